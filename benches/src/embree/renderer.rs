//! Embree's traversal in our renderer's place.

use std::ffi::c_void;
use std::marker::PhantomData;

use residual_bvh::{Hit, Ray};
use residual_device_cpu::traversal::{AlphaFilter, Traversal};

use super::ffi::{Arguments, Handle, INVALID_GEOMETRY_ID, RayHits, Trace1, TraceN};
use super::library::EmbreeScene;
use super::trace::{FlushToZero, Valid, empty, fill};

/// Traces a renderer's streams with Embree: one ray a call, or 16. It knows no alpha and sees both sides of everything.
pub struct EmbreeTraversal<'s> {
    scene: Handle,
    calls: Calls,
    lives: PhantomData<&'s EmbreeScene>,
}

#[derive(Clone, Copy)]
enum Calls {
    One { closest: Trace1, any: Trace1 },
    Sixteen { closest: TraceN, any: TraceN },
}

// SAFETY: a committed scene may be traced by any number of threads at once ("Embree API Reference", Thread Safety); the
// rest are functions.
unsafe impl Sync for EmbreeTraversal<'_> {}

impl<'s> EmbreeTraversal<'s> {
    /// `rtcIntersect1` and `rtcOccluded1`.
    pub fn single(scene: &'s EmbreeScene) -> Self {
        let api = &scene.embree.api;
        let (closest, any) = (api.rtcIntersect1, api.rtcOccluded1);
        Self::new(scene, Calls::One { closest, any })
    }

    /// `rtcIntersect16` and `rtcOccluded16`.
    pub fn packets(scene: &'s EmbreeScene) -> Self {
        let api = &scene.embree.api;
        let (closest, any) = (api.rtcIntersect16, api.rtcOccluded16);
        Self::new(scene, Calls::Sixteen { closest, any })
    }

    fn new(scene: &'s EmbreeScene, calls: Calls) -> Self {
        Self {
            scene: scene.scene,
            calls,
            lives: PhantomData,
        }
    }

    /// Traces rays in packets of `N`; `trace` gets a packet and the lanes that take part, `take` the packet, a lane and
    /// the index of its ray.
    fn packets_of<const N: usize>(
        &self,
        rays: &[Ray],
        trace: impl Fn(*mut c_void, &Valid, &mut Arguments),
        mut take: impl FnMut(&RayHits<N>, usize, usize),
    ) {
        let _flush = FlushToZero::new();
        let mut arguments = Arguments::new(false);
        for (number, rays) in rays.chunks(N).enumerate() {
            let mut packet = empty::<N>();
            fill(&mut packet, rays);
            trace(
                (&raw mut packet).cast(),
                &Valid::first(rays.len()),
                &mut arguments,
            );
            for lane in 0..rays.len() {
                take(&packet, lane, number * N + lane);
            }
        }
    }
}

fn hit<const N: usize>(packet: &RayHits<N>, lane: usize) -> Hit {
    let t = packet.rays.tfar[lane];
    if packet.hits.geometry_id[lane] == INVALID_GEOMETRY_ID {
        return Hit::miss(t);
    }
    Hit {
        t,
        u: packet.hits.uv[0][lane],
        v: packet.hits.uv[1][lane],
        prim: packet.hits.prim_id[lane],
    }
}

impl Traversal for EmbreeTraversal<'_> {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], alpha: Option<&AlphaFilter<'_>>) {
        assert!(alpha.is_none(), "Embree is measured without alpha");
        match self.calls {
            Calls::One { closest, .. } => self.packets_of::<1>(
                rays,
                // SAFETY: the scene is alive and committed, and the packet is an RTCRayHit.
                |packet, _, arguments| unsafe { closest(self.scene, packet, arguments) },
                |packet, lane, ray| hits[ray] = hit(packet, lane),
            ),
            Calls::Sixteen { closest, .. } => self.packets_of::<16>(
                rays,
                // SAFETY: the scene is alive and committed, and the packet is an RTCRayHit16.
                |packet, valid, arguments| unsafe {
                    closest(valid.0.as_ptr(), self.scene, packet, arguments);
                },
                |packet, lane, ray| hits[ray] = hit(packet, lane),
            ),
        }
    }

    fn any_hits(&self, rays: &[Ray], occluded: &mut [bool], alpha: Option<&AlphaFilter<'_>>) {
        assert!(alpha.is_none(), "Embree is measured without alpha");
        match self.calls {
            Calls::One { any, .. } => self.packets_of::<1>(
                rays,
                // SAFETY: the scene is alive and committed, and the packet begins with an RTCRay.
                |packet, _, arguments| unsafe { any(self.scene, packet, arguments) },
                |packet, lane, ray| occluded[ray] = packet.rays.tfar[lane] < 0.0,
            ),
            Calls::Sixteen { any, .. } => self.packets_of::<16>(
                rays,
                // SAFETY: the scene is alive and committed, and the packet begins with an RTCRay16.
                |packet, valid, arguments| unsafe {
                    any(valid.0.as_ptr(), self.scene, packet, arguments);
                },
                |packet, lane, ray| occluded[ray] = packet.rays.tfar[lane] < 0.0,
            ),
        }
    }
}
