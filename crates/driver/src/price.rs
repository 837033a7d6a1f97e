//! The price list: what each effect of a scene costs in time, and what the image would be without it.
//!
//! The scene is rendered as it is and without each effect in turn, round by round, each round with random numbers of its
//! own that all variants share: so only what an effect changes differs. Effects that are out and that other paths would
//! have to ask about (alpha, kinds of lights) are put in, without use, and must not change the image.

use anyhow::{Context, Result};
use residual_accuracy::{Estimate, Jackknifed, flip, relative_mse};
use residual_device_cpu::plugin::LoadedRenderer;
use residual_device_cpu::{CpuDevice, Interpreter, LaneCount, TileRenderer, Width};
use residual_frontend::process_time;
use residual_render::passes::RenderOptions;
use residual_render::program::{AlphaTestNode, BsdfNode, LightNode, Program, ScalarNode};
use residual_render::surface::Attributes;
use residual_scenegen::ablation::{instead, without};
use residual_scenegen::desc::{SceneDesc, Warning, WarningKind};
use residual_scenegen::effects::{Effect, Effects};
use residual_scenegen::plan::{Plan, PlanOptions, plan};

use crate::compile::compile;
use crate::poses::Poses;

/// One line of the price list.
#[derive(Clone, Debug)]
pub struct Price {
    /// The effect.
    pub effect: Effect,
    /// What was rendered instead.
    pub instead: &'static str,
    /// Whether the scene calls for it.
    pub is_in: bool,
    /// The part of the rendering time that goes into it: 1 − time without / time with. For an effect that is out, the part
    /// that compiling it in would add.
    pub time: Estimate,
    /// Difference of the images: mean ꟻLIP.
    pub flip: Jackknifed,
    /// Difference of the images: relative mean squared error.
    pub relmse: Jackknifed,
}

/// How prices are measured.
#[derive(Clone, Copy, Debug)]
pub struct PriceOptions {
    /// Measured rounds, at least one; a round before them, which warms caches, does not count.
    pub rounds: u32,
    /// Samples per pixel in a round.
    pub samples: u32,
    /// How the renderers are made.
    pub tier: PricedTier,
}

/// How the renderers are made that are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PricedTier {
    /// Without a compiler.
    Interpreted,
    /// Compiled, each before the first round.
    Specialized,
}

/// What has been done on the way to a price list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// The next renderer is about to be compiled.
    Compiling {
        /// Which one, from 1.
        renderer: usize,
        /// Of how many.
        renderers: usize,
    },
    /// A round has been measured.
    Measured {
        /// Which one; 0 does not count.
        round: u32,
        /// Of how many.
        rounds: u32,
        /// Renders of a round.
        renders: usize,
    },
}

/// A scene that is rendered.
struct Variant {
    effect: Option<Effect>,
    /// Whether the scene calls for the effect.
    is_in: bool,
    instead: &'static str,
    plan: Plan,
    renderer: Renderer,
}

/// What came of its renders.
#[derive(Default)]
struct Renders {
    /// CPU seconds, round by round.
    seconds: Vec<f64>,
    images: Vec<Vec<[f32; 3]>>,
}

enum Renderer {
    Interpreted(Interpreter),
    Compiled(LoadedRenderer),
}

impl Renderer {
    fn get(&self) -> &dyn TileRenderer {
        match self {
            Self::Interpreted(renderer) => renderer,
            Self::Compiled(renderer) => renderer,
        }
    }
}

/// Measures all effects for which that makes sense; the dearest first. `with` is the plan of the scene with these options.
/// `report` is called after each step.
///
/// # Errors
/// If a renderer cannot be compiled, or threads cannot be started.
pub fn prices(
    with: &Plan,
    scene: &SceneDesc,
    options: &PlanOptions,
    measurement: &PriceOptions,
    mut report: impl FnMut(Step),
) -> Result<Vec<Price>> {
    let variants = variants(with, scene, options, measurement.tier, &mut report)?;
    let poses = variants.iter().map(|variant| {
        let poses = Poses::new(&variant.plan, Width::Native, 0);
        poses.build_ahead();
        poses
    });
    let poses: Vec<_> = poses.collect();
    let mut renders: Vec<_> = variants.iter().map(|_| Renders::default()).collect();
    let device = CpuDevice::new(0).context("starting threads")?;
    let count = variants.len();
    for round in 0..=measurement.rounds {
        for turn in 0..count {
            let index = (round as usize + turn) % count;
            let job = RenderOptions {
                size: options.size,
                samples: Some(measurement.samples),
                time: None,
                max_depth: 8,
                seed: round,
                ..RenderOptions::default()
            };
            let before = process_time();
            let film = poses[index].render(&device, variants[index].renderer.get(), &job);
            let used = process_time() - before;
            // The first round warms caches.
            if round > 0 {
                renders[index].seconds.push(used.as_secs_f64());
                renders[index].images.push(film.image());
            }
        }
        report(Step::Measured {
            round,
            rounds: measurement.rounds,
            renders: count,
        });
    }
    let of_variants = variants.iter().zip(&renders);
    let width = options.size[0] as usize;
    let prices = of_variants
        .skip(1)
        .map(|(other, of_other)| price(&renders[0], other, of_other, width));
    let mut prices: Vec<_> = prices.collect();
    prices.sort_by(|a, b| b.time.median.total_cmp(&a.time.median));
    Ok(prices)
}

