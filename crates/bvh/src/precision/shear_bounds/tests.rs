//! What is rejected for a bundle of rays is rejected for each of them.

use fearless_simd::{Level, dispatch};

use super::ShearBounds;
use crate::filter::Culling;
use crate::layout::class::Class;
use crate::layout::ray_packet::RayPacket;
use crate::layout::triangle_packet::TrianglePacket;
use crate::precision::fast::Fast;
use crate::precision::triangle::Shear;
use crate::precision::triangle_test::sealed::Test;
use crate::precision::watertight::Watertight;
use crate::ray::Ray;
use crate::simd::Width;

/// Numbers in [-1, 1), by a linear congruential generator.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1 << 23) as f32 - 1.0
    }

    fn point(&mut self, size: f32) -> [f32; 3] {
        [0; 3].map(|_| size * self.next())
    }
}

/// Rays from about one place in about one direction.
fn bundle(random: &mut Random) -> [Ray; 16] {
    let (org, dir) = (random.point(2.0), random.point(1.0));
    let spread = [0.0, 1e-6, 1e-3, 0.1][(random.next().abs() * 4.0) as usize % 4];
    [(); 16].map(|()| {
        let around = |center: [f32; 3], by: [f32; 3]| [0, 1, 2].map(|axis| center[axis] + by[axis]);
        let aside = random.point(spread);
        Ray::unbounded(around(org, random.point(spread)), around(dir, aside))
    })
}

/// Triangles about the rays: with a corner or an edge that one of them is aimed at, flat ones among them.
fn triangles(rays: &[Ray; 16], random: &mut Random) -> TrianglePacket<16> {
    let mut packet = TrianglePacket::VACANT;
    for (lane, ray) in rays.iter().enumerate() {
        let along = |t: f32, aside: [f32; 3]| {
            [0, 1, 2].map(|axis| ray.org[axis] + t * ray.dir[axis] + aside[axis])
        };
        let size = 10f32.powf(1.5 * random.next() - 1.0);
        let flat = if lane % 3 == 0 { 1e-6 } else { size };
        let corners = [
            along(1.0, random.point(if lane % 2 == 0 { 0.0 } else { size })),
            along(1.0 + size, random.point(flat)),
            along(1.0 - 0.5 * size, random.point(size)),
        ];
        packet.set_corners(lane, corners);
        packet.prim_ids[lane] = lane as u32;
    }
    packet
}

/// How many pairs of a bundle and a triangle were rejected, and how many were not.
#[inline(always)]
fn check<S: Width<16>, P: Test>(simd: S, precision: P, culling: Culling) -> [u32; 2] {
    let mut random = Random(7);
    let mut counts = [0; 2];
    for _ in 0..2000 {
        let rays = bundle(&mut random);
        let packet = triangles(&rays, &mut random);
        let packet_of_rays = RayPacket::of(simd, &rays);
        let Some(Class { axes, .. }) = packet_of_rays.class(simd) else {
            continue;
        };
        let shear = Shear::<S, 16>::of_packet(simd, &packet_of_rays, &[0.0; 16], axes);
        let bounds = ShearBounds::<S, 16>::enclosing(
            simd,
            &packet_of_rays.bounds(simd, &packet_of_rays.intervals(u32::MAX)),
            &shear,
        );
        let all = precision.candidates_of_rays(simd, &bounds, &packet, culling) & 0xffff;
        for ray in &rays {
            let shear = Shear::<S, 16>::of_ray(simd, ray, 0.0);
            let one = precision.candidates(simd, &shear, &packet, culling) & 0xffff;
            assert_eq!(one & !all, 0, "{ray:?}, {packet:?}");
        }
        counts[0] += (!all & 0xffff).count_ones();
        counts[1] += all.count_ones();
    }
    counts
}

#[test]
fn what_a_bundle_misses_each_ray_misses() {
    for culling in [Culling::None, Culling::Back] {
        let counts = dispatch!(Level::new(), simd => [
            check(simd, Watertight, culling),
            check(simd, Fast, culling),
        ]);
        for [rejected, left] in counts {
            assert!(rejected > 4000 && left > 4000, "{rejected}, {left}");
        }
    }
}
