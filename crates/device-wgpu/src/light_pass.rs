//! Paths from lights: what they bring to an image comes back as a list.

use std::time::Instant;

use residual_render::film::{Pass, Splats};
use residual_render::passes::Counters;

use crate::compiled::Compiled;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::launch::Settings;
use crate::stages::StageSeconds;
use crate::state::{Header, SPLAT, Shown};

/// Paths have this many splats on average, or fewer, between two looks at what there is; where they have more, the first launch is in vain.
const LIKELY: u32 = 2;

/// Some of a pass's paths.
#[derive(Clone, Copy)]
struct Part {
    first_sample: u32,
    first: u32,
    count: u32,
}

/// What a pass of light paths needs.
pub(crate) struct LightPass<'a> {
    pub(crate) gpu: &'a Gpu,
    pub(crate) kernels: &'a Compiled,
    pub(crate) state: Shown<'a>,
    /// Of all paths.
    pub(crate) settings: Settings,
    /// Most paths under way.
    pub(crate) slots: u32,
}

impl LightPass<'_> {
    /// What as many light paths bring as the pass has samples in an image of this size.
    ///
    /// # Errors
    /// If the device fails.
    pub(crate) fn splats(
        &self,
        pass: Pass,
        size: [u32; 2],
        counters: &mut Counters,
        seconds: &mut StageSeconds,
    ) -> Result<Splats, Error> {
        let mut splats = Splats::new(size, pass.count);
        let mut film_seconds = 0.0;
        let paths = u64::from(size[0]) * u64::from(size[1]) * u64::from(pass.count);
        let most = self.kernels.most_splats(&self.settings);
        let mut per_path = LIKELY.min(most);
        let mut first = 0;
        while first < paths {
            let fitting = (self.state.splats_that_fit() / u64::from(per_path)) as u32;
            let left = (paths - first).min(u64::from(self.slots)) as u32;
            let part = Part {
                first_sample: pass.first,
                first: first as u32,
                count: left.min(fitting.max(1)),
            };
            match self.launch(part, per_path, counters, seconds)? {
                Some(list) => {
                    let start = Instant::now();
                    splats.add(&list);
                    film_seconds += start.elapsed().as_secs_f64();
                    first += u64::from(part.count);
                }
                // Once more, fewer at a time. That of all of them there is room for.
                None => per_path = (2 * per_path).min(most),
            }
        }
        counters.camera_rays += paths;
        counters.film += film_seconds;
        Ok(splats)
    }

    /// Runs some paths, so that no driver compiles later.
    ///
    /// # Errors
    /// If the device fails.
    pub(crate) fn warm_up(&self, seconds: &mut StageSeconds) -> Result<(), Error> {
        let part = Part {
            first_sample: 0,
            first: 0,
            count: 1,
        };
        let most = self.kernels.most_splats(&self.settings);
        let mut counters = Counters::default();
        self.launch(part, most, &mut counters, seconds)?;
        Ok(())
    }

    /// Launches paths, waits for them, and returns their splats; `None` if these are more than so many a path, and not all there.
    fn launch(
        &self,
        part: Part,
        per_path: u32,
        counters: &mut Counters,
        seconds: &mut StageSeconds,
    ) -> Result<Option<Vec<f32>>, Error> {
        let Self {
            gpu,
            kernels,
            state,
            ..
        } = *self;
        let settings = self.settings.of(part.first_sample, part.first, part.count);
        let room = u64::from(part.count) * u64::from(per_path);
        let room = room.min(state.splats_that_fit()) as usize;
        let mut list = Vec::new();
        let mut is_whole = true;
        let mut found = |header: &Header, values: &[f32]| {
            let count = header.splats as usize;
            is_whole &= count <= room;
            list.extend_from_slice(&values[..SPLAT * count.min(room)]);
        };
        let returns = (0, 4 * (SPLAT * room) as u64);
        let launched = kernels.launch(gpu, state, &settings, returns, seconds, &mut found)?;
        let did = state.collect(gpu, &launched, seconds, &mut found)?;
        if !is_whole {
            return Ok(None);
        }
        counters.splats += (list.len() / SPLAT) as u64;
        counters.bounce_rays += u64::from(did.bounce_rays);
        counters.shadow_rays += u64::from(did.shadow_rays);
        Ok(Some(list))
    }
}
