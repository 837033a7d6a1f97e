//! The files that OBJ and MTL files name.
//!
//! They come from systems that ignore case, separate folders by backslashes and encode names in their own way, and
//! from machines whose folders are not here.

use std::collections::HashMap;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use encoding_rs::{BIG5, EUC_JP, EUC_KR, GB18030, SHIFT_JIS, WINDOWS_1251};

use super::names::{comparable, readings};
use super::text::legacy_bytes;

/// Folders in which exporters put images beside a model.
const IMAGE_FOLDERS: [&str; 8] = [
    "textures",
    "texture",
    "maps",
    "images",
    "tex",
    "../textures",
    "../images",
    "../maps",
];

/// How many parts of a path may lead to a file from here.
const MAX_PARTS: usize = 6;

/// More files than this are not looked for where their names do not say, which takes hundreds of looks each.
const MAX_GUESSES: usize = 1000;

/// Finds files, and remembers what is in the folders that it has looked at.
pub(super) struct Finder {
    /// By folder, its entries by name without case; the first in order of those that differ only in that.
    listings: HashMap<PathBuf, HashMap<String, PathBuf>>,
    guesses_left: usize,
}

impl Finder {
    /// One that knows no folder yet.
    pub(super) fn new() -> Self {
        Self {
            listings: HashMap::new(),
            guesses_left: MAX_GUESSES,
        }
    }

    /// Finds a file where its name says, but for case, slashes, quotes and comments.
    pub(super) fn find(&mut self, text: &str, folders: &[&Path]) -> Option<PathBuf> {
        readings(text).find_map(|name| self.find_in(name, folders))
    }

    /// Finds a file elsewhere, where the last parts of its path lead beside the file that names it, or into a folder of
    /// images there.
    pub(super) fn guess(&mut self, text: &str, folders: &[&Path]) -> Option<PathBuf> {
        self.guesses_left = self.guesses_left.checked_sub(1)?;
        readings(text).find_map(|name| {
            let name = name.replace('\\', "/");
            let parts: Vec<&str> = name.split('/').filter(|part| !part.is_empty()).collect();
            let longest = parts.len().saturating_sub(MAX_PARTS);
            (longest..parts.len()).find_map(|start| {
                let end = parts[start..].join("/");
                self.find_in(&end, folders).or_else(|| {
                    let mut images = IMAGE_FOLDERS.iter();
                    images.find_map(|images| self.find_in(&format!("{images}/{end}"), folders))
                })
            })
        })
    }

    fn find_in(&mut self, name: &str, folders: &[&Path]) -> Option<PathBuf> {
        let names = encoded_names(name);
        folders.iter().find_map(|folder| {
            let mut names = names.iter();
            names.find_map(|name| {
                let path = folder.join(name);
                if path.is_file() {
                    return Some(path);
                }
                self.find_loosely(name.to_str()?, folder)
            })
        })
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

/// A name, and what its bytes may have meant if it comes from a file of a legacy code page.
fn encoded_names(name: &str) -> Vec<OsString> {
    let mut names = vec![OsString::from(name)];
    if name.is_ascii() {
        return names;
    }
    let Some(bytes) = legacy_bytes(name) else {
        return names;
    };
    for encoding in [SHIFT_JIS, GB18030, BIG5, EUC_KR, EUC_JP, WINDOWS_1251] {
        if let Some(name) = encoding.decode_without_bom_handling_and_without_replacement(&bytes) {
            names.push(OsString::from(name.into_owned()));
        }
    }
    #[cfg(unix)]
    names.push(std::os::unix::ffi::OsStringExt::from_vec(bytes));
    names
}
