//! The texts of kernels: what is recorded of a scene, and what schedules it.

use residual_render::layer::{Layer, Layers};
use residual_render::program::Structure;

use crate::arithmetic::Arithmetic;
use crate::functions::{Recorded, SceneFunctions};
use crate::module::Module;

/// Threads of a workgroup.
pub const WORKGROUP: u32 = 64;
/// Nodes that wait on a thread's stack.
pub const STACK: usize = 64;

const WAVEFRONT: &str = include_str!("wgsl/wavefront.wgsl");
const CONTROL: &str = include_str!("wgsl/control.wgsl");
const BINDINGS: &str = include_str!("wgsl/kernels.wgsl");
const PATHS: &str = include_str!("wgsl/paths.wgsl");
const TRAVERSAL: &str = include_str!("wgsl/traversal.wgsl");
const TRACE: &str = include_str!("wgsl/trace.wgsl");
const SCATTER: &str = include_str!("wgsl/scatter.wgsl");
const TALLIES: &str = include_str!("wgsl/tallies.wgsl");
const COMPACTION: &str = include_str!("wgsl/compaction.wgsl");
const RAYS: &str = include_str!("wgsl/rays.wgsl");
const FOLLOW: &str = include_str!("wgsl/follow.wgsl");

/// What a scene calls for, as texts for one adapter.
pub struct Kernels {
    functions: SceneFunctions,
    layers: Layers,
    traits: Traits,
    arithmetic: Arithmetic,
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
    /// The kernels of a structure.
    pub fn new(structure: &Structure, traits: Traits, arithmetic: Arithmetic) -> Self {
        Self {
            functions: SceneFunctions::of(structure),
            layers: structure.layers,
            traits,
            arithmetic,
        }
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
            "const WORKGROUP: u32 = {WORKGROUP}u;\nconst QUEUES: u32 = {}u;\nconst STRIDE: u32 = {}u;\nconst STACK: u32 = {STACK}u;\n\n{WAVEFRONT}",
            self.queues(),
            self.layers.stride(),
        )
    }

    fn module(&self) -> Module {
        let mut module = Module::new(self.arithmetic);
        module.add_text(&self.constants());
        module.add_text(BINDINGS);
        module.add_text(PATHS);
        module
    }

    /// `plan` and `turn`, which one thread runs between the others.
    pub fn control(&self) -> String {
        let mut module = Module::new(self.arithmetic);
        module.add_text(&self.constants());
        module.add_text(CONTROL);
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

    /// Makes the `path` of a `slot`, and clears its sample.
    fn start(&self) -> String {
        let call = call(&self.functions.emit);
        format!(
            "    let slot = id.x;
    if slot >= settings.count {{
        return;
    }}
    let place = pixel_of(slot);
    let start = {call};
    var path = Path(start.org, 0.0f, start.dir, start.pixel, vec3f(1.0f), 1u, vec4u(0u));
    for (var k = 0u; k < STRIDE; k++) {{
        samples[slot * STRIDE + k] = 0.0f;
    }}
"
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
                let call = call(test);
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
        let body = self.take_step(step, &QUEUED);
        module.add_text(COMPACTION);
        module.add_text(&format!(
            "\
@compute @workgroup_size(WORKGROUP)
fn shade(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {{
    clear_counts(thread);
    var slot: u32;
    var next = NONE;
    var shadow = NONE;
    var shadow_ray: ShadowRay;
    if id.x < atomicLoad(&queues.counts[{queue}]) {{
        slot = queues.entries[2u * settings.slots + queues.starts[{queue}] + id.x];
        let path = paths[slot];
{body}    }}
    reserve(thread);
    if next != NONE {{
        queues.entries[(1u - queues.side) * settings.slots + next_start + next] = slot;
    }}
    if shadow != NONE {{
        shadow_rays[shadow_start + shadow] = shadow_ray;
    }}
}}
"
        ));
        module.finish()
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
        let mut body = format!("{indent}let step = {};\n", call(step));
        let output = |name: &str| step.output("step", name);
        if let Some(seen) = output("seen") {
            body += &format!("{indent}add(slot, {seen});\n");
        }
        body += &self.keep_layers(step, indent);
        for (kind, lines) in [("shadow", shadow), ("bounce", bounce)] {
            if let Some(active) = output(&format!("{kind}_active")) {
                body += &format!("{indent}if {active} {{\n");
                for line in *lines {
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
        for layer in self.layers.iter().filter(|&l| l != Layer::SampleCount) {
            let Some(value) = step.output("step", layer.name()) else {
                continue;
            };
            let (first, channels) = (self.layers.offset(layer), layer.channels().len());
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
            false => format!("{indent}if path.depth == 1u {{\n{lines}{indent}}}\n"),
        }
    }
}

/// `trace_rays`: ray queries, apart from any scene.
pub fn rays_kernel(arithmetic: Arithmetic, f64: bool) -> String {
    let mut module = Module::new(arithmetic);
    module.add_text(&format!(
        "const WORKGROUP: u32 = {WORKGROUP}u;\nconst STACK: u32 = {STACK}u;\n"
    ));
    module.add_text(&sections(
        TRAVERSAL,
        &[if f64 { "f64" } else { "f32" }, "sided"],
    ));
    module.add_text(RAYS);
    module.finish()
}

/// How a path goes on: statements on what `step` has.
struct WayOn {
    indent: &'static str,
    shadow: &'static [&'static str],
    bounce: &'static [&'static str],
}

/// Through queues.
const QUEUED: WayOn = WayOn {
    indent: "        ",
    shadow: &[
        "shadow = atomicAdd(&shadow_count, 1u);",
        "shadow_ray = ShadowRay(step.shadow_org, step.shadow_tmax, step.shadow_dir, slot, step.shadow_contribution);",
    ],
    bounce: &[
        "next = atomicAdd(&next_count, 1u);",
        "paths[slot] = Path(step.bounce_org, step.bounce_pdf, step.bounce_dir, path.pixel, step.bounce_throughput, path.depth + 1u, vec4u(0u));",
    ],
};

/// In the same thread.
const FOLLOWED: WayOn = WayOn {
    indent: "                ",
    shadow: &[
        "is_shadow = true;",
        "shadow = ShadowRay(step.shadow_org, step.shadow_tmax, step.shadow_dir, slot, step.shadow_contribution);",
    ],
    bounce: &[
        "goes_on = true;",
        "path = Path(step.bounce_org, step.bounce_pdf, step.bounce_dir, path.pixel, step.bounce_throughput, path.depth + 1u, vec4u(0u));",
    ],
};

/// The call of a recorded function where there are `slot`, `path`, or what emission and alpha tests have instead.
fn call(recorded: &Recorded) -> String {
    let name = &recorded.function.name;
    let is_alpha_test = name.ends_with("alpha_test");
    let argument = |parameter: &str| match parameter {
        "x" => "place.x",
        "y" => "place.y",
        "width" => "settings.width",
        "height" => "settings.height",
        "seed" => "settings.seed",
        "sample" | "index" => "sample_of(slot)",
        "max_depth" => "settings.max_depth",
        "roulette_from" => "settings.roulette_from",
        "reach" => "settings.reach",
        "prim" if is_alpha_test => "hit.prim",
        "u" if is_alpha_test => "hit.u",
        "v" if is_alpha_test => "hit.v",
        "org" if is_alpha_test => "org",
        "dir" if is_alpha_test => "dir",
        "prim" => "path.hit.w",
        "u" => "bitcast<f32>(path.hit.y)",
        "v" => "bitcast<f32>(path.hit.z)",
        "org" => "path.org",
        "dir" => "path.dir",
        "throughput" => "path.throughput",
        "pdf" => "path.pdf",
        "pixel" => "path.pixel",
        "depth" => "path.depth",
        other => unreachable!("no recorded function has a parameter {other}"),
    };
    let parameters = &recorded.function.parameters;
    let arguments: Vec<_> = parameters.iter().map(|p| argument(p.name)).collect();
    format!("{name}({})", arguments.join(", "))
}

/// A text with its sections: lines between `//[name` and `//]` stay where the name is among these.
fn sections(text: &str, names: &[&str]) -> String {
    let mut kept = String::with_capacity(text.len());
    let mut is_kept = true;
    for line in text.lines() {
        match line.trim().strip_prefix("//[") {
            Some(name) => is_kept = names.contains(&name),
            None if line.trim() == "//]" => is_kept = true,
            None if is_kept => {
                kept += line;
                kept.push('\n');
            }
            None => {}
        }
    }
    kept
}
