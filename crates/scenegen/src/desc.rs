//! The scene description: what an importer read, validated, as plain data.
//!
//! First value of the chain file → [`SceneDesc`] → plan → program, from which effects are read off. Nothing here knows a file
//! format or a device. Invariants, established by the importers and checked by [`SceneDesc::validate`]:
//! every index is in range, every float finite, every triangle has three valid corners, attribute arrays
//! are as long as `positions`, images have `width · height` texels.
//!
//! Space: right-handed, +Y up, metres, as glTF. Colours are linear Rec. 709 unless an image says sRGB.

mod inputs;
mod metallic_roughness;
mod poses;

pub use inputs::{ColorInput, NormalMap, ScalarInput, TextureUse, UvTransform};
pub use metallic_roughness::{Attenuation, MetallicRoughness, Scattering};
pub use poses::{NOTHING_MOVES, Pose};

use glam::{Affine3A, DVec3, Quat, Vec2, Vec3, Vec4};

use crate::effect::Effect;

/// A scene, ready to be analysed.
#[derive(Debug, Clone, Default)]
pub struct SceneDesc {
    /// File stem, used for the default name of the image.
    pub name: String,
    /// Where in the file's world the scene's own lies: 0 but for scenes that are far away, of which 32 bits would not hold
    /// the details. All positions here are relative to it.
    pub origin: DVec3,
    /// Decoded images, each once.
    pub images: Vec<ImageDesc>,
    /// Images together with their samplers.
    pub textures: Vec<TextureDesc>,
    /// Materials; meshes refer to them by index. Importers append a default where a file names none.
    pub materials: Vec<MaterialDesc>,
    /// Triangle meshes in object space.
    pub meshes: Vec<MeshDesc>,
    /// Meshes placed in the world.
    pub instances: Vec<InstanceDesc>,
    /// Punctual lights, in world space.
    pub lights: Vec<LightDesc>,
    /// Cameras, in world space.
    pub cameras: Vec<CameraDesc>,
    /// Light from infinitely far away.
    pub environment: Option<EnvironmentDesc>,
    /// Where meshes, lights and cameras are at other moments while the shutter is open; none where it is closed, or where
    /// nothing moves meanwhile.
    pub later: Vec<PoseDesc>,
    /// For each moment while the shutter is open, in order of time, the [pose](SceneDesc::pose) then; none where there is one
    /// pose only.
    pub moments: Vec<usize>,
    /// What could not be taken over faithfully.
    pub warnings: Vec<Warning>,
    /// What is in the file and changes nothing.
    pub dismissed: Vec<Dismissed>,
}

/// Where meshes, lights and cameras are at a moment: as many of each as at the first, of the same names and kinds, and
/// meshes with as many triangles of the same materials.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PoseDesc {
    /// Meshes placed in the world. Those that are deformed are others at each moment.
    pub instances: Vec<InstanceDesc>,
    /// Punctual lights.
    pub lights: Vec<LightDesc>,
    /// Cameras.
    pub cameras: Vec<CameraDesc>,
}

/// Something of the file that changes nothing in the image, so that the renderer goes without.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Dismissed {
    /// The effect that it would have called for, if we know one.
    pub effect: Option<Effect>,
    /// Where: as in [`Warning::place`].
    pub place: String,
    /// Why it changes nothing.
    pub reason: String,
}

/// What a [`Warning`] is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WarningKind {
    /// The image does not show what the file says.
    Unfaithful,
    /// The file has no light; a white sky takes its place.
    NoLight,
    /// The file has no camera; one that frames the scene takes its place.
    NoCamera,
    /// A mesh that nobody could see is left out.
    Invisible,
    /// The user asked for something that the scene has no use for.
    Unused,
}

/// Something of the file that the image will lack or show differently.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// What it is about.
    pub kind: WarningKind,
    /// Where: a JSON path with the name in quotes, such as `materials/3 "Glass"`, or `line 12`.
    pub place: String,
    /// What, and what was done instead.
    pub message: String,
}

/// A decoded image. Row 0 is the top row.
#[derive(Debug, Clone)]
pub struct ImageDesc {
    /// Name or path, for messages and comments.
    pub name: String,
    /// Texels per row, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
    /// The texels, row by row.
    pub texels: Texels,
}

