//! Recorded materials: BSDFs, textures, alpha tests.

use residual_render::alpha::AlphaTest as _;
use residual_render::bsdf::Bsdf;
use residual_render::domain::tape::Function;
use residual_render::domain::{Buffer, Domain};
use residual_render::material::Material;
use residual_render::math::vec3::vec3;
use residual_render::program::{
    AlphaTestNode, BoxedMaterial, BsdfNode, ColorNode, EmissionNode, FresnelNode, ImageNode,
    NormalNode, Program, RoughnessNode, ScalarNode,
};
use residual_render::surface::{Attributes, Surface, SurfaceHit};
use residual_render::texture::Input;

use crate::check::{check, record};
use crate::common::{Formula, Random, Yield, count, loads};
use crate::nodes::{bsdfs, color, hit_arguments, image, inputs, program, scalar};

/// Everything that a program computes at a hit.
struct AtHit(Program);

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
        let hit = SurfaceHit {
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

#[test]
fn bsdfs_with_parameters() {
    for bsdf in bsdfs() {
        check(&AtHit(program(bsdf, inputs(false))));
    }
}

#[test]
fn bsdfs_with_constants() {
    for bsdf in bsdfs() {
        let has_table = matches!(bsdf, BsdfNode::RoughDielectric { .. });
        let function = check(&AtHit(program(bsdf, inputs(true))));
        let loads = loads(&function, Buffer::Params);
        assert_eq!(loads > 0, has_table, "constants are not loaded");
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
            BsdfNode::Glossy {
                fresnel: FresnelNode::Schlick {
                    normal: Input(0),
                    grazing: Input(3),
                },
                roughness: RoughnessNode::Isotropic {
                    roughness: Input(2),
                },
            },
            inputs(false),
        );
        program.attributes = all;
        program.inputs[1] = color("normal", ColorNode::Image(image(0)));
        program.inputs[0] = color(
            "product",
            ColorNode::Product(
                Box::new(ColorNode::VertexColor),
                Box::new(ColorNode::Checkerboard {
                    even: Box::new(ColorNode::Param(9)),
                    odd: Box::new(ColorNode::VertexColor),
                    uv: image(0).uv,
                }),
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
        let hit = SurfaceHit {
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
    for k in 0..108 {
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
        let hit = SurfaceHit {
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
