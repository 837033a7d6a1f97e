//! The configurations that are compared: each is the renderer as it is, with one thing switched.
//!
//! A row of [`CONFIGURATIONS`] is all that it takes to measure another one. [`SWITCHES`] says which pairs of them are the two sides of
//! a choice between time and truth.

use residual_device_cpu::LaneCount;
use residual_render::film::Sampling;
use residual_render::passes::RenderOptions;
use residual_render::sampler::AnySampler;
use residual_render::tracer::{AnyMis, TracerNode};
use residual_scenegen::plan::{Binding, LightPicks, PlanOptions};
use residual_variants::TraversalPrecision;

/// All that a configuration may change.
#[derive(Clone, Debug)]
pub struct Setup {
    /// How the scene is planned.
    pub plan: PlanOptions,
    /// How it is rendered.
    pub render: RenderOptions,
    /// How exactly rays meet triangles.
    pub precision: TraversalPrecision,
    /// Compiled or not.
    pub tier: Tier,
    /// Paths shaded at once.
    pub lanes: LaneCount,
    /// No sample is brighter than so many times the mean of the image.
    pub clamp: Option<f64>,
}

impl Setup {
    /// Weighs light in this way.
    pub fn mis(&mut self, mis: AnyMis) {
        self.plan.tracer = TracerNode::Path(mis);
    }

    /// Whether it renders the same in the same way.
    pub fn is_as(&self, other: &Self) -> bool {
        format!("{self:?}") == format!("{other:?}")
    }
}

/// How the renderer is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tier {
    /// Without a compiler.
    Interpreted,
    /// Compiled for the scene.
    Specialized,
}

/// What is switched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Nothing: what all others are compared with.
    Baseline,
    /// How exactly rays meet triangles.
    Traversal,
    /// Where random numbers come from.
    Sampler,
    /// How samples are spread over the image.
    Sampling,
    /// How light is weighed that lights and BSDFs find.
    Mis,
    /// How often each light is picked.
    LightPicks,
    /// Where paths may end by chance.
    Roulette,
    /// How long paths may be.
    Depth,
    /// Bright samples cut off.
    Clamping,
    /// How the renderer is made from the scene.
    Execution,
}

impl Axis {
    /// All but the baseline.
    pub const SWITCHED: [Self; 9] = [
        Self::Traversal,
        Self::Sampler,
        Self::Sampling,
        Self::Mis,
        Self::LightPicks,
        Self::Roulette,
        Self::Depth,
        Self::Clamping,
        Self::Execution,
    ];

    /// What people call it.
    pub fn title(self) -> &'static str {
        match self {
            Self::Baseline => "As rendered by default",
            Self::Traversal => "Precision of traversal",
            Self::Sampler => "Sampler",
            Self::Sampling => "Where samples are spent",
            Self::Mis => "Multiple importance sampling",
            Self::LightPicks => "Light sampling",
            Self::Roulette => "Russian roulette",
            Self::Depth => "Length of paths",
            Self::Clamping => "Clamping",
            Self::Execution => "Specialisation and lanes",
        }
    }

    /// Whether images converge to the same as the baseline's, so that they have its bias.
    pub fn keeps_limit(self) -> bool {
        match self {
            Self::Baseline
            | Self::Traversal
            | Self::Sampler
            | Self::Sampling
            | Self::Mis
            | Self::LightPicks
            | Self::Roulette
            | Self::Execution => true,
            Self::Depth | Self::Clamping => false,
        }
    }
}

/// Whether a study of two minutes measures it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// Every study does.
    Quick,
    /// Only the full one.
    Full,
}

/// A way to render the scene.
#[derive(Clone, Copy, Debug)]
pub struct Configuration {
    /// Its name, also of files.
    pub name: &'static str,
    /// What is switched.
    pub axis: Axis,
    /// What it is, for people.
    pub what: &'static str,
    /// In which studies.
    pub extent: Extent,
    /// What it changes.
    pub change: fn(&mut Setup),
}

/// The name of the baseline.
pub const BASELINE: &str = "default";

const fn row(
    name: &'static str,
    axis: Axis,
    what: &'static str,
    extent: Extent,
    change: fn(&mut Setup),
) -> Configuration {
    Configuration {
        name,
        axis,
        what,
        extent,
        change,
    }
}

