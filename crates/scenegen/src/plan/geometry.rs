//! Geometry: instances baked into world space, one vertex buffer for each attribute that some program reads.

use glam::{Mat3, Vec3, Vec4};
use residual_render::domain::Buffer;
use residual_render::program::AlphaTestNode;
use residual_render::scene_data::SceneData;
use residual_render::surface::{Attributes, ColorRecord, NormalRecord, TangentRecord, UvRecord};
use residual_render::triangle::TriangleRecord;

use super::camera::Bounds;
use super::error::PlanError;
use super::planned::PlannedObject;
use super::planned_materials::{Materials, PlannedMaterial};
use crate::desc::{InstanceDesc, MeshDesc, Pose, SceneDesc, Warning, WarningKind};

/// What packing found out.
#[derive(Debug)]
pub(super) struct Geometry {
    pub(super) bounds: Bounds,
    pub(super) objects: Vec<PlannedObject>,
}

/// An instance that is seen, with what its material reads.
struct Visible<'a> {
    instance: &'a InstanceDesc,
    mesh: &'a MeshDesc,
    planned: &'a PlannedMaterial,
    reads: Attributes,
    /// Index of its first vertex; of no use where nothing is read.
    first_vertex: u32,
}

/// The instances that are seen.
fn visible<'a>(
    scene: &'a SceneDesc,
    pose: Pose<'a>,
    materials: &'a Materials,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<Visible<'a>>, PlanError> {
    let mut visible = Vec::new();
    let mut triangles = 0_u64;
    for instance in pose.instances {
        let mesh = &scene.meshes[instance.mesh];
        let Some(planned) = &materials.planned[mesh.material] else {
            warnings.push(Warning {
                kind: WarningKind::Invisible,
                place: format!("node {:?}", instance.name),
                message: format!(
                    "its material {:?} is transparent everywhere; left out",
                    scene.materials[mesh.material].name
                ),
            });
            continue;
        };
        triangles += mesh.triangles.len() as u64;
        if triangles * u64::from(TriangleRecord::WORDS) > u64::from(u32::MAX) {
            return Err(PlanError::TooLarge { what: "triangles" });
        }
        let program = &materials.programs[planned.program as usize];
        let alpha_test = program.alpha_test.iter();
        let reads = alpha_test
            .map(AlphaTestNode::given_attributes)
            .fold(program.attributes, Attributes::union);
        visible.push(Visible {
            instance,
            mesh,
            planned,
            reads,
            first_vertex: 0,
        });
    }
    Ok(visible)
}

