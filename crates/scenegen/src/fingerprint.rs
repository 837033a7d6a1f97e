//! A number for a [`Structure`], by which compiled code recognises the data that it was made for.

use std::fmt::{self, Write};

use residual_render::program::Structure;

use crate::plan::Plan;

/// Data that belong to another renderer than the one that was compiled.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "the renderer was compiled for structure {compiled:016x}, but {scene:?} has structure {found:016x}: \
     the scene or the plan's options have changed since; compile again, with the same options in both places"
)]
pub struct StructureMismatch {
    /// Name of the scene.
    pub scene: String,
    /// What the renderer was compiled for.
    pub compiled: u64,
    /// What the plan has.
    pub found: u64,
}

/// The 64-bit FNV-1a hash of the structure's `Debug` text, which prints every field, and floats so that they read
/// back. Equal structures have equal numbers in all programs that one version of Residual is compiled into.
pub fn fingerprint(structure: &Structure) -> u64 {
    struct Fnv(u64);
    impl Write for Fnv {
        fn write_str(&mut self, text: &str) -> fmt::Result {
            for byte in text.bytes() {
                self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
            }
            Ok(())
        }
    }
    let mut hash = Fnv(0xcbf2_9ce4_8422_2325);
    write!(hash, "{structure:?}").expect("hashing does not fail");
    hash.0
}

impl Plan {
    /// Checks that a compiled renderer, of which `compiled` is the emitted `Scene::STRUCTURE`, is this plan's.
    ///
    /// # Errors
    /// If it was generated from another structure.
    pub fn check_structure(&self, compiled: u64) -> Result<(), StructureMismatch> {
        let found = fingerprint(&self.structure);
        if found == compiled {
            return Ok(());
        }
        Err(StructureMismatch {
            scene: self.name.clone(),
            compiled,
            found,
        })
    }
}
