//! Polygons as triangles, whatever their outline: concave, not planar, with doubled or collinear corners.

use earcut::Earcut;
use glam::{DVec2, DVec3, Vec3};

/// How much work polygons that are not convex may be together, in squares of their numbers of corners: earcut takes
/// about that time for outlines that cross themselves everywhere. It is seconds, and millions of sane polygons.
const CONCAVE_WORK: u64 = 1_000_000_000;

/// Triangles may cover so much more or less than the polygon, relative to its area.
const AREA_TOLERANCE: f64 = 1e-4;

/// Negative areas of triangles up to this share of the polygon's are rounding.
const CONCAVITY_TOLERANCE: f64 = 1e-6;

/// Corners are on the plane of a polygon up to this part of the root of its area.
const FLATNESS: f64 = 0.01;

/// A polygon whose area is this part of that of its fan is a bow tie, whose halves go around in opposite directions.
const BOW_TIE: f64 = 1e-3;

/// How well triangles cover a polygon.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::import) enum Coverage {
    /// They do.
    Exact,
    /// They cannot, as the outline crosses itself, or do not, as cutting it would take too long.
    Approximate,
}

/// The vector area of a polygon, by Newell's method: normal to the plane that fits its corners best.
pub(in crate::import) fn vector_area(corners: &[Vec3]) -> DVec3 {
    let Some(&origin) = corners.first() else {
        return DVec3::ZERO;
    };
    let [origin, mut previous] = [origin, origin].map(Vec3::as_dvec3);
    let mut sum = DVec3::ZERO;
    for corner in corners.iter().map(|corner| corner.as_dvec3()) {
        sum += (previous - origin).cross(corner - origin);
        previous = corner;
    }
    0.5 * sum
}

/// Cuts polygons into triangles, and keeps its memory between them.
pub(in crate::import) struct Triangulator {
    /// What is left of [`CONCAVE_WORK`].
    work_left: u64,
    earcut: Earcut<f64>,
    outline: Vec<[f64; 2]>,
    cut: Vec<u32>,
}

impl Triangulator {
    /// With no memory yet.
    pub(in crate::import) fn new() -> Self {
        Self {
            work_left: CONCAVE_WORK,
            earcut: Earcut::new(),
            outline: Vec::new(),
            cut: Vec::new(),
        }
    }

    /// Appends triangles of indices of `corners`, of which there are at least three: a fan around the first one where
    /// no triangle of it faces backwards, seen along the polygon's normal; the other diagonal of quadrilaterals,
    /// and what earcut finds, elsewhere.
    pub(in crate::import) fn triangulate(
        &mut self,
        corners: &[Vec3],
        triangles: &mut Vec<[u32; 3]>,
    ) -> Coverage {
        let count = corners.len() as u32;
        let fan = (1..count.saturating_sub(1)).map(|corner| [0, corner, corner + 1]);
        let area_vector = vector_area(corners);
        let area = area_vector.length();
        if count <= 3 || !area.is_finite() {
            triangles.extend(fan);
            return Coverage::Exact;
        }
        let fan_area = || -> f64 {
            let triangle = |triangle: [u32; 3]| triangle.map(|corner| corners[corner as usize]);
            let areas = fan.clone().map(|of| vector_area(&triangle(of)).length());
            areas.sum()
        };
        if area == 0.0 {
            // What is a line or a point is covered by nothing.
            let coverage = match fan_area() > 0.0 {
                true => Coverage::Approximate,
                false => Coverage::Exact,
            };
            triangles.extend(fan);
            return coverage;
        }
        let (x, y) = (area_vector / area).any_orthonormal_pair();
        let origin = corners[0].as_dvec3();
        self.outline.clear();
        self.outline.extend(corners.iter().map(|corner| {
            let offset = corner.as_dvec3() - origin;
            [offset.dot(x), offset.dot(y)]
        }));
        let outline = &self.outline;
        let faces_forward =
            |triangle: [u32; 3]| signed_area(outline, triangle) >= -CONCAVITY_TOLERANCE * area;
        if fan.clone().all(faces_forward) {
            triangles.extend(fan);
            return Coverage::Exact;
        }
        let other_diagonal = [[1, 2, 3], [1, 3, 0]];
        if count == 4 && other_diagonal.into_iter().all(faces_forward) {
            triangles.extend(other_diagonal);
            return Coverage::Exact;
        }
        let work = u64::from(count).pow(2);
        if let Some(work_left) = self.work_left.checked_sub(work)
            && count > 4
        {
            self.work_left = work_left;
            self.earcut.earcut_slice(outline, &[], &mut self.cut);
            let (cut, _) = self.cut.as_chunks::<3>();
            let covered: f64 = cut
                .iter()
                .map(|&triangle| signed_area(outline, triangle).abs())
                .sum();
            if (covered - area).abs() <= AREA_TOLERANCE * area {
                triangles.extend(cut.iter().map(|&[a, b, c]| {
                    match signed_area(outline, [a, b, c]) < 0.0 {
                        true => [a, c, b],
                        false => [a, b, c],
                    }
                }));
                return Coverage::Exact;
            }
        }
        // Without holes, at least.
        let is_bow_tie = area < BOW_TIE * fan_area();
        triangles.extend(fan);
        let normal = area_vector / area;
        let height = |corner: &Vec3| (corner.as_dvec3() - origin).dot(normal).abs();
        let is_flat = corners
            .iter()
            .all(|corner| height(corner) <= FLATNESS * area.sqrt());
        // Folded quadrilaterals have no outline; either diagonal is right.
        match count == 4 && !is_flat && !is_bow_tie {
            true => Coverage::Exact,
            false => Coverage::Approximate,
        }
    }
}

