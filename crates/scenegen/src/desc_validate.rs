//! The invariants of [`SceneDesc`], checked.

use crate::desc::{
    AlphaMode, Attenuation, CameraDesc, LightDesc, MaterialDesc, MeshDesc, Projection,
    PunctualKind, SceneDesc, SurfaceDesc, Texels,
};
use crate::desc_inputs::MaterialInput;

mod poses;

/// A broken invariant.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {problem}")]
pub struct Violation {
    /// Path into the description, such as `meshes[2].normals`.
    pub place: String,
    /// What is wrong.
    pub problem: String,
}

type Check = Result<(), Violation>;

fn require(holds: bool, place: impl FnOnce() -> String, problem: &str) -> Check {
    if holds {
        Ok(())
    } else {
        Err(Violation {
            place: place(),
            problem: problem.to_owned(),
        })
    }
}

impl SceneDesc {
    /// Checks every invariant that the module documentation of [`crate::desc`] names.
    pub fn validate(&self) -> Result<(), Violation> {
        require(
            self.origin.is_finite(),
            || "origin".to_owned(),
            "is not finite",
        )?;
        for (i, image) in self.images.iter().enumerate() {
            let expected = u64::from(image.width) * u64::from(image.height);
            let (count, is_valid) = match &image.texels {
                Texels::Rgba8(texels) => (texels.len(), true),
                Texels::Rgba16(texels) => (texels.len(), true),
                Texels::RgbaF32(texels) => (
                    texels.len(),
                    texels
                        .iter()
                        .flatten()
                        .all(|&value| value.is_finite() && value >= 0.0),
                ),
            };
            let place = || format!("images[{i}]");
            require(
                expected > 0 && count as u64 == expected,
                place,
                "does not have width · height > 0 texels",
            )?;
            require(is_valid, place, "has a non-finite or negative texel")?;
        }
        for (i, texture) in self.textures.iter().enumerate() {
            require(
                texture.image < self.images.len(),
                || format!("textures[{i}].image"),
                "is out of range",
            )?;
        }
        for (i, material) in self.materials.iter().enumerate() {
            self.check_material(i, material)?;
        }
        for (i, mesh) in self.meshes.iter().enumerate() {
            self.check_mesh(i, mesh)?;
        }
        self.check_poses()?;
        if let Some(environment) = &self.environment {
            let place = || "environment".to_owned();
            let image = self.images.get(environment.image);
            let is_linear = image.is_some_and(|image| matches!(image.texels, Texels::RgbaF32(_)));
            require(is_linear, place, "has no linear image")?;
            require(
                environment.rotation.is_finite(),
                place,
                "has a non-finite rotation",
            )?;
            require(
                environment.strength.is_finite() && environment.strength >= 0.0,
                place,
                "has a bad strength",
            )?;
        }
        Ok(())
    }

    fn check_material(&self, i: usize, material: &MaterialDesc) -> Check {
        let place = |field: &str| format!("materials[{i}].{field}");
        match &material.surface {
            SurfaceDesc::MetallicRoughness(surface) => {
                let is_valid =
                    surface.ior.is_finite() && (surface.ior == 0.0 || surface.ior >= 1.0);
                require(is_valid, || place("ior"), "is neither 0 nor at least 1")?;
                let is_valid = surface
                    .attenuation
                    .is_none_or(|Attenuation { color, distance }| {
                        let is_share = |c: &f32| *c > 0.0 && *c <= 1.0;
                        color.iter().all(is_share) && distance > 0.0 && distance.is_finite()
                    });
                require(
                    is_valid,
                    || place("attenuation"),
                    "has no colour in (0, 1] or no positive distance",
                )?;
                let is_valid = surface.scattering.is_none_or(|scattering| {
                    let mut colors = scattering.multiscatter_color.iter();
                    colors.all(|c| (0.0..=1.0).contains(c)) && scattering.anisotropy.abs() < 1.0
                });
                require(
                    is_valid,
                    || place("scattering"),
                    "has no colour in [0, 1] or no anisotropy in (-1, 1)",
                )?;
                require(
                    surface.dispersion.is_finite() && surface.dispersion >= 0.0,
                    || place("dispersion"),
                    "is not finite and non-negative",
                )?;
                require(
                    surface.anisotropy_rotation.is_finite(),
                    || place("anisotropy_rotation"),
                    "is not finite",
                )?;
                require(
                    surface.iridescence_ior.is_finite() && surface.iridescence_ior >= 1.0,
                    || place("iridescence_ior"),
                    "is not at least 1",
                )?;
                require(
                    surface.iridescence_minimum.is_finite() && surface.iridescence_minimum >= 0.0,
                    || place("iridescence_minimum"),
                    "is not finite and non-negative",
                )?;
            }
            SurfaceDesc::Phong(_) | SurfaceDesc::Mirror { .. } | SurfaceDesc::Unlit => {}
            SurfaceDesc::Checkerboard { squares, .. } => require(
                squares.iter().all(|count| count.is_finite()),
                || place("squares"),
                "is not finite",
            )?,
            SurfaceDesc::Dielectric { ior, transmittance } => {
                require(
                    ior.is_finite() && *ior > 0.0,
                    || place("ior"),
                    "is not positive",
                )?;
                require_color(transmittance, || place("transmittance"))?;
            }
        }
        for (name, input) in material.inputs() {
            match input {
                MaterialInput::Color(color) => require_color(&color.factor, || place(name))?,
                MaterialInput::Scalar(scalar) => {
                    require(
                        scalar.factor.is_finite() && scalar.factor >= 0.0,
                        || place(name),
                        "is not finite and non-negative",
                    )?;
                    let channel = scalar.texture.as_ref().map_or(0, |(_, channel)| *channel);
                    require(channel < 4, || place(name), "reads a channel beyond alpha")?;
                }
                MaterialInput::Normal(map) => require(
                    map.scale.is_finite(),
                    || place(name),
                    "has a non-finite scale",
                )?,
            }
        }
        if let AlphaMode::Mask(cutoff) = material.alpha_mode {
            require(
                cutoff.is_finite(),
                || place("alpha_mode"),
                "has a non-finite cutoff",
            )?;
        }
        for texture in material.textures() {
            require(
                texture.texture < self.textures.len(),
                || place("textures"),
                "an index is out of range",
            )?;
            require(
                texture.uv_set < 2,
                || place("textures"),
                "a uv_set is neither 0 nor 1",
            )?;
            let is_finite = texture
                .transform
                .iter()
                .flatten()
                .flatten()
                .all(|value| value.is_finite());
            require(is_finite, || place("textures"), "a transform is not finite")?;
        }
        Ok(())
    }

