//! The rays: the same for all contenders, and the same in every run.

use std::fmt;

use clap::ValueEnum;
use glam::Vec3;
use residual_bvh::{Hit, Ray};

use crate::contender::Query;
use crate::mesh::Mesh;
use crate::scene::{Scene, View};

/// Where rays come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum RayKind {
    /// Through pixel centres; tiles of 8×8, in them blocks of 4×4, so that sixteen neighbours make a packet.
    Primary,
    /// One for each primary hit, cosine-distributed about the normal, up to a fifth of the box's diagonal; any hit.
    Ao,
    /// One for each primary hit, cosine-distributed about the normal, without a limit; nearest hit.
    Diffuse,
    /// Rays that miss the box around everything: what a call costs.
    Miss,
    /// Of a render: those that paths are followed by, after the camera's.
    Bounce,
    /// Of a render: those towards lights; any hit.
    Shadow,
}

impl RayKind {
    /// All, in the order of the tables.
    pub const ALL: [RayKind; 6] = [
        RayKind::Primary,
        RayKind::Ao,
        RayKind::Diffuse,
        RayKind::Miss,
        RayKind::Bounce,
        RayKind::Shadow,
    ];

    /// What is asked about these rays.
    pub fn query(self) -> Query {
        match self {
            RayKind::Ao | RayKind::Shadow => Query::Any,
            RayKind::Primary | RayKind::Diffuse | RayKind::Miss | RayKind::Bounce => Query::Closest,
        }
    }
}

impl fmt::Display for RayKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            RayKind::Primary => "primary",
            RayKind::Ao => "ao",
            RayKind::Diffuse => "diffuse",
            RayKind::Miss => "miss",
            RayKind::Bounce => "bounce",
            RayKind::Shadow => "shadow",
        })
    }
}

/// Rays of one kind.
pub struct RaySet {
    /// Their kind.
    pub kind: RayKind,
    /// The rays.
    pub rays: Vec<Ray>,
    /// How many of them hit something.
    pub hits: usize,
}

/// Length of ambient-occlusion rays, as a part of the box's diagonal.
const AO_REACH: f32 = 0.2;
/// Where spawned rays begin, as a part of the box's diagonal.
const EPSILON: f32 = 1e-4;

/// The rays of all kinds that a mesh and a view are enough for. There are as many spawned rays as primary ones that hit.
pub fn ray_sets(scene: &Scene, size: [u32; 2]) -> Vec<RaySet> {
    let primary = primary(&scene.view, size);
    let hits = scene.reference.closest(&primary);
    let ao = spawned(&primary, &hits, scene, AO_REACH * scene.diagonal);
    let diffuse = spawned(&primary, &hits, scene, f32::INFINITY);
    let miss = missing(primary.len(), scene);
    let made = [
        (RayKind::Primary, primary),
        (RayKind::Ao, ao),
        (RayKind::Diffuse, diffuse),
        (RayKind::Miss, miss),
    ];
    made.into_iter()
        .map(|(kind, rays)| {
            let hits = scene.reference.closest(&rays);
            RaySet {
                kind,
                hits: hits.iter().filter(|hit| hit.is_hit()).count(),
                rays,
            }
        })
        .collect()
}

fn primary(view: &View, [width, height]: [u32; 2]) -> Vec<Ray> {
    let tan = (0.5 * view.yfov).tan();
    let aspect = width as f32 / height as f32;
    let ray = |(x, y): (u32, u32)| {
        let right = (2.0 * (x as f32 + 0.5) / width as f32 - 1.0) * tan * aspect;
        let up = (1.0 - 2.0 * (y as f32 + 0.5) / height as f32) * tan;
        Ray::unbounded(
            view.eye.to_array(),
            (view.rotation * Vec3::new(right, up, -1.0))
                .normalize()
                .to_array(),
        )
    };
    pixels(width, height).map(ray).collect()
}

