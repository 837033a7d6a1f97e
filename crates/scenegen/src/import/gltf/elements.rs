//! The elements of an accessor: where their bytes are, and what numbers they hold.

use gltf::json::accessor::ComponentType;

use crate::import::error::Fault;

/// Elements in a buffer view.
pub(super) struct Elements {
    /// JSON path, for messages.
    pub(super) place: String,
    /// How many.
    pub(super) count: usize,
    /// Bytes of each.
    pub(super) size: usize,
}

impl Elements {
    /// The bytes of each element, after checking that the last one ends within the view.
    pub(super) fn slices<'b>(
        &self,
        bytes: &'b [u8],
        offset: u64,
        stride: Option<usize>,
    ) -> Result<impl Iterator<Item = &'b [u8]> + use<'b>, Fault> {
        let (count, size) = (self.count, self.size);
        let stride = stride.unwrap_or(size);
        if stride < size {
            return Err(Fault::new(
                &*self.place,
                format!("elements of {size} bytes overlap at a stride of {stride}"),
            ));
        }
        let end = (count as u64).checked_sub(1).map_or(Some(offset), |last| {
            last.checked_mul(stride as u64)?
                .checked_add(offset)?
                .checked_add(size as u64)
        });
        if end.is_none_or(|end| end > bytes.len() as u64) {
            let problem = format!(
                "{count} elements reach beyond the {} bytes of the buffer view",
                bytes.len()
            );
            return Err(Fault::new(&*self.place, problem));
        }
        let offset = offset as usize;
        Ok((0..count).map(move |i| &bytes[offset + i * stride..offset + i * stride + size]))
    }
}

/// How the components of vectors are stored.
#[derive(Clone, Copy)]
pub(super) struct Encoding {
    /// Their type.
    pub(super) component: ComponentType,
    /// Whether integers stand for fractions of their largest value.
    pub(super) is_normalized: bool,
}

impl Encoding {
    /// One component, by the equations of glTF 2.0 section 3.11.
    pub(super) fn to_f32(self, bytes: &[u8]) -> f32 {
        let (value, scale) = match self.component {
            ComponentType::I8 => (f32::from(bytes[0] as i8), 127.0),
            ComponentType::U8 => (f32::from(bytes[0]), 255.0),
            ComponentType::I16 => (f32::from(i16::from_le_bytes([bytes[0], bytes[1]])), 32767.0),
            ComponentType::U16 => (f32::from(u16::from_le_bytes([bytes[0], bytes[1]])), 65535.0),
            ComponentType::F32 => {
                return f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
            }
            ComponentType::U32 => unreachable!("refused by `Accessors::floats`"),
        };
        if self.is_normalized {
            (value / scale).max(-1.0)
        } else {
            value
        }
    }
}

/// An unsigned integer of one, two or four bytes.
pub(super) fn to_u32(bytes: &[u8], component: ComponentType) -> u32 {
    match component {
        ComponentType::U8 | ComponentType::I8 => u32::from(bytes[0]),
        ComponentType::U16 | ComponentType::I16 => {
            u32::from(u16::from_le_bytes([bytes[0], bytes[1]]))
        }
        ComponentType::U32 | ComponentType::F32 => {
            u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
        }
    }
}
