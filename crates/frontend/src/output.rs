//! Image files. A file is written beside its place, synced, and renamed: there is never half an image.

use std::io::{Cursor, Write as _};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use exr::prelude::*;
use residual_accuracy::{ErrorEstimate, Interval};
use residual_render::film::Film;
use residual_render::layer::Layers;
use residual_render::texture::srgb_code;

/// What is written beside the pixels.
pub struct Metadata {
    /// Name of the scene.
    pub scene: String,
    /// Samples a pixel.
    pub samples: u64,
    /// Time of rendering.
    pub seconds: f64,
    /// The error of these samples.
    pub error: Option<ErrorEstimate>,
}

/// Formats that are written.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Format {
    Png,
    Exr,
}

impl Format {
    /// By the extension of a file's name, in either case.
    pub(crate) fn of(path: &Path) -> Result<Self> {
        let extension = path.extension().unwrap_or_default().to_string_lossy();
        match extension.to_ascii_lowercase().as_str() {
            "png" => Ok(Self::Png),
            "exr" => Ok(Self::Exr),
            _ => bail!("{}: images are written as .png or .exr", path.display()),
        }
    }
}

/// Refuses file names that [`write()`] would refuse, before any work is done.
///
/// # Errors
/// If the format is none of ours, or the directory does not exist or cannot be written to.
pub fn check(path: &Path) -> Result<()> {
    Format::of(path)?;
    check_place(path)
}

/// Refuses layers that no file could hold.
///
/// # Errors
/// If there are layers, and none of the files is an EXR.
pub fn check_layers(paths: &[PathBuf], layers: Layers) -> Result<()> {
    if layers != Layers::NONE
        && !paths
            .iter()
            .any(|path| matches!(Format::of(path), Ok(Format::Exr)))
    {
        let names: Vec<_> = layers.iter().map(|layer| layer.name()).collect();
        bail!(
            "only an EXR holds layers ({}); add one with -o image.exr",
            names.join(", ")
        );
    }
    Ok(())
}

/// Refuses places where no file can be written.
///
/// # Errors
/// If there is a directory of this name, or its own does not exist or cannot be written to.
pub fn check_place(path: &Path) -> Result<()> {
    let directory = directory(path);
    if !directory.is_dir() {
        bail!(
            "{}: the directory {} does not exist",
            path.display(),
            directory.display()
        );
    }
    if path.is_dir() {
        bail!(
            "{}: is a directory; give the name of a file",
            path.display()
        );
    }
    // Made and removed again: nothing else says for sure whether the directory can be written to.
    tempfile::NamedTempFile::new_in(directory).with_context(|| {
        format!(
            "{}: the directory {} cannot be written to",
            path.display(),
            directory.display()
        )
    })?;
    Ok(())
}

fn directory(path: &Path) -> &Path {
    path.parent()
        .filter(|parent| !parent.as_os_str().is_empty())
        .unwrap_or(Path::new("."))
}

/// Writes the film as a PNG (sRGB) or an EXR (linear).
///
/// # Errors
/// If the file cannot be written.
pub fn write(path: &Path, film: &Film, metadata: &Metadata) -> Result<()> {
    let bytes = match Format::of(path)? {
        Format::Png => png(film)?,
        Format::Exr => open_exr(film, metadata)?,
    };
    write_atomically(path, &bytes)
}

/// Writes a file by way of a temporary one beside it.
///
/// # Errors
/// If it cannot be written; what was there before stays.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<()> {
    write_with_mode(path, bytes, 0o644)
}

/// Writes a program in the same way.
///
/// # Errors
/// If it cannot be written; what was there before stays.
pub fn write_executable(path: &Path, bytes: &[u8]) -> Result<()> {
    write_with_mode(path, bytes, 0o755)
}

