//! OpenEXR pictures of which some channels have fewer pixels than others, as those of luminance and chroma do. The `exr`
//! crate decompresses their blocks and reads no pixels of them.

use std::io::Cursor;

use exr::compression::Compression;
use exr::math::Vec2;
use exr::meta::attribute::{ChannelDescription, IntegerBounds, SampleType};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use exr::prelude::f16;

use super::unreadable::unreadable;

/// The samples of one channel.
struct Plane {
    /// Pixels for each sample.
    sampling: Vec2<usize>,
    /// Samples of a row.
    width: usize,
    /// None of channels that nobody asks for.
    samples: Vec<f32>,
}

impl Plane {
    fn new(channel: &ChannelDescription, size: Vec2<usize>, names: &[&str]) -> Self {
        let Vec2(width, height) = channel.subsampled_resolution(size);
        let is_used = names.contains(&&*channel.name.to_string());
        Self {
            sampling: channel.sampling,
            width,
            samples: vec![0.0; if is_used { width * height } else { 0 }],
        }
    }

    /// The value at a pixel. Samples are at the first pixel of those that they are for; in between, they are
    /// interpolated.
    fn at(&self, x: usize, y: usize) -> f32 {
        let sample = |column: usize, row: usize| {
            let row = row.min(self.samples.len() / self.width - 1);
            self.samples[row * self.width + column.min(self.width - 1)]
        };
        let (column, u) = split(x, self.sampling.x());
        let (row, v) = split(y, self.sampling.y());
        let along = |row: usize| match u {
            0.0 => sample(column, row),
            _ => (1.0 - u) * sample(column, row) + u * sample(column + 1, row),
        };
        match v {
            0.0 => along(row),
            _ => (1.0 - v) * along(row) + v * along(row + 1),
        }
    }
}

/// Which sample is at a pixel or before it, and how far the pixel is on the way to the next.
fn split(pixel: usize, sampling: usize) -> (usize, f32) {
    (
        pixel / sampling,
        (pixel % sampling) as f32 / sampling as f32,
    )
}

/// Whether a picture has such channels.
pub(super) fn is_subsampled(header: &Header) -> bool {
    let mut channels = header.channels.list.iter();
    channels.any(|channel| channel.sampling != Vec2(1, 1))
}

/// Calls `set` with the place of each pixel in the data window and the values of the named channels there.
pub(super) fn for_each_pixel<const N: usize>(
    bytes: &[u8],
    names: [&str; N],
    mut set: impl FnMut(usize, usize, [f32; N]),
) -> Result<(), String> {
    let mut file = Cursor::new(bytes);
    let meta = MetaData::read_from_buffered(&mut file, false).map_err(unreadable)?;
    let [header] = &meta.headers[..] else {
        return Err("has several parts and channels of fewer pixels than others".into());
    };
    if header.deep || header.blocks != BlockDescription::ScanLines {
        return Err("has tiles and channels of fewer pixels than others".into());
    }
    // The crate takes blocks of fewer pixels for longer than they are.
    if matches!(header.compression, Compression::B44 | Compression::B44A) {
        let problem = "is compressed by B44 and has channels of fewer pixels than others, as luminance and chroma have; \
                       another compression is read";
        return Err(problem.into());
    }
    let size = header.layer_size;
    let position = header.own_attributes.layer_position;
    let divides = |channel: &ChannelDescription| {
        let [x, y] = [channel.sampling.x(), channel.sampling.y()].map(|sampling| sampling as i64);
        let is_whole = |length: i64, sampling: i64| sampling > 0 && length % sampling == 0;
        is_whole(size.x() as i64, x)
            && is_whole(size.y() as i64, y)
            && is_whole(position.x().into(), x)
            && is_whole(position.y().into(), y)
    };
    if !header.channels.list.iter().all(divides) {
        return Err(
            "has channels of fewer pixels than others, whose numbers do not divide theirs".into(),
        );
    }
    let mut planes: Vec<Plane> = header
        .channels
        .list
        .iter()
        .map(|channel| Plane::new(channel, size, &names))
        .collect();
    // Behind the header are the places of the blocks.
    let table = bytes.get(file.position() as usize..).unwrap_or(&[]);
    let offsets = table.as_chunks().0.get(..header.chunk_count);
    for offset in offsets.ok_or("is damaged or ends early")? {
        let offset = usize::try_from(u64::from_le_bytes(*offset)).unwrap_or(usize::MAX);
        read_block(bytes.get(offset..).unwrap_or(&[]), header, &mut planes)
            .ok_or("is damaged or ends early")??;
    }
    let index = |name: &str| {
        let mut channels = header.channels.list.iter();
        channels.position(|channel| channel.name.to_string() == name)
    };
    let used = names.map(index);
    for y in 0..size.y() {
        for x in 0..size.x() {
            // Of these only alpha may be missing.
            set(
                x,
                y,
                used.map(|index| index.map_or(1.0, |index| planes[index].at(x, y))),
            );
        }
    }
    Ok(())
}

