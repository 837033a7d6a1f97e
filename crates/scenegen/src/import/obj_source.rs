//! OBJ text made fit for tobj, line by line, so that its errors can be placed.
//!
//! tobj rejects a whole file for a comment behind a face or a colour with two numbers, turns polylines into
//! triangles and misaligns colours where only some vertices have them. This pass removes those cases, and
//! keeps the number of lines.

use std::io::{self, BufRead, Read};
use std::sync::atomic::{AtomicUsize, Ordering};

use super::error::Warnings;

/// Cleaned text, with what the materials pass wants to know.
pub(super) struct ObjSource {
    /// As many lines as the file.
    pub(super) text: String,
    /// Each `usemtl`'s line and name.
    pub(super) used_materials: Vec<(usize, String)>,
}

/// Cleans a file's text.
pub(super) fn clean(bytes: &[u8], warnings: &mut Warnings) -> ObjSource {
    let raw = String::from_utf8_lossy(bytes);
    let has_uniform_colors = has_uniform_colors(&raw);
    let mut source = ObjSource {
        text: String::with_capacity(raw.len()),
        used_materials: Vec::new(),
    };
    let (mut points_and_lines, mut short_faces) = (0_usize, 0_usize);
    let mut continued = String::new();
    for (index, line) in raw.lines().enumerate() {
        // A backslash joins lines; the joined line stands where the last one was.
        if let Some(start) = line.trim_end().strip_suffix('\\') {
            continued.push_str(start);
            continued.push(' ');
            source.text.push('\n');
            continue;
        }
        let joined = std::mem::take(&mut continued) + line;
        let (keyword, rest) = split_keyword(&joined);
        match keyword {
            "v" | "vt" | "vn" | "f" => {
                let rest = rest.split('#').next().unwrap_or_default();
                let words: Vec<&str> = rest.split_whitespace().collect();
                let kept = match (keyword, words.len()) {
                    ("v", 6) if has_uniform_colors => 6,
                    ("v", 4) => 4,
                    ("v" | "vn", _) => 3,
                    ("vt", _) => 2,
                    _ => words.len(),
                };
                if keyword == "f" && words.len() < 3 {
                    short_faces += 1;
                } else {
                    source.text.push_str(keyword);
                    for word in words.iter().take(kept) {
                        source.text.push(' ');
                        source.text.push_str(word);
                    }
                    if keyword == "vt" && words.len() == 1 {
                        source.text.push_str(" 0");
                    }
                }
            }
            "p" | "l" => points_and_lines += 1,
            "usemtl" if rest.is_empty() => {
                warnings.push(line_place(index), "usemtl without a name is ignored")
            }
            "usemtl" => {
                source.used_materials.push((index + 1, rest.to_owned()));
                source.text.push_str(&format!("usemtl {rest}"));
            }
            "o" | "g" | "mtllib" => source.text.push_str(&format!("{keyword} {rest}")),
            _ => {}
        }
        source.text.push('\n');
    }
    if points_and_lines > 0 {
        warnings.push(
            "p, l",
            format!("{points_and_lines} points and lines are not rendered"),
        );
    }
    if short_faces > 0 {
        warnings.push(
            "f",
            format!("{short_faces} faces have fewer than three corners and are left out"),
        );
    }
    source
}

/// `line N`, counted from 1.
pub(super) fn line_place(index: usize) -> String {
    format!("line {}", index + 1)
}

/// First word and the trimmed rest.
pub(super) fn split_keyword(line: &str) -> (&str, &str) {
    let line = line.trim();
    line.split_once(char::is_whitespace)
        .map_or((line, ""), |(keyword, rest)| (keyword, rest.trim()))
}

/// Whether all vertices have a colour: six numbers behind `v`.
fn has_uniform_colors(text: &str) -> bool {
    text.lines()
        .map(split_keyword)
        .filter(|(keyword, _)| *keyword == "v")
        .all(|(_, rest)| {
            rest.split('#')
                .next()
                .unwrap_or_default()
                .split_whitespace()
                .count()
                == 6
        })
}

/// Hands text out one line at a time and counts, so that a parser's error has a line.
pub(super) struct CountingLines<'a> {
    rest: &'a [u8],
    count: &'a AtomicUsize,
}

impl<'a> CountingLines<'a> {
    /// `count` is the number of lines handed out.
    pub(super) fn new(text: &'a str, count: &'a AtomicUsize) -> Self {
        Self {
            rest: text.as_bytes(),
            count,
        }
    }
}

impl Read for CountingLines<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.fill_buf()?.read(buffer)?;
        self.consume(read);
        Ok(read)
    }
}

impl BufRead for CountingLines<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        let end = self
            .rest
            .iter()
            .position(|&byte| byte == b'\n')
            .map_or(self.rest.len(), |at| at + 1);
        Ok(&self.rest[..end])
    }

    fn consume(&mut self, amount: usize) {
        if amount > 0 && self.rest.get(amount - 1) == Some(&b'\n') {
            self.count.fetch_add(1, Ordering::Relaxed);
        }
        self.rest = &self.rest[amount..];
    }
}
