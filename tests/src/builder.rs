//! Scenes, built step by step.

use glam::{Affine3A, Mat3, Quat, Vec3};
use residual_scenegen::desc::{
    CameraDesc, EnvironmentDesc, Filter, ImageDesc, InstanceDesc, LightDesc, MaterialDesc,
    MeshDesc, Projection, PunctualKind, SceneDesc, Texels, TextureDesc, TextureUse, Wrap,
};

/// A scene in the making.
#[derive(Default)]
pub struct Builder {
    scene: SceneDesc,
}

impl Builder {
    /// An empty scene of this name.
    pub fn new(name: &str) -> Self {
        Self {
            scene: SceneDesc {
                name: name.to_owned(),
                ..SceneDesc::default()
            },
        }
    }

    /// A scene that there is, to be added to.
    pub fn of(scene: SceneDesc) -> Self {
        Self { scene }
    }

    /// Adds meshes of one material.
    pub fn add(&mut self, material: MaterialDesc, meshes: impl IntoIterator<Item = MeshDesc>) {
        for mesh in meshes {
            let number = self.scene.meshes.len();
            self.scene.instances.push(InstanceDesc {
                name: format!("node {number}"),
                mesh: number,
                transform: Affine3A::IDENTITY,
            });
            self.scene.meshes.push(MeshDesc {
                material: self.scene.materials.len(),
                ..mesh
            });
        }
        self.scene.materials.push(material);
    }

    /// Adds a light.
    pub fn light(&mut self, kind: PunctualKind, intensity: [f32; 3]) {
        self.scene.lights.push(LightDesc {
            name: "light".to_owned(),
            kind,
            intensity,
            size: 0.0,
        });
    }

    /// Gives the last light a [size](LightDesc::size).
    pub fn size_of_light(&mut self, size: f32) {
        self.scene.lights.last_mut().expect("a light").size = size;
    }

    /// Adds a camera that looks from one point at another.
    pub fn camera(&mut self, name: &str, eye: [f32; 3], target: [f32; 3], projection: Projection) {
        let (position, target) = (Vec3::from(eye), Vec3::from(target));
        let back = (position - target).normalize();
        let right = Vec3::Y.cross(back).normalize();
        let rotation = Quat::from_mat3(&Mat3::from_cols(right, back.cross(right), back));
        self.scene.cameras.push(CameraDesc {
            name: name.to_owned(),
            position,
            rotation,
            projection,
            frame_aspect: None,
            clip: None,
        });
    }

    /// Adds a coloured image of bytes, all texels different; its alpha takes all values.
    pub fn bytes(&mut self, width: u32, height: u32) -> usize {
        let texel = |i: u32| {
            let x = i.wrapping_mul(2_654_435_761) >> 7;
            [
                x as u8,
                (x >> 8) as u8,
                (x >> 16) as u8,
                (i * 255 / (width * height - 1)) as u8,
            ]
        };
        self.image(
            width,
            height,
            Texels::Rgba8((0..width * height).map(texel).collect()),
        )
    }

    /// Adds an image of floating-point numbers, brighter at the top.
    pub fn floats(&mut self, width: u32, height: u32) -> usize {
        let texel = |i: u32| {
            let (x, y) = (i % width, i / width);
            let up = 1.0 - y as f32 / height as f32;
            [up * 1.5, up + 0.1 * (x % 3) as f32, 0.4, 1.0]
        };
        self.image(
            width,
            height,
            Texels::RgbaF32((0..width * height).map(texel).collect()),
        )
    }

    fn image(&mut self, width: u32, height: u32, texels: Texels) -> usize {
        let name = format!("image {}", self.scene.images.len());
        self.scene.images.push(ImageDesc {
            name,
            width,
            height,
            texels,
        });
        self.scene.images.len() - 1
    }

    /// Adds a texture.
    pub fn texture(&mut self, image: usize, wrap: [Wrap; 2], filter: Filter) -> TextureUse {
        self.scene.textures.push(TextureDesc {
            image,
            wrap,
            filter,
        });
        TextureUse {
            texture: self.scene.textures.len() - 1,
            uv_set: 0,
            transform: None,
        }
    }

    /// Puts an image around everything, turned by `rotation` radians about the vertical.
    pub fn environment(&mut self, image: usize, strength: f32, rotation: f32) {
        self.scene.environment = Some(EnvironmentDesc {
            image,
            strength,
            rotation,
        });
    }

    /// The scene.
    ///
    /// # Panics
    /// If it breaks an invariant of descriptions.
    pub fn finish(self) -> SceneDesc {
        self.scene.validate().expect("a valid fixture");
        self.scene
    }
}
