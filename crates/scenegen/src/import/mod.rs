//! Importers: scene files of others as a [`SceneDesc`], the first step of the chain file → description →
//! plan → program.
//!
//! ```text
//! .gltf, .glb ─ gltf ─┬─ RawMesh ─ mesh ─▶ MeshDesc ─ instances ─▶ InstanceDesc ─┐
//! .obj, .mtl ── obj ──┼─ MaterialDesc, TextureDesc; lights and cameras of glTF ──┼▶ SceneDesc ─ validate
//!                     └─ ImageRequest ─ images ─▶ ImageDesc ─────────────────────┤
//! the user's image ──── environment ─▶ EnvironmentDesc ──────────────────────────┘
//! ```
//!
//! Each format has a room; what both fill lies beside them. Files are not trusted: every index and size is
//! checked before it is used, decoded data is charged to a `budget`, and a malformed file ends in an
//! [`ImportError`], never in a panic. What a file asks for and we do not render is a warning; under
//! [`ImportOptions::strict`] an error.

use std::path::Path;

use self::error::Fault;
use self::warnings::Warnings;
use crate::desc::SceneDesc;

mod budget;
mod environment;
mod error;
mod files;
mod folders;
mod gltf;
mod guard;
mod images;
mod instances;
mod mesh;
mod missing_uvs;
mod obj;
mod options;
mod origin;
mod percent;
mod text;
mod warnings;

pub use error::ImportError;
pub(crate) use gltf::external_files;
pub use options::{EnvironmentOptions, ImportOptions};

/// Reads a scene; its extension says how.
pub fn import(path: &Path, options: &ImportOptions) -> Result<SceneDesc, ImportError> {
    let mut warnings = Warnings::default();
    let extension = path
        .extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_ascii_lowercase();
    let mut scene = match extension.as_str() {
        "gltf" | "glb" => gltf::import(path, options, &mut warnings)?,
        "obj" => {
            if options.variant.is_some() {
                warnings.push("variant", "OBJ files have no variants; ignored");
            }
            let is_timed = options.time_code.is_some() || !options.moments.is_empty();
            if is_timed || options.animation.is_some() {
                warnings.push("animation", "OBJ files have no animations; ignored");
            }
            obj::import(path, &mut warnings)?
        }
        _ => {
            return Err(ImportError::UnknownFormat {
                file: path.to_owned(),
            });
        }
    };
    scene.name = path
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    if let Some(environment) = &options.environment {
        environment::append(&mut scene, environment, &mut warnings)?;
    }
    if scene.instances.is_empty() {
        warnings.push("scene", "has nothing to render");
    }
    origin::warn_about_lost_details(&scene, &mut warnings);
    scene.dismissed = warnings.take_dismissed();
    scene.warnings = warnings.into_vec();
    if let Err(violation) = scene.validate() {
        // Values the checks above did not foresee; better refused here than rendered as NaN.
        return Err(Fault::new(violation.place, violation.problem).in_file(path));
    }
    if options.strict && !scene.warnings.is_empty() {
        return Err(ImportError::Strict {
            file: path.to_owned(),
            warnings: scene.warnings,
        });
    }
    Ok(scene)
}
