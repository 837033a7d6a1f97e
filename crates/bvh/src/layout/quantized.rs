//! A hierarchy with nodes of half the size: the planes of a node's boxes as bytes.
//!
//! A node's planes lie on a grid: `origin + q * scale`, `q` of 0 to 255, whose step along each axis
//! is a power of two. So `q * scale` is exact, and the sum is rounded once whether an instruction
//! set fuses it or not: every decoder finds the same planes, the scalar one here among them, with
//! which boxes are rounded outwards. A box never shrinks, hence hits are those of the plain layout,
//! bit for bit; a few more boxes are entered, which takes time.
//!
//! Measured on 1.2 million triangles: boxes grow by 3 % in area, rays are 3 to 16 % slower (packets
//! with nodes of 16 a third), and nodes of 8 take 4.9 MB instead of 9.7. But triangles take 77 MB, so
//! that all in all 6 % are saved: worth it where nodes outgrow a cache, or triangles lie elsewhere.
//!
//! After H. Ylitie, T. Karras, S. Laine, "Efficient Incoherent Ray Traversal on GPUs Through
//! Compressed Wide BVHs", HPG 2017, section 3. They fold grid and ray into one multiplication a
//! plane; that rounds relative to the grid's distance instead of the plane's, which the slab
//! test's slack does not cover.

use std::mem::{align_of, offset_of, size_of};

use crate::bounds::Bounds;
use crate::layout::boxes::Boxes;
use crate::layout::boxes::sealed::Sealed;
use crate::layout::bvh::{Bvh, BvhView};
use crate::layout::child::Child;
use crate::layout::node::WideNode;
use crate::layout::triangle_packet::TrianglePacket;
use crate::simd::Width;

/// `N` child boxes on a grid of bytes, and what they hold.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct QuantizedNode<const N: usize> {
    /// Where the grid begins, `[axis]`.
    pub origin: [f32; 3],
    /// The step of the grid, `[axis]`: the exponent bits of an `f32`. 255 where the boxes reach
    /// farther than finite numbers: then all planes of the axis are 0, which decodes to NaN, and the
    /// axis keeps no ray out.
    pub exponents: [u8; 3],
    /// The first so many slots are used. No box on a grid is empty by the slab test's margin, so
    /// rays are kept out of the others by this alone.
    pub used_slots: u8,
    /// `[lo.x, hi.x, lo.y, hi.y, lo.z, hi.z]`, each `[child]`.
    pub planes: [[u8; N]; 6],
    /// What each box holds, as in [`WideNode::children`].
    pub children: [u32; N],
}

/// Bytes: whole cache lines. One line of `QuantizedNode<8>` holds all boxes, another the children.
macro_rules! assert_layout {
    ($n:literal: $size:literal, children at $offset:literal) => {
        const _: () = assert!(
            size_of::<QuantizedNode<$n>>() == $size
                && align_of::<QuantizedNode<$n>>() == 64
                && offset_of!(QuantizedNode<$n>, planes) == 16
                && offset_of!(QuantizedNode<$n>, children) == $offset
        );
    };
}
assert_layout!(2: 64, children at 28);
assert_layout!(4: 64, children at 40);
assert_layout!(8: 128, children at 64);
assert_layout!(16: 192, children at 112);

/// The greatest exponent with which no `q * scale` overflows.
const GREATEST: u8 = 127 + 120;
/// Stands for no grid at all.
const UNBOUNDED: u8 = 255;

/// The grid along one axis.
#[derive(Clone, Copy)]
struct Grid {
    origin: f32,
    exponent: u8,
}

impl Grid {
    /// The finest grid from `lo` that reaches `hi`.
    fn around(lo: f32, hi: f32) -> Grid {
        let with = |exponent| Grid {
            origin: lo,
            exponent,
        };
        // Exponent 0 would be the step 0.
        let exponent = least(1, GREATEST, |exponent| with(exponent).plane(255) >= hi);
        match exponent {
            Some(exponent) if lo.is_finite() && hi.is_finite() => with(exponent),
            _ => Grid {
                origin: 0.0,
                exponent: UNBOUNDED,
            },
        }
    }

