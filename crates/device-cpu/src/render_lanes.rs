//! From a lane count to the tile loop in its domain.

/// Calls [`render_tiles`](crate::tile::render_tiles) in the domain of one lane count, named by its variant of
/// [`LaneCount`](crate::LaneCount), on the machine's instruction set, with the scene that `|buffers| scene` makes.
#[macro_export]
macro_rules! render_lanes {
    (One, $($rest:tt)*) => { $crate::render_lanes!(@ Scalar, $($rest)*) };
    (Four, $($rest:tt)*) => { $crate::render_lanes!(@ Lanes4, $($rest)*) };
    (Eight, $($rest:tt)*) => { $crate::render_lanes!(@ Lanes8, $($rest)*) };
    (Sixteen, $($rest:tt)*) => { $crate::render_lanes!(@ Lanes16, $($rest)*) };
    (@ $domain:ident, $view:expr, $job:expr, $samples:expr, |$buffers:ident| $scene:expr) => {{
        use $crate::generated::fearless_simd::{Level, dispatch};
        let view: &$crate::SceneView<'_> = $view;
        let $buffers = &view.buffers;
        dispatch!(Level::new(), simd => {
            let d = $crate::render_lanes!(# $domain, simd, $buffers);
            $crate::tile::render_tiles(d, &$scene, view, $job, $samples)
        })
    }};
    (# Scalar, $simd:ident, $buffers:ident) => {{
        let _ = $simd;
        $crate::generated::render::domain::Scalar::new($buffers)
    }};
    (# $domain:ident, $simd:ident, $buffers:ident) => {
        $crate::generated::render::domain::$domain::new($simd, $buffers)
    };
}
