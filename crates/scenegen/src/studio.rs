//! A photographer's studio for models that come without light: soft boxes before grey walls, as an environment image.
//!
//! White and black objects both stand out before grey, a key light and its fill give form, and boxes with edges show in
//! polish. It is a table ([`BOXES`]), drawn into an image when the scene is made.

use glam::Vec3;

use crate::desc::{ColorInput, EnvironmentDesc, ImageDesc, LightDesc, SceneDesc, Texels};

/// A rectangle of light, seen from the model.
struct SoftBox {
    /// Where its middle is: degrees about +Y, from +Z, which models face, to +X; degrees above the horizon.
    azimuth: f32,
    elevation: f32,
    /// Half its width and height as angles, in degrees.
    half: [f32; 2],
    /// Radiance in the middle; 1 is white paper.
    radiance: [f32; 3],
}

/// Key from the right, fill from the left, a rim from behind, and a large box overhead.
#[rustfmt::skip]
const BOXES: [SoftBox; 4] = [
    SoftBox { azimuth: 40.0, elevation: 42.0, half: [20.0, 16.0], radiance: [4.1, 3.95, 3.75] },
    SoftBox { azimuth: -62.0, elevation: 18.0, half: [22.0, 30.0], radiance: [0.66, 0.70, 0.75] },
    SoftBox { azimuth: 165.0, elevation: 38.0, half: [26.0, 10.0], radiance: [2.5, 2.6, 2.7] },
    SoftBox { azimuth: 0.0, elevation: 88.0, half: [34.0, 34.0], radiance: [0.5, 0.5, 0.5] },
];
/// Radiance of the walls at the floor, at eye level and at the ceiling.
const WALLS: [f32; 3] = [0.10, 0.22, 0.34];
/// Over so many degrees the light of a box falls off at its edges.
const EDGE: f32 = 5.0;
/// Texels along the image's height; it is twice as wide.
const HEIGHT: u32 = 128;

impl SceneDesc {
    /// Puts the scene into a studio, in place of the environment that it may have.
    pub fn add_studio(&mut self) {
        self.images.push(image());
        self.environment = Some(EnvironmentDesc {
            image: self.images.len() - 1,
            strength: 1.0,
            rotation: 0.0,
        });
    }

    /// Nothing in the scene is a lamp: there is no environment and no light that shines, and what glows is no brighter than
    /// white paper and a small part of all surfaces, as the displays of a model are.
    pub fn is_unlit(&self) -> bool {
        /// Part of all surfaces up to which glowing details are details.
        const DETAILS: f64 = 0.25;
        let shines = |light: &LightDesc| light.intensity.into_iter().any(|c| c > 0.0);
        let mut lights = self.poses().flat_map(|pose| pose.lights);
        if lights.any(shines) || self.environment.is_some() {
            return false;
        }
        let (mut all, mut glowing) = (0.0, 0.0);
        for instance in self.poses().flat_map(|pose| pose.instances) {
            let mesh = &self.meshes[instance.mesh];
            let emission = &self.materials[mesh.material].emission;
            let glow = self.glowing_part(emission);
            let brightest = emission.factor.into_iter().fold(0.0, f32::max);
            if glow > 0.0 && brightest > 1.0 {
                return false;
            }
            let place = |v: u32| {
                instance
                    .transform
                    .transform_point3(mesh.positions[v as usize])
            };
            let area = |triangle: &[u32; 3]| {
                let [a, b, c] = triangle.map(|v| place(v).as_dvec3());
                0.5 * (b - a).cross(c - a).length()
            };
            let area: f64 = mesh.triangles.iter().map(area).sum();
            all += area;
            glowing += glow * area;
        }
        glowing <= DETAILS * all
    }

