//! Shading alone, per kind of program: specialised and interpreted, with constants and with textures (thesis, Figure 3.4),
//! and with each interface specialised by itself (Figure 3.5).
//!
//! What runs is the device's own loop over a tile, on a traversal that answers at once with hits laid out beforehand
//! ([`stream`]). The shading stage then is what it is in a render: hits to surfaces, inputs, a light sample with the
//! evaluation of the BSDF towards it, a BSDF sample, compaction. Paths end by Russian roulette, and camera rays take their
//! places, so that the stream stays full.

pub mod interfaces;
pub mod kinds;
pub mod stream;
pub mod table;

use std::collections::BTreeMap;
use std::time::Instant;

use residual_accuracy::Estimate;
use residual_device_cpu::{LaneCount, SceneView, TileJob, TileRenderer};
use residual_render::film::{Pass, SampleSet, TileRect, TileSamples};
use residual_render::layer::Layers;
use residual_render::program::{CameraNode, LightNode, Structure};
use residual_render::sampler::AnySampler;
use residual_render::scene_data::SceneData;
use residual_render::tracer::{Between, PathOrigin, TracerNode, TracerOptions};
use residual_scenegen::plan::{Binding, LightKindUse, LightPicks, MaterialUse, Plan};
use residual_variants::AnyLanes;
use serde_json::{Value, json};

use self::interfaces::{CasesRenderer, Known};
use self::kinds::{Inputs, Kind};
use self::stream::Hits;
use crate::measure::thread_time;

/// The job: the side of its tile is the root of the hits' number.
const SIDE: u32 = 64;
const SAMPLES: u32 = 2;

/// All programs, in the order of the plan.
fn programs() -> impl Iterator<Item = (Kind, Inputs)> {
    let both = |kind| [(kind, Inputs::Constants), (kind, Inputs::Textures)];
    Kind::ALL.into_iter().flat_map(both)
}

/// The scene that is to be compiled for each lane count: all programs.
pub fn plan() -> Plan {
    let (nodes, params): (Vec<_>, Vec<_>) = programs()
        .map(|(kind, inputs)| kind.program(inputs))
        .unzip();
    let uses = |(kind, inputs)| {
        vec![MaterialUse {
            name: format!("{kind}, {inputs}"),
            images: BTreeMap::new(),
            culled: false,
            absorbs: false,
            scatters: false,
            body: false,
        }]
    };
    Plan {
        light_picks: LightPicks::default(),
        name: "shading".to_owned(),
        binding: Binding::default(),
        structure: Structure {
            programs: nodes,
            lights: vec![LightNode::Point],
            light_tree: None,
            camera: CameraNode::Perspective,
            sampler: AnySampler::Sobol,
            tracer: TracerNode::default(),
            between: Between::default(),
            layers: Layers::NONE,
        },
        data: stream::data(&params),
        motion: None,
        materials: programs().map(uses).collect(),
        objects: Vec::new(),
        lights: vec![LightKindUse {
            count: 2,
            sources: Vec::new(),
        }],
        camera_name: "camera".to_owned(),
        diagonal: 6.0,
        depth: 6.0,
        warnings: Vec::new(),
        dismissed: Vec::new(),
    }
}

/// What shading one program with one lane count takes.
#[derive(Clone, Debug)]
pub struct KindRow {
    /// The program.
    pub kind: Kind,
    /// Its inputs.
    pub inputs: Inputs,
    /// Paths shaded at once.
    pub lanes: u32,
    /// Nanoseconds a hit, compiled.
    pub specialized_ns: Estimate,
    /// Nanoseconds a hit, interpreted.
    pub interpreted_ns: Estimate,
    /// The second over the first, round by round.
    pub interpreted_over_specialized: Estimate,
    /// This over the same program with constants, compiled, round by round.
    pub over_constants: Estimate,
}

/// What shading a textured coat takes where the compiler knows this much of it.
#[derive(Clone, Debug)]
pub struct InterfaceRow {
    /// What it knows.
    pub known: Known,
    /// Paths shaded at once.
    pub lanes: u32,
    /// Nanoseconds a hit.
    pub ns: Estimate,
    /// This over the case in which everything is known, round by round.
    pub over_known: Estimate,
}

