//! Quantised nodes contain what they stand for, and answer as plain ones do (B-05).

use fearless_simd::{Level, Simd, dispatch};
use residual_bvh::{
    AllHits, Apart, Bounds, Boxes, BuildQuality, Bvh, BvhView, Hit, Hybrid, InvalidBvh, Kernel,
    Packets, Phased, QuantizedBvh, QuantizedNode, Ray, Single, Watertight, WideNode, Width, build,
};

use crate::mesh::{Mesh, grid, jittered_icosphere, soup};
use crate::oracle::closest_hit_of_all;
use crate::random::Random;
use crate::runner::{aimed, same, trials};

const LEAF: u32 = 1 << 31;

/// Runs the expression with the token of every instruction set that the machine has.
macro_rules! on_every_instruction_set {
    ($simd:ident => $check:expr) => {
        dispatch!(Level::new(), $simd => $check);
        #[cfg(target_arch = "x86_64")]
        {
            let level = Level::new();
            if let Some($simd) = level.as_avx2() {
                $simd.vectorize(|| $check);
            }
            if let Some($simd) = level.as_sse4_2() {
                $simd.vectorize(|| $check);
            }
            if let Some($simd) = level.as_sse2() {
                $simd.vectorize(|| $check);
            }
        }
    };
}

/// A node of leaves of one packet each, with these boxes.
fn node_of<const N: usize>(boxes: &[Bounds]) -> WideNode<N> {
    let mut node = WideNode {
        bounds: [0, 1, 2, 3, 4, 5].map(|row| [[f32::INFINITY, f32::NEG_INFINITY][row % 2]; N]),
        children: [LEAF; N],
    };
    for (slot, bounds) in boxes.iter().enumerate() {
        for axis in 0..3 {
            node.bounds[2 * axis][slot] = bounds.lo[axis];
            node.bounds[2 * axis + 1][slot] = bounds.hi[axis];
        }
        node.children[slot] = LEAF | 1 << 27 | slot as u32;
    }
    node
}

/// Quantises; every decoder must give boxes around the original ones, and all the same.
fn quantize_and_check<const N: usize>(boxes: &[Bounds]) -> QuantizedNode<N> {
    let node = node_of::<N>(boxes);
    let quantized = QuantizedNode::from(&node);
    assert_eq!(quantized.used_slots as usize, boxes.len());
    assert_eq!(quantized.children, node.children);
    for (slot, bounds) in boxes.iter().enumerate() {
        let decoded = quantized.child_bounds(slot);
        assert!(decoded.contains(bounds), "{decoded:?} around {bounds:?}");
    }
    quantized
}

#[inline(always)]
fn check_decoder<S: Simd + Width<N>, const N: usize>(simd: S, node: &QuantizedNode<N>) {
    for row in 0..6 {
        let mut planes = [0.0; N];
        // SAFETY: the row is its axis's.
        Width::<N>::store(simd, unsafe { node.plane(simd, row / 2, row) }, &mut planes);
        for (slot, plane) in planes.iter().enumerate() {
            assert_eq!(plane.to_bits(), node.plane_of(slot, row / 2, row).to_bits());
        }
    }
}

