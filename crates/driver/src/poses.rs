//! The poses of a scene at the moments while the shutter is open, each with its hierarchy.
//!
//! Hierarchies are built ahead by a thread of its own, in the order in which passes ask for them, and are kept: a render comes
//! back to every moment again and again. What a pose shares with the first, hierarchy included, it has from there.

use std::convert::Infallible;
use std::ops::ControlFlow;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use residual_device_cpu::{AnyBvh, CpuDevice, SceneView, TileRenderer, Width};
use residual_frontend::hierarchy_quality;
use residual_render::changed_data::ChangedData;
use residual_render::film::{Film, TILE_SIZE};
use residual_render::passes::{Counters, Pass, Progress, RenderOptions, render_passes};
use residual_render::shutter::Moments;
use residual_scenegen::plan::{Motion, Plan};

/// A plan with the hierarchies of its poses.
pub struct Poses<'a> {
    plan: &'a Plan,
    width: Width,
    /// Which sample sees which moment; `None` where nothing moves.
    moments: Option<(Moments, &'a Motion)>,
    /// Of the first pose, then of those in which triangles have moved.
    hierarchies: Vec<OnceLock<(AnyBvh, Duration)>>,
    is_over: AtomicBool,
}

impl<'a> Poses<'a> {
    /// Those of a plan, for a render with this seed. No hierarchy is built yet.
    ///
    /// # Panics
    /// If the plan's moments are no power of two, which no plan has.
    pub fn new(plan: &'a Plan, width: Width, seed: u32) -> Self {
        let moments = plan.motion.as_ref().map(|motion| {
            let count = motion.moments.len() as u32;
            let moments = Moments::new(count, seed).expect("plans have powers of two of moments");
            (moments, motion)
        });
        let poses = 1 + moments.map_or(0, |(_, motion)| motion.later.len());
        Self {
            plan,
            width,
            moments,
            hierarchies: (0..poses).map(|_| OnceLock::new()).collect(),
            is_over: AtomicBool::new(false),
        }
    }

    /// The pose that a sample of a pixel sees.
    pub fn pose_of(&self, sample: u32) -> usize {
        let moments = self.moments.as_ref();
        moments.map_or(0, |(moments, motion)| {
            motion.moments[moments.of_sample(sample) as usize]
        })
    }

    /// A pose, whose hierarchy is built if it is not yet.
    pub fn view(&self, pose: usize) -> SceneView<'_> {
        let data = &self.plan.data;
        SceneView {
            buffers: match self.later(pose) {
                Some(changed) => changed.buffers(data),
                None => data.buffers(),
            },
            traversal: self.hierarchy(pose),
        }
    }

    /// The hierarchy of a pose, which is built if it is not yet.
    pub fn hierarchy(&self, pose: usize) -> &AnyBvh {
        let data = &self.plan.data;
        let quality = hierarchy_quality(data.triangle_count());
        let build = |pose: usize, positions: Option<Vec<[f32; 3]>>| {
            let (bvh, _) = self.hierarchies[pose].get_or_init(|| {
                let start = Instant::now();
                let bvh = match positions {
                    Some(positions) => AnyBvh::build_moved(data, &positions, self.width, quality),
                    None => AnyBvh::build(data, self.width, quality),
                };
                (bvh, start.elapsed())
            });
            bvh
        };
        if let Some((bvh, _)) = self.hierarchies[pose].get() {
            return bvh;
        }
        match self.later(pose).map(ChangedData::positions) {
            Some(Some(positions)) => build(pose, Some(positions)),
            // Whatever moves, triangles are where they were.
            Some(None) | None => build(0, None),
        }
    }

    /// Builds all hierarchies, in the order in which samples ask for them. Runs beside rendering, until [`Poses::end`].
    pub fn build_ahead(&self) {
        let count = self.moments.map_or(1, |(moments, _)| moments.count());
        for sample in 0..count {
            if self.is_over.load(Ordering::Relaxed) {
                return;
            }
            self.hierarchy(self.pose_of(sample));
        }
    }

    /// To be called when rendering is over: what is not built yet is not needed any more.
    pub fn end(&self) {
        self.is_over.store(true, Ordering::Relaxed);
    }

    /// Adds a pass of samples to a film, each at its moment.
    ///
    /// # Panics
    /// If the film has other layers than the renderer.
    pub fn pass(
        &self,
        device: &CpuDevice,
        renderer: &dyn TileRenderer,
        options: &RenderOptions,
        film: &mut Film,
        pass: Pass,
    ) -> Counters {
        match self.moments {
            None => device.pass(renderer, &self.view(0), options, film, pass),
            Some(_) => {
                let (pose_of, view) = (|sample| self.pose_of(sample), |pose| self.view(pose));
                device.pass_in_poses(renderer, pose_of, view, options, film, pass)
            }
        }
    }

    /// Renders until the options say stop.
    pub fn render(
        &self,
        device: &CpuDevice,
        renderer: &dyn TileRenderer,
        options: &RenderOptions,
    ) -> Film {
        let film = Film::sampled_by(options.sampling, options.size, TILE_SIZE, renderer.layers());
        let mut film = film.with_second_set(options.seed);
        let pass = |film: &mut Film, pass| {
            Ok::<_, Infallible>(self.pass(device, renderer, options, film, pass))
        };
        let go_on = |_: Progress<'_>| ControlFlow::Continue(());
        let (_, Ok(())) = render_passes(options, &mut film, pass, go_on);
        film
    }

    /// How long building took in all, and the bytes of all hierarchies.
    pub fn built(&self) -> (Duration, usize) {
        let built = self.hierarchies.iter().filter_map(OnceLock::get);
        built.fold((Duration::ZERO, 0), |(time, bytes), (bvh, took)| {
            (time + *took, bytes + bvh.memory_bytes())
        })
    }

    fn later(&self, pose: usize) -> Option<&'a ChangedData> {
        let (_, motion) = self.moments.as_ref()?;
        Some(&motion.later[pose.checked_sub(1)?])
    }
}
