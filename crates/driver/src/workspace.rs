//! Where the workspace is, and where we keep what we make.

use std::path::{Path, PathBuf};

/// The workspace that this crate was built from.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .nth(2)
        .expect("the driver lies in crates/ of the workspace")
}

/// Where its builds are, as an absolute path; compiled scenes share their dependencies with them.
pub fn target_directory() -> PathBuf {
    let given = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    // Cargo is run from the workspace; a relative path is relative to here.
    given.map_or_else(
        || root().join("target"),
        |path| std::path::absolute(&path).unwrap_or(path),
    )
}

/// Where we keep what we make.
pub fn own_directory() -> PathBuf {
    target_directory().join("residual")
}
