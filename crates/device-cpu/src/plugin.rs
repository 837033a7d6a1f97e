//! Renderers in shared libraries: emitted code, compiled, loaded and called.
//!
//! The boundary is C: one function that renders a tile, with pointers and lengths, and one that says what the library
//! was made for. No Rust type with an unspecified layout crosses it.

use std::ffi::OsStr;
use std::fmt;
use std::slice;

use residual_bvh::{BvhView, Node, TrianglePacket};
use residual_render::domain::{Buffer, Buffers};

use crate::lanes::{AnyBvh, LaneCount};
use crate::tile::{Counters, SceneView, TileJob, TileRenderer};

/// Raised whenever the layout of anything here, of nodes and packets, or the meaning of buffers changes.
const ABI_VERSION: u32 = 1;

/// What a library was made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Identity {
    abi_version: u32,
    lanes: u32,
    node_size: u32,
    packet_size: u32,
}

impl Identity {
    /// The identity of renderers with this lane count that are built from these sources.
    pub const fn new(lanes: u32) -> Self {
        let (node, packet) = match lanes {
            16 => (size_of::<Node<16>>(), size_of::<TrianglePacket<16>>()),
            8 => (size_of::<Node<8>>(), size_of::<TrianglePacket<8>>()),
            _ => (size_of::<Node<4>>(), size_of::<TrianglePacket<4>>()),
        };
        Self {
            abi_version: ABI_VERSION,
            lanes,
            node_size: node as u32,
            packet_size: packet as u32,
        }
    }
}

/// A slice as C sees it.
#[derive(Clone, Copy)]
#[repr(C)]
struct RawSlice<T> {
    start: *const T,
    length: usize,
}

impl<T> RawSlice<T> {
    fn new(slice: &[T]) -> Self {
        Self {
            start: slice.as_ptr(),
            length: slice.len(),
        }
    }

    /// # Safety
    /// It was made by [`RawSlice::new`] from a slice that lives for `'a`, and is asked for as the same type.
    unsafe fn get<'a>(self) -> &'a [T] {
        // SAFETY: pointer and length came from a slice that the caller vouches for.
        unsafe { slice::from_raw_parts(self.start, self.length) }
    }

    fn erase(self) -> RawSlice<()> {
        RawSlice {
            start: self.start.cast(),
            length: self.length,
        }
    }
}

impl RawSlice<()> {
    fn of<T>(self) -> RawSlice<T> {
        RawSlice {
            start: self.start.cast(),
            length: self.length,
        }
    }
}

/// The arguments of a call.
#[repr(C)]
pub struct TileCall {
    words: [RawSlice<u32>; Buffer::COUNT],
    nodes: RawSlice<()>,
    packets: RawSlice<()>,
    /// Width of the hierarchy: what `nodes` and `packets` are.
    width: u32,
    job: TileJob,
    radiance: *mut f32,
    radiance_length: usize,
    counters: Counters,
}

/// The type of the exported function `residual_render_tile`.
type RenderTile = unsafe extern "C" fn(*mut TileCall);
/// The type of the exported function `residual_identity`.
type GetIdentity = extern "C" fn() -> Identity;

/// Why a library could not be used.
#[derive(Debug)]
pub enum LoadError {
    /// The system could not load it, or it lacks a function.
    Library(libloading::Error),
    /// It was built from other sources or for another lane count.
    Mismatch,
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Library(error) => write!(f, "the compiled renderer could not be loaded: {error}"),
            Self::Mismatch => f.write_str(
                "the compiled renderer was made by another version of Residual or for another lane count",
            ),
        }
    }
}

impl std::error::Error for LoadError {}

impl From<libloading::Error> for LoadError {
    fn from(error: libloading::Error) -> Self {
        Self::Library(error)
    }
}

/// A renderer loaded from a shared library.
pub struct LoadedRenderer {
    render_tile: RenderTile,
    // Keeps the code in memory.
    _library: libloading::Library,
}

impl LoadedRenderer {
    /// Loads a library that [`export_renderer!`](crate::export_renderer) made.
    ///
    /// # Errors
    /// If it cannot be loaded or was made for something else.
    ///
    /// # Safety
    /// The file must be a library compiled from emitted code: loading runs its initialisers, and calling it trusts
    /// that its functions have the types declared here. The identity catches honest mistakes, not forgeries.
    pub unsafe fn load(path: &OsStr, lanes: LaneCount) -> Result<Self, LoadError> {
        // SAFETY: the caller vouches for the file, hence for its initialisers and for the types of both symbols.
        unsafe {
            let library = libloading::Library::new(path)?;
            let identity: GetIdentity = *library.get(b"residual_identity\0")?;
            if identity() != Identity::new(lanes.count()) {
                return Err(LoadError::Mismatch);
            }
            let render_tile: RenderTile = *library.get(b"residual_render_tile\0")?;
            Ok(Self {
                render_tile,
                _library: library,
            })
        }
    }
}

