//! Ctrl-C. That a process listens for it is written in `/proc`.

use std::fs;
use std::io::{BufRead as _, BufReader};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use residual_tests::pictures::{first_difference, read_exr};
use tempfile::TempDir;

use super::{good, render, statistics, stderr, workplace};

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
