//! Images that are there once.

use residual_render::texture::{AnyFilter, AnyWrap};

use crate::support::random::Rng;
use crate::textures::{image, numbered, sample};

const BORDERS: [(AnyWrap, f32); 3] = [
    (AnyWrap::WhiteBorder, 1.0),
    (AnyWrap::BlackBorder, 0.0),
    (AnyWrap::FlatBorder, 0.5),
];

/// An image that is there once: within it is clamped, a whole texel beyond its edge is the border, and half a texel beyond a
/// bilinear filter is between the two.
#[test]
fn images_have_borders() {
    let (width, height) = (5_u32, 3_u32);
    let data = numbered(width, height);
    let mut rng = Rng::new(118);
    for (wrap, border) in BORDERS {
        for filter in [AnyFilter::Nearest, AnyFilter::Bilinear] {
            let both = image((wrap, wrap), filter);
            let clamped = image((AnyWrap::Clamp, AnyWrap::Clamp), filter);
            for _ in 0..2000 {
                let uv = [0; 2].map(|_| rng.range(-1.0, 2.0) as f32);
                let texels = [uv[0] * width as f32, uv[1] * height as f32];
                let sizes = [width as f32, height as f32];
                // How far outside of the outermost texels' centres.
                let beyond = [0, 1].map(|k| (0.5 - texels[k]).max(texels[k] - sizes[k] + 0.5));
                let beyond = beyond[0].max(beyond[1]);
                let found = sample(&data, &both, uv);
                if beyond < 0.0 {
                    assert_eq!(found, sample(&data, &clamped, uv), "{wrap:?} {uv:?}");
                } else if beyond > 1.0 {
                    assert_eq!(found, border, "{wrap:?} {uv:?}");
                }
            }
        }
        // Along one axis alone; in the middle of a row's edge, half a texel out.
        let once = image((wrap, AnyWrap::Repeat), AnyFilter::Nearest);
        assert_eq!(
            sample(&data, &once, [0.5, 1.5]),
            sample(&data, &once, [0.5, 0.5])
        );
        assert_eq!(sample(&data, &once, [1.5, 0.5]), border);
        let soft = image((wrap, wrap), AnyFilter::Bilinear);
        let edge = sample(&data, &soft, [0.0, 0.5]);
        let texel = 1.0 + width as f32;
        assert!((edge - 0.5 * (texel + border)).abs() < 1e-5, "{edge}");
    }
}
