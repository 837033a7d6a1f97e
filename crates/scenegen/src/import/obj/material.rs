//! One MTL material: its statements as a description.

use super::statements::Statements;
use super::textures::Textures;
use crate::desc::{
    AlphaMode, ColorInput, MaterialDesc, NormalMap, PhongSurface, ScalarInput, SurfaceDesc,
    TextureUse,
};
use crate::import::images::ImageRole;

/// Reflectance where a file gives none.
const GREY: f32 = 0.8;

/// The index of refraction where a file gives none.
const DEFAULT_IOR: f32 = 1.5;

/// What the number behind `illum` asks for.
#[derive(Clone, Copy, PartialEq)]
enum Illumination {
    /// 0 and 1.
    Diffuse,
    /// 2, and those whose difference from it is not rendered.
    Highlight,
    /// 3, 5 and 8, "reflection on".
    Reflection,
    /// 4, "transparency: glass".
    Glass,
    /// 6, 7 and 9.
    Refraction,
}

impl Illumination {
    fn new(illum: f32) -> Self {
        if illum < 2.0 {
            Self::Diffuse
        } else if [3.0, 5.0, 8.0].contains(&illum) {
            Self::Reflection
        } else if illum == 4.0 {
            Self::Glass
        } else if [6.0, 7.0, 9.0].contains(&illum) {
            Self::Refraction
        } else {
            Self::Highlight
        }
    }
}

/// Reads a material.
pub(super) fn read(statements: Statements<'_>, textures: &mut Textures<'_>) -> MaterialDesc {
    let reader = Reader {
        statements,
        textures,
    };
    reader.material()
}

struct Reader<'r, 'a> {
    statements: Statements<'r>,
    textures: &'r mut Textures<'a>,
}

impl Reader<'_, '_> {
    fn material(mut self) -> MaterialDesc {
        let illumination = Illumination::new(self.statements.number("illum").unwrap_or(2.0));
        let diffuse = self.color("kd", "map_kd", GREY);
        let emission = self.color("ke", "map_ke", 0.0);
        let alpha_map = self.scalar_map("map_d");
        let opacity = self.opacity();
        let ior = self.statements.number("ni");

        let refracts = ior.is_some_and(|ior| ior > 1.0);
        let is_glass = match illumination {
            // Maya and others write `illum 4`, `Ni 1` and `d 1` for every opaque material.
            Illumination::Glass => opacity < 1.0 || refracts,
            Illumination::Refraction => true,
            Illumination::Diffuse | Illumination::Highlight | Illumination::Reflection => {
                opacity < 1.0 && refracts && alpha_map.is_none()
            }
        };
        let surface = if is_glass {
            SurfaceDesc::Dielectric {
                ior: self.valid_ior(ior),
                transmittance: self.statements.color("tf").unwrap_or([1.0; 3]),
            }
        } else if illumination == Illumination::Reflection {
            self.mirror(diffuse)
        } else {
            SurfaceDesc::Phong(self.phong(diffuse, illumination))
        };
        let (alpha_mode, alpha) = if is_glass {
            (AlphaMode::Opaque, constant(1.0))
        } else {
            self.alpha(opacity, alpha_map)
        };
        self.statements.warn_about_unsupported();
        MaterialDesc {
            name: self.statements.name().to_owned(),
            surface,
            emission,
            alpha_mode,
            alpha,
            normal_map: self.normal_map(),
            double_sided: true,
        }
    }

    fn phong(&mut self, diffuse: ColorInput, illumination: Illumination) -> PhongSurface {
        let specular = self.color("ks", "map_ks", 0.0);
        let black = ColorInput {
            factor: [0.0; 3],
            texture: None,
        };
        let texture = self.scalar_map("map_ns");
        let factor = self.statements.number("ns").unwrap_or(1.0).max(0.0);
        PhongSurface {
            diffuse,
            specular: match illumination {
                Illumination::Diffuse => black,
                _ => specular,
            },
            exponent: ScalarInput { factor, texture },
        }
    }

