//! Where the workspace is, and what compiled scenes depend on in it.

use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io;
use std::path::{Path, PathBuf};

/// The workspace that this command line was built from.
pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("xtask lies in the workspace")
}

/// Where its builds are; compiled scenes share their dependencies with them.
pub(crate) fn target_directory() -> PathBuf {
    let given = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    // Cargo is run from the workspace; a relative path is relative to here.
    given.map_or_else(
        || root().join("target"),
        |path| std::path::absolute(&path).unwrap_or(path),
    )
}

/// Where we keep what we make.
pub(crate) fn own_directory() -> PathBuf {
    target_directory().join("residual")
}

/// A hash of all that a compiled scene is made of, but its own source: compiler, instruction set, flags, the versions of
/// libraries, and the sources of our crates.
pub(crate) fn fingerprint() -> io::Result<u64> {
    let mut hasher = DefaultHasher::new();
    env!("RESIDUAL_RUSTC").hash(&mut hasher);
    env!("RESIDUAL_TARGET_FEATURES").hash(&mut hasher);
    for flags in ["RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS"] {
        std::env::var_os(flags).hash(&mut hasher);
    }
    for file in ["Cargo.toml", "Cargo.lock", ".cargo/config.toml"] {
        fs::read(root().join(file))?.hash(&mut hasher);
    }
    for name in ["bvh", "render", "device-cpu"] {
        hash_directory(&root().join("crates").join(name).join("src"), &mut hasher)?;
    }
    Ok(hasher.finish())
}

fn hash_directory(directory: &Path, hasher: &mut impl Hasher) -> io::Result<()> {
    let mut entries: Vec<_> = fs::read_dir(directory)?.collect::<Result<_, _>>()?;
    entries.sort_by_key(fs::DirEntry::file_name);
    for entry in entries {
        let path = entry.path();
        if path.is_dir() {
            hash_directory(&path, hasher)?;
        } else {
            (entry.file_name(), fs::read(&path)?).hash(hasher);
        }
    }
    Ok(())
}
