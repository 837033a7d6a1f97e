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

/// The statements of a file, without empty lines and those that are comments, but for [`POLYPAINT`].
pub(super) fn statements(text: &str) -> impl Iterator<Item = Statement<'_>> {
    let mut lines = lines(text).enumerate();
    iter::from_fn(move || {
        loop {
            let (line, mut last) = lines.next()?;
            let mut text = Cow::Borrowed(last);
            let keyword = split_word(last).0.to_ascii_lowercase();
            let is_name = matches!(keyword.as_str(), "o" | "g" | "usemtl" | "newmtl");
            while let Some(start) = continued(last, is_name).or_else(|| {
                let next = numbers_behind_comments(lines.clone().map(|(_, line)| line));
                (!is_name && next.is_some()).then_some(before_continued_comment(last)?)
            }) {
                let text = text.to_mut();
                text.truncate(text.len() - (last.len() - start.len()));
                let comments = numbers_behind_comments(lines.clone().map(|(_, line)| line));
                let Some((_, next)) = lines.nth(comments.unwrap_or(0)) else {
                    break;
                };
                text.push(' ');
                text.push_str(next);
                last = next;
            }
            let start = text.trim_start_matches(is_blank);
            if !start.is_empty() && (!start.starts_with('#') || start.starts_with(POLYPAINT)) {
                return Some(Statement { line, text });
            }
        }
    })
}

/// What begins a comment in which ZBrush has colours of vertices.
pub(super) const POLYPAINT: &str = "#MRGB";

/// What stands before a comment that ends as if it went on in the next line, behind the words of a statement.
fn before_continued_comment(line: &str) -> Option<&str> {
    let start = &line[..comment_start(line)?];
    let is_continued = line.trim_end_matches(is_blank).ends_with('\\');
    (is_continued && !start.trim_matches(is_blank).is_empty()).then_some(start)
}

/// How many lines that are comments stand before one that begins with a number, as no statement does.
fn numbers_behind_comments<'t>(mut lines: impl Iterator<Item = &'t str>) -> Option<usize> {
    let mut comments = 0;
    loop {
        let first = split_word(lines.next()?).0;
        if first.starts_with('#') && !first.starts_with(POLYPAINT) {
            comments += 1;
        } else {
            let digits = first.trim_start_matches(['-', '+']);
            return digits
                .starts_with(|c: char| c.is_ascii_digit())
                .then_some(comments);
        }
    }
}

/// Lines that end in LF, CR LF or, on old systems, CR.
fn lines(text: &str) -> impl Iterator<Item = &str> + Clone {
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
        check("v 1\nf 1 \\", &[(1, "v", "1"), (2, "f", "1")]);
        check("v 1\nf 1 2 3\\", &[(1, "v", "1"), (2, "f", "1 2 3")]);
        check("f 1 2 \\\n", &[(1, "f", "1 2")]);
        check("f 1 2 \\\n\nv 1", &[(1, "f", "1 2"), (3, "v", "1")]);
    }

    #[test]
    fn comments_within_a_continued_statement_do_not_end_it() {
        check(
            "f 1 2 \\\n# half\n3 4\nv 1",
            &[(1, "f", "1 2  3 4"), (4, "v", "1")],
        );
        check(
            "f 1 2 \\\n# a\n  # b \\\n3 \\\n# c\n-4",
            &[(1, "f", "1 2  3  -4")],
        );
        check(
            "f 1 2 # half \\\n3 # more\nv 1",
            &[(1, "f", "1 2  3 # more"), (3, "v", "1")],
        );
        check("f 1 2 # half \\\n# more\n3", &[(1, "f", "1 2  3")]);
        // What begins with a word is a statement of its own.
        check(
            "f 1 2 3 # half \\\nv 1",
            &[(1, "f", "1 2 3 # half \\"), (2, "v", "1")],
        );
        check("# comment \\\n3 4\nv 1", &[(2, "3", "4"), (3, "v", "1")]);
        check("o a # b \\\n3", &[(1, "o", "a # b \\"), (2, "3", "")]);
    }

    #[test]
    fn colours_in_comments_are_statements() {
        check(
            "#MRGB ff000000\n# MRGB\n#mrgb\nf 1 \\\n#MRGB ff\n",
            &[(1, "#mrgb", "ff000000"), (4, "f", "1  #MRGB ff")],
        );
    }
}
