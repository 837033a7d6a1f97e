//! MTL material libraries: which keyword stands on which line.
//!
//! Read here and not by tobj, which drops a whole library for one short line, has no line numbers and knows
//! neither `Tf`, `Tr`, `norm` nor the options before a texture's name.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::source::split_keyword;
use crate::import::error::Warnings;
use crate::import::files;

/// A material as its lines say.
#[derive(Debug, Default)]
pub(super) struct MtlMaterial {
    /// What `newmtl` called it.
    pub(super) name: String,
    /// Library and line, for messages.
    pub(super) place: String,
    /// Keyword in lower case → the rest of its last line.
    pub(super) entries: BTreeMap<String, String>,
}

/// A texture's file and the options before it.
#[derive(Debug, PartialEq)]
pub(super) struct MapStatement {
    /// File name as written; may have spaces.
    pub(super) file: String,
    /// Options by name, without the dash, and their arguments.
    pub(super) options: BTreeMap<String, Vec<String>>,
}

/// Loads the libraries named by one `mtllib` line; those that are missing are warned about.
pub(super) fn load(
    names: &str,
    folder: &Path,
    place: &str,
    warnings: &mut Warnings,
) -> Vec<MtlMaterial> {
    // The specification separates several libraries by spaces, while exporters write names with spaces.
    let paths: Vec<(String, Option<PathBuf>)> = match files::find_loosely(names, folder) {
        Some(path) => vec![(names.to_owned(), Some(path))],
        None => names
            .split_whitespace()
            .map(|name| (name.to_owned(), files::find_loosely(name, folder)))
            .collect(),
    };
    let mut materials = Vec::new();
    for (name, path) in paths {
        let read = path
            .ok_or("is not there".to_owned())
            .and_then(|path| files::read(&path));
        match read {
            Ok(bytes) => parse(
                &String::from_utf8_lossy(&bytes),
                &name,
                &mut materials,
                warnings,
            ),
            Err(problem) => warnings.push(
                place,
                format!("material library \"{name}\" {problem}; left out"),
            ),
        }
    }
    materials
}

fn parse(text: &str, library: &str, materials: &mut Vec<MtlMaterial>, warnings: &mut Warnings) {
    let start = materials.len();
    for (index, line) in text.lines().enumerate() {
        let (keyword, rest) = split_keyword(line);
        if keyword.is_empty() || keyword.starts_with('#') {
            continue;
        }
        let place = || format!("{library} line {}", index + 1);
        if keyword.eq_ignore_ascii_case("newmtl") {
            if rest.is_empty() {
                warnings.push(place(), "newmtl without a name");
            }
            materials.push(MtlMaterial {
                name: rest.to_owned(),
                place: place(),
                entries: BTreeMap::new(),
            });
        } else if let Some(material) = materials[start..].last_mut() {
            material
                .entries
                .insert(keyword.to_ascii_lowercase(), rest.to_owned());
        } else {
            warnings.push(
                place(),
                format!("{keyword} before the first newmtl is ignored"),
            );
        }
    }
}

/// Splits `-option argument… file name`.
pub(super) fn parse_map(statement: &str) -> MapStatement {
    let mut options = BTreeMap::new();
    let mut rest = statement.trim();
    while let Some(dashed) = rest.strip_prefix('-') {
        let (name, mut after) = split_keyword(dashed);
        let (least, most) = match name {
            "o" | "s" | "t" => (1, 3),
            "mm" => (2, 2),
            "blendu" | "blendv" | "bm" | "boost" | "cc" | "clamp" | "colorspace" | "imfchan"
            | "texres" | "type" => (1, 1),
            // Not an option: a file whose name starts with a dash.
            _ => break,
        };
        let mut arguments = Vec::new();
        while arguments.len() < most {
            let (argument, remainder) = split_keyword(after);
            // The second and third number may be missing, and the file's name comes next.
            if arguments.len() >= least && argument.parse::<f32>().is_err() {
                break;
            }
            arguments.push(argument.to_owned());
            after = remainder;
        }
        options.insert(name.to_owned(), arguments);
        rest = after;
    }
    MapStatement {
        file: rest.trim().to_owned(),
        options,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_told_from_file_names() {
        let map = parse_map("-s 2 3 -clamp on -bm 0.5 -o 0.25 my texture 1.png");
        assert_eq!(map.file, "my texture 1.png");
        assert_eq!(map.options["s"], ["2", "3"]);
        assert_eq!(map.options["clamp"], ["on"]);
        assert_eq!(map.options["bm"], ["0.5"]);
        assert_eq!(map.options["o"], ["0.25"]);
        assert_eq!(parse_map("-dash.png").file, "-dash.png");
        assert_eq!(parse_map("tex\\a b.png").file, "tex\\a b.png");
        assert_eq!(parse_map("-s").file, "");
    }
}
