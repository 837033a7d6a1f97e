//! Streams of every length, with rays that are none, through hierarchies of every shape: the kernels that keep rays in
//! flight across a stream give what brute force does (I-08, B-04).

use std::fmt::Debug;

use fearless_simd::{Level, dispatch};
use residual_bvh::{
    AllHits, Apart, Boxes, BuildQuality, BvhView, FrontHits, Hit, HitFilter, Hybrid, Kernel,
    MarkedHits, Phased, QuantizedBvh, Ray, TrianglePacket, Watertight, WideNode, Width, build,
};

use crate::mesh::{Mesh, fan, grid, jittered_icosphere, soup};
use crate::oracle::closest_hit_of_all;
use crate::random::Random;
use crate::runner::{Columns, Holes, aimed, same, trials};

/// Lengths around the number of rays in flight, packets and windows, and around as many as make it worth while to test all
/// triangles.
const LENGTHS: [usize; 18] = [
    0, 1, 2, 3, 7, 16, 31, 32, 33, 63, 65, 255, 256, 257, 511, 512, 700, RAYS,
];
/// More than are sorted together.
const RAYS: usize = 1300;

/// Holds a kernel against the expected hits, for streams of all lengths.
fn compare<S, const N: usize, const P: usize, F: HitFilter>(
    simd: S,
    kernel: impl Kernel<S, N, P> + Debug,
    bvh: BvhView<'_, N, P, impl Boxes<N>>,
    rays: &[Ray],
    expected: &[Hit],
    filter: &F,
) where
    S: Width<N> + Width<P>,
{
    let kernel = Apart(kernel);
    for length in LENGTHS.into_iter().filter(|&length| length <= rays.len()) {
        let start = rays.len() - length;
        let (rays, expected) = (&rays[start..], &expected[start..]);
        let mut hits = vec![Hit::miss(-1.0); length];
        let mut occluded = vec![false; length];
        // What is not overwritten is wrong.
        hits.fill(Hit {
            prim: 0x7777,
            ..Hit::miss(-1.0)
        });
        for (occluded, hit) in occluded.iter_mut().zip(expected) {
            *occluded = !hit.is_hit();
        }
        kernel.closest_hits(simd, Watertight, bvh, rays, &mut hits, filter);
        kernel.any_hits(simd, Watertight, bvh, rays, &mut occluded, filter);
        for (i, ray) in rays.iter().enumerate() {
            assert!(
                same(&hits[i], &expected[i]) && occluded[i] == expected[i].is_hit(),
                "{kernel:?}, {length} rays: {ray:?}\n  {:?}, {}, expected {:?}",
                hits[i],
                occluded[i],
                expected[i],
            );
        }
    }
}

/// Every other ray through the mesh; the rest NaN, infinite, without direction, or with an empty interval; a few with an
/// interval that ends before it begins to count.
fn mixed_rays(mesh: &Mesh, random: &mut Random) -> Vec<Ray> {
    (0..RAYS)
        .map(|i| {
            let mut ray = aimed(random.in_cube(1.5), mesh.edge_point(random));
            match i % 16 {
                1 => ray.org[random.below(3)] = f32::NAN,
                3 => ray.dir[random.below(3)] = f32::NAN,
                5 => ray.dir = [0.0; 3],
                7 => ray.dir[random.below(3)] = f32::INFINITY,
                9 => (ray.tmin, ray.tmax) = (1.0, 0.5),
                11 => ray.tmax = f32::NAN,
                13 => (ray.tmin, ray.tmax) = (-2.0, -1.0),
                14 => (ray.tmin, ray.tmax) = (random.unit(), 1.0 + random.unit()),
                15 => ray.tmin = f32::NAN,
                _ => {}
            }
            ray
        })
        .collect()
}

fn brute_force(mesh: &Mesh, rays: &[Ray], filter: &impl HitFilter) -> Vec<Hit> {
    rays.iter()
        .map(|ray| closest_hit_of_all(mesh, ray, filter))
        .collect()
}

/// All filters, and other widths and nodes without one.
fn check(mesh: &Mesh, rays: &[Ray]) -> usize {
    let marks = (!mesh.single_sided.is_empty()).then_some(&mesh.single_sided[..]);
    let (positions, triangles) = (&mesh.positions, &mesh.triangles);
    let eight = build::<8, 8>(positions, triangles, marks, BuildQuality::Best);
    let sixteen = build::<16, 16>(positions, triangles, marks, BuildQuality::Best);
    let quantized = QuantizedBvh::from(eight.clone());
    let [all, front, marked, holes] = [
        brute_force(mesh, rays, &AllHits),
        brute_force(mesh, rays, &FrontHits),
        brute_force(mesh, rays, &MarkedHits),
        brute_force(mesh, rays, &Holes),
    ];
    dispatch!(Level::new(), simd => {
        compare(simd, Hybrid::<8>, eight.view(), rays, &front, &FrontHits);
        compare(simd, Phased, eight.view(), rays, &marked, &MarkedHits);
        compare(simd, Hybrid::<32>, eight.view(), rays, &marked, &MarkedHits);
        compare(simd, Phased, eight.view(), rays, &holes, &Holes);
        compare(simd, Columns::<32>, eight.view(), rays, &holes, &Holes);
        compare(simd, Phased, sixteen.view(), rays, &all, &AllHits);
        compare(simd, Columns::<8>, sixteen.view(), rays, &all, &AllHits);
        compare(simd, Phased, quantized.view(), rays, &all, &AllHits);
    });
    all.iter().filter(|hit| hit.is_hit()).count()
}