    fn check_mesh(&self, i: usize, mesh: &MeshDesc) -> Check {
        let place = |field: &str| format!("meshes[{i}].{field}");
        let count = mesh.positions.len();
        require(
            mesh.material < self.materials.len(),
            || place("material"),
            "is out of range",
        )?;
        require(
            mesh.positions.iter().all(|value| value.is_finite()),
            || place("positions"),
            "is not finite",
        )?;
        require(
            mesh.normals.len() == count,
            || place("normals"),
            "is not as long as positions",
        )?;
        let are_unit = mesh
            .normals
            .iter()
            .all(|normal| is_unit(normal.length_squared()));
        require(are_unit, || place("normals"), "is not of unit length")?;
        if let Some(tangents) = &mesh.tangents {
            require(
                tangents.len() == count,
                || place("tangents"),
                "is not as long as positions",
            )?;
            let is_valid = |tangent: &glam::Vec4| {
                is_unit(tangent.truncate().length_squared()) && tangent.w.abs() == 1.0
            };
            require(
                tangents.iter().all(is_valid),
                || place("tangents"),
                "is not of unit length with w = ±1",
            )?;
        }
        for uvs in mesh.uvs.iter().flatten() {
            require(
                uvs.len() == count,
                || place("uvs"),
                "is not as long as positions",
            )?;
            require(
                uvs.iter().all(|uv| uv.is_finite()),
                || place("uvs"),
                "is not finite",
            )?;
        }
        if let Some(colors) = &mesh.colors {
            require(
                colors.len() == count,
                || place("colors"),
                "is not as long as positions",
            )?;
            require(
                colors.iter().all(|color| color.is_finite()),
                || place("colors"),
                "is not finite",
            )?;
        }
        let in_range = mesh
            .triangles
            .iter()
            .flatten()
            .all(|&corner| (corner as usize) < count);
        require(in_range, || place("triangles"), "an index is out of range")
    }
}

fn require_color(color: &[f32; 3], place: impl FnOnce() -> String) -> Check {
    let is_valid = color.iter().all(|value| value.is_finite() && *value >= 0.0);
    require(is_valid, place, "is not finite and non-negative")
}

fn is_unit(length_squared: f32) -> bool {
    (length_squared - 1.0).abs() < 1e-4
}

fn check_light(i: usize, light: &LightDesc) -> Check {
    let place = || format!("lights[{i}]");
    let is_valid = light
        .intensity
        .iter()
        .all(|value| value.is_finite() && *value >= 0.0);
    require(is_valid, place, "has a negative or non-finite intensity")?;
    let largest = match light.is_directional() {
        true => std::f32::consts::PI,
        false => f32::MAX,
    };
    let has_size = light.size >= 0.0 && light.size <= largest;
    require(
        has_size,
        place,
        "has a negative or non-finite size, or an angle above π",
    )?;
    match light.kind {
        PunctualKind::Point { position } => {
            require(position.is_finite(), place, "has a non-finite position")
        }
        PunctualKind::Spot {
            position,
            direction,
            inner,
            outer,
        } => {
            require(position.is_finite(), place, "has a non-finite position")?;
            require(
                is_unit(direction.length_squared()),
                place,
                "has no unit direction",
            )?;
            let is_cone = inner >= 0.0
                && inner <= outer
                && outer > 0.0
                && outer <= std::f32::consts::FRAC_PI_2;
            require(
                is_cone,
                place,
                "has a cone without 0 ≤ inner ≤ outer ≤ π/2, outer > 0",
            )
        }
        PunctualKind::Directional { direction } => require(
            is_unit(direction.length_squared()),
            place,
            "has no unit direction",
        ),
    }
}

fn check_camera(i: usize, camera: &CameraDesc) -> Check {
    let place = || format!("cameras[{i}]");
    require(
        camera.position.is_finite(),
        place,
        "has a non-finite position",
    )?;
    require(
        is_unit(camera.rotation.length_squared()),
        place,
        "has no unit rotation",
    )?;
    let is_frame = |aspect: f32| aspect > 0.0 && aspect.is_finite();
    require(
        camera.frame_aspect.is_none_or(is_frame),
        place,
        "has a frame of no positive width over height",
    )?;
    match camera.projection {
        Projection::Perspective { yfov } => require(
            yfov > 0.0 && yfov < std::f32::consts::PI,
            place,
            "has a field of view outside (0, π)",
        ),
        Projection::Orthographic { ymag } => require(
            ymag > 0.0 && ymag.is_finite(),
            place,
            "has a height that is not positive",
        ),
    }
}
