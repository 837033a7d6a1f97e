//! Renderers in shared libraries: emitted code, compiled, loaded and called.
//!
//! The boundary is C: one function that renders tiles, with pointers and lengths, and one that says what the library
//! was made for. No Rust type with an unspecified layout crosses it.

use std::ffi::{OsStr, c_void};
use std::{fmt, ptr, slice};

use residual_bvh::{Hit, Ray};
use residual_render::domain::{Buffer, Buffers};
use residual_render::film::{SampleSet, TileSamples};
use residual_render::layer::Layers;
use residual_render::passes::Counters;
use residual_render::tracer::TracerOptions;

use crate::job::{SceneView, TileJob, TileRenderer};
use crate::lanes::LaneCount;
use crate::traversal::{AlphaFilter, Traversal};

/// Raised whenever the layout of anything here or the meaning of buffers changes.
const ABI_VERSION: u32 = 5;

/// What a library was made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Identity {
    abi_version: u32,
    lanes: u32,
    buffers: u32,
    call_size: u32,
    layers: u32,
    light_paths: u32,
}

impl Identity {
    /// The identity of a renderer with this lane count that is built from these sources.
    pub fn of(lanes: LaneCount, renderer: &impl TileRenderer) -> Self {
        Self::new(lanes, renderer.layers(), renderer.has_light_paths())
    }

    fn new(lanes: LaneCount, layers: Layers, has_light_paths: bool) -> Self {
        Self {
            abi_version: ABI_VERSION,
            lanes: lanes.count(),
            buffers: Buffer::COUNT as u32,
            call_size: size_of::<TileCall>() as u32,
            layers: layers.bits(),
            light_paths: u32::from(has_light_paths),
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
}

/// An exclusive slice as C sees it.
#[derive(Clone, Copy)]
#[repr(C)]
struct RawSliceMut<T> {
    start: *mut T,
    length: usize,
}

impl<T> RawSliceMut<T> {
    fn new(slice: &mut [T]) -> Self {
        Self {
            start: slice.as_mut_ptr(),
            length: slice.len(),
        }
    }

    /// # Safety
    /// It was made by [`RawSliceMut::new`] from a slice that lives, and is used by nobody else, for `'a`.
    unsafe fn get<'a>(self) -> &'a mut [T] {
        // SAFETY: pointer and length came from a slice that the caller vouches for.
        unsafe { slice::from_raw_parts_mut(self.start, self.length) }
    }
}

/// An [`AlphaFilter`] as C sees it; none without a function.
#[derive(Clone, Copy)]
#[repr(C)]
struct RawAlphaFilter {
    /// A `&AlphaFilter`.
    context: *const c_void,
    accept: Option<unsafe extern "C" fn(*const c_void, *const Ray, *const Hit) -> bool>,
}

impl RawAlphaFilter {
    /// Borrows what `alpha` borrows: it must not be called after that is gone.
    fn new(alpha: &Option<&AlphaFilter<'_>>) -> Self {
        /// # Safety
        /// `context` is a `&AlphaFilter`, and ray and hit are valid.
        unsafe extern "C" fn accept(
            context: *const c_void,
            ray: *const Ray,
            hit: *const Hit,
        ) -> bool {
            // SAFETY: by this function's contract.
            unsafe { (*context.cast::<&AlphaFilter<'_>>())(&*ray, &*hit) }
        }
        Self {
            context: alpha
                .as_ref()
                .map_or(ptr::null(), |alpha| ptr::from_ref(alpha).cast()),
            accept: alpha.is_some().then_some(accept),
        }
    }

    /// Calls `f` with the alpha that this was made from.
    ///
    /// # Safety
    /// That alpha is alive.
    unsafe fn with<R>(self, f: impl FnOnce(Option<&AlphaFilter<'_>>) -> R) -> R {
        match self.accept {
            None => f(None),
            Some(accept) => f(Some(&|ray, hit| {
                // SAFETY: the context is alive, says the caller, and goes with the function.
                unsafe { accept(self.context, ray, hit) }
            })),
        }
    }
}

/// A [`Traversal`] as C sees it.
#[derive(Clone, Copy)]
#[repr(C)]
struct RawTraversal {
    /// A `&(dyn Traversal + Sync)`.
    context: *const c_void,
    closest_hits:
        unsafe extern "C" fn(*const c_void, RawSlice<Ray>, RawSliceMut<Hit>, RawAlphaFilter),
    any_hits: unsafe extern "C" fn(*const c_void, RawSlice<Ray>, RawSliceMut<bool>, RawAlphaFilter),
    visits: unsafe extern "C" fn(*const c_void, RawSlice<Ray>, RawSliceMut<u32>, RawAlphaFilter),
}

impl RawTraversal {
    fn new(traversal: &&(dyn Traversal + Sync)) -> Self {
        /// # Safety
        /// `context` is a `&(dyn Traversal + Sync)`, and the slices and the alpha are alive.
        unsafe extern "C" fn closest_hits(
            context: *const c_void,
            rays: RawSlice<Ray>,
            hits: RawSliceMut<Hit>,
            alpha: RawAlphaFilter,
        ) {
            // SAFETY: by this function's contract.
            unsafe {
                let traversal = *context.cast::<&(dyn Traversal + Sync)>();
                alpha.with(|alpha| traversal.closest_hits(rays.get(), hits.get(), alpha));
            }
        }
        /// # Safety
        /// As for `closest_hits`.
        unsafe extern "C" fn any_hits(
            context: *const c_void,
            rays: RawSlice<Ray>,
            occluded: RawSliceMut<bool>,
            alpha: RawAlphaFilter,
        ) {
            // SAFETY: by this function's contract.
            unsafe {
                let traversal = *context.cast::<&(dyn Traversal + Sync)>();
                alpha.with(|alpha| traversal.any_hits(rays.get(), occluded.get(), alpha));
            }
        }
        /// # Safety
        /// As for `closest_hits`.
        unsafe extern "C" fn visits(
            context: *const c_void,
            rays: RawSlice<Ray>,
            visits: RawSliceMut<u32>,
            alpha: RawAlphaFilter,
        ) {
            // SAFETY: by this function's contract.
            unsafe {
                let traversal = *context.cast::<&(dyn Traversal + Sync)>();
                alpha.with(|alpha| traversal.visits(rays.get(), visits.get(), alpha));
            }
        }
        Self {
            context: ptr::from_ref(traversal).cast(),
            closest_hits,
            any_hits,
            visits,
        }
    }
}

// SAFETY: what it refers to is `Sync`, and nothing else is in it but functions.
unsafe impl Sync for RawTraversal {}

/// The library's side: what it refers to lives as long as the call.
impl Traversal for RawTraversal {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], alpha: Option<&AlphaFilter<'_>>) {
        let (hits, alpha) = (RawSliceMut::new(hits), RawAlphaFilter::new(&alpha));
        // SAFETY: the function goes with the context, and all arguments outlive the call.
        unsafe { (self.closest_hits)(self.context, RawSlice::new(rays), hits, alpha) }
    }

    fn any_hits(&self, rays: &[Ray], occluded: &mut [bool], alpha: Option<&AlphaFilter<'_>>) {
        let (occluded, alpha) = (RawSliceMut::new(occluded), RawAlphaFilter::new(&alpha));
        // SAFETY: as above.
        unsafe { (self.any_hits)(self.context, RawSlice::new(rays), occluded, alpha) }
    }

    fn visits(&self, rays: &[Ray], visits: &mut [u32], alpha: Option<&AlphaFilter<'_>>) {
        let (visits, alpha) = (RawSliceMut::new(visits), RawAlphaFilter::new(&alpha));
        // SAFETY: as above.
        unsafe { (self.visits)(self.context, RawSlice::new(rays), visits, alpha) }
    }
}

/// The arguments of a call.
#[repr(C)]
pub struct TileCall {
    words: [RawSlice<u32>; Buffer::COUNT],
    traversal: RawTraversal,
    tiles: RawSlice<TileSamples>,
    /// Pixels along the side of the blocks of which each has one of the tiles' pixels; 1 if the tiles are of the image.
    block: u32,
    tracer: TracerOptions,
    samples: RawSliceMut<f32>,
    counters: Counters,
}

/// The type of the exported function `residual_render_tiles`.
type RenderTiles = unsafe extern "C" fn(*mut TileCall);
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
    render_tiles: RenderTiles,
    layers: Layers,
    has_light_paths: bool,
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
            let identity = identity();
            // Layers and light paths are what the library says; the rest has to be what is expected.
            let layers = Layers::from_bits(identity.layers);
            let has_light_paths = identity.light_paths != 0;
            if identity != Identity::new(lanes, layers, has_light_paths) {
                return Err(LoadError::Mismatch);
            }
            let render_tiles: RenderTiles = *library.get(b"residual_render_tiles\0")?;
            Ok(Self {
                render_tiles,
                layers,
                has_light_paths,
                _library: library,
            })
        }
    }
}

