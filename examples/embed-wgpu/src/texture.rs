//! The image as a texture of the program's device, and back.

use anyhow::Result;
use residual_device_wgpu::wgpu;
use residual_render::film::Film;

/// Bytes of a texel.
const TEXEL: u32 = 16;

/// A texture of linear red, green, blue and 1.
pub(crate) fn upload(device: &wgpu::Device, queue: &wgpu::Queue, film: &Film) -> wgpu::Texture {
    let size = wgpu::Extent3d {
        width: film.width(),
        height: film.height(),
        depth_or_array_layers: 1,
    };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("rendered"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_DST
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let image = film.image();
    let texels = image.iter().flat_map(|&[r, g, b]| [r, g, b, 1.0]);
    let bytes: Vec<u8> = texels.flat_map(f32::to_le_bytes).collect();
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(film.width() * TEXEL),
        rows_per_image: None,
    };
    queue.write_texture(texture.as_image_copy(), &bytes, layout, size);
    texture
}

/// The texels of such a texture, whose rows are whole multiples of 256 bytes.
pub(crate) fn download(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &wgpu::Texture,
) -> Result<Vec<[f32; 4]>> {
    let row = texture.width() * TEXEL;
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("texels"),
        size: u64::from(row) * u64::from(texture.height()),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(row),
        rows_per_image: None,
    };
    let to = wgpu::TexelCopyBufferInfo {
        buffer: &buffer,
        layout,
    };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), to, texture.size());
    queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |_| ());
    device.poll(wgpu::PollType::wait_indefinitely())?;
    let bytes = buffer.get_mapped_range(..)?;
    let words = bytes.as_chunks().0.iter();
    let numbers: Vec<f32> = words.map(|&word| f32::from_le_bytes(word)).collect();
    Ok(numbers.as_chunks().0.to_vec())
}
