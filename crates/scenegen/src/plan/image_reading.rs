//! How a texture's image is read: wraps and filters.

use residual_render::texture::{AnyFilter, AnyFormat, AnyWrap};

use super::options::TextureResolution;
use crate::desc::{Filter, Wrap};

/// How coordinates outside of the image are read.
pub(super) fn wrap(wrap: Wrap) -> AnyWrap {
    match wrap {
        Wrap::Repeat => AnyWrap::Repeat,
        Wrap::Mirror => AnyWrap::MirroredRepeat,
        Wrap::Clamp => AnyWrap::Clamp,
        Wrap::WhiteBorder => AnyWrap::WhiteBorder,
        Wrap::BlackBorder => AnyWrap::BlackBorder,
    }
}

/// The same of a map of normals: around the image, they are those of the mesh.
pub(super) fn wraps_of_normals((u, v): (AnyWrap, AnyWrap)) -> (AnyWrap, AnyWrap) {
    let of_normals = |wrap| match wrap {
        AnyWrap::WhiteBorder | AnyWrap::BlackBorder => AnyWrap::FlatBorder,
        wrap => wrap,
    };
    (of_normals(u), of_normals(v))
}

/// How texels are combined whose bytes are read as `bytes` says. Colours may be filtered over what a ray stands for: the means
/// of other things are those of another material.
pub(super) fn filter(filter: Filter, textures: TextureResolution, bytes: AnyFormat) -> AnyFilter {
    match (filter, textures, bytes) {
        (Filter::Nearest, ..) => AnyFilter::Nearest,
        (Filter::Mipmapped, TextureResolution::Filtered, AnyFormat::SrgbRgba8) => {
            AnyFilter::Trilinear
        }
        (Filter::Linear | Filter::Mipmapped, ..) => AnyFilter::Bilinear,
    }
}

/// The least and greatest value of an image's channel, and of what is around it.
pub(super) fn with_border([least, greatest]: [f32; 2], wrap: [Wrap; 2]) -> [f32; 2] {
    let around = wrap.into_iter().filter_map(|wrap| match wrap {
        Wrap::WhiteBorder => Some(1.0),
        Wrap::BlackBorder => Some(0.0),
        Wrap::Repeat | Wrap::Mirror | Wrap::Clamp => None,
    });
    around.fold([least, greatest], |[least, greatest], around| {
        [least.min(around), greatest.max(around)]
    })
}
