//! What denoisers get as the albedo: between 0 and 1, the directional albedo where that is smooth, and what Open Image
//! Denoise asks for where it is not.

use residual_render::bsdf::{
    Black, Bsdf, Dielectric, Diffuse, DirectionalAlbedo, Fresnel, Mirror, Mix, Phong, Roughness,
    Sheen, Solid, Sum, Thin,
};
use residual_render::domain::Precise;
use residual_render::math::Vec3;
use residual_render::math::vec3::vec3;
use residual_render::surface::Surface;
use residual_render::texture::Const;

use crate::support::bsdfs::{facets, metal, plastic};
use crate::support::scenes::{FLOOR, floor, scene, surface_at};

const ORANGE: Const<[f32; 3]> = Const([0.8, 0.5, 0.1]);
const BLUE: Const<[f32; 3]> = Const([0.1, 0.2, 0.7]);
const COSINES: [f64; 5] = [1.0, 0.8, 0.5, 0.1, 1e-3];

fn view(cos: f64) -> Vec3<f64> {
    vec3((1.0 - cos * cos).sqrt(), 0.0, cos)
}

fn colors([r, g, b]: [f32; 3]) -> [f64; 3] {
    [r, g, b].map(f64::from)
}

/// Runs a function of a BSDF at the middle of a floor, seen from its front.
fn at<T>(f: impl for<'a> FnOnce(Precise<'a>, &Surface<Precise<'a>>) -> T) -> T {
    let data = scene(&[FLOOR]);
    let buffers = data.buffers();
    let d = Precise::new(&buffers);
    f(d, &floor(d))
}

fn albedo<B: for<'a> Bsdf<Precise<'a>>>(bsdf: &B, cos: f64) -> [f64; 3] {
    at(|d, surface| {
        let Vec3 { x, y, z } = bsdf.albedo(d, surface, view(cos));
        [x, y, z]
    })
}

/// ∫ f cos dω over the upper hemisphere, by midpoints in the cosine and the angle.
fn integral<B: for<'a> Bsdf<Precise<'a>>>(bsdf: &B, cos: f64) -> [f64; 3] {
    const STEPS: usize = 2048;
    const ANGLES: usize = 256;
    at(|d, surface| {
        let mut sum = [0.0; 3];
        for k in 0..STEPS * ANGLES {
            let u = ((k / ANGLES) as f64 + 0.5) / STEPS as f64;
            let v = ((k % ANGLES) as f64 + 0.5) / ANGLES as f64;
            let sin = (1.0 - u * u).sqrt();
            let (s, c) = (v * std::f64::consts::TAU).sin_cos();
            let value = bsdf
                .eval(d, surface, view(cos), vec3(sin * c, sin * s, u))
                .value;
            let measure = std::f64::consts::TAU / (STEPS * ANGLES) as f64;
            sum = [
                sum[0] + value.x * measure,
                sum[1] + value.y * measure,
                sum[2] + value.z * measure,
            ];
        }
        sum
    })
}

/// The mean weight of samples, over a regular grid of the numbers that choose lobe and direction.
fn mean_weight<B: for<'a> Bsdf<Precise<'a>>>(bsdf: &B, cos: f64) -> [f64; 3] {
    const STEPS: usize = 4096;
    at(|d, surface| {
        let mut sum = [0.0; 3];
        for k in 0..STEPS {
            let u = (k as f64 + 0.5) / STEPS as f64;
            let Vec3 { x, y, z } = bsdf.sample(d, surface, view(cos), [0.3, 0.7, u]).weight;
            sum = [sum[0] + x, sum[1] + y, sum[2] + z];
        }
        sum.map(|c| c / STEPS as f64)
    })
}

