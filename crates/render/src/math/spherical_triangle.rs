//! Triangles as a point sees them: their solid angle, and places on them that are uniform in it.
//!
//! Arvo 1995, "Stratified Sampling of Spherical Triangles", in half-vectors (Peters 2021, "BRDF Importance Sampling for Polygonal
//! Lights"), and rearranged so that nothing cancels: neither the triangle's angles nor directions within it are computed, but weights of its
//! corners, from sums of positive numbers alone. So needles, triangles far away and triangles seen edge-on keep their digits as well as large
//! ones, in `f32`.

use super::elementary::atan2;
use super::vec3::Vec3;
use crate::domain::{Bundle, Domain};

/// A triangle as a point sees it.
#[derive(Clone, Copy, Debug)]
pub struct SphericalTriangle<D: Domain> {
    /// The corners, relative to the point.
    corners: [Vec3<D::F>; 3],
    /// Their distances.
    distances: [D::F; 3],
    /// The directions to them.
    directions: [Vec3<D::F>; 3],
    /// 1 + the cosine of the arc between two corners, by the index of the third.
    arcs: [D::F; 3],
    /// Half the solid angle.
    half: D::F,
}

/// What belongs to the smallest of three numbers.
#[inline(always)]
fn of_smallest<D: Domain>(d: D, numbers: [D::F; 3], [a, b, c]: [D::F; 3]) -> D::F {
    let second = d.lt(numbers[1], numbers[0]);
    let least = d.min(numbers[0], numbers[1]);
    d.select(d.lt(numbers[2], least), c, d.select(second, b, a))
}

/// Two numbers with what belongs to them, the smaller first.
#[inline(always)]
fn in_order<D: Domain>(d: D, [a, b]: [(D::F, Vec3<D::F>); 2]) -> [(D::F, Vec3<D::F>); 2] {
    let second = d.lt(b.0, a.0);
    [
        (d.min(a.0, b.0), Vec3::choose(d, second, b.1, a.1)),
        (d.max(a.0, b.0), Vec3::choose(d, second, a.1, b.1)),
    ]
}

/// sin x / x for x² = `square`, 0 ≤ x ≤ π; absolute error below 1.5e-7.
#[inline(always)]
fn sinc<D: Domain>(d: D, square: D::F) -> D::F {
    let p = d.fma(
        d.lit(-2.077_191_156_248_39e-8),
        square,
        d.lit(2.710_812_338_501_582e-6),
    );
    let p = d.fma(p, square, d.lit(-1.981_955_663_678_636e-4));
    let p = d.fma(p, square, d.lit(8.332_872_728_150_708e-3));
    let p = d.fma(p, square, d.lit(-1.666_663_486_152_242e-1));
    d.fma(p, square, d.lit(1.0))
}

impl<D: Domain> SphericalTriangle<D> {
    /// The triangle with these corners as the point `from` sees it. The length of `normal` is twice the triangle's area; which way it
    /// points makes no difference.
    ///
    /// tan(Ω/2) = |a·(b×c)| / (1 + a·b + b·c + c·a) (Van Oosterom and Strackee 1983). The numerator is the distance to the triangle's plane,
    /// taken from the nearest corner. The denominator is w² + w·(c − b) with w = a + b, where a and b are farthest apart and b and c nearest to
    /// one another. So it keeps its digits where a and b are nearly opposite, as a point sees both ends of a needle beside it.
    #[inline(always)]
    pub fn new(d: D, from: Vec3<D::F>, corners: [Vec3<D::F>; 3], normal: Vec3<D::F>) -> Self {
        let corners = corners.map(|corner| corner - from);
        let distances = corners.map(|corner| d.max(corner.length(d), d.lit(1e-18)));
        let inverses = distances.map(|distance| d.lit(1.0) / distance);
        let directions = [0, 1, 2].map(|k| corners[k].scale(inverses[k]));
        let heights = corners.map(|corner| d.abs(corner.dot(d, normal)));
        let height = of_smallest(d, distances, heights);
        let [a, b, c] = inverses;

        let sums = [[1, 2], [2, 0], [0, 1]].map(|[i, j]| directions[i] + directions[j]);
        let arcs = sums.map(|sum| sum.dot(d, sum) * d.lit(0.5));
        // By the arcs opposite, the longest first.
        let [x, y, z] = [0, 1, 2].map(|k| (arcs[k], directions[k]));
        let [x, y] = in_order(d, [x, y]);
        let [y, z] = in_order(d, [y, z]);
        let [(longest, third), (_, second)] = in_order(d, [x, y]);
        let denominator = d.fma(d.lit(2.0), longest, (z.1 + second).dot(d, third - second));
        Self {
            corners,
            distances,
            directions,
            arcs,
            half: atan2(d, height * a * b * c, denominator),
        }
    }

    /// The solid angle, from 0 to 2π.
    #[inline(always)]
    pub fn solid_angle(&self, d: D) -> D::F {
        self.half * d.lit(2.0)
    }

    /// Where a place that is uniform by area goes so that it is uniform by solid angle: both are weights of the second and the third
    /// corner.
    ///
    /// A place far away stays where it is, so that points that are well spread remain so.
    #[inline(always)]
    pub fn place(&self, d: D, [u, v]: [D::F; 2]) -> [D::F; 2] {
        let (one, least) = (d.lit(1.0), d.lit(1e-37));
        let [a, b, c] = self.distances;
        let [arc_bc, arc_ca, arc_ab] = self.arcs;
        // How far from the second corner, and how far along the edge from the first corner to the third.
        let away = one - u;
        let away_inverse = one / d.max(away, least);
        let along = d.min(v * away_inverse, one);
        let left = one - along;

        // The triangle up to the place on that edge has the share `along` of the solid angle: sines of both shares of its half, over the half.
        let half2 = self.half * self.half;
        let share = along * sinc(d, half2 * along * along);
        let rest = left * sinc(d, half2 * left * left);
        let beta = share * arc_ab;
        let delta = rest * d.sqrt(d.lit(2.0) * arc_ab * arc_bc * arc_ca);
        let twice = beta + beta;
        let [of_a, of_c] = [
            (delta + twice) * delta * c,
            d.fma(beta, arc_ca, delta) * twice * a,
        ];
        let of_c = of_c / d.max(of_a + of_c, least);

        // The arc from the second corner to that place: the square of the sine of half the angle from the corner is uniform.
        let on_edge = self.corners[0].scale(one - of_c) + self.corners[2].scale(of_c);
        let distance = d.max(on_edge.length(d), d.lit(1e-18));
        let middle = self.directions[1] + on_edge.scale(one / distance);
        // Cosine of half the arc, and of half the angle.
        let cos2 = d.min(middle.dot(d, middle) * d.lit(0.25), one);
        let (cos, sin2) = (d.sqrt(cos2), one - cos2);
        let cos_away = d.sqrt(d.max(one - away * away * sin2, cos2));
        let of_edge = away * cos_away * d.fma(away, cos, cos_away) * b;
        let of_b = u * (one + away) * d.fma(away, sin2, cos * cos_away) * distance;
        let scale = one / d.max(of_edge + of_b, least);
        [of_b * scale, of_edge * scale * of_c]
    }
}
