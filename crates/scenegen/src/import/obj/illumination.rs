//! The illumination models of MTL, as far as they differ in what is rendered.

/// What the number behind `illum` asks for.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Illumination {
    /// 0 and 1.
    Diffuse,
    /// 2, and those whose difference from it is not rendered.
    Highlight,
    /// 3, 5 and 8, "reflection on".
    Reflection,
    /// 4, "transparency: glass".
    Glass,
    /// 6, 7 and 9.
    Refraction,
}

impl Illumination {
    /// That of a number.
    pub(super) fn new(illum: f32) -> Self {
        if illum < 2.0 {
            Self::Diffuse
        } else if [3.0, 5.0, 8.0].contains(&illum) {
            Self::Reflection
        } else if illum == 4.0 {
            Self::Glass
        } else if [6.0, 7.0, 9.0].contains(&illum) {
            Self::Refraction
        } else {
            Self::Highlight
        }
    }
}
