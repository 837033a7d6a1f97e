//! OBJ text made fit for tobj, line by line, so that its errors can be placed.
//!
//! tobj rejects a whole file for a comment behind a face or a colour with two numbers, turns polylines into
//! triangles and misaligns colours where only some vertices have them. This pass removes those cases, and
//! keeps the number of lines.

use super::lines::{line_place, split_keyword, words};
use super::references::{Attribute, References};
use crate::import::error::Fault;
use crate::import::warnings::Warnings;

/// Cleaned text, with what is checked once the material libraries are known.
pub(super) struct ObjSource {
    /// As many lines as the file.
    pub(super) text: String,
    /// Index of the line and name of each `usemtl`.
    pub(super) used_materials: Vec<(usize, String)>,
}

/// Which numbers behind `v` are its colour: tobj misaligns colours unless every vertex has one.
#[derive(Clone, Copy)]
enum VertexColors {
    /// The fourth to the sixth, as every vertex has six.
    Kept,
    /// None are kept.
    Dropped,
}

/// Cleans a file's text; faces that refer to what is not there are errors.
pub(super) fn clean(bytes: &[u8], warnings: &mut Warnings) -> Result<ObjSource, Fault> {
    let raw = String::from_utf8_lossy(bytes);
    let colors = vertex_colors(&raw);
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
        match (Attribute::defined_by(keyword), keyword) {
            (Some(attribute), _) => {
                references.define(attribute);
                push_attribute(&mut source.text, attribute, rest, colors);
            }
            (None, "f") => {
                let corners: Vec<&str> = words(rest).collect();
                references.refer(&corners, index)?;
                if corners.len() < 3 {
                    short_faces += 1;
                } else {
                    push_statement(&mut source.text, keyword, corners);
                }
            }
            (None, "p" | "l") => points_and_lines += 1,
            (None, "usemtl") if rest.is_empty() => {
                warnings.push(line_place(index), "usemtl without a name is ignored")
            }
            (None, "usemtl") => {
                source.used_materials.push((index, rest.to_owned()));
                push_statement(&mut source.text, keyword, [rest]);
            }
            (None, "o" | "g" | "mtllib") => push_statement(&mut source.text, keyword, [rest]),
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

/// Writes the numbers of an attribute that tobj understands.
fn push_attribute(text: &mut String, attribute: Attribute, rest: &str, colors: VertexColors) {
    let numbers: Vec<&str> = words(rest).collect();
    let kept = match (attribute, numbers.len(), colors) {
        (Attribute::Position, 6, VertexColors::Kept) => 6,
        // The fourth number is a weight.
        (Attribute::Position, 4, _) => 4,
        (Attribute::Position | Attribute::Normal, _, _) => 3,
        (Attribute::TextureCoordinate, _, _) => 2,
    };
    let has_only_u = matches!(attribute, Attribute::TextureCoordinate) && numbers.len() == 1;
    push_statement(text, attribute.keyword(), numbers.into_iter().take(kept));
    if has_only_u {
        text.push_str(" 0");
    }
}

fn push_statement<'a>(text: &mut String, keyword: &str, words: impl IntoIterator<Item = &'a str>) {
    text.push_str(keyword);
    for word in words {
        text.push(' ');
        text.push_str(word);
    }
}

/// Looks whether all vertices have a colour: six numbers behind `v`.
fn vertex_colors(text: &str) -> VertexColors {
    let mut vertices = text
        .lines()
        .map(split_keyword)
        .filter(|(keyword, _)| *keyword == "v");
    if vertices.all(|(_, rest)| words(rest).count() == 6) {
        VertexColors::Kept
    } else {
        VertexColors::Dropped
    }
}
