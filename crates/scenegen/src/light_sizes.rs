//! Sizes of lights, of which files say nothing.

use crate::desc::{LightDesc, PunctualKind, SceneDesc};

impl LightDesc {
    /// Whether it shines from infinitely far away.
    pub fn is_directional(&self) -> bool {
        matches!(self.kind, PunctualKind::Directional { .. })
    }
}

impl SceneDesc {
    /// Makes spheres of this radius, in units of the scene, of all point and spot lights; at 0 they are points.
    pub fn set_light_radius(&mut self, radius: f32) {
        let lights = self.all_lights_mut();
        for light in lights.filter(|light| !light.is_directional()) {
            light.size = radius;
        }
    }

    /// Makes discs of the sky of this angular diameter, in radians, of all directional lights; at 0 they shine in one direction.
    pub fn set_sun_angle(&mut self, angle: f32) {
        let lights = self.all_lights_mut();
        for light in lights.filter(|light| light.is_directional()) {
            light.size = angle;
        }
    }
}
