//! Tiny scenes, each with one thing that the plainest has not: what is emitted for them is kept in `golden/`.
//!
//! Longer than 400 lines: one entry for each scene, which read as a table.

use glam::{Vec2, Vec3, Vec4};
use residual_render::sampler::AnySampler;
use residual_scenegen::desc::{
    AlphaMode, Attenuation, ColorInput, EnvironmentDesc, Filter, MaterialDesc, MeshDesc,
    MetallicRoughness, NormalMap, PhongSurface, PoseDesc, Projection, PunctualKind, ScalarInput,
    Scattering, SceneDesc, SurfaceDesc, Texels, TextureUse, Wrap,
};
use residual_scenegen::effects::Effect;
use residual_scenegen::plan::{
    Aperture, Binding, Focus, LightPicks, LightPlaces, Optics, Plan, PlanOptions,
    TextureResolution, plan,
};

use crate::fixtures::{
    Builder, color, glass, material, matte, metallic_roughness, scalar, sheet, sphere,
};

/// A scene and what is special about it.
pub struct Tiny {
    /// A name for files and modules.
    pub name: &'static str,
    /// The scene.
    pub scene: SceneDesc,
    /// How it is planned.
    pub options: PlanOptions,
    /// The effects that the plainest of the scenes has not.
    pub adds: Vec<Effect>,
    /// The effects that only the plainest has.
    pub lacks: Vec<Effect>,
}

impl Tiny {
    fn new(name: &'static str, adds: &[Effect], lacks: &[Effect], scene: SceneDesc) -> Self {
        Self {
            name,
            scene: SceneDesc {
                name: name.to_owned(),
                ..scene
            },
            options: PlanOptions {
                size: SIZE,
                // By solid angle there is a scene of its own.
                light_places: LightPlaces::Area,
                ..PlanOptions::default()
            },
            adds: adds.to_vec(),
            lacks: lacks.to_vec(),
        }
    }

    /// The plan.
    ///
    /// # Panics
    /// If there is none.
    pub fn plan(&self) -> Plan {
        plan(&self.scene, &self.options).expect("tiny scenes can be planned")
    }
}

/// Of all pictures: not a multiple of the lanes.
pub const SIZE: [u32; 2] = [21, 15];

/// Of bodies that absorb.
const TINT: Attenuation = Attenuation {
    color: [0.3, 0.7, 0.5],
    distance: 0.4,
};

/// Of bodies that scatter.
const SCATTERING: Scattering = Scattering {
    multiscatter_color: [0.9, 0.8, 0.6],
    anisotropy: 0.4,
};

/// A corner of two sheets.
fn corner() -> [MeshDesc; 2] {
    [
        sheet([-1.0, -0.8, 0.0], [2.0, 0.0, 0.0], [0.0, 1.6, 0.0]),
        sheet([-1.0, -0.8, 1.5], [2.0, 0.0, 0.0], [0.0, 0.0, -1.5]),
    ]
}

fn lamp(b: &mut Builder) {
    let position = Vec3::new(0.4, 0.6, 1.2);
    b.light(PunctualKind::Point { position }, [3.0, 2.5, 2.0]);
}

fn camera(b: &mut Builder, projection: Projection) {
    b.camera("camera", [0.2, 0.3, 3.5], [0.0, -0.1, 0.0], projection);
}

const PERSPECTIVE: Projection = Projection::Perspective { yfov: 0.5 };

fn finish(mut b: Builder) -> SceneDesc {
    camera(&mut b, PERSPECTIVE);
    b.finish()
}

/// Meshes of one material under a point light.
fn scene(material: MaterialDesc, meshes: impl IntoIterator<Item = MeshDesc>) -> SceneDesc {
    let mut b = Builder::new("");
    b.add(material, meshes);
    lamp(&mut b);
    finish(b)
}

fn surface(name: &str, surface: MetallicRoughness) -> MaterialDesc {
    material(name, SurfaceDesc::MetallicRoughness(surface))
}

fn gray() -> MaterialDesc {
    material("gray", matte([0.5; 3]))
}

/// The plainest scene under other lights.
fn lit(add: impl FnOnce(&mut Builder)) -> SceneDesc {
    let mut b = Builder::new("");
    b.add(gray(), corner());
    add(&mut b);
    finish(b)
}

