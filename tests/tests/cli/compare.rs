//! `compare`: exit statuses for continuous integration, numbers, pictures.

use std::process::Output;

use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Image, WritableImage};
use serde_json::Value;
use tempfile::TempDir;

use super::{fails, good, render, run, statistics, stderr, workplace};

const SIZE: (usize, usize) = (40, 36);

/// Writes an EXR in which every pixel has these values of these channels, but one pixel of red.
fn write_exr(folder: &TempDir, name: &str, channels: &[(&str, f32)], odd: Option<(usize, f32)>) {
    let channels = channels.iter().map(|&(name, value)| {
        let mut values = vec![value; SIZE.0 * SIZE.1];
        if let (Some((index, value)), "R") = (odd, name) {
            values[index] = value;
        }
        AnyChannel::new(name, FlatSamples::F32(values))
    });
    let image = Image::from_channels(SIZE, AnyChannels::sort(channels.collect()));
    image.write().to_file(folder.path().join(name)).unwrap();
}

fn grey(folder: &TempDir, name: &str, value: f32) {
    write_exr(
        folder,
        name,
        &[("R", value), ("G", value), ("B", value)],
        None,
    );
}

fn noisy(folder: &TempDir, name: &str, value: f32, error: f32) {
    let radiance = [("R", value), ("G", value), ("B", value)];
    let errors = ["standard_error.R", "standard_error.G", "standard_error.B"];
    let errors = errors.map(|name| (name, error));
    write_exr(folder, name, &[radiance, errors].concat(), None);
}

fn compare(folder: &TempDir, args: &[&str]) -> Output {
    run(folder, &[&["compare"], args].concat())
}

/// The JSON object of a comparison of two files.
fn numbers(folder: &TempDir, args: &[&str]) -> Value {
    statistics(&good(compare(folder, &[args, &["--json"]].concat())))
}

