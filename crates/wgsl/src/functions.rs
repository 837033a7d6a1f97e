//! The functions of a scene, recorded: the steps of its tracer, and its alpha tests.
//!
//! Options of the tracer are parameters, so that none of them makes another module.

use residual_render::domain::tape::{Outputs, Record, Tape};
use residual_render::domain::{Buffers, Domain};
use residual_render::layer::Layers;
use residual_render::math::Vec3;
use residual_render::math::vec3::vec3;
use residual_render::program::{BoxedMaterial, Interpreted, Program, Structure};
use residual_render::renderer::Renderer;
use residual_render::sampler::SampleKey;
use residual_render::surface::PathRay;
use residual_render::tracer::{
    self, Features, Path, PathOrigin, PathState, Settings, Step, Tracer,
};

use crate::hit_functions::{alpha_test, hit, program_of};
use crate::recorded::Recorded;

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
    /// Records them, of paths that begin here: at the camera, but of structures that [have light
    /// paths](residual_render::tracer::TracerNode::has_light_paths).
    pub fn of(structure: &Structure, origin: PathOrigin) -> Self {
        let recorder = Recorder { structure, origin };
        let outcome = recorder.outcome();
        let programs = structure.programs.iter().enumerate();
        let programs = programs.map(|(index, program)| ProgramFunctions {
            description: describe(index, program),
            step: recorder.step(index, program, outcome),
            alpha_test: program
                .alpha_test
                .as_ref()
                .map(|node| alpha_test(index, node)),
        });
        Self {
            emit: recorder.emit(),
            programs: programs.collect(),
            miss: recorder.miss(),
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

/// Whether the structure's tracer ever has a contribution, a shadow ray, a bounce at a hit: all programs return the
/// same, so that one kernel can take over from another.
#[derive(Clone, Copy, Default)]
struct Outcome {
    seen: bool,
    shadow: bool,
    bounce: bool,
}

/// Records the steps of a structure's paths that begin at one end.
#[derive(Clone, Copy)]
struct Recorder<'s> {
    structure: &'s Structure,
    origin: PathOrigin,
}

impl Recorder<'_> {
    /// The name of a function, which says at which end its paths begin: a module may have both.
    fn name(self, function: &str) -> String {
        match self.origin {
            PathOrigin::Camera => function.to_owned(),
            PathOrigin::Lights => format!("light_{function}"),
        }
    }

    /// The name of a function's outputs.
    fn result(self, of_camera: &'static str, of_lights: &'static str) -> &'static str {
        match self.origin {
            PathOrigin::Camera => of_camera,
            PathOrigin::Lights => of_lights,
        }
    }

    /// Paths of both ends are weighed against each other.
    fn has_rivals(self) -> bool {
        self.structure.tracer.has_light_paths()
    }

    /// A path, as parameters.
    fn path(self, tape: &Tape) -> Path<Record<'_>> {
        let d = Record::new(tape);
        Path {
            ray: PathRay::unbounded(d, tape.vector("org"), tape.vector("dir")),
            throughput: tape.vector("throughput"),
            pdf: tape.real("pdf"),
            rivals: match self.has_rivals() {
                true => tape.real("rivals"),
                false => d.lit(0.0),
            },
            key: SampleKey {
                pixel: tape.word("pixel"),
                index: tape.word("index"),
            },
            state: PathState(tape.word("state")),
        }
    }

    /// The tracer's options that matter along a path, as parameters.
    fn settings(self, tape: &Tape) -> Settings<Record<'_>> {
        let d = Record::new(tape);
        Settings {
            // The width matters where a path begins, or where the camera sees it, and the seed where it begins.
            image: match self.origin {
                PathOrigin::Camera => [d.lit(1.0), tape.real("height")],
                PathOrigin::Lights => ["width", "height"].map(|name| tape.real(name)),
            },
            seed: d.uint(0),
            max_depth: tape.word("max_depth"),
            roulette_from: tape.word("roulette_from"),
            reach: tape.real("reach"),
            origin: self.origin,
        }
    }

    /// What ever comes of a hit, on any program.
    fn outcome(self) -> Outcome {
        let of_programs = self.structure.programs.iter().map(|program| {
            self.with_step(&Tape::new(), program, |step, _| Outcome {
                seen: step.seen.is_some(),
                shadow: step.shadow.is_some(),
                bounce: step.bounce.is_some(),
            })
        });
        of_programs.fold(Outcome::default(), |all, one| Outcome {
            seen: all.seen | one.seen,
            shadow: all.shadow | one.shadow,
            bounce: all.bounce | one.bounce,
        })
    }

    /// Records the step at a hit on a program; `f` also gets the layers that are filled.
    fn with_step<'t, R>(
        self,
        tape: &'t Tape,
        program: &Program,
        f: impl FnOnce(Step<Record<'t>>, Layers) -> R,
    ) -> R {
        let d = Record::new(tape);
        let (hit, path) = (hit(tape), self.path(tape));
        let scene = Interpreted::<Record<'_>>::new(self.structure, &Buffers::EMPTY);
        let tracer = scene.tracer(self.settings(tape));
        let material = BoxedMaterial::new(program);
        let step = tracer::shade(d, &tracer, &path, &hit, &material, scene.lights());
        f(step, tracer.layers())
    }

    /// The step at a hit on a program; `None` where nothing ever comes of a hit.
    fn step(self, index: usize, program: &Program, outcome: Outcome) -> Option<Recorded> {
        let tape = Tape::new();
        let d = Record::new(&tape);
        let outputs = self.with_step(&tape, program, |step, set| {
            self.outputs(d, &step, set, outcome)
        });
        (!outputs.is_empty()).then(|| Recorded {
            function: tape.function(self.name(&format!("program_{index}_step")), outputs),
            result: self.result("Step", "LightStep"),
            comment: "What becomes of a path that hits a surface of this program.".to_owned(),
        })
    }

    fn outputs<'t>(
        self,
        d: Record<'t>,
        step: &Step<Record<'t>>,
        set: Layers,
        outcome: Outcome,
    ) -> Outputs<'t> {
        let zero = d.lit(0.0);
        let none = Vec3::splat(zero);
        let mut outputs = Outputs::new();
        if outcome.seen {
            outputs = outputs.vector("seen", step.seen.unwrap_or(none));
        }
        if let Some(features) = &step.features {
            outputs = layers(outputs, features, set);
        }
        if outcome.shadow {
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
            if self.origin == PathOrigin::Lights {
                let pixel = step.shadow.and_then(|shadow| shadow.pixel);
                outputs = outputs.word("shadow_pixel", pixel.unwrap_or(d.uint(0)));
            }
        }
        if outcome.bounce {
            let (org, dir, throughput, pdf, rivals, state, active) = match step.bounce {
                Some(b) => (
                    b.path.ray.org,
                    b.path.ray.dir,
                    b.path.throughput,
                    b.path.pdf,
                    b.path.rivals,
                    b.path.state.0,
                    b.active,
                ),
                None => (none, none, none, zero, zero, d.uint(0), d.truth(false)),
            };
            outputs = outputs
                .vector("bounce_org", org)
                .vector("bounce_dir", dir)
                .vector("bounce_throughput", throughput)
                .real("bounce_pdf", pdf)
                .word("bounce_state", state)
                .truth("bounce_active", active);
            if self.has_rivals() {
                outputs = outputs.real("bounce_rivals", rivals);
            }
        }
        outputs
    }

    /// What rays that hit nothing see; nothing where the tracer sees nothing.
    fn miss(self) -> Option<Recorded> {
        let tape = Tape::new();
        let d = Record::new(&tape);
        let path = self.path(&tape);
        let scene = Interpreted::<Record<'_>>::new(self.structure, &Buffers::EMPTY);
        let tracer = scene.tracer(self.settings(&tape));
        let mut outputs = Outputs::new();
        if let Some(seen) = tracer.on_miss(d, &path, scene.lights()) {
            outputs = outputs.vector("seen", seen);
        }
        let set = tracer.layers();
        if set != Layers::NONE {
            outputs = layers(outputs, &Features::of_miss(d, set, &path), set);
        }
        (!outputs.is_empty()).then(|| Recorded {
            function: tape.function(self.name("miss"), outputs),
            result: self.result("Miss", "LightMiss"),
            comment: "What a path sees whose ray hits nothing.".to_owned(),
        })
    }

    /// Where paths begin.
    fn emit(self) -> Recorded {
        let tape = Tape::new();
        let d = Record::new(&tape);
        let pixel = ["x", "y"].map(|name| tape.word(name));
        let sample = tape.word("sample");
        let scene = Interpreted::<Record<'_>>::new(self.structure, &Buffers::EMPTY);
        let tracer = scene.tracer(Settings {
            image: ["width", "height"].map(|name| tape.real(name)),
            seed: tape.word("seed"),
            max_depth: d.uint(0),
            roulette_from: d.uint(0),
            reach: d.lit(0.0),
            origin: self.origin,
        });
        let path = tracer.on_emit(d, scene.camera(), scene.lights(), pixel, sample);
        let mut outputs = Outputs::new()
            .vector("org", path.ray.org)
            .vector("dir", path.ray.dir)
            .word("pixel", path.key.pixel);
        if self.has_rivals() {
            outputs = outputs
                .word("index", path.key.index)
                .vector("throughput", path.throughput)
                .real("pdf", path.pdf)
                .real("rivals", path.rivals);
        }
        if self.structure.between.media.is_some() {
            outputs = outputs.word("state", path.state.0);
        }
        let Structure {
            camera, sampler, ..
        } = self.structure;
        let comment = match self.origin {
            PathOrigin::Camera => format!(
                "{camera:?}, {sampler:?}: a path of throughput 1 through a place of the pixel at (x, y)."
            ),
            PathOrigin::Lights => format!(
                "{sampler:?}: a path from a light; of as many in an image as there are pixels, the one with the number of this."
            ),
        };
        Recorded {
            function: tape.function(self.name("emit"), outputs),
            result: self.result("CameraPath", "LightPath"),
            comment,
        }
    }
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