#[track_caller]
fn assert_near(name: &str, a: [f64; 3], b: [f64; 3], tolerance: f64) {
    let error = (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
    assert!(error <= tolerance, "{name}: {a:?}, {b:?}");
}

#[test]
fn diffuse_surfaces_and_their_blends_have_their_directional_albedo() {
    let (a, b) = (Diffuse { albedo: ORANGE }, Diffuse { albedo: BLUE });
    let mix = Mix {
        a,
        b,
        weight: Const(0.25),
    };
    let sum = Sum {
        a: Diffuse { albedo: BLUE },
        b: Diffuse {
            albedo: Const([0.25; 3]),
        },
        probability: Const(0.5),
    };
    for cos in COSINES {
        assert_near("diffuse", albedo(&a, cos), integral(&a, cos), 1e-6);
        assert_near("mix", albedo(&mix, cos), integral(&mix, cos), 1e-6);
        assert_near("sum", albedo(&sum, cos), integral(&sum, cos), 1e-6);
        assert_eq!(albedo(&Black, cos), [0.0; 3]);
        let mirror = Mirror {
            reflectance: ORANGE,
        };
        assert_eq!(albedo(&mirror, cos), colors(ORANGE.0));
        assert_near(
            "mirror",
            albedo(&mirror, cos),
            mean_weight(&mirror, cos),
            1e-9,
        );
    }
    // The integral does see a wrong albedo.
    let [r, ..] = integral(&b, 1.0);
    assert!((r - albedo(&a, 1.0)[0]).abs() > 0.5);
}

#[test]
fn phong_has_its_directional_albedo_where_nothing_is_cut_off() {
    for exponent in [1.0, 10.0, 50.0] {
        let phong = Phong {
            color: ORANGE,
            exponent: Const(exponent),
        };
        assert_near("phong", albedo(&phong, 1.0), integral(&phong, 1.0), 1e-4);
    }
}

/// The mean weight of samples over a regular grid of directions.
fn mean_reflection<B: for<'a> Bsdf<Precise<'a>>>(bsdf: &B, cos: f64) -> [f64; 3] {
    const STEPS: usize = 512;
    at(|d, surface| {
        let mut sum = [0.0; 3];
        for k in 0..STEPS * STEPS {
            let u = [k % STEPS, k / STEPS].map(|k| (k as f64 + 0.5) / STEPS as f64);
            let sample = bsdf.sample(d, surface, view(cos), [u[0], u[1], 0.5]);
            let Vec3 { x, y, z } = sample.weight;
            sum = [sum[0] + x, sum[1] + y, sum[2] + z];
        }
        sum.map(|c| c / (STEPS * STEPS) as f64)
    })
}

/// The fits of directional albedos against the lobes themselves.
#[test]
fn facets_have_their_directional_albedo() {
    for roughness in [0.01, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.85, 1.0] {
        for cos in [1.0, 0.9, 0.7, 0.5, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4] {
            for (normal, grazing) in [([0.04; 3], 1.0), (ORANGE.0, 1.0), ([0.0, 0.5, 1.0], 0.3)] {
                let facets = facets(normal, grazing, roughness);
                let name = format!("roughness {roughness}, cos {cos}, {normal:?}");
                let (seen, all) = (albedo(&facets, cos), mean_reflection(&facets, cos));
                // The fit is off by 5e-4 of the first reflection at most, which the rest multiplies.
                let rest = at(|d, surface| {
                    let ggx = facets.roughness.microfacets(d, surface);
                    let curve = facets.fresnel.curve(d, surface, cos);
                    let Vec3 { x, y, z } =
                        DirectionalAlbedo::new(d, &ggx, cos).compensation(d, &curve);
                    [x, y, z]
                });
                let first = |sum: [f64; 3]| [0, 1, 2].map(|k| sum[k] / rest[k]);
                assert_near(&name, first(seen), first(all), 8e-4);
                assert_near(&name, seen, all, 2e-3);
            }
        }
    }
}

/// The lobe of cloth is normalised, whatever the fit of its albedo.
#[test]
fn sheen_has_its_directional_albedo() {
    for roughness in [0.05, 0.1, 0.3, 0.7, 1.0] {
        for cos in [1.0, 0.7, 0.3, 0.1] {
            let sheen = Sheen {
                color: ORANGE,
                roughness: Const(roughness),
            };
            let name = format!("sheen {roughness}, cos {cos}");
            assert_near(&name, albedo(&sheen, cos), integral(&sheen, cos), 2e-3);
        }
    }
}

/// 1 where light is reflected, the tint where it goes through, and what of each the Fresnel factor says.
#[test]
fn dielectrics_have_their_tint_and_their_reflection() {
    let thin = Dielectric {
        transmittance: ORANGE,
        ior: Const(1.5),
        interface: Thin,
    };
    let clear = Dielectric {
        transmittance: Const([1.0; 3]),
        ior: Const(1.5),
        interface: Solid,
    };
    for cos in COSINES {
        assert_near("thin", albedo(&thin, cos), mean_weight(&thin, cos), 1e-3);
        assert_near("clear", albedo(&clear, cos), [1.0; 3], 1e-12);
    }
    // Seen from inside beyond the critical angle, everything is reflected.
    let data = scene(&[FLOOR]);
    let buffers = data.buffers();
    let d = Precise::new(&buffers);
    let inside = surface_at(d, 0, [0.3, 0.3], [0.0, 0.0, 1.0]);
    let solid = Dielectric {
        transmittance: ORANGE,
        ior: Const(1.5),
        interface: Solid,
    };
    let Vec3 { x, y, z } = solid.albedo(d, &inside, view(0.5));
    assert_near("total reflection", [x, y, z], [1.0; 3], 1e-12);
}

#[test]
fn albedos_are_between_0_and_1() {
    fn check<B: for<'a> Bsdf<Precise<'a>>>(name: &str, bsdf: &B) {
        for cos in COSINES {
            let seen = albedo(bsdf, cos);
            assert!(
                seen.iter().all(|c| (0.0..=1.0).contains(c)),
                "{name}, cos {cos}: {seen:?}"
            );
        }
    }
    let colors = [[0.0; 3], [1.0; 3], ORANGE.0].map(Const);
    for color in colors {
        let diffuse = Diffuse { albedo: color };
        let phong = Phong {
            color,
            exponent: Const(20.0),
        };
        check("diffuse", &diffuse);
        check("mirror", &Mirror { reflectance: color });
        check("phong", &phong);
        let glass = Dielectric {
            transmittance: color,
            ior: Const(1.5),
            interface: Solid,
        };
        check("dielectric", &glass);
        for number in [0.0, 0.3, 1.0] {
            check("conductor", &metal(color.0, number));
            let coated = plastic(color.0, 0.2, [0.04, number]);
            check("coat", &coated);
            let mix = Mix {
                a: coated,
                b: glass,
                weight: Const(number),
            };
            check("mix", &mix);
        }
        // A sum may exceed 1 where a file says so; its albedo does not.
        let sum = Sum {
            a: diffuse,
            b: phong,
            probability: Const(0.5),
        };
        check("sum", &sum);
    }
}
