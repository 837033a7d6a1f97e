//! The texts of kernels: what is recorded of a scene, and what schedules it.

use residual_render::layer::Layers;
use residual_render::program::Structure;
use residual_render::tracer::{MAX_DEPTH, PathOrigin};

use crate::arithmetic::Arithmetic;
use crate::calls::{FOLLOWED, QUEUED, QUEUED_IN_CASE, WayOn, call};
use crate::functions::SceneFunctions;
use crate::module::Module;
use crate::recorded::Recorded;
use crate::sections::sections;
use crate::shade_kernel::add_shade;

/// Threads of a workgroup.
pub const WORKGROUP: u32 = 64;
/// Steps of at most so many lines share a kernel, with everything around them.
const SHORT: usize = 256;
/// Nodes that wait on a thread's stack.
pub const STACK: usize = 64;

const WAVEFRONT: &str = include_str!("wgsl/wavefront.wgsl");
const CONTROL: &str = include_str!("wgsl/control.wgsl");
const PLAN: &str = include_str!("wgsl/plan.wgsl");
const BINDINGS: &str = include_str!("wgsl/kernels.wgsl");
const PATHS: &str = include_str!("wgsl/paths.wgsl");
pub(crate) const TRAVERSAL: &str = include_str!("wgsl/traversal.wgsl");
const TRACE: &str = include_str!("wgsl/trace.wgsl");
const SCATTER: &str = include_str!("wgsl/scatter.wgsl");
const TALLIES: &str = include_str!("wgsl/tallies.wgsl");
const FOLLOW: &str = include_str!("wgsl/follow.wgsl");

/// What a scene calls for, as texts for one adapter.
pub struct Kernels {
    functions: SceneFunctions,
    origin: PathOrigin,
    /// Paths begin at both ends, in kernels of their own.
    has_light_paths: bool,
    layers: Layers,
    traits: Traits,
    arithmetic: Arithmetic,
    folded: Vec<usize>,
}

/// What kernels have in them only where it is called for.
#[derive(Clone, Copy, Debug)]
pub struct Traits {
    /// Some triangles are seen from their front only.
    pub sided: bool,
    /// The image shows what traversal visits.
    pub visits: bool,
    /// Hits on triangles seen edge-on are computed in `f64`, which adapters need not have.
    pub f64: bool,
}

impl Kernels {
    /// The kernels of a structure's paths that begin at one end.
    pub fn new(
        structure: &Structure,
        origin: PathOrigin,
        traits: Traits,
        arithmetic: Arithmetic,
    ) -> Self {
        let mut kernels = Self {
            functions: SceneFunctions::of(structure, origin),
            origin,
            has_light_paths: structure.tracer.has_light_paths(),
            layers: structure.layers,
            traits,
            arithmetic,
            folded: Vec::new(),
        };
        kernels.folded = kernels.short_queues();
        kernels
    }

    /// Where their paths begin.
    pub fn origin(&self) -> PathOrigin {
        self.origin
    }

    /// How many queues of hits there are: one a program, and one for rays that hit nothing.
    pub fn queues(&self) -> usize {
        self.functions.programs.len() + 1
    }

    /// The queues of whose hits something comes: of programs, and the last of what rays see that hit nothing.
    pub fn queues_with_steps(&self) -> impl Iterator<Item = usize> {
        (0..self.queues()).filter(|&queue| self.step(queue).is_some())
    }

    fn step(&self, queue: usize) -> Option<&Recorded> {
        match self.functions.programs.get(queue) {
            Some(program) => program.step.as_ref(),
            None => self.functions.miss.as_ref(),
        }
    }

    /// Constants and structures of all kernels.
    fn constants(&self) -> String {
        format!(
            "const WORKGROUP: u32 = {WORKGROUP}u;\nconst QUEUES: u32 = {}u;\nconst STRIDE: u32 = {}u;\nconst STACK: u32 = {STACK}u;\n\n{}",
            self.queues(),
            self.layers.stride(),
            sections(WAVEFRONT, &self.section_names()),
        )
    }

    fn module(&self) -> Module {
        let mut module = Module::new(self.arithmetic);
        module.add_text(&self.constants());
        module.add_text(BINDINGS);
        module.add_text(&sections(PATHS, &self.section_names()));
        module
    }

    /// The queues whose steps are so short that one kernel takes them all; none, or several.
    pub fn folded(&self) -> &[usize] {
        &self.folded
    }

