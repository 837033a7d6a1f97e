//! What can go wrong in an import, always with the file, the place in it and a way on.

use std::path::{Path, PathBuf};

use crate::desc::{Dismissed, Warning, WarningKind};
use crate::effect::Effect;

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
    #[error("{}: {message}; check that the file exists and can be read", file.display())]
    Io {
        /// The file.
        file: PathBuf,
        /// What the operating system said.
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
    /// There were warnings, and [`super::ImportOptions::strict`] turns them into an error.
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

/// More warnings than this are only counted: a hostile file can cause millions.
const MAX_WARNINGS: usize = 1000;

/// Warnings as they come up.
#[derive(Debug, Default)]
pub(super) struct Warnings {
    list: Vec<Warning>,
    omitted: usize,
    dismissed: Vec<Dismissed>,
}

impl Warnings {
    /// Records a warning, each once.
    pub(super) fn push(&mut self, place: impl Into<String>, message: impl Into<String>) {
        if self.list.len() >= MAX_WARNINGS {
            self.omitted += 1;
            return;
        }
        let warning = Warning {
            kind: WarningKind::Unfaithful,
            place: place.into(),
            message: message.into(),
        };
        if !self.list.contains(&warning) {
            self.list.push(warning);
        }
    }

    /// Records that something changes nothing, each once.
    pub(super) fn dismiss(
        &mut self,
        effect: Option<Effect>,
        place: impl Into<String>,
        reason: impl Into<String>,
    ) {
        let dismissed = Dismissed {
            effect,
            place: place.into(),
            reason: reason.into(),
        };
        if self.dismissed.len() < MAX_WARNINGS && !self.dismissed.contains(&dismissed) {
            self.dismissed.push(dismissed);
        }
    }

    /// What was dismissed, in order.
    pub(super) fn take_dismissed(&mut self) -> Vec<Dismissed> {
        std::mem::take(&mut self.dismissed)
    }

    /// All warnings, in order.
    pub(super) fn into_vec(mut self) -> Vec<Warning> {
        if self.omitted > 0 {
            let message = format!("{} more warnings are left out", self.omitted);
            self.list.push(Warning {
                kind: WarningKind::Unfaithful,
                place: "warnings".into(),
                message,
            });
        }
        self.list
    }
}

/// A JSON path with the element's name, such as `materials/3 "Glass"`.
pub(super) fn place(array: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) => format!("{array}/{index} \"{}\"", name.escape_debug()),
        None => format!("{array}/{index}"),
    }
}
