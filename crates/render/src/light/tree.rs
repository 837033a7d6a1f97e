//! A tree of lights (Conty Estevez and Kulla 2018; PBRT 4, section 12.6.3): picks a light by what may arrive from it at a point.
//!
//! Lights stand together in clusters, two in each larger one. A walk from the root turns to one of two clusters with a
//! probability in proportion to their importance at the point, until there is one light left. All clusters on the way to a light
//! can be found again from its *turns*, a bit for each level, so that the probability of a light that a path has met is that of
//! the same walk.
//!
//! What is behind the point's surface is not known to the tree: a path keeps no normal of the vertex that it comes from, and the
//! probability of a pick must be the same for both strategies.

use super::pick::{Pick, find};
use crate::alias_table::BELOW_ONE;
use crate::domain::{Buffer, Bundle, Domain};
use crate::math::Vec3;
use crate::record::{BufferRecord, record};
use crate::scene_data::SceneData;

record! {
    /// What lies before the turns and the clusters.
    pub struct LightTreeHeader in LightTree {
        row {
            /// What is at the root, as in [`next`](ClusterRecord::next).
            root: word,
        }
    }
}

record! {
    /// Lights that stand together.
    pub struct ClusterRecord {
        row {
            /// Centre of the sphere around them, world space.
            center: vector,
            /// Its radius.
            radius: real,
        }
        row {
            /// The unit axis of the cone of directions in which they shine most.
            axis: vector,
            /// Cosine of the cone's half-angle.
            cos: real,
        }
        row {
            /// Sine of that angle.
            sin: real,
            /// The sum of their radiant intensities where each shines most, in terms of an arbitrary unit.
            intensity: real,
            /// The first word of the pair of clusters that it consists of, or [`LEAF`] plus the index of its only light.
            next: word,
        }
    }
}

/// What is added to the index of a light where a walk ends.
pub const LEAF: u32 = 1 << 31;

/// A radius so large that all places are in the middle: what has it is of the same importance everywhere, its intensity over the
/// square of half this radius.
pub const EVERYWHERE: f64 = (1_u64 << 40) as f64;

/// Of two clusters that both may shine at a point, none is picked less often than this.
const LEAST_SHARE: f64 = 1.0 / 256.0;

/// The structure of a tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightTree {
    /// The number of turns on the longest way, at most 31.
    pub levels: u32,
}

impl<D: Domain> ClusterRecord<D> {
    /// What may arrive at a point from these lights, as if all of them stood at the sphere's centre, shining
    /// with the cosine of the least angle that any of them may have to the point. Where the point is in the sphere, they are in
    /// part nearer than the centre and in part farther away, and in the mean half the radius away at least.
    #[inline(always)]
    fn importance(&self, d: D, at: Vec3<D::F>) -> D::F {
        let (zero, one) = (d.lit(0.0), d.lit(1.0));
        let away = at - self.center;
        let distance = away.length(d);
        let least = d.max(self.radius * d.lit(0.5), d.lit(1e-15));
        let inverse = one / d.max(distance, least);
        // The angle that the sphere subtends; a right one within it.
        let sin_sphere = d.min(self.radius * inverse, one);
        let cos_sphere = d.sqrt(one - sin_sphere * sin_sphere);
        let cos_axis = away.dot(d, self.axis) * inverse;
        let sin_axis = d.sqrt(d.max(one - cos_axis * cos_axis, zero));
        // The angle to the axis, less that of the cone and that of the sphere, but not less than 0.
        let in_cone = d.lt(self.cos, cos_axis);
        let cos = d.fma(cos_axis, self.cos, sin_axis * self.sin);
        let sin = sin_axis * self.cos - cos_axis * self.sin;
        let (cos, sin) = (d.select(in_cone, one, cos), d.select(in_cone, zero, sin));
        let in_sphere = d.lt(cos_sphere, cos);
        let cos = d.select(in_sphere, one, d.fma(cos, cos_sphere, sin * sin_sphere));
        // Among them, the point may see any of them from its front.
        let least = d.select(d.lt(distance, self.radius), d.lit(0.25), zero);
        d.max(cos, least) * self.intensity * (inverse * inverse)
    }
}

/// Where a walk has come to.
#[derive(Clone, Copy)]
struct Walk<D: Domain> {
    /// What is there, as in [`ClusterRecord::next`].
    at: D::U,
    /// The probability of coming here.
    probability: D::F,
    /// What is left of the number that decides, stretched to [0, 1).
    rest: D::F,
    /// How far apart the numbers are that it can be.
    grain: D::F,
}

impl<D: Domain> Bundle<D> for Walk<D> {
    #[inline(always)]
    fn choose(d: D, mask: D::M, a: Self, b: Self) -> Self {
        Self {
            at: d.select_u(mask, a.at, b.at),
            probability: d.select(mask, a.probability, b.probability),
            rest: d.select(mask, a.rest, b.rest),
            grain: d.select(mask, a.grain, b.grain),
        }
    }
}

