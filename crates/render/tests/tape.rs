//! The recording domain computes what the scalar domain computes, bit for bit, and leaves out what it should.

mod common;

use common::{Formula, IMAGE, Random, TRANSFORM, TRIANGLES, Yield, count, ifs, loads, scene};
use residual_render::alpha::AlphaTest as _;
use residual_render::bsdf::AnyInterface;
use residual_render::bsdf::Bsdf;
use residual_render::camera::Camera;
use residual_render::domain::tape::{Function, Outputs, Record, Tape};
use residual_render::domain::{Buffer, Buffers, Bundle, Domain, Scalar, Uint};
use residual_render::layer::{Layer, Layers};
use residual_render::light;
use residual_render::material::Material;
use residual_render::math::elementary;
use residual_render::math::vec3::vec3;
use residual_render::program::{
    AlphaTestNode, BoxedMaterial, BsdfNode, CameraNode, ColorNode, EmissionNode, ImageNode,
    InputNode, Interpreted, LightNode, NormalNode, Program, ScalarNode, SourceNode, Structure,
};
use residual_render::sampler::{AnySampler, SampleKey, Sampler};
use residual_render::scene::Scene;
use residual_render::surface::{Attributes, Hit, Ray, Surface};
use residual_render::texture::{AnyFilter, AnyFormat, AnyWrap, Input, UvMap};
use residual_render::tracer::{
    self, DebugView, Path, PathTracer, Settings, Tracer, TracerNode, TracerOptions,
};

const RUNS: usize = 1000;

/// Paths of the tests are shorter.
const OPTIONS: TracerOptions = TracerOptions {
    image: [640, 480],
    seed: 0,
    max_depth: 100,
    roulette_from: 5,
    reach: 3.0,
};

/// Names of parameters, as many as any formula needs.
const NAMES: [&str; 24] = [
    "a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l", "m", "n", "o", "p", "q", "r", "s",
    "t", "u", "v", "w", "x",
];

fn record<F: Formula>(formula: &F) -> Function {
    let (reals, words) = formula.arguments(&mut Random(1));
    let tape = Tape::new();
    let mut names = NAMES.into_iter();
    let reals: Vec<_> = reals
        .iter()
        .map(|_| tape.real(names.next().unwrap()))
        .collect();
    let words: Vec<_> = words
        .iter()
        .map(|_| tape.word(names.next().unwrap()))
        .collect();
    let results = formula.run(Record::new(&tape), &reals, &words);
    let mut outputs = Outputs::new();
    for real in results.reals {
        outputs = outputs.real("real", real);
    }
    for word in results.words {
        outputs = outputs.word("word", word);
    }
    for truth in results.truths {
        outputs = outputs.truth("truth", truth);
    }
    tape.function(formula.name(), outputs)
}

/// The same bits; zeros of either sign and all NaN are one.
fn same(a: u32, b: u32) -> bool {
    let (x, y) = (f32::from_bits(a), f32::from_bits(b));
    a == b || (x == 0.0 && y == 0.0) || (x.is_nan() && y.is_nan())
}

/// Runs the recorded function and the formula on the same random arguments.
#[track_caller]
fn check<F: Formula>(formula: &F) -> Function {
    let data = scene();
    let buffers = data.buffers();
    let function = record(formula);
    let mut random = Random(99);
    for run in 0..RUNS {
        let (reals, words) = formula.arguments(&mut random);
        let bits: Vec<u32> = reals
            .iter()
            .map(|r| r.to_bits())
            .chain(words.iter().copied())
            .collect();
        let words: Vec<Uint> = words.into_iter().map(Uint).collect();
        let expected = formula.run(Scalar::new(&buffers), &reals, &words);
        let real_count = expected.reals.len();
        let expected: Vec<u32> = expected
            .reals
            .iter()
            .map(|r| r.to_bits())
            .chain(expected.words.iter().map(|w| w.0))
            .chain(expected.truths.iter().map(|&t| t.into()))
            .collect();
        let got = function.evaluate(&buffers, &bits);
        assert_eq!(got.len(), expected.len());
        for (place, (&got, &expected)) in got.iter().zip(&expected).enumerate() {
            let equal = if place < real_count {
                same(got, expected)
            } else {
                got == expected
            };
            assert!(
                equal,
                "{}, run {run}, output {place}: {} recorded, {} scalar; arguments {reals:?} {words:?}",
                formula.name(),
                f32::from_bits(got),
                f32::from_bits(expected),
            );
        }
    }
    function
}

