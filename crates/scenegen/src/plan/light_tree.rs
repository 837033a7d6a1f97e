//! Builds the tree of lights (Conty Estevez and Kulla 2018, section 4).
//!
//! A set of lights is split where the two halves shine least over the space around them: the sum of intensity times the square of the
//! box's diagonal times the solid angle into which the half shines. Splits are tried between equal bins of the centres along each axis.

use glam::DVec3;
use residual_render::light::{ClusterRecord, EVERYWHERE, LEAF, LightTree, set_light_tree};
use residual_render::scene_data::SceneData;

/// Where a light, or a set of them, stands, and how it shines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LightBounds {
    /// The box around it: two corners, world space.
    pub(super) corners: [DVec3; 2],
    /// The unit axis of the cone of directions in which it shines most; it shines up to a right angle beyond the cone.
    pub(super) axis: DVec3,
    /// Half-angle of the cone in radians.
    pub(super) half_angle: f64,
    /// Radiant intensity where it shines most.
    pub(super) intensity: f64,
}

impl LightBounds {
    /// Those of a light that shines everywhere from a point.
    pub(super) fn point(position: DVec3, intensity: f64) -> Self {
        Self {
            corners: [position; 2],
            axis: DVec3::Z,
            half_angle: std::f64::consts::PI,
            intensity,
        }
    }

    /// The middle of the box.
    pub(super) fn center(&self) -> DVec3 {
        0.5 * (self.corners[0] + self.corners[1])
    }

    /// The square of the box's diagonal.
    pub(super) fn diagonal2(&self) -> f64 {
        (self.corners[1] - self.corners[0]).length_squared()
    }

    /// The smallest bounds around both, but for the cone, which is around the larger of two cones.
    fn union(&self, other: &Self) -> Self {
        let (axis, half_angle) =
            cone_around((self.axis, self.half_angle), (other.axis, other.half_angle));
        Self {
            corners: [
                self.corners[0].min(other.corners[0]),
                self.corners[1].max(other.corners[1]),
            ],
            axis,
            half_angle,
            intensity: self.intensity + other.intensity,
        }
    }

    /// How much it shines over the space around it: what splits are compared by.
    fn cost(&self) -> f64 {
        use std::f64::consts::{FRAC_PI_2, PI};
        // The integral of the cosine beyond the cone, over the directions up to a right angle from it.
        let (cone, all) = (self.half_angle, (self.half_angle + FRAC_PI_2).min(PI));
        let (sin, cos) = cone.sin_cos();
        let beyond = 2.0 * all * sin - (cone - 2.0 * all).cos() - 2.0 * cone * sin + cos;
        let directions = 2.0 * PI * (1.0 - cos) + FRAC_PI_2 * beyond;
        self.intensity * self.diagonal2() * directions
    }

    fn record(&self, next: u32) -> ClusterRecord {
        let (sin, cos) = self.half_angle.sin_cos();
        ClusterRecord {
            center: self.center().as_vec3().to_array().into(),
            radius: (0.5 * self.diagonal2().sqrt()) as f32,
            axis: self.axis.as_vec3().to_array().into(),
            cos: cos as f32,
            sin: sin as f32,
            intensity: self.intensity as f32,
            next,
        }
    }
}

/// The smallest cone around two, each an axis and a half-angle.
fn cone_around(a: (DVec3, f64), b: (DVec3, f64)) -> (DVec3, f64) {
    use std::f64::consts::PI;
    let (wide, narrow) = if a.1 >= b.1 { (a, b) } else { (b, a) };
    if wide.1 >= PI {
        return wide;
    }
    let between = wide.0.dot(narrow.0).clamp(-1.0, 1.0).acos();
    if between + narrow.1 <= wide.1 {
        return wide;
    }
    let half_angle = 0.5 * (wide.1 + between + narrow.1);
    let across = wide.0.cross(narrow.0);
    match across.try_normalize() {
        Some(across) if half_angle < PI => {
            let turn = glam::DQuat::from_axis_angle(across, half_angle - wide.1);
            (turn * wide.0, half_angle)
        }
        // Opposite, or all around.
        _ => (wide.0, PI),
    }
}

