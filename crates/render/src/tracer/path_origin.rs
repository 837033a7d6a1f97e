//! Where paths begin.

/// Where paths begin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u32)]
pub enum PathOrigin {
    /// At the camera.
    #[default]
    Camera,
    /// At lights. Only of tracers that have light paths.
    Lights,
}
