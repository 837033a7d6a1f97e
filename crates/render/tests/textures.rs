//! Textures (hard cases T-02, T-03, T-04).

use residual_render::domain::{Buffer, Scalar};
use residual_render::math::vec3::vec3;
use residual_render::record::BufferRecord;
use residual_render::scene_data::SceneData;
use residual_render::texture::{
    AnyFilter, AnyFormat, AnyWrap, Bilinear, Checkerboard, Clamp, ColorSource, Const, Image,
    ImageParam, LinearFloat, Nearest, Repeat, ScalarSource, SrgbRgba8, TransformParam, UvMap,
    srgb_table,
};

use crate::support::random::Rng;
use crate::support::scenes::{FLOOR, floor, scene, set_params};
use crate::support::{Worst, array, ulp_diff};

fn exact_srgb(code: u32) -> f64 {
    let c = f64::from(code) / 255.0;
    if c <= 0.04045 {
        c / 12.92
    } else {
        ((c + 0.055) / 1.055).powf(2.4)
    }
}

#[test]
fn srgb_table_is_correctly_rounded_and_goes_back() {
    for (code, &linear) in (0..).zip(&srgb_table()) {
        let exact = exact_srgb(code);
        let ulp = f64::from(linear.next_up() - linear);
        assert!((f64::from(linear) - exact).abs() <= 0.5 * ulp, "{code}");
        assert!(ulp_diff(linear, exact as f32) == 0, "{code}");
        let l = f64::from(linear);
        let encoded = if l <= 0.003_130_8 {
            l * 12.92
        } else {
            1.055 * l.powf(1.0 / 2.4) - 0.055
        };
        assert_eq!((encoded * 255.0).round() as u32, code);
    }
}

#[test]
fn codes_are_decoded_to_the_stated_error_in_order_and_exactly_at_the_ends() {
    let mut data = numbered(1, 1);
    let mut decoded = Vec::new();
    for code in 0..=255 {
        data.buffer_mut(Buffer::Texels)[8] = u32::from_le_bytes([code, 255, 0, 128]);
        let buffers = data.buffers();
        let d = Scalar::new(&buffers);
        let wrap = (AnyWrap::Repeat, AnyWrap::Repeat);
        let image = Image {
            format: AnyFormat::SrgbRgba8,
            ..image(wrap, AnyFilter::Nearest)
        };
        let [red, green, blue] = array(image.color(d, &floor(d)));
        assert_eq!([green, blue], [1.0, 0.0]);
        let exact = exact_srgb(code.into());
        assert!(
            (f64::from(red) - exact).abs() <= 1e-6 * exact,
            "{code}: {red} {exact}"
        );
        decoded.push(red);
    }
    assert!(decoded.is_sorted_by(|a, b| a < b));
}

pub(crate) type AnyImage = Image<AnyWrap, AnyWrap, AnyFilter, AnyFormat>;
const UV: UvMap = UvMap {
    set: 0,
    transform: None,
};
const WRAPS: [AnyWrap; 3] = [AnyWrap::Repeat, AnyWrap::MirroredRepeat, AnyWrap::Clamp];

/// A scene with one image of `f32` texels whose red is the texel's number plus one; all else is −1e9.
pub(crate) fn numbered(width: u32, height: u32) -> SceneData {
    let mut data = scene(&[FLOOR]);
    let texel = |k: u32| [k as f32 + 1.0, 0.25, 0.5, 0.75];
    let mut words: Vec<u32> = vec![(-1e9_f32).to_bits(); 8];
    words.extend((0..width * height).flat_map(texel).map(f32::to_bits));
    words.extend([(-1e9_f32).to_bits(); 64]);
    *data.buffer_mut(Buffer::Texels) = words;
    set_params(
        &mut data,
        ImageParam {
            first: 8,
            width,
            height,
            levels: 0,
        },
    );
    data
}

pub(crate) fn image(wrap: (AnyWrap, AnyWrap), filter: AnyFilter) -> AnyImage {
    Image {
        slot: 0,
        uv: UV,
        channel: 0,
        wrap,
        filter,
        format: AnyFormat::LinearFloat,
    }
}

pub(crate) fn sample(data: &SceneData, image: &AnyImage, uv: [f32; 2]) -> f32 {
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let mut surface = floor(d);
    surface.uv[0] = uv;
    let (color, scalar) = (image.color(d, &surface), image.scalar(d, &surface));
    assert!(
        color.x.to_bits() == scalar.to_bits() || color.x.is_nan(),
        "{color:?} {scalar}"
    );
    scalar
}

