//! What is stored of a triangle.

use crate::domain::{Buffer, Buffers, Domain, Scalar, Uint};
use crate::math::Vec3;
use crate::record::record;

/// In [`TriangleRecord::light`]: the triangle is no light.
pub const NO_LIGHT: u32 = u32::MAX;

record! {
    /// A triangle. Its front is where its corners run counter-clockwise.
    pub struct TriangleRecord in Triangles {
        row {
            /// First corner, world space.
            a: vector,
            /// First word of the material's parameters in [`Buffer::Params`].
            params: word,
        }
        row {
            /// Second corner.
            b: vector,
            /// Index of the light that the triangle is, or [`NO_LIGHT`].
            light: word,
        }
        row {
            /// Third corner.
            c: vector,
            /// Index of the object that it belongs to.
            object: word,
        }
    }
}

const _: () = assert!(TriangleRecord::WORDS == 12);

impl TriangleRecord {
    /// A triangle of object 0 with the parameters from word 0 on, and no light.
    pub fn new(corners: [[f32; 3]; 3]) -> Self {
        let [a, b, c] = corners.map(Vec3::from);
        Self {
            a,
            params: 0,
            b,
            light: NO_LIGHT,
            c,
            object: 0,
        }
    }

    /// The corners, world space.
    pub fn corners(&self) -> [[f32; 3]; 3] {
        [self.a, self.b, self.c].map(Vec3::to_array)
    }
}

record! {
    /// An object: what one instance of a mesh has become.
    pub struct ObjectRecord in Objects {
        row {
            /// Index of its material in the scene's description.
            material: word,
            /// [Id](crate::cryptomatte::id) of its name.
            name_id: real,
            /// Id of its material's name.
            material_name_id: real,
        }
    }
}

/// The index of a triangle's program.
#[inline(always)]
pub fn program_of<D: Domain>(d: D, triangle: D::U) -> D::U {
    d.load(Buffer::TrianglePrograms, triangle)
}

/// [`program_of`] outside formulas.
#[inline(always)]
pub fn program_in(buffers: &Buffers<'_>, triangle: u32) -> u32 {
    program_of(Scalar::new(buffers), Uint(triangle)).0
}
