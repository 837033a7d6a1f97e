//! Recorded cameras, samplers and steps of tracers.

use residual_render::camera::Camera;
use residual_render::domain::{Buffers, Domain};
use residual_render::layer::{Layer, Layers};
use residual_render::math::vec3::vec3;
use residual_render::program::{BoxedMaterial, CameraNode, EmissionNode, Interpreted, Structure};
use residual_render::renderer::Renderer;
use residual_render::sampler::{AnySampler, SampleKey, Sampler};
use residual_render::surface::{PathRay, SurfaceHit};
use residual_render::texture::Input;
use residual_render::tracer::{
    self, AnyNesting, AnySharing, Between, DebugView, MatterNode, MediaNode, Path, PathOrigin,
    PathState, PathTracer, PowerHeuristic, Settings, Tracer, TracerNode, TracerOptions,
};

use crate::check::check;
use crate::common::{Formula, MEDIUM, Random, Yield};
use crate::nodes::{bsdfs, hit_arguments, inputs, light_kinds, program, structure};

/// Paths of the tests are shorter.
const OPTIONS: TracerOptions = TracerOptions {
    image: [640, 480],
    seed: 0,
    max_depth: 100,
    roulette_from: 5,
    reach: 3.0,
    origin: PathOrigin::Camera,
};

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
            mis: PowerHeuristic,
        };
        let Path {
            ray,
            throughput,
            pdf,
            rivals: _,
            key,
            state: PathState(state),
        } = tracer.on_emit(d, &camera, &(), [x, y], index);
        let through = camera.ray(
            d,
            [out.reals[0], out.reals[1]],
            [out.reals[1], out.reals[0]],
        );
        for ray in [ray, through] {
            out.vector(ray.org);
            out.vector(ray.dir);
            out.real(ray.tmax);
        }
        out.vector(throughput);
        out.real(pdf);
        out.words.extend([key.pixel, key.index, state]);
        out
    }
}

#[test]
fn cameras_and_samplers() {
    for camera in [
        CameraNode::Perspective,
        CameraNode::ThinLens,
        CameraNode::Orthographic,
        CameraNode::Panorama,
    ] {
        for sampler in [AnySampler::Independent, AnySampler::Sobol] {
            check(&CameraAndSampler(camera.clone(), sampler));
        }
    }
}

/// What leaves lights.
struct FirstOfLightPath;

impl Formula for FirstOfLightPath {
    fn name(&self) -> String {
        "first ray of a light path".to_owned()
    }
    fn arguments(&self, random: &mut Random) -> (Vec<f32>, Vec<u32>) {
        (vec![], [0; 3].map(|_| random.word() % 4096).to_vec())
    }
    fn run<D: Domain>(&self, d: D, _: &[D::F], words: &[D::U]) -> Yield<D> {
        let &[x, y, index] = words else {
            unreachable!()
        };
        let structure = Structure {
            tracer: TracerNode::Bidirectional(AnySharing::Combined),
            ..structure(light_kinds())
        };
        let scene = Interpreted::<D>::new(&structure, &Buffers::EMPTY);
        let tracer = scene.tracer(Settings {
            origin: PathOrigin::Lights,
            ..Settings::new(d, &OPTIONS)
        });
        let path = tracer.on_emit(d, scene.camera(), scene.lights(), [x, y], index);
        let mut out = Yield::new();
        out.vector(path.ray.org);
        out.vector(path.ray.dir);
        out.vector(path.throughput);
        out.reals.extend([path.pdf, path.rivals]);
        out.words
            .extend([path.key.pixel, path.key.index, path.state.0]);
        out
    }
}

/// The step of a tracer at a hit, with all layers.
struct AnyStep(TracerNode, Between, PathOrigin);

impl AnyStep {
    fn new(tracer: TracerNode, between: Between) -> Self {
        Self(tracer, between, PathOrigin::Camera)
    }
}

