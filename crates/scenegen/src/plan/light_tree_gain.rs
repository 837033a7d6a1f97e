//! Whether a tree of lights pays: how much less variance it has than a table, at points on the scene's surfaces.

use glam::DVec3;
use residual_render::domain::{Scalar, Uint};
use residual_render::light::LightTree;
use residual_render::scene_data::SceneData;

use super::equal_areas;
use super::light_tree::{LightBounds, Reach};

/// Points at which it is looked.
const POINTS: usize = 64;

/// By how many times the mean square of a sample of one light, without shadows, is larger by the table of these probabilities than by the tree:
/// the geometric mean over points, so that a few of them next to a lamp do not decide. The sky is left out, which has its share either way.
pub(super) fn gain(lights: &[(Reach, f64)], tree: LightTree, data: &SceneData) -> f64 {
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let (mut logarithms, mut points) = (0.0, 0.0);
    for [a, b, c] in equal_areas::triangles(data, POINTS) {
        let at = (a + b + c) / 3.0;
        let (mut by_table, mut by_tree) = (0.0, 0.0);
        for (light, (reach, probability)) in lights.iter().enumerate() {
            let arriving = match reach {
                Reach::Bounded(bounds) => arriving(bounds, at),
                Reach::Everywhere => 0.0,
            };
            if arriving > 0.0 {
                let square = arriving * arriving;
                by_table += square / probability;
                let of_tree =
                    tree.probability(d, at.as_vec3().to_array().into(), Uint(light as u32));
                by_tree += square / f64::from(of_tree);
            }
        }
        let ratio = by_table / by_tree;
        if ratio.is_finite() && ratio > 0.0 {
            logarithms += ratio.ln();
            points += 1.0;
        }
    }
    if points == 0.0 {
        return 1.0;
    }
    f64::exp(logarithms / points)
}

/// What arrives at a point from a light, as if it stood in the middle of its box.
fn arriving(light: &LightBounds, at: DVec3) -> f64 {
    let away = at - light.center();
    let least = 0.25 * light.diagonal2();
    let cos = match light.half_angle == 0.0 {
        true => light.axis.dot(away.normalize_or_zero()).max(0.0),
        false => 1.0,
    };
    light.intensity * cos / away.length_squared().max(least)
}
