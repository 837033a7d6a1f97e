//! Every kernel, node width, packet width, precision and instruction set against brute force, bit
//! for bit (I-01, I-02, I-04, I-14, B-04).

use std::fmt::Debug;

use fearless_simd::{Level, Simd};
use rayon::prelude::*;
use residual_bvh::{
    AllHits, Apart, BuildQuality, Bvh, Exact, Fast, Hit, Hybrid, Kernel, OneByOne, Packets, Phased,
    Precision, Ray, Single, Watertight, build,
};

use crate::mesh::{Mesh, jittered_icosphere};
use crate::oracle::{closest_hit_of_all, exact_closest_hit_of_all};
use crate::random::Random;
use crate::runner::{Columns, aimed, closest_hit, same};
use crate::tally::{Counts, Tally, check};

/// Rays that are traced as one stream: not a whole number of windows or packets.
const BATCH: usize = if cfg!(miri) { 6 } else { 1000 };
/// Of the meshes: 80 triangles, of which all are tested, and 320, of which a few are.
const LEVELS: [usize; 2] = if cfg!(miri) { [0, 0] } else { [1, 2] };

/// A closed mesh around `center`, in hierarchies of all widths, and each triangle alone.
struct Scene {
    mesh: Mesh,
    center: f32,
    best: best::Trees,
    sse: sse::Trees,
    avx2: avx2::Trees,
    alone: Vec<Bvh<4>>,
}

/// Trees of so many children a node and triangles a packet, how exactly each is traced, and by which kernels. A table, since
/// every entry takes seconds to compile.
macro_rules! combinations {
    ($module:ident: $($tree:ident($n:literal, $p:literal): $($precision:ident [$($kernel:expr),*]),*;)*) => {
        mod $module {
            use super::*;

            pub(super) struct Trees {
                $($tree: Bvh<$n, $p>,)*
            }

            impl Trees {
                pub(super) fn new(mesh: &Mesh, quality: BuildQuality) -> Trees {
                    let (positions, triangles) = (&mesh.positions, &mesh.triangles);
                    Trees {
                        $($tree: build(positions, triangles, None, quality),)*
                    }
                }

                pub(super) fn compare<S: Simd>(&self, simd: S, batch: &Batch, tally: &mut Tally) {
                    $($($(compare(simd, $kernel, $precision, &self.$tree, batch, tally);)*)*)*
                }
            }
        }
    };
}

// For the best instruction set. Without lanes (trees of one triangle a packet, the kernel without SIMD)
// `Fast` does not fuse, and gives other bits.
combinations!(best:
    n2p1(2, 1): Watertight [Single, Phased];
    n2p4(2, 4): Exact [Hybrid::<8>];
    n4p1(4, 1): Exact [Hybrid::<8>];
    n4p4(4, 4): Fast [Single, Packets::<4>, Hybrid::<4>], Watertight [Hybrid::<4>];
    n4p8(4, 8): Watertight [Hybrid::<16>, Columns::<4>];
    n8p4(8, 4): Exact [Single, Phased];
    n8p8(8, 8): Watertight [Packets::<8>, Hybrid::<32>], Fast [Columns::<32>], Exact [Hybrid::<8>];
    n8p16(8, 16): Watertight [Single, Phased];
    n16p8(16, 8): Watertight [Hybrid::<8>];
    n16p16(16, 16): Exact [Packets::<32>, Columns::<32>], Fast [Single, Phased, Hybrid::<32>], Watertight [Columns::<32>];
    n2p8(2, 8): Watertight [OneByOne];
    n4p16(4, 16): Exact [OneByOne];
    n8p1(8, 1): Exact [OneByOne];
    n16p4(16, 4): Watertight [OneByOne];
);
// For the lesser ones: the kernel that calls the others, in all precisions between them.
combinations!(sse:
    n4p4(4, 4): Fast [Hybrid::<32>];
    n8p8(8, 8): Watertight [Hybrid::<8>];
);
combinations!(avx2:
    n4p4(4, 4): Exact [Hybrid::<4>];
    n8p8(8, 8): Watertight [Hybrid::<32>];
);

/// A stream of rays and what they must hit.
struct Batch {
    rays: Vec<Ray>,
    /// Whether each was aimed at an edge or a vertex.
    aimed: Vec<bool>,
    /// Whether each must hit something: those from inside of the mesh whose interval has no end.
    inside: Vec<bool>,
    fast: Vec<Hit>,
    watertight: Vec<Hit>,
    exact: Vec<Hit>,
}

/// A precision with its brute force.
trait Judged: Precision + Debug {
    fn of(batch: &Batch) -> &[Hit];
    fn counts(tally: &mut Tally) -> &mut Counts;
}

