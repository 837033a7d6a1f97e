//! A file that passes 400 lines is asking to be two. One that is longer has a reason, in its head:
//!
//! ```text
//! //! Tape of a recorded function.
//! //!
//! //! Longer than 400 lines: one test for each operation, which read as a table.
//! ```

use std::path::Path;

use anyhow::Result;

use crate::problem::{Place, Problem};
use crate::sources;
use crate::workspace::Workspace;

/// Most lines of a file that needs no reason.
pub const MOST_LINES: usize = 400;

/// How the line of the file's head begins that says why the file is longer.
pub const REASON: &str = "//! Longer than 400 lines:";

/// Files that are too long, and reasons that no file needs.
///
/// # Errors
/// If a file cannot be read.
pub fn problems(workspace: &Workspace) -> Result<Vec<Problem>> {
    let mut problems = Vec::new();
    for package in &workspace.packages {
        for source in sources::of_package(&package.directory)? {
            problems.extend(problem(workspace.relative(&source.path), &source.text));
        }
    }
    Ok(problems)
}

/// What is wrong with the length of a file.
pub fn problem(file: &Path, text: &str) -> Option<Problem> {
    let lines = text.lines().count();
    let reason = reason(text);
    if lines > MOST_LINES && reason.is_none() {
        return Some(Problem::new(
            Some(Place::line(file, lines)),
            format!("{lines} lines, where {MOST_LINES} are allowed"),
            format!("make two files of it, or give the reason in its head: {REASON} …"),
        ));
    }
    let (line, reason) = reason?;
    let place = Some(Place::line(file, line));
    if lines <= MOST_LINES {
        return Some(Problem::new(
            place,
            format!("a reason for more than {MOST_LINES} lines, of a file with {lines}"),
            "remove the reason",
        ));
    }
    reason.is_empty().then(|| {
        Problem::new(
            place,
            "an empty reason",
            "say why the file reads better as one",
        )
    })
}

/// The reason in the file's head, and the line where it begins.
fn reason(text: &str) -> Option<(usize, &str)> {
    let head = text
        .lines()
        .enumerate()
        .take_while(|(_, line)| line.starts_with("//"));
    let mut reasons =
        head.filter_map(|(index, line)| Some((index + 1, line.strip_prefix(REASON)?.trim())));
    reasons.next()
}
