//! What no BSDF may do: give out more than comes in (hard case M-04).

use residual_render::bsdf::{
    Black, Bsdf, Coated, Dielectric, Diffuse, Mirror, Mix, Phong, RoughDiffuse, Sheen, Sum, Thin,
};
use residual_render::domain::{Precise, Scalar};
use residual_render::math::vec3::vec3;
use residual_render::scene_data::SceneData;
use residual_render::texture::Const;

use crate::support::bsdfs::{
    WHITE, coated, conductor, facets, frosted, frosted_sheet, glass_scene, phong, view,
};
use crate::support::random::Rng;
use crate::support::sampling::Side;
use crate::support::scenes::{FLOOR, floor, scene};
use crate::support::stats::Mean;
use crate::support::{Worst, array};

/// Albedo seen from several directions, by sampling.
fn albedos<B: for<'a> Bsdf<Scalar<'a>>>(bsdf: &B) -> Vec<(f64, Mean)> {
    albedos_seen(&scene(&[FLOOR]), bsdf, Side::Front)
}

/// The same, of a side of the floor of a scene.
fn albedos_seen<B: for<'a> Bsdf<Scalar<'a>>>(
    data: &SceneData,
    bsdf: &B,
    side: Side,
) -> Vec<(f64, Mean)> {
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let surface = side.surface(d);
    let mut rng = Rng::new(90);
    let seen = |cos| {
        let mut mean = Mean::default();
        for _ in 0..60_000 {
            let weight = array(bsdf.sample(d, &surface, view(cos, 0.7), rng.unit3()).weight);
            assert!(
                weight.iter().all(|w| w.is_finite() && *w >= 0.0),
                "{weight:?}"
            );
            mean.add(f64::from(weight[0]));
        }
        (cos, mean)
    };
    [1.0, 0.8, 0.5, 0.2, 0.05, 0.01, 1e-3, 1e-4]
        .map(seen)
        .to_vec()
}

/// The white furnace: the 99.9 % confidence interval of the albedo is narrow and not wholly above 1. (Its upper
/// end is above 1 by chance wherever the albedo is exactly 1.)
#[track_caller]
fn assert_no_gain<B: for<'a> Bsdf<Scalar<'a>>>(name: &str, bsdf: &B) {
    for (cos, albedo) in albedos(bsdf) {
        let lower = albedo.value() - 3.09 * albedo.error();
        println!(
            "{name}, cos {cos}: albedo {:.4} ± {:.4}",
            albedo.value(),
            albedo.error()
        );
        assert!(
            lower <= 1.0 + 1e-3,
            "{name}, cos {cos}: albedo at least {lower}"
        );
        assert!(
            albedo.error() < 1e-2,
            "{name}, cos {cos}: albedo unknown, ± {}",
            albedo.error()
        );
    }
}

const ROUGHNESSES: [f32; 8] = [0.0, 0.01, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0];

#[test]
fn furnace_of_metals() {
    for roughness in ROUGHNESSES {
        assert_no_gain(&format!("conductor {roughness}"), &conductor(roughness));
    }
    // A mirror loses nothing.
    for (cos, albedo) in albedos(&conductor(0.0)) {
        assert!(
            (albedo.value() - 1.0).abs() < if cos > 0.04 { 1e-4 } else { 2e-2 },
            "{cos}: {}",
            albedo.value()
        );
    }
}

/// What absorbs nothing loses nothing, and gains nothing: the albedo is 1, up to the fits of directional albedos.
#[track_caller]
fn assert_conserves<B: for<'a> Bsdf<Scalar<'a>>>(name: &str, bsdf: &B) {
    assert_conserves_seen(name, &scene(&[FLOOR]), bsdf, Side::Front);
}

#[track_caller]
fn assert_conserves_seen<B: for<'a> Bsdf<Scalar<'a>>>(
    name: &str,
    data: &SceneData,
    bsdf: &B,
    side: Side,
) {
    for (cos, albedo) in albedos_seen(data, bsdf, side) {
        let (value, error) = (albedo.value(), 3.09 * albedo.error());
        println!("{name}, cos {cos}: {value:.4} ± {error:.4}");
        assert!(
            value - error <= 1.0 + 1e-3,
            "{name}, cos {cos}: {value} ± {error}"
        );
        assert!(
            value + error >= 1.0 - 5e-3,
            "{name}, cos {cos}: {value} ± {error}"
        );
        assert!(
            error < 3e-2,
            "{name}, cos {cos}: unknown, {value} ± {error}"
        );
    }
}

#[test]
fn white_metals_conserve_light() {
    for roughness in ROUGHNESSES {
        assert_conserves(&format!("conductor {roughness}"), &conductor(roughness));
    }
}

