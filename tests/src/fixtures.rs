//! Small scenes, built in code, that between them call for every effect.

use glam::{Vec2, Vec3, Vec4};
use residual_scenegen::desc::{
    AlphaMode, ColorInput, Filter, MaterialDesc, MeshDesc, MetallicRoughness, NormalMap,
    PhongSurface, Projection, PunctualKind, ScalarInput, SceneDesc, SurfaceDesc, Wrap,
};

pub use crate::builder::Builder;

/// A colour without a texture.
pub fn color(factor: [f32; 3]) -> ColorInput {
    ColorInput::constant(factor)
}

/// A number without a texture.
pub fn scalar(factor: f32) -> ScalarInput {
    ScalarInput::constant(factor)
}

/// glTF's surface with its defaults, but for base colour, metallic and roughness.
pub fn metallic_roughness(base: [f32; 3], metallic: f32, roughness: f32) -> MetallicRoughness {
    MetallicRoughness {
        base_color: color(base),
        metallic: scalar(metallic),
        roughness: scalar(roughness),
        ..MetallicRoughness::default()
    }
}

/// Smooth clear glass.
pub fn glass(solid: bool) -> MetallicRoughness {
    MetallicRoughness {
        transmission: scalar(1.0),
        solid,
        ..metallic_roughness([0.9, 0.95, 1.0], 0.0, 0.0)
    }
}

/// A Lambertian surface.
pub fn matte(albedo: [f32; 3]) -> SurfaceDesc {
    SurfaceDesc::Phong(PhongSurface {
        diffuse: color(albedo),
        specular: color([0.0; 3]),
        exponent: scalar(0.0),
    })
}

/// A material that neither emits nor has alpha or a normal map; seen from both sides.
pub fn material(name: &str, surface: SurfaceDesc) -> MaterialDesc {
    MaterialDesc::new(name, surface)
}

