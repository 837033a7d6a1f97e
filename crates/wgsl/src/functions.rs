//! The functions of a scene, recorded: the steps of its tracer, and its alpha tests.
//!
//! Options of the tracer are parameters, so that none of them makes another module.

use residual_render::alpha::AlphaTest as _;
use residual_render::domain::tape::{Function, Outputs, Record, Tape};
use residual_render::domain::{Buffers, Domain};
use residual_render::layer::Layers;
use residual_render::math::Vec3;
use residual_render::math::vec3::vec3;
use residual_render::program::{AlphaTestNode, BoxedMaterial, Interpreted, Program, Structure};
use residual_render::renderer::Renderer;
use residual_render::sampler::SampleKey;
use residual_render::surface::{PathRay, SurfaceHit};
use residual_render::tracer::{
    self, Features, Path, PathOrigin, PathState, Settings, Step, Tracer,
};
use residual_render::triangle;

/// A recorded function with what is printed around it.
#[derive(Clone, Debug)]
pub struct Recorded {
    /// The function.
    pub function: Function,
    /// The structure that it returns, if it has several outputs.
    pub result: &'static str,
    /// What it is for.
    pub comment: String,
}

impl Recorded {
    /// The expression that reads an output from `value`, which the function has returned; `None` if there is no such
    /// output.
    pub fn output(&self, value: &str, output: &str) -> Option<String> {
        let outputs = &self.function.outputs;
        let is_there = outputs.iter().any(|o| o.name == output);
        is_there.then(|| match outputs.len() {
            1 => value.to_owned(),
            _ => format!("{value}.{output}"),
        })
    }
}

/// What a structure calls for.
#[derive(Clone, Debug)]
pub struct SceneFunctions {
    /// Where paths begin.
    pub emit: Recorded,
    /// Of each program.
    pub programs: Vec<ProgramFunctions>,
    /// What rays see that hit nothing, if that is anything.
    pub miss: Option<Recorded>,
    /// The index of a triangle's program.
    pub program_of: Recorded,
}

/// What a material program calls for.
#[derive(Clone, Debug)]
pub struct ProgramFunctions {
    /// What the program is, for readers.
    pub description: String,
    /// What becomes of a path that hits it, if anything does.
    pub step: Option<Recorded>,
    /// Whether the surface is there at all, if it is not always.
    pub alpha_test: Option<Recorded>,
}

impl SceneFunctions {
    /// Records them.
    pub fn of(structure: &Structure) -> Self {
        let outcome = Outcome::of(structure);
        let programs = structure.programs.iter().enumerate();
        let programs = programs.map(|(index, program)| ProgramFunctions {
            description: describe(index, program),
            step: step(index, program, structure, outcome),
            alpha_test: program
                .alpha_test
                .as_ref()
                .map(|node| alpha_test(index, node)),
        });
        Self {
            emit: emit(structure),
            programs: programs.collect(),
            miss: miss(structure),
            program_of: program_of(),
        }
    }
}

fn describe(index: usize, program: &Program) -> String {
    let inputs = program.inputs.iter().enumerate();
    let inputs: Vec<String> = inputs
        .map(|(place, input)| format!("{place} {}", input.name))
        .collect();
    format!(
        "Program {index}: {:?}; inputs: {}",
        program.bsdf,
        inputs.join(", ")
    )
}

/// A hit, as parameters.
fn hit(tape: &Tape) -> SurfaceHit<Record<'_>> {
    let prim = tape.word("prim");
    SurfaceHit {
        prim,
        u: tape.real("u"),
        v: tape.real("v"),
    }
}

/// A path, as parameters.
fn path(tape: &Tape) -> Path<Record<'_>> {
    let d = Record::new(tape);
    Path {
        ray: PathRay::unbounded(d, tape.vector("org"), tape.vector("dir")),
        throughput: tape.vector("throughput"),
        pdf: tape.real("pdf"),
        rivals: d.lit(0.0),
        key: SampleKey {
            pixel: tape.word("pixel"),
            index: tape.word("index"),
        },
        state: PathState(tape.word("state")),
    }
}

