//! Rust files of a package.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

/// A Rust file.
pub(crate) struct Source {
    pub(crate) path: PathBuf,
    pub(crate) text: String,
}

/// All Rust files of the package in a directory, whether they are compiled or not, in the order of their paths. What cargo
/// made, and packages within the package, are not among them.
pub(crate) fn of_package(directory: &Path) -> Result<Vec<Source>> {
    let mut sources = Vec::new();
    add_directory(directory, &mut sources)?;
    sources.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(sources)
}

fn add_directory(directory: &Path, sources: &mut Vec<Source>) -> Result<()> {
    let entries = fs::read_dir(directory).with_context(|| directory.display().to_string())?;
    for entry in entries {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if path.is_dir() {
            let is_package = path.join("Cargo.toml").exists();
            if !is_package && name != "target" && !name.starts_with('.') {
                add_directory(&path, sources)?;
            }
        } else if name.ends_with(".rs") {
            let text = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
            sources.push(Source { path, text });
        }
    }
    Ok(())
}
