//! What filtering textures does to the noise of a picture, and to nothing else.

use residual_device_cpu::LaneCount;
use residual_scenegen::desc::{ColorInput, Filter, ImageDesc, Projection, SceneDesc, Texels, Wrap};
use residual_scenegen::effects::{Effect, Effects};
use residual_scenegen::plan::{Plan, PlanOptions, TextureResolution, plan};
use residual_tests::fixtures::{Builder, material, matte, sheet};
use residual_tests::{Look, Prepared};

const SIZE: [u32; 2] = [160, 90];
/// The picture from the horizon down, in the rows of the picture: far, in the middle, near.
const BANDS: [std::ops::Range<usize>; 3] = [46..52, 52..62, 64..90];

/// A floor of 200 m, seen from 1.6 m above it, under a white sky: an image of 64 × 64 cells of random colours every 4 m, or their
/// mean.
fn floor(filter: Option<Filter>) -> SceneDesc {
    let mut b = Builder::new("floor");
    let mut cells: Vec<[u8; 4]> = Vec::new();
    let mut random = 12345_u32;
    for _ in 0..64 * 64 {
        let mut channel = || {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (random >> 24) as u8
        };
        cells.push([channel(), channel(), channel(), 255]);
    }
    let image = b.bytes(2, 2);
    let texture = filter.map(|filter| b.texture(image, [Wrap::Repeat; 2], filter));
    let mut mesh = sheet([-100.0, 0.0, 100.0], [200.0, 0.0, 0.0], [0.0, 0.0, -200.0]);
    for uv in mesh.uvs[0].iter_mut().flatten() {
        *uv *= 50.0;
    }
    let factor = [if filter.is_some() { 1.0 } else { 0.33 }; 3];
    let mut surface = matte([1.0; 3]);
    if let Some((_, residual_scenegen::desc_inputs::MaterialInput::Color(input))) =
        surface.inputs_mut().into_iter().next()
    {
        *input = ColorInput { factor, texture };
    }
    b.add(material("floor", surface), [mesh]);
    let lens = Projection::Perspective { yfov: 0.8 };
    b.camera("camera", [0.0, 1.6, 60.0], [0.0, 1.6, 0.0], lens);
    let mut scene = b.finish();
    scene.images[image] = ImageDesc {
        name: "cells".to_owned(),
        width: 64,
        height: 64,
        texels: Texels::Rgba8(cells),
    };
    scene
}

fn planned(scene: &SceneDesc, textures: TextureResolution) -> Plan {
    let options = PlanOptions {
        size: SIZE,
        textures,
        ..PlanOptions::default()
    };
    plan(scene, &options).unwrap()
}

fn render(plan: &Plan, samples: u32, seed: u32) -> Vec<[f32; 3]> {
    let look = Look {
        max_depth: 2,
        seed,
        ..Look::new(SIZE, samples)
    };
    Prepared::new(plan, LaneCount::native())
        .interpret(&look)
        .image()
}

/// Relative mean squared errors of 4 samples for each pixel, in the bands.
fn errors(plan: &Plan) -> [f64; 3] {
    let reference = render(plan, 512, 2);
    let image = render(plan, 4, 1);
    BANDS.map(|rows| {
        let pixels = rows.start * SIZE[0] as usize..rows.end * SIZE[0] as usize;
        let count = pixels.len() as f64 * 3.0;
        let pairs = image[pixels.clone()]
            .iter()
            .flatten()
            .zip(reference[pixels].iter().flatten());
        let errors = pairs.map(|(&a, &b)| (f64::from(a - b) / f64::from(b.max(1e-3))).powi(2));
        errors.sum::<f64>() / count
    })
}

/// Filtered, the floor is as little work as one of the texture's mean; unfiltered, several times as much.
#[test]
fn a_filtered_floor_has_the_noise_of_a_plain_one() {
    let textured = floor(Some(Filter::Mipmapped));
    let flat = errors(&planned(&floor(None), TextureResolution::Full));
    let full = errors(&planned(&textured, TextureResolution::Full));
    let filtered = errors(&planned(&textured, TextureResolution::Filtered));
    println!("flat {flat:?}\nfull {full:?}\nfiltered {filtered:?}");
    for band in 0..3 {
        assert!(
            filtered[band] < 2.0 * flat[band],
            "{band}: {filtered:?} {flat:?}"
        );
    }
    assert!(
        full[0] > 5.0 * filtered[0] && full[1] > 2.0 * filtered[1],
        "{full:?} {filtered:?}"
    );
}

/// The picture is as bright as without a filter: levels are means.
#[test]
fn filtering_keeps_the_mean() {
    let textured = floor(Some(Filter::Mipmapped));
    let mean = |textures| {
        let image = render(&planned(&textured, textures), 64, 3);
        let pixels = 46 * SIZE[0] as usize..image.len();
        residual_tests::pictures::mean(&image[pixels])
    };
    let (full, filtered) = (
        mean(TextureResolution::Full),
        mean(TextureResolution::Filtered),
    );
    for (full, filtered) in full.into_iter().zip(filtered) {
        assert!((filtered / full - 1.0).abs() < 5e-3, "{full} {filtered}");
    }
}

/// Where samplers ask for no mipmaps, and where nobody asks for filtering, plans are what they were.
#[test]
fn who_does_not_ask_pays_nothing() {
    let plain = |filter, textures| {
        let plan = planned(&floor(Some(filter)), textures);
        assert!(!Effects::of(&plan).has(Effect::Mipmaps));
        (format!("{:?}", plan.structure), plan.data.memory_bytes())
    };
    let before = plain(Filter::Linear, TextureResolution::Full);
    assert_eq!(plain(Filter::Linear, TextureResolution::Filtered), before);
    assert_eq!(plain(Filter::Mipmapped, TextureResolution::Full), before);
    let filtered = planned(&floor(Some(Filter::Mipmapped)), TextureResolution::Filtered);
    assert!(Effects::of(&filtered).has(Effect::Mipmaps));
    // A third more texels.
    let levels = filtered.data.memory_bytes() - before.1;
    assert!(
        (levels as f64 / (64.0 * 64.0 * 4.0) - 1.0 / 3.0).abs() < 0.03,
        "{levels}"
    );
}
