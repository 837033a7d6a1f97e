//! A scene on the device: its buffers, merged into as many as kernels bind.

use residual_bvh::Bvh;
use residual_render::domain::{Buffer, Buffers};
use residual_wgsl::Binding;
use wgpu::BufferUsages;

use crate::error::Error;
use crate::gpu::Gpu;
use crate::tree::Tree;

/// Words to which buffers are aligned in their binding: a row of four.
const ROW: usize = 4;

/// Buffers of a scene.
pub(crate) struct Scene {
    /// In the order of [`Binding::ALL`].
    pub(crate) bindings: [wgpu::Buffer; Binding::ALL.len()],
    /// Where each [`Buffer`] begins in its binding, in words.
    pub(crate) bases: wgpu::Buffer,
    /// The hierarchy.
    pub(crate) tree: wgpu::Buffer,
    /// The first row of its packets.
    pub(crate) first_packet: u32,
    /// Bytes in all of them that are its own.
    pub(crate) bytes: u64,
}

impl Scene {
    /// Copies a scene to the device. What is the same as in another pose of it, `first`, is not copied again: its textures.
    ///
    /// # Errors
    /// If it does not fit.
    pub(crate) fn new(
        gpu: &Gpu,
        data: &Buffers<'_>,
        bvh: &Bvh<4>,
        first: Option<&Self>,
    ) -> Result<Self, Error> {
        let tree = Tree::new(bvh)?;
        check_size(gpu, "the hierarchy", tree.words.len())?;
        let mut bases = [0; Buffer::COUNT];
        for (binding, what) in Binding::ALL.into_iter().zip([
            "the scene's geometry",
            "the scene's textures",
            "the scene's lights and parameters",
        ]) {
            let mut end = 0;
            for buffer in binding.buffers() {
                bases[buffer as usize] = end as u32;
                end += data.get(buffer).len().next_multiple_of(ROW);
            }
            check_size(gpu, what, end)?;
        }
        let bindings = Binding::ALL.map(|binding| match (first, binding) {
            (Some(first), Binding::Texels) => first.bindings[binding as usize].clone(),
            _ => merged(gpu, data, binding, &bases),
        });
        let bases = gpu.upload("bases", &bases, BufferUsages::UNIFORM);
        let first_packet = tree.first_packet;
        let tree = gpu.upload("tree", &tree.words, BufferUsages::STORAGE);
        let is_own = |binding: &Binding| first.is_none() || *binding != Binding::Texels;
        let own = Binding::ALL.into_iter().filter(is_own);
        let own = own.map(|binding| bindings[binding as usize].size());
        let bytes = own.sum::<u64>() + tree.size();
        gpu.check()?;
        Ok(Self {
            bindings,
            bases,
            tree,
            first_packet,
            bytes,
        })
    }
}

fn check_size(gpu: &Gpu, what: &'static str, words: usize) -> Result<(), Error> {
    let limits = gpu.device.limits();
    let limit = limits
        .max_storage_buffer_binding_size
        .min(limits.max_buffer_size);
    let bytes = 4 * words as u64;
    if bytes <= limit {
        return Ok(());
    }
    Err(Error::TooLarge {
        adapter: gpu.adapter.name.clone(),
        what,
        bytes,
        limit,
    })
}

/// The buffers of one binding, one behind the other.
fn merged(
    gpu: &Gpu,
    data: &Buffers<'_>,
    binding: Binding,
    bases: &[u32; Buffer::COUNT],
) -> wgpu::Buffer {
    let words = |buffer: Buffer| data.get(buffer).len().next_multiple_of(ROW);
    let words: usize = binding.buffers().map(words).sum();
    let label = format!("{binding:?}").to_lowercase();
    let merged = gpu.buffer(&label, 4 * words as u64, BufferUsages::STORAGE);
    for buffer in binding.buffers() {
        let first = 4 * u64::from(bases[buffer as usize]);
        let bytes = bytemuck::cast_slice(data.get(buffer));
        gpu.queue.write_buffer(&merged, first, bytes);
    }
    merged
}
