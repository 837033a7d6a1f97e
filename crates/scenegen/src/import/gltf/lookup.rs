//! The JSON's arrays: elements found by their index, and named in messages.

use gltf::json::Index;

use crate::import::error::Fault;

/// The element at an index; where that dangles, the error names both ends.
pub(super) fn get<'a, T, U>(
    items: &'a [T],
    index: Index<U>,
    array: &str,
    user: &str,
) -> Result<&'a T, Fault> {
    items.get(index.value()).ok_or_else(|| {
        Fault::new(
            user,
            format!(
                "refers to {array}/{}, but there are {}",
                index.value(),
                items.len()
            ),
        )
    })
}

/// A JSON path with the element's name, such as `materials/3 "Glass"`.
pub(super) fn place(array: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) => format!("{array}/{index} \"{}\"", name.escape_debug()),
        None => format!("{array}/{index}"),
    }
}
