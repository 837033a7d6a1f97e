//! Traces primary rays at a bumpy sphere, prints it in characters, and times coherent and random
//! rays: `cargo run --release -p residual-bvh --example trace`.

use std::time::Instant;

use residual_bvh::{BuildQuality, Bvh, HasKernels, Hit, Ray, build};

fn main() {
    let (positions, triangles) = bumpy_sphere(300, 600);
    println!("{} triangles", triangles.len());
    measure::<4>(&positions, &triangles);
    measure::<8>(&positions, &triangles);
    let bvh = measure::<16>(&positions, &triangles);
    let hits = trace(&bvh, &camera_rays(64, 32));
    for row in hits.chunks(64) {
        let shade = |hit: &Hit| {
            if hit.is_hit() {
                b"#*+=-:."[(hit.t * 12.0) as usize % 7]
            } else {
                b' '
            }
        };
        println!(
            "{}",
            String::from_utf8_lossy(&row.iter().map(shade).collect::<Vec<u8>>())
        );
    }
}

fn measure<const N: usize>(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Bvh<N>
where
    Bvh<N>: HasKernels<N, N>,
{
    let start = Instant::now();
    let bvh = build::<N, N>(positions, triangles, None, BuildQuality::Best);
    println!(
        "width {N:2}: built in {:.2} s, {:.1} MB, cost {:.2}",
        start.elapsed().as_secs_f64(),
        bvh.memory_bytes() as f64 / 1e6,
        bvh.sah_cost()
    );
    let camera = camera_rays(1024, 1024);
    let bounced = bounced_rays(&camera, &trace(&bvh, &camera));
    for (name, rays) in [("coherent", &camera), ("random", &bounced)] {
        let mut best = [f64::INFINITY; 2];
        let mut found = [0; 2];
        for _ in 0..5 {
            let start = Instant::now();
            found[0] = trace(&bvh, rays).iter().filter(|hit| hit.is_hit()).count();
            best[0] = best[0].min(start.elapsed().as_secs_f64());
            let start = Instant::now();
            found[1] = count_occluded(&bvh, rays);
            best[1] = best[1].min(start.elapsed().as_secs_f64());
        }
        assert_eq!(found[0], found[1]);
        let [closest, any] = best.map(|seconds| rays.len() as f64 / seconds / 1e6);
        println!(
            "    {name:8}  closest {closest:5.2}  any {any:5.2} Mrays/s  ({} of {} hit)",
            found[0],
            rays.len()
        );
    }
    bvh
}

fn trace<const N: usize>(bvh: &Bvh<N>, rays: &[Ray]) -> Vec<Hit>
where
    Bvh<N>: HasKernels<N, N>,
{
    let mut hits = vec![Hit::miss(0.0); rays.len()];
    bvh.closest_hits(rays, &mut hits);
    hits
}

fn count_occluded<const N: usize>(bvh: &Bvh<N>, rays: &[Ray]) -> usize
where
    Bvh<N>: HasKernels<N, N>,
{
    let mut occluded = vec![false; rays.len()];
    bvh.any_hits(rays, &mut occluded);
    occluded.iter().filter(|&&is| is).count()
}

fn camera_rays(width: usize, height: usize) -> Vec<Ray> {
    let ray = |index: usize| {
        let x = (index % width) as f32 / width as f32 * 2.0 - 1.0;
        let y = 1.0 - (index / width) as f32 / height as f32 * 2.0;
        Ray::unbounded([0.0, 0.0, 3.0], [0.5 * x, 0.5 * y, -1.0])
    };
    (0..width * height).map(ray).collect()
}

/// Rays from the points hit, in random directions. Those that start inwards cross the sphere.
fn bounced_rays(rays: &[Ray], hits: &[Hit]) -> Vec<Ray> {
    let mut state = 1u64;
    let mut random = || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 40) as f32 / (1 << 23) as f32 - 1.0
    };
    rays.iter()
        .zip(hits)
        .filter(|(_, hit)| hit.is_hit())
        .map(|(ray, hit)| Ray {
            tmin: 1e-3,
            ..Ray::unbounded(
                [0, 1, 2].map(|axis| ray.org[axis] + hit.t * ray.dir[axis]),
                [random(), random(), random()],
            )
        })
        .collect()
}

fn bumpy_sphere(rings: usize, segments: usize) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let point = |ring: usize, segment: usize| {
        let theta = std::f32::consts::PI * ring as f32 / rings as f32;
        let phi = std::f32::consts::TAU * segment as f32 / segments as f32;
        let radius = 1.0 + 0.1 * (9.0 * theta).sin() * (11.0 * phi).sin();
        let (s, c) = theta.sin_cos();
        [radius * s * phi.cos(), radius * c, radius * s * phi.sin()]
    };
    let positions = (0..=rings)
        .flat_map(|ring| (0..segments).map(move |segment| point(ring, segment)))
        .collect();
    let mut triangles = Vec::new();
    for ring in 0..rings {
        for segment in 0..segments {
            let index = |r: usize, s: usize| (r * segments + s % segments) as u32;
            let (a, b) = (index(ring, segment), index(ring, segment + 1));
            let (c, d) = (index(ring + 1, segment), index(ring + 1, segment + 1));
            triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    (positions, triangles)
}
