//! Our renderer as a contender.

use std::ops::ControlFlow;

use anyhow::Result;
use residual_device_cpu::{CpuDevice, SceneView, TileRenderer};
use residual_frontend::process_time;
use residual_render::film::Sampling;
use residual_render::passes::RenderOptions;

use super::contender::{Contender, Label, Rendered};

/// Our renderer, of one tier and sampler. What it does beside rendering is in its time, as in every render: the second samples of
/// some pixels, and the estimate of the error that is made of them.
pub struct Residual<'a> {
    /// `interpreted` or `specialized`.
    pub tier: &'static str,
    /// `sobol` or `independent`.
    pub sampler: &'static str,
    /// How samples are spread over the image.
    pub sampling: Sampling,
    /// Threads.
    pub device: &'a CpuDevice,
    /// What renders tiles.
    pub renderer: &'a dyn TileRenderer,
    /// The scene with its hierarchy.
    pub view: SceneView<'a>,
    /// Width and height.
    pub size: [u32; 2],
    /// Most vertices of a path.
    pub max_depth: u32,
}

impl Residual<'_> {
    /// What it is called.
    pub const NAME: &'static str = "Residual";
}

impl Contender for Residual<'_> {
    fn label(&self) -> Label {
        Label {
            renderer: Self::NAME.to_owned(),
            variant: self.tier.to_owned(),
            sampler: match self.sampling {
                Sampling::Uniform => self.sampler.to_owned(),
                Sampling::Adaptive => format!("{}, {}", self.sampler, self.sampling),
            },
        }
    }

    fn render(&mut self, samples: u32, seed: u32) -> Result<Rendered> {
        let options = RenderOptions {
            size: self.size,
            samples: Some(samples),
            sampling: self.sampling,
            max_depth: self.max_depth,
            seed,
            ..RenderOptions::default()
        };
        let before = process_time();
        let go_on = |_: residual_render::passes::Progress<'_>| ControlFlow::Continue(());
        let (film, _) = self
            .device
            .render(|| self.renderer, &self.view, &options, go_on);
        let cpu_s = (process_time() - before).as_secs_f64();
        Ok(Rendered {
            image: film.image(),
            samples,
            cpu_s,
        })
    }
}
