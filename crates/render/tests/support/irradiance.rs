//! Irradiance, estimated by sampling lights.

use residual_render::domain::Scalar;
use residual_render::light::{self, LightKinds, LightSample};
use residual_render::scene_data::SceneData;

use crate::support::random::Rng;
use crate::support::scenes::floor;
use crate::support::stats::Mean;
use crate::support::{array, dot};

/// Contribution of a sample to the irradiance on a surface with this normal.
fn irradiance<'a>(sample: &LightSample<Scalar<'a>>, normal: [f64; 3]) -> f64 {
    let cos = dot(array(sample.wi).map(f64::from), normal).max(0.0);
    if cos == 0.0 {
        0.0
    } else {
        f64::from(sample.radiance.x) * cos / f64::from(sample.pdf)
    }
}

/// Mean of the contributions at the middle of triangle 0.
pub(crate) fn estimate<L: for<'a> LightKinds<Scalar<'a>>>(
    data: &SceneData,
    lights: &L,
    normal: [f64; 3],
    n: usize,
    seed: u64,
) -> Mean {
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let surface = floor(d);
    let mut rng = Rng::new(seed);
    let mut mean = Mean::default();
    for _ in 0..n {
        let [a, b, c] = rng.unit3();
        mean.add(irradiance(
            &light::sample(d, lights, surface.point, [a, b, c]),
            normal,
        ));
    }
    mean
}
