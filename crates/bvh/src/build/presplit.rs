//! References split before the build: a large triangle enters the tree as several boxes around its parts, which
//! enclose less empty space than one (M. Ernst, G. Greiner, "Early Split Clipping for Bounding
//! Volume Hierarchies", RT 2007; the heuristic is obvhs').

use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::splits::split_aabbs_preset;
use obvhs::triangle::Triangle;

use crate::bounds::Bounds;
use crate::build::mesh::Mesh;
use crate::build::reference::Reference;

/// Coordinates whose areas stay clear of overflow and underflow in `f32`.
const SAFE_COORDINATES: f32 = 1e15;

/// References to the triangles `prims`, at least one for each.
pub(crate) fn split_references(mesh: &Mesh<'_>, prims: &[u32]) -> Vec<Reference> {
    let triangles: Vec<Triangle> = prims
        .iter()
        .map(|&prim| {
            let [v0, v1, v2] = mesh.vertices(prim).map(Vec3A::from_array);
            Triangle { v0, v1, v2 }
        })
        .collect();
    let mut boxes: Vec<Aabb> = triangles.iter().map(|triangle| triangle.aabb()).collect();
    let areas = || boxes.iter().map(|bounds| bounds.half_area());
    let largest = areas().fold(0.0, f32::max);
    let average = (areas().map(f64::from).sum::<f64>() / boxes.len() as f64) as f32;
    let in_range = boxes.iter().all(|bounds| {
        bounds
            .min
            .abs()
            .max_element()
            .max(bounds.max.abs().max_element())
            < SAFE_COORDINATES
    });
    if !in_range || average < f32::MIN_POSITIVE {
        return whole_references(mesh, prims);
    }

    let extents: Vec<f32> = prims
        .iter()
        .map(|&prim| Bounds::of_triangle(&mesh.vertices(prim)).extent())
        .collect();
    let mut sources: Vec<u32> = (0..prims.len() as u32).collect();
    split_aabbs_preset(&mut boxes, &mut sources, &triangles, average, largest);
    boxes
        .iter()
        .zip(&sources)
        .map(|(part, &source)| {
            // A part that holds nothing of the triangle comes out inverted, as may, by a rounding,
            // a flat one: the box between the two planes is safe for both.
            let bounds = Bounds {
                lo: part.min.min(part.max).to_array(),
                hi: part.min.max(part.max).to_array(),
            };
            // Clipping rounds no worse than the padding of the whole triangle allows.
            Reference {
                prim: prims[source as usize],
                bounds: bounds.padded(extents[source as usize]),
            }
        })
        .collect()
}

/// One reference for each triangle.
fn whole_references(mesh: &Mesh<'_>, prims: &[u32]) -> Vec<Reference> {
    let whole = |&prim: &u32| Reference {
        prim,
        bounds: Bounds::of_padded_triangle(&mesh.vertices(prim)),
    };
    prims.iter().map(whole).collect()
}
