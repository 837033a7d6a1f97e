//! The command line as a process: exit statuses, messages, files, statistics.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use residual_tests::pictures::{first_difference, read_exr};
use serde_json::{Value, json};
use tempfile::TempDir;

const TRIANGLE: &str = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n";

/// A folder to work in, with `triangle.obj`, `cameras.gltf` (two cameras, no mesh) and `empty.gltf`.
fn workplace() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("triangle.obj"), TRIANGLE).unwrap();
    let lens = json!({ "type": "perspective", "perspective": { "yfov": 0.8, "znear": 0.1 } });
    let cameras = json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0, 1] }],
        "nodes": [{ "name": "left", "camera": 0 }, { "name": "right", "camera": 1 }],
        "cameras": [lens, lens],
    });
    fs::write(folder.path().join("cameras.gltf"), cameras.to_string()).unwrap();
    fs::write(
        folder.path().join("empty.gltf"),
        r#"{ "asset": { "version": "2.0" } }"#,
    )
    .unwrap();
    folder
}

/// Runs the command line in a folder.
fn run(folder: &TempDir, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_residual-tests"))
        .current_dir(folder)
        .args(args)
        .output()
        .unwrap()
}

/// Renders quickly: `--tier interpreted`, 16 × 12 pixels, 2 samples, unless `args` say otherwise.
fn render(folder: &TempDir, args: &[&str]) -> Output {
    let mut all = vec!["render", "--tier", "interpreted", "--threads", "1"];
    for (name, value) in [("--size", "16x12"), ("--spp", "2")] {
        let timed = name == "--spp" && args.contains(&"--time");
        if !timed && !args.contains(&name) {
            all.extend([name, value]);
        }
    }
    all.extend(args);
    run(folder, &all)
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Fails unless the command ended well.
fn good(output: Output) -> Output {
    assert!(
        output.status.success(),
        "{}: {}",
        output.status,
        stderr(&output)
    );
    output
}

/// Fails unless the command failed with status 1 and says all the texts.
fn fails(output: &Output, texts: &[&str]) {
    let message = stderr(output);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("error: "), "{message}");
    for text in texts {
        assert!(message.contains(text), "{message:?} does not say {text:?}");
    }
}

#[test]
fn bad_usage_ends_in_status_2() {
    let folder = workplace();
    let cases: &[&[&str]] = &[
        &[],
        &["paint"],
        &["render"],
        &["render", "triangle.obj", "--bogus"],
        &["render", "triangle.obj", "--spp", "0"],
        &["render", "triangle.obj", "--spp", "many"],
        &["render", "triangle.obj", "--size", "0x10"],
        &["render", "triangle.obj", "--size", "640"],
        &["render", "triangle.obj", "--fov", "180"],
        &["render", "triangle.obj", "--eye", "1,2"],
        &["render", "triangle.obj", "--dir", "nan,0,1"],
        &["render", "triangle.obj", "--time", "-3s"],
        &["render", "triangle.obj", "--lanes", "3"],
        &["render", "triangle.obj", "--max-depth", "0"],
        &["render", "triangle.obj", "--camera", "0", "--fov", "40"],
        &["render", "triangle.obj", "--env-strength", "2"],
        &["render", "triangle.obj", "--tier", "fastest"],
        &["inspect"],
        &["emit", "triangle.obj"],
    ];
    for args in cases {
        let output = run(&folder, args);
        assert_eq!(
            output.status.code(),
            Some(2),
            "{args:?}: {}",
            stderr(&output)
        );
        assert!(!stderr(&output).is_empty(), "{args:?}");
    }
    assert!(!folder.path().join("triangle.png").exists());
}

