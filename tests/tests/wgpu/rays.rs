//! Ray queries of the GPU: hits have the bits of the processor's, and closed meshes do not leak.

use residual_bvh::{BuildQuality, Bvh, Hit, MarkedHits, Ray, build};
use residual_device_wgpu::{Dialect, Mode, RayQueries};
use residual_tests::{read_scene, scenes};
use residual_wgsl::Arithmetic;

use crate::meshes::{Mesh, Random, aimed, grid, jittered_sphere};
use crate::{Machine, exact_machine, machine};

/// Rays for each mesh: a few for each of its edges where a software driver traces them.
fn ray_count(machine: &Machine) -> usize {
    match machine.gpu.adapter.is_software() {
        true => 20_000,
        false => 100_000,
    }
}

fn hierarchy(mesh: &Mesh, quality: BuildQuality) -> Bvh<4> {
    let Mesh {
        positions,
        triangles,
        single_sided,
    } = mesh;
    let sides = (!single_sided.is_empty()).then_some(&single_sided[..]);
    build(positions, triangles, sides, quality)
}

/// A file's triangles, every other one seen from its front only.
fn mesh_of_file(file: &str) -> Option<Mesh> {
    let scene = read_scene(&scenes()?.join(file), None).unwrap();
    let mut mesh = Mesh {
        positions: Vec::new(),
        triangles: Vec::new(),
        single_sided: Vec::new(),
    };
    for part in &scene.meshes {
        let first = mesh.positions.len() as u32;
        mesh.positions
            .extend(part.positions.iter().map(|p| p.to_array()));
        let triangles = part.triangles.iter();
        mesh.triangles
            .extend(triangles.map(|t| t.map(|vertex| first + vertex)));
    }
    mesh.single_sided = (0..mesh.triangles.len()).map(|k| k % 2 == 0).collect();
    Some(mesh)
}

/// Rays from anywhere to anywhere; as from a camera; along edges, which are seen edge-on; along axes; of all lengths; and some
/// that are none.
fn rays(mesh: &Mesh, count: usize, random: &mut Random) -> Vec<Ray> {
    let (center, half) = mesh.center_and_half();
    let eye = [center[0], center[1] + half, center[2] + 4.0 * half];
    let unbounded = (0..count).map(|k| match k % 5 {
        0 | 1 => aimed(random.near(center, 2.0 * half), random.near(center, half)),
        2 => aimed(eye, random.near(center, half)),
        3 => {
            let [a, b, _] = mesh.edge(random);
            let back = [0, 1, 2].map(|k| 2.0 * a[k] - b[k]);
            aimed(back, b)
        }
        _ => {
            let mut dir = [0.0; 3];
            dir[random.below(3)] = if random.below(2) == 0 { 1.0 } else { -1.0 };
            let through = match random.below(2) {
                0 => mesh.vertex(random),
                _ => mesh.edge(random)[2],
            };
            Ray::unbounded([0, 1, 2].map(|k| through[k] - 3.0 * half * dir[k]), dir)
        }
    });
    let mut rays: Vec<Ray> = unbounded.collect();
    for ray in rays.iter_mut().step_by(7) {
        // Targets are at distance 1: these end before, at or behind them.
        ray.tmax = [0.5, 1.0, 1.5, 0.0][random.below(4)];
    }
    for (ray, [x, tmax]) in rays.iter_mut().step_by(1001).zip([
        [f32::NAN, f32::MAX],
        [f32::INFINITY, f32::MAX],
        [0.0, -1.0],
        [0.0, f32::NAN],
    ]) {
        ray.org[0] += x;
        ray.tmax = tmax;
    }
    for (ray, length) in rays
        .iter_mut()
        .skip(1)
        .step_by(1001)
        .zip([0.0, 1e-40, 1e-30, 1e30])
    {
        ray.dir = [0.0, length, 0.0];
    }
    rays
}

/// Where hits differ: a miss is as good as any other, everything else is compared in bits.
fn mismatches(rays: &[Ray], expected: &[Hit], found: &[Hit]) -> Vec<String> {
    assert_eq!(expected.len(), found.len());
    let bits = |hit: &Hit| match hit.is_hit() {
        true => [hit.t.to_bits(), hit.u.to_bits(), hit.v.to_bits(), hit.prim],
        false => [0, 0, 0, Hit::NONE],
    };
    let all = rays.iter().zip(expected).zip(found);
    let differing = all.filter(|((_, a), b)| bits(a) != bits(b));
    differing
        .map(|((ray, a), b)| format!("{ray:?}: {a:?} and {b:?}"))
        .collect()
}

