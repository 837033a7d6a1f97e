//! What a check has to say: where, what is wrong, and what to do.

use std::fmt;
use std::path::PathBuf;

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Where, if it is in a file.
    pub place: Option<Place>,
    /// What is wrong.
    pub what: String,
    /// What it consists of, a line each.
    pub details: Vec<String>,
    /// What to do.
    pub remedy: String,
}

/// A line of a file, or a whole file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Relative to the workspace.
    pub file: PathBuf,
    /// From 1.
    pub line: Option<usize>,
}

impl Problem {
    /// A problem without details.
    pub fn new(place: Option<Place>, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            place,
            what: what.into(),
            details: Vec::new(),
            remedy: remedy.into(),
        }
    }
}

impl Place {
    /// A line, counted from 1.
    pub fn line(file: impl Into<PathBuf>, line: usize) -> Self {
        Self {
            file: file.into(),
            line: Some(line),
        }
    }

    /// A whole file.
    pub fn file(file: impl Into<PathBuf>) -> Self {
        Self {
            file: file.into(),
            line: None,
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}", self.file.display())?;
        self.line
            .map_or(Ok(()), |line| write!(formatter, ":{line}"))
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = &self.place {
            write!(formatter, "{place}: ")?;
        }
        writeln!(formatter, "{}", self.what)?;
        for detail in &self.details {
            writeln!(formatter, "    {detail}")?;
        }
        write!(formatter, "    to do: {}", self.remedy)
    }
}
