//! The slab test against exact arithmetic (B-01), in the planes of boxes (B-02), and at vacant
//! slots (B-06).

use fearless_simd::{Level, dispatch};

use super::Slab;
use crate::bounds::Bounds;
use crate::layout::child::Child;
use crate::layout::node::WideNode;
use crate::layout::quantized::QuantizedNode;
use crate::ray::Ray;
use crate::simd::Width;

/// Which of the boxes the ray touches, as bits; all widths must agree.
fn touched(ray: &Ray, boxes: &[Bounds; 4]) -> u32 {
    let masks = dispatch!(Level::new(), simd => [
        touched_in::<_, 4>(simd, ray, boxes),
        touched_in::<_, 8>(simd, ray, boxes),
        touched_in::<_, 16>(simd, ray, boxes),
    ]);
    assert!(masks[0] == masks[1] && masks[1] == masks[2], "{masks:?}");
    masks[0]
}

#[inline(always)]
fn touched_in<S: Width<N>, const N: usize>(simd: S, ray: &Ray, boxes: &[Bounds; 4]) -> u32 {
    let mut node = WideNode::<N>::VACANT;
    for (slot, bounds) in boxes.iter().enumerate() {
        // As in every hierarchy, boxes are padded.
        node.set_child(slot, &bounds.padded(1.0), Child::VACANT);
    }
    let (tmin, tmax) = ray.interval();
    let slab = Slab::<S, N>::of_ray(simd, ray, tmin);
    slab.touched_children(simd, &node, tmax).0
}

struct Random(u64);

impl Random {
    fn below(&mut self, n: i64) -> i64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 33) as i64 % n
    }
}

/// Whether the ray from `org` along `dir` touches the closed box, all integers: the interval of
/// each slab is a pair of fractions, compared by cross-multiplication.
fn touches_exactly(org: [i64; 3], dir: [i64; 3], lo: [i64; 3], hi: [i64; 3]) -> bool {
    // Fractions with positive denominators.
    let (mut entry, mut exit) = ((0i128, 1i128), None::<(i128, i128)>);
    let less = |a: (i128, i128), b: (i128, i128)| a.0 * b.1 < b.0 * a.1;
    for axis in 0..3 {
        let (o, d) = (org[axis], dir[axis]);
        if d == 0 {
            if o < lo[axis] || o > hi[axis] {
                return false;
            }
            continue;
        }
        let (near, far) = if d > 0 {
            (lo[axis], hi[axis])
        } else {
            (hi[axis], lo[axis])
        };
        let fraction = |plane: i64| (((plane - o) * d.signum()) as i128, d.abs() as i128);
        if less(entry, fraction(near)) {
            entry = fraction(near);
        }
        if exit.is_none_or(|exit| less(fraction(far), exit)) {
            exit = Some(fraction(far));
        }
    }
    exit.is_none_or(|exit| !less(exit, entry))
}

#[test]
fn exact_touches_are_found() {
    let mut random = Random(1);
    let (mut touches, mut extra) = (0u32, 0u32);
    let rounds = if cfg!(miri) {
        100
    } else if cfg!(debug_assertions) {
        20_000
    } else {
        300_000
    };
    for _ in 0..rounds {
        let offset = [0, 0, 1 << 10, 1 << 18][random.below(4) as usize];
        let mut boxes = [([0; 3], [0; 3]); 4];
        for (lo, hi) in &mut boxes {
            *lo = [0; 3].map(|_| offset + random.below(64));
            // Flat boxes are frequent.
            *hi = lo.map(|x| x + (random.below(12) - 3).max(0));
        }
        let (lo, hi) = boxes[0];
        // A corner, a point of an edge or face, or any near point.
        let target = [0, 1, 2].map(|axis| match random.below(4) {
            0 => lo[axis],
            1 => hi[axis],
            2 => lo[axis] + random.below(hi[axis] - lo[axis] + 1),
            _ => lo[axis] + random.below(16) - 4,
        });
        let org = target.map(|x| x + [0, random.below(200) - 100][random.below(4).min(1) as usize]);
        let dir = [0, 1, 2].map(|axis| target[axis] - org[axis]);
        if dir == [0; 3] {
            continue;
        }
        let float = |p: [i64; 3]| p.map(|x| x as f32);
        let ray = Ray::unbounded(float(org), float(dir));
        let found = touched(
            &ray,
            &boxes.map(|(lo, hi)| Bounds {
                lo: float(lo),
                hi: float(hi),
            }),
        );
        for (slot, (lo, hi)) in boxes.into_iter().enumerate() {
            let exact = touches_exactly(org, dir, lo, hi);
            let found = found >> slot & 1 == 1;
            assert!(found || !exact, "lost: {ray:?} {lo:?} {hi:?}");
            touches += u32::from(exact);
            // Far from the origin the slack is of the size of these small boxes.
            extra += u32::from(found && !exact && offset < 1 << 18);
        }
        assert_eq!(found >> 4, 0, "vacant slots are never entered");
    }
    assert!(touches > rounds / 2);
    assert!(extra < rounds / 1000, "{extra} boxes entered in vain");
}

