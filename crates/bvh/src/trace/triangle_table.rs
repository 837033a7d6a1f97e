//! All triangles of a tiny hierarchy, and each of their vertices once.

use crate::layout::packet::Packet;

/// So many triangles, whose vertices a byte can count.
pub(crate) const MOST_TRIANGLES: usize = 85;
/// At least as many as they have.
pub(crate) const MOST_VERTICES: usize = 256;

const _: () = assert!(3 * MOST_TRIANGLES <= MOST_VERTICES);

/// A triangle of the table.
#[derive(Clone, Copy)]
pub(crate) struct Indexed {
    /// Indices of vertices.
    pub(crate) corners: [u8; 3],
    /// Index of the triangle in the mesh, with its mark.
    pub(crate) prim: u32,
}

/// The table.
pub(crate) struct TriangleTable {
    vertices: [[f32; 3]; MOST_VERTICES],
    vertex_count: usize,
    triangles: [Indexed; MOST_TRIANGLES],
    triangle_count: usize,
}

impl TriangleTable {
    /// The triangles of a hierarchy's packets, if they are few.
    #[inline(never)]
    pub(crate) fn of<const P: usize>(packets: &[impl Packet<P>]) -> Option<TriangleTable> {
        if packets.len() > MOST_TRIANGLES {
            return None;
        }
        const NONE: Indexed = Indexed {
            corners: [0; 3],
            prim: u32::MAX,
        };
        let mut table = TriangleTable {
            vertices: [[0.0; 3]; MOST_VERTICES],
            vertex_count: 0,
            triangles: [NONE; MOST_TRIANGLES],
            triangle_count: 0,
        };
        let mut index = VertexIndex::EMPTY;
        for packet in packets {
            for (lane, &prim) in packet.prim_ids().iter().enumerate() {
                // What is split among leaves is there more than once.
                if prim == u32::MAX || table.triangles().iter().any(|other| other.prim == prim) {
                    continue;
                }
                if table.triangle_count == MOST_TRIANGLES {
                    return None;
                }
                let mut corners = [0; 3];
                for (corner, position) in corners.iter_mut().zip(packet.corners(lane)) {
                    *corner = table.index_of(position, &mut index);
                }
                table.triangles[table.triangle_count] = Indexed { corners, prim };
                table.triangle_count += 1;
            }
        }
        Some(table)
    }

    #[inline(always)]
    pub(crate) fn triangles(&self) -> &[Indexed] {
        &self.triangles[..self.triangle_count]
    }

    #[inline(always)]
    pub(crate) fn vertices(&self) -> &[[f32; 3]] {
        &self.vertices[..self.vertex_count]
    }

    /// The index of a vertex, which is added if it is new.
    fn index_of(&mut self, position: [f32; 3], index: &mut VertexIndex) -> u8 {
        // Zeros of either sign are two: their tests may differ in the sign of a zero.
        let bits = position.map(f32::to_bits);
        let mut slot = VertexIndex::slot(bits);
        while let Some(vertex) = index.0[slot] {
            if self.vertices[usize::from(vertex)].map(f32::to_bits) == bits {
                return vertex;
            }
            slot = (slot + 1) % VertexIndex::SLOTS;
        }
        let vertex = self.vertex_count as u8;
        self.vertices[self.vertex_count] = position;
        self.vertex_count += 1;
        index.0[slot] = Some(vertex);
        vertex
    }
}

/// Finds vertices by the bits of their coordinates: a hash table, at most half full.
struct VertexIndex([Option<u8>; VertexIndex::SLOTS]);

impl VertexIndex {
    const SLOTS: usize = 2 * MOST_VERTICES;
    const EMPTY: VertexIndex = VertexIndex([None; VertexIndex::SLOTS]);

    fn slot([x, y, z]: [u32; 3]) -> usize {
        let mixed = (x.wrapping_mul(0x9e37_79b1) ^ y.rotate_left(11)).wrapping_mul(0x85eb_ca77)
            ^ z.rotate_left(7);
        (mixed.wrapping_mul(0xc2b2_ae3d) >> 16) as usize % VertexIndex::SLOTS
    }
}
