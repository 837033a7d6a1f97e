//! OpenEXR pictures: which of their parts, layers and channels is the picture, and where in it the pixels lie.

use std::io::Cursor;

use exr::meta::header::Header;
use exr::prelude::{ReadChannels, ReadLayers, ReadSpecificChannel};

use super::limits::{LARGEST_RADIANCE, MAX_EXTENT};
use super::primaries::{Primaries, REC_709};
use super::unreadable::unreadable;
use super::{luminance_chroma, subsampled};

/// Parts of the names of layers that hold what a camera has seen, in other words than that of the light in it.
const PICTURES: [&str; 6] = ["beauty", "combined", "rgba", "rgb", "color", "main"];

/// The largest finite number of 16 bits.
const LARGEST_HALF: f32 = 65504.0;

/// What is read of a file.
#[derive(Debug)]
pub(super) struct Layout {
    /// Pixels per row of the picture.
    pub(super) width: u32,
    /// Its rows.
    pub(super) height: u32,
    /// Of the first stored pixel in the picture.
    position: [i64; 2],
    channels: Channels,
    /// Some channels have fewer pixels than others.
    is_subsampled: bool,
    primaries: Primaries,
    /// What infinities become.
    pub(super) largest: f32,
    /// What had to be guessed.
    pub(super) remarks: Vec<String>,
}

/// Names of channels.
#[derive(Debug)]
struct Channels {
    color: Color,
    alpha: Option<String>,
}

#[derive(Debug)]
enum Color {
    Rgb([String; 3]),
    /// (red − luminance) / luminance, luminance, and the same of blue.
    LuminanceChroma([String; 3]),
    /// All three are the same.
    Gray(String),
}

/// Whether a file is an OpenEXR picture.
pub(super) fn is_openexr(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01])
}

/// Looks at what is in a file.
pub(super) fn layout(bytes: &[u8]) -> Result<Layout, String> {
    let meta = exr::meta::MetaData::read_from_buffered(Cursor::new(bytes), false);
    let headers = meta.map_err(unreadable)?.headers;
    let mut remarks = Vec::new();
    let (header, channels) = choose(&headers, &mut remarks)?;

    let data = header.layer_size;
    if data.width().max(data.height()) > MAX_EXTENT as usize {
        return Err(format!(
            "has {} × {} texels; 1 to {MAX_EXTENT} each way are read",
            data.width(),
            data.height()
        ));
    }
    let window = header.shared_attributes.display_window;
    let first = header.own_attributes.layer_position;
    let position = [
        i64::from(first.x()) - i64::from(window.position.x()),
        i64::from(first.y()) - i64::from(window.position.y()),
    ];
    let overlap = |axis: usize, shown: usize, stored: usize| {
        let (start, end) = (position[axis], position[axis] + stored as i64);
        start < shown as i64 && end > 0
    };
    let is_seen = overlap(0, window.size.width(), data.width())
        && overlap(1, window.size.height(), data.height());
    let (size, position) = if is_seen {
        (window.size, position)
    } else {
        remarks.push("none of its pixels are in the display window; the window is ignored".into());
        (data, [0; 2])
    };
    let extent = |size: usize| u32::try_from(size).map_err(|_| "is too large");
    let used = channels.names();
    let are_halves = |name: &str| {
        let mut channels = header.channels.list.iter();
        channels.any(|channel| {
            channel.name.to_string() == name
                && channel.sample_type == exr::meta::attribute::SampleType::F16
        })
    };
    Ok(Layout {
        width: extent(size.width())?,
        height: extent(size.height())?,
        position,
        largest: if used.iter().all(|name| are_halves(name)) {
            LARGEST_HALF
        } else {
            LARGEST_RADIANCE
        },
        channels,
        is_subsampled: subsampled::is_subsampled(header),
        primaries: primaries(header, &mut remarks),
        remarks,
    })
}

/// The primaries of colours; those of Rec. 709, as the format says, where a file gives none.
fn primaries(header: &Header, remarks: &mut Vec<String>) -> Primaries {
    let Some(given) = &header.shared_attributes.chromaticities else {
        return REC_709;
    };
    let [red, green, blue, white] =
        [given.red, given.green, given.blue, given.white].map(|xy| [xy.x(), xy.y()].map(f64::from));
    let primaries = Primaries {
        red,
        green,
        blue,
        white,
    };
    if primaries.to_rec_709().is_none() {
        remarks
            .push("has chromaticities that no primaries have; those of Rec. 709 are used".into());
        return REC_709;
    }
    primaries
}