/// A ray within the common plane of two boxes enters both, with either sign of zero.
#[test]
fn rays_in_the_planes_of_boxes() {
    let unit = Bounds {
        lo: [0.0; 3],
        hi: [1.0; 3],
    };
    for plane_axis in 0..3 {
        let mut boxes = [unit, unit, unit, unit];
        (boxes[1].lo[plane_axis], boxes[1].hi[plane_axis]) = (1.0, 2.0);
        (boxes[2].lo[plane_axis], boxes[2].hi[plane_axis]) = (1.0, 1.0);
        (boxes[3].lo[plane_axis], boxes[3].hi[plane_axis]) = (2.0, 3.0);
        for along in (0..3).filter(|&axis| axis != plane_axis) {
            for zero in [0.0, -0.0, 1e-40, -1e-40] {
                for other in [0.0, -0.0] {
                    for sign in [1.0, -1.0] {
                        let mut dir = [other; 3];
                        dir[plane_axis] = zero;
                        dir[along] = sign;
                        let mut org = [0.5; 3];
                        org[along] = 0.5 - 5.0 * sign;
                        for (at, expected) in
                            [(0.0, 0b0001), (0.5, 0b0001), (1.0, 0b0111), (2.0, 0b1010)]
                        {
                            org[plane_axis] = at;
                            let ray = Ray::unbounded(org, dir);
                            assert_eq!(touched(&ray, &boxes), expected, "{ray:?}");
                        }
                    }
                }
            }
        }
    }
}

/// Quantised boxes are touched where plain ones are, and unused slots never: they have no box that
/// would be empty by the slack, which from afar is greater than the node.
#[test]
fn quantised_slots() {
    fn check<S: Width<N>, const N: usize>(simd: S, ray: &Ray, node: &WideNode<N>, used: usize) {
        let slab = Slab::<S, N>::of_ray(simd, ray, 0.0);
        let (plain, _) = slab.touched_children(simd, node, f32::INFINITY);
        let (quantized, _) = slab.touched_children(simd, &QuantizedNode::from(node), f32::INFINITY);
        assert_eq!(plain & !quantized, 0, "{ray:?}");
        assert_eq!(quantized >> used, 0, "{ray:?}");
    }
    fn node<const N: usize>(random: &mut Random, used: usize) -> WideNode<N> {
        let mut node = WideNode::VACANT;
        for slot in 0..used {
            let lo = [0; 3].map(|_| random.below(1000) as f32 * 1e-5);
            let hi = lo.map(|x| x + random.below(1000) as f32 * 1e-5);
            node.set_child(slot, &Bounds { lo, hi }, Child::leaf(slot, 1));
        }
        node
    }
    let mut random = Random(8);
    let mut touched = 0;
    for round in 0..20_000 {
        let used = random.below(4) as usize;
        let distance = [1.0, 1e3, 1e6][round % 3];
        let org = [0; 3].map(|_| (random.below(2001) - 1000) as f32 * 1e-3 * distance);
        let ray = Ray::unbounded(org, org.map(|x| random.below(20) as f32 * 1e-3 - x));
        let (four, sixteen) = (node::<4>(&mut random, used), node::<16>(&mut random, used));
        let inverted = WideNode {
            bounds: [0, 1, 2, 3, 4, 5].map(|row| [[0.02, 0.0][row % 2]; 4]),
            ..WideNode::VACANT
        };
        touched += dispatch!(Level::new(), simd => {
            check(simd, &ray, &four, used);
            check(simd, &ray, &sixteen, used);
            let slab = Slab::<_, 4>::of_ray(simd, &ray, 0.0);
            slab.touched_children(simd, &inverted, f32::INFINITY).0 & 1
        });
    }
    assert!(touched > 1000, "inverted boxes would have done: {touched}");
}
