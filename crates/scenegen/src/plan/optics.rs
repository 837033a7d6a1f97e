//! What the user puts before the eye: a lens, and what it is focused on, or a panorama.

use std::str::FromStr;

use glam::DVec3;
use residual_render::scene_data::SceneData;
use residual_render::triangle::TriangleRecord;

use crate::desc::CameraDesc;

/// How a camera sees.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum Optics {
    /// By its projection: everything is sharp.
    #[default]
    Projection,
    /// Through a thin lens, by perspective.
    ThinLens {
        /// How far the lens is open.
        aperture: Aperture,
        /// Where everything is sharp.
        focus: Focus,
    },
    /// In all directions, as a latitude-longitude image.
    Panorama,
}

/// How far a lens is open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Aperture {
    /// Focal length over diameter, the focal length being the one at which a picture 24 mm high (that of 35 mm film) shows
    /// the camera's vertical field of view. For scenes in metres, as glTF's are.
    FNumber(f32),
    /// The diameter, in units of the scene.
    Diameter(f32),
}

/// Half the height of a picture of 35 mm film, in metres.
const HALF_PICTURE: f32 = 0.012;

impl Aperture {
    /// The radius of the lens of a camera, of whose vertical field of view half has this tangent; in units of the scene.
    pub(super) fn radius(self, tangent: f32) -> f32 {
        0.5 * match self {
            Self::FNumber(number) => HALF_PICTURE / tangent / number,
            Self::Diameter(diameter) => diameter,
        }
    }
}

/// Where everything is sharp: in a plane across the direction of view.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum Focus {
    /// Through the surface in the middle of the image.
    #[default]
    Middle,
    /// So far from the lens, in units of the scene.
    Distance(f32),
}

/// Distance of the surface that is in the middle of an image, if there is one. Alpha is taken for 1.
pub(super) fn distance_in_the_middle(camera: &CameraDesc, data: &SceneData) -> Option<f32> {
    let org = camera.position.as_dvec3();
    let dir = (camera.rotation * glam::Vec3::NEG_Z).as_dvec3();
    let triangles = data.records::<TriangleRecord>().enumerate();
    let distances = triangles.filter_map(|(index, triangle)| {
        let is_culled = data.single_sided.get(index).is_some_and(|&is| is);
        distance(org, dir, triangle.corners(), is_culled)
    });
    distances.reduce(f64::min).map(|distance| distance as f32)
}

/// Distance at which a ray meets a triangle (Möller and Trumbore 1997).
fn distance(org: DVec3, dir: DVec3, corners: [[f32; 3]; 3], is_culled: bool) -> Option<f64> {
    let [a, b, c] = corners.map(|corner| DVec3::from_array(corner.map(f64::from)));
    let (ab, ac, to_org) = (b - a, c - a, org - a);
    let (p, q) = (dir.cross(ac), to_org.cross(ab));
    let determinant = ab.dot(p);
    // Positive where the ray meets the front.
    if determinant == 0.0 || (is_culled && determinant < 0.0) {
        return None;
    }
    let (u, v) = (to_org.dot(p) / determinant, dir.dot(q) / determinant);
    let distance = ac.dot(q) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0).then_some(distance)
}

fn positive(text: &str) -> Option<f32> {
    let number: f32 = text.trim().parse().ok()?;
    (number > 0.0 && number.is_finite()).then_some(number)
}

impl FromStr for Aperture {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let aperture = match text.strip_prefix("f/") {
            Some(number) => positive(number).map(Self::FNumber),
            None => positive(text).map(Self::Diameter),
        };
        aperture.ok_or("expected an f-number as in f/2.8, or a diameter greater than zero")
    }
}

impl FromStr for Focus {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text {
            "auto" => Ok(Self::Middle),
            _ => positive(text)
                .map(Self::Distance)
                .ok_or("expected a distance greater than zero, or auto"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn apertures_and_distances_parse() {
        assert_eq!("f/2.8".parse(), Ok(Aperture::FNumber(2.8)));
        assert_eq!("0.25".parse(), Ok(Aperture::Diameter(0.25)));
        assert_eq!("auto".parse(), Ok(Focus::Middle));
        assert_eq!("3".parse(), Ok(Focus::Distance(3.0)));
        for wrong in ["f/0", "f2", "-1", "nan", "inf", ""] {
            assert!(wrong.parse::<Aperture>().is_err() && wrong.parse::<Focus>().is_err());
        }
    }

    /// 50 mm at f/2 is an opening of 25 mm. At 50 mm, a picture 24 mm high has 27° (26.99°).
    #[test]
    fn f_numbers_are_those_of_35_mm_film() {
        let tangent = (26.991_f32.to_radians() * 0.5).tan();
        let radius = Aperture::FNumber(2.0).radius(tangent);
        assert!((radius - 0.0125).abs() < 1e-6, "{radius}");
        assert_eq!(Aperture::Diameter(0.5).radius(tangent), 0.25);
    }

    #[test]
    fn rays_meet_triangles_from_their_fronts() {
        let corners = [[0.0, 0.0, -3.0], [1.0, 0.0, -3.0], [0.0, 1.0, -3.0]];
        let org = DVec3::new(0.2, 0.3, 1.0);
        for is_culled in [false, true] {
            assert_eq!(distance(org, DVec3::NEG_Z, corners, is_culled), Some(4.0));
            assert_eq!(distance(org, DVec3::Z, corners, is_culled), None);
            let beside = DVec3::new(0.6, 0.6, 1.0);
            assert_eq!(distance(beside, DVec3::NEG_Z, corners, is_culled), None);
        }
        let behind = DVec3::new(0.2, 0.3, -5.0);
        assert_eq!(distance(behind, DVec3::Z, corners, false), Some(2.0));
        assert_eq!(distance(behind, DVec3::Z, corners, true), None);
    }
}
