//! Textures that change nothing.

use residual_scenegen::desc::{AlphaMode, MaterialDesc, MetallicRoughness, NormalMap};
use residual_scenegen::effects::Effect;
use residual_tests::fixtures::{material, matte, scalar};

use crate::sheets::{Case, alpha, bytes, channel, colored, floats, painted, plastic, surface};

const TEXTURE: &[Effect] = &[Effect::Textures];

const ONE_COLOR: &[(Effect, &str)] = &[(Effect::Textures, "of one colour")];

const ONE_NUMBER: &[(Effect, &str)] = &[(Effect::Textures, "the same everywhere")];

const FACTOR_0: &[(Effect, &str)] = &[(Effect::Textures, "its factor is 0")];

pub(crate) fn cases() -> Vec<Case> {
    let white = || bytes([255; 4]);
    let black = || bytes([0, 0, 0, 255]);
    vec![
        Case {
            name: "a colour of bytes",
            // ((188/255 + 0.055) / 1.055)^2.4 and so on, times the factor.
            texels: bytes([188, 64, 10, 255]),
            far: Some(white()),
            material: |texture| painted([0.5, 1.0, 0.25], texture),
            dismissed: ONE_COLOR,
            out: TEXTURE,
            becomes: Some(&[0.251_443_2, 0.051_269_4, 0.000_758_816]),
        },
        Case {
            name: "a colour of floating-point numbers",
            texels: floats([0.5, 0.25, 0.75, 1.0]),
            far: Some(floats([0.5, 0.25, 0.5, 1.0])),
            material: |texture| painted([0.5, 1.0, 0.25], texture),
            dismissed: ONE_COLOR,
            out: TEXTURE,
            becomes: Some(&[0.25, 0.25, 0.1875]),
        },
        Case {
            name: "roughness",
            texels: bytes([7, 100, 9, 255]),
            far: Some(white()),
            material: |texture| {
                surface(MetallicRoughness {
                    roughness: channel(0.5, texture, 1),
                    ..plastic()
                })
            },
            dismissed: ONE_NUMBER,
            out: TEXTURE,
            becomes: Some(&[50.0 / 255.0]),
        },
        Case {
            name: "roughness of an image whose other channels vary",
            texels: bytes([7, 100, 9, 255]),
            far: Some(bytes([7, 101, 9, 255])),
            material: |texture| {
                surface(MetallicRoughness {
                    roughness: channel(1.0, texture, 1),
                    ..plastic()
                })
            },
            dismissed: ONE_NUMBER,
            out: TEXTURE,
            becomes: Some(&[100.0 / 255.0]),
        },
        Case {
            name: "strength of the coat",
            texels: bytes([0, 0, 0, 51]),
            far: Some(bytes([0, 0, 0, 255])),
            material: |texture| {
                surface(MetallicRoughness {
                    specular: channel(0.5, texture, 3),
                    ..plastic()
                })
            },
            dismissed: ONE_NUMBER,
            out: TEXTURE,
            // F0 is 0.04 of it.
            becomes: Some(&[0.004, 0.004, 0.004]),
        },
        Case {
            name: "no coat",
            texels: bytes([255, 255, 255, 0]),
            far: Some(white()),
            material: |texture| {
                surface(MetallicRoughness {
                    specular: channel(1.0, texture, 3),
                    ..plastic()
                })
            },
            dismissed: ONE_NUMBER,
            out: &[Effect::Textures, Effect::DielectricCoat],
            becomes: None,
        },
        Case {
            name: "colour by factor 0",
            texels: white(),
            far: None,
            material: |texture| painted([0.0; 3], texture),
            dismissed: FACTOR_0,
            out: TEXTURE,
            becomes: None,
        },
        Case {
            name: "metallic by factor 0",
            texels: white(),
            far: None,
            material: |texture| {
                surface(MetallicRoughness {
                    metallic: channel(0.0, texture, 2),
                    ..plastic()
                })
            },
            dismissed: FACTOR_0,
            out: &[
                Effect::Textures,
                Effect::MetallicReflection,
                Effect::MixedLobes,
            ],
            becomes: None,
        },
        Case {
            name: "transmission black everywhere",
            texels: black(),
            far: Some(white()),
            material: |texture| {
                surface(MetallicRoughness {
                    transmission: channel(1.0, texture, 0),
                    ..plastic()
                })
            },
            dismissed: &[
                (Effect::Textures, "the same everywhere"),
                (Effect::ThinTransmission, "transmission texture is black"),
            ],
            out: &[
                Effect::Textures,
                Effect::ThinTransmission,
                Effect::MixedLobes,
            ],
            becomes: None,
        },
        Case {
            name: "transmission tinted black by a texture",
            texels: black(),
            // What does transmit is rendered as if smooth, so its coat is another.
            far: None,
            material: |texture| {
                surface(MetallicRoughness {
                    base_color: colored([1.0; 3], texture),
                    transmission: scalar(0.5),
                    ..plastic()
                })
            },
            dismissed: &[
                (Effect::Textures, "of one colour"),
                (Effect::ThinTransmission, "tinted black"),
            ],
            out: &[
                Effect::Textures,
                Effect::ThinTransmission,
                Effect::MixedLobes,
            ],
            becomes: None,
        },
        Case {
            name: "emission black everywhere",
            texels: black(),
            far: Some(white()),
            material: |texture| MaterialDesc {
                emission: colored([4.0; 3], texture),
                ..material("case", matte([0.5; 3]))
            },
            dismissed: &[
                (Effect::Textures, "of one colour"),
                (Effect::EmittingSurfaces, "emissive texture is black"),
            ],
            out: &[
                Effect::Textures,
                Effect::EmittingSurfaces,
                Effect::TexturedEmission,
            ],
            becomes: None,
        },
        Case {
            name: "emission of one colour",
            texels: bytes([255, 188, 255, 255]),
            far: Some(white()),
            material: |texture| MaterialDesc {
                emission: colored([4.0, 2.0, 1.0], texture),
                ..material("case", matte([0.5; 3]))
            },
            dismissed: ONE_COLOR,
            out: &[Effect::Textures, Effect::TexturedEmission],
            becomes: Some(&[4.0, 1.005_773, 1.0]),
        },
        Case {
            name: "a normal map of scale 0",
            texels: bytes([20, 200, 90, 255]),
            far: Some(white()),
            material: |texture| MaterialDesc {
                normal_map: Some(NormalMap {
                    texture,
                    scale: 0.0,
                }),
                ..material("case", matte([0.5; 3]))
            },
            dismissed: &[(Effect::NormalMaps, "bends no normal")],
            out: &[Effect::NormalMaps, Effect::Textures],
            becomes: None,
        },
        Case {
            name: "a flat normal map of floating-point numbers",
            texels: floats([0.5, 0.5, 1.0, 1.0]),
            far: Some(floats([0.9, 0.5, 0.6, 1.0])),
            material: |texture| MaterialDesc {
                normal_map: Some(NormalMap {
                    texture,
                    scale: 1.0,
                }),
                ..material("case", matte([0.5; 3]))
            },
            dismissed: &[(Effect::NormalMaps, "bends no normal")],
            out: &[Effect::NormalMaps, Effect::Textures],
            becomes: None,
        },
        Case {
            name: "a flat normal map of bytes",
            texels: bytes([128, 127, 255, 255]),
            // Bytes cannot write it exactly, so pictures differ.
            far: None,
            material: |texture| MaterialDesc {
                normal_map: Some(NormalMap {
                    texture,
                    scale: 1.0,
                }),
                ..material("case", matte([0.5; 3]))
            },
            dismissed: &[(Effect::NormalMaps, "bends no normal")],
            out: &[Effect::NormalMaps, Effect::Textures],
            becomes: None,
        },
        Case {
            name: "a mask that every texel passes",
            texels: bytes([255, 255, 255, 200]),
            far: Some(bytes([255, 255, 255, 0])),
            material: |texture| alpha(AlphaMode::Mask(0.5), 1.0, texture),
            dismissed: &[(Effect::AlphaMasks, "lets nothing through")],
            out: &[Effect::AlphaMasks, Effect::Textures],
            becomes: None,
        },
        Case {
            name: "a mask of cutoff 0",
            texels: bytes([255, 255, 255, 0]),
            far: None,
            material: |texture| alpha(AlphaMode::Mask(0.0), 1.0, texture),
            dismissed: &[(Effect::AlphaMasks, "lets nothing through")],
            out: &[Effect::AlphaMasks, Effect::Textures],
            becomes: None,
        },
        Case {
            name: "a mask that no texel passes",
            texels: bytes([255, 255, 255, 100]),
            far: Some(white()),
            material: |texture| alpha(AlphaMode::Mask(0.5), 1.0, texture),
            dismissed: &[(Effect::AlphaMasks, "lets everything through")],
            out: &[Effect::AlphaMasks, Effect::Textures],
            becomes: None,
        },
        Case {
            name: "blending by alpha 1",
            texels: white(),
            far: Some(bytes([255, 255, 255, 0])),
            material: |texture| alpha(AlphaMode::Blend, 1.0, texture),
            dismissed: &[(Effect::AlphaBlending, "lets nothing through")],
            out: &[Effect::AlphaBlending, Effect::Textures],
            becomes: None,
        },
        Case {
            name: "blending by alpha 0",
            texels: bytes([255, 255, 255, 0]),
            far: Some(white()),
            material: |texture| alpha(AlphaMode::Blend, 0.5, texture),
            dismissed: &[(Effect::AlphaBlending, "lets everything through")],
            out: &[Effect::AlphaBlending, Effect::Textures],
            becomes: None,
        },
    ]
}