// ---- materials ----

/// Everything that a program computes at a hit.
struct AtHit(Program);

fn hit_arguments(random: &mut Random) -> (Vec<f32>, Vec<u32>) {
    let (u, v) = (random.unit(), random.unit());
    let (u, v) = if u + v > 1.0 {
        (1.0 - u, 1.0 - v)
    } else {
        (u, v)
    };
    let mut reals = vec![u, v];
    reals.extend(random.direction());
    (reals, vec![random.word() % TRIANGLES])
}

impl Formula for AtHit {
    fn name(&self) -> String {
        format!("{:?}", self.0)
    }
    fn arguments(&self, random: &mut Random) -> (Vec<f32>, Vec<u32>) {
        let (mut reals, words) = hit_arguments(random);
        reals.extend(random.direction());
        reals.extend([random.unit(), random.unit(), random.unit()]);
        (reals, words)
    }
    fn run<D: Domain>(&self, d: D, r: &[D::F], words: &[D::U]) -> Yield<D> {
        let material = BoxedMaterial::<D>::new(&self.0);
        let hit = Hit {
            u: r[0],
            v: r[1],
            prim: words[0],
        };
        let dir = vec3(r[2], r[3], r[4]);
        let mut surface = Surface::new(d, material.attributes(), &hit, dir);
        let wo = -dir.normalize(d);
        let shading = material.shade(d, &mut surface, wo);
        let wo = surface.frame.to_local(d, wo);
        let wi = surface.frame.to_local(d, vec3(r[5], r[6], r[7]));
        let value = shading.bsdf.eval(d, &surface, wo, wi);
        let sample = shading.bsdf.sample(d, &surface, wo, [r[8], r[9], r[10]]);
        let mut out = Yield::new();
        out.vector(value.value);
        out.real(value.pdf);
        out.vector(surface.frame.to_world(sample.wi));
        out.vector(sample.weight);
        out.real(sample.pdf);
        out.truths.push(sample.delta);
        out.vector(surface.spawn(d, dir));
        if let Some(emission) = shading.emission {
            out.vector(emission);
        }
        out
    }
}

fn color(name: &'static str, node: ColorNode) -> InputNode {
    InputNode {
        name,
        source: SourceNode::Color(node),
    }
}
fn scalar(name: &'static str, node: ScalarNode) -> InputNode {
    InputNode {
        name,
        source: SourceNode::Scalar(node),
    }
}

fn program(bsdf: BsdfNode, inputs: Vec<InputNode>) -> Program {
    Program {
        attributes: Attributes::default(),
        inputs,
        normal: None,
        emission: None,
        bsdf,
        alpha_test: None,
    }
}

/// Inputs 0 and 1 are colours, 2, 3 and 4 numbers.
fn inputs(constant: bool) -> Vec<InputNode> {
    let (c, s): (fn(u32) -> ColorNode, fn(u32) -> ScalarNode) = if constant {
        (
            |k| ColorNode::Const([0.25, 0.5, 0.125 * (k + 1) as f32]),
            |k| ScalarNode::Const(0.3 + 0.1 * k as f32),
        )
    } else {
        (ColorNode::Param, ScalarNode::Param)
    };
    vec![
        color("first", c(0)),
        color("second", c(3)),
        scalar("third", s(6)),
        scalar("fourth", s(7)),
        scalar("fifth", s(8)),
    ]
}

/// Every BSDF, and combinations of them.
fn bsdfs() -> Vec<BsdfNode> {
    let [first, second, third, fourth, fifth] = [0, 1, 2, 3, 4].map(Input);
    let diffuse = BsdfNode::Diffuse { albedo: first };
    let conductor = BsdfNode::Conductor {
        color: second,
        roughness: third,
    };
    let coated = BsdfNode::CoatedDiffuse {
        albedo: first,
        roughness: third,
        reflectance: second,
        grazing: fourth,
    };
    let glass = |interface| BsdfNode::Dielectric {
        transmittance: first,
        ior: fourth,
        interface,
    };
    let phong = BsdfNode::Phong {
        color: second,
        exponent: fifth,
    };
    let mirror = BsdfNode::Mirror {
        reflectance: second,
    };
    let mix = |a: &BsdfNode, b: &BsdfNode| BsdfNode::Mix {
        a: Box::new(a.clone()),
        b: Box::new(b.clone()),
        weight: third,
    };
    let sum = |a: &BsdfNode, b: &BsdfNode| BsdfNode::Sum {
        a: Box::new(a.clone()),
        b: Box::new(b.clone()),
        probability: fourth,
    };
    vec![
        BsdfNode::Black,
        diffuse.clone(),
        conductor.clone(),
        coated.clone(),
        glass(AnyInterface::Solid),
        glass(AnyInterface::Thin),
        phong.clone(),
        mirror.clone(),
        sum(&diffuse, &mirror),
        mix(&coated, &conductor),
        mix(&coated, &glass(AnyInterface::Thin)),
        mix(&glass(AnyInterface::Solid), &glass(AnyInterface::Thin)),
        sum(&diffuse, &phong),
        mix(
            &sum(&diffuse, &phong),
            &mix(&glass(AnyInterface::Solid), &coated),
        ),
    ]
}

