//! MTL files, keyword by keyword.

use glam::Vec4;
use residual_scenegen::desc::{AlphaMode, MetallicRoughness, SurfaceDesc};

use crate::common::gltf_text::warns;
use crate::common::obj_text::{material, mirror, phong, red};

#[test]
fn colours_and_exponents_are_read() {
    let (material, _) =
        material("Kd 0.1 0.2 0.3\nKs 0.4 0.5 0.6\nKe 7 8 9\nNs 40 # a comment\nillum 2");
    let phong = phong(&material);
    assert_eq!(phong.diffuse.factor, [0.1, 0.2, 0.3]);
    assert_eq!(phong.specular.factor, [0.4, 0.5, 0.6]);
    assert_eq!(material.emission.factor, [7., 8., 9.]);
    assert_eq!(phong.exponent.factor, 40.0);
    assert_eq!(
        (material.alpha_mode, material.alpha.factor),
        (AlphaMode::Opaque, 1.0)
    );
}

#[test]
fn illum_below_2_has_no_highlight() {
    for illum in 0..2 {
        let (material, _) = material(&format!("Ks 1 1 1\nmap_Ks ks.png\nillum {illum}"));
        assert_eq!(phong(&material).specular.factor, [0.0; 3]);
        assert_eq!(phong(&material).specular.texture, None);
    }
}

#[test]
fn illum_with_reflection_is_a_mirror() {
    for illum in [3, 5, 8] {
        let statements = format!("Kd 0.1 0.2 0.3\nKs 0.4 0.5 0.6\nNs 1000\nillum {illum}");
        let (material, scene) = material(&statements);
        let [diffuse, reflectance] = mirror(&material);
        assert_eq!(diffuse.factor, [0.1, 0.2, 0.3]);
        assert_eq!(reflectance.factor, [0.4, 0.5, 0.6]);
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    }
}

/// Programs write `illum` 3 for every metal, and how rough it is in `Ns`.
#[test]
fn reflections_are_as_rough_as_their_exponent_says() {
    for (ns, is_mirror) in [
        ("", true),
        ("Ns 900", true),
        ("Ns 250", false),
        ("Ns 10", false),
        ("map_Ns ks.png", false),
    ] {
        let (material, _) = material(&format!("Kd 0.1 0.1 0.1\nKs 0.5 0.5 0.5\n{ns}\nillum 3"));
        assert_eq!(
            matches!(material.surface, SurfaceDesc::Mirror { .. }),
            is_mirror,
            "{ns}"
        );
    }
    let (rough, _) = material("Ks 0.1 0.1 0.1\nNs 250\nillum 3");
    assert_eq!(phong(&rough).exponent.factor, 250.0);
}

/// Rodent registered map_Ks as map_Kd.
#[test]
fn specular_maps_are_not_diffuse_maps() {
    let (only_specular, scene) = material("map_Ks ks.png");
    assert_eq!(phong(&only_specular).diffuse.texture, None);
    assert_eq!(
        red(
            &scene,
            phong(&only_specular)
                .specular
                .texture
                .as_ref()
                .unwrap()
                .texture
        ),
        1
    );
    let (both, scene) = material("map_Kd kd.png\nmap_Ks ks.png\nmap_Ns ks.png");
    assert_eq!(
        red(
            &scene,
            phong(&both).diffuse.texture.as_ref().unwrap().texture
        ),
        0
    );
    assert_eq!(
        red(
            &scene,
            phong(&both).specular.texture.as_ref().unwrap().texture
        ),
        1
    );
    assert_eq!(
        red(
            &scene,
            phong(&both).exponent.texture.as_ref().unwrap().0.texture
        ),
        1
    );
    assert_eq!((scene.images.len(), scene.textures.len()), (2, 2));
    assert_eq!(
        phong(&both).diffuse.factor,
        [1.0; 3],
        "1 where only the map is given"
    );
}

#[test]
fn textured_emission_needs_no_ke() {
    let (emitter, scene) = material("Kd 0 0 0\nmap_Ke ks.png");
    assert_eq!(emitter.emission.factor, [1.0; 3]);
    assert_eq!(
        red(&scene, emitter.emission.texture.as_ref().unwrap().texture),
        1
    );
}

