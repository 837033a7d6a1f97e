//! Plain WGSL, whose operations compilers may contract and reassociate (G-07): the same samples, but for roundings and the few
//! paths that take another turn for one.

use residual_device_wgpu::{Dialect, Mapping, Mode};
use residual_render::film::{Film, Sampling};
use residual_scenegen::plan::PlanOptions;
use residual_tests::{Look, fixtures, read_scene, scenes, tiny};
use residual_wgsl::{Arithmetic, Division, Fma, SquareRoot};

use crate::machine;
use crate::subject::Subject;

const PLAIN: Dialect = Dialect {
    mode: Mode::Plain,
    arithmetic: Arithmetic {
        fma: Fma::Native,
        division: Division::Native,
        square_root: SquareRoot::Native,
    },
};

const LOOK: Look = Look {
    size: [48; 2],
    samples: 32,
    max_depth: 8,
    roulette_from: 2,
    seed: 0,
    threads: 2,
    reach: f32::MAX,
    sampling: Sampling::Uniform,
    tile_size: None,
};

/// The part of the pixels whose channels differ by more than a part of their value.
fn part_off(a: &Film, b: &Film, by: f32) -> f64 {
    let (a, b) = (a.image(), b.image());
    let is_off = |(a, b): &(&[f32; 3], &[f32; 3])| {
        let mut channels = a.iter().zip(*b);
        channels.any(|(x, y)| (x - y).abs() > by * x.max(*y))
    };
    a.iter().zip(&b).filter(is_off).count() as f64 / a.len() as f64
}

/// The luminance of an image, and its standard error, which pixels share evenly.
fn luminance(film: &Film) -> [f64; 2] {
    let [r, g, b] = film.mean();
    let mean = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    let pixels = f64::from(film.width()) * f64::from(film.height());
    let relmse = film.error().expect("samples").relmse.value;
    [mean, mean * (relmse / pixels).sqrt()]
}

/// The means of two films, apart, in standard errors of their difference.
fn distance(a: &Film, b: &Film) -> f64 {
    let ([a, error_a], [b, error_b]) = (luminance(a), luminance(b));
    (a - b).abs() / error_a.hypot(error_b)
}

fn check(subject: &Subject) {
    let Some(machine) = machine() else {
        return;
    };
    let cpu = subject.on_cpu(&LOOK);
    let renderer = subject.renderer(machine, PLAIN, Mapping::Wavefront, LOOK.size);
    let plain = |seed| {
        let look = Look { seed, ..LOOK };
        subject.passes(&renderer, &look, &[LOOK.samples])
    };
    let (same, other) = (plain(LOOK.seed), plain(LOOK.seed + 1));
    let name = &subject.plan.name;
    let roundings = part_off(&cpu, &same, 1e-4);
    let far = part_off(&cpu, &same, 0.1);
    let distances = [&same, &other].map(|film| distance(&cpu, film));
    println!(
        "{name}: more than roundings in {roundings:.4}, far off {far:.4}; means apart by {distances:?} σ"
    );
    assert_eq!(same.invalid_samples(), 0, "{name}");
    // Blended alpha is decided by a hash of the ray's bits, so that roundings are other random numbers.
    let has_alpha = subject.plan.data.alpha_tested.contains(&true);
    assert!(
        has_alpha || roundings < 0.2,
        "{name}: {roundings} of the pixels"
    );
    assert!(far < 0.02, "{name}: {far} of the pixels are far off");
    // The same samples are far closer than independent ones.
    assert!(distances[0] < 1.0, "{name}: {} σ", distances[0]);
    assert!(distances[1] < 4.0, "{name}: {} σ", distances[1]);
    // Other samples show that the measures can fail.
    assert!(part_off(&cpu, &other, 1e-4) > roundings.max(0.2), "{name}");
}

#[test]
fn plain_kernels_agree_with_the_processor() {
    let options = PlanOptions {
        size: LOOK.size,
        ..PlanOptions::default()
    };
    // Textures are read in the same way whatever they are for: one is enough, and decides what is hit.
    let [masked, sky] = ["alpha_mask", "environment"].map(|name| tiny::named(name).scene);
    for scene in [fixtures::room(), fixtures::lights(), masked, sky] {
        check(&Subject::of(&scene, &options));
    }
    if let Some(scenes) = scenes() {
        let scene = read_scene(&scenes.join("interiors/cornell-box.glb"), None).unwrap();
        check(&Subject::of(&scene, &options));
    }
}
