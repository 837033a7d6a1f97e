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
    let samples_each = (origin::MAX_SAMPLES / placements.len().max(1)).max(1);
    let corners = placements.iter().flat_map(|placement| {
        let mesh = &meshes[placement.mesh];
        let corners = mesh.triangles.as_flattened();
        let step = corners.len().div_ceil(samples_each).max(1);
        let used = corners.iter().step_by(step);
        used.map(move |&corner| {
            let position = mesh.positions[corner as usize].as_dvec3();
            placement.world.transform_point3(position)
        })
    });
    origin::choose(corners)
}

/// The instances, relative to an origin; `None`, after a warning, for those of which nothing can be seen. `named` gives the name
/// and the JSON path of a node.
pub(super) fn instances<'a>(
    placements: &[Placement],
    meshes: &[MeshDesc],
    origin: DVec3,
    named: impl Fn(usize) -> [&'a str; 2],
    warnings: &mut Warnings,
) -> Vec<Option<InstanceDesc>> {
    let instance = |placement: &Placement| {
        let [name, place] = named(placement.node);
        let mut world = placement.world;
        world.translation -= origin;
        place_mesh(meshes, placement.mesh, name, &world, place, warnings)
    };
    placements.iter().map(instance).collect()
}
