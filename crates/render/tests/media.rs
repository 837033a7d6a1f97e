//! What paths know of the media that they are in, against a list kept in another way; the phase function, and how far rays get,
//! against their integrals.

use residual_render::bsdf::{Bsdf, HenyeyGreenstein};
use residual_render::domain::{Buffer, Precise, Scalar, Uint};
use residual_render::math::vec3::vec3;
use residual_render::record::BufferRecord;
use residual_render::sampler::{Independent, SampleKey};
use residual_render::scene_data::SceneData;
use residual_render::surface::{Attributes, PathRay, Surface, SurfaceHit};
use residual_render::tracer::{
    AbsorptionAndScattering, Matter, MediumRecord, Nested, Nesting, Path, PathState,
};
use residual_render::triangle::TriangleRecord;

use crate::support::random::Rng;
use crate::support::stats::{Family, Mean};

const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// Media 1 to `priorities.len()`, of these priorities, which do not fall.
fn media(priorities: &[i32]) -> SceneData {
    let mut data = SceneData::default();
    data.push(TriangleRecord::new([
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
    ]));
    let above = |priority: i32| priorities.partition_point(|other| *other <= priority) as u32 + 1;
    let all = std::iter::once(&i32::MIN).chain(priorities);
    for (index, priority) in all.enumerate() {
        let record = MediumRecord {
            halvings: [0.0; 3].into(),
            ior: 1.0 + index as f32 / 16.0,
            albedo: [0.0; 3].into(),
            anisotropy: 0.0,
            above: above(*priority),
            around_camera: 0,
        };
        record.append_to(data.buffer_mut(Buffer::Media));
    }
    data
}

