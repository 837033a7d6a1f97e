//! Adapters, and the device that one of them gives.

use std::fmt;
use std::sync::{Arc, Mutex};

use wgpu::{Adapter, Backends, DeviceType, Features, Limits};

use crate::error::Error;

/// Storage buffers that a stage binds.
const STORAGE_BUFFERS: u32 = 8;

/// What an adapter is.
#[derive(Clone, Debug)]
pub struct AdapterDescription {
    /// Its name.
    pub name: String,
    /// The interface through which it is reached.
    pub backend: String,
    /// Its kind: discrete, integrated, software.
    pub kind: &'static str,
    /// Its driver, with version.
    pub driver: String,
}

/// The kind of adapters that are drivers alone.
const SOFTWARE: &str = "software";

impl AdapterDescription {
    /// There is no GPU behind it.
    pub fn is_software(&self) -> bool {
        self.kind == SOFTWARE
    }
}

impl fmt::Display for AdapterDescription {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            name,
            backend,
            kind,
            driver,
        } = self;
        write!(f, "{name} ({kind}, {backend}, {driver})")
    }
}

/// A device that renders.
pub struct Gpu {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    /// What the adapter is.
    pub adapter: AdapterDescription,
    faults: Faults,
}

/// What went wrong outside of any error scope.
type Faults = Arc<Mutex<Option<String>>>;

fn instance() -> wgpu::Instance {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = Backends::PRIMARY;
    // Arguments of indirect dispatches are our own: checking them would cost a dispatch each.
    descriptor.flags = wgpu::InstanceFlags::empty();
    wgpu::Instance::new(descriptor)
}

fn adapters() -> Vec<Adapter> {
    let mut adapters = pollster::block_on(instance().enumerate_adapters(Backends::PRIMARY));
    // The sort is stable: drivers' order counts among equals.
    adapters.sort_by_key(|adapter| match adapter.get_info().device_type {
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::Cpu => 4,
    });
    adapters
}

fn describe(adapter: &Adapter) -> AdapterDescription {
    let info = adapter.get_info();
    AdapterDescription {
        name: info.name.clone(),
        backend: info.backend.to_string(),
        kind: match info.device_type {
            DeviceType::DiscreteGpu => "discrete",
            DeviceType::IntegratedGpu => "integrated",
            DeviceType::VirtualGpu => "virtual",
            DeviceType::Cpu => SOFTWARE,
            DeviceType::Other => "other",
        },
        driver: format!("{} {}", info.driver, info.driver_info)
            .trim()
            .to_owned(),
    }
}

/// The adapters of this machine, the one first that renders unless another is asked for.
pub fn list_adapters() -> Vec<AdapterDescription> {
    adapters().iter().map(describe).collect()
}

impl Gpu {
    /// The device of the adapter whose name contains `name`, whatever its case, or whose place in [`list_adapters`] it is; or
    /// of the first.
    ///
    /// # Errors
    /// If there is none, or it cannot do what rendering needs.
    pub fn open(name: Option<&str>) -> Result<Self, Error> {
        let adapters = adapters();
        let is_asked_for = |(index, adapter): &(usize, &Adapter)| {
            name.is_none_or(|name| {
                let known = adapter.get_info().name.to_lowercase();
                match name.parse::<usize>() {
                    Ok(place) => place == *index,
                    Err(_) => known.contains(&name.to_lowercase()),
                }
            })
        };
        let Some((_, adapter)) = adapters.iter().enumerate().find(is_asked_for) else {
            return Err(match name {
                Some(name) if !adapters.is_empty() => Error::NoSuchAdapter {
                    name: name.to_owned(),
                    known: adapters.iter().map(|a| a.get_info().name).collect(),
                },
                _ => Error::NoAdapter,
            });
        };
        Self::of(adapter)
    }

