//! The device by itself: every sample of every pixel is taken once, however paths share a stream, and a render ends when
//! it is told to.

use std::ops::ControlFlow;

use residual_device_cpu::{CpuDevice, LaneCount, TileJob, TileRenderer};
use residual_render::film::{Pass, SampleSet, Sampling, TileRect, TileSamples};
use residual_render::passes::{Counters, RenderOptions};
use residual_render::tracer::{PathOrigin, TracerOptions};
use residual_scenegen::desc::{MaterialDesc, Projection, SceneDesc};
use residual_scenegen::plan::{Plan, PlanOptions, plan};
use residual_tests::fixtures::{self, Builder, color, material, matte, sheet};
use residual_tests::pictures::first_difference;
use residual_tests::{Look, Prepared};

/// Of the image; tiles lie somewhere in it.
const SIZE: [u32; 2] = [90, 80];

fn planned(scene: &SceneDesc) -> Plan {
    let options = PlanOptions {
        size: SIZE,
        ..PlanOptions::default()
    };
    plan(scene, &options).unwrap()
}

fn tile([x, y, width, height]: [u32; 4], [first, count]: [u32; 2]) -> TileSamples {
    TileSamples {
        rect: TileRect {
            x,
            y,
            width,
            height,
        },
        pass: Pass { first, count },
    }
}

fn job(tiles: &[TileSamples]) -> TileJob<'_> {
    TileJob {
        tiles,
        set: SampleSet::First,
        tracer: TracerOptions {
            image: SIZE,
            seed: 5,
            max_depth: 6,
            roulette_from: 3,
            reach: f32::MAX,
            origin: PathOrigin::Camera,
        },
    }
}

/// Renders a job by interpretation: its colours by sample, row and column.
fn colors(prepared: &Prepared<'_>, job: &TileJob<'_>) -> (Vec<[f32; 3]>, Counters) {
    let count = job.samples();
    // What was there before must not show.
    let mut radiance = vec![f32::NAN; 3 * count];
    let renderer = prepared.interpreter();
    let counters = renderer.render_tiles(&prepared.view(), job, &mut radiance);
    (radiance.as_chunks().0.to_vec(), counters)
}

/// A lamp that fills the picture.
fn lamp() -> SceneDesc {
    let mut b = Builder::new("lamp");
    let lamp = MaterialDesc {
        emission: color([1.0; 3]),
        ..material("lamp", matte([0.0; 3]))
    };
    b.add(
        lamp,
        [sheet([-9.0, -9.0, 0.0], [18.0, 0.0, 0.0], [0.0, 18.0, 0.0])],
    );
    let projection = Projection::Perspective { yfov: 0.75 };
    b.camera("front", [0.0, 0.0, 3.0], [0.0; 3], projection);
    b.finish()
}

/// Each is of colour 1: one left out would be black, one taken twice too bright.
#[test]
fn every_sample_of_every_pixel_is_taken_once() {
    // Without anything in it, a scene is under a white sky.
    for scene in [lamp(), SceneDesc::default()] {
        let plan = planned(&scene);
        for lanes in LaneCount::ALL {
            let prepared = Prepared::new(&plan, lanes);
            for [width, height] in [[1, 1], [3, 5], [17, 9], [64, 64]] {
                for samples in [1, 5] {
                    let tile = tile([13, 7, width, height], [3, samples]);
                    let tiles = [tile, tile];
                    let mut job = job(&tiles);
                    job.tracer.max_depth = 1;
                    let (colors, counters) = colors(&prepared, &job);
                    let what = format!("{} with {lanes} lanes: {job:?}", scene.name);
                    assert_eq!(
                        colors.iter().position(|rgb| *rgb != [1.0; 3]),
                        None,
                        "{what}"
                    );
                    assert_eq!(counters.camera_rays, colors.len() as u64, "{what}");
                    assert_eq!(
                        (counters.bounce_rays, counters.shadow_rays),
                        (0, 0),
                        "{what}"
                    );
                }
            }
        }
    }
}

