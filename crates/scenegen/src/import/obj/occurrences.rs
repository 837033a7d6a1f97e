//! One fault that may stand on thousands of lines, as one warning.

use super::lines::line_place;
use crate::import::warnings::Warnings;

/// How often something occurs, and where first.
#[derive(Debug, Default)]
pub(super) struct Occurrences {
    /// Index of the first line.
    first: Option<usize>,
    count: usize,
}

impl Occurrences {
    /// Counts one on a line.
    pub(super) fn note(&mut self, line: usize) {
        self.first.get_or_insert(line);
        self.count += 1;
    }

    /// Warns at the first line, if there is one: how many there are, what and what was done.
    pub(super) fn warn(&self, message: &str, warnings: &mut Warnings) {
        let Some(first) = self.first else { return };
        let place = match self.count {
            1 => line_place(first),
            _ => format!("{} and others", line_place(first)),
        };
        warnings.push(place, format!("{} {message}", self.count));
    }
}
