//! Image files. A file is written beside its place, synced, and renamed: there is never half an image.

use std::io::{Cursor, Write as _};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use exr::prelude::*;
use residual_accuracy::{ErrorEstimate, Interval};
use residual_render::film::Film;
use residual_render::layer::Layers;

use crate::cryptomatte::Manifest;
use crate::display::Display;

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
    /// Of its Cryptomatte layers.
    pub manifests: Vec<Manifest>,
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

/// Writes the film as a PNG, as a display shows it, or as an EXR, linear.
///
/// # Errors
/// If the file cannot be written.
pub fn write(path: &Path, film: &Film, display: Display, metadata: &Metadata) -> Result<()> {
    let bytes = match Format::of(path)? {
        Format::Png => png(film, display)?,
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

fn png(film: &Film, display: Display) -> Result<Vec<u8>> {
    let codes = display.codes(&film.image()).into_flattened();
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
        for (name, values) in layer.channel_names().zip(values) {
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
    for (name, value) in metadata.manifests.iter().flat_map(Manifest::attributes) {
        // Cryptomatte has UTF-8 here, of which the library's checked constructors know nothing.
        let [name, value] =
            [name, value].map(|text| Text::from_bytes_unchecked(text.bytes().collect()));
        attributes.other.insert(name, AttributeValue::Text(value));
    }
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
            manifests: Vec::new(),
        };
        let png = directory.path().join("a.png");
        write(&png, &film(), Display::default(), &metadata).unwrap();
        let read = image::open(&png).unwrap().to_rgb8();
        assert_eq!(
            (read.dimensions(), read.get_pixel(2, 1).0),
            ((3, 2), [241, 248, 255])
        );
        let exr = directory.path().join("a.exr");
        write(&exr, &film(), Display::default(), &metadata).unwrap();
        let read = image_from_exr(&exr);
        assert_eq!(read, film().image());
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
            manifests: Vec::new(),
        };
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a.exr");
        write(&path, &film, Display::default(), &metadata).unwrap();
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
    fn cryptomattes_are_numbered_layers_with_a_manifest() {
        let layers = Layers::NONE.with(Layer::CryptoObject);
        let id = residual_render::cryptomatte::id("равнина");
        let mut film = Film::new(1, 1, 64, layers);
        film.tiles_mut()[0].add(&[0.0, 0.0, 0.0, id, 0.0, 0.0, 0.0, 0.0]);
        let manifest = Manifest {
            layer: Layer::CryptoObject,
            names: vec!["равнина".to_owned()],
        };
        let metadata = Metadata {
            scene: "s".into(),
            samples: 2,
            seconds: 1.0,
            error: None,
            manifests: vec![manifest.clone()],
        };
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a.exr");
        write(&path, &film, Display::default(), &metadata).unwrap();
        let image = read_first_flat_layer_from_file(&path).unwrap();
        for (name, value) in manifest.attributes() {
            let name = Text::new_or_panic(name);
            let found = &image.layer_data.attributes.other[&name];
            let AttributeValue::Text(found) = found else {
                panic!("{name}: {found:?}")
            };
            assert_eq!(std::str::from_utf8(found.as_slice()), Ok(&*value));
        }
        let channels = image.layer_data.channel_data.list.iter();
        let of_layer = channels.filter(|channel| channel.name.to_string().starts_with("crypto"));
        let found: Vec<_> = of_layer
            .map(|channel| {
                let value = channel.sample_data.values_as_f32().next().unwrap();
                (channel.name.to_string(), value)
            })
            .collect();
        let ids = ["00", "01", "02"].into_iter().flat_map(|number| {
            ["A", "B", "G", "R"].map(|channel| format!("crypto_object{number}.{channel}"))
        });
        let values = [0.5, id, 0.5, 0.0].into_iter().chain([0.0; 8]);
        // Equal parts are ranked by the bits of their ids; that of nothing is the smallest.
        let values = values.collect::<Vec<_>>();
        let expected: Vec<_> = ids.zip(values).collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn a_failed_write_leaves_the_old_file() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("missing/a.png");
        assert!(check(&path).is_err() && write_atomically(&path, b"x").is_err());
        assert!(check(&directory.path().join("a.jpg")).is_err());
    }
}
