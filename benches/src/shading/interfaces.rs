//! Which interface's specialisation is worth what (thesis, Figure 3.5): a textured dielectric coat whose textures, and whose
//! vertex attributes, are known to the compiler or not.

use std::hint::black_box;

use residual_device_cpu::{LaneCount, SceneView, TileJob, TileRenderer, render_lanes};
use residual_render::bsdf::{Bsdf, Coated, Diffuse, Glossy, Isotropic, Schlick};
use residual_render::camera::Perspective;
use residual_render::domain::Domain;
use residual_render::layer::Layers;
use residual_render::light::Point;
use residual_render::material::{Material, Shading};
use residual_render::math::{Color, Vec3};
use residual_render::passes::Counters;
use residual_render::program::{ColorNode, ImageNode, Program, ScalarNode, SourceNode};
use residual_render::renderer::{MaterialVisitor, Renderer};
use residual_render::sampler::Sobol;
use residual_render::surface::{Attributes, Surface};
use residual_render::texture::{
    Bilinear, Bound, ColorSource, Image, LinearRgba8, Param, Repeat, ScalarSource, SrgbRgba8,
};
use residual_render::tracer::{PathTracer, PowerHeuristic, Settings};

use super::kinds::{Inputs, Kind};

/// What the compiler knows of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Known {
    /// How images are wrapped, filtered and stored.
    pub textures: bool,
    /// Which vertex attributes are read.
    pub attributes: bool,
}

impl Known {
    /// All four cases, by the number of their programs.
    pub const ALL: [Self; 4] = [
        Self::new(true, true),
        Self::new(true, false),
        Self::new(false, true),
        Self::new(false, false),
    ];

    const fn new(textures: bool, attributes: bool) -> Self {
        Self {
            textures,
            attributes,
        }
    }
}

/// Attributes that are read: a type if they are known, else a value.
trait AttributeSet: Sync {
    fn get(&self) -> Attributes;
}

struct TextureCoordinates;

impl AttributeSet for TextureCoordinates {
    #[inline(always)]
    fn get(&self) -> Attributes {
        Attributes {
            uv0: true,
            ..Attributes::NONE
        }
    }
}

impl AttributeSet for Attributes {
    #[inline(always)]
    fn get(&self) -> Attributes {
        *self
    }
}

/// An image of kinds that are values, entered with the domain's instruction set.
struct Node(ImageNode);

impl<D: Domain> ColorSource<D> for Node {
    fn color(&self, d: D, surface: &Surface<D>) -> Color<D::F> {
        d.vectorize(
            #[inline(always)]
            || self.0.color(d, surface),
        )
    }
}

impl<D: Domain> ScalarSource<D> for Node {
    fn scalar(&self, d: D, surface: &Surface<D>) -> D::F {
        d.vectorize(
            #[inline(always)]
            || self.0.scalar(d, surface),
        )
    }
}

/// A source behind a vtable, as the interpreter has it.
struct Opaque<'a, T: ?Sized>(&'a T);

impl<D: Domain> ColorSource<D> for Opaque<'_, dyn ColorSource<D>> {
    #[inline(always)]
    fn color(&self, d: D, surface: &Surface<D>) -> Color<D::F> {
        self.0.color(d, surface)
    }
}

impl<D: Domain> ScalarSource<D> for Opaque<'_, dyn ScalarSource<D>> {
    #[inline(always)]
    fn scalar(&self, d: D, surface: &Surface<D>) -> D::F {
        self.0.scalar(d, surface)
    }
}

/// The textured coat.
struct Coat<C, R, A> {
    albedo: C,
    roughness: R,
    reflectance: Param,
    grazing: Param,
    attributes: A,
}

impl<D, C, R, A> Material<D> for Coat<C, R, A>
where
    D: Domain,
    C: ColorSource<D>,
    R: ScalarSource<D>,
    A: AttributeSet,
{
    #[inline(always)]
    fn attributes(&self) -> Attributes {
        self.attributes.get()
    }

    #[inline(always)]
    fn shade<'s>(
        &'s self,
        d: D,
        surface: &mut Surface<D>,
        _: Vec3<D::F>,
    ) -> Shading<D::F, impl Bsdf<D> + 's>
    where
        D: 's,
    {
        Shading {
            emission: None,
            bsdf: Coated {
                coat: Glossy {
                    fresnel: Schlick {
                        normal: Bound(self.reflectance.color(d, surface)),
                        grazing: Bound(self.grazing.scalar(d, surface)),
                    },
                    roughness: Isotropic {
                        roughness: Bound(self.roughness.scalar(d, surface)),
                    },
                },
                base: Diffuse {
                    albedo: Bound(self.albedo.color(d, surface)),
                },
            },
        }
    }
}