#[test]
fn black_beside_a_map_means_the_map() {
    let (toy, scene) = material("Kd 0 0 0\nmap_Kd white.png");
    assert_eq!(phong(&toy).diffuse.factor, [1.0; 3]);
    assert!(warns(
        &scene,
        "m",
        "kd 0 would make map_kd black; 1 is used"
    ));
    let (lamp, scene) = material("Ke 0 0 0\nmap_Ke white.png");
    assert_eq!(lamp.emission.factor, [1.0; 3]);
    assert!(warns(&scene, "m", "ke 0 would make map_ke black"));
    let (dull, scene) = material("Ks 0 0 0\nmap_Ks white.png\nNs 10");
    assert_eq!(phong(&dull).specular.factor, [0.0; 3]);
    assert!(warns(&scene, "m", "map_ks has no effect, as ks is 0"));
    let (tinted, scene) = material("Kd 0 0.5 0\nmap_Kd white.png");
    assert_eq!(phong(&tinted).diffuse.factor, [0.0, 0.5, 0.0]);
    assert!(scene.warnings.is_empty());
}

#[test]
fn colours_are_numbers_of_several_kinds() {
    for (kd, expected, warning) in [
        ("0.25 0.5 0.75", [0.25, 0.5, 0.75], ""),
        ("0.5", [0.5; 3], ""),
        ("0,25 0,5 0,75", [0.25, 0.5, 0.75], ""),
        ("0.25, 0.5, 0.75;", [0.25, 0.5, 0.75], ""),
        ("0.25 0.5", [0.25, 0.5, 0.5], "lacks a third number"),
        ("0.25 0.5 0.75 1", [0.25, 0.5, 0.75], ""),
        ("0.25 x 0.75", [0.8; 3], "not a number"),
        ("spectral oak.rfl 1", [0.8; 3], "file of spectra"),
        ("-1 0.5 0.5", [0.0, 0.5, 0.5], "negative"),
    ] {
        let (material, scene) = material(&format!("Kd {kd} # comment"));
        assert_eq!(phong(&material).diffuse.factor, expected, "{kd}");
        assert!(
            warning.is_empty() || warns(&scene, "m", warning),
            "{kd}: {:?}",
            scene.warnings
        );
        assert_eq!(
            scene.warnings.is_empty(),
            warning.is_empty(),
            "{kd}: {:?}",
            scene.warnings
        );
    }
    // White of D65.
    let (white, _) = material("Kd xyz 0.47523 0.5 0.54454");
    assert!(
        phong(&white)
            .diffuse
            .factor
            .iter()
            .all(|value| (value - 0.5).abs() < 1e-4)
    );
}

#[test]
fn highlights_without_an_exponent_get_a_usual_one() {
    let (shiny, scene) = material("Ks 0.1 0.1 0.1");
    assert_eq!(phong(&shiny).exponent.factor, 30.0);
    assert!(warns(
        &scene,
        "m",
        "Ks without Ns: an exponent of 30 is used"
    ));
    let (dull, scene) = material("Ks 0 0 0");
    assert_eq!(phong(&dull).specular.factor, [0.0; 3]);
    assert!(scene.warnings.is_empty());
    let (mapped, _) = material("Ks 0.1 0.1 0.1\nmap_Ns white.png");
    assert_eq!(phong(&mapped).exponent.factor, 1000.0);
    let (negative, scene) = material("Ks 0.1 0.1 0.1\nNs -5");
    assert_eq!(phong(&negative).exponent.factor, 0.0);
    assert!(warns(&scene, "m", "Ns -5 is negative"));
}

