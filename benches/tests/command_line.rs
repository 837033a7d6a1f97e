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

/// What `bench error` says of a small image of the triangle, with this program as Python.
#[cfg(unix)]
fn error_with_python(python: &str) -> Output {
    run(&[
        "error",
        "--scene=triangle.obj",
        "--json",
        "--tier=interpreted",
        "--size=8x8",
        "--spp=1,4",
        "--runs=3",
        &format!("--python={python}"),
    ])
}

/// A program in the place of Python.
#[cfg(unix)]
fn fake_python(folder: &tempfile::TempDir, script: &str) -> String {
    use std::os::unix::fs::PermissionsExt;
    let path = folder.path().join("python");
    fs::write(&path, format!("#!/bin/sh\n{script}")).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    path.to_string_lossy().into_owned()
}

#[cfg(unix)]
fn lines(output: &Output) -> (Vec<Value>, String) {
    let rows = String::from_utf8_lossy(&output.stdout);
    let rows = rows
        .lines()
        .map(|row| serde_json::from_str(row).unwrap())
        .collect();
    (rows, String::from_utf8_lossy(&output.stderr).into_owned())
}

#[cfg(unix)]
#[test]
fn without_the_peer_there_are_our_own_rows() {
    let folder = tempfile::tempdir().unwrap();
    let without_mitsuba = fake_python(
        &folder,
        r#"echo '{"missing": "No module named x"}'; exit 1"#,
    );
    for (python, reason) in [
        ("no-such-python", "there is no no-such-python"),
        (&without_mitsuba, "No module named x"),
    ] {
        let output = error_with_python(python);
        let (rows, messages) = lines(&output);
        assert!(output.status.success(), "{messages}");
        let expected = format!("without Mitsuba: {reason}\n");
        assert!(messages.contains(&expected), "{messages}");
        let who = |row: &Value| json!([row["renderer"], row["sampler"], row["spp"]]);
        assert_eq!(
            rows.iter().map(who).collect::<Vec<_>>(),
            [
                json!(["Residual", "sobol", 1]),
                json!(["Residual", "sobol", 4]),
                json!(["Residual", "independent", 1]),
                json!(["Residual", "independent", 4]),
            ]
        );
        for row in &rows {
            assert!(row["relmse"].as_f64().unwrap() > 0.0, "{row}");
            assert!(row["cpu_s"].as_f64().unwrap() > 0.0, "{row}");
            assert!(row["of_best_peer"].is_null(), "{row}");
        }
    }
}

/// It greets, and answers each request by a black image of 8 × 8 pixels.
#[cfg(unix)]
const BLACK_PEER: &str = r#"
echo 'a library says hello'
echo '{"renderer": "Black", "version": "1", "variant": "v", "samplers": ["a", "b"]}'
while read -r request; do
    image=$(printf '%s' "$request" | sed 's/.*"image":"\([^"]*\)".*/\1/')
    head -c 768 /dev/zero > "$image"
    echo '{"samples": 4, "cpu_s": 0.5}'
done
"#;

#[cfg(unix)]
#[test]
fn a_peer_that_renders_another_scene_is_a_failure() {
    let folder = tempfile::tempdir().unwrap();
    let output = error_with_python(&fake_python(&folder, BLACK_PEER));
    let (rows, messages) = lines(&output);
    assert_eq!(output.status.code(), Some(1), "{messages}");
    assert!(
        messages.contains("the converged means differ by 100.0 %"),
        "{messages}"
    );
    let of_peer: Vec<_> = rows
        .iter()
        .filter(|row| row["renderer"] == "Black")
        .collect();
    assert_eq!(of_peer.len(), 4);
    for row in of_peer {
        assert_eq!((&row["cpu_s"], &row["spp"]), (&json!(0.5), &json!(4)));
        assert_eq!(row["runs"], 3);
    }
    let means = rows.last().unwrap();
    assert_eq!(means["kind"], "means");
    assert_eq!(means["ratios"], json!([0.0, 0.0, 0.0]));
}

#[cfg(unix)]
#[test]
fn a_peer_that_fails_fails_the_job() {
    let greeting = r#"echo '{"renderer": "P", "version": "1", "variant": "v", "samplers": ["a"]}'"#;
    for (answers, expected) in [
        (
            "read -r request; exit 3",
            "P ended without an answer: exit status: 3",
        ),
        (
            r#"read -r request; echo '{"error": "no such thing"}'; read -r request"#,
            "no such thing",
        ),
        (
            r#"read -r request; echo '{"samples": 4, "cpu_s": 1}'; read -r request"#,
            "reading its image",
        ),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let script = format!("{greeting}\n{answers}\n");
        let output = error_with_python(&fake_python(&folder, &script));
        let (_, messages) = lines(&output);
        assert_eq!(output.status.code(), Some(1), "{messages}");
        assert!(messages.contains(expected), "{messages}");
    }
}

#[cfg(unix)]
#[test]
fn scenes_with_other_materials_are_measured_without_the_peer() {
    let textured = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/textured.gltf");
    let output = run(&[
        "error",
        &format!("--scene={textured}"),
        "--json",
        "--tier=interpreted",
        "--sampler=independent",
        "--size=8x8",
        "--spp=1",
        "--runs=3",
    ]);
    let (rows, messages) = lines(&output);
    assert!(output.status.success(), "{messages}");
    assert_eq!(rows.len(), 1);
    assert!(messages.contains("without Mitsuba: material"), "{messages}");
}