/// The integer reference.
fn wrap(mode: AnyWrap, i: i64, size: i64) -> i64 {
    match mode {
        AnyWrap::Repeat => i.rem_euclid(size),
        AnyWrap::MirroredRepeat => {
            let r = i.rem_euclid(2 * size);
            r.min(2 * size - 1 - r)
        }
        AnyWrap::Clamp | AnyWrap::WhiteBorder | AnyWrap::BlackBorder | AnyWrap::FlatBorder => {
            i.clamp(0, size - 1)
        }
    }
}

fn coordinates() -> Vec<f32> {
    let mut rng = Rng::new(110);
    let mut list = vec![
        0.0,
        -0.0,
        1.0,
        -1.0,
        1.0_f32.next_down(),
        1.0_f32.next_up(),
        0.5,
        2.0,
        -1e-10,
        1e-10,
        1234.5,
    ];
    list.extend((0..150).map(|_| rng.range(-4.0, 4.0) as f32));
    list.extend((0..50).map(|_| rng.range(-1000.0, 1000.0) as f32));
    list
}

const SIZES: [(u32, u32); 5] = [(1, 1), (5, 3), (4, 8), (1, 7), (100, 3)];

#[test]
fn nearest_texels_are_the_integer_references() {
    for (width, height) in SIZES {
        let data = numbered(width, height);
        for wraps in WRAPS.into_iter().flat_map(|u| WRAPS.map(|v| (u, v))) {
            for (u, v) in coordinates()
                .into_iter()
                .zip(coordinates().into_iter().rev())
            {
                let place = |c: f32, size: u32, mode| {
                    wrap(mode, (c * size as f32).floor() as i64, i64::from(size))
                };
                let (x, y) = (place(u, width, wraps.0), place(v, height, wraps.1));
                let expected = (y * i64::from(width) + x) as f32 + 1.0;
                let got = sample(&data, &image(wraps, AnyFilter::Nearest), [u, v]);
                assert_eq!(got, expected, "({u}, {v}) of {width} × {height}, {wraps:?}");
            }
        }
    }
}

#[test]
fn bilinear_texels_are_the_f64_references() {
    let mut worst = Worst::default();
    for (width, height) in SIZES {
        let data = numbered(width, height);
        for wraps in WRAPS.into_iter().flat_map(|u| WRAPS.map(|v| (u, v))) {
            for (u, v) in coordinates()
                .into_iter()
                .zip(coordinates().into_iter().rev())
            {
                // The reference starts where texel coordinates are already rounded.
                let (x, y) = (u * width as f32 - 0.5, v * height as f32 - 0.5);
                let (x0, y0) = (x.floor(), y.floor());
                let texel = |i: i64, j: i64| {
                    let (i, j) = (
                        wrap(wraps.0, i, width.into()),
                        wrap(wraps.1, j, height.into()),
                    );
                    (j * i64::from(width) + i) as f64 + 1.0
                };
                let (s, t) = (f64::from(x) - f64::from(x0), f64::from(y) - f64::from(y0));
                let row = |j: i64| texel(x0 as i64, j) * (1.0 - s) + texel(x0 as i64 + 1, j) * s;
                let exact = row(y0 as i64) * (1.0 - t) + row(y0 as i64 + 1) * t;
                let got = sample(&data, &image(wraps, AnyFilter::Bilinear), [u, v]);
                let range = f64::from(width * height);
                worst.add((f64::from(got) - exact).abs() / range, || {
                    format!("({u}, {v}) {width} × {height} {wraps:?}")
                });
            }
        }
    }
    worst.assert_below(2.0_f64.powi(-20), "bilinear, ÷ range");
}

#[test]
fn hostile_coordinates_stay_inside() {
    let hostile = [
        1e8,
        -1e8,
        3e38,
        -3e38,
        1e20,
        16_777_217.0,
        1e-45,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::NAN,
    ];
    for (width, height) in SIZES {
        let data = numbered(width, height);
        let last = (width * height) as f32;
        for wraps in WRAPS.into_iter().flat_map(|u| WRAPS.map(|v| (u, v))) {
            for u in hostile {
                for v in hostile.into_iter().chain([0.3]) {
                    let got = sample(&data, &image(wraps, AnyFilter::Nearest), [u, v]);
                    assert!((1.0..=last).contains(&got), "({u}, {v}) {wraps:?}: {got}");
                    let got = sample(&data, &image(wraps, AnyFilter::Bilinear), [u, v]);
                    // A coordinate without a place in the image may give NaN, which the film counts; never a
                    // texel of another image, which here would be far below 0.
                    assert!(
                        got.is_nan() || (0.999..=last * 1.001).contains(&got),
                        "({u}, {v}) {wraps:?}: {got}"
                    );
                    let finite = u.is_finite() && v.is_finite() && u.abs() < 1e37 && v.abs() < 1e37;
                    assert!(!finite || got.is_finite(), "({u}, {v}) {wraps:?}");
                }
            }
        }
    }
}

