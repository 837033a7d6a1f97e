//! Hostile files: every one is imported or refused with a message, and nothing panics or hangs.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use residual_scenegen::import::{ImportOptions, import};

use crate::common;

#[test]
fn hostile_files_end_in_a_scene_or_a_message() {
    let Some(scenes) = common::scenes() else {
        return;
    };
    let mut panicked = Vec::new();
    let mut outcomes: BTreeMap<String, (usize, usize)> = BTreeMap::new();
    for path in common::files_under(&scenes.join("malformed")) {
        let extension = common::extension(&path);
        if !matches!(extension.as_str(), "gltf" | "glb" | "obj") {
            continue;
        }
        let started = Instant::now();
        let result = catch_unwind(AssertUnwindSafe(|| {
            import(&path, &ImportOptions::default())
        }));
        assert!(
            started.elapsed() < Duration::from_secs(10),
            "{} took too long",
            path.display()
        );
        let (good, refused) = outcomes.entry(extension).or_default();
        match result {
            Ok(Ok(scene)) => {
                *good += 1;
                println!("ok  {} ({} warnings)", path.display(), scene.warnings.len());
            }
            Ok(Err(error)) => {
                *refused += 1;
                let message = error.to_string();
                println!("err {message}");
                assert!(
                    message.contains(';') && message.len() > 20,
                    "no advice: {message}"
                );
            }
            Err(_) => panicked.push(path),
        }
    }
    println!("(good, refused) by extension: {outcomes:?}");
    assert!(panicked.is_empty(), "panicked: {panicked:#?}");
    assert!(outcomes.len() == 3, "all three formats are covered");
}
