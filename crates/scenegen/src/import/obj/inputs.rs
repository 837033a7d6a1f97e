//! Inputs of materials: numbers, colours and directions with their textures.

use super::map_statement::MapStatement;
use super::statements::Statements;
use super::textures::Textures;
use crate::desc::{ColorInput, NormalMap, ScalarInput, TextureUse, Wrap};
use crate::import::images::{ImageRole, ScalarMap, ScalarSource};

/// What larger values become, of which products and squares would be infinite; the largest radiance of images.
const LARGEST_COLOR: f32 = 1e30;

/// Reads the inputs of one material.
pub(super) struct Inputs<'r, 'a> {
    /// What it says.
    pub(super) statements: Statements<'r>,
    /// Those of all materials.
    pub(super) textures: &'r mut Textures<'a>,
}

/// A map beside a value of 0: around an image that is there once, there is nothing.
fn before_black(map: MapStatement) -> MapStatement {
    let wrap = match map.wrap {
        Wrap::WhiteBorder => Wrap::BlackBorder,
        wrap => wrap,
    };
    MapStatement { wrap, ..map }
}

/// What black is that stands beside a texture.
#[derive(Clone, Copy)]
pub(super) enum BlackBesideMap {
    /// What programs write that know the texture only: the texture counts.
    Nothing,
    /// Black.
    Black,
}

impl Inputs<'_, '_> {
    /// A colour and its texture; without a colour, 1 where there is a texture and `default` elsewhere.
    pub(super) fn color(
        &mut self,
        key: &'static str,
        map_key: &'static str,
        default: f32,
        black: BlackBesideMap,
    ) -> ColorInput {
        let map = self.statements.map(map_key, ImageRole::Factors);
        let ignored = [
            (
                "imfchan",
                map.as_ref().is_some_and(|map| map.source.is_some()),
            ),
            // It would have to be added to every texel.
            ("mm", map.as_ref().is_some_and(|map| map.base != 0.0)),
        ];
        for (option, _) in ignored.into_iter().filter(|(_, is_there)| *is_there) {
            let message = format!("-{option} of {map_key} is ignored");
            self.statements.warn(message);
        }
        let gain = match &map {
            Some(map) if map.base == 0.0 => map.gain,
            _ => 1.0,
        };
        let mut given = self.statements.color(key);
        let texture = map.map(|map| {
            let map = match given.unwrap_or([default; 3]) {
                [0.0, 0.0, 0.0] => before_black(map),
                _ => map,
            };
            self.textures
                .add(&map, ImageRole::Factors, &mut self.statements)
        });
        if texture.is_some() && given == Some([0.0; 3]) {
            self.statements.warn(match black {
                BlackBesideMap::Nothing => {
                    given = None;
                    format!("{key} 0 would make {map_key} black; 1 is used")
                }
                BlackBesideMap::Black => format!("{map_key} has no effect, as {key} is 0"),
            });
        }
        let default = if texture.is_some() { 1.0 } else { default };
        let factor = given.unwrap_or([default; 3]).map(|value| value * gain);
        if factor.iter().any(|&value| value < 0.0) {
            self.statements
                .warn(format!("{key} has negative values; 0 is used"));
        }
        if factor.iter().any(|&value| value > LARGEST_COLOR) {
            let message = format!("{key} has values beyond {LARGEST_COLOR}, which is used");
            self.statements.warn(message);
        }
        ColorInput {
            factor: factor.map(|value| value.clamp(0.0, LARGEST_COLOR)),
            texture,
        }
    }

    /// A number from 0 to 1.
    pub(super) fn fraction(&mut self, key: &'static str) -> Option<f32> {
        let value = self.statements.number(key)?;
        if !(0.0..=1.0).contains(&value) {
            self.statements
                .warn(format!("{key} {value} is outside of 0 to 1 and clamped"));
        }
        Some(value.clamp(0.0, 1.0))
    }

    /// The same with a texture; without a number, 1 where there is a texture and `default` elsewhere.
    pub(super) fn fraction_input(
        &mut self,
        key: &'static str,
        map_key: &'static str,
        default: f32,
    ) -> ScalarInput {
        let given = self.fraction(key);
        let texture = match given.unwrap_or(default) {
            0.0 => self.scalar_map(map_key, before_black),
            _ => self.scalar_map(map_key, |map| map),
        };
        let default = if texture.is_some() { 1.0 } else { default };
        let factor = given.unwrap_or(default);
        ScalarInput { factor, texture }
    }

    /// A colour without values outside of 0 to 1.
    pub(super) fn at_most_1(&mut self, key: &str, color: [f32; 3]) -> [f32; 3] {
        let clamped = color.map(|value| value.clamp(0.0, 1.0));
        if clamped != color {
            self.statements.warn(format!(
                "{key} has values outside of 0 to 1, which are clamped"
            ));
        }
        clamped
    }

    /// A texture with the channel that is read, of a statement as it is changed.
    pub(super) fn scalar_map(
        &mut self,
        key: &'static str,
        change: fn(MapStatement) -> MapStatement,
    ) -> Option<(TextureUse, usize)> {
        let map = change(self.statements.map(key, ImageRole::Factors)?);
        let source = map.source.unwrap_or(ScalarSource::Channel(0));
        Some(self.scalar_texture(&map, source))
    }

    /// `map_d`. Masks are grey images, except where the colour's own alpha is meant or the image has one.
    pub(super) fn alpha_map(&mut self) -> Option<(TextureUse, usize)> {
        let mut map = self.statements.map("map_d", ImageRole::Factors)?;
        if self.statements.number("d") == Some(0.0) {
            map = before_black(map);
        }
        let source = match map.source {
            Some(source) => source,
            None if self.statements.name_one_file("map_d", "map_kd") => ScalarSource::Channel(3),
            None if self.textures.look_at(&map, &self.statements).has_alpha => {
                ScalarSource::Channel(3)
            }
            None => ScalarSource::Channel(0),
        };
        Some(self.scalar_texture(&map, source))
    }

    /// A channel of the image, or of another one that is made of it.
    fn scalar_texture(&mut self, map: &MapStatement, source: ScalarSource) -> (TextureUse, usize) {
        let scalars = ScalarMap {
            source,
            base: map.base,
            gain: map.gain,
        };
        let (role, channel) = match scalars.channel() {
            Some(channel) => (ImageRole::Factors, channel),
            None => (ImageRole::Scalars(scalars), 0),
        };
        (self.textures.add(map, role, &mut self.statements), channel)
    }

    /// `norm`, or a bump map that is a map of normals, as some programs write them.
    pub(super) fn normal_map(&mut self) -> Option<NormalMap> {
        let keys = ["norm", "map_bump", "bump"];
        let key = keys.into_iter().find(|key| self.statements.has(key))?;
        let map = self.statements.map(key, ImageRole::Normals)?;
        if key != "norm" && !self.textures.look_at(&map, &self.statements).are_directions {
            self.statements
                .warn(format!("{key}: height maps are not supported and ignored"));
            return None;
        }
        Some(NormalMap {
            texture: self
                .textures
                .add(&map, ImageRole::Normals, &mut self.statements),
            scale: map.bump_scale.unwrap_or(1.0),
        })
    }
}