impl Formula for AnyStep {
    fn name(&self) -> String {
        format!("{:?} {:?} {:?}", self.0, self.1, self.2)
    }
    fn arguments(&self, random: &mut Random) -> (Vec<f32>, Vec<u32>) {
        let (mut reals, mut words) = hit_arguments(random);
        reals.extend([0; 5].map(|_| random.between(0.1, 1.0)));
        // Within two bodies, of which that of the higher index is first.
        let media = match self.1.media {
            None => 0,
            Some(_) => (random.word() % 4) | ((random.word() % 2) << 5),
        };
        words.extend([
            random.word(),
            random.word(),
            1 + random.word() % 9 + (media << 10),
        ]);
        (reals, words)
    }
    fn run<D: Domain>(&self, d: D, r: &[D::F], words: &[D::U]) -> Yield<D> {
        let &[prim, pixel, index, state] = words else {
            unreachable!()
        };
        let mut program = program(bsdfs().pop().unwrap(), inputs(false));
        program.interior = self.1.media.map(|_| MEDIUM);
        program.emission = Some(EmissionNode {
            radiance: Input(0),
            double_sided: false,
        });
        let layers: Layers = Layer::ALL.into_iter().collect();
        let structure = Structure {
            tracer: self.0,
            between: self.1,
            layers,
            ..structure(light_kinds())
        };
        let scene = Interpreted::<D>::new(&structure, &Buffers::EMPTY);
        let material = BoxedMaterial::<D>::new(&program);
        let dir = vec3(r[2], r[3], r[4]);
        let hit = SurfaceHit {
            u: r[0],
            v: r[1],
            prim,
        };
        let path = Path {
            ray: PathRay::unbounded(d, -dir, dir),
            throughput: vec3(r[5], r[6], r[7]),
            pdf: r[8],
            rivals: r[9],
            key: SampleKey { pixel, index },
            state: PathState(state),
        };
        let tracer = scene.tracer(Settings {
            origin: self.2,
            ..Settings::new(d, &OPTIONS)
        });
        let step = tracer::shade(d, &tracer, &path, &hit, &material, scene.lights());
        let mut out = Yield::new();
        if let Some(seen) = step.seen {
            out.vector(seen);
        }
        let of_camera = self.2 == PathOrigin::Camera;
        assert_eq!(
            step.features.is_some(),
            of_camera,
            "what a light path meets is in no pixel yet"
        );
        if let Some(features) = step.features {
            out.truths.push(features.first);
            out.reals.extend(features.channels(layers));
        }
        if let Some(shadow) = step.shadow {
            out.vector(shadow.ray.org);
            out.vector(shadow.ray.dir);
            out.real(shadow.ray.tmax);
            out.vector(shadow.contribution);
            out.words.extend(shadow.pixel);
            out.truths.push(shadow.active);
        }
        if let Some(bounce) = step.bounce {
            out.vector(bounce.path.ray.org);
            out.vector(bounce.path.ray.dir);
            out.vector(bounce.path.throughput);
            out.reals.extend([bounce.path.pdf, bounce.path.rivals]);
            out.words.push(bounce.path.state.0);
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
    let surfaces = Between::default();
    check(&AnyStep::new(TracerNode::default(), surfaces));
    check(&AnyStep::new(TracerNode::AmbientOcclusion, surfaces));
    for view in DebugView::ALL {
        // A path of this tracer is at its end at once, which the recorder cannot know.
        check(&AnyStep::new(TracerNode::Debug(view), surfaces));
    }
    for nesting in [AnyNesting::Beside, AnyNesting::Nested] {
        for matter in [MatterNode::Absorption, MatterNode::AbsorptionAndScattering] {
            for dispersion in [false, true] {
                let media = Some(MediaNode { nesting, matter });
                let between = Between { media, dispersion };
                check(&AnyStep::new(TracerNode::default(), between));
            }
        }
    }
}

#[test]
fn steps_of_paths_from_both_ends() {
    check(&FirstOfLightPath);
    for sharing in [AnySharing::Combined, AnySharing::LightPathsOnly] {
        for origin in [PathOrigin::Camera, PathOrigin::Lights] {
            let tracer = TracerNode::Bidirectional(sharing);
            check(&AnyStep(tracer, Between::default(), origin));
        }
    }
}