    fn of(adapter: &Adapter) -> Result<Self, Error> {
        let description = describe(adapter);
        let limits = adapter.limits();
        let unsuitable = |reason: String| Error::Unsuitable {
            adapter: description.name.clone(),
            reason,
        };
        if limits.max_storage_buffers_per_shader_stage < STORAGE_BUFFERS {
            let has = limits.max_storage_buffers_per_shader_stage;
            return Err(unsuitable(format!(
                "kernels read {STORAGE_BUFFERS} buffers, and it has {has}"
            )));
        }
        let wanted = Features::PASSTHROUGH_SHADERS
            | Features::SHADER_F64
            | Features::TIMESTAMP_QUERY
            | Features::TIMESTAMP_QUERY_INSIDE_PASSES;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("residual"),
            required_features: wanted & adapter.features(),
            required_limits: Limits {
                // Bindings end at 2³¹ − 1 bytes on every driver.
                max_storage_buffer_binding_size: limits
                    .max_storage_buffer_binding_size
                    .min((1 << 31) - 4),
                ..limits
            },
            experimental_features: crate::experimental::experimental_features(),
            memory_hints: wgpu::MemoryHints::Performance,
            trace: wgpu::Trace::Off,
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|error| unsuitable(error.to_string()))?;
        Ok(Self::from_device(device, queue, adapter))
    }

    /// A device that a program has opened for itself. Its handlers of errors and of loss become ours. What it was opened
    /// without is done without: exact arithmetic needs `PASSTHROUGH_SHADERS`.
    pub fn from_device(device: wgpu::Device, queue: wgpu::Queue, adapter: &Adapter) -> Self {
        let faults = Faults::default();
        let note = |faults: &Faults| {
            let faults = Arc::clone(faults);
            move |fault: String| {
                let mut faults = faults.lock().unwrap_or_else(|poison| poison.into_inner());
                faults.get_or_insert(fault);
            }
        };
        let (on_error, on_loss) = (note(&faults), note(&faults));
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            on_error(error.to_string());
        }));
        device.set_device_lost_callback(move |reason, message| {
            if reason != wgpu::DeviceLostReason::Destroyed {
                on_loss(format!("the device was lost: {message}"));
            }
        });
        Self {
            device,
            queue,
            adapter: describe(adapter),
            faults,
        }
    }

    pub(crate) fn has(&self, features: Features) -> bool {
        self.device.features().contains(features)
    }

    /// Whether kernels can be had with exact arithmetic.
    pub fn is_exact(&self) -> bool {
        self.has(Features::PASSTHROUGH_SHADERS)
    }

    /// An error if something has failed.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let faults = self
            .faults
            .lock()
            .unwrap_or_else(|poison| poison.into_inner());
        match &*faults {
            Some(fault) => Err(self.failed(fault.clone())),
            None => Ok(()),
        }
    }

    pub(crate) fn failed(&self, reason: String) -> Error {
        Error::Failed {
            adapter: self.adapter.name.clone(),
            reason,
        }
    }

    /// Waits until a submission is done, or all of them.
    pub(crate) fn wait_for(
        &self,
        submission_index: Option<wgpu::SubmissionIndex>,
    ) -> Result<(), Error> {
        let polled = self.device.poll(wgpu::PollType::Wait {
            submission_index,
            timeout: None,
        });
        polled.map_err(|error| self.failed(error.to_string()))?;
        self.check()
    }

    /// A buffer with these words, at least one row.
    pub(crate) fn upload(
        &self,
        label: &str,
        words: &[u32],
        usage: wgpu::BufferUsages,
    ) -> wgpu::Buffer {
        let bytes: &[u8] = bytemuck::cast_slice(words);
        let buffer = self.buffer(label, bytes.len() as u64, usage);
        self.queue.write_buffer(&buffer, 0, bytes);
        buffer
    }

    /// A buffer of zeros.
    pub(crate) fn buffer(
        &self,
        label: &str,
        bytes: u64,
        usage: wgpu::BufferUsages,
    ) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: bytes.max(16).next_multiple_of(16),
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    }

    /// Copies the first bytes of a buffer back.
    pub(crate) fn download(&self, buffer: &wgpu::Buffer, bytes: &mut [u8]) -> Result<(), Error> {
        let size = bytes.len() as u64;
        let staging = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("staging"),
            size,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, size);
        self.queue.submit([encoder.finish()]);
        let request = MapRequest::new(&staging, size);
        self.wait_for(None)?;
        bytes.copy_from_slice(&request.view(self, &staging)?);
        Ok(())
    }
}

/// The first bytes of a buffer on their way into memory.
pub(crate) struct MapRequest {
    bytes: u64,
    failure: Arc<Mutex<Option<wgpu::BufferAsyncError>>>,
}

impl MapRequest {
    /// Asks for them; they are there when what was submitted before is done.
    pub(crate) fn new(buffer: &wgpu::Buffer, bytes: u64) -> Self {
        let failure = Arc::new(Mutex::new(None));
        let answer = Arc::clone(&failure);
        buffer.map_async(wgpu::MapMode::Read, ..bytes, move |result| {
            if let Err(error) = result {
                *answer.lock().unwrap_or_else(|poison| poison.into_inner()) = Some(error);
            }
        });
        Self { bytes, failure }
    }

    /// The bytes, after waiting.
    pub(crate) fn view(&self, gpu: &Gpu, buffer: &wgpu::Buffer) -> Result<wgpu::BufferView, Error> {
        let failure = self.failure.lock();
        if let Some(error) = &*failure.unwrap_or_else(|poison| poison.into_inner()) {
            return Err(gpu.failed(error.to_string()));
        }
        let view = buffer.get_mapped_range(..self.bytes);
        view.map_err(|error| gpu.failed(error.to_string()))
    }
}
