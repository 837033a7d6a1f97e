//! Compact packets hold what plain ones do, and answer as they do.

use std::collections::{BTreeMap, BTreeSet};

use fearless_simd::{Level, Simd, dispatch};
use residual_bvh::{
    AllHits, Apart, BuildQuality, Bvh, BvhView, CompactBvh, CompactPacket, Exact, Fast, FrontHits,
    Hit, HitFilter, Hybrid, Kernel, LeafTooLarge, MarkedHits, OneByOne, Packet, Packets, Phased,
    Precision, Ray, Single, TrianglePacket, Watertight, WideNode, Width, build, build_compact,
};

use crate::mesh::{Mesh, grid, jittered_icosphere, soup};
use crate::oracle::closest_hit_of_all;
use crate::random::Random;
use crate::runner::{Holes, aimed, same, trials};

const LEAF: u32 = 1 << 31;

fn marks(mesh: &Mesh) -> Option<&[bool]> {
    (!mesh.single_sided.is_empty()).then_some(&mesh.single_sided[..])
}

fn compact<const N: usize>(mesh: &Mesh, quality: BuildQuality) -> CompactBvh<N> {
    build_compact(&mesh.positions, &mesh.triangles, marks(mesh), quality)
}

/// The corners' bits by triangle index, with its mark.
type Triangles = BTreeMap<u32, [[u32; 3]; 3]>;

fn triangles_of<const P: usize>(packets: &[impl Packet<P>]) -> Triangles {
    let lanes = packets.iter().flat_map(|packet| {
        let prims = packet.prim_ids().iter().copied().enumerate();
        prims.map(move |(lane, prim)| (prim, packet.corners(lane)))
    });
    lanes
        .filter(|&(prim, _)| prim != u32::MAX)
        .map(|(prim, corners)| (prim, corners.map(|corner| corner.map(f32::to_bits))))
        .collect()
}

#[test]
fn every_leaf_has_its_triangles() {
    let mut random = Random::new(140);
    for mesh in [grid(40), soup(700, 0.1, &mut random).marked(&mut random)] {
        let plain: Bvh<8, 16> = build(
            &mesh.positions,
            &mesh.triangles,
            marks(&mesh),
            BuildQuality::Best,
        );
        let compact = CompactBvh::try_from(plain.clone()).expect("leaves are small");
        BvhView::<8, 16, _, CompactPacket>::new(compact.nodes(), compact.packets())
            .expect("a sound hierarchy");
        assert_eq!(compact.bounds(), plain.bounds());
        assert_eq!(
            triangles_of(compact.packets()),
            triangles_of(plain.packets())
        );
        let range = |child: u32| {
            let first = (child & ((1 << 27) - 1)) as usize;
            first..first + (child >> 27 & 15) as usize
        };
        let mut leaves = 0;
        for (before, after) in plain.nodes().iter().zip(compact.nodes()) {
            for (&before, &after) in before.children.iter().zip(&after.children) {
                assert_eq!(before & LEAF, after & LEAF);
                if before & LEAF == 0 {
                    assert_eq!(before, after);
                    continue;
                }
                let prims = |triangles: Triangles| triangles.into_keys().collect::<BTreeSet<_>>();
                let own = prims(triangles_of(&plain.packets()[range(before)]));
                let shared = prims(triangles_of(&compact.packets()[range(after)]));
                assert!(own.is_subset(&shared));
                leaves += usize::from(!own.is_empty());
            }
        }
        assert!(leaves > 10);
    }
}

/// A vertex is there once, and one that all triangles share makes room for more of them.
#[test]
fn vertices_are_shared() {
    let mesh = grid(64);
    let plain: Bvh<16> = build(&mesh.positions, &mesh.triangles, None, BuildQuality::High);
    let compact = compact::<16>(&mesh, BuildQuality::High);
    // Plain packets are full here; where they are not, as in most scenes, it is less than half.
    assert!(3 * compact.memory_bytes() < 2 * plain.memory_bytes());
    for packet in compact.packets() {
        let vertices: Vec<[u32; 3]> = (0..16)
            .map(|vertex| [0, 1, 2].map(|axis| packet.vertices[axis][vertex].to_bits()))
            .filter(|vertex| !f32::from_bits(vertex[0]).is_nan())
            .collect();
        let different: BTreeSet<_> = vertices.iter().collect();
        assert_eq!(different.len(), vertices.len());
    }
}

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
            if let Some($simd) = level.as_sse2() {
                $simd.vectorize(|| $check);
            }
        }
    };
}

