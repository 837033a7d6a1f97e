//! Files by the names that other systems give them: they separate folders by backslashes, ignore case and compose accents
//! in their own way.

use std::collections::HashMap;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use unicode_normalization::UnicodeNormalization;

/// A name by which two that differ in case or in how accents are composed are the same.
pub(super) fn comparable(name: &str) -> String {
    name.to_lowercase().nfc().collect()
}

/// What is in the folders that were looked at.
#[derive(Debug, Default)]
pub(super) struct Folders {
    /// By folder, its entries by name without case; the first in order of those that differ only in that.
    listings: HashMap<PathBuf, HashMap<String, PathBuf>>,
}

impl Folders {
    /// Finds a file of this name, or of one that means the same.
    pub(super) fn find(&mut self, name: &OsStr, folder: &Path) -> Option<PathBuf> {
        let path = folder.join(name);
        if path.is_file() {
            return Some(path);
        }
        self.find_loosely(name.to_str()?, folder)
    }

    /// Backslashes are separators, and where nothing has the exact name, one that differs only in case, or in how accents
    /// are composed, will do.
    fn find_loosely(&mut self, name: &str, folder: &Path) -> Option<PathBuf> {
        let name = name.replace('\\', "/");
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
                self.entry(&path, part)?
            };
        }
        path.is_file().then_some(path)
    }

    fn entry(&mut self, folder: &Path, name: &str) -> Option<PathBuf> {
        if !self.listings.contains_key(folder) {
            self.listings.insert(folder.to_owned(), list(folder));
        }
        self.listings[folder].get(&comparable(name)).cloned()
    }
}

/// What is in a folder; nothing where it cannot be read.
fn list(folder: &Path) -> HashMap<String, PathBuf> {
    let this = Path::new(".");
    let entries = fs::read_dir(if folder.as_os_str().is_empty() {
        this
    } else {
        folder
    });
    let mut paths: Vec<PathBuf> = entries
        .into_iter()
        .flatten()
        .filter_map(|entry| Some(entry.ok()?.path()))
        .collect();
    // The first of equal names is inserted last.
    paths.sort_by(|a, b| b.cmp(a));
    let name = |path: &Path| comparable(&path.file_name().unwrap_or_default().to_string_lossy());
    paths.into_iter().map(|path| (name(&path), path)).collect()
}
