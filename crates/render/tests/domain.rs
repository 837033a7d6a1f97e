//! The `f32` domains give the same bits: every operation and elementary function.

use fearless_simd::{Level, dispatch};
use residual_render::domain::{Buffer, Lanes, Lanes4, Lanes8, Lanes16, MAX_LANES, One, Scalar};
use residual_render::math::elementary::{atan2, exp2, log2, pow, sincos_turns};
use residual_render::math::fresnel::fresnel;
use residual_render::math::vec3::vec3;
use residual_render::math::{Frame, warp};
use residual_render::scene_data::SceneData;

use crate::support::agreement::{
    Formula, ROWS, any_bits, check, evaluate, numbers, reals, truth, vector, words,
};
use crate::support::random::Rng;

struct Operations;

impl Formula for Operations {
    fn run<D: Lanes>(&self, d: D, x: &[D::U]) -> Vec<D::U> {
        let [a, b, c] = [x[0], x[1], x[2]].map(|bits| d.from_bits(bits));
        let (i, j) = (x[3], x[4]);
        let mask = d.lt(a, b);
        let real = [
            a + b,
            a - b,
            a * b,
            a / b,
            -a,
            d.sqrt(a),
            d.min(a, b),
            d.max(a, b),
            d.abs(a),
            d.floor(a),
            d.fma(a, b, c),
            d.copysign(a, b),
            d.select(mask, b, c),
            d.to_real(i >> 8),
            truth(d, mask),
            truth(d, d.le(a, b)),
            truth(d, d.eq(a, b)),
            truth(d, d.eq_u(i, j)),
            truth(d, d.eq_u(i, i)),
            truth(d, d.lt_u(i, j)),
            truth(d, !mask),
            truth(d, mask & d.le(b, c)),
            truth(d, mask | d.le(b, c)),
            truth(d, d.truth(true)),
            d.branch(mask, || One(a + c), || One(b - c)).0,
            d.load_real(Buffer::Texels, i >> 23),
            d.uniform_real(Buffer::Texels, 7),
            d.lit(0.1),
        ];
        // Truncation is specified for numbers from 0 to 2³² only.
        let inside = d.le(d.lit(0.0), a) & d.lt(a, d.lit(4_294_967_296.0));
        let whole = [
            i + j,
            i - j,
            i * j,
            i & j,
            i | j,
            i ^ j,
            i << 7,
            i >> 13,
            i << 0,
            i >> 31,
            d.reverse_bits(i),
            d.select_u(mask, i, j),
            d.load(Buffer::Texels, i >> 22),
            d.uniform(Buffer::Texels, 255),
            d.uint(0x8000_0001),
            d.to_uint(d.select(inside, a, d.lit(3.9))),
        ];
        words(d, real).into_iter().chain(whole).collect()
    }
}

#[test]
fn operations_agree() {
    check("operations", &numbers(), &Operations, &any_bits(5, 40));
    // Numbers of like size, whose results are not all infinite or 0.
    let near = reals(41, |r| [0; 5].map(|_| r.signed_power(-3.0, 30.0)));
    check("operations", &numbers(), &Operations, &near);
}

/// Records of four words to lanes and back.
fn transpose<D: Lanes>(d: D) {
    let mut rng = Rng::new(52);
    for _ in 0..200 {
        let records: [[u32; 4]; MAX_LANES] = [(); MAX_LANES].map(|()| [(); 4].map(|()| rng.bits()));
        let columns = d.columns(|lane| records[lane]);
        for (k, column) in columns.into_iter().enumerate() {
            let mut words = [0; MAX_LANES];
            d.store_word(column, &mut words[..D::LANES]);
            for (lane, record) in records[..D::LANES].iter().enumerate() {
                assert_eq!(
                    words[lane],
                    record[k],
                    "word {k}, lane {lane} of {}",
                    D::LANES
                );
            }
        }
        assert_eq!(d.rows(columns)[..D::LANES], records[..D::LANES]);

        // From columns that were no rows before.
        let words = [(); 4].map(|()| [(); MAX_LANES].map(|()| rng.bits()));
        let rows = d.rows(words.map(|column| d.word(&column[..D::LANES])));
        for (lane, row) in rows[..D::LANES].iter().enumerate() {
            assert_eq!(
                *row,
                words.map(|column| column[lane]),
                "lane {lane} of {}",
                D::LANES
            );
        }
    }
}

