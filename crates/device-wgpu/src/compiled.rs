//! Kernels of either mapping, compiled.

use residual_wgsl::{KernelTexts, Mapping};

use crate::error::Error;
use crate::gpu::Gpu;
use crate::launch::Settings;
use crate::megakernel::Megakernel;
use crate::shader::Mode;
use crate::stages::StageSeconds;
use crate::state::{Header, Launched, Shown, State};
use crate::wavefront::{VERTICES, Wavefront};

/// Kernels of either mapping, of paths that begin at one end.
pub(crate) enum Compiled {
    Wavefront(Wavefront),
    Megakernel(Megakernel),
}

impl Compiled {
    /// Compiles them.
    ///
    /// # Errors
    /// If a kernel is refused.
    pub(crate) fn new(
        gpu: &Gpu,
        mode: Mode,
        mapping: Mapping,
        kernels: KernelTexts<'_>,
        state: &State,
    ) -> Result<Self, Error> {
        Ok(match mapping {
            Mapping::Wavefront => Self::Wavefront(Wavefront::new(gpu, mode, kernels, state)?),
            Mapping::Megakernel => Self::Megakernel(Megakernel::new(gpu, mode, kernels, state)?),
        })
    }

    /// Runs them on `settings.count` paths, whose samples or splats, of so many bytes, come back through one of the staging buffers.
    /// `meanwhile` gets what has come back before.
    ///
    /// # Errors
    /// If the device fails.
    pub(crate) fn launch(
        &self,
        gpu: &Gpu,
        state: Shown<'_>,
        settings: &Settings,
        returns: (usize, u64),
        seconds: &mut StageSeconds,
        meanwhile: impl FnMut(&Header, &[f32]),
    ) -> Result<Launched, Error> {
        match self {
            Self::Wavefront(kernels) => {
                kernels.launch(gpu, state, settings, returns, seconds, meanwhile)
            }
            Self::Megakernel(kernels) => Ok(kernels.launch(gpu, state, settings, returns)),
        }
    }

    /// Most splats of a light path between two looks at what there is.
    pub(crate) fn most_splats(&self, settings: &Settings) -> u32 {
        match self {
            // The shadow rays of the vertex before are among them.
            Self::Wavefront(_) => settings.max_depth.min(VERTICES) + 1,
            Self::Megakernel(_) => settings.max_depth,
        }
    }
}
