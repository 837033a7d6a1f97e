//! How many packets the triangles of a subtree take as one leaf, which is what the leaf costs.

use crate::layout::compact::LANES;

/// Packets in the largest leaf considered.
pub(crate) const MAX_LEAF_PACKETS: usize = 4;

/// What is known of a subtree's triangles, from its leaves up, until there are too many for a leaf.
pub(crate) trait LeafSize<const P: usize>: Send + Sized {
    /// Of one triangle.
    fn of_triangle(corners: &[[f32; 3]; 3]) -> Self;
    /// Of the triangles of both.
    fn join(self, other: Self) -> Self;
    /// How many packets, if they are few enough.
    fn packets(&self) -> Option<usize>;
}

/// Packets have room for `P` triangles.
pub(crate) struct Triangles(usize);

impl<const P: usize> LeafSize<P> for Triangles {
    fn of_triangle(_: &[[f32; 3]; 3]) -> Triangles {
        Triangles(1)
    }

    fn join(self, other: Triangles) -> Triangles {
        Triangles(self.0 + other.0)
    }

    fn packets(&self) -> Option<usize> {
        Some(self.0.div_ceil(P)).filter(|&packets| packets <= MAX_LEAF_PACKETS)
    }
}

/// Packets have room for as many vertices as triangles.
pub(crate) struct Vertices {
    triangles: Triangles,
    /// The bits of their coordinates, in order, each vertex once; none where they are too many.
    vertices: Option<Vec<[u32; 3]>>,
}

impl LeafSize<LANES> for Vertices {
    fn of_triangle(corners: &[[f32; 3]; 3]) -> Vertices {
        let mut vertices = corners.map(|corner| corner.map(f32::to_bits)).to_vec();
        vertices.sort_unstable();
        vertices.dedup();
        Vertices {
            triangles: Triangles(1),
            vertices: Some(vertices),
        }
    }

    fn join(self, other: Vertices) -> Vertices {
        let both = self.vertices.zip(other.vertices);
        let vertices = both.map(|(mut vertices, others)| {
            vertices.extend(others);
            // Two runs that are in order each: a merge.
            vertices.sort();
            vertices.dedup();
            vertices
        });
        Vertices {
            triangles: LeafSize::<LANES>::join(self.triangles, other.triangles),
            vertices: vertices.filter(|vertices| vertices.len() <= MAX_LEAF_PACKETS * LANES),
        }
    }

    /// At least so many: how well the triangles can be distributed is not known yet.
    fn packets(&self) -> Option<usize> {
        let for_triangles = LeafSize::<LANES>::packets(&self.triangles)?;
        let for_vertices = self.vertices.as_ref()?.len().div_ceil(LANES);
        Some(for_triangles.max(for_vertices))
    }
}
