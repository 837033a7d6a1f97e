//! Image files.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use residual_tests::pictures::read_exr;

use super::{TRIANGLE, fails, good, render, stderr, workplace};

/// As in `… 2>&1 | head -1`.
#[test]
fn an_image_is_not_lost_with_the_reader_of_messages() {
    let folder = workplace();
    let mut child = Command::new(env!("CARGO_BIN_EXE_residual-tests"))
        .current_dir(&folder)
        .args([
            "render",
            "triangle.obj",
            "--tier",
            "interpreted",
            "--size",
            "16x12",
            "--spp",
            "2",
        ])
        .args(["--stats", "json", "--output", "image.png"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop((child.stdout.take(), child.stderr.take()));
    let status = child.wait().unwrap();
    assert!(status.success(), "{status}");
    assert!(folder.path().join("image.png").exists());
}

/// Had rendering begun, the good file, which comes first, would be there.
#[test]
fn outputs_that_cannot_be_written_are_refused_before_rendering() {
    let folder = workplace();
    fs::create_dir(folder.path().join("folder.png")).unwrap();
    let refuse = |output: &str, texts: &[&str]| {
        let args = ["triangle.obj", "-o", "good.png", "-o", output];
        fails(&render(&folder, &args), texts);
        assert!(!folder.path().join("good.png").exists());
    };
    refuse("nowhere/a.png", &["nowhere", "does not exist"]);
    refuse("a.jpg", &["a.jpg", ".png or .exr"]);
    refuse("a", &[".png or .exr"]);
    refuse("folder.png", &["folder.png", "directory"]);
    refuse("triangle.obj/a.png", &["triangle.obj"]);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let closed = folder.path().join("closed");
        fs::create_dir(&closed).unwrap();
        fs::set_permissions(&closed, fs::Permissions::from_mode(0o555)).unwrap();
        if fs::write(closed.join("probe"), "").is_ok() {
            println!("skipped: permissions do not bind this user");
        } else {
            refuse("closed/a.png", &["closed"]);
        }
        fs::set_permissions(&closed, fs::Permissions::from_mode(0o755)).unwrap();
    }
}

#[test]
fn a_failed_job_leaves_an_existing_file_alone() {
    let folder = workplace();
    let kept = folder.path().join("kept.png");
    fs::write(&kept, "precious").unwrap();
    fails(&render(&folder, &["missing.glb", "-o", "kept.png"]), &[]);
    fails(
        &render(
            &folder,
            &["triangle.obj", "-o", "kept.png", "-o", "kept.jpg"],
        ),
        &[],
    );
    assert_eq!(fs::read_to_string(&kept).unwrap(), "precious");
    good(render(&folder, &["triangle.obj", "-o", "kept.png"]));
    assert_eq!(image::open(&kept).unwrap().to_rgb8().dimensions(), (16, 12));
    // Nothing temporary is left beside it.
    let names: Vec<_> = fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    assert_eq!(names.len(), 4, "{names:?}");
}

#[test]
fn the_image_is_named_after_the_scene() {
    let folder = workplace();
    fs::write(folder.path().join("house.v2.obj"), TRIANGLE).unwrap();
    for (scene, image) in [
        ("triangle.obj", "triangle.png"),
        ("house.v2.obj", "house.v2.png"),
    ] {
        let output = good(render(&folder, &[scene]));
        assert!(folder.path().join(image).exists(), "{}", stderr(&output));
        assert!(stderr(&output).contains(image), "{}", stderr(&output));
    }
}

/// Every format shows the same picture; extensions are read in either case.
#[test]
fn pngs_and_exrs_agree() {
    let folder = workplace();
    good(render(
        &folder,
        &["triangle.obj", "-o", "a.exr", "-o", "a.PNG", "--spp", "16"],
    ));
    let (width, pixels) = read_exr(&folder.path().join("a.exr")).unwrap();
    let image = image::ImageReader::open(Path::new(folder.path()).join("a.PNG")).unwrap();
    let image = image
        .with_guessed_format()
        .unwrap()
        .decode()
        .unwrap()
        .to_rgb8();
    for (x, y, pixel) in image.enumerate_pixels() {
        let linear = f64::from(pixels[y as usize * width + x as usize][1]).clamp(0.0, 1.0);
        let encoded = if linear <= 0.0031308 {
            12.92 * linear
        } else {
            1.055 * linear.powf(1.0 / 2.4) - 0.055
        };
        assert!((encoded * 255.0 - f64::from(pixel.0[1])).abs() <= 0.501);
    }
}
