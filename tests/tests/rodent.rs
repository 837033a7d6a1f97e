//! Known faults of Rodent, the thesis's implementation: one test for each, of whatever comes nearest to it here.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use glam::Vec3;
use residual_device_cpu::LaneCount;
use residual_render::domain::Buffer;
use residual_render::light::set_picks;
use residual_scenegen::desc::{LightDesc, PunctualKind, SceneDesc, SurfaceDesc, Texels};
use residual_scenegen::effects::{Effect, Effects};
use residual_scenegen::emit::rust;
use residual_scenegen::plan::{Binding, Plan, PlanOptions, plan};
use residual_tests::pictures::{first_difference, mean, read_exr};
use residual_tests::{Look, Prepared, fixtures, read_scene};
use tempfile::TempDir;

const SIZE: [u32; 2] = [24, 18];

/// A quadrilateral of one material, with texture coordinates.
const QUAD: &str = "mtllib scene.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n\
                    vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3 4/4\n";

fn folder(material: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.obj"), QUAD).unwrap();
    fs::write(
        folder.path().join("scene.mtl"),
        format!("newmtl m\n{material}"),
    )
    .unwrap();
    for (name, color) in [("red", [255, 0, 0]), ("blue", [0, 0, 255])] {
        let mut pixels = image::RgbImage::from_pixel(2, 2, image::Rgb(color));
        // An image of one colour would be a number, and no texture.
        pixels.put_pixel(1, 1, image::Rgb(color.map(|c| c / 255 * 250)));
        pixels
            .save(folder.path().join(format!("{name}.png")))
            .unwrap();
    }
    folder
}

fn read(folder: &TempDir) -> SceneDesc {
    read_scene(&folder.path().join("scene.obj"), None).unwrap()
}

fn planned(scene: &SceneDesc, binding: Binding) -> Plan {
    let options = PlanOptions {
        size: SIZE,
        binding,
        ..PlanOptions::default()
    };
    plan(scene, &options).unwrap()
}

/// Mean colour of a picture without an invalid sample.
fn shown(plan: &Plan) -> [f64; 3] {
    let film = Prepared::new(plan, LaneCount::Eight).interpret(&Look::new(SIZE, 16));
    assert_eq!(film.invalid_samples(), 0);
    mean(&film.image())
}

/// Runs the command line.
fn run(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_residual-tests"))
        .current_dir(folder)
        .args(args)
        .output()
        .unwrap()
}

/// `map_Ks` was registered as `map_Kd`.
#[test]
fn specular_maps_colour_the_highlight_only() {
    let folder = folder("Kd 0.5 0.5 0.5\nKs 1 1 1\nNs 1\nillum 2\nmap_Ks red.png\n");
    let mut scene = read(&folder);
    let SurfaceDesc::Phong(surface) = &scene.materials[0].surface else {
        panic!("{:?}", scene.materials[0]);
    };
    assert!(surface.diffuse.texture.is_none());
    assert!(surface.specular.texture.is_some());
    // Before a black sky: green and blue are the diffuse half, red is more.
    let position = Vec3::new(0.0, 0.0, 3.0);
    scene.lights.push(LightDesc {
        name: "lamp".to_owned(),
        kind: PunctualKind::Point { position },
        intensity: [5.0; 3],
        size: 0.0,
    });
    let [r, g, b] = shown(&planned(&scene, Binding::Structure));
    assert!(r > 1.2 * g && g == b && g > 0.0, "{r} {g} {b}");
}

/// Emission with a texture was not a program that could be typed.
#[test]
fn textured_emission_compiles_and_shines() {
    let folder = folder("Kd 0 0 0\nKe 2 2 2\nmap_Ke blue.png\n");
    let plan = planned(&read(&folder), Binding::Structure);
    let effects = Effects::of(&plan);
    assert!(!effects.reasons(Effect::TexturedEmission).is_empty());
    let [r, g, b] = shown(&plan);
    assert!(r == 0.0 && g == 0.0 && b > 0.0, "{r} {g} {b}");
    // As a type: `goldens.rs` compiles the golden file of the same name.
    assert!(rust::module(&plan, "Eight").contains("Area<Product<Param, Image<"));
}

/// A scene without lights divided by their number.
#[test]
fn a_scene_without_lights_is_dark_or_under_a_sky_but_no_division() {
    // The plan gives it a sky, and says so.
    let scene = fixtures::triangle();
    let plan = planned(&scene, Binding::Structure);
    assert!(
        plan.warnings
            .iter()
            .any(|warning| warning.message.contains("no light"))
    );
    assert!(shown(&plan).iter().all(|c| *c > 0.0));
    // A renderer that has none in spite of that shows black.
    let mut dark = plan;
    dark.structure.lights.clear();
    for buffer in [Buffer::Lights, Buffer::Environment] {
        dark.data.buffer_mut(buffer).clear();
    }
    set_picks(&mut dark.data, std::iter::empty());
    assert_eq!(shown(&dark), [0.0; 3]);
}

