//! OBJ and MTL files, keyword by keyword.

use std::path::Path;

use glam::{Vec2, Vec3, Vec4};
use residual_scenegen::desc::{
    AlphaMode, MaterialDesc, PhongSurface, SceneDesc, SurfaceDesc, Texels, Wrap,
};
use residual_scenegen::import::{ImportError, ImportOptions, import};
use tempfile::TempDir;

mod common;

use common::gltf_text::warns;

const TRIANGLE: &str =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 0.75\nusemtl m\nf 1/1 2/2 3/3\n";

/// A folder with files, among them `a.obj` and images of one texel.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        write(folder.path(), name, text.as_bytes());
    }
    for (index, name) in ["kd.png", "ks.png", "tex/Deep One.PNG"]
        .into_iter()
        .enumerate()
    {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        let color = image::Rgba([index as u8, 0, 0, 255]);
        image::RgbaImage::from_pixel(1, 1, color)
            .save_with_format(path, image::ImageFormat::Png)
            .unwrap();
    }
    folder
}

fn write(folder: &Path, name: &str, bytes: &[u8]) {
    std::fs::write(folder.join(name), bytes).unwrap();
}

fn try_import(files: &[(&str, &str)]) -> Result<SceneDesc, ImportError> {
    import(
        &folder(files).path().join("a.obj"),
        &ImportOptions::default(),
    )
}

/// The material of a triangle with the given MTL statements.
fn material(statements: &str) -> (MaterialDesc, SceneDesc) {
    let scene = try_import(&[
        ("a.obj", TRIANGLE),
        ("a.mtl", &format!("newmtl m\n{statements}\n")),
    ])
    .unwrap();
    (scene.materials[0].clone(), scene)
}

fn phong(material: &MaterialDesc) -> &PhongSurface {
    match &material.surface {
        SurfaceDesc::Phong(phong) => phong,
        other => panic!("{other:?}"),
    }
}

/// The red byte of a texture's only texel, which says which file it is.
fn red(scene: &SceneDesc, texture: usize) -> u8 {
    match &scene.images[scene.textures[texture].image].texels {
        Texels::Rgba8(texels) => texels[0][0],
        Texels::RgbaF32(_) => panic!("8 bits"),
    }
}

#[test]
fn geometry_has_flat_normals_and_v_downwards() {
    let (_, scene) = material("Kd 1 0 0");
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(mesh.normals, [Vec3::Z; 3]);
    assert_eq!(
        mesh.uvs[0].as_ref().unwrap()[..],
        [Vec2::new(0., 1.), Vec2::new(1., 1.), Vec2::new(0., 0.25)]
    );
    assert_eq!(scene.instances.len(), 1);
    assert!(scene.materials[0].double_sided);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

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
        let statements = format!("Kd 0.1 0.2 0.3\nKs 0.4 0.5 0.6\nNs 40\nillum {illum}");
        let (material, scene) = material(&statements);
        let SurfaceDesc::Mirror {
            diffuse,
            reflectance,
        } = &material.surface
        else {
            panic!("{material:?}")
        };
        assert_eq!(diffuse.factor, [0.1, 0.2, 0.3]);
        assert_eq!(reflectance.factor, [0.4, 0.5, 0.6]);
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    }
}