/// A stream that is filled up again as paths end holds the same paths as one that is not.
#[test]
fn jobs_longer_than_a_stream_are_those_of_their_parts() {
    let plan = planned(&fixtures::room());
    let tiles = [tile([13, 7, 64, 64], [2, 4])];
    let whole = job(&tiles);
    let scalar = Prepared::new(&plan, LaneCount::One);
    let mut expected = vec![[f32::NAN; 3]; whole.samples()];
    for sample in 0..4 {
        for (x, y) in (0..16).map(|part| (part % 4 * 16, part / 4 * 16)) {
            let tiles = [tile([13 + x, 7 + y, 16, 16], [2 + sample, 1])];
            let (colors, _) = colors(&scalar, &job(&tiles));
            for (row, colors) in (y..).zip(colors.chunks(16)) {
                let at = ((sample * 64 + row) * 64 + x) as usize;
                expected[at..at + colors.len()].copy_from_slice(colors);
            }
        }
    }
    for lanes in LaneCount::ALL {
        let (colors, _) = colors(&Prepared::new(&plan, lanes), &whole);
        assert_eq!(first_difference(&expected, &colors), None, "{lanes} lanes");
    }
}

/// S-10 in whole renders: the mean of many adaptive images is that of many others; and none depends on threads.
#[test]
fn adaptive_renders_repeat_and_are_right_on_average() {
    let plan = planned(&fixtures::room());
    let prepared = Prepared::new(&plan, LaneCount::native());
    let look = |sampling, seed, threads| Look {
        sampling,
        seed,
        threads,
        ..Look::new(SIZE, 64)
    };
    let one = prepared.interpret(&look(Sampling::Adaptive, 0, 1));
    let three = prepared.interpret(&look(Sampling::Adaptive, 0, 3));
    assert_eq!(first_difference(&one.image(), &three.image()), None);
    assert_eq!((one.error(), one.samples()), (three.error(), 64));
    let counts = one.tiles().iter().map(|tile| tile.samples());
    assert!(counts.clone().max() > counts.min(), "samples are spread");

    let means = |sampling, first| -> Vec<f64> {
        let seeds = first..first + 24;
        let mean = |seed| prepared.interpret(&look(sampling, seed, 2)).mean()[1];
        seeds.map(mean).collect()
    };
    let [adaptive, uniform] =
        [means(Sampling::Adaptive, 1), means(Sampling::Uniform, 101)].map(|means| {
            let count = means.len() as f64;
            let mean = means.iter().sum::<f64>() / count;
            let squares: f64 = means.iter().map(|m| (m - mean).powi(2)).sum();
            (mean, squares / (count - 1.0) / count)
        });
    let error = (adaptive.1 + uniform.1).sqrt();
    assert!(error < 0.01 * uniform.0, "{error}");
    assert!((adaptive.0 - uniform.0).abs() < 3.0 * error);
}

#[test]
fn a_render_that_is_told_to_stop_ends_after_the_pass() {
    let plan = planned(&fixtures::room());
    let prepared = Prepared::new(&plan, LaneCount::native());
    let renderer = prepared.interpreter();
    let device = CpuDevice::new(2).unwrap();
    let options = RenderOptions {
        size: SIZE,
        samples: Some(1_000_000),
        time: None,
        max_depth: 8,
        seed: 0,
        ..RenderOptions::default()
    };
    for passes in [1, 3] {
        let mut told = Vec::new();
        let (film, report) = device.render(
            || &renderer,
            &prepared.view(),
            &options,
            |progress| {
                told.push(progress.samples);
                if told.len() < passes {
                    ControlFlow::Continue(())
                } else {
                    ControlFlow::Break(())
                }
            },
        );
        assert_eq!(told.len(), passes);
        let samples = told[passes - 1];
        assert_eq!(film.samples(), u64::from(samples));
        let pixels = u64::from(SIZE[0] * SIZE[1]);
        // One pixel in each block of 4 x 4 is sampled twice.
        let twice = u64::from(SIZE[0] / 4 * (SIZE[1] / 4));
        let camera_rays = (pixels + twice) * u64::from(samples);
        assert_eq!(report.counters.camera_rays, camera_rays);
        let expected = prepared.interpret(&Look::new(SIZE, samples));
        assert_eq!(first_difference(&expected.image(), &film.image()), None);
        assert_eq!(film.error(), expected.error());
    }
}