/// The hierarchy was cached under the name of the scene's file.
#[test]
fn scenes_of_one_name_share_nothing_that_differs() {
    let colors = [
        "Kd 0.8 0.1 0.1\n",
        "Kd 0.1 0.1 0.8\n",
        "Kd 0 0 0\nKe 1 1 1\n",
    ];
    let folders = colors.map(folder);
    // Another triangle in the same file name.
    let moved = QUAD.replace("v -1 1 0", "v 0 2 0");
    fs::write(folders[1].path().join("scene.obj"), moved).unwrap();
    let args = |out: &'static str| {
        let tier = if out == "a.exr" {
            "interpreted"
        } else {
            "specialized"
        };
        [
            "render",
            "scene.obj",
            "--size",
            "24x18",
            "--spp",
            "2",
            "--quiet",
            "--tier",
            tier,
            "-o",
            out,
        ]
    };
    let pictures = folders.each_ref().map(|folder| {
        let [interpreted, specialized] = ["a.exr", "b.exr"].map(|out| {
            let output = run(folder.path(), &args(out));
            let message = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(output.status.success(), "{message}");
            read_exr(&folder.path().join(out)).unwrap().1
        });
        assert_eq!(first_difference(&interpreted, &specialized), None);
        specialized
    });
    for (a, b) in [(0, 1), (0, 2), (1, 2)] {
        assert!(first_difference(&pictures[a], &pictures[b]).is_some());
    }
    // Two of one structure do share a renderer: what it is known by is its text.
    let texts = folders
        .each_ref()
        .map(|folder| rust::module(&planned(&read(folder), Binding::Structure), "Eight"));
    assert!(texts[0] == texts[1] && texts[0] != texts[2]);
}

/// TGA and TIFF images became a call of a function that did not exist.
#[test]
fn images_are_decoded_whatever_their_format_or_said_to_be_missing() {
    let folder = folder("Kd 1 1 1\nmap_Kd picture.tga\n");
    let pixels = image::RgbImage::from_pixel(2, 2, image::Rgb([255, 0, 0]));
    pixels.save(folder.path().join("picture.tga")).unwrap();
    let scene = read(&folder);
    assert_eq!(scene.warnings, []);
    assert!(
        matches!(&scene.images[0].texels, Texels::Rgba8(texels) if texels[0] == [255, 0, 0, 255])
    );

    fs::write(
        folder.path().join("picture.tiff"),
        b"II*\0\x08\0\0\0\0\0\0\0\0\0",
    )
    .unwrap();
    fs::write(
        folder.path().join("scene.mtl"),
        "newmtl m\nmap_Kd picture.tiff\n",
    )
    .unwrap();
    let scene = read(&folder);
    assert!(
        scene
            .warnings
            .iter()
            .any(|warning| warning.place.contains("picture.tiff")),
        "{:?}",
        scene.warnings
    );
    assert!(
        shown(&planned(&scene, Binding::Structure))
            .iter()
            .all(|c| *c > 0.0)
    );
}

/// Rays started 0.001 from a surface, whatever its size.
#[test]
fn the_size_of_a_scene_does_not_matter() {
    let sizes = [1.0_f32, 1e-4, 1e4].map(|size| {
        let mut scene = fixtures::room();
        for mesh in &mut scene.meshes {
            for position in &mut mesh.positions {
                *position *= size;
            }
        }
        for camera in &mut scene.cameras {
            camera.position *= size;
        }
        shown(&planned(&scene, Binding::Structure))
    });
    for other in &sizes[1..] {
        for (a, b) in sizes[0].iter().zip(other) {
            assert!((a / b - 1.0).abs() < 0.03, "{sizes:?}");
        }
    }
}

/// Test scripts compared the wrong exit status.
#[test]
fn statuses_tell_success_failure_and_bad_usage_apart() {
    let folder = folder("Kd 0.5 0.5 0.5\n");
    let status = |args: &[&str]| run(folder.path(), args).status.code();
    assert_eq!(status(&["inspect", "scene.obj"]), Some(0));
    assert_eq!(status(&["inspect", "other.obj"]), Some(1));
    assert_eq!(status(&["inspect", "--bogus"]), Some(2));
    assert_eq!(status(&["emit", "scene.obj", "--target", "rust"]), Some(0));
    assert_eq!(status(&["emit", "scene.obj", "--target", "artic"]), Some(2));
}

/// The order of what was generated was that of a hash table. Each process has another seed for its tables.
#[test]
fn emitted_texts_do_not_depend_on_the_process() {
    let folder =
        folder("Kd 0.5 0.5 0.5\nKs 1 1 1\nNs 8\nillum 2\nmap_Ks red.png\nmap_Ke blue.png\n");
    for target in ["rust", "wgsl"] {
        let text = || run(folder.path(), &["emit", "scene.obj", "--target", target]).stdout;
        let first = text();
        assert!(!first.is_empty());
        for _ in 0..3 {
            assert!(text() == first, "{target}");
        }
    }
}

/// Floats were printed with six digits.
#[test]
fn numbers_read_back_as_the_same_bits() {
    let awkward = [
        0.1,
        1.0 / 3.0,
        0.123_456_79,
        f32::MIN_POSITIVE,
        f32::from_bits(1),
        1.0_f32.next_down(),
        1.0_f32.next_up(),
        0.5_f32.next_up(),
        16_777_216.0,
    ];
    for value in awkward {
        let mut scene = fixtures::triangle();
        scene.materials[0].surface = fixtures::matte([value, 0.25, 0.75]);
        let plan = planned(&scene, Binding::Constants);
        let text = rust::module(&plan, "Eight");
        let start = text.find("Const([").expect("an albedo") + "Const([".len();
        let printed = text[start..].split(',').next().unwrap();
        assert_eq!(
            printed.parse::<f32>().unwrap().to_bits(),
            value.to_bits(),
            "{printed}"
        );
        // What is known by six digits would be the same renderer.
        let mut other = scene;
        other.materials[0].surface = fixtures::matte([value.next_up(), 0.25, 0.75]);
        let other = planned(&other, Binding::Constants);
        assert_ne!(text, rust::module(&other, "Eight"));
        assert!(
            plan.check_structure(residual_scenegen::fingerprint(&other.structure))
                .is_err()
        );
        assert_ne!(
            residual_wgsl::scene_module(&plan.structure),
            residual_wgsl::scene_module(&other.structure)
        );
    }
}
