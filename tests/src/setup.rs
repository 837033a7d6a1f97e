//! From a description to a film.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use residual_bvh::BuildQuality;
use residual_device_cpu::{
    AnyBvh, CpuDevice, LaneCount, SceneView, TileRenderer, Traversal, Width,
};
use residual_render::film::{Film, Sampling};
use residual_render::passes::RenderOptions;
use residual_scenegen::desc::SceneDesc;
use residual_scenegen::import::{EnvironmentOptions, ImportError, ImportOptions, import};
use residual_scenegen::plan::Plan;
use residual_variants::AnyLanes;

/// Reads a scene file, under an environment image where one is given.
///
/// # Errors
/// If the file is refused.
pub fn read_scene(path: &Path, environment: Option<PathBuf>) -> Result<SceneDesc, ImportError> {
    let environment = environment.map(|path| EnvironmentOptions {
        path,
        strength: 1.0,
        rotation_degrees: 0.0,
    });
    import(
        path,
        &ImportOptions {
            environment,
            ..ImportOptions::default()
        },
    )
}

/// How a picture is taken.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// Width and height; the plan was made for the same.
    pub size: [u32; 2],
    /// Samples a pixel.
    pub samples: u32,
    /// Most vertices of a path.
    pub max_depth: u32,
    /// First vertex at which roulette may end a path.
    pub roulette_from: u32,
    /// Seed.
    pub seed: u32,
    /// Threads.
    pub threads: usize,
    /// How far the tracer reaches.
    pub reach: f32,
    /// How samples are spread over the image.
    pub sampling: Sampling,
    /// Pixels along the side of a tile; `None` is the device's choice.
    pub tile_size: Option<u32>,
}

impl Look {
    /// On two threads, with paths of eight vertices.
    pub fn new(size: [u32; 2], samples: u32) -> Self {
        Self {
            size,
            samples,
            max_depth: 8,
            roulette_from: RenderOptions::default().roulette_from,
            seed: 0,
            threads: 2,
            reach: f32::MAX,
            sampling: Sampling::Uniform,
            tile_size: None,
        }
    }
}

/// A plan with what traces its rays, for a lane count.
pub struct Prepared<'a> {
    plan: &'a Plan,
    traversal: Box<dyn Traversal + Sync>,
    lanes: LaneCount,
}

impl<'a> Prepared<'a> {
    /// Builds the hierarchy, of four children for up to four lanes; a hasty one over more triangles than it pays for in a test.
    pub fn new(plan: &'a Plan, lanes: LaneCount) -> Self {
        const MANY: usize = 150_000;
        let many = plan.data.triangle_count() > MANY;
        let quality = if many {
            BuildQuality::Fast
        } else {
            BuildQuality::Best
        };
        // A hierarchy of another width may not show, either.
        let width = match lanes {
            LaneCount::One | LaneCount::Four => Width::Four,
            LaneCount::Eight | LaneCount::Sixteen => Width::Native,
        };
        Self::with_traversal(plan, lanes, AnyBvh::build(&plan.data, width, quality))
    }

    /// With a traversal of the plan's triangles.
    pub fn with_traversal(
        plan: &'a Plan,
        lanes: LaneCount,
        traversal: impl Traversal + Sync + 'static,
    ) -> Self {
        Self {
            plan,
            traversal: Box::new(traversal),
            lanes,
        }
    }

    /// What a device needs of it.
    pub fn view(&self) -> SceneView<'_> {
        SceneView {
            buffers: self.plan.data.buffers(),
            traversal: &*self.traversal,
        }
    }

    /// The plan's interpreter.
    pub fn interpreter(&self) -> AnyLanes {
        AnyLanes::new(self.plan.structure.clone(), self.lanes)
    }

    /// Renders by interpretation.
    pub fn interpret(&self, look: &Look) -> Film {
        self.render(&self.interpreter(), look)
    }

    /// Renders by a renderer made for the plan and the lane count.
    ///
    /// # Panics
    /// If the system gives no threads.
    pub fn render(&self, renderer: &dyn TileRenderer, look: &Look) -> Film {
        let mut device = CpuDevice::new(look.threads).expect("threads");
        if let Some(tile_size) = look.tile_size {
            device = device.with_tile_size(tile_size);
        }
        let options = RenderOptions {
            size: look.size,
            samples: Some(look.samples),
            max_depth: look.max_depth,
            roulette_from: look.roulette_from,
            seed: look.seed,
            reach: look.reach,
            sampling: look.sampling,
            ..RenderOptions::default()
        };
        let go_on = |_: residual_render::passes::Progress<'_>| ControlFlow::Continue(());
        device.render(|| renderer, &self.view(), &options, go_on).0
    }
}
