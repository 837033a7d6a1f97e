//! What rays are traced through, and from where: a mesh, and a view of it.

use std::path::Path;

use anyhow::{Result, ensure};
use glam::{Quat, Vec3};
use residual_bvh::Ray;
use residual_scenegen::desc::{CameraDesc, Projection, SceneDesc};
use residual_scenegen::import::{ImportOptions, import};

use crate::mesh::Mesh;
use crate::reference::Reference;

/// A pinhole camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Where it is.
    pub eye: Vec3,
    /// Looks along -Z, +Y is up.
    pub rotation: Quat,
    /// Vertical field of view in radians.
    pub yfov: f32,
}

/// Something to be measured.
pub struct Scene {
    /// The file's stem.
    pub name: String,
    /// Its triangles.
    pub mesh: Mesh,
    /// How it is seen.
    pub view: View,
    /// Answers for making rays and for checking contenders.
    pub reference: Reference,
    /// What the file says, if there is one.
    pub description: Option<SceneDesc>,
    /// Length of the diagonal of the box around it.
    pub diagonal: f32,
}

impl Scene {
    /// Reads a file. Its first perspective camera is used; without one, a view from its box: from the inside where its
    /// middle sees mostly fronts of triangles, and otherwise from the front.
    pub fn load(path: &Path) -> Result<Scene> {
        let scene = import(path, &ImportOptions::default())?;
        let name = scene.name.clone();
        let mesh = Mesh::of(&scene);
        ensure!(
            !mesh.triangles.is_empty(),
            "{}: nothing to trace",
            path.display()
        );
        let camera = scene.cameras.iter().find_map(perspective);
        Ok(Scene {
            description: Some(scene),
            ..Scene::new(name, mesh, camera)
        })
    }

    /// A mesh with a view, or with one made from its box.
    pub fn new(name: String, mesh: Mesh, view: Option<View>) -> Scene {
        let reference = Reference::new(&mesh);
        let bounds = mesh.bounds();
        let [lo, hi] = [bounds.lo, bounds.hi].map(Vec3::from);
        let view = view.unwrap_or_else(|| {
            let inside = inside(lo, hi);
            if sees_fronts(inside.eye, &mesh, &reference) {
                inside
            } else {
                framing(lo, hi)
            }
        });
        Scene {
            name,
            mesh,
            view,
            reference,
            description: None,
            diagonal: (hi - lo).length(),
        }
    }
}

fn perspective(camera: &CameraDesc) -> Option<View> {
    match camera.projection {
        Projection::Perspective { yfov } => Some(View {
            eye: camera.position,
            rotation: camera.rotation,
            yfov,
        }),
        Projection::Orthographic { .. } => None,
    }
}

/// In the middle, at a third of the height, along the longer horizontal axis.
fn inside(lo: Vec3, hi: Vec3) -> View {
    let size = hi - lo;
    let mut eye = lo + 0.5 * size;
    eye.y = lo.y + size.y / 3.0;
    let dir = if size.x >= size.z {
        Vec3::X
    } else {
        Vec3::NEG_Z
    };
    View {
        eye,
        rotation: Quat::from_rotation_arc(Vec3::NEG_Z, dir),
        yfov: 1.0,
    }
}

/// From the front, a little from above, with everything in view.
fn framing(lo: Vec3, hi: Vec3) -> View {
    let yfov = 0.7f32;
    let dir = Vec3::new(-0.27, -0.32, -0.91).normalize();
    let distance = 0.5 * (hi - lo).length() / (0.5 * yfov).sin();
    let right = dir.cross(Vec3::Y).normalize();
    View {
        eye: 0.5 * (lo + hi) - distance * dir,
        rotation: Quat::from_mat3(&glam::Mat3::from_cols(right, right.cross(dir), -dir)),
        yfov,
    }
}

/// Whether most directions from a point end at the front of a triangle: a room does so, a solid does not.
fn sees_fronts(eye: Vec3, mesh: &Mesh, reference: &Reference) -> bool {
    const COUNT: usize = 256;
    let dir = |i: usize| {
        let y = 1.0 - (2 * i + 1) as f32 / COUNT as f32;
        let (sin, cos) = (2.399_963 * i as f32).sin_cos();
        let radius = (1.0 - y * y).sqrt();
        [radius * cos, y, radius * sin]
    };
    let ray = |i| Ray::unbounded(eye.to_array(), dir(i));
    let rays: Vec<Ray> = (0..COUNT).map(ray).collect();
    let is_front = |(ray, hit): &(&Ray, residual_bvh::Hit)| {
        hit.is_hit() && mesh.normal(hit.prim).dot(ray.dir.into()) < 0.0
    };
    rays.iter()
        .zip(reference.closest(&rays))
        .filter(is_front)
        .count()
        > COUNT / 2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solids_are_seen_from_outside_and_rooms_from_inside() {
        let solid = Mesh::bumpy_sphere(20, 40);
        let mut room = solid.clone();
        for [_, b, c] in &mut room.triangles {
            std::mem::swap(b, c);
        }
        let eye = |mesh| Scene::new(String::new(), mesh, None).view.eye.length();
        let eyes = [eye(solid), eye(room)];
        assert!(eyes.iter().any(|&distance| distance < 1.0));
        assert!(eyes.iter().any(|&distance| distance > 2.0));
    }
}
