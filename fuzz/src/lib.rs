//! What all targets do with a file: it ends in a scene that has a plan, or in an error.

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use residual_scenegen::import::{EnvironmentOptions, ImportOptions, import};
use residual_scenegen::plan::{PlanOptions, plan};
use tempfile::TempDir;

/// A folder for the files of this process; where there is one, in memory.
static FOLDER: LazyLock<TempDir> = LazyLock::new(|| {
    let memory = Path::new("/dev/shm");
    let folder = match memory.is_dir() {
        true => TempDir::new_in(memory),
        false => TempDir::new(),
    };
    folder.expect("a temporary folder")
});

/// Writes a file.
pub fn write(name: &str, bytes: &[u8]) {
    fs::write(FOLDER.path().join(name), bytes).expect("a file in the temporary folder");
}

/// Imports and plans a scene that was written, with an environment that was written.
pub fn read(scene: &str, environment: Option<&str>) {
    let options = ImportOptions {
        environment: environment.map(|name| EnvironmentOptions {
            path: FOLDER.path().join(name),
            strength: 1.0,
            rotation_degrees: 0.0,
        }),
        moments: vec![0.5, 0.75],
        ..ImportOptions::default()
    };
    let Ok(scene) = import(&FOLDER.path().join(scene), &options) else {
        return;
    };
    let options = PlanOptions {
        size: [16, 12],
        ..PlanOptions::default()
    };
    // Too large a scene is an error, too.
    let _ = plan(&scene, &options);
}
