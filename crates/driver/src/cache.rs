//! Compiled renderers, kept: `target/residual/cache/KEY/` holds a library and the source that it was made from.
//!
//! The key is a hash of that source and of everything else that goes into the library. Entries are written beside their
//! place and renamed, and the longest unused go when there is too much.

use std::fs::{self, File};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use anyhow::{Context, Result};

use crate::fingerprint::fingerprint;
use crate::workspace;

/// More than this is not kept, unless `RESIDUAL_CACHE_MIB` says so.
const DEFAULT_MIB: u64 = 512;

const SOURCE: &str = "scene.rs";
const LIBRARY: &str = "library";

/// The compiled renderers on this disk.
#[derive(Clone, Debug)]
pub struct Cache {
    directory: PathBuf,
    bound: u64,
}

/// One of them.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Its own directory in the cache.
    directory: PathBuf,
    /// When it was last made or found.
    pub used: SystemTime,
    /// Size of its files.
    pub bytes: u64,
}

impl Cache {
    /// The workspace's cache, or the one in `RESIDUAL_CACHE_DIR`.
    pub fn open() -> Self {
        let mib = std::env::var("RESIDUAL_CACHE_MIB").ok();
        let mib = mib.and_then(|mib| mib.parse().ok()).unwrap_or(DEFAULT_MIB);
        let parent = std::env::var_os("RESIDUAL_CACHE_DIR").map(PathBuf::from);
        Self {
            // Never the given directory itself, which may hold other things: a cache is cleared as a whole.
            directory: parent.map_or_else(
                || workspace::own_directory().join("cache"),
                |parent| parent.join("residual"),
            ),
            bound: mib << 20,
        }
    }

    /// A cache in a directory of its own.
    pub fn at(directory: &Path) -> Self {
        Self {
            directory: directory.to_owned(),
            ..Self::open()
        }
    }

    /// Where the renderers are.
    pub fn directory(&self) -> &Path {
        &self.directory
    }

    /// Bytes that are kept at most.
    pub fn bound(&self) -> u64 {
        self.bound
    }

    /// The key of a source.
    ///
    /// # Errors
    /// If the sources of the workspace cannot be read, which it covers.
    pub fn key(source: &str) -> Result<String> {
        let fingerprint = fingerprint().context("reading the workspace's sources")?;
        let mut hasher = DefaultHasher::new();
        fingerprint.hash(&mut hasher);
        code(source).for_each(|line| line.hash(&mut hasher));
        Ok(format!("{:016x}", hasher.finish()))
    }

    /// The library of a source, if it is here. It counts as used now.
    pub fn find(&self, key: &str, source: &str) -> Option<PathBuf> {
        let directory = self.directory.join(key);
        // Two sources may share a key, in theory.
        let kept = fs::read_to_string(directory.join(SOURCE));
        let same = kept.is_ok_and(|kept| code(&kept).eq(code(source)));
        let library = directory.join(LIBRARY);
        if !same || !library.exists() {
            return None;
        }
        // Only the order of eviction suffers where this fails.
        let _ = File::options()
            .append(true)
            .open(directory.join(SOURCE))
            .and_then(|file| file.set_modified(SystemTime::now()));
        Some(library)
    }

    /// Keeps a copy of a library, and says where. Older ones go if there is too much.
    ///
    /// # Errors
    /// If the library cannot be read, or the cache not written.
    pub fn keep(&self, key: &str, source: &str, library: &Path) -> Result<PathBuf> {
        let write = || -> io::Result<PathBuf> {
            fs::create_dir_all(&self.directory)?;
            let new = tempfile::tempdir_in(&self.directory)?;
            fs::write(new.path().join(SOURCE), source)?;
            fs::copy(library, new.path().join(LIBRARY))?;
            let place = self.directory.join(key);
            // Whoever came first made the same, or something damaged.
            let _ = fs::remove_dir_all(&place);
            fs::rename(new.keep(), &place)?;
            Ok(place.join(LIBRARY))
        };
        let kept = write().with_context(|| format!("writing to {}", self.directory.display()))?;
        self.evict(key)?;
        Ok(kept)
    }

    /// All entries, the last used first.
    ///
    /// # Errors
    /// If there is a cache that cannot be read.
    pub fn entries(&self) -> Result<Vec<Entry>> {
        let read = || -> io::Result<Vec<Entry>> {
            let mut entries = Vec::new();
            for entry in fs::read_dir(&self.directory)? {
                let directory = entry?.path();
                let (Ok(source), Ok(library)) = (
                    fs::metadata(directory.join(SOURCE)),
                    fs::metadata(directory.join(LIBRARY)),
                ) else {
                    continue;
                };
                entries.push(Entry {
                    used: source.modified()?,
                    bytes: source.len() + library.len(),
                    directory,
                });
            }
            entries.sort_by_key(|entry| std::cmp::Reverse(entry.used));
            Ok(entries)
        };
        match read() {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
            entries => entries.with_context(|| format!("reading {}", self.directory.display())),
        }
    }

    /// Removes the longest unused until the rest, of which `newest` is one, is within the bound.
    fn evict(&self, newest: &str) -> Result<()> {
        let mut bytes = 0;
        for entry in self.entries()? {
            bytes += entry.bytes;
            if bytes > self.bound && !entry.directory.ends_with(newest) {
                // Another process may have been faster.
                let _ = fs::remove_dir_all(&entry.directory);
            }
        }
        Ok(())
    }

    /// Removes everything.
    ///
    /// # Errors
    /// If something cannot be removed.
    pub fn clear(&self) -> Result<()> {
        match fs::remove_dir_all(&self.directory) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                Err(error).with_context(|| format!("removing {}", self.directory.display()))
            }
            _ => Ok(()),
        }
    }
}

/// A source without its comments: what things are called in the scene makes no other renderer.
fn code(source: &str) -> impl Iterator<Item = &str> {
    source
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
}

impl Entry {
    /// Its key.
    pub fn key(&self) -> String {
        let name = self.directory.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    }

    /// The name of its scene, as the first line of the source has it.
    pub fn title(&self) -> String {
        let source = fs::read_to_string(self.directory.join(SOURCE)).unwrap_or_default();
        let line = source.lines().next().unwrap_or_default();
        let title = line.strip_prefix("// Renderer for the scene ");
        let title =
            title.and_then(|title| title.strip_suffix(", generated by Residual. Do not edit."));
        title.unwrap_or("?").to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_unused_go() {
        let directory = tempfile::tempdir().unwrap();
        let library = directory.path().join("made");
        fs::write(&library, vec![0; 1000]).unwrap();
        let cache = Cache {
            directory: directory.path().join("cache"),
            bound: 2100,
        };
        assert!(cache.entries().unwrap().is_empty());
        for (key, age) in [("a", 30), ("b", 20), ("c", 10)] {
            cache.keep(key, key, &library).unwrap();
            let used = SystemTime::now() - std::time::Duration::from_secs(age);
            let source = cache.directory.join(key).join(SOURCE);
            let file = File::options().append(true).open(source).unwrap();
            file.set_modified(used).unwrap();
            // Using the oldest saves it from eviction.
            if key == "b" {
                assert!(cache.find("a", "a").is_some());
            }
        }
        assert!(cache.find("b", "b").is_none());
        assert!(cache.find("a", "a").is_some() && cache.find("c", "c").is_some());
        assert!(cache.find("a", "another source of the same key").is_none());
        assert!(cache.find("a", "// of another scene\na").is_some());
        cache.clear().unwrap();
        cache.clear().unwrap();
        assert!(cache.find("a", "a").is_none());
    }
}