#[test]
fn bsdfs_with_parameters() {
    for bsdf in bsdfs() {
        check(&AtHit(program(bsdf, inputs(false))));
    }
}

#[test]
fn bsdfs_with_constants() {
    for bsdf in bsdfs() {
        let function = check(&AtHit(program(bsdf, inputs(true))));
        assert_eq!(
            loads(&function, Buffer::Params),
            0,
            "constants are not loaded"
        );
    }
}

#[test]
fn zeros_and_ones_remove_code() {
    let zero = || {
        vec![
            color("black", ColorNode::Const([0.0; 3])),
            color("white", ColorNode::Const([1.0; 3])),
            scalar("zero", ScalarNode::Const(0.0)),
            scalar("one", ScalarNode::Const(1.0)),
            scalar("exponent", ScalarNode::Const(20.0)),
        ]
    };
    for bsdf in bsdfs() {
        let short = check(&AtHit(program(bsdf.clone(), zero())));
        let long = record(&AtHit(program(bsdf, inputs(false))));
        let statements = |f: &Function| count(&f.body, &|_| true);
        assert!(statements(&short) <= statements(&long));
    }
}

#[test]
fn normal_maps_emission_and_vertex_attributes() {
    let all = Attributes {
        normals: true,
        tangents: true,
        uv0: true,
        uv1: true,
        colors: true,
    };
    for double_sided in [false, true] {
        let mut program = program(
            BsdfNode::Conductor {
                color: Input(0),
                roughness: Input(2),
            },
            inputs(false),
        );
        program.attributes = all;
        program.inputs[1] = color("normal", ColorNode::Image(image(0)));
        program.inputs[0] = color(
            "product",
            ColorNode::Product(
                Box::new(ColorNode::VertexColor),
                Box::new(ColorNode::Param(9)),
            ),
        );
        program.inputs[2] = scalar(
            "product",
            ScalarNode::Product(
                Box::new(ScalarNode::VertexColor),
                Box::new(ScalarNode::Param(9)),
            ),
        );
        program.normal = Some(NormalNode {
            texel: Input(1),
            scale: Input(3),
        });
        program.emission = Some(EmissionNode {
            radiance: Input(0),
            double_sided,
        });
        check(&AtHit(program));
    }
}

/// Image number `k` of all combinations of wrapping, filter, format, coordinates and transform.
fn image(k: usize) -> ImageNode {
    let wraps = [AnyWrap::Repeat, AnyWrap::MirroredRepeat, AnyWrap::Clamp];
    let filters = [AnyFilter::Nearest, AnyFilter::Bilinear];
    let formats = [
        AnyFormat::SrgbRgba8,
        AnyFormat::LinearRgba8,
        AnyFormat::LinearFloat,
    ];
    ImageNode {
        slot: IMAGE,
        uv: UvMap {
            set: k % 2,
            transform: k.is_multiple_of(3).then_some(TRANSFORM),
        },
        channel: (k % 4) as u32,
        wrap: (wraps[k % 3], wraps[k / 3 % 3]),
        filter: filters[k / 9 % 2],
        format: formats[k / 18 % 3],
    }
}

/// One image as a colour and as a number.
struct Texture(ImageNode);

impl Formula for Texture {
    fn name(&self) -> String {
        format!("{:?}", self.0)
    }
    fn arguments(&self, random: &mut Random) -> (Vec<f32>, Vec<u32>) {
        hit_arguments(random)
    }
    fn run<D: Domain>(&self, d: D, r: &[D::F], words: &[D::U]) -> Yield<D> {
        use residual_render::texture::{ColorSource, ScalarSource};
        let hit = Hit {
            u: r[0],
            v: r[1],
            prim: words[0],
        };
        let attributes = Attributes {
            uv0: true,
            uv1: true,
            ..Attributes::default()
        };
        let surface = Surface::new(d, attributes, &hit, vec3(r[2], r[3], r[4]));
        let mut out = Yield::new();
        out.vector(self.0.color(d, &surface));
        out.real(self.0.scalar(d, &surface));
        out
    }
}

