//! Radiance pictures (`.hdr`, `.pic`): all eight orientations, both kinds of run lengths, colours as RGB or XYZ, and the
//! factors of the header.
//!
//! The format is described in Radiance's `filefmts` and in Ward, "Real Pixels" (Graphics Gems II).

use glam::{DMat3, DVec3};

use super::primaries::{Primaries, REC_709};

/// A colour of the CIE as red, green and blue of Radiance's primaries, which everyone takes for those of displays; its
/// rows add up to 1.
const XYZ_TO_RGB: [[f64; 3]; 3] = [
    [2.565_312_84, -1.166_849_62, -0.398_463_23],
    [-1.022_108_17, 1.978_286_62, 0.043_821_56],
    [0.074_724_38, -0.251_939_57, 1.177_215_19],
];

/// Primaries that differ by less from those of displays are taken for them.
const PRIMARIES_TOLERANCE: f64 = 0.025;

/// The longest header that is looked at.
const MAX_HEADER: usize = 1 << 16;

/// Scanlines of other lengths are not compressed channel by channel.
const CHANNELWISE: std::ops::RangeInclusive<usize> = 8..=32767;

/// What lies before the pixels.
#[derive(Debug)]
pub(super) struct Header {
    /// Pixels per row.
    pub(super) width: u32,
    /// Rows.
    pub(super) height: u32,
    /// Scanlines are columns.
    is_columns: bool,
    /// Columns are stored from the right.
    from_right: bool,
    /// Rows are stored from the bottom.
    from_bottom: bool,
    is_xyz: bool,
    /// From red, green and blue of other primaries to those of displays.
    to_rec_709: Option<DMat3>,
    /// What the pixels have been multiplied with.
    factors: [f64; 3],
    /// Of the first pixel.
    first_byte: usize,
    /// What the header says and is not heeded.
    pub(super) remarks: Vec<String>,
}

/// What pictures begin with: programs write `#?RADIANCE`, `#?RGBE` and their own names.
const MAGIC: &[u8] = b"#?";

/// Whether a file is a Radiance picture. Some programs leave the first line out, but nothing else has a header that ends as
/// theirs.
pub(super) fn is_radiance(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC) || header(bytes).is_ok()
}

/// Reads the header.
pub(super) fn header(bytes: &[u8]) -> Result<Header, String> {
    let mut header = Header {
        width: 0,
        height: 0,
        is_columns: false,
        from_right: false,
        from_bottom: false,
        is_xyz: false,
        to_rec_709: None,
        factors: [1.0; 3],
        first_byte: 0,
        remarks: Vec::new(),
    };
    let mut lines = Lines { bytes, at: 0 };
    loop {
        let line = lines.next()?;
        if line.is_empty() {
            break;
        }
        if let Some((variable, value)) = line.split_once('=').filter(|_| !line.starts_with('#')) {
            header.set(variable.trim(), value.trim())?;
        }
    }
    let resolution = lines.next()?;
    header.set_resolution(&resolution).ok_or_else(|| {
        format!("has no size and orientation such as -Y 512 +X 1024, but {resolution:?}")
    })?;
    if !bytes.starts_with(MAGIC) {
        header
            .remarks
            .push("lacks its first line, #?RADIANCE; read nonetheless".into());
    }
    header.first_byte = lines.at;
    Ok(header)
}

struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Lines<'_> {
    /// The next line without its end.
    fn next(&mut self) -> Result<String, String> {
        let rest = &self.bytes[self.at..self.bytes.len().min(MAX_HEADER)];
        let end = rest.iter().position(|&byte| byte == b'\n');
        let end = end.ok_or("has a header that does not end")?;
        self.at += end + 1;
        let line = String::from_utf8_lossy(&rest[..end]);
        Ok(line.trim_end_matches('\r').to_owned())
    }
}