#[test]
fn white_coated_surfaces_conserve_light() {
    for roughness in ROUGHNESSES {
        for reflectance in [0.0, 0.04, 0.5, 1.0] {
            let name = format!("coated {roughness}, F₀ {reflectance}");
            assert_conserves(&name, &coated(roughness, reflectance));
        }
        let base = Diffuse { albedo: WHITE };
        let sheen = Sheen {
            color: WHITE,
            roughness: Const(roughness),
        };
        assert_conserves(&format!("cloth {roughness}"), &Coated { coat: sheen, base });
        let clear_coat = Coated {
            coat: facets([0.04; 3], 1.0, 0.1),
            base: conductor(roughness),
        };
        assert_conserves(&format!("clear coat on {roughness}"), &clear_coat);
    }
}

/// Clay that absorbs nothing loses nothing: up to its fits, 1e-3.
#[test]
fn white_clay_conserves_light() {
    for roughness in ROUGHNESSES {
        let clay = RoughDiffuse {
            albedo: WHITE,
            roughness: Const(roughness),
        };
        assert_conserves(&format!("clay {roughness}"), &clay);
        let coat = facets([0.04; 3], 1.0, 0.3);
        let coated = Coated { coat, base: clay };
        assert_conserves(&format!("glazed clay {roughness}"), &coated);
    }
}

/// Smooth clay is a Lambertian surface, whatever the samples.
#[test]
fn smooth_clay_is_matte() {
    let data = scene(&[FLOOR]);
    let buffers = data.buffers();
    let d = Precise::new(&buffers);
    let surface = floor(d);
    let albedo = Const([0.8, 0.4, 0.1]);
    let clay = RoughDiffuse {
        albedo,
        roughness: Const(0.0),
    };
    let matte = Diffuse { albedo };
    let mut worst = Worst::default();
    let mut rng = Rng::new(94);
    for _ in 0..10_000 {
        let mut direction = || {
            let [x, y, z] = rng.direction();
            vec3(x, y, z.abs())
        };
        let (wo, wi) = (direction(), direction());
        let [a, b] = [
            clay.eval(d, &surface, wo, wi),
            matte.eval(d, &surface, wo, wi),
        ];
        let differences = array(a.value - b.value).into_iter().chain([a.pdf - b.pdf]);
        let difference = differences.map(f64::abs).fold(0.0, f64::max);
        worst.add(difference, || format!("{wo:?} {wi:?}"));
    }
    worst.assert_below(1e-9, "smooth clay against a Lambertian surface");
}

/// Glass that absorbs nothing loses nothing, from either side. Radiance is divided by η² where it is carried across.
#[test]
fn clear_rough_glass_conserves_light() {
    for ior in [1.1_f32, 1.33, 1.5, 2.0, 2.5] {
        let data = glass_scene(ior);
        for roughness in [0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0] {
            for (side, tint) in [(Side::Front, ior * ior), (Side::Back, 1.0 / ior / ior)] {
                let solid = frosted([tint; 3], ior, roughness);
                let name = format!("solid {roughness}, {ior}, {side:?}");
                assert_conserves_seen(&name, &data, &solid, side);
            }
            let sheet = frosted_sheet([1.0; 3], ior, roughness);
            assert_conserves(&format!("sheet {roughness}, {ior}"), &sheet);
        }
    }
}

/// The table of albedos, between its entries, against the mean weight of samples in `f64`: 1, if glass absorbs nothing.
#[test]
fn tabulated_albedos_are_those_of_rough_glass() {
    const SAMPLES: u32 = 200_000;
    let mut worst = Worst::default();
    for ior in [1.1_f32, 1.5, 2.5] {
        let data = glass_scene(ior);
        let buffers = data.buffers();
        let d = Precise::new(&buffers);
        for (side, tint) in [(Side::Front, ior * ior), (Side::Back, 1.0 / ior / ior)] {
            let surface = side.surface(d);
            for roughness in [0.03, 0.14, 0.37, 0.55, 0.73, 0.95] {
                let glass = frosted([tint; 3], ior, roughness);
                for cos in [0.003, 0.02, 0.13, 0.4, 0.7, 0.85, 0.97] {
                    let wo = vec3(f64::sqrt(1.0 - cos * cos), 0.0, cos);
                    // A lattice of irrational steps, well spread over the cube.
                    let step = 1.220_744_084_605_759_5_f64;
                    let mean = (0..SAMPLES).map(|k| {
                        let u = [1, 2, 3].map(|p| (0.5 + f64::from(k) / step.powi(p)).fract());
                        glass.sample(d, &surface, wo, u).weight.x
                    });
                    let mean = mean.sum::<f64>() / f64::from(SAMPLES);
                    worst.add((mean - 1.0).abs(), || {
                        format!("{roughness}, {ior}, {side:?}, cos {cos}: {mean}")
                    });
                }
            }
        }
    }
    worst.assert_below(2.5e-3, "tabulated albedos");
}

