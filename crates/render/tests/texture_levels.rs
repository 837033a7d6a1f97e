//! Levels of images beside the footprint of a pixel, computed with differentials in f64.

use residual_render::domain::{Buffer, Scalar};
use residual_render::math::vec3::vec3;
use residual_render::record::BufferRecord;
use residual_render::scene_data::SceneData;
use residual_render::surface::{Attributes, Cone, Surface, SurfaceHit, UvRecord};
use residual_render::texture::{
    Image, ImageParam, LinearFloat, Repeat, ScalarSource, TransformParam, Trilinear, UvMap,
};
use residual_render::triangle::TriangleRecord;

use crate::support::random::Rng;
use crate::support::scenes::{FLOOR, scene};

const ATTRIBUTES: Attributes = Attributes {
    uv0: true,
    ..Attributes::NONE
};

/// The floor with so many repetitions of an image for a unit of length, each of whose levels is of its number.
fn leveled(
    [width, height]: [u32; 2],
    repetitions: [f32; 2],
    transform: TransformParam,
) -> SceneData {
    let mut data = scene(&[FLOOR]);
    data.change(0, |floor: TriangleRecord| floor.with_vertices([0, 1, 2]));
    for [x, y, _] in FLOOR {
        data.push(UvRecord {
            u0: x * repetitions[0],
            v0: y * repetitions[1],
            u1: 0.0,
            v1: 0.0,
        });
    }
    let count = width.max(height).ilog2() + 1;
    let size = |level: u32| [width, height].map(|side| (side >> level).max(1));
    let mut first = count * 4;
    for level in 0..count {
        let [width, height] = size(level);
        let record = ImageParam {
            first,
            width,
            height,
            levels: 0,
        };
        record.append_to(data.buffer_mut(Buffer::Texels));
        if level == 0 {
            record.append_to(data.buffer_mut(Buffer::Params));
        }
        first += 4 * width * height;
    }
    transform.append_to(data.buffer_mut(Buffer::Params));
    for level in 0..count {
        let [width, height] = size(level);
        let words = 4 * width * height;
        let texels = data.buffer_mut(Buffer::Texels);
        texels.extend((0..words).map(|_| (level as f32).to_bits()));
    }
    data
}

/// The level that is read on average, through a cone of this angle around a ray that arrives from a distance at an angle to the
/// normal; along x.
fn level(data: &SceneData, cone: f64, distance: f64, angle: f64, transform: Option<u32>) -> f64 {
    let image = Image {
        slot: 0,
        uv: UvMap { set: 0, transform },
        channel: 0,
        wrap: (Repeat, Repeat),
        filter: Trilinear,
        format: LinearFloat,
    };
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let hit = SurfaceHit {
        u: 0.3,
        v: 0.3,
        prim: residual_render::domain::Uint(0),
    };
    let (sin, cos) = angle.sin_cos();
    let dir = vec3(sin as f32, 0.0, -cos as f32);
    let mut surface = Surface::new(d, ATTRIBUTES, &hit, dir);
    let org = surface.point - dir.scale(distance as f32);
    let choices = 500;
    let read = |choice: i32| {
        let cone = Cone {
            width: 0.0,
            angle: cone as f32,
            random: (choice as f32 + 0.5) / choices as f32,
        };
        surface.see_through(d, cone, org, ATTRIBUTES, hit.prim);
        f64::from(image.scalar(d, &surface))
    };
    (0..choices).map(read).sum::<f64>() / f64::from(choices)
}

fn identity() -> TransformParam {
    TransformParam {
        u: vec3(1.0, 0.0, 0.0),
        v: vec3(0.0, 1.0, 0.0),
    }
}

/// Planes at any angle and distance: half of the logarithm of the texels under a square as wide as the footprint is long.
#[test]
fn levels_are_those_of_differentials() {
    let mut rng = Rng::new(200);
    for _ in 0..300 {
        let cone = 10.0_f64.powf(rng.range(-4.0, -2.5));
        let angle = rng.range(0.0, 1.4);
        let distance = 10.0_f64.powf(rng.range(0.0, 3.0));
        let repetitions = [0; 2].map(|_| 10.0_f64.powf(rng.range(-1.0, 1.0)) as f32);
        let size = [64, 32];
        let data = leveled(size, repetitions, identity());
        // The rays at the edges of the pixel meet the plane this far apart.
        let height = distance * angle.cos();
        let [near, far] = [-0.5, 0.5].map(|half| height * (angle + half * cone).tan());
        let texels: f64 = [0, 1]
            .map(|k| f64::from(repetitions[k]) * f64::from(size[k]))
            .iter()
            .product();
        let exact = ((far - near) * texels.sqrt()).log2().clamp(0.0, 6.0);
        let found = level(&data, cone, distance, angle, None);
        assert!(
            (found - exact).abs() < 0.01,
            "cone {cone}, angle {angle}, distance {distance}: {found} {exact}"
        );
    }
}

/// A transform that shows the image four times as small along one axis, and turned: one level more.
#[test]
fn transforms_of_coordinates_count() {
    let transform = TransformParam {
        u: vec3(0.0, 4.0, 0.3),
        v: vec3(-1.0, 0.0, 0.1),
    };
    let data = leveled([64, 64], [1.0; 2], transform);
    let [without, with] =
        [None, Some(4)].map(|transform| level(&data, 1e-3, 100.0, 0.3, transform));
    assert!(
        without > 1.0 && (with - without - 1.0).abs() < 0.01,
        "{without} {with}"
    );
}

/// Images of one texel, of one row, and of sides that are no powers of two: there is no level beyond the last.
#[test]
fn the_last_level_is_of_one_texel() {
    for size in [[1, 1], [9, 1], [1, 5], [63, 3], [64, 64]] {
        let data = leveled(size, [1.0; 2], identity());
        let last = f64::from(size[0].max(size[1]).ilog2());
        assert_eq!(level(&data, 0.2, 1e6, 0.5, None), last, "{size:?}");
        assert_eq!(level(&data, 1e-9, 1e-3, 0.5, None), 0.0, "{size:?}");
    }
}

/// Numbers of 16 bits, as they are stored, for all of them.
#[test]
fn halves_are_read_exactly() {
    use residual_render::texture::{LinearHalf, TexelFormat};
    let mut data = scene(&[FLOOR]);
    let all = 0..0x7c00_u32;
    let pairs = all.clone().map(|bits| bits | (0x7bff - bits) << 16);
    *data.buffer_mut(Buffer::Texels) = pairs.flat_map(|two| [two, two]).collect();
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let exact = |bits: u32| match bits >> 10 {
        0 => f64::from(bits) * 2.0_f64.powi(-24),
        exponent => (1.0 + f64::from(bits & 0x3ff) / 1024.0) * 2.0_f64.powi(exponent as i32 - 15),
    };
    for bits in all {
        let word = residual_render::domain::Uint(2 * bits);
        let color = LinearHalf.color(d, word);
        let expected = [bits, 0x7bff - bits, bits].map(exact);
        assert_eq!([color.x, color.y, color.z].map(f64::from), expected);
        for channel in 0..4 {
            let found = f64::from(LinearHalf.channel(d, word, channel));
            assert_eq!(found, exact([bits, 0x7bff - bits][channel as usize % 2]));
        }
    }
}