impl Channels {
    fn names(&self) -> Vec<&str> {
        match &self.color {
            Color::Rgb(names) | Color::LuminanceChroma(names) => {
                names.iter().map(String::as_str).collect()
            }
            Color::Gray(name) => vec![name],
        }
    }
}

/// Channels of one layer: those whose names have the same beginning.
struct Layer<'a> {
    header: &'a Header,
    /// With the last dot; empty for channels that have none.
    prefix: String,
    /// The rest of each name, and the name.
    channels: Vec<(String, String)>,
}

impl Layer<'_> {
    fn find(&self, names: &[&str]) -> Option<String> {
        let mut channels = self.channels.iter();
        let is_named = |ending: &str| names.iter().any(|name| name.eq_ignore_ascii_case(ending));
        channels
            .find(|(ending, _)| is_named(ending))
            .map(|(_, name)| name.clone())
    }

    fn rgb(&self) -> Option<Color> {
        let [r, g, b] = [["r", "red"], ["g", "green"], ["b", "blue"]];
        Some(Color::Rgb([self.find(&r)?, self.find(&g)?, self.find(&b)?]))
    }

    fn luminance(&self) -> Option<Color> {
        let chroma = || {
            let names = [self.find(&["ry"])?, self.find(&["y"])?, self.find(&["by"])?];
            Some(Color::LuminanceChroma(names))
        };
        chroma().or_else(|| self.gray())
    }

    fn gray(&self) -> Option<Color> {
        self.find(&["y", "l", "luminance"]).map(Color::Gray)
    }

    fn named(&self, color: Color) -> Channels {
        let alpha = self.find(&["a", "alpha"]);
        Channels { color, alpha }
    }

    /// Of the part of the file or the layer.
    fn name(&self) -> String {
        let part = self.header.own_attributes.layer_name.as_ref();
        let part = part.map(ToString::to_string).unwrap_or_default();
        format!("{part} {}", self.prefix.trim_end_matches('.'))
            .trim()
            .to_owned()
    }

    fn is_picture(&self) -> bool {
        let name = self.name().to_lowercase();
        PICTURES.iter().any(|picture| name.contains(picture))
    }
}

/// The channels that are the picture: colours before luminance, those without a layer before those with one, pictures
/// before passes of light, and all of that in the order of the file.
fn choose<'a>(
    headers: &'a [Header],
    remarks: &mut Vec<String>,
) -> Result<(&'a Header, Channels), String> {
    let layers: Vec<Layer<'_>> = headers
        .iter()
        .filter(|header| !header.deep)
        .flat_map(layers)
        .collect();
    let in_order = |is_wanted: &dyn Fn(&Layer<'_>) -> bool| {
        let wanted = layers.iter().filter(|layer| is_wanted(layer));
        wanted.min_by_key(|layer| !layer.prefix.is_empty())
    };
    let found = in_order(&|layer| layer.rgb().is_some() && layer.prefix.is_empty())
        .or_else(|| in_order(&|layer| layer.luminance().is_some() && layer.prefix.is_empty()))
        .or_else(|| in_order(&|layer| layer.rgb().is_some() && layer.is_picture()))
        .or_else(|| in_order(&|layer| layer.rgb().is_some()))
        .or_else(|| in_order(&|layer| layer.luminance().is_some()));
    let (layer, color) = match found {
        Some(layer) => {
            let color = layer.rgb().or_else(|| layer.luminance());
            (layer, color.ok_or("has no colours")?)
        }
        // A lone channel is grey, whatever its name: a mask, a height, red.
        None => match &layers[..] {
            [layer] if layer.channels.len() == 1 => {
                let name = layer.channels[0].1.clone();
                remarks.push(format!("its only channel, {name}, is taken as grey"));
                (layer, Color::Gray(name))
            }
            _ => return Err(no_colors(headers)),
        },
    };
    let others = layers.iter().filter(|other| other.rgb().is_some()).count();
    if !layer.prefix.is_empty() || (headers.len() > 1 && others > 1) {
        remarks.push(format!("of its layers, \"{}\" is read", layer.name()));
    }
    Ok((layer.header, layer.named(color)))
}

fn layers(header: &Header) -> Vec<Layer<'_>> {
    let mut layers: Vec<Layer<'_>> = Vec::new();
    for channel in &header.channels.list {
        let name = channel.name.to_string();
        let dot = name.rfind('.').map_or(0, |dot| dot + 1);
        let (prefix, ending) = (name[..dot].to_owned(), name[dot..].to_owned());
        let known = layers.iter().position(|layer| layer.prefix == prefix);
        let index = known.unwrap_or_else(|| {
            layers.push(Layer {
                header,
                prefix,
                channels: Vec::new(),
            });
            layers.len() - 1
        });
        layers[index].channels.push((ending, name));
    }
    layers
}

