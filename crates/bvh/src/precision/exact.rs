//! A filter in `f32`, then the truth: in `f64` where that can be certain, else by expansions.
//!
//! The shear test decides only what its error bound lets it: that a ray passes outside. All other
//! lanes, hits mostly, are tested one by one, by what depends on ray and triangle alone. So the
//! instruction set and the arrangement of the lanes do not matter, nor whether the filter is fused.
//!
//! Neighbours agree on their edge because both take the sign of the same number. Touching counts as
//! inside, for both; in its plane a triangle has no inside.

use crate::bounds::Bounds;
use crate::filter::Culling;
use crate::inlined::each;
use crate::layout::packet::Packet;
use crate::precision::ending::Ending;
use crate::precision::expansion::{self, Pair};
use crate::precision::shear_bounds::ShearBounds;
use crate::precision::shearing::Rounded;
use crate::precision::triangle::{LaneHits, Shear, Triangles};
use crate::precision::triangle_test::Precision;
use crate::precision::triangle_test::sealed::Test;
use crate::ray::Ray;
use crate::simd::Width;

/// Whether a ray meets a triangle is decided without error, for the closed triangle that its `f32`
/// corners span; so closed meshes have no holes, and nothing is hit that should not be. The
/// distance is off by a unit in the last place, or where that is more by 2⁻³⁶ of the distance to
/// the triangle's first corner, and `u` and `v` by 2⁻²⁴ at most. The same bits on every instruction
/// set.
///
/// That holds while differences of coordinates and inverse components of directions are finite in
/// `f32`; beyond, hits may be missed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exact;

impl Precision for Exact {}

impl Test for Exact {
    type Shearing = Rounded;

    #[inline(always)]
    fn candidates<S: Width<W>, const W: usize>(
        self,
        simd: S,
        rays: &Shear<'_, S, W>,
        triangles: impl Triangles<S, W>,
        culling: Culling,
    ) -> u32 {
        candidates(simd, rays, &triangles, culling)
    }

    /// All: signs of rounded numbers say nothing here.
    #[inline(always)]
    fn candidates_of_rays<S: Width<W>, const W: usize>(
        self,
        _: S,
        _: &ShearBounds<S, W>,
        _: &impl Packet<W>,
        _: Culling,
    ) -> u32 {
        u32::MAX
    }

    #[inline(always)]
    fn test<S: Width<W>, const W: usize, E: Ending>(
        self,
        simd: S,
        rays: &Shear<'_, S, W>,
        triangles: impl Triangles<S, W>,
        tmax: S::Float,
        culling: Culling,
        ending: E,
    ) -> Option<LaneHits<S, W>> {
        let mut lanes = candidates(simd, rays, &triangles, culling);
        if lanes == 0 {
            return None;
        }
        // Lanes that are left over, or done, have an empty interval.
        lanes &= simd.bits(simd.le(rays.tmin, tmax));

        let ([mut t, mut u, mut v], mut back) = ([[f32::NAN; W]; 3], 0);
        for lane in 0..W {
            if lanes >> lane & 1 == 0 {
                continue;
            }
            if let Some(hit) = meet(&rays.ray(lane), &triangles.corners(lane), culling) {
                (t[lane], u[lane], v[lane]) = (hit.t, hit.u, hit.v);
                back |= u32::from(hit.back) << lane;
            }
        }
        let hits = LaneHits {
            lanes,
            back,
            t: simd.load(&t),
            u: simd.load(&u),
            v: simd.load(&v),
        };
        hits.within(simd, rays.tmin, tmax, ending)
    }
}

