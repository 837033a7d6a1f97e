//! The command line as a process.

use std::fs;
use std::process::{Command, Output};

use serde_json::{Value, json};

/// Runs the command line in a folder of its own with `triangle.obj` in it.
fn run(args: &[&str]) -> Output {
    let folder = tempfile::tempdir().unwrap();
    let triangle = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n";
    fs::write(folder.path().join("triangle.obj"), triangle).unwrap();
    Command::new(env!("CARGO_BIN_EXE_residual-benches"))
        .current_dir(&folder)
        .args(args)
        .output()
        .unwrap()
}

/// Standard output of a command that ends well.
fn good(args: &[&str]) -> String {
    let output = run(args);
    assert!(
        output.status.success(),
        "{}: {}",
        output.status,
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn help_calls_it_what_users_call_it() {
    for (args, usage) in [
        (&["--help"][..], "cargo xtask bench <COMMAND>"),
        (
            &["traversal", "--help"],
            "cargo xtask bench traversal [OPTIONS]",
        ),
    ] {
        let help = good(args);
        assert!(help.contains(&format!("Usage: {usage}")), "{help}");
    }
}

#[test]
fn statuses_tell_bad_usage_from_failed_jobs() {
    let cases: [(&[&str], i32); 4] = [
        (&[], 2),
        (&["paint"], 2),
        (&["traversal", "--isa", "other"], 2),
        (&["render", "--scene", "missing.obj"], 1),
    ];
    for (args, status) in cases {
        let output = run(args);
        assert_eq!(output.status.code(), Some(status), "{args:?}");
        assert!(!output.stderr.is_empty(), "{args:?}");
    }
}

/// One row for each tier at least; a row more for each way of Embree, where it is installed.
#[test]
fn renders_are_measured() {
    // A lane count that no other test compiles the same scene for meanwhile.
    let args = "render --json --rounds 1 --size 16x16 --lanes 1 --scene triangle.obj";
    let args: Vec<_> = args.split(' ').collect();
    let text = good(&args);
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
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/cornell-box.gltf");
    let args = ["compile", "--json", "--rounds", "1", "--scene", scene];
    let text = good(&args);
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
