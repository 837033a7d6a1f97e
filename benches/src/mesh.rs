//! A triangle soup in world space.

use glam::Vec3;
use residual_bvh::Bounds;
use residual_scenegen::desc::SceneDesc;

/// Triangles in world space.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Vertices.
    pub positions: Vec<[f32; 3]>,
    /// Corners, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// All instances of a scene, baked.
    pub fn of(scene: &SceneDesc) -> Mesh {
        let mut baked = Mesh::default();
        for instance in &scene.instances {
            let mesh = &scene.meshes[instance.mesh];
            let first = baked.positions.len() as u32;
            let place = |&p: &Vec3| instance.transform.transform_point3(p).to_array();
            baked.positions.extend(mesh.positions.iter().map(place));
            let mirrored = instance.transform.matrix3.determinant() < 0.0;
            baked
                .triangles
                .extend(mesh.triangles.iter().map(|&[a, b, c]| {
                    let [b, c] = if mirrored { [c, b] } else { [b, c] };
                    [first + a, first + b, first + c]
                }));
        }
        baked
    }

    /// A sphere with bumps: `2 · rings · segments` triangles, those at the poles without area.
    pub fn bumpy_sphere(rings: usize, segments: usize) -> Mesh {
        use std::f32::consts::{PI, TAU};
        let point = |ring: usize, segment: usize| {
            let theta = PI * ring as f32 / rings as f32;
            let phi = TAU * segment as f32 / segments as f32;
            let radius = 1.0 + 0.1 * (9.0 * theta).sin() * (11.0 * phi).sin();
            let (s, c) = theta.sin_cos();
            [radius * s * phi.cos(), radius * c, radius * s * phi.sin()]
        };
        let positions = (0..=rings)
            .flat_map(|ring| (0..segments).map(move |segment| point(ring, segment)))
            .collect();
        let index = |ring: usize, segment: usize| (ring * segments + segment % segments) as u32;
        let quad = |(ring, segment): (usize, usize)| {
            let (a, b) = (index(ring, segment), index(ring, segment + 1));
            let (c, d) = (index(ring + 1, segment), index(ring + 1, segment + 1));
            [[a, b, c], [b, d, c]]
        };
        let triangles = (0..rings)
            .flat_map(|ring| (0..segments).map(move |segment| (ring, segment)))
            .flat_map(quad)
            .collect();
        Mesh {
            positions,
            triangles,
        }
    }

    /// The box around all triangles.
    pub fn bounds(&self) -> Bounds {
        let vertices = self.triangles.iter().flatten();
        vertices.fold(Bounds::EMPTY, |bounds, &vertex| {
            let point = self.positions[vertex as usize];
            let point = Bounds {
                lo: point,
                hi: point,
            };
            bounds.union(&point)
        })
    }

    /// A triangle's normal, not normalised.
    pub fn normal(&self, prim: u32) -> Vec3 {
        let [a, b, c] =
            self.triangles[prim as usize].map(|vertex| Vec3::from(self.positions[vertex as usize]));
        (b - a).cross(c - a)
    }
}
