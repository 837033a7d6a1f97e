//! What no BSDF may do: be anything but finite (hard case M-15). And what smooth dielectrics do.

use residual_render::bsdf::{
    Anisotropic, Bsdf, BsdfSample, Coated, Dielectric, Diffuse, DiffuseTransmission, Glossy,
    Mirror, Mix, RoughDiffuse, Sheen, Solid, Thin, ThinFilm,
};
use residual_render::domain::{Buffers, Scalar};
use residual_render::math::Vec3;
use residual_render::math::vec3::vec3;
use residual_render::surface::Surface;
use residual_render::texture::Const;

use crate::support::bsdfs::{
    WHITE, coated, conductor, frosted, frosted_sheet, glass_scene, phong, view,
};
use crate::support::random::Rng;
use crate::support::scenes::{FLOOR, floor, scene, surface_at};
use crate::support::{Worst, array, dot};

#[test]
fn degenerate_directions_give_finite_values() {
    /// Where nothing passes, directions below give nothing.
    fn check<B: for<'a> Bsdf<Scalar<'a>>>(name: &str, bsdf: &B) {
        check_sides(name, bsdf, true);
    }
    fn check_sides<B: for<'a> Bsdf<Scalar<'a>>>(name: &str, bsdf: &B, is_opaque: bool) {
        let data = glass_scene(1.5);
        let buffers = data.buffers();
        let d = Scalar::new(&buffers);
        let surface = floor(d);
        let axis = [0.0, -0.0, 1.0, -1.0, 0.6, 1e-20, 1e-4];
        let mut directions = vec![vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, -1.0)];
        directions.extend(axis.map(|z: f32| vec3((1.0 - z * z).sqrt(), 0.0, z)));
        directions.extend(axis.map(|z: f32| vec3(-(1.0 - z * z).sqrt(), 0.0, z)));
        let below_one = 1.0 - 1.0 / 16_777_216.0;
        for &wo in directions.iter().filter(|wo| wo.z >= 0.0) {
            for &wi in &directions {
                let value = bsdf.eval(d, &surface, wo, wi);
                let all = [value.value.x, value.value.y, value.value.z, value.pdf];
                assert!(
                    all.iter().all(|c| c.is_finite() && *c >= 0.0),
                    "{name} {wo:?} {wi:?}: {value:?}"
                );
                let none = is_opaque && wi.z <= 0.0;
                assert!(!none || all == [0.0; 4], "{name} {wo:?} {wi:?}: {value:?}");
            }
            for u in [0.0, 0.5, below_one] {
                for v in [0.0, 0.25, below_one] {
                    for w in [0.0, 0.5, below_one] {
                        let s: BsdfSample<_> = bsdf.sample(d, &surface, wo, [u, v, w]);
                        let all = array(s.wi)
                            .into_iter()
                            .chain(array(s.weight))
                            .chain([s.pdf]);
                        assert!(
                            all.clone().all(f32::is_finite),
                            "{name} {wo:?} {:?}: {s:?}",
                            [u, v, w]
                        );
                        assert!(
                            s.pdf >= 0.0 && s.weight.x >= 0.0,
                            "{name} {wo:?} {:?}: {s:?}",
                            [u, v, w]
                        );
                    }
                }
            }
        }
    }
    for roughness in [0.0, 0.1, 1.0] {
        check("conductor", &conductor(roughness));
        check("coated", &coated(roughness, 0.04));
    }
    for roughness in [0.0, 0.1, 1.0].map(Const) {
        let sheen = Sheen {
            color: WHITE,
            roughness,
        };
        check("sheen", &sheen);
        let base = Diffuse { albedo: WHITE };
        let albedo = WHITE;
        check("clay", &RoughDiffuse { albedo, roughness });
        check("cloth", &Coated { coat: sheen, base });
        let brushed = Anisotropic {
            roughness,
            anisotropy: Const(1.0),
        };
        let film = ThinFilm {
            normal: WHITE,
            grazing: Const(1.0),
            strength: Const(1.0),
            ior: Const(1.3),
            thickness: roughness,
        };
        let glossy = Glossy {
            fresnel: film,
            roughness: brushed,
        };
        check("brushed film", &glossy);
        for ior in [1.001, 1.5, 3.0] {
            check_sides("frosted solid", &frosted(WHITE.0, ior, roughness.0), false);
            let sheet = frosted_sheet(WHITE.0, ior, roughness.0);
            check_sides("frosted sheet", &sheet, false);
        }
    }
    check_sides("paper", &DiffuseTransmission { color: WHITE }, false);
    for exponent in [0.0, 1.0, 1e4] {
        check("phong", &phong(exponent));
    }
    check("diffuse", &Diffuse { albedo: WHITE });
    check("mirror", &Mirror { reflectance: WHITE });
    check(
        "solid",
        &Dielectric {
            transmittance: WHITE,
            ior: Const(1.5),
            interface: Solid,
        },
    );
    check(
        "thin",
        &Dielectric {
            transmittance: WHITE,
            ior: Const(1.5),
            interface: Thin,
        },
    );
    let mix = |weight| Mix {
        a: Diffuse { albedo: WHITE },
        b: Dielectric {
            transmittance: WHITE,
            ior: Const(1.5),
            interface: Solid,
        },
        weight: Const(weight),
    };
    [0.0, 0.3, 1.0]
        .into_iter()
        .for_each(|weight| check("mix", &mix(weight)));
}