/// What MTL adds may reflect more than arrives.
#[test]
fn mirrors_conserve_energy() {
    let (material, scene) = material("Kd 0.5 0.5 1\nKs 1 0 1\nmap_Ks ks.png\nillum 3");
    let SurfaceDesc::Mirror {
        diffuse,
        reflectance,
    } = &material.surface
    else {
        panic!("{material:?}")
    };
    assert_eq!(diffuse.factor, [0.25, 0.25, 0.5]);
    assert_eq!(reflectance.factor, [0.5, 0.0, 0.5]);
    assert!(reflectance.texture.is_some());
    assert!(warns(&scene, "m", "reflect 2 times what arrives"));
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
    assert_eq!(glass("d 0.5\nNi 1.5"), (1.5, [1.0; 3]));
    assert_eq!(glass("illum 7"), (1.5, [1.0; 3]));
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
fn texture_options_do_not_hide_the_file() {
    let (tiled, scene) = material("map_Kd -s 2 4 -o 0.5 0.25 -clamp on -mm 0 1 kd.png");
    let texture = phong(&tiled).diffuse.texture.clone().unwrap();
    assert_eq!(
        texture.transform,
        Some([[2., 0., 0.5], [0., 4., 1. - 4. - 0.25]])
    );
    assert_eq!(scene.textures[texture.texture].wrap, [Wrap::Clamp; 2]);
    assert_eq!(red(&scene, texture.texture), 0);
    assert!(warns(&scene, "a.mtl", "-mm of map_kd is ignored"));
    assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
}

#[test]
fn backslashes_spaces_and_other_case_find_the_file() {
    let (found, scene) = material("map_Kd TEX\\deep one.png");
    assert_eq!(
        red(
            &scene,
            phong(&found).diffuse.texture.as_ref().unwrap().texture
        ),
        2
    );
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn missing_files_and_materials_are_warnings() {
    let scene = try_import(&[("a.obj", TRIANGLE)]).unwrap();
    assert!(warns(&scene, "line 1", "a.mtl"), "{:?}", scene.warnings);
    assert!(warns(&scene, "line 8", "\"m\""), "{:?}", scene.warnings);
    assert_eq!(phong(&scene.materials[0]).diffuse.factor, [0.8; 3]);
    let (white, scene) = material("map_Kd nowhere.png");
    assert!(phong(&white).diffuse.texture.is_some());
    assert!(
        warns(&scene, "nowhere.png", "is not there"),
        "{:?}",
        scene.warnings
    );
}

#[test]
fn broken_numbers_cost_one_statement_and_not_the_library() {
    let (material, scene) = material("Kd red\nKs 0.5\nNs nan\nKe 1 2 3");
    assert_eq!(phong(&material).diffuse.factor, [0.8; 3]);
    assert_eq!(
        phong(&material).specular.factor,
        [0.5; 3],
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

#[test]
fn polygons_colours_negative_indices_and_comments() {
    let text = "v 0 0 0 1 0 0 # red\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 0.5 0.5 0.5\n\
                p 1\nl 1 2 3\nf -4 -3 \\\n-2 -1 # a square\n";
    let scene = try_import(&[("a.obj", text)]).unwrap();
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.triangles.len(), 2);
    assert_eq!(mesh.normals, [Vec3::Z; 6]);
    assert_eq!(mesh.colors.as_ref().unwrap()[1], Vec4::new(0., 1., 0., 1.));
    assert!(warns(&scene, "p, l", "2 points and lines"));
}

#[test]
fn corners_with_and_without_normals_fall_back_to_flat_ones() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvn 1 0 0\nf 1//1 2//1 3//1\nf 2 4 3\n";
    let scene = try_import(&[("a.obj", text)]).unwrap();
    assert_eq!(scene.meshes[0].normals, [Vec3::Z; 6]);
    assert!(
        warns(&scene, "o \"", "only some corners have normals"),
        "{:?}",
        scene.warnings
    );
}

#[test]
fn references_to_an_attribute_that_is_nowhere_are_ignored() {
    let scene =
        try_import(&[("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1/1 2/2/1 3/3/1\n")]).unwrap();
    assert_eq!(scene.meshes[0].normals, [Vec3::Z; 3]);
    assert_eq!(scene.meshes[0].uvs, [None, None]);
    assert!(
        warns(&scene, "line 4", "vn, of which there are none"),
        "{:?}",
        scene.warnings
    );
}

#[test]
fn malformed_lines_are_errors_with_their_line() {
    for (text, expected) in [
        ("v 0 0 0\nv 1 x 0\n", "line 2: position parse error"),
        ("v 0 0 0\nf 1 a 1\n", "line 2: \"a\" in a face"),
        (
            "v 0 0 0\nf 1 2 3\n",
            "line 2: a face refers to v 3, but there are 1",
        ),
        ("v 0 0 0\nf 0 0 0\n", "line 2: a face refers to v 0"),
        ("v 0 0 0\nf -1 -2 -1\n", "line 2: a face refers to v -2"),
        (
            "v 0 0 0\nf 1/-9223372036854775808 1/9 1\nvt 0 0\n",
            "line 2: a face refers to vt",
        ),
        (
            "v 0 0 0\nf 1//9223372036854775807 1 1\nvn 0 0 1\n",
            "line 2: a face refers to vn",
        ),
    ] {
        let message = try_import(&[("a.obj", text)]).expect_err(text).to_string();
        assert!(
            message.contains(expected) && message.contains("a.obj"),
            "{message}"
        );
    }
}