/// The tracer's options that matter along a path, as parameters.
fn settings(tape: &Tape) -> Settings<Record<'_>> {
    let d = Record::new(tape);
    Settings {
        // The width and the seed matter where a path begins.
        image: [d.lit(1.0), tape.real("height")],
        seed: d.uint(0),
        max_depth: tape.word("max_depth"),
        roulette_from: tape.word("roulette_from"),
        reach: tape.real("reach"),
        origin: PathOrigin::Camera,
    }
}

/// Whether the structure's tracer ever has a contribution, a shadow ray, a bounce at a hit: all programs return the
/// same, so that one kernel can take over from another.
#[derive(Clone, Copy, Default)]
struct Outcome {
    seen: bool,
    shadow: bool,
    bounce: bool,
}

impl Outcome {
    /// Of all programs.
    fn of(structure: &Structure) -> Self {
        let of_programs = structure.programs.iter().map(|program| {
            with_step(&Tape::new(), structure, program, |step| Self {
                seen: step.seen.is_some(),
                shadow: step.shadow.is_some(),
                bounce: step.bounce.is_some(),
            })
        });
        of_programs.fold(Self::default(), |all, one| Self {
            seen: all.seen | one.seen,
            shadow: all.shadow | one.shadow,
            bounce: all.bounce | one.bounce,
        })
    }
}

/// Records the step at a hit on a program.
fn with_step<'t, R>(
    tape: &'t Tape,
    structure: &Structure,
    program: &Program,
    f: impl FnOnce(Step<Record<'t>>) -> R,
) -> R {
    let d = Record::new(tape);
    let (hit, path) = (hit(tape), path(tape));
    let scene = Interpreted::<Record<'_>>::new(structure, &Buffers::EMPTY);
    let tracer = scene.tracer(settings(tape));
    let material = BoxedMaterial::new(program);
    f(tracer::shade(
        d,
        &tracer,
        &path,
        &hit,
        &material,
        scene.lights(),
    ))
}

/// The step at a hit on a program; `None` where nothing ever comes of a hit.
fn step(
    index: usize,
    program: &Program,
    structure: &Structure,
    outcome: Outcome,
) -> Option<Recorded> {
    let Outcome {
        seen,
        shadow,
        bounce,
    } = outcome;
    if !(seen || shadow || bounce || structure.layers != Layers::NONE) {
        return None;
    }
    let tape = Tape::new();
    let d = Record::new(&tape);
    let zero = d.lit(0.0);
    let none = Vec3::splat(zero);
    let outputs = with_step(&tape, structure, program, |step| {
        let mut outputs = Outputs::new();
        if seen {
            outputs = outputs.vector("seen", step.seen.unwrap_or(none));
        }
        if let Some(features) = &step.features {
            outputs = layers(outputs, features, structure.layers);
        }
        if shadow {
            let (org, dir, tmax, contribution, active) = match step.shadow {
                Some(s) => (s.ray.org, s.ray.dir, s.ray.tmax, s.contribution, s.active),
                None => (none, none, zero, none, d.truth(false)),
            };
            outputs = outputs
                .vector("shadow_org", org)
                .vector("shadow_dir", dir)
                .real("shadow_tmax", tmax)
                .vector("shadow_contribution", contribution)
                .truth("shadow_active", active);
        }
        if bounce {
            let (org, dir, throughput, pdf, state, active) = match step.bounce {
                Some(b) => (
                    b.path.ray.org,
                    b.path.ray.dir,
                    b.path.throughput,
                    b.path.pdf,
                    b.path.state.0,
                    b.active,
                ),
                None => (none, none, none, zero, d.uint(0), d.truth(false)),
            };
            outputs = outputs
                .vector("bounce_org", org)
                .vector("bounce_dir", dir)
                .vector("bounce_throughput", throughput)
                .real("bounce_pdf", pdf)
                .word("bounce_state", state)
                .truth("bounce_active", active);
        }
        outputs
    });
    Some(Recorded {
        function: tape.function(format!("program_{index}_step"), outputs),
        result: "Step",
        comment: "What becomes of a path that hits a surface of this program.".to_owned(),
    })
}

