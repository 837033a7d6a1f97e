//! Reading accessors: every component type, stride, sparse replacement and normalisation, bounds-checked.

use gltf::json::accessor::{ComponentType, Type, sparse::Sparse};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index};

use super::document::{Document, get};
use crate::import::budget::Budget;
use crate::import::error::{Fault, place};

/// A file's accessors and the memory they may take.
pub(super) struct Accessors<'a> {
    document: &'a Document,
    /// What may still be decoded.
    pub(super) budget: Budget,
}

/// What an accessor says about its elements.
struct Layout {
    place: String,
    count: usize,
    component: ComponentType,
    normalized: bool,
}

impl<'a> Accessors<'a> {
    /// Starts with a full budget.
    pub(super) fn new(document: &'a Document) -> Self {
        Self {
            document,
            budget: Budget::geometry(),
        }
    }

    /// Number of elements, unchecked against the data.
    pub(super) fn count(&self, index: Index<Accessor>, user: &str) -> Result<u64, Fault> {
        Ok(
            get(&self.document.root.accessors, index, "accessors", user)?
                .count
                .0,
        )
    }

    /// Vectors of `N` floats; integers are converted, and scaled where the accessor is normalised.
    pub(super) fn floats<const N: usize>(
        &mut self,
        index: Index<Accessor>,
        user: &str,
    ) -> Result<Vec<[f32; N]>, Fault> {
        let expected = match N {
            2 => Type::Vec2,
            3 => Type::Vec3,
            _ => Type::Vec4,
        };
        let convert = |bytes: &[u8], layout: &Layout| {
            let size = layout.component.size();
            std::array::from_fn(|i| to_f32(&bytes[i * size..], layout.component, layout.normalized))
        };
        let allowed = |layout: &Layout| match layout.component {
            ComponentType::U32 => Err("may not be made of 32-bit integers"),
            _ => Ok(()),
        };
        self.read(index, expected, user, allowed, convert, [0.0; N])
    }

    /// Triangle corner indices.
    pub(super) fn indices(
        &mut self,
        index: Index<Accessor>,
        user: &str,
    ) -> Result<Vec<u32>, Fault> {
        let allowed = |layout: &Layout| match layout.component {
            ComponentType::U8 | ComponentType::U16 | ComponentType::U32 => Ok(()),
            ComponentType::I8 | ComponentType::I16 | ComponentType::F32 => {
                Err("indices must be unsigned integers")
            }
        };
        let convert = |bytes: &[u8], layout: &Layout| to_u32(bytes, layout.component);
        self.read(index, Type::Scalar, user, allowed, convert, 0)
    }

    /// Number of components (3 or 4) that an accessor of colours has.
    pub(super) fn components(&self, index: Index<Accessor>, user: &str) -> Result<usize, Fault> {
        let accessor = get(&self.document.root.accessors, index, "accessors", user)?;
        match accessor.type_ {
            Checked::Valid(kind) => Ok(kind.multiplicity()),
            Checked::Invalid => Err(Fault::new(
                place("accessors", index.value(), None),
                "has an unknown type",
            )),
        }
    }

    fn read<T: Copy>(
        &mut self,
        index: Index<Accessor>,
        expected: Type,
        user: &str,
        allowed: impl Fn(&Layout) -> Result<(), &'static str>,
        convert: impl Fn(&[u8], &Layout) -> T,
        zero: T,
    ) -> Result<Vec<T>, Fault> {
        let accessor = get(&self.document.root.accessors, index, "accessors", user)?;
        let here = place("accessors", index.value(), accessor.name.as_deref());
        let Checked::Valid(component) = accessor.component_type else {
            return Err(Fault::new(here, "has an unknown componentType"));
        };
        match accessor.type_ {
            Checked::Valid(kind) if kind == expected => {}
            _ => {
                return Err(Fault::new(
                    here,
                    format!("must be {expected:?} as {user} uses it"),
                ));
            }
        }
        let component = component.0;
        let count = usize::try_from(accessor.count.0)
            .map_err(|_| Fault::new(here.as_str(), "count is too large"))?;
        let layout = Layout {
            place: here,
            count,
            component,
            normalized: accessor.normalized,
        };
        allowed(&layout).map_err(|problem| Fault::new(layout.place.as_str(), problem))?;

        let element = component.size() * expected.multiplicity();
        self.budget
            .charge(count as u64, size_of::<T>() as u64, &layout.place)?;
        let mut values = match accessor.buffer_view {
            Some(view) => {
                let (bytes, stride) = self.document.view(view, &layout.place)?;
                let offset = accessor.byte_offset.unwrap_or_default().0;
                let chunks = elements(bytes, offset, stride, element, &layout)?;
                chunks.map(|bytes| convert(bytes, &layout)).collect()
            }
            None => vec![zero; count],
        };
        if let Some(sparse) = &accessor.sparse {
            self.replace(sparse, &layout, element, &mut values, convert)?;
        }
        Ok(values)
    }

