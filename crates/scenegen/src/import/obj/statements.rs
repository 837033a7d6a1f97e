//! The statements of one MTL material as values.

use super::map_statement::MapStatement;
use super::mtl::MtlMaterial;
use crate::import::images::ImageRole;
use crate::import::warnings::Warnings;

/// Reads a material's statements. What cannot be used is warned about when it is asked for, so that nothing
/// is said about statements that the material does without.
pub(super) struct Statements<'r> {
    material: &'r MtlMaterial,
    /// Where the material stands.
    pub(super) place: String,
    warnings: &'r mut Warnings,
}

impl<'r> Statements<'r> {
    /// Those of a material.
    pub(super) fn new(material: &'r MtlMaterial, warnings: &'r mut Warnings) -> Self {
        Self {
            material,
            place: material.place(),
            warnings,
        }
    }

    /// What `newmtl` called the material.
    pub(super) fn name(&self) -> &'r str {
        &self.material.name
    }

    /// Warns about the material.
    pub(super) fn warn(&mut self, message: impl Into<String>) {
        self.warnings.push(&*self.place, message);
    }

    /// The first number of a statement.
    pub(super) fn number(&mut self, key: &str) -> Option<f32> {
        self.color(key).map(|[value, _, _]| value)
    }

    /// Up to three numbers; a single one stands for all three, as the specification says.
    pub(super) fn color(&mut self, key: &str) -> Option<[f32; 3]> {
        let text = self.material.statements.get(key)?;
        let text = text.split('#').next().unwrap_or_default();
        let words: Vec<&str> = text.split_whitespace().collect();
        // `-halo`, of `d -halo 0.5`, changes with the angle; the number is what remains.
        let words = words.strip_prefix(&["-halo"]).unwrap_or(&words);
        let numbers: Vec<f32> = words
            .iter()
            .take(3)
            .map_while(|word| word.parse().ok())
            .collect();
        let values = match numbers[..] {
            [r, g, b] => [r, g, b],
            [value, ..] => [value; 3],
            [] => {
                self.warn(format!("{key} \"{text}\" is not a number and ignored"));
                return None;
            }
        };
        if !values.iter().all(|value| value.is_finite()) {
            self.warn(format!("{key} \"{text}\" is not finite and ignored"));
            return None;
        }
        Some(values)
    }

    /// A texture's statement.
    pub(super) fn map(&mut self, key: &str, role: ImageRole) -> Option<MapStatement> {
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

    /// Warns about statements that ask for what is not rendered.
    pub(super) fn warn_about_unsupported(&mut self) {
        for key in self.material.statements.keys() {
            match key.as_str() {
                "map_bump" | "bump" => {
                    self.warn(format!("{key}: height maps are not supported and ignored"));
                }
                "disp" | "decal" | "refl" | "pr" | "pm" | "ps" | "pc" | "pcr" | "aniso"
                | "map_pr" | "map_pm" | "map_ps" | "map_tr" => {
                    self.warn(format!("{key} is not supported and ignored"));
                }
                _ => {}
            }
        }
    }
}