/// A parallelogram with texture coordinates, seen from the side from which `u` turns left to `v`.
pub fn sheet(corner: [f32; 3], u: [f32; 3], v: [f32; 3]) -> MeshDesc {
    let (corner, u, v) = (Vec3::from(corner), Vec3::from(u), Vec3::from(v));
    let uvs = vec![
        Vec2::new(0.0, 1.0),
        Vec2::new(1.0, 1.0),
        Vec2::new(1.0, 0.0),
        Vec2::new(0.0, 0.0),
    ];
    MeshDesc {
        name: "sheet".to_owned(),
        material: 0,
        positions: vec![corner, corner + u, corner + u + v, corner + v],
        normals: vec![u.cross(v).normalize(); 4],
        tangents: None,
        uvs: [Some(uvs), None],
        colors: None,
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

/// A sphere with smooth normals.
pub fn sphere(centre: [f32; 3], radius: f32) -> MeshDesc {
    const ROWS: u32 = 12;
    const COLUMNS: u32 = 24;
    let vertex = |row: u32, column: u32| {
        let (polar, azimuth) = (
            std::f32::consts::PI * row as f32 / ROWS as f32,
            std::f32::consts::TAU * column as f32 / COLUMNS as f32,
        );
        Vec3::new(
            polar.sin() * azimuth.cos(),
            polar.cos(),
            polar.sin() * azimuth.sin(),
        )
    };
    let places = || (0..=ROWS).flat_map(|row| (0..=COLUMNS).map(move |column| (row, column)));
    let normals: Vec<_> = places()
        .map(|(row, column)| vertex(row, column % COLUMNS))
        .collect();
    let uv = |(row, column)| Vec2::new(column as f32 / COLUMNS as f32, row as f32 / ROWS as f32);
    let cell = |row: u32, column: u32| {
        let [a, b] = [row, row + 1].map(|row| row * (COLUMNS + 1) + column);
        [[a, b + 1, b], [a, a + 1, b + 1]]
    };
    MeshDesc {
        name: "sphere".to_owned(),
        material: 0,
        positions: normals
            .iter()
            .map(|n| Vec3::from(centre) + *n * radius)
            .collect(),
        normals,
        tangents: None,
        uvs: [Some(places().map(uv).collect()), None],
        colors: None,
        triangles: (0..ROWS)
            .flat_map(|row| (0..COLUMNS).flat_map(move |column| cell(row, column)))
            .collect(),
    }
}

const PERSPECTIVE: Projection = Projection::Perspective { yfov: 0.75 };

/// An open room: matte, metal, a mixture, coated, thin and solid glass, a normal map, vertex colours, an emitting
/// surface and one with a texture; single-sided and double-sided surfaces.
pub fn room() -> SceneDesc {
    let mut b = Builder::new("room");
    let bumps = b.bytes(8, 8);
    let smooth = b.texture(bumps, [Wrap::Repeat; 2], Filter::Linear);

    let floor = MeshDesc {
        tangents: Some(vec![Vec4::new(1.0, 0.0, 0.0, 1.0); 4]),
        ..sheet([-2.0, 0.0, 2.0], [4.0, 0.0, 0.0], [0.0, 0.0, -4.0])
    };
    let relief = NormalMap {
        texture: smooth.clone(),
        scale: 0.4,
    };
    let tiles = SurfaceDesc::MetallicRoughness(metallic_roughness([0.7, 0.6, 0.5], 0.0, 0.4));
    b.add(
        MaterialDesc {
            normal_map: Some(relief),
            ..material("tiles", tiles)
        },
        [floor],
    );

    let wall = MeshDesc {
        colors: Some(
            (0..4)
                .map(|i| Vec4::new(1.0, 0.3 * i as f32, 0.2, 1.0))
                .collect(),
        ),
        ..sheet([-2.0, 0.0, -2.0], [4.0, 0.0, 0.0], [0.0, 3.0, 0.0])
    };
    let surface = MetallicRoughness {
        specular: scalar(0.0),
        ..metallic_roughness([1.0; 3], 0.0, 1.0)
    };
    b.add(
        MaterialDesc {
            double_sided: false,
            ..material("wall", SurfaceDesc::MetallicRoughness(surface))
        },
        [wall],
    );
    let side = sheet([-2.0, 0.0, 2.0], [0.0, 0.0, -4.0], [0.0, 3.0, 0.0]);
    b.add(material("matte", matte([0.2, 0.6, 0.3])), [side]);

    let balls = [
        ("gold", metallic_roughness([1.0, 0.8, 0.3], 1.0, 0.25)),
        ("half metal", metallic_roughness([0.5, 0.7, 0.9], 0.5, 0.5)),
        ("solid glass", glass(true)),
        (
            "frost",
            MetallicRoughness {
                transmission: scalar(0.6),
                ..metallic_roughness([0.8; 3], 0.0, 0.0)
            },
        ),
    ];
    for (i, (name, surface)) in balls.into_iter().enumerate() {
        let centre = [-1.35 + 0.9 * i as f32, 0.45, 0.3];
        b.add(
            material(name, SurfaceDesc::MetallicRoughness(surface)),
            [sphere(centre, 0.4)],
        );
    }
    let pane = sheet([0.2, 0.9, 0.9], [1.0, 0.0, 0.0], [0.0, 0.8, 0.2]);
    b.add(
        material("thin glass", SurfaceDesc::MetallicRoughness(glass(false))),
        [pane],
    );

    let lamp = MaterialDesc {
        emission: color([9.0, 8.0, 6.0]),
        double_sided: false,
        ..material("lamp", matte([0.0; 3]))
    };
    b.add(
        lamp,
        [sheet([-0.6, 2.9, -0.6], [1.2, 0.0, 0.0], [0.0, 0.0, 1.2])],
    );
    let screen = ColorInput {
        factor: [1.5; 3],
        texture: Some(smooth),
    };
    let screen = MaterialDesc {
        emission: screen,
        ..material("screen", matte([0.1; 3]))
    };
    b.add(
        screen,
        [sheet([1.9, 0.4, 1.0], [0.0, 0.0, -1.6], [0.0, 1.2, 0.0])],
    );
    b.camera("front", [0.3, 1.4, 5.5], [0.0, 1.1, 0.0], PERSPECTIVE);
    b.finish()
}

/// Sheets with every wrap, filter and texel format, transforms and a second set of coordinates, masks and blending, each
/// single-sided or double-sided, under an environment, seen by an orthographic camera.
pub fn textures() -> SceneDesc {
    let mut b = Builder::new("textures");
    let (bytes, floats) = (b.bytes(7, 5), b.floats(6, 4));
    let wraps = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp];
    let filters = [Filter::Nearest, Filter::Linear];
    let mut number = 0;
    for (row, wrap) in wraps.into_iter().enumerate() {
        for filter in filters {
            for image in [bytes, floats] {
                let mut texture = b.texture(image, [wrap, wraps[(row + 1) % 3]], filter);
                texture.transform = Some([[2.6, 0.3, -0.8], [-0.2, 2.4, -0.6]]);
                texture.uv_set = number % 2;
                let mut surface = metallic_roughness([0.9, 1.0, 0.8], 0.0, 0.7);
                surface.base_color.texture = Some(texture.clone());
                surface.roughness.texture = Some((texture.clone(), 1));
                if number % 3 == 0 {
                    surface.metallic = ScalarInput {
                        factor: 1.0,
                        texture: Some((texture.clone(), 2)),
                    };
                }
                let alpha_mode = match number % 4 {
                    0 => AlphaMode::Mask(0.4),
                    1 => AlphaMode::Blend,
                    _ => AlphaMode::Opaque,
                };
                let alpha = ScalarInput {
                    factor: 0.9,
                    texture: Some((texture, 3)),
                };
                let corner = [
                    (number % 4) as f32 - 2.0,
                    row as f32 - 1.5,
                    0.3 * (number % 2) as f32,
                ];
                let mut mesh = sheet(corner, [0.9, 0.0, 0.1], [0.1, 0.9, 0.0]);
                mesh.uvs[1] = mesh.uvs[0]
                    .as_ref()
                    .map(|uvs| uvs.iter().map(|uv| Vec2::new(uv.y, uv.x) * 0.7).collect());
                let name = format!("{wrap:?} {filter:?} {number}");
                let surface = SurfaceDesc::MetallicRoughness(surface);
                b.add(
                    MaterialDesc {
                        alpha_mode,
                        alpha,
                        double_sided: number % 3 != 1,
                        ..material(&name, surface)
                    },
                    [mesh],
                );
                number += 1;
            }
        }
    }
    b.add(
        material("back", matte([0.6, 0.5, 0.4])),
        [sheet([-3.0, -2.0, -1.0], [6.0, 0.0, 0.0], [0.0, 4.0, 0.0])],
    );
    let sky = b.floats(16, 8);
    b.environment(sky, 0.8, 0.7);
    b.camera(
        "flat",
        [0.5, 0.4, 5.0],
        [0.0, 0.0, 0.0],
        Projection::Orthographic { ymag: 1.9 },
    );
    b.finish()
}

/// Phong surfaces, a mirror and a dielectric, as OBJ files have them, and a checkerboard, under a point, a spot and a directional light and an
/// emitting triangle.
pub fn lights() -> SceneDesc {
    let mut b = Builder::new("lights");
    let phong = |diffuse, specular, exponent| {
        SurfaceDesc::Phong(PhongSurface {
            diffuse: color(diffuse),
            specular: color(specular),
            exponent: scalar(exponent),
        })
    };
    b.add(
        material("ground", phong([0.5, 0.5, 0.4], [0.2; 3], 12.0)),
        [sheet([-3.0, 0.0, 3.0], [6.0, 0.0, 0.0], [0.0, 0.0, -6.0])],
    );
    b.add(
        material("shiny", phong([0.1, 0.2, 0.5], [0.6; 3], 80.0)),
        [sphere([-1.1, 0.6, 0.0], 0.6)],
    );
    b.add(
        material("polished", phong([0.0; 3], [0.8, 0.7, 0.6], 500.0)),
        [sphere([0.2, 0.5, -0.6], 0.5)],
    );
    let mirror = SurfaceDesc::Mirror {
        diffuse: color([0.1, 0.0, 0.2]),
        reflectance: color([0.8, 0.7, 0.6]),
    };
    b.add(material("mirror", mirror), [sphere([0.0, 0.3, 1.2], 0.3)]);
    let tiles = SurfaceDesc::Checkerboard {
        even: color([0.7, 0.6, 0.5]),
        odd: color([0.2, 0.3, 0.4]),
        squares: [9.0, 4.0],
    };
    b.add(
        material("tiles", tiles),
        [sheet([-3.0, 0.0, -3.0], [6.0, 0.0, 0.0], [0.0, 2.5, 0.0])],
    );
    let clear = SurfaceDesc::Dielectric {
        ior: 1.4,
        transmittance: [0.9, 1.0, 0.9],
    };
    b.add(material("clear", clear), [sphere([1.2, 0.5, 0.4], 0.5)]);
    let mut tip = sheet([-0.4, 2.4, 0.0], [0.8, 0.0, 0.0], [0.0, 0.0, 0.8]);
    tip.triangles.truncate(1);
    b.add(
        MaterialDesc {
            emission: color([5.0, 3.0, 2.0]),
            ..material("tip", matte([0.3; 3]))
        },
        [tip],
    );
    b.light(
        PunctualKind::Point {
            position: Vec3::new(2.0, 2.0, 2.0),
        },
        [4.0, 4.0, 5.0],
    );
    b.light(
        PunctualKind::Point {
            position: Vec3::new(-2.0, 1.0, 2.0),
        },
        [1.0, 0.5, 0.2],
    );
    let down = Vec3::new(0.2, -1.0, -0.3).normalize();
    b.light(
        PunctualKind::Spot {
            position: Vec3::new(-1.0, 3.0, 1.0),
            direction: down,
            inner: 0.3,
            outer: 0.5,
        },
        [12.0, 10.0, 8.0],
    );
    b.light(
        PunctualKind::Directional {
            direction: Vec3::new(-0.4, -0.8, -0.3).normalize(),
        },
        [0.6, 0.7, 0.8],
    );
    b.camera("front", [0.0, 1.6, 5.0], [0.0, 0.7, 0.0], PERSPECTIVE);
    b.finish()
}

/// One matte triangle; no light, no camera.
pub fn triangle() -> SceneDesc {
    let mut b = Builder::new("triangle");
    let mut mesh = sheet([-1.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]);
    mesh.triangles.truncate(1);
    b.add(material("matte", matte([0.5; 3])), [mesh]);
    b.finish()
}
