//! MTL material libraries: which keyword stands on which line.
//!
//! Read here and not by tobj, which drops a whole library for one short line, has no line numbers and knows
//! neither `Tf`, `Tr`, `norm` nor the options before a texture's name.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::find::find_loosely;
use super::lines::{line_place, split_keyword};
use crate::import::files;
use crate::import::warnings::Warnings;

/// A material as its lines say.
#[derive(Debug, Default)]
pub(super) struct MtlMaterial {
    /// What `newmtl` called it.
    pub(super) name: String,
    /// Library and line of `newmtl`.
    line: String,
    /// Keyword in lower case → the rest of its last line.
    pub(super) statements: BTreeMap<String, String>,
}

impl MtlMaterial {
    /// The material that no library has.
    pub(super) fn unnamed() -> Self {
        Self {
            name: "default".into(),
            ..Self::default()
        }
    }

    /// Where it stands, for messages.
    pub(super) fn place(&self) -> String {
        format!("{} \"{}\"", self.line, self.name.escape_debug())
    }
}

/// Loads the libraries named by one `mtllib` line; those that are missing are warned about.
pub(super) fn load(
    names: &str,
    folder: &Path,
    place: &str,
    warnings: &mut Warnings,
) -> Vec<MtlMaterial> {
    // The specification separates several libraries by spaces, while exporters write names with spaces.
    let paths: Vec<(String, Option<PathBuf>)> = match find_loosely(names, folder) {
        Some(path) => vec![(names.to_owned(), Some(path))],
        None => names
            .split_whitespace()
            .map(|name| (name.to_owned(), find_loosely(name, folder)))
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
        let place = || format!("{library} {}", line_place(index));
        if keyword.eq_ignore_ascii_case("newmtl") {
            if rest.is_empty() {
                warnings.push(place(), "newmtl without a name");
            }
            materials.push(MtlMaterial {
                name: rest.to_owned(),
                line: place(),
                statements: BTreeMap::new(),
            });
        } else if let Some(material) = materials[start..].last_mut() {
            material
                .statements
                .insert(keyword.to_ascii_lowercase(), rest.to_owned());
        } else {
            warnings.push(
                place(),
                format!("{keyword} before the first newmtl is ignored"),
            );
        }
    }
}