/// G-01: every hit is the processor's, also where `f32` cannot say where it is.
fn check_hits(machine: &Machine, name: &str, mesh: &Mesh) {
    let mut random = Random::new(1);
    let rays = rays(mesh, ray_count(machine), &mut random);
    for quality in [BuildQuality::Fast, BuildQuality::Best] {
        let bvh = hierarchy(mesh, quality);
        let mut expected = vec![Hit::miss(0.0); rays.len()];
        bvh.closest_hits_filtered(&rays, &mut expected, &MarkedHits);
        let hits = expected.iter().filter(|hit| hit.is_hit()).count();
        assert!(hits > rays.len() / 8, "{name}: {hits} hits");
        let queries = RayQueries::new(&machine.gpu, machine.probe.dialect, &bvh)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        let trace = |any| {
            let traced = queries.trace(&rays, any);
            traced.unwrap_or_else(|error| panic!("{name}: {error}")).0
        };
        let mismatches = mismatches(&rays, &expected, &trace(false));
        let count = mismatches.len();
        assert_eq!(
            count,
            0,
            "{name}, {quality:?}: {}",
            mismatches[..count.min(5)].join("\n")
        );
        let differs = trace(true);
        let differs = differs
            .iter()
            .zip(&expected)
            .filter(|(any, hit)| any.is_hit() != hit.is_hit());
        assert_eq!(differs.count(), 0, "{name}, {quality:?}: any hits");
    }
}

#[test]
fn hits_have_the_processors_bits() {
    let Some(machine) = exact_machine() else {
        return;
    };
    let mut random = Random::new(2);
    for offset in [0.0, 3.7, 1e3] {
        let mut mesh = jittered_sphere([offset; 3], 4, &mut random);
        check_hits(machine, &format!("sphere at {offset}"), &mesh);
        mesh.single_sided = mesh
            .triangles
            .iter()
            .map(|_| random.below(2) == 0)
            .collect();
        check_hits(machine, &format!("sided sphere at {offset}"), &mesh);
    }
    check_hits(machine, "grid", &grid(32));
    for file in ["bench/suzanne.obj", "bench/teapot.obj"] {
        if let Some(mesh) = mesh_of_file(file) {
            check_hits(machine, file, &mesh);
        }
    }
}

/// The comparison fails where it should.
#[test]
fn hits_of_other_bits_are_told_apart() {
    let ray = Ray::unbounded([0.0; 3], [1.0; 3]);
    let hit = Hit {
        t: 1.0,
        u: 0.25,
        v: 0.5,
        prim: 3,
    };
    assert!(mismatches(&[ray], &[hit], &[hit]).is_empty());
    let others = [
        Hit {
            t: 1.0_f32.next_up(),
            ..hit
        },
        Hit {
            u: 0.25_f32.next_up(),
            ..hit
        },
        Hit {
            v: 0.5_f32.next_up(),
            ..hit
        },
        Hit { prim: 4, ..hit },
        Hit::miss(1.0),
    ];
    for other in others {
        assert_eq!(mismatches(&[ray], &[hit], &[other]).len(), 1);
    }
    assert!(mismatches(&[ray], &[Hit::miss(1.0)], &[Hit::miss(2.0)]).is_empty());
}

/// Rays from inside a closed mesh at its edges and vertices: how many miss, asked for the closest hit and for any.
fn leaks(machine: &Machine, dialect: Dialect, mesh: &Mesh, bvh: &Bvh<4>) -> [usize; 2] {
    let mut random = Random::new(3);
    let (center, _) = mesh.center_and_half();
    let rays: Vec<Ray> = (0..ray_count(machine))
        .map(|_| {
            let org = random.near(center, 0.3);
            let target = match random.below(2) {
                0 => mesh.vertex(&mut random),
                _ => mesh.edge(&mut random)[2],
            };
            aimed(org, target)
        })
        .collect();
    let queries = RayQueries::new(&machine.gpu, dialect, bvh);
    let queries = queries.unwrap_or_else(|error| panic!("{error}"));
    [false, true].map(|any| {
        let traced = queries
            .trace(&rays, any)
            .unwrap_or_else(|error| panic!("{error}"));
        traced.0.iter().filter(|hit| !hit.is_hit()).count()
    })
}

/// G-02: sides are decided by comparing rounded products, which neither contraction nor reassociation can flip, so that no
/// compiler opens a gap between triangles.
#[test]
fn closed_meshes_do_not_leak() {
    let Some(machine) = machine() else {
        return;
    };
    let plain = Dialect {
        mode: Mode::Plain,
        arithmetic: Arithmetic::default(),
    };
    for (offset, levels) in [(0.0, 2), (3.7, 5), (37.0, 2), (1e3, 2), (1e4, 2), (1e6, 2)] {
        let mesh = jittered_sphere([offset; 3], levels, &mut Random::new(4));
        let bvh = hierarchy(&mesh, BuildQuality::Best);
        for dialect in [machine.probe.dialect, plain] {
            let leaks = leaks(machine, dialect, &mesh, &bvh);
            assert_eq!(leaks, [0; 2], "at {offset}, {levels} levels, {dialect:?}");
        }
    }
}

/// A mesh with a hole leaks: the rays are aimed where leaks would be.
#[test]
fn holes_leak() {
    let Some(machine) = machine() else {
        return;
    };
    let mut mesh = jittered_sphere([0.0; 3], 2, &mut Random::new(4));
    mesh.triangles.pop();
    let bvh = hierarchy(&mesh, BuildQuality::Best);
    let leaks = leaks(machine, machine.probe.dialect, &mesh, &bvh);
    assert!(leaks.into_iter().all(|leaks| leaks > 0), "{leaks:?}");
}