/// The program that is the same in all cases, as the nodes of the interpreter.
struct Nodes {
    albedo: Node,
    roughness: Node,
    reflectance: Param,
    grazing: Param,
}

impl Nodes {
    fn of(program: &Program) -> Self {
        let sources: Vec<_> = program.inputs.iter().map(|input| &input.source).collect();
        let [
            SourceNode::Color(ColorNode::Image(albedo)),
            SourceNode::Scalar(ScalarNode::Image(roughness)),
            SourceNode::Color(ColorNode::Param(reflectance)),
            SourceNode::Scalar(ScalarNode::Param(grazing)),
        ] = sources[..]
        else {
            unreachable!("these are the inputs of a textured coat");
        };
        Self {
            albedo: Node(*albedo),
            roughness: Node(*roughness),
            reflectance: Param(*reflectance),
            grazing: Param(*grazing),
        }
    }

    fn coat<C, R, A>(&self, albedo: C, roughness: R, attributes: A) -> Coat<C, R, A> {
        Coat {
            albedo,
            roughness,
            reflectance: self.reflectance,
            grazing: self.grazing,
            attributes,
        }
    }
}

/// An image of which everything is known.
fn known<T>(image: &ImageNode, format: T) -> Image<Repeat, Repeat, Bilinear, T> {
    Image {
        slot: image.slot,
        uv: image.uv,
        channel: image.channel,
        wrap: (Repeat, Repeat),
        filter: Bilinear,
        format,
    }
}

/// The four programs as a scene.
struct Cases<'a> {
    nodes: &'a Nodes,
    /// What is read, as a value that the compiler cannot see.
    attributes: Attributes,
}

impl<D: Domain> Renderer<D> for Cases<'_> {
    type Camera = Perspective;
    type Tracer = PathTracer<D, Sobol>;
    type Lights = (Point, ());

    fn camera(&self) -> &Perspective {
        &Perspective
    }
    fn tracer(&self, settings: Settings<D>) -> Self::Tracer {
        PathTracer {
            mis: PowerHeuristic,
            sampler: Sobol,
            settings,
        }
    }
    fn lights(&self) -> &(Point, ()) {
        &(Point, ())
    }
    fn programs(&self) -> usize {
        Known::ALL.len()
    }
    #[inline(always)]
    fn visit_material<V: MaterialVisitor<D>>(&self, program: usize, visitor: V) -> V::Output {
        let Self { nodes, attributes } = self;
        let (albedo, roughness) = (
            known(&nodes.albedo.0, SrgbRgba8),
            known(&nodes.roughness.0, LinearRgba8),
        );
        let any: (&dyn ColorSource<D>, &dyn ScalarSource<D>) = (&nodes.albedo, &nodes.roughness);
        // The compiler must not look through the vtables.
        let any = black_box(any);
        let (any_albedo, any_roughness) = (Opaque(any.0), Opaque(any.1));
        match Known::ALL[program] {
            Known {
                textures: true,
                attributes: true,
            } => visitor.visit(&nodes.coat(albedo, roughness, TextureCoordinates)),
            Known {
                textures: true,
                attributes: false,
            } => visitor.visit(&nodes.coat(albedo, roughness, *attributes)),
            Known {
                textures: false,
                attributes: true,
            } => visitor.visit(&nodes.coat(any_albedo, any_roughness, TextureCoordinates)),
            Known {
                textures: false,
                attributes: false,
            } => visitor.visit(&nodes.coat(any_albedo, any_roughness, *attributes)),
        }
    }
}

/// Renders the four programs with one lane count.
pub(super) struct CasesRenderer {
    nodes: Nodes,
    lanes: LaneCount,
}

impl CasesRenderer {
    pub(super) fn new(lanes: LaneCount) -> Self {
        Self {
            nodes: Nodes::of(&Kind::Coat.program(Inputs::Textures).0),
            lanes,
        }
    }
}

impl TileRenderer for CasesRenderer {
    fn layers(&self) -> Layers {
        Layers::NONE
    }

    fn has_light_paths(&self) -> bool {
        false
    }

    fn render_tiles(
        &self,
        scene: &SceneView<'_>,
        job: &TileJob<'_>,
        samples: &mut [f32],
    ) -> Counters {
        let cases = Cases {
            nodes: &self.nodes,
            attributes: black_box(TextureCoordinates.get()),
        };
        match self.lanes {
            LaneCount::One => render_lanes!(One, scene, job, samples, |buffers| cases),
            LaneCount::Four => render_lanes!(Four, scene, job, samples, |buffers| cases),
            LaneCount::Eight => render_lanes!(Eight, scene, job, samples, |buffers| cases),
            LaneCount::Sixteen => render_lanes!(Sixteen, scene, job, samples, |buffers| cases),
        }
    }
}
