//! What is shaded: hits on a patch of triangles, the same for every program, and the images on it.
//!
//! The hits come in the order of a coherent stream: [`HITS`] of them on [`TRIANGLES`] triangles, 32 neighbours at random
//! places of the eight triangles around theirs. The patch spans 256² of the 1024² texels of each image, so these 32 fall on
//! 32 × 16 texels; colours and numbers are noise.

use residual_bvh::{Hit, Ray};
use residual_device_cpu::Traversal;
use residual_device_cpu::traversal::AlphaFilter;
use residual_render::alias_table::alias_entries;
use residual_render::camera::CameraRecord;
use residual_render::domain::Buffer;
use residual_render::light::{PunctualRecord, push_light, set_picks};
use residual_render::scene_data::SceneData;
use residual_render::surface::UvRecord;
use residual_render::texture::ImageParam;
use residual_render::triangle::TriangleRecord;

use crate::rays::random;

/// Paths under way: as many as a tile has.
pub const HITS: usize = 4096;
/// Triangles of the patch.
pub const TRIANGLES: usize = 2 * CELLS[0] * CELLS[1];
/// Cells of two triangles along and across the patch.
const CELLS: [usize; 2] = [32, 16];

/// Width and height of the images.
const SIDE: u32 = 1024;
/// Part of the images' sides that the patch spans.
const SPAN: f32 = 0.25;
/// The sRGB images.
pub(super) const COLOR_IMAGES: [u32; 4] = [0, 1, 2, 3];
/// The linear image.
pub(super) const NUMBER_IMAGE: u32 = 4;
const IMAGES: u32 = 5;

/// An image among the texels.
pub(super) fn image_param(image: u32) -> ImageParam {
    ImageParam {
        first: image * SIDE * SIDE,
        width: SIDE,
        height: SIDE,
        levels: 0,
    }
}

/// The patch once for each program, with the program's parameters; two lights, one on each side of it; images; a camera
/// that looks at it.
pub(super) fn data(params_of_programs: &[Vec<u32>]) -> SceneData {
    let mut data = SceneData::default();
    let [columns, rows] = CELLS;
    // Gently bumped, so that no two normals are the same.
    let corner = |column: usize, row: usize| {
        let (x, y) = (column as f32 / columns as f32, row as f32 / rows as f32);
        [
            4.0 * x - 2.0,
            4.0 * y - 2.0,
            0.1 * random(row * (columns + 1) + column),
        ]
    };
    let vertex = |column, row| (row * (columns + 1) + column) as u32;
    for (program, params) in params_of_programs.iter().enumerate() {
        let first = data.buffer(Buffer::Params).len() as u32;
        data.buffer_mut(Buffer::Params).extend(params);
        for cell in 0..columns * rows {
            let (x, y) = (cell % columns, cell / columns);
            for corners in [
                [(x, y), (x + 1, y), (x + 1, y + 1)],
                [(x, y), (x + 1, y + 1), (x, y + 1)],
            ] {
                data.push(TriangleRecord {
                    params: first,
                    program: program as u32,
                    ..TriangleRecord::new(corners.map(|(x, y)| corner(x, y)))
                        .with_vertices(corners.map(|(x, y)| vertex(x, y)))
                });
            }
        }
    }
    for row in 0..=rows {
        for column in 0..=columns {
            let u = SPAN * column as f32 / columns as f32;
            let v = SPAN * row as f32 / rows as f32;
            data.push(UvRecord {
                u0: u,
                v0: v,
                u1: u,
                v1: v,
            });
        }
    }
    // Bright enough that paths live on.
    let byte = |index: usize| 0x80 | (random(index) * 128.0) as u32;
    let texels = (0..(IMAGES * SIDE * SIDE) as usize).map(|texel| {
        let [r, g, b] = [0, 1, 2].map(|channel| byte(3 * texel + channel));
        r | g << 8 | b << 16 | 0xff00_0000
    });
    data.buffer_mut(Buffer::Texels).extend(texels);
    set_lights(&mut data, [[0.5, 0.7, 2.0], [0.5, 0.7, -2.0]]);
    data.push(CameraRecord {
        eye: [0.0, 0.0, 3.0].into(),
        lens_radius: 0.0,
        right: [1.0, 0.0, 0.0].into(),
        frame_width: 0.0,
        up: [0.0, 1.0, 0.0].into(),
        frame_height: 1.0,
        forward: [0.0, 0.0, -2.0].into(),
        focus_distance: 0.0,
    });
    data
}

/// Two point lights of the structure's only kind, picked evenly.
fn set_lights(data: &mut SceneData, positions: [[f32; 3]; 2]) {
    for position in positions {
        push_light(data, PunctualRecord::new(0, position, [1.0; 3]));
    }
    set_picks(data, alias_entries(&[0.5; 2], 1.0));
}

/// A traversal that needs no time: every ray hits the patch of one program, whatever its direction, and every shadow ray is
/// blocked.
pub(super) struct Hits(Vec<Hit>);

impl Hits {
    pub(super) fn on(program: usize) -> Self {
        let triangle_at = |hit: usize| {
            let around = hit * TRIANGLES / HITS / 8 * 8 + (random(3 * hit) * 8.0) as usize;
            (program * TRIANGLES + around) as u32
        };
        let hit = |index: usize| {
            let (u, v) = (random(3 * index + 1), random(3 * index + 2));
            let (u, v) = if u + v > 1.0 {
                (1.0 - u, 1.0 - v)
            } else {
                (u, v)
            };
            Hit {
                t: 1.0,
                u,
                v,
                prim: triangle_at(index),
            }
        };
        Self((0..HITS).map(hit).collect())
    }
}

impl Traversal for Hits {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], _: Option<&AlphaFilter<'_>>) {
        let count = rays.len();
        hits[..count].copy_from_slice(&self.0[..count]);
    }

    fn any_hits(&self, _: &[Ray], occluded: &mut [bool], _: Option<&AlphaFilter<'_>>) {
        occluded.fill(true);
    }
}
