//! The cost of a query: bounds that follow from the boxes alone, and its smallest cases.

use fearless_simd::{Level, dispatch};
use residual_bvh::{
    AllHits, BuildQuality, Bvh, Culling, Hit, HitFilter, QuantizedBvh, Ray, TraversalCost,
    Watertight, build, traversal_cost,
};

use crate::mesh::{Mesh, soup};
use crate::random::Random;
use crate::runner::{aimed, trials};

/// No intersection is a hit: the interval stays as long as it is.
struct NoHits;

impl HitFilter for NoHits {
    const CULLING: Culling = Culling::None;
    const REJECTS: bool = true;

    fn accept(&self, _ray: &Ray, _hit: &Hit) -> bool {
        false
    }
}

fn cost(bvh: &Bvh<8>, ray: &Ray, filter: &impl HitFilter) -> TraversalCost {
    dispatch!(Level::new(), simd => traversal_cost(simd, Watertight, bvh.view(), ray, filter))
}

fn built(mesh: &Mesh) -> Bvh<8> {
    build(&mesh.positions, &mesh.triangles, None, BuildQuality::High)
}

/// Whether the ray passes the child's box, in `f64`. The kernels may let rays pass that miss by a
/// few roundings: `slack` is relative to the coordinates.
fn touches(bvh: &Bvh<8>, node: usize, slot: usize, ray: &Ray, slack: f64) -> bool {
    let bounds = bvh.nodes()[node].child_bounds(slot);
    let (mut entry, mut exit) = (f64::from(ray.tmin), f64::from(ray.tmax));
    for axis in 0..3 {
        let [lo, hi, org, dir] = [
            bounds.lo[axis],
            bounds.hi[axis],
            ray.org[axis],
            ray.dir[axis],
        ]
        .map(f64::from);
        let distance = |plane: f64, outwards: f64| {
            (plane + outwards * slack * (plane.abs() + org.abs()) - org) / dir
        };
        let (lo, hi) = (distance(lo, -1.0), distance(hi, 1.0));
        (entry, exit) = (entry.max(lo.min(hi)), exit.min(lo.max(hi)));
    }
    entry <= exit
}

/// All nodes and packets below boxes that the ray touches.
fn reachable(bvh: &Bvh<8>, ray: &Ray, slack: f64) -> TraversalCost {
    let mut cost = TraversalCost::default();
    let mut pending = vec![0];
    while let Some(node) = pending.pop() {
        cost.nodes += 1;
        for (slot, &child) in bvh.nodes()[node].children.iter().enumerate() {
            if !touches(bvh, node, slot, ray, slack) {
                continue;
            }
            if child >> 31 == 1 {
                cost.packets += child >> 27 & 15;
            } else {
                pending.push(child as usize);
            }
        }
    }
    cost
}

/// Where nothing is a hit, everything that the ray touches is visited and nothing else; hits save
/// some of it.
#[test]
fn what_a_ray_touches_is_visited() {
    let mut random = Random::new(21);
    let bvh = built(&soup(2_000, 0.1, &mut random));
    let (mut exact, mut saved) = (0, 0);
    let rays = trials(2_000);
    for _ in 0..rays {
        let mut ray = aimed(random.in_cube(3.0), random.in_cube(1.0));
        ray.tmax = 2.0 * random.unit();
        let (least, most) = (reachable(&bvh, &ray, 0.0), reachable(&bvh, &ray, 1e-5));
        let all = cost(&bvh, &ray, &NoHits);
        assert!(
            least.nodes <= all.nodes && all.nodes <= most.nodes,
            "{ray:?}"
        );
        assert!(
            least.packets <= all.packets && all.packets <= most.packets,
            "{ray:?}"
        );
        exact += usize::from(least == all);
        let nearest = cost(&bvh, &ray, &AllHits);
        assert!(
            nearest.nodes <= all.nodes && nearest.packets <= all.packets,
            "{ray:?}"
        );
        saved += usize::from(nearest.packets < all.packets);
    }
    assert!(exact > rays * 9 / 10, "{exact} of {rays}");
    assert!(saved > rays / 10, "{saved} of {rays}");
}

/// The longer the interval, the more is visited, up to the nearest hit and not beyond.
#[test]
fn longer_intervals_cost_more() {
    let mut random = Random::new(22);
    let bvh = built(&soup(2_000, 0.1, &mut random));
    for _ in 0..trials(500) {
        let mut ray = aimed(random.in_cube(3.0), random.in_cube(1.0));
        let (unbounded, hit) = (cost(&bvh, &ray, &AllHits), bvh.closest_hit(&ray));
        assert!(!hit.is_hit() || unbounded.packets > 0, "{ray:?}");
        let mut before = TraversalCost::default();
        for step in 0..20 {
            ray.tmax = step as f32 * 0.1;
            let now = cost(&bvh, &ray, &AllHits);
            assert!(
                before.nodes <= now.nodes && before.packets <= now.packets,
                "{ray:?}"
            );
            before = now;
        }
        assert!(before.nodes <= unbounded.nodes && before.packets <= unbounded.packets);
    }
}

#[test]
fn smallest_cases() {
    let positions = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
    let bvh: Bvh<8> = build(&positions, &[[0, 1, 2]], None, BuildQuality::Fast);
    let empty: Bvh<8> = build(&positions, &[], None, BuildQuality::Fast);
    let towards = aimed([0.0, 0.0, 1.0], [0.0, 0.0, 0.0]);
    let past = aimed([5.0, 0.0, 1.0], [5.0, 0.0, 0.0]);
    let away = aimed([0.0, 0.0, 1.0], [0.0, 0.0, 2.0]);
    let invalid = aimed([0.0; 3], [0.0; 3]);
    let counts = |nodes, packets| TraversalCost { nodes, packets };
    assert_eq!(cost(&bvh, &towards, &AllHits), counts(1, 1));
    assert_eq!(cost(&bvh, &past, &AllHits), counts(1, 0));
    assert_eq!(cost(&bvh, &away, &AllHits), counts(1, 0));
    assert_eq!(cost(&bvh, &invalid, &AllHits), counts(0, 0));
    assert_eq!(cost(&empty, &towards, &AllHits), counts(1, 0));

    let quantized = QuantizedBvh::from(bvh);
    let cost = dispatch!(Level::new(), simd =>
        traversal_cost(simd, Watertight, quantized.view(), &towards, &AllHits));
    assert_eq!(cost, counts(1, 1));
}
