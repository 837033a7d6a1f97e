//! What a scene calls for: factors, texels and lights that matter.

use glam::Vec3;
use residual_render::domain::Buffer;
use residual_scenegen::desc::{
    AlphaMode, Attenuation, ColorInput, EnvironmentDesc, Filter, ImageDesc, LightDesc,
    MaterialDesc, MetallicRoughness, NormalMap, PhongSurface, PunctualKind, ScalarInput, SceneDesc,
    SurfaceDesc, Texels, TextureUse, Wrap,
};
use residual_scenegen::effects::{Effect, Effects};
use residual_scenegen::plan::{PlanOptions, plan};
use residual_tests::fixtures::{
    Builder, color, material, matte, metallic_roughness, scalar, sheet,
};

/// Texels of an image of bytes that are all this, but for one.
type Image = ([u8; 4], [u8; 4]);

const BLACK: Image = ([0; 4], [0; 4]);

const BLACK_BUT_ONE: Image = ([0; 4], [1; 4]);

const WHITE: Image = ([255; 4], [255; 4]);

const WHITE_BUT_ONE: Image = ([255; 4], [254; 4]);

/// A sheet under a point light, of the material that `make` makes of a texture.
fn effects(
    (all, one): Image,
    make: impl FnOnce(TextureUse) -> MaterialDesc,
    change: impl FnOnce(&mut SceneDesc),
) -> Vec<Effect> {
    let mut b = Builder::new("sheet");
    let image = b.bytes(5, 3);
    let texture = b.texture(image, [Wrap::Repeat; 2], Filter::Linear);
    let mesh = sheet([-1.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]);
    b.add(make(texture), [mesh]);
    let position = Vec3::new(0.0, 0.0, 2.0);
    b.light(PunctualKind::Point { position }, [1.0; 3]);
    let mut scene = b.finish();
    let Texels::Rgba8(texels) = &mut scene.images[image].texels else {
        unreachable!("an image of bytes");
    };
    texels.fill(all);
    texels[7] = one;
    change(&mut scene);
    let plan = plan(&scene, &PlanOptions::default()).unwrap();
    Effects::of(&plan).iter().collect()
}

/// Where a material has a number or a colour: how one of a factor and a texture is put there.
type Place = fn(f32, Option<TextureUse>) -> MaterialDesc;

fn number(factor: f32, texture: Option<TextureUse>) -> ScalarInput {
    let texture = texture.map(|texture| (texture, 0));
    ScalarInput { factor, texture }
}

fn colors(factor: f32, texture: Option<TextureUse>) -> ColorInput {
    let factor = [factor; 3];
    ColorInput { factor, texture }
}

const PLACES: &[(Effect, Place)] = &[
    (Effect::MetallicReflection, |factor, texture| {
        let mut surface = metallic_roughness([0.5; 3], 0.0, 0.5);
        surface.metallic = number(factor, texture);
        material("metallic", SurfaceDesc::MetallicRoughness(surface))
    }),
    (Effect::ThinTransmission, |factor, texture| {
        let mut surface = metallic_roughness([0.5; 3], 0.0, 0.0);
        surface.transmission = number(factor, texture);
        material("transmission", SurfaceDesc::MetallicRoughness(surface))
    }),
    (Effect::DielectricCoat, |factor, texture| {
        let mut surface = metallic_roughness([0.5; 3], 0.0, 0.5);
        surface.specular = number(factor, texture);
        material("specular", SurfaceDesc::MetallicRoughness(surface))
    }),
    (Effect::RoughDiffuseReflection, |factor, texture| {
        let mut surface = metallic_roughness([0.5; 3], 0.0, 0.5);
        surface.diffuse_roughness = number(factor, texture);
        material("clay", SurfaceDesc::MetallicRoughness(surface))
    }),
    (Effect::PhongReflection, |factor, texture| {
        let surface = PhongSurface {
            diffuse: color([0.5; 3]),
            specular: colors(factor, texture),
            exponent: scalar(20.0),
        };
        material("Ks", SurfaceDesc::Phong(surface))
    }),
    (Effect::MirrorReflection, |factor, texture| {
        let surface = SurfaceDesc::Mirror {
            diffuse: color([0.5; 3]),
            reflectance: colors(factor, texture),
        };
        material("Ks of a mirror", surface)
    }),
    (Effect::EmittingSurfaces, |factor, texture| MaterialDesc {
        emission: colors(factor, texture),
        ..material("emission", matte([0.5; 3]))
    }),
    (Effect::DiffuseReflection, |factor, texture| {
        let surface = PhongSurface {
            diffuse: colors(factor, texture),
            specular: color([0.5; 3]),
            exponent: scalar(20.0),
        };
        material("Kd", SurfaceDesc::Phong(surface))
    }),
];