/// The layers of a first vertex.
fn layers<'t>(
    mut outputs: Outputs<'t>,
    features: &Features<Record<'t>>,
    set: Layers,
) -> Outputs<'t> {
    let channels = features.channels(set);
    for layer in set.of_samples() {
        let first = set.offset(layer) - Layers::RADIANCE;
        outputs = match channels[first..first + layer.width()] {
            [x, y, z] => outputs.vector(layer.name(), vec3(x, y, z)),
            [x] => outputs.real(layer.name(), x),
            _ => unreachable!("layers are vectors or numbers"),
        };
    }
    outputs
}

fn alpha_test(index: usize, node: &AlphaTestNode) -> Recorded {
    let tape = Tape::new();
    let d = Record::new(&tape);
    let hit = hit(&tape);
    let ray = [tape.vector("org"), tape.vector("dir")];
    let passes = node.boxed::<Record<'_>>().passes(d, ray, &hit);
    Recorded {
        function: tape.function(
            format!("program_{index}_alpha_test"),
            Outputs::new().truth("passes", passes),
        ),
        result: "",
        comment: "Whether the surface is there for this hit of the ray.".to_owned(),
    }
}

/// What rays that hit nothing see; nothing where the tracer sees nothing.
fn miss(structure: &Structure) -> Option<Recorded> {
    let tape = Tape::new();
    let d = Record::new(&tape);
    let path = path(&tape);
    let scene = Interpreted::<Record<'_>>::new(structure, &Buffers::EMPTY);
    let tracer = scene.tracer(settings(&tape));
    let seen = tracer.on_miss(d, &path, scene.lights());
    let mut outputs = Outputs::new();
    let is_needed = seen.is_some() || structure.layers != Layers::NONE;
    if let Some(seen) = seen {
        outputs = outputs.vector("seen", seen);
    }
    if structure.layers != Layers::NONE {
        let features = Features::of_miss(d, structure.layers, &path);
        outputs = layers(outputs, &features, structure.layers);
    }
    is_needed.then(|| Recorded {
        function: tape.function("miss", outputs),
        result: "Miss",
        comment: "What a path sees whose ray hits nothing.".to_owned(),
    })
}

/// Where paths begin.
fn emit(structure: &Structure) -> Recorded {
    let tape = Tape::new();
    let d = Record::new(&tape);
    let pixel = ["x", "y"].map(|name| tape.word(name));
    let sample = tape.word("sample");
    let scene = Interpreted::<Record<'_>>::new(structure, &Buffers::EMPTY);
    let tracer = scene.tracer(Settings {
        image: ["width", "height"].map(|name| tape.real(name)),
        seed: tape.word("seed"),
        max_depth: d.uint(0),
        roulette_from: d.uint(0),
        reach: d.lit(0.0),
        origin: PathOrigin::Camera,
    });
    let path = tracer.on_emit(d, scene.camera(), scene.lights(), pixel, sample);
    let outputs = Outputs::new()
        .vector("org", path.ray.org)
        .vector("dir", path.ray.dir)
        .word("pixel", path.key.pixel);
    Recorded {
        function: tape.function("emit", outputs),
        result: "CameraPath",
        comment: format!(
            "{:?}, {:?}: a path of throughput 1 through a place of the pixel at (x, y).",
            structure.camera, structure.sampler
        ),
    }
}

fn program_of() -> Recorded {
    let tape = Tape::new();
    let d = Record::new(&tape);
    let program = triangle::program_of(d, tape.word("prim"));
    Recorded {
        function: tape.function("program_of", Outputs::new().word("program", program)),
        result: "",
        comment: "The index of a triangle's program.".to_owned(),
    }
}
