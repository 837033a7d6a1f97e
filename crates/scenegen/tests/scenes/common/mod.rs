//! Helpers of the import tests.

pub(crate) mod gltf_text;
pub(crate) mod obj_text;

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

/// The folder of shared scenes; prints that the test is skipped where there is none.
pub(crate) fn scenes() -> Option<PathBuf> {
    let default = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/scenes");
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

/// All files below a folder, sorted.
pub(crate) fn files_under(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path)
            } else {
                files.push(path)
            }
        }
    }
    files.sort();
    files
}

/// The extension in lower case.
pub(crate) fn extension(path: &Path) -> String {
    path.extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_ascii_lowercase()
}

/// The JSON of a `.gltf` or `.glb` file.
pub(crate) fn read_json(path: &Path) -> Option<Value> {
    let bytes = fs::read(path).unwrap();
    match extension(path).as_str() {
        "gltf" => serde_json::from_slice(&bytes).ok(),
        "glb" => {
            let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
            serde_json::from_slice(&bytes[20..20 + length]).ok()
        }
        _ => None,
    }
}