    #[inline(always)]
    fn scale(self) -> f32 {
        f32::from_bits(u32::from(self.exponent) << 23)
    }

    /// NaN for plane 0 of no grid.
    #[inline(always)]
    fn plane(self, q: u8) -> f32 {
        self.origin + f32::from(q) * self.scale()
    }

    /// The indices of the planes next to an interval within the grid, outwards.
    fn enclosing(self, lo: f32, hi: f32) -> [u8; 2] {
        if self.exponent == UNBOUNDED {
            return [0, 0];
        }
        let below = least(1, 255, |q| self.plane(q) > lo).map_or(255, |above| above - 1);
        let above = least(0, 255, |q| self.plane(q) >= hi).expect("the grid reaches its end");
        [below, above]
    }
}

/// The least number of the range from which on `holds` is true, if there is one.
fn least(mut lo: u8, mut hi: u8, holds: impl Fn(u8) -> bool) -> Option<u8> {
    if !holds(hi) {
        return None;
    }
    while lo < hi {
        let middle = lo + (hi - lo) / 2;
        if holds(middle) {
            hi = middle;
        } else {
            lo = middle + 1;
        }
    }
    Some(lo)
}

impl<const N: usize> QuantizedNode<N> {
    fn grid(&self, axis: usize) -> Grid {
        Grid {
            origin: self.origin[axis],
            exponent: self.exponents[axis],
        }
    }
}

/// Boxes rounded outwards. Empty boxes, and those that are NaN, lose their slots; the others keep
/// their order.
impl<const N: usize> From<&WideNode<N>> for QuantizedNode<N> {
    fn from(node: &WideNode<N>) -> QuantizedNode<N> {
        let is_box = |bounds: &Bounds| (0..3).all(|axis| bounds.lo[axis] <= bounds.hi[axis]);
        let mut quantized = QuantizedNode {
            origin: [0.0; 3],
            exponents: [1; 3],
            used_slots: 0,
            planes: [[0; N]; 6],
            children: [Child::VACANT.0; N],
        };
        let mut boxes = [Bounds::EMPTY; N];
        let mut all = Bounds::EMPTY;
        let mut used = 0;
        for (slot, &child) in node.children.iter().enumerate() {
            let bounds = node.child_bounds(slot);
            if is_box(&bounds) && Child(child) != Child::VACANT {
                (boxes[used], quantized.children[used]) = (bounds, child);
                all = all.union(&bounds);
                used += 1;
            }
        }
        quantized.used_slots = used as u8;
        for axis in (0..3).filter(|_| used > 0) {
            let grid = Grid::around(all.lo[axis], all.hi[axis]);
            (quantized.origin[axis], quantized.exponents[axis]) = (grid.origin, grid.exponent);
            for (slot, bounds) in boxes[..used].iter().enumerate() {
                let [lo, hi] = grid.enclosing(bounds.lo[axis], bounds.hi[axis]);
                quantized.planes[2 * axis][slot] = lo;
                quantized.planes[2 * axis + 1][slot] = hi;
            }
        }
        quantized
    }
}

impl<const N: usize> Sealed for QuantizedNode<N> {}

// SAFETY: the children are a field.
unsafe impl<const N: usize> Boxes<N> for QuantizedNode<N> {
    #[inline(always)]
    fn children(&self) -> &[u32; N] {
        &self.children
    }

    #[inline(always)]
    fn used(&self) -> u32 {
        const { assert!(N < 32) };
        (1 << (self.used_slots & 31)) - 1
    }