/// The scene as it is, and what it is compared with.
fn variants(
    with: &Plan,
    scene: &SceneDesc,
    options: &PlanOptions,
    tier: PricedTier,
    report: &mut impl FnMut(Step),
) -> Result<Vec<Variant>> {
    let effects = Effects::of(with);
    let mut plans = vec![(None, true, "", with.clone())];
    for &effect in Effect::ALL {
        let Some(how) = instead(effect) else { continue };
        if effects.has(effect) {
            let changed = without(effect, scene, options);
            let (scene, options) = changed.expect("there is something instead");
            let plan = plan(&scene, &options)?;
            // Without its last light a scene gets a sky, and is another scene.
            let lacks_light = |warning: &Warning| warning.kind == WarningKind::NoLight;
            let dark = is_light(effect) && plan.warnings.iter().any(lacks_light);
            if !dark {
                plans.push((Some(effect), true, how, plan));
            }
        } else if let Some(plan) = with_unused(effect, with) {
            plans.push((Some(effect), false, "compiled in, without use", plan));
        }
    }
    let count = plans.len();
    let built = plans
        .into_iter()
        .enumerate()
        .map(|(index, (effect, is_in, instead, plan))| {
            let lanes = LaneCount::native();
            let renderer = match tier {
                PricedTier::Interpreted => {
                    Renderer::Interpreted(Interpreter::new(plan.structure.clone()))
                }
                PricedTier::Specialized => {
                    report(Step::Compiling {
                        renderer: index + 1,
                        renderers: count,
                    });
                    Renderer::Compiled(compile(&plan, lanes)?)
                }
            };
            Ok(Variant {
                effect,
                is_in,
                instead,
                plan,
                renderer,
            })
        });
    built.collect()
}

fn is_light(effect: Effect) -> bool {
    matches!(
        effect,
        Effect::EmittingSurfaces
            | Effect::PointLights
            | Effect::SpotLights
            | Effect::DirectionalLights
            | Effect::Environment
    )
}

/// The plan with an effect compiled in that nothing in the scene uses; `None` where that costs nothing, because no path
/// would come by: materials are programs of their own.
fn with_unused(effect: Effect, plan: &Plan) -> Option<Plan> {
    let mut structure = plan.structure.clone();
    match effect {
        Effect::AlphaBlending => structure.programs.push(Program {
            attributes: Attributes::NONE,
            inputs: Vec::new(),
            normal: None,
            tangent: None,
            interior: None,
            emission: None,
            bsdf: BsdfNode::Black,
            alpha_test: Some(AlphaTestNode::AlphaBlend {
                alpha: ScalarNode::Const(0.5),
                attributes: Attributes::NONE,
            }),
        }),
        Effect::PointLights => structure.lights.push(LightNode::Point),
        Effect::SpotLights => structure.lights.push(LightNode::Spot),
        Effect::DirectionalLights => structure.lights.push(LightNode::Directional),
        _ => return None,
    }
    let mut plan = Plan {
        structure,
        ..plan.clone()
    };
    plan.materials
        .resize(plan.structure.programs.len(), Vec::new());
    let kinds = plan.structure.lights.len();
    plan.lights.resize(kinds, Default::default());
    Some(plan)
}

fn price(with: &Renders, variant: &Variant, other: &Renders, width: usize) -> Price {
    let effect = variant.effect.expect("not the scene as it is");
    let is_in = variant.is_in;
    let saved = with.seconds.iter().zip(&other.seconds);
    let saved = saved.map(|(with, other)| match is_in {
        true => 1.0 - other / with,
        false => other / with - 1.0,
    });
    let rounds = with.images.len();
    let difference = |metric: &dyn Fn(&[[f32; 3]], &[[f32; 3]]) -> f64| {
        Jackknifed::of(rounds, |used| {
            let (reference, test) = (mean(&with.images, used), mean(&other.images, used));
            metric(&reference, &test)
        })
    };
    Price {
        effect,
        instead: variant.instead,
        is_in,
        time: Estimate::of(saved.collect()),
        flip: difference(&|a, b| flip(a, b, width)),
        relmse: difference(&relative_mse),
    }
}

/// The mean of some of the images.
fn mean(images: &[Vec<[f32; 3]>], used: &dyn Fn(usize) -> bool) -> Vec<[f32; 3]> {
    let used: Vec<_> = (0..images.len()).filter(|k| used(*k)).collect();
    let pixel = |p: usize| {
        [0, 1, 2].map(|c| {
            let sum: f64 = used.iter().map(|&k| f64::from(images[k][p][c])).sum();
            (sum / used.len() as f64) as f32
        })
    };
    (0..images[0].len()).map(pixel).collect()
}
