//! What a scene would be without one of its effects, so that the two can be compared: the price of the effect.

use residual_render::texture::srgb_table;

use crate::desc::{
    AlphaMode, ColorInput, Filter, LightDesc, MaterialDesc, PhongSurface, PunctualKind,
    ScalarInput, SceneDesc, SurfaceDesc, Texels, TextureUse,
};
use crate::desc_inputs::{InputMut, MaterialInput};
use crate::effect::Effect;
use crate::plan::{
    BodyRule, CullingRule, LightPicks, LightPlaces, Optics, PlanOptions, TextureResolution,
};
use crate::sixteen_bits;

/// How an effect is taken out of a scene, in words; `None` for those without which there is no picture, or which
/// others stand for (a texel's format, a wrap mode).
pub fn instead(effect: Effect) -> Option<&'static str> {
    Some(match effect {
        Effect::RoughDiffuseReflection => "as smooth surfaces reflect",
        Effect::DielectricCoat => "matte",
        Effect::MetallicReflection => "matte, of the same colour",
        Effect::ClearCoat | Effect::Sheen => "without it",
        Effect::Anisotropy => "as rough in all directions",
        Effect::Iridescence => "without a film",
        Effect::RoughTransmission => "smooth",
        Effect::Absorption => "clear",
        Effect::ScatteringMedia => "what is scattered is absorbed",
        Effect::NestedBodies => "beside each other",
        Effect::Dispersion => "all wavelengths bent alike",
        Effect::PhongReflection | Effect::MirrorReflection => "matte",
        Effect::ThinTransmission | Effect::Refraction | Effect::DiffuseTransmission => "opaque",
        Effect::Textures => "their mean values; alpha, normal maps and emission stay",
        Effect::ProceduralTextures => "the mean of their colours",
        Effect::BilinearFilter => "the nearest texel",
        Effect::Mipmaps => "the full resolution",
        Effect::TextureTransforms => "coordinates as they are",
        Effect::VertexColors => "white",
        Effect::SmoothNormals => "flat triangles",
        Effect::NormalMaps | Effect::CoatNormalMaps => "as the mesh is",
        Effect::AlphaMasks | Effect::AlphaBlending => "opaque",
        Effect::BackFaceCulling => "seen from both sides",
        Effect::EmittingSurfaces => "dark",
        Effect::TexturedEmission => "its mean",
        Effect::CoatedEmission => "without the coat over it",
        Effect::PointLights | Effect::SpotLights | Effect::DirectionalLights => "off",
        Effect::SphericalPointLights | Effect::SphericalSpotLights => "without a radius",
        Effect::Suns => "without an angle",
        Effect::Environment => "black",
        Effect::DepthOfField => "a pinhole",
        Effect::LightTree => "picked from a table",
        Effect::SolidAngleSampling => "by area",
        Effect::MotionBlur => "as at the first moment",
        Effect::DiffuseReflection
        | Effect::MixedLobes
        | Effect::NearestFilter
        | Effect::RepeatWrap
        | Effect::MirrorWrap
        | Effect::ClampWrap
        | Effect::BorderWrap
        | Effect::SrgbTexels
        | Effect::LinearTexels
        | Effect::HalfTexels
        | Effect::FloatTexels
        | Effect::SecondUvSet
        | Effect::PerspectiveCamera
        | Effect::OrthographicCamera
        | Effect::PanoramicCamera => return None,
    })
}

/// The scene and how it is planned, with an effect taken out as [`instead`] says; `None` where that says nothing.
pub fn without(
    effect: Effect,
    scene: &SceneDesc,
    options: &PlanOptions,
) -> Option<(SceneDesc, PlanOptions)> {
    instead(effect)?;
    let (mut scene, mut options) = (scene.clone(), options.clone());
    let mut means = Means::new(&scene);
    match effect {
        Effect::BilinearFilter => {
            let textures = scene.textures.iter_mut();
            textures.for_each(|texture| texture.filter = Filter::Nearest);
        }
        Effect::Mipmaps => options.textures = TextureResolution::Full,
        Effect::VertexColors => scene.meshes.iter_mut().for_each(|mesh| mesh.colors = None),
        Effect::SmoothNormals => options.flat_normals = true,
        Effect::BackFaceCulling => options.culling = CullingRule::None,
        Effect::NestedBodies => options.bodies = BodyRule::Beside,
        Effect::LightTree => options.light_picks = LightPicks::Mixed,
        Effect::SolidAngleSampling => options.light_places = LightPlaces::Area,
        Effect::PointLights | Effect::SpotLights | Effect::DirectionalLights => {
            scene.retain_lights(|light| light.size > 0.0 || light_effect(light) != effect);
        }
        Effect::SphericalPointLights => take_sizes(Effect::PointLights, &mut scene),
        Effect::SphericalSpotLights => take_sizes(Effect::SpotLights, &mut scene),
        Effect::Suns => take_sizes(Effect::DirectionalLights, &mut scene),
        Effect::Environment => scene.environment = None,
        Effect::MotionBlur => scene.close_shutter(),
        Effect::DepthOfField => options.optics = Optics::Projection,
        _ => {
            for material in &mut scene.materials {
                change(effect, material, &mut means);
            }
        }
    }
    Some((scene, options))
}