/// Two sheets whose material is made of a texture.
fn textured(
    floats: bool,
    wrap: [Wrap; 2],
    filter: Filter,
    material: impl FnOnce(TextureUse) -> MaterialDesc,
) -> SceneDesc {
    let mut b = Builder::new("");
    let image = if floats {
        b.floats(5, 3)
    } else {
        b.bytes(5, 3)
    };
    let texture = b.texture(image, wrap, filter);
    // Coordinates beyond the image, so that it matters how it goes on.
    let meshes = corner().map(|mut mesh| {
        for uv in mesh.uvs[0].iter_mut().flatten() {
            *uv = *uv * 2.5 - 0.6;
        }
        mesh.uvs[1] = mesh.uvs[0]
            .as_ref()
            .map(|uvs| uvs.iter().map(|uv| Vec2::new(uv.y, uv.x)).collect());
        mesh.colors = None;
        mesh
    });
    b.add(material(texture), meshes);
    lamp(&mut b);
    finish(b)
}

/// A Lambertian surface whose albedo is a texture.
fn printed(texture: TextureUse) -> MaterialDesc {
    let diffuse = ColorInput {
        factor: [1.0; 3],
        texture: Some(texture),
    };
    material(
        "printed",
        SurfaceDesc::Phong(PhongSurface {
            diffuse,
            specular: color([0.0; 3]),
            exponent: scalar(0.0),
        }),
    )
}

/// A Lambertian surface whose alpha is a texture.
fn cut_out(texture: TextureUse, alpha_mode: AlphaMode) -> MaterialDesc {
    MaterialDesc {
        alpha_mode,
        alpha: ScalarInput {
            factor: 0.9,
            texture: Some((texture, 3)),
        },
        ..gray()
    }
}

const REPEAT: [Wrap; 2] = [Wrap::Repeat; 2];
const TEXTURE: [Effect; 3] = [Effect::Textures, Effect::BilinearFilter, Effect::RepeatWrap];
const SRGB: [Effect; 4] = [
    Effect::Textures,
    Effect::BilinearFilter,
    Effect::RepeatWrap,
    Effect::SrgbTexels,
];

/// The plainest scene: a matte surface, a point light.
pub fn plain() -> Tiny {
    Tiny::new("matte", &[], &[], scene(gray(), corner()))
}

/// The tiny scene of this name.
///
/// # Panics
/// If none has it.
pub fn named(name: &str) -> Tiny {
    let tiny = all().into_iter().find(|tiny| tiny.name == name);
    tiny.unwrap_or_else(|| panic!("no tiny scene is called {name}"))
}

