//! Rays through a closed surface: aimed at edges that two triangles share, and counted if they hit nothing there (hard case I-01).
//!
//! Rays of an image, and random ones, all but never meet an edge so closely that it matters; a leak is seen as a bright pixel once in a
//! million paths. Aimed rays meet one every time.

use std::collections::HashMap;

use glam::DVec3;
use residual_accuracy::sweep::FailureRate;
use residual_bvh::Ray;
use residual_device_cpu::{AnyBvh, Width};
use residual_frontend::hierarchy_quality;
use residual_render::scene_data::SceneData;

use super::random::Random;
use residual_variants::TraversalPrecision;

/// An edge of two triangles.
struct SharedEdge {
    ends: [DVec3; 2],
    /// The third corners.
    others: [DVec3; 2],
}

/// A scene's triangles, both sides of which can be hit, and the edges to aim at.
pub struct Target {
    bvh: AnyBvh,
    edges: Vec<SharedEdge>,
    diagonal: f64,
    least_distance: f64,
}

/// Rays are traced so many at a time.
const BATCH: usize = 4096;

/// A ray's angle to a triangle's plane has at least this sine: seen edge-on, a triangle may be missed.
const LEAST_SINE: f64 = 0.05;

/// Triangles that are thinner, relative to the edge, are left out: the end of an aimed ray is rounded, and may lie beyond.
const LEAST_HEIGHT: f64 = 1e-3;

/// Rays begin at least so far from the edge, relative to the largest coordinate: the rounding of the edge's points is small beside it.
const LEAST_DISTANCE: f64 = 1e-3;

/// Relative distance beyond the edge up to which a hit counts: more than rounding takes, at the least distance and sine.
const SLACK: f32 = 0.02;

impl Target {
    /// The triangles of these data, which must have no culling.
    pub fn new(data: &SceneData) -> Self {
        let positions: Vec<DVec3> = data
            .positions()
            .iter()
            .map(|p| DVec3::from(p.map(f64::from)))
            .collect();
        let quality = hierarchy_quality(data.triangle_count());
        let low = positions
            .iter()
            .copied()
            .reduce(DVec3::min)
            .unwrap_or_default();
        let high = positions
            .iter()
            .copied()
            .reduce(DVec3::max)
            .unwrap_or_default();
        let largest = low.abs().max(high.abs()).max_element();
        Self {
            bvh: AnyBvh::build(data, Width::Native, quality),
            edges: shared_edges(&positions, &data.triangles(), 1e-4 * largest),
            diagonal: (high - low).length(),
            least_distance: LEAST_DISTANCE * largest,
        }
    }

    /// How many of this number of rays pass between two triangles; `None` if no edge is shared. The same rays for all precisions.
    pub fn misses(&self, precision: TraversalPrecision, rays: u64) -> Option<FailureRate> {
        if self.edges.is_empty() {
            return None;
        }
        let traversal = precision.of(&self.bvh);
        let mut random = Random(1);
        let (mut trials, mut failures) = (0, 0);
        let mut batch = Vec::with_capacity(BATCH);
        let mut hit = vec![false; BATCH];
        // Edges that are seen edge-on from everywhere tried give no ray; an end to that is needed.
        let mut attempts = 20 * rays;
        while trials < rays && attempts > 0 {
            batch.clear();
            while batch.len() < BATCH.min((rays - trials) as usize) && attempts > 0 {
                attempts -= 1;
                batch.extend(self.aimed(&mut random));
            }
            let hit = &mut hit[..batch.len()];
            traversal.any_hits(&batch, hit, None);
            trials += batch.len() as u64;
            failures += hit.iter().filter(|hit| !**hit).count() as u64;
        }
        (trials > 0).then_some(FailureRate { failures, trials })
    }

    /// A ray to a random point of a random edge, from which its two triangles are seen on two sides of the edge.
    fn aimed(&self, random: &mut Random) -> Option<Ray> {
        let edge = &self.edges[random.below(self.edges.len())];
        let [a, b] = edge.ends;
        let target = a.lerp(b, 0.05 + 0.9 * random.unit());
        let (z, turn) = (
            2.0 * random.unit() - 1.0,
            std::f64::consts::TAU * random.unit(),
        );
        let around = (1.0 - z * z).sqrt();
        let dir = DVec3::new(around * turn.cos(), around * turn.sin(), z);
        let sine = |other: DVec3| (b - a).cross(other - a).normalize().dot(dir);
        let [first, second] = edge.others.map(sine);
        if first * second >= 0.0 || first.abs().min(second.abs()) < LEAST_SINE {
            return None;
        }
        // From a tenth of the edge to the size of the scene, any scale as often.
        let nearest = (0.1 * (b - a).length()).max(self.least_distance);
        let distance = nearest * (self.diagonal / nearest).powf(random.unit());
        let (target, org) = (target.as_vec3(), (target - distance * dir).as_vec3());
        Some(Ray {
            org: org.to_array(),
            tmin: 0.0,
            dir: (target - org).to_array(),
            tmax: 1.0 + SLACK,
        })
    }
}

