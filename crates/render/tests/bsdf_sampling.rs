//! BSDF sampling against its own density, lobe by lobe.

use residual_render::bsdf::ggx::MIN_ALPHA;
use residual_render::bsdf::{
    Anisotropic, Coated, Diffuse, Glossy, Mix, Phong, RoughDiffuse, Sheen, Sum,
};
use residual_render::texture::Const;

use crate::support::Worst;
use crate::support::bsdfs::{Facets, Plastic, frosted, frosted_sheet, glass_scene, metal, plastic};
use crate::support::sampling::{Case, Digits, Event, Side};
use crate::support::scenes::{FLOOR, scene};
use crate::support::stats::Family;

const WHITE: Const<[f32; 3]> = Const([1.0; 3]);
const BASE: Const<[f32; 3]> = Const([0.8, 0.5, 0.3]);

fn conductor(roughness: f32) -> Facets {
    metal(BASE.0, roughness)
}
fn coated(roughness: f32) -> Plastic {
    plastic(BASE.0, roughness, [0.04, 1.0])
}
fn alpha(roughness: f32) -> f64 {
    f64::from(roughness * roughness).max(MIN_ALPHA)
}

#[test]
fn diffuse() {
    let data = scene(&[FLOOR]);
    let mut family = Family::default();
    Case::new("diffuse", Diffuse { albedo: BASE }, 1.0, &data).check(&mut family, 1e-6, 1e-6);
    family.assert_plausible();
}

#[test]
fn conductors() {
    let data = scene(&[FLOOR]);
    let mut family = Family::default();
    for roughness in [1e-4, 0.05, 0.2, 0.5, 1.0] {
        let name = format!("conductor {roughness}");
        Case::new(name, conductor(roughness), alpha(roughness), &data).check(
            &mut family,
            1e-4,
            5e-2,
        );
    }
    family.assert_plausible();
}

#[test]
fn coated_diffuse() {
    let data = scene(&[FLOOR]);
    let mut family = Family::default();
    for roughness in [1e-4, 0.05, 0.2, 0.5, 1.0] {
        let name = format!("coated {roughness}");
        Case::new(name, coated(roughness), alpha(roughness), &data).check(&mut family, 1e-4, 1e-5);
    }
    family.assert_plausible();
}

/// Rougher along the tangent: χ² in all directions around.
#[test]
fn brushed_conductors() {
    let data = scene(&[FLOOR]);
    let mut family = Family::default();
    for (roughness, anisotropy) in [(0.1, 0.3), (0.3, 0.7), (0.5, 1.0)] {
        let bsdf = Glossy {
            fresnel: conductor(0.0).fresnel,
            roughness: Anisotropic {
                roughness: Const(roughness),
                anisotropy: Const(anisotropy),
            },
        };
        let name = format!("brushed {roughness}, {anisotropy}");
        Case::new(name, bsdf, alpha(roughness), &data).check(&mut family, 1e-4, 5e-2);
    }
    family.assert_plausible();
}

#[test]
fn cloth() {
    let data = scene(&[FLOOR]);
    let mut family = Family::default();
    for roughness in [0.1, 0.3, 0.7, 1.0] {
        let sheen = Sheen {
            color: BASE,
            roughness: Const(roughness),
        };
        Case::new(format!("sheen {roughness}"), sheen, 1.0, &data).check(&mut family, 1e-3, 1e-3);
        let cloth = Coated {
            coat: sheen,
            base: Diffuse { albedo: BASE },
        };
        Case::new(format!("cloth {roughness}"), cloth, 1.0, &data).check(&mut family, 1e-3, 1e-3);
    }
    family.assert_plausible();
}

#[test]
fn clay() {
    let data = scene(&[FLOOR]);
    let mut family = Family::default();
    for roughness in [0.0, 0.1, 0.5, 1.0] {
        let name = format!("clay {roughness}");
        let bsdf = RoughDiffuse {
            albedo: BASE,
            roughness: Const(roughness),
        };
        Case::new(name, bsdf, 1.0, &data).check(&mut family, 1e-3, 1e-4);
    }
    family.assert_plausible();
}

