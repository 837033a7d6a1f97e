//! Pictures of where images differ.

use std::path::Path;

use anyhow::Result;
use residual_accuracy::color_map::{diverging, magma};
use residual_accuracy::comparison::{
    Comparison, Pair, absolute_difference, relative_luminance_difference, shown_range,
};
use residual_accuracy::flip::FlipMap;
use residual_frontend::output;
use residual_frontend::pictures::{Picture, write};

use super::args::PictureArgs;

/// At how many standard errors the colours of a z-map end.
const Z_RANGE: f64 = 4.0;

/// Refuses names that no picture could be written under, before any work is done.
///
/// # Errors
/// If one cannot be.
pub(super) fn check(args: &PictureArgs) -> Result<()> {
    let paths = [
        &args.difference,
        &args.absolute_difference,
        &args.flip_map,
        &args.hdr_flip_map,
        &args.z_map,
    ];
    paths
        .into_iter()
        .flatten()
        .try_for_each(|path| output::check(path))
}

/// Writes the pictures that are asked for, and says what each shows.
///
/// # Errors
/// If one cannot be written.
pub(super) fn write_all(
    args: &PictureArgs,
    pair: &Pair<'_>,
    comparison: &Comparison,
) -> Result<Vec<String>> {
    let size = pair.size();
    let mut written = Vec::new();
    let mut add = |path: &Path, picture: Picture, what: String| -> Result<()> {
        write(path, &picture)?;
        written.push(format!("{}: {what}", path.display()));
        Ok(())
    };
    if let Some(path) = &args.difference {
        let differences = relative_luminance_difference(pair);
        let range = shown_range(&differences);
        let picture = of_numbers(size, &differences, |value| diverging(value / range));
        let what = format!(
            "difference of luminance, red where the test is brighter, blue where it is darker, ±{} %",
            100.0 * range
        );
        add(path, picture, what)?;
    }
    if let Some(path) = &args.absolute_difference {
        let differences = absolute_difference(pair);
        let range = shown_range(&differences);
        let picture = of_numbers(size, &differences, |value| magma(value / range));
        add(
            path,
            picture,
            format!("absolute difference, black 0 to light yellow {range}"),
        )?;
    }
    if let Some(path) = &args.flip_map {
        add(
            path,
            of_flip(size, &comparison.flip),
            "FLIP, black 0 to light yellow 1".to_owned(),
        )?;
    }
    if let (Some(path), Some(hdr)) = (&args.hdr_flip_map, &comparison.hdr_flip) {
        add(
            path,
            of_flip(size, &hdr.map),
            "HDR-FLIP, black 0 to light yellow 1".to_owned(),
        )?;
    }
    if let (Some(path), Some(z)) = (&args.z_map, &comparison.z_scores) {
        let farthest = z.farthest();
        let colors = farthest.iter().map(|z| diverging(z / Z_RANGE)).collect();
        let channel = |k: usize| z.scores().iter().map(|scores| scores[k] as f32).collect();
        let picture = Picture {
            size,
            colors,
            channels: vec![("R", channel(0)), ("G", channel(1)), ("B", channel(2))],
            comment: None,
        };
        let what = format!(
            "difference over its standard error, of the channel farthest from 0, blue −{Z_RANGE} to red {Z_RANGE}"
        );
        add(path, picture, what)?;
    }
    Ok(written)
}

fn of_numbers(size: [usize; 2], values: &[f64], color: impl Fn(f64) -> [u8; 3]) -> Picture {
    Picture {
        size,
        colors: values.iter().map(|&value| color(value)).collect(),
        channels: vec![("Y", values.iter().map(|&value| value as f32).collect())],
        comment: None,
    }
}

fn of_flip(size: [usize; 2], map: &FlipMap) -> Picture {
    of_numbers(size, map.values(), magma)
}
