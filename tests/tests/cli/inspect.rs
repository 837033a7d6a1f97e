//! `inspect`.

use serde_json::json;

use super::{good, run, statistics, workplace};

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
