//! Lights with a size: suns with an angle, point and spot lights with a radius. Their shadows have soft edges.
//!
//! They are found by sampling them, from a cone of directions, and by nothing else: camera rays and reflections do not see
//! them, as they do not see lights without a size, whose records these lights have. What a sample brings is therefore
//! radiance over density, which is finite for any size, with 1 for its density.

use super::cone::in_cone;
use super::punctual::{EVERYWHERE, PunctualRecord, all_directions};
use super::{Emission, EmissionNumbers, LightKind, LightSample, NOT_FOUND};
use crate::domain::{Bundle, Domain};
use crate::math::vec3::vec3;
use crate::math::{Frame, Vec3, warp};
use crate::surface::PathRay;

/// Shines from a disc of the sky, evenly bright.
#[derive(Clone, Copy, Debug)]
pub struct Sun;
/// A sphere, evenly bright wherever it is seen from.
#[derive(Clone, Copy, Debug)]
pub struct SphericalPoint;
/// A sphere of which every point shines into a cone: in each direction as much as a spot does.
#[derive(Clone, Copy, Debug)]
pub struct SphericalSpot;

impl<D: Domain> LightKind<D> for Sun {
    #[inline(always)]
    fn sample(&self, d: D, record: D::U, _: Vec3<D::F>, u: [D::F; 3]) -> LightSample<D> {
        let record = PunctualRecord::of_light(d, record);
        let (wi, _) = in_cone(d, record.position, record.edge, [u[0], u[1]]);
        LightSample {
            wi,
            position: wi,
            infinite: d.truth(true),
            radiance: record.intensity,
            pdf: d.lit(1.0),
            delta: d.truth(true),
            spread: d.lit(0.0),
        }
    }

    #[inline(always)]
    fn emit(&self, d: D, record: D::U, u: EmissionNumbers<D::F>) -> Emission<D> {
        let record = PunctualRecord::of_light(d, record);
        let (wi, _) = in_cone(d, record.position, record.edge, u.place);
        let found = d.lit(NOT_FOUND);
        Emission::from_afar(d, wi, record.intensity, found, u.direction)
    }
}

/// A sample of the sphere of a record, which shines everywhere, and the unit axis of a spot.
///
/// Of the sphere the point sees the cone of half-angle α, sin α = radius / distance (PBRT 4, 6.2.4). Its radiance is
/// I / (π r²), and the cone's solid angle 2π·(1 − cos α) with 1 − cos α = sin² α / (1 + cos α): what a sample brings is
/// 2·I / (d²·(1 + cos α)), a point light's I / d² where the sphere is far. Within the sphere its inner side is all around.
#[inline(always)]
fn sphere<D: Domain>(
    d: D,
    record: &PunctualRecord<D>,
    from: Vec3<D::F>,
    u: [D::F; 3],
) -> (LightSample<D>, Vec3<D::F>) {
    let (one, two) = (d.lit(1.0), d.lit(2.0));
    let radius = record.axis.length(d);
    let towards = record.position - from;
    let squared = towards.dot(d, towards);
    let is_centre = d.lt(squared, d.lit(1e-30));
    let squared = d.select(is_centre, d.lit(1e-30), squared);
    let distance = d.sqrt(squared);
    let axis = Vec3::choose(
        d,
        is_centre,
        vec3(d.lit(0.0), d.lit(0.0), one),
        towards.scale(one / distance),
    );
    let radius_squared = radius * radius;
    let is_within = d.le(squared, radius_squared);
    let sine_squared = d.min(radius_squared / squared, one);
    let more_than_one = one + d.sqrt(one - sine_squared);
    let widest = d.select(is_within, two, sine_squared / more_than_one);
    let (wi, versine) = in_cone(d, axis, widest, [u[0], u[1]]);
    // From the middle of the chord to its end that is seen.
    let half_chord = radius_squared - squared * versine * (two - versine);
    let half_chord = d.sqrt(d.max(half_chord, d.lit(0.0)));
    let to_middle = distance * (one - versine);
    let reach = d.select(is_within, to_middle + half_chord, to_middle - half_chord);
    let weight = d.select(
        is_within,
        d.lit(4.0) / radius_squared,
        two / (squared * more_than_one),
    );
    let sample = LightSample {
        wi,
        position: from + wi.scale(reach),
        infinite: d.truth(false),
        radiance: record.intensity.scale(weight),
        pdf: one,
        delta: d.truth(true),
        spread: d.lit(EVERYWHERE),
    };
    (sample, record.axis.scale(one / radius))
}

/// Light that leaves a point light's place, as light that leaves a sphere around it: in a direction of the same distribution, from
/// a place evenly distributed over what is seen of the sphere from there.
#[inline(always)]
fn off_sphere<D: Domain>(d: D, radius: D::F, point: Emission<D>, u: [D::F; 2]) -> Emission<D> {
    let dir = point.ray.dir;
    let frame = Frame::around(d, dir);
    let [x, y] = warp::disc(d, u).map(|c| c * radius);
    let ahead = d.sqrt(d.lit(1.0) - u[0]) * radius;
    let place = frame.to_world(vec3(x, y, ahead));
    Emission {
        ray: PathRay::unbounded(d, point.ray.org + place, dir),
        ..point
    }
}

impl<D: Domain> LightKind<D> for SphericalPoint {
    #[inline(always)]
    fn sample(&self, d: D, record: D::U, from: Vec3<D::F>, u: [D::F; 3]) -> LightSample<D> {
        let record = PunctualRecord::of_light(d, record);
        sphere(d, &record, from, u).0
    }

    #[inline(always)]
    fn emit(&self, d: D, record: D::U, u: EmissionNumbers<D::F>) -> Emission<D> {
        let record = PunctualRecord::of_light(d, record);
        let (point, _) = record.leaving(d, all_directions(d), u.direction);
        off_sphere(d, record.axis.length(d), point, u.place)
    }
}

impl<D: Domain> LightKind<D> for SphericalSpot {
    #[inline(always)]
    fn sample(&self, d: D, record: D::U, from: Vec3<D::F>, u: [D::F; 3]) -> LightSample<D> {
        let record = PunctualRecord::of_light(d, record);
        let (everywhere, axis) = sphere(d, &record, from, u);
        record.within_cone(d, axis, everywhere)
    }

    #[inline(always)]
    fn emit(&self, d: D, record: D::U, u: EmissionNumbers<D::F>) -> Emission<D> {
        let record = PunctualRecord::of_light(d, record);
        let radius = record.axis.length(d);
        let axis = record.axis.scale(d.lit(1.0) / radius);
        let point = record.leaving_spot(d, axis, u.direction);
        off_sphere(d, radius, point, u.place)
    }
}
