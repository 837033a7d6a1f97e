//! glTF materials with the extensions that we render.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use gltf::json::material::AlphaMode as JsonAlphaMode;
use gltf::json::texture::Info;
use gltf::json::validation::Checked;
use gltf::json::{Index, Material};

use super::document::{Document, get};
use super::extensions;
use super::textures::{Reference, Textures};
use crate::desc::{
    AlphaMode, ColorInput, MaterialDesc, MetallicRoughness, NormalMap, ScalarInput, SurfaceDesc,
    TextureUse,
};
use crate::effect::Effect;
use crate::import::error::{Fault, Warnings, place};

/// Materials in use, in order of first use.
pub(super) struct Materials<'a> {
    document: &'a Document,
    /// Their textures.
    pub(super) textures: Textures<'a>,
    /// The materials.
    pub(super) list: Vec<MaterialDesc>,
    ids: BTreeMap<Option<usize>, usize>,
}

impl<'a> Materials<'a> {
    /// None yet.
    pub(super) fn new(document: &'a Document) -> Self {
        Self {
            document,
            textures: Textures::new(document),
            list: Vec::new(),
            ids: BTreeMap::new(),
        }
    }

    /// Says which materials and images of the file are not in use.
    pub(super) fn dismiss_unused(&self, warnings: &mut Warnings) {
        for (index, material) in self.document.root.materials.iter().enumerate() {
            if !self.ids.contains_key(&Some(index)) {
                let at = place("materials", index, material.name.as_deref());
                warnings.dismiss(None, at, "no mesh of the scene uses it");
            }
        }
        self.textures.dismiss_unused(warnings);
    }

    /// The index of a material in the scene; `None` is glTF's default material.
    pub(super) fn id(
        &mut self,
        index: Option<Index<Material>>,
        user: &str,
        warnings: &mut Warnings,
    ) -> Result<usize, Fault> {
        let key = index.map(|index| index.value());
        if let Some(&id) = self.ids.get(&key) {
            return Ok(id);
        }
        let default = Material::default();
        let (material, at, name) = match index {
            Some(index) => {
                let material = get(&self.document.root.materials, index, "materials", user)?;
                let at = place("materials", index.value(), material.name.as_deref());
                (
                    material,
                    at,
                    material
                        .name
                        .clone()
                        .unwrap_or_else(|| format!("material {}", index.value())),
                )
            }
            None => (&default, "materials/default".into(), "default".into()),
        };
        let reader = Reader {
            textures: &mut self.textures,
            warnings,
            at,
        };
        self.list.push(reader.material(material, name)?);
        self.ids.insert(key, self.list.len() - 1);
        Ok(self.list.len() - 1)
    }
}

/// Reads one material.
struct Reader<'r, 'a> {
    textures: &'r mut Textures<'a>,
    warnings: &'r mut Warnings,
    at: String,
}

impl Reader<'_, '_> {
    fn material(mut self, material: &Material, name: String) -> Result<MaterialDesc, Fault> {
        let extensions = material.extensions.clone().unwrap_or_default();
        extensions::warn_about_material(&extensions.others, &self.at, self.warnings);

        let pbr = &material.pbr_metallic_roughness;
        let base_texture = self.texture("baseColorTexture", pbr.base_color_texture.as_ref())?;
        let [red, green, blue, alpha] = pbr.base_color_factor.0;
        let base_color = ColorInput {
            factor: self.color("baseColorFactor", [red, green, blue], 0.0..=1.0, 1.0),
            texture: base_texture.clone(),
        };
        let alpha = ScalarInput {
            factor: self.number("baseColorFactor", alpha, 0.0..=1.0, 1.0),
            texture: base_texture.map(|texture| (texture, 3)),
        };
        let surface = match extensions.unlit {
            Some(_) => {
                self.warnings.push(
                    &*self.at,
                    "KHR_materials_unlit is rendered as a diffuse surface",
                );
                unlit(base_color)
            }
            None => self.metallic_roughness(material, &extensions, base_color)?,
        };

        let strength = extensions
            .emissive_strength
            .map_or(1.0, |extension| extension.emissive_strength.0);
        let strength = self.number("emissiveStrength", strength, 0.0..=f32::MAX, 1.0);
        let emissive = self.color(
            "emissiveFactor",
            material.emissive_factor.0,
            0.0..=f32::MAX,
            0.0,
        );
        if strength == 0.0 && emissive != [0.0; 3] {
            let effect = Some(Effect::EmittingSurfaces);
            self.warnings
                .dismiss(effect, &*self.at, "emissiveStrength is 0");
        }
        let emissive = emissive.map(|factor| (factor * strength).min(f32::MAX));
        let emission = ColorInput {
            factor: emissive,
            texture: match emissive == [0.0; 3] {
                true => None,
                false => self.texture("emissiveTexture", material.emissive_texture.as_ref())?,
            },
        };
        Ok(MaterialDesc {
            name,
            surface,
            emission,
            alpha_mode: self.alpha_mode(material),
            alpha,
            normal_map: self.normal_map(material)?,
            double_sided: material.double_sided,
        })
    }

