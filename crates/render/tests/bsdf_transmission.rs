//! Lobes that scatter to both sides: samples against values and densities, by moments over the whole sphere.

use residual_render::bsdf::{Bsdf, Coated, Diffuse, DiffuseTransmission, Mix};
use residual_render::domain::{Precise, Scalar};
use residual_render::math::Vec3;
use residual_render::math::vec3::vec3;
use residual_render::scene_data::SceneData;
use residual_render::texture::Const;

use crate::support::bsdfs::{facets, frosted, frosted_sheet, glass_scene, view};
use crate::support::random::Rng;
use crate::support::scenes::{FLOOR, floor, scene, surface_at};
use crate::support::stats::Mean;

const TINT: Const<[f32; 3]> = Const([0.9, 0.6, 0.3]);

/// What moments are taken of.
const MOMENTS: usize = 7;

fn moments(wi: [f64; 3]) -> [f64; MOMENTS] {
    let [x, y, z] = wi;
    let below = f64::from(u8::from(z < 0.0));
    [1.0, below, x, y, z, z * z, x * z]
}

/// ∫ pdf·g and ∫ value·g over the sphere, by midpoints.
fn integrals<B: for<'a> Bsdf<Precise<'a>>>(
    data: &SceneData,
    bsdf: &B,
    wo: Vec3<f64>,
    is_front: bool,
) -> [[f64; MOMENTS]; 2] {
    const STEPS: usize = 2048;
    const ANGLES: usize = 256;
    let buffers = data.buffers();
    let d = Precise::new(&buffers);
    let surface = match is_front {
        true => floor(d),
        false => surface_at(d, 0, [0.3, 0.3], [0.0, 0.0, 1.0]),
    };
    let mut sums = [[0.0; MOMENTS]; 2];
    let measure = std::f64::consts::PI * std::f64::consts::TAU / (STEPS * ANGLES) as f64;
    for k in 0..STEPS * ANGLES {
        let (r, z) = (((k / ANGLES) as f64 + 0.5) / STEPS as f64 * std::f64::consts::PI).sin_cos();
        let angle = ((k % ANGLES) as f64 + 0.5) / ANGLES as f64 * std::f64::consts::TAU;
        let wi = [r * angle.cos(), r * angle.sin(), z];
        let value = bsdf.eval(d, &surface, wo, vec3(wi[0], wi[1], wi[2]));
        for (j, g) in moments(wi).into_iter().enumerate() {
            sums[0][j] += value.pdf * g * r * measure;
            sums[1][j] += value.value.y * g * r * measure;
        }
    }
    sums
}

fn check<B>(name: &str, data: &SceneData, bsdf: &B, is_front: bool)
where
    B: for<'a> Bsdf<Precise<'a>> + for<'a> Bsdf<Scalar<'a>>,
{
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let surface = match is_front {
        true => floor(d),
        false => surface_at(d, 0, [0.3, 0.3], [0.0, 0.0, 1.0]),
    };
    let mut rng = Rng::new(93);
    for cos in [1.0, 0.7, 0.3, 0.05] {
        let wo = view(cos, 0.7);
        let mut means = [[Mean::default(); MOMENTS]; 2];
        for _ in 0..200_000 {
            let sample = bsdf.sample(d, &surface, wo, rng.unit3());
            let wi = [sample.wi.x, sample.wi.y, sample.wi.z].map(f64::from);
            // Reflections that end up on the wrong side of the surface count for nothing.
            let is_sampled = sample.pdf > 0.0 && sample.weight.y > 0.0;
            for (j, g) in moments(wi).into_iter().enumerate() {
                means[0][j].add(if is_sampled { g } else { 0.0 });
                means[1][j].add(f64::from(sample.weight.y) * g);
            }
        }
        let exact = vec3(f64::from(wo.x), f64::from(wo.y), f64::from(wo.z));
        let integrals = integrals(data, bsdf, exact, is_front);
        for (what, (means, integrals)) in
            ["density", "value"].iter().zip(means.iter().zip(integrals))
        {
            for (j, (mean, integral)) in means.iter().zip(integrals).enumerate() {
                let error = (mean.value() - integral).abs();
                assert!(
                    error <= 4.5 * mean.error() + 2e-3,
                    "{name}, cos {cos}, {what}, moment {j}: {} ± {} against {integral}",
                    mean.value(),
                    mean.error()
                );
            }
        }
    }
}

#[test]
fn rough_dielectrics() {
    for ior in [1.3, 1.5, 2.4] {
        let data = glass_scene(ior);
        for roughness in [0.5, 0.7, 1.0] {
            let solid = frosted(TINT.0, ior, roughness);
            let name = format!("solid {roughness}, {ior}");
            check(&format!("{name}, entering"), &data, &solid, true);
            check(&format!("{name}, leaving"), &data, &solid, false);
            let sheet = frosted_sheet(TINT.0, ior, roughness);
            check(&format!("sheet {roughness}, {ior}"), &data, &sheet, true);
        }
    }
}

#[test]
fn coated_paper() {
    let paper = Coated {
        coat: facets([0.04; 3], 1.0, 0.5),
        base: Mix {
            a: Diffuse { albedo: TINT },
            b: DiffuseTransmission { color: TINT },
            weight: Const(0.4),
        },
    };
    check("coated paper", &scene(&[FLOOR]), &paper, true);
}

/// The moments do see a wrong lobe.
#[test]
fn another_lobe_is_told_apart() {
    let data = scene(&[FLOOR]);
    let up = vec3(0.0, 0.0, 1.0);
    let [_, entering] = integrals(&data, &Diffuse { albedo: TINT }, up, true);
    let [_, passing] = integrals(&data, &DiffuseTransmission { color: TINT }, up, true);
    assert!((entering[1] - passing[1]).abs() > 0.5);
}
