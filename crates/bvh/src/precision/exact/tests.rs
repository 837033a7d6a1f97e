//! Decisions, distances and weights against integers of any size (I-06, I-08, I-10, I-16).

use fearless_simd::{Level, dispatch};
use num_bigint::{BigInt, Sign};

use self::integers::{integer, quotient, triple_product};
use super::Exact;
use crate::filter::Culling;
use crate::layout::triangle_packet::TrianglePacket;
use crate::precision::ending::Early;
use crate::precision::triangle::Shear;
use crate::precision::triangle_test::sealed::Test;
use crate::precision::watertight::Watertight;
use crate::ray::Ray;
use crate::simd::Width;

#[path = "../../../tests/queries/integers.rs"]
mod integers;

type Triangle = [[f32; 3]; 3];

struct Random(u64);

impl Random {
    fn bits(&mut self) -> u32 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 32) as u32
    }

    fn below(&mut self, n: u32) -> u32 {
        self.bits() % n
    }

    /// In [-1, 1).
    fn coordinate(&mut self) -> f32 {
        (self.bits() as i32 >> 7) as f32 / (1 << 24) as f32
    }

    fn point(&mut self) -> [f32; 3] {
        [0; 3].map(|_| self.coordinate())
    }

    /// On the triangle: at a corner, on an edge, or inside; rounded.
    fn target(&mut self, triangle: &Triangle) -> [f32; 3] {
        let [mut u, mut v] = [0; 2].map(|_| self.coordinate().abs());
        match self.below(4) {
            0 => (u, v) = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)][self.below(3) as usize],
            1 => v = 0.0,
            2 => v = 1.0 - u,
            _ => (u, v) = (u * 0.5, v * 0.5),
        }
        let [a, b, c] = triangle;
        [0, 1, 2].map(|i| a[i] + u * (b[i] - a[i]) + v * (c[i] - a[i]))
    }
}

fn towards(org: [f32; 3], target: [f32; 3]) -> Ray {
    Ray::unbounded(org, [0, 1, 2].map(|axis| target[axis] - org[axis]))
}

/// `[t, u, v]` where the line meets the closed triangle, and whether from behind.
fn truth(ray: &Ray, triangle: &Triangle) -> Option<([f64; 3], bool)> {
    let org = ray.org.map(integer);
    let dir = ray.dir.map(integer);
    let [a, b, c] = triangle.map(|corner| {
        let corner = corner.map(integer);
        [0, 1, 2].map(|axis| &corner[axis] - &org[axis])
    });
    let weights = [
        triple_product(&dir, &c, &b),
        triple_product(&dir, &a, &c),
        triple_product(&dir, &b, &a),
    ];
    let all = |sign: Sign| weights.iter().all(|weight| weight.sign() != sign);
    let determinant: BigInt = weights.iter().sum();
    let (front, back) = (all(Sign::Minus), all(Sign::Plus));
    if !(front || back) || determinant.sign() == Sign::NoSign {
        return None;
    }
    let volume = triple_product(&a, &c, &b);
    let hit = [&volume, &weights[1], &weights[2]].map(|x| quotient(x, &determinant));
    Some((hit, back))
}

/// `[t, u, v]` in 16 lanes, and which are hit, from anywhere and from behind.
fn hits<P: Test>(
    precision: P,
    ray: &Ray,
    triangles: &[Triangle; 16],
) -> ([[f32; 3]; 16], u32, u32) {
    let mut packet = TrianglePacket::<16>::VACANT;
    for (lane, triangle) in triangles.iter().enumerate() {
        for (vertex, corner) in triangle.iter().enumerate() {
            for (axis, &x) in corner.iter().enumerate() {
                packet.vertices[vertex][axis][lane] = x;
            }
        }
    }
    #[inline(always)]
    fn run<S: Width<16>, P: Test>(
        simd: S,
        precision: P,
        ray: &Ray,
        packet: &TrianglePacket<16>,
    ) -> ([[f32; 3]; 16], u32, u32) {
        let shear = Shear::of_ray(simd, ray, 0.0);
        let tmax = simd.splat(f32::MAX);
        let Some(hits) = precision.test(simd, &shear, packet, tmax, Culling::None, Early) else {
            return ([[0.0; 3]; 16], 0, 0);
        };
        let [t, u, v] = hits.store(simd).map(|stored| stored.0);
        let hit = std::array::from_fn(|lane| [t[lane], u[lane], v[lane]]);
        (hit, hits.lanes, hits.back)
    }
    dispatch!(Level::new(), simd => run(simd, precision, ray, &packet))
}

#[derive(Debug, Default)]
struct Tally {
    decisions: usize,
    inside: usize,
    /// Decisions of `Watertight` that differ from the truth.
    watertight: usize,
}

