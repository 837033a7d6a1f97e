//! Kernels, loaded: with exact arithmetic where the adapter takes SPIR-V as it is, else as wgpu translates them.

use std::borrow::Cow;

use residual_wgsl::Arithmetic;
use wgpu::{PipelineLayout, ShaderModule, ShaderRuntimeChecks};

use crate::error::Error;
use crate::exact::{self, FloatControls};
use crate::gpu::Gpu;

/// How kernels reach the driver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// As SPIR-V without contraction: operations round as the processor's.
    Exact(FloatControls),
    /// As wgpu translates them: compilers may contract, reassociate, and assume that there is no NaN.
    Plain,
}

/// How kernels compute on an adapter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dialect {
    /// How they reach the driver.
    pub mode: Mode,
    /// How operations are spelled.
    pub arithmetic: Arithmetic,
}

fn module(gpu: &Gpu, mode: Mode, text: &str) -> Result<ShaderModule, String> {
    match mode {
        Mode::Exact(controls) => {
            let exact::Spirv {
                words,
                entry_points,
            } = exact::spirv(text, controls)?;
            let entry_points = entry_points.into_iter().map(|(name, [x, y, z])| {
                wgpu::PassthroughShaderEntryPoint {
                    name: name.into(),
                    workgroup_size: (x, y, z),
                }
            });
            let descriptor = wgpu::ShaderModuleDescriptorPassthrough {
                entry_points: entry_points.collect(),
                spirv: Some(Cow::Owned(words)),
                ..Default::default()
            };
            // SAFETY: the words are naga's translation of a text that it has validated, with decorations that only take
            // freedom from compilers. Reads and writes are in range: of a scene's buffers, since a renderer on the
            // processor that counts reads out of range finds none, and of the device's own, since slots and queues are as
            // long as the launch that their kernels check. Loops end: they walk a tree or count to a bound.
            Ok(unsafe { gpu.device.create_shader_module_passthrough(descriptor) })
        }
        Mode::Plain => {
            let descriptor = wgpu::ShaderModuleDescriptor {
                label: None,
                source: wgpu::ShaderSource::Wgsl(Cow::Borrowed(text)),
            };
            let checks = ShaderRuntimeChecks::unchecked();
            // SAFETY: as above.
            Ok(unsafe { gpu.device.create_shader_module_trusted(descriptor, checks) })
        }
    }
}

/// The pipeline of an entry point.
///
/// # Errors
/// If naga, wgpu or the driver refuses it.
pub(crate) fn pipeline(
    gpu: &Gpu,
    mode: Mode,
    layout: &PipelineLayout,
    text: &str,
    entry_point: &str,
) -> Result<wgpu::ComputePipeline, Error> {
    let refused = |reason: String| Error::Kernel {
        kernel: entry_point.to_owned(),
        adapter: gpu.adapter.name.clone(),
        reason,
    };
    // Errors of creation come out of scopes; without one, wgpu would panic.
    let scopes = [wgpu::ErrorFilter::Validation, wgpu::ErrorFilter::Internal]
        .map(|filter| gpu.device.push_error_scope(filter));
    let module = module(gpu, mode, text);
    let pipeline = module.map(|module| {
        gpu.device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry_point),
                layout: Some(layout),
                module: &module,
                entry_point: Some(entry_point),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &[],
                    zero_initialize_workgroup_memory: false,
                },
                cache: None,
            })
    });
    let mut errors = Vec::new();
    for scope in scopes.into_iter().rev() {
        errors.extend(pollster::block_on(scope.pop()));
    }
    match errors.first() {
        Some(error) => Err(refused(error.to_string())),
        None => pipeline.map_err(refused),
    }
}
