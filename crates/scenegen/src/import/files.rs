//! Reading files, of which other files may have given the names.

use std::fs;
use std::path::Path;

/// The largest file read whole.
const MAX_FILE_BYTES: u64 = 1 << 30;

/// Reads a regular file of bounded size.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, String> {
    let metadata = fs::metadata(path).map_err(|error| format!("cannot be read ({error})"))?;
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
    fs::read(path).map_err(|error| format!("cannot be read ({error})"))
}
