//! EXT_mesh_gpu_instancing: copies of a node's mesh.

use glam::{DAffine3, DQuat, DVec3};
use gltf::json::{Index, Value};

use super::accessors::Accessors;
use super::nodes::PlacedNode;
use crate::import::error::Fault;

const EXTENSION: &str = "EXT_mesh_gpu_instancing";

/// From each copy's space to that of the node; one identity where the node has no copies.
pub(super) fn copies(
    placed: &PlacedNode<'_>,
    accessors: &mut Accessors<'_>,
) -> Result<Vec<DAffine3>, Fault> {
    let extensions = placed.node.extensions.as_ref();
    let Some(instancing) = extensions.and_then(|extensions| extensions.others.get(EXTENSION))
    else {
        return Ok(vec![DAffine3::IDENTITY]);
    };
    let at = format!("{}/extensions/{EXTENSION}", placed.place);
    let accessor = |name: &str| -> Result<Option<Index<_>>, Fault> {
        let Some(value) = instancing
            .get("attributes")
            .and_then(|attributes| attributes.get(name))
        else {
            return Ok(None);
        };
        let index = value.as_u64().and_then(|index| u32::try_from(index).ok());
        index
            .map(Index::new)
            .map(Some)
            .ok_or_else(|| Fault::new(&*at, format!("{name} is not an accessor index")))
    };
    let (translation, rotation, scale) = (
        accessor("TRANSLATION")?,
        accessor("ROTATION")?,
        accessor("SCALE")?,
    );
    // Copies may differ in attributes of their own only, which are not shown, and still be so many.
    let attributes = instancing.get("attributes").and_then(Value::as_object);
    let names = attributes
        .into_iter()
        .flat_map(|attributes| attributes.keys());
    let all = names
        .map(|name| accessor(name))
        .collect::<Result<Vec<_>, _>>()?;
    let mut count = None;
    for index in all.into_iter().flatten() {
        let elements = accessors.count(index, &at)?;
        if *count.get_or_insert(elements) != elements {
            return Err(Fault::new(at, "the attributes have different counts"));
        }
    }
    let count = count.unwrap_or(0);
    // The transform here and an instance with its name for each.
    accessors.budget.charge(count, 256, &at)?;
    let count = count as usize;
    let translations = translation
        .map(|index| accessors.floats::<3>(index, &at))
        .transpose()?;
    let rotations = rotation
        .map(|index| accessors.floats::<4>(index, &at))
        .transpose()?;
    let scales = scale
        .map(|index| accessors.floats::<3>(index, &at))
        .transpose()?;
    let vector = |values: &Option<Vec<[f32; 3]>>, i: usize, default| {
        values
            .as_ref()
            .map_or(default, |values| DVec3::from(values[i].map(f64::from)))
    };
    let rotation = |i: usize| {
        let quaternion = rotations
            .as_ref()
            .map(|values| DQuat::from_array(values[i].map(f64::from)));
        quaternion
            .filter(|quaternion| quaternion.length() > 0.0)
            .map_or(DQuat::IDENTITY, DQuat::normalize)
    };
    Ok((0..count)
        .map(|i| {
            DAffine3::from_scale_rotation_translation(
                vector(&scales, i, DVec3::ONE),
                rotation(i),
                vector(&translations, i, DVec3::ZERO),
            )
        })
        .collect())
}
