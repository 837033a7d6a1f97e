//! The inputs of a material's description, listed once.

use crate::desc::{
    ColorInput, MaterialDesc, MetallicRoughness, NormalMap, PhongSurface, ScalarInput, SurfaceDesc,
    TextureUse,
};

/// An input of a material: a colour, a number or a normal map.
#[derive(Debug)]
pub enum MaterialInput<C, S, N> {
    /// A colour.
    Color(C),
    /// A number.
    Scalar(S),
    /// A normal map.
    Normal(N),
}

/// An input that is looked at.
pub type InputRef<'a> = MaterialInput<&'a ColorInput, &'a ScalarInput, &'a NormalMap>;
/// An input that is changed.
pub type InputMut<'a> = MaterialInput<&'a mut ColorInput, &'a mut ScalarInput, &'a mut NormalMap>;

/// The inputs of a surface with their names, as the reference to it is, shared or exclusive.
macro_rules! surface_inputs {
    ($surface:expr) => {{
        use MaterialInput::{Color, Scalar};
        match $surface {
            SurfaceDesc::MetallicRoughness(MetallicRoughness {
                base_color,
                metallic,
                roughness,
                ior: _,
                specular,
                specular_color,
                transmission,
                solid: _,
                attenuation: _,
                scattering: _,
                priority: _,
                dispersion: _,
                diffuse_roughness,
                diffuse_transmission,
                diffuse_transmission_color,
                anisotropy,
                anisotropy_rotation: _,
                iridescence,
                iridescence_ior: _,
                iridescence_minimum: _,
                iridescence_thickness,
                sheen_color,
                sheen_roughness,
                clearcoat,
                clearcoat_roughness,
                clearcoat_normal,
            }) => {
                let mut inputs = vec![
                    ("base_color", Color(base_color)),
                    ("metallic", Scalar(metallic)),
                    ("roughness", Scalar(roughness)),
                    ("specular", Scalar(specular)),
                    ("specular_color", Color(specular_color)),
                    ("transmission", Scalar(transmission)),
                    ("diffuse_roughness", Scalar(diffuse_roughness)),
                    ("diffuse_transmission", Scalar(diffuse_transmission)),
                    (
                        "diffuse_transmission_color",
                        Color(diffuse_transmission_color),
                    ),
                    ("anisotropy", Scalar(anisotropy)),
                    ("iridescence", Scalar(iridescence)),
                    ("iridescence_thickness", Scalar(iridescence_thickness)),
                    ("sheen_color", Color(sheen_color)),
                    ("sheen_roughness", Scalar(sheen_roughness)),
                    ("clearcoat", Scalar(clearcoat)),
                    ("clearcoat_roughness", Scalar(clearcoat_roughness)),
                ];
                let normal = clearcoat_normal.into_iter();
                inputs.extend(normal.map(|map| ("clearcoat_normal", MaterialInput::Normal(map))));
                inputs
            }
            SurfaceDesc::Phong(PhongSurface {
                diffuse,
                specular,
                exponent,
            }) => vec![
                ("diffuse", Color(diffuse)),
                ("specular", Color(specular)),
                ("exponent", Scalar(exponent)),
            ],
            SurfaceDesc::Mirror {
                diffuse,
                reflectance,
            } => vec![
                ("diffuse", Color(diffuse)),
                ("reflectance", Color(reflectance)),
            ],
            SurfaceDesc::Checkerboard {
                even,
                odd,
                squares: _,
            } => vec![("even", Color(even)), ("odd", Color(odd))],
            SurfaceDesc::Unlit
            | SurfaceDesc::Dielectric {
                ior: _,
                transmittance: _,
            } => Vec::new(),
        }
    }};
}

/// The inputs of a material, those of its surface first.
macro_rules! material_inputs {
    ($material:expr) => {{
        let MaterialDesc {
            name: _,
            surface,
            emission,
            alpha_mode: _,
            alpha,
            normal_map,
            double_sided: _,
        } = $material;
        let mut inputs = surface_inputs!(surface);
        inputs.push(("emission", MaterialInput::Color(emission)));
        inputs.push(("alpha", MaterialInput::Scalar(alpha)));
        let normal_map = normal_map.into_iter();
        inputs.extend(normal_map.map(|map| ("normal_map", MaterialInput::Normal(map))));
        inputs
    }};
}

impl SurfaceDesc {
    /// The inputs with the names of their fields, in order.
    pub fn inputs(&self) -> Vec<(&'static str, InputRef<'_>)> {
        surface_inputs!(self)
    }

    /// The inputs with the names of their fields, in order, to be changed.
    pub fn inputs_mut(&mut self) -> Vec<(&'static str, InputMut<'_>)> {
        surface_inputs!(self)
    }
}

impl MaterialDesc {
    /// The inputs of the surface, then the others, with the names of their fields.
    pub fn inputs(&self) -> Vec<(&'static str, InputRef<'_>)> {
        material_inputs!(self)
    }

    /// The inputs of the surface, then the others, with the names of their fields, to be changed.
    pub fn inputs_mut(&mut self) -> Vec<(&'static str, InputMut<'_>)> {
        material_inputs!(self)
    }

    /// The set of texture coordinates that tangents follow; `None` where none are needed.
    pub fn tangent_uv_set(&self) -> Option<usize> {
        if let Some(map) = &self.normal_map {
            return Some(map.texture.uv_set);
        }
        match &self.surface {
            SurfaceDesc::MetallicRoughness(surface) if surface.anisotropy.factor > 0.0 => {
                let texture = surface.anisotropy.texture.as_ref();
                Some(texture.map_or(0, |(texture, _)| texture.uv_set))
            }
            SurfaceDesc::MetallicRoughness(surface) if surface.clearcoat.factor > 0.0 => {
                let map = surface.clearcoat_normal.as_ref()?;
                Some(map.texture.uv_set)
            }
            _ => None,
        }
    }

    /// The textures that the inputs are read from.
    pub fn textures(&self) -> impl Iterator<Item = &TextureUse> {
        let inputs = self.inputs().into_iter();
        inputs.filter_map(|(_, input)| input.texture())
    }
}

impl<'a> InputRef<'a> {
    /// The texture that it is read from.
    pub fn texture(self) -> Option<&'a TextureUse> {
        match self {
            Self::Color(input) => input.texture.as_ref(),
            Self::Scalar(input) => input.texture.as_ref().map(|(texture, _)| texture),
            Self::Normal(map) => Some(&map.texture),
        }
    }
}

impl<'a> InputMut<'a> {
    /// The texture that it is read from, to be changed.
    pub fn texture(self) -> Option<&'a mut TextureUse> {
        match self {
            Self::Color(input) => input.texture.as_mut(),
            Self::Scalar(input) => input.texture.as_mut().map(|(texture, _)| texture),
            Self::Normal(map) => Some(&mut map.texture),
        }
    }
}