/// All tiny scenes.
pub fn all() -> Vec<Tiny> {
    [
        surfaces(),
        textures(),
        attributes(),
        alphas(),
        lights(),
        views(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn surfaces() -> Vec<Tiny> {
    let diffuse = [Effect::DiffuseReflection];
    let phong = |diffuse| {
        SurfaceDesc::Phong(PhongSurface {
            diffuse: color(diffuse),
            specular: color([0.4, 0.3, 0.2]),
            exponent: scalar(20.0),
        })
    };
    let mirror = |diffuse| SurfaceDesc::Mirror {
        diffuse: color(diffuse),
        reflectance: color([0.5, 0.4, 0.3]),
    };
    let ball = || [sphere([0.0, 0.0, 0.2], 0.7)];
    let [wall, floor] = corner();
    vec![
        plain(),
        Tiny::new(
            "metal",
            &[Effect::MetallicReflection],
            &diffuse,
            scene(
                surface("brass", metallic_roughness([0.9, 0.7, 0.3], 1.0, 0.6)),
                corner(),
            ),
        ),
        Tiny::new(
            "dielectric_coat",
            &[Effect::DielectricCoat],
            &[],
            scene(
                surface("varnish", metallic_roughness([0.5, 0.3, 0.2], 0.0, 0.3)),
                corner(),
            ),
        ),
        Tiny::new(
            "mixed_metal",
            &[
                Effect::DielectricCoat,
                Effect::MetallicReflection,
                Effect::MixedLobes,
            ],
            &[],
            scene(
                surface("worn", metallic_roughness([0.6, 0.5, 0.4], 0.5, 0.5)),
                corner(),
            ),
        ),
        Tiny::new("thin_glass", &[Effect::ThinTransmission], &[], {
            let pane = sheet([-0.6, -0.5, 0.8], [1.1, 0.0, 0.2], [0.0, 0.9, 0.0]);
            behind(surface("pane", glass(false)), [pane])
        }),
        Tiny::new(
            "solid_glass",
            &[Effect::Refraction, Effect::SmoothNormals],
            &[],
            behind(surface("ball", glass(true)), ball()),
        ),
        Tiny::new(
            "tinted_glass",
            &[
                Effect::Refraction,
                Effect::Absorption,
                Effect::SmoothNormals,
            ],
            &[],
            behind(
                surface(
                    "bottle",
                    MetallicRoughness {
                        attenuation: Some(TINT),
                        ..glass(true)
                    },
                ),
                ball(),
            ),
        ),
        Tiny::new(
            "milk",
            &[
                Effect::Refraction,
                Effect::ScatteringMedia,
                Effect::SmoothNormals,
            ],
            &[],
            behind(
                surface(
                    "milk",
                    MetallicRoughness {
                        attenuation: Some(TINT),
                        scattering: Some(SCATTERING),
                        ..glass(true)
                    },
                ),
                ball(),
            ),
        ),
        Tiny::new(
            "drink",
            &[
                Effect::Refraction,
                Effect::Absorption,
                Effect::ScatteringMedia,
                Effect::NestedBodies,
                Effect::SmoothNormals,
            ],
            &[],
            drink(),
        ),
        Tiny::new(
            "prism",
            &[
                Effect::Refraction,
                Effect::Dispersion,
                Effect::SmoothNormals,
            ],
            &[],
            behind(
                surface(
                    "flint",
                    MetallicRoughness {
                        dispersion: 1.5,
                        ..glass(true)
                    },
                ),
                ball(),
            ),
        ),
        Tiny::new(
            "tinted_prism",
            &[
                Effect::Refraction,
                Effect::RoughTransmission,
                Effect::Absorption,
                Effect::Dispersion,
                Effect::SmoothNormals,
            ],
            &[],
            behind(
                surface(
                    "frosted flint",
                    MetallicRoughness {
                        attenuation: Some(TINT),
                        dispersion: 1.5,
                        roughness: scalar(0.4),
                        ..glass(true)
                    },
                ),
                ball(),
            ),
        ),
        Tiny::new(
            "frosted_glass",
            &[
                Effect::Refraction,
                Effect::RoughTransmission,
                Effect::SmoothNormals,
            ],
            &[],
            behind(
                surface(
                    "frosted",
                    MetallicRoughness {
                        roughness: scalar(0.3),
                        ..glass(true)
                    },
                ),
                ball(),
            ),
        ),
        Tiny::new(
            "frosted_pane",
            &[Effect::ThinTransmission, Effect::RoughTransmission],
            &[],
            {
                let pane = sheet([-0.6, -0.5, 0.8], [1.1, 0.0, 0.2], [0.0, 0.9, 0.0]);
                let frosted = MetallicRoughness {
                    roughness: scalar(0.3),
                    ..glass(false)
                };
                behind(surface("frosted", frosted), [pane])
            },
        ),
        Tiny::new(
            "clay",
            &[Effect::DielectricCoat, Effect::RoughDiffuseReflection],
            &[Effect::DiffuseReflection],
            scene(
                surface(
                    "clay",
                    MetallicRoughness {
                        diffuse_roughness: scalar(0.8),
                        ..metallic_roughness([0.7, 0.4, 0.3], 0.0, 0.6)
                    },
                ),
                corner(),
            ),
        ),
        Tiny::new(
            "paper",
            &[
                Effect::DielectricCoat,
                Effect::DiffuseTransmission,
                Effect::MixedLobes,
            ],
            &[],
            scene(
                surface(
                    "paper",
                    MetallicRoughness {
                        diffuse_transmission: scalar(0.4),
                        diffuse_transmission_color: color([0.9, 0.6, 0.3]),
                        ..metallic_roughness([0.7, 0.6, 0.5], 0.0, 0.6)
                    },
                ),
                corner(),
            ),
        ),
        Tiny::new(
            "car_paint",
            &[Effect::MetallicReflection, Effect::ClearCoat],
            &diffuse,
            scene(
                surface(
                    "car paint",
                    MetallicRoughness {
                        clearcoat: scalar(0.8),
                        clearcoat_roughness: scalar(0.1),
                        ..metallic_roughness([0.7, 0.1, 0.1], 1.0, 0.5)
                    },
                ),
                corner(),
            ),
        ),
        Tiny::new(
            "velvet",
            &[Effect::DielectricCoat, Effect::Sheen],
            &[],
            scene(
                surface(
                    "velvet",
                    MetallicRoughness {
                        sheen_color: color([0.8, 0.7, 0.9]),
                        sheen_roughness: scalar(0.4),
                        ..metallic_roughness([0.3, 0.1, 0.2], 0.0, 0.9)
                    },
                ),
                corner(),
            ),
        ),
        Tiny::new(
            "soap_film",
            &[Effect::MetallicReflection, Effect::Iridescence],
            &diffuse,
            scene(
                surface(
                    "soap film",
                    MetallicRoughness {
                        iridescence: scalar(0.9),
                        iridescence_thickness: scalar(350.0),
                        ..metallic_roughness([0.7, 0.6, 0.5], 1.0, 0.3)
                    },
                ),
                corner(),
            ),
        ),
        Tiny::new(
            "brushed_metal",
            &[Effect::MetallicReflection, Effect::Anisotropy],
            &diffuse,
            scene(
                surface(
                    "brushed",
                    MetallicRoughness {
                        anisotropy: scalar(0.7),
                        anisotropy_rotation: 0.6,
                        ..metallic_roughness([0.7, 0.6, 0.5], 1.0, 0.3)
                    },
                ),
                corner().map(along_u),
            ),
        ),
        Tiny::new(
            "phong",
            &[Effect::PhongReflection],
            &diffuse,
            scene(material("sheen", phong([0.0; 3])), corner()),
        ),
        Tiny::new(
            "checkerboard",
            &[Effect::ProceduralTextures, Effect::TextureTransforms],
            &[],
            scene(
                material(
                    "tiles",
                    SurfaceDesc::Checkerboard {
                        even: color([0.7, 0.6, 0.2]),
                        odd: color([0.1, 0.2, 0.4]),
                        squares: [4.0, 3.0],
                    },
                ),
                corner(),
            ),
        ),
        Tiny::new("mirror", &[Effect::MirrorReflection], &[], {
            let pane = sheet([-0.6, -0.5, 0.8], [1.1, 0.0, 0.2], [0.0, 0.9, 0.0]);
            behind(material("mirror", mirror([0.0; 3])), [pane])
        }),
        Tiny::new(
            "diffuse_and_mirror",
            &[Effect::MirrorReflection, Effect::MixedLobes],
            &[],
            scene(material("lacquer", mirror([0.2, 0.4, 0.3])), corner()),
        ),
        Tiny::new(
            "diffuse_and_phong",
            &[Effect::PhongReflection, Effect::MixedLobes],
            &[],
            scene(material("plastic", phong([0.2, 0.4, 0.3])), corner()),
        ),
        Tiny::new(
            "culling",
            &[Effect::BackFaceCulling],
            &[],
            scene(
                MaterialDesc {
                    double_sided: false,
                    ..gray()
                },
                // The sheet above the floor is not seen from the light.
                [
                    wall,
                    floor,
                    sheet([-1.0, 0.3, 0.0], [0.8, 0.0, 0.0], [0.0, 0.0, 1.5]),
                ],
            ),
        ),
    ]
}

/// Meshes before two grey sheets.
fn behind(material: MaterialDesc, meshes: impl IntoIterator<Item = MeshDesc>) -> SceneDesc {
    let mut b = Builder::new("");
    b.add(gray(), corner());
    b.add(material, meshes);
    lamp(&mut b);
    finish(b)
}

/// A glass with something milky in it, which overlaps its wall and is behind it there, and a clear ball in that.
fn drink() -> SceneDesc {
    let mut b = Builder::new("");
    b.add(gray(), corner());
    let glass_of = |priority| MetallicRoughness {
        priority,
        ..glass(true)
    };
    let milk = MetallicRoughness {
        attenuation: Some(TINT),
        scattering: Some(SCATTERING),
        ior: 1.33,
        ..glass_of(0)
    };
    let syrup = MetallicRoughness {
        attenuation: Some(TINT),
        ior: 1.4,
        ..glass_of(0)
    };
    b.add(
        surface("glass", glass_of(1)),
        [sphere([0.25, 0.0, 0.2], 0.45)],
    );
    b.add(surface("milk", milk), [sphere([-0.2, 0.0, 0.2], 0.5)]);
    b.add(surface("syrup", syrup), [sphere([-0.3, 0.05, 0.3], 0.25)]);
    lamp(&mut b);
    finish(b)
}

fn textures() -> Vec<Tiny> {
    let linear = Filter::Linear;
    let with = |change: fn(&mut TextureUse)| {
        textured(false, REPEAT, linear, move |mut texture| {
            change(&mut texture);
            printed(texture)
        })
    };
    let and = |effect| [&SRGB[..], &[effect]].concat();
    let instead = |out: Effect, effect| -> Vec<_> {
        let swap = |e: &Effect| if *e == out { effect } else { *e };
        SRGB.iter().map(swap).collect()
    };
    let wrapped = |wrap| textured(false, [wrap; 2], linear, printed);
    let mut mipmaps = Tiny::new(
        "mipmaps",
        &instead(Effect::BilinearFilter, Effect::Mipmaps),
        &[],
        textured(false, REPEAT, Filter::Mipmapped, printed),
    );
    mipmaps.options.textures = TextureResolution::Filtered;
    let mut halves = textured(true, REPEAT, linear, printed);
    if let Texels::RgbaF32(texels) = &mut halves.images[0].texels {
        for channel in texels.iter_mut().flatten() {
            *channel = (*channel * 256.0).round() / 256.0;
        }
    }
    vec![
        Tiny::new("texture", &SRGB, &[], with(|_| {})),
        Tiny::new(
            "nearest_filter",
            &instead(Effect::BilinearFilter, Effect::NearestFilter),
            &[],
            textured(false, REPEAT, Filter::Nearest, printed),
        ),
        Tiny::new(
            "mirror_wrap",
            &instead(Effect::RepeatWrap, Effect::MirrorWrap),
            &[],
            wrapped(Wrap::Mirror),
        ),
        Tiny::new(
            "clamp_wrap",
            &instead(Effect::RepeatWrap, Effect::ClampWrap),
            &[],
            wrapped(Wrap::Clamp),
        ),
        Tiny::new(
            "border_wrap",
            &instead(Effect::RepeatWrap, Effect::BorderWrap),
            &[],
            wrapped(Wrap::WhiteBorder),
        ),
        mipmaps,
        Tiny::new(
            "half_texels",
            &instead(Effect::SrgbTexels, Effect::HalfTexels),
            &[],
            halves,
        ),
        Tiny::new(
            "float_texels",
            &instead(Effect::SrgbTexels, Effect::FloatTexels),
            &[],
            textured(true, REPEAT, linear, printed),
        ),
        Tiny::new(
            "linear_texels",
            &[
                &TEXTURE[..],
                &[Effect::LinearTexels, Effect::DielectricCoat],
            ]
            .concat(),
            &[],
            textured(false, REPEAT, linear, |texture| {
                surface(
                    "smears",
                    MetallicRoughness {
                        roughness: ScalarInput {
                            factor: 0.8,
                            texture: Some((texture, 1)),
                        },
                        ..metallic_roughness([0.5; 3], 0.0, 1.0)
                    },
                )
            }),
        ),
        Tiny::new(
            "specular_texture",
            &[
                &TEXTURE[..],
                &[Effect::LinearTexels, Effect::DielectricCoat],
            ]
            .concat(),
            &[],
            textured(false, REPEAT, linear, |texture| {
                surface(
                    "worn varnish",
                    MetallicRoughness {
                        specular: ScalarInput {
                            factor: 0.9,
                            texture: Some((texture, 0)),
                        },
                        ..metallic_roughness([0.5; 3], 0.0, 0.4)
                    },
                )
            }),
        ),
        Tiny::new(
            "film_thickness",
            &[
                &TEXTURE[..],
                &[
                    Effect::LinearTexels,
                    Effect::MetallicReflection,
                    Effect::Iridescence,
                ],
            ]
            .concat(),
            &[Effect::DiffuseReflection],
            textured(false, REPEAT, linear, |texture| {
                surface(
                    "oil",
                    MetallicRoughness {
                        iridescence: scalar(1.0),
                        iridescence_thickness: ScalarInput {
                            factor: 500.0,
                            texture: Some((texture, 1)),
                        },
                        ..metallic_roughness([0.5; 3], 1.0, 0.4)
                    },
                )
            }),
        ),
        Tiny::new(
            "texture_transform",
            &and(Effect::TextureTransforms),
            &[],
            with(|texture| texture.transform = Some([[0.6, 0.3, 0.1], [-0.2, 0.7, 0.4]])),
        ),
        Tiny::new(
            "second_uv_set",
            &and(Effect::SecondUvSet),
            &[],
            with(|texture| texture.uv_set = 1),
        ),
    ]
}

/// A sheet with the tangents of its first texture coordinates.
fn along_u(mesh: MeshDesc) -> MeshDesc {
    let along = (mesh.positions[1] - mesh.positions[0]).normalize();
    MeshDesc {
        tangents: Some(vec![along.extend(1.0); mesh.positions.len()]),
        ..mesh
    }
}

fn attributes() -> Vec<Tiny> {
    let colors = vec![
        Vec4::new(1.0, 0.2, 0.3, 1.0),
        Vec4::new(0.2, 0.9, 0.3, 1.0),
        Vec4::new(0.1, 0.2, 1.0, 1.0),
        Vec4::ONE,
    ];
    let tangents = vec![Vec4::new(1.0, 0.0, 0.0, 1.0); 4];
    vec![
        Tiny::new(
            "smooth_normals",
            &[Effect::SmoothNormals],
            &[],
            scene(gray(), [sphere([0.0, 0.0, 0.2], 0.7)]),
        ),
        Tiny::new(
            "vertex_colors",
            &[Effect::VertexColors],
            &[],
            scene(
                gray(),
                corner().map(|mesh| MeshDesc {
                    colors: Some(colors.clone()),
                    ..mesh
                }),
            ),
        ),
        Tiny::new(
            "normal_map",
            &[&TEXTURE[..], &[Effect::LinearTexels, Effect::NormalMaps]].concat(),
            &[],
            {
                let mut scene = textured(false, REPEAT, Filter::Linear, |texture| MaterialDesc {
                    normal_map: Some(NormalMap {
                        texture,
                        scale: 0.5,
                    }),
                    ..gray()
                });
                for mesh in &mut scene.meshes {
                    mesh.tangents = Some(tangents.clone());
                }
                scene
            },
        ),
        varnished("smooth_coat", Effect::NormalMaps, |texture, _| {
            MaterialDesc {
                normal_map: Some(NormalMap {
                    texture,
                    scale: 0.5,
                }),
                ..surface("varnish", varnish(None))
            }
        }),
        varnished("bumpy_coat", Effect::CoatNormalMaps, |texture, scale| {
            surface("orange peel", varnish(Some(NormalMap { texture, scale })))
        }),
    ]
}

/// A metal under a clear coat.
fn varnish(clearcoat_normal: Option<NormalMap>) -> MetallicRoughness {
    MetallicRoughness {
        clearcoat: scalar(1.0),
        clearcoat_roughness: scalar(0.2),
        clearcoat_normal,
        ..metallic_roughness([0.7, 0.5, 0.4], 1.0, 0.4)
    }
}

/// Sheets whose base or coat has bumps.
fn varnished(
    name: &'static str,
    bumps: Effect,
    material: impl FnOnce(TextureUse, f32) -> MaterialDesc,
) -> Tiny {
    let effects = [
        &TEXTURE[..],
        &[
            Effect::LinearTexels,
            bumps,
            Effect::MetallicReflection,
            Effect::ClearCoat,
        ],
    ];
    let mut scene = textured(false, [Wrap::Repeat; 2], Filter::Linear, |texture| {
        material(texture, 0.7)
    });
    for mesh in &mut scene.meshes {
        let tangent = Vec4::new(0.8, 0.6, 0.0, 1.0);
        mesh.tangents = Some(vec![tangent; mesh.positions.len()]);
    }
    Tiny::new(name, &effects.concat(), &[Effect::DiffuseReflection], scene)
}

fn alphas() -> Vec<Tiny> {
    let reads = [&TEXTURE[..], &[Effect::LinearTexels]].concat();
    let cut = |mode| textured(false, REPEAT, Filter::Linear, move |t| cut_out(t, mode));
    vec![
        Tiny::new(
            "alpha_mask",
            &[&reads[..], &[Effect::AlphaMasks]].concat(),
            &[],
            cut(AlphaMode::Mask(0.4)),
        ),
        Tiny::new(
            "alpha_blending",
            &[&reads[..], &[Effect::AlphaBlending]].concat(),
            &[],
            cut(AlphaMode::Blend),
        ),
        // The light of a lamp of which parts are cut out.
        Tiny::new(
            "masked_emission",
            &[&reads[..], &[Effect::AlphaMasks, Effect::EmittingSurfaces]].concat(),
            &[],
            textured(false, REPEAT, Filter::Linear, |texture| MaterialDesc {
                emission: color([1.5, 1.0, 0.5]),
                ..cut_out(texture, AlphaMode::Mask(0.4))
            }),
        ),
    ]
}

fn lights() -> Vec<Tiny> {
    let point = [Effect::PointLights];
    let lamp = |emission, surface| {
        let lamp = MaterialDesc {
            emission,
            ..material("lamp", surface)
        };
        move |b: &mut Builder| {
            b.add(
                lamp,
                [sheet([-0.4, 0.7, 0.9], [0.8, 0.0, 0.0], [0.0, 0.0, 0.6])],
            );
        }
    };
    let glowing = |emission| lamp(emission, matte([0.0; 3]));
    let mut by_solid_angle = Tiny::new(
        "light_by_solid_angle",
        &[Effect::EmittingSurfaces, Effect::SolidAngleSampling],
        &point,
        lit(glowing(color([6.0, 5.0, 4.0]))),
    );
    by_solid_angle.options.light_places = LightPlaces::SolidAngle;
    let position = Vec3::new(0.4, 0.6, 1.2);
    let direction = Vec3::new(-0.3, -0.6, -0.8).normalize();
    let mut light_tree = Tiny::new(
        "light_tree",
        &[
            Effect::EmittingSurfaces,
            Effect::Environment,
            Effect::LightTree,
        ],
        &[],
        {
            let mut image = 0;
            let mut scene = lit(|b| {
                for [x, y] in [[-0.9, 0.3], [-0.2, 0.9], [0.6, 0.5]] {
                    let lamp = MaterialDesc {
                        emission: color([20.0, 15.0 * y, 10.0]),
                        ..material("lamp", matte([0.0; 3]))
                    };
                    let edge = [0.2, 0.0, 0.0];
                    b.add(lamp, [sheet([x, y, 0.9], edge, [0.0, 0.05, 0.2])]);
                }
                b.light(PunctualKind::Point { position }, [0.3, 0.4, 0.5]);
                image = b.floats(8, 4);
            });
            scene.environment = Some(EnvironmentDesc {
                image,
                strength: 0.2,
                rotation: 0.7,
            });
            scene
        },
    );
    light_tree.options.light_picks = LightPicks::Tree;
    vec![
        light_tree,
        by_solid_angle,
        Tiny::new(
            "emission",
            &[Effect::EmittingSurfaces],
            &point,
            lit(glowing(color([6.0, 5.0, 4.0]))),
        ),
        Tiny::new(
            "textured_emission",
            &[
                &SRGB[..],
                &[Effect::EmittingSurfaces, Effect::TexturedEmission],
            ]
            .concat(),
            &point,
            lit(|b| {
                let image = b.bytes(5, 3);
                let texture = Some(b.texture(image, REPEAT, Filter::Linear));
                let factor = [8.0; 3];
                glowing(ColorInput { factor, texture })(b);
            }),
        ),
        Tiny::new(
            "coated_emission",
            // The coat has a texture, what is emitted under it has none.
            &[
                &SRGB[..3],
                &[
                    Effect::LinearTexels,
                    Effect::EmittingSurfaces,
                    Effect::CoatedEmission,
                    Effect::MetallicReflection,
                    Effect::ClearCoat,
                ],
            ]
            .concat(),
            &point,
            lit(|b| {
                let image = b.bytes(5, 3);
                let strength = b.texture(image, REPEAT, Filter::Linear);
                let coated = MetallicRoughness {
                    clearcoat: ScalarInput {
                        factor: 0.8,
                        texture: Some((strength, 0)),
                    },
                    clearcoat_roughness: scalar(0.1),
                    ..metallic_roughness([0.7, 0.1, 0.1], 1.0, 0.5)
                };
                let coated = SurfaceDesc::MetallicRoughness(coated);
                lamp(color([6.0, 5.0, 4.0]), coated)(b);
            }),
        ),
        Tiny::new(
            "spot_light",
            &[Effect::SpotLights],
            &point,
            lit(|b| {
                let kind = PunctualKind::Spot {
                    position,
                    direction,
                    inner: 0.4,
                    outer: 0.7,
                };
                b.light(kind, [3.0, 2.5, 2.0]);
            }),
        ),
        Tiny::new(
            "directional_light",
            &[Effect::DirectionalLights],
            &point,
            lit(|b| b.light(PunctualKind::Directional { direction }, [1.0, 0.9, 0.8])),
        ),
        Tiny::new(
            "spherical_point",
            &[Effect::SphericalPointLights],
            &point,
            lit(|b| {
                b.light(PunctualKind::Point { position }, [3.0, 2.5, 2.0]);
                b.size_of_light(0.3);
            }),
        ),
        Tiny::new(
            "spherical_spot",
            &[Effect::SphericalSpotLights],
            &point,
            lit(|b| {
                let kind = PunctualKind::Spot {
                    position,
                    direction,
                    inner: 0.4,
                    outer: 0.7,
                };
                b.light(kind, [3.0, 2.5, 2.0]);
                b.size_of_light(0.3);
            }),
        ),
        Tiny::new(
            "sun",
            &[Effect::Suns],
            &point,
            lit(|b| {
                b.light(PunctualKind::Directional { direction }, [1.0, 0.9, 0.8]);
                b.size_of_light(0.1);
            }),
        ),
        Tiny::new("environment", &[Effect::Environment], &point, {
            let mut image = 0;
            let mut scene = lit(|b| image = b.floats(8, 4));
            scene.environment = Some(EnvironmentDesc {
                image,
                strength: 0.8,
                rotation: 0.7,
            });
            scene
        }),
    ]
}

fn views() -> Vec<Tiny> {
    let orthographic = {
        let mut b = Builder::new("");
        b.add(gray(), corner());
        lamp(&mut b);
        camera(&mut b, Projection::Orthographic { ymag: 0.9 });
        b.finish()
    };
    // Near the walls, which fill half of what is around.
    let within = {
        let mut b = Builder::new("");
        b.add(gray(), corner());
        lamp(&mut b);
        b.camera("camera", [0.2, 0.1, 0.4], [0.0, -0.1, 0.0], PERSPECTIVE);
        b.finish()
    };
    let named = |name: &str| {
        let gray = MaterialDesc {
            name: name.to_owned(),
            ..gray()
        };
        scene(gray, corner())
    };
    let constants = scene(
        surface(
            "thirds",
            metallic_roughness([1.0 / 3.0, 2e-7, 0.1], 0.0, 0.7),
        ),
        corner(),
    );
    let plain_options = |tiny: Tiny, change: fn(&mut PlanOptions)| {
        let mut tiny = tiny;
        change(&mut tiny.options);
        tiny
    };
    let mut moving = scene(gray(), corner());
    moving.later.push(PoseDesc {
        instances: moving.instances.clone(),
        lights: moving.lights.clone(),
        cameras: moving.cameras.clone(),
    });
    moving.moments = vec![0, 1];
    moving.instances[0].transform.translation.z += 0.1;
    vec![
        Tiny::new("motion_blur", &[Effect::MotionBlur], &[], moving),
        Tiny::new(
            "orthographic_camera",
            &[Effect::OrthographicCamera],
            &[Effect::PerspectiveCamera],
            orthographic,
        ),
        plain_options(
            Tiny::new(
                "depth_of_field",
                &[Effect::DepthOfField],
                &[Effect::PerspectiveCamera],
                scene(gray(), corner()),
            ),
            |options| {
                options.optics = Optics::ThinLens {
                    aperture: Aperture::Diameter(0.3),
                    focus: Focus::Distance(2.5),
                }
            },
        ),
        plain_options(
            Tiny::new(
                "panorama",
                &[Effect::PanoramicCamera],
                &[Effect::PerspectiveCamera],
                within,
            ),
            |options| options.optics = Optics::Panorama,
        ),
        plain_options(
            Tiny::new("constants", &[Effect::DielectricCoat], &[], constants),
            |options| options.binding = Binding::Constants,
        ),
        plain_options(
            Tiny::new("independent_sampler", &[], &[], named("gray")),
            |options| options.sampler = AnySampler::Independent,
        ),
        Tiny::new(
            "odd_names",
            &[],
            &[],
            named("a\nb\r*/ \"c\" \u{2028}\u{202e}{} \\"),
        ),
    ]
}