fn signed_area(outline: &[[f64; 2]], triangle: [u32; 3]) -> f64 {
    let [a, b, c] = triangle.map(|corner| DVec2::from(outline[corner as usize]));
    0.5 * (b - a).perp_dot(c - a)
}

#[cfg(test)]
mod tests {
    use glam::{Mat3, Vec2};

    use super::*;

    fn cut(corners: &[Vec3]) -> (Vec<[u32; 3]>, Coverage) {
        let mut triangles = Vec::new();
        let coverage = Triangulator::new().triangulate(corners, &mut triangles);
        (triangles, coverage)
    }

    /// Whether a point is inside, by the parity of crossings.
    fn is_inside(outline: &[Vec2], point: Vec2) -> bool {
        let edges = outline.iter().zip(outline.iter().cycle().skip(1));
        let crossed = edges.filter(|&(&a, &b)| {
            (a.y > point.y) != (b.y > point.y)
                && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x)
        });
        crossed.count() % 2 == 1
    }

    /// Triangles cover the points of a grid that are inside once, the others never, from any first corner, in any
    /// direction, either way around.
    fn check(outline: &[[f32; 2]]) {
        let turns = [
            Mat3::IDENTITY,
            Mat3::from_rotation_x(1.0),
            Mat3::from_rotation_y(2.5) * Mat3::from_rotation_z(0.7),
        ];
        for turn in turns {
            for start in 0..outline.len() {
                let mut outline: Vec<Vec2> = outline.iter().map(|&point| point.into()).collect();
                outline.rotate_left(start);
                for is_reversed in [false, true] {
                    if is_reversed {
                        outline.reverse();
                    }
                    let corners: Vec<Vec3> = outline
                        .iter()
                        .map(|point| turn * point.extend(0.3))
                        .collect();
                    let (triangles, coverage) = cut(&corners);
                    assert_eq!(coverage, Coverage::Exact);
                    let normal = vector_area(&corners).normalize();
                    for &triangle in &triangles {
                        let [a, b, c] = triangle.map(|corner| corners[corner as usize].as_dvec3());
                        assert!(
                            (b - a).cross(c - a).dot(normal) >= -1e-6,
                            "{triangles:?} faces backwards"
                        );
                    }
                    for point in (0..900).map(|i| Vec2::new((i % 30) as f32, (i / 30) as f32)) {
                        let point = point * Vec2::new(0.1, 0.1037) - 1.4567;
                        let covering = triangles.iter().filter(|triangle| {
                            is_inside(&triangle.map(|corner| outline[corner as usize]), point)
                        });
                        assert_eq!(
                            covering.count(),
                            usize::from(is_inside(&outline, point)),
                            "{point} {outline:?}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn outlines_are_covered_once() {
        // A square, with a collinear corner, and with a doubled one.
        check(&[[-1., -1.], [1., -1.], [1., 1.], [-1., 1.]]);
        check(&[[-1., -1.], [0., -1.], [1., -1.], [1., 1.], [-1., 1.]]);
        check(&[[-1., -1.], [1., -1.], [1., -1.], [1., 1.], [-1., 1.]]);
        // An arrow head, an L, a U, a star.
        check(&[[-1., -1.], [0., -0.2], [1., -1.], [0., 1.]]);
        check(&[
            [1., -1.],
            [1., 0.],
            [0., 0.],
            [0., 1.],
            [-1., 1.],
            [-1., -1.],
        ]);
        let third = 1.0 / 3.0;
        check(&[
            [third, 1.],
            [third, -third],
            [-third, -third],
            [-third, 1.],
            [-1., 1.],
            [-1., -1.],
            [1., -1.],
            [1., 1.],
        ]);
        let star: Vec<[f32; 2]> = (0..14)
            .map(|i| {
                let (angle, radius) = (i as f32 * std::f32::consts::TAU / 14.0, [1.0, 0.3][i % 2]);
                [radius * angle.cos(), radius * angle.sin()]
            })
            .collect();
        check(&star);
        // A wall with a window, cut open where its two outlines are joined.
        check(&[
            [-1., -1.],
            [1., -1.],
            [1., 1.],
            [-1., 1.],
            [-1., -1.],
            [-0.5, -0.5],
            [-0.5, 0.5],
            [0.5, 0.5],
            [0.5, -0.5],
            [-0.5, -0.5],
        ]);
    }

    #[test]
    fn convex_polygons_are_fans_of_their_first_corner() {
        let hexagon: Vec<Vec3> = (0..6)
            .map(|i| Vec2::from_angle(i as f32 * std::f32::consts::FRAC_PI_3))
            .map(|point| Vec3::new(point.x, 5.0, point.y))
            .collect();
        let fan = vec![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
        assert_eq!(cut(&hexagon), (fan, Coverage::Exact));
        let saddle = [
            Vec3::ZERO,
            Vec3::new(1., 0., 1.),
            Vec3::new(1., 1., 0.),
            Vec3::new(0., 1., 1.),
        ];
        assert_eq!(cut(&saddle), (vec![[0, 1, 2], [0, 2, 3]], Coverage::Exact));
    }

    #[test]
    fn a_corner_out_of_the_plane_keeps_the_outline() {
        // An L whose inner corner is lifted: from above, it is the L.
        let corners = [
            [1., -1., 0.],
            [1., 0., 0.],
            [0., 0., 0.4],
            [0., 1., 0.],
            [-1., 1., 0.],
            [-1., -1., 0.],
        ];
        let corners = corners.map(Vec3::from);
        let (triangles, coverage) = cut(&corners);
        assert_eq!((triangles.len(), coverage), (4, Coverage::Exact));
        let area: f64 = triangles
            .iter()
            .map(|triangle| vector_area(&triangle.map(|corner| corners[corner as usize])).z)
            .sum();
        assert!((area - 3.0).abs() < 1e-9, "{area}");
        assert!(!triangles.iter().any(|triangle| !triangle.contains(&2)
            && triangle.contains(&1)
            && triangle.contains(&3)));
    }

    #[test]
    fn outlines_that_make_no_polygon_are_said_to_be_approximate_or_empty() {
        let crossed = [[0., 0., 0.], [2., 2., 0.], [2., 0., 0.], [0., 1., 0.]].map(Vec3::from);
        assert_eq!(cut(&crossed).1, Coverage::Approximate);
        // Bow ties, of which both halves are as large, nearly so, or not; in a plane that is none of the axes'.
        for middle in [1.0, 1.000_01, 1.01, 1.5] {
            let corners = [[0., 0.], [1., 1.], [1., 0.], [0., middle]];
            let corners = corners.map(|[x, y]| Vec3::new(x, y, 0.3 * x + 0.7 * y));
            let (triangles, coverage) = cut(&corners);
            assert_eq!(coverage, Coverage::Approximate, "{middle}");
            // As other programs show them.
            assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
        }
        let line = [[0., 0., 0.], [1., 0., 0.], [2., 0., 0.], [3., 0., 0.]].map(Vec3::from);
        assert_eq!(
            (cut(&line).0.len(), cut(&line).1),
            (2, Coverage::Exact),
            "without area, which normals deal with"
        );
        assert_eq!(
            cut(&[Vec3::NAN; 5]).0.len(),
            3,
            "left out later, as any triangle of such corners"
        );
    }

    #[test]
    fn folded_quadrilaterals_are_two_triangles() {
        let mut state = 7_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / 16_777_216.0
        };
        for _ in 0..1000 {
            let corners = [[0., 0.], [0.1, 0.], [0.1, 0.1], [0., 0.1]]
                .map(|[x, y]| Vec3::new(x, y, random()));
            let (triangles, coverage) = cut(&corners);
            assert_eq!(
                (triangles.len(), coverage),
                (2, Coverage::Exact),
                "{corners:?}"
            );
        }
    }

    #[test]
    fn hostile_outlines_end_as_fans() {
        let mut state = 1_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32
        };
        let corners: Vec<Vec3> = (0..20_000)
            .map(|_| Vec3::new(random(), random(), 0.0))
            .collect();
        let (mut triangulator, mut triangles) = (Triangulator::new(), Vec::new());
        for _ in 0..100 {
            triangles.clear();
            let coverage = triangulator.triangulate(&corners, &mut triangles);
            assert_eq!(coverage, Coverage::Approximate);
        }
        assert_eq!(triangles[1], [0, 2, 3]);
        assert!(triangulator.work_left < 20_000 * 20_000);
    }
}
