//! The same job gives the same bits; another seed gives another picture. Tiles and threads do not show.

use std::path::Path;
use std::process::Command;

use residual_device_cpu::LaneCount;
use residual_render::sampler::AnySampler;
use residual_scenegen::plan::{Plan, PlanOptions, plan};
use residual_tests::pictures::{first_difference, mean, read_exr};
use residual_tests::{Look, Prepared, fixtures};

const SIZE: [u32; 2] = [61, 43];

fn room(sampler: AnySampler) -> Plan {
    room_of_size(SIZE, sampler)
}

fn room_of_size(size: [u32; 2], sampler: AnySampler) -> Plan {
    plan(
        &fixtures::room(),
        &PlanOptions {
            size,
            sampler,
            ..PlanOptions::default()
        },
    )
    .unwrap()
}

#[test]
fn tiles_and_threads_do_not_show() {
    for sampler in [AnySampler::Sobol, AnySampler::Independent] {
        let plan = room(sampler);
        let prepared = Prepared::new(&plan, LaneCount::native());
        let look = Look::new(SIZE, 5);
        let expected = prepared.interpret(&look);
        for tile_size in [1, 7, 16, 43, 1000] {
            for threads in [1, 2, 3] {
                let film = prepared.interpret(&Look {
                    tile_size: Some(tile_size),
                    threads,
                    ..look
                });
                let difference = first_difference(&expected.image(), &film.image());
                assert_eq!(
                    difference, None,
                    "{sampler:?}, tiles of {tile_size}, {threads} threads"
                );
            }
        }
    }
}

/// Smaller than a tile, than a block of camera rays, than a vector.
#[test]
fn tiles_and_lanes_do_not_show_in_small_images() {
    for size in [[1, 1], [3, 5], [17, 9]] {
        let plan = room_of_size(size, AnySampler::Sobol);
        let look = Look::new(size, 5);
        let expected = Prepared::new(&plan, LaneCount::One).interpret(&look);
        for lanes in LaneCount::ALL {
            let prepared = Prepared::new(&plan, lanes);
            for tile_size in [1, 5, 64] {
                let film = prepared.interpret(&Look {
                    tile_size: Some(tile_size),
                    ..look
                });
                let difference = first_difference(&expected.image(), &film.image());
                let what = format!("{size:?}, {lanes} lanes, tiles of {tile_size}");
                assert_eq!(difference, None, "{what}");
                assert_eq!(expected.error(), film.error(), "{what}");
            }
        }
    }
}

#[test]
fn seeds_and_samplers_show_and_agree_in_the_mean() {
    let plan = room(AnySampler::Sobol);
    let prepared = Prepared::new(&plan, LaneCount::native());
    let look = Look::new(SIZE, 64);
    let expected = prepared.interpret(&look).image();
    let independent = room(AnySampler::Independent);
    let others = [
        prepared.interpret(&Look { seed: 1, ..look }),
        prepared.interpret(&Look {
            seed: u32::MAX,
            ..look
        }),
        Prepared::new(&independent, LaneCount::native()).interpret(&look),
    ];
    for other in &others {
        assert!(first_difference(&expected, &other.image()).is_some());
        let (a, b) = (mean(&expected), mean(&other.image()));
        for channel in 0..3 {
            assert!(
                (a[channel] / b[channel] - 1.0).abs() < 0.02,
                "{a:?} and {b:?}"
            );
        }
    }
}

/// Passes grow with the machine's speed; how samples are cut into passes must not show.
#[test]
fn the_first_samples_are_those_of_a_shorter_render() {
    let plan = room(AnySampler::Sobol);
    let prepared = Prepared::new(&plan, LaneCount::native());
    let [one, two] = [1, 2].map(|samples| prepared.interpret(&Look::new(SIZE, samples)).image());
    // Twice the mean of two, less the first, is the second; it must be a picture of its own.
    assert!(first_difference(&one, &two).is_some());
    let second = one
        .iter()
        .zip(&two)
        .flat_map(|(one, two)| [0, 1, 2].map(|k| 2.0 * two[k] - one[k]));
    assert!(second.into_iter().all(|c| c > -1e-4));
}

#[test]
fn the_same_command_writes_the_same_pixels() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("quad.obj");
    std::fs::write(
        &scene,
        "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n",
    )
    .unwrap();
    let render = |name: &str, more: &[&str]| {
        let output = folder.path().join(name);
        let status = Command::new(env!("CARGO_BIN_EXE_residual-tests"))
            .args([
                "render",
                "--quiet",
                "--size",
                "70x40",
                "--spp",
                "6",
                "--tier",
                "interpreted",
            ])
            .args(more)
            .args([Path::new("-o"), &output, &scene])
            .status()
            .unwrap();
        assert!(status.success());
        let (width, pixels) = read_exr(&output).unwrap();
        assert_eq!((width, pixels.len()), (70, 70 * 40));
        pixels
    };
    let first = render("a.exr", &[]);
    assert!(mean(&first)[0] > 0.1);
    for (name, more) in [
        ("b.exr", &[][..]),
        ("c.exr", &["--threads", "1"]),
        ("d.exr", &["--threads", "2"]),
    ] {
        assert_eq!(
            first_difference(&first, &render(name, more)),
            None,
            "{more:?}"
        );
    }
    assert!(first_difference(&first, &render("e.exr", &["--seed", "1"])).is_some());
}