#[test]
fn columns_and_rows_are_inverse_and_in_the_order_of_lanes() {
    let data = SceneData::default();
    let buffers = data.buffers();
    transpose(Scalar::new(&buffers));
    dispatch!(Level::new(), simd => {
        transpose(Lanes4::new(simd, &buffers));
        transpose(Lanes8::new(simd, &buffers));
        transpose(Lanes16::new(simd, &buffers));
    });
}

#[test]
fn rows_are_four_words() {
    struct Rows;
    impl Formula for Rows {
        fn run<D: Lanes>(&self, d: D, x: &[D::U]) -> Vec<D::U> {
            let one: [_; 1] = d.load_rows(Buffer::Texels, x[0]);
            let three: [_; 3] = d.load_rows(Buffer::Texels, x[0]);
            let words = one.into_iter().chain(three).flatten();
            let single = (0..12).map(|k| d.load(Buffer::Texels, x[0] + d.uint(k)));
            words.chain(single).collect()
        }
    }
    // Starts of rows all of whose words are inside or outside.
    let mut rng = Rng::new(43);
    let first = |row: usize| match row {
        0 => 244,
        1 => 256,
        2 => u32::MAX - 11,
        _ if row.is_multiple_of(3) => 256 + rng.bits() % (u32::MAX - 268),
        _ => rng.bits() % 245,
    };
    let columns = [(0..ROWS).map(first).collect()];
    let data = numbers();
    let buffers = data.buffers();
    let results = evaluate(Scalar::new(&buffers), &Rows, &columns);
    assert_eq!(results[..4], results[16..20]);
    assert_eq!(results[4..16], results[16..]);
    check("rows", &data, &Rows, &columns);
}

#[test]
fn conversion_of_large_integers_agrees() {
    struct ToReal;
    impl Formula for ToReal {
        fn run<D: Lanes>(&self, d: D, x: &[D::U]) -> Vec<D::U> {
            words(d, [d.to_real(x[0])])
        }
    }
    check("to_real", &SceneData::default(), &ToReal, &any_bits(1, 42));
}

struct Elementary;

impl Formula for Elementary {
    fn run<D: Lanes>(&self, d: D, x: &[D::U]) -> Vec<D::U> {
        let [a, b, c] = [x[0], x[1], x[2]].map(|bits| d.from_bits(bits));
        let (sin, cos) = sincos_turns(d, a);
        let (p, q) = warp::triangle(d, [b, c]);
        let v = vec3(a, b, c);
        let (r, g) = fresnel(d, b, d.abs(a) + d.lit(0.5));
        let frame = Frame::around(d, v.normalize_any(d));
        let size = d.abs(a);
        let scalars = [
            sin,
            cos,
            atan2(d, a, b),
            exp2(d, a),
            log2(d, size),
            pow(d, size, b),
            p,
            q,
            r,
            g,
        ];
        let vectors = [
            v.normalize_any(d),
            v.normalize(d),
            v.cross(vec3(c, a, b)),
            warp::cosine_hemisphere(d, [b, c]),
            frame.tangent,
            frame.bitangent,
            frame.to_local(d, vec3(c, b, a)),
        ];
        words(
            d,
            scalars
                .into_iter()
                .chain(vectors.into_iter().flat_map(vector)),
        )
    }
}

#[test]
fn elementary_functions_agree() {
    let inputs = reals(43, |r| [r.range(-4.0, 4.0) as f32, r.unit(), r.unit()]);
    check("elementary", &SceneData::default(), &Elementary, &inputs);
}

#[test]
#[should_panic(expected = "8 lanes")]
fn differences_are_found() {
    struct LaneCounted;
    impl Formula for LaneCounted {
        fn run<D: Lanes>(&self, d: D, _: &[D::U]) -> Vec<D::U> {
            words(d, [d.lit(if D::LANES == 8 { 1.0 } else { 0.0 })])
        }
    }
    check(
        "differs",
        &SceneData::default(),
        &LaneCounted,
        &any_bits(1, 51),
    );
}
