//! Whether emitting triangles are sampled by area or by solid angle.

use glam::DVec3;
use residual_render::domain::Buffer;
use residual_render::light::{AreaBySolidAngleRecord, AreaRecord, LIGHT_WORDS};
use residual_render::program::LightNode;
use residual_render::record::BufferRecord;
use residual_render::scene_data::SceneData;

use super::light_places_gain::{Emitter, gain};
use super::options::LightPlaces;

/// With more emitting triangles than these, each is small beside its distance, and they are not tried by solid angle.
const MANY_EMITTERS: usize = 512;
/// Triangles are sampled by solid angle where direct light has so much less [variance](gain).
const LEAST_GAIN: f64 = 1.5;

/// Whether triangles are sampled by solid angle: if it pays or is asked for. `pick` is the probability of a light at a point.
pub(super) fn by_solid_angle(
    places: LightPlaces,
    emitters: &[Emitter],
    pick: impl Fn(DVec3, usize) -> f64,
    data: &SceneData,
) -> bool {
    match places {
        LightPlaces::Area => false,
        LightPlaces::SolidAngle => true,
        LightPlaces::Auto => {
            (1..=MANY_EMITTERS).contains(&emitters.len())
                && gain(emitters, pick, data) >= LEAST_GAIN
        }
    }
}

/// Has the triangles among lights of these kinds sampled by solid angle.
pub(super) fn set_by_solid_angle(
    emitters: &[Emitter],
    kinds: &mut [LightNode],
    data: &mut SceneData,
) {
    for kind in kinds {
        if let LightNode::Area {
            emission,
            attributes,
        } = kind
        {
            *kind = LightNode::AreaBySolidAngle {
                emission: emission.clone(),
                attributes: *attributes,
            };
        }
    }
    let words = data.buffer_mut(Buffer::Lights);
    for emitter in emitters {
        let words = &mut words[emitter.light * LIGHT_WORDS as usize..];
        let AreaRecord {
            kind,
            triangle,
            double_sided,
        } = AreaRecord::from_words(words);
        let record = AreaBySolidAngleRecord {
            kind,
            triangle,
            double_sided,
            normal: emitter.across().as_vec3().to_array().into(),
        };
        record.write_to(words);
    }
}
