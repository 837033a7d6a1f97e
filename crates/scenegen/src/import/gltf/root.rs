//! The JSON of a glTF file.
//!
//! It is read into `gltf::json` types without that crate's validation, which refuses extensions we can read
//! and indices out of bounds in others. Every index is looked up with a check instead.

use gltf::json::{Animation, Root, Value};

use crate::import::error::{Fault, MAKE_SMALLER};

/// More JSON objects than this would need gigabytes once parsed.
const MAX_JSON_OBJECTS: usize = 2_000_000;

/// Advice for files of another version.
pub(super) const EXPORT_AS_2: &str = "export it as glTF 2.0, or convert it, for example with `gltf-transform copy` or `gltf-pipeline`";

/// Reads the JSON of a glTF 2.0 file.
pub(super) fn parse(json: &[u8]) -> Result<Root, Fault> {
    let root = parse_any_version(json)?;
    check_version(&root)?;
    Ok(root)
}

/// The specification forbids a byte order mark and allows readers to skip it.
pub(super) fn without_mark(json: &[u8]) -> &[u8] {
    json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(json)
}

fn parse_any_version(json: &[u8]) -> Result<Root, Fault> {
    if json.iter().filter(|&&byte| byte == b'{').count() > MAX_JSON_OBJECTS {
        let problem = format!("more than {MAX_JSON_OBJECTS} JSON objects");
        return Err(Fault::new("JSON", problem).advise(MAKE_SMALLER));
    }
    let json = without_mark(json);
    Root::from_slice(json).or_else(|error| {
        if let Ok(value) = serde_json::from_slice(json) {
            refuse_version_1(&value)?;
        }
        parse_leniently(json).ok_or_else(|| {
            let place = format!("line {} column {}", error.line(), error.column());
            Fault::new(place, format!("invalid JSON or glTF: {error}"))
        })
    })
}

/// Second try without what the `gltf` crate is stricter about than the specification: a scene needs no
/// nodes, an animation channel needs no node, and animations are not shown anyway.
fn parse_leniently(json: &[u8]) -> Option<Root> {
    let mut value: Value = serde_json::from_slice(json).ok()?;
    let members = value.as_object_mut()?;
    let had_animations = members.remove("animations").is_some();
    for scene in members
        .get_mut("scenes")
        .and_then(Value::as_array_mut)
        .into_iter()
        .flatten()
    {
        scene
            .as_object_mut()?
            .entry("nodes")
            .or_insert_with(|| Value::Array(Vec::new()));
    }
    let mut root: Root = serde_json::from_value(value).ok()?;
    if had_animations {
        let (channels, samplers) = (Vec::new(), Vec::new());
        root.animations.push(Animation {
            extensions: None,
            extras: None,
            channels,
            name: None,
            samplers,
        });
    }
    Some(root)
}

fn check_version(root: &Root) -> Result<(), Fault> {
    let asset = &root.asset;
    if let Some(needed) = asset.min_version.as_ref().filter(|needed| *needed != "2.0") {
        let problem = format!("readers must know glTF {needed}; 2.0 is read");
        return Err(Fault::new("asset/minVersion", problem).advise(EXPORT_AS_2));
    }
    if asset.version.starts_with("2.") {
        return Ok(());
    }
    let problem = format!("glTF version {:?} is not 2.0", asset.version);
    Err(Fault::new("asset/version", problem).advise(EXPORT_AS_2))
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
        return Err(Fault::new("asset/version", problem).advise(EXPORT_AS_2));
    }
    Ok(())
}