#[test]
fn roughness_and_metalness_are_read() {
    let surface = |statements: &str| -> MetallicRoughness {
        match material(statements).0.surface {
            SurfaceDesc::MetallicRoughness(surface) => surface,
            other => panic!("{statements}: {other:?}"),
        }
    };
    let metal = surface("Kd 0.9 0.6 0.2\nKs 0.5 0.5 0.5\nNs 250\nillum 3\nPr 0.25\nPm 1\nNi 1.45");
    assert_eq!(
        (metal.metallic.factor, metal.roughness.factor, metal.ior),
        (1.0, 0.25, 1.45)
    );
    assert_eq!(metal.base_color.factor, [0.9, 0.6, 0.2]);
    let mapped = surface("map_Pr white.png\nmap_Pm -imfchan b white.png\nNi 1");
    assert_eq!(
        (mapped.metallic.factor, mapped.roughness.factor, mapped.ior),
        (1.0, 1.0, 1.5)
    );
    let channels =
        [&mapped.metallic, &mapped.roughness].map(|input| input.texture.as_ref().unwrap().1);
    assert_eq!(channels, [2, 0]);
    let coated = surface("Pr 0.5\nPc 0.75\nPcr 0.03\naniso 0.5\nanisor 0.25");
    assert_eq!(
        (coated.clearcoat.factor, coated.clearcoat_roughness.factor),
        (0.75, 0.03)
    );
    assert_eq!(
        (coated.anisotropy.factor, coated.anisotropy_rotation),
        (0.5, std::f32::consts::FRAC_PI_2)
    );
    let (_, scene) = material("Pr 0.5\nPs 0.5\nmap_Ps kd.png");
    assert!(
        warns(&scene, "m", "not rendered and ignored: map_ps"),
        "{:?}",
        scene.warnings
    );
    assert_eq!(scene.warnings.len(), 1);
    let cloth = surface("Pr 0.5\nPs 0.4");
    assert_eq!(
        (cloth.sheen_color.factor, cloth.sheen_roughness.factor),
        ([0.4; 3], 0.5)
    );
}

#[test]
fn what_is_not_rendered_is_said() {
    let (_, scene) = material(
        "Kd 1 1 1\ndisp kd.png\nrefl -type sphere kd.png\nrubbish 1\nKa 1 1 1\nNi 1\nillum 2\nmap_Ka kd.png",
    );
    assert!(
        warns(
            &scene,
            "m",
            "not rendered and ignored: disp, map_ka, refl, rubbish"
        ),
        "{:?}",
        scene.warnings
    );
    assert_eq!(scene.warnings.len(), 1);
    let (_, scene) = material("map_Ka kd.png\nmap_Kd kd.png");
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let (last, scene) = material("Kd 0.1 0.1 0.1\nKd 0.2 0.2 0.2");
    assert_eq!(phong(&last).diffuse.factor, [0.2; 3]);
    assert!(
        warns(&scene, "a.mtl line 3", "kd stands there again"),
        "{:?}",
        scene.warnings
    );
}

#[test]
fn bump_maps_that_are_directions_are_normal_maps() {
    for key in ["bump", "map_Bump", "map_bump"] {
        let (material, scene) = material(&format!("{key} -bm 0.5 directions.png"));
        assert_eq!(material.normal_map.unwrap().scale, 0.5, "{key}");
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    }
    let (both, scene) = material("norm directions.png\nmap_Bump kd.png");
    assert!(both.normal_map.is_some());
    assert!(warns(&scene, "m", "ignored: map_bump"));
    let (behind, _) = material("map_Bump directions.png -bm 0.25");
    assert_eq!(behind.normal_map.unwrap().scale, 0.25);
}

#[test]
fn normal_maps_get_tangents_and_bump_maps_a_warning() {
    let (with_normals, scene) = material("norm -bm 0.5 kd.png");
    assert_eq!(with_normals.normal_map.unwrap().scale, 0.5);
    assert_eq!(
        scene.meshes[0].tangents.as_ref().unwrap()[0],
        Vec4::new(1., 0., 0., 1.)
    );
    let (bumpy, scene) = material("map_Bump kd.png");
    assert_eq!(bumpy.normal_map, None);
    assert!(warns(&scene, "a.mtl line 1 \"m\"", "height maps"));
}

#[test]
fn broken_numbers_cost_one_statement_and_not_the_library() {
    let (material, scene) = material("Kd red\nKs 0.125\nNs nan\nKe 1 2 3");
    assert_eq!(phong(&material).diffuse.factor, [0.8; 3]);
    assert_eq!(
        phong(&material).specular.factor,
        [0.125; 3],
        "one number stands for all"
    );
    assert_eq!(material.emission.factor, [1., 2., 3.]);
    assert!(
        warns(&scene, "a.mtl line 1", "kd \"red\""),
        "{:?}",
        scene.warnings
    );
    assert!(warns(&scene, "a.mtl line 1", "ns"), "{:?}", scene.warnings);
}