#[test]
fn image_textures() {
    for k in 0..54 {
        check(&Texture(image(k)));
    }
}

struct Alpha(AlphaTestNode);

impl Formula for Alpha {
    fn name(&self) -> String {
        format!("{:?}", self.0)
    }
    fn arguments(&self, random: &mut Random) -> (Vec<f32>, Vec<u32>) {
        let (mut reals, words) = hit_arguments(random);
        reals.extend(random.direction());
        (reals, words)
    }
    fn run<D: Domain>(&self, d: D, r: &[D::F], words: &[D::U]) -> Yield<D> {
        let hit = Hit {
            u: r[0],
            v: r[1],
            prim: words[0],
        };
        let ray = [vec3(r[5], r[6], r[7]), vec3(r[2], r[3], r[4])];
        let mut out = Yield::new();
        out.truths.push(self.0.boxed::<D>().passes(d, ray, &hit));
        out
    }
}

#[test]
fn alpha() {
    let attributes = Attributes {
        uv0: true,
        uv1: true,
        ..Attributes::default()
    };
    let alpha = ScalarNode::Image(image(3));
    for cutoff in [ScalarNode::Const(0.5), ScalarNode::Param(3)] {
        check(&Alpha(AlphaTestNode::AlphaMask {
            alpha: alpha.clone(),
            cutoff,
            attributes,
        }));
    }
    check(&Alpha(AlphaTestNode::AlphaBlend { alpha, attributes }));
}

// ---- lights, cameras, samplers ----

fn structure(lights: Vec<LightNode>) -> Structure {
    Structure {
        programs: vec![],
        lights,
        camera: CameraNode::Perspective,
        sampler: AnySampler::Sobol,
        tracer: TracerNode::Path,
        layers: Layers::NONE,
    }
}

fn light_kinds() -> Vec<LightNode> {
    let attributes = Attributes {
        uv0: true,
        uv1: true,
        ..Attributes::default()
    };
    vec![
        LightNode::Area {
            emission: ColorNode::Image(image(9)),
            attributes,
        },
        LightNode::Point,
        LightNode::Spot,
        LightNode::Directional,
        LightNode::Environment,
    ]
}

/// One kind of light, or all of them behind a pick.
struct Lights(Option<usize>);

impl Formula for Lights {
    fn name(&self) -> String {
        format!("lights {:?}", self.0)
    }
    fn arguments(&self, random: &mut Random) -> (Vec<f32>, Vec<u32>) {
        let (mut reals, words) = hit_arguments(random);
        reals.extend([0; 4].map(|_| random.unit()));
        (reals, words)
    }
    fn run<D: Domain>(&self, d: D, r: &[D::F], words: &[D::U]) -> Yield<D> {
        let hit = Hit {
            u: r[0],
            v: r[1],
            prim: words[0],
        };
        let dir = vec3(r[2], r[3], r[4]);
        let surface = Surface::new(d, Attributes::default(), &hit, dir);
        let structure = structure(light_kinds());
        let scene = Interpreted::<D>::new(&structure, &Buffers::EMPTY);
        let u = [r[5], r[6], r[7], r[8]];
        let (sample, background) = match self.0 {
            Some(kind) => {
                let node = &scene.lights()[kind];
                let record = d.uint(16 * kind as u32);
                let sample = node.sample(d, record, surface.point, [u[0], u[1], u[2]]);
                (sample, node.background(d, dir))
            }
            None => {
                let lights = scene.lights();
                (
                    light::sample(d, lights, surface.point, u),
                    light::LightKinds::background(lights, d, dir),
                )
            }
        };
        let mut out = Yield::new();
        out.vector(sample.wi);
        out.vector(sample.position);
        out.vector(sample.radiance);
        out.real(sample.pdf);
        out.truths.extend([sample.infinite, sample.delta]);
        if let Some(seen) = background {
            out.vector(seen.radiance);
            out.real(seen.pdf);
        }
        out
    }
}

#[test]
fn each_kind_of_light() {
    for kind in 0..5 {
        let function = check(&Lights(Some(kind)));
        assert_eq!(ifs(&function), 0);
    }
}

#[test]
fn all_lights_at_once() {
    let function = check(&Lights(None));
    assert_eq!(ifs(&function), 4, "a branch for each kind but the last");
}

