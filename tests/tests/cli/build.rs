//! `build`: the program of a single scene.

use std::env::consts::EXE_SUFFIX;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Output};

use residual_tests::pictures::{first_difference, read_exr};
use serde_json::json;

use super::{fails, good, run, statistics, stderr, workplace};

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/cornell-box.gltf");

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let name = |entry: fs::DirEntry| entry.file_name().into_string().unwrap();
    entries.map(|entry| name(entry.unwrap())).collect()
}

/// Runs a program in a folder, with nothing else around.
fn alone(program: &Path, folder: &Path, args: &[&str]) -> Output {
    let mut command = Command::new(program);
    command.current_dir(folder).env_clear().args(args);
    command.output().unwrap()
}

#[test]
fn a_program_renders_its_scene_as_the_command_line_does() {
    let folder = workplace();
    let args = ["build", SCENE, "--size", "64x48", "-o", "box"];
    good(run(&folder, &args));
    let program = folder.path().join("box");
    let empty = tempfile::tempdir().unwrap();
    let common = ["--spp", "4", "--threads", "1", "--stats", "json"];
    let outputs = ["-o", "a.png", "-o", "a.exr"];
    let render = |size| {
        let args = ["render", SCENE, "--tier", "interpreted", "--size", size];
        good(run(&folder, &[&args[..], &common, &outputs].concat()))
    };
    let exr = |folder: &Path| read_exr(&folder.join("a.exr")).unwrap();

    let own = good(alone(
        &program,
        empty.path(),
        &[&common[..], &outputs].concat(),
    ));
    let expected = render("64x48");
    assert_eq!(names(empty.path()).len(), 2);
    assert_eq!(
        first_difference(&exr(folder.path()).1, &exr(empty.path()).1),
        None
    );
    let png = |folder: &Path| fs::read(folder.join("a.png")).unwrap();
    assert!(png(folder.path()) == png(empty.path()));
    let (own, expected) = (statistics(&own), statistics(&expected));
    for same in ["scene", "width", "height", "programs", "effects", "rays"] {
        assert_eq!(own[same], expected[same], "{same}");
    }
    assert_eq!(own["tier"], json!("specialized"));

    // Another aspect than it was built for.
    let args = [&common[..], &outputs, &["--size", "40x60"]].concat();
    good(alone(&program, empty.path(), &args));
    render("40x60");
    let (own, expected) = (exr(empty.path()), exr(folder.path()));
    assert_eq!((own.0, expected.0), (40, 40));
    for (a, b) in own.1.iter().flatten().zip(expected.1.iter().flatten()) {
        assert!((a - b).abs() <= 1e-4 * a.abs().max(b.abs()), "{a} {b}");
    }

    // Without a name, the image has the scene's.
    good(alone(&program, empty.path(), &["--spp", "1", "--quiet"]));
    assert!(empty.path().join("cornell-box.png").exists());
    let usage = alone(&program, empty.path(), &["--size", "0x1"]);
    assert_eq!(usage.status.code(), Some(2));
}

/// Places are looked at before the compiler is called, which here is none.
#[test]
fn a_program_that_cannot_be_written_is_refused_before_it_is_compiled() {
    let folder = workplace();
    let target = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("place")).unwrap();
    let before = names(folder.path()).len();
    let refuse = |output: &str, texts: &[&str]| {
        let program = env!("CARGO_BIN_EXE_residual-tests");
        let mut command = Command::new(program);
        command.current_dir(&folder).env("CARGO", "no-such-cargo");
        command.env("CARGO_TARGET_DIR", target.path());
        command.args(["build", "triangle.obj", "-o", output]);
        let output = command.output().unwrap();
        fails(&output, texts);
        assert_eq!(names(folder.path()).len(), before);
        stderr(&output)
    };
    for (output, texts) in [
        ("nowhere/box", ["nowhere", "does not exist"]),
        ("place", ["place", "directory"]),
        ("triangle.obj/box", ["triangle.obj", "does not exist"]),
    ] {
        let message = refuse(output, &texts);
        assert!(!message.contains("no-such-cargo"), "{message}");
    }
    assert!(!target.path().join("residual").exists());
    // One that could be written is not, where compiling fails; nor is anything left for the compiler.
    refuse("box", &["no-such-cargo", "triangle"]);
    let left = names(&target.path().join("residual"));
    let is_data = |name: &String| name.contains("data") || name.starts_with(".tmp");
    assert!(!left.iter().any(is_data), "{left:?}");
}

#[test]
fn without_a_scene_it_says_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join(format!("empty{EXE_SUFFIX}"));
    let target = Path::new(env!("CARGO_BIN_EXE_residual-tests"));
    let target = target.ancestors().nth(2).unwrap();
    {
        // The command line builds programs of scenes in the same place.
        fs::create_dir_all(target.join("residual")).unwrap();
        let lock = File::create(target.join("residual/lock")).unwrap();
        lock.lock().unwrap();
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let mut command = Command::new(cargo);
        command.current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
        command.args(["build", "--release", "--offline", "--quiet"]);
        command.args(["-p", "residual-standalone", "--target-dir"]);
        good(command.arg(target).output().unwrap());
        let made = format!("release/residual-standalone{EXE_SUFFIX}");
        fs::copy(target.join(made), &program).unwrap();
    }
    fails(
        &alone(&program, folder.path(), &[]),
        &[
            "no scene is in this program",
            "cargo xtask build SCENE -o FILE",
        ],
    );
    assert_eq!(names(folder.path()).len(), 1);
}