fn no_colors(headers: &[Header]) -> String {
    if headers.iter().all(|header| header.deep) {
        return "has deep pixels only, which are not read".into();
    }
    let channels = headers.iter().flat_map(|header| &header.channels.list);
    let names: Vec<_> = channels
        .map(|channel| channel.name.to_string())
        .take(8)
        .collect();
    format!(
        "has neither red, green and blue nor luminance, but {}",
        names.join(", ")
    )
}

/// The picture.
struct Canvas {
    width: i64,
    height: i64,
    position: [i64; 2],
    texels: Vec<[f32; 4]>,
}

impl Canvas {
    fn set(&mut self, x: usize, y: usize, texel: [f32; 4]) {
        let (x, y) = (x as i64 + self.position[0], y as i64 + self.position[1]);
        if (0..self.width).contains(&x) && (0..self.height).contains(&y) {
            self.texels[(y * self.width + x) as usize] = texel;
        }
    }
}

/// Reads the pixels. What the file has none of is black, and there only if all that is there is.
pub(super) fn texels(bytes: &[u8], layout: &Layout) -> Result<Vec<[f32; 4]>, String> {
    let mut texels = stored_texels(bytes, layout)?;
    let primaries = layout.primaries;
    match layout.channels.color {
        Color::Gray(_) => return Ok(texels),
        Color::Rgb(_) => {}
        Color::LuminanceChroma(_) => {
            let weights = primaries.luminance_weights();
            let weights = weights.ok_or("has chromaticities without luminance")?;
            for [r, g, b, _] in &mut texels {
                [*r, *g, *b] = luminance_chroma::to_rgb([*r, *g, *b], weights);
            }
        }
    }
    if !primaries.are_rec_709() {
        primaries.convert(&mut texels, layout.largest);
    }
    Ok(texels)
}

/// The values of the channels, as they are in the file.
fn stored_texels(bytes: &[u8], layout: &Layout) -> Result<Vec<[f32; 4]>, String> {
    let alpha = layout.channels.alpha.as_deref();
    let outside = if alpha.is_some() { 0.0 } else { 1.0 };
    let canvas = || Canvas {
        width: layout.width.into(),
        height: layout.height.into(),
        position: layout.position,
        texels: vec![[0.0, 0.0, 0.0, outside]; layout.width as usize * layout.height as usize],
    };
    // A name that no channel has.
    let alpha = alpha.unwrap_or("no alpha");
    if layout.is_subsampled {
        let mut canvas = canvas();
        match &layout.channels.color {
            Color::Rgb([r, g, b]) | Color::LuminanceChroma([r, g, b]) => {
                subsampled::for_each_pixel(bytes, [r, g, b, alpha], |x, y, texel| {
                    canvas.set(x, y, texel);
                })?;
            }
            Color::Gray(name) => {
                subsampled::for_each_pixel(bytes, [name, alpha], |x, y, [g, a]| {
                    canvas.set(x, y, [g, g, g, a]);
                })?
            }
        }
        return Ok(canvas.texels);
    }
    let reader = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level();
    let canvas = match &layout.channels.color {
        Color::Rgb([r, g, b]) | Color::LuminanceChroma([r, g, b]) => {
            reader
                .specific_channels()
                .required(r.as_str())
                .required(g.as_str())
                .required(b.as_str())
                .optional(alpha, 1.0)
                .collect_pixels(
                    |_, _| canvas(),
                    |canvas, at, (r, g, b, a): (f32, f32, f32, f32)| {
                        canvas.set(at.x(), at.y(), [r, g, b, a]);
                    },
                )
                .first_valid_layer()
                .all_attributes()
                .non_parallel()
                .from_buffered(Cursor::new(bytes))
                .map_err(unreadable)?
                .layer_data
                .channel_data
                .pixels
        }
        Color::Gray(name) => {
            reader
                .specific_channels()
                .required(name.as_str())
                .optional(alpha, 1.0)
                .collect_pixels(
                    |_, _| canvas(),
                    |canvas, at, (y, a): (f32, f32)| canvas.set(at.x(), at.y(), [y, y, y, a]),
                )
                .first_valid_layer()
                .all_attributes()
                .non_parallel()
                .from_buffered(Cursor::new(bytes))
                .map_err(unreadable)?
                .layer_data
                .channel_data
                .pixels
        }
    };
    Ok(canvas.texels)
}
