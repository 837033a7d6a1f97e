//! Input that nobody should make and somebody will: garbage triangles, special rays, degenerate
//! distributions (I-07, I-12, I-13, B-06 to B-10).

use residual_bvh::{AllHits, BuildQuality, Hit, Ray};

use crate::mesh::{Mesh, jittered_icosphere, soup};
use crate::oracle::closest_hit_of_all;
use crate::random::Random;
use crate::runner::{Widths, aimed, check, same, trials};

/// Garbage among the triangles changes no hit (I-07).
#[test]
fn garbage_triangles_are_invisible() {
    let mut random = Random::new(30);
    let clean = jittered_icosphere(2, &mut random);
    let mut dirty = clean.clone();
    for i in 0..256 {
        let p = random.in_cube(1.0);
        match i % 5 {
            0 => dirty.push([p, p, random.in_cube(1.0)]),
            1 => dirty.push([p, p, p]),
            2 => dirty.push([p, p.map(|x| 2.0 * x), p.map(|x| 4.0 * x)]),
            3 => dirty.push([p, random.in_cube(1.0), [f32::NAN, 0.0, f32::INFINITY]]),
            _ => {
                let mut bits = || f32::from_bits(random.bits() | 0x7f80_0000);
                dirty.push([[bits(), bits(), bits()], p, p.map(|x| -x)]);
            }
        }
    }
    for quality in [BuildQuality::Fast, BuildQuality::Best] {
        let (clean_widths, dirty_widths) =
            (Widths::new(&clean, quality), Widths::new(&dirty, quality));
        for _ in 0..trials(20_000) {
            let ray = aimed(random.in_cube(2.0), clean.edge_point(&mut random));
            let hit = clean_widths.closest(&ray, &AllHits);
            assert!(same(&hit, &dirty_widths.closest(&ray, &AllHits)), "{ray:?}");
        }
    }
}

/// Vertices of any bits: no panic, no NaN, and the oracle's answer.
#[test]
fn random_bit_patterns() {
    let mut random = Random::new(31);
    for _ in 0..20 {
        let mut mesh = soup(64, 0.5, &mut random);
        for _ in 0..64 {
            mesh.push([0; 3].map(|_| [0; 3].map(|_| f32::from_bits(random.bits()))));
        }
        let rays: Vec<Ray> = (0..trials(200))
            .map(|_| aimed(random.in_cube(2.0), random.in_cube(1.0)))
            .collect();
        check(&mesh, &rays);
        let widths = Widths::new(&mesh, BuildQuality::Best);
        for ray in &rays {
            let hit = widths.closest(ray, &AllHits);
            assert!(!hit.is_hit() || hit.t.is_finite() && hit.u.is_finite() && hit.v.is_finite());
        }
    }
}