/// Texels of an image.
#[derive(Debug, Clone)]
pub enum Texels {
    /// Four bytes a texel, as stored in the file. Whether colour is sRGB-encoded is said by its use.
    Rgba8(Vec<[u8; 4]>),
    /// Four numbers of 16 bits a texel, likewise (16-bit PNGs).
    Rgba16(Vec<[u16; 4]>),
    /// Linear, finite, non-negative (HDR and EXR images).
    RgbaF32(Vec<[f32; 4]>),
}

/// How coordinates outside `[0, 1]` are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Wrap {
    /// Tiles.
    #[default]
    Repeat,
    /// Tiles, every other one mirrored.
    Mirror,
    /// The texels at the edge go on.
    Clamp,
    /// The image is there once, and white around it: there, factors count alone. Around a normal map, normals are the mesh's.
    WhiteBorder,
    /// The image is there once, and black around it. Around a normal map, normals are the mesh's.
    BlackBorder,
}

/// How texels are combined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Filter {
    /// The nearest texel.
    Nearest,
    /// Bilinear.
    #[default]
    Linear,
    /// Bilinear, and where texels are smaller than what is seen of the surface, as if they were as large: by mipmaps.
    Mipmapped,
}

/// An image with a sampler.
#[derive(Debug, Clone, PartialEq)]
pub struct TextureDesc {
    /// Index into [`SceneDesc::images`].
    pub image: usize,
    /// Along u and v.
    pub wrap: [Wrap; 2],
    /// How texels are combined.
    pub filter: Filter,
}

/// What alpha does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AlphaMode {
    /// Alpha is ignored.
    Opaque,
    /// The surface is there where alpha ≥ the cutoff.
    Mask(f32),
    /// The surface is there with probability alpha.
    Blend,
}

/// A material.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialDesc {
    /// Name in the file, or a made-up one.
    pub name: String,
    /// How it scatters light.
    pub surface: SurfaceDesc,
    /// Emitted radiance, strength included; factor 0 emits nothing.
    pub emission: ColorInput,
    /// What alpha does.
    pub alpha_mode: AlphaMode,
    /// Alpha (base colour's alpha for glTF, `d`/`map_d` for OBJ).
    pub alpha: ScalarInput,
    /// Normal map.
    pub normal_map: Option<NormalMap>,
    /// Seen, blocking and emitting from both sides.
    pub double_sided: bool,
}

impl MaterialDesc {
    /// Of a surface that emits nothing, is opaque, has no normal map, and is seen from both sides.
    pub fn new(name: impl Into<String>, surface: SurfaceDesc) -> Self {
        Self {
            name: name.into(),
            surface,
            emission: ColorInput::constant([0.0; 3]),
            alpha_mode: AlphaMode::Opaque,
            alpha: ScalarInput::constant(1.0),
            normal_map: None,
            double_sided: true,
        }
    }
}

/// How a surface scatters light.
#[derive(Debug, Clone, PartialEq)]
#[allow(
    clippy::large_enum_variant,
    reason = "a scene has few materials, and most are of the largest kind"
)]
pub enum SurfaceDesc {
    /// glTF 2.0, appendix B, with the extensions that it has fields for.
    MetallicRoughness(MetallicRoughness),
    /// OBJ: Lambert plus normalised Phong. The two reflect no more than arrives.
    Phong(PhongSurface),
    /// OBJ `illum` 3, 5, 8: Lambert plus a perfect mirror. The two reflect no more than arrives.
    Mirror {
        /// `Kd`.
        diffuse: ColorInput,
        /// `Ks`.
        reflectance: ColorInput,
    },
    /// A matte checkerboard over `TEXCOORD_0`: the ground that [`SceneDesc::add_ground`] makes.
    Checkerboard {
        /// Of the square from (0, 0).
        even: ColorInput,
        /// Of its neighbours.
        odd: ColorInput,
        /// Squares from 0 to 1, along u and v.
        squares: [f32; 2],
    },
    /// KHR_materials_unlit: reflects nothing. What it emits is tinted by `COLOR_0`, is seen where rays meet it, and is no
    /// light that others are lit by on purpose.
    Unlit,
    /// OBJ `illum` 4, 6, 7, 9 or a coloured `Tf`: a smooth dielectric.
    Dielectric {
        /// Index of refraction.
        ior: f32,
        /// Tint of transmitted light.
        transmittance: [f32; 3],
    },
}