fn write_with_mode(path: &Path, bytes: &[u8], mode: u32) -> Result<()> {
    let write = || -> std::io::Result<()> {
        let mut file = tempfile::NamedTempFile::new_in(directory(path))?;
        file.write_all(bytes)?;
        file.as_file().sync_all()?;
        // Temporary files are private; these are as readable as any new file.
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            file.as_file()
                .set_permissions(std::fs::Permissions::from_mode(mode))?;
        }
        #[cfg(not(unix))]
        let _ = mode;
        file.persist(path)?;
        Ok(())
    };
    write().with_context(|| format!("writing {}", path.display()))
}

/// From this share of white pixels on, a PNG says little.
const MUCH_WHITE: f64 = 0.5;

/// What a PNG of the film does not show, if that is much: photometric lights, in candela and lux, make pictures of
/// hundreds and thousands.
pub(crate) fn clipping(film: &Film) -> Option<String> {
    // Rounding of white is white.
    const WHITE: f32 = 1.01;
    let image = film.image();
    let is_clipped = |rgb: &&[f32; 3]| rgb.iter().all(|&value| value > WHITE);
    let share = image.iter().filter(is_clipped).count() as f64 / image.len() as f64;
    let [red, green, blue] = film.mean();
    (share >= MUCH_WHITE).then(|| {
        format!(
            "{:.0} % of the pixels are brighter than a display shows and white in the PNG (the mean is {:.3e}): are \
             the lights in candela and lux? An .exr keeps what there is",
            100.0 * share,
            (red + green + blue) / 3.0
        )
    })
}

fn png(film: &Film) -> Result<Vec<u8>> {
    let codes = film
        .image()
        .into_iter()
        .flat_map(|rgb| rgb.map(srgb_code))
        .collect();
    encode_png([film.width() as usize, film.height() as usize], codes)
}

/// Codes for red, green and blue, row by row, as a PNG of this width and height.
///
/// # Errors
/// If it cannot be encoded.
///
/// # Panics
/// If there are not as many codes as the size says.
pub fn encode_png([width, height]: [usize; 2], codes: Vec<u8>) -> Result<Vec<u8>> {
    let image = image::RgbImage::from_raw(width as u32, height as u32, codes)
        .expect("there are as many pixels as the size says");
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png)?;
    Ok(bytes.into_inner())
}

/// Radiance as `R`, `G`, `B`; each layer's channels behind its name and a dot, as compositors expect them.
fn open_exr(film: &Film, metadata: &Metadata) -> Result<Vec<u8>> {
    let size = (film.width() as usize, film.height() as usize);
    let image = film.image();
    let radiance = ["R", "G", "B"].into_iter().enumerate().map(|(k, name)| {
        let values = image.iter().map(|rgb| rgb[k]).collect();
        AnyChannel::new(name, FlatSamples::F32(values))
    });
    let mut channels: SmallVec<[_; 4]> = radiance.collect();
    for layer in film.layers().iter() {
        let values = film.layer(layer).expect("the film has its layers");
        for (channel, values) in layer.channels().iter().zip(values) {
            let name = format!("{layer}.{channel}");
            channels.push(AnyChannel::new(name.as_str(), FlatSamples::F32(values)));
        }
    }
    let mut attributes = LayerAttributes::named("");
    attributes.software_name = Text::new_or_none(concat!("Residual ", env!("CARGO_PKG_VERSION")));
    let mut comment = format!(
        "scene={} spp={} seconds={:.3}",
        metadata.scene, metadata.samples, metadata.seconds
    );
    if let Some(error) = metadata.error {
        let Interval { value, low, high } = error.relmse;
        comment.push_str(&format!(
            " relmse={value:.3e} relmse95={low:.3e}..{high:.3e}"
        ));
        if error.distrust.is_some() {
            comment.push_str(" untrustworthy");
        }
    }
    attributes.comments = Text::new_or_none(&comment);
    let channels = AnyChannels::sort(channels);
    let layer = exr::prelude::Layer::new(size, attributes, Encoding::SMALL_LOSSLESS, channels);
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer).write().to_buffered(&mut bytes)?;
    Ok(bytes.into_inner())
}

