//! Environment images, replaced texels, and the formats by extension.

use std::path::Path;

use residual_render::alias_table::AliasEntry;
use residual_render::domain::Buffer;
use residual_render::light::EnvironmentHeader;
use residual_render::record::BufferRecord;
use residual_render::tracer::{AnyMis, AnySharing, TracerNode};

use crate::common;
use crate::common::gltf_text::{Gltf, warns};
use residual_scenegen::desc::Texels;
use residual_scenegen::import::{EnvironmentOptions, ImportError, ImportOptions, import};
use residual_scenegen::plan::{PlanOptions, plan};

fn options(path: &Path) -> ImportOptions {
    let environment = EnvironmentOptions {
        path: path.to_owned(),
        strength: 2.0,
        rotation_degrees: 90.0,
    };
    ImportOptions {
        environment: Some(environment),
        ..ImportOptions::default()
    }
}

#[test]
fn shared_environments_are_read() {
    let Some(scenes) = common::scenes() else {
        return;
    };
    for path in common::files_under(&scenes.join("env")) {
        let scene = Gltf::square().import_with(&options(&path)).unwrap();
        let environment = scene.environment.as_ref().unwrap();
        let image = &scene.images[environment.image];
        assert_eq!(image.width, 2 * image.height, "{}", path.display());
        assert_eq!(
            (environment.strength, environment.rotation),
            (2.0, std::f32::consts::FRAC_PI_2)
        );
        let Texels::RgbaF32(texels) = &image.texels else {
            panic!("linear")
        };
        assert!(texels.iter().any(|texel| texel[0] > 0.0));
    }
}

#[test]
fn bad_texels_of_an_exr_are_replaced_and_counted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bad.exr");
    let texels = [f32::NAN, f32::INFINITY, -1.0, 1e38];
    exr::prelude::write_rgb_file(&path, 4, 1, |x, _| (texels[x], 0.5_f32, 0.25_f32)).unwrap();
    let scene = Gltf::square().import_with(&options(&path)).unwrap();
    let Texels::RgbaF32(read) = &scene.images[0].texels else {
        panic!("linear")
    };
    assert_eq!(
        read[..],
        [0.0, 1e30, 0.0, 1e30].map(|red| [red, 0.5, 0.25, 1.0])
    );
    for message in [
        "2 texels have NaN or negative",
        "2 texels have infinite or too large",
    ] {
        assert!(warns(&scene, "bad.exr", message), "{:?}", scene.warnings);
    }
}

#[test]
fn eight_bit_environments_are_decoded_from_srgb() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sky.png");
    image::RgbImage::from_pixel(2, 1, image::Rgb([0, 188, 255]))
        .save(&path)
        .unwrap();
    let scene = Gltf::square().import_with(&options(&path)).unwrap();
    let Texels::RgbaF32(texels) = &scene.images[0].texels else {
        panic!("linear")
    };
    assert_eq!((texels[0][0], texels[0][2]), (0.0, 1.0));
    assert!(
        (texels[0][1] - 0.502_886_5).abs() < 1e-6,
        "{}",
        texels[0][1]
    );
}

/// Where BSDF samples find the sky as well, light samples go where it is brighter than its mean alone; where they do not share the
/// work, each texel that shines is sampled.
#[test]
fn what_is_sampled_of_a_sky_depends_on_who_else_finds_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lamp.exr");
    let texel = |x, y| if (x, y) == (3, 2) { 9.0_f32 } else { 0.5 };
    exr::prelude::write_rgb_file(&path, 16, 8, |x, y| [texel(x, y); 3].into()).unwrap();
    let scene = Gltf::square().import_with(&options(&path)).unwrap();
    let sampled = |tracer| {
        let options = PlanOptions {
            tracer,
            ..PlanOptions::default()
        };
        let plan = plan(&scene, &options).unwrap();
        let words = plan.data.buffer(Buffer::Environment);
        let entries = &words[EnvironmentHeader::WORDS as usize..];
        let entries = entries.chunks_exact(AliasEntry::WORDS as usize);
        let densities = entries.map(|entry| AliasEntry::from_words(entry).density);
        densities.filter(|&density| density > 0.0).count()
    };
    for mis in [AnyMis::PowerHeuristic, AnyMis::BalanceHeuristic] {
        // The lamp, and its neighbours, over which its bilinear image reaches.
        assert_eq!(sampled(TracerNode::Path(mis)), 9, "{mis:?}");
    }
    for tracer in [
        TracerNode::Path(AnyMis::LightsOnly),
        TracerNode::Bidirectional(AnySharing::Combined),
        TracerNode::Bidirectional(AnySharing::LightPathsOnly),
    ] {
        assert_eq!(sampled(tracer), 16 * 8, "{tracer:?}");
    }
}

#[test]
fn environments_that_cannot_be_read_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("missing.hdr");
    let message = Gltf::square()
        .import_with(&options(&missing))
        .unwrap_err()
        .to_string();
    assert!(message.contains("missing.hdr"), "{message}");
    let broken = folder.path().join("broken.exr");
    std::fs::write(&broken, [0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0, 1, 2, 3]).unwrap();
    let message = Gltf::square()
        .import_with(&options(&broken))
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("broken.exr") && message.contains("environment"),
        "{message}"
    );
}

#[test]
fn formats_are_told_by_extension_in_any_case() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("A.OBJ");
    std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let scene = import(&path, &ImportOptions::default()).unwrap();
    assert_eq!(
        (scene.name.as_str(), scene.meshes[0].triangles.len()),
        ("A", 1)
    );
    let other = import(Path::new("a.fbx"), &ImportOptions::default());
    assert!(matches!(other, Err(ImportError::UnknownFormat { .. })));
    let absent = import(Path::new("/nowhere/a.glb"), &ImportOptions::default()).unwrap_err();
    assert!(matches!(absent, ImportError::Io { .. }), "{absent}");
}
