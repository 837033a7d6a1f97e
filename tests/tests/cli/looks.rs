//! How pictures look without being told, and what can be asked for: light, brightness, where samples are spent.

use std::fs;

use super::{good, render, statistics, stderr, workplace};

/// A white triangle is neither lost in a white void nor in the dark.
#[test]
fn a_model_without_light_stands_in_a_studio() {
    let folder = workplace();
    let picture = |name: &str, args: &[&str]| {
        let args = [&["triangle.obj", "-o", name, "--spp", "64"], args].concat();
        let message = stderr(&good(render(&folder, &args)));
        let image = image::open(folder.path().join(name)).unwrap().to_rgb8();
        let corner = image.get_pixel(0, 0).0;
        let middle = image.get_pixel(image.width() / 2, image.height() / 2).0;
        (message, corner, middle)
    };
    let (message, wall, white) = picture("studio.png", &[]);
    assert!(message.contains("studio"), "{message}");
    assert!((60..190).contains(&wall[0]), "a grey wall: {wall:?}");
    assert!(white[0] > wall[0] + 30, "{white:?} before {wall:?}");
    let (message, wall, _) = picture("sky.png", &["--studio", "never"]);
    assert!(message.contains("white sky"), "{message}");
    assert_eq!(wall, [255; 3]);
    let (_, again, _) = picture("always.png", &["--studio", "always"]);
    assert!((60..190).contains(&again[0]), "{again:?}");
}

/// A lamp of hundreds of candela per square metre.
#[test]
fn pictures_are_exposed() {
    let folder = workplace();
    let text = "mtllib lamp.mtl\nusemtl lamp\nv -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n";
    fs::write(folder.path().join("lamp.obj"), text).unwrap();
    fs::write(
        folder.path().join("lamp.mtl"),
        "newmtl lamp\nKe 400 400 400\nKd 0 0 0\n",
    )
    .unwrap();
    let code = |args: &[&str]| {
        let view = [
            "lamp.obj", "-o", "lamp.png", "--eye", "0,0,5", "--dir", "0,0,-1",
        ];
        let message = stderr(&good(render(&folder, &[&view, args].concat())));
        let image = image::open(folder.path().join("lamp.png"))
            .unwrap()
            .to_rgb8();
        (
            image.get_pixel(image.width() / 2, image.height() / 2).0,
            message,
        )
    };
    // Middle grey is code 118.
    let (grey, message) = code(&[]);
    assert_eq!(grey, [118; 3]);
    assert!(message.contains("stops"), "{message}");
    let (white, message) = code(&["--exposure", "0"]);
    assert_eq!(white, [255; 3]);
    assert!(!message.contains("stops"), "{message}");
    assert_eq!(code(&["--exposure", "auto"]).0, [118; 3]);
    // 400 · 2⁻¹⁰ = 0.39: code 168.
    assert_eq!(code(&["--exposure", "-10"]).0, [168; 3]);
    for curve in ["neutral", "aces", "agx"] {
        let (shown, _) = code(&["--exposure", "-8", "--tonemap", curve]);
        assert!((180..255).contains(&shown[0]), "{curve}: {shown:?}");
    }
    let wrong = render(&folder, &["lamp.obj", "--exposure", "bright"]);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(stderr(&wrong).contains("stops"));
}

#[test]
fn samples_are_spent_where_the_noise_is() {
    let folder = workplace();
    let args = |more: &[&'static str]| {
        let scene = [
            "triangle.obj",
            "-o",
            "a.exr",
            "--size",
            "64x48",
            "--spp",
            "64",
            "--stats",
            "json",
        ];
        [&scene[..], more].concat()
    };
    let adaptive = args(&["--adaptive", "--aov", "sample_count"]);
    let once = statistics(&good(render(&folder, &adaptive)));
    let again = statistics(&good(render(&folder, &adaptive)));
    assert_eq!((&once["spp"], &once["mean"]), (&64.into(), &again["mean"]));
    let even = statistics(&good(render(&folder, &args(&[]))));
    let [a, b] = [&once, &even].map(|json| json["mean"][1].as_f64().unwrap());
    assert!(a != b && (a / b - 1.0).abs() < 0.02, "{a} {b}");
    // Where the error is what was asked for, samples follow it.
    let [until, evenly] = [
        &["--error", "50%"][..],
        &["--error=50%", "--adaptive=false"],
    ]
    .map(|more| statistics(&good(render(&folder, &args(more))))["sampling"].clone());
    assert_eq!([until, evenly], ["adaptive", "uniform"]);
}

#[test]
fn ambient_occlusion_comes_with_a_guarantee() {
    let folder = workplace();
    let scene = [
        "triangle.obj",
        "-o",
        "a.png",
        "--size",
        "96x96",
        "--stats",
        "json",
    ];
    let occlusion = good(render(&folder, &[&scene[..], &["--tracer", "ao"]].concat()));
    let json = statistics(&occlusion);
    let bound = json["guaranteed_mse"].as_f64().unwrap();
    assert!(bound > 0.0 && bound < 0.05, "{bound}");
    assert!(stderr(&occlusion).contains("guaranteed"));
    // Light has no bound.
    let paths = good(render(&folder, &scene));
    assert!(statistics(&paths)["guaranteed_mse"].is_null());
    assert!(!stderr(&paths).contains("guaranteed"));
}
