//! The `f32` domains give the same bits: whole formulas, of samplers, BSDFs, lights and textures.

use residual_render::bsdf::{
    Anisotropic, Bsdf, Coated, Dielectric, Diffuse, DiffuseTransmission, Glossy, Isotropic, Mirror,
    Mix, Phong, RoughDiffuse, Sheen, Solid, Sum, Thin, ThinFilm,
};
use residual_render::domain::{Buffer, Domain, Lanes};
use residual_render::light::{
    self, Area, AreaBySolidAngle, AreaBySolidAngleRecord, AreaRecord, Directional, Environment,
    LightKind, LightSample, Point, PunctualRecord, SphericalPoint, SphericalSpot, Spot, Sun,
};
use residual_render::math::vec3::vec3;
use residual_render::record::BufferRecord;
use residual_render::sampler::{AnySampler, SampleKey, Sampler};
use residual_render::scene_data::SceneData;
use residual_render::surface::{Attributes, Footprint, PathRay, Surface, SurfaceHit};
use residual_render::texture::{
    AnyFilter, AnyFormat, AnyWrap, Checkerboard, ColorSource, Const, Image, ImageParam,
    ScalarSource, TransformParam, UvMap,
};

use crate::support::agreement::{Formula, any_bits, check, reals, truth, vector, words};
use crate::support::bsdfs::{frosted, frosted_sheet, glass_scene, metal, plastic};
use crate::support::random::Rng;
use crate::support::scenes::{FLOOR, floor, scene, set_environment, set_lights, set_params};

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
        check($name, &glass_scene(1.5), &This, &inputs);
    })*};
}

const RED: Const<[f32; 3]> = Const([0.9, 0.5, 0.1]);