/// Edges of exactly two triangles, neither of which is thin.
fn shared_edges(positions: &[DVec3], triangles: &[[u32; 3]], least_height: f64) -> Vec<SharedEdge> {
    let key = |p: DVec3| p.to_array().map(f64::to_bits);
    let mut found: HashMap<[[u64; 3]; 2], (usize, SharedEdge)> = HashMap::new();
    for triangle in triangles {
        let corners = triangle.map(|index| positions[index as usize]);
        for k in 0..3 {
            let [a, b, other] = [0, 1, 2].map(|i| corners[(k + i) % 3]);
            let height = (b - a).cross(other - a).length() / (b - a).length();
            if !(height > LEAST_HEIGHT * (b - a).length() && height > least_height) {
                continue;
            }
            let mut ends = [key(a), key(b)];
            ends.sort_unstable();
            let edge = SharedEdge {
                ends: [a, b],
                others: [other; 2],
            };
            let (count, edge) = found.entry(ends).or_insert((0, edge));
            *count += 1;
            edge.others[1] = other;
        }
    }
    let mut edges: Vec<_> = found
        .into_iter()
        .filter(|(_, (count, _))| *count == 2)
        .collect();
    // A map has no order of its own, and rays are to be the same every time.
    edges.sort_unstable_by_key(|(ends, _)| *ends);
    edges.into_iter().map(|(_, (_, edge))| edge).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use residual_render::triangle::TriangleRecord;

    /// A tetrahedron's edges are all shared, and a lone triangle's none.
    #[test]
    fn edges_of_two_triangles_are_found() {
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let corners = corners.map(DVec3::from);
        let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        assert_eq!(shared_edges(&corners, &faces, 1e-4).len(), 6);
        assert_eq!(shared_edges(&corners, &faces[..1], 1e-4).len(), 0);
        assert_eq!(shared_edges(&corners, &faces, 2.0).len(), 0);
    }

    /// A closed sphere with bumps, away from the origin, where coordinates have few digits to spare.
    fn sphere() -> SceneData {
        let point = |i: u32, j: u32| {
            let (theta, phi) = (f64::from(i) / 16.0, f64::from(j % 32) / 16.0);
            let [theta, phi] = [theta, phi].map(|x| x * std::f64::consts::PI);
            let radius = 1.0 + 0.2 * (9.0 * theta).sin() * (7.0 * phi).sin();
            let around = radius * theta.sin();
            [around * phi.cos(), around * phi.sin(), radius * theta.cos()]
                .map(|x| (x + 37.3) as f32)
        };
        let mut data = SceneData::default();
        for (i, j) in (1..15).flat_map(|i| (0..32).map(move |j| (i, j))) {
            let [a, b, c, d] = [
                point(i, j),
                point(i + 1, j),
                point(i, j + 1),
                point(i + 1, j + 1),
            ];
            data.push(TriangleRecord::new([a, b, d]));
            data.push(TriangleRecord::new([a, d, c]));
        }
        data
    }

    #[test]
    fn aimed_rays_find_leaks_where_there_are_some() {
        let target = Target::new(&sphere());
        let misses = |precision| target.misses(precision, 200_000).unwrap();
        assert_eq!(misses(TraversalPrecision::Watertight).failures, 0);
        assert_eq!(misses(TraversalPrecision::Exact).failures, 0);
        let fast = misses(TraversalPrecision::Fast);
        assert!(fast.failures > 10 && fast.trials == 200_000, "{fast:?}");
        assert_eq!(misses(TraversalPrecision::Fast), fast);
    }

    #[test]
    fn without_shared_edges_nothing_is_said() {
        let mut data = SceneData::default();
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        data.push(TriangleRecord::new(corners));
        assert_eq!(
            Target::new(&data).misses(TraversalPrecision::Fast, 10),
            None
        );
    }
}
