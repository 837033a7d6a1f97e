//! What textures read from a material's parameter block, and of the levels of images. A number is a word; the rest are records.

use crate::record::record;

record! {
    /// A colour.
    pub struct ColorParam {
        row {
            /// Linear Rec. 709.
            color: vector,
        }
    }
}

record! {
    /// An image among the texels.
    pub struct ImageParam {
        row {
            /// Its first word in [`Buffer::Texels`](crate::domain::Buffer::Texels).
            first: word,
            /// Width in texels.
            width: word,
            /// Height in texels.
            height: word,
            /// The first word among the texels of the levels of the image, a record of this kind each, from the image itself
            /// to the level of one texel. Only where it is read by [`Trilinear`](super::Trilinear).
            levels: word,
        }
    }
}

record! {
    /// An affine map of texture coordinates: the matrix of KHR_texture_transform.
    pub struct TransformParam {
        row {
            /// What (u, v, 1) is multiplied with to give u.
            u: vector,
        }
        row {
            /// What (u, v, 1) is multiplied with to give v.
            v: vector,
        }
    }
}