/// Holds decisions, distances and weights against the truth.
fn check(ray: &Ray, triangles: &[Triangle; 16], tally: &mut Tally) {
    let (exact, lanes, back) = hits(Exact, ray, triangles);
    let (_, watertight, _) = hits(Watertight, ray, triangles);
    let longest = |p: [f32; 3]| {
        p.into_iter()
            .map(|x| f64::from(x.abs()))
            .fold(0.0, f64::max)
    };
    for (lane, triangle) in triangles.iter().enumerate() {
        let truth = truth(ray, triangle);
        let hit = lanes >> lane & 1 == 1;
        let corner = [0, 1, 2].map(|axis| triangle[0][axis] - ray.org[axis]);
        let near = longest(corner) / longest(ray.dir) * 2f64.powi(-36);
        if let Some(([t, ..], _)) = truth
            && (t.abs() <= near || t.abs() < 1e-36 || t > 1e38)
        {
            continue; // At an end of the interval.
        }
        let expected = truth.filter(|([t, ..], _)| *t > 0.0);
        tally.decisions += 1;
        tally.inside += usize::from(expected.is_some());
        tally.watertight += usize::from((watertight >> lane & 1 == 1) != expected.is_some());
        let context = || format!("{ray:x?} {triangle:x?}: {:?}, not {truth:?}", exact[lane]);
        assert_eq!(hit, expected.is_some(), "{}", context());
        if let Some(([t, u, v], from_behind)) = expected {
            let found = exact[lane].map(f64::from);
            let ulp = f64::from(exact[lane][0].next_up()) - found[0];
            assert!((found[0] - t).abs() <= ulp + near, "{}", context());
            for (found, expected) in [(found[1], u), (found[2], v)] {
                assert!((found - expected).abs() <= 2f64.powi(-24), "{}", context());
            }
            assert_eq!(back >> lane & 1 == 1, from_behind, "{}", context());
        }
    }
}

/// So many rays, each at one of 16 triangles.
fn check_many(rays: usize, mut case: impl FnMut(&mut Random) -> (Ray, [Triangle; 16])) -> Tally {
    let mut random = Random(7);
    let mut tally = Tally::default();
    let rays = if cfg!(miri) {
        rays / 1000
    } else if cfg!(debug_assertions) {
        rays / 10
    } else {
        rays
    };
    for _ in 0..rays.max(1) {
        let (ray, triangles) = case(&mut random);
        check(&ray, &triangles, &mut tally);
    }
    println!("{tally:?}");
    tally
}

/// Triangles of all sizes, at offsets, around a common corner; rays at corners, edges and insides.
#[test]
fn aimed_rays() {
    for offset in [0.0, 3.7, 1e3] {
        let tally = check_many(8_000, |random| {
            let size = 10f32.powi(-(random.below(4) as i32));
            let common = random.point().map(|x| x + offset);
            let triangles = [0; 16].map(|_| {
                let [p, q] = [0; 2].map(|_| random.point());
                let at = |p: [f32; 3]| [0, 1, 2].map(|axis| common[axis] + size * p[axis]);
                [common, at(p), at(q)]
            });
            let target = random.target(&triangles[0]);
            let org = random.point().map(|x| x + offset);
            (towards(org, target), triangles)
        });
        assert!(tally.inside * 20 > tally.decisions);
    }
}

/// A hundred million times as long as wide, and rays around them. `Watertight` rounds, and is wrong.
#[test]
fn slivers() {
    let mut wrong = 0;
    for power in 0..=8 {
        let width = 10f32.powi(-power);
        let tally = check_many(2_000, |random| {
            let triangles = [0; 16].map(|_| {
                let (p, d, across) = (random.point(), random.point(), random.point());
                let along = random.coordinate();
                let third = |i: usize| p[i] + along * d[i] + width * across[i];
                [p, [0, 1, 2].map(|i| p[i] + d[i]), [0, 1, 2].map(third)]
            });
            let target = random.target(&triangles[0]);
            let distance = 10f32.powi(random.below(4) as i32 - 1);
            let offset = random.point();
            let org = [0, 1, 2].map(|axis| target[axis] + distance * offset[axis]);
            (towards(org, target), triangles)
        });
        wrong += tally.watertight;
    }
    assert!(wrong > 20 || cfg!(miri), "the test has no power: {wrong}");
}

/// Small integers: corners, edges and planes are met exactly, at every scale.
#[test]
fn touching() {
    let tally = check_many(8_000, |random| {
        let scale = 2f32.powi(random.below(120) as i32 - 60);
        let mut point = || [0; 3].map(|_| (random.below(5) as i32 - 2) as f32 * scale);
        let triangles = [0; 16].map(|_| [0; 3].map(|_| point()));
        let (org, target) = (point(), point());
        (towards(org, target), triangles)
    });
    assert!(tally.inside * 20 > tally.decisions);
}

/// Coordinates and directions of any size.
#[test]
fn extreme_exponents() {
    let tally = check_many(12_000, |random| {
        let spread = [1, 8, 40, 100][random.below(4) as usize];
        let base = random.below(200 - 2 * spread + 1) as i32 - 100 + spread as i32;
        let mut number = || {
            let exponent = base + random.below(2 * spread + 1) as i32 - spread as i32;
            random.coordinate() * 2f32.powi(exponent)
        };
        let mut point = || [0; 3].map(|_| number());
        let mut triangles = [0; 16].map(|_| [0; 3].map(|_| point()));
        let org = point();
        for triangle in &mut triangles[8..] {
            triangle[0] = org.map(|x| -x);
        }
        let aim = random.below(16) as usize;
        let target = random.target(&triangles[aim]);
        let mut ray = towards(org, target);
        if random.below(4) == 0 {
            ray.dir[random.below(3) as usize] = 0.0;
        }
        if !ray.is_valid() || ray.dir.iter().any(|x| x.is_subnormal()) {
            ray.dir = [1.0, 0.0, -0.0];
        }
        (ray, triangles)
    });
    assert!(tally.inside * 100 > tally.decisions);
}