#[test]
fn a_factor_of_0_takes_an_effect_out_and_its_texture_with_it() {
    for (effect, make) in PLACES {
        for texels in [BLACK, BLACK_BUT_ONE, WHITE] {
            let out = effects(texels, |texture| make(0.0, Some(texture)), |_| {});
            assert!(!out.contains(effect), "{effect}: {out:?}");
            assert!(!out.contains(&Effect::Textures), "{effect}: {out:?}");
        }
        let out = effects(WHITE, |_| make(0.0, None), |_| {});
        assert!(!out.contains(effect), "{effect}: {out:?}");
    }
}

/// Extensions whose factor is 0, with everything else that they say.
const SWITCHED_OFF: &[(&str, fn(&mut MetallicRoughness))] = &[
    ("anisotropy", |surface| surface.anisotropy_rotation = 0.5),
    ("clear coat", |surface| {
        surface.clearcoat_roughness = scalar(0.3);
    }),
    ("diffuse roughness", |surface| {
        surface.diffuse_roughness = scalar(0.0);
    }),
    ("diffuse transmission", |surface| {
        surface.diffuse_transmission_color = color([0.9, 0.1, 0.4]);
    }),
    ("dispersion of what is opaque", |surface| {
        surface.dispersion = 3.0
    }),
    ("iridescence", |surface| {
        surface.iridescence_ior = 2.0;
        surface.iridescence_minimum = 7.0;
        surface.iridescence_thickness = scalar(300.0);
    }),
    ("sheen", |surface| surface.sheen_roughness = scalar(0.7)),
    ("a volume of what is opaque", |surface| {
        surface.solid = true;
        surface.attenuation = Some(Attenuation {
            color: [0.5; 3],
            distance: 0.1,
        });
    }),
];

/// A factor of 0 gives the program and the data of a file without the extension, and so the same bits (hard case M-10).
#[test]
fn a_factor_of_0_is_the_extensions_absence() {
    for base in [
        metallic_roughness([0.5, 0.6, 0.7], 0.0, 0.4),
        metallic_roughness([0.5, 0.6, 0.7], 0.5, 0.4),
    ] {
        let planned = |change: fn(&mut MetallicRoughness)| {
            let mut surface = base.clone();
            change(&mut surface);
            let mut b = Builder::new("sheet");
            let mesh = sheet([-1.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]);
            b.add(
                material("sheet", SurfaceDesc::MetallicRoughness(surface)),
                [mesh],
            );
            let position = Vec3::new(0.0, 0.0, 2.0);
            b.light(PunctualKind::Point { position }, [1.0; 3]);
            plan(&b.finish(), &PlanOptions::default()).unwrap()
        };
        let absent = planned(|_| {});
        for (extension, change) in SWITCHED_OFF {
            let off = planned(*change);
            assert_eq!(off.structure, absent.structure, "{extension}");
            for buffer in Buffer::ALL {
                let [a, b] = [&off, &absent].map(|plan| plan.data.buffer(buffer));
                assert_eq!(a, b, "{extension}, {buffer:?}");
            }
        }
        // It does see an extension that is there.
        let there = planned(|surface| surface.clearcoat = scalar(1e-3));
        assert_ne!(there.structure, absent.structure);
    }
}

#[test]
fn any_other_factor_and_a_single_texel_call_for_an_effect() {
    for (effect, make) in PLACES {
        for factor in [f32::MIN_POSITIVE, 0.5, 1.0] {
            let only_factor = effects(WHITE, |_| make(factor, None), |_| {});
            assert!(only_factor.contains(effect), "{effect} by {factor}");
            assert!(
                !only_factor.contains(&Effect::Textures),
                "{effect} by {factor}"
            );
            for texels in [BLACK_BUT_ONE, WHITE] {
                let textured = effects(texels, |texture| make(factor, Some(texture)), |_| {});
                assert!(textured.contains(effect), "{effect} by {factor}");
                // A texture of one colour is no more than a number.
                let is_texture = textured.contains(&Effect::Textures);
                assert_eq!(is_texture, texels != WHITE, "{effect} by {factor}");
            }
        }
    }
}