    /// What `Ks` is the colour of comes from the mirrored direction.
    fn mirror(&mut self, mut diffuse: ColorInput) -> SurfaceDesc {
        let mut reflectance = self.color("ks", "map_ks", 0.0);
        let sums = [0, 1, 2].map(|k| diffuse.factor[k] + reflectance.factor[k]);
        let largest = sums.into_iter().fold(0.0, f32::max);
        if largest > 1.0 {
            self.statements.warn(format!(
                "Kd and Ks reflect {largest} times what arrives; both are divided by that"
            ));
            for factor in [&mut diffuse.factor, &mut reflectance.factor] {
                *factor = factor.map(|value| value / largest);
            }
        }
        SurfaceDesc::Mirror {
            diffuse,
            reflectance,
        }
    }

    /// `d`, or 1 − `Tr` where there is only that.
    fn opacity(&mut self) -> f32 {
        let opacity = self.statements.number("d").or_else(|| {
            let transparency = self.statements.number("tr");
            transparency.map(|transparency| 1.0 - transparency)
        });
        opacity.unwrap_or(1.0).clamp(0.0, 1.0)
    }

    fn alpha(&self, opacity: f32, map: Option<(TextureUse, usize)>) -> (AlphaMode, ScalarInput) {
        let mode = if opacity < 1.0 || map.is_some() {
            AlphaMode::Blend
        } else {
            AlphaMode::Opaque
        };
        // Masks are grey images, except where the colour's own alpha is meant.
        let texture = map.map(|(texture, channel)| {
            let is_own_alpha = self.statements.name_one_file("map_d", "map_kd");
            (texture, if is_own_alpha { 3 } else { channel })
        });
        let alpha = ScalarInput {
            factor: opacity,
            texture,
        };
        (mode, alpha)
    }

    fn valid_ior(&mut self, ior: Option<f32>) -> f32 {
        match ior {
            Some(ior) if ior > 0.0 => ior,
            Some(ior) => {
                self.statements
                    .warn(format!("Ni {ior} is not positive; {DEFAULT_IOR} is used"));
                DEFAULT_IOR
            }
            None => DEFAULT_IOR,
        }
    }

    /// A colour and its texture; without a colour, 1 where there is a texture and `default` elsewhere.
    fn color(&mut self, key: &str, map_key: &str, default: f32) -> ColorInput {
        let map = self.statements.map(map_key, ImageRole::Factors);
        let texture = map.map(|map| {
            self.textures
                .add(&map, ImageRole::Factors, &self.statements.place)
        });
        let given = self.statements.color(key);
        if texture.is_some() && given == Some([0.0; 3]) {
            self.statements
                .warn(format!("{map_key} has no effect, as {key} is 0"));
        }
        let default = if texture.is_some() { 1.0 } else { default };
        let factor = given.unwrap_or([default; 3]);
        if factor.iter().any(|&value| value < 0.0) {
            self.statements
                .warn(format!("{key} has negative values; 0 is used"));
        }
        ColorInput {
            factor: factor.map(|value| value.max(0.0)),
            texture,
        }
    }

    /// A texture with the channel that is read.
    fn scalar_map(&mut self, key: &str) -> Option<(TextureUse, usize)> {
        let map = self.statements.map(key, ImageRole::Factors)?;
        let place = &self.statements.place;
        let texture = self.textures.add(&map, ImageRole::Factors, place);
        Some((texture, map.channel))
    }

    fn normal_map(&mut self) -> Option<NormalMap> {
        let map = self.statements.map("norm", ImageRole::Normals)?;
        let place = &self.statements.place;
        Some(NormalMap {
            texture: self.textures.add(&map, ImageRole::Normals, place),
            scale: map.bump_scale.unwrap_or(1.0),
        })
    }
}

fn constant(factor: f32) -> ScalarInput {
    ScalarInput {
        factor,
        texture: None,
    }
}
