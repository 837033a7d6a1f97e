//! What whole-system tests share: scenes to render, a way to render them, and a way to compare what came out.
//!
//! Tests go the way of the data through public functions: file or [`fixtures`] → description → plan → renderer →
//! film. Tests of the command line run it as a process.

mod builder;
pub mod fixtures;
pub mod library;
mod parts;
pub mod pictures;
mod setup;
pub mod tiny;

pub use parts::Parts;
pub use setup::{Look, Prepared, read_scene};

use std::path::{Path, PathBuf};

/// The folder of shared scenes; prints that the test is skipped where there is none.
pub fn scenes() -> Option<PathBuf> {
    let default = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/scenes");
    let path = std::env::var_os("RESIDUAL_SCENES").map_or(default, PathBuf::from);
    if !path.is_dir() {
        println!(
            "skipped: {} is not there (set RESIDUAL_SCENES)",
            path.display()
        );
        return None;
    }
    Some(path)
}

/// All scene files below a folder, sorted.
pub fn scene_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder that can be read") {
            let path = entry.expect("an entry").path();
            let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
            if path.is_dir() {
                folders.push(path);
            } else if ["gltf", "glb", "obj"]
                .iter()
                .any(|known| extension == *known)
            {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}
