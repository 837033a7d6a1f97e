//! `bench`.

use serde_json::{Value, json};

use super::{good, run, workplace};

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