macro_rules! implement_judged {
    ($($precision:ident, $field:ident, $index:literal;)*) => {$(
        impl Judged for $precision {
            fn of(batch: &Batch) -> &[Hit] {
                &batch.$field
            }
            fn counts(tally: &mut Tally) -> &mut Counts {
                &mut tally.precisions[$index]
            }
        }
    )*};
}
implement_judged!(Fast, fast, 0; Watertight, watertight, 1; Exact, exact, 2;);

/// A kernel, and its place among [`KERNELS`](crate::tally::KERNELS).
trait Counted: Copy + Debug {
    const INDEX: usize;
}

impl Counted for Single {
    const INDEX: usize = 0;
}

impl<const R: usize> Counted for Packets<R> {
    const INDEX: usize = 1;
}

impl<const R: usize> Counted for Hybrid<R> {
    const INDEX: usize = 2;
}

impl<const R: usize> Counted for Columns<R> {
    const INDEX: usize = 5;
}

impl Counted for OneByOne {
    const INDEX: usize = 3;
}

impl Counted for Phased {
    const INDEX: usize = 4;
}

fn compare<S, K, Pr: Judged, const N: usize, const P: usize>(
    simd: S,
    kernel: K,
    precision: Pr,
    bvh: &Bvh<N, P>,
    batch: &Batch,
    tally: &mut Tally,
) where
    S: Simd,
    K: Kernel<S, N, P> + Counted,
{
    let (rays, expected, counts) = (&batch.rays, Pr::of(batch), Pr::counts(tally));
    let mut hits = vec![Hit::miss(0.0); rays.len()];
    let mut occluded = vec![false; rays.len()];
    let apart = Apart(kernel);
    apart.closest_hits(simd, precision, bvh.view(), rays, &mut hits, &AllHits);
    apart.any_hits(simd, precision, bvh.view(), rays, &mut occluded, &AllHits);
    for i in 0..rays.len() {
        let kind = usize::from(batch.aimed[i]);
        counts.answers[K::INDEX][kind] += 1;
        if !same(&hits[i], &expected[i]) || occluded[i] != expected[i].is_hit() {
            counts.disagreements[K::INDEX][kind] += 1;
            if counts.disagreements[K::INDEX][kind] == 1 {
                println!(
                    "{precision:?}, {kernel:?}, {N} children, {P} triangles: {:x?}\n  {:?}, {}, expected {:?}",
                    rays[i], hits[i], occluded[i], expected[i]
                );
            }
        }
    }
}

impl Scene {
    fn new(center: f32, quality: BuildQuality, seed: u64) -> Scene {
        let mesh = jittered_icosphere(LEVELS[seed as usize % 2], &mut Random::new(seed))
            .translated(center);
        let alone = |triangle| build(&mesh.positions, &[triangle], None, BuildQuality::Fast);
        Scene {
            center,
            best: best::Trees::new(&mesh, quality),
            sse: sse::Trees::new(&mesh, quality),
            avx2: avx2::Trees::new(&mesh, quality),
            alone: mesh
                .triangles
                .iter()
                .map(|&triangle| alone(triangle))
                .collect(),
            mesh,
        }
    }

    /// From all around and inside; half of them in bundles. Aimed at edges and vertices, but for
    /// a quarter. A few have an end.
    fn batch(&self, random: &mut Random) -> Batch {
        let mesh = &self.mesh;
        let mut batch = Batch {
            rays: Vec::new(),
            aimed: Vec::new(),
            inside: Vec::new(),
            fast: Vec::new(),
            watertight: Vec::new(),
            exact: Vec::new(),
        };
        let (mut org, mut first, mut coherent, mut inside) = ([0.0; 3], 0, false, true);
        for i in 0..BATCH {
            if i % 32 == 0 {
                coherent = random.below(2) == 0;
                inside = random.below(4) != 0;
                org = random.in_cube(if inside { 0.3 } else { 3.0 });
                first = random.below(mesh.triangles.len());
            }
            if !coherent {
                org = random.in_cube(if inside { 0.3 } else { 3.0 });
                first = random.below(mesh.triangles.len());
            }
            let triangle = (first + random.below(4)) % mesh.triangles.len();
            let corners = mesh.vertices(triangle);
            let kind = random.below(4);
            let (from, corner) = (random.below(3), random.unit());
            let (p, q) = (corners[from], corners[(from + 1) % 3]);
            let target = match kind {
                0 => [0, 1, 2]
                    .map(|axis| self.center + org[axis] + 1e-3 * p[axis])
                    .map(|x| x + random.unit() - 0.5),
                1 => p,
                _ => [0, 1, 2].map(|axis| p[axis] + corner * (q[axis] - p[axis])),
            };
            let mut ray = aimed(org.map(|x| x + self.center), target);
            if random.below(2) == 0 {
                let length = ray.dir.iter().map(|x| x * x).sum::<f32>().sqrt();
                ray.dir = ray.dir.map(|x| x / length);
            }
            let clipped = random.below(8) == 0;
            if clipped {
                ray.tmin = random.unit() * 0.5;
                ray.tmax = ray.tmin + random.unit() * 2.0;
            }
            batch.rays.push(ray);
            batch.aimed.push(kind != 0);
            batch.inside.push(inside && !clipped);
        }
        let rays = &batch.rays;
        let of_all = |ray: &Ray| closest_hit_of_all(mesh, ray, &AllHits);
        batch.watertight = rays.iter().map(of_all).collect();
        let of_all = |ray: &Ray| exact_closest_hit_of_all(mesh, ray, &AllHits);
        batch.exact = rays.iter().map(of_all).collect();
        batch
    }

