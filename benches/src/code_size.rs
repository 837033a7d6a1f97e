//! How much code the parts of the project are (thesis, Table 3.2): lines, and Halstead's effort.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow};
use serde_json::{Value, json};

use crate::halstead::Halstead;

/// A part, and its folder in the workspace. A folder inside another one belongs to its own part only.
const PARTS: [(&str, &str); 6] = [
    ("core", "crates/render/src"),
    ("CPU device", "crates/device-cpu/src"),
    ("GPU device", "crates/device-wgpu/src"),
    ("WGSL", "crates/wgsl/src"),
    ("ray queries", "crates/bvh/src"),
    ("scenes and plans", "crates/scenegen/src"),
];

/// How much code one part is.
#[derive(Clone, Debug)]
pub struct CodeRow {
    /// The part.
    pub part: &'static str,
    /// Lines without blank ones, comments and tests.
    pub lines: usize,
    /// Operators and operands of these lines, all files as one program.
    pub halstead: Halstead,
}

/// Measures the parts of the workspace at `root`.
///
/// # Errors
/// If a file cannot be read, or is not Rust.
pub fn code_sizes(root: &Path) -> Result<Vec<CodeRow>> {
    PARTS
        .into_iter()
        .map(|(part, folder)| {
            let mut row = CodeRow {
                part,
                lines: 0,
                halstead: Halstead::default(),
            };
            for file in sources(&root.join(folder))? {
                let parts = PARTS
                    .iter()
                    .filter(|(_, folder)| file.starts_with(root.join(folder)));
                let innermost = parts.max_by_key(|(_, folder)| folder.len());
                if innermost.is_some_and(|(innermost, _)| *innermost == part) {
                    row.add(&file).with_context(|| file.display().to_string())?;
                }
            }
            Ok(row)
        })
        .collect()
}

/// Lines that are neither blank nor comments.
pub fn code_lines(source: &str) -> usize {
    let lines = source.lines().map(str::trim_start);
    lines
        .filter(|line| !line.is_empty() && !line.starts_with("//"))
        .count()
}

impl CodeRow {
    fn add(&mut self, file: &Path) -> Result<()> {
        let code = without_tests(&fs::read_to_string(file)?);
        self.lines += code_lines(&code);
        self.halstead.add(&code).map_err(|error| anyhow!("{error}"))
    }

    /// As one JSON object.
    pub fn to_json(&self) -> Value {
        json!({
            "part": self.part,
            "lines": self.lines,
            "halstead_effort": self.halstead.effort(),
        })
    }
}

/// The Rust files below a folder; `tests.rs` is the body of a test module.
fn sources(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    let entries = fs::read_dir(folder).with_context(|| folder.display().to_string())?;
    for entry in entries {
        let path = entry?.path();
        if path.is_dir() {
            files.append(&mut sources(&path)?);
        } else if path.extension().is_some_and(|extension| extension == "rs")
            && !path.ends_with("tests.rs")
        {
            files.push(path);
        }
    }
    Ok(files)
}

/// A source in rustfmt's layout without its test modules: each ends with the first line that is a brace, or is declared
/// in one line.
fn without_tests(source: &str) -> String {
    let mut code = String::new();
    let mut lines = source.lines();
    while let Some(line) = lines.next() {
        if line != "#[cfg(test)]" {
            code.push_str(line);
            code.push('\n');
        } else if lines.next().is_some_and(|head| head.ends_with('{')) {
            lines.find(|line| *line == "}");
        }
    }
    code
}

/// A table of parts.
pub fn code_table(rows: &[CodeRow]) -> String {
    let mut text = format!(
        "{:<16}  {:>6}  {:>15}\n",
        "part", "lines", "effort, millions"
    );
    for row in rows {
        text.push_str(&format!(
            "{:<16}  {:>6}  {:>15.1}\n",
            row.part,
            row.lines,
            row.halstead.effort() / 1e6
        ));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neither_tests_nor_comments_are_code() {
        let source = "\
//! A module.

fn f() {
    // It does nothing; \"//\" in code does not end it.
    let nothing = \"//\";
}

#[cfg(test)]
mod tests;

#[cfg(test)]
mod more_tests {
    #[test]
    fn g() {}
}

/// After the tests.
fn h() {}
";
        let code = without_tests(source);
        assert!(code.contains("fn h()"), "{code}");
        assert!(
            !code.contains("mod tests") && !code.contains("fn g()"),
            "{code}"
        );
        assert_eq!(code_lines(&code), 4);
    }

    #[test]
    fn every_part_is_rust_and_in_no_other() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let rows = code_sizes(&root).unwrap();
        let lines = |part| rows.iter().find(|row| row.part == part).unwrap().lines;
        for (part, folder) in PARTS {
            let folder = root.join(folder);
            let all: usize = sources(&folder)
                .unwrap()
                .iter()
                .map(|file| code_lines(&without_tests(&fs::read_to_string(file).unwrap())))
                .sum();
            assert_eq!(lines(part), all, "{part}");
            assert!(lines(part) > 100, "{part}");
        }
    }
}