#[test]
fn mirrors_reflect_their_reflectance_into_the_mirrored_direction() {
    let data = scene(&[FLOOR]);
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let surface = floor(d);
    let mirror = Mirror {
        reflectance: Const([0.9, 0.5, 0.1]),
    };
    for cos in [1.0, 0.8, 0.5, 0.2, 0.05, 1e-4] {
        let wo = view(cos, 0.7);
        let sample = mirror.sample(d, &surface, wo, [0.3, 0.6, 0.9]);
        assert_eq!(sample.wi, vec3(-wo.x, -wo.y, wo.z));
        assert_eq!(sample.weight, vec3(0.9, 0.5, 0.1));
        assert_eq!((sample.pdf, sample.delta), (0.0, true));
        let value = mirror.eval(d, &surface, wo, sample.wi);
        assert_eq!((value.value.x, value.pdf), (0.0, 0.0));
    }
    // White mirrors lose nothing, alone or beside a diffuse lobe.
    let half = Const([0.5; 3]);
    let sum = Sum {
        a: Diffuse { albedo: half },
        b: Mirror { reflectance: half },
        probability: Const(0.3),
    };
    for (_, albedo) in albedos(&Mirror { reflectance: WHITE }) {
        assert_eq!((albedo.value(), albedo.error()), (1.0, 0.0));
    }
    for (cos, albedo) in albedos(&sum) {
        let error = (albedo.value() - 1.0).abs();
        assert!(error <= 4.0 * albedo.error() + 1e-6, "{cos}: {error}");
    }
}

#[test]
fn furnace_of_phong() {
    for exponent in [0.0, 1.0, 5.0, 20.0, 100.0, 500.0, 10_000.0] {
        assert_no_gain(&format!("phong {exponent}"), &phong(exponent));
    }
}

/// Up to the exponent that importers allow, 32 bits tell a lobe from its surroundings: it reflects what a mirror does, times
/// the cosine.
#[test]
fn sharp_phong_loses_nothing() {
    for exponent in [1e4, 1e5, 1e6] {
        for (cos, albedo) in albedos(&phong(exponent)).into_iter().take(4) {
            let error = (albedo.value() / cos - 1.0).abs();
            assert!(error < 2e-3, "{exponent}, cos {cos}: {error}");
        }
    }
}

#[test]
fn furnace_of_combinations() {
    let base = Diffuse { albedo: WHITE };
    let half = Diffuse {
        albedo: Const([0.5; 3]),
    };
    let shiny = Phong {
        color: Const([0.5; 3]),
        exponent: Const(30.0),
    };
    assert_no_gain(
        "mix",
        &Mix {
            a: base,
            b: conductor(0.3),
            weight: Const(0.4),
        },
    );
    assert_no_gain(
        "mix with glass",
        &Mix {
            a: base,
            b: Dielectric {
                transmittance: WHITE,
                ior: Const(1.5),
                interface: Thin,
            },
            weight: Const(0.4),
        },
    );
    assert_no_gain(
        "sum",
        &Sum {
            a: half,
            b: shiny,
            probability: Const(0.3),
        },
    );
    assert_no_gain(
        "ends",
        &Mix {
            a: base,
            b: Mix {
                a: base,
                b: phong(9.0),
                weight: Const(1.0),
            },
            weight: Const(0.0),
        },
    );
    // What mixes lose nothing: the estimator's mean does not depend on how lobes are chosen.
    let glass = Dielectric {
        transmittance: WHITE,
        ior: Const(1.5),
        interface: Thin,
    };
    for (_, albedo) in albedos(&Mix {
        a: base,
        b: glass,
        weight: Const(0.25),
    }) {
        assert!((albedo.value() - 1.0).abs() < 1e-6);
    }
    for (_, albedo) in albedos(&Sum {
        a: half,
        b: half,
        probability: Const(0.8),
    }) {
        assert!((albedo.value() - 1.0).abs() < 1e-6);
    }
}

#[test]
fn furnace_finds_a_gain() {
    let bright = Diffuse {
        albedo: Const([0.6; 3]),
    };
    let sum = Sum {
        a: bright,
        b: bright,
        probability: Const(0.5),
    };
    assert!(std::panic::catch_unwind(|| assert_no_gain("too bright", &sum)).is_err());
}

#[test]
fn diffuse_returns_exactly_its_albedo() {
    for (_, albedo) in albedos(&Diffuse { albedo: WHITE }) {
        assert_eq!((albedo.value(), albedo.error()), (1.0, 0.0));
    }
    for (_, albedo) in albedos(&Black) {
        assert_eq!(albedo.value(), 0.0);
    }
}
