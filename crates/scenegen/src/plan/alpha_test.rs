//! Alpha tests: whether a material needs one, and which.

use residual_render::program::AlphaTestNode;

use super::opacity::Opacity;
use super::program::Builder;
use crate::desc::{AlphaMode, MaterialDesc};
use crate::effect::Effect;

impl Builder<'_> {
    /// Whether alpha can fail its test, and whether it always does.
    pub(super) fn opacity(&mut self, desc: &MaterialDesc) -> Opacity {
        // Filtering stays between the extremes of the texels, but for rounding.
        const ROUNDING: f32 = 1e-5;
        if desc.alpha_mode == AlphaMode::Opaque {
            return Opacity::Opaque;
        }
        let Some([least, greatest]) = self.sources.alpha_extremes(&desc.alpha) else {
            return Opacity::Tested;
        };
        let (effect, always, never) = match desc.alpha_mode {
            AlphaMode::Opaque => return Opacity::Opaque,
            AlphaMode::Mask(cutoff) if least == greatest => {
                (Effect::AlphaMasks, least >= cutoff, least < cutoff)
            }
            AlphaMode::Mask(cutoff) => (
                Effect::AlphaMasks,
                cutoff <= 0.0 || least >= cutoff + ROUNDING,
                greatest < cutoff - ROUNDING,
            ),
            AlphaMode::Blend => (Effect::AlphaBlending, least >= 1.0, greatest <= 0.0),
        };
        if always {
            self.sources
                .dismiss(effect, "its alpha lets nothing through");
            Opacity::Opaque
        } else if never {
            self.sources
                .dismiss(effect, "its alpha lets everything through");
            Opacity::Transparent
        } else {
            Opacity::Tested
        }
    }

    /// The test of a material's alpha; `None` if it has none.
    pub(super) fn alpha_test(&mut self, desc: &MaterialDesc) -> Option<AlphaTestNode> {
        let alpha = self.sources.alpha(&desc.alpha);
        let attributes = self.sources.read(&alpha);
        match desc.alpha_mode {
            AlphaMode::Opaque => None,
            AlphaMode::Mask(cutoff) => Some(AlphaTestNode::AlphaMask {
                alpha,
                cutoff: self.sources.number(cutoff),
                attributes,
            }),
            AlphaMode::Blend => Some(AlphaTestNode::AlphaBlend { alpha, attributes }),
        }
    }
}