/// Holds a kernel against the oracle, both queries.
fn check_kernel<S, const N: usize, F: HitFilter, K>(
    simd: S,
    kernel: K,
    precision: impl Precision,
    bvh: &CompactBvh<N>,
    rays: &[Ray],
    filter: &F,
    expected: &[Hit],
) where
    S: Simd + Width<N> + Width<16>,
    K: Kernel<S, N, 16>,
{
    let mut hits = vec![Hit::miss(0.0); rays.len()];
    let mut occluded = vec![false; rays.len()];
    Apart(kernel).closest_hits(simd, precision, bvh.view(), rays, &mut hits, filter);
    Apart(kernel).any_hits(simd, precision, bvh.view(), rays, &mut occluded, filter);
    for (((ray, hit), occluded), expected) in rays.iter().zip(&hits).zip(&occluded).zip(expected) {
        assert!(
            same(hit, expected),
            "width {N}: {ray:?}\n  {hit:?}, expected {expected:?}"
        );
        assert_eq!(*occluded, expected.is_hit(), "width {N}: {ray:?}");
    }
}

/// Holds the kernel that calls the others against the oracle, with a filter.
fn check_filter<F: HitFilter>(mesh: &Mesh, rays: &[Ray], filter: &F) {
    let expected: Vec<Hit> = rays
        .iter()
        .map(|ray| closest_hit_of_all(mesh, ray, filter))
        .collect();
    let bvh = compact::<16>(mesh, BuildQuality::High);
    dispatch!(Level::new(), simd => {
        check_kernel(simd, Hybrid::<32>, Watertight, &bvh, rays, filter, &expected);
    });
}

/// Returns how many rays hit.
fn check(mesh: &Mesh, rays: &[Ray]) -> usize {
    let expected: Vec<Hit> = rays
        .iter()
        .map(|ray| closest_hit_of_all(mesh, ray, &AllHits))
        .collect();
    for quality in [BuildQuality::Fast, BuildQuality::High, BuildQuality::Best] {
        let (four, sixteen) = (compact::<4>(mesh, quality), compact::<16>(mesh, quality));
        on_every_instruction_set!(simd => {
            check_kernel(simd, Single, Watertight, &four, rays, &AllHits, &expected);
        });
        dispatch!(Level::new(), simd => {
            check_kernel(simd, Packets::<16>, Watertight, &sixteen, rays, &AllHits, &expected);
            check_kernel(simd, OneByOne, Watertight, &four, rays, &AllHits, &expected);
            check_kernel(simd, Phased, Watertight, &sixteen, rays, &AllHits, &expected);
        });
    }
    check_filter(mesh, rays, &AllHits);
    check_filter(mesh, rays, &FrontHits);
    check_filter(mesh, rays, &MarkedHits);
    check_filter(mesh, rays, &Holes);
    expected.iter().filter(|hit| hit.is_hit()).count()
}

/// Rays at edges, at vertices, and in random directions; then a bundle of neighbours, for packets.
fn mixed_rays(mesh: &Mesh, count: usize, random: &mut Random) -> Vec<Ray> {
    let mut rays: Vec<Ray> = (0..count)
        .map(|i| {
            let org = random.in_cube(1.5);
            match i % 3 {
                0 => aimed(org, mesh.edge_point(random)),
                1 => aimed(org, mesh.vertex(random)),
                _ => Ray {
                    dir: random.in_cube(1.0),
                    ..aimed(org, [0.0; 3])
                },
            }
        })
        .collect();
    let eye = random.in_cube(1.5);
    let target = mesh.vertex(random);
    rays.extend((0..count).map(|_| {
        let aside = random.in_cube(0.1);
        aimed(eye, [0, 1, 2].map(|axis| target[axis] + aside[axis]))
    }));
    rays
}

#[test]
fn random_soups() {
    let mut random = Random::new(141);
    for (count, size) in [(1, 1.0), (17, 0.8), (400, 0.1), (1500, 0.02)] {
        let mesh = soup(count, size, &mut random).marked(&mut random);
        let rays = mixed_rays(&mesh, trials(700), &mut random);
        assert!(check(&mesh, &rays) > rays.len() / 5, "{count} triangles");
    }
    let empty = Mesh::default();
    assert_eq!(check(&empty, &[aimed([0.0; 3], [1.0; 3])]), 0);
}

