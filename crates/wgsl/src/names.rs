//! Types and numbers as WGSL spells them.

use residual_render::domain::tape::{Kind, ParameterKind};

pub(super) fn type_name(kind: ParameterKind) -> &'static str {
    match kind {
        ParameterKind::Real => "f32",
        ParameterKind::Word => "u32",
        ParameterKind::Truth => "bool",
        ParameterKind::Vector => "vec3f",
    }
}

pub(super) fn kind_name(kind: Kind) -> &'static str {
    match kind {
        Kind::Real => "f32",
        Kind::Word => "u32",
        Kind::Truth => "bool",
    }
}

/// A constant; reals in the shortest form that reads back as the same number.
pub(super) fn constant(kind: Kind, bits: u32) -> String {
    match kind {
        Kind::Real => {
            let value = f32::from_bits(bits);
            assert!(value.is_finite(), "recorded constants are finite");
            format!("{value:?}f")
        }
        Kind::Word if bits > 0xffff => format!("{bits:#x}u"),
        Kind::Word => format!("{bits}u"),
        Kind::Truth => (bits != 0).to_string(),
    }
}
