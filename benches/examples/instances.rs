//! What instances save, and what they cost: `cargo run --release -p residual-benches --example instances -- SCENE`.
//!
//! Builds the scene's meshes once each and places them, builds the same triangles baked into world space, and traces
//! the same rays through both.

use std::path::Path;

use anyhow::{Context, Result};
use residual_benches::measure::thread_time;
use residual_benches::mesh::Mesh;
use residual_benches::rays::ray_sets;
use residual_benches::scene::Scene;
use residual_bvh::{BuildQuality, Bvh, Hit, Instance, InstanceHit, InstancedBvh, Ray, build};
use residual_scenegen::import::{ImportOptions, import};

type Tree = Bvh<8>;

fn main() -> Result<()> {
    let path = std::env::args().nth(1).context("usage: instances SCENE")?;
    let path = Path::new(&path);
    let description = import(path, &ImportOptions::default())?;
    let objects: Vec<Tree> = description
        .meshes
        .iter()
        .map(|mesh| {
            let positions: Vec<[f32; 3]> = mesh.positions.iter().map(|p| p.to_array()).collect();
            build(&positions, &mesh.triangles, None, BuildQuality::High)
        })
        .collect();
    let instances: Vec<Instance> = description
        .instances
        .iter()
        .map(|instance| Instance {
            bvh: instance.mesh,
            object_to_world: instance.transform,
        })
        .collect();
    let one: usize = objects.iter().map(Tree::memory_bytes).sum();
    let instanced = InstancedBvh::new(objects, &instances)?;

    let mesh = Mesh::of(&description);
    let baked: Tree = build(&mesh.positions, &mesh.triangles, None, BuildQuality::High);
    let mib = |bytes: usize| bytes as f64 / (1 << 20) as f64;
    println!(
        "{} instances of {} meshes: {:.2} MiB, of which the meshes {:.2} MiB; baked, {} triangles: {:.1} MiB",
        instances.len(),
        description.meshes.len(),
        mib(instanced.memory_bytes()),
        mib(one),
        mesh.triangles.len(),
        mib(baked.memory_bytes())
    );

    let scene = Scene::load(path)?;
    for set in ray_sets(&scene, [512; 2]) {
        let [flat, two_level] = speeds(&set.rays, &baked, &instanced);
        println!(
            "{}: baked {flat:.2}, instanced {two_level:.2} Mrays/s (nearest hit, one ray at a time)",
            set.kind
        );
    }
    Ok(())
}

/// Medians of interleaved rounds, in millions of rays a second of the thread's time.
fn speeds(rays: &[Ray], baked: &Tree, instanced: &InstancedBvh<8, 8>) -> [f64; 2] {
    let mut hits = vec![Hit::miss(0.0); rays.len()];
    let mut instance_hits = vec![InstanceHit::miss(0.0); rays.len()];
    let mut seconds = [Vec::new(), Vec::new()];
    for _ in 0..7 {
        let start = thread_time();
        for (ray, hit) in rays.iter().zip(&mut hits) {
            *hit = baked.closest_hit(ray);
        }
        let middle = thread_time();
        instanced.closest_hits(rays, &mut instance_hits);
        let end = thread_time();
        seconds[0].push((middle - start).as_secs_f64());
        seconds[1].push((end - middle).as_secs_f64());
    }
    let differ = hits
        .iter()
        .zip(&instance_hits)
        .filter(|(a, b)| a.is_hit() != b.is_hit())
        .count();
    if differ > 0 {
        println!(
            "{differ} of {} rays hit in one and not in the other",
            rays.len()
        );
    }
    seconds.map(|mut seconds| {
        seconds.sort_by(f64::total_cmp);
        rays.len() as f64 / seconds[seconds.len() / 2] / 1e6
    })
}
