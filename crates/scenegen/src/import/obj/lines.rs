//! Lines of OBJ and MTL files: line ends of every system, comments, and statements that go on in the next line.

use std::borrow::Cow;
use std::iter;

/// A statement, which may stand on several lines.
pub(super) struct Statement<'t> {
    /// Index of its first line.
    pub(super) line: usize,
    text: Cow<'t, str>,
}

impl Statement<'_> {
    /// The first word, in lower case, and the trimmed rest with the comment behind it, as names may have a `#`.
    pub(super) fn split(&self) -> (Cow<'_, str>, &str) {
        let (keyword, rest) = split_word(&self.text);
        let keyword = match keyword.contains(|c: char| c.is_ascii_uppercase()) {
            true => keyword.to_ascii_lowercase().into(),
            false => keyword.into(),
        };
        (keyword, rest)
    }
}

/// The statements of a file, without empty lines and those that are comments.
pub(super) fn statements(text: &str) -> impl Iterator<Item = Statement<'_>> {
    let mut lines = lines(text).enumerate();
    iter::from_fn(move || {
        loop {
            let (line, mut last) = lines.next()?;
            let mut text = Cow::Borrowed(last);
            let keyword = split_word(last).0.to_ascii_lowercase();
            let is_name = matches!(keyword.as_str(), "o" | "g" | "usemtl" | "newmtl");
            while let Some(start) = continued(last, is_name) {
                let Some((_, next)) = lines.next() else { break };
                let text = text.to_mut();
                text.truncate(text.len() - (last.len() - start.len()));
                text.push(' ');
                text.push_str(next);
                last = next;
            }
            let start = text.trim_start_matches(is_blank);
            if !start.is_empty() && !start.starts_with('#') {
                return Some(Statement { line, text });
            }
        }
    })
}

/// Lines that end in LF, CR LF or, on old systems, CR.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = text;
    iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let (line, after) = match rest.find(['\n', '\r']) {
            Some(end) => {
                let next = rest[end..].strip_prefix("\r\n");
                (&rest[..end], next.unwrap_or(&rest[end + 1..]))
            }
            None => (rest, ""),
        };
        rest = after;
        Some(line)
    })
}

/// What stands before the backslash that says that a line goes on in the next. Comments do not go on, and a
/// backslash behind a letter is the end of a folder's name, or half of a character of another code page; so is one behind
/// anything but a blank where a statement is a name.
fn continued(line: &str, is_name: bool) -> Option<&str> {
    let start = line.trim_end_matches(is_blank).strip_suffix('\\')?;
    let goes_on = match start.chars().next_back() {
        Some(last) if is_name => is_blank(last),
        Some(last) => is_blank(last) || last.is_ascii_digit() || "./".contains(last),
        None => true,
    };
    (goes_on && comment_start(start).is_none()).then_some(start)
}

/// Where a comment starts: at a `#` that begins a word.
pub(super) fn comment_start(text: &str) -> Option<usize> {
    let starts_word = |index: usize| text[..index].chars().next_back().is_none_or(is_blank);
    text.match_indices('#')
        .map(|(index, _)| index)
        .find(|&index| starts_word(index))
}

/// White space, and what programs leave in files: byte order marks between joined files, ends of DOS files.
fn is_blank(character: char) -> bool {
    character.is_whitespace() || matches!(character, '\0' | '\u{1a}' | '\u{feff}')
}

/// First word and the trimmed rest.
pub(super) fn split_word(text: &str) -> (&str, &str) {
    let text = text.trim_matches(is_blank);
    text.split_once(is_blank)
        .map_or((text, ""), |(word, rest)| {
            (word, rest.trim_start_matches(is_blank))
        })
}

/// The words of a statement that has no names, without the comment behind it.
pub(super) fn words(rest: &str) -> impl Iterator<Item = &str> {
    // What C prints for no number has a `#` of its own: `1.#IND`, `-1.#QNAN`, `1.#INF`.
    let is_comment = |&(index, _): &(usize, &str)| !rest[..index].ends_with('.');
    let end = rest.match_indices('#').find(is_comment);
    rest[..end.map_or(rest.len(), |(index, _)| index)]
        .split(is_blank)
        .filter(|word| !word.is_empty())
}

/// `line N`, counted from 1.
pub(super) fn line_place(index: usize) -> String {
    format!("line {}", index + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Vec<(usize, String, String)> {
        statements(text)
            .map(|statement| {
                let (keyword, rest) = statement.split();
                (statement.line + 1, keyword.into_owned(), rest.to_owned())
            })
            .collect()
    }

    fn check(text: &str, expected: &[(usize, &str, &str)]) {
        let expected: Vec<_> = expected
            .iter()
            .map(|&(line, keyword, rest)| (line, keyword.to_owned(), rest.to_owned()))
            .collect();
        assert_eq!(read(text), expected, "{text:?}");
    }

    #[test]
    fn names_of_folders_do_not_continue_and_broken_numbers_are_no_comments() {
        check(
            "o D:\\scans\\2024\\\nusemtl a.\\\nv 1\\\n 2 \\\n3\ng a \\\n b",
            &[
                (1, "o", "D:\\scans\\2024\\"),
                (2, "usemtl", "a.\\"),
                (3, "v", "1  2  3"),
                (6, "g", "a   b"),
            ],
        );
        let split = |rest| words(rest).collect::<Vec<_>>();
        assert_eq!(split("1 -1.#QNAN 1.#INF # 3"), ["1", "-1.#QNAN", "1.#INF"]);
        assert_eq!(split("1 2#3"), ["1", "2"]);
    }

    #[test]
    fn lines_end_in_many_ways() {
        for end in ["\n", "\r\n", "\r"] {
            let text = ["# plate", "V  1 2", "", "\tusemtl a b ", "f 1 \\", "2 3"].join(end);
            let expected = [(2, "v", "1 2"), (4, "usemtl", "a b"), (5, "f", "1  2 3")];
            check(&text, &expected);
            check(&(text + end), &expected);
        }
        check(
            "\u{feff}v 1\u{a0}\0\n\u{feff}o a\n\u{1a}",
            &[(1, "v", "1"), (2, "o", "a")],
        );
    }

    #[test]
    fn backslashes_continue_statements_but_no_comments_and_no_names() {
        check("# D:\\scans\\\nv 1", &[(2, "v", "1")]);
        check("  #D:\\scans\\ \r\nv 1", &[(2, "v", "1")]);
        check(
            "v 1 # in D:\\\nv 2",
            &[(1, "v", "1 # in D:\\"), (2, "v", "2")],
        );
        check(
            "mtllib D:\\scans\\\nv 2",
            &[(1, "mtllib", "D:\\scans\\"), (2, "v", "2")],
        );
        check("f 1 2\\\n3", &[(1, "f", "1 2 3")]);
        check("f 1/ \\ \n \\\n2/\\\n3", &[(1, "f", "1/    2/ 3")]);
        check(
            "f 1 2 \\\n# a comment\nv 1",
            &[(1, "f", "1 2  # a comment"), (3, "v", "1")],
        );
        check("v 1\nf 1 \\", &[(1, "v", "1"), (2, "f", "1 \\")]);
    }
}
