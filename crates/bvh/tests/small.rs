//! Every kernel on a handful of triangles: small enough for miri, which holds the unsafe code to the letter.
//!
//! ```text
//! MIRIFLAGS="-Zmiri-tree-borrows -Zmiri-ignore-leaks -Zmiri-disable-isolation" RUSTFLAGS="-C target-cpu=x86-64" \
//!     cargo +nightly miri test -p residual-bvh --test small
//! ```

use fearless_simd::{Level, dispatch};
use residual_bvh::{
    AllHits, Apart, Boxes, BuildQuality, Bvh, BvhView, Exact, Fast, Hit, Hybrid, Kernel, OneByOne,
    Packet, Packets, Phased, QuantizedBvh, Ray, Single, Watertight, Width, build, build_compact,
};

/// Squares behind each other, two triangles each.
fn squares() -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for square in 0..6u32 {
        let z = -(square as f32);
        positions.extend([[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]]);
        triangles.extend([[0, 1, 2], [0, 2, 3]].map(|corners| corners.map(|i| 4 * square + i)));
    }
    (positions, triangles)
}

/// Towards the squares, one beside them, one that is no ray.
fn rays() -> Vec<Ray> {
    let ray = |x: f32, z: f32| Ray::unbounded([x, 0.25, z], [0.01, 0.02, -1.0]);
    let mut rays: Vec<Ray> = (0..6)
        .map(|i| ray(0.1 * i as f32, 0.5 - i as f32))
        .collect();
    rays.push(ray(3.0, 1.0));
    rays.push(Ray {
        dir: [0.0; 3],
        ..ray(0.5, 1.0)
    });
    rays
}

/// The kernels that between them have all code.
fn check<S, const N: usize, const P: usize>(
    simd: S,
    bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
) where
    S: Width<N> + Width<P> + Width<4>,
{
    let rays = rays();
    let mut expected = vec![Hit::miss(0.0); rays.len()];
    Apart(Single).closest_hits(simd, Watertight, bvh, &rays, &mut expected, &AllHits);
    let hit: Vec<bool> = expected.iter().map(Hit::is_hit).collect();
    assert_eq!(hit, [true, true, true, true, true, true, false, false]);
    for (i, hit) in expected[..6].iter().enumerate() {
        assert_eq!((hit.prim / 2, hit.t), (i as u32, 0.5));
    }
    let mut hits = expected.clone();
    Apart(OneByOne).closest_hits(simd, Watertight, bvh, &rays, &mut hits, &AllHits);
    assert_eq!(hits, expected);
    Apart(Hybrid::<4>).closest_hits(simd, Exact, bvh, &rays, &mut hits, &AllHits);
    assert!(hits.iter().zip(&expected).all(|(a, b)| a.prim == b.prim));
    let mut occluded = vec![false; rays.len()];
    Apart(Phased).any_hits(simd, Watertight, bvh, &rays, &mut occluded, &AllHits);
    assert_eq!(occluded, hit);
}

fn tree<const N: usize, const P: usize>() -> Bvh<N, P> {
    let (positions, triangles) = squares();
    build(&positions, &triangles, None, BuildQuality::Fast)
}

#[test]
fn every_width() {
    let (two, four, eight, sixteen) = (
        tree::<2, 1>(),
        tree::<4, 4>(),
        tree::<8, 4>(),
        tree::<16, 16>(),
    );
    dispatch!(Level::new(), simd => {
        check(simd, two.view());
        check(simd, four.view());
        check(simd, eight.view());
        check(simd, sixteen.view());
    });
}

#[test]
fn every_kernel() {
    let (bvh, rays) = (tree::<4, 4>(), rays());
    let mut expected = vec![Hit::miss(0.0); rays.len()];
    let mut hits = expected.clone();
    let mut occluded = vec![false; rays.len()];
    dispatch!(Level::new(), simd => {
        let view = bvh.view();
        Apart(Single).closest_hits(simd, Watertight, view, &rays, &mut expected, &AllHits);
        let hit: Vec<bool> = expected.iter().map(Hit::is_hit).collect();
        Apart(Packets::<4>).closest_hits(simd, Watertight, view, &rays, &mut hits, &AllHits);
        assert_eq!(hits, expected);
        Apart(Phased).closest_hits(simd, Watertight, view, &rays, &mut hits, &AllHits);
        assert_eq!(hits, expected);
        Apart(Packets::<4>).any_hits(simd, Fast, view, &rays, &mut occluded, &AllHits);
        assert_eq!(occluded, hit);
        Apart(Single).any_hits(simd, Fast, view, &rays, &mut occluded, &AllHits);
        assert_eq!(occluded, hit);
    });
}

