//! A scene's buffers full of random numbers, and the formulas that are run over them.

use residual_render::alias_table::AliasEntry;
use residual_render::camera::{CameraRecord, PixelConeRecord};
use residual_render::domain::tape::{Function, Node, Op, Statement};
use residual_render::domain::{Buffer, Domain};
use residual_render::light::{
    AreaRecord, EnvironmentHeader, LIGHT_WORDS, PunctualRecord, SceneSphereRecord, set_environment,
    set_picks,
};
use residual_render::record::BufferRecord;
use residual_render::scene_data::SceneData;
use residual_render::surface::TangentRecord;
use residual_render::texture::ImageParam;
use residual_render::tracer::MediumRecord;
use residual_render::triangle::TriangleRecord;

/// Words of a triangle's parameters.
pub(crate) const BLOCK: u32 = ALBEDOS + 3584;
/// In a block: an image's slot.
pub(crate) const IMAGE: u32 = 48;
/// In a block: the medium behind a surface.
pub(crate) const MEDIUM: u32 = 60;
/// How many media there are.
pub(crate) const MEDIA: u32 = 32;
/// In a block: a texture's transform.
pub(crate) const TRANSFORM: u32 = 52;
/// In a block: albedos of a rough dielectric.
pub(crate) const ALBEDOS: u32 = 64;
/// How many triangles there are.
pub(crate) const TRIANGLES: u32 = 4;

/// Random numbers.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn word(&mut self) -> u32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.0 ^ (self.0 >> 22)) >> 29) as u32
    }

    /// In [0, 1).
    pub(crate) fn unit(&mut self) -> f32 {
        (self.word() >> 8) as f32 / 16_777_216.0
    }

    /// In [low, high).
    pub(crate) fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// A unit vector.
    pub(crate) fn direction(&mut self) -> [f32; 3] {
        loop {
            let v = [0; 3].map(|_| self.between(-1.0, 1.0));
            let square: f32 = v.iter().map(|c| c * c).sum();
            if square > 1e-3 && square < 1.0 {
                return v.map(|c| c / square.sqrt());
            }
        }
    }
}

/// Triangles with every attribute, images, five lights of five kinds, an environment and a camera.
pub(crate) fn scene() -> SceneData {
    let mut random = Random(7);
    let mut data = SceneData::default();
    let vertices = 3 * TRIANGLES;
    let mut fill = |buffer: Buffer, words: u32, low: f32, high: f32| {
        let words = (0..words).map(|_| random.between(low, high).to_bits());
        data.buffer_mut(buffer).extend(words);
    };
    fill(Buffer::Normals, 4 * vertices, -1.0, 1.0);
    fill(Buffer::Tangents, 4 * vertices, -1.0, 1.0);
    fill(Buffer::Uvs, 4 * vertices, -2.0, 2.0);
    fill(Buffer::Colors, 4 * vertices, 0.0, 1.0);
    fill(Buffer::Params, BLOCK * TRIANGLES, 0.05, 1.0);
    fill(Buffer::Texels, 4 * 64, 0.0, 1.0);
    fill(Buffer::Media, MediumRecord::WORDS * MEDIA, 0.1, 0.9);
    fill(Buffer::Lights, LIGHT_WORDS * 5, -1.0, 1.0);
    let mut vector = || [0; 3].map(|_| random.between(-1.0, 1.0)).into();
    data.push(CameraRecord {
        eye: vector(),
        lens_radius: 0.25,
        right: vector(),
        frame_width: 0.0,
        up: vector(),
        frame_height: 1.0,
        forward: vector(),
        focus_distance: 2.5,
    });
    let cone = PixelConeRecord {
        parallel: 0.0,
        spread: 1.0,
        turn: 0.0,
    };
    cone.append_to(data.buffer_mut(Buffer::Camera));
    let sphere = SceneSphereRecord {
        centre: [0.1, -0.2, 0.3].into(),
        radius: 2.5,
    };
    sphere.append_to(data.buffer_mut(Buffer::Camera));
    let picks = alias_entries(&mut random, 5, 2);
    set_picks(&mut data, picks.into_iter());
    for index in 0..MEDIA as usize {
        data.change(index, |record| MediumRecord {
            above: 1 + index as u32 / 2 * 2,
            ..record
        });
    }
    let header = EnvironmentHeader {
        width: 4,
        height: 3,
        first_texel: 0,
        strength: 1.5,
        cos: 0.6,
        sin: 0.8,
        light: 4,
    };
    let texels = alias_entries(&mut random, 12, 5);
    set_environment(&mut data, header, texels.into_iter());
    for triangle in 0..TRIANGLES {
        let corners = [[0; 3]; 3].map(|corner| corner.map(|_| random.between(-2.0, 2.0)));
        let first = 3 * triangle;
        data.push(TriangleRecord {
            params: BLOCK * triangle,
            ..TriangleRecord::new(corners).with_vertices([first, first + 1, first + 2])
        });
        if triangle > 0 {
            data.set_light(triangle as usize, 0);
        }
        for vertex in 0..3 {
            let sign = if triangle % 2 == 0 { 1.0 } else { -1.0 };
            let vertex = (3 * triangle + vertex) as usize;
            data.change(vertex, |record| TangentRecord { sign, ..record });
        }
        data.buffer_mut(Buffer::Params)[(BLOCK * triangle + MEDIUM) as usize] = 1 + triangle % 3;
        let slot = (BLOCK * triangle + IMAGE) as usize;
        let image = ImageParam {
            first: 4 * triangle,
            width: 5,
            height: 3,
            levels: 0,
        };
        image.write_to(&mut data.buffer_mut(Buffer::Params)[slot..]);
    }
    let lights = data.buffer_mut(Buffer::Lights);
    let records = lights.chunks_exact_mut(LIGHT_WORDS as usize);
    for (kind, words) in (0..).zip(records) {
        if kind == 0 {
            let lamp = AreaRecord {
                kind,
                triangle: 1,
                double_sided: 1,
            };
            lamp.write_to(words);
        } else {
            let record = PunctualRecord::from_words(words);
            PunctualRecord { kind, ..record }.write_to(words);
        }
    }
    data
}

