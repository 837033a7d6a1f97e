//! What the user wants besides the file.

use std::path::PathBuf;

/// Options of an import.
#[derive(Debug, Clone, Default)]
pub struct ImportOptions {
    /// Light from infinitely far away.
    pub environment: Option<EnvironmentOptions>,
    /// The set of materials to show, by its name, of files that have several (KHR_materials_variants).
    pub variant: Option<String>,
    /// The animation to show a moment of, by its name or index; all together without one.
    pub animation: Option<String>,
    /// The moment of animations to show, in seconds; without one, files are shown as their nodes stand.
    pub time_code: Option<f64>,
    /// The moments while the shutter is open, in seconds and in order, a power of two of them; they take the place of
    /// `time_code`. None where the shutter is closed.
    pub moments: Vec<f64>,
    /// Whether warnings are errors.
    pub strict: bool,
}

/// Light from infinitely far away, from a latitude-longitude image.
#[derive(Debug, Clone)]
pub struct EnvironmentOptions {
    /// A `.hdr`, `.exr` or 8-bit image; the latter is decoded from sRGB.
    pub path: PathBuf,
    /// Factor on radiance.
    pub strength: f32,
    /// Turn about +Y.
    pub rotation_degrees: f32,
}