/// Reads the block that begins with these bytes; `None` where there are too few.
fn read_block(bytes: &[u8], header: &Header, planes: &mut [Plane]) -> Option<Result<(), String>> {
    let (first_row, rest) = bytes.split_first_chunk()?;
    let (length, rest) = rest.split_first_chunk()?;
    let length = usize::try_from(i32::from_le_bytes(*length)).ok()?;
    let compressed = rest.get(..length)?.to_vec();
    let top = header.own_attributes.layer_position.y();
    let first_row =
        usize::try_from(i64::from(i32::from_le_bytes(*first_row)) - i64::from(top)).ok()?;
    let rows_left = header
        .layer_size
        .y()
        .checked_sub(first_row)
        .filter(|&left| left > 0)?;
    let rows = rows_left.min(header.compression.scan_lines_per_block());
    let position = Vec2(
        header.own_attributes.layer_position.x(),
        top.checked_add(i32::try_from(first_row).ok()?)?,
    );
    let section = IntegerBounds::new(position, Vec2(header.layer_size.x(), rows));
    let lines: Vec<(usize, usize)> = (first_row..first_row + rows)
        .flat_map(|row| (0..planes.len()).map(move |plane| (row, plane)))
        .filter(|&(row, plane)| row % planes[plane].sampling.y() == 0)
        .collect();
    let sample_types: Vec<SampleType> = header
        .channels
        .list
        .iter()
        .map(|channel| channel.sample_type)
        .collect();
    let byte_count: usize = lines
        .iter()
        .map(|&(_, plane)| planes[plane].width * sample_types[plane].bytes_per_sample())
        .sum();
    // What the crate takes for the size of a block is the number of its pixels times this.
    let mut header = header.clone();
    if !byte_count.is_multiple_of(section.size.area()) {
        return Some(Err(
            "has channels of fewer pixels than others in an unusual number".into(),
        ));
    }
    header.channels.bytes_per_pixel = byte_count / section.size.area();
    let decompressed = header
        .compression
        .decompress_image_section_from_le(&header, compressed, section, false);
    let decompressed = match decompressed {
        Ok(bytes) => bytes,
        Err(error) => return Some(Err(unreadable(error))),
    };
    let mut rest = &decompressed[..];
    for (row, plane) in lines {
        let Plane {
            sampling,
            width,
            samples,
        } = &mut planes[plane];
        let sample_type = sample_types[plane];
        let (line, after) = rest.split_at_checked(*width * sample_type.bytes_per_sample())?;
        rest = after;
        let start = row / sampling.y() * *width;
        let samples = samples.get_mut(start..start + *width).unwrap_or(&mut []);
        for (sample, bytes) in samples
            .iter_mut()
            .zip(line.chunks(sample_type.bytes_per_sample()))
        {
            *sample = match (sample_type, bytes) {
                (SampleType::F16, &[a, b]) => f16::from_ne_bytes([a, b]).to_f32(),
                (SampleType::F32, &[a, b, c, d]) => f32::from_ne_bytes([a, b, c, d]),
                (SampleType::U32, &[a, b, c, d]) => u32::from_ne_bytes([a, b, c, d]) as f32,
                _ => return None,
            };
        }
    }
    Some(Ok(()))
}