    fn short_queues(&self) -> Vec<usize> {
        let is_short = |&queue: &usize| {
            self.step(queue).is_some_and(|step| {
                let mut module = Module::new(self.arithmetic);
                module.add(step);
                module.finish().lines().count() <= SHORT
            })
        };
        let short: Vec<usize> = (0..self.queues()).filter(is_short).collect();
        match short.len() {
            1 => Vec::new(),
            _ => short,
        }
    }

    /// `plan` and `turn`, which one thread runs between the others. Paths of folded queues stand first, side by side.
    pub fn control(&self) -> String {
        let mut module = Module::new(self.arithmetic);
        module.add_text(&self.constants());
        module.add_text(CONTROL);
        let folded = &self.folded;
        let place = |queue: usize| format!("    start = place({queue}u, start);\n");
        let others = (0..self.queues()).filter(|queue| !folded.contains(queue));
        let first: String = folded.iter().map(|&queue| place(queue)).collect();
        let then: String = others.map(place).collect();
        module.add_text(
            &PLAN
                .replace("//FOLDED\n", &first)
                .replace("//OTHERS\n", &then),
        );
        module.finish()
    }

    /// `emit_paths`: where paths begin.
    pub fn emit(&self) -> String {
        let mut module = self.module();
        module.add(&self.functions.emit);
        let start = self.start();
        module.add_text(&format!(
            "\
@compute @workgroup_size(WORKGROUP)
fn emit_paths(@builtin(global_invocation_id) id: vec3u) {{
{start}    paths[slot] = path;
    queues.entries[slot] = slot;
}}
"
        ));
        module.finish()
    }

    fn call(&self, recorded: &Recorded) -> String {
        call(recorded, self.has_light_paths)
    }