impl<D: Domain> Walk<D> {
    /// Takes a turn: to the first of two clusters where `is_first` of the level's walk and the first one's share.
    #[inline(always)]
    fn turn(self, d: D, from: Vec3<D::F>, is_first: impl FnOnce(&Self, D::F) -> D::M) -> Self {
        let second = self.at + d.uint(ClusterRecord::WORDS);
        let [a, b] = [self.at, second].map(|at| ClusterRecord::load_at(d, Buffer::LightTree, at));
        let [of_a, of_b] = [a, b].map(|cluster| cluster.importance(d, from));
        let (zero, one) = (d.lit(0.0), d.lit(1.0));
        let sum = of_a + of_b;
        let shines = d.lt(zero, sum);
        let share = d.select(shines, of_a / d.select(shines, sum, one), d.lit(0.5));
        let both = d.lt(zero, of_a) & d.lt(zero, of_b);
        let bounded = d.min(d.max(share, d.lit(LEAST_SHARE)), d.lit(1.0 - LEAST_SHARE));
        let share = d.select(both, bounded, share);

        let is_first = is_first(&self, share);
        let width = d.select(is_first, share, one - share);
        let start = d.select(is_first, zero, share);
        let stretch = one / width;
        Self {
            at: d.select_u(is_first, a.next, b.next),
            probability: self.probability * width,
            rest: (self.rest - start) * stretch,
            grain: self.grain * stretch,
        }
    }
}

impl LightTree {
    /// Walks from the root to a light. `is_first` says at each level, which it is given, whether to turn to the first of two
    /// clusters.
    #[inline(always)]
    fn walk<D: Domain>(
        self,
        d: D,
        from: Vec3<D::F>,
        number: D::F,
        is_first: impl Fn(u32, &Walk<D>, D::F) -> D::M,
    ) -> Walk<D> {
        let mut walk = Walk {
            at: LightTreeHeader::uniform(d).root,
            probability: d.lit(1.0),
            rest: number,
            grain: d.lit(1.0 / (1 << 24) as f64),
        };
        for level in 0..self.levels {
            let goes_on = d.lt_u(walk.at, d.uint(LEAF));
            if d.holds_nowhere(goes_on) {
                break;
            }
            let turn = |walk: &Walk<D>, share: D::F| is_first(level, walk, share);
            walk = d.branch(goes_on, || walk.turn(d, from, turn), || walk);
        }
        walk
    }

    /// Picks a light for the point `from` with the first of two numbers, and makes of both two numbers for a place on it.
    #[inline(always)]
    pub fn pick<D: Domain>(self, d: D, from: Vec3<D::F>, [u, v]: [D::F; 2]) -> Pick<D> {
        // Deep in the tree few digits are left of the 24: digits of the other number follow them.
        let digits = v * d.lit(4096.0);
        let digits = digits - d.floor(digits);
        let rest = |walk: &Walk<D>| d.fma(digits, walk.grain, walk.rest);
        let walk = self.walk(d, from, u, |_, walk, share| d.lt(rest(walk), share));
        let (kind, record) = find(d, walk.at - d.uint(LEAF));
        let place = d.min(d.max(rest(&walk), d.lit(0.0)), d.lit(BELOW_ONE));
        Pick {
            kind,
            record,
            probability: walk.probability,
            place: [place, v],
        }
    }

    /// The probability of picking a light for the point `from`.
    #[inline(always)]
    pub fn probability<D: Domain>(self, d: D, from: Vec3<D::F>, light: D::U) -> D::F {
        let turns = d.load(Buffer::LightTree, light + d.uint(LightTreeHeader::WORDS));
        let is_first = |level, _: &Walk<D>, _| d.eq_u((turns >> level) & d.uint(1), d.uint(0));
        self.walk(d, from, d.lit(0.0), is_first).probability
    }
}

/// Sets the tree from which lights are picked: the turns to each light, the first one the lowest bit, 1 for the second of two
/// clusters; pairs of clusters; and what is at the root. Where that names a pair, it is by its index: the words follow from it.
pub fn set_light_tree(
    data: &mut SceneData,
    root: u32,
    turns: &[u32],
    pairs: &[[ClusterRecord; 2]],
) {
    let first = (LightTreeHeader::WORDS + turns.len() as u32).next_multiple_of(4);
    let word = |next: u32| match next < LEAF {
        true => first + next * 2 * ClusterRecord::WORDS,
        false => next,
    };
    let buffer = data.buffer_mut(Buffer::LightTree);
    buffer.clear();
    LightTreeHeader { root: word(root) }.append_to(buffer);
    buffer.extend_from_slice(turns);
    buffer.resize(first as usize, 0);
    for cluster in pairs.iter().flatten() {
        let next = word(cluster.next);
        ClusterRecord { next, ..*cluster }.append_to(buffer);
    }
}
