//! What textures read from a material's parameter block. A number is a word; the rest are records.

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