#[test]
fn phongs() {
    let data = scene(&[FLOOR]);
    let mut family = Family::default();
    for exponent in [1.0, 20.0, 500.0] {
        let bsdf = Phong {
            color: BASE,
            exponent: Const(exponent),
        };
        let scale = (1.0 / (f64::from(exponent) + 2.0)).sqrt();
        Case::new(format!("phong {exponent}"), bsdf, scale, &data).check(&mut family, 1e-4, 1e-5);
    }
    family.assert_plausible();
}

#[test]
fn combinations() {
    let data = scene(&[FLOOR]);
    let mut family = Family::default();
    let mix = Mix {
        a: Diffuse { albedo: BASE },
        b: conductor(0.2),
        weight: Const(0.3),
    };
    Case::new("mix", mix, 0.04, &data).check(&mut family, 1e-4, 1e-5);
    let phong = Phong {
        color: BASE,
        exponent: Const(50.0),
    };
    let sum = Sum {
        a: Diffuse { albedo: BASE },
        b: phong,
        probability: Const(0.6),
    };
    Case::new("sum", sum, 0.14, &data).check(&mut family, 1e-3, 1e-5);
    let nested = Mix {
        a: sum,
        b: Mix {
            a: coated(0.3),
            b: mix,
            weight: Const(0.5),
        },
        weight: Const(0.75),
    };
    Case::new("nested", nested, 0.04, &data).check(&mut family, 1e-4, 1e-5);
    family.assert_plausible();
}

/// Glass that is mixed proposes directions and is evaluated, where glass alone knows its weights.
#[test]
fn mixed_glass() {
    let data = glass_scene(1.5);
    let mut family = Family::default();
    for roughness in [0.2, 0.6] {
        let body = Mix {
            a: Diffuse { albedo: BASE },
            b: frosted(BASE.0, 1.5, roughness),
            weight: Const(0.7),
        };
        for (side, eta) in [(Side::Front, 1.5), (Side::Back, 1.0 / 1.5)] {
            Case {
                side,
                through: Some(Event::Refraction(eta)),
                ..Case::new(
                    format!("body {roughness}, {side:?}"),
                    body,
                    alpha(roughness),
                    &data,
                )
            }
            .check(&mut family, 1e-3, 5e-2);
        }
        let sheet = Mix {
            a: Diffuse { albedo: BASE },
            b: frosted_sheet(BASE.0, 1.5, roughness),
            weight: Const(0.7),
        };
        Case {
            through: Some(Event::Passage),
            ..Case::new(format!("sheet {roughness}"), sheet, alpha(roughness), &data)
        }
        .check(&mut family, 1e-3, 5e-2);
    }
    family.assert_plausible();
}

#[test]
fn perturbed_densities_are_rejected() {
    let data = scene(&[FLOOR]);
    let (mut weights, mut pdfs) = (Worst::default(), Worst::default());
    let case = Case::new("conductor", conductor(0.5), 0.25, &data);
    assert!(case.run((0.5, Digits::Single), 80, 0.2, &mut weights, &mut pdfs) < 1e-4);
    let case = Case::new("diffuse", Diffuse { albedo: WHITE }, 1.0, &data);
    assert!(case.run((0.5, Digits::Single), 81, 0.2, &mut weights, &mut pdfs) < 1e-4);
}

/// Glass whose facets refract, from both sides; and panes of it.
#[test]
fn rough_glass() {
    let mut family = Family::default();
    for ior in [1.1, 1.5, 2.4] {
        let data = glass_scene(ior);
        for roughness in [1e-4, 0.1, 0.3, 0.6, 1.0] {
            let into = f64::from(ior);
            for (side, eta) in [(Side::Front, into), (Side::Back, 1.0 / into)] {
                let glass = frosted(BASE.0, ior, roughness);
                let name = format!("glass {roughness}, {ior}, {side:?}");
                Case {
                    side,
                    through: Some(Event::Refraction(eta)),
                    ..Case::new(name, glass, alpha(roughness), &data)
                }
                .check(&mut family, 1e-3, 5e-2);
            }
            let sheet = frosted_sheet(BASE.0, ior, roughness);
            let name = format!("sheet {roughness}, {ior}");
            Case {
                through: Some(Event::Passage),
                ..Case::new(name, sheet, alpha(roughness), &data)
            }
            .check(&mut family, 1e-4, 5e-2);
        }
    }
    family.assert_plausible();
}