/// What a light without a size calls for.
fn light_effect(light: &LightDesc) -> Effect {
    match light.kind {
        PunctualKind::Point { .. } => Effect::PointLights,
        PunctualKind::Spot { .. } => Effect::SpotLights,
        PunctualKind::Directional { .. } => Effect::DirectionalLights,
    }
}

/// Takes the size of the lights that would call for an effect without it.
fn take_sizes(effect: Effect, scene: &mut SceneDesc) {
    let lights = scene.all_lights_mut();
    for light in lights.filter(|light| light_effect(light) == effect) {
        light.size = 0.0;
    }
}

/// Takes an effect out of a material.
fn change(effect: Effect, material: &mut MaterialDesc, means: &mut Means) {
    match effect {
        Effect::NormalMaps => material.normal_map = None,
        Effect::EmittingSurfaces => material.emission.factor = [0.0; 3],
        Effect::TexturedEmission => means.of_color(&mut material.emission),
        Effect::CoatedEmission if material.emission.factor != [0.0; 3] => {
            change_surface(Effect::ClearCoat, &mut material.surface);
        }
        Effect::AlphaMasks if matches!(material.alpha_mode, AlphaMode::Mask(_)) => {
            material.alpha_mode = AlphaMode::Opaque;
        }
        Effect::AlphaBlending if material.alpha_mode == AlphaMode::Blend => {
            material.alpha_mode = AlphaMode::Opaque;
        }
        Effect::Textures => {
            for (_, input) in material.surface.inputs_mut() {
                means.of_input(input);
            }
        }
        Effect::TextureTransforms => {
            let inputs = material.inputs_mut().into_iter();
            let textures = inputs.filter_map(|(_, input)| input.texture());
            textures.for_each(|texture| texture.transform = None);
            if let SurfaceDesc::Checkerboard { squares, .. } = &mut material.surface {
                *squares = [1.0; 2];
            }
        }
        _ => change_surface(effect, &mut material.surface),
    }
}

/// Takes a lobe out of a surface.
fn change_surface(effect: Effect, surface: &mut SurfaceDesc) {
    match (effect, &mut *surface) {
        (Effect::DielectricCoat, SurfaceDesc::MetallicRoughness(surface)) => {
            surface.specular = ScalarInput::constant(0.0);
        }
        // A metal's reflection is all there is of it: what stays is its colour, and no coat instead.
        (Effect::MetallicReflection, SurfaceDesc::MetallicRoughness(surface)) => {
            if surface.metallic.factor == 1.0 && surface.metallic.texture.is_none() {
                surface.specular = ScalarInput::constant(0.0);
            }
            surface.metallic = ScalarInput::constant(0.0);
        }
        (
            Effect::ThinTransmission | Effect::Refraction,
            SurfaceDesc::MetallicRoughness(surface),
        ) => surface.transmission = ScalarInput::constant(0.0),
        (Effect::RoughTransmission, SurfaceDesc::MetallicRoughness(surface)) => {
            surface.roughness = ScalarInput::constant(0.0);
        }
        (Effect::Absorption, SurfaceDesc::MetallicRoughness(surface)) => {
            surface.attenuation = None;
        }
        (Effect::ScatteringMedia, SurfaceDesc::MetallicRoughness(surface)) => {
            surface.scattering = None;
        }
        (Effect::Dispersion, SurfaceDesc::MetallicRoughness(surface)) => surface.dispersion = 0.0,
        (Effect::DiffuseTransmission, SurfaceDesc::MetallicRoughness(surface)) => {
            surface.diffuse_transmission = ScalarInput::constant(0.0);
        }
        (Effect::RoughDiffuseReflection, SurfaceDesc::MetallicRoughness(surface)) => {
            surface.diffuse_roughness = ScalarInput::constant(0.0);
        }
        (Effect::CoatNormalMaps, SurfaceDesc::MetallicRoughness(surface)) => {
            surface.clearcoat_normal = None;
        }
        (Effect::ClearCoat, SurfaceDesc::MetallicRoughness(surface)) => {
            surface.clearcoat = ScalarInput::constant(0.0);
        }
        (Effect::Sheen, SurfaceDesc::MetallicRoughness(surface)) => {
            surface.sheen_color = ColorInput::constant([0.0; 3]);
        }
        (Effect::Anisotropy, SurfaceDesc::MetallicRoughness(surface)) => {
            surface.anisotropy = ScalarInput::constant(0.0);
        }
        (Effect::Iridescence, SurfaceDesc::MetallicRoughness(surface)) => {
            surface.iridescence = ScalarInput::constant(0.0);
        }
        (Effect::PhongReflection, SurfaceDesc::Phong(surface)) => {
            surface.specular = ColorInput::constant([0.0; 3]);
        }
        (Effect::MirrorReflection, SurfaceDesc::Mirror { reflectance, .. }) => {
            *reflectance = ColorInput::constant([0.0; 3]);
        }
        (Effect::ProceduralTextures, SurfaceDesc::Checkerboard { even, odd, .. }) => {
            let mean = [0, 1, 2].map(|k| 0.5 * (even.factor[k] + odd.factor[k]));
            (*even, *odd) = (ColorInput::constant(mean), ColorInput::constant(mean));
        }
        (Effect::Refraction, SurfaceDesc::Dielectric { transmittance, .. }) => {
            *surface = SurfaceDesc::Phong(PhongSurface {
                diffuse: ColorInput::constant(*transmittance),
                specular: ColorInput::constant([0.0; 3]),
                exponent: ScalarInput::constant(0.0),
            });
        }
        _ => {}
    }
}