#[test]
fn bsdfs_agree() {
    check_bsdfs! {
        "diffuse" Diffuse { albedo: RED };
        "conductor" metal(RED.0, 0.3);
        "smooth conductor" metal(RED.0, 0.0);
        "coated" plastic(RED.0, 0.2, [0.04, 1.0]);
        "brushed conductor" Glossy {
            fresnel: metal(RED.0, 0.0).fresnel,
            roughness: Anisotropic { roughness: Const(0.3), anisotropy: Const(0.7) },
        };
        "film" Glossy {
            fresnel: ThinFilm { normal: RED, grazing: Const(1.0), strength: Const(0.8), ior: Const(1.33), thickness: Const(420.0) },
            roughness: Isotropic { roughness: Const(0.2) },
        };
        "clay" RoughDiffuse { albedo: RED, roughness: Const(0.7) };
        "sheen" Sheen { color: RED, roughness: Const(0.4) };
        "cloth" Coated { coat: Sheen { color: RED, roughness: Const(0.6) }, base: Diffuse { albedo: RED } };
        "paper" DiffuseTransmission { color: RED };
        "frosted" frosted(RED.0, 1.5, 0.3);
        "frosted sheet" frosted_sheet(RED.0, 1.4, 0.5);
        "solid" Dielectric { transmittance: RED, ior: Const(1.5), interface: Solid };
        "thin" Dielectric { transmittance: RED, ior: Const(1.33), interface: Thin };
        "phong" Phong { color: RED, exponent: Const(40.0) };
        "mirror" Mirror { reflectance: RED };
        "mix" Mix { a: Diffuse { albedo: RED }, b: Dielectric { transmittance: RED, ior: Const(1.5), interface: Solid }, weight: Const(0.4) };
        "sum" Sum {
            a: Diffuse { albedo: RED },
            b: Mix { a: Phong { color: RED, exponent: Const(9.0) }, b: metal(RED.0, 0.6), weight: Const(0.3) },
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
                let hit = SurfaceHit { u: u * d.lit(0.5), v: v * d.lit(0.5), prim: d.uint(0) };
                let surface = Surface::new(d, Attributes::default(), &hit, vec3(u, v, d.lit(-0.3)));
                let sample = self.0.sample(d, d.uint(0), surface.point, [a, b, c]);
                let mut results = light_words(d, sample);
                results.extend(light_words(d, light::sample(d, &(self.0, ()), surface.point, [c, a, u])));
                let ray = PathRay::unbounded(d, surface.point, sample.wi);
                results.extend(words(d, self.0.density(d, d.uint(0), &ray, &surface)));
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

light_formula!(
    Area<Const<[f32; 3]>>,
    AreaBySolidAngle<Const<[f32; 3]>>,
    Point,
    Spot,
    Directional,
    SphericalPoint,
    SphericalSpot,
    Sun,
    Environment
);

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
    let near = AreaBySolidAngle {
        emission: area.emission,
        attributes: area.attributes,
    };
    let lamp = AreaBySolidAngleRecord {
        kind: 0,
        triangle: 1,
        double_sided: 1,
        normal: [0.8, -0.7, 1.6].into(),
    };
    set_lights(&mut data, &[lamp], &[1.0]);
    check("area by solid angle", &data, &Light(near), &inputs);
    let axis = [0.0, 0.0, -1.0];
    let spot = PunctualRecord::spot(0, [0.3, 0.2, 0.933], [5.0, 4.0, 3.0], axis, [0.4, 1.3]);
    set_lights(&mut data, &[spot], &[1.0]);
    check("point", &data, &Light(Point), &inputs);
    check("spot", &data, &Light(Spot), &inputs);
    check("directional", &data, &Light(Directional), &inputs);
    // The floor, on which the points lie, is without and within.
    for radius in [0.01, 0.9, 1.2] {
        set_lights(&mut data, &[spot.with_radius(radius)], &[1.0]);
        check("sphere", &data, &Light(SphericalPoint), &inputs);
        check("spot sphere", &data, &Light(SphericalSpot), &inputs);
    }
    let sun = PunctualRecord::sun(0, [0.6, 0.0, 0.8], [5.0, 4.0, 3.0], 0.01);
    set_lights(&mut data, &[sun], &[1.0]);
    check("sun", &data, &Light(Sun), &inputs);
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
        // Of all levels.
        surface.footprint = Footprint {
            width: d.max(d.min(d.abs(surface.uv[0][0]), d.lit(8.0)), d.lit(0.0)),
            uv_areas: [d.lit(0.02); 2],
            random: d.lit(0.4),
        };
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
            levels: 4 * 35,
        },
    );
    let sizes = [[5, 7], [2, 3], [1, 1]];
    for (first, [width, height]) in [0, 40, 70].into_iter().zip(sizes) {
        let level = ImageParam {
            first,
            width,
            height,
            levels: 4 * 35,
        };
        level.append_to(data.buffer_mut(Buffer::Texels));
    }
    let moderate = reals(49, |r| {
        [r.range(-5.0, 5.0) as f32, r.range(-5.0, 5.0) as f32]
    });
    for wrap in [
        AnyWrap::Repeat,
        AnyWrap::MirroredRepeat,
        AnyWrap::Clamp,
        AnyWrap::WhiteBorder,
        AnyWrap::BlackBorder,
        AnyWrap::FlatBorder,
    ] {
        for filter in [
            AnyFilter::Nearest,
            AnyFilter::Bilinear,
            AnyFilter::Trilinear,
        ] {
            for format in [
                AnyFormat::SrgbRgba8,
                AnyFormat::LinearRgba8,
                AnyFormat::LinearHalf,
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

/// A checkerboard over given coordinates.
struct Checkers(UvMap);
impl Formula for Checkers {
    fn run<D: Lanes>(&self, d: D, x: &[D::U]) -> Vec<D::U> {
        let mut surface = floor(d);
        surface.uv[0] = [d.from_bits(x[0]), d.from_bits(x[1])];
        let board = Checkerboard {
            even: RED,
            odd: Const([0.1, 0.2, 0.3]),
            uv: self.0,
        };
        words(d, vector(board.color(d, &surface)))
    }
}

#[test]
fn checkerboards_agree() {
    let mut data = scene(&[FLOOR]);
    let transform = TransformParam {
        u: vec3(3.0, 0.5, 0.1),
        v: vec3(-0.25, 7.0, -0.3),
    };
    set_params(&mut data, transform);
    let moderate = reals(51, |r| {
        [r.range(-5.0, 5.0) as f32, r.range(-5.0, 5.0) as f32]
    });
    for transform in [None, Some(0)] {
        let checkers = Checkers(UvMap { set: 0, transform });
        check("checkerboard", &data, &checkers, &moderate);
        check("checkerboard", &data, &checkers, &any_bits(2, 52));
    }
}