/// Fails unless the images could not be compared, with status 2, and the message says all the texts.
fn refuses(output: &Output, texts: &[&str]) {
    let message = stderr(output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(output.stdout.is_empty());
    for text in texts {
        assert!(message.contains(text), "{message:?} does not say {text:?}");
    }
}

#[test]
fn metrics_of_plain_images_are_their_closed_forms() {
    let folder = workplace();
    grey(&folder, "a.exr", 0.5);
    grey(&folder, "b.exr", 0.75);
    let found = numbers(&folder, &["a.exr", "b.exr"]);
    let relmse = 0.0625 / (0.25 * 1.01);
    for (pointer, expected) in [
        ("/mae", 0.25),
        ("/mse/measured", 0.0625),
        ("/relmse/measured", relmse),
        ("/relmse_trimmed", relmse),
        ("/relmse_luminance", relmse),
        ("/worst_tile/relmse", relmse),
        ("/mape", f64::sqrt(relmse)),
        ("/smape", 0.4),
        ("/mean_ratios/1", 1.5),
    ] {
        let value = found.pointer(pointer).and_then(Value::as_f64).unwrap();
        assert!(
            (value - expected).abs() < 1e-9,
            "{pointer}: {value} {expected}"
        );
    }
    assert!(found["z"].is_null() && found["mse"]["without_noise"].is_null());
    assert!(found["flip"].as_f64() > Some(0.0) && found["hdr_flip"]["mean"].as_f64() > Some(0.0));
    let text = good(compare(&folder, &["a.exr", "b.exr"]));
    let text = String::from_utf8(text.stdout).unwrap();
    for part in ["40 × 36", "relMSE", "HDR-FLIP", "1.50000", "50.00 %"] {
        assert!(text.contains(part), "{text}");
    }
    let same = good(compare(&folder, &["a.exr", "a.exr", "--max-mse", "0"]));
    assert!(String::from_utf8(same.stdout).unwrap().contains("the same"));
}

#[test]
fn the_status_says_whether_a_limit_is_exceeded() {
    let folder = workplace();
    grey(&folder, "a.exr", 0.5);
    grey(&folder, "b.exr", 0.75);
    let found = numbers(&folder, &["a.exr", "b.exr"]);
    for (option, value, name) in [
        ("--max-mae", &found["mae"], "MAE"),
        ("--max-mse", &found["mse"]["measured"], "MSE"),
        ("--max-relmse", &found["relmse"]["measured"], "relMSE"),
        ("--max-mape", &found["mape"], "MAPE"),
        ("--max-flip", &found["flip"], "FLIP"),
        ("--max-hdr-flip", &found["hdr_flip"]["mean"], "HDR-FLIP"),
        (
            "--max-tile-relmse",
            &found["worst_tile"]["relmse"],
            "worst tile",
        ),
    ] {
        let value = value.as_f64().unwrap();
        let within = (1.001 * value).to_string();
        good(compare(&folder, &["a.exr", "b.exr", option, &within]));
        let below = format!("{:e}", 0.999 * value);
        let output = compare(&folder, &["a.exr", "b.exr", option, &below]);
        fails(&output, &[name, option, &below, "worst tile is"]);
        // The numbers are printed all the same.
        assert!(!output.stdout.is_empty());
        let output = compare(&folder, &["a.exr", "b.exr", "--json", option, &below]);
        assert_eq!(statistics(&output)["limits"][0]["exceeded"], true);
    }
    let both = ["a.exr", "b.exr", "--max-mae", "1", "--max-flip", "0"];
    fails(&compare(&folder, &both), &["FLIP"]);
    assert!(!stderr(&compare(&folder, &both)).contains("MAE"));
}

#[test]
fn the_worst_tile_is_named_and_crops_leave_it_out() {
    let folder = workplace();
    let radiance = [("R", 1.0), ("G", 1.0), ("B", 1.0)];
    write_exr(&folder, "a.exr", &radiance, None);
    write_exr(&folder, "b.exr", &radiance, Some((33 * SIZE.0 + 35, 9.0)));
    let output = compare(&folder, &["a.exr", "b.exr", "--max-tile-relmse", "1e-6"]);
    fails(&output, &["8 × 4 at 32,32"]);
    let left = ["a.exr", "b.exr", "--max-mse", "0", "--crop", "0,0,35,36"];
    good(compare(&folder, &left));
    let around = numbers(&folder, &["a.exr", "b.exr", "--crop", "35,33,1,1"]);
    assert_eq!(around["mse"]["measured"], 64.0 / 3.0);
    let outside = compare(&folder, &["a.exr", "b.exr", "--crop", "20,20,21,2"]);
    refuses(&outside, &["--crop 20,20,21,2", "40 × 36"]);
}

#[test]
fn images_that_cannot_be_compared_end_in_status_2_and_say_why() {
    let folder = workplace();
    grey(&folder, "a.exr", 0.5);
    let with_a = |test: &str| compare(&folder, &["a.exr", test]);
    refuses(&with_a("missing.exr"), &["missing.exr"]);
    refuses(
        &compare(&folder, &["missing.png", "a.exr"]),
        &["missing.png"],
    );
    refuses(&with_a("triangle.obj"), &["triangle.obj", "known format"]);
    good(render(&folder, &["triangle.obj", "-o", "other.exr"]));
    refuses(&with_a("other.exr"), &["40 × 36", "16 × 12"]);
    for bad in [f32::NAN, f32::INFINITY] {
        let radiance = [("R", 0.5), ("G", 0.5), ("B", 0.5)];
        write_exr(&folder, "bad.exr", &radiance, Some((2 * SIZE.0 + 7, bad)));
        let output = with_a("bad.exr");
        refuses(&output, &["test has pixels that are not finite: 1", "7,2"]);
        refuses(&compare(&folder, &["bad.exr", "a.exr"]), &["reference"]);
    }
    write_exr(&folder, "depth.exr", &[("depth.Z", 1.0)], None);
    refuses(&with_a("depth.exr"), &["depth.exr", "\"R\"", "depth.Z"]);
    // What is asked for of z needs noise, and names who lacks it.
    noisy(&folder, "noisy.exr", 0.5, 0.1);
    for asked in [["--z-map", "z.png"], ["--max-z-fraction", "1"]] {
        let args = [["noisy.exr", "a.exr"], asked].concat();
        refuses(&compare(&folder, &args), &["test", "standard_error.R"]);
    }
    let nowhere = ["a.exr", "a.exr", "--difference", "nowhere/d.png"];
    refuses(&compare(&folder, &nowhere), &["nowhere"]);
    let unknown = ["a.exr", "a.exr", "--flip-map", "f.jpg"];
    refuses(&compare(&folder, &unknown), &[".png or .exr"]);
}

#[test]
fn noise_is_told_from_a_difference() {
    let folder = workplace();
    noisy(&folder, "a.exr", 1.0, 0.03);
    noisy(&folder, "b.exr", 1.1, 0.04);
    let found = numbers(&folder, &["a.exr", "b.exr", "--max-z-fraction", "0"]);
    let close = |value: &Value, expected: f64| {
        let value = value.as_f64().unwrap();
        assert!((value / expected - 1.0).abs() < 1e-5, "{value} {expected}");
    };
    close(&found["mse"]["without_reference_noise"], 0.01 - 0.0009);
    close(&found["mse"]["without_noise"], 0.01 - 0.0025);
    close(&found["relmse"]["without_noise"], (0.01 - 0.0025) / 1.01);
    // Each number is two standard errors away.
    close(&found["z"]["mean_square"], 4.0);
    close(&found["z"]["blocks"]["largest"]["z"], 64.0);
    assert_eq!(found["z"]["scored"], 3 * SIZE.0 * SIZE.1);
    let text = good(compare(&folder, &["a.exr", "b.exr"])).stdout;
    let text = String::from_utf8(text).unwrap();
    assert!(
        text.contains("noise does not explain the difference at 0,0"),
        "{text}"
    );
    noisy(&folder, "far.exr", 1.5, 0.04);
    let far = ["a.exr", "far.exr", "--max-z-fraction", "1e-3"];
    fails(&compare(&folder, &far), &["--max-z-fraction"]);
}

#[test]
fn pictures_have_the_size_and_the_colours_of_the_difference() {
    let folder = workplace();
    noisy(&folder, "a.exr", 1.0, 0.03);
    noisy(&folder, "b.exr", 1.1, 0.04);
    let pictures = [
        ("--difference", "difference"),
        ("--absolute-difference", "absolute"),
        ("--flip-map", "flip"),
        ("--hdr-flip-map", "hdr"),
        ("--z-map", "z"),
    ];
    for extension in ["png", "exr"] {
        let names = pictures.map(|(_, name)| format!("{name}.{extension}"));
        let mut args = vec!["a.exr", "b.exr"];
        for ((option, _), name) in pictures.iter().zip(&names) {
            args.extend([*option, name.as_str()]);
        }
        let output = good(compare(&folder, &args));
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(
            names.iter().all(|name| text.contains(name.as_str())),
            "{text}"
        );
    }
    let codes = |name: &str| {
        let image = image::open(folder.path().join(name)).unwrap().to_rgb8();
        let (width, height) = image.dimensions();
        assert_eq!((width as usize, height as usize), SIZE);
        image.get_pixel(9, 9).0
    };
    // A tenth brighter is nearly all of the range, ±10 %: dark red. Two standard errors are half of it.
    assert_eq!(codes("difference.png"), [111, 9, 24]);
    assert_eq!(codes("z.png"), [214, 114, 88]);
    // A screen shows both as white; another exposure does not.
    assert_eq!(codes("flip.png"), [0, 0, 4]);
    for name in ["absolute.png", "hdr.png"] {
        assert_ne!(codes(name), [0, 0, 4], "{name}");
    }
    let path = folder.path().join("z.exr");
    let read = residual_tests::pictures::read_exr(&path);
    assert!(read.is_ok(), "{:?}", read.err());
    let (width, pixels) = read.unwrap();
    assert_eq!((width, pixels.len()), (SIZE.0, SIZE.0 * SIZE.1));
    assert!(pixels.as_flattened().iter().all(|z| (z - 2.0).abs() < 1e-5));
}

#[test]
fn images_for_a_screen_are_decoded_and_said_to_be_clipped() {
    let folder = workplace();
    let args = [
        "triangle.obj",
        "-o",
        "a.exr",
        "-o",
        "a.png",
        "--eye",
        "0,0,3",
        "--dir",
        "0,0,-1",
    ];
    good(render(&folder, &args));
    let both = compare(&folder, &["a.png", "a.png", "--max-mae", "0"]);
    assert!(stderr(&good(both)).contains("both images are encoded for a screen"));
    // Rounding to codes is all that is lost of what is not brighter than white.
    let mixed = compare(&folder, &["a.exr", "a.png", "--max-mae", "0.01", "--json"]);
    let mixed = good(mixed);
    assert!(stderr(&mixed).contains("one image is encoded for a screen"));
    assert!(statistics(&mixed)["hdr_flip"].is_null());
    for asked in [["--hdr-flip-map", "h.png"], ["--max-hdr-flip", "1"]] {
        let args = [["a.exr", "a.png"], asked].concat();
        refuses(&compare(&folder, &args), &["HDR-FLIP", ".exr"]);
    }
}