impl TileRenderer for LoadedRenderer {
    fn render_tile(&self, scene: &SceneView<'_>, job: &TileJob, radiance: &mut [f32]) -> Counters {
        let (width, nodes, packets) = match scene.bvh {
            AnyBvh::Four(bvh) => (
                4,
                RawSlice::new(bvh.nodes()).erase(),
                RawSlice::new(bvh.packets()).erase(),
            ),
            AnyBvh::Eight(bvh) => (
                8,
                RawSlice::new(bvh.nodes()).erase(),
                RawSlice::new(bvh.packets()).erase(),
            ),
            AnyBvh::Sixteen(bvh) => (
                16,
                RawSlice::new(bvh.nodes()).erase(),
                RawSlice::new(bvh.packets()).erase(),
            ),
        };
        let mut call = TileCall {
            words: Buffer::ALL.map(|buffer| RawSlice::new(scene.buffers.get(buffer))),
            nodes,
            packets,
            width,
            job: *job,
            radiance: radiance.as_mut_ptr(),
            radiance_length: radiance.len(),
            counters: Counters::default(),
        };
        // SAFETY: every slice in the call outlives it, `radiance` is borrowed exclusively, and the function is the
        // library's `residual_render_tile`, whose identity was checked when it was loaded.
        unsafe { (self.render_tile)(&raw mut call) };
        call.counters
    }
}

/// The library's side of a call.
///
/// # Safety
/// `call` was made by [`LoadedRenderer`] and is not used by anybody else during the call.
pub unsafe fn answer(call: *mut TileCall, renderer: &impl TileRenderer) {
    // SAFETY: the pointer is valid and exclusive, says the caller; the slices in it were made from living slices of
    // these types (the identity's sizes agree), and the hierarchy's views were sound when they were taken apart.
    unsafe {
        let call = &mut *call;
        let buffers = Buffers::new(call.words.map(|words| words.get()));
        let bvh = match call.width {
            16 => AnyBvh::Sixteen(BvhView::new_unchecked(
                call.nodes.of().get(),
                call.packets.of().get(),
            )),
            8 => AnyBvh::Eight(BvhView::new_unchecked(
                call.nodes.of().get(),
                call.packets.of().get(),
            )),
            _ => AnyBvh::Four(BvhView::new_unchecked(
                call.nodes.of().get(),
                call.packets.of().get(),
            )),
        };
        let radiance = slice::from_raw_parts_mut(call.radiance, call.radiance_length);
        call.counters = renderer.render_tile(&SceneView { buffers, bvh }, &call.job, radiance);
    }
}

/// Makes a [`TileRenderer`] called `Compiled` from emitted code's `Scene`, for a lane count.
#[macro_export]
macro_rules! compiled_scene {
    ($scene:ident, $lanes:ident) => {
        /// This scene's renderer.
        #[derive(Clone, Copy, Debug)]
        pub struct Compiled;

        impl Compiled {
            /// Paths shaded at once.
            pub const LANES: $crate::LaneCount = $crate::LaneCount::$lanes;
        }

        impl $crate::TileRenderer for Compiled {
            fn render_tile(
                &self,
                view: &$crate::SceneView<'_>,
                job: &$crate::TileJob,
                radiance: &mut [f32],
            ) -> $crate::Counters {
                $crate::render_lanes!($lanes, view, job, radiance, |buffers| $scene::new(buffers))
            }
        }
    };
}

/// Exports `Compiled` from a shared library.
#[macro_export]
macro_rules! export_renderer {
    () => {
        /// What this library was made for.
        #[unsafe(no_mangle)]
        pub extern "C" fn residual_identity() -> $crate::plugin::Identity {
            const { $crate::plugin::Identity::new(Compiled::LANES.count()) }
        }

        /// Renders a tile.
        ///
        /// # Safety
        /// Called by `LoadedRenderer` only.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn residual_render_tile(call: *mut $crate::plugin::TileCall) {
            // SAFETY: the caller is `LoadedRenderer`, which made the call and waits for its end.
            unsafe { $crate::plugin::answer(call, &Compiled) }
        }
    };
}
