//! glTF's surface with the extensions that we render.

use super::inputs::{ColorInput, NormalMap, ScalarInput};

/// glTF's metallic-roughness surface with its layers. What a factor of 0 leaves out is not there.
#[derive(Debug, Clone, PartialEq)]
pub struct MetallicRoughness {
    /// Base colour; multiplied by `COLOR_0` where the mesh has one.
    pub base_color: ColorInput,
    /// 0 dielectric … 1 metal (blue channel).
    pub metallic: ScalarInput,
    /// Perceptual roughness, α = roughness² (green channel).
    pub roughness: ScalarInput,
    /// Index of refraction of the dielectric, 1.5 by default. 0 means "Fresnel 1" (KHR_materials_ior).
    pub ior: f32,
    /// KHR_materials_specular: strength (alpha channel).
    pub specular: ScalarInput,
    /// KHR_materials_specular: colour of the reflection at normal incidence.
    pub specular_color: ColorInput,
    /// KHR_materials_transmission (red channel).
    pub transmission: ScalarInput,
    /// KHR_materials_volume with `thicknessFactor` > 0: transmitted rays refract into a solid.
    /// Without it the surface is thin: what is transmitted goes straight on.
    pub solid: bool,
    /// KHR_materials_volume: what a solid absorbs, if anything.
    pub attenuation: Option<Attenuation>,
    /// KHR_materials_volume_scatter: how a solid scatters, if it does.
    pub scattering: Option<Scattering>,
    /// `extras.priority`: where bodies overlap, the one of the highest priority is there.
    pub priority: i32,
    /// KHR_materials_dispersion: 20 over the Abbe number; 0 bends all wavelengths alike.
    pub dispersion: f32,
    /// KHR_materials_diffuse_roughness: how rough the diffuse reflection is (red channel).
    pub diffuse_roughness: ScalarInput,
    /// KHR_materials_diffuse_transmission: the share of the diffuse light that passes (alpha channel).
    pub diffuse_transmission: ScalarInput,
    /// KHR_materials_diffuse_transmission: its colour.
    pub diffuse_transmission_color: ColorInput,
    /// KHR_materials_anisotropy: how much rougher the surface is along its direction (blue channel). Its texture's red and
    /// green are that direction, 2·rg − 1 along tangent and bitangent.
    pub anisotropy: ScalarInput,
    /// KHR_materials_anisotropy: angle from the tangent, or from the texture's direction, counter-clockwise in radians.
    pub anisotropy_rotation: f32,
    /// KHR_materials_iridescence: how much of the surface is under a thin film.
    pub iridescence: ScalarInput,
    /// KHR_materials_iridescence: the film's index of refraction, at least 1.
    pub iridescence_ior: f32,
    /// KHR_materials_iridescence: the film's thickness in nanometres where the texture (green channel) is 0.
    pub iridescence_minimum: f32,
    /// KHR_materials_iridescence: the film's thickness in nanometres where the texture is 1, or everywhere.
    pub iridescence_thickness: ScalarInput,
    /// KHR_materials_sheen: colour.
    pub sheen_color: ColorInput,
    /// KHR_materials_sheen: roughness (alpha channel).
    pub sheen_roughness: ScalarInput,
    /// KHR_materials_clearcoat: strength (red channel).
    pub clearcoat: ScalarInput,
    /// KHR_materials_clearcoat: roughness (green channel).
    pub clearcoat_roughness: ScalarInput,
    /// KHR_materials_clearcoat: normal map of the coat; without it the coat has the normals of the mesh.
    pub clearcoat_normal: Option<NormalMap>,
}

impl MetallicRoughness {
    /// It bounds a solid into which light passes in all directions: wax, skin.
    pub(crate) fn is_translucent(&self) -> bool {
        self.solid && self.diffuse_transmission.factor > 0.0
    }
}

/// What a body takes of light that goes straight on: all of it is absorbed, but for what is scattered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attenuation {
    /// What is left of white light after the distance, in (0, 1].
    pub color: [f32; 3],
    /// The distance in metres, positive.
    pub distance: f32,
}

/// How a body scatters light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scattering {
    /// The share of light that comes back from a thick layer after many scatterings (multi-scatter albedo), in [0, 1].
    pub multiscatter_color: [f32; 3],
    /// Mean cosine between the directions before and after a scattering, in (−1, 1).
    pub anisotropy: f32,
}

impl Default for MetallicRoughness {
    /// glTF's defaults: a white metal of roughness 1, without any layer.
    fn default() -> Self {
        Self {
            base_color: ColorInput::constant([1.0; 3]),
            metallic: ScalarInput::constant(1.0),
            roughness: ScalarInput::constant(1.0),
            ior: 1.5,
            specular: ScalarInput::constant(1.0),
            specular_color: ColorInput::constant([1.0; 3]),
            transmission: ScalarInput::constant(0.0),
            solid: false,
            attenuation: None,
            scattering: None,
            priority: 0,
            dispersion: 0.0,
            diffuse_roughness: ScalarInput::constant(0.0),
            diffuse_transmission: ScalarInput::constant(0.0),
            diffuse_transmission_color: ColorInput::constant([1.0; 3]),
            anisotropy: ScalarInput::constant(0.0),
            anisotropy_rotation: 0.0,
            iridescence: ScalarInput::constant(0.0),
            iridescence_ior: 1.3,
            iridescence_minimum: 100.0,
            iridescence_thickness: ScalarInput::constant(400.0),
            sheen_color: ColorInput::constant([0.0; 3]),
            sheen_roughness: ScalarInput::constant(0.0),
            clearcoat: ScalarInput::constant(0.0),
            clearcoat_roughness: ScalarInput::constant(0.0),
            clearcoat_normal: None,
        }
    }
}
