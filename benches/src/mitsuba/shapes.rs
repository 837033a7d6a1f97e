//! Geometry: one mesh for each material, in world space.

use std::collections::BTreeMap;

use glam::Vec3;
use residual_render::program::{AlphaTestNode, Program};
use residual_render::surface::{Attributes, NormalRecord, UvRecord};
use residual_render::triangle::TriangleRecord;
use residual_scenegen::plan::Plan;

use super::ply::{Corner, Has, PlyMesh};

/// The triangles of a material.
pub(super) struct Shape<'a> {
    /// Index of the material in the description.
    pub(super) material: usize,
    pub(super) program: &'a Program,
    /// The first of its triangles in the plan.
    pub(super) triangle: usize,
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
            let corners = corners(plan, shape.program, triangle);
            let emission = shape.program.emission;
            if emission.is_some_and(|emission| emission.double_sided) {
                shape.mesh.push(turned_over(corners));
            }
            shape.mesh.push(corners);
        }
    }
    shapes.into_values().collect()
}

/// The shape that will have this triangle.
fn empty(plan: &Plan, material: usize, triangle: usize) -> Shape<'_> {
    let program = plan.data.record::<TriangleRecord>(triangle).program;
    let program = &plan.structure.programs[program as usize];
    Shape {
        material,
        program,
        triangle,
        mesh: PlyMesh::new(Has {
            normals: program.attributes.normals,
            uvs: uv_set(program).is_some(),
        }),
    }
}

/// What the inputs and the test of alpha read of vertices.
fn attributes(program: &Program) -> Attributes {
    match program.alpha_test {
        Some(
            AlphaTestNode::AlphaMask { attributes, .. }
            | AlphaTestNode::AlphaBlend { attributes, .. },
        ) => program.attributes.union(attributes),
        None => program.attributes,
    }
}

/// The set of texture coordinates that a program reads, if it reads one.
fn uv_set(program: &Program) -> Option<usize> {
    let attributes = attributes(program);
    match [attributes.uv0, attributes.uv1] {
        [true, _] => Some(0),
        [false, true] => Some(1),
        [false, false] => None,
    }
}

/// Whether a program reads two sets of texture coordinates, of which Mitsuba has one.
pub(super) fn has_two_uv_sets(program: &Program) -> bool {
    let attributes = attributes(program);
    attributes.uv0 && attributes.uv1
}

fn corners(plan: &Plan, program: &Program, triangle: usize) -> [Corner; 3] {
    let positions = plan.data.record::<TriangleRecord>(triangle).corners();
    let uv_set = uv_set(program);
    if !program.attributes.normals && uv_set.is_none() {
        return positions.map(|position| Corner {
            position,
            normal: None,
            uv: None,
        });
    }
    let front = front(positions.map(Vec3::from));
    let [a, b, c] = plan.data.record::<TriangleRecord>(triangle).vertices();
    let vertices = [a, b, c].map(|vertex| vertex as usize);
    [0, 1, 2].map(|k| Corner {
        position: positions[k],
        normal: program.attributes.normals.then(|| {
            let NormalRecord { normal } = plan.data.record(vertices[k]);
            on_the_side_of(front, normal.to_array())
        }),
        uv: uv_set.map(|set| {
            let UvRecord { u0, v0, u1, v1 } = plan.data.record(vertices[k]);
            [[u0, v0], [u1, v1]][set]
        }),
    })
}

/// Where the front of a triangle looks.
fn front([a, b, c]: [Vec3; 3]) -> Vec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

/// A normal or its opposite. Normals that are stored say which side of a surface is its front there, which here only winding does.
fn on_the_side_of(front: Vec3, normal: [f32; 3]) -> [f32; 3] {
    match front.dot(Vec3::from(normal)) < 0.0 {
        true => normal.map(|x| -x),
        false => normal,
    }
}

/// The triangle that looks back from right behind: where both sides emit here, each is a surface there. It is as far behind as
/// makes hits of both certain to be told apart, which is less than Mitsuba sets off rays from surfaces.
fn turned_over(corners: [Corner; 3]) -> [Corner; 3] {
    /// In units of the largest coordinate, or of 1.
    const DISTANCE: f32 = 2e-5;
    let back = front(corners.map(|corner| Vec3::from(corner.position))) * -DISTANCE;
    let [a, b, c] = corners.map(|corner| {
        let position = Vec3::from(corner.position);
        let scale = 1.0 + position.abs().max_element();
        Corner {
            position: (position + scale * back).to_array(),
            normal: corner.normal.map(|normal| normal.map(|x| -x)),
            uv: corner.uv,
        }
    });
    [c, b, a]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_are_turned_to_the_front() {
        let [x, y] = [Vec3::X, Vec3::Y];
        let up = [0.1, 0.0, 0.9];
        assert_eq!(on_the_side_of(front([Vec3::ZERO, x, y]), up), up);
        assert_eq!(
            on_the_side_of(front([Vec3::ZERO, y, x]), up),
            [-0.1, 0.0, -0.9]
        );
    }

    #[test]
    fn a_triangle_turned_over_looks_back_from_behind() {
        let corner = |x: f32, y: f32| Corner {
            position: [x, y, 9.0],
            normal: Some([0.0, 0.0, 1.0]),
            uv: Some([x, y]),
        };
        let [c, b, a] = turned_over([corner(1.0, 0.0), corner(2.0, 0.0), corner(1.0, 1.0)]);
        assert_eq!(
            [a.uv, b.uv, c.uv],
            [[1.0, 0.0], [2.0, 0.0], [1.0, 1.0]].map(Some)
        );
        assert_eq!(a.normal, Some([0.0, 0.0, -1.0]));
        for corner in [a, b, c] {
            let behind = 9.0 - corner.position[2];
            assert!(behind > 1e-4 && behind < 3e-4, "{behind}");
        }
    }
}
