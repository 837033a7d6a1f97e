//! A ground for models that come without one.

use glam::{Affine3A, Vec2, Vec3};

use crate::desc::{ColorInput, InstanceDesc, MaterialDesc, MeshDesc, SceneDesc, SurfaceDesc};

/// Half the ground's side, in terms of half the scene's larger extent along x and z.
const REACH: f32 = 1.5;
/// Squares along a side of the ground.
const SQUARES: f32 = 12.0;
/// How far the ground lies below the scene, in terms of its side: far enough that no surface of the scene lies in it.
const GAP: f32 = 1e-4;

impl SceneDesc {
    /// Adds a level, checkered square below the scene, somewhat larger than it. A scene without vertices gets none.
    pub fn add_ground(&mut self) {
        let Some([low, high]) = self.bounds() else {
            return;
        };
        let centre = (low + high) * 0.5;
        let extent = (high - low) * 0.5;
        let reach = REACH * extent.x.max(extent.z).max(extent.y).max(1e-3);
        let corner = |x: f32, z: f32| {
            let y = low.y - GAP * reach;
            Vec3::new(centre.x + x * reach, y, centre.z + z * reach)
        };
        let plain = |value: f32| ColorInput::constant([value; 3]);
        let squares = SurfaceDesc::Checkerboard {
            even: plain(0.5),
            odd: plain(0.25),
            squares: [SQUARES; 2],
        };
        self.materials.push(MaterialDesc::new("ground", squares));
        self.meshes.push(MeshDesc {
            name: "ground".to_owned(),
            material: self.materials.len() - 1,
            positions: vec![
                corner(-1.0, 1.0),
                corner(1.0, 1.0),
                corner(1.0, -1.0),
                corner(-1.0, -1.0),
            ],
            normals: vec![Vec3::Y; 4],
            uvs: [Some(vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y]), None],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..MeshDesc::default()
        });
        let ground = InstanceDesc {
            name: "ground".to_owned(),
            mesh: self.meshes.len() - 1,
            transform: Affine3A::IDENTITY,
        };
        for pose in &mut self.later {
            pose.instances.push(ground.clone());
        }
        self.instances.push(ground);
    }

    /// Least and greatest coordinates of what is placed in the world, at any moment.
    fn bounds(&self) -> Option<[Vec3; 2]> {
        let instances = self.poses().flat_map(|pose| pose.instances);
        let points = instances.flat_map(|instance| {
            let positions = self.meshes[instance.mesh].positions.iter();
            positions.map(|&position| instance.transform.transform_point3(position))
        });
        points
            .map(|point| [point, point])
            .reduce(|[low, high], [a, b]| [low.min(a), high.max(b)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ground_lies_level_below_the_scene() {
        let mut scene = SceneDesc::default();
        scene.add_ground();
        assert!(scene.meshes.is_empty());
        let mesh = MeshDesc {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            normals: vec![Vec3::Z; 3],
            triangles: vec![[0, 1, 2]],
            ..MeshDesc::default()
        };
        scene.meshes.push(mesh);
        let glass = SurfaceDesc::Dielectric {
            ior: 1.5,
            transmittance: [1.0; 3],
        };
        scene.materials.push(MaterialDesc {
            double_sided: false,
            ..MaterialDesc::new("", glass)
        });
        scene.instances.push(InstanceDesc {
            name: String::new(),
            mesh: 0,
            transform: Affine3A::from_translation(Vec3::new(5.0, -2.0, 1.0)),
        });
        scene.add_ground();
        scene.validate().unwrap();
        let ground = &scene.meshes[1];
        assert_eq!(ground.material, 1);
        let [a, b, c] = ground.triangles[0].map(|k| ground.positions[k as usize]);
        assert!(
            (b - a).cross(c - a).normalize().abs_diff_eq(Vec3::Y, 1e-6),
            "it faces up"
        );
        for position in &ground.positions {
            assert!(position.y < -2.0 && position.y > -2.01, "{position}");
            assert!((position.x - 5.5).abs() > 0.5, "{position}");
        }
    }
}