/// An attribute as a buffer: who reads it, and its rows.
struct Attribute {
    buffer: Buffer,
    is_read: fn(Attributes) -> bool,
    /// Of its record.
    words: u32,
    pack: fn(&Visible<'_>, &mut SceneData),
}

/// From the one that the fewest materials read, as a rule, to the one that the most do.
const ATTRIBUTES: [Attribute; 4] = [
    Attribute {
        buffer: Buffer::Tangents,
        is_read: |reads| reads.tangents,
        words: TangentRecord::WORDS,
        pack: pack_tangents,
    },
    Attribute {
        buffer: Buffer::Colors,
        is_read: |reads| reads.colors,
        words: ColorRecord::WORDS,
        pack: pack_colors,
    },
    Attribute {
        buffer: Buffer::Uvs,
        is_read: |reads| reads.uv0 || reads.uv1,
        words: UvRecord::WORDS,
        pack: pack_uvs,
    },
    Attribute {
        buffer: Buffer::Normals,
        is_read: |reads| reads.normals,
        words: NormalRecord::WORDS,
        pack: pack_normals,
    },
];

/// Packs all instances of a pose.
pub(super) fn pack(
    scene: &SceneDesc,
    pose: Pose<'_>,
    materials: &Materials,
    data: &mut SceneData,
    warnings: &mut Vec<Warning>,
) -> Result<Geometry, PlanError> {
    let mut visible = visible(scene, pose, materials, warnings)?;
    pack_vertices(&mut visible, data)?;
    let mut bounds = Bounds::EMPTY;
    let mut objects = Vec::new();
    for (object_index, seen) in (0..).zip(&visible) {
        let start = data.triangle_count() as u32;
        let transform = &seen.instance.transform;
        let positions = seen.mesh.positions.iter();
        let positions: Vec<Vec3> = positions.map(|&p| transform.transform_point3(p)).collect();
        positions.iter().for_each(|&p| bounds.add(p));
        pack_triangles(object_index, seen, &positions, data);
        objects.push(PlannedObject {
            name: seen.instance.name.clone(),
            material: seen.mesh.material,
            material_name: scene.materials[seen.mesh.material].name.clone(),
            triangles: start..data.triangle_count() as u32,
        });
    }
    Ok(Geometry { bounds, objects })
}

/// Orders the vertices and writes the buffers of attributes. Vertices whose material reads nothing are none; those
/// that read the rarest attributes come first, so that each buffer ends with the last vertex that reads it.
fn pack_vertices(visible: &mut [Visible<'_>], data: &mut SceneData) -> Result<(), PlanError> {
    let mut order: Vec<usize> = (0..visible.len())
        .filter(|&k| visible[k].reads != Attributes::NONE)
        .collect();
    order.sort_by_key(|&k| {
        ATTRIBUTES
            .each_ref()
            .map(|attribute| !(attribute.is_read)(visible[k].reads))
    });
    let mut vertices = 0_u64;
    for &k in &order {
        visible[k].first_vertex = vertices as u32;
        vertices += visible[k].mesh.positions.len() as u64;
        if vertices * 4 > u64::from(u32::MAX) {
            return Err(PlanError::TooLarge { what: "vertices" });
        }
    }
    for attribute in &ATTRIBUTES {
        let reads = |&k: &usize| (attribute.is_read)(visible[k].reads);
        let readers = order.iter().rposition(reads).map_or(0, |last| last + 1);
        for k in &order[..readers] {
            let seen = &visible[*k];
            if reads(k) {
                (attribute.pack)(seen, data);
            } else {
                let buffer = data.buffer_mut(attribute.buffer);
                let unread = attribute.words as usize * seen.mesh.positions.len();
                buffer.resize(buffer.len() + unread, 0);
            }
        }
    }
    Ok(())
}

fn linear(seen: &Visible<'_>) -> Mat3 {
    Mat3::from(seen.instance.transform.matrix3)
}

/// −1 for instances that are mirrored.
fn side(linear: Mat3) -> f32 {
    if linear.determinant() < 0.0 {
        -1.0
    } else {
        1.0
    }
}

fn pack_normals(seen: &Visible<'_>, data: &mut SceneData) {
    let linear = linear(seen);
    // Normals go by the cofactor matrix, which exists for singular transforms too; its sign mirrors with them.
    let cofactors = Mat3::from_cols(
        linear.y_axis.cross(linear.z_axis),
        linear.z_axis.cross(linear.x_axis),
        linear.x_axis.cross(linear.y_axis),
    );
    for &n in &seen.mesh.normals {
        let normal = (cofactors * n * side(linear)).normalize_or(n);
        data.push(NormalRecord {
            normal: normal.to_array().into(),
        });
    }
}

fn pack_tangents(seen: &Visible<'_>, data: &mut SceneData) {
    let linear = linear(seen);
    // (0, 0, 0) leaves the frame to the normal.
    let none = vec![Vec4::new(0.0, 0.0, 0.0, 1.0); seen.mesh.positions.len()];
    for &t in seen.mesh.tangents.as_ref().unwrap_or(&none) {
        let tangent = (linear * t.truncate()).normalize_or_zero();
        data.push(TangentRecord {
            tangent: tangent.to_array().into(),
            sign: t.w * side(linear),
        });
    }
}

fn pack_uvs(seen: &Visible<'_>, data: &mut SceneData) {
    let uv = |set: usize, vertex: usize| match &seen.mesh.uvs[set] {
        Some(uvs) => uvs[vertex].to_array(),
        None => [0.0; 2],
    };
    for vertex in 0..seen.mesh.positions.len() {
        let ([u0, v0], [u1, v1]) = (uv(0, vertex), uv(1, vertex));
        data.push(UvRecord { u0, v0, u1, v1 });
    }
}

fn pack_colors(seen: &Visible<'_>, data: &mut SceneData) {
    let white = vec![Vec4::ONE; seen.mesh.positions.len()];
    for color in seen.mesh.colors.as_ref().unwrap_or(&white) {
        data.push(ColorRecord {
            color: color.truncate().to_array().into(),
            alpha: color.w,
        });
    }
}

/// The triangles of a mesh, counter-clockwise seen from the front of the instance.
fn turned(mesh: &MeshDesc, instance: &InstanceDesc) -> impl Iterator<Item = [u32; 3]> {
    let mirrored = Mat3::from(instance.transform.matrix3).determinant() < 0.0;
    let turn = move |&[a, b, c]: &[u32; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
    mesh.triangles.iter().map(turn)
}

fn pack_triangles(object_index: u32, seen: &Visible<'_>, positions: &[Vec3], data: &mut SceneData) {
    let planned = seen.planned;
    let vertex = |corner: u32| match seen.reads {
        Attributes::NONE => 0,
        _ => seen.first_vertex + corner,
    };
    for triangle in turned(seen.mesh, seen.instance) {
        let corners = triangle.map(|corner| positions[corner as usize].to_array());
        let triangle = TriangleRecord {
            params: planned.params,
            object: object_index,
            program: planned.program,
            ..TriangleRecord::new(corners).with_vertices(triangle.map(vertex))
        };
        data.push(triangle);
    }
    let count = data.triangle_count();
    data.single_sided.resize(count, planned.culled);
    data.alpha_tested.resize(count, planned.alpha_tested);
}

/// The box around all that is seen in any of a scene's poses.
pub(super) fn bounds_of_poses(scene: &SceneDesc, materials: &Materials) -> Bounds {
    let mut bounds = Bounds::EMPTY;
    for instance in scene.poses().flat_map(|pose| pose.instances) {
        let mesh = &scene.meshes[instance.mesh];
        if materials.planned[mesh.material].is_some() {
            let positions = mesh.positions.iter();
            positions.for_each(|&p| bounds.add(instance.transform.transform_point3(p)));
        }
    }
    bounds
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
