//! Closed meshes and planes have no holes (I-01, I-02, B-03). Rays are aimed at edges and vertices:
//! random directions have no power.

use crate::mesh::{Mesh, fan, grid, jittered_icosphere};
use crate::random::Random;
use crate::runner::{Widths, aimed, trials};
use residual_bvh::{AllHits, BuildQuality, Exact, Fast, Precision, Ray, Watertight, closest_hit};

/// Aims from points inside the mesh around `center` at edges and vertices.
fn count_leaks(mesh: &Mesh, center: f32, quality: BuildQuality, count: usize, seed: u64) -> usize {
    let mut random = Random::new(seed);
    let widths = Widths::new(mesh, quality);
    let leak = |_: &usize| {
        let org = random.in_cube(0.3).map(|x| x + center);
        let target = if random.below(2) == 0 {
            mesh.edge_point(&mut random)
        } else {
            mesh.vertex(&mut random)
        };
        let mut ray = aimed(org, target);
        if random.below(2) == 0 {
            let length = ray.dir.iter().map(|x| x * x).sum::<f32>().sqrt();
            ray.dir = ray.dir.map(|x| x / length);
        }
        !widths.closest(&ray, &AllHits).is_hit()
    };
    (0..count).filter(leak).count()
}

#[test]
fn closed_meshes_do_not_leak() {
    for (seed, offset) in [0.0, 3.7, 37.0, 1e3, 1e4, 1e6].into_iter().enumerate() {
        let mut random = Random::new(seed as u64);
        let mesh = jittered_icosphere(2, &mut random).translated(offset);
        for quality in [BuildQuality::Fast, BuildQuality::Best] {
            let leaks = count_leaks(&mesh, offset, quality, trials(100_000), seed as u64);
            assert_eq!(leaks, 0, "offset {offset}, {quality:?}");
        }
    }
}

#[test]
fn fine_meshes_do_not_leak() {
    let mut random = Random::new(20);
    let mesh = jittered_icosphere(5, &mut random).translated(3.7);
    assert_eq!(
        count_leaks(&mesh, 3.7, BuildQuality::Best, trials(200_000), 20),
        0
    );
}

#[test]
fn fans_of_a_thousand_do_not_leak() {
    let mut random = Random::new(21);
    let mesh = fan(1000);
    let widths = Widths::new(&mesh, BuildQuality::Best);
    for _ in 0..trials(20_000) {
        let [x, y, z] = random.in_cube(1.0);
        let ray = aimed([x, y, z + 2.0], mesh.positions[0]);
        assert!(widths.closest(&ray, &AllHits).is_hit(), "{ray:?}");
    }
}

/// Rays along an axis through the vertices and along the edges of a grid, from both sides, and the
/// same with the axes exchanged.
#[test]
fn axis_parallel_rays_hit_grid_vertices() {
    const CELLS: usize = 64;
    for turn in 0..3 {
        let rotate = |p: [f32; 3]| {
            let mut p = p;
            p.rotate_right(turn);
            p
        };
        let mut mesh = grid(CELLS);
        for position in &mut mesh.positions {
            *position = rotate(*position);
        }
        let widths = Widths::new(&mesh, BuildQuality::Best);
        for y in 0..=2 * CELLS {
            for x in 0..=2 * CELLS {
                for (side, zero) in [(1.0, 0.0), (-1.0, 0.0), (1.0, -0.0), (-1.0, -0.0)] {
                    let ray = Ray::unbounded(
                        rotate([x as f32 / 2.0, y as f32 / 2.0, 3.0 * side]),
                        rotate([zero, zero, -side]),
                    );
                    assert_eq!(widths.closest(&ray, &AllHits).t, 3.0, "{ray:?}");
                }
            }
        }
    }
}

/// What each precision costs in leaks: misses of rays from inside a closed mesh, by offset.
/// `cargo test --release -p residual-bvh -- --ignored --nocapture misses_per_million`.
#[test]
#[ignore = "prints a table"]
fn misses_per_million() {
    const RAYS: usize = 1_000_000;
    println!("aimed at   offset        Fast  Watertight       Exact");
    for target in ["edges", "vertices"] {
        for (seed, offset) in [0.0, 3.7, 37.0, 1e3, 1e4].into_iter().enumerate() {
            let mut random = Random::new(seed as u64);
            let mesh = jittered_icosphere(2, &mut random).translated(offset);
            let widths = Widths::new(&mesh, BuildQuality::Best);
            let rays: Vec<Ray> = (0..RAYS)
                .map(|_| {
                    let org = random.in_cube(0.3).map(|x| x + offset);
                    let target = match target {
                        "edges" => mesh.edge_point(&mut random),
                        _ => mesh.vertex(&mut random),
                    };
                    aimed(org, target)
                })
                .collect();
            fn misses(widths: &Widths, precision: impl Precision, rays: &[Ray]) -> usize {
                let bvh = widths.w8.view();
                fearless_simd::dispatch!(fearless_simd::Level::new(), simd => rays
                    .iter()
                    .filter(|ray| !closest_hit(simd, precision, bvh, ray, &AllHits).is_hit())
                    .count())
            }
            let [fast, watertight, exact] = [
                misses(&widths, Fast, &rays),
                misses(&widths, Watertight, &rays),
                misses(&widths, Exact, &rays),
            ];
            println!("{target:8} {offset:8} {fast:11} {watertight:11} {exact:11}");
            assert_eq!((watertight, exact), (0, 0));
        }
    }
}