impl Header {
    fn set(&mut self, variable: &str, value: &str) -> Result<(), String> {
        let numbers = || -> Option<Vec<f64>> {
            let numbers: Vec<f64> = value
                .split_whitespace()
                .map(|word| word.parse().ok())
                .collect::<Option<_>>()?;
            let is_factor = |number: &f64| *number > 0.0 && number.is_finite();
            numbers.iter().all(is_factor).then_some(numbers)
        };
        match (variable, numbers().as_deref()) {
            ("FORMAT", _) => {
                self.is_xyz = match value {
                    "32-bit_rle_rgbe" => false,
                    "32-bit_rle_xyze" => true,
                    _ => return Err(format!("has the pixel format {value:?}, which is unknown")),
                }
            }
            // Each program that multiplies the pixels adds a line.
            ("EXPOSURE", Some(&[exposure])) => {
                self.factors = self.factors.map(|factor| factor * exposure);
            }
            ("COLORCORR", Some(&[red, green, blue])) => {
                let [r, g, b] = self.factors;
                self.factors = [r * red, g * green, b * blue];
            }
            ("EXPOSURE" | "COLORCORR", _) => {
                self.remarks
                    .push(format!("{variable} {value:?} is not positive; ignored"));
            }
            ("GAMMA", Some(&[1.0])) => {}
            ("PRIMARIES", _) => self.set_primaries(value),
            ("GAMMA", _) => {
                self.remarks
                    .push(format!("{variable} {value:?} is ignored"));
            }
            _ => {}
        }
        Ok(())
    }

    /// CIE xy of red, green, blue and white. Those of displays, and of Radiance, which differ little, change nothing, and
    /// zeros say nothing.
    fn set_primaries(&mut self, value: &str) {
        let numbers = value.split_whitespace().map(|word| word.parse().ok());
        let numbers: Vec<f64> = numbers.collect::<Option<_>>().unwrap_or_default();
        let primaries = match numbers.as_chunks() {
            (&[red, green, blue, white], []) => Primaries {
                red,
                green,
                blue,
                white,
            },
            _ => return self.ignore_primaries(value),
        };
        let is_silent = numbers.iter().all(|&number| number == 0.0);
        if is_silent || primaries.are_near(&REC_709, PRIMARIES_TOLERANCE) {
            return;
        }
        self.to_rec_709 = primaries.to_rec_709();
        if self.to_rec_709.is_none() {
            self.ignore_primaries(value);
        }
    }

    fn ignore_primaries(&mut self, value: &str) {
        self.remarks
            .push(format!("PRIMARIES {value:?} make no sense; ignored"));
    }

    /// `-Y height +X width` and its seven relatives: the first is the axis along which scanlines follow one another. Y
    /// grows upwards.
    fn set_resolution(&mut self, line: &str) -> Option<()> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [first_axis, first_size, second_axis, second_size] = words[..] else {
            return None;
        };
        let sizes = [first_size.parse().ok()?, second_size.parse().ok()?];
        let (x, y) = match (first_axis.get(1..)?, second_axis.get(1..)?) {
            ("Y", "X") => (1, 0),
            ("X", "Y") => (0, 1),
            _ => return None,
        };
        let is_negative = |axis: &str| match axis.as_bytes()[0] {
            b'-' => Some(true),
            b'+' => Some(false),
            _ => None,
        };
        let signs = [is_negative(first_axis)?, is_negative(second_axis)?];
        self.is_columns = x == 0;
        self.from_right = signs[x];
        self.from_bottom = !signs[y];
        (self.width, self.height) = (sizes[x], sizes[y]);
        Some(())
    }

    /// Index among the texels, whose first row is the top one, of an element of a scanline.
    fn index(&self, scanline: usize, element: usize) -> usize {
        let (width, height) = (self.width as usize, self.height as usize);
        let (x, y) = match self.is_columns {
            true => (scanline, element),
            false => (element, scanline),
        };
        let column = if self.from_right { width - 1 - x } else { x };
        let row = if self.from_bottom { height - 1 - y } else { y };
        row * width + column
    }

    /// The colour of a pixel.
    fn color(&self, scales: &[f64; 256], [r, g, b, exponent]: [u8; 4]) -> [f32; 4] {
        let stored = [r, g, b].map(|c| f64::from(c) * scales[usize::from(exponent)]);
        let rgb = match self.is_xyz {
            true => XYZ_TO_RGB.map(|row| (0..3).map(|k| row[k] * stored[k]).sum()),
            false => stored,
        };
        let rgb = [0, 1, 2].map(|k| rgb[k] / self.factors[k]);
        let rgb = match self.to_rec_709 {
            Some(to_rec_709) if !self.is_xyz => (to_rec_709 * DVec3::from(rgb)).to_array(),
            _ => rgb,
        };
        let [r, g, b] = rgb.map(|value| value as f32);
        [r, g, b, 1.0]
    }
}

