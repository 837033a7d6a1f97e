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
