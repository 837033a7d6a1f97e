//! The statements of one MTL material as values.

use std::collections::BTreeSet;

use super::lines::words;
use super::map_statement::MapStatement;
use super::mtl::{MtlMaterial, TrMeaning};
use super::numbers;
use crate::import::images::ImageRole;
use crate::import::warnings::Warnings;

/// Statements that nothing rendered depends on: ambient light, which global illumination replaces, and the sharpness
/// of reflection maps. `Ni` belongs to glass, and is written for every material.
const WITHOUT_EFFECT: [&str; 5] = ["ka", "illum", "sharpness", "map_aat", "ni"];

/// Reads a material's statements. What cannot be used is warned about when it is asked for, and what nobody has asked
/// for in [`Self::warn_about_unread`].
pub(super) struct Statements<'r> {
    material: &'r MtlMaterial,
    /// Where the material stands.
    pub(super) place: String,
    read: BTreeSet<&'static str>,
    warnings: &'r mut Warnings,
}

impl<'r> Statements<'r> {
    /// Those of a material.
    pub(super) fn new(material: &'r MtlMaterial, warnings: &'r mut Warnings) -> Self {
        Self {
            material,
            place: material.place(),
            read: WITHOUT_EFFECT.into(),
            warnings,
        }
    }

    /// The material.
    pub(super) fn material(&self) -> &'r MtlMaterial {
        self.material
    }

    /// What `Tr` means.
    pub(super) fn tr_meaning(&self) -> TrMeaning {
        self.material.tr_meaning
    }

    /// Warns about the material.
    pub(super) fn warn(&mut self, message: impl Into<String>) {
        self.warnings.push(&*self.place, message);
    }

    /// Whether there is a statement.
    pub(super) fn has(&self, key: &str) -> bool {
        self.material.statements.contains_key(key)
    }

    /// The first number of a statement.
    pub(super) fn number(&mut self, key: &'static str) -> Option<f32> {
        self.color(key).map(|[value, _, _]| value)
    }

    /// Up to three numbers; a single one stands for all three, as the specification says. `xyz` before them makes them
    /// CIE colours.
    pub(super) fn color(&mut self, key: &'static str) -> Option<[f32; 3]> {
        self.read.insert(key);
        let text = self.material.statements.get(key)?;
        let words: Vec<&str> = words(text).collect();
        let (option, words) = match words[..] {
            [option @ ("-halo" | "xyz" | "spectral"), ref words @ ..] => (option, words),
            _ => ("", &words[..]),
        };
        match option {
            "-halo" => self.warn(format!("-halo of {key} is ignored")),
            "spectral" => {
                self.warn(format!(
                    "{key} \"{text}\" is a file of spectra, which are not read; it is ignored"
                ));
                return None;
            }
            _ => {}
        }
        let numbers: Vec<Option<f32>> = words
            .iter()
            .take(3)
            .map(|word| numbers::parse(word))
            .collect();
        let values = match numbers[..] {
            [Some(r), Some(g), Some(b)] => [r, g, b],
            [Some(r), Some(g)] => {
                self.warn(format!(
                    "{key} \"{text}\" lacks a third number; the second is used"
                ));
                [r, g, g]
            }
            [Some(value)] => [value; 3],
            _ => {
                self.warn(format!("{key} \"{text}\" is not a number and ignored"));
                return None;
            }
        };
        Some(match option {
            "xyz" => from_xyz(values),
            _ => values,
        })
    }

    /// A texture's statement.
    pub(super) fn map(&mut self, key: &'static str, role: ImageRole) -> Option<MapStatement> {
        self.read.insert(key);
        let map = MapStatement::parse(self.material.statements.get(key)?);
        if map.file.is_empty() {
            self.warn(format!("{key} names no file"));
            return None;
        }
        let mut ignored = map.others.clone();
        if map.bump_scale.is_some() && role != ImageRole::Normals {
            ignored.insert("bm".into());
        }
        for option in ignored {
            self.warn(format!("-{option} of {key} is ignored"));
        }
        Some(map)
    }

    /// Whether two statements name the same file.
    pub(super) fn name_one_file(&self, key: &str, other: &str) -> bool {
        let file = |key| {
            let statement = self.material.statements.get(key)?;
            Some(MapStatement::parse(statement).file)
        };
        file(key) == file(other)
    }

    /// Says nothing about statements that another one makes void.
    pub(super) fn dismiss(&mut self, keys: &[&'static str]) {
        self.read.extend(keys);
    }

    /// Warns about the statements that have no part in what is rendered.
    pub(super) fn warn_about_unread(&mut self) {
        if self.name_one_file("map_ka", "map_kd") {
            self.read.insert("map_ka");
        }
        let keys = self.material.statements.keys().map(String::as_str);
        let unread: Vec<&str> = keys.filter(|key| !self.read.contains(key)).collect();
        if !unread.is_empty() {
            let message = format!("not rendered and ignored: {}", unread.join(", "));
            self.warn(message);
        }
    }
}

/// CIE XYZ with white D65 as linear Rec. 709 (IEC 61966-2-1).
fn from_xyz([x, y, z]: [f32; 3]) -> [f32; 3] {
    [
        3.240_97 * x - 1.537_383_2 * y - 0.498_610_76 * z,
        -0.969_243_6 * x + 1.875_967_5 * y + 0.041_555_06 * z,
        0.055_630_08 * x - 0.203_976_96 * y + 1.056_971_5 * z,
    ]
}