fn containment<const N: usize>(count: usize) {
    let mut random = Random::new(120 + N as u64);
    for _ in 0..count {
        let extent = 10f32.powf(random.unit() * 12.0 - 6.0);
        let offset = [0.0, 1.0, 1e3, 1e6][random.below(4)] * (random.unit() * 2.0 - 1.0);
        let flat = random.below(8);
        let used = 1 + random.below(N);
        let boxes: Vec<Bounds> = (0..used)
            .map(|_| {
                let (p, q) = (random.in_cube(extent), random.in_cube(extent));
                let [lo, hi] = [f32::min, f32::max]
                    .map(|pick| [0, 1, 2].map(|axis| offset + pick(p[axis], q[axis])));
                match random.below(4) {
                    // The whole node.
                    0 => Bounds {
                        lo: [offset - extent; 3],
                        hi: [offset + extent; 3],
                    },
                    // A point along an axis.
                    1 if flat < 3 => Bounds {
                        lo,
                        hi: [0, 1, 2].map(|axis| if axis == flat { lo[axis] } else { hi[axis] }),
                    },
                    _ => Bounds { lo, hi },
                }
            })
            .collect();
        let quantized = quantize_and_check::<N>(&boxes);

        // Planes within two units in the last place of the grid's.
        let mut near = |x: f32| {
            let steps = random.below(5) as i32 - 2;
            (0..steps.abs()).fold(x, |x, _| {
                if steps < 0 {
                    x.next_down()
                } else {
                    x.next_up()
                }
            })
        };
        let moved: Vec<Bounds> = (0..used)
            .map(|slot| {
                let bounds = quantized.child_bounds(slot);
                let (lo, hi) = (bounds.lo.map(&mut near), bounds.hi.map(&mut near));
                Bounds {
                    lo: [0, 1, 2].map(|axis| lo[axis].min(hi[axis])),
                    hi: [0, 1, 2].map(|axis| lo[axis].max(hi[axis])),
                }
            })
            .collect();
        quantize_and_check::<N>(&moved);
    }
}

#[test]
fn decoded_boxes_contain_the_boxes() {
    containment::<2>(trials(100_000));
    containment::<4>(trials(100_000));
    containment::<8>(trials(100_000));
    containment::<16>(trials(100_000));
}

/// The decoders agree on any bytes.
#[test]
fn decoders_agree() {
    fn node_of_noise<const N: usize>(random: &mut Random) -> QuantizedNode<N> {
        QuantizedNode {
            origin: [0; 3].map(|_| {
                let x = f32::from_bits(random.bits());
                if x.is_finite() { x } else { 1.0 }
            }),
            // As far as the encoder goes; it has no use for 0.
            exponents: [0; 3].map(|_| 1 + random.below(247) as u8),
            used_slots: N as u8,
            planes: [0; 6].map(|_| [0; N].map(|_| random.bits() as u8)),
            children: [LEAF; N],
        }
    }
    let mut random = Random::new(121);
    for _ in 0..trials(100_000) {
        let nodes = (
            node_of_noise::<2>(&mut random),
            node_of_noise::<4>(&mut random),
            node_of_noise::<8>(&mut random),
            node_of_noise::<16>(&mut random),
        );
        on_every_instruction_set!(simd => {
            check_decoder(simd, &nodes.0);
            check_decoder(simd, &nodes.1);
            check_decoder(simd, &nodes.2);
            check_decoder(simd, &nodes.3);
        });
    }
}

/// Extents that no finite grid covers, and the smallest there are.
#[test]
fn extreme_boxes() {
    let cube = |lo: f32, hi: f32| Bounds {
        lo: [lo; 3],
        hi: [hi; 3],
    };
    let tiny = f32::from_bits(1);
    for boxes in [
        vec![],
        vec![cube(f32::MIN, f32::MAX), cube(0.0, 1.0)],
        vec![cube(f32::NEG_INFINITY, f32::INFINITY)],
        vec![cube(f32::MAX, f32::INFINITY), cube(1.0, 2.0)],
        vec![cube(-1e38, 1e38), cube(f32::MAX, f32::MAX)],
        vec![cube(0.0, tiny), cube(-tiny, 0.0), cube(0.0, -0.0)],
        vec![cube(1.0, 1.0f32.next_up()), cube(1.0, 1.0)],
    ] {
        quantize_and_check::<4>(&boxes);
        quantize_and_check::<8>(&boxes);
    }
    // Slots without a box are closed up.
    let nan = Bounds {
        lo: [f32::NAN; 3],
        ..cube(0.0, 1.0)
    };
    let node = node_of::<4>(&[Bounds::EMPTY, cube(0.0, 1.0), nan, cube(2.0, 3.0)]);
    let quantized = QuantizedNode::from(&node);
    assert_eq!(quantized.used_slots, 2);
    assert_eq!(
        quantized.children,
        [node.children[1], node.children[3], LEAF, LEAF]
    );
}

