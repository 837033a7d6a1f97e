//! The list of all effects.

use std::fmt;

macro_rules! effects {
    ($($(#[doc = $doc:literal])* $name:ident = $text:literal,)*) => {
        /// Something a renderer can simulate.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Effect {
            $(#[doc = $text] $name,)*
        }

        impl Effect {
            /// All effects.
            pub const ALL: &[Self] = &[$(Self::$name,)*];
        }

        impl fmt::Display for Effect {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(match self { $(Self::$name => $text,)* })
            }
        }
    };
}

effects! {
    DiffuseReflection = "diffuse reflection",
    RoughDiffuseReflection = "rough diffuse reflection",
    DielectricCoat = "dielectric coat",
    MetallicReflection = "metallic reflection",
    ClearCoat = "clear coat",
    Sheen = "sheen",
    Anisotropy = "anisotropy",
    Iridescence = "iridescence",
    PhongReflection = "Phong reflection",
    MirrorReflection = "mirror reflection",
    ThinTransmission = "thin transmission",
    Refraction = "refraction",
    RoughTransmission = "rough transmission",
    DiffuseTransmission = "diffuse transmission",
    Absorption = "absorption",
    ScatteringMedia = "scattering media",
    NestedBodies = "bodies within bodies",
    Dispersion = "dispersion",
    MixedLobes = "mixed lobes",
    Textures = "textures",
    NearestFilter = "nearest filter",
    BilinearFilter = "bilinear filter",
    Mipmaps = "mipmaps",
    RepeatWrap = "repeat wrap",
    MirrorWrap = "mirror wrap",
    ClampWrap = "clamp wrap",
    BorderWrap = "border wrap",
    SrgbTexels = "sRGB texels",
    LinearTexels = "linear texels",
    HalfTexels = "half-float texels",
    FloatTexels = "float texels",
    ProceduralTextures = "procedural textures",
    TextureTransforms = "texture transforms",
    SecondUvSet = "second UV set",
    VertexColors = "vertex colours",
    SmoothNormals = "smooth normals",
    NormalMaps = "normal maps",
    CoatNormalMaps = "normal maps of clear coats",
    AlphaMasks = "alpha masks",
    AlphaBlending = "alpha blending",
    BackFaceCulling = "back-face culling",
    EmittingSurfaces = "emitting surfaces",
    TexturedEmission = "textured emission",
    CoatedEmission = "emission under a clear coat",
    SolidAngleSampling = "lights sampled by solid angle",
    PointLights = "point lights",
    SpotLights = "spot lights",
    DirectionalLights = "directional lights",
    SphericalPointLights = "point lights with a radius",
    SphericalSpotLights = "spot lights with a radius",
    Suns = "directional lights with an angle",
    Environment = "environment",
    LightTree = "light tree",
    PerspectiveCamera = "perspective camera",
    DepthOfField = "depth of field",
    OrthographicCamera = "orthographic camera",
    PanoramicCamera = "panoramic camera",
    MotionBlur = "motion blur",
}
