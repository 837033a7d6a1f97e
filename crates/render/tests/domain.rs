//! The `f32` domains give the same bits: every operation, and whole formulas.

use fearless_simd::{Level, dispatch};
use residual_render::bsdf::{
    Bsdf, CoatedDiffuse, Conductor, Dielectric, Diffuse, Mirror, Mix, Phong, Solid, Sum, Thin,
    fresnel,
};
use residual_render::domain::{
    Buffer, Domain, Lanes, Lanes4, Lanes8, Lanes16, MAX_LANES, One, Scalar,
};
use residual_render::light::{
    self, Area, AreaRecord, Directional, Environment, LightKind, LightSample, Point,
    PunctualRecord, Spot,
};
use residual_render::math::elementary::{atan2, exp2, log2, pow, sincos_turns};
use residual_render::math::vec3::vec3;
use residual_render::math::{Frame, Vec3, warp};
use residual_render::sampler::{AnySampler, SampleKey, Sampler};
use residual_render::scene_data::SceneData;
use residual_render::surface::{Attributes, Hit, Surface};
use residual_render::texture::{
    AnyFilter, AnyFormat, AnyWrap, ColorSource, Const, Image, ImageParam, ScalarSource, UvMap,
    srgb_table,
};

use crate::support::random::Rng;
use crate::support::scenes::{FLOOR, floor, scene, set_environment, set_lights, set_params};

/// A formula over columns of words; its results, as words.
trait Formula {
    fn run<D: Lanes>(&self, d: D, x: &[D::U]) -> Vec<D::U>;
}

/// Rows in each column; a multiple of every lane count.
const ROWS: usize = 2048;

/// A scene whose texels are 256 numbers.
fn numbers() -> SceneData {
    let mut data = scene(&[FLOOR]);
    *data.buffer_mut(Buffer::Texels) = srgb_table().map(f32::to_bits).to_vec();
    data
}

fn evaluate<D: Lanes>(d: D, formula: &impl Formula, columns: &[Vec<u32>]) -> Vec<Vec<u32>> {
    let mut results: Vec<Vec<u32>> = Vec::new();
    for first in (0..ROWS).step_by(D::LANES) {
        let x: Vec<_> = columns
            .iter()
            .map(|column| d.word(&column[first..first + D::LANES]))
            .collect();
        for (k, result) in formula.run(d, &x).into_iter().enumerate() {
            if results.len() <= k {
                results.push(vec![0; ROWS]);
            }
            d.store_word(result, &mut results[k][first..first + D::LANES]);
        }
    }
    results
}

/// Evaluates the formula in all domains and compares.
#[track_caller]
fn check(name: &str, data: &SceneData, formula: &impl Formula, columns: &[Vec<u32>]) {
    let buffers = data.buffers();
    // One NaN is like another: IEEE 754 leaves their payloads open.
    let same =
        |a: u32, b: u32| a == b || (f32::from_bits(a).is_nan() && f32::from_bits(b).is_nan());
    let expected = evaluate(Scalar::new(&buffers), formula, columns);
    let compare = |lanes: usize, results: Vec<Vec<u32>>| {
        for (k, (result, expected)) in results.iter().zip(&expected).enumerate() {
            for row in 0..ROWS {
                let input: Vec<_> = columns
                    .iter()
                    .map(|c| (c[row], f32::from_bits(c[row])))
                    .collect();
                let (a, b) = (expected[row], result[row]);
                assert!(
                    same(a, b),
                    "{name}, result {k}, {lanes} lanes: {a:#x} {b:#x} for {input:x?}"
                );
            }
        }
    };
    dispatch!(Level::new(), simd => {
        compare(4, evaluate(Lanes4::new(simd, &buffers), formula, columns));
        compare(8, evaluate(Lanes8::new(simd, &buffers), formula, columns));
        compare(16, evaluate(Lanes16::new(simd, &buffers), formula, columns));
    });
}

fn words<D: Domain>(d: D, values: impl IntoIterator<Item = D::F>) -> Vec<D::U> {
    values.into_iter().map(|value| d.to_bits(value)).collect()
}
fn vector<F>(v: Vec3<F>) -> [F; 3] {
    [v.x, v.y, v.z]
}
fn truth<D: Domain>(d: D, mask: D::M) -> D::F {
    d.select(mask, d.lit(1.0), d.lit(0.0))
}

const SPECIAL: [f32; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    -0.5,
    f32::MAX,
    f32::MIN,
    f32::MIN_POSITIVE,
    1e-45,
    -1e-45,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
    16_777_216.0,
    8_388_607.5,
];

