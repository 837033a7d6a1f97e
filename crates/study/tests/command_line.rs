//! The command line as a process: a study of a tiny scene, stopped and taken up again.

use std::fs;
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

/// A folder with two triangles that share an edge, under the sky that scenes without lights get.
fn workplace() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let square = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3\nf 1 3 4\n";
    fs::write(folder.path().join("square.obj"), square).unwrap();
    folder
}

fn run(folder: &TempDir, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_residual-study"))
        .current_dir(folder)
        .args(args)
        .output()
        .unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A study without a compiler, of so many seeds, in `out`.
fn study(folder: &TempDir, seeds: &str) {
    let common = [
        "--quick",
        "--tier",
        "interpreted",
        "--size",
        "16x12",
        "--spp",
        "4",
    ];
    let args = [
        &[
            "square.obj",
            "-o",
            "out",
            "--reference",
            "8",
            "--seeds",
            seeds,
        ][..],
        &common,
    ];
    let output = run(folder, &args.concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.trim_end().ends_with("report.html"), "{text}");
}

fn read(folder: &TempDir, name: &str) -> String {
    fs::read_to_string(folder.path().join("out").join(name)).unwrap()
}

#[test]
fn a_study_makes_a_report_and_goes_on_where_it_was() {
    let folder = workplace();
    study(&folder, "3");
    let report = read(&folder, "report.html");
    assert!(report.starts_with("<!DOCTYPE html>") && report.trim_end().ends_with("</html>"));
    assert!(!report.contains("{{"), "a placeholder is left");
    for text in [
        "prefers-color-scheme:dark",
        "data:image/png;base64,",
        "depth-2",
        "Not measured",
    ] {
        assert!(report.contains(text), "{text}");
    }
    // Nothing is fetched from elsewhere, and nothing runs.
    for text in ["<script", "http://", "https://", "url("] {
        assert!(!report.contains(text), "{text}");
    }
    assert!(report.len() < 400_000, "{} bytes", report.len());
    for name in [
        "error-against-time.svg",
        "pareto-front.svg",
        "truth-ladder.svg",
    ] {
        let figure = read(&folder, name);
        assert!(
            figure.starts_with("<svg") && figure.ends_with("</svg>\n"),
            "{name}"
        );
        assert!(!figure.contains("NaN") && !figure.contains("inf"), "{name}");
    }
    let configurations = read(&folder, "configurations.csv");
    let fields = |line: &str| line.split(',').count();
    let head = configurations.lines().next().unwrap();
    assert!(configurations.lines().count() > 8);
    // Names of the first rows have no commas.
    let independent = configurations
        .lines()
        .find(|line| line.starts_with("independent"));
    assert_eq!(fields(independent.unwrap()), fields(head));
    // Three seeds, after 1, 2 and 4 samples.
    let measurements = read(&folder, "measurements.csv");
    let of_default = measurements
        .lines()
        .filter(|line| line.starts_with("default,"));
    assert_eq!(of_default.count(), 9);

    // The same again measures nothing, and says the same.
    let journal = read(&folder, "journal.jsonl");
    study(&folder, "3");
    assert_eq!(read(&folder, "journal.jsonl"), journal);
    assert_eq!(read(&folder, "report.html"), report);
    // Of four seeds one is new.
    study(&folder, "4");
    let longer = read(&folder, "journal.jsonl");
    let new = longer
        .strip_prefix(&journal)
        .expect("a journal is only added to");
    let runs = new.lines().filter_map(|line| {
        let line: Value = serde_json::from_str(line).unwrap();
        let name = line["entry"].as_str().unwrap().to_owned();
        name.starts_with("run ").then_some(name)
    });
    let runs: Vec<_> = runs.collect();
    assert!(
        !runs.is_empty() && runs.iter().all(|name| name.ends_with(" 4")),
        "{runs:?}"
    );
    // A lost image is rendered again.
    fs::remove_file(folder.path().join("out/images/default-2.exr")).unwrap();
    study(&folder, "4");
    assert!(read(&folder, "journal.jsonl")[longer.len()..].contains("\"run default 2\""));
}

#[test]
fn what_cannot_be_read_or_written_is_named() {
    let folder = workplace();
    let cases: [(&[&str], &[&str]); 3] = [
        (&["missing.gltf"], &["missing.gltf"]),
        (
            &["square.obj", "-o", "square.obj", "--quick"],
            &["square.obj", "folder"],
        ),
        (
            &["square.obj", "--camera", "left", "--quick"],
            &["square.obj", "left"],
        ),
    ];
    for (args, texts) in cases {
        let output = run(&folder, args);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{message}");
        for text in texts {
            assert!(
                message.contains("error: ") && message.contains(text),
                "{message}"
            );
        }
    }
    let output = run(&folder, &["square.obj", "--spp", "3"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("power of two"));
    let help = run(&folder, &["--help"]);
    assert!(
        String::from_utf8_lossy(&help.stdout).contains("cargo xtask accuracy [OPTIONS] <SCENE>")
    );
}
