//! Geometry: instances baked into world space, one vertex buffer for each attribute that some program reads.

use glam::{Mat3, Vec3, Vec4};
use residual_render::domain::Buffer;
use residual_render::light::NO_LIGHT;
use residual_render::program::Culling;
use residual_render::scene_data::SceneData;
use residual_render::surface::Attributes;

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
        if triangles + mesh.triangles.len() as u64 >= 1 << 31 {
            return Err(PlanError::TooLarge { what: "triangles" });
        }
        pack_vertices(mesh, instance, wanted, data, &mut bounds);
        pack_triangles(
            mesh,
            instance,
            vertices as u32,
            materials.of(mesh.material),
            data,
        );
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

fn pack_vertices(
    mesh: &MeshDesc,
    instance: &InstanceDesc,
    wanted: Attributes,
    data: &mut SceneData,
    bounds: &mut Bounds,
) {
    let transform = instance.transform;
    let linear = Mat3::from(transform.matrix3);
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
    for &p in &mesh.positions {
        let p = transform.transform_point3(p);
        bounds.add(p);
        extend(data, Buffer::Positions, p.to_array());
    }
    if wanted.normals {
        for &n in &mesh.normals {
            let n = (cofactors * n * side).normalize_or(n);
            extend(data, Buffer::Normals, n.to_array());
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
    for (set, buffer, wanted) in [(0, Buffer::Uv0, wanted.uv0), (1, Buffer::Uv1, wanted.uv1)] {
        if wanted {
            match &mesh.uvs[set] {
                Some(uvs) => extend(data, buffer, uvs.iter().flat_map(|uv| uv.to_array())),
                None => extend(data, buffer, vec![0.0; count * 2]),
            }
        }
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

fn pack_triangles(
    mesh: &MeshDesc,
    instance: &InstanceDesc,
    first_vertex: u32,
    planned: &PlannedMaterial,
    data: &mut SceneData,
) {
    let mirrored = Mat3::from(instance.transform.matrix3).determinant() < 0.0;
    for &[a, b, c] in &mesh.triangles {
        let corners = if mirrored { [a, c, b] } else { [a, b, c] };
        data.buffer_mut(Buffer::Triangles)
            .extend(corners.map(|corner| first_vertex + corner));
    }
    let count = mesh.triangles.len();
    let push = |data: &mut SceneData, buffer: Buffer, value: u32| {
        let words = data.buffer_mut(buffer);
        words.resize(words.len() + count, value);
    };
    push(data, Buffer::TrianglePrograms, planned.program);
    push(data, Buffer::TriangleParams, planned.params);
    push(data, Buffer::TriangleLights, NO_LIGHT);
    data.single_sided
        .resize(data.single_sided.len() + count, planned.culled);
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