    /// Makes the `path` of a `slot`, and clears its sample.
    fn start(&self) -> String {
        let call = self.call(&self.functions.emit);
        let of_emit = |output: &str, otherwise: &str| {
            let output = self.functions.emit.output("start", output);
            output.unwrap_or_else(|| otherwise.to_owned())
        };
        let [pdf, throughput, state] = [
            ("pdf", "0.0f"),
            ("throughput", "vec3f(1.0f)"),
            ("state", "1u"),
        ]
        .map(|(output, otherwise)| of_emit(output, otherwise));
        let more = match self.has_light_paths {
            true => ", start.rivals, start.index",
            false => "",
        };
        let clear = match self.origin {
            PathOrigin::Camera => {
                "\
    for (var k = 0u; k < STRIDE; k++) {
        samples[slot * STRIDE + k] = 0.0f;
    }
"
            }
            PathOrigin::Lights => "",
        };
        format!(
            "    let slot = id.x;
    if slot >= settings.count {{
        return;
    }}
    let place = pixel_of(slot);
    let start = {call};
    var path = Path(start.org, {pdf}, start.dir, start.pixel, {throughput}, {state}, vec4u(0u){more});
{clear}"
        )
    }

    /// `trace`: closest hits of paths, and occlusion of shadow rays.
    pub fn trace(&self) -> String {
        let mut module = self.module();
        self.add_traversal(&mut module);
        module.add_text(TALLIES);
        module.add_text(&sections(TRACE, &self.section_names()));
        module.finish()
    }

    fn section_names(&self) -> Vec<&'static str> {
        let Traits { sided, visits, f64 } = self.traits;
        let has_alpha = self
            .functions
            .programs
            .iter()
            .any(|p| p.alpha_test.is_some());
        let mut names = vec![if f64 { "f64" } else { "f32" }];
        names.push(match self.origin {
            PathOrigin::Camera => "camera",
            PathOrigin::Lights => "lights",
        });
        names.extend(self.has_light_paths.then_some("ends"));
        names.extend(sided.then_some("sided"));
        names.extend(visits.then_some("visits"));
        names.extend(has_alpha.then_some("alpha"));
        names
    }

    fn add_traversal(&self, module: &mut Module) {
        let mut cases = String::new();
        for (index, program) in self.functions.programs.iter().enumerate() {
            if let Some(test) = &program.alpha_test {
                module.add(test);
                let call = self.call(test);
                cases +=
                    &format!("        case {index}u: {{\n            return {call};\n        }}\n");
            }
        }
        module.add_text(&sections(TRAVERSAL, &self.section_names()));
        if !cases.is_empty() {
            module.add_text(&format!(
                "\
// Whether alpha lets the ray through.
fn is_there(org: vec3f, dir: vec3f, hit: Hit) -> bool {{
    switch program_of(hit.prim) {{
{cases}        default: {{
            return true;
        }}
    }}
}}
"
            ));
        }
        module.add(&self.functions.program_of);
    }

    /// `scatter`: paths go to the queue of the program that they have hit.
    pub fn scatter(&self) -> String {
        let mut module = self.module();
        module.add_text(TALLIES);
        module.add_text(SCATTER);
        module.finish()
    }

    /// `shade`: a step of the paths in a queue.
    ///
    /// # Panics
    /// If nothing comes of the queue's hits.
    pub fn shade(&self, queue: usize) -> String {
        let step = self.step(queue).expect("the queue has a step");
        let mut module = self.module();
        module.add(step);
        let first = format!("queues.starts[{queue}]");
        let count = format!("atomicLoad(&queues.counts[{queue}])");
        add_shade(module, &first, &count, &self.take_step(step, &QUEUED))
    }

    /// `shade`: a step of the paths in the folded queues.
    ///
    /// # Panics
    /// If there are none.
    pub fn shade_folded(&self) -> String {
        let folded = &self.folded;
        let last = folded.last().expect("folded queues");
        let mut module = self.module();
        let mut body = "        switch path.hit.x {\n".to_owned();
        for &queue in folded {
            let step = self.step(queue).expect("a folded queue has a step");
            module.add(step);
            let taken = self.take_step(step, &QUEUED_IN_CASE);
            body += &format!("            case {queue}u: {{\n{taken}            }}\n");
        }
        body += "            default: {\n            }\n        }\n";
        // They stand first.
        let count = format!("queues.starts[{last}] + atomicLoad(&queues.counts[{last}])");
        add_shade(module, "0u", &count, &body)
    }

    /// `follow_path`: everything in one kernel.
    pub fn megakernel(&self) -> String {
        let mut module = self.module();
        module.add(&self.functions.emit);
        self.add_traversal(&mut module);
        let mut cases = String::new();
        for queue in self.queues_with_steps() {
            let step = self.step(queue).expect("the queue has a step");
            module.add(step);
            let body = self.take_step(step, &FOLLOWED);
            cases += &format!("            case {queue}u: {{\n{body}            }}\n");
        }
        let start = self.start();
        let body = sections(FOLLOW, &self.section_names())
            .replace("//START\n", &start)
            .replace("//CASES\n", &cases);
        module.add_text(&body);
        module.finish()
    }

    /// What becomes of `path` in `slot`.
    fn take_step(&self, step: &Recorded, way: &WayOn) -> String {
        let WayOn {
            indent,
            shadow,
            bounce,
        } = way;
        let mut body = format!("{indent}let step = {};\n", self.call(step));
        let output = |name: &str| step.output("step", name);
        if let Some(seen) = output("seen") {
            body += &format!("{indent}add(slot, {seen});\n");
        }
        body += &self.keep_layers(step, indent);
        let sample = match self.origin {
            PathOrigin::Camera => "slot",
            PathOrigin::Lights => "sample_in(step.shadow_pixel, slot)",
        };
        let shadow_ray = format!(
            "ShadowRay(step.shadow_org, step.shadow_tmax, step.shadow_dir, {sample}, step.shadow_contribution)"
        );
        let more = match self.has_light_paths {
            true => ", step.bounce_rivals, path.index",
            false => "",
        };
        let next = format!(
            "Path(step.bounce_org, step.bounce_pdf, step.bounce_dir, path.pixel, step.bounce_throughput, step.bounce_state, vec4u(0u){more})"
        );
        for (kind, lines) in [("shadow", shadow), ("bounce", bounce)] {
            if let Some(active) = output(&format!("{kind}_active")) {
                body += &format!("{indent}if {active} {{\n");
                for line in *lines {
                    let line = line.replace("SHADOW", &shadow_ray).replace("PATH", &next);
                    body += &format!("{indent}    {line}\n");
                }
                body += &format!("{indent}}}\n");
            }
        }
        body
    }

    /// Layers keep what is seen first.
    fn keep_layers(&self, step: &Recorded, indent: &str) -> String {
        let mut lines = String::new();
        for layer in self.layers.of_samples() {
            let Some(value) = step.output("step", layer.name()) else {
                continue;
            };
            let (first, channels) = (self.layers.offset(layer), layer.width());
            for (channel, component) in [".x", ".y", ".z"].into_iter().take(channels).enumerate() {
                let component = if channels == 1 { "" } else { component };
                let place = first + channel;
                lines += &format!(
                    "{indent}    samples[slot * STRIDE + {place}u] = {value}{component};\n"
                );
            }
        }
        match lines.is_empty() {
            true => lines,
            false => {
                format!("{indent}if (path.state & {MAX_DEPTH}u) == 1u {{\n{lines}{indent}}}\n")
            }
        }
    }
}
