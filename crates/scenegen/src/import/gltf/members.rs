//! The members of a material's JSON: numbers forced into their ranges, textures registered.

use std::ops::RangeInclusive;

use gltf::json::material::NormalTexture;
use gltf::json::texture::Info;

use super::texture_reference::TextureReference;
use super::textures::Textures;
use super::uv_sets::UvSets;
use crate::desc::TextureUse;
use crate::import::error::Fault;
use crate::import::images::ImageRole;
use crate::import::warnings::Warnings;

/// Takes members of one material, each by its name for messages.
pub(super) struct Members<'r, 'a> {
    /// Where textures are registered.
    pub(super) textures: &'r mut Textures<'a>,
    /// The sets of texture coordinates that they read.
    pub(super) uv_sets: UvSets,
    /// What is said about members that cannot be taken as they are.
    pub(super) warnings: &'r mut Warnings,
    /// The material's JSON path.
    pub(super) place: String,
}

impl Members<'_, '_> {
    /// Warns about the material.
    pub(super) fn warn(&mut self, message: impl Into<String>) {
        self.warnings.push(&*self.place, message);
    }

    /// A texture of factors; `None` where there is none or it cannot be read, after a warning.
    pub(super) fn texture(
        &mut self,
        member: &str,
        info: Option<&Info>,
    ) -> Result<Option<TextureUse>, Fault> {
        let Some(info) = info else { return Ok(None) };
        let at = format!("{}/{member}", self.place);
        self.textures.add(
            info.into(),
            ImageRole::Factors,
            &at,
            &mut self.uv_sets,
            self.warnings,
        )
    }

    /// A texture whose alpha is glossiness, as one whose green is roughness: 1 − `factor` · alpha.
    pub(super) fn roughness_texture(
        &mut self,
        member: &str,
        info: Option<&Info>,
        factor: f32,
    ) -> Result<Option<TextureUse>, Fault> {
        let Some(info) = info else { return Ok(None) };
        let at = format!("{}/{member}", self.place);
        let role = ImageRole::Glossiness { factor };
        self.textures
            .add(info.into(), role, &at, &mut self.uv_sets, self.warnings)
    }

    /// The texture of a normal map, likewise.
    pub(super) fn normal_texture(
        &mut self,
        member: &str,
        texture: &NormalTexture,
    ) -> Result<Option<TextureUse>, Fault> {
        let at = format!("{}/{member}", self.place);
        let reference = TextureReference::to_normals(texture, &at)?;
        self.textures.add(
            reference,
            ImageRole::Normals,
            &at,
            &mut self.uv_sets,
            self.warnings,
        )
    }

    /// A number forced into its range; `default` stands in for NaN, and the like, with a warning.
    pub(super) fn number(
        &mut self,
        member: &str,
        value: f32,
        range: RangeInclusive<f32>,
        default: f32,
    ) -> f32 {
        if range.contains(&value) {
            return value;
        }
        let used = if value.is_nan() {
            default
        } else {
            value.clamp(*range.start(), *range.end())
        };
        let used = if used.abs() == f32::MAX {
            default
        } else {
            used
        };
        self.warn(format!("{member} {value} is out of range; {used} is used"));
        used
    }

    /// A colour, each component as a number.
    pub(super) fn color(
        &mut self,
        member: &str,
        values: [f32; 3],
        range: RangeInclusive<f32>,
        default: f32,
    ) -> [f32; 3] {
        values.map(|value| self.number(member, value, range.clone(), default))
    }
}
