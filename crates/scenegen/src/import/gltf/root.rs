//! The JSON of a glTF file.
//!
//! It is read into `gltf::json` types without that crate's validation, which refuses extensions we can read
//! and indices out of bounds in others. Every index is looked up with a check instead.

use gltf::json::{Root, Value};
use serde_json::Map;

use super::json_text;
use super::repair::repair;
use crate::import::error::{Fault, MAKE_SMALLER};
use crate::import::warnings::Warnings;

/// More JSON objects than this would need gigabytes once parsed.
const MAX_JSON_OBJECTS: usize = 2_000_000;

/// Advice for files of version 1, and of versions to come.
pub(super) const CONVERT: &str = "export it as glTF 2.0, or convert it, for example with `gltf-pipeline -i old.gltf -o new.gltf`";

/// Reads the JSON of a glTF 2.0 file, which is UTF-8.
pub(super) fn parse(json: &[u8], warnings: &mut Warnings) -> Result<Root, Fault> {
    let root = parse_any_version(json, warnings)?;
    check_version(&root)?;
    Ok(root)
}

fn parse_any_version(json: &[u8], warnings: &mut Warnings) -> Result<Root, Fault> {
    if json.iter().filter(|&&byte| byte == b'{').count() > MAX_JSON_OBJECTS {
        let problem = format!("more than {MAX_JSON_OBJECTS} JSON objects");
        return Err(Fault::new("JSON", problem).advise(MAKE_SMALLER));
    }
    let error = match Root::from_slice(json) {
        Ok(root) => return Ok(root),
        Err(error) => error,
    };
    let fault = |error: serde_json::Error| {
        let place = format!("line {} column {}", error.line(), error.column());
        Fault::new(place, format!("invalid JSON or glTF: {error}"))
    };
    let mut value: Value = match serde_json::from_slice(json) {
        Ok(value) => value,
        Err(error) => {
            let mended =
                json_text::tolerant(json).and_then(|json| serde_json::from_slice(&json).ok());
            let Some(value) = mended else {
                return Err(fault(error));
            };
            let message = format!("this is no JSON ({error}), and read as what is meant");
            warnings.push("JSON", message);
            value
        }
    };
    refuse_version_1(&value)?;
    complete(&mut value);
    let remarks = repair(&mut value);
    let is_repaired = !remarks.is_empty();
    for remark in remarks {
        warnings.push("JSON", remark);
    }
    serde_json::from_value(value).map_err(|remaining| match is_repaired {
        true => Fault::new("JSON", format!("invalid glTF: {remaining}")),
        // This one knows the line.
        false => fault(error),
    })
}

/// Writes out what the specification lets files omit and the `gltf` crate wants to be there: the nodes of a scene. Channels of
/// animations that move no node are left out: nothing that is shown depends on them.
fn complete(root: &mut Value) {
    let mut each = |array: &str, change: fn(&mut Map<String, Value>)| {
        let items = root.get_mut(array).and_then(Value::as_array_mut);
        let objects = items.into_iter().flatten().filter_map(Value::as_object_mut);
        objects.for_each(change);
    };
    each("scenes", |scene| {
        scene
            .entry("nodes")
            .or_insert_with(|| Value::Array(Vec::new()));
    });
    each("animations", |animation| {
        if let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) {
            channels.retain(|channel| channel.pointer("/target/node").is_some());
        }
    });
}

fn check_version(root: &Root) -> Result<(), Fault> {
    let asset = &root.asset;
    if let Some(needed) = asset.min_version.as_ref().filter(|needed| *needed != "2.0") {
        let problem = format!("readers must know glTF {needed}; 2.0 is read");
        return Err(Fault::new("asset/minVersion", problem).advise(CONVERT));
    }
    if asset.version.starts_with("2.") {
        return Ok(());
    }
    let problem = format!("glTF version {:?} is not 2.0", asset.version);
    Err(Fault::new("asset/version", problem).advise(CONVERT))
}

/// Files of glTF 1.0 have objects where 2.0 has arrays, and often no version.
fn refuse_version_1(value: &Value) -> Result<(), Fault> {
    let version = value.get("asset").and_then(|asset| asset.get("version"));
    let says_1 = match version {
        Some(Value::String(version)) => version.starts_with("1."),
        Some(Value::Number(version)) => version.as_f64() == Some(1.0),
        _ => false,
    };
    let is_of_objects = ["buffers", "accessors", "meshes", "nodes"]
        .iter()
        .any(|array| value.get(array).is_some_and(Value::is_object));
    if says_1 || (version.is_none() && is_of_objects) {
        let problem = "this is glTF 1.0, which is another format than 2.0";
        return Err(Fault::new("asset/version", problem).advise(CONVERT));
    }
    Ok(())
}
