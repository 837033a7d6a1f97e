//! What is stored of a triangle.

use crate::domain::{Buffer, Buffers, Domain, Scalar, Uint};
use crate::math::Vec3;
use crate::record::{Offsets, record};

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
        row {
            /// Index of its program.
            program: word,
            /// First vertex, as an index into the buffers of attributes. Of no meaning where its program reads none.
            vertex_a: word,
            /// Second vertex.
            vertex_b: word,
            /// Third vertex.
            vertex_c: word,
        }
    }
}

// As large as a cache line: what is read of a triangle that was hit waits for memory once.
const _: () = assert!(TriangleRecord::WORDS == 16);

impl TriangleRecord {
    /// A triangle of object 0 and program 0 with the parameters from word 0 on, without vertices, and no light.
    pub fn new(corners: [[f32; 3]; 3]) -> Self {
        let [a, b, c] = corners.map(Vec3::from);
        Self {
            a,
            params: 0,
            b,
            light: NO_LIGHT,
            c,
            object: 0,
            program: 0,
            vertex_a: 0,
            vertex_b: 0,
            vertex_c: 0,
        }
    }

    /// The triangle with these vertices.
    pub fn with_vertices(self, [vertex_a, vertex_b, vertex_c]: [u32; 3]) -> Self {
        Self {
            vertex_a,
            vertex_b,
            vertex_c,
            ..self
        }
    }

    /// The vertices.
    pub fn vertices(&self) -> [u32; 3] {
        [self.vertex_a, self.vertex_b, self.vertex_c]
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

/// The word of a record that its last row begins with.
#[inline(always)]
fn last_row<D: Domain>(d: D, triangle: D::U) -> D::U {
    let first = TriangleRecord::<Offsets>::offsets().program;
    triangle * d.uint(TriangleRecord::WORDS) + d.uint(first)
}

/// The index of a triangle's program.
#[inline(always)]
pub fn program_of<D: Domain>(d: D, triangle: D::U) -> D::U {
    d.load(Buffer::Triangles, last_row(d, triangle))
}

/// The vertices of a triangle.
#[inline(always)]
pub fn vertices_of<D: Domain>(d: D, triangle: D::U) -> [D::U; 3] {
    let [[_, a, b, c]] = d.load_rows(Buffer::Triangles, last_row(d, triangle));
    [a, b, c]
}

/// [`program_of`] outside formulas.
#[inline(always)]
pub fn program_in(buffers: &Buffers<'_>, triangle: u32) -> u32 {
    program_of(Scalar::new(buffers), Uint(triangle)).0
}
