//! What a renderer of tiles is asked for, and what it reports.

use residual_render::domain::Buffers;
use residual_render::film::TileRect;
use residual_render::layer::Layers;
use residual_render::tracer::TracerOptions;

use crate::traversal::Traversal;

/// What is to be rendered.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct TileJob {
    /// x, y, width and height of the tile.
    pub tile: [u32; 4],
    /// Index of the first sample, and how many.
    pub samples: [u32; 2],
    /// What the tracer is told.
    pub tracer: TracerOptions,
}

const _: () = assert!(size_of::<TileJob>() == 48);

impl TileJob {
    /// The tile as a rectangle.
    pub fn rect(&self) -> TileRect {
        let [x, y, width, height] = self.tile;
        TileRect {
            x,
            y,
            width,
            height,
        }
    }
}

/// What was done, and how long each stage took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Counters {
    /// Rays from the camera.
    pub camera_rays: u64,
    /// Rays that continue paths.
    pub bounce_rays: u64,
    /// Rays towards lights.
    pub shadow_rays: u64,
    /// Thread seconds: making camera rays.
    pub emit: f64,
    /// Thread seconds: closest hits of camera rays.
    pub trace_camera: f64,
    /// Thread seconds: closest hits of continued paths.
    pub trace_bounce: f64,
    /// Thread seconds: occlusion, and adding what is not occluded.
    pub trace_shadow: f64,
    /// Thread seconds: sorting by program.
    pub sort: f64,
    /// Thread seconds: shading, and writing down the paths and shadow rays that go on, which compacts them.
    pub shade: f64,
    /// Thread seconds: adding samples to the film.
    pub film: f64,
}

impl Counters {
    /// The stages with their thread seconds (thesis, Figure 3.3).
    pub fn stages(&self) -> [(&'static str, f64); 7] {
        [
            ("emit", self.emit),
            ("trace_camera", self.trace_camera),
            ("trace_bounce", self.trace_bounce),
            ("trace_shadow", self.trace_shadow),
            ("sort", self.sort),
            ("shade", self.shade),
            ("film", self.film),
        ]
    }
}

impl std::ops::AddAssign for Counters {
    fn add_assign(&mut self, o: Self) {
        self.camera_rays += o.camera_rays;
        self.bounce_rays += o.bounce_rays;
        self.shadow_rays += o.shadow_rays;
        self.emit += o.emit;
        self.trace_camera += o.trace_camera;
        self.trace_bounce += o.trace_bounce;
        self.trace_shadow += o.trace_shadow;
        self.sort += o.sort;
        self.shade += o.shade;
        self.film += o.film;
    }
}

/// A scene's data, ready to be rendered.
#[derive(Clone, Copy)]
pub struct SceneView<'a> {
    /// Its buffers.
    pub buffers: Buffers<'a>,
    /// What traces rays against its triangles.
    pub traversal: &'a (dyn Traversal + Sync),
}

/// Renders tiles of one scene structure: interpreted, compiled in, or loaded.
pub trait TileRenderer: Sync {
    /// The layers that it fills beside radiance.
    fn layers(&self) -> Layers;

    /// Renders the job into `samples[sample][row][column][channel]`, which is overwritten: as many channels as
    /// [`Layers::stride`] says.
    fn render_tile(&self, scene: &SceneView<'_>, job: &TileJob, samples: &mut [f32]) -> Counters;
}