/// Alpha matters where it is not enough, be it in one texel.
#[test]
fn a_single_texel_calls_for_alpha() {
    let alpha = |texels, mode, factor: f32| {
        let make = |texture| MaterialDesc {
            alpha_mode: mode,
            alpha: ScalarInput {
                factor,
                texture: Some((texture, 3)),
            },
            ..material("alpha", matte([0.5; 3]))
        };
        effects(texels, make, |_| {})
    };
    // Where no texel is enough for a mask, there is no surface to ask for its alpha.
    for (mode, effect, little) in [
        (AlphaMode::Blend, Effect::AlphaBlending, true),
        (AlphaMode::Mask(0.999), Effect::AlphaMasks, false),
    ] {
        for (texels, factor, wanted) in [
            (WHITE, 1.0, false),
            (WHITE_BUT_ONE, 1.0, true),
            (BLACK_BUT_ONE, 1.0, little),
            (WHITE_BUT_ONE, 0.5, little),
        ] {
            let found = alpha(texels, mode, factor);
            assert_eq!(
                found.contains(&effect),
                wanted,
                "{effect} {texels:?} {factor}"
            );
        }
        assert!(!alpha(WHITE_BUT_ONE, AlphaMode::Opaque, 0.5).contains(&effect));
    }
}

#[test]
fn lights_that_do_not_shine_are_none() {
    let direction = Vec3::NEG_Z;
    let position = Vec3::new(0.5, 0.5, 2.0);
    let kinds = [
        (Effect::PointLights, PunctualKind::Point { position }),
        (
            Effect::DirectionalLights,
            PunctualKind::Directional { direction },
        ),
        (
            Effect::SpotLights,
            PunctualKind::Spot {
                position,
                direction,
                inner: 0.2,
                outer: 0.4,
            },
        ),
    ];
    for (effect, kind) in kinds {
        for (intensity, wanted) in [([0.0; 3], false), ([0.0, 0.0, 1e-6], true)] {
            let found = effects(
                WHITE,
                |_| material("gray", matte([0.5; 3])),
                |scene| {
                    let light = scene.lights[0].clone();
                    // The plain light is of another kind than the one in question.
                    scene.lights[0].kind = match kind {
                        PunctualKind::Point { .. } => PunctualKind::Directional { direction },
                        _ => PunctualKind::Point { position },
                    };
                    scene.lights.push(LightDesc {
                        kind,
                        intensity,
                        ..light
                    });
                },
            );
            assert_eq!(found.contains(&effect), wanted, "{effect} {intensity:?}");
        }
    }
    for (strength, texel, wanted) in [
        (0.0, 1.0, false),
        (1.0, 0.0, false),
        (1.0, 1e-6, true),
        (1e-6, 1.0, true),
    ] {
        let found = effects(
            WHITE,
            |_| material("gray", matte([0.5; 3])),
            |scene| {
                let mut texels = vec![[0.0, 0.0, 0.0, 1.0]; 32];
                texels[13] = [texel, 0.0, 0.0, 1.0];
                scene.images.push(ImageDesc {
                    name: "sky".to_owned(),
                    width: 8,
                    height: 4,
                    texels: Texels::RgbaF32(texels),
                });
                scene.environment = Some(EnvironmentDesc {
                    image: scene.images.len() - 1,
                    strength,
                    rotation: 0.0,
                });
            },
        );
        assert_eq!(
            found.contains(&Effect::Environment),
            wanted,
            "{strength} {texel}"
        );
    }
}

/// A normal map needs tangents to lie along; without them it is no call for anything.
#[test]
fn normal_maps_need_tangents() {
    for tangents in [false, true] {
        let found = effects(
            WHITE,
            |texture| MaterialDesc {
                normal_map: Some(NormalMap {
                    texture,
                    scale: 1.0,
                }),
                ..material("bumps", matte([0.5; 3]))
            },
            |scene| {
                let mesh = &mut scene.meshes[0];
                let along = glam::Vec4::new(1.0, 0.0, 0.0, 1.0);
                mesh.tangents = tangents.then(|| vec![along; mesh.positions.len()]);
            },
        );
        assert_eq!(found.contains(&Effect::NormalMaps), tangents);
        assert_eq!(found.contains(&Effect::Textures), tangents);
    }
}