/// For tests of what was written.
#[cfg(test)]
mod tests {
    use super::*;
    use residual_render::layer::Layer;

    fn film() -> Film {
        let mut film = Film::new(3, 2, 64, Layers::NONE);
        film.tiles_mut()[0].add(&(0..18).map(|i| i as f32 / 17.0).collect::<Vec<_>>());
        film
    }

    #[test]
    fn files_read_back() {
        let directory = tempfile::tempdir().unwrap();
        let metadata = Metadata {
            scene: "s".into(),
            samples: 1,
            seconds: 1.0,
            error: None,
        };
        let png = directory.path().join("a.png");
        write(&png, &film(), &metadata).unwrap();
        let read = image::open(&png).unwrap().to_rgb8();
        assert_eq!(
            (read.dimensions(), read.get_pixel(2, 1).0),
            ((3, 2), [241, 248, 255])
        );
        let exr = directory.path().join("a.exr");
        write(&exr, &film(), &metadata).unwrap();
        let read = image_from_exr(&exr);
        assert_eq!(read, film().image());
    }

    #[test]
    fn white_pngs_are_told_of() {
        let film = |value: f32| {
            let mut film = Film::new(4, 1, 64, Layers::NONE);
            // One pixel of four is dark.
            let pixels: Vec<f32> = (0..12).map(|k| if k < 3 { 0.1 } else { value }).collect();
            film.tiles_mut()[0].add(&pixels);
            film
        };
        assert_eq!(clipping(&film(1.0)), None);
        let message = clipping(&film(2000.0)).unwrap();
        assert!(
            message.contains("75 %") && message.contains("1.500e3"),
            "{message}"
        );
        let mut coloured = Film::new(1, 1, 64, Layers::NONE);
        coloured.tiles_mut()[0].add(&[0.5, 9.0, 9.0]);
        assert_eq!(clipping(&coloured), None, "colours are no white");
    }

    fn image_from_exr(path: &Path) -> Vec<[f32; 3]> {
        let image = read_first_rgba_layer_from_file(
            path,
            |size, _| vec![[0.0; 3]; size.area()].into_boxed_slice().into_vec(),
            |pixels: &mut Vec<[f32; 3]>, at, (r, g, b, _): (f32, f32, f32, f32)| {
                pixels[at.y() * 3 + at.x()] = [r, g, b];
            },
        );
        image.unwrap().layer_data.channel_data.pixels
    }

    #[test]
    fn layers_are_channels_of_an_exr() {
        let layers = Layers::NONE.with(Layer::Albedo).with(Layer::Depth);
        let mut film = Film::new(2, 1, 64, layers);
        let samples: Vec<_> = (0..14).map(|i| i as f32).collect();
        film.tiles_mut()[0].add(&samples);
        let metadata = Metadata {
            scene: "s".into(),
            samples: 1,
            seconds: 1.0,
            error: None,
        };
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a.exr");
        write(&path, &film, &metadata).unwrap();
        let image = read_first_flat_layer_from_file(&path).unwrap();
        let channels: Vec<_> = image
            .layer_data
            .channel_data
            .list
            .iter()
            .map(|channel| {
                let values: Vec<_> = channel.sample_data.values_as_f32().collect();
                (channel.name.to_string(), values)
            })
            .collect();
        let expected = [
            ("B", [2.0, 9.0]),
            ("G", [1.0, 8.0]),
            ("R", [0.0, 7.0]),
            ("albedo.B", [5.0, 12.0]),
            ("albedo.G", [4.0, 11.0]),
            ("albedo.R", [3.0, 10.0]),
            ("depth.Z", [6.0, 13.0]),
        ];
        let expected = expected.map(|(name, values)| (name.to_owned(), values.to_vec()));
        assert_eq!(channels, expected);
    }

    #[test]
    fn a_failed_write_leaves_the_old_file() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("missing/a.png");
        assert!(check(&path).is_err() && write_atomically(&path, b"x").is_err());
        assert!(check(&directory.path().join("a.jpg")).is_err());
    }
}