/// Columns of bits: special values against one another, then anything.
fn any_bits(count: usize, seed: u64) -> Vec<Vec<u32>> {
    let mut rng = Rng::new(seed);
    let special = |row: usize, k: usize| SPECIAL[(row >> (4 * (k % 2))) & 15].to_bits();
    (0..count)
        .map(|k| {
            (0..ROWS)
                .map(|row| {
                    if row < 256 {
                        special(row, k)
                    } else {
                        rng.bits()
                    }
                })
                .collect()
        })
        .collect()
}

/// Columns of numbers made row by row.
fn reals<const N: usize>(seed: u64, mut row: impl FnMut(&mut Rng) -> [f32; N]) -> Vec<Vec<u32>> {
    let mut rng = Rng::new(seed);
    let mut columns = vec![Vec::with_capacity(ROWS); N];
    for _ in 0..ROWS {
        for (column, value) in columns.iter_mut().zip(row(&mut rng)) {
            column.push(value.to_bits());
        }
    }
    columns
}

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

struct Samplers;
impl Formula for Samplers {
    fn run<D: Lanes>(&self, d: D, x: &[D::U]) -> Vec<D::U> {
        let key = SampleKey::new(d, x[0], x[1], x[2], x[3]);
        let pairs = [AnySampler::Independent, AnySampler::Sobol].map(|s| s.pair(d, key, x[4]));
        words(d, pairs.into_iter().flatten())
    }
}

#[test]
fn samplers_agree() {
    check(
        "samplers",
        &SceneData::default(),
        &Samplers,
        &any_bits(5, 44),
    );
}

fn bsdf_words<D: Domain>(d: D, bsdf: &impl Bsdf<D>, x: &[D::U]) -> Vec<D::U> {
    let x: Vec<_> = x.iter().map(|bits| d.from_bits(*bits)).collect();
    let (wo, wi) = (vec3(x[0], x[1], x[2]), vec3(x[3], x[4], x[5]));
    let surface = floor(d);
    let value = bsdf.eval(d, &surface, wo, wi);
    let sample = bsdf.sample(d, &surface, wo, [x[6], x[7], x[8]]);
    let albedo = bsdf.albedo(d, &surface, wo);
    let vectors = [value.value, sample.wi, sample.weight, albedo]
        .into_iter()
        .flat_map(vector);
    words(
        d,
        vectors.chain([value.pdf, sample.pdf, truth(d, sample.delta)]),
    )
}

macro_rules! check_bsdfs {
    ($($name:literal $bsdf:expr;)*) => {$({
        struct This;
        impl Formula for This {
            fn run<D: Lanes>(&self, d: D, x: &[D::U]) -> Vec<D::U> {
                bsdf_words(d, &$bsdf, x)
            }
        }
        let inputs = reals(45, |r| {
            let ([a, b, c], [e, f, g], [u, v, w]) = (r.direction(), r.direction(), r.unit3());
            [a as f32, b as f32, c.abs() as f32, e as f32, f as f32, g as f32, u, v, w]
        });
        check($name, &scene(&[FLOOR]), &This, &inputs);
    })*};
}

const RED: Const<[f32; 3]> = Const([0.9, 0.5, 0.1]);

#[test]
fn bsdfs_agree() {
    check_bsdfs! {
        "diffuse" Diffuse { albedo: RED };
        "conductor" Conductor { color: RED, roughness: Const(0.3) };
        "smooth conductor" Conductor { color: RED, roughness: Const(0.0) };
        "coated" CoatedDiffuse { albedo: RED, roughness: Const(0.2), reflectance: Const([0.04; 3]), grazing: Const(1.0) };
        "solid" Dielectric { transmittance: RED, ior: Const(1.5), interface: Solid };
        "thin" Dielectric { transmittance: RED, ior: Const(1.33), interface: Thin };
        "phong" Phong { color: RED, exponent: Const(40.0) };
        "mirror" Mirror { reflectance: RED };
        "mix" Mix { a: Diffuse { albedo: RED }, b: Dielectric { transmittance: RED, ior: Const(1.5), interface: Solid }, weight: Const(0.4) };
        "sum" Sum {
            a: Diffuse { albedo: RED },
            b: Mix { a: Phong { color: RED, exponent: Const(9.0) }, b: Conductor { color: RED, roughness: Const(0.6) }, weight: Const(0.3) },
            probability: Const(0.5)
        };
    }
}