    /// The part of a texture that glows, of what is brightest in it at least a hundredth; all of it or nothing without one.
    fn glowing_part(&self, emission: &ColorInput) -> f64 {
        let [r, g, b] = emission.factor;
        if r.max(g).max(b) <= 0.0 {
            return 0.0;
        }
        let Some(texture) = &emission.texture else {
            return 1.0;
        };
        let image = &self.images[self.textures[texture.texture].image];
        // Channels that the factor takes away do not glow. Codes need no decoding to be compared.
        let on = [r, g, b].map(|c| if c > 0.0 { 1.0 } else { 0.0 });
        let largest = |[a, b, c]: [f32; 3]| (a * on[0]).max(b * on[1]).max(c * on[2]);
        let values: Vec<f32> = match &image.texels {
            Texels::Rgba8(texels) => texels
                .iter()
                .map(|&[r, g, b, _]| largest([r, g, b].map(f32::from)))
                .collect(),
            Texels::Rgba16(texels) => texels
                .iter()
                .map(|&[r, g, b, _]| largest([r, g, b].map(f32::from)))
                .collect(),
            Texels::RgbaF32(texels) => texels
                .iter()
                .map(|&[r, g, b, _]| largest([r, g, b]))
                .collect(),
        };
        // A tenth of the largest code is a hundredth of its light.
        let brightest = values.iter().copied().fold(0.0, f32::max);
        let glows = |value: &&f32| brightest > 0.0 && **value >= 0.1 * brightest;
        values.iter().filter(glows).count() as f64 / values.len() as f64
    }
}

fn image() -> ImageDesc {
    let width = 2 * HEIGHT;
    let texel = |row: u32, column: u32| {
        let u = (column as f32 + 0.5) / width as f32;
        let v = (row as f32 + 0.5) / HEIGHT as f32;
        let [r, g, b] = radiance(direction(u, v));
        [r, g, b, 1.0]
    };
    let texels = (0..HEIGHT).flat_map(|row| (0..width).map(move |column| texel(row, column)));
    ImageDesc {
        name: "studio".to_owned(),
        width,
        height: HEIGHT,
        texels: Texels::RgbaF32(texels.collect()),
    }
}

/// The direction of a place in the image, as [`EnvironmentDesc`] has it.
fn direction(u: f32, v: f32) -> Vec3 {
    let around = (u - 0.5) * std::f32::consts::TAU;
    let up = (0.5 - v) * std::f32::consts::PI;
    Vec3::new(around.cos() * up.cos(), up.sin(), around.sin() * up.cos())
}

fn radiance(direction: Vec3) -> [f32; 3] {
    let [floor, wall, ceiling] = WALLS;
    let y = direction.y;
    let walls = wall + y.max(0.0) * (ceiling - wall) + y.min(0.0) * (wall - floor);
    let mut sum = [walls; 3];
    for soft in &BOXES {
        let part = soft.part(direction);
        sum = std::array::from_fn(|k| sum[k] + part * soft.radiance[k]);
    }
    sum
}

