//! From a mesh to a hierarchy: which triangles take part, and the steps of the build.

mod balance;
mod binary;
mod binning;
mod clip;
mod collapse;
mod fragment;
mod leaf_size;
mod mesh;
mod partition;
mod ploc;
mod presplit;
mod reference;
mod refit;
mod reinsert;
mod sbvh;
mod spatial;

use rayon::prelude::*;

use self::collapse::collapse;
use self::leaf_size::{LeafSize, Triangles, Vertices};
use self::mesh::{Mesh, has_area};
use self::reinsert::reinsert;
use self::sbvh::{Splits, build_tree};
use crate::layout::bvh::Bvh;
use crate::layout::compact::CompactBvh;

/// How much time the build may spend on the tree's quality.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BuildQuality {
    /// From the top down, in parallel.
    Fast,
    /// Then a few subtrees move to where they cost less.
    Medium,
    /// Splits large triangles, and moves many subtrees.
    High,
    /// Takes five to ten times as long as `High`. Single rays take up to a fifth less; streams of incoherent rays, many of which
    /// are in flight, between an eighth less and a twentieth more.
    Best,
}

impl BuildQuality {
    /// All, the fastest build first.
    pub const ALL: [BuildQuality; 4] = [
        BuildQuality::Fast,
        BuildQuality::Medium,
        BuildQuality::High,
        BuildQuality::Best,
    ];
}

/// Builds a hierarchy over `triangles`, whose vertices index `positions`; `single_sided` marks
/// those that [`MarkedHits`](crate::MarkedHits) hits only from the front.
///
/// Triangles with a vertex that is not finite, or without area, are left out. Equal input gives
/// equal bytes.
///
/// # Panics
/// If a vertex index is out of range, there are marks but not one for each triangle, or there are
/// 2³¹ triangles or more.
pub fn build<const N: usize, const P: usize>(
    positions: &[[f32; 3]],
    triangles: &[[u32; 3]],
    single_sided: Option<&[bool]>,
    quality: BuildQuality,
) -> Bvh<N, P> {
    build_with_progress(positions, triangles, single_sided, quality, &|_| ())
}

/// As [`build`], and calls `report` now and then with the fraction that is done, in [0, 1]: from any
/// of the threads, and not always in order.
pub fn build_with_progress<const N: usize, const P: usize>(
    positions: &[[f32; 3]],
    triangles: &[[u32; 3]],
    single_sided: Option<&[bool]>,
    quality: BuildQuality,
    report: &(dyn Fn(f32) + Sync),
) -> Bvh<N, P> {
    build_leaves::<N, P, Triangles>(positions, triangles, single_sided, quality, report)
}

/// As [`build`], in a third to a half of the memory: see [`CompactBvh`]. Leaves are planned for packets that hold 16 vertices.
///
/// # Panics
/// As [`build`].
pub fn build_compact<const N: usize>(
    positions: &[[f32; 3]],
    triangles: &[[u32; 3]],
    single_sided: Option<&[bool]>,
    quality: BuildQuality,
) -> CompactBvh<N> {
    let report = |_| ();
    let bvh = build_leaves::<N, 16, Vertices>(positions, triangles, single_sided, quality, &report);
    CompactBvh::try_from(bvh).expect("leaves have at most 64 triangles")
}

fn build_leaves<const N: usize, const P: usize, L: LeafSize<P>>(
    positions: &[[f32; 3]],
    triangles: &[[u32; 3]],
    single_sided: Option<&[bool]>,
    quality: BuildQuality,
    report: &(dyn Fn(f32) + Sync),
) -> Bvh<N, P> {
    assert!(triangles.len() < 1 << 31, "too many triangles");
    assert!(
        single_sided.is_none_or(|marks| marks.len() == triangles.len()),
        "marks per triangle"
    );
    let mesh = Mesh {
        positions,
        triangles,
        single_sided,
    };
    let prims: Vec<u32> = (0..triangles.len() as u32)
        .into_par_iter()
        .filter(|&prim| has_area(&mesh.vertices(prim)))
        .collect();
    let top_down = |splits: Splits, rounds: &[f32]| {
        let (tree, references) = build_tree(&mesh, &prims, splits, &|done| report(0.6 * done));
        reinsert(tree, references, P as u32, rounds)
    };
    let (tree, references) = match quality {
        BuildQuality::Fast => top_down(Splits::Objects, &[]),
        BuildQuality::Medium => top_down(Splits::Objects, &[0.3, 0.2, 0.2, 0.2]),
        // Eight rounds of all nodes gain 0.2 % more, and take three times as long.
        BuildQuality::High => top_down(
            Splits::ObjectsAndSpace,
            &[1.0, 0.5, 0.33, 0.25, 0.2, 0.17, 0.14, 0.12],
        ),
        BuildQuality::Best => ploc::build_tree(&mesh, &prims),
    };
    report(0.8);
    let bvh = collapse::<N, P, L>(&tree, &references, &mesh);
    report(1.0);
    bvh
}
