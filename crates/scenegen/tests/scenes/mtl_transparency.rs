//! What `illum`, `d`, `Tr`, `Tf`, `Ni` and `map_d` of MTL files mean together.

use residual_scenegen::desc::{AlphaMode, SurfaceDesc};

use crate::common::gltf_text::warns;
use crate::common::obj_text::{material, phong};

#[test]
fn transparency_blends_and_glass_refracts() {
    let alpha = |statements: &str| {
        let (material, _) = material(statements);
        phong(&material);
        (material.alpha_mode, material.alpha.factor)
    };
    assert_eq!(alpha("d 0.25"), (AlphaMode::Blend, 0.25));
    assert_eq!(alpha("Tr 0.25"), (AlphaMode::Blend, 0.75));
    assert_eq!(alpha("d 1\nTr 1"), (AlphaMode::Opaque, 1.0));
    assert_eq!(alpha("d -halo 0.5"), (AlphaMode::Blend, 0.5));
    assert_eq!(
        alpha("d 0.5\nNi 1.5\nmap_d kd.png"),
        (AlphaMode::Blend, 0.5)
    );
    assert_eq!(
        alpha("illum 4\nNi 1\nd 1\nTf 1 1 1"),
        (AlphaMode::Opaque, 1.0)
    );

    let glass = |statements: &str| match material(statements).0.surface {
        SurfaceDesc::Dielectric { ior, transmittance } => (ior, transmittance),
        other => panic!("{statements}: {other:?}"),
    };
    for illum in [4, 6, 7, 9] {
        assert_eq!(
            glass(&format!("illum {illum}\nNi 1.3\nTf 0.5 1 0.5")),
            (1.3, [0.5, 1., 0.5])
        );
    }
    assert_eq!(glass("illum 7"), (1.5, [1.0; 3]));
}

/// `Ni` and `d` stand in every material of some programs.
#[test]
fn dissolve_is_not_glass() {
    for statements in [
        "d 0.5\nNi 1.5",
        "d 0.5\nNi 1.45\nillum 2",
        "Tr 0.5\nNi 1.45\nillum 1",
        "d 0.5\nNi 1.5\nillum 3\nNs 10",
        "d 0.5\nNi 1.5\nTf 1 1 1",
        "d 0.5\nNi 1.5\nTf 0 0 0",
        "d 0.5\nillum 4\nmap_d kd.png",
        "d 0.5\nillum 9\nmap_d kd.png\nmap_Kd kd.png",
    ] {
        let (material, _) = material(statements);
        phong(&material);
        assert_eq!(
            (material.alpha_mode, material.alpha.factor),
            (AlphaMode::Blend, 0.5),
            "{statements}"
        );
    }
}

#[test]
fn what_exporters_write_for_every_material_is_no_glass() {
    for statements in [
        "illum 4\nKd 0 0 0\nTf 1 1 1\nmap_Kd kd.png\nNi 1",
        "illum 4\nd 1\nNi 1.5",
        "illum 4\nNi 1.5\nmap_Kd kd.png",
        "illum 4\nTf 0 0 0\nNi 1",
        "illum 7\nNi 1.5\nmap_Kd kd.png\nd 1",
        "Ni 1.5",
        "illum 2\nd 1\nTf 0.5 0.5 0.5",
    ] {
        let (material, scene) = material(statements);
        phong(&material);
        assert_eq!(
            (material.alpha_mode, material.alpha.factor),
            (AlphaMode::Opaque, 1.0),
            "{statements}"
        );
        assert_eq!(
            warns(&scene, "m", "Tf is ignored"),
            statements.contains("0.5 0.5"),
            "{statements}"
        );
    }
}

#[test]
fn a_transmission_colour_is_glass() {
    for statements in [
        "Tf 0.9 0.2 0.2",
        "illum 4\nTf 0.9 0.2 0.2\nNi 1",
        "d 0.5\nTf 0.9 0.2 0.2\nillum 2",
    ] {
        let (material, _) = material(statements);
        let SurfaceDesc::Dielectric { transmittance, .. } = material.surface else {
            panic!("{statements}: {material:?}")
        };
        assert_eq!(transmittance, [0.9, 0.2, 0.2]);
        assert_eq!(
            (material.alpha_mode, material.alpha.factor),
            (AlphaMode::Opaque, 1.0)
        );
    }
    let (clamped, scene) = material("illum 7\nTf 2 0.5 -1");
    assert!(matches!(
        clamped.surface,
        SurfaceDesc::Dielectric {
            transmittance: [1.0, 0.5, 0.0],
            ..
        }
    ));
    assert!(warns(&scene, "m", "Tf has values outside of 0 to 1"));
    let (_, scene) = material("illum 7\nKd 0.2 0.2 0.2\nKs 0 0 0");
    assert!(warns(
        &scene,
        "m",
        "kd is ignored: the material is clear glass"
    ));
    assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
}