#[test]
fn failed_jobs_end_in_status_1_and_say_why() {
    let folder = workplace();
    fails(
        &render(&folder, &["missing.glb"]),
        &["missing.glb", "exists"],
    );
    fs::write(folder.path().join("scene.fbx"), "x").unwrap();
    fails(
        &render(&folder, &["scene.fbx"]),
        &["scene.fbx", ".gltf, .glb or .obj"],
    );
    fs::write(folder.path().join("broken.gltf"), "{").unwrap();
    fails(&render(&folder, &["broken.gltf"]), &["broken.gltf"]);
    fails(
        &render(&folder, &["cameras.gltf", "--camera", "middle"]),
        &["cameras.gltf", "\"middle\"", "\"left\"", "\"right\""],
    );
    fails(
        &render(&folder, &["cameras.gltf", "--camera", "2"]),
        &["\"2\"", "\"left\""],
    );
    fails(
        &render(&folder, &["triangle.obj", "--camera", "0"]),
        &["no cameras"],
    );
    fails(
        &render(&folder, &["triangle.obj", "--env", "missing.hdr"]),
        &["missing.hdr"],
    );
    fails(&run(&folder, &["inspect", "missing.glb"]), &["missing.glb"]);
    for camera in ["right", "1"] {
        good(render(&folder, &["cameras.gltf", "--camera", camera]));
    }
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

/// The last line of standard output as JSON.
fn statistics(output: &Output) -> Value {
    let text = String::from_utf8(output.stdout.clone()).unwrap();
    serde_json::from_str(text.lines().last().expect("a line")).expect("JSON")
}

#[test]
fn statistics_have_what_the_design_promises() {
    let folder = workplace();
    let output = good(render(
        &folder,
        &["triangle.obj", "--quiet", "--stats", "json", "--spp", "3"],
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
        (&json!(16), &json!(12), &json!(3))
    );
    assert_eq!(
        (&stats["rays"]["camera"], &stats["invalid_samples"]),
        (&json!(16 * 12 * 3), &json!(0))
    );
    let effects = stats["effects"].as_array().unwrap();
    assert!(
        effects.contains(&json!("diffuse reflection")) && effects.contains(&json!("environment"))
    );
    let seconds = |name: &str| stats["seconds"][name].as_f64().unwrap();
    assert!(seconds("load") + seconds("bvh") + seconds("render") <= seconds("total"));
    let rate = stats["msamples_per_s"].as_f64().unwrap() * 1e6 * seconds("render");
    assert!((rate / 576.0 - 1.0).abs() < 1e-6, "{rate} samples");

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

#[test]
fn quiet_is_quiet() {
    let folder = workplace();
    let output = good(render(&folder, &["cameras.gltf", "--quiet"]));
    assert!(output.stdout.is_empty());
    assert!(
        stderr(&output)
            .lines()
            .all(|line| line.starts_with("warning: ")),
        "{}",
        stderr(&output)
    );
}

#[test]
fn what_the_scene_lacks_is_said() {
    let folder = workplace();
    let message = stderr(&good(render(&folder, &["triangle.obj"])));
    assert!(
        message.contains("no camera") && message.contains("no light"),
        "{message}"
    );
    let strict = render(&folder, &["missing.glb", "--strict"]);
    fails(&strict, &["missing.glb"]);
    let view = stderr(&good(render(
        &folder,
        &["cameras.gltf", "--eye", "0,0,3", "--dir", "0,0,-1"],
    )));
    assert!(!view.contains("no camera"), "{view}");
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

#[test]
fn inspect_speaks_json() {
    let folder = workplace();
    let report = statistics(&good(run(&folder, &["inspect", "triangle.obj", "--json"])));
    assert_eq!(
        (&report["scene"], &report["triangles"]),
        (&json!("triangle"), &json!(1))
    );
    assert_eq!(report["effects"]["environment"]["in"], true);
    assert_eq!(report["effects"]["spot lights"]["in"], false);
    let reasons = report["effects"]["diffuse reflection"]["called_for_by"]
        .as_array()
        .unwrap();
    assert_eq!(reasons.len(), 1, "{reasons:?}");
    assert_eq!(report["programs"].as_array().unwrap().len(), 1);
    let text = String::from_utf8(good(run(&folder, &["inspect", "triangle.obj"])).stdout).unwrap();
    assert!(
        text.contains("effects in:") && text.contains("effects out:"),
        "{text}"
    );
}

#[test]
fn emission_is_deterministic_and_the_same_everywhere() {
    let folder = workplace();
    fs::copy(
        folder.path().join("triangle.obj"),
        folder.path().join("house.v2.obj"),
    )
    .unwrap();
    for (scene, file) in [
        ("triangle.obj", "out/triangle.rs"),
        ("house.v2.obj", "out/house.v2.rs"),
    ] {
        let emit = |more: &[&str]| {
            good(run(
                &folder,
                &[&["emit", scene, "--target", "rust"], more].concat(),
            ))
            .stdout
        };
        let text = emit(&[]);
        assert!(text.starts_with(b"// Renderer for the scene"));
        assert_eq!(text, emit(&[]));
        emit(&["-o", "out"]);
        assert_eq!(text, fs::read(folder.path().join(file)).unwrap());
        assert_ne!(text, emit(&["--lanes", "1"]));
    }
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

/// Compiles a renderer, by way of a target directory given relative to where the command is run.
#[cfg(unix)]
#[test]
fn specialised_renderers_are_compiled_from_any_folder() {
    let folder = workplace();
    let target = Path::new(env!("CARGO_BIN_EXE_residual-tests"))
        .ancestors()
        .nth(2)
        .unwrap();
    std::os::unix::fs::symlink(target, folder.path().join("built")).unwrap();
    let render = |tier: &str| {
        let output = Command::new(env!("CARGO_BIN_EXE_residual-tests"))
            .current_dir(&folder)
            .env("CARGO_TARGET_DIR", "built")
            .args([
                "render",
                "triangle.obj",
                "--size",
                "16x12",
                "--spp",
                "2",
                "--stats",
                "json",
            ])
            .args(["--tier", tier, "-o", &format!("{tier}.exr")])
            .output()
            .unwrap();
        let stats = statistics(&good(output));
        assert_eq!(stats["tier"], tier);
        let compile = stats["seconds"]["compile"].as_f64().unwrap();
        assert_eq!(compile > 0.0, tier == "specialized");
        read_exr(&folder.path().join(format!("{tier}.exr")))
            .unwrap()
            .1
    };
    assert_eq!(
        first_difference(&render("interpreted"), &render("specialized")),
        None
    );
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

/// Without a compiler the image is made all the same, and it is said why it was interpreted; a compiled renderer that
/// was asked for outright is not replaced by another.
#[test]
fn a_missing_compiler_is_reported() {
    let folder = workplace();
    let render = |tier: &str| {
        Command::new(env!("CARGO_BIN_EXE_residual-tests"))
            .current_dir(&folder)
            .env("CARGO", "no-such-cargo")
            .args(["render", "triangle.obj", "--size", "64x48", "--time", "2s"])
            .args(["--tier", tier])
            .output()
            .unwrap()
    };
    let auto = render("auto");
    let messages = String::from_utf8_lossy(&auto.stderr);
    assert_eq!(auto.status.code(), Some(0), "{messages}");
    assert!(messages.contains("could not be compiled"), "{messages}");
    assert!(messages.contains("no-such-cargo"), "{messages}");
    assert!(folder.path().join("triangle.png").exists());

    let specialized = render("specialized");
    assert_eq!(specialized.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&specialized.stderr).contains("no-such-cargo"));
}

/// One row for each tier at least; a row more for each way of Embree, where it is installed.
#[test]
fn renders_are_measured() {
    let folder = workplace();
    // A lane count that no other test compiles the same scene for meanwhile.
    let args = "bench render --json --rounds 1 --size 16x16 --lanes 1 --scene triangle.obj";
    let args: Vec<_> = args.split(' ').collect();
    let text = String::from_utf8(good(run(&folder, &args)).stdout).unwrap();
    let rows: Vec<Value> = text
        .lines()
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect();
    for row in &rows {
        assert_eq!(
            (&row["scene"], &row["device"]),
            (&json!("triangle"), &json!("cpu"))
        );
        assert!(row["traversal"].is_string(), "{row}");
        assert_eq!(row["lanes"], 1);
        for number in ["msamples_per_s", "msamples_per_cpu_s", "time_to_error_s"] {
            let value = row[number].as_f64();
            assert!(value.is_some_and(|n| n > 0.0), "{number}: {row}");
        }
    }
    for tier in ["specialized", "interpreted"] {
        let ours = |row: &&Value| row["traversal"] == "residual" && row["tier"] == tier;
        assert_eq!(rows.iter().filter(ours).count(), 1, "{tier}: {rows:?}");
    }
}

/// A row for each device and binding, and one for each part of our code.
#[test]
fn compiling_and_code_are_measured() {
    let folder = workplace();
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/cornell-box.gltf");
    let args = [
        "bench", "compile", "--json", "--rounds", "1", "--scene", scene,
    ];
    let text = String::from_utf8(good(run(&folder, &args)).stdout).unwrap();
    let rows: Vec<Value> = text
        .lines()
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect();
    let (scenes, parts): (Vec<_>, Vec<_>) = rows.iter().partition(|row| !row["scene"].is_null());
    for binding in ["structure", "constants"] {
        for (device, has_library) in [("cpu", true), ("wgpu", false)] {
            let mut rows = scenes
                .iter()
                .filter(|row| row["device"] == device && row["binding"] == binding);
            let (row, more) = (rows.next().expect("a row"), rows.next());
            assert_eq!((more, &row["scene"]), (None, &json!("cornell-box")));
            let positive = |value: &Value| value.as_f64().is_some_and(|number| number > 0.0);
            for stage in ["plan", "emit", "compile"] {
                assert!(positive(&row["seconds"][stage]), "{stage}: {row}");
            }
            assert!(
                positive(&row["programs"]) && positive(&row["lines"]),
                "{row}"
            );
            assert_eq!(positive(&row["seconds"]["cached"]), has_library, "{row}");
            assert_eq!(positive(&row["library_kib"]), has_library, "{row}");
        }
    }
    assert_eq!(scenes.len(), 4);
    for row in &parts {
        assert!(row["part"].is_string() && row["lines"].is_u64(), "{row}");
        assert!(row["halstead_effort"].is_f64(), "{row}");
    }
    assert!(parts.iter().any(|row| row["part"] == "core"), "{parts:?}");
}

/// Ctrl-C. That a process listens for it is written in `/proc`.
#[cfg(target_os = "linux")]
mod interrupt {
    use std::io::{BufRead as _, BufReader};
    use std::process::{Child, ExitStatus, Stdio};

    use super::*;

    /// Asks again and again until there is an answer.
    fn wait_for<T>(child: &mut Child, mut ask: impl FnMut(&mut Child) -> Option<T>) -> T {
        let start = Instant::now();
        while start.elapsed() < Duration::from_secs(120) {
            if let Some(answer) = ask(child) {
                return answer;
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        child.kill().unwrap();
        panic!("waited for too long");
    }

    fn end(child: &mut Child) -> ExitStatus {
        wait_for(child, |child| child.try_wait().unwrap())
    }

    /// Begins to render what would take for days, and waits until Ctrl-C is listened for.
    fn begin(folder: &TempDir, scene: &str, size: &str) -> Child {
        let mut child = Command::new(env!("CARGO_BIN_EXE_residual-tests"))
            .current_dir(folder)
            .args(["render", scene, "--tier", "interpreted"])
            .args(["--threads", "1", "--size", size, "--spp", "1000000000"])
            .args(["--stats", "json", "-o", "a.exr", "-o", "a.png"])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        wait_for(&mut child, |child| {
            assert_eq!(child.try_wait().unwrap(), None, "it ended by itself");
            let status = fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap();
            let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
            let caught = u64::from_str_radix(caught?.trim(), 16).unwrap();
            // Signal number 2.
            (caught & 1 << (2 - 1) != 0).then_some(())
        });
        child
    }

    fn interrupt(child: &Child) {
        let kill = format!("kill -INT {}", child.id());
        let status = Command::new("sh").args(["-c", &kill]).status().unwrap();
        assert!(status.success());
    }

    #[test]
    fn the_image_is_what_there_is_by_then() {
        let folder = workplace();
        let mut child = begin(&folder, "triangle.obj", "64x48");
        interrupt(&child);
        end(&mut child);
        let output = good(child.wait_with_output().unwrap());
        assert!(stderr(&output).contains("stopped"), "{}", stderr(&output));
        let samples = statistics(&output)["spp"].as_u64().unwrap();
        assert!((1..1_000_000_000).contains(&samples));
        let image = image::open(folder.path().join("a.png")).unwrap();
        assert_eq!(image.to_rgb8().dimensions(), (64, 48));
        let (_, stopped) = read_exr(&folder.path().join("a.exr")).unwrap();

        // As if no more had been asked for.
        let spp = samples.to_string();
        let args = [
            "triangle.obj",
            "--size",
            "64x48",
            "-o",
            "b.exr",
            "--spp",
            &spp,
        ];
        good(render(&folder, &args));
        let (_, expected) = read_exr(&folder.path().join("b.exr")).unwrap();
        assert_eq!(first_difference(&expected, &stopped), None);
    }

    #[test]
    fn the_second_ends_the_program_at_once() {
        let folder = workplace();
        let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/textured.gltf");
        // A pass takes seconds.
        let mut child = begin(&folder, scene, "2048x2048");
        interrupt(&child);
        let mut messages = BufReader::new(child.stderr.take().unwrap()).lines();
        assert!(messages.any(|line| line.unwrap().contains("stopping after this pass")));
        interrupt(&child);
        assert_eq!(end(&mut child).code(), Some(130));
        for name in ["a.exr", "a.png"] {
            assert!(!folder.path().join(name).exists(), "{name}");
        }
    }
}
