//! `cargo xtask compare`: how far an image is from a reference.

pub(crate) mod args;
mod crop;
mod json;
mod limits;
mod pictures;
mod report;

use std::path::Path;
use std::process::ExitCode;

use anyhow::{Result, bail};
use residual_accuracy::comparison::{Comparison, DynamicRange, Image, Pair, ZScores};
use residual_frontend::input::{self, Encoding, ReadImage};

use args::CompareArgs;
use crop::Crop;
use residual_frontend::{note, out};

/// Status 0 if no limit is exceeded, 1 if one is, 2 if the images could not be compared.
pub(crate) fn run(args: &CompareArgs) -> ExitCode {
    compare(args).unwrap_or_else(|error| {
        note!("error: {error:#}");
        ExitCode::from(2)
    })
}

fn compare(args: &CompareArgs) -> Result<ExitCode> {
    pictures::check(&args.pictures)?;
    let reference = read(&args.reference, args.crop)?;
    let test = read(&args.test, args.crop)?;
    let pair = Pair::new(image(&reference), image(&test))?;
    let range = match (reference.encoding, test.encoding) {
        (Encoding::Linear, Encoding::Linear) => DynamicRange::High,
        _ => DynamicRange::Low,
    };
    check_needs(args, &pair, range)?;
    let comparison = Comparison::of(&pair, range);
    let limits = limits::limits(&args.limits, &comparison);
    let written = pictures::write_all(&args.pictures, &pair, &comparison)?;
    if args.json {
        out!("{}", json::object(&comparison, &limits));
    } else {
        out!("{}", description("reference", &args.reference, &reference));
        out!("{}", description("test", &args.test, &test));
        out!("{}", report::table(&comparison).trim_end());
        for line in written {
            out!("{line}");
        }
    }
    if let Some(note) = note(reference.encoding, test.encoding) {
        note!("note: {note}");
    }
    let mut status = ExitCode::SUCCESS;
    for limit in limits.iter().filter(|limit| limit.is_exceeded()) {
        note!(
            "error: {} is {:.4e}, above {:e} ({}); the worst tile is {} (relMSE {:.3e})",
            limit.metric,
            limit.value,
            limit.most,
            limit.option,
            report::place(&comparison.worst_tile),
            comparison.worst_tile.relmse
        );
        status = ExitCode::FAILURE;
    }
    Ok(status)
}

fn read(path: &Path, crop: Option<Crop>) -> Result<ReadImage> {
    let image = input::read(path)?;
    match crop {
        Some(crop) => crop.of(image),
        None => Ok(image),
    }
}

fn image(read: &ReadImage) -> Image<'_> {
    let image = Image::new(&read.pixels, read.size[0]);
    match &read.standard_errors {
        Some(standard_errors) => image.with_standard_errors(standard_errors),
        None => image,
    }
}

/// Refuses what the images have no data for, before any work is done.
fn check_needs(args: &CompareArgs, pair: &Pair<'_>, range: DynamicRange) -> Result<()> {
    let (pictures, limits) = (&args.pictures, &args.limits);
    let asks = pictures.hdr_flip_map.is_some() || limits.max_hdr_flip.is_some();
    if asks && range == DynamicRange::Low {
        bail!(
            "HDR-FLIP needs images of radiance (.exr, .hdr): of one that is encoded for a screen there are no other exposures"
        );
    }
    let asks = pictures.z_map.is_some() || limits.max_z_fraction.is_some();
    if asks && let Err(missing) = ZScores::of(pair) {
        bail!(
            "z needs the noise of both images, and {missing}: the channels standard_error.R, .G and .B of an EXR"
        );
    }
    Ok(())
}

fn description(role: &str, path: &Path, image: &ReadImage) -> String {
    let [width, height] = image.size;
    let encoding = match image.encoding {
        Encoding::Linear => "radiance",
        Encoding::Srgb => "sRGB, decoded",
    };
    let noise = match image.standard_errors {
        Some(_) => ", with standard errors",
        None => "",
    };
    format!(
        "{role:<12} {}: {width} × {height}, {encoding}{noise}",
        path.display()
    )
}

/// What to know of images that are encoded for a screen.
fn note(reference: Encoding, test: Encoding) -> Option<&'static str> {
    match (reference, test) {
        (Encoding::Linear, Encoding::Linear) => None,
        (Encoding::Srgb, Encoding::Srgb) => Some(
            "both images are encoded for a screen: what was brighter than white is white in them, and errors there do not count",
        ),
        _ => Some(
            "one image is encoded for a screen and the other is not: what is brighter than white in the other counts as an error",
        ),
    }
}