/// All of them, the baseline first.
#[rustfmt::skip]
pub const CONFIGURATIONS: &[Configuration] = {
    use Axis::{
        Baseline, Clamping, Depth, Execution, LightPicks as Picks, Mis, Roulette, Sampler, Sampling as Spread,
        Traversal,
    };
    use Extent::{Full, Quick};
    &[
        row(BASELINE, Baseline, "watertight, Sobol, 8 vertices", Quick, |_| {}),
        row("fast", Traversal, "Möller–Trumbore in f32", Quick, |s| s.precision = TraversalPrecision::Fast),
        row("exact", Traversal, "decisions as in exact arithmetic", Quick, |s| s.precision = TraversalPrecision::Exact),
        row("independent", Sampler, "independent random numbers", Quick, |s| s.plan.sampler = AnySampler::Independent),
        row("adaptive", Spread, "more samples where it is noisy", Quick, |s| s.render.sampling = Sampling::Adaptive),
        row("balance", Mis, "balance heuristic, not power", Full, |s| s.mis(AnyMis::BalanceHeuristic)),
        row("lights-only", Mis, "lights are sampled, not found", Quick, |s| s.mis(AnyMis::LightsOnly)),
        row("bsdf-only", Mis, "lights are found, not sampled", Quick, |s| s.mis(AnyMis::BsdfOnly)),
        row("by-power", Picks, "lights are picked by power", Quick, |s| s.plan.light_picks = LightPicks::Power),
        row("evenly", Picks, "each light as often as any other", Full, |s| s.plan.light_picks = LightPicks::Uniform),
        row("roulette-5", Roulette, "from the 5th vertex, not the 2nd", Full, |s| s.render.roulette_from = 5),
        row("no-roulette", Roulette, "all paths go on to their 8th vertex", Quick, |s| s.render.roulette_from = u32::MAX),
        row("depth-2", Depth, "2 vertices: direct light", Quick, |s| s.render.max_depth = 2),
        row("depth-4", Depth, "4 vertices", Quick, |s| s.render.max_depth = 4),
        row("depth-16", Depth, "16 vertices", Quick, |s| s.render.max_depth = 16),
        row("depth-64", Depth, "64 vertices", Full, |s| s.render.max_depth = 64),
        row("clamp-2", Clamping, "samples cut at 2 × the mean", Full, |s| s.clamp = Some(2.0)),
        row("clamp-10", Clamping, "samples cut at 10 × the mean", Quick, |s| s.clamp = Some(10.0)),
        row("clamp-100", Clamping, "samples cut at 100 × the mean", Full, |s| s.clamp = Some(100.0)),
        row("interpreted", Execution, "not compiled", Quick, |s| s.tier = Tier::Interpreted),
        row("constants", Execution, "all numbers known to the compiler", Full, |s| s.plan.binding = Binding::Constants),
        row("lanes-1", Execution, "one path at a time", Full, |s| s.lanes = LaneCount::One),
        row("lanes-4", Execution, "four lanes", Full, |s| s.lanes = LaneCount::Four),
    ]
};

/// What a switch removes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Removes {
    /// Rays that pass between two triangles with a common edge.
    Misses(TraversalPrecision, TraversalPrecision),
    /// A difference between what images converge to and the truth.
    Bias,
    /// Sums of samples that no longer grow.
    Stagnation,
}

/// A choice between time and truth.
#[derive(Clone, Copy, Debug)]
pub struct Switch {
    /// What people call it.
    pub name: &'static str,
    /// The configuration with it off.
    pub without: &'static str,
    /// The configuration with it on.
    pub with: &'static str,
    /// What it is good for.
    pub removes: Removes,
}

const fn switch(
    name: &'static str,
    without: &'static str,
    with: &'static str,
    removes: Removes,
) -> Switch {
    Switch {
        name,
        without,
        with,
        removes,
    }
}

/// All of them.
pub const SWITCHES: &[Switch] = {
    use Removes::{Bias, Misses, Stagnation};
    use TraversalPrecision::{Exact, Fast, Watertight};
    &[
        switch(
            "watertight triangles",
            "fast",
            BASELINE,
            Misses(Fast, Watertight),
        ),
        switch(
            "exact triangles",
            BASELINE,
            "exact",
            Misses(Watertight, Exact),
        ),
        switch("sums in f64", BASELINE, BASELINE, Stagnation),
        switch("4 vertices, not 2", "depth-2", "depth-4", Bias),
        switch("8 vertices, not 4", "depth-4", BASELINE, Bias),
        switch("16 vertices, not 8", BASELINE, "depth-16", Bias),
        switch("64 vertices, not 16", "depth-16", "depth-64", Bias),
        switch("no clamping at 2 × mean", "clamp-2", BASELINE, Bias),
        switch("no clamping at 10 × mean", "clamp-10", BASELINE, Bias),
        switch("no clamping at 100 × mean", "clamp-100", BASELINE, Bias),
    ]
};

/// What people would look for and the engine cannot do, with the reason.
pub const NOT_MEASURED: &[(&str, &str)] = &[
    (
        "pixel filters",
        "pixels are boxes; there is no other filter",
    ),
    (
        "whole renders in f64",
        "formulas run in f64 in tests only, no device renders with it",
    ),
    (
        "CPU against wgpu",
        "samples have the same bits where an adapter's arithmetic is exact, and its time is another device's",
    ),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn switches_are_between_configurations() {
        for switch in SWITCHES {
            for name in [switch.without, switch.with] {
                let named = CONFIGURATIONS.iter().filter(|c| c.name == name);
                assert_eq!(named.count(), 1, "{name}");
            }
        }
        assert_eq!(CONFIGURATIONS[0].axis, Axis::Baseline);
        let switched = |c: &Configuration| Axis::SWITCHED.contains(&c.axis);
        assert!(CONFIGURATIONS[1..].iter().all(switched));
    }
}
