//! The JSON's arrays: elements found by their index, and named in messages.

use gltf::json::Index;

use crate::import::error::Fault;
use crate::import::warnings::Warnings;

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

/// The element at an index of something that the scene can do without: where it dangles, a warning names both ends and what is
/// shown instead.
pub(super) fn find<'a, T, U>(
    items: &'a [T],
    index: Index<U>,
    array: &str,
    user: &str,
    instead: &str,
    warnings: &mut Warnings,
) -> Option<&'a T> {
    get(items, index, array, user)
        .inspect_err(|fault| {
            warnings.push(&*fault.place, format!("{}; {instead}", fault.problem));
        })
        .ok()
}

/// A JSON path with the element's name, such as `materials/3 "Glass"`.
pub(super) fn place(array: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) => format!("{array}/{index} \"{}\"", name.escape_debug()),
        None => format!("{array}/{index}"),
    }
}
