//! How much code there is, for each package.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow};
use proc_macro2::{TokenStream, TokenTree};

use crate::files::{self, Crate};
use crate::workspace::{Package, Workspace};

/// Sizes of the code of a package, without its tests, benchmarks and examples.
struct Figures {
    /// Lines with code: no comments, no empty lines.
    lines_of_code: usize,
    /// All lines of each file, with comments and tests in it.
    lengths: BTreeMap<PathBuf, usize>,
    circles: usize,
}

/// The table of all packages.
pub(crate) fn table(workspace: &Workspace) -> Result<String> {
    let mut table = String::new();
    writeln!(
        table,
        "{:<24} {:>7} {:>6} {:>7} {:>8}  {:<40} {:>7}",
        "production code", "lines", "files", "median", "longest", "", "circles"
    )?;
    let mut all = Figures {
        lines_of_code: 0,
        lengths: BTreeMap::new(),
        circles: 0,
    };
    for package in &workspace.packages {
        let figures = figures(package)?;
        write_row(&mut table, &package.name, &figures, workspace)?;
        all.lines_of_code += figures.lines_of_code;
        all.lengths.extend(figures.lengths);
        all.circles += figures.circles;
    }
    write_row(&mut table, "all", &all, workspace)?;
    table.truncate(table.trim_end().len());
    Ok(table)
}

fn write_row(
    table: &mut String,
    name: &str,
    figures: &Figures,
    workspace: &Workspace,
) -> Result<()> {
    let mut lengths: Vec<_> = figures.lengths.values().copied().collect();
    lengths.sort_unstable();
    let median = lengths.get(lengths.len() / 2).copied().unwrap_or(0);
    let longest = figures.lengths.iter().max_by_key(|(_, lines)| **lines);
    let (path, longest) = longest.map_or((Path::new(""), 0), |(path, lines)| (path, *lines));
    writeln!(
        table,
        "{name:<24} {:>7} {:>6} {median:>7} {longest:>8}  {:<40} {:>7}",
        figures.lines_of_code,
        lengths.len(),
        workspace.relative(path).display().to_string(),
        figures.circles,
    )?;
    Ok(())
}

fn figures(package: &Package) -> Result<Figures> {
    let mut figures = Figures {
        lines_of_code: 0,
        lengths: BTreeMap::new(),
        circles: 0,
    };
    for target in &package.targets {
        figures.circles += files::circles(&target.source)?.len();
        if !target.is_production() {
            continue;
        }
        for file in Crate::read(&target.source)?.files {
            if file.is_test || figures.lengths.contains_key(&file.path) {
                continue;
            }
            let text = fs::read_to_string(&file.path)?;
            figures.lines_of_code += lines_of_code(&text)
                .map_err(|error| error.context(file.path.display().to_string()))?;
            figures.lengths.insert(file.path, text.lines().count());
        }
    }
    Ok(figures)
}

/// Lines of a file with code that is not for tests.
fn lines_of_code(text: &str) -> Result<usize> {
    let tokens: TokenStream = text.parse().map_err(|error| anyhow!("{error}"))?;
    let mut lines = BTreeSet::new();
    add_lines(tokens, &mut lines);
    Ok(lines.len())
}

fn add_lines(tokens: TokenStream, lines: &mut BTreeSet<usize>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut rest = &tokens[..];
    while let Some((token, after)) = rest.split_first() {
        rest = after;
        match attribute(token, after) {
            Some(Attribute::Documentation { after }) => rest = after,
            Some(Attribute::ForTests { after }) => rest = after_item(after),
            None => match token {
                TokenTree::Group(group) => {
                    lines.insert(group.span_open().start().line);
                    lines.insert(group.span_close().end().line);
                    add_lines(group.stream(), lines);
                }
                _ => lines.extend(token.span().start().line..=token.span().end().line),
            },
        }
    }
}

/// An attribute that is no code, or stands before an item that is none.
enum Attribute<'a> {
    Documentation { after: &'a [TokenTree] },
    ForTests { after: &'a [TokenTree] },
}

fn attribute<'a>(token: &TokenTree, after: &'a [TokenTree]) -> Option<Attribute<'a>> {
    let is = |token: &TokenTree, char| matches!(token, TokenTree::Punct(punct) if punct.as_char() == char);
    if !is(token, '#') {
        return None;
    }
    let after = match after {
        [inner, after @ ..] if is(inner, '!') => after,
        after => after,
    };
    let [TokenTree::Group(group), after @ ..] = after else {
        return None;
    };
    let content: Vec<_> = group.stream().into_iter().collect();
    match &content[..] {
        [TokenTree::Ident(name), ..] if name == "doc" => Some(Attribute::Documentation { after }),
        [TokenTree::Ident(name), TokenTree::Group(condition)]
            if name == "cfg" && files::requires_test(condition.stream()) =>
        {
            Some(Attribute::ForTests { after })
        }
        _ => None,
    }
}

/// What follows an item: it ends with a semicolon or with braces.
fn after_item(tokens: &[TokenTree]) -> &[TokenTree] {
    let is_end = |token: &TokenTree| match token {
        TokenTree::Punct(punct) => punct.as_char() == ';',
        TokenTree::Group(group) => group.delimiter() == proc_macro2::Delimiter::Brace,
        _ => false,
    };
    let end = tokens.iter().position(is_end);
    end.map_or(&[], |end| &tokens[end + 1..])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_empty_lines_and_tests_are_no_code() {
        let text = r#"//! A module.

/// A function.
/* comment */
fn one() {
    // Nothing.

    two("a
b");
}

#[cfg(test)]
mod tests {
    fn three() {}
}

#[cfg(test)]
mod more;
const FOUR: u8 = 4;
"#;
        // fn, two(", b"), }, const
        assert_eq!(lines_of_code(text).unwrap(), 5);
    }

    #[test]
    fn a_condition_other_than_test_is_code() {
        let text = "#[cfg(not(test))]\nfn one() {}\n#[cfg(all(test, unix))]\nfn two() {}\n";
        assert_eq!(lines_of_code(text).unwrap(), 2);
    }
}
