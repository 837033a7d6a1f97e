//! The one runner, which holds every width and instruction set against the oracle.
use fearless_simd::{Level, Simd};
use residual_bvh::{
    AllHits, Boxes, BuildQuality, Bvh, BvhView, FrontHits, Hit, HitFilter, HitPacket, Kernel,
    MarkedHits, Packet, Precision, Ray, RayPacket, Watertight, Width, any_hit_packets, build,
    closest_hit_packets,
};

use crate::mesh::Mesh;
use crate::oracle::closest_hit_of_all;

/// Iterations for the profile: the dev profile does a tenth.
pub(crate) fn trials(release: usize) -> usize {
    if cfg!(debug_assertions) {
        release / 10
    } else {
        release
    }
}

/// A ray from `org` to `target` and beyond; the direction is their rounded difference.
pub(crate) fn aimed(org: [f32; 3], target: [f32; 3]) -> Ray {
    let dir = [0, 1, 2].map(|axis| target[axis] - org[axis]);
    Ray::unbounded(org, dir)
}

/// [`residual_bvh::closest_hit`] as a function of its own (see [`residual_bvh::Apart`]).
#[inline(never)]
pub(crate) fn closest_hit<S: Width<N> + Width<P>, const N: usize, const P: usize>(
    simd: S,
    precision: impl Precision,
    bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
    ray: &Ray,
    filter: &impl HitFilter,
) -> Hit {
    simd.vectorize(
        #[inline(always)]
        || residual_bvh::closest_hit(simd, precision, bvh, ray, filter),
    )
}

/// [`residual_bvh::any_hit`] as a function of its own (see [`residual_bvh::Apart`]).
#[inline(never)]
pub(crate) fn any_hit<S: Width<N> + Width<P>, const N: usize, const P: usize>(
    simd: S,
    precision: impl Precision,
    bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
    ray: &Ray,
    filter: &impl HitFilter,
) -> bool {
    simd.vectorize(
        #[inline(always)]
        || residual_bvh::any_hit(simd, precision, bvh, ray, filter),
    )
}

/// One mesh in hierarchies of all widths.
pub(crate) struct Widths {
    pub(crate) w4: Bvh<4>,
    pub(crate) w8: Bvh<8>,
    pub(crate) w16: Bvh<16>,
}

impl Widths {
    pub(crate) fn new(mesh: &Mesh, quality: BuildQuality) -> Widths {
        let marks = (!mesh.single_sided.is_empty()).then_some(&mesh.single_sided[..]);
        Widths {
            w4: build(&mesh.positions, &mesh.triangles, marks, quality),
            w8: build(&mesh.positions, &mesh.triangles, marks, quality),
            w16: build(&mesh.positions, &mesh.triangles, marks, quality),
        }
    }

    /// The best instruction set's answer, which must be the same for every width and query.
    pub(crate) fn closest<F: HitFilter>(&self, ray: &Ray, filter: &F) -> Hit {
        let hits = fearless_simd::dispatch!(Level::new(), simd => self.answers(simd, ray, filter));
        assert!(
            hits.iter().all(|hit| same(hit, &hits[0])),
            "{ray:x?}: {hits:?}"
        );
        hits[0]
    }

    /// Every width's closest hit, once its any-hit query is known to agree.
    fn answers<S: Simd, F: HitFilter>(&self, simd: S, ray: &Ray, filter: &F) -> [Hit; 3] {
        let (w4, w8, w16) = (self.w4.view(), self.w8.view(), self.w16.view());
        let hits = [
            closest_hit(simd, Watertight, w4, ray, filter),
            closest_hit(simd, Watertight, w8, ray, filter),
            closest_hit(simd, Watertight, w16, ray, filter),
        ];
        let any = [
            any_hit(simd, Watertight, w4, ray, filter),
            any_hit(simd, Watertight, w8, ray, filter),
            any_hit(simd, Watertight, w16, ray, filter),
        ];
        assert_eq!(
            hits.map(|hit| hit.is_hit()),
            any,
            "any_hit and closest_hit differ: {ray:?}"
        );
        hits
    }
}

/// Equality of bits, except that all NaN are alike.
pub(crate) fn same(a: &Hit, b: &Hit) -> bool {
    let bits = |x: f32| if x.is_nan() { u32::MAX } else { x.to_bits() };
    (bits(a.t), bits(a.u), bits(a.v), a.prim) == (bits(b.t), bits(b.u), bits(b.v), b.prim)
}

