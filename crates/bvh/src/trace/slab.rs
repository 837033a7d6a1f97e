//! Rays against boxes: the slab test, conservative under rounding.
//!
//! T. Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013. The distance to a plane is
//! `scale * plane + shift`, one fused operation, with `scale = 1 / dir` and
//! `shift = -org / dir`. What that cancels, and more, is folded into the ray's constants:
//! - `scale` is shrunk for entries and stretched for exits by 2⁻²⁰: the product's roundings and
//!   those of the triangle test, all relative to the distance;
//! - `shift` is moved by 2⁻²² of itself, for the roundings relative to the origin's coordinates.
//!   In space that is two units in the last place of the origin.
//!
//! A component of the direction below 2⁻⁶⁴ of the greatest counts as that: a ray lying in a plane
//! of a box then enters it. Where a constant overflows, the distances are NaN, which the minimum
//! and maximum drop: the axis does not cull.
//!
//! The same test serves one ray against the `N` boxes of a node, `N` rays against one box, and the
//! envelope of a packet of rays against `N` boxes.

use crate::inlined::{each, inlined};
use crate::layout::boxes::Boxes;
use crate::layout::class::Octant;
use crate::layout::ray_packet::{RayBounds, RayPacket};
use crate::ray::Ray;
use crate::simd::Width;

const STRETCH: f32 = 1.0 / (1 << 20) as f32;
const REACH: f32 = 1.0 / (1 << 22) as f32;
/// Least component of a direction, relative to the greatest.
const LEAST: f32 = 1.0 / (1u128 << 64) as f32;

/// `scale` and `shift` of the entry and the exit planes' distances, `[axis]` and one more.
#[derive(Clone, Copy)]
struct Constants {
    near_scale: [f32; 4],
    near_shift: [f32; 4],
    far_scale: [f32; 4],
    far_shift: [f32; 4],
}

impl Constants {
    /// For rays from `near_org`, as slow as `near_inv`, into the boxes and from `far_org`, as
    /// fast as `far_inv`, out of them. The axes are lanes.
    #[inline(always)]
    fn new<S: Width<4>>(
        simd: S,
        near_org: S::Float,
        near_inv: S::Float,
        far_org: S::Float,
        far_inv: S::Float,
    ) -> Self {
        let near_scale = simd.mul(near_inv, simd.splat(1.0 - STRETCH));
        let far_scale = simd.mul(far_inv, simd.splat(1.0 + STRETCH));
        let near_shift = shift(simd, near_org, near_scale, -REACH);
        let far_shift = shift(simd, far_org, far_scale, REACH);
        let array = inlined(
            #[inline(always)]
            |lanes: S::Float| {
                let mut array = [0.0; 4];
                simd.store(lanes, &mut array);
                array
            },
        );
        Constants {
            near_scale: array(near_scale),
            near_shift: array(near_shift),
            far_scale: array(far_scale),
            far_shift: array(far_shift),
        }
    }
}

/// `-org * scale`, moved by `reach` of itself.
#[inline(always)]
fn shift<S: Width<W>, const W: usize>(
    simd: S,
    org: S::Float,
    scale: S::Float,
    reach: f32,
) -> S::Float {
    let shift = simd.mul(org, scale);
    simd.mul_sub(simd.abs(shift), simd.splat(reach), shift)
}

/// The inverse of components of directions, of which `longest` are the greatest, from their signs
/// and sizes.
#[inline(always)]
fn inverse<S: Width<W>, const W: usize>(
    simd: S,
    sign: S::Float,
    size: S::Float,
    longest: S::Float,
) -> S::Float {
    let least = simd.mul(longest, simd.splat(LEAST));
    simd.div(sign, simd.max_number(size, least))
}

/// The inverse directions of a packet's rays.
#[inline(always)]
fn inverse_of_rays<S: Width<R>, const R: usize>(
    simd: S,
    rays: &RayPacket<R>,
    octant: Octant,
) -> [S::Float; 3] {
    let size = each(
        [0, 1, 2],
        #[inline(always)]
        |axis| simd.abs(simd.load(&rays.dir[axis])),
    );
    let longest = simd.max_number(simd.max_number(size[0], size[1]), size[2]);
    each(
        [0, 1, 2],
        #[inline(always)]
        |axis: usize| {
            let sign = simd.splat(if octant[axis] { -1.0 } else { 1.0 });
            inverse(simd, sign, size[axis], longest)
        },
    )
}