/// Mean texels of images: linear, and with red, green and blue decoded from sRGB.
struct Means {
    of_textures: Vec<[[f32; 4]; 2]>,
}

impl Means {
    fn new(scene: &SceneDesc) -> Self {
        let of_images: Vec<_> = scene
            .images
            .iter()
            .map(|image| mean(&image.texels))
            .collect();
        let textures = scene.textures.iter();
        Self {
            of_textures: textures.map(|texture| of_images[texture.image]).collect(),
        }
    }

    fn of(&self, texture: &TextureUse) -> [[f32; 4]; 2] {
        self.of_textures[texture.texture]
    }

    fn of_input(&mut self, input: InputMut<'_>) {
        match input {
            MaterialInput::Color(input) => self.of_color(input),
            MaterialInput::Scalar(input) => self.of_scalar(input),
            MaterialInput::Normal(_) => {}
        }
    }

    fn of_color(&mut self, input: &mut ColorInput) {
        if let Some(texture) = input.texture.take() {
            let [_, decoded] = self.of(&texture);
            input.factor = [0, 1, 2].map(|k| input.factor[k] * decoded[k]);
        }
    }

    fn of_scalar(&mut self, input: &mut ScalarInput) {
        if let Some((texture, channel)) = input.texture.take() {
            let [linear, _] = self.of(&texture);
            input.factor *= linear[channel];
        }
    }
}

fn mean(texels: &Texels) -> [[f32; 4]; 2] {
    let over = |values: &mut dyn Iterator<Item = [f32; 4]>| -> [f32; 4] {
        let (mut sum, mut count) = ([0.0_f64; 4], 0.0);
        for value in values {
            sum = [0, 1, 2, 3].map(|k| sum[k] + f64::from(value[k]));
            count += 1.0;
        }
        sum.map(|sum| (sum / count) as f32)
    };
    match texels {
        Texels::Rgba16(texels) => [
            over(&mut texels.iter().copied().map(sixteen_bits::linear_texel)),
            over(&mut texels.iter().copied().map(sixteen_bits::decoded_texel)),
        ],
        Texels::RgbaF32(texels) => [over(&mut texels.iter().copied()); 2],
        Texels::Rgba8(texels) => {
            let table = srgb_table();
            let linear = |texel: &[u8; 4]| texel.map(|byte| f32::from(byte) / 255.0);
            let decoded = |texel: &[u8; 4]| {
                let [r, g, b, a] = *texel;
                let [r, g, b] = [r, g, b].map(|code| table[usize::from(code)]);
                [r, g, b, f32::from(a) / 255.0]
            };
            [
                over(&mut texels.iter().map(linear)),
                over(&mut texels.iter().map(decoded)),
            ]
        }
    }
}
