//! A camera chosen at run time: the interpreted renderer's.

use super::CameraNode;
use crate::camera::{Camera, Orthographic, Panorama, Perspective, Sight, ThinLens};
use crate::domain::Domain;
use crate::math::Vec3;
use crate::surface::PathRay;

/// Any of the cameras.
#[derive(Clone, Copy)]
#[expect(missing_docs, reason = "each variant is the type of its name")]
pub enum AnyCamera {
    Perspective(Perspective),
    ThinLens(ThinLens),
    Orthographic(Orthographic),
    Panorama(Panorama),
}

impl From<&CameraNode> for AnyCamera {
    fn from(node: &CameraNode) -> Self {
        match node {
            CameraNode::Perspective => Self::Perspective(Perspective),
            CameraNode::ThinLens => Self::ThinLens(ThinLens),
            CameraNode::Orthographic => Self::Orthographic(Orthographic),
            CameraNode::Panorama => Self::Panorama(Panorama),
        }
    }
}

/// The same call for whichever camera it is.
macro_rules! each {
    ($any:expr, $camera:ident => $call:expr) => {
        match $any {
            AnyCamera::Perspective($camera) => $call,
            AnyCamera::ThinLens($camera) => $call,
            AnyCamera::Orthographic($camera) => $call,
            AnyCamera::Panorama($camera) => $call,
        }
    };
}

impl<D: Domain> Camera<D> for AnyCamera {
    #[inline(always)]
    fn ray(&self, d: D, film: [D::F; 2], lens: [D::F; 2]) -> PathRay<D> {
        each!(self, camera => camera.ray(d, film, lens))
    }

    #[inline(always)]
    fn sight(&self, d: D, point: Vec3<D::F>, lens: [D::F; 2]) -> Sight<D> {
        each!(self, camera => camera.sight(d, point, lens))
    }

    #[inline(always)]
    fn density(&self, d: D, dir: Vec3<D::F>, distance: D::F) -> D::F {
        each!(self, camera => camera.density(d, dir, distance))
    }

    #[inline(always)]
    fn has_lens(&self) -> bool {
        each!(self, camera => Camera::<D>::has_lens(camera))
    }
}