    fn replace<T>(
        &self,
        sparse: &Sparse,
        layout: &Layout,
        element: usize,
        values: &mut [T],
        convert: impl Fn(&[u8], &Layout) -> T,
    ) -> Result<(), Fault> {
        let here = format!("{}/sparse", layout.place);
        let count = usize::try_from(sparse.count.0).unwrap_or(usize::MAX);
        if count > layout.count {
            return Err(Fault::new(
                here,
                format!("replaces {count} of {} elements", layout.count),
            ));
        }
        let Checked::Valid(index_type) = sparse.indices.component_type else {
            return Err(Fault::new(here, "indices have an unknown componentType"));
        };
        let indices = Layout {
            place: here.clone(),
            count,
            component: index_type.0,
            normalized: false,
        };
        let replacements = Layout {
            place: here.clone(),
            count,
            ..*layout
        };
        let (index_bytes, _) = self.document.view(sparse.indices.buffer_view, &here)?;
        let (value_bytes, _) = self.document.view(sparse.values.buffer_view, &here)?;
        let index_size = index_type.0.size();
        let at = elements(
            index_bytes,
            sparse.indices.byte_offset.0,
            None,
            index_size,
            &indices,
        )?;
        let with = elements(
            value_bytes,
            sparse.values.byte_offset.0,
            None,
            element,
            &replacements,
        )?;
        for (at, with) in at.zip(with) {
            let at = to_u32(at, index_type.0) as usize;
            let value = values.get_mut(at);
            *value.ok_or_else(|| {
                Fault::new(&*here, format!("replaces element {at} of {}", layout.count))
            })? = convert(with, layout);
        }
        Ok(())
    }
}

/// The bytes of each element, after checking that the last one ends within the view.
fn elements<'b>(
    bytes: &'b [u8],
    offset: u64,
    stride: Option<usize>,
    element: usize,
    layout: &Layout,
) -> Result<impl Iterator<Item = &'b [u8]> + use<'b>, Fault> {
    let stride = stride.unwrap_or(element);
    if stride < element {
        return Err(Fault::new(
            &*layout.place,
            format!("elements of {element} bytes overlap at a stride of {stride}"),
        ));
    }
    let end = (layout.count as u64)
        .checked_sub(1)
        .map_or(Some(offset), |last| {
            last.checked_mul(stride as u64)?
                .checked_add(offset)?
                .checked_add(element as u64)
        });
    if end.is_none_or(|end| end > bytes.len() as u64) {
        let problem = format!(
            "{} elements reach beyond the {} bytes of the buffer view",
            layout.count,
            bytes.len()
        );
        return Err(Fault::new(&*layout.place, problem));
    }
    let offset = offset as usize;
    Ok((0..layout.count).map(move |i| &bytes[offset + i * stride..offset + i * stride + element]))
}

fn to_u32(bytes: &[u8], component: ComponentType) -> u32 {
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

/// One component, by the equations of glTF 2.0 section 3.11.
fn to_f32(bytes: &[u8], component: ComponentType, normalized: bool) -> f32 {
    let (value, scale) = match component {
        ComponentType::I8 => (f32::from(bytes[0] as i8), 127.0),
        ComponentType::U8 => (f32::from(bytes[0]), 255.0),
        ComponentType::I16 => (f32::from(i16::from_le_bytes([bytes[0], bytes[1]])), 32767.0),
        ComponentType::U16 => (f32::from(u16::from_le_bytes([bytes[0], bytes[1]])), 65535.0),
        ComponentType::F32 => return f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
        ComponentType::U32 => unreachable!("refused by `floats`"),
    };
    if normalized {
        (value / scale).max(-1.0)
    } else {
        value
    }
}
