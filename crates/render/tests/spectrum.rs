//! Wavelengths: their colours, and what dispersive glass makes of them.

use residual_render::domain::{Buffers, Precise};
use residual_render::math::spectrum::{color_of, wavelength_at};
use residual_render::texture::{Const, Dispersive, ScalarSource};

use crate::support::array;
use crate::support::scenes::{FLOOR, floor, scene};

#[test]
fn all_wavelengths_together_are_white() {
    const STEPS: usize = 100_000;
    let d = Precise::new(&Buffers::EMPTY);
    let mut sum = [0.0; 3];
    for k in 0..STEPS {
        let wavelength = wavelength_at(d, (k as f64 + 0.5) / STEPS as f64);
        let color = array(color_of(d, wavelength));
        assert!(color.iter().all(|c| *c >= 0.0));
        sum = [0, 1, 2].map(|j: usize| sum[j] + color[j] / STEPS as f64);
    }
    assert!(sum.iter().all(|mean| (mean - 1.0).abs() < 1e-4), "{sum:?}");
}

#[test]
fn wavelengths_have_the_colours_of_the_rainbow() {
    let d = Precise::new(&Buffers::EMPTY);
    let brightest = |wavelength| {
        let color: [f64; 3] = array(color_of(d, wavelength));
        (0..3)
            .max_by(|a, b| color[*a].total_cmp(&color[*b]))
            .unwrap()
    };
    assert_eq!([630.0, 530.0, 450.0].map(brightest), [0, 1, 2]);
}

/// The Abbe number, (n_d − 1)/(n_F − n_C), is 20 over the dispersion.
#[test]
fn glass_has_its_abbe_number() {
    let data = scene(&[FLOOR]);
    let buffers = data.buffers();
    let d = Precise::new(&buffers);
    for (ior, dispersion) in [(1.5_f32, 0.1_f32), (1.5, 1.0), (2.42, 0.36), (1.33, 0.36)] {
        let glass = Dispersive {
            ior: Const(ior),
            dispersion: Const(dispersion),
        };
        let at = |wavelength| {
            let mut surface = floor(d);
            surface.wavelength = wavelength;
            glass.scalar(d, &surface)
        };
        let abbe = (at(587.56) - 1.0) / (at(486.13) - at(656.27));
        let expected = 20.0 / f64::from(dispersion);
        assert!((at(587.56) - f64::from(ior)).abs() < 1e-12);
        assert!((abbe / expected - 1.0).abs() < 1e-9, "{abbe}, {expected}");
    }
}