/// Zeros, subnormals, huge numbers, infinities and NaN in every component of a ray (I-12).
#[test]
fn special_rays() {
    let values = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        0.5,
        1e-40,
        -1e-40,
        f32::MIN_POSITIVE,
        1e30,
        f32::MAX,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::NAN,
    ];
    let mut random = Random::new(32);
    let mesh = jittered_icosphere(1, &mut random);
    let mut rays = Vec::new();
    for _ in 0..trials(20_000) {
        let mut any = || values[random.below(values.len())];
        let (mut tmin, mut tmax) = (any(), any());
        if random.below(2) == 0 {
            (tmin, tmax) = (0.0, f32::INFINITY);
        }
        // Mostly ordinary components, so that rays go wrong in one component at a time.
        let mut component = |ordinary: f32| {
            if random.below(4) == 0 {
                values[random.below(values.len())]
            } else {
                ordinary
            }
        };
        let (org, dir) = (
            [0; 3].map(|_| component(0.25)),
            [component(0.3), component(-0.4), component(1.0)],
        );
        rays.push(Ray {
            org,
            tmin,
            dir,
            tmax,
        });
    }
    // From as far away as this, the least component that a direction has for the slab test may
    // lead past a box.
    let reach = |ray: &Ray| ray.org.iter().all(|x| x.abs() < 1e15 || !x.is_finite());
    let (near, far): (Vec<Ray>, Vec<Ray>) = rays.iter().partition(|ray| reach(ray));
    assert!(check(&mesh, &near) > near.len() / 20);
    assert!(!far.is_empty());
    let widths = Widths::new(&mesh, BuildQuality::Medium);
    for ray in far {
        widths.closest(&ray, &AllHits);
    }

    let good = Ray::unbounded([0.0; 3], [0.0, 0.0, 1.0]);
    let widths = Widths::new(&mesh, BuildQuality::Medium);
    assert!(widths.closest(&good, &AllHits).is_hit());
    let bad = [
        Ray {
            org: [f32::NAN, 0.0, 0.0],
            ..good
        },
        Ray {
            org: [0.0, f32::INFINITY, 0.0],
            ..good
        },
        Ray {
            dir: [0.0; 3],
            ..good
        },
        Ray {
            dir: [-0.0; 3],
            ..good
        },
        Ray {
            dir: [1e-40, 0.0, 0.0],
            ..good
        },
        Ray {
            dir: [0.0, f32::NAN, 1.0],
            ..good
        },
        Ray {
            dir: [0.0, f32::NEG_INFINITY, 1.0],
            ..good
        },
        Ray {
            tmin: f32::NAN,
            ..good
        },
        Ray {
            tmax: f32::NAN,
            ..good
        },
        Ray {
            tmin: 3.0,
            tmax: 2.9,
            ..good
        },
        Ray {
            tmin: f32::INFINITY,
            ..good
        },
        Ray {
            tmin: f32::NEG_INFINITY,
            tmax: -1.0,
            ..good
        },
    ];
    for ray in bad {
        assert!(
            same(&widths.closest(&ray, &AllHits), &Hit::miss(ray.tmax)),
            "{ray:?}"
        );
    }
}

/// Both ends of the interval belong to it, so that moving an end just past each hit enumerates a
/// stack of layers (I-13).
#[test]
fn intervals_are_closed() {
    let mut random = Random::new(33);
    let mut mesh = Mesh::default();
    for layer in 0..50 {
        let z = layer as f32 * 0.37;
        mesh.push([[-5.0, -5.0, z], [5.0, -5.0, z + 0.1], [0.0, 8.0, z - 0.1]]);
    }
    let widths = Widths::new(&mesh, BuildQuality::Best);
    for _ in 0..trials(500) {
        let [x, y, _] = random.in_cube(1.0);
        let mut ray = Ray::unbounded([x, y, -3.0], random.in_cube(0.05));
        ray.dir[2] = 1.0;
        let mut layers = 0;
        loop {
            let hit = widths.closest(&ray, &AllHits);
            if !hit.is_hit() {
                break;
            }
            layers += 1;
            let at = |tmin, tmax| widths.closest(&Ray { tmin, tmax, ..ray }, &AllHits).prim;
            let (before, after) = (hit.t.next_down(), hit.t.next_up());
            assert_eq!(at(hit.t, hit.t), hit.prim);
            assert_eq!(at(0.0_f32.max(before), hit.t), hit.prim);
            assert_ne!(at(after, f32::INFINITY), hit.prim);
            assert_ne!(at(0.0, before), hit.prim);
            ray.tmin = after;
        }
        assert_eq!(layers, 50);
    }
}

