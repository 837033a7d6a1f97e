//! The part of Embree 4's C interface that we call (`rtcore_device.h`, `_scene.h`, `_geometry.h`, `_ray.h`).

use std::ffi::{c_char, c_int, c_void};
use std::mem::ManuallyDrop;

use libloading::Library;

/// RTCDevice, RTCScene or RTCGeometry.
pub(super) type Handle = *mut c_void;

pub(super) const DEVICE_PROPERTY_VERSION: u32 = 0;
pub(super) const SCENE_FLAG_ROBUST: u32 = 1 << 2;
pub(super) const BUILD_QUALITY_MEDIUM: u32 = 1;
pub(super) const BUILD_QUALITY_HIGH: u32 = 2;
pub(super) const GEOMETRY_TYPE_TRIANGLE: u32 = 0;
pub(super) const BUFFER_TYPE_INDEX: u32 = 0;
pub(super) const BUFFER_TYPE_VERTEX: u32 = 1;
pub(super) const FORMAT_UINT3: u32 = 0x5003;
pub(super) const FORMAT_FLOAT3: u32 = 0x9003;
pub(super) const RAY_QUERY_FLAG_COHERENT: u32 = 1 << 16;
pub(super) const FEATURE_FLAG_ALL: u32 = u32::MAX;
pub(super) const INVALID_GEOMETRY_ID: u32 = u32::MAX;

/// RTCIntersectArguments and RTCOccludedArguments, which have the same fields.
#[repr(C)]
pub(super) struct Arguments {
    pub(super) flags: u32,
    pub(super) feature_mask: u32,
    pub(super) context: *mut c_void,
    pub(super) filter: *mut c_void,
    pub(super) callback: *mut c_void,
    pub(super) min_width_distance_factor: f32,
}

/// RTCRay4, RTCRay8, RTCRay16; with one lane, RTCRay.
#[derive(Clone, Copy)]
#[repr(C)]
pub(super) struct Rays<const N: usize> {
    pub(super) org: [[f32; N]; 3],
    pub(super) tnear: [f32; N],
    pub(super) dir: [[f32; N]; 3],
    pub(super) time: [f32; N],
    pub(super) tfar: [f32; N],
    pub(super) mask: [u32; N],
    pub(super) id: [u32; N],
    pub(super) flags: [u32; N],
}

/// RTCHit4 and so on, with room for the instance's primitive that a build of Embree may write.
#[derive(Clone, Copy)]
#[repr(C)]
pub(super) struct Hits<const N: usize> {
    pub(super) normal: [[f32; N]; 3],
    pub(super) uv: [[f32; N]; 2],
    pub(super) prim_id: [u32; N],
    pub(super) geometry_id: [u32; N],
    pub(super) instance_id: [u32; N],
    pub(super) instance_prim_id: [u32; N],
}

/// RTCRayHit4 and so on.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct RayHits<const N: usize> {
    pub(super) rays: Rays<N>,
    pub(super) hits: Hits<N>,
}

const _: () = assert!(std::mem::offset_of!(RayHits<1>, hits) == 48);
const _: () = assert!(std::mem::offset_of!(RayHits<16>, hits) == 768);

pub(super) type Trace1 = unsafe extern "C" fn(Handle, *mut c_void, *mut Arguments);
pub(super) type TraceN = unsafe extern "C" fn(*const c_int, Handle, *mut c_void, *mut Arguments);

macro_rules! api {
    ($($name:ident: $type:ty;)*) => {
        /// The functions, and the library that they live in. It is never unloaded: its TBB has destructors that run
        /// when threads end.
        #[allow(non_snake_case, reason = "Embree's names")]
        pub(super) struct Api {
            $(pub(super) $name: $type,)*
            _library: ManuallyDrop<Library>,
        }

        impl Api {
            /// # Safety
            /// The library's functions of these names must have these types.
            #[allow(non_snake_case, reason = "Embree's names")]
            pub(super) unsafe fn of(library: Library) -> Result<Api, libloading::Error> {
                $(
                    // SAFETY: by this function's contract.
                    let $name = *unsafe { library.get::<$type>(concat!(stringify!($name), "\0").as_bytes()) }?;
                )*
                Ok(Api { $($name,)* _library: ManuallyDrop::new(library) })
            }
        }
    };
}

api! {
    rtcNewDevice: unsafe extern "C" fn(*const c_char) -> Handle;
    rtcReleaseDevice: unsafe extern "C" fn(Handle);
    rtcGetDeviceProperty: unsafe extern "C" fn(Handle, u32) -> isize;
    rtcGetDeviceError: unsafe extern "C" fn(Handle) -> u32;
    rtcNewScene: unsafe extern "C" fn(Handle) -> Handle;
    rtcReleaseScene: unsafe extern "C" fn(Handle);
    rtcSetSceneFlags: unsafe extern "C" fn(Handle, u32);
    rtcSetSceneBuildQuality: unsafe extern "C" fn(Handle, u32);
    rtcCommitScene: unsafe extern "C" fn(Handle);
    rtcNewGeometry: unsafe extern "C" fn(Handle, u32) -> Handle;
    rtcReleaseGeometry: unsafe extern "C" fn(Handle);
    rtcSetNewGeometryBuffer: unsafe extern "C" fn(Handle, u32, u32, u32, usize, usize) -> *mut c_void;
    rtcCommitGeometry: unsafe extern "C" fn(Handle);
    rtcAttachGeometry: unsafe extern "C" fn(Handle, Handle) -> u32;
    rtcIntersect1: Trace1;
    rtcIntersect4: TraceN;
    rtcIntersect8: TraceN;
    rtcIntersect16: TraceN;
    rtcOccluded1: Trace1;
    rtcOccluded4: TraceN;
    rtcOccluded8: TraceN;
    rtcOccluded16: TraceN;
}