impl TileRenderer for LoadedRenderer {
    fn layers(&self) -> Layers {
        self.layers
    }

    fn has_light_paths(&self) -> bool {
        self.has_light_paths
    }

    fn render_tiles(
        &self,
        scene: &SceneView<'_>,
        job: &TileJob<'_>,
        samples: &mut [f32],
    ) -> Counters {
        let mut call = TileCall {
            words: Buffer::ALL.map(|buffer| RawSlice::new(scene.buffers.get(buffer))),
            traversal: RawTraversal::new(&scene.traversal),
            tiles: RawSlice::new(job.tiles),
            block: match job.set {
                SampleSet::First => 1,
                SampleSet::Second { block } => block,
            },
            tracer: job.tracer,
            samples: RawSliceMut::new(samples),
            counters: Counters::default(),
        };
        // SAFETY: every slice in the call outlives it, `samples` is borrowed exclusively, and the function is the
        // library's `residual_render_tiles`, whose identity was checked when it was loaded.
        unsafe { (self.render_tiles)(&raw mut call) };
        call.counters
    }
}

/// The library's side of a call.
///
/// # Safety
/// `call` was made by [`LoadedRenderer`] and is not used by anybody else during the call.
pub unsafe fn answer(call: *mut TileCall, renderer: &impl TileRenderer) {
    // SAFETY: the pointer is valid and exclusive, says the caller, and the slices in it were made from living slices of
    // these types.
    unsafe {
        let call = &mut *call;
        let view = SceneView {
            buffers: Buffers::new(call.words.map(|words| words.get())),
            traversal: &call.traversal,
        };
        let job = TileJob {
            tiles: call.tiles.get(),
            set: match call.block {
                1 => SampleSet::First,
                block => SampleSet::Second { block },
            },
            tracer: call.tracer,
        };
        call.counters = renderer.render_tiles(&view, &job, call.samples.get());
    }
}
