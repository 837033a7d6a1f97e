//! What denoisers get as the albedo: between 0 and 1, the directional albedo where that is smooth, and what Open Image
//! Denoise asks for where it is not.

use residual_render::bsdf::{
    Black, Bsdf, CoatedDiffuse, Conductor, Dielectric, Diffuse, Mirror, Mix, Phong, Solid, Sum,
    Thin,
};
use residual_render::domain::Precise;
use residual_render::math::Vec3;
use residual_render::math::vec3::vec3;
use residual_render::surface::Surface;
use residual_render::texture::Const;

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

/// Rough metals lose what hits a second facet; smooth ones nothing.
#[test]
fn metals_have_the_colour_of_their_reflection() {
    let metal = |roughness| Conductor {
        color: ORANGE,
        roughness: Const(roughness),
    };
    assert_near("normal", albedo(&metal(0.4), 1.0), colors(ORANGE.0), 1e-12);
    for cos in [1.0, 0.8, 0.5] {
        let (seen, smooth) = (albedo(&metal(0.0), cos), mean_weight(&metal(0.0), cos));
        assert_near("smooth", seen, smooth, 1e-3);
        assert_near("rough", seen, integral(&metal(0.4), cos), 0.06);
    }
    let [r, g, b] = albedo(&metal(0.4), 1e-3);
    assert!(r.min(g).min(b) > 0.99, "grazing metal is white");
}

#[test]
fn coats_show_their_base_until_they_are_grazed() {
    let coated = CoatedDiffuse {
        albedo: BLUE,
        roughness: Const(0.5),
        reflectance: Const([0.04; 3]),
        grazing: Const(1.0),
    };
    let base = colors(BLUE.0).map(|c| 0.04 + 0.96 * c);
    assert_near("normal", albedo(&coated, 1.0), base, 1e-6);
    for cos in [1.0, 0.8, 0.5] {
        assert_near("coat", albedo(&coated, cos), integral(&coated, cos), 0.05);
    }
    assert_near("grazing", albedo(&coated, 1e-3), [1.0; 3], 1e-2);
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
        for number in [0.0, 0.3, 1.0].map(Const) {
            let conductor = Conductor {
                color,
                roughness: number,
            };
            check("conductor", &conductor);
            let coated = CoatedDiffuse {
                albedo: color,
                roughness: Const(0.2),
                reflectance: Const([0.04; 3]),
                grazing: number,
            };
            check("coat", &coated);
            let mix = Mix {
                a: coated,
                b: glass,
                weight: number,
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