/// One ray prepared for slab tests, as it is kept in memory.
#[derive(Clone, Copy)]
pub(crate) struct RaySlab {
    constants: Constants,
    /// As [`Slab::near_row`].
    near_row: [u8; 3],
}

impl RaySlab {
    #[inline(always)]
    pub(crate) fn new<S: Width<4>>(simd: S, ray: &Ray) -> RaySlab {
        // As they lie in memory; what comes last is of no use.
        let lanes = |[x, y, z]: [f32; 3], last: f32| [x, y, z, last];
        let dir = simd.load(&lanes(ray.dir, ray.tmax));
        let negative = simd.bits(simd.lt(dir, simd.splat(0.0)));
        let sign = simd.select(negative, simd.splat(-1.0), simd.splat(1.0));
        // Not the inverse of `tmax`: of `f32::MAX` it is denormal, which costs as much as a node.
        let longest = simd.splat(ray.longest());
        let size = simd.select(0b111, simd.abs(dir), longest);
        let inv = inverse(simd, sign, size, longest);
        let org = simd.load(&lanes(ray.org, ray.tmin));
        let octant = [0, 1, 2].map(|axis| negative >> axis & 1 == 1);
        RaySlab {
            constants: Constants::new(simd, org, inv, org, inv),
            near_row: near_rows(octant),
        }
    }
}

/// Rays of one octant, prepared for slab tests. Distances are in units of their directions.
pub(crate) struct Slab<S: Width<N>, const N: usize> {
    near_scale: [S::Float; 3],
    near_shift: [S::Float; 3],
    far_scale: [S::Float; 3],
    far_shift: [S::Float; 3],
    /// Row of the entry plane in a node's bounds; its exit plane's is this with the low bit
    /// flipped.
    near_row: [u8; 3],
    tmin: S::Float,
}

impl<S: Width<N>, const N: usize> Slab<S, N> {
    /// One ray, in every lane. `tmin` must not be negative: the slack would then point the wrong
    /// way.
    #[inline(always)]
    pub(crate) fn of_ray(simd: S, ray: &Ray, tmin: f32) -> Slab<S, N>
    where
        S: Width<4>,
    {
        Slab::of_prepared(simd, &RaySlab::new(simd, ray), tmin)
    }

    /// As [`of_ray`](Slab::of_ray).
    #[inline(always)]
    pub(crate) fn of_prepared(simd: S, ray: &RaySlab, tmin: f32) -> Slab<S, N> {
        Slab::splat(simd, &ray.constants, ray.near_row, tmin)
    }

    /// A ray a lane, all of one octant, and valid.
    #[inline(always)]
    pub(crate) fn of_rays(
        simd: S,
        rays: &RayPacket<N>,
        tmin: &[f32; N],
        octant: Octant,
    ) -> Slab<S, N> {
        let axes = [0, 1, 2_usize];
        let inv = inverse_of_rays(simd, rays, octant);
        let scale = inlined(
            #[inline(always)]
            |by: f32| {
                each(
                    axes,
                    #[inline(always)]
                    |axis| simd.mul(inv[axis], simd.splat(by)),
                )
            },
        );
        let (near_scale, far_scale) = (scale(1.0 - STRETCH), scale(1.0 + STRETCH));
        let shift = inlined(
            #[inline(always)]
            |scale: [S::Float; 3], reach: f32| {
                each(
                    axes,
                    #[inline(always)]
                    |axis| shift(simd, simd.load(&rays.org[axis]), scale[axis], reach),
                )
            },
        );
        Slab {
            near_scale,
            near_shift: shift(near_scale, -REACH),
            far_scale,
            far_shift: shift(far_scale, REACH),
            near_row: near_rows(octant),
            tmin: simd.load(tmin),
        }
    }

