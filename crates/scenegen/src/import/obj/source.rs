//! OBJ text made fit for tobj, line by line, so that its errors can be placed.
//!
//! tobj rejects a whole file for a comment behind a face or a colour with two numbers, turns polylines into
//! triangles and misaligns colours where only some vertices have them. This pass removes those cases, and
//! keeps the number of lines.

use std::io::{self, BufRead, Read};
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::import::error::{Fault, Warnings};

/// Cleaned text, with what the materials pass wants to know.
pub(super) struct ObjSource {
    /// As many lines as the file.
    pub(super) text: String,
    /// Each `usemtl`'s line and name.
    pub(super) used_materials: Vec<(usize, String)>,
}

/// Cleans a file's text; faces that refer to what is not there are errors.
pub(super) fn clean(bytes: &[u8], warnings: &mut Warnings) -> Result<ObjSource, Fault> {
    let raw = String::from_utf8_lossy(bytes);
    let has_uniform_colors = has_uniform_colors(&raw);
    let mut source = ObjSource {
        text: String::with_capacity(raw.len()),
        used_materials: Vec::new(),
    };
    let (mut points_and_lines, mut short_faces) = (0_usize, 0_usize);
    let mut continued = String::new();
    let mut references = References::default();
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
                references.note(keyword, &words, index)?;
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
    references.check(warnings)?;
    Ok(source)
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

/// Checks faces' indices, with their lines, which tobj does late and with arithmetic that overflows.
#[derive(Default)]
struct References {
    /// Positions, texture coordinates and normals so far.
    counts: [usize; 3],
    /// The largest index to each of them, counted from 1, and its line.
    largest: [(usize, usize); 3],
}

const REFERENCED: [&str; 3] = ["v", "vt", "vn"];

impl References {
    fn note(&mut self, keyword: &str, words: &[&str], line: usize) -> Result<(), Fault> {
        if let Some(kind) = REFERENCED
            .iter()
            .position(|&referenced| referenced == keyword)
        {
            self.counts[kind] += 1;
            return Ok(());
        }
        for corner in words {
            for (kind, text) in corner
                .split('/')
                .enumerate()
                .take(3)
                .filter(|(_, text)| !text.is_empty())
            {
                let index: i64 = text
                    .parse()
                    .map_err(|_| at_line(line, format!("\"{text}\" in a face is not an index")))?;
                let count = self.counts[kind];
                // Positive ones may refer to what follows; negative ones count back from here.
                let absolute = if index < 0 {
                    index.saturating_add_unsigned(count as u64) + 1
                } else {
                    index
                };
                if absolute < 1 {
                    return Err(out_of_range(line, index, kind, count));
                }
                self.largest[kind] = self.largest[kind].max((absolute as usize, line));
            }
        }
        Ok(())
    }

    fn check(&self, warnings: &mut Warnings) -> Result<(), Fault> {
        for (kind, &(index, line)) in self.largest.iter().enumerate() {
            if kind > 0 && index > 0 && self.counts[kind] == 0 {
                // Some exporters leave out the attribute and keep the indices.
                let message = format!(
                    "faces refer to {}, of which there are none",
                    REFERENCED[kind]
                );
                warnings.push(line_place(line), message);
            } else if index > self.counts[kind] {
                return Err(out_of_range(line, index as i64, kind, self.counts[kind]));
            }
        }
        Ok(())
    }
}

fn out_of_range(line: usize, index: i64, kind: usize, count: usize) -> Fault {
    at_line(
        line,
        format!(
            "a face refers to {} {index}, but there are {count}",
            REFERENCED[kind]
        ),
    )
}

fn at_line(line: usize, problem: String) -> Fault {
    Fault::new(line_place(line), problem).advise(REPAIR_LINE)
}

/// Advice for a line that makes no sense.
pub(super) const REPAIR_LINE: &str = "repair that line or export the file again";

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
