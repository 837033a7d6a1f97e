//! Paths from lights: what they bring to an image comes back as a list.

use std::time::Instant;

use residual_render::film::{Pass, Splats};
use residual_render::passes::Counters;

use crate::compiled::Compiled;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::launch::Settings;
use crate::stages::StageSeconds;
use crate::state::{Header, Shown};

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
        let mut add = |list: &[f32]| {
            let start = Instant::now();
            splats.add(list);
            film_seconds += start.elapsed().as_secs_f64();
        };
        let paths = u64::from(size[0]) * u64::from(size[1]) * u64::from(pass.count);
        let mut first = 0;
        while first < paths {
            let wanted = (paths - first).min(u64::from(self.slots)) as u32;
            let count = wanted.min(self.most_paths());
            self.launch(pass.first, first as u32, count, &mut add, counters, seconds)?;
            first += u64::from(count);
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
        let mut counters = Counters::default();
        self.launch(0, 0, 1, &mut |_| (), &mut counters, seconds)
    }

    /// So many that their splats fit where samples are kept otherwise.
    fn most_paths(&self) -> u32 {
        let most = self.kernels.most_splats(&self.settings);
        (self.state.splats_that_fit() / u64::from(most)).max(1) as u32
    }

    /// Launches paths, waits for them, and hands out their splats, some at a time.
    fn launch(
        &self,
        first_sample: u32,
        first: u32,
        count: u32,
        splats: &mut impl FnMut(&[f32]),
        counters: &mut Counters,
        seconds: &mut StageSeconds,
    ) -> Result<(), Error> {
        let Self {
            gpu,
            kernels,
            state,
            ..
        } = *self;
        let settings = self.settings.of(first_sample, first, count);
        let most = u64::from(count) * u64::from(kernels.most_splats(&settings));
        let returns = (0, state.bytes_of_splats(most));
        let mut found = |header: &Header, values: &[f32]| {
            counters.splats += u64::from(header.splats);
            splats(&values[..4 * header.splats as usize]);
        };
        let launched = kernels.launch(gpu, state, &settings, returns, seconds, &mut found)?;
        let did = state.collect(gpu, &launched, seconds, &mut found)?;
        counters.bounce_rays += u64::from(did.bounce_rays);
        counters.shadow_rays += u64::from(did.shadow_rays);
        Ok(())
    }
}
