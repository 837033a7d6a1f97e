//! Point, spot and directional lights, with and without a size.

use std::f64::consts::PI;

use glam::Vec3;
use residual_render::light::{self, PunctualRecord};
use residual_render::program::LightNode;

use super::light_tree::{LightBounds, Reach};
use crate::desc::{LightDesc, PunctualKind};

/// What becomes of a light.
pub(super) struct Punctual {
    pub(super) node: LightNode,
    /// Its kind is not known yet.
    pub(super) record: PunctualRecord,
    pub(super) power: f64,
    pub(super) reach: Reach,
}

impl Punctual {
    /// Of a light of this luminance, in a scene of this radius; `None` if it is dark.
    pub(super) fn new(light: &LightDesc, luminance: f64, radius: f64) -> Option<Self> {
        if luminance <= 0.0 {
            return None;
        }
        let (size, intensity) = (light.size, light.intensity);
        let record = |position: Vec3| PunctualRecord::new(0, position.to_array(), intensity);
        let bounds = |position: Vec3| LightBounds {
            corners: [-size, size].map(|size| position.as_dvec3() + f64::from(size)),
            ..LightBounds::point(position.as_dvec3(), luminance)
        };
        Some(match light.kind {
            PunctualKind::Point { position } => {
                let record = record(position);
                let (node, record) = match size {
                    0.0 => (LightNode::Point, record),
                    _ => (LightNode::SphericalPoint, record.with_radius(size)),
                };
                Self {
                    node,
                    record,
                    power: 4.0 * PI * luminance,
                    reach: Reach::Bounded(bounds(position)),
                }
            }
            PunctualKind::Spot {
                position,
                direction,
                inner,
                outer,
            } => {
                let record = PunctualRecord::spot(
                    0,
                    position.to_array(),
                    intensity,
                    direction.to_array(),
                    [inner, outer],
                );
                let (node, record) = match size {
                    0.0 => (LightNode::Spot, record),
                    _ => (LightNode::SphericalSpot, record.with_radius(size)),
                };
                Self {
                    node,
                    record,
                    power: 0.5 * (4.0 * PI) * light::versine(outer) * luminance,
                    reach: Reach::Bounded(LightBounds {
                        axis: direction.as_dvec3(),
                        half_angle: 0.0,
                        ..bounds(position)
                    }),
                }
            }
            PunctualKind::Directional { direction } => {
                let towards = -direction;
                let (node, record) = match size {
                    0.0 => (LightNode::Directional, record(towards)),
                    _ => {
                        let sun = PunctualRecord::sun(0, towards.to_array(), intensity, size);
                        (LightNode::Sun, sun)
                    }
                };
                Self {
                    node,
                    record,
                    power: PI * radius * radius * luminance,
                    reach: Reach::Everywhere,
                }
            }
        })
    }
}
