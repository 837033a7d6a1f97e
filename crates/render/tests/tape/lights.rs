//! Recorded lights.

use residual_render::domain::{Buffers, Domain};
use residual_render::light::{self, LightTree};
use residual_render::math::vec3::vec3;
use residual_render::program::{Interpreted, Structure};
use residual_render::renderer::Renderer;
use residual_render::surface::{Attributes, PathRay, Surface, SurfaceHit};

use crate::check::check;
use crate::common::{Formula, Random, Yield, ifs};
use crate::nodes::{hit_arguments, light_kinds, structure};

/// One kind of light, or all of them behind a pick from a table or a tree.
enum Lights {
    One(usize),
    Table,
    Tree(LightTree),
}

impl Formula for Lights {
    fn name(&self) -> String {
        match self {
            Self::One(kind) => format!("light {kind}"),
            Self::Table => "lights".to_owned(),
            Self::Tree(tree) => format!("lights, {tree:?}"),
        }
    }
    fn arguments(&self, random: &mut Random) -> (Vec<f32>, Vec<u32>) {
        let (mut reals, words) = hit_arguments(random);
        reals.extend([0; 4].map(|_| random.unit()));
        (reals, words)
    }
    fn run<D: Domain>(&self, d: D, r: &[D::F], words: &[D::U]) -> Yield<D> {
        let hit = SurfaceHit {
            u: r[0],
            v: r[1],
            prim: words[0],
        };
        let dir = vec3(r[2], r[3], r[4]);
        let surface = Surface::new(d, Attributes::default(), &hit, dir);
        let structure = Structure {
            light_tree: match self {
                Self::Tree(tree) => Some(*tree),
                Self::One(_) | Self::Table => None,
            },
            ..structure(light_kinds())
        };
        let scene = Interpreted::<D>::new(&structure, &Buffers::EMPTY);
        let u = [r[5], r[6], r[7], r[8]];
        let (sample, background) = match self {
            Self::One(kind) => {
                let node = &scene.lights().kinds[*kind];
                let record = d.uint(16 * *kind as u32);
                let sample = node.sample(d, record, surface.point, [u[0], u[1], u[2]]);
                (sample, node.background(d, dir))
            }
            Self::Table | Self::Tree(_) => {
                let lights = scene.lights();
                (
                    light::sample(d, lights, surface.point, [u[0], u[1], u[3]]),
                    light::background(d, lights, &PathRay::unbounded(d, surface.point, dir)),
                )
            }
        };
        let mut out = Yield::new();
        out.vector(sample.wi);
        out.vector(sample.position);
        out.vector(sample.radiance);
        out.reals.extend([sample.pdf, sample.spread]);
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
    for kind in 0..9 {
        let function = check(&Lights::One(kind));
        assert_eq!(ifs(&function), 0);
    }
}

#[test]
fn all_lights_at_once() {
    let function = check(&Lights::Table);
    assert_eq!(ifs(&function), 8, "a branch for each kind but the last");
}

#[test]
fn lights_of_a_tree() {
    let function = check(&Lights::Tree(LightTree { levels: 3 }));
    assert_eq!(
        ifs(&function),
        8 + 3 + 3,
        "a branch for each kind but the last, and for each level on the way to the picked light and to the environment"
    );
}
