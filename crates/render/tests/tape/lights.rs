//! Recorded lights.

use residual_render::domain::{Buffers, Domain};
use residual_render::light;
use residual_render::math::vec3::vec3;
use residual_render::program::Interpreted;
use residual_render::renderer::Renderer;
use residual_render::surface::{Attributes, Surface, SurfaceHit};

use crate::check::check;
use crate::common::{Formula, Random, Yield, ifs};
use crate::nodes::{hit_arguments, light_kinds, structure};

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
        let hit = SurfaceHit {
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
                    light::sample(d, lights, surface.point, [u[0], u[1], u[3]]),
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
