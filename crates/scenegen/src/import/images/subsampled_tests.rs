//! Pictures of luminance and chroma, written by hand: no crate writes them.

use std::io::Cursor;

use exr::math::Vec2;
use exr::meta::MetaData;
use exr::meta::attribute::IntegerBounds;

use super::luminance_chroma::to_rgb;
use super::openexr::{layout, texels};
use super::primaries::REC_709;

const WIDTH: usize = 8;
const HEIGHT: usize = 36;

/// A channel of floats: its name, pixels for each sample along both axes, and its samples by the place of the pixel.
type Channel = (&'static str, usize, fn(f32, f32) -> f32);

/// In order of their names, as the format wants.
const CHANNELS: [Channel; 4] = [
    ("A", 1, |x, _| x / 16.0),
    ("BY", 2, |x, y| 0.05 * x - 0.01 * y),
    ("RY", 2, |x, y| 0.1 * y - 0.02 * x),
    ("Y", 1, |x, y| 1.0 + x + 0.25 * y),
];

/// A file with the given number for its compression.
fn file(channels: &[Channel], compression: u8, [width, height]: [usize; 2]) -> Vec<u8> {
    let mut bytes = vec![0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0];
    let mut attribute = |name: &str, kind: &str, value: &[u8]| {
        bytes.extend([name.as_bytes(), &[0], kind.as_bytes(), &[0]].concat());
        bytes.extend((value.len() as u32).to_le_bytes());
        bytes.extend(value);
    };
    let numbers = |numbers: &[u32]| -> Vec<u8> {
        numbers
            .iter()
            .flat_map(|number| number.to_le_bytes())
            .collect()
    };
    let mut list = Vec::new();
    for &(name, sampling, _) in channels {
        list.extend([name.as_bytes(), &[0]].concat());
        list.extend(numbers(&[2, 0, sampling as u32, sampling as u32]));
    }
    list.push(0);
    attribute("channels", "chlist", &list);
    attribute("compression", "compression", &[compression]);
    let window = numbers(&[0, 0, width as u32 - 1, height as u32 - 1]);
    attribute("dataWindow", "box2i", &window);
    attribute("displayWindow", "box2i", &window);
    attribute("lineOrder", "lineOrder", &[0]);
    attribute("pixelAspectRatio", "float", &1.0_f32.to_le_bytes());
    attribute("screenWindowCenter", "v2f", &[0; 8]);
    attribute("screenWindowWidth", "float", &1.0_f32.to_le_bytes());
    bytes.push(0);

    let meta = MetaData::read_from_buffered(Cursor::new(&bytes), false).unwrap();
    let mut header = meta.headers[0].clone();
    let rows_each = header.compression.scan_lines_per_block();
    let mut blocks = Vec::new();
    for first_row in (0..height).step_by(rows_each) {
        let rows = rows_each.min(height - first_row);
        let mut samples = Vec::new();
        for y in first_row..first_row + rows {
            for &(_, sampling, value) in channels.iter().filter(|channel| y % channel.1 == 0) {
                let columns = (0..width).step_by(sampling);
                samples.extend(columns.flat_map(|x| value(x as f32, y as f32).to_ne_bytes()));
            }
        }
        header.channels.bytes_per_pixel = samples.len() / (width * rows);
        let section = IntegerBounds::new((0, first_row as i32), Vec2(width, rows));
        let compressed = match compression {
            // Not written by the crate where channels have fewer pixels.
            6 => samples,
            _ => header
                .compression
                .compress_image_section_to_le(&header, samples, section)
                .unwrap(),
        };
        blocks.push((first_row, compressed));
    }
    let mut offset = bytes.len() + 8 * blocks.len();
    for (_, block) in &blocks {
        bytes.extend((offset as u64).to_le_bytes());
        offset += 8 + block.len();
    }
    for (first_row, block) in blocks {
        bytes.extend((first_row as u32).to_le_bytes());
        bytes.extend((block.len() as u32).to_le_bytes());
        bytes.extend(block);
    }
    bytes
}

fn decode(bytes: &[u8]) -> Result<Vec<[f32; 4]>, String> {
    let layout = layout(bytes)?;
    assert!(layout.remarks.is_empty(), "{:?}", layout.remarks);
    texels(bytes, &layout)
}

/// What linear samples are at a pixel: between the last sample and the border, as there.
fn interpolated(value: fn(f32, f32) -> f32, sampling: usize, [x, y]: [usize; 2]) -> f32 {
    let last = |size: usize| size - sampling;
    value(x.min(last(WIDTH)) as f32, y.min(last(HEIGHT)) as f32)
}

fn check(channels: &[Channel], texels: &[[f32; 4]]) {
    let weights = REC_709.luminance_weights().unwrap();
    for (index, texel) in texels.iter().enumerate() {
        let place = [index % WIDTH, index / WIDTH];
        let [a, by, ry, y] =
            [0, 1, 2, 3].map(|k| interpolated(channels[k].2, channels[k].1, place));
        let [r, g, b] = to_rgb([ry, y, by], weights);
        let pairs = texel.iter().zip([r, g, b, a]);
        assert!(
            pairs
                .into_iter()
                .all(|(found, expected)| (found - expected).abs() < 1e-3),
            "{place:?}: {texel:?} {:?}",
            [r, g, b, a]
        );
    }
}

#[test]
fn luminance_and_chroma_are_colours() {
    // None, run lengths, ZIP of one line and of 16, PIZ.
    for compression in 0..5 {
        let texels = decode(&file(&CHANNELS, compression, [WIDTH, HEIGHT])).unwrap();
        assert_eq!(texels.len(), WIDTH * HEIGHT);
        check(&CHANNELS, &texels);
    }
}

#[test]
fn chroma_may_have_as_many_pixels_as_luminance() {
    let channels = CHANNELS.map(|(name, _, value)| (name, 1, value));
    let texels = decode(&file(&channels, 3, [WIDTH, HEIGHT])).unwrap();
    check(&channels, &texels);
}

#[test]
fn what_is_not_read_is_said() {
    let b44 = decode(&file(&CHANNELS, 6, [WIDTH, HEIGHT])).unwrap_err();
    assert!(
        b44.contains("B44") && b44.contains("luminance and chroma"),
        "{b44}"
    );
    let odd = decode(&file(&CHANNELS, 0, [7, 4])).unwrap_err();
    assert!(odd.contains("do not divide"), "{odd}");
}

#[test]
fn damaged_files_are_errors() {
    for compression in 0..5 {
        let whole = file(&CHANNELS, compression, [WIDTH, HEIGHT]);
        for length in (0..whole.len()).step_by(7) {
            let result = crate::import::guard::without_panic(|| decode(&whole[..length]));
            assert!(result.is_err(), "{compression} {length}");
        }
    }
}
