//! Tracing with Embree: single rays and packets, laid out as its interface wants them before the clock starts.

use std::ffi::{c_int, c_void};
use std::fmt;
use std::ptr::null_mut;
use std::rc::Rc;

use residual_bvh::Ray;

use crate::contender::{Contender, Prepared, Query};

use super::ffi::{
    Arguments, FEATURE_FLAG_ALL, Handle, Hits, INVALID_GEOMETRY_ID, RAY_QUERY_FLAG_COHERENT,
    RayHits, Rays, Trace1, TraceN,
};
use super::library::EmbreeScene;

/// Which calls are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mode {
    /// Rays of a call: 1, 4, 8 or 16.
    pub packet: usize,
    /// Whether Embree is told that rays are coherent.
    pub coherent: bool,
}

impl Mode {
    /// One ray a call.
    pub const SINGLE: Mode = Mode {
        packet: 1,
        coherent: false,
    };

    /// Packets of all sizes, both ways.
    pub fn packets() -> impl Iterator<Item = Mode> {
        let both = |packet| [false, true].map(|coherent| Mode { packet, coherent });
        [4, 8, 16].into_iter().flat_map(both)
    }
}

/// A scene and a way to trace it.
pub struct EmbreeContender {
    scene: Rc<EmbreeScene>,
    mode: Mode,
}

impl EmbreeContender {
    /// The scene may be shared.
    pub fn new(scene: Rc<EmbreeScene>, mode: Mode) -> EmbreeContender {
        EmbreeContender { scene, mode }
    }

    /// The calls and the settings, as in `rtcIntersect16 coherent HIGH ROBUST`.
    pub fn describe(&self, query: Query) -> String {
        let call = match query {
            Query::Closest => "rtcIntersect",
            Query::Any => "rtcOccluded",
        };
        let coherent = if self.mode.coherent { " coherent" } else { "" };
        let robust = if self.scene.robust { " ROBUST" } else { "" };
        format!(
            "{call}{}{coherent} {}{robust}",
            self.mode.packet, self.scene.quality
        )
    }
}

impl fmt::Debug for EmbreeContender {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.describe(Query::Closest))
    }
}

#[derive(Clone, Copy)]
enum Call {
    One(Trace1),
    Many(TraceN),
}

impl Contender for EmbreeContender {
    fn prepare(&self, query: Query) -> Box<dyn Prepared + '_> {
        let api = &self.scene.embree.api;
        let [closest, any] = match self.mode.packet {
            1 => [api.rtcIntersect1, api.rtcOccluded1].map(Call::One),
            4 => [api.rtcIntersect4, api.rtcOccluded4].map(Call::Many),
            8 => [api.rtcIntersect8, api.rtcOccluded8].map(Call::Many),
            16 => [api.rtcIntersect16, api.rtcOccluded16].map(Call::Many),
            packet => panic!("no packets of {packet}"),
        };
        let call = match query {
            Query::Closest => closest,
            Query::Any => any,
        };
        match self.mode.packet {
            1 => Box::new(Packets::<1>::new(self, call, query)),
            4 => Box::new(Packets::<4>::new(self, call, query)),
            8 => Box::new(Packets::<8>::new(self, call, query)),
            _ => Box::new(Packets::<16>::new(self, call, query)),
        }
    }
}

/// Lanes that take part, -1 or 0.
#[repr(C, align(64))]
pub(super) struct Valid(pub(super) [c_int; 16]);

impl Valid {
    /// The first lanes.
    pub(super) fn first(count: usize) -> Valid {
        Valid(std::array::from_fn(
            |lane| if lane < count { -1 } else { 0 },
        ))
    }
}

struct Packets<'a, const N: usize> {
    scene: &'a EmbreeScene,
    call: Call,
    query: Query,
    coherent: bool,
    packets: Vec<RayHits<N>>,
    /// Lanes of the last packet that take part.
    last: Valid,
}

impl<'a, const N: usize> Packets<'a, N> {
    fn new(contender: &'a EmbreeContender, call: Call, query: Query) -> Self {
        Packets {
            scene: &contender.scene,
            call,
            query,
            coherent: contender.mode.coherent,
            packets: Vec::new(),
            last: Valid([-1; 16]),
        }
    }
}