/// Reflection and transmission with their probabilities, by choosing each lobe with its own number.
fn lobes<'a, B: Bsdf<Scalar<'a>>>(
    bsdf: &B,
    surface: &Surface<Scalar<'a>>,
    d: Scalar<'a>,
    wo: Vec3<f32>,
) -> f64 {
    // The largest number that still reflects, by bisection.
    let reflects = |u: f32| bsdf.sample(d, surface, wo, [0.5, 0.5, u]).wi.z > 0.0;
    let (mut low, mut high) = (0_u32, 1 << 24);
    while low < high {
        let middle = low.midpoint(high);
        if reflects(middle as f32 / 16_777_216.0) {
            low = middle + 1
        } else {
            high = middle
        }
    }
    f64::from(low) / 16_777_216.0
}

#[test]
fn dielectrics_conserve_energy_and_obey_snell() {
    let data = scene(&[FLOOR]);
    let buffers: Buffers<'_> = data.buffers();
    let d = Scalar::new(&buffers);
    let front = floor(d);
    let back = surface_at(d, 0, [0.3, 0.3], [0.0, 0.0, 1.0]);
    let mut rng = Rng::new(92);
    let (mut unit, mut snell, mut share) = (Worst::default(), Worst::default(), Worst::default());
    for _ in 0..20_000 {
        let wo = view(
            10.0_f64.powf(rng.range(-4.0, 0.0)),
            rng.range(0.0, std::f64::consts::TAU),
        );
        let ior = rng.range(1.01, 2.5) as f32;
        let glass = Dielectric {
            transmittance: WHITE,
            ior: Const(ior),
            interface: Solid,
        };
        for (surface, eta) in [(&front, f64::from(ior)), (&back, 1.0 / f64::from(ior))] {
            let place = || format!("{wo:?}, η {eta}");
            let exact = crate::support::unit(array(wo).map(f64::from));
            let sin2 = (exact[0] * exact[0] + exact[1] * exact[1]) / (eta * eta);
            let mirrored = glass.sample(d, surface, wo, [0.5, 0.5, 0.0]);
            assert_eq!(
                (mirrored.wi, mirrored.delta, mirrored.pdf),
                (vec3(-wo.x, -wo.y, wo.z), true, 0.0)
            );
            assert_eq!(mirrored.weight, vec3(1.0, 1.0, 1.0));
            let through = glass.sample(d, surface, wo, [0.5, 0.5, 1.0 - 1.0 / 16_777_216.0]);
            if sin2 > 1.0 - 1e-3 {
                continue;
            }
            let wi = array(through.wi).map(f64::from);
            assert!(wi[2] < 0.0, "{}", place());
            unit.add((dot(wi, wi) - 1.0).abs(), place);
            let error = [
                wi[0] + exact[0] / eta,
                wi[1] + exact[1] / eta,
                wi[2] + (1.0 - sin2).sqrt(),
            ];
            snell.add(error.map(f64::abs).into_iter().fold(0.0, f64::max), place);
            // Radiance changes by 1/η²; its energy does not, since the cone changes by η².
            share.add((f64::from(through.weight.x) * eta * eta - 1.0).abs(), place);
        }
    }
    unit.assert_below(1e-6, "refracted directions, |length² − 1|");
    // The last millesimal before total reflection loses √u.
    snell.assert_below(2e-5, "Snell's law, component");
    share.assert_below(1e-6, "1/η² of transmitted radiance");
    for cos in [1.0, 0.5, 0.1] {
        let reflectance = lobes(
            &Dielectric {
                transmittance: WHITE,
                ior: Const(1.5),
                interface: Solid,
            },
            &front,
            d,
            view(cos, 0.3),
        );
        let exact = residual_render::math::fresnel::fresnel(d, view(cos, 0.3).z, 1.5).0;
        assert!((reflectance - f64::from(exact)).abs() < 1e-6, "{cos}");
    }
}

