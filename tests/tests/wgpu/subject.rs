//! Something to render, on either device.

use std::path::Path;

use residual_bvh::BuildQuality;
use residual_device_cpu::{AnyBvh, LaneCount, Width};
use residual_device_wgpu::{Dialect, Mapping, WgpuRenderer};
use residual_render::film::{Film, SampleSet, TILE_SIZE};
use residual_render::passes::{MAX_PASS, Pass, RenderOptions};
use residual_render::tracer::{AnySharing, TracerNode};
use residual_scenegen::desc::{MaterialDesc, Projection, SceneDesc};
use residual_scenegen::plan::{Plan, PlanOptions, plan};
use residual_tests::fixtures::{Builder, color, material, matte, sheet};
use residual_tests::pictures::first_difference;
use residual_tests::{Look, Prepared, read_scene, scene_files, scenes};

use crate::Machine;

/// Tiny scenes that between them have what tracers and layers ask about: alpha and lamps, misses that see something, many
/// programs and media. Which materials there are shows in no tracer (and `reads.rs` has scenes of many).
pub(crate) const SCENES_OF_LAYERS: [&str; 3] = ["masked_emission", "environment", "drink"];

/// A closed chamber, white but for its lamp: paths go on for long, and most of their vertices are lit and seen. There are only two
/// programs to compile.
pub(crate) fn chamber() -> SceneDesc {
    let mut b = Builder::new("chamber");
    let walls = [-1.0, 1.0].into_iter().flat_map(|at: f32| {
        let across = -2.0 * at;
        let [x, y, z] = [[across, 0.0, 0.0], [0.0, across, 0.0], [0.0, 0.0, across]];
        [(x, y), (y, z), (z, x)].map(|(u, v)| sheet([at; 3], u, v))
    });
    b.add(material("white", matte([0.9; 3])), walls);
    let lamp = MaterialDesc {
        emission: color([5.0, 4.0, 3.0]),
        ..material("lamp", matte([0.0; 3]))
    };
    b.add(
        lamp,
        [sheet([-0.3, 0.9, -0.3], [0.6, 0.0, 0.0], [0.0, 0.0, 0.6])],
    );
    let projection = Projection::Perspective { yfov: 1.2 };
    b.camera("inside", [0.1, 0.2, 0.9], [0.0, 0.0, -1.0], projection);
    b.finish()
}

/// A plan with the hierarchy that GPUs traverse.
pub(crate) struct Subject {
    pub(crate) plan: Plan,
    pub(crate) bvh: AnyBvh,
}

impl Subject {
    pub(crate) fn new(plan: Plan) -> Self {
        let bvh = AnyBvh::build(&plan.data, Width::Four, BuildQuality::Fast);
        Self { plan, bvh }
    }

    /// A scene, planned for an image of this size.
    pub(crate) fn of(scene: &SceneDesc, options: &PlanOptions) -> Self {
        Self::new(plan(scene, options).unwrap_or_else(|error| panic!("{}: {error}", scene.name)))
    }

    /// A scene with paths from both ends.
    pub(crate) fn from_both_ends(scene: &SceneDesc, options: &PlanOptions) -> Self {
        let options = PlanOptions {
            tracer: TracerNode::Bidirectional(AnySharing::Combined),
            ..options.clone()
        };
        Self::of(scene, &options)
    }

    pub(crate) fn on_cpu(&self, look: &Look) -> Film {
        Prepared::new(&self.plan, LaneCount::native()).interpret(look)
    }

