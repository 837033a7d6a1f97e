//! Which scenes are measured.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

/// The scenes that were asked for; where none were, the glTF files that come with the repository.
pub(super) fn scenes_or_own(asked_for: &[PathBuf]) -> Result<Vec<PathBuf>> {
    if !asked_for.is_empty() {
        return Ok(asked_for.to_vec());
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let entries = std::fs::read_dir(&folder).with_context(|| folder.display().to_string())?;
    let mut scenes = entries
        .map(|entry| Ok(entry?.path()))
        .collect::<Result<Vec<_>>>()?;
    scenes.retain(|path| {
        path.extension()
            .is_some_and(|extension| extension == "gltf")
    });
    scenes.sort();
    Ok(scenes)
}