#[test]
fn quantized_nodes() {
    let bvh = QuantizedBvh::from(tree::<4, 4>());
    dispatch!(Level::new(), simd => check(simd, bvh.view()));
}

#[test]
fn compact_packets() {
    let (positions, triangles) = squares();
    let quality = BuildQuality::High;
    let bvh = build_compact::<4>(&positions, &triangles, None, quality);
    dispatch!(Level::new(), simd => check(simd, bvh.view()));
}

/// So many triangles that there are more than a few nodes: neighbours make packets, others are in flight.
#[test]
fn streams_through_many_nodes() {
    let side = 12;
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for y in 0..=side {
        positions.extend((0..=side).map(|x| [x as f32, y as f32, ((x * y) % 3) as f32]));
    }
    for corner in (0..side * side).map(|i| i / side * (side + 1) + i % side) {
        let (right, above) = (corner + 1, corner + side + 1);
        triangles.extend([[corner, right, above], [right, above + 1, above]]);
    }
    let bvh: Bvh<4> = build(&positions, &triangles, None, BuildQuality::Fast);
    assert!(bvh.nodes().len() > 16);
    let compact = build_compact::<4>(&positions, &triangles, None, BuildQuality::Fast);
    let ray = |i: u32, dir| {
        let along = |step: u32| (i * step % 97) as f32 / 97.0 * side as f32;
        Ray::unbounded([along(13), along(29), 5.0], dir)
    };
    let neighbours = (0..64).map(|i| ray(i, [0.01, 0.02, -1.0]));
    let others = (0..64).map(|i| {
        ray(
            i,
            [0.3 - 0.1 * (i % 7) as f32, 0.2, [-1.0, 1.0][i as usize % 2]],
        )
    });
    for rays in [neighbours.collect::<Vec<Ray>>(), others.collect()] {
        let mut expected = vec![Hit::miss(0.0); rays.len()];
        let mut hits = expected.clone();
        let mut occluded = vec![false; rays.len()];
        dispatch!(Level::new(), simd => {
            Apart(Single).closest_hits(simd, Watertight, bvh.view(), &rays, &mut expected, &AllHits);
            Apart(Hybrid::<4>).closest_hits(simd, Watertight, bvh.view(), &rays, &mut hits, &AllHits);
            assert_eq!(hits, expected);
            Apart(Hybrid::<16>).closest_hits(simd, Watertight, compact.view(), &rays, &mut hits, &AllHits);
            assert_eq!(hits, expected);
            Apart(Hybrid::<8>).any_hits(simd, Watertight, compact.view(), &rays, &mut occluded, &AllHits);
        });
        let hit: Vec<bool> = expected.iter().map(Hit::is_hit).collect();
        assert_eq!(occluded, hit);
        assert!(hit.contains(&true));
    }
}

/// So many that all triangles are tested, with sixteen rays at once.
#[test]
fn streams_of_many_rays() {
    let bvh = tree::<8, 4>();
    let (positions, triangles) = squares();
    let compact = build_compact::<8>(&positions, &triangles, None, BuildQuality::Fast);
    let rays: Vec<Ray> = rays().into_iter().cycle().take(260).collect();
    // Neighbours that differ make no packets.
    let turned = |ray: &Ray| Ray {
        dir: ray.dir.map(|x| -x),
        ..*ray
    };
    let rays: Vec<Ray> = rays.iter().flat_map(|ray| [*ray, turned(ray)]).collect();
    let mut expected = vec![Hit::miss(0.0); rays.len()];
    let mut hits = expected.clone();
    dispatch!(Level::new(), simd => {
        Apart(Single).closest_hits(simd, Watertight, bvh.view(), &rays, &mut expected, &AllHits);
        Apart(Hybrid::<4>).closest_hits(simd, Watertight, compact.view(), &rays, &mut hits, &AllHits);
        assert_eq!(hits, expected);
        Apart(Hybrid::<4>).closest_hits(simd, Watertight, bvh.view(), &rays, &mut hits, &AllHits);
    });
    assert_eq!(hits, expected);
    assert!(hits.iter().any(Hit::is_hit) && !hits.iter().all(Hit::is_hit));
}