/// The pixels of an image, tile by tile of 8×8, block by block of 4×4.
fn pixels(width: u32, height: u32) -> impl Iterator<Item = (u32, u32)> {
    let corners = |width: u32, height: u32, step: usize| {
        (0..height)
            .step_by(step)
            .flat_map(move |y| (0..width).step_by(step).map(move |x| (x, y)))
    };
    corners(width, height, 8)
        .flat_map(move |(x, y)| corners(8, 8, 4).map(move |(i, j)| (x + i, y + j)))
        .flat_map(move |(x, y)| corners(4, 4, 1).map(move |(i, j)| (x + i, y + j)))
        .filter(move |&(x, y)| x < width && y < height)
}

/// One ray from every hit into the side of the surface that was seen.
fn spawned(rays: &[Ray], hits: &[Hit], scene: &Scene, tmax: f32) -> Vec<Ray> {
    let spawn = |(index, (ray, hit)): (usize, (&Ray, &Hit))| {
        let dir = Vec3::from(ray.dir);
        let normal = facing(&scene.mesh, hit.prim, dir);
        Ray {
            org: (Vec3::from(ray.org) + hit.t * dir).to_array(),
            tmin: EPSILON * scene.diagonal,
            dir: cosine_distributed(normal, random(2 * index), random(2 * index + 1)).to_array(),
            tmax,
        }
    };
    let pairs = rays.iter().zip(hits).enumerate();
    pairs
        .filter(|(_, (_, hit))| hit.is_hit())
        .map(spawn)
        .collect()
}

fn facing(mesh: &Mesh, prim: u32, dir: Vec3) -> Vec3 {
    let normal = mesh.normal(prim).normalize_or(-dir);
    if normal.dot(dir) > 0.0 {
        -normal
    } else {
        normal
    }
}

fn cosine_distributed(normal: Vec3, u: f32, v: f32) -> Vec3 {
    let (tangent, bitangent) = normal.any_orthonormal_pair();
    let (sin, cos) = (std::f32::consts::TAU * u).sin_cos();
    let radius = v.sqrt();
    (radius * (cos * tangent + sin * bitangent) + (1.0 - v).sqrt() * normal).normalize()
}

/// A number in [0, 1) that is a function of the index alone (PCG's output function on a hashed state).
pub(crate) fn random(index: usize) -> f32 {
    let state = (index as u32)
        .wrapping_mul(747_796_405)
        .wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (((word >> 22) ^ word) >> 8) as f32 / (1 << 24) as f32
}

/// From beyond a corner of the box, away from it.
fn missing(count: usize, scene: &Scene) -> Vec<Ray> {
    let org = Vec3::from(scene.mesh.bounds().hi) + scene.diagonal;
    let ray = |index: usize| {
        let dir = Vec3::new(
            random(3 * index),
            random(3 * index + 1),
            random(3 * index + 2),
        );
        Ray::unbounded(org.to_array(), (dir + 0.1).normalize().to_array())
    };
    (0..count).map(ray).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sets() -> Vec<RaySet> {
        let scene = Scene::new("sphere".to_owned(), Mesh::bumpy_sphere(20, 40), None);
        ray_sets(&scene, [33, 30])
    }

    #[test]
    fn rays_are_the_same_in_every_run() {
        for (a, b) in sets().iter().zip(&sets()) {
            assert_eq!(a.rays, b.rays);
            assert_eq!(a.hits, b.hits);
        }
    }

    #[test]
    fn every_kind_is_what_it_says() {
        let sets = sets();
        let [primary, ao, diffuse, miss] = &sets[..] else {
            panic!("four kinds")
        };
        assert_eq!(primary.rays.len(), 33 * 30);
        assert!(primary.hits > 100 && primary.hits < primary.rays.len());
        assert_eq!(ao.rays.len(), primary.hits);
        assert_eq!(diffuse.rays.len(), primary.hits);
        assert!(sets.iter().all(|set| set.rays.iter().all(Ray::is_valid)));
        assert_eq!(miss.hits, 0);
    }

    #[test]
    fn sixteen_rays_are_a_block_of_pixels() {
        let order: Vec<_> = pixels(13, 9).collect();
        assert_eq!(order.len(), 13 * 9);
        let block = &order[16..32];
        assert!(block.iter().all(|&(x, y)| (4..8).contains(&x) && y < 4));
        let mut all = order.clone();
        all.sort();
        all.dedup();
        assert_eq!(all.len(), order.len());
    }
}