/// A light over a triangle in general position.
struct Light<K>(K);
fn light_words<D: Domain>(d: D, s: LightSample<D>) -> Vec<D::U> {
    let vectors = [s.wi, s.position, s.radiance].into_iter().flat_map(vector);
    words(
        d,
        vectors.chain([s.pdf, truth(d, s.infinite), truth(d, s.delta)]),
    )
}
macro_rules! light_formula {
    ($($kind:ty),*) => {$(
        impl Formula for Light<$kind> {
            fn run<D: Lanes>(&self, d: D, x: &[D::U]) -> Vec<D::U> {
                let [a, b, c, u, v] = [0, 1, 2, 3, 4].map(|k| d.from_bits(x[k]));
                let hit = Hit { u: u * d.lit(0.5), v: v * d.lit(0.5), prim: d.uint(0) };
                let surface = Surface::new(d, Attributes::default(), &hit, vec3(u, v, d.lit(-0.3)));
                let sample = self.0.sample(d, d.uint(0), surface.point, [a, b, c]);
                let mut results = light_words(d, sample);
                results.extend(light_words(d, light::sample(d, &(self.0, ()), surface.point, [c, a, b, u])));
                if let Some(seen) = self.0.background(d, sample.wi) {
                    results.extend(words(d, vector(seen.radiance).into_iter().chain([seen.pdf])));
                }
                let start = surface.spawn(d, sample.wi);
                results.extend(words(d, vector(start).into_iter().chain(vector(surface.error))));
                results
            }
        }
    )*};
}
light_formula!(Area<Const<[f32; 3]>>, Point, Spot, Directional, Environment);

#[test]
fn lights_agree() {
    let lamp = [[0.3, -0.2, 2.0], [0.4, 1.1, 2.5], [1.7, 0.1, 1.5]];
    let mut data = scene(&[FLOOR, lamp]);
    let inputs = reals(46, |r| [0; 5].map(|_| r.unit()));
    let area = Area {
        emission: Const([3.0, 2.0, 1.0]),
        attributes: Attributes::default(),
    };
    let lamp = AreaRecord {
        kind: 0,
        triangle: 1,
        double_sided: 1,
    };
    set_lights(&mut data, &[lamp], &[1.0]);
    check("area", &data, &Light(area), &inputs);
    let spot = PunctualRecord {
        scale: 2.0,
        axis: [0.0, 0.0, -1.0].into(),
        offset: -0.5,
        ..PunctualRecord::new(0, [0.3, 0.2, 0.933], [5.0, 4.0, 3.0])
    };
    set_lights(&mut data, &[spot], &[1.0]);
    check("point", &data, &Light(Point), &inputs);
    check("spot", &data, &Light(Spot), &inputs);
    check("directional", &data, &Light(Directional), &inputs);
    let mut rng = Rng::new(47);
    let texels: Vec<_> = (0..21).map(|_| rng.unit3()).collect();
    set_environment(&mut data, 7, &texels, 0.7);
    check("environment", &data, &Light(Environment), &inputs);
}

struct Texture(Image<AnyWrap, AnyWrap, AnyFilter, AnyFormat>);
impl Formula for Texture {
    fn run<D: Lanes>(&self, d: D, x: &[D::U]) -> Vec<D::U> {
        let mut surface = floor(d);
        surface.uv[0] = [d.from_bits(x[0]), d.from_bits(x[1])];
        let scalar = self.0.scalar(d, &surface);
        words(
            d,
            vector(self.0.color(d, &surface))
                .into_iter()
                .chain([scalar]),
        )
    }
}

#[test]
fn textures_agree() {
    let mut data = scene(&[FLOOR]);
    let mut rng = Rng::new(48);
    *data.buffer_mut(Buffer::Texels) = (0..4 * 35).map(|_| rng.bits() & 0xbf7f_ffff).collect();
    set_params(
        &mut data,
        ImageParam {
            first: 0,
            width: 5,
            height: 7,
        },
    );
    let moderate = reals(49, |r| {
        [r.range(-5.0, 5.0) as f32, r.range(-5.0, 5.0) as f32]
    });
    for wrap in [AnyWrap::Repeat, AnyWrap::MirroredRepeat, AnyWrap::Clamp] {
        for filter in [AnyFilter::Nearest, AnyFilter::Bilinear] {
            for format in [
                AnyFormat::SrgbRgba8,
                AnyFormat::LinearRgba8,
                AnyFormat::LinearFloat,
            ] {
                let uv = UvMap {
                    set: 0,
                    transform: None,
                };
                let image = Image {
                    slot: 0,
                    uv,
                    channel: 3,
                    wrap: (wrap, AnyWrap::Repeat),
                    filter,
                    format,
                };
                let name = format!("{image:?}");
                check(&name, &data, &Texture(image), &moderate);
                check(&name, &data, &Texture(image), &any_bits(2, 50));
            }
        }
    }
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