fn path(d: Scalar<'_>, media: u32) -> Path<Scalar<'_>> {
    Path {
        ray: PathRay::unbounded(d, vec3(0.2, 0.2, 1.0), vec3(0.0, 0.0, -1.0)),
        throughput: vec3(1.0, 1.0, 1.0),
        pdf: 0.0,
        rivals: 0.0,
        key: SampleKey {
            pixel: Uint(0),
            index: Uint(0),
        },
        state: PathState::first(d).in_media(d, Uint(media)),
    }
}

/// Bodies in the order in which they were entered: of those with the highest priority the last is there.
fn there(bodies: &[u32], priorities: &[i32]) -> u32 {
    let priority = |body: &u32| priorities[*body as usize - 1];
    let highest = bodies.iter().map(priority).max();
    let last = bodies
        .iter()
        .rev()
        .find(|body| Some(priority(body)) == highest);
    last.copied().unwrap_or(0)
}

/// Paths that enter and leave bodies in any order know what is where, and which surfaces are hidden.
#[test]
fn nested_bodies_are_those_that_were_entered_and_not_left() {
    let mut rng = Rng::new(3);
    for priorities in [&[0, 0, 0, 0, 0][..], &[-3, 0, 0, 0, 7], &[1, 2, 3, 4, 5]] {
        let data = media(priorities);
        let buffers = data.buffers();
        let d = Scalar::new(&buffers);
        let hit = SurfaceHit {
            u: 0.2,
            v: 0.2,
            prim: Uint(0),
        };
        let mut seen = [0; 2];
        for _ in 0..200 {
            let mut bodies: Vec<u32> = Vec::new();
            let mut packed = 0;
            for _ in 0..40 {
                let enters = bodies.is_empty()
                    || (bodies.len() < Nested::BODIES as usize && rng.range(0.0, 1.0) < 0.5);
                let (interior, dir) = match enters {
                    true => (1 + (rng.range(0.0, 1.0) * 5.0) as u32, -1.0),
                    false => (
                        bodies[(rng.range(0.0, 1.0) * bodies.len() as f64) as usize],
                        1.0,
                    ),
                };
                let surface = Surface::new(d, Attributes::NONE, &hit, vec3(0.0, 0.0, dir));
                assert_eq!(surface.front, enters);
                let here = there(&bodies, priorities);
                let mut after = bodies.clone();
                match enters {
                    true => after.push(interior),
                    false => {
                        let last = after.iter().rposition(|body| *body == interior).unwrap();
                        after.remove(last);
                    }
                }
                let beyond = there(&after, priorities);
                let path = path(d, packed);
                assert_eq!(Nested.medium(d, path.state), Uint(here));
                let crossing =
                    Nested.crossing(d, path.state.media(d), surface.front, Uint(interior));
                let goes_before = |body: u32| {
                    body != 0 && priorities[body as usize - 1] > priorities[interior as usize - 1]
                };
                let hidden = if enters {
                    goes_before(here)
                } else {
                    here != interior
                };
                assert_eq!(crossing.hidden, Some(hidden), "{bodies:?} → {after:?}");
                seen[usize::from(hidden)] += 1;
                if crossing.hidden == Some(false) {
                    let around = if enters { here } else { beyond };
                    assert_eq!(crossing.around, Some(1.0 + around as f32 / 16.0));
                }
                (bodies, packed) = (after, crossing.beyond.0);
                assert_eq!(
                    Nested.medium(d, path.state.in_media(d, Uint(packed))),
                    Uint(beyond)
                );
            }
        }
        assert!(seen.iter().all(|&count| count > 500), "{seen:?}");
    }
}

/// Of more bodies than a path remembers, it forgets the ones of the lowest priority, and leaves what it forgot without a fault.
#[test]
fn too_many_bodies_are_forgotten_from_below() {
    let priorities = [1, 2, 3, 4, 5, 6];
    let data = media(&priorities);
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let mut packed = 0;
    for body in [3, 1, 6, 2, 5, 4] {
        packed = Nested.crossing(d, Uint(packed), true, Uint(body)).beyond.0;
    }
    for (left, then) in [(6, 5), (1, 5), (5, 4), (2, 4), (4, 3), (3, 0)] {
        packed = Nested.crossing(d, Uint(packed), false, Uint(left)).beyond.0;
        let state = path(d, packed).state;
        assert_eq!(Nested.medium(d, state), Uint(then), "after {left}");
    }
}

/// The density is 1 over all directions, its mean cosine is its parameter, and samples are as the density says.
#[test]
fn the_phase_function_is_sampled_as_it_is() {
    let mut family = Family::default();
    let data = media(&[]);
    let buffers = data.buffers();
    let d = Precise::new(&buffers);
    let hit = SurfaceHit {
        u: 0.2,
        v: 0.2,
        prim: Uint(0),
    };
    let surface = Surface::new(d, Attributes::NONE, &hit, vec3(0.0, 0.0, -1.0));
    let wo = vec3(UP[0], UP[1], UP[2]);
    for g in [-0.99, -0.6, -1e-3, 0.0, 1e-6, 0.3, 0.9, 0.99] {
        let phase = HenyeyGreenstein(g);
        let steps = 2_000_000;
        let (mut mass, mut mean) = (0.0, 0.0);
        for step in 0..steps {
            let cos = 2.0 * (f64::from(step) + 0.5) / f64::from(steps) - 1.0;
            let sin = (1.0 - cos * cos).sqrt();
            let value = phase.eval(d, &surface, wo, vec3(sin, 0.0, -cos));
            assert_eq!(value.value.x, value.pdf);
            let share = value.pdf * 4.0 * std::f64::consts::PI / f64::from(steps);
            mass += share;
            mean += share * cos;
        }
        // Of the narrowest peaks the quadrature is off.
        let tolerance = if g.abs() > 0.95 { 1e-4 } else { 1e-6 };
        assert!((mass - 1.0).abs() < tolerance, "{g}: {mass}");
        assert!((mean - g).abs() < tolerance, "{g}: {mean}");

        let mut rng = Rng::new(11);
        let mut moments = [Mean::default(), Mean::default()];
        for _ in 0..100_000 {
            let u = [
                rng.range(0.0, 1.0),
                rng.range(0.0, 1.0),
                rng.range(0.0, 1.0),
            ];
            let sample = phase.sample(d, &surface, wo, u);
            let cos = -sample.wi.z;
            let length = sample.wi.dot(d, sample.wi);
            assert!((length - 1.0).abs() < 1e-7, "{g}: {length}");
            let value = phase.eval(d, &surface, wo, sample.wi);
            assert!((value.pdf / sample.pdf - 1.0).abs() < 1e-6, "{g}");
            moments[0].add(cos);
            moments[1].add(cos * cos);
        }
        // ∫ p cos² of Henyey and Greenstein: P₂ has the coefficient g².
        for (moment, expected) in moments.iter().zip([g, (1.0 + 2.0 * g * g) / 3.0]) {
            family.add_z(moment.z(expected, 1e-4), format!("g {g}: {expected}"));
        }
    }
    family.assert_plausible();
}

/// In f32 the same to rounding, and finite at both ends.
#[test]
fn the_phase_function_in_single_precision() {
    let data = media(&[]);
    let buffers = data.buffers();
    let (single, double) = (Scalar::new(&buffers), Precise::new(&buffers));
    let hit = SurfaceHit {
        u: 0.2,
        v: 0.2,
        prim: Uint(0),
    };
    let surface = Surface::new(single, Attributes::NONE, &hit, vec3(0.0, 0.0, -1.0));
    let hit = SurfaceHit {
        u: 0.2,
        v: 0.2,
        prim: Uint(0),
    };
    let reference = Surface::new(double, Attributes::NONE, &hit, vec3(0.0, 0.0, -1.0));
    for g in [-0.99_f32, -0.5, 0.0, 0.25, 0.99] {
        for step in 0..=1000 {
            let u = (step as f32 / 1000.0).min(1.0 - f32::EPSILON / 2.0);
            let a =
                HenyeyGreenstein(g).sample(single, &surface, vec3(0.0, 0.0, 1.0), [u, 0.25, 0.0]);
            let b = HenyeyGreenstein(f64::from(g)).sample(
                double,
                &reference,
                vec3(0.0, 0.0, 1.0),
                [f64::from(u), 0.25, 0.0],
            );
            let off = (f64::from(a.wi.z) - b.wi.z).abs();
            assert!(off < 5e-4, "{g} {u}: {} {}", a.wi.z, b.wi.z);
            assert!(a.pdf.is_finite() && a.pdf > 0.0, "{g} {u}: {}", a.pdf);
        }
    }
}

/// What gets through, and what is scattered on the way, weighed: for each colour Beer's law and the albedo of the rest.
#[test]
fn rays_get_as_far_as_their_colours_do() {
    let mut family = Family::default();
    let data = media(&[]);
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let medium = MediumRecord::<Scalar<'_>> {
        halvings: vec3(0.2, 1.5, 0.0),
        ior: 1.0,
        albedo: vec3(0.9, 0.5, 0.7),
        anisotropy: 0.0,
        above: Uint(1),
        around_camera: Uint(0),
    };
    let matter = AbsorptionAndScattering {
        sampler: Independent,
    };
    for throughput in [[1.0, 1.0, 1.0], [0.0, 1.0, 0.0], [0.1, 3.0, 1e-9]] {
        for length in [0.01_f32, 0.7, 5.0] {
            let mut through = [Mean::default(), Mean::default(), Mean::default()];
            let mut scattered = [Mean::default(), Mean::default(), Mean::default()];
            let mut farther = [Mean::default(), Mean::default(), Mean::default()];
            for index in 0..100_000 {
                let path = Path {
                    throughput: throughput.into(),
                    key: SampleKey::new(d, Uint(3), Uint(4), Uint(index), Uint(5)),
                    ..path(d, 0)
                };
                let passage = matter.passage(d, &path, &medium, length);
                let scattering = passage.scattering.unwrap();
                let weight = passage.weight.to_array().map(f64::from);
                assert!(weight.iter().all(|w| w.is_finite() && *w >= 0.0));
                assert_eq!(scattering.happens, scattering.distance < length);
                for k in 0..3 {
                    let is_far = scattering.distance > 0.5 * length;
                    let here = |there: bool| if there { weight[k] } else { 0.0 };
                    through[k].add(here(!scattering.happens));
                    scattered[k].add(here(scattering.happens));
                    farther[k].add(here(scattering.happens && is_far));
                }
            }
            for k in 0..3 {
                if throughput[k] == 0.0 {
                    continue;
                }
                let h = [0.2_f64, 1.5, 0.0][k];
                let albedo = f64::from([0.9_f32, 0.5, 0.7][k]);
                let left = |length: f64| (-h * length).exp2();
                let length = f64::from(length);
                let name = format!("{throughput:?} {length} {k}");
                // What a colour that is hardly there weighs is as noisy as that says.
                for (mean, expected) in [
                    (&through[k], left(length)),
                    (&scattered[k], albedo * (1.0 - left(length))),
                    (&farther[k], albedo * (left(0.5 * length) - left(length))),
                ] {
                    family.add_z(mean.z(expected, 1e-4), name.clone());
                }
            }
        }
    }
    family.assert_plausible();
}
