//! Geometry: instances baked into world space, one vertex buffer for each attribute that some program reads.

use glam::{Mat3, Vec3, Vec4};
use residual_render::domain::Buffer;
use residual_render::program::Culling;
use residual_render::scene_data::SceneData;
use residual_render::surface::{Attributes, TRIANGLE_WORDS};

use super::camera::Bounds;
use super::{Materials, PlanError, PlannedMaterial, culling};
use crate::desc::{InstanceDesc, MeshDesc, SceneDesc, Warning};

/// What packing found out.
#[derive(Debug)]
pub(super) struct Geometry {
    pub(super) bounds: Bounds,
    pub(super) culling: Culling,
    /// Triangle ranges of instances with their materials, in order.
    pub(super) ranges: Vec<(std::ops::Range<u32>, usize)>,
}

/// Attributes that any program reads: the buffers to be filled, for all vertices.
fn wanted(materials: &Materials) -> Attributes {
    let mut all = Attributes::default();
    for program in &materials.programs {
        all = all.union(program.attributes);
        if let Some(alpha) = &program.alpha {
            all = all.union(alpha.attributes);
        }
    }
    all
}

/// Packs all instances.
pub(super) fn pack(
    scene: &SceneDesc,
    materials: &Materials,
    data: &mut SceneData,
    warnings: &mut Vec<Warning>,
) -> Result<Geometry, PlanError> {
    let wanted = wanted(materials);
    let mut bounds = Bounds::EMPTY;
    let mut ranges = Vec::new();
    let mut vertices = 0_u64;
    let mut triangles = 0_u64;
    for instance in &scene.instances {
        let mesh = &scene.meshes[instance.mesh];
        if materials.of(mesh.material).invisible {
            warnings.push(Warning {
                place: format!("node {:?}", instance.name),
                message: format!(
                    "its material {:?} is transparent everywhere; left out",
                    scene.materials[mesh.material].name
                ),
            });
            continue;
        }
        if (vertices + mesh.positions.len() as u64) * 4 > u64::from(u32::MAX) {
            return Err(PlanError::TooLarge { what: "vertices" });
        }
        let words = u64::from(TRIANGLE_WORDS);
        if (triangles + mesh.triangles.len() as u64) * words > u64::from(u32::MAX) {
            return Err(PlanError::TooLarge { what: "triangles" });
        }
        let positions = mesh.positions.iter();
        let positions: Vec<Vec3> = positions
            .map(|&p| instance.transform.transform_point3(p))
            .collect();
        positions.iter().for_each(|&p| bounds.add(p));
        pack_triangles(
            mesh,
            instance,
            &positions,
            materials.of(mesh.material),
            data,
        );
        if wanted != Attributes::NONE {
            pack_indices(mesh, instance, vertices as u32, data);
            pack_attributes(mesh, instance, wanted, data);
        }
        let start = triangles as u32;
        vertices += mesh.positions.len() as u64;
        triangles += mesh.triangles.len() as u64;
        ranges.push((start..triangles as u32, mesh.material));
    }
    let culled = data.single_sided.iter().filter(|&&single| single).count();
    let culling = culling(culled, data.single_sided.len());
    Ok(Geometry {
        bounds,
        culling,
        ranges,
    })
}

fn extend(data: &mut SceneData, buffer: Buffer, values: impl IntoIterator<Item = f32>) {
    data.buffer_mut(buffer)
        .extend(values.into_iter().map(f32::to_bits));
}

fn pack_attributes(
    mesh: &MeshDesc,
    instance: &InstanceDesc,
    wanted: Attributes,
    data: &mut SceneData,
) {
    let linear = Mat3::from(instance.transform.matrix3);
    // Normals go by the cofactor matrix, which exists for singular transforms too; its sign mirrors with them.
    let cofactors = Mat3::from_cols(
        linear.y_axis.cross(linear.z_axis),
        linear.z_axis.cross(linear.x_axis),
        linear.x_axis.cross(linear.y_axis),
    );
    let side = if linear.determinant() < 0.0 {
        -1.0
    } else {
        1.0
    };
    let count = mesh.positions.len();
    if wanted.normals {
        for &n in &mesh.normals {
            let n = (cofactors * n * side).normalize_or(n);
            extend(data, Buffer::Normals, n.extend(0.0).to_array());
        }
    }
    if wanted.tangents {
        // (0, 0, 0) leaves the frame to the normal.
        let none = vec![Vec4::new(0.0, 0.0, 0.0, 1.0); count];
        for &t in mesh.tangents.as_ref().unwrap_or(&none) {
            let turned = (linear * t.truncate()).normalize_or_zero();
            extend(data, Buffer::Tangents, turned.extend(t.w * side).to_array());
        }
    }
    if wanted.uv0 || wanted.uv1 {
        let uv = |set: usize, vertex: usize| match &mesh.uvs[set] {
            Some(uvs) => uvs[vertex].to_array(),
            None => [0.0; 2],
        };
        let row = |vertex| uv(0, vertex).into_iter().chain(uv(1, vertex));
        extend(data, Buffer::Uvs, (0..count).flat_map(row));
    }
    if wanted.colors {
        match &mesh.colors {
            Some(colors) => {
                extend(
                    data,
                    Buffer::Colors,
                    colors.iter().flat_map(|c| c.to_array()),
                );
            }
            None => extend(data, Buffer::Colors, vec![1.0; count * 4]),
        }
    }
}

/// The triangles of a mesh, counter-clockwise seen from the front of the instance.
fn turned(mesh: &MeshDesc, instance: &InstanceDesc) -> impl Iterator<Item = [u32; 3]> {
    let mirrored = Mat3::from(instance.transform.matrix3).determinant() < 0.0;
    let turn = move |&[a, b, c]: &[u32; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
    mesh.triangles.iter().map(turn)
}

fn pack_triangles(
    mesh: &MeshDesc,
    instance: &InstanceDesc,
    positions: &[Vec3],
    planned: &PlannedMaterial,
    data: &mut SceneData,
) {
    for triangle in turned(mesh, instance) {
        let corners = triangle.map(|corner| positions[corner as usize].to_array());
        data.push_triangle(corners, planned.program, planned.params);
    }
    data.single_sided
        .resize(data.triangle_count(), planned.culled);
}

fn pack_indices(mesh: &MeshDesc, instance: &InstanceDesc, first_vertex: u32, data: &mut SceneData) {
    let indices = data.buffer_mut(Buffer::Indices);
    for triangle in turned(mesh, instance) {
        let [a, b, c] = triangle.map(|corner| first_vertex + corner);
        indices.extend([a, b, c, 0]);
    }
}

/// Whether a mesh's normals say more than its triangles do.
pub(super) fn is_smooth(mesh: &MeshDesc) -> bool {
    mesh.triangles.iter().any(|triangle| {
        let [a, b, c] = triangle.map(|corner| mesh.positions[corner as usize]);
        let face = (b - a).cross(c - a).normalize_or_zero();
        let differs = |corner: &u32| mesh.normals[*corner as usize].dot(face) < 1.0 - 1e-6;
        face != Vec3::ZERO && triangle.iter().any(differs)
    })
}
