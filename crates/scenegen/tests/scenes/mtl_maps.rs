//! Options of texture maps in MTL files.

use residual_scenegen::desc::{ScalarInput, SceneDesc, SurfaceDesc, Texels, Wrap};

use crate::common::gltf_text::warns;
use crate::common::obj_text::{TRIANGLE, material, phong, png, red, try_import};

#[test]
fn texture_options_do_not_hide_the_file() {
    let (tiled, scene) = material("map_Kd -s 2 4 -o 0.5 0.25 -clamp on -mm 0.5 1 kd.png");
    let texture = phong(&tiled).diffuse.texture.clone().unwrap();
    assert_eq!(
        texture.transform,
        Some([[2., 0., 0.5], [0., 4., 1. - 4. - 0.25]])
    );
    assert_eq!(scene.textures[texture.texture].wrap, [Wrap::WhiteBorder; 2]);
    assert_eq!(red(&scene, texture.texture), 0);
    assert!(warns(&scene, "a.mtl", "-mm of map_kd is ignored"));
    assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
}

#[test]
fn a_gain_is_a_factor_of_colours_and_other_options_are_said_to_be_ignored() {
    let (darker, scene) = material("Kd 1 0.5 0\nmap_Kd -mm 0 0.5 white.png");
    assert_eq!(phong(&darker).diffuse.factor, [0.5, 0.25, 0.0]);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let (_, scene) = material("map_Kd -imfchan g white.png");
    assert!(warns(&scene, "m", "-imfchan of map_kd is ignored"));
    let (brighter, scene) = material("map_Kd -mm 0.5 0.5 white.png");
    assert_eq!(phong(&brighter).diffuse.factor, [1.0; 3]);
    assert!(warns(&scene, "m", "-mm of map_kd is ignored"));
}

/// The number that a scalar input reads of its only texel.
fn read(scene: &SceneDesc, input: &ScalarInput) -> f32 {
    let (texture, channel) = input.texture.as_ref().unwrap();
    match &scene.images[scene.textures[texture.texture].image].texels {
        Texels::Rgba8(texels) => f32::from(texels[0][*channel]) / 255.0,
        Texels::Rgba16(texels) => f32::from(texels[0][*channel]) / 65535.0,
        Texels::RgbaF32(texels) => texels[0][*channel],
    }
}

#[test]
fn numbers_are_read_of_what_the_options_say() {
    let color = png([200, 100, 50, 64]);
    let value = |statement: &str| {
        let scene = try_import(&[
            ("a.obj", TRIANGLE.as_bytes()),
            (
                "a.mtl",
                format!("newmtl m\nKd 1 1 1\n{statement}\n").as_bytes(),
            ),
            ("color.png", &color),
        ])
        .unwrap();
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
        read(&scene, &scene.materials[0].alpha)
    };
    let [r, g, b, a] = [200.0, 100.0, 50.0, 64.0].map(|code: f32| code / 255.0);
    let luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    for (options, expected) in [
        ("", a),
        ("-imfchan r", r),
        ("-imfchan G", g),
        ("-IMFCHAN b", b),
        ("-imfchan m", a),
        ("-imfchan l", luminance),
        ("-imfchan L -mm 0 0.5", 0.5 * luminance),
        ("-imfchan r -mm 0.1 0.5", 0.1 + 0.5 * r),
        ("-MM 0.5 0.25", 0.5 + 0.25 * a),
        ("-imfchan r -mm 1 -1", 1.0 - r),
        ("-imfchan r -mm 0.5 2", 1.0),
    ] {
        let found = value(&format!("map_d {options} color.png"));
        assert!(
            (found - expected).abs() < 1e-5,
            "{options}: {found} {expected}"
        );
    }
}

#[test]
fn options_hold_for_every_map_of_numbers() {
    let (shiny, scene) = material("Ks 0.1 0.1 0.1\nmap_Ns -mm 0 0.5 white.png\nmap_d white.png");
    assert!((read(&scene, &phong(&shiny).exponent) - 0.5).abs() < 1e-4);
    assert_eq!(read(&scene, &shiny.alpha), 1.0, "the same file as it is");
    let (metal, scene) = material("map_Pr -mm 0.25 0.5 white.png\nmap_Pm -mm 0 0.25 white.png");
    let SurfaceDesc::MetallicRoughness(surface) = &metal.surface else {
        panic!("{metal:?}")
    };
    assert!((read(&scene, &surface.roughness) - 0.75).abs() < 1e-4);
    assert!((read(&scene, &surface.metallic) - 0.25).abs() < 1e-4);
    let (_, scene) = material("map_d -imfchan z white.png");
    assert!(warns(&scene, "m", "-imfchan of map_d is ignored"));
}

#[test]
fn options_in_capitals_are_options() {
    let (bumpy, scene) =
        material("map_Bump -BM 0.5 directions.png\nmap_Kd -S 2 2 -Clamp ON kd.png");
    assert_eq!(bumpy.normal_map.as_ref().unwrap().scale, 0.5);
    let texture = phong(&bumpy).diffuse.texture.clone().unwrap();
    assert!(texture.transform.is_some());
    assert_eq!(scene.textures[texture.texture].wrap, [Wrap::WhiteBorder; 2]);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

/// Around an image that is there once, the material is what it is without the image.
#[test]
fn around_stamps_there_is_the_material() {
    let wrap = |statements: &str, input: fn(&SceneDesc) -> usize| {
        let (_, scene) = material(statements);
        scene.textures[input(&scene)].wrap
    };
    let diffuse = |scene: &SceneDesc| {
        phong(&scene.materials[0])
            .diffuse
            .texture
            .clone()
            .unwrap()
            .texture
    };
    let emission = |scene: &SceneDesc| scene.materials[0].emission.texture.clone().unwrap().texture;
    let alpha = |scene: &SceneDesc| scene.materials[0].alpha.texture.clone().unwrap().0.texture;
    for (statements, input, expected) in [
        (
            "Kd 0.5 0.5 0.5\nmap_Kd -clamp on kd.png",
            diffuse as fn(&SceneDesc) -> usize,
            Wrap::WhiteBorder,
        ),
        (
            "Kd 0 0 0\nmap_Kd -clamp on kd.png",
            diffuse,
            Wrap::BlackBorder,
        ),
        ("map_Ke -clamp on kd.png", emission, Wrap::BlackBorder),
        (
            "Ke 2 2 2\nmap_Ke -clamp on kd.png",
            emission,
            Wrap::WhiteBorder,
        ),
        ("map_Ke -clamp off kd.png", emission, Wrap::Repeat),
        ("map_d -clamp on kd.png", alpha, Wrap::WhiteBorder),
        ("d 0\nmap_d -clamp on kd.png", alpha, Wrap::BlackBorder),
    ] {
        assert_eq!(wrap(statements, input), [expected; 2], "{statements}");
    }
}
