//! Which camera the user wants.

/// Which camera is wanted.
#[derive(Debug, Clone, Default, PartialEq)]
pub enum CameraChoice {
    /// The scene's first, or one that frames the scene.
    #[default]
    Default,
    /// The scene's camera of this name or index.
    Named(String),
    /// Given outright.
    View(View),
}

/// A pinhole camera given by the user. What is `None` is taken from the default camera, but for `up`, which is +Y.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct View {
    /// Eye.
    pub eye: Option<[f64; 3]>,
    /// Direction of view, of any length.
    pub dir: Option<[f64; 3]>,
    /// A direction that is up in the image; need not be perpendicular to `dir`.
    pub up: Option<[f64; 3]>,
    /// Vertical field of view in degrees.
    pub fov: Option<f32>,
}
