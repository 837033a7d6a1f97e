//! KHR_draco_mesh_compression: primitives whose indices and attributes are stored in one compressed piece. What is decoded
//! takes the place of the elements of the accessors that the primitive names.

use std::collections::HashMap;

use draco_core::mesh::Mesh;
use draco_core::mesh_decoder::MeshDecoder;
use draco_core::{DecodeLimits, DecoderBuffer};
use gltf::json::accessor::ComponentType;
use gltf::json::mesh::Primitive;
use gltf::json::validation::Checked;
use gltf::json::{Index, Root, Value, buffer};

use super::lookup::{get, place};
use crate::import::budget::Budget;
use crate::import::error::Fault;
use crate::import::guard::without_panic;
use crate::import::warnings::Warnings;

/// The extension's name.
pub(super) const EXTENSION: &str = "KHR_draco_mesh_compression";

/// The most bytes that one primitive may become.
const MAX_BYTES: u64 = 1 << 30;

/// The elements of an accessor, one behind the other.
pub(super) struct Elements {
    /// Of each component.
    pub(super) component: ComponentType,
    /// How many elements.
    pub(super) count: usize,
    /// Little-endian.
    pub(super) bytes: Vec<u8>,
}

/// What the primitive says of its compressed piece.
pub(super) fn of_primitive(primitive: &Primitive) -> Option<&Value> {
    let extensions = primitive.extensions.as_ref()?;
    extensions.others.get(EXTENSION)
}

/// Decodes all compressed primitives: elements by the index of their accessor. `view` gives the bytes of a buffer view.
pub(super) fn decode_all<'a>(
    root: &Root,
    view: &dyn Fn(Index<buffer::View>, &str) -> Result<&'a [u8], Fault>,
    warnings: &mut Warnings,
) -> Result<HashMap<usize, Elements>, Fault> {
    let is_required = root
        .extensions_required
        .iter()
        .any(|name| name == EXTENSION);
    let mut budget = Budget::geometry();
    let mut decoded = HashMap::new();
    for (index, mesh) in root.meshes.iter().enumerate() {
        for (k, primitive) in mesh.primitives.iter().enumerate() {
            let Some(json) = of_primitive(primitive) else {
                continue;
            };
            let at = place("meshes", index, mesh.name.as_deref());
            let at = format!("{at}/primitives/{k}/extensions/{EXTENSION}");
            let result = decode(root, primitive, json, view, &at, &mut budget, &mut decoded);
            match result {
                Ok(()) => {}
                Err(fault) if is_required => return Err(fault),
                Err(fault) => {
                    let message = format!("{}; the uncompressed data is used", fault.problem);
                    warnings.push(fault.place, message);
                }
            }
        }
    }
    Ok(decoded)
}

fn decode<'a>(
    root: &Root,
    primitive: &Primitive,
    json: &Value,
    view: &dyn Fn(Index<buffer::View>, &str) -> Result<&'a [u8], Fault>,
    at: &str,
    budget: &mut Budget,
    decoded: &mut HashMap<usize, Elements>,
) -> Result<(), Fault> {
    let index = |value: Option<&Value>, name: &str| {
        let index = value.and_then(Value::as_u64);
        index
            .and_then(|index| u32::try_from(index).ok())
            .ok_or_else(|| Fault::new(at, format!("{name} is no index")))
    };
    let bytes = view(Index::new(index(json.get("bufferView"), "bufferView")?), at)?;
    let mesh = without_panic(|| {
        let limits = DecodeLimits::default().with_max_decoded_bytes(MAX_BYTES);
        let mut buffer = DecoderBuffer::new(bytes).with_limits(limits);
        let mut mesh = Mesh::new();
        let status = MeshDecoder::new().decode(&mut buffer, &mut mesh);
        status
            .map(|()| mesh)
            .map_err(|error| format!("the compressed data cannot be decoded ({error:?})"))
    })
    .map_err(|problem| Fault::new(at, problem))?;

    let indices = primitive.indices.ok_or_else(|| {
        Fault::new(
            at,
            "the primitive has no indices to put the decoded ones in",
        )
    })?;
    let corners = mesh.faces().iter().flatten();
    let count = 3 * mesh.num_faces();
    budget.charge(count as u64, 4, at)?;
    let elements = Elements {
        component: ComponentType::U32,
        count,
        bytes: corners.flat_map(|corner| corner.0.to_le_bytes()).collect(),
    };
    decoded.insert(indices.value(), elements);

    let attributes = json.get("attributes").and_then(Value::as_object);
    for (semantic, &accessor) in &primitive.attributes {
        let Checked::Valid(semantic) = semantic else {
            continue;
        };
        let name = semantic.to_string();
        let Some(id) = attributes.and_then(|attributes| attributes.get(&name)) else {
            continue;
        };
        let id = index(Some(id), &name)?;
        let attribute = mesh.attribute_by_unique_id(id);
        let attribute =
            attribute.ok_or_else(|| Fault::new(at, format!("has no attribute {id} for {name}")))?;
        let description = get(&root.accessors, accessor, "accessors", at)?;
        let (Checked::Valid(kind), Checked::Valid(component)) =
            (description.type_, description.component_type)
        else {
            let here = place("accessors", accessor.value(), description.name.as_deref());
            return Err(Fault::new(here, "has an unknown type or componentType"));
        };
        let (points, components) = (mesh.num_points(), kind.multiplicity());
        let size = (components * component.0.size()) as u64;
        budget.charge(points as u64, size, at)?;
        let values = attribute.read_f32s(points, components);
        let elements = Elements {
            component: component.0,
            count: points,
            bytes: encoded(&values, component.0),
        };
        decoded.insert(accessor.value(), elements);
    }
    Ok(())
}

/// Numbers as an accessor stores them: integers are whole in the compressed data, too.
fn encoded(values: &[f32], component: ComponentType) -> Vec<u8> {
    let values = values.iter().copied();
    match component {
        ComponentType::I8 => values.map(|value| value as i8 as u8).collect(),
        ComponentType::U8 => values.map(|value| value as u8).collect(),
        ComponentType::I16 => values
            .flat_map(|value| (value as i16).to_le_bytes())
            .collect(),
        ComponentType::U16 => values
            .flat_map(|value| (value as u16).to_le_bytes())
            .collect(),
        ComponentType::U32 => values
            .flat_map(|value| (value as u32).to_le_bytes())
            .collect(),
        ComponentType::F32 => values.flat_map(f32::to_le_bytes).collect(),
    }
}
