//! Members of an extension that is left as JSON, each by its name.

use std::ops::RangeInclusive;

use gltf::json::deserialize;
use gltf::json::material::NormalTexture;
use gltf::json::texture::Info;
use serde_json::{Map, Value};

use super::members::Members;
use crate::desc::{ColorInput, NormalMap, ScalarInput, TextureUse};
use crate::import::error::Fault;

/// The members of an extension of a material.
pub(super) struct ExtensionMembers<'a> {
    /// The extension's name.
    name: &'static str,
    content: &'a Map<String, Value>,
}

/// The values that a number may have, and what it is where the file says nothing.
type Range = (RangeInclusive<f32>, f32);

impl<'a> ExtensionMembers<'a> {
    /// Those of an extension, if the material has it.
    pub(super) fn of(extensions: &'a Map<String, Value>, name: &'static str) -> Option<Self> {
        let content = extensions.get(name)?.as_object()?;
        Some(Self { name, content })
    }

    /// A number.
    pub(super) fn number(
        &self,
        members: &mut Members<'_, '_>,
        member: &str,
        (range, default): Range,
    ) -> f32 {
        match self.content.get(member) {
            None => default,
            Some(value) => match value.as_f64() {
                Some(value) => members.number(member, value as f32, range, default),
                None => {
                    members.warn(format!("{member} is no number; {default} is used"));
                    default
                }
            },
        }
    }

    /// A factor with a texture, of which one channel is read.
    pub(super) fn scalar(
        &self,
        members: &mut Members<'_, '_>,
        [factor, texture]: [&str; 2],
        range: Range,
        channel: usize,
    ) -> Result<ScalarInput, Fault> {
        let factor = self.number(members, factor, range);
        let texture = self.texture(members, texture)?;
        Ok(ScalarInput {
            factor,
            texture: texture.map(|texture| (texture, channel)),
        })
    }

    /// A colour factor with a texture.
    pub(super) fn color(
        &self,
        members: &mut Members<'_, '_>,
        [factor, texture]: [&str; 2],
        default: [f32; 3],
    ) -> Result<ColorInput, Fault> {
        Ok(ColorInput {
            factor: self.factor(members, factor, default),
            texture: self.texture(members, texture)?,
        })
    }

    /// Whether a member is given.
    pub(super) fn has(&self, member: &str) -> bool {
        self.content.contains_key(member)
    }

    /// A colour without a texture.
    pub(super) fn factor(
        &self,
        members: &mut Members<'_, '_>,
        factor: &str,
        default: [f32; 3],
    ) -> [f32; 3] {
        let given = self.content.get(factor);
        let numbers = given.and_then(|value| {
            let [r, g, b] = value.as_array()?.as_slice() else {
                return None;
            };
            Some([r.as_f64()?, g.as_f64()?, b.as_f64()?].map(|c| c as f32))
        });
        if given.is_some() && numbers.is_none() {
            members.warn(format!("{factor} is no colour; {default:?} is used"));
        }
        let color = numbers.unwrap_or(default);
        members.color(factor, color, 0.0..=1.0, default[0])
    }

    /// A normal map.
    pub(super) fn normal_map(
        &self,
        members: &mut Members<'_, '_>,
        member: &str,
    ) -> Result<Option<NormalMap>, Fault> {
        let Some(json) = self.content.get(member) else {
            return Ok(None);
        };
        let texture: NormalTexture = deserialize::from_value(json.clone())
            .map_err(|error| self.fault(members, member, &error))?;
        let scale = members.number(member, texture.scale, f32::MIN..=f32::MAX, 1.0);
        let texture = members.normal_texture(member, &texture)?;
        Ok(texture.map(|texture| NormalMap { texture, scale }))
    }

    fn texture(
        &self,
        members: &mut Members<'_, '_>,
        member: &str,
    ) -> Result<Option<TextureUse>, Fault> {
        let Some(json) = self.content.get(member) else {
            return Ok(None);
        };
        let info: Info = deserialize::from_value(json.clone())
            .map_err(|error| self.fault(members, member, &error))?;
        members.texture(member, Some(&info))
    }

    fn fault(&self, members: &Members<'_, '_>, member: &str, error: &serde_json::Error) -> Fault {
        let place = format!("{}/extensions/{}/{member}", members.place, self.name);
        Fault::new(place, error.to_string())
    }
}