#[test]
fn few_triangles() {
    let mut random = Random::new(34);
    let ray = Ray {
        org: [0.1, 0.1, -1.0],
        tmin: 0.0,
        dir: [0.0, 0.0, 1.0],
        tmax: 9.0,
    };
    let mut mesh = Mesh::default();
    let empty = Widths::new(&mesh, BuildQuality::Best);
    assert_eq!(empty.closest(&ray, &AllHits), Hit::miss(9.0));
    assert_eq!(empty.w8.bounds(), residual_bvh::Bounds::EMPTY);
    mesh.push([[f32::NAN; 3]; 3]);
    assert_eq!(
        Widths::new(&mesh, BuildQuality::Fast).closest(&ray, &AllHits),
        Hit::miss(9.0)
    );
    for count in 1..20 {
        mesh.push([[0.0, 0.0, count as f32], [1.0, 0.0, 0.5], [0.0, 1.0, 0.5]]);
        let rays: Vec<Ray> = (0..50)
            .map(|_| aimed(random.in_cube(2.0), mesh.vertices(count)[0]))
            .collect();
        check(&mesh, &rays);
        assert!(
            Widths::new(&mesh, BuildQuality::Fast)
                .closest(&ray, &AllHits)
                .is_hit()
        );
    }
}

/// A hundred thousand copies of one triangle (B-07).
#[test]
fn identical_triangles() {
    let copies = if cfg!(debug_assertions) {
        5_000
    } else {
        100_000
    };
    let mesh = Mesh {
        positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        triangles: vec![[0, 1, 2]; copies],
        ..Mesh::default()
    };
    for quality in [BuildQuality::Fast, BuildQuality::Medium, BuildQuality::Best] {
        let widths = Widths::new(&mesh, quality);
        let hit = widths.closest(&aimed([0.2, 0.2, 1.0], [0.25, 0.25, 0.0]), &AllHits);
        assert_eq!((hit.t, hit.prim), (1.0, 0));
    }
}

/// Triangles of all sizes around common points: centroids coincide, trees want to become lists
/// (B-07, B-08). The builder asserts the depth.
#[test]
fn cascades() {
    let mut random = Random::new(35);
    let mut mesh = Mesh::default();
    for i in 0..120 {
        let size = 2f32.powi(-i);
        mesh.push([[size, 0.0, 0.0], [0.0, size, 0.0], [0.0, 0.0, size]]);
        mesh.push([[1.0 + size, 0.0, 0.0], [1.0, size, 0.0], [1.0, 0.0, size]]);
        mesh.push([[-size, -size, 2.0], [size, -size, 2.0], [0.0, size, 2.0]]);
    }
    for i in 0..2000 {
        let size = 1.002f32.powi(i);
        mesh.push([[-size, -size, 5.0], [size, -size, 5.0], [0.0, size, 5.0]]);
    }
    let rays: Vec<Ray> = (0..trials(400))
        .map(|_| aimed(random.in_cube(2.0), mesh.edge_point(&mut random)))
        .collect();
    assert!(check(&mesh, &rays) > rays.len() / 2);
}

/// Areas that overflow or vanish in `f32` still give a tree that finds everything (B-09).
#[test]
fn huge_and_tiny_scenes() {
    let mut random = Random::new(36);
    for scale in [1e-18f32, 1e-12, 1e12, 1e17] {
        let mut mesh = soup(300, 0.2, &mut random);
        for position in &mut mesh.positions {
            *position = position.map(|x| x * scale);
        }
        let rays: Vec<Ray> = (0..trials(500))
            .map(|_| aimed(random.in_cube(2.0 * scale), mesh.vertex(&mut random)))
            .collect();
        assert!(check(&mesh, &rays) > rays.len() / 2, "scale {scale}");
    }
    // A teapot in a stadium, and both in a stadium whose area overflows.
    let mut mesh = soup(200, 1e-6, &mut random);
    for scale in [1e3, 1e6, 1e19, f32::MAX] {
        mesh.push([
            [-scale, -scale, scale],
            [scale, -scale, scale],
            [0.0, scale, scale],
        ]);
    }
    let rays: Vec<Ray> = (0..trials(2000))
        .map(|_| aimed(random.in_cube(2.0), mesh.vertices(random.below(202))[0]))
        .collect();
    assert!(check(&mesh, &rays) > rays.len() / 2);
    assert!(closest_hit_of_all(&mesh, &aimed([0.0; 3], [0.0, 0.0, 1.0]), &AllHits).is_hit());
}