/// Reads the pixels behind the header. Colours beyond Rec. 709 have negative components.
pub(super) fn texels(bytes: &[u8], header: &Header) -> Result<Vec<[f32; 4]>, String> {
    let scales: [f64; 256] = std::array::from_fn(|exponent| match exponent {
        0 => 0.0,
        _ => 2.0_f64.powi(exponent as i32 - 136),
    });
    let (scanlines, length) = match header.is_columns {
        true => (header.width as usize, header.height as usize),
        false => (header.height as usize, header.width as usize),
    };
    let mut texels = vec![[0.0; 4]; scanlines * length];
    let mut scanline = vec![[0; 4]; length];
    let mut data = Data(&bytes[header.first_byte..]);
    for k in 0..scanlines {
        data.read(&mut scanline)
            .ok_or_else(|| format!("is damaged or ends early, in scanline {k} of {scanlines}"))?;
        for (element, &pixel) in scanline.iter().enumerate() {
            texels[header.index(k, element)] = header.color(&scales, pixel);
        }
    }
    Ok(texels)
}

/// What is left of the pixels.
struct Data<'a>(&'a [u8]);

impl Data<'_> {
    fn byte(&mut self) -> Option<u8> {
        let (&first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(first)
    }

    fn pixel(&mut self) -> Option<[u8; 4]> {
        let (&first, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(first)
    }

    fn read(&mut self, scanline: &mut [[u8; 4]]) -> Option<()> {
        let length = scanline.len();
        let begins_with_length = matches!(self.0, [2, 2, high, low, ..]
            if usize::from(*high) << 8 | usize::from(*low) == length);
        if CHANNELWISE.contains(&length) && begins_with_length {
            self.pixel()?;
            (0..4).try_for_each(|channel| self.read_channel(scanline, channel))
        } else {
            self.read_pixels(scanline)
        }
    }

    /// Runs of one channel.
    fn read_channel(&mut self, scanline: &mut [[u8; 4]], channel: usize) -> Option<()> {
        let mut at = 0;
        while at < scanline.len() {
            let code = usize::from(self.byte()?);
            let (count, repeated) = match code {
                0 => return None,
                1..=128 => (code, None),
                _ => (code - 128, Some(self.byte()?)),
            };
            for pixel in scanline.get_mut(at..at + count)? {
                pixel[channel] = match repeated {
                    Some(value) => value,
                    None => self.byte()?,
                };
            }
            at += count;
        }
        Some(())
    }

    /// Pixels one by one, or as runs of the one before: (1, 1, 1, count), whose counts are digits of a base of 256 where
    /// several follow one another.
    fn read_pixels(&mut self, scanline: &mut [[u8; 4]]) -> Option<()> {
        let (mut at, mut shift) = (0, 0);
        while at < scanline.len() {
            match self.pixel()? {
                [1, 1, 1, count] => {
                    let count = usize::from(count).checked_shl(shift)?;
                    let before = *scanline.get(at.checked_sub(1)?)?;
                    scanline.get_mut(at..at.checked_add(count)?)?.fill(before);
                    at += count;
                    // More digits than that are no count.
                    shift = (shift + 8).min(32);
                }
                pixel => {
                    scanline[at] = pixel;
                    at += 1;
                    shift = 0;
                }
            }
        }
        Some(())
    }
}