/// None, one, a single leaf, a leaf of several packets' worth, as many as are all tested, one more, a tree.
#[test]
fn hierarchies_of_every_size() {
    let mut random = Random::new(160);
    for count in [1, 2, 8, 20, 85, 86, trials(500)] {
        let mesh = soup(count, 0.5, &mut random).marked(&mut random);
        let rays = mixed_rays(&mesh, &mut random);
        assert!(check(&mesh, &rays) > rays.len() / 8, "{count} triangles");
    }
    let empty = Mesh::default();
    let rays: Vec<Ray> = (0..40)
        .map(|_| aimed(random.in_cube(1.0), [0.0; 3]))
        .collect();
    assert_eq!(check(&empty, &rays), 0);
}

/// Equal triangles make leaves of many packets, and ties within them and between them: the smallest index wins.
#[test]
fn leaves_of_many_packets() {
    let mut random = Random::new(161);
    let few = soup(3, 0.8, &mut random);
    for count in [70, 200] {
        let mut mesh = Mesh::default();
        for i in 0..count {
            mesh.push(few.vertices((i * 7) % 3));
        }
        let mesh = mesh.marked(&mut random);
        let rays = mixed_rays(&mesh, &mut random);
        assert!(check(&mesh, &rays) > rays.len() / 8);
    }
}

/// Rays that start at vertices of several triangles, and hit them at a distance of zero of either sign.
#[test]
fn rays_that_start_on_triangles() {
    let mut random = Random::new(162);
    for mesh in [fan(60), grid(12), jittered_icosphere(2, &mut random)] {
        let rays: Vec<Ray> = (0..700)
            .map(|i| {
                let mut dir = [0.0; 3];
                dir[i % 3] = [1.0, -1.0, 0.15625, -0.15625][random.below(4)];
                if i % 4 == 0 {
                    dir[(i + 1) % 3] = 0.5;
                }
                Ray::unbounded(mesh.vertex(&mut random), dir)
            })
            .collect();
        assert!(check(&mesh, &rays) > rays.len() / 8);
    }
}

/// `LEVELS` nodes in each other, all of whose boxes are touched by what touches one: each level leaves all siblings but one
/// on the stack. All other slots hold a leaf of one triangle.
fn chain<const N: usize, const P: usize>(
    random: &mut Random,
) -> (Mesh, Vec<WideNode<N>>, Vec<TrianglePacket<P>>) {
    const LEVELS: usize = 64;
    const LEAF: u32 = 1 << 31;
    let (mut mesh, mut nodes, mut packets) = (Mesh::default(), Vec::new(), Vec::new());
    for level in 0..LEVELS {
        let mut node = WideNode {
            bounds: [-2.0, 2.0, -2.0, 2.0, -2.0, 2.0].map(|plane| [plane; N]),
            children: [level as u32 + 1; N],
        };
        for (slot, child) in node.children.iter_mut().enumerate() {
            if slot == 0 && level + 1 < LEVELS {
                continue;
            }
            *child = LEAF | 1 << 27 | packets.len() as u32;
            let middle = random.in_cube(1.0);
            let mut packet = TrianglePacket {
                vertices: [[[f32::NAN; P]; 3]; 3],
                prim_ids: [u32::MAX; P],
            };
            packet.prim_ids[0] = packets.len() as u32;
            let corners = [0, 1, 2].map(|vertex| {
                let offset = random.in_cube(0.5);
                [0, 1, 2].map(|axis| {
                    let coordinate = middle[axis] + offset[axis];
                    packet.vertices[vertex][axis][0] = coordinate;
                    coordinate
                })
            });
            mesh.push(corners);
            packets.push(packet);
        }
        nodes.push(node);
    }
    (mesh, nodes, packets)
}

/// As deep as is allowed; what is at the bottom is visited first.
#[test]
fn deepest_stacks() {
    macro_rules! check {
        ($($n:literal x $p:literal)*) => {$(
            let mut random = Random::new(162);
            let (mesh, nodes, packets) = chain::<$n, $p>(&mut random);
            let rays = mixed_rays(&mesh, &mut random);
            let expected = brute_force(&mesh, &rays, &AllHits);
            assert!(expected.iter().filter(|hit| hit.is_hit()).count() > rays.len() / 8);
            let bvh = BvhView::<$n, $p>::new(&nodes, &packets).expect("as deep as is allowed");
            dispatch!(Level::new(), simd => compare(simd, Phased, bvh, &rays, &expected, &AllHits));
        )*};
    }
    check!(2 x 1 16 x 8);
}
