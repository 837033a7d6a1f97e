//! An instance as queries see it, and the box that a ray must enter to hit it.
//!
//! # Boxes and roundings
//! With `A` the linear part of `object_to_world`, `T` its translation and `M` the inverse of `A`
//! rounded to `f32`, the object sees the ray `M (o - T) + t M d`. A component of `M` is wrong by one
//! rounding, the difference adds one, the product and the sums three: the point at `t` is away from
//! where it should be by at most `5 u |M| (|o - T| + t |d|)`, `u = 2⁻²⁴`; seen in the world, by
//! `5 u |A| |M|` times that vector. For a ray that starts in the instance's box and hits inside of
//! it, `|o - T| + t |d|` is at most thrice the box's reach from `T`, so a box around the object's
//! transformed box is padded by `16 u |A| |M|` times its reach. That covers the `f64` arithmetic that
//! makes the box, too.
//!
//! Rays that come from farther away err by more. So that no answer depends on the order of visits
//! then, a hit counts from where the ray enters the instance's own box, with half the slack of the
//! slab test (see `bounds.rs`): no box around it is entered later, and a ray that passes by the box
//! does not hit what is in it.

use glam::{DMat3, DVec3};

use crate::bounds::Bounds;
use crate::instances::instance::{Instance, InstanceFault};
use crate::ray::Ray;

/// An instance as queries see it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    /// Around the instance, in the world.
    pub(crate) bounds: Bounds,
    /// The world's origin of the object's space.
    translation: [f32; 3],
    /// Rows of the inverse of the transform's linear part.
    to_object: [[f32; 3]; 3],
    /// Index of the object.
    pub(crate) bvh: u32,
    /// Index of the instance.
    pub(crate) instance: u32,
}

/// Checks and prepares an instance; none if there is nothing to hit.
pub(crate) fn place(
    instance: &Instance,
    index: usize,
    bounds: &[Bounds],
) -> Result<Option<Placed>, InstanceFault> {
    let transform = &instance.object_to_world;
    let bvh = instance.bvh;
    let bounds = bounds.get(bvh).ok_or(InstanceFault::NoSuchObject { bvh })?;
    if !transform.is_finite() {
        return Err(InstanceFault::NotFinite);
    }
    // In f64 no product of three f32 overflows or vanishes; of the determinant the last few bits of
    // the columns' lengths are lost.
    let linear = DMat3::from_cols_array(&transform.matrix3.to_cols_array().map(f64::from));
    let [a, b, c] = [linear.x_axis, linear.y_axis, linear.z_axis].map(DVec3::length);
    if linear.determinant().abs() <= 1e-14 * a * b * c {
        return Err(InstanceFault::NotInvertible);
    }
    let inverse = linear.inverse();
    let to_object = [0, 1, 2].map(|axis| inverse.row(axis).to_array().map(|x| x as f32));
    if !to_object.iter().flatten().all(|x| x.is_finite()) {
        return Err(InstanceFault::NotFinite);
    }
    let is_empty = (0..3).any(|axis| bounds.lo[axis] > bounds.hi[axis]);
    let translation = transform.translation.to_array();
    let placed = Placed {
        bounds: world_bounds(bounds, &linear, &inverse, translation),
        translation,
        to_object,
        bvh: bvh as u32,
        instance: index as u32,
    };
    Ok((!is_empty).then_some(placed))
}

/// The padded box around an object's transformed box. A box that is not finite becomes the whole
/// world.
fn world_bounds(bounds: &Bounds, linear: &DMat3, inverse: &DMat3, translation: [f32; 3]) -> Bounds {
    const PAD: f64 = 1.0 / (1 << 20) as f64;
    let corners = (0..8).map(|corner| {
        let side = |axis: usize| f64::from([bounds.lo, bounds.hi][corner >> axis & 1][axis]);
        *linear * DVec3::new(side(0), side(1), side(2))
    });
    let (mut lo, mut hi) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for corner in corners {
        if !corner.is_finite() {
            return Bounds {
                lo: [f32::NEG_INFINITY; 3],
                hi: [f32::INFINITY; 3],
            };
        }
        (lo, hi) = (lo.min(corner), hi.max(corner));
    }
    let magnitude = |matrix: &DMat3| {
        DMat3::from_cols(
            matrix.x_axis.abs(),
            matrix.y_axis.abs(),
            matrix.z_axis.abs(),
        )
    };
    let reach = lo.abs().max(hi.abs());
    let pad = magnitude(linear) * (magnitude(inverse) * reach) * PAD;
    let translation = DVec3::from(translation.map(f64::from));
    Bounds {
        lo: (translation + lo - pad)
            .to_array()
            .map(|x| (x as f32).next_down()),
        hi: (translation + hi + pad)
            .to_array()
            .map(|x| (x as f32).next_up()),
    }
}

impl Placed {
    /// The ray as the object sees it.
    #[inline(always)]
    pub(crate) fn object_ray(&self, ray: &Ray) -> Ray {
        let [rx, ry, rz] = self.to_object;
        let dot = |[a, b, c]: [f32; 3], [x, y, z]: [f32; 3]| a * x + b * y + c * z;
        let linear = |x: [f32; 3]| [dot(rx, x), dot(ry, x), dot(rz, x)];
        let [x, y, z] = ray.org;
        let [tx, ty, tz] = self.translation;
        Ray {
            org: linear([x - tx, y - ty, z - tz]),
            dir: linear(ray.dir),
            ..*ray
        }
    }
}
