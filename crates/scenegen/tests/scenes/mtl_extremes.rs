//! Values of MTL files that no surface has.

use residual_scenegen::desc::SurfaceDesc;

use crate::common::gltf_text::warns;
use crate::common::obj_text::{material, phong};

#[test]
fn exponents_are_as_sharp_as_can_be_rendered() {
    for (ns, used, warning) in [
        ("0", 0.0, ""),
        ("1000", 1000.0, ""),
        ("1e6", 1e6, ""),
        ("1e9", 1e6, "Ns 1000000000 is sharper than can be rendered"),
        ("3e38", 1e6, "is sharper"),
        ("1e39", 30.0, "not a number"),
        ("nan", 30.0, "not a number"),
        ("inf", 30.0, "not a number"),
        ("-1e9", 0.0, "is negative; 0 is used"),
        ("-0.0", 0.0, ""),
    ] {
        let (material, scene) = material(&format!("Ks 0.1 0.1 0.1\nNs {ns}"));
        assert_eq!(phong(&material).exponent.factor, used, "{ns}");
        assert!(
            warning.is_empty() || warns(&scene, "m", warning),
            "{ns}: {:?}",
            scene.warnings
        );
        assert_eq!(scene.warnings.is_empty(), warning.is_empty(), "{ns}");
    }
    // It does not matter where nothing is shiny.
    let (_, scene) = material("Ks 0 0 0\nNs 1e9");
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let (mapped, _) = material("Ks 0.1 0.1 0.1\nNs 1e9\nmap_Ns white.png");
    assert_eq!(phong(&mapped).exponent.factor, 1e6);
    let (mirror, scene) = material("Ks 0.1 0.1 0.1\nNs 1e9\nillum 3");
    assert!(matches!(mirror.surface, SurfaceDesc::Mirror { .. }));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn indices_of_refraction_are_those_of_materials() {
    for (ni, glass, coat, warning) in [
        ("1.33", 1.33, 1.33, ""),
        ("1", 1.0, 1.5, ""),
        ("0.75", 0.75, 1.5, ""),
        ("10", 10.0, 10.0, ""),
        ("0", 1.5, 1.5, "Ni 0 is not positive; 1.5 is used"),
        ("-1", 1.5, 1.5, "Ni -1 is not positive; 1.5 is used"),
        ("1e9", 10.0, 10.0, "none of a material; 10 is used"),
        ("1e-9", 0.001, 1.5, "none of a material; 0.001 is used"),
        ("nan", 1.5, 1.5, "not a number"),
    ] {
        for (statements, expected) in [("illum 7", glass), ("Pr 0.5", coat)] {
            let (material, scene) = material(&format!("{statements}\nNi {ni}"));
            let found = match material.surface {
                SurfaceDesc::Dielectric { ior, .. } => ior,
                SurfaceDesc::MetallicRoughness(surface) => surface.ior,
                other => panic!("{other:?}"),
            };
            assert_eq!(found, expected, "{statements} Ni {ni}");
            assert!(
                warning.is_empty() || warns(&scene, "m", warning),
                "{ni}: {:?}",
                scene.warnings
            );
            assert_eq!(scene.warnings.is_empty(), warning.is_empty(), "{ni}");
        }
    }
    // Where nothing is refracted it does not matter.
    let (_, scene) = material("Ni -1\nKd 0.5 0.5 0.5");
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn colours_are_finite_and_not_negative() {
    for (kd, expected, warning) in [
        ("-1 -1 -1", [0.0; 3], "kd has negative values; 0 is used"),
        ("-1", [0.0; 3], "negative"),
        ("nan nan nan", [0.8; 3], "not a number and ignored"),
        ("0.5 nan 0.5", [0.8; 3], "not a number"),
        ("inf", [0.8; 3], "not a number"),
        ("1e38", [1.0; 3], "kd has values beyond"),
    ] {
        let (material, scene) = material(&format!("Kd {kd}"));
        let found = phong(&material).diffuse.factor;
        assert!(
            found
                .iter()
                .zip(expected)
                .all(|(a, b): (&f32, f32)| (a - b).abs() < 1e-6),
            "{kd}: {found:?}"
        );
        assert!(warns(&scene, "m", warning), "{kd}: {:?}", scene.warnings);
    }
    let (lamp, scene) = material("Ke 1e38 1 0\nmap_Ke -mm 0 1e30 white.png");
    assert_eq!(lamp.emission.factor, [1e30, 1e30, 0.0]);
    assert!(warns(&scene, "m", "ke has values beyond"));
}

#[test]
fn roughness_and_metalness_are_clamped() {
    for (statements, roughness, metallic, warning) in [
        ("Pr 2", 1.0, 0.0, "pr 2 is outside of 0 to 1 and clamped"),
        ("Pr -1", 0.0, 0.0, "pr -1 is outside"),
        ("Pm -1", 0.5, 0.0, "pm -1 is outside"),
        ("Pm 2\nPr 0.25", 0.25, 1.0, "pm 2 is outside"),
        ("Pr nan\nPm 1", 0.5, 1.0, "pr \"nan\" is not a number"),
        ("Pr 1e30", 1.0, 0.0, "outside of 0 to 1"),
    ] {
        let (material, scene) = material(statements);
        let SurfaceDesc::MetallicRoughness(surface) = &material.surface else {
            panic!("{material:?}")
        };
        assert_eq!(
            (surface.roughness.factor, surface.metallic.factor),
            (roughness, metallic),
            "{statements}"
        );
        assert!(warns(&scene, "m", warning), "{:?}", scene.warnings);
    }
}