impl SoftBox {
    /// How much of its radiance comes from a direction.
    fn part(&self, direction: Vec3) -> f32 {
        let (sin_a, cos_a) = self.azimuth.to_radians().sin_cos();
        let (sin_e, cos_e) = self.elevation.to_radians().sin_cos();
        let forward = Vec3::new(sin_a * cos_e, sin_e, cos_a * cos_e);
        let right = Vec3::new(cos_a, 0.0, -sin_a);
        let up = forward.cross(right);
        let depth = direction.dot(forward);
        if depth <= 0.0 {
            return 0.0;
        }
        let along = |axis: Vec3, half: f32| {
            let angle = direction.dot(axis).atan2(depth).abs().to_degrees();
            let t = ((half - angle) / EDGE + 0.5).clamp(0.0, 1.0);
            t * t * (3.0 - 2.0 * t)
        };
        along(right, self.half[0]) * along(up, self.half[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::desc::{Filter, TextureDesc, TextureUse, Wrap};

    /// What a white, matte surface with this normal sends out: the mean radiance over its hemisphere, weighed by the cosine.
    fn white(normal: Vec3) -> [f64; 3] {
        let ImageDesc {
            width,
            height,
            texels: Texels::RgbaF32(texels),
            ..
        } = image()
        else {
            panic!("texels are floats");
        };
        let mut sums = [0.0; 3];
        let mut weights = 0.0;
        for (k, texel) in texels.iter().enumerate() {
            let (column, row) = (k as u32 % width, k as u32 / width);
            let v = (row as f32 + 0.5) / height as f32;
            let direction = direction((column as f32 + 0.5) / width as f32, v);
            let solid = f64::from((std::f32::consts::PI * v).sin());
            let weight = solid * f64::from(direction.dot(normal).max(0.0));
            weights += weight;
            sums = std::array::from_fn(|c| sums[c] + weight * f64::from(texel[c]));
        }
        sums.map(|sum| sum / weights)
    }

    #[test]
    fn white_objects_are_white_have_form_and_stand_out() {
        let directions = [
            (Vec3::new(0.5, 0.6, 0.62), "towards the key"),
            (Vec3::Y, "up"),
            (Vec3::Z, "front"),
            (Vec3::NEG_X, "left"),
        ];
        let [key, up, front, left] = directions.map(|(normal, name)| {
            let [r, g, b] = white(normal.normalize());
            println!("{name}: {r:.2} {g:.2} {b:.2}");
            // Nearly neutral.
            assert!((r / b - 1.0).abs() < 0.1, "{name}: {r} {g} {b}");
            g
        });
        // Paper that faces the key is near white and not beyond it.
        assert!((0.8..1.0).contains(&key), "{key}");
        assert!(up < 1.0 && front < 1.0);
        // Form: the shadow side is under half of the lit one.
        assert!(left < 0.5 * key, "{left} {key}");
        // The wall behind is darker than white objects, lighter than black ones.
        let wall = radiance(Vec3::NEG_Z)[1];
        assert!(
            f64::from(wall) < 0.5 * front && wall > 0.1,
            "{wall} {front}"
        );
    }

    #[test]
    fn a_model_with_glowing_details_is_unlit_and_a_lamp_is_not() {
        let scene = |factor: f32, glowing_texels: usize| {
            let mut texels = vec![[3_u8, 3, 3, 255]; 100];
            texels[..glowing_texels].fill([255; 4]);
            let mut scene = SceneDesc::default();
            scene.add_ground();
            scene.images.push(ImageDesc {
                name: "glow".to_owned(),
                width: 10,
                height: 10,
                texels: Texels::Rgba8(texels),
            });
            let input = ColorInput {
                factor: [factor; 3],
                texture: None,
            };
            (scene, input)
        };
        for (factor, glowing, part) in [(1.0, 3, 0.03), (1.0, 100, 1.0), (0.0, 100, 0.0)] {
            let (mut scene, mut input) = scene(factor, glowing);
            scene.textures.push(TextureDesc {
                image: 0,
                wrap: [Wrap::Repeat; 2],
                filter: Filter::Linear,
            });
            input.texture = Some(TextureUse {
                texture: 0,
                uv_set: 0,
                transform: None,
            });
            assert_eq!(scene.glowing_part(&input), part);
        }
        let (scene, input) = scene(0.5, 0);
        assert_eq!(scene.glowing_part(&input), 1.0);
        assert!(scene.is_unlit());
    }

    #[test]
    fn boxes_are_where_the_table_says() {
        let key = BOXES[0].part(Vec3::new(0.478, 0.669, 0.569).normalize());
        assert!(key > 0.99, "{key}");
        assert_eq!(BOXES[0].part(Vec3::NEG_Z), 0.0);
        assert!(BOXES[3].part(Vec3::Y) > 0.99);
        // The image has its top at +Y and its middle at +X.
        assert!((direction(0.5, 0.5) - Vec3::X).length() < 1e-6);
        assert!((direction(0.75, 0.5) - Vec3::Z).length() < 1e-6);
        assert!(direction(0.1, 0.001).y > 0.99);
    }
}
