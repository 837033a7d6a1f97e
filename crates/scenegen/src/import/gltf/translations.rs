//! Translations of nodes in 64 bits. The `gltf` crate reads them in 32, which near a million metres are steps of 6 cm, one
//! for each node: what is near one another would move apart.

use std::collections::HashMap;

use glam::DVec3;
use gltf::json::{Root, Value};

/// Shorter translations are what 32 bits say, to a millimetre.
const LONG: f32 = 16384.0;

/// Long translations, by the index of their node.
pub(super) fn long(json: &[u8], root: &Root) -> HashMap<usize, DVec3> {
    let is_long = |values: &[f32]| values.iter().any(|value| value.abs() >= LONG);
    let nodes: Vec<usize> = (0..root.nodes.len())
        .filter(|&index| {
            let node = &root.nodes[index];
            let translation = node.translation.is_some_and(|values| is_long(&values));
            translation || node.matrix.is_some_and(|values| is_long(&values[12..15]))
        })
        .collect();
    if nodes.is_empty() {
        return HashMap::new();
    }
    let Ok(document) = serde_json::from_slice::<Value>(json) else {
        return HashMap::new();
    };
    let translation = |index: usize| {
        let node = document.get("nodes")?.get(index)?;
        let numbers = match node.get("matrix") {
            Some(matrix) => matrix.as_array()?.get(12..15)?,
            None => node.get("translation")?.as_array()?,
        };
        let [x, y, z] = numbers else { return None };
        Some(DVec3::new(x.as_f64()?, y.as_f64()?, z.as_f64()?))
    };
    let translations = nodes.into_iter();
    translations
        .filter_map(|index| Some((index, translation(index)?)))
        .collect()
}
