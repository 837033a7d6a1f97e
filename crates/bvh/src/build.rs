//! From a mesh to a hierarchy: which triangles take part, and the steps of the build.

use crate::balance::limit_depth;
use crate::binary::BinaryTree;
use crate::collapse::collapse;
use crate::split::split_references;
use crate::{Bounds, Bvh};

/// How much time the build may spend on the tree's quality.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BuildQuality {
    /// For previews.
    Fast,
    /// For images that take minutes.
    Medium,
    /// Splits large triangles and optimises thoroughly.
    Best,
}

/// A triangle's index and a padded box around the triangle, or around a part of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reference {
    pub(crate) prim: u32,
    pub(crate) bounds: Bounds,
}

/// The triangles' corners and marks, as the build sees them.
#[derive(Clone, Copy)]
pub(crate) struct Mesh<'a> {
    positions: &'a [[f32; 3]],
    triangles: &'a [[u32; 3]],
    single_sided: Option<&'a [bool]>,
}

impl Mesh<'_> {
    pub(crate) fn vertices(&self, prim: u32) -> [[f32; 3]; 3] {
        self.triangles[prim as usize].map(|vertex| self.positions[vertex as usize])
    }

    pub(crate) fn is_single_sided(&self, prim: u32) -> bool {
        self.single_sided.is_some_and(|marks| marks[prim as usize])
    }
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
        .filter(|&prim| has_area(&mesh.vertices(prim)))
        .collect();
    let references = match quality {
        BuildQuality::Best => split_references(&mesh, &prims),
        BuildQuality::Fast | BuildQuality::Medium => whole_references(&mesh, &prims),
    };
    let tree = limit_depth(BinaryTree::build(&references, quality));
    collapse(&tree, &references, &mesh)
}

/// One reference for each triangle.
pub(crate) fn whole_references(mesh: &Mesh<'_>, prims: &[u32]) -> Vec<Reference> {
    let whole = |&prim: &u32| Reference {
        prim,
        bounds: Bounds::of_padded_triangle(&mesh.vertices(prim)),
    };
    prims.iter().map(whole).collect()
}

/// Whether the vertices are finite and not collinear. In `f64` the products of any two `f32`
/// differences neither overflow nor vanish.
fn has_area(vertices: &[[f32; 3]; 3]) -> bool {
    let [a, b, c] = vertices.map(|vertex| vertex.map(f64::from));
    let edge = |p: [f64; 3]| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
    let (e, f) = (edge(b), edge(c));
    let normal = [
        e[1] * f[2] - e[2] * f[1],
        e[2] * f[0] - e[0] * f[2],
        e[0] * f[1] - e[1] * f[0],
    ];
    vertices.iter().flatten().all(|x| x.is_finite()) && normal != [0.0; 3]
}
