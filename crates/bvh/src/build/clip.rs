//! Triangles clipped at axis-aligned planes.

use glam::Vec3A;

use crate::build::fragment::Box3;

/// Boxes around the parts of a triangle below and above `plane` on `axis`, within `bounds`; a part
/// that holds nothing may come out empty.
///
/// A crossing is interpolated from the nearer end of its edge, so that it is off by less than
/// 2.5 · 2⁻²⁴ of the triangle's extent and 2⁻²⁴ of its coordinate. Parts of parts are clipped from
/// the triangle again, which keeps errors from adding up.
#[inline]
pub(crate) fn clip(vertices: &[Vec3A; 3], bounds: &Box3, axis: usize, plane: f32) -> (Box3, Box3) {
    let (mut below, mut above) = (Box3::EMPTY, Box3::EMPTY);
    let mut from = vertices[2];
    for &to in vertices {
        let (start, end) = (from[axis], to[axis]);
        if end <= plane {
            below.grow(to, to);
        }
        if end >= plane {
            above.grow(to, to);
        }
        if start < plane && plane < end || end < plane && plane < start {
            let (near, far) = if (plane - start).abs() <= (plane - end).abs() {
                (from, to)
            } else {
                (to, from)
            };
            let crossing = near + (far - near) * ((plane - near[axis]) / (far[axis] - near[axis]));
            below.grow(crossing, crossing);
            above.grow(crossing, crossing);
        }
        from = to;
    }
    below.hi[axis] = below.hi[axis].min(plane);
    above.lo[axis] = above.lo[axis].max(plane);
    (below.intersection(bounds), above.intersection(bounds))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::Bounds;

    /// Knuth's linear congruential generator.
    struct Random(u64);

    impl Random {
        fn unit(&mut self) -> f32 {
            self.0 = self
                .0
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (self.0 >> 40) as f32 / (1 << 24) as f32
        }

        fn below(&mut self, n: usize) -> usize {
            (self.unit() * n as f32) as usize
        }
    }

    fn padded(part: &Box3, pad: f32) -> Bounds {
        let bounds = Bounds {
            lo: part.lo.into(),
            hi: part.hi.into(),
        };
        bounds.padded(pad)
    }

    /// Every point of a triangle, computed in `f64`, is in the padded box of the part on its side of
    /// the plane, also after further clipping; and parts keep to their side.
    #[test]
    fn parts_cover_the_triangle() {
        let mut random = Random(7);
        for _ in 0..3000 {
            let scale = 10f32.powi(random.below(9) as i32 - 4);
            let offset = [0.0, 1.0, 100.0][random.below(3)] * scale;
            let vertices = [0; 3].map(|_| {
                Vec3A::from_array([0; 3].map(|_| {
                    // Few values in some cases: edges in the plane, vertices on it.
                    let x = random.unit();
                    let x = if random.below(3) == 0 {
                        (4.0 * x).round() / 4.0
                    } else {
                        x
                    };
                    scale * x + offset
                }))
            });
            let mut whole = Box3::EMPTY;
            vertices
                .iter()
                .for_each(|&vertex| whole.grow(vertex, vertex));
            let extent = whole.size().max_element();
            let planes = [0; 3].map(|_| {
                let axis = random.below(3);
                let at = (random.unit() * 8.0).round() / 8.0;
                (axis, whole.lo[axis] + at * whole.size()[axis])
            });
            for _ in 0..100 {
                let (mut u, mut v) = (f64::from(random.unit()), f64::from(random.unit()));
                if u + v > 1.0 {
                    (u, v) = (1.0 - u, 1.0 - v);
                }
                if random.below(4) == 0 {
                    u = u.round();
                    v = v.round() * (1.0 - u);
                }
                let point = [0, 1, 2].map(|axis| {
                    let [a, b, c] = vertices.map(|vertex| f64::from(vertex[axis]));
                    a + u * (b - a) + v * (c - a)
                });
                let mut part = whole;
                for (axis, plane) in planes {
                    if plane < part.lo[axis] || plane > part.hi[axis] {
                        continue;
                    }
                    let (below, above) = clip(&vertices, &part, axis, plane);
                    assert!(below.hi[axis] <= plane && above.lo[axis] >= plane);
                    part = if point[axis] < f64::from(plane) {
                        below
                    } else {
                        above
                    };
                }
                // The builder pads parts for twice the extent.
                let bounds = padded(&part, 2.0 * extent);
                for axis in 0..3 {
                    let range = f64::from(bounds.lo[axis])..=f64::from(bounds.hi[axis]);
                    assert!(
                        range.contains(&point[axis]),
                        "{vertices:?} {planes:?} {point:?}"
                    );
                }
            }
        }
    }

    /// A right triangle halved: the part at the right angle stays tall, the other one is half.
    #[test]
    fn a_halved_triangle() {
        let vertices = [[0.0; 3], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]].map(Vec3A::from_array);
        let whole = Box3 {
            lo: Vec3A::ZERO,
            hi: Vec3A::new(2.0, 2.0, 0.0),
        };
        let (below, above) = clip(&vertices, &whole, 0, 1.0);
        assert_eq!(below.hi, Vec3A::new(1.0, 2.0, 0.0));
        assert_eq!((above.lo, above.hi), (Vec3A::X, Vec3A::new(2.0, 1.0, 0.0)));
    }
}
