//! A hash of all that compiled scenes are made of, apart from their own source.

use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io;
use std::path::{Path, PathBuf};

use crate::workspace;

/// Of the compiler, the instruction set, flags, the versions of libraries, and the crates of the workspace that compiled
/// scenes depend on.
pub(crate) fn fingerprint() -> io::Result<u64> {
    of_workspace(workspace::root())
}

/// Folders of crates from the workspace on. Cargo tells the build script which they are.
fn crates() -> impl Iterator<Item = &'static str> {
    env!("RESIDUAL_CRATES").split(';')
}

fn of_workspace(root: &Path) -> io::Result<u64> {
    let mut hasher = DefaultHasher::new();
    env!("RESIDUAL_RUSTC").hash(&mut hasher);
    env!("RESIDUAL_TARGET_FEATURES").hash(&mut hasher);
    for flags in ["RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS"] {
        std::env::var_os(flags).hash(&mut hasher);
    }
    for file in ["Cargo.toml", "Cargo.lock", ".cargo/config.toml"] {
        fs::read(root.join(file))?.hash(&mut hasher);
    }
    for folder in crates() {
        folder.hash(&mut hasher);
        hash_package(&root.join(folder), &mut hasher)?;
    }
    Ok(hasher.finish())
}

/// Folders of a package whose files are programs of their own.
const OWN_PROGRAMS: [&str; 3] = ["tests", "benches", "examples"];

/// All that the package's library may be compiled from.
fn hash_package(package: &Path, hasher: &mut impl Hasher) -> io::Result<()> {
    for path in sorted(package)? {
        if !OWN_PROGRAMS.iter().any(|folder| path.ends_with(folder)) {
            hash_tree(&path, hasher)?;
        }
    }
    Ok(())
}

/// A file, or all files below a folder, with their names.
fn hash_tree(path: &Path, hasher: &mut impl Hasher) -> io::Result<()> {
    path.file_name().hash(hasher);
    if path.is_dir() {
        sorted(path)?
            .iter()
            .try_for_each(|path| hash_tree(path, hasher))
    } else {
        fs::read(path)?.hash(hasher);
        Ok(())
    }
}

fn sorted(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let entries = fs::read_dir(folder)?;
    let mut paths = entries
        .map(|entry| Ok(entry?.path()))
        .collect::<io::Result<Vec<_>>>()?;
    paths.sort();
    Ok(paths)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::io::Write as _;

    use serde_json::Value;

    use super::*;

    /// The members of the workspace, as `cargo metadata` lists them.
    fn members() -> Vec<Value> {
        let output = crate::cargo::command()
            .args(["metadata", "--no-deps", "--format-version", "1"])
            .output()
            .unwrap();
        assert!(output.status.success());
        let metadata: Value = serde_json::from_slice(&output.stdout).unwrap();
        metadata["packages"].as_array().unwrap().clone()
    }

    /// The folders of a package and of all that it depends on by paths, from the workspace on.
    fn reachable(name: &str, members: &[Value], found: &mut BTreeSet<String>) {
        let package = members.iter().find(|p| p["name"] == name).unwrap();
        if found.insert(folder(package)) {
            for dependency in package["dependencies"].as_array().unwrap() {
                if dependency["path"].is_string() && dependency["kind"] != "dev" {
                    reachable(dependency["name"].as_str().unwrap(), members, found);
                }
            }
        }
    }

    fn folder(package: &Value) -> String {
        let manifest = Path::new(package["manifest_path"].as_str().unwrap());
        let folder = manifest.parent().unwrap();
        let inside = folder.strip_prefix(workspace::root()).unwrap();
        inside.to_str().unwrap().to_owned()
    }

    /// Copies files, without tests and what was built.
    fn copy(from: &Path, to: &Path) {
        fs::create_dir_all(to).unwrap();
        for path in sorted(from).unwrap() {
            let name = path.file_name().unwrap();
            if path.is_file() {
                fs::copy(&path, to.join(name)).unwrap();
            } else if !["target", "tests"].iter().any(|folder| name == *folder) {
                copy(&path, &to.join(name));
            }
        }
    }

    #[test]
    fn it_covers_what_compiled_scenes_depend_on_and_nothing_else() {
        let members = members();
        let mut covered = BTreeSet::new();
        reachable("residual-compiled-scene", &members, &mut covered);
        assert!(covered.contains("crates/bvh") && covered.contains("crates/compiled-scene"));
        assert!(!covered.contains("crates/scenegen"));

        let copied = tempfile::tempdir().unwrap();
        let root = copied.path();
        let needed = members.iter().map(folder).filter(|f| f != "tests");
        for folder in needed.chain([".cargo".to_owned()]) {
            copy(&workspace::root().join(&folder), &root.join(&folder));
        }
        for file in ["Cargo.toml", "Cargo.lock"] {
            fs::copy(workspace::root().join(file), root.join(file)).unwrap();
        }
        let before = of_workspace(root).unwrap();
        assert_eq!(before, fingerprint().unwrap());

        // Whether the fingerprint is another one while a file ends in a comment.
        let is_covered = |file: &Path| {
            let contents = fs::read(file).unwrap();
            let mut open = fs::File::options().append(true).open(file).unwrap();
            open.write_all(b"# changed").unwrap();
            let after = of_workspace(root).unwrap();
            fs::write(file, contents).unwrap();
            after != before
        };
        let mut changed = 0;
        for package in members.iter().map(folder) {
            for file in ["Cargo.toml", "build.rs", "src/lib.rs", "src/main.rs"] {
                let file = root.join(&package).join(file);
                if file.exists() {
                    let expected = covered.contains(&package);
                    assert_eq!(is_covered(&file), expected, "{}", file.display());
                    changed += 1;
                }
            }
        }
        assert!(changed > 2 * covered.len());
        for file in ["Cargo.toml", "Cargo.lock", ".cargo/config.toml"] {
            assert!(is_covered(&root.join(file)), "{file}");
        }
        // Not only the roots of crates: any file, and one that is new.
        fs::write(root.join("crates/render/src/new.rs"), "").unwrap();
        assert_ne!(of_workspace(root).unwrap(), before);
    }
}