/// OBJ's Lambert plus Phong surface.
#[derive(Debug, Clone, PartialEq)]
pub struct PhongSurface {
    /// `Kd`.
    pub diffuse: ColorInput,
    /// `Ks`; 0 when `illum` < 2.
    pub specular: ColorInput,
    /// `Ns`, at least 0.
    pub exponent: ScalarInput,
}

/// A triangle mesh.
#[derive(Debug, Clone, Default)]
pub struct MeshDesc {
    /// Name in the file.
    pub name: String,
    /// Index into [`SceneDesc::materials`].
    pub material: usize,
    /// Vertices.
    pub positions: Vec<Vec3>,
    /// Unit shading normals. Importers make flat ones (by splitting vertices) where a glTF file has none,
    /// as its specification says, and likewise for OBJ without smoothing groups.
    pub normals: Vec<Vec3>,
    /// Unit tangents with the bitangent's sign in w. Present only where the material has a normal map.
    pub tangents: Option<Vec<Vec4>>,
    /// `TEXCOORD_0` and `TEXCOORD_1`; (0, 0) is the image's top left.
    pub uvs: [Option<Vec<Vec2>>; 2],
    /// `COLOR_0`, linear.
    pub colors: Option<Vec<Vec4>>,
    /// Corners, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
}

/// A mesh placed in the world.
#[derive(Debug, Clone, PartialEq)]
pub struct InstanceDesc {
    /// Name of the node, for messages.
    pub name: String,
    /// Index into [`SceneDesc::meshes`].
    pub mesh: usize,
    /// Object to world; may mirror and shear, is finite, composed in f64.
    pub transform: Affine3A,
}

/// A punctual light (KHR_lights_punctual) in world space.
#[derive(Debug, Clone, PartialEq)]
pub struct LightDesc {
    /// Name in the file.
    pub name: String,
    /// Its kind, with what belongs to it.
    pub kind: PunctualKind,
    /// Colour × intensity: W/(sr·m²)-like photometric units are taken as radiometric, one for one.
    /// Radiant intensity for point and spot, irradiance at normal incidence for directional.
    pub intensity: [f32; 3],
    /// Radius of a point or spot light, in units of the scene; angular diameter of a directional one, in radians, up to π.
    /// 0 of lights without a size, as those of files are.
    pub size: f32,
}

/// Kinds of punctual lights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PunctualKind {
    /// Shines everywhere from a point.
    Point {
        /// World position.
        position: Vec3,
    },
    /// Shines into a cone.
    Spot {
        /// World position.
        position: Vec3,
        /// Unit axis, pointing away from the light.
        direction: Vec3,
        /// Half-angle of full intensity, radians.
        inner: f32,
        /// Half-angle where it ends, radians; inner ≤ outer ≤ π/2, outer > 0. Where both are the same, the edge is hard.
        outer: f32,
    },
    /// Shines along one direction from infinitely far away.
    Directional {
        /// Unit direction in which the light travels.
        direction: Vec3,
    },
}

/// A camera in world space. It looks along −Z of `rotation`, +Y is up.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraDesc {
    /// Name of the node or the camera.
    pub name: String,
    /// Eye.
    pub position: Vec3,
    /// Orientation.
    pub rotation: Quat,
    /// Lens.
    pub projection: Projection,
    /// Width over height of what the file frames, all of which images of any shape show; `None` where only the height
    /// counts.
    pub frame_aspect: Option<f32>,
    /// Where the file's camera begins and ends to see, which is not rendered; `None` where the file says nothing of it.
    pub clip: Option<ClipDistances>,
}

/// Along the view axis from the eye, in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClipDistances {
    /// What is nearer is not seen.
    pub near: f32,
    /// What is farther is not seen; `None` where everything is.
    pub far: Option<f32>,
}

/// A camera's projection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// Pinhole.
    Perspective {
        /// Vertical field of view in radians, in (0, π).
        yfov: f32,
    },
    /// Parallel rays.
    Orthographic {
        /// Half the height of what is seen, in metres.
        ymag: f32,
    },
}

/// Light from infinitely far away: a latitude-longitude image, centre at +X, u growing towards +Z, top at +Y.
#[derive(Debug, Clone)]
pub struct EnvironmentDesc {
    /// Index into [`SceneDesc::images`]; the image is [`Texels::RgbaF32`].
    pub image: usize,
    /// Factor on radiance.
    pub strength: f32,
    /// Turn about +Y in radians.
    pub rotation: f32,
}
