//! Edges that pass over pixels: how much of the time each pixel is covered is known.

use residual_device_cpu::{CpuDevice, Interpreter, Width};
use residual_driver::poses::Poses;
use residual_render::cryptomatte;
use residual_render::film::Sampling;
use residual_render::layer::Layer;
use residual_render::passes::RenderOptions;
use residual_render::shutter::Moments;
use residual_scenegen::plan::{PlanOptions, plan};
use serde_json::json;

use super::file::{File, options, turn};

/// As many as pixels in a row.
const MOMENTS: u32 = 16;
const WIDE: [u32; 2] = [MOMENTS, 4];

/// A square whose right edge passes over the image, from its left to its right.
fn passing() -> File {
    let mut file = File::orthographic(1.0, 0.25);
    let mesh = file.rectangle([-3.0, 0.0], [-3.0, 3.0], 0);
    let node = file.node(json!({ "name": "square", "mesh": mesh }));
    let keys: [&[f32]; 2] = [&[-1.0, 0.0, 0.0], &[1.0, 0.0, 0.0]];
    file.animate(node, "translation", "LINEAR", &keys);
    file
}

/// The part of the time during which the square covers the middle of a pixel of this column.
fn ramp(column: usize) -> f64 {
    1.0 - (column as f64 + 0.5) / f64::from(MOMENTS)
}

#[test]
fn an_edge_that_passes_leaves_a_ramp() {
    const SEEDS: u32 = 48;
    let mut sums = [0.0; MOMENTS as usize];
    for seed in 0..SEEDS {
        let film = passing().film(MOMENTS, &options(WIDE, 32, seed));
        for (pixel, [red, ..]) in film.image().into_iter().enumerate() {
            let column = pixel % MOMENTS as usize;
            let off = f64::from(red) - ramp(column);
            // The edge is in this column at one of the moments; at all others it covers all of the pixel or nothing.
            assert!(
                off.abs() <= 0.5 / f64::from(MOMENTS) + 1e-6,
                "seed {seed}, column {column}: {off}"
            );
            sums[column] += off / f64::from(WIDE[1]);
        }
    }
    for (column, sum) in sums.into_iter().enumerate() {
        // The deviation of one seed is that of a number between ±1/32.
        let off = sum / f64::from(SEEDS);
        let deviation = 1.0 / 16.0 / 12_f64.sqrt() / f64::from(SEEDS).sqrt();
        assert!(off.abs() < 4.5 * deviation, "column {column}: {off}");
    }
}

#[test]
fn every_stop_of_a_render_covers_the_time() {
    for samples in [2, 4, 8, 16, 24] {
        let film = passing().film(MOMENTS, &options(WIDE, samples, 3));
        let most = 1.0 / f64::from(samples.min(MOMENTS)) + 0.5 / f64::from(MOMENTS);
        for (pixel, [red, ..]) in film.image().into_iter().enumerate() {
            let off = f64::from(red) - ramp(pixel % MOMENTS as usize);
            assert!(off.abs() <= most, "{samples} samples: {off}");
        }
    }
}

#[test]
fn more_samples_where_it_is_noisy_cover_the_time_as_well() {
    let size = [4 * MOMENTS, 16];
    let film = passing().film(
        MOMENTS,
        &RenderOptions {
            sampling: Sampling::Adaptive,
            ..options(size, 64, 1)
        },
    );
    let shades: std::collections::BTreeSet<u32> =
        film.image().iter().map(|[red, ..]| red.to_bits()).collect();
    assert!(shades.len() > 20);
    for (pixel, [red, ..]) in film.image().into_iter().enumerate() {
        let place = (pixel % size[0] as usize) as f64 + 0.5;
        let off = f64::from(red) - (1.0 - place / f64::from(size[0]));
        assert!(off.abs() <= 1.0 / f64::from(MOMENTS), "{place}: {off}");
    }
}

#[test]
fn an_edge_that_turns_leaves_a_wedge() {
    let size = [24, 24];
    let mut file = File::orthographic(1.0, 1.0);
    let mesh = file.rectangle([-3.0, 3.0], [-3.0, 0.0], 0);
    let node = file.node(json!({ "mesh": mesh }));
    file.animate(node, "rotation", "LINEAR", &[&turn(0.0), &turn(90.0)]);
    let film = file.film(MOMENTS, &options(size, 64, 7));
    let mut shades = 0;
    for (pixel, [red, ..]) in film.image().into_iter().enumerate() {
        let [column, row] = [pixel % 24, pixel / 24].map(|k| k as f64);
        let (x, y) = ((column + 0.5) / 12.0 - 1.0, 1.0 - (row + 0.5) / 12.0);
        if y < 0.0 {
            continue;
        }
        // Degrees about the middle of the image; the edge comes by when it has turned as far.
        let angle = y.atan2(x).to_degrees();
        let covered = (1.0 - angle / 90.0).max(0.0);
        let of_pixel = f64::atan(0.5_f64.sqrt() / 12.0 / x.hypot(y)).to_degrees() / 90.0;
        let off = f64::from(red) - covered;
        assert!(
            off.abs() <= 1.0 / f64::from(MOMENTS) + of_pixel,
            "{x} {y}: {red} {covered}"
        );
        shades += usize::from((0.2..0.8).contains(&red));
    }
    assert!(shades > 50, "the edge turns");
}

#[test]
fn a_cryptomatte_holds_the_part_of_the_time() {
    let moments = Moments::new(MOMENTS, 0).unwrap();
    let plan_options = PlanOptions {
        size: WIDE,
        layers: [Layer::CryptoObject, Layer::Position].into_iter().collect(),
        ..PlanOptions::default()
    };
    let plan = plan(&passing().open(&moments), &plan_options).unwrap();
    let device = CpuDevice::new(1).unwrap();
    let interpreter = Interpreter::new(plan.structure.clone());
    let render = options(WIDE, 32, 0);
    let film = Poses::new(&plan, Width::Native, 0).render(&device, &interpreter, &render);
    let layer = film.layer(Layer::CryptoObject).unwrap();
    let square = cryptomatte::id("square");
    for (pixel, [red, ..]) in film.image().into_iter().enumerate() {
        let ranks = layer
            .chunks_exact(2)
            .map(|rank| [rank[0][pixel], rank[1][pixel]]);
        let covered: f32 = ranks
            .filter(|[id, _]| *id == square)
            .map(|[_, part]| part)
            .sum();
        assert!((covered - red).abs() < 1e-6, "{pixel}: {covered} {red}");
    }
}
