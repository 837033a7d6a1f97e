//! MTL material libraries: which keyword stands on which line.
//!
//! Read here and not by another crate: those drop a whole library for one short line, have no line numbers and
//! know neither `Tf`, `Tr`, `norm` nor the options before a texture's name.

use std::collections::BTreeMap;
use std::path::PathBuf;

use super::lines::{line_place, statements};
use super::numbers;
use crate::import::warnings::Warnings;

/// A material as its lines say.
#[derive(Debug, Default)]
pub(super) struct MtlMaterial {
    /// What `newmtl` called it.
    pub(super) name: String,
    /// Library and line of `newmtl`.
    line: String,
    /// Where its textures are looked for first.
    pub(super) folder: PathBuf,
    /// Keyword in lower case → the rest of its last line.
    pub(super) statements: BTreeMap<String, String>,
    /// What `Tr` means in the library.
    pub(super) tr_meaning: TrMeaning,
}

/// What the number behind `Tr` is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum TrMeaning {
    /// 1 − `d`, as most programs have it.
    #[default]
    Transparency,
    /// `d`: programs that process scans write 1 for what is opaque.
    Opacity,
}

impl MtlMaterial {
    /// The material of faces without one.
    pub(super) fn grey() -> Self {
        Self {
            name: "default".into(),
            ..Self::default()
        }
    }

    /// The same where vertices have colours, which it leaves as they are.
    pub(super) fn white() -> Self {
        Self {
            statements: [("kd".into(), "1".into())].into(),
            ..Self::grey()
        }
    }

    /// Where it stands, for messages.
    pub(super) fn place(&self) -> String {
        format!("{} \"{}\"", self.line, self.name.escape_debug())
    }

    /// `Tr`, where `d` does not say how opaque the material is.
    fn lone_tr(&self) -> Option<f32> {
        let has_d = self.statements.contains_key("d");
        let tr = self.statements.get("tr").filter(|_| !has_d)?;
        numbers::parse(tr.split_whitespace().next()?)
    }
}

/// Reads a library's text; `library` is its name for messages, `folder` where it lies.
pub(super) fn parse(
    text: &str,
    library: &str,
    folder: &std::path::Path,
    warnings: &mut Warnings,
) -> Vec<MtlMaterial> {
    let mut materials: Vec<MtlMaterial> = Vec::new();
    for statement in statements(text) {
        let (keyword, rest) = statement.split();
        let place = || format!("{library} {}", line_place(statement.line));
        if keyword == "newmtl" {
            if rest.is_empty() {
                warnings.push(place(), "newmtl without a name");
            }
            materials.push(MtlMaterial {
                name: rest.to_owned(),
                line: place(),
                folder: folder.to_owned(),
                ..MtlMaterial::default()
            });
        } else if let Some(material) = materials.last_mut() {
            let previous = material
                .statements
                .insert(keyword.to_string(), rest.to_owned());
            if previous.is_some_and(|previous| previous != rest) {
                warnings.push(
                    place(),
                    format!("{keyword} stands there again; the last one counts"),
                );
            }
        } else {
            warnings.push(
                place(),
                format!("{keyword} before the first newmtl is ignored"),
            );
        }
    }
    let has_tr = |value| {
        materials
            .iter()
            .any(|material| material.lone_tr() == Some(value))
    };
    if has_tr(1.0) && !has_tr(0.0) {
        for material in &mut materials {
            material.tr_meaning = TrMeaning::Opacity;
        }
    }
    materials
}