/// The lanes of which `f32` is not certain that the ray passes outside the triangle, or meets the
/// side that is culled, as bits.
///
/// Let u = 2⁻²⁴, η = 2⁻¹⁵⁰, and X, Z a corner's coordinates relative to the origin after their
/// subtraction, which is off by u |X| and u |Z|. The ray runs mostly along z, so the slope s is at
/// most 1; it is off by u |s| + η. With the product's rounding, P = s Z is off by 3 u |Z|, to first
/// order, and η. The sheared x = X - P is rounded by u |x|, and |X| ≤ |x| + |Z|. Together x, and y
/// alike, is off by
///
/// ```text
/// e = 2 u |x| + 4 u |Z| + η.
/// ```
///
/// An edge's function x y' - y x' has two rounded products and a rounded difference. With
/// H = |x| + |y| it is off by
///
/// ```text
/// 2 u H H' + H e' + H' e + 2 e e' + 2 η  ≤  6 u H H' + 4 u (H Z' + Z H') + 32 u² Z Z' + …,
/// ```
///
/// where what is left out is of third order in u, or contains η. That is less than
/// `5 u (G T' + T G') + ω` with G = H + 4 u Z, T = H + Z + ω and ω = 2⁻¹²⁶: at least a tenth of each
/// term is to spare for the rest and for the roundings of the bound itself. What overflows is
/// infinite or NaN, and nothing is certain.
#[inline(always)]
fn candidates<S: Width<W>, const W: usize>(
    simd: S,
    rays: &Shear<'_, S, W>,
    triangles: &impl Triangles<S, W>,
    culling: Culling,
) -> u32 {
    const U: f32 = f32::EPSILON / 2.0;
    let (zero, least) = (simd.splat(0.0), simd.splat(f32::MIN_POSITIVE));
    let sheared = triangles.sheared::<Rounded>(simd, rays);
    // Where nothing is used; what overflows is infinite.
    let is_number = simd.bits(simd.le(sheared[0][2], sheared[0][2]));
    let corners = each(
        sheared,
        #[inline(always)]
        |[x, y, z]| {
            let (across, along) = (simd.add(simd.abs(x), simd.abs(y)), simd.abs(z));
            let g = simd.add(across, simd.mul(along, simd.splat(4.0 * U)));
            let t = simd.add(simd.add(across, along), least);
            (x, y, g, t)
        },
    );
    let [a, b, c] = corners;
    // Whether each is certainly positive, and certainly negative, as bits.
    let sides = each(
        [(c, b), (a, c), (b, a)],
        #[inline(always)]
        |(p, q)| {
            let edge = simd.sub(simd.mul(p.0, q.1), simd.mul(p.1, q.0));
            let size = simd.add(simd.mul(p.2, q.3), simd.mul(p.3, q.2));
            let error = simd.add(simd.mul(size, simd.splat(5.0 * U)), least);
            (
                simd.bits(simd.lt(error, edge)),
                simd.bits(simd.lt(simd.add(edge, error), zero)),
            )
        },
    );
    let [w, u, v] = sides;
    let (positive, negative) = (w.0 | u.0 | v.0, w.1 | u.1 | v.1);
    let outside = match culling {
        Culling::Back => negative,
        Culling::None | Culling::PerTriangle => positive & negative,
    };
    !outside & is_number & triangles.used(simd)
}

/// Where a ray meets one triangle.
#[derive(Clone, Copy)]
struct Meeting {
    t: f32,
    u: f32,
    v: f32,
    back: bool,
}

/// Half a unit in the last place of 1.
const U: f64 = f64::EPSILON / 2.0;
/// What the weights may be off by, relative to their sum.
const WEIGHTS: f64 = 1.0 / (1 << 28) as f64;
/// What the distance may be off by, relative to itself or to `NEAR` of the distance to a corner.
const DISTANCE: f64 = 1.0 / (1 << 26) as f64;
/// See `DISTANCE`.
const NEAR: f64 = 1.0 / (1 << 10) as f64;