/// Holds the quantised hierarchy against the oracle: every kernel, both queries, and every
/// instruction set. Returns how many rays hit.
fn check_width<const N: usize, const P: usize>(
    mesh: &Mesh,
    rays: &[Ray],
    quality: BuildQuality,
    expected: &[Hit],
    trace: impl Fn(BvhView<'_, N, P, QuantizedNode<N>>, &mut [Hit], &mut [bool]),
) {
    let marks = (!mesh.single_sided.is_empty()).then_some(&mesh.single_sided[..]);
    let plain: Bvh<N, P> = build(&mesh.positions, &mesh.triangles, marks, quality);
    let quantized = QuantizedBvh::from(plain.clone());
    BvhView::new(quantized.nodes(), quantized.packets()).expect("a sound hierarchy");
    assert!(quantized.bounds().contains(&plain.bounds()));
    assert_eq!(quantized.nodes().len(), plain.nodes().len());
    let mut hits = vec![Hit::miss(0.0); rays.len()];
    let mut occluded = vec![false; rays.len()];
    trace(quantized.view(), &mut hits, &mut occluded);
    for (((ray, hit), occluded), expected) in rays.iter().zip(&hits).zip(&occluded).zip(expected) {
        assert!(
            same(hit, expected),
            "width {N}, {quality:?}: {ray:?}\n  {hit:?}, expected {expected:?}"
        );
        assert_eq!(*occluded, expected.is_hit(), "width {N}: {ray:?}");
    }
}

fn check(mesh: &Mesh, rays: &[Ray]) -> usize {
    let expected: Vec<Hit> = rays
        .iter()
        .map(|ray| closest_hit_of_all(mesh, ray, &AllHits))
        .collect();
    for quality in [BuildQuality::Fast, BuildQuality::Medium, BuildQuality::Best] {
        macro_rules! check_widths {
            ($simd:ident, $kernel:expr, $($n:literal x $p:literal)*) => {$(
                check_width::<$n, $p>(mesh, rays, quality, &expected, |view, hits, occluded| {
                    Apart($kernel).closest_hits($simd, Watertight, view, rays, hits, &AllHits);
                    Apart($kernel).any_hits($simd, Watertight, view, rays, occluded, &AllHits);
                });
            )*};
        }
        on_every_instruction_set!(simd => {
            check_widths!(simd, Single, 2 x 1 4 x 4 8 x 8 16 x 16);
        });
        dispatch!(Level::new(), simd => {
            check_widths!(simd, Packets::<8>, 4 x 4 16 x 16);
            check_widths!(simd, Phased, 4 x 4 8 x 8 16 x 16);
            check_widths!(simd, Hybrid::<8>, 8 x 8);
        });
    }
    expected.iter().filter(|hit| hit.is_hit()).count()
}

/// Rays at edges, at vertices, and in random directions, from around the mesh's place.
fn mixed_rays(mesh: &Mesh, center: f32, count: usize, random: &mut Random) -> Vec<Ray> {
    (0..count)
        .map(|i| {
            let org = random.in_cube(1.5).map(|x| x + center);
            match i % 3 {
                0 => aimed(org, mesh.edge_point(random)),
                1 => aimed(org, mesh.vertex(random)),
                _ => Ray {
                    dir: random.in_cube(1.0),
                    ..aimed(org, [0.0; 3])
                },
            }
        })
        .collect()
}

#[test]
fn random_soups() {
    let mut random = Random::new(122);
    for (count, size) in [(1, 1.0), (17, 0.8), (400, 0.1), (1500, 0.02)] {
        let mesh = soup(count, size, &mut random).marked(&mut random);
        let rays = mixed_rays(&mesh, 0.0, trials(1500), &mut random);
        assert!(check(&mesh, &rays) > rays.len() / 5, "{count} triangles");
    }
    let empty = Mesh::default();
    assert_eq!(check(&empty, &[aimed([0.0; 3], [1.0; 3])]), 0);
}

#[test]
fn far_from_the_origin() {
    let mut random = Random::new(123);
    for offset in [1e2, 1e4, 1e6] {
        let mesh = jittered_icosphere(2, &mut random).translated(offset);
        let mut rays = mixed_rays(&mesh, offset, trials(1000), &mut random);
        for _ in 0..trials(300) {
            rays.push(aimed(random.in_cube(1.0), mesh.edge_point(&mut random)));
        }
        assert!(check(&mesh, &rays) > rays.len() / 3, "{offset}");
    }
}

#[test]
fn slivers_and_flat_grids() {
    let mut random = Random::new(124);
    let mut mesh = grid(8);
    for _ in 0..100 {
        let (p, d) = (random.in_cube(1.0), random.in_cube(2.0));
        let width = 10f32.powi(-(random.below(8) as i32));
        let thin = random.in_cube(width);
        mesh.push([
            p,
            [0, 1, 2].map(|axis| p[axis] + d[axis]),
            [0, 1, 2].map(|axis| p[axis] + 0.4 * d[axis] + thin[axis]),
        ]);
    }
    let mut rays = mixed_rays(&mesh, 0.0, trials(2000), &mut random);
    for ray in rays.iter_mut().step_by(5) {
        ray.org[2] = [0.0, 1e-30, 1e-7][random.below(3)];
        ray.dir[2] = [0.0, -0.0, -1e-30, -1e-8][random.below(4)];
    }
    assert!(check(&mesh, &rays) > rays.len() / 5);
}

/// Scenes as small and as large as the triangle test bears.
#[test]
fn every_scale() {
    let mut random = Random::new(125);
    let mesh = soup(200, 0.2, &mut random);
    let rays = mixed_rays(&mesh, 0.0, trials(300), &mut random);
    for exponent in [-60, -30, 30, 60] {
        let scale = 2f32.powi(exponent);
        let mut scaled = mesh.clone();
        for position in &mut scaled.positions {
            *position = position.map(|x| x * scale);
        }
        let rays: Vec<Ray> = rays
            .iter()
            .map(|ray| Ray {
                org: ray.org.map(|x| x * scale),
                ..*ray
            })
            .collect();
        assert!(check(&scaled, &rays) > rays.len() / 5, "{exponent}");
    }
}

#[test]
fn broken_structures_are_refused() {
    let mesh = grid(40);
    let plain: Bvh<8> = build(&mesh.positions, &mesh.triangles, None, BuildQuality::Fast);
    let memory = plain.memory_bytes();
    let quantized = QuantizedBvh::from(plain);
    let nodes = quantized.nodes();
    assert_eq!(quantized.memory_bytes(), memory - 128 * nodes.len());
    let slot = (0..8)
        .find(|&slot| nodes[0].children[slot] & LEAF == 0)
        .expect("the root has inner children");
    let refuse = |change: &dyn Fn(&mut QuantizedNode<8>), expected: InvalidBvh| {
        let mut broken = nodes.to_vec();
        change(&mut broken[0]);
        let error = BvhView::<8, 8, _>::new(&broken, quantized.packets()).unwrap_err();
        assert_eq!(error, expected);
    };
    let bad_bounds = InvalidBvh::BadBounds { node: 0, slot };
    refuse(
        &|root| root.planes[1][slot] = root.planes[0][slot],
        bad_bounds,
    );
    refuse(&|root| root.origin[0] += 100.0, bad_bounds);
    refuse(&|root| root.exponents[1] -= 1, bad_bounds);
    refuse(&|root| root.used_slots = 0, bad_bounds);
    let bad_child = InvalidBvh::BadChild { node: 0, slot };
    refuse(&|root| root.children[slot] = 0, bad_child);
}
