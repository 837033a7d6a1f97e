//! Files of others with the shutter open: none panics, and all that move are rendered.

use std::path::Path;

use rayon::prelude::*;
use residual_scenegen::import::{ImportOptions, import};
use residual_scenegen::plan::{PlanOptions, plan};
use residual_tests::{scene_files, scenes};

use super::file::{interpret, options};

const SIZE: [u32; 2] = [16, 16];
/// Files that are larger make tests wait.
const LARGEST: u64 = 4 << 20;

/// Whether something in the file moves; then it is rendered.
fn moves(file: &Path) -> bool {
    let import_options = ImportOptions {
        moments: vec![0.1, 0.6],
        ..ImportOptions::default()
    };
    let plan_options = PlanOptions {
        size: SIZE,
        ..PlanOptions::default()
    };
    let Ok(scene) = import(file, &import_options) else {
        return false;
    };
    let Ok(plan) = plan(&scene, &plan_options) else {
        return false;
    };
    if plan.motion.is_none() {
        return false;
    }
    let film = interpret(&plan, &options(SIZE, 2, 0));
    assert_eq!(film.invalid_samples(), 0, "{}", file.display());
    true
}

#[test]
fn shared_scenes_move_or_do_not() {
    let Some(scenes) = scenes() else { return };
    let folders = ["malformed", "materials", "peers"];
    let mut files: Vec<_> = folders
        .iter()
        .flat_map(|f| scene_files(&scenes.join(f)))
        .collect();
    files.retain(|file| file.metadata().expect("a file").len() <= LARGEST);
    let moving = files.par_iter().filter(|file| moves(file)).count();
    assert!(moving >= 6, "{moving}");
}
