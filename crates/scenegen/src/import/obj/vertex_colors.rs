//! Colours of vertices, behind the numbers of `v`: display values, for as many vertices as have them.

use glam::{Vec3, Vec4};
use residual_render::texture::srgb_decoded;

use crate::import::warnings::Warnings;

/// The colours of all vertices, or nothing where no vertex has one.
#[derive(Default)]
pub(super) struct VertexColors(Vec<Option<Vec3>>);

impl VertexColors {
    /// Bytes of a vertex.
    pub(super) const BYTES: u64 = size_of::<Option<Vec3>>() as u64;

    /// Whether a vertex has a colour.
    pub(super) fn is_some(&self) -> bool {
        !self.0.is_empty()
    }

    /// Appends that of the vertex with the given index.
    pub(super) fn push(&mut self, color: Option<[f32; 3]>, vertex: usize) {
        if color.is_some() || self.is_some() {
            self.0.resize(vertex, None);
            self.0.push(color.map(Vec3::from));
        }
    }

    /// Gives the last vertices of so many colours of their own, which are display values in [0, 1]. Returns how many
    /// there are too many.
    pub(super) fn paint_last(&mut self, colors: &[[f32; 3]], vertices: usize) -> usize {
        let count = colors.len().min(vertices);
        self.0.resize(vertices.max(self.0.len()), None);
        let painted = &mut self.0[vertices - count..vertices];
        for (color, &paint) in painted.iter_mut().zip(colors) {
            *color = Some(paint.into());
        }
        colors.len() - count
    }

    /// That of a vertex as stored in the file.
    pub(super) fn get(&self, vertex: usize) -> Option<Vec3> {
        *self.0.get(vertex)?
    }

    /// Makes linear light of them. Programs write what a display gets, in [0, 1] or as bytes.
    pub(super) fn linearize(&mut self, warnings: &mut Warnings) {
        let colors = || self.0.iter().flatten();
        // NaN where a word is no number.
        let largest = colors()
            .map(|color| color.max_element())
            .fold(0.0, f32::max);
        let are_bytes = largest > 1.0
            && largest <= 255.0
            && colors().all(|color| color.is_nan() || color.fract() == Vec3::ZERO);
        let scale = if are_bytes { 1.0 / 255.0 } else { 1.0 };
        if are_bytes {
            warnings.push(
                "v",
                "vertex colours are whole numbers beyond 1 and read as bytes",
            );
        }
        let (mut unreadable, mut clamped) = (0, 0);
        for color in self.0.iter_mut() {
            let Some(stored) = color else { continue };
            let scaled = *stored * scale;
            if scaled.is_nan() {
                unreadable += 1;
                *color = None;
                continue;
            }
            let inside = scaled.clamp(Vec3::ZERO, Vec3::ONE);
            clamped += usize::from(inside != scaled);
            *stored = inside.map(|value| srgb_decoded(f64::from(value)) as f32);
        }
        for (count, message) in [
            (unreadable, "vertex colours lack a number; white is used"),
            (clamped, "vertex colours are outside of 0 to 1 and clamped"),
        ] {
            if count > 0 {
                warnings.push("v", format!("{count} {message}"));
            }
        }
    }

    /// Those of a mesh whose vertices are the given ones; white where others have a colour, nothing where none has.
    pub(super) fn of(&self, vertices: &[usize]) -> Option<Vec<Vec4>> {
        let has_any = vertices.iter().any(|&vertex| self.get(vertex).is_some());
        let color = |&vertex| self.get(vertex).unwrap_or(Vec3::ONE).extend(1.0);
        has_any.then(|| vertices.iter().map(color).collect())
    }
}
