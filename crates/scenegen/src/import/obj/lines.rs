//! Lines of OBJ and MTL files.

use crate::import::error::Fault;

/// Advice for a line that makes no sense.
pub(super) const REPAIR_LINE: &str = "repair that line or export the file again";

/// `line N`, counted from 1.
pub(super) fn line_place(index: usize) -> String {
    format!("line {}", index + 1)
}

/// A line that breaks the format's rules.
pub(super) fn line_fault(index: usize, problem: String) -> Fault {
    Fault::new(line_place(index), problem).advise(REPAIR_LINE)
}

/// First word and the trimmed rest.
pub(super) fn split_keyword(line: &str) -> (&str, &str) {
    let line = line.trim();
    line.split_once(char::is_whitespace)
        .map_or((line, ""), |(keyword, rest)| (keyword, rest.trim()))
}

/// The words of a statement, without the comment behind it.
pub(super) fn words(rest: &str) -> impl Iterator<Item = &str> {
    rest.split('#')
        .next()
        .unwrap_or_default()
        .split_whitespace()
}