/// Measures all programs of [`plan`] with its compiled renderers, and interpreted; and the interfaces.
///
/// # Panics
/// Without rounds.
pub fn shading(
    plan: &Plan,
    compiled: &[(LaneCount, &dyn TileRenderer)],
    rounds: usize,
) -> (Vec<KindRow>, Vec<InterfaceRow>) {
    let renderers: Vec<_> = compiled
        .iter()
        .map(|&(lanes, specialized)| Renderers {
            lanes,
            specialized,
            interpreter: AnyLanes::new(plan.structure.clone(), lanes),
            cases: CasesRenderer::new(lanes),
        })
        .collect();
    let coat = Kind::Coat.program(Inputs::Textures).1;
    let coats = stream::data(&Known::ALL.map(|_| coat.clone()));
    let mut contenders = Vec::new();
    for renderers in &renderers {
        for program in 0..plan.structure.programs.len() {
            contenders.push(Contender::new(renderers.specialized, &plan.data, program));
            contenders.push(Contender::new(&renderers.interpreter, &plan.data, program));
        }
        for program in 0..Known::ALL.len() {
            contenders.push(Contender::new(&renderers.cases, &coats, program));
        }
    }
    let mut times = interleaved(&mut contenders, rounds).into_iter();
    let mut next = || times.next().expect("each contender has its times");

    let (mut kinds, mut interfaces) = (Vec::new(), Vec::new());
    for lanes in renderers.iter().map(|renderers| renderers.lanes.count()) {
        let mut constants = Vec::new();
        for (kind, inputs) in programs() {
            let (specialized, interpreted) = (next(), next());
            if inputs == Inputs::Constants {
                constants.clone_from(&specialized);
            }
            kinds.push(KindRow {
                kind,
                inputs,
                lanes,
                interpreted_over_specialized: ratio(&interpreted, &specialized),
                over_constants: ratio(&specialized, &constants),
                specialized_ns: Estimate::of(specialized),
                interpreted_ns: Estimate::of(interpreted),
            });
        }
        let cases = Known::ALL.map(|known| (known, next()));
        let all_known = &cases[0].1;
        interfaces.extend(cases.iter().map(|(known, ns)| InterfaceRow {
            known: *known,
            lanes,
            ns: Estimate::of(ns.clone()),
            over_known: ratio(ns, all_known),
        }));
    }
    (kinds, interfaces)
}

/// What renders with one lane count.
struct Renderers<'a> {
    lanes: LaneCount,
    specialized: &'a dyn TileRenderer,
    interpreter: AnyLanes,
    cases: CasesRenderer,
}

/// One program, shaded by one renderer.
struct Contender<'a> {
    renderer: &'a dyn TileRenderer,
    data: &'a SceneData,
    hits: Hits,
}

impl<'a> Contender<'a> {
    fn new(renderer: &'a dyn TileRenderer, data: &'a SceneData, program: usize) -> Self {
        Self {
            renderer,
            data,
            hits: Hits::on(program),
        }
    }

    /// Nanoseconds of the shading stage a hit. Stages are timed by the clock on the wall; what other processes had of it is
    /// taken out evenly.
    fn run(&self, radiance: &mut [f32]) -> f64 {
        let tile = TileSamples {
            rect: TileRect {
                x: 0,
                y: 0,
                width: SIDE,
                height: SIDE,
            },
            pass: Pass {
                first: 0,
                count: SAMPLES,
            },
        };
        let job = TileJob {
            tiles: &[tile],
            set: SampleSet::First,
            tracer: TracerOptions {
                image: [SIDE, SIDE],
                seed: 0,
                max_depth: u32::MAX,
                roulette_from: 5,
                reach: f32::MAX,
                origin: PathOrigin::Camera,
            },
        };
        let view = SceneView {
            buffers: self.data.buffers(),
            traversal: &self.hits,
        };
        let (wall, used) = (Instant::now(), thread_time());
        let counters = self.renderer.render_tiles(&view, &job, radiance);
        let share = (thread_time() - used).as_secs_f64() / wall.elapsed().as_secs_f64();
        let hits = counters.camera_rays + counters.bounce_rays;
        counters.shade * share / hits as f64 * 1e9
    }
}

/// Runs all contenders once a round, each time beginning with another one; a first round, which warms caches, does not
/// count. Returns each contender's times (outer) by round (inner).
fn interleaved(contenders: &mut [Contender<'_>], rounds: usize) -> Vec<Vec<f64>> {
    let count = contenders.len();
    let mut radiance = vec![0.0; (SIDE * SIDE * SAMPLES * 3) as usize];
    let mut times = vec![Vec::with_capacity(rounds); count];
    for round in 0..=rounds {
        for turn in 0..count {
            let index = (round + turn) % count;
            let time = contenders[index].run(&mut radiance);
            if round > 0 {
                times[index].push(time);
            }
        }
    }
    times
}

fn ratio(times: &[f64], others: &[f64]) -> Estimate {
    Estimate::of(times.iter().zip(others).map(|(a, b)| a / b).collect())
}

impl KindRow {
    /// As one JSON object.
    pub fn to_json(&self) -> Value {
        json!({
            "kind": "shading",
            "program": self.kind.to_string(),
            "inputs": self.inputs.to_string(),
            "lanes": self.lanes,
            "specialized_ns": self.specialized_ns.median,
            "specialized_ns_ci95": self.specialized_ns.interval,
            "interpreted_ns": self.interpreted_ns.median,
            "interpreted_ns_ci95": self.interpreted_ns.interval,
            "interpreted_over_specialized": self.interpreted_over_specialized.median,
            "interpreted_over_specialized_ci95": self.interpreted_over_specialized.interval,
            "over_constants": self.over_constants.median,
            "over_constants_ci95": self.over_constants.interval,
        })
    }
}

impl InterfaceRow {
    /// As one JSON object.
    pub fn to_json(&self) -> Value {
        json!({
            "kind": "interfaces",
            "textures_known": self.known.textures,
            "attributes_known": self.known.attributes,
            "lanes": self.lanes,
            "ns": self.ns.median,
            "ns_ci95": self.ns.interval,
            "over_known": self.over_known.median,
            "over_known_ci95": self.over_known.interval,
        })
    }
}
