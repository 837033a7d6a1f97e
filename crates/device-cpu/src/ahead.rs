//! What sorting and shading read of the triangles that were hit, on its way to the caches before they get there: hits lie
//! anywhere in the scene, and each read would wait for memory.

use residual_bvh::prefetch;
use residual_render::domain::{Buffers, Scalar, Uint};
use residual_render::record::IndexedRecord;
use residual_render::surface::{Attributes, ColorRecord, NormalRecord, TangentRecord, UvRecord};
use residual_render::triangle::{TriangleRecord, vertices_of};

/// So many hits ahead sorting asks for programs. Half and twice as many take as long.
pub(crate) const PROGRAMS_AHEAD: usize = 24;

/// Asks for a triangle.
#[inline(always)]
pub(crate) fn triangle(buffers: &Buffers<'_>, triangle: u32) {
    record::<TriangleRecord>(buffers, triangle);
}

/// Asks for the attributes of a triangle's vertices, whose indices had better be there.
#[inline(always)]
pub(crate) fn vertices(buffers: &Buffers<'_>, triangle: u32, attributes: Attributes) {
    if attributes == Attributes::NONE {
        return;
    }
    for Uint(vertex) in vertices_of(Scalar::new(buffers), Uint(triangle)) {
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

/// Asks for a record, which may lie in two lines: buffers begin with a row, but not with a line.
#[inline(always)]
fn record<R: IndexedRecord>(buffers: &Buffers<'_>, index: u32) {
    const ROW: u32 = 4;
    let words = buffers.get(R::BUFFER);
    let first = index as usize * R::WORDS as usize;
    prefetch(words, first);
    if R::WORDS > ROW {
        prefetch(words, first + R::WORDS as usize - 1);
    }
}
