//! Macros around emitted code: a renderer of it, and functions that a shared library exports.

/// Makes a [`TileRenderer`](crate::TileRenderer) called `Compiled` from emitted code's `Scene`, for a lane count.
#[macro_export]
macro_rules! compiled_scene {
    ($scene:ident, $lanes:ident) => {
        /// This scene's renderer.
        #[derive(Clone, Copy, Debug)]
        pub struct Compiled;

        impl Compiled {
            /// Paths shaded at once.
            pub const LANES: $crate::LaneCount = $crate::LaneCount::$lanes;
        }

        impl $crate::TileRenderer for Compiled {
            fn layers(&self) -> $crate::generated::render::layer::Layers {
                $scene::LAYERS
            }

            fn has_light_paths(&self) -> bool {
                #[allow(
                    unused_imports,
                    reason = "a scene's own constant goes before the trait's"
                )]
                use $crate::generated::LightPaths as _;
                $scene::HAS_LIGHT_PATHS
            }

            fn render_tiles(
                &self,
                view: &$crate::SceneView<'_>,
                job: &$crate::TileJob<'_>,
                samples: &mut [f32],
            ) -> $crate::generated::render::passes::Counters {
                $crate::render_lanes!($lanes, view, job, samples, |buffers| $scene::new(buffers))
            }
        }
    };
}

/// Exports `Compiled` from a shared library.
#[macro_export]
macro_rules! export_renderer {
    () => {
        /// What this library was made for.
        #[unsafe(no_mangle)]
        pub extern "C" fn residual_identity() -> $crate::plugin::Identity {
            $crate::plugin::Identity::of(Compiled::LANES, &Compiled)
        }

        /// Renders tiles.
        ///
        /// # Safety
        /// Called by `LoadedRenderer` only.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn residual_render_tiles(call: *mut $crate::plugin::TileCall) {
            // SAFETY: the caller is `LoadedRenderer`, which made the call and waits for its end.
            unsafe { $crate::plugin::answer(call, &Compiled) }
        }
    };
}
