//! The files that a glTF file refers to, for build scripts that watch them.

use std::path::{Path, PathBuf};

use super::uri::{self, Uri};
use crate::import::files;
use crate::import::folders::Folders;

/// The files that a `.gltf` file refers to; `None` where it is another kind of file or cannot be read.
pub(crate) fn external_files(scene: &Path) -> Option<Vec<PathBuf>> {
    if !scene.extension()?.eq_ignore_ascii_case("gltf") {
        return None;
    }
    let root: serde_json::Value = serde_json::from_slice(&files::read(scene).ok()?).ok()?;
    let folder = scene.parent()?;
    let entries = ["buffers", "images"]
        .into_iter()
        .filter_map(|array| root.get(array)?.as_array())
        .flatten();
    let uris = entries.filter_map(|entry| entry.get("uri")?.as_str());
    let mut folders = Folders::default();
    let paths = uris.filter_map(|uri| match Uri::new(uri) {
        Uri::File(name) => Some(uri::file_path(name, folder, &mut folders).ok()?.path),
        Uri::Data(_) | Uri::Remote => None,
    });
    Some(paths.collect())
}
