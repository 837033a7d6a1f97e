//! Tracers and layers on the command line.

use exr::prelude::read_first_flat_layer_from_file;

use super::{fails, good, render, stderr, workplace};

#[test]
fn every_tracer_renders() {
    let folder = workplace();
    let mut pictures = Vec::new();
    for args in [
        &["--tracer", "path"][..],
        &["--tracer", "ao", "--reach", "0.5"],
        &["--tracer", "debug"],
        &["--tracer", "debug", "--view", "uv"],
        &["--tracer", "debug", "--view", "programs"],
        &["--tracer", "debug", "--view", "depth"],
        &["--tracer", "debug", "--view", "cost"],
    ] {
        let picture = [&["triangle.obj", "-o", "a.png"], args].concat();
        let output = good(render(&folder, &picture));
        // Only paths need light: the others are not told that there is none.
        let warned = stderr(&output).contains("no light");
        assert_eq!(warned, args.contains(&"path"), "{args:?}");
        pictures.push(image::open(folder.path().join("a.png")).unwrap().to_rgb8());
    }
    pictures.sort_by_key(|picture| picture.as_raw().clone());
    pictures.dedup();
    assert_eq!(pictures.len(), 7, "each shows something else");
}

#[test]
fn layers_are_in_the_exr() {
    let folder = workplace();
    let args = [
        "triangle.obj",
        "-o",
        "a.exr",
        "-o",
        "a.png",
        "--aov",
        "normal,depth,sample_count",
    ];
    good(render(&folder, &args));
    let image = read_first_flat_layer_from_file(folder.path().join("a.exr")).unwrap();
    let channels = &image.layer_data.channel_data.list;
    let names: Vec<_> = channels
        .iter()
        .map(|channel| channel.name.to_string())
        .collect();
    let expected = [
        "B",
        "G",
        "R",
        "depth.Z",
        "normal.X",
        "normal.Y",
        "normal.Z",
        "sample_count.X",
    ];
    assert_eq!(names, expected);
    let samples: Vec<_> = channels[7].sample_data.values_as_f32().collect();
    assert_eq!(samples, [2.0; 16 * 12]);
}

#[test]
fn layers_that_no_file_can_hold_are_refused() {
    let folder = workplace();
    let args = ["triangle.obj", "-o", "a.png", "--aov", "albedo,depth"];
    fails(&render(&folder, &args), &["albedo, depth", "-o image.exr"]);
    assert!(!folder.path().join("a.png").exists());
}

#[test]
fn unknown_layers_and_tracers_are_bad_usage() {
    let folder = workplace();
    for (args, texts) in [
        (
            &["--aov", "beauty"][..],
            &["beauty", "albedo", "position"][..],
        ),
        (&["--tracer", "photons"], &["light", "ao", "debug"]),
        (&["--tracer", "ao", "--reach", "-1"], &["--reach"]),
        (&["--tracer", "debug", "--view", "x"], &["normals", "cost"]),
    ] {
        let output = render(&folder, &[&["triangle.obj"], args].concat());
        assert_eq!(output.status.code(), Some(2), "{args:?}");
        let message = stderr(&output);
        assert!(texts.iter().all(|text| message.contains(text)), "{message}");
    }
}

/// Options of one tracer are not ignored by others.
#[test]
fn options_of_other_tracers_are_errors() {
    let folder = workplace();
    for (args, option) in [
        (
            &["--tracer", "bidirectional", "--mis", "balance"][..],
            "--mis",
        ),
        (&["--tracer", "ao", "--mis", "power"], "--mis"),
        (&["--view", "cost"], "--view"),
    ] {
        let output = render(&folder, &[&["triangle.obj"], args].concat());
        assert_eq!(output.status.code(), Some(1), "{args:?}");
        let message = stderr(&output);
        assert!(
            message.contains(&format!("{option}: it is for")),
            "{message}"
        );
    }
}
