//! The files that OBJ and MTL files name.
//!
//! They come from systems that ignore case, separate folders by backslashes and encode names in their own way, and
//! from machines whose folders are not here.

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

/// Finds a file where its name says, but for case, slashes, quotes and comments.
pub(super) fn find(text: &str, folders: &[&Path]) -> Option<PathBuf> {
    readings(text).find_map(|name| folders.iter().find_map(|folder| find_named(name, folder)))
}

/// Finds a file elsewhere, where the last parts of its path lead beside the file that names it, or into a folder of
/// images there. What is found is a guess.
pub(super) fn guess(text: &str, folders: &[&Path]) -> Option<PathBuf> {
    let in_folders = |name: &str| {
        let beside = folders.iter().find_map(|folder| find_named(name, folder));
        beside.or_else(|| {
            let pairs = folders
                .iter()
                .flat_map(|folder| IMAGE_FOLDERS.map(|images| (folder, images)));
            pairs
                .into_iter()
                .find_map(|(folder, images)| find_named(&format!("{images}/{name}"), folder))
        })
    };
    readings(text).find_map(|name| {
        let name = name.replace('\\', "/");
        let parts: Vec<&str> = name.split('/').filter(|part| !part.is_empty()).collect();
        let longest = parts.len().saturating_sub(MAX_PARTS);
        (longest..parts.len()).find_map(|start| in_folders(&parts[start..].join("/")))
    })
}

fn find_named(name: &str, folder: &Path) -> Option<PathBuf> {
    encoded_names(name).into_iter().find_map(|name| {
        let path = folder.join(&name);
        if path.is_file() {
            return Some(path);
        }
        find_loosely(name.to_str()?, folder)
    })
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

/// Backslashes are separators, and where nothing has the exact name, one that differs only in case, or
/// in how accents are composed, will do.
fn find_loosely(name: &str, folder: &Path) -> Option<PathBuf> {
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
            let folder = if path.as_os_str().is_empty() {
                Path::new(".")
            } else {
                &path
            };
            let wanted = comparable(part);
            fs::read_dir(folder)
                .ok()?
                .filter_map(Result::ok)
                .filter(|entry| comparable(&entry.file_name().to_string_lossy()) == wanted)
                .map(|entry| entry.path())
                .min()?
        };
    }
    path.is_file().then_some(path)
}
