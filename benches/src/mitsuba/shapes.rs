//! Geometry: one mesh for each material, in world space.

use std::collections::BTreeMap;

use residual_render::domain::Buffer;
use residual_render::program::Program;
use residual_render::surface::{NormalRecord, VerticesRecord};
use residual_render::triangle::TriangleRecord;
use residual_scenegen::plan::Plan;

use super::ply::{Corner, PlyMesh};

/// The triangles of a material.
pub(super) struct Shape<'a> {
    /// Index of the material in the description.
    pub(super) material: usize,
    pub(super) program: &'a Program,
    pub(super) mesh: PlyMesh,
}

/// The shapes of a plan, in the order of their materials. One for each object would be slower to trace.
pub(super) fn shapes(plan: &Plan) -> Vec<Shape<'_>> {
    let mut shapes = BTreeMap::new();
    for object in &plan.objects {
        for triangle in object.triangles.clone().map(|index| index as usize) {
            let shape = shapes
                .entry(object.material)
                .or_insert_with(|| empty(plan, object.material, triangle));
            shape.mesh.push(corners(plan, shape.program, triangle));
        }
    }
    shapes.into_values().collect()
}

/// The shape that will have this triangle.
fn empty(plan: &Plan, material: usize, triangle: usize) -> Shape<'_> {
    let program = plan.data.buffer(Buffer::TrianglePrograms)[triangle];
    let program = &plan.structure.programs[program as usize];
    Shape {
        material,
        program,
        mesh: PlyMesh::new(program.attributes.normals),
    }
}

fn corners(plan: &Plan, program: &Program, triangle: usize) -> [Corner; 3] {
    let positions = plan.data.record::<TriangleRecord>(triangle).corners();
    let flat = positions.map(|position| Corner {
        position,
        normal: None,
    });
    if !program.attributes.normals {
        return flat;
    }
    let VerticesRecord { a, b, c } = plan.data.record(triangle);
    let normals = [a, b, c].map(|vertex| {
        let NormalRecord { normal } = plan.data.record(vertex as usize);
        normal.to_array()
    });
    [0, 1, 2].map(|k| Corner {
        normal: Some(normals[k]),
        ..flat[k]
    })
}
