//! The files that OBJ and MTL files name.

use std::fs;
use std::path::{Path, PathBuf};

/// Finds a file: backslashes are separators, and where nothing has the exact
/// name, one that differs only in case will do (these files come from systems that ignore case).
pub(super) fn find_loosely(name: &str, folder: &Path) -> Option<PathBuf> {
    let name = name.trim().replace('\\', "/");
    if name.is_empty() {
        return None;
    }
    let exact = folder.join(&name);
    if exact.is_file() {
        return Some(exact);
    }
    let mut path = if name.starts_with('/') {
        PathBuf::from("/")
    } else {
        folder.to_owned()
    };
    for part in name
        .split('/')
        .filter(|part| !part.is_empty() && *part != ".")
    {
        let next = path.join(part);
        path = if part == ".." || next.exists() {
            next
        } else {
            let mut matches: Vec<PathBuf> = fs::read_dir(&path)
                .ok()?
                .filter_map(Result::ok)
                .filter(|entry| {
                    entry
                        .file_name()
                        .to_string_lossy()
                        .eq_ignore_ascii_case(part)
                })
                .map(|entry| entry.path())
                .collect();
            matches.sort();
            matches.into_iter().next()?
        };
    }
    path.is_file().then_some(path)
}