    /// The triangles one after the other, each in a hierarchy of its own.
    fn fast_hits<S: Simd>(&self, simd: S, rays: &[Ray]) -> Vec<Hit> {
        let closest = |ray: &Ray| {
            let mut best = Hit::miss(ray.tmax);
            for (prim, bvh) in self.alone.iter().enumerate() {
                let hit = closest_hit(simd, Fast, bvh.view(), ray, &AllHits);
                if hit.is_hit() && (hit.t < best.t || !best.is_hit()) {
                    best = Hit {
                        prim: prim as u32,
                        ..hit
                    };
                }
            }
            best
        };
        rays.iter().map(closest).collect()
    }

    /// One batch of rays through everything.
    fn trial(&self, seed: u64) -> Tally {
        let mut random = Random::new(seed);
        let mut batch = self.batch(&mut random);
        let mut tally = Tally::default();
        let level = Level::new();
        // The narrowest first, since it is on every machine of its kind.
        #[cfg(target_arch = "x86_64")]
        {
            if let Some(simd) = level.as_sse2() {
                batch.fast = self.fast_hits(simd, &batch.rays);
                self.sse.compare(simd, &batch, &mut tally);
            }
            if let Some(simd) = level.as_sse4_2() {
                batch.fast = self.fast_hits(simd, &batch.rays);
                self.sse.compare(simd, &batch, &mut tally);
            }
            if let Some(simd) = level.as_avx2() {
                batch.fast = self.fast_hits(simd, &batch.rays);
                self.avx2.compare(simd, &batch, &mut tally);
            }
        }
        fearless_simd::dispatch!(level, simd => {
            batch.fast = self.fast_hits(simd, &batch.rays);
            self.best.compare(simd, &batch, &mut tally)
        });
        let expected = [&batch.fast, &batch.watertight, &batch.exact];
        for (counts, hits) in tally.precisions.iter_mut().zip(expected) {
            for (i, hit) in hits.iter().enumerate() {
                let kind = usize::from(batch.aimed[i]);
                counts.rays[kind] += 1;
                counts.inside[kind] += usize::from(batch.inside[i]);
                counts.misses[kind] += usize::from(batch.inside[i] && !hit.is_hit());
            }
        }
        tally
    }
}

/// So many batches of rays, a fifth at each offset.
fn trials(batches: usize) -> Tally {
    let qualities = [BuildQuality::Fast, BuildQuality::Medium, BuildQuality::Best];
    let offsets = [0.0, 3.7, 37.0, 1e3, 1e4];
    let scenes: Vec<Scene> = (0..batches.min(15))
        .map(|i| Scene::new(offsets[i % 5], qualities[i % 3], i as u64))
        .collect();
    let add = |mut a: Tally, b: Tally| {
        a += b;
        a
    };
    (0..batches)
        .into_par_iter()
        .map(|i| scenes[i % scenes.len()].trial(1000 + i as u64))
        .reduce(Tally::default, add)
}

#[test]
fn every_kernel_agrees_with_brute_force() {
    let batches = if cfg!(miri) {
        1
    } else if cfg!(debug_assertions) {
        5
    } else {
        30
    };
    check(&trials(batches));
}

/// As many rays as the variable RAYS says, ten million if it is not set:
/// `RAYS=1e7 cargo test --release -p residual-bvh -- --ignored --nocapture ten_million`.
#[test]
#[ignore = "takes twenty minutes on one core"]
fn ten_million_rays_agree_with_brute_force() {
    let rays = std::env::var("RAYS").map_or(1e7, |rays| rays.parse().expect("a number of rays"));
    check(&trials((rays / BATCH as f64).ceil() as usize));
}
