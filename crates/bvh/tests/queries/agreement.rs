//! Hierarchies of every width, on every instruction set, under every filter, give the oracle's
//! answer bit for bit (I-04, I-08, I-09, I-14, B-04).

use crate::mesh::{Mesh, grid, jittered_icosphere, soup};
use crate::random::Random;
use crate::runner::{aimed, check, trials};
use residual_bvh::Ray;

/// Rays at edges, at vertices, in random directions, and along axes.
fn mixed_rays(mesh: &Mesh, count: usize, random: &mut Random) -> Vec<Ray> {
    let mut rays = Vec::new();
    for i in 0..count {
        let org = random.in_cube(1.5);
        rays.push(match i % 4 {
            0 => aimed(org, mesh.edge_point(random)),
            1 => aimed(org, mesh.vertex(random)),
            2 => Ray::unbounded(org, random.in_cube(1.0)),
            _ => {
                let mut org = mesh.vertex(random);
                let axis = random.below(3);
                let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
                org[axis] = -3.0 * sign;
                let mut dir = [0.0, -0.0, 0.0];
                dir[axis] = sign;
                Ray::unbounded(org, dir)
            }
        });
    }
    rays
}

#[test]
fn random_soups() {
    for (seed, (count, size)) in [
        (1, 1.0),
        (3, 1.0),
        (17, 0.8),
        (150, 0.3),
        (400, 0.1),
        (300, 1e-3),
    ]
    .into_iter()
    .enumerate()
    {
        let mut random = Random::new(seed as u64);
        let mesh = soup(count, size, &mut random).marked(&mut random);
        let rays = mixed_rays(&mesh, trials(3000), &mut random);
        assert!(
            check(&mesh, &rays) > rays.len() / 5,
            "{count} triangles of size {size}"
        );
    }
}

#[test]
fn closed_meshes() {
    let mut random = Random::new(10);
    let mesh = jittered_icosphere(2, &mut random).marked(&mut random);
    let rays = mixed_rays(&mesh, trials(6000), &mut random);
    assert!(check(&mesh, &rays) > rays.len() / 2);
}

#[test]
fn clipped_intervals() {
    let mut random = Random::new(11);
    let mesh = soup(200, 0.4, &mut random).marked(&mut random);
    let mut rays = mixed_rays(&mesh, trials(4000), &mut random);
    for ray in &mut rays {
        ray.tmin = random.unit() - 0.2;
        ray.tmax = ray.tmin + random.unit();
    }
    assert!(check(&mesh, &rays) > rays.len() / 10);
}

/// The smallest index of those at the same place wins.
#[test]
fn stacks_of_equal_triangles() {
    let mut random = Random::new(12);
    let mut mesh = Mesh::default();
    let single = soup(12, 0.6, &mut random);
    for i in 0..240 {
        mesh.push(single.vertices((i * 7) % 12));
    }
    let mesh = mesh.marked(&mut random);
    let rays = mixed_rays(&mesh, trials(3000), &mut random);
    assert!(check(&mesh, &rays) > rays.len() / 5);
}

#[test]
fn coplanar_grid_seen_edge_on() {
    let mut random = Random::new(13);
    let mesh = grid(12);
    let mut rays = Vec::new();
    for _ in 0..trials(3000) {
        let [x, y, _] = random.in_cube(6.0);
        let org = [x + 6.0, y + 6.0, [0.0, 1e-30, 1e-7, 1e-3][random.below(4)]];
        let mut dir = random.in_cube(1.0);
        dir[2] = [0.0, -0.0, -1e-30, -1e-8, -1e-7, -1e-4][random.below(6)];
        rays.push(Ray::unbounded(org, dir));
    }
    check(&mesh, &rays);
}

/// Where the distance is ill-conditioned it must still not depend on the tree.
#[test]
fn slivers_and_pebbles() {
    let mut random = Random::new(14);
    let mut mesh = Mesh::default();
    for _ in 0..100 {
        let (p, d) = (random.in_cube(1.0), random.in_cube(2.0));
        let width = 10f32.powi(-(random.below(8) as i32));
        let thin = random.in_cube(width);
        mesh.push([
            p,
            [0, 1, 2].map(|axis| p[axis] + d[axis]),
            [0, 1, 2].map(|axis| p[axis] + 0.4 * d[axis] + thin[axis]),
        ]);
    }
    mesh.push([[-1e4, -1.0, -1e4], [1e4, -1.0, -1e4], [0.0, -1.0, 2e4]]);
    for _ in 0..60 {
        let [x, _, z] = random.in_cube(1.0);
        mesh.push([0; 3].map(|_| {
            let [dx, dy, dz] = random.in_cube(0.01);
            [x + dx, -1.0 + dy * 1e-4, z + dz]
        }));
    }
    let mesh = mesh.marked(&mut random);
    let mut rays = mixed_rays(&mesh, trials(4000), &mut random);
    for _ in 0..trials(4000) {
        // Grazing the ground.
        let mut org = random.in_cube(100.0);
        org[1] = -1.0 + random.unit() * 1e-3;
        rays.push(aimed(org, mesh.vertices(101 + random.below(60))[0]));
    }
    assert!(check(&mesh, &rays) > rays.len() / 5);
}

/// Scaling by a power of two scales distances and changes nothing else (I-10).
#[test]
fn scale_invariance() {
    let mut random = Random::new(15);
    let mesh = soup(100, 0.4, &mut random).marked(&mut random);
    let rays = mixed_rays(&mesh, trials(300), &mut random);
    for exponent in [-40, -20, 20, 40] {
        let scale = 2f32.powi(exponent);
        let mut scaled = mesh.clone();
        for position in &mut scaled.positions {
            *position = position.map(|x| x * scale);
        }
        let scaled_rays: Vec<Ray> = rays
            .iter()
            .map(|ray| Ray {
                org: ray.org.map(|x| x * scale),
                ..*ray
            })
            .collect();
        check(&scaled, &scaled_rays);
        for (ray, scaled_ray) in rays.iter().zip(&scaled_rays) {
            let hit = crate::oracle::closest_hit_of_all(&mesh, ray, &residual_bvh::AllHits);
            let other =
                crate::oracle::closest_hit_of_all(&scaled, scaled_ray, &residual_bvh::AllHits);
            assert_eq!(
                (hit.t * scale, hit.u, hit.v, hit.prim),
                (other.t, other.u, other.v, other.prim)
            );
        }
    }
}