#[test]
fn thin_sheets_do_not_bend_and_have_no_inside() {
    let data = scene(&[FLOOR]);
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let tint = Const([0.9, 0.5, 0.1]);
    let sheet = Dielectric {
        transmittance: tint,
        ior: Const(1.5),
        interface: Thin,
    };
    let [front, back] = [-1.0, 1.0].map(|z| surface_at(d, 0, [0.3, 0.3], [0.0, 0.0, z]));
    assert!(front.front && !back.front);
    for cos in [0.9, 0.6, 0.2, 0.01] {
        let wo = view(cos, 2.0);
        for surface in [&front, &back] {
            let through = sheet.sample(d, surface, wo, [0.1, 0.2, 1.0 - 1.0 / 16_777_216.0]);
            assert_eq!((through.wi, through.weight), (-wo, vec3(0.9, 0.5, 0.1)));
            let solid = Dielectric {
                transmittance: tint,
                ior: Const(1.5),
                interface: Solid,
            };
            let same = lobes(&sheet, surface, d, wo) == lobes(&solid, surface, d, wo);
            assert_eq!(
                same, surface.front,
                "only the front of a solid is like a sheet"
            );
        }
    }
}

/// A clear body takes nothing from a path but the factor that it gives back on the way out: what a path carries, scaled by
/// the squared index of where it is, stays the same on the way in, inside and on the way out.
#[test]
fn what_glass_takes_on_the_way_in_is_known_to_roulette() {
    let data = scene(&[FLOOR]);
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let front = surface_at(d, 0, [0.3, 0.3], [0.0, 0.0, -1.0]);
    let back = surface_at(d, 0, [0.3, 0.3], [0.0, 0.0, 1.0]);
    let mut rng = Rng::new(93);
    let mut worst = Worst::default();
    for _ in 0..1000 {
        let ior = rng.range(0.6, 2.5) as f32;
        let glass = Dielectric {
            transmittance: WHITE,
            ior: Const(ior),
            interface: Solid,
        };
        let mix = Mix {
            a: Diffuse { albedo: WHITE },
            b: glass,
            weight: Const(1.0),
        };
        for (surface, outside_of) in [(&front, 1.0), (&back, ior * ior)] {
            let wo = view(rng.range(0.8, 1.0), rng.range(0.0, 6.0));
            for lobe in [0.0, 0.999_999] {
                let sample = glass.sample(d, surface, wo, [0.5, 0.5, lobe]);
                let scale = glass.radiance_scale(d, surface, sample.wi).unwrap();
                assert_eq!(mix.radiance_scale(d, surface, sample.wi), Some(scale));
                let carried = f64::from(sample.weight.x * scale / outside_of);
                worst.add((carried - 1.0).abs(), || format!("η {ior}, {wo:?}"));
            }
        }
        let thin = Dielectric {
            transmittance: WHITE,
            ior: Const(ior),
            interface: Thin,
        };
        assert_eq!(thin.radiance_scale(d, &front, view(0.5, 0.0)), None);
    }
    worst.assert_below(1e-6, "what is carried through glass");
}