    fn metallic_roughness(
        &mut self,
        material: &Material,
        extensions: &gltf::json::extensions::material::Material,
        base_color: ColorInput,
    ) -> Result<SurfaceDesc, Fault> {
        let pbr = &material.pbr_metallic_roughness;
        let texture = self.texture(
            "metallicRoughnessTexture",
            pbr.metallic_roughness_texture.as_ref(),
        )?;
        let metallic = self.number("metallicFactor", pbr.metallic_factor.0, 0.0..=1.0, 1.0);
        let roughness = self.number("roughnessFactor", pbr.roughness_factor.0, 0.0..=1.0, 1.0);

        let specular = extensions.specular.clone().unwrap_or_default();
        let specular_texture =
            self.texture("specularTexture", specular.specular_texture.as_ref())?;
        let specular_color_texture = self.texture(
            "specularColorTexture",
            specular.specular_color_texture.as_ref(),
        )?;
        let transmission = extensions.transmission.clone().unwrap_or_default();
        let transmission_texture = self.texture(
            "transmissionTexture",
            transmission.transmission_texture.as_ref(),
        )?;
        let transmission_factor = self.number(
            "transmissionFactor",
            transmission.transmission_factor.0,
            0.0..=1.0,
            0.0,
        );
        Ok(SurfaceDesc::MetallicRoughness(MetallicRoughness {
            base_color,
            metallic: ScalarInput {
                factor: metallic,
                texture: texture.clone().map(|texture| (texture, 2)),
            },
            roughness: ScalarInput {
                factor: roughness,
                texture: texture.map(|texture| (texture, 1)),
            },
            ior: self.ior(
                extensions
                    .ior
                    .as_ref()
                    .map_or(1.5, |extension| extension.ior.0),
            ),
            specular: ScalarInput {
                factor: self.number("specularFactor", specular.specular_factor.0, 0.0..=1.0, 1.0),
                texture: specular_texture.map(|texture| (texture, 3)),
            },
            specular_color: ColorInput {
                factor: self.color(
                    "specularColorFactor",
                    specular.specular_color_factor.0,
                    0.0..=f32::MAX,
                    1.0,
                ),
                texture: specular_color_texture,
            },
            transmission: ScalarInput {
                factor: transmission_factor,
                texture: transmission_texture.map(|texture| (texture, 0)),
            },
            solid: self.is_solid(extensions.volume.as_ref(), transmission_factor),
        }))
    }

    fn is_solid(
        &mut self,
        volume: Option<&gltf::json::extensions::material::Volume>,
        transmission_factor: f32,
    ) -> bool {
        let Some(volume) = volume else { return false };
        let is_solid = self.number(
            "thicknessFactor",
            volume.thickness_factor.0,
            0.0..=f32::MAX,
            0.0,
        ) > 0.0;
        let absorbs =
            volume.attenuation_color.0 != [1.0; 3] && volume.attenuation_distance.0.is_finite();
        if is_solid && absorbs && transmission_factor > 0.0 {
            self.warnings.push(
                &*self.at,
                "the attenuation of KHR_materials_volume is not rendered",
            );
        }
        is_solid
    }

    fn ior(&mut self, ior: f32) -> f32 {
        if ior == 0.0 || (ior >= 1.0 && ior.is_finite()) {
            return ior;
        }
        self.warnings.push(
            &*self.at,
            format!("ior {ior} is neither 0 nor at least 1; 1.5 is used"),
        );
        1.5
    }

    fn alpha_mode(&mut self, material: &Material) -> AlphaMode {
        match material.alpha_mode {
            Checked::Valid(JsonAlphaMode::Opaque) => AlphaMode::Opaque,
            Checked::Valid(JsonAlphaMode::Mask) => {
                let cutoff = material.alpha_cutoff.map_or(0.5, |cutoff| cutoff.0);
                AlphaMode::Mask(self.number("alphaCutoff", cutoff, 0.0..=f32::MAX, 0.5))
            }
            Checked::Valid(JsonAlphaMode::Blend) => AlphaMode::Blend,
            Checked::Invalid => {
                self.warnings
                    .push(&*self.at, "alphaMode is unknown; OPAQUE is used");
                AlphaMode::Opaque
            }
        }
    }

    fn normal_map(&mut self, material: &Material) -> Result<Option<NormalMap>, Fault> {
        let Some(texture) = &material.normal_texture else {
            return Ok(None);
        };
        let at = format!("{}/normalTexture", self.at);
        let scale = self.number(
            "normalTexture/scale",
            texture.scale,
            f32::MIN..=f32::MAX,
            1.0,
        );
        let reference = Reference::to_normal_texture(texture, &at)?;
        Ok(self
            .textures
            .add(reference, true, &at, self.warnings)?
            .map(|texture| NormalMap { texture, scale }))
    }

    fn texture(&mut self, member: &str, info: Option<&Info>) -> Result<Option<TextureUse>, Fault> {
        let Some(info) = info else { return Ok(None) };
        self.textures
            .add(info, false, &format!("{}/{member}", self.at), self.warnings)
    }

    /// A number forced into its range; `default` stands in for NaN, and the like, with a warning.
    fn number(
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
        self.warnings.push(
            &*self.at,
            format!("{member} {value} is out of range; {used} is used"),
        );
        used
    }

    fn color(
        &mut self,
        member: &str,
        values: [f32; 3],
        range: RangeInclusive<f32>,
        default: f32,
    ) -> [f32; 3] {
        values.map(|value| self.number(member, value, range.clone(), default))
    }
}

fn unlit(base_color: ColorInput) -> SurfaceDesc {
    let constant = |factor| ScalarInput {
        factor,
        texture: None,
    };
    SurfaceDesc::MetallicRoughness(MetallicRoughness {
        base_color,
        metallic: constant(0.0),
        roughness: constant(1.0),
        ior: 1.5,
        specular: constant(0.0),
        specular_color: ColorInput {
            factor: [0.0; 3],
            texture: None,
        },
        transmission: constant(0.0),
        solid: false,
    })
}
