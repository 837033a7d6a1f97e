//! Tests of alpha as Mitsuba's `mask`, which lets rays through by chance, or always, or never.
//!
//! What is let through counts as a vertex of the path there, but not here.

use residual_render::program::{AlphaTestNode, ImageNode, ScalarNode};

use super::textures::Textures;
use super::xml::Element;

/// The BSDF where the test of alpha passes, and nothing elsewhere.
///
/// # Errors
/// What of the test has no counterpart.
pub(super) fn masked(
    bsdf: Element,
    test: &AlphaTestNode,
    textures: &mut Textures<'_>,
) -> Result<Element, String> {
    let mask = Element::plugin("bsdf", "mask").child(bsdf);
    let unknown = || "alpha that is more than a factor of an image".to_owned();
    match test {
        AlphaTestNode::AlphaMask { alpha, cutoff, .. } => {
            let ScalarNode::Const(cutoff) = *cutoff else {
                return Err(unknown());
            };
            let (factor, image) = factor_and_image(alpha).ok_or_else(unknown)?;
            Ok(mask.child(textures.at_least("opacity", (factor, cutoff), image)?))
        }
        AlphaTestNode::AlphaBlend { alpha, .. } => {
            if let ScalarNode::Const(alpha) = alpha {
                return Ok(mask.float("opacity", alpha));
            }
            let (factor, image) = factor_and_image(alpha).ok_or_else(unknown)?;
            Ok(mask.child(textures.number("opacity", factor, image)?))
        }
    }
}

fn factor_and_image(alpha: &ScalarNode) -> Option<(f32, &ImageNode)> {
    match alpha {
        ScalarNode::Image(image) => Some((1.0, image)),
        ScalarNode::Product(factor, image) => match (&**factor, &**image) {
            (ScalarNode::Const(factor), ScalarNode::Image(image)) => Some((*factor, image)),
            _ => None,
        },
        _ => None,
    }
}
