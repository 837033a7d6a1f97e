//! EXT_meshopt_compression and KHR_meshopt_compression: compressed buffer views.

use gltf::json::{Root, Value};
use meshoptimizer_rs::codec;
use meshoptimizer_rs::{Limits, Workspace};

use super::lookup::place;
use crate::import::budget::Budget;
use crate::import::error::Fault;
use crate::import::guard::without_panic;

/// The extension's names, of which the second has more filters and a newer codec.
pub(super) const EXTENSIONS: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// A compressed buffer view.
pub(super) struct Compressed {
    /// Index of the buffer that holds the compressed bytes.
    pub(super) buffer: usize,
    /// Of the first of them.
    pub(super) offset: usize,
    /// How many.
    pub(super) length: usize,
    count: usize,
    /// Bytes of an element.
    pub(super) stride: usize,
    mode: String,
    filter: String,
}

impl Compressed {
    /// What a buffer view says; `None` where it is not compressed.
    pub(super) fn of_view(root: &Root, index: usize) -> Result<Option<Self>, Fault> {
        let view = &root.buffer_views[index];
        let others = view.extensions.as_ref().map(|used| &used.others);
        let named = |name: &'static str| Some((name, others?.get(name)?));
        let Some((name, json)) = EXTENSIONS.into_iter().find_map(named) else {
            return Ok(None);
        };
        let at = place("bufferViews", index, view.name.as_deref());
        let at = format!("{at}/extensions/{name}");
        let number = |member: &str, default: Option<u64>| {
            let number = json.get(member).map_or(default, Value::as_u64);
            number
                .and_then(|number| usize::try_from(number).ok())
                .ok_or_else(|| Fault::new(&*at, format!("{member} is no whole number")))
        };
        let text = |member: &str, default: &str| {
            let text = json.get(member).and_then(Value::as_str);
            text.unwrap_or(default).to_owned()
        };
        Ok(Some(Self {
            buffer: number("buffer", None)?,
            offset: number("byteOffset", Some(0))?,
            length: number("byteLength", None)?,
            count: number("count", None)?,
            stride: number("byteStride", None)?,
            mode: text("mode", ""),
            filter: text("filter", "NONE"),
        }))
    }

    /// Decodes the bytes, which are charged to a budget before they are there.
    pub(super) fn decode(
        &self,
        bytes: &[u8],
        budget: &mut Budget,
        at: &str,
    ) -> Result<Vec<u8>, Fault> {
        budget.charge(self.count as u64, self.stride as u64, at)?;
        without_panic(|| self.decoded(bytes)).map_err(|problem| Fault::new(at, problem))
    }

    fn decoded(&self, bytes: &[u8]) -> Result<Vec<u8>, String> {
        let unreadable = |error| format!("the compressed data cannot be decoded ({error:?})");
        if self.count == 0 {
            return Ok(Vec::new());
        }
        let workspace = &mut Workspace::new(Limits::default());
        let (count, stride) = (self.count, self.stride);
        let decode = match self.mode.as_str() {
            "ATTRIBUTES" => codec::decode_vertex_buffer,
            "TRIANGLES" => codec::decode_index_buffer,
            "INDICES" => codec::decode_index_sequence,
            mode => return Err(format!("has the unknown mode {mode:?}")),
        };
        let mut decoded = decode(count, stride, bytes, workspace).map_err(unreadable)?;
        let filter = match self.filter.as_str() {
            "NONE" => return Ok(decoded),
            "OCTAHEDRAL" => codec::decode_filter_oct,
            "QUATERNION" => codec::decode_filter_quat,
            "EXPONENTIAL" => codec::decode_filter_exp,
            "COLOR" => codec::decode_filter_color,
            filter => return Err(format!("has the unknown filter {filter:?}")),
        };
        filter(&mut decoded, count, stride, workspace).map_err(unreadable)?;
        Ok(decoded)
    }
}