/// How a light is picked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Reach {
    /// By what may arrive from it at a point.
    Bounded(LightBounds),
    /// It is infinitely far away: as often everywhere.
    Everywhere,
}

/// Builds the tree over lights with the probabilities that they have where nothing is known of the point: the part of all of those
/// infinitely far away is always the same. Intensities are not negative, and positive where the probability is.
pub(super) fn build(lights: &[(Reach, f64)], data: &mut SceneData) -> LightTree {
    let (mut near, mut far) = (Vec::new(), Vec::new());
    let total: f64 = lights.iter().map(|(reach, _)| intensity(reach)).sum();
    let unit = if total > 0.0 { total } else { 1.0 };
    let (mut near_share, mut far_share) = (0.0, 0.0);
    for (light, (reach, probability)) in lights.iter().enumerate() {
        match reach {
            Reach::Bounded(bounds) => {
                near_share += probability;
                let intensity = bounds.intensity / unit;
                near.push((
                    light,
                    LightBounds {
                        intensity,
                        ..*bounds
                    },
                ));
            }
            Reach::Everywhere => {
                far_share += probability;
                far.push((light, *probability));
            }
        }
    }
    let mut builder = Builder::new(lights.len());
    let root = match (near.is_empty(), far.is_empty()) {
        (true, true) => 0,
        (false, true) => builder.near(&mut near, Turns::default()).next,
        (true, false) => builder.far(&far, Turns::default()).next,
        (false, false) => {
            let pair = builder.reserve();
            let [a, b] = Turns::default().both();
            let near = builder.near(&mut near, a).next;
            let far = builder.far(&far, b).next;
            builder.pairs[pair as usize] =
                [everywhere(near_share, near), everywhere(far_share, far)];
            pair
        }
    };
    set_light_tree(data, root, &builder.turns, &builder.pairs);
    LightTree {
        levels: builder.levels,
    }
}

fn intensity(reach: &Reach) -> f64 {
    match reach {
        Reach::Bounded(bounds) => bounds.intensity,
        Reach::Everywhere => 0.0,
    }
}

/// A cluster of the same importance everywhere.
fn everywhere(importance: f64, next: u32) -> ClusterRecord {
    let intensity = importance * (0.5 * EVERYWHERE).powi(2);
    let bounds = LightBounds::point(DVec3::ZERO, intensity);
    ClusterRecord {
        radius: EVERYWHERE as f32,
        ..bounds.record(next)
    }
}

/// The way from the root to a cluster.
#[derive(Debug, Clone, Copy, Default)]
struct Turns {
    level: u32,
    bits: u32,
}

impl Turns {
    /// The ways on to the two clusters that it consists of.
    fn both(self) -> [Self; 2] {
        let level = self.level + 1;
        [self.bits, self.bits | 1 << self.level].map(|bits| Self { level, bits })
    }
}

/// Bins along an axis, at most: fewer lights have one each.
const BINS: usize = 16;
/// Levels beyond those that a balanced tree needs.
const SPARE_LEVELS: u32 = 4;

struct Builder {
    turns: Vec<u32>,
    pairs: Vec<[ClusterRecord; 2]>,
    levels: u32,
    most_levels: u32,
}

impl Builder {
    fn new(lights: usize) -> Self {
        Self {
            turns: vec![0; lights],
            pairs: Vec::with_capacity(lights),
            levels: 0,
            // One for those infinitely far away.
            most_levels: (lights.next_power_of_two().ilog2() + 1 + SPARE_LEVELS).min(31),
        }
    }

    fn reserve(&mut self) -> u32 {
        let none = LightBounds::point(DVec3::ZERO, 0.0).record(0);
        self.pairs.push([none; 2]);
        self.pairs.len() as u32 - 1
    }

    fn leaf(&mut self, light: usize, turns: Turns) -> u32 {
        self.turns[light] = turns.bits;
        self.levels = self.levels.max(turns.level);
        LEAF + light as u32
    }

