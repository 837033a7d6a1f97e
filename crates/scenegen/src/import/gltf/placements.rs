//! Meshes placed in the world: composed in 64 bits, and made relative to the scene's origin before they become 32.

use glam::{DAffine3, DVec3};

use crate::desc::{InstanceDesc, MeshDesc};
use crate::import::instances::place_mesh;
use crate::import::origin;
use crate::import::warnings::Warnings;

/// A mesh of the scene, placed.
pub(super) struct Placement {
    /// Index of the mesh.
    pub(super) mesh: usize,
    /// Index of the node among those of the scene.
    pub(super) node: usize,
    /// Object to world.
    pub(super) world: DAffine3,
}

/// The place that positions are relative to; the origin of the world unless the meshes are far from it.
pub(super) fn origin(placements: &[Placement], meshes: &[MeshDesc]) -> DVec3 {
    let boxes: Vec<[DVec3; 2]> = meshes.iter().map(bounds).collect();
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for placement in placements {
        let corners = boxes[placement.mesh];
        for k in 0..8 {
            let side = |axis: usize| corners[k >> axis & 1][axis];
            let corner = DVec3::new(side(0), side(1), side(2));
            let corner = placement.world.transform_point3(corner);
            if corner.is_finite() {
                (low, high) = (low.min(corner), high.max(corner));
            }
        }
    }
    origin::choose([low, high])
}

fn bounds(mesh: &MeshDesc) -> [DVec3; 2] {
    let positions = mesh.positions.iter().map(|position| position.as_dvec3());
    positions.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], p| {
        [low.min(p), high.max(p)]
    })
}

/// The instances, relative to an origin. `named` gives the name and the JSON path of a node.
pub(super) fn instances<'a>(
    placements: &[Placement],
    meshes: &[MeshDesc],
    origin: DVec3,
    named: impl Fn(usize) -> [&'a str; 2],
    warnings: &mut Warnings,
) -> Vec<InstanceDesc> {
    let instance = |placement: &Placement| {
        let [name, place] = named(placement.node);
        let mut world = placement.world;
        world.translation -= origin;
        place_mesh(meshes, placement.mesh, name, &world, place, warnings)
    };
    placements.iter().filter_map(instance).collect()
}