/// Where the ray's line meets the closed triangle.
///
/// With `n` the triangle's normal, the weights are `dir · (p × q)` for each edge from `p` to `q`
/// relative to the origin, which add up to `dir · n`, and the distance is `a · n / dir · n`. In the
/// products the edge stands for its end, since it is shorter.
#[inline(never)]
fn meet(ray: &Ray, corners: &[[f32; 3]; 3], culling: Culling) -> Option<Meeting> {
    let finite = |corner: &[f32; 3]| corner.iter().all(|x| x.is_finite());
    if !corners.iter().all(finite) {
        return None;
    }
    let dir = ray.dir.map(f64::from);
    let relative = corners.map(|corner| rounded(corner, ray.org));
    const EDGES: [(usize, usize); 3] = [(2, 1), (0, 2), (1, 0)];
    let products =
        EDGES.map(|(p, q)| triple_product(dir, relative[p], rounded(corners[q], corners[p])));

    let [w, u, v] = products.map(|(weight, _)| weight);
    let certain = |sign: f64| move |&(weight, error): &(f64, f64)| sign * weight > error;
    if products.iter().any(certain(1.0)) && products.iter().any(certain(-1.0)) {
        return None;
    }
    let signs_are_certain = products
        .iter()
        .all(|(weight, error)| weight.abs() >= *error);
    let error: f64 = products.iter().map(|(_, error)| error).sum();
    let weights = if signs_are_certain && error <= WEIGHTS * (w + u + v).abs() {
        [w, u, v]
    } else {
        exact_weights(ray, corners)
    };

    let front = weights.iter().all(|&weight| weight >= 0.0);
    let back = weights.iter().all(|&weight| weight <= 0.0);
    let determinant = weights.iter().sum::<f64>();
    let culled = matches!(culling, Culling::Back) && !front;
    if !(front || back) || culled || determinant == 0.0 {
        return None;
    }

    let [ab, ac] = [1, 2].map(|corner| rounded(corners[corner], corners[0]));
    let (volume, error) = triple_product(relative[0], ac, ab);
    let far = longest(relative[0]) * determinant.abs() / longest(dir);
    let volume = if error <= DISTANCE * volume.abs().max(NEAR * far) {
        volume
    } else {
        exact_volume(ray, corners)
    };

    // The box moves only what under- or overflows: the nodes' boxes are entered no later and left
    // no earlier than the padded box, which contains the triangle.
    let (entry, exit) = Bounds::of_padded_triangle(corners).passage(ray);
    // Zero has no sign.
    let [t, u, v] = [volume, weights[1], weights[2]].map(|x| (x / determinant) as f32 + 0.0);
    (entry <= exit).then(|| Meeting {
        t: t.max(entry).min(exit),
        u,
        v,
        back: !front,
    })
}

/// `p - q`.
fn rounded(p: [f32; 3], q: [f32; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| f64::from(p[axis]) - f64::from(q[axis]))
}

/// `p - q`.
fn exact(p: [f32; 3], q: [f32; 3]) -> [Pair; 3] {
    std::array::from_fn(|axis| expansion::difference(f64::from(p[axis]), f64::from(q[axis])))
}

/// The greatest component.
fn longest(p: [f64; 3]) -> f64 {
    p.into_iter().map(f64::abs).fold(0.0, f64::max)
}

/// `p · (q × r)` of vectors that may each be rounded, and more than what it is off by: the
/// products in it see eight roundings each.
fn triple_product(p: [f64; 3], q: [f64; 3], r: [f64; 3]) -> (f64, f64) {
    let (mut value, mut size) = (0.0, 0.0);
    for (i, p) in p.into_iter().enumerate() {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let (left, right) = (q[j] * r[k], q[k] * r[j]);
        value += p * (left - right);
        size += p.abs() * (left.abs() + right.abs());
    }
    (value, 9.0 * U * size)
}

/// The weights with the right signs, to within a few roundings.
#[cold]
#[inline(never)]
fn exact_weights(ray: &Ray, corners: &[[f32; 3]; 3]) -> [f64; 3] {
    let dir = exact(ray.dir, [0.0; 3]);
    let [a, b, c] = corners.map(|corner| exact(corner, ray.org));
    [(c, b), (a, c), (b, a)].map(|(p, q)| expansion::triple_product(dir, p, q))
}

/// `a · n` to within a few roundings.
#[cold]
#[inline(never)]
fn exact_volume(ray: &Ray, [a, b, c]: &[[f32; 3]; 3]) -> f64 {
    expansion::triple_product(exact(*a, ray.org), exact(*c, *a), exact(*b, *a))
}

#[cfg(test)]
mod tests;
