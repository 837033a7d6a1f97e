//! The files that OBJ and MTL files name.
//!
//! They come from systems that encode names in their own way, and from machines whose folders are not here.

use std::ffi::OsString;
use std::iter;
use std::path::{Path, PathBuf};

use super::names::readings;
use crate::import::folders::Folders;
use crate::import::percent;
use crate::import::text::{self, legacy_bytes};

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
    folders: Folders,
    guesses_left: usize,
}

impl Finder {
    /// One that knows no folder yet.
    pub(super) fn new() -> Self {
        Self {
            folders: Folders::default(),
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
            names.find_map(|name| self.folders.find(name, folder))
        })
    }
}

/// A name, what it is without percent escapes, of which there may be two layers, and what its bytes may have meant if it
/// comes from a file of a legacy code page.
fn encoded_names(name: &str) -> Vec<OsString> {
    let unescaped = |name: &String| {
        let decoded = text::decode(percent::decode(name));
        (decoded != *name).then_some(decoded)
    };
    let layers = iter::successors(Some(name.to_owned()), unescaped).take(3);
    let mut names: Vec<OsString> = layers.map(OsString::from).collect();
    names.extend(text::other_decodings(name).into_iter().map(OsString::from));
    #[cfg(unix)]
    names.extend(legacy_bytes(name).map(std::os::unix::ffi::OsStringExt::from_vec));
    names
}