    pub(crate) fn renderer(
        &self,
        machine: &'static Machine,
        dialect: Dialect,
        mapping: Mapping,
        size: [u32; 2],
    ) -> WgpuRenderer<'static> {
        let bvh = self.bvh.four_wide().expect("four children a node");
        let Plan {
            structure, data, ..
        } = &self.plan;
        WgpuRenderer::new(&machine.gpu, dialect, mapping, structure, data, bvh, size)
            .unwrap_or_else(|error| panic!("{}: {error}", self.plan.name))
    }

    /// Rendered in the dialect that the probe has chosen.
    pub(crate) fn on_gpu(&self, machine: &'static Machine, mapping: Mapping, look: &Look) -> Film {
        let renderer = self.renderer(machine, machine.probe.dialect, mapping, look.size);
        self.passes(&renderer, look, &[look.samples])
    }

    /// Samples in groups, each of as many passes as it takes.
    pub(crate) fn passes(&self, renderer: &WgpuRenderer<'_>, look: &Look, groups: &[u32]) -> Film {
        let [width, height] = look.size;
        let mut film = Film::new(width, height, TILE_SIZE, self.plan.structure.layers);
        let options = RenderOptions {
            size: look.size,
            max_depth: look.max_depth,
            seed: look.seed,
            reach: look.reach,
            ..RenderOptions::default()
        };
        let mut first = 0;
        for &group in groups {
            let end = first + group;
            while first < end {
                let count = MAX_PASS.min(end - first);
                renderer
                    .pass(
                        film.tiles_mut(),
                        Pass { first, count },
                        &options.tracer(SampleSet::First),
                    )
                    .unwrap_or_else(|error| panic!("{}: {error}", self.plan.name));
                first += count;
            }
        }
        film
    }

    /// Fails unless the GPU's samples have the processor's bits: radiance, its spread, and all layers.
    #[track_caller]
    pub(crate) fn agrees(&self, machine: &'static Machine, mapping: Mapping, look: &Look) {
        let (cpu, gpu) = (self.on_cpu(look), self.on_gpu(machine, mapping, look));
        let difference = difference(&cpu, &gpu);
        assert_eq!(difference, None, "{}, {mapping}, {look:?}", self.plan.name);
    }
}

/// Files that are larger make tests wait for importers, scenes of more triangles for hierarchies.
const LARGEST: u64 = 20 << 20;
const MOST_TRIANGLES: usize = 1_500_000;

/// A file's scene; under a sky, if it would be dark.
///
/// # Errors
/// With the reason why it is not rendered.
fn subject_of(file: &Path, sky: &Path, size: [u32; 2]) -> Result<Subject, String> {
    if file.metadata().expect("a file").len() > LARGEST {
        return Err("the file is large".to_owned());
    }
    let planned = |environment| {
        let scene = read_scene(file, environment).map_err(|error| error.to_string())?;
        let options = PlanOptions {
            size,
            ..PlanOptions::default()
        };
        plan(&scene, &options).map_err(|error| error.to_string())
    };
    let mut of_file = planned(None)?;
    if of_file.structure.lights.is_empty() {
        of_file = planned(Some(sky.to_owned()))?;
    }
    match of_file.data.triangle_count() {
        count if count > MOST_TRIANGLES => Err(format!("{count} triangles")),
        _ => Ok(Subject::new(of_file)),
    }
}

/// Does something with every `step`-th shared scene of a folder, of which there are to be some.
pub(crate) fn for_each_shared(
    folder: &str,
    at_least: usize,
    step: usize,
    size: [u32; 2],
    mut check: impl FnMut(Subject),
) {
    let Some(scenes) = scenes() else {
        return;
    };
    let sky = scenes.join("env/sky.hdr");
    let mut checked = 0;
    for file in scene_files(&scenes.join(folder)).into_iter().step_by(step) {
        match subject_of(&file, &sky, size) {
            Ok(subject) => {
                check(subject);
                checked += 1;
            }
            Err(reason) => println!("skipped: {}: {reason}", file.display()),
        }
    }
    assert!(checked * step >= at_least, "{checked} scenes in {folder}");
}

/// How the samples of two films differ; `None` if they are the same in all that is kept of them.
#[must_use]
pub(crate) fn difference(a: &Film, b: &Film) -> Option<String> {
    if a.tiles() == b.tiles() {
        return None;
    }
    let layer = a.layers().iter().find(|layer| {
        let channels = 0..layer.channels().len();
        channels
            .into_iter()
            .any(|channel| a.channel(*layer, channel) != b.channel(*layer, channel))
    });
    let picture = first_difference(&a.image(), &b.image());
    picture
        .or(layer.map(|layer| format!("layer {layer}")))
        .or(Some("the spread of samples".to_owned()))
}

/// The comparison fails where it should.
#[test]
fn films_of_other_samples_differ() {
    let film = |value: f32| {
        let mut film = Film::new(2, 1, TILE_SIZE, residual_render::layer::Layers::NONE);
        film.tiles_mut()[0].add(&[value; 6]);
        film
    };
    assert_eq!(difference(&film(0.5), &film(0.5)), None);
    assert!(difference(&film(0.5), &film(0.5_f32.next_up())).is_some());
}