/// A table of random densities, which no weights have; the alias of each slot is `shift` slots on.
fn alias_entries(random: &mut Random, count: u32, shift: u32) -> Vec<AliasEntry> {
    let mut number = || random.between(0.05, 1.0);
    let entry = |slot| AliasEntry {
        threshold: number(),
        alias: (slot + shift) % count,
        density: number(),
        alias_density: number(),
    };
    (0..count).map(entry).collect()
}

/// What a formula yields.
pub(crate) struct Yield<D: Domain> {
    pub(crate) reals: Vec<D::F>,
    pub(crate) words: Vec<D::U>,
    pub(crate) truths: Vec<D::M>,
}

impl<D: Domain> Yield<D> {
    pub(crate) fn new() -> Self {
        Self {
            reals: vec![],
            words: vec![],
            truths: vec![],
        }
    }

    pub(crate) fn real(&mut self, value: D::F) {
        self.reals.push(value);
    }

    pub(crate) fn vector(&mut self, value: residual_render::math::Vec3<D::F>) {
        self.reals.extend([value.x, value.y, value.z]);
    }
}

/// A formula, whatever its domain.
pub(crate) trait Formula {
    /// How it appears in messages.
    fn name(&self) -> String;
    /// Arguments for one run: real numbers and words.
    fn arguments(&self, random: &mut Random) -> (Vec<f32>, Vec<u32>);
    /// Runs it.
    fn run<D: Domain>(&self, d: D, reals: &[D::F], words: &[D::U]) -> Yield<D>;
}

pub(crate) fn count(statements: &[Statement], wanted: &impl Fn(&Statement) -> bool) -> usize {
    let inner = |statement: &Statement| match statement {
        Statement::Let(_) => 0,
        Statement::If {
            then, otherwise, ..
        } => count(then, wanted) + count(otherwise, wanted),
    };
    statements
        .iter()
        .map(|s| usize::from(wanted(s)) + inner(s))
        .sum()
}

pub(crate) fn ifs(function: &Function) -> usize {
    count(&function.body, &|s| matches!(s, Statement::If { .. }))
}

pub(crate) fn loads(function: &Function, wanted: Buffer) -> usize {
    count(&function.body, &|s| match s {
        Statement::Let(id) => {
            matches!(function.node(*id), Node::Load { buffer, .. } if buffer == wanted)
        }
        Statement::If { .. } => false,
    })
}

pub(crate) fn ops(function: &Function, wanted: Op) -> usize {
    count(&function.body, &|s| match s {
        Statement::Let(id) => {
            matches!(function.node(*id), Node::Apply { op, .. } if op == wanted)
        }
        Statement::If { .. } => false,
    })
}
