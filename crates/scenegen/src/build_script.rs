//! Renderers in other programs: [`generate`] is called from a build script and writes the renderer of a scene, which
//! the program includes. The program imports and plans the scene again, for its data, and checks with
//! [`Plan::check_structure`] that they are data for this renderer. `examples/embed` is such a program.

use std::env::{self, VarError};
use std::fs;
use std::path::{Path, PathBuf};

use crate::desc::Warning;
use crate::emit::rust;
use crate::import::{self, ImportError, ImportOptions, import};
use crate::plan::{Plan, PlanError, PlanOptions, plan};

/// Name of the file in `OUT_DIR`.
pub const FILE_NAME: &str = "residual_scene.rs";

/// Why no renderer was written.
#[derive(Debug, thiserror::Error)]
pub enum BuildScriptError {
    /// A variable that cargo sets for build scripts is not there.
    #[error("{name}: {source}; call this from a build script, which cargo runs")]
    Variable {
        /// Its name.
        name: &'static str,
        /// What is wrong with it.
        source: VarError,
    },
    /// The scene was not imported.
    #[error(transparent)]
    Import(#[from] ImportError),
    /// The scene was not planned.
    #[error("{}: {source}", scene.display())]
    Plan {
        /// The scene.
        scene: PathBuf,
        /// Why.
        source: PlanError,
    },
    /// The file was not written.
    #[error("{}: {source}; check that the directory exists and has room", file.display())]
    Write {
        /// The file.
        file: PathBuf,
        /// Why.
        source: std::io::Error,
    },
}

/// Writes the renderer of a scene to `$OUT_DIR/residual_scene.rs`, for the target's instruction set, and tells cargo
/// which files it depends on. A relative path starts, as build scripts do, at the embedding crate's manifest.
///
/// # Errors
/// If the scene cannot be imported or planned, or the file not written.
pub fn generate(scene: impl AsRef<Path>, options: &PlanOptions) -> Result<(), BuildScriptError> {
    let directory = PathBuf::from(variable("OUT_DIR")?);
    // Targets without any features have no such variable.
    let lanes = lanes(&variable("CARGO_CFG_TARGET_FEATURE").unwrap_or_default());
    let plan = plan_scene(scene, options)?;
    let file = directory.join(FILE_NAME);
    fs::write(&file, rust::module(&plan, lanes))
        .map_err(|source| BuildScriptError::Write { file, source })
}

/// The plan of a scene, for build scripts that emit something else of it; tells cargo which files it depends on, and passes
/// warnings on.
///
/// # Errors
/// If the scene cannot be imported or planned.
pub fn plan_scene(
    scene: impl AsRef<Path>,
    options: &PlanOptions,
) -> Result<Plan, BuildScriptError> {
    let scene = scene.as_ref();
    // First of all: cargo has to look at them again after a failure, too.
    for file in dependencies(scene) {
        println!("cargo::rerun-if-changed={}", file.display());
    }
    let (plan, warnings) = load(scene, options)?;
    for Warning { place, message, .. } in &warnings {
        // A line break would end the instruction, and the rest might be another one.
        let text = format!("{}: {place}: {message}", scene.display()).replace(['\r', '\n'], " ");
        println!("cargo::warning={text}");
    }
    Ok(plan)
}

fn variable(name: &'static str) -> Result<String, BuildScriptError> {
    env::var(name).map_err(|source| BuildScriptError::Variable { name, source })
}

fn load(scene: &Path, options: &PlanOptions) -> Result<(Plan, Vec<Warning>), BuildScriptError> {
    let desc = import(scene, &ImportOptions::default())?;
    let plan = plan(&desc, options).map_err(|source| BuildScriptError::Plan {
        scene: scene.to_owned(),
        source,
    })?;
    let warnings = desc
        .warnings
        .into_iter()
        .chain(plan.warnings.iter().cloned())
        .collect();
    Ok((plan, warnings))
}

/// The variant of the CPU device's `LaneCount` that suits a target with these features.
fn lanes(features: &str) -> &'static str {
    let has = |name| features.split(',').any(|feature| feature == name);
    if has("avx512f") {
        "Sixteen"
    } else if has("avx2") {
        "Eight"
    } else {
        "Four"
    }
}

/// The scene and the files it refers to: by name for glTF, for other formats everything beside it.
fn dependencies(scene: &Path) -> Vec<PathBuf> {
    let mut files = vec![scene.to_owned()];
    match import::external_files(scene) {
        Some(external) => files.extend(external),
        None => files.extend(scene.parent().map(|folder| Path::new(".").join(folder))),
    }
    files
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_follow_the_target() {
        let cases = [
            ("", "Four"),
            ("fxsr,sse,sse2", "Four"),
            ("avx,avx2,fma", "Eight"),
            ("avx2,avx512bw,avx512f", "Sixteen"),
            ("avx512fp16", "Four"),
            ("neon", "Four"),
        ];
        for (features, expected) in cases {
            assert_eq!(lanes(features), expected, "{features}");
        }
    }

    #[test]
    fn the_build_depends_on_what_the_scene_names() {
        let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
        let names = |scene: &str| -> Vec<String> {
            let files = dependencies(&scenes.join(scene));
            files
                .iter()
                .map(|file| file.strip_prefix(&scenes).unwrap().display().to_string())
                .collect()
        };
        assert_eq!(names("cornell-box.gltf"), ["cornell-box.gltf"]);
        assert_eq!(names("cornell-box.obj"), ["cornell-box.obj", ""]);
        let textured = names("textured.gltf");
        assert!(textured.contains(&"textured.bin".to_owned()));
        assert!(textured.contains(&"textures/wood.png".to_owned()));
        assert_eq!(textured.len(), 7, "{textured:?}");
    }
}