/// Packets of `R` rays that are given and answered in columns, as a kernel of streams.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Columns<const R: usize>;

impl<S, const N: usize, const P: usize, const R: usize> Kernel<S, N, P> for Columns<R>
where
    S: Width<N> + Width<P> + Width<R>,
{
    #[inline(always)]
    fn closest_hits(
        self,
        simd: S,
        precision: impl Precision,
        bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
        rays: &[Ray],
        hits: &mut [Hit],
        filter: &impl HitFilter,
    ) {
        let packets: Vec<RayPacket<R>> = rays.chunks(R).map(RayPacket::of_rays).collect();
        let mut found = vec![HitPacket::misses(&RayPacket::NONE); packets.len()];
        closest_hit_packets(simd, precision, bvh, &packets, &mut found, filter);
        for (index, hit) in hits.iter_mut().enumerate() {
            *hit = found[index / R].hit(index % R);
        }
    }

    #[inline(always)]
    fn any_hits(
        self,
        simd: S,
        precision: impl Precision,
        bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
        rays: &[Ray],
        occluded: &mut [bool],
        filter: &impl HitFilter,
    ) {
        let packets: Vec<RayPacket<R>> = rays.chunks(R).map(RayPacket::of_rays).collect();
        let mut found = vec![0; packets.len()];
        any_hit_packets(simd, precision, bvh, &packets, &mut found, filter);
        let is_hit = |index: usize| found[index / R] >> (index % R) & 1 == 1;
        for (index, occluded) in occluded.iter_mut().enumerate() {
            *occluded = is_hit(index);
        }
        let mut left_over = rays.len()..R * found.len();
        assert!(!left_over.any(is_hit), "lanes without rays hit nothing");
    }
}

/// Rejects a third of the triangles and the half of each that is near its third vertex.
pub(crate) struct Holes;

impl HitFilter for Holes {
    const CULLING: residual_bvh::Culling = residual_bvh::Culling::None;
    const REJECTS: bool = true;

    fn accept(&self, _ray: &Ray, hit: &Hit) -> bool {
        !hit.prim.is_multiple_of(3) && hit.v < 0.5
    }
}

/// Holds every width, instruction set, culling and query against the oracle. Returns how many rays
/// hit, so that the caller can see that it tests something.
pub(crate) fn check(mesh: &Mesh, rays: &[Ray]) -> usize {
    let qualities = [BuildQuality::Fast, BuildQuality::Medium, BuildQuality::Best];
    let widths = qualities.map(|quality| Widths::new(mesh, quality));
    for ray in rays {
        for widths in &widths {
            check_filter(mesh, widths, ray, &FrontHits);
            check_filter(mesh, widths, ray, &MarkedHits);
            check_filter(mesh, widths, ray, &Holes);
        }
    }
    let hit = |ray: &&Ray| {
        let expected = closest_hit_of_all(mesh, ray, &AllHits);
        for widths in &widths {
            on_every_instruction_set(widths, ray, &expected);
        }
        expected.is_hit()
    };
    rays.iter().filter(hit).count()
}

fn check_filter<F: HitFilter>(mesh: &Mesh, widths: &Widths, ray: &Ray, filter: &F) {
    let expected = closest_hit_of_all(mesh, ray, filter);
    let hit = widths.closest(ray, filter);
    assert!(
        same(&hit, &expected),
        "{ray:?}\n  {hit:?}, expected {expected:?}"
    );
}

fn on_every_instruction_set(widths: &Widths, ray: &Ray, expected: &Hit) {
    let compare = |hits: [Hit; 3], name: &str| {
        for (hit, width) in hits.iter().zip([4, 8, 16]) {
            assert!(
                same(hit, expected),
                "{name}, width {width}: {ray:?}\n  {hit:?}, expected {expected:?}"
            );
        }
    };
    let best = fearless_simd::dispatch!(Level::new(), simd => widths.answers(simd, ray, &AllHits));
    compare(best, "best");
    #[cfg(target_arch = "x86_64")]
    {
        let level = Level::new();
        if let Some(simd) = level.as_avx2() {
            compare(
                simd.vectorize(|| widths.answers(simd, ray, &AllHits)),
                "avx2",
            );
        }
        if let Some(simd) = level.as_sse4_2() {
            compare(
                simd.vectorize(|| widths.answers(simd, ray, &AllHits)),
                "sse4.2",
            );
        }
        if let Some(simd) = level.as_sse2() {
            compare(
                simd.vectorize(|| widths.answers(simd, ray, &AllHits)),
                "sse2",
            );
        }
    }
}