    /// What encloses all rays, which are of one octant and valid, in every lane: it enters a box
    /// no later, and leaves it no earlier, than any of them.
    #[inline(always)]
    pub(crate) fn enclosing<const R: usize>(
        simd: S,
        rays: &RayPacket<R>,
        bounds: &RayBounds,
        octant: Octant,
    ) -> Slab<S, N>
    where
        S: Width<R> + Width<4>,
    {
        let [x, y, z] = inverse_of_rays(simd, rays, octant);
        let inv = [
            <S as Width<R>>::least_of(simd, [x, y, z, z]),
            <S as Width<R>>::greatest_of(simd, [x, y, z, z]),
        ];
        let negative = octant_bits(octant);
        let choose = inlined(
            #[inline(always)]
            |a: &[f32; 4], b: &[f32; 4]| {
                let [a, b] = each(
                    [*a, *b],
                    #[inline(always)]
                    |x| <S as Width<4>>::load(simd, &x),
                );
                <S as Width<4>>::select(simd, negative, a, b)
            },
        );
        // Where planes lie behind an origin the bounds are wrong, but below zero as they should.
        let constants = Constants::new(
            simd,
            choose(&bounds.lo, &bounds.hi),
            choose(&inv[1], &inv[0]),
            choose(&bounds.hi, &bounds.lo),
            choose(&inv[0], &inv[1]),
        );
        Slab::splat(simd, &constants, near_rows(octant), bounds.lo[3])
    }

    #[inline(always)]
    fn splat(simd: S, constants: &Constants, near_row: [u8; 3], tmin: f32) -> Slab<S, N> {
        let splat = inlined(
            #[inline(always)]
            |x: [f32; 4]| [simd.splat(x[0]), simd.splat(x[1]), simd.splat(x[2])],
        );
        Slab {
            near_scale: splat(constants.near_scale),
            near_shift: splat(constants.near_shift),
            far_scale: splat(constants.far_scale),
            far_shift: splat(constants.far_shift),
            near_row,
            tmin: simd.splat(tmin),
        }
    }

    /// The lanes whose ray touches its box within `[tmin, tmax]`, as bits, and where it enters.
    /// `plane(axis, row)` gives the boxes' planes as [`Boxes::plane`].
    #[inline(always)]
    fn touched(
        &self,
        simd: S,
        plane: impl Fn(usize, usize) -> S::Float,
        tmax: S::Float,
    ) -> (u32, S::Float) {
        let near = inlined(
            #[inline(always)]
            |axis: usize| {
                let plane = plane(axis, usize::from(self.near_row[axis]));
                simd.mul_add(plane, self.near_scale[axis], self.near_shift[axis])
            },
        );
        let far = inlined(
            #[inline(always)]
            |axis: usize| {
                let plane = plane(axis, usize::from(self.near_row[axis] ^ 1));
                simd.mul_add(plane, self.far_scale[axis], self.far_shift[axis])
            },
        );
        let entry = simd.max_number(near(0), self.tmin);
        let entry = simd.max_number(near(2), simd.max_number(near(1), entry));
        let exit = simd.min_number(far(0), tmax);
        let exit = simd.min_number(far(2), simd.min_number(far(1), exit));
        (simd.bits(simd.le(entry, exit)), entry)
    }

    /// One ray, or an envelope, against the boxes of a node.
    #[inline(always)]
    pub(crate) fn touched_children(
        &self,
        simd: S,
        node: &impl Boxes<N>,
        tmax: f32,
    ) -> (u32, S::Float) {
        let plane = inlined(
            #[inline(always)]
            |axis: usize, row: usize| {
                // SAFETY: near rows are of their axis, and so are they with the low bit flipped.
                unsafe { node.plane(simd, axis, row) }
            },
        );
        let (touched, entry) = self.touched(simd, plane, simd.splat(tmax));
        (touched & node.used(), entry)
    }

    /// A ray a lane against one box of a node.
    #[inline(always)]
    pub(crate) fn touching_rays<const W: usize>(
        &self,
        simd: S,
        node: &impl Boxes<W>,
        slot: usize,
        tmax: &[f32; N],
    ) -> u32 {
        let plane = inlined(
            #[inline(always)]
            |axis: usize, row: usize| simd.splat(node.plane_of(slot, axis, row)),
        );
        self.touched(simd, plane, simd.load(tmax)).0
    }
}

#[inline(always)]
fn octant_bits([x, y, z]: Octant) -> u32 {
    u32::from(x) | u32::from(y) << 1 | u32::from(z) << 2
}

#[inline(always)]
fn near_rows(octant: Octant) -> [u8; 3] {
    [0, 1, 2].map(|axis: u8| 2 * axis + u8::from(octant[usize::from(axis)]))
}

#[cfg(test)]
mod tests;
