//! Triangles as a file gives them.

use glam::{Vec2, Vec3, Vec4};

use crate::import::warnings::Warnings;

/// Vertices and triangles, with attribute arrays of the same length and indices in range, but with any
/// bits in the floats.
#[derive(Debug, Default)]
pub(in crate::import) struct RawMesh {
    /// Positions.
    pub(in crate::import) positions: Vec<Vec3>,
    /// Normals of any length.
    pub(in crate::import) normals: Option<Vec<Vec3>>,
    /// Tangents of any length.
    pub(in crate::import) tangents: Option<Vec<Vec4>>,
    /// Texture coordinates.
    pub(in crate::import) uvs: [Option<Vec<Vec2>>; 2],
    /// The numbers of the two sets in the file.
    pub(in crate::import) uv_sets: [u32; 2],
    /// Colours.
    pub(in crate::import) colors: Option<Vec<Vec4>>,
    /// Corners.
    pub(in crate::import) triangles: Vec<[u32; 3]>,
}

impl RawMesh {
    /// Drops triangles with non-finite corners and replaces other non-finite values by harmless ones.
    pub(super) fn drop_non_finite(&mut self, place: &str, warnings: &mut Warnings) {
        let before = self.triangles.len();
        let positions = &self.positions;
        self.triangles.retain(|corners| {
            corners
                .iter()
                .all(|&corner| positions[corner as usize].is_finite())
        });
        let dropped = before - self.triangles.len();
        if dropped > 0 {
            warnings.push(
                place,
                format!(
                    "{dropped} of {before} triangles have NaN or infinite corners and are dropped"
                ),
            );
        }
        replace_non_finite(&mut self.positions, Vec3::is_finite, Vec3::ZERO);
        for uvs in self.uvs.iter_mut().flatten() {
            let replaced = replace_non_finite(uvs, Vec2::is_finite, Vec2::ZERO);
            if replaced > 0 {
                warnings.push(
                    place,
                    format!("{replaced} texture coordinates are NaN or infinite; 0 is used"),
                );
            }
        }
        if let Some(colors) = &mut self.colors {
            clamp_colors(colors, place, warnings);
        }
    }
}

/// Forces colours into [0, 1], each component by itself; NaN becomes 1.
fn clamp_colors(colors: &mut [Vec4], place: &str, warnings: &mut Warnings) {
    let (mut unreadable, mut clamped) = (0, 0);
    for color in colors {
        if color.is_nan() {
            unreadable += 1;
            *color = Vec4::select(color.is_nan_mask(), Vec4::ONE, *color);
        }
        let inside = color.clamp(Vec4::ZERO, Vec4::ONE);
        clamped += usize::from(inside != *color);
        *color = inside;
    }
    for (count, message) in [
        (unreadable, "vertex colours are NaN; 1 is used"),
        (clamped, "vertex colours are outside of 0 to 1 and clamped"),
    ] {
        if count > 0 {
            warnings.push(place, format!("{count} {message}"));
        }
    }
}

fn replace_non_finite<T: Copy>(
    values: &mut [T],
    is_valid: impl Fn(T) -> bool,
    substitute: T,
) -> usize {
    let mut count = 0;
    for value in values.iter_mut().filter(|value| !is_valid(**value)) {
        *value = substitute;
        count += 1;
    }
    count
}
