//! A hierarchy whose vertices moved: the same tree with new boxes.

use rayon::prelude::*;

use crate::bounds::Bounds;
use crate::build::collapse::PACKET_COST;
use crate::build::mesh::has_area;
use crate::layout::bvh::Bvh;
use crate::layout::child::Child;
use crate::layout::triangle_packet::{SINGLE_SIDED, TrianglePacket};

impl<const N: usize, const P: usize> Bvh<N, P> {
    /// Moves the triangles to where `positions` has their vertices now.
    ///
    /// The tree keeps its shape, so it gets worse as the mesh departs from the one it was built
    /// for: [`sah_cost`](Bvh::sah_cost) tells by how much. Answers are those of a new build. A
    /// triangle that has lost its area, or has a vertex that is not finite, is not hit until a later
    /// call finds it sound again; those that were left out by [`build`](crate::build) stay out.
    ///
    /// Where the build split triangles, a leaf's box is now around all of each triangle in it: right,
    /// but larger. A mesh that is to be moved is better built with
    /// [`BuildQuality::Medium`](crate::BuildQuality).
    ///
    /// # Panics
    /// If there are fewer triangles than there were, or a vertex index is out of range. Then some
    /// triangles have moved and others have not.
    pub fn refit(&mut self, positions: &[[f32; 3]], triangles: &[[u32; 3]]) {
        let vertices =
            |prim: u32| triangles[prim as usize].map(|vertex| positions[vertex as usize]);
        let boxes: Vec<Bounds> = self
            .packets
            .par_iter_mut()
            .map(|packet| move_packet(packet, vertices))
            .collect();

        // Children follow their parents, so the boxes below a node are there before it asks.
        let mut bounds = vec![Bounds::EMPTY; self.nodes.len()];
        for index in (0..self.nodes.len()).rev() {
            let node = &mut self.nodes[index];
            for slot in 0..N {
                let child = Child(node.children[slot]);
                let below = if child.is_leaf() {
                    let first = child.first_packet();
                    boxes[first..first + child.packet_count()]
                        .iter()
                        .fold(Bounds::EMPTY, |all, packet| all.union(packet))
                } else {
                    bounds[child.0 as usize]
                };
                node.set_child(slot, &below, child);
                bounds[index] = bounds[index].union(&below);
            }
        }
        self.sah_cost = self.measure_cost(&bounds);
    }

    /// As the builder counts it. `bounds` are those of the nodes.
    fn measure_cost(&self, bounds: &[Bounds]) -> f32 {
        let mut cost = 0.0;
        for (node, bounds) in self.nodes.iter().zip(bounds) {
            cost += bounds.half_area();
            for slot in 0..N {
                let child = Child(node.children[slot]);
                if child.is_leaf() {
                    let tests = PACKET_COST * child.packet_count() as f32;
                    cost += f64::from(tests) * node.child_bounds(slot).half_area();
                }
            }
        }
        let root = bounds[0].half_area();
        if root > 0.0 {
            (cost / root) as f32
        } else {
            0.0
        }
    }
}

/// Rewrites the packet's triangles, NaN for those that cannot be hit, and returns the box around the
/// others' padded boxes.
fn move_packet<const P: usize>(
    packet: &mut TrianglePacket<P>,
    vertices: impl Fn(u32) -> [[f32; 3]; 3],
) -> Bounds {
    let mut bounds = Bounds::EMPTY;
    let marked = packet.prim_ids.into_iter().enumerate();
    for (lane, marked) in marked.filter(|&(_, marked)| marked != u32::MAX) {
        let mut moved = vertices(marked & !SINGLE_SIDED);
        if has_area(&moved) {
            bounds = bounds.union(&Bounds::of_padded_triangle(&moved));
        } else {
            moved = [[f32::NAN; 3]; 3];
        }
        packet.set_corners(lane, moved);
    }
    bounds
}
