//! wgpu's experimental features.

/// wgpu's consent to features that it calls experimental: shaders that it does not translate.
pub(crate) fn experimental_features() -> wgpu::ExperimentalFeatures {
    // SAFETY: the only experimental feature that is asked for is passing shaders through, and `shader.rs` says what
    // makes them sound.
    unsafe { wgpu::ExperimentalFeatures::enabled() }
}
