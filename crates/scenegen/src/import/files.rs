//! Reading files, of which other files may have given the names.

use std::fs;
use std::path::Path;

/// The largest file read whole.
const MAX_FILE_BYTES: u64 = 1 << 30;

/// Reads a regular file of bounded size.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, String> {
    let metadata = fs::metadata(path).map_err(|error| {
        format!("cannot be read ({error}); check that it exists and may be read")
    })?;
    // A device or pipe named by a hostile file would never end.
    if !metadata.is_file() {
        return Err("is not a regular file".into());
    }
    if metadata.len() > MAX_FILE_BYTES {
        return Err(format!(
            "has {} bytes, more than the 1 GiB we read",
            metadata.len()
        ));
    }
    let bytes = fs::read(path).map_err(|error| format!("cannot be read ({error})"))?;
    match stand_in(&bytes) {
        Some(problem) => Err(problem.into()),
        None => Ok(bytes),
    }
}

/// What lies here instead of the file that somebody wanted to have, and the way to it.
fn stand_in(bytes: &[u8]) -> Option<&'static str> {
    let text = bytes.trim_ascii_start();
    let starts = |start: &str| {
        let bytes = text.get(..start.len());
        bytes.is_some_and(|bytes| bytes.eq_ignore_ascii_case(start.as_bytes()))
    };
    if starts("version https://git-lfs") {
        return Some("is a pointer of Git LFS, not the file; `git lfs pull` gets it");
    }
    if starts("<!doctype html") || starts("<html") {
        return Some("is a web page, not the file; download the file itself (on GitHub: Raw)");
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stands_in_for_a_file_is_told_from_it() {
        assert!(stand_in(b"version https://git-lfs.github.com/spec/v1\noid sha256:1").is_some());
        assert!(stand_in(b"\n<!DOCTYPE html><html>").is_some());
        for content in [&b"{\"asset\": {}}"[..], b"v 1 2 3", b"\x89PNG", b""] {
            assert_eq!(stand_in(content), None);
        }
    }
}