    #[inline(always)]
    unsafe fn plane<S: Width<N>>(&self, simd: S, axis: usize, row: usize) -> S::Float {
        let scale = simd.splat(self.grid(axis).scale());
        let origin = simd.splat(self.origin[axis]);
        // SAFETY: there are six rows, by this function's contract.
        let planes = unsafe { self.planes.get_unchecked(row) };
        simd.mul_add(simd.load_bytes(planes), scale, origin)
    }

    #[inline(always)]
    fn plane_of(&self, slot: usize, axis: usize, row: usize) -> f32 {
        self.grid(axis).plane(self.planes[row % 6][slot % N])
    }

    fn child_bounds(&self, slot: usize) -> Bounds {
        if slot >= usize::from(self.used_slots) {
            return Bounds::EMPTY;
        }
        let plane = |axis: usize, side: usize, unbounded: f32| {
            let plane = self.plane_of(slot, axis, 2 * axis + side);
            if plane.is_nan() { unbounded } else { plane }
        };
        Bounds {
            lo: [0, 1, 2].map(|axis| plane(axis, 0, f32::NEG_INFINITY)),
            hi: [0, 1, 2].map(|axis| plane(axis, 1, f32::INFINITY)),
        }
    }
}

/// As [`Bvh`], with quantised nodes. It answers the same through [`view`](QuantizedBvh::view) and
/// the kernels.
#[derive(Clone, Debug)]
pub struct QuantizedBvh<const N: usize, const P: usize = N> {
    nodes: Vec<QuantizedNode<N>>,
    packets: Vec<TrianglePacket<P>>,
}

impl<const N: usize, const P: usize> From<Bvh<N, P>> for QuantizedBvh<N, P> {
    fn from(bvh: Bvh<N, P>) -> QuantizedBvh<N, P> {
        QuantizedBvh {
            nodes: quantize(bvh.nodes),
            packets: bvh.packets,
        }
    }
}

/// From the leaves up: a box is around the decoded boxes below it too, so that they lie inside of
/// each other as [`BvhView::new`] asks.
fn quantize<const N: usize>(mut nodes: Vec<WideNode<N>>) -> Vec<QuantizedNode<N>> {
    let mut decoded = vec![Bounds::EMPTY; nodes.len()];
    let mut quantized = Vec::with_capacity(nodes.len());
    for index in (0..nodes.len()).rev() {
        let node = &mut nodes[index];
        for slot in 0..N {
            let child = Child(node.children[slot]);
            if !child.is_leaf() {
                let bounds = node.child_bounds(slot).union(&decoded[child.0 as usize]);
                node.set_child(slot, &bounds, child);
            }
        }
        let node = QuantizedNode::from(&*node);
        decoded[index] = bounds_of(&node);
        quantized.push(node);
    }
    quantized.reverse();
    quantized
}

fn bounds_of<const N: usize>(node: &QuantizedNode<N>) -> Bounds {
    (0..N).fold(Bounds::EMPTY, |bounds, slot| {
        bounds.union(&node.child_bounds(slot))
    })
}

impl<const N: usize, const P: usize> QuantizedBvh<N, P> {
    /// What the kernels take.
    #[inline(always)]
    pub fn view(&self) -> BvhView<'_, N, P, QuantizedNode<N>> {
        // SAFETY: the children are those of a sound hierarchy, in the same order but for slots
        // left out; boxes lie inside of each other by construction.
        unsafe { BvhView::new_unchecked(&self.nodes, &self.packets) }
    }

    /// The nodes, the root first, parents before their children.
    pub fn nodes(&self) -> &[QuantizedNode<N>] {
        &self.nodes
    }

    /// The triangles, leaf by leaf.
    pub fn packets(&self) -> &[TrianglePacket<P>] {
        &self.packets
    }

    /// The box around everything, rounded outwards; empty if there are no triangles.
    pub fn bounds(&self) -> Bounds {
        bounds_of(&self.nodes[0])
    }

    /// Size of nodes and packets.
    pub fn memory_bytes(&self) -> usize {
        size_of_val(self.nodes()) + size_of_val(self.packets())
    }
}
