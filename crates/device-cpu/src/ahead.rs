//! What sorting and shading read of the triangles that were hit, on its way to the caches before they get there: hits lie
//! anywhere in the scene, and each read would wait for memory.

use residual_bvh::prefetch;
use residual_render::domain::{Buffer, Buffers};
use residual_render::record::IndexedRecord;
use residual_render::surface::{
    Attributes, ColorRecord, NormalRecord, TangentRecord, UvRecord, VerticesRecord,
};
use residual_render::triangle::TriangleRecord;

/// So many hits ahead sorting asks for programs. Half and twice as many take as long.
pub(crate) const PROGRAMS_AHEAD: usize = 24;

/// Asks for the index of a triangle's program.
#[inline(always)]
pub(crate) fn program(buffers: &Buffers<'_>, triangle: u32) {
    prefetch(buffers.get(Buffer::TrianglePrograms), triangle as usize);
}

/// Asks for a triangle, and for the indices of its vertices if a material reads any of their attributes.
#[inline(always)]
pub(crate) fn triangle(buffers: &Buffers<'_>, triangle: u32, attributes: Attributes) {
    record::<TriangleRecord>(buffers, triangle);
    if attributes != Attributes::NONE {
        record::<VerticesRecord>(buffers, triangle);
    }
}

/// Asks for the attributes of a triangle's vertices, whose indices had better be there.
#[inline(always)]
pub(crate) fn vertices(buffers: &Buffers<'_>, triangle: u32, attributes: Attributes) {
    if attributes == Attributes::NONE {
        return;
    }
    let first = triangle.wrapping_mul(VerticesRecord::WORDS);
    let [[a, b, c, _]] = *buffers.rows::<1>(Buffer::Indices, first);
    for vertex in [a, b, c] {
        if attributes.normals {
            record::<NormalRecord>(buffers, vertex);
        }
        if attributes.tangents {
            record::<TangentRecord>(buffers, vertex);
        }
        if attributes.uv0 || attributes.uv1 {
            record::<UvRecord>(buffers, vertex);
        }
        if attributes.colors {
            record::<ColorRecord>(buffers, vertex);
        }
    }
}

/// Asks for a record, which may lie in two lines.
#[inline(always)]
fn record<R: IndexedRecord>(buffers: &Buffers<'_>, index: u32) {
    const LINE: u32 = 16;
    let words = buffers.get(R::BUFFER);
    let first = index as usize * R::WORDS as usize;
    prefetch(words, first);
    if !LINE.is_multiple_of(R::WORDS) {
        prefetch(words, first + R::WORDS as usize - 1);
    }
}