struct CameraAndSampler(CameraNode, AnySampler);

impl Formula for CameraAndSampler {
    fn name(&self) -> String {
        format!("{:?} {:?}", self.0, self.1)
    }
    fn arguments(&self, random: &mut Random) -> (Vec<f32>, Vec<u32>) {
        (
            vec![],
            vec![
                random.word() % 4096,
                random.word() % 4096,
                random.word(),
                random.word(),
                random.word() % 64,
            ],
        )
    }
    fn run<D: Domain>(&self, d: D, _: &[D::F], words: &[D::U]) -> Yield<D> {
        let &[x, y, index, seed, dimension] = words else {
            unreachable!()
        };
        let key = SampleKey::new(d, x, y, index, seed);
        let camera = self.0.boxed::<D>();
        let mut out = Yield::new();
        out.reals.extend(self.1.pair(d, key, dimension));
        let tracer = PathTracer {
            sampler: self.1,
            settings: Settings {
                seed,
                ..Settings::new(d, &OPTIONS)
            },
        };
        let Path {
            ray,
            throughput,
            pdf,
            key,
            depth,
        } = tracer.on_emit(d, &camera, [x, y], index);
        let through = camera.ray(d, [out.reals[0], out.reals[1]]);
        for ray in [ray, through] {
            out.vector(ray.org);
            out.vector(ray.dir);
            out.real(ray.tmax);
        }
        out.vector(throughput);
        out.real(pdf);
        out.words.extend([key.pixel, key.index, depth]);
        out
    }
}

#[test]
fn cameras_and_samplers() {
    for camera in [CameraNode::Perspective, CameraNode::Orthographic] {
        for sampler in [AnySampler::Independent, AnySampler::Sobol] {
            check(&CameraAndSampler(camera.clone(), sampler));
        }
    }
}

/// The step of a tracer at a hit, with all layers.
struct AnyStep(TracerNode);

impl Formula for AnyStep {
    fn name(&self) -> String {
        format!("{:?}", self.0)
    }
    fn arguments(&self, random: &mut Random) -> (Vec<f32>, Vec<u32>) {
        let (mut reals, mut words) = hit_arguments(random);
        reals.extend([0; 4].map(|_| random.between(0.1, 1.0)));
        words.extend([random.word(), random.word(), 1 + random.word() % 9]);
        (reals, words)
    }
    fn run<D: Domain>(&self, d: D, r: &[D::F], words: &[D::U]) -> Yield<D> {
        let &[prim, pixel, index, depth] = words else {
            unreachable!()
        };
        let mut program = program(bsdfs().pop().unwrap(), inputs(false));
        program.emission = Some(EmissionNode {
            radiance: Input(0),
            double_sided: false,
        });
        let layers: Layers = Layer::ALL.into_iter().collect();
        let structure = Structure {
            tracer: self.0,
            layers,
            ..structure(light_kinds())
        };
        let scene = Interpreted::<D>::new(&structure, &Buffers::EMPTY);
        let material = BoxedMaterial::<D>::new(&program);
        let dir = vec3(r[2], r[3], r[4]);
        let hit = Hit {
            u: r[0],
            v: r[1],
            prim,
        };
        let path = Path {
            ray: Ray::unbounded(d, -dir, dir),
            throughput: vec3(r[5], r[6], r[7]),
            pdf: r[8],
            key: SampleKey { pixel, index },
            depth,
        };
        let tracer = scene.tracer(Settings::new(d, &OPTIONS));
        let step = tracer::shade(d, &tracer, &path, &hit, &material, scene.lights());
        let mut out = Yield::new();
        if let Some(seen) = step.seen {
            out.vector(seen);
        }
        let features = step.features.expect("there are layers");
        out.truths.push(features.first);
        out.reals.extend(features.channels(layers));
        if let Some(shadow) = step.shadow {
            out.vector(shadow.ray.org);
            out.vector(shadow.ray.dir);
            out.real(shadow.ray.tmax);
            out.vector(shadow.contribution);
            out.truths.push(shadow.active);
        }
        if let Some(bounce) = step.bounce {
            out.vector(bounce.path.ray.org);
            out.vector(bounce.path.ray.dir);
            out.vector(bounce.path.throughput);
            out.real(bounce.path.pdf);
            out.words.push(bounce.path.depth);
            out.truths.push(bounce.active);
        }
        if let Some(seen) = tracer.on_miss(d, &path, scene.lights()) {
            out.vector(seen);
        }
        out
    }
}

