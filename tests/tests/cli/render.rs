//! `render`: statistics, limits, and scenes that lack something.

use std::time::{Duration, Instant};

use residual_tests::pictures::read_exr;
use serde_json::{Value, json};

use super::{good, render, statistics, stderr, workplace};

#[test]
fn statistics_have_what_the_design_promises() {
    let folder = workplace();
    let output = good(render(
        &folder,
        &["triangle.obj", "--quiet", "--stats", "json", "--spp", "4"],
    ));
    let stats = statistics(&output);
    for number in [
        "/width",
        "/height",
        "/spp",
        "/seconds/load",
        "/seconds/bvh",
        "/seconds/compile",
        "/seconds/render",
        "/seconds/total",
        "/msamples_per_s",
        "/cpu_seconds",
        "/rays/camera",
        "/rays/bounce",
        "/rays/shadow",
        "/mrays_per_s",
        "/programs",
        "/error/relmse",
        "/error/ci95",
        "/invalid_samples",
        "/peak_rss_mib",
    ] {
        let value = stats
            .pointer(number)
            .unwrap_or_else(|| panic!("{number} is missing"));
        let absent_is_fine = !cfg!(target_os = "linux") && value.is_null();
        assert!(
            absent_is_fine || value.as_f64().is_some_and(|n| n >= 0.0),
            "{number}: {value}"
        );
    }
    assert_eq!(
        (&stats["scene"], &stats["device"], &stats["tier"]),
        (&json!("triangle"), &json!("cpu"), &json!("interpreted"))
    );
    assert_eq!(
        (&stats["width"], &stats["height"], &stats["spp"]),
        (&json!(16), &json!(12), &json!(4))
    );
    assert_eq!(
        (&stats["rays"]["camera"], &stats["invalid_samples"]),
        (&json!((16 * 12 + 4 * 3) * 4), &json!(0))
    );
    let effects = stats["effects"].as_array().unwrap();
    assert!(
        effects.contains(&json!("diffuse reflection")) && effects.contains(&json!("environment"))
    );
    let seconds = |name: &str| stats["seconds"][name].as_f64().unwrap();
    assert!(seconds("load") + seconds("bvh") + seconds("render") <= seconds("total"));
    let rate = stats["msamples_per_s"].as_f64().unwrap() * 1e6 * seconds("render");
    assert!((rate / 768.0 - 1.0).abs() < 1e-6, "{rate} samples");

    let one = good(render(
        &folder,
        &["triangle.obj", "--stats", "json", "--spp", "1"],
    ));
    assert_eq!(
        statistics(&one)["error"],
        Value::Null,
        "one sample says nothing about its error"
    );
    let text = good(render(&folder, &["triangle.obj", "--stats", "text"]));
    assert!(
        String::from_utf8(text.stdout)
            .unwrap()
            .contains("Msamples/s")
    );
}

#[test]
fn a_render_stops_at_its_limits() {
    let folder = workplace();
    let start = Instant::now();
    let timed = good(render(
        &folder,
        &["triangle.obj", "--time", "400ms", "--stats", "json"],
    ));
    let seconds = statistics(&timed)["seconds"]["render"].as_f64().unwrap();
    assert!(
        seconds >= 0.4 && start.elapsed() < Duration::from_secs(20),
        "{seconds} s"
    );
    assert!(statistics(&timed)["spp"].as_u64().unwrap() > 16);
    // Whichever comes first.
    let args = [
        "triangle.obj",
        "--time",
        "1000s",
        "--spp",
        "3",
        "--stats",
        "json",
    ];
    assert_eq!(statistics(&good(render(&folder, &args)))["spp"], 3);
}

/// Under the white sky that stands in for missing lights, nothing is white, and matte grey is grey.
#[test]
fn empty_scenes_and_single_triangles_render() {
    let folder = workplace();
    for scene in ["empty.gltf", "cameras.gltf"] {
        let message = stderr(&good(render(
            &folder,
            &[scene, "-o", "empty.exr", "-o", "empty.png"],
        )));
        assert!(message.contains("nothing to render"), "{message}");
        let (_, pixels) = read_exr(&folder.path().join("empty.exr")).unwrap();
        assert!(pixels.iter().all(|rgb| *rgb == [1.0; 3]));
        let image = image::open(folder.path().join("empty.png"))
            .unwrap()
            .to_rgb8();
        assert!(image.pixels().all(|pixel| pixel.0 == [255; 3]));
    }
    good(render(
        &folder,
        &[
            "triangle.obj",
            "-o",
            "triangle.exr",
            "--eye",
            "0,0,0.5",
            "--dir",
            "0,0,-1",
            "--spp",
            "64",
        ],
    ));
    let (width, pixels) = read_exr(&folder.path().join("triangle.exr")).unwrap();
    let centre = pixels[6 * width + 8];
    assert!(centre.iter().all(|c| (0.2..0.95).contains(c)), "{centre:?}");
}

/// `--env-strength 0` is darkness, not a missing light.
#[test]
fn a_black_sky_is_black() {
    let folder = workplace();
    let sky = folder.path().join("sky.png");
    image::RgbImage::from_pixel(4, 2, image::Rgb([200; 3]))
        .save(&sky)
        .unwrap();
    for (strength, bright) in [("0", false), ("1", true)] {
        let args = [
            "triangle.obj",
            "--env",
            "sky.png",
            "--env-strength",
            strength,
            "-o",
            "a.exr",
            "--stats",
            "json",
        ];
        let stats = statistics(&good(render(&folder, &args)));
        assert_eq!(stats["invalid_samples"], 0);
        let (_, pixels) = read_exr(&folder.path().join("a.exr")).unwrap();
        assert_eq!(pixels.iter().all(|rgb| *rgb == [0.0; 3]), !bright);
    }
}
