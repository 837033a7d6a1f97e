//! Hierarchies whose vertices moved.

use residual_bvh::{AllHits, BuildQuality, Bvh, BvhView, Hit, MarkedHits, Ray};

use crate::mesh::{Mesh, grid, jittered_icosphere, soup};
use crate::oracle::closest_hit_of_all;
use crate::random::Random;
use crate::runner::{Widths, aimed, same, trials};

impl Widths {
    fn refit(&mut self, mesh: &Mesh) {
        refit(&mut self.w4, mesh);
        refit(&mut self.w8, mesh);
        refit(&mut self.w16, mesh);
    }
}

fn refit<const N: usize, const P: usize>(bvh: &mut Bvh<N, P>, mesh: &Mesh) {
    bvh.refit(&mesh.positions, &mesh.triangles);
    BvhView::new(bvh.nodes(), bvh.packets()).expect("a sound tree");
}

fn rays_at(mesh: &Mesh, count: usize, random: &mut Random) -> Vec<Ray> {
    (0..count)
        .map(|i| {
            let target = if i % 2 == 0 {
                mesh.edge_point(random)
            } else {
                random.in_cube(1.0)
            };
            aimed(random.in_cube(3.0), target)
        })
        .collect()
}

fn hold_against_oracle(widths: &Widths, mesh: &Mesh, rays: &[Ray]) -> usize {
    let hit = |ray: &&Ray| {
        let expected = closest_hit_of_all(mesh, ray, &AllHits);
        let hit = widths.closest(ray, &AllHits);
        assert!(same(&hit, &expected), "{ray:?}: {hit:?}, {expected:?}");
        let expected = closest_hit_of_all(mesh, ray, &MarkedHits);
        assert!(same(&widths.closest(ray, &MarkedHits), &expected));
        expected.is_hit()
    };
    rays.iter().filter(hit).count()
}

const QUALITIES: [BuildQuality; 3] = [BuildQuality::Fast, BuildQuality::Medium, BuildQuality::Best];

/// Nothing moved: every hit is the same, bit for bit, and so is the cost where nothing is split.
#[test]
fn standing_still() {
    let mut random = Random::new(100);
    for mesh in [
        soup(2000, 0.2, &mut random).marked(&mut random),
        jittered_icosphere(3, &mut random),
        Mesh::default(),
    ] {
        let rays = match mesh.triangles.len() {
            0 => vec![aimed([0.0; 3], [1.0; 3])],
            _ => rays_at(&mesh, trials(3000), &mut random),
        };
        for quality in QUALITIES {
            let mut widths = Widths::new(&mesh, quality);
            let before: Vec<Hit> = rays
                .iter()
                .map(|ray| widths.closest(ray, &AllHits))
                .collect();
            let cost = widths.w8.sah_cost();
            widths.refit(&mesh);
            for (ray, before) in rays.iter().zip(&before) {
                assert!(same(&widths.closest(ray, &AllHits), before), "{ray:?}");
            }
            if quality != BuildQuality::Best {
                let change = (widths.w8.sah_cost() - cost).abs();
                assert!(change <= 1e-5 * cost, "{cost} changes by {change}");
            }
        }
    }
}

/// Deformed more and more, up to nonsense: the oracle's answers.
#[test]
fn deformations() {
    let mut random = Random::new(101);
    for quality in QUALITIES {
        let mut mesh = soup(150, 0.3, &mut random).marked(&mut random);
        let mut widths = Widths::new(&mesh, quality);
        let built_cost = widths.w8.sah_cost();
        for amount in [1e-3, 0.1, 0.5, 2.0] {
            for position in &mut mesh.positions {
                let offset = random.in_cube(amount);
                *position = [0, 1, 2].map(|axis| position[axis] + offset[axis]);
            }
            widths.refit(&mesh);
            let rays = rays_at(&mesh, trials(2000), &mut random);
            assert!(hold_against_oracle(&widths, &mesh, &rays) > rays.len() / 10);
        }
        assert!(widths.w8.sah_cost() > 1.2 * built_cost);
    }
}

/// Triangles that collapse or are torn to infinity are not hit, and come back.
#[test]
fn degenerate_triangles_come_back() {
    let mut random = Random::new(102);
    let mesh = jittered_icosphere(2, &mut random);
    let rays = rays_at(&mesh, trials(3000), &mut random);
    let mut widths = Widths::new(&mesh, BuildQuality::Best);
    let mut torn = mesh.clone();
    for (i, position) in torn.positions.iter_mut().enumerate() {
        match i % 5 {
            0 => position[i % 3] = f32::NAN,
            1 => position[i % 3] = f32::INFINITY,
            2 => *position = [0.5; 3],
            _ => {}
        }
    }
    widths.refit(&torn);
    hold_against_oracle(&widths, &torn, &rays);

    let mut gone = mesh.clone();
    gone.positions.fill([f32::NAN; 3]);
    widths.refit(&gone);
    assert_eq!(hold_against_oracle(&widths, &gone, &rays), 0);
    assert_eq!(widths.w4.sah_cost(), 0.0);

    widths.refit(&mesh);
    assert!(hold_against_oracle(&widths, &mesh, &rays) > rays.len() / 4);
}

/// A flat grid that becomes a bumpy one far away.
#[test]
fn boxes_follow() {
    let mut random = Random::new(103);
    let mut mesh = grid(40);
    let mut bvh: Bvh<8> =
        residual_bvh::build(&mesh.positions, &mesh.triangles, None, BuildQuality::Medium);
    for position in &mut mesh.positions {
        position[2] = 1000.0 + random.unit();
    }
    refit(&mut bvh, &mesh);
    let bounds = bvh.bounds();
    assert!(bounds.lo[2] > 999.9 && bounds.hi[2] < 1001.1, "{bounds:?}");
}