    /// The cluster of some lights, at least one.
    fn near(&mut self, lights: &mut [(usize, LightBounds)], turns: Turns) -> ClusterRecord {
        if let [(light, bounds)] = lights {
            return bounds.record(self.leaf(*light, turns));
        }
        let pair = self.reserve();
        let bounds = union(lights);
        // Each half must fit the levels that are left.
        let most = 1_usize << (self.most_levels - turns.level - 1).min(30);
        let middle = split(lights, most);
        let [a, b] = turns.both();
        let (first, second) = lights.split_at_mut(middle);
        self.pairs[pair as usize] = [self.near(first, a), self.near(second, b)];
        bounds.record(pair)
    }

    /// The cluster of some lights infinitely far away, at least one.
    fn far(&mut self, lights: &[(usize, f64)], turns: Turns) -> ClusterRecord {
        let sum = lights.iter().map(|(_, probability)| probability).sum();
        if let [(light, _)] = lights {
            return everywhere(sum, self.leaf(*light, turns));
        }
        let pair = self.reserve();
        let (first, second) = lights.split_at(lights.len() / 2);
        let [a, b] = turns.both();
        self.pairs[pair as usize] = [self.far(first, a), self.far(second, b)];
        everywhere(sum, pair)
    }
}

fn union(lights: &[(usize, LightBounds)]) -> LightBounds {
    let bounds = lights.iter().map(|(_, bounds)| *bounds);
    bounds.reduce(|a, b| a.union(&b)).expect("there is a light")
}

/// Puts lights in order so that they are best split at the index that is returned; neither half has more than `most`.
fn split(lights: &mut [(usize, LightBounds)], most: usize) -> usize {
    if lights.len() == 2 {
        return 1;
    }
    let centers = lights.iter().map(|(_, bounds)| bounds.center());
    let [low, high] = centers.fold(
        [DVec3::INFINITY, DVec3::NEG_INFINITY],
        |[low, high], center| [low.min(center), high.max(center)],
    );
    let extent = high - low;
    let bins = lights.len().min(BINS);
    let bin_of = |bounds: &LightBounds, axis: usize| {
        let part = (bounds.center()[axis] - low[axis]) / extent[axis];
        ((part * bins as f64) as usize).min(bins - 1)
    };
    let mut best: Option<(f64, usize, usize)> = None;
    for axis in (0..3).filter(|&axis| extent[axis] > 0.0) {
        let mut filled = [(0, None::<LightBounds>); BINS];
        let filled = &mut filled[..bins];
        for (_, bounds) in lights.iter() {
            let (count, of_bin) = &mut filled[bin_of(bounds, axis)];
            *count += 1;
            *of_bin = join(*of_bin, Some(*bounds));
        }
        // After each bin: how many lights there are up to it, and what they cost.
        let after = |bins: &mut dyn Iterator<Item = &(usize, Option<LightBounds>)>| {
            let mut sum = (0, None);
            let sums = bins.map(|bin| {
                sum = (sum.0 + bin.0, join(sum.1, bin.1));
                (sum.0, sum.1.map_or(0.0, |bounds| bounds.cost()))
            });
            sums.collect::<Vec<_>>()
        };
        let up = after(&mut filled.iter());
        let down = after(&mut filled.iter().rev());
        for bin in 0..bins - 1 {
            let (first, second) = (up[bin], down[bins - 2 - bin]);
            let fits = |count| (1..=most).contains(&count);
            let cost = first.1 + second.1;
            if fits(first.0) && fits(second.0) && best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, bin));
            }
        }
    }
    match best {
        Some((_, axis, bin)) => {
            lights.sort_by_key(|(_, bounds)| bin_of(bounds, axis) > bin);
            lights.partition_point(|(_, bounds)| bin_of(bounds, axis) <= bin)
        }
        None => {
            let axis = extent.max_position();
            lights.sort_by(|(_, a), (_, b)| a.center()[axis].total_cmp(&b.center()[axis]));
            lights.len() / 2
        }
    }
}

fn join(a: Option<LightBounds>, b: Option<LightBounds>) -> Option<LightBounds> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.union(&b)),
        (a, b) => a.or(b),
    }
}
