//! Images of scenes exported to Mitsuba: which numbers are in the files, and where they are read.

use std::fs;
use std::path::Path;

use glam::{Vec2, Vec3};
use residual_benches::mitsuba::{SCENE_FILE, export};
use residual_frontend::input::{ReadImage, read};
use residual_render::domain::Scalar;
use residual_render::light::{Environment, LightKind};
use residual_render::texture::srgb_table;
use residual_scenegen::desc::{
    AlphaMode, EnvironmentDesc, Filter, ImageDesc, SceneDesc, SurfaceDesc, Texels, TextureDesc,
    TextureUse, Wrap,
};
use residual_scenegen::import::{ImportOptions, import};
use residual_scenegen::plan::{CullingRule, PlanOptions, plan};

fn cornell() -> SceneDesc {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/cornell-box.gltf");
    import(&path, &ImportOptions::default()).unwrap()
}

fn options() -> PlanOptions {
    PlanOptions {
        culling: CullingRule::None,
        ..PlanOptions::default()
    }
}

/// The exported scene's text, and the image that is its only one.
fn exported(scene: &SceneDesc) -> (String, ReadImage) {
    let folder = tempfile::tempdir().unwrap();
    export(scene, &options(), 8, folder.path()).unwrap();
    assert!(!folder.path().join("1.exr").exists());
    (
        fs::read_to_string(folder.path().join(SCENE_FILE)).unwrap(),
        read(&folder.path().join("0.exr")).unwrap(),
    )
}

/// The box whose second material, `red`, reads an image.
fn textured(width: u32, height: u32, texels: &[[u8; 4]], wrap: Wrap) -> (SceneDesc, TextureUse) {
    let mut scene = cornell();
    scene.images.push(ImageDesc {
        name: "image".to_owned(),
        width,
        height,
        texels: Texels::Rgba8(texels.to_vec()),
    });
    scene.textures.push(TextureDesc {
        image: 0,
        wrap: [wrap; 2],
        filter: Filter::Linear,
    });
    for mesh in &mut scene.meshes {
        mesh.uvs[0] = Some(vec![Vec2::splat(0.5); mesh.positions.len()]);
    }
    let texture = TextureUse {
        texture: 0,
        uv_set: 0,
        transform: None,
    };
    (scene, texture)
}

#[test]
fn colours_are_linear_and_the_first_row_is_the_first() {
    let texels = [[255, 0, 0, 255], [0, 188, 0, 255]];
    let (mut scene, texture) = textured(1, 2, &texels, Wrap::Mirror);
    let SurfaceDesc::MetallicRoughness(surface) = &mut scene.materials[1].surface else {
        panic!();
    };
    surface.base_color.factor = [0.5, 0.25, 1.0];
    surface.base_color.texture = Some(TextureUse {
        transform: Some([[2.0, 0.0, 0.25], [0.0, -1.0, 1.0]]),
        ..texture
    });
    let (text, image) = exported(&scene);
    assert_eq!(image.size, [1, 2]);
    let green = 0.25 * srgb_table()[188];
    let expected = [[0.5, 0.0, 0.0], [0.0, green, 0.0]];
    for (found, expected) in image
        .pixels
        .as_flattened()
        .iter()
        .zip(expected.as_flattened())
    {
        assert!((found - expected).abs() < 1e-6, "{:?}", image.pixels);
    }
    for line in [
        r#"<texture type="bitmap" name="reflectance">"#,
        r#"<boolean name="raw" value="true"/>"#,
        r#"<string name="wrap_mode" value="mirror"/>"#,
        r#"<string name="filter_type" value="bilinear"/>"#,
        r#"<matrix value="2 0 0.25 0 -1 1 0 0 1"/>"#,
    ] {
        assert!(text.contains(line), "{line} is not in {text}");
    }
}

