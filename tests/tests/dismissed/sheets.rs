//! Sheets of a material, planned and rendered.

use glam::{Vec2, Vec3, Vec4};
use residual_device_cpu::LaneCount;
use residual_scenegen::desc::{
    AlphaMode, ColorInput, Filter, MaterialDesc, MetallicRoughness, PhongSurface, Projection,
    PunctualKind, ScalarInput, SceneDesc, SurfaceDesc, Texels, TextureUse, Wrap,
};
use residual_scenegen::effects::Effect;
use residual_scenegen::plan::{Binding, Plan, PlanOptions, plan};
use residual_tests::fixtures::{
    Builder, color, material, matte, metallic_roughness, scalar, sheet,
};
use residual_tests::tiny::SIZE;
use residual_tests::{Look, Prepared};

/// A texture of a material and what it amounts to.
pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) texels: Texels,
    /// Another value of the texel that no ray reads: with it, the texture stays. None where it makes no difference.
    pub(crate) far: Option<Texels>,
    pub(crate) material: fn(TextureUse) -> MaterialDesc,
    pub(crate) dismissed: &'static [(Effect, &'static str)],
    pub(crate) out: &'static [Effect],
    /// A number or a colour that takes the texture's place among the parameters.
    pub(crate) becomes: Option<&'static [f64]>,
}

const SIDE: u32 = 16;

pub(crate) fn bytes(texel: [u8; 4]) -> Texels {
    Texels::Rgba8(vec![texel])
}

pub(crate) fn floats(texel: [f32; 4]) -> Texels {
    Texels::RgbaF32(vec![texel])
}

/// An image of one texel everywhere, but for the one in the corner that is not read.
fn fill(texel: &Texels, far: Option<&Texels>) -> Texels {
    fn all<T: Copy>(texel: T, far: T) -> Vec<T> {
        let mut texels = vec![texel; (SIDE * SIDE) as usize];
        *texels.last_mut().unwrap() = far;
        texels
    }
    match (texel, far.unwrap_or(texel)) {
        (Texels::Rgba8(texel), Texels::Rgba8(far)) => Texels::Rgba8(all(texel[0], far[0])),
        (Texels::RgbaF32(texel), Texels::RgbaF32(far)) => Texels::RgbaF32(all(texel[0], far[0])),
        (Texels::Rgba16(texel), Texels::Rgba16(far)) => Texels::Rgba16(all(texel[0], far[0])),
        _ => unreachable!("both are bytes or both are numbers"),
    }
}

/// Two sheets of the material, one before the other, under a point light.
pub(crate) fn scene(case: &Case, far: Option<&Texels>) -> SceneDesc {
    let mut b = Builder::new("sheets");
    let image = b.bytes(SIDE, SIDE);
    let texture = b.texture(image, [Wrap::Clamp; 2], Filter::Linear);
    let meshes = [0.0, 0.3].map(|z| {
        let mut mesh = sheet([-1.0 + z, -0.8, z], [1.6, 0.0, 0.0], [0.0, 1.6, 0.2]);
        // Far from the last texel.
        for uv in mesh.uvs[0].iter_mut().flatten() {
            *uv = Vec2::splat(0.2) + *uv * 0.4;
        }
        mesh.tangents = Some(vec![Vec4::new(1.0, 0.0, 0.0, 1.0); 4]);
        mesh
    });
    b.add(
        material("back", matte([0.5; 3])),
        [sheet([-2.0, -2.0, -1.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0])],
    );
    b.add((case.material)(texture), meshes);
    let position = Vec3::new(0.3, 0.5, 2.0);
    b.light(PunctualKind::Point { position }, [3.0, 2.5, 2.0]);
    let lens = Projection::Perspective { yfov: 0.6 };
    b.camera("camera", [0.1, 0.2, 3.0], [0.0, 0.0, 0.0], lens);
    let mut scene = b.finish();
    scene.images[image].texels = fill(&case.texels, far);
    scene.validate().unwrap();
    scene
}

pub(crate) fn planned(scene: &SceneDesc, binding: Binding) -> Plan {
    let options = PlanOptions {
        binding,
        size: SIZE,
        ..PlanOptions::default()
    };
    plan(scene, &options).unwrap()
}

pub(crate) fn picture(plan: &Plan, max_depth: u32) -> Vec<[f32; 3]> {
    let look = Look {
        max_depth,
        ..Look::new(SIZE, 8)
    };
    Prepared::new(plan, LaneCount::Eight)
        .interpret(&look)
        .image()
}

pub(crate) fn surface(surface: MetallicRoughness) -> MaterialDesc {
    material("case", SurfaceDesc::MetallicRoughness(surface))
}

pub(crate) fn plastic() -> MetallicRoughness {
    metallic_roughness([0.5; 3], 0.0, 0.5)
}

pub(crate) fn channel(factor: f32, texture: TextureUse, channel: usize) -> ScalarInput {
    ScalarInput {
        factor,
        texture: Some((texture, channel)),
    }
}

pub(crate) fn colored(factor: [f32; 3], texture: TextureUse) -> ColorInput {
    ColorInput {
        factor,
        texture: Some(texture),
    }
}

pub(crate) fn alpha(mode: AlphaMode, factor: f32, texture: TextureUse) -> MaterialDesc {
    MaterialDesc {
        alpha_mode: mode,
        alpha: channel(factor, texture, 3),
        ..material("case", matte([0.5; 3]))
    }
}

pub(crate) fn painted(factor: [f32; 3], texture: TextureUse) -> MaterialDesc {
    let surface = PhongSurface {
        diffuse: colored(factor, texture),
        specular: color([0.0; 3]),
        exponent: scalar(0.0),
    };
    material("case", SurfaceDesc::Phong(surface))
}