#[test]
fn transforms_and_second_coordinates() {
    let mut data = numbered(4, 4);
    // u' = v, v' = −u + 1: a quarter turn.
    let quarter = TransformParam {
        u: [0.0, 1.0, 0.0].into(),
        v: [-1.0, 0.0, 1.0].into(),
    };
    quarter.append_to(data.buffer_mut(Buffer::Params));
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let mut surface = floor(d);
    surface.uv = [[0.1, 0.9], [0.6, 0.4]];
    let turned = Some(ImageParam::WORDS);
    let at = |set: usize, transform: Option<u32>| {
        let clamped = (Clamp, Repeat);
        let image = Image {
            slot: 0,
            uv: UvMap { set, transform },
            channel: 0,
            wrap: clamped,
            filter: Nearest,
            format: LinearFloat,
        };
        image.scalar(d, &surface)
    };
    assert_eq!(at(0, None), 13.0, "column 0, row 3");
    assert_eq!(at(1, None), 7.0, "column 2, row 1");
    assert_eq!(at(0, turned), 16.0, "column 3, row 3");
    assert_eq!(at(1, turned), 6.0, "column 1, row 1");
}

#[test]
fn channels_and_formats() {
    let mut data = numbered(1, 1);
    data.buffer_mut(Buffer::Texels)[8] = u32::from_le_bytes([10, 100, 200, 128]);
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let surface = floor(d);
    for filter in [AnyFilter::Nearest, AnyFilter::Bilinear] {
        let read = |channel: u32, format: AnyFormat| {
            let wrap = (AnyWrap::Repeat, AnyWrap::Repeat);
            Image {
                slot: 0,
                uv: UV,
                channel,
                wrap,
                filter,
                format,
            }
        };
        for (k, code) in [10, 100, 200, 128].into_iter().enumerate() {
            let linear = code as f32 / 255.0;
            let got = read(k as u32, AnyFormat::LinearRgba8).scalar(d, &surface);
            assert!(ulp_diff(got, linear) <= 1, "{got} {linear}");
            let decoded = if k == 3 {
                linear
            } else {
                exact_srgb(code) as f32
            };
            let got = read(k as u32, AnyFormat::SrgbRgba8).scalar(d, &surface);
            assert!((got - decoded).abs() <= 1e-6 * decoded, "{got} {decoded}");
        }
        let color = array(read(0, AnyFormat::SrgbRgba8).color(d, &surface));
        for (got, code) in color.into_iter().zip([10, 100, 200]) {
            let exact = exact_srgb(code) as f32;
            assert!((got - exact).abs() <= 1e-6 * exact, "{got} {exact}");
        }
    }
    let full = Image {
        slot: 0,
        uv: UV,
        channel: 3,
        wrap: (Repeat, Repeat),
        filter: Bilinear,
        format: SrgbRgba8,
    };
    assert!((full.scalar(d, &surface) - 128.0 / 255.0).abs() < 1e-7);
}

/// The colour of a square is the parity of the whole parts of its coordinates, on both sides of 0 and far away.
#[test]
fn checkerboards_alternate() {
    let mut data = scene(&[FLOOR]);
    let transform = TransformParam {
        u: vec3(8.0, 0.0, 0.5),
        v: vec3(0.0, 3.0, -0.25),
    };
    set_params(&mut data, transform);
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let mut surface = floor(d);
    let mut rng = Rng::new(77);
    let mut seen = [0; 2];
    for k in 0..10_000 {
        let reach = if k % 2 == 0 { 3.0 } else { 50_000.0 };
        let uv = [0; 2].map(|_| rng.range(-reach, reach) as f32);
        surface.uv[0] = uv;
        for transform in [None, Some(0)] {
            let board = Checkerboard {
                even: Const([0.0; 3]),
                odd: Const([1.0; 3]),
                uv: UvMap { set: 0, transform },
            };
            let [u, v] = uv.map(f64::from);
            let [u, v] = match transform {
                None => [u, v],
                Some(_) => [8.0 * u + 0.5, 3.0 * v - 0.25],
            };
            // Rounding may move a point across the border of its square.
            let near = |c: f64| (c - c.round()).abs() < 1e-6 * c.abs().max(1.0);
            if near(u) || near(v) {
                continue;
            }
            let parity = (u.floor() + v.floor()).rem_euclid(2.0);
            let color = array(board.color(d, &surface));
            assert_eq!(color, [parity as f32; 3], "{u} {v}");
            seen[parity as usize] += 1;
        }
    }
    assert!(seen.iter().all(|count| *count > 5_000), "{seen:?}");
}