/// A packet that has hit nothing yet.
pub(super) fn empty<const N: usize>() -> RayHits<N> {
    RayHits {
        rays: Rays {
            org: [[0.0; N]; 3],
            tnear: [0.0; N],
            dir: [[0.0; N]; 3],
            time: [0.0; N],
            tfar: [0.0; N],
            mask: [u32::MAX; N],
            id: [0; N],
            flags: [0; N],
        },
        hits: Hits {
            normal: [[0.0; N]; 3],
            uv: [[0.0; N]; 2],
            prim_id: [u32::MAX; N],
            geometry_id: [INVALID_GEOMETRY_ID; N],
            instance_id: [u32::MAX; N],
            instance_prim_id: [u32::MAX; N],
        },
    }
}

/// Puts at most `N` rays into a packet.
pub(super) fn fill<const N: usize>(packet: &mut RayHits<N>, rays: &[Ray]) {
    for (lane, ray) in rays.iter().enumerate() {
        for axis in 0..3 {
            packet.rays.org[axis][lane] = ray.org[axis];
            packet.rays.dir[axis][lane] = ray.dir[axis];
        }
        packet.rays.tnear[lane] = ray.tmin;
        packet.rays.tfar[lane] = ray.tmax;
    }
}

impl Arguments {
    /// The defaults.
    pub(super) fn new(coherent: bool) -> Arguments {
        Arguments {
            flags: if coherent { RAY_QUERY_FLAG_COHERENT } else { 0 },
            feature_mask: FEATURE_FLAG_ALL,
            context: null_mut(),
            filter: null_mut(),
            callback: null_mut(),
            min_width_distance_factor: 0.0,
        }
    }
}

impl<const N: usize> Prepared for Packets<'_, N> {
    fn load(&mut self, rays: &[Ray]) {
        self.packets.clear();
        self.packets.resize(rays.len().div_ceil(N), empty());
        self.last = Valid::first((rays.len() + N - 1) % N + 1);
        for (packet, rays) in self.packets.iter_mut().zip(rays.chunks(N)) {
            fill(packet, rays);
        }
    }

    fn run(&mut self) {
        let _flush = FlushToZero::new();
        let mut arguments = Arguments::new(self.coherent);
        let all = Valid([-1; 16]);
        let scene: Handle = self.scene.scene;
        let last_index = self.packets.len().wrapping_sub(1);
        for (index, packet) in self.packets.iter_mut().enumerate() {
            // An occlusion query gets a pointer to the rays, which come first.
            let pointer: *mut c_void = std::ptr::from_mut(packet).cast();
            // SAFETY: the scene is alive and committed, the packet has Embree's layout and alignment, and so have the
            // masks.
            unsafe {
                match self.call {
                    Call::One(trace) => trace(scene, pointer, &mut arguments),
                    Call::Many(trace) => {
                        let valid = if index == last_index {
                            &self.last
                        } else {
                            &all
                        };
                        trace(valid.0.as_ptr(), scene, pointer, &mut arguments);
                    }
                }
            }
        }
    }

    fn hits(&self) -> usize {
        let lanes = |packet: &RayHits<N>| match self.query {
            Query::Closest => {
                let is_hit = |&&id: &&u32| id != INVALID_GEOMETRY_ID;
                packet.hits.geometry_id.iter().filter(is_hit).count()
            }
            Query::Any => packet.rays.tfar.iter().filter(|&&tfar| tfar < 0.0).count(),
        };
        self.packets.iter().map(lanes).sum()
    }
}

/// Denormals are zero, as Embree advises, until this is dropped.
pub(super) struct FlushToZero {
    #[cfg(target_arch = "x86_64")]
    before: u32,
}

#[cfg(target_arch = "x86_64")]
impl FlushToZero {
    const FTZ_AND_DAZ: u32 = 0x8040;

    pub(super) fn new() -> FlushToZero {
        let mut before = 0u32;
        // SAFETY: stores the control register to a live variable.
        unsafe { std::arch::asm!("stmxcsr [{}]", in(reg) &mut before, options(nostack)) };
        set_control(before | FlushToZero::FTZ_AND_DAZ);
        FlushToZero { before }
    }
}

#[cfg(target_arch = "x86_64")]
impl Drop for FlushToZero {
    fn drop(&mut self) {
        set_control(self.before);
    }
}

#[cfg(target_arch = "x86_64")]
fn set_control(value: u32) {
    // SAFETY: loads a valid control word; between this and its restoration only Embree computes.
    unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &value, options(nostack)) };
}

#[cfg(not(target_arch = "x86_64"))]
impl FlushToZero {
    pub(super) fn new() -> FlushToZero {
        FlushToZero {}
    }
}