#[test]
fn steps_of_all_tracers() {
    check(&AnyStep(TracerNode::Path));
    check(&AnyStep(TracerNode::AmbientOcclusion));
    for view in DebugView::ALL {
        // A path of this tracer is at its end at once, which the recorder cannot know.
        check(&AnyStep(TracerNode::Debug(view)));
    }
}

/// Elementary functions of two numbers.
struct Elementary;

impl Formula for Elementary {
    fn name(&self) -> String {
        "elementary".to_owned()
    }
    fn arguments(&self, random: &mut Random) -> (Vec<f32>, Vec<u32>) {
        (
            vec![random.between(-4.0, 4.0), random.between(-4.0, 4.0)],
            vec![],
        )
    }
    fn run<D: Domain>(&self, d: D, r: &[D::F], _: &[D::U]) -> Yield<D> {
        let mut out = Yield::new();
        let (sin, cos) = elementary::sincos_turns(d, r[0]);
        out.reals.extend([
            sin,
            cos,
            elementary::atan2(d, r[0], r[1]),
            elementary::exp2(d, r[1]),
        ]);
        let positive = d.abs(r[0]);
        out.reals.extend([
            elementary::log2(d, positive),
            elementary::pow(d, positive, r[1]),
        ]);
        // Constants fold to the scalar domain's bits.
        let c = d.lit(0.7);
        out.reals.extend([
            elementary::pow(d, c, d.lit(2.2)),
            elementary::atan2(d, c, -c),
        ]);
        out
    }
}

#[test]
fn elementary_functions() {
    check(&Elementary);
}

/// Nested branches with everything that could leave its scope.
struct Branches;

/// A number, a word and a truth value.
#[derive(Clone, Copy)]
struct Triple<D: Domain>(D::F, D::U, D::M);

impl<D: Domain> Bundle<D> for Triple<D> {
    fn choose(d: D, mask: D::M, a: Self, b: Self) -> Self {
        Self(
            // What `choose` computes itself is of neither side.
            d.select(mask, a.0 + a.0, b.0 + b.0) * d.lit(0.25)
                + d.select(mask, a.0, b.0) * d.lit(0.5),
            d.select_u(mask, a.1, b.1),
            d.select_mask(mask, a.2, b.2),
        )
    }
}

impl Formula for Branches {
    fn name(&self) -> String {
        "branches".to_owned()
    }
    fn arguments(&self, random: &mut Random) -> (Vec<f32>, Vec<u32>) {
        let reals = [0; 4].map(|_| random.between(-1.0, 1.0));
        (reals.to_vec(), vec![random.word() % 16, random.word() % 16])
    }
    fn run<D: Domain>(&self, d: D, r: &[D::F], words: &[D::U]) -> Yield<D> {
        let zero = d.lit(0.0);
        let (p, q) = (d.lt(r[0], zero), d.lt(r[1], zero));
        let inner = |x: D::F| {
            d.branch(
                q,
                || {
                    Triple(
                        x * r[2] + d.sqrt(d.abs(r[3])),
                        words[0] + words[1],
                        d.lt(x, r[3]),
                    )
                },
                || {
                    Triple(
                        x / (d.abs(r[2]) + d.lit(0.1)),
                        words[0] * words[1],
                        d.truth(true),
                    )
                },
            )
        };
        // `shared` is recorded in one side, and used in the other and after both.
        let shared = || d.sqrt(d.abs(r[0] * r[1]));
        let first = d.branch(
            p,
            || inner(shared()),
            || Triple(shared() * r[3], words[1], q),
        );
        // The same branch again: expressions of the first are known, but were not computed here.
        let second = d.branch(p, || inner(shared() + r[2]), || inner(r[2]));
        let third = d.branch(!q & p, || (first, second), || (second, inner(first.0)));
        let constant = d.branch(d.truth(true), || inner(r[0]), || unreachable!());
        let mut out = Yield::new();
        for Triple(real, word, truth) in [first, second, third.0, third.1, constant] {
            out.real(real + shared());
            out.words.push(word);
            out.truths.push(truth);
        }
        out
    }
}

#[test]
fn branches_and_scopes() {
    let function = check(&Branches);
    assert!(ifs(&function) >= 6);
}

#[test]
fn the_same_formula_leaves_the_same_tape() {
    for bsdf in bsdfs() {
        let formula = AtHit(program(bsdf, inputs(false)));
        assert_eq!(
            format!("{:?}", record(&formula)),
            format!("{:?}", record(&formula))
        );
    }
}