#[test]
fn masks_are_made_of_filtered_alpha() {
    let texels = [[9, 9, 9, 0], [9, 9, 9, 255]];
    let (mut scene, texture) = textured(2, 1, &texels, Wrap::Clamp);
    scene.materials[1].alpha.texture = Some((texture, 3));
    scene.materials[1].alpha_mode = AlphaMode::Mask(0.25);
    let (text, image) = exported(&scene);
    // Alpha is 0 at half a texel and 1 at one and a half: a quarter of the way is at six eighths of a texel.
    assert_eq!(image.size, [16, 8]);
    for (index, pixel) in image.pixels.iter().enumerate() {
        let expected = if index % 16 < 6 { 0.0 } else { 1.0 };
        assert_eq!(pixel[0], expected, "column {}", index % 16);
    }
    assert!(text.contains(r#"<bsdf type="mask">"#), "{text}");
    assert!(
        text.contains(r#"<string name="filter_type" value="nearest"/>"#),
        "{text}"
    );
}

#[test]
fn images_that_mitsuba_cannot_wrap_are_refused() {
    let texels = [[255, 0, 0, 255], [0, 188, 0, 255]];
    let (mut scene, texture) = textured(1, 2, &texels, Wrap::BlackBorder);
    let SurfaceDesc::MetallicRoughness(surface) = &mut scene.materials[1].surface else {
        panic!();
    };
    surface.base_color.texture = Some(texture);
    let folder = tempfile::tempdir().unwrap();
    let error = export(&scene, &options(), 8, folder.path()).unwrap_err();
    assert!(format!("{error:#}").contains("in a border"), "{error:#}");
}

/// What Mitsuba 3's `envmap` makes of a direction (`src/emitters/envmap.cpp`): the left edge is at −Z, u grows towards +X, and the
/// first and the last row are at the poles.
fn envmap(image: &ReadImage, degrees: f64, direction: Vec3) -> [f64; 3] {
    let [x, y, z] = direction.as_dvec3().to_array();
    let (sin, cos) = (-degrees).to_radians().sin_cos();
    let (x, z) = (x * cos + z * sin, z * cos - x * sin);
    let u = (x.atan2(-z) / std::f64::consts::TAU).rem_euclid(1.0);
    let v = y.clamp(-1.0, 1.0).acos() / std::f64::consts::PI;
    let [width, height] = image.size;
    let (across, down) = (u * width as f64 - 0.5, v * (height - 1) as f64);
    let pixel = |x: f64, y: f64| {
        let x = x.rem_euclid(width as f64) as usize;
        let y = (y as usize).min(height - 1);
        image.pixels[y * width + x].map(f64::from)
    };
    let (x, y) = (across.floor(), down.floor());
    let (s, t) = (across - x, down - y);
    [0, 1, 2].map(|k| {
        let row = |y: f64| (1.0 - s) * pixel(x, y)[k] + s * pixel(x + 1.0, y)[k];
        (1.0 - t) * row(y) + t * row(y + 1.0)
    })
}

#[test]
fn environments_shine_from_where_they_do_here() {
    let mut scene = cornell();
    let texel = |index: u32| {
        [
            0.1 + (index * 7 % 11) as f32,
            (index % 5) as f32,
            index as f32,
            1.0,
        ]
    };
    scene.images.push(ImageDesc {
        name: "sky".to_owned(),
        width: 6,
        height: 3,
        texels: Texels::RgbaF32((0..18).map(texel).collect()),
    });
    scene.environment = Some(EnvironmentDesc {
        image: 0,
        strength: 2.0,
        rotation: 0.7,
    });
    let (text, image) = exported(&scene);
    assert!(
        text.contains(r#"<float name="scale" value="2"/>"#),
        "{text}"
    );
    let (_, angle) = text.split_once(r#"<rotate y="1" angle=""#).unwrap();
    let angle: f64 = angle.split_once('"').unwrap().0.parse().unwrap();
    let planned = plan(&scene, &options()).unwrap();
    let buffers = planned.data.buffers();
    let d = Scalar::new(&buffers);
    for index in 0..500 {
        let y = 1.0 - (index as f32 + 0.5) / 250.0;
        let (sin, cos) = (2.4 * index as f32).sin_cos();
        let radius = (1.0 - y * y).sqrt();
        let direction = Vec3::new(radius * cos, y, radius * sin);
        let ours = Environment
            .background(d, direction.to_array().into())
            .unwrap();
        let ours = ours.radiance.to_array().map(f64::from);
        let theirs = envmap(&image, angle, direction).map(|c| 2.0 * c);
        for k in 0..3 {
            assert!(
                (ours[k] - theirs[k]).abs() < 1e-2,
                "{direction}: {ours:?}, {theirs:?}"
            );
        }
    }
}
