//! `SceneDesc::validate` accepts what the importers make and finds every violation.

use std::path::PathBuf;

use glam::{Affine3A, Vec2, Vec3, Vec4};
use residual_scenegen::desc::{
    EnvironmentDesc, ImageDesc, LightDesc, PunctualKind, SceneDesc, Texels, TextureDesc,
    TextureUse, Wrap,
};
use residual_scenegen::import::{ImportOptions, import};

/// A valid scene of one triangle.
fn triangle() -> SceneDesc {
    let folder = tempfile::tempdir().unwrap();
    let path: PathBuf = folder.path().join("a.obj");
    std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    import(&path, &ImportOptions::default()).unwrap()
}

#[test]
fn violations_are_found_and_placed() {
    type Break = fn(&mut SceneDesc);
    let image = || ImageDesc {
        name: String::new(),
        width: 1,
        height: 1,
        texels: Texels::Rgba8(vec![[0; 4]]),
    };
    let cases: &[(&str, Break)] = &[
        ("meshes[0].material", |scene| scene.meshes[0].material = 1),
        ("meshes[0].positions", |scene| {
            scene.meshes[0].positions[1].x = f32::NAN
        }),
        ("meshes[0].normals", |scene| {
            scene.meshes[0].normals.truncate(2)
        }),
        ("meshes[0].normals", |scene| {
            scene.meshes[0].normals[0] = Vec3::ZERO
        }),
        ("meshes[0].tangents", |scene| {
            scene.meshes[0].tangents = Some(vec![Vec4::ONE; 3])
        }),
        ("meshes[0].uvs", |scene| {
            scene.meshes[0].uvs[1] = Some(vec![Vec2::ZERO; 2])
        }),
        ("meshes[0].colors", |scene| {
            scene.meshes[0].colors = Some(vec![Vec4::INFINITY; 3])
        }),
        ("meshes[0].triangles", |scene| {
            scene.meshes[0].triangles[0][2] = 3
        }),
        ("instances[0].mesh", |scene| scene.instances[0].mesh = 7),
        ("instances[0].transform", |scene| {
            scene.instances[0].transform = Affine3A::NAN
        }),
        ("materials[0].emission", |scene| {
            scene.materials[0].emission.factor[0] = -1.0
        }),
        ("materials[0].alpha", |scene| {
            scene.materials[0].alpha.factor = f32::NAN
        }),
        ("materials[0].textures", |scene| {
            scene.materials[0].emission.texture = Some(TextureUse {
                texture: 0,
                uv_set: 0,
                transform: None,
            });
        }),
        ("textures[0].image", |scene| {
            let wrap = [Wrap::Repeat; 2];
            scene.textures.push(TextureDesc {
                image: 0,
                wrap,
                filter: Default::default(),
            });
        }),
        ("environment", |scene| {
            scene.environment = Some(EnvironmentDesc {
                image: 0,
                strength: 1.0,
                rotation: 0.0,
            });
        }),
        ("lights[0]", |scene| {
            let kind = PunctualKind::Directional {
                direction: Vec3::ZERO,
            };
            scene.lights.push(LightDesc {
                name: String::new(),
                kind,
                intensity: [1.0; 3],
                size: 0.0,
            });
        }),
        ("lights[0]", |scene| {
            let kind = PunctualKind::Directional { direction: Vec3::Z };
            scene.lights.push(LightDesc {
                name: String::new(),
                kind,
                intensity: [1.0; 3],
                size: 3.2,
            });
        }),
    ];
    triangle().validate().unwrap();
    for (place, damage) in cases {
        let mut scene = triangle();
        damage(&mut scene);
        let violation = scene.validate().expect_err(place);
        assert_eq!(violation.place, *place, "{violation}");
    }

    let mut scene = triangle();
    scene.images.push(ImageDesc {
        width: 2,
        ..image()
    });
    assert_eq!(scene.validate().unwrap_err().place, "images[0]");
    scene.images[0] = ImageDesc {
        texels: Texels::RgbaF32(vec![[0.0, -1.0, 0.0, 1.0]]),
        ..image()
    };
    assert_eq!(scene.validate().unwrap_err().place, "images[0]");
}
