//! Triangles that stand for equal parts of the area of a scene's surfaces.

use glam::{DVec3, Vec3};
use residual_render::scene_data::SceneData;

/// The corners of as many triangles as are asked for: large ones are there several times, and of small ones some.
pub(super) fn triangles(data: &SceneData, count: usize) -> Vec<[DVec3; 3]> {
    let positions = data.positions();
    let areas = || {
        positions.as_chunks().0.iter().map(|&corners| {
            let corners = corners.map(|corner: [f32; 3]| Vec3::from_array(corner).as_dvec3());
            let [a, b, c] = corners;
            (corners, (b - a).cross(c - a).length())
        })
    };
    let total: f64 = areas().map(|(_, area)| area).sum();
    let mut chosen = Vec::with_capacity(count);
    let mut sum = 0.0;
    for (corners, area) in areas() {
        sum += area;
        while sum * count as f64 > total * (chosen.len() as f64 + 0.5) {
            chosen.push(corners);
        }
    }
    chosen
}