#[test]
fn closed_and_flat_meshes() {
    let mut random = Random::new(142);
    for mesh in [jittered_icosphere(3, &mut random), grid(24)] {
        let rays = mixed_rays(&mesh, trials(700), &mut random);
        assert!(check(&mesh, &rays) > rays.len() / 5);
    }
}

/// `Exact` is itself in either layout, and `Fast` on one instruction set.
#[test]
fn precisions_agree_with_plain_packets() {
    let mut random = Random::new(143);
    let mesh = jittered_icosphere(3, &mut random);
    let rays = mixed_rays(&mesh, trials(1000), &mut random);
    let plain: Bvh<16> = build(&mesh.positions, &mesh.triangles, None, BuildQuality::High);
    let compact = compact::<16>(&mesh, BuildQuality::High);
    let mut expected = vec![Hit::miss(0.0); rays.len()];
    dispatch!(Level::new(), simd => {
        Apart(Single).closest_hits(simd, Exact, plain.view(), &rays, &mut expected, &AllHits);
        check_kernel(simd, Single, Exact, &compact, &rays, &AllHits, &expected);
        check_kernel(simd, Hybrid::<32>, Exact, &compact, &rays, &AllHits, &expected);
        Apart(Single).closest_hits(simd, Fast, plain.view(), &rays, &mut expected, &AllHits);
        check_kernel(simd, Single, Fast, &compact, &rays, &AllHits, &expected);
        check_kernel(simd, Hybrid::<32>, Fast, &compact, &rays, &AllHits, &expected);
    });
    assert!(expected.iter().filter(|hit| hit.is_hit()).count() > rays.len() / 3);
}

/// Leaves of hierarchies that were made elsewhere may be larger than any that is built.
#[test]
fn large_leaves_are_refused() {
    let mut random = Random::new(144);
    let mesh = soup(240, 0.2, &mut random);
    let packets: Vec<TrianglePacket<16>> = mesh
        .triangles
        .chunks(16)
        .enumerate()
        .map(|(first, triangles)| {
            let mut packet = TrianglePacket {
                vertices: [[[f32::NAN; 16]; 3]; 3],
                prim_ids: [u32::MAX; 16],
            };
            for (lane, triangle) in triangles.iter().enumerate() {
                packet.prim_ids[lane] = (16 * first + lane) as u32;
                for (vertex, &position) in triangle.iter().enumerate() {
                    for axis in 0..3 {
                        packet.vertices[vertex][axis][lane] =
                            mesh.positions[position as usize][axis];
                    }
                }
            }
            packet
        })
        .collect();
    let mut node = WideNode::<4> {
        bounds: [0, 1, 2, 3, 4, 5].map(|row| [[f32::INFINITY, f32::NEG_INFINITY][row % 2]; 4]),
        children: [LEAF; 4],
    };
    for row in 0..6 {
        node.bounds[row][2] = [-10.0, 10.0][row % 2];
    }
    node.children[2] = LEAF | 15 << 27;
    let bytes = bytes_of(&node, &packets);
    let bvh = Bvh::<4, 16>::read_from(&mut &bytes[..]).expect("a sound hierarchy");
    assert_eq!(
        CompactBvh::try_from(bvh).unwrap_err(),
        LeafTooLarge { node: 0, slot: 2 }
    );
}

/// A hierarchy of one node, as a file.
fn bytes_of(node: &WideNode<4>, packets: &[TrianglePacket<16>]) -> Vec<u8> {
    let mut bytes = b"ResidBVH".to_vec();
    for word in [1u32, 4, 16] {
        bytes.extend(word.to_le_bytes());
    }
    for count in [1, packets.len() as u64] {
        bytes.extend(count.to_le_bytes());
    }
    bytes.extend(0f32.to_le_bytes());
    bytes.extend(node.bounds.iter().flatten().flat_map(|x| x.to_le_bytes()));
    bytes.extend(node.children.iter().flat_map(|child| child.to_le_bytes()));
    for packet in packets {
        let coordinates = packet.vertices.iter().flatten().flatten();
        bytes.extend(coordinates.flat_map(|x| x.to_le_bytes()));
        bytes.extend(packet.prim_ids.iter().flat_map(|prim| prim.to_le_bytes()));
    }
    bytes
}