#[test]
fn glass_has_the_colour_of_kd_as_far_as_it_is_opaque() {
    for (statements, expected) in [
        ("illum 9\nd 0.25\nKd 0 1 0", [0.75, 1.0, 0.75]),
        ("illum 4\nTr 0.75\nKd 0 1 0.5", [0.75, 1.0, 0.875]),
        (
            "illum 6\nd 0.5\nKd 0 1 1\nTf 0.5 0.5 1\nKs 1 1 1",
            [0.25, 0.5, 1.0],
        ),
        ("illum 7\nd 0.25\nKd 0 0 0", [1.0; 3]),
        ("illum 7\nd 0\nKs 1 1 1\nNs 1000", [1.0; 3]),
    ] {
        let (material, scene) = material(statements);
        let SurfaceDesc::Dielectric { transmittance, .. } = material.surface else {
            panic!("{statements}: {material:?}")
        };
        assert_eq!(transmittance, expected, "{statements}");
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    }
}

#[test]
fn maps_belong_to_surfaces() {
    for (statements, opacity) in [
        ("illum 9\nd 0.25\nmap_Kd kd.png\nNi 1.45", 0.25),
        ("illum 7\nmap_Kd kd.png", 1.0),
        ("illum 4\nTf 0.5 0.5 0.5\nmap_Kd kd.png", 1.0),
        ("illum 6\nd 1\nmap_d ks.png", 1.0),
    ] {
        let (material, scene) = material(statements);
        phong(&material);
        assert_eq!(material.alpha.factor, opacity, "{statements}");
        assert!(
            warns(&scene, "m", "is for surfaces"),
            "{statements}: {:?}",
            scene.warnings
        );
    }
}

#[test]
fn opacity_is_what_exporters_mean() {
    for (statements, opacity, warning) in [
        ("d 0.25\nTr 0.75", 0.25, ""),
        ("d 1\nTr 0.25", 0.75, "Tr counts"),
        ("d 0.25\nTr 0", 0.25, "d counts"),
        ("d 0.25\nTr 0.25", 0.25, ""),
        ("d 0\nTr 0", 1.0, "opaque"),
        ("Tr 1", 1.0, "read as opacity"),
        ("Tr 1.000000\nmap_Kd kd.png", 1.0, "read as opacity"),
        ("Tr 1\nnewmtl other\nTr 0\nnewmtl third\n", 0.0, ""),
        (
            "Tr 1\nmap_Kd kd.png\nnewmtl other\nTr 0",
            1.0,
            "can only mean that it is opaque",
        ),
        ("Tr 0.25\nnewmtl other\nTr 1", 0.25, "read as opacity"),
        ("Tr 0.25\nnewmtl other\nd 0\nTr 1", 0.75, ""),
        ("d 0", 0.0, ""),
        ("d 0\nmap_Kd kd.png", 1.0, "can only mean that it is opaque"),
        ("d 0\nmap_d kd.png", 1.0, "the map alone says"),
        ("d 0.000\nmap_Kd kd.png\nmap_d ks.png", 1.0, "the map alone"),
        ("d 0.0\nillum 4\nmap_d kd.png", 1.0, "the map alone"),
        ("d 0\nTr 1\nmap_d kd.png", 1.0, "the map alone"),
        (
            "Tr 1\nmap_d kd.png\nnewmtl other\nTr 0",
            1.0,
            "the map alone",
        ),
        ("d 0.5\nmap_d kd.png", 0.5, ""),
        ("d 100", 1.0, "clamped"),
        ("Tr -1", 1.0, "clamped"),
        ("d nan\nTr 0.25", 0.75, "ignored"),
        ("d 0,25", 0.25, ""),
        ("d -halo 0.25", 0.25, "-halo of d is ignored"),
    ] {
        let (material, scene) = material(statements);
        assert_eq!(material.alpha.factor, opacity, "{statements}");
        assert!(
            warning.is_empty() || warns(&scene, "m", warning),
            "{statements}: {:?}",
            scene.warnings
        );
        assert_eq!(
            warns(&scene, "\"m\"", ""),
            !warning.is_empty(),
            "{statements}: {:?}",
            scene.warnings
        );
    }
}

/// The whole mesh would be left out.
#[test]
fn a_map_beside_d_0_is_what_is_opaque() {
    let (leaf, _) = material("d 0\nmap_d ks.png");
    assert_eq!(leaf.alpha_mode, AlphaMode::Blend);
    assert!(leaf.alpha.texture.is_some());
}

#[test]
fn alpha_maps_are_grey_unless_they_are_the_colours_file() {
    let (grey, _) = material("map_d ks.png");
    assert_eq!(
        (grey.alpha_mode, grey.alpha.texture.unwrap().1),
        (AlphaMode::Blend, 0)
    );
    let (same, _) = material("map_Kd kd.png\nmap_d kd.png");
    assert_eq!(same.alpha.texture.unwrap().1, 3);
    let (own_alpha, _) = material("map_d leaf.png");
    assert_eq!(own_alpha.alpha.texture.unwrap().1, 3);
    let (said, _) = material("map_d -imfchan g leaf.png");
    assert_eq!(said.alpha.texture.unwrap().1, 1);
}
