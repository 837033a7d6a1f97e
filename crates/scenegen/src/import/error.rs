//! What can go wrong in an import, always with the file, the place in it and a way on.

use std::path::{Path, PathBuf};

use crate::desc::Warning;

/// Why a scene was not imported.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// The extension is not one of those we read.
    #[error("{}: not a scene format we read; give a .gltf, .glb or .obj file", file.display())]
    UnknownFormat {
        /// The file.
        file: PathBuf,
    },
    /// A file could not be read.
    #[error("{}: {message}", file.display())]
    Io {
        /// The file.
        file: PathBuf,
        /// What the operating system said, or what lies there instead.
        message: String,
    },
    /// The content breaks the format's rules or our limits.
    #[error("{}: {place}: {problem}; {advice}", file.display())]
    Malformed {
        /// The file.
        file: PathBuf,
        /// JSON path or line.
        place: String,
        /// What is wrong.
        problem: String,
        /// What to do about it.
        advice: &'static str,
    },
    /// The file says that it cannot be shown without an extension that we lack.
    #[error("{}: extensionsRequired: {extension} is not supported; {advice}", file.display())]
    UnsupportedExtension {
        /// The file.
        file: PathBuf,
        /// The extension's name.
        extension: String,
        /// What to do about it.
        advice: &'static str,
    },
    /// There were warnings, and [`ImportOptions::strict`](super::options::ImportOptions::strict) turns them into an error.
    #[error("{}: {} with --strict:{}", file.display(), count(warnings), list(warnings))]
    Strict {
        /// The file.
        file: PathBuf,
        /// All the warnings.
        warnings: Vec<Warning>,
    },
}

fn count(warnings: &[Warning]) -> String {
    format!(
        "{} warning{}",
        warnings.len(),
        if warnings.len() == 1 { "" } else { "s" }
    )
}

fn list(warnings: &[Warning]) -> String {
    warnings
        .iter()
        .map(|warning| format!("\n  {}: {}", warning.place, warning.message))
        .collect()
}

/// A broken rule inside a file whose name the caller knows.
#[derive(Debug, Clone)]
pub(super) struct Fault {
    /// JSON path or line.
    pub(super) place: String,
    /// What is wrong.
    pub(super) problem: String,
    /// What to do about it.
    pub(super) advice: &'static str,
}

/// Advice for data that breaks the format's rules.
pub(super) const EXPORT_AGAIN: &str =
    "export the file again or repair it (the Khronos glTF validator says more)";

/// Advice for data beyond our limits.
pub(super) const MAKE_SMALLER: &str = "split the scene or reduce its data";

impl Fault {
    /// A rule of glTF that is broken at `place`.
    pub(super) fn new(place: impl Into<String>, problem: impl Into<String>) -> Self {
        Self {
            place: place.into(),
            problem: problem.into(),
            advice: EXPORT_AGAIN,
        }
    }

    /// The same with other advice.
    pub(super) fn advise(mut self, advice: &'static str) -> Self {
        self.advice = advice;
        self
    }

    /// Names the file.
    pub(super) fn in_file(self, file: &Path) -> ImportError {
        ImportError::Malformed {
            file: file.to_owned(),
            place: self.place,
            problem: self.problem,
            advice: self.advice,
        }
    }
}
