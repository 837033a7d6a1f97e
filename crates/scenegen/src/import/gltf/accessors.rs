//! Accessors: arrays of vectors and indices, with sparse replacement, bounds-checked.

use gltf::json::accessor::{ComponentType, Type, sparse::Sparse};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index};

use super::document::Document;
use super::elements::{Elements, Encoding, to_u32};
use super::lookup::{get, place};
use crate::import::budget::Budget;
use crate::import::error::Fault;

/// A file's accessors and the memory they may take.
pub(super) struct Accessors<'a> {
    document: &'a Document,
    /// What may still be decoded.
    pub(super) budget: Budget,
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
        self.vectors(index, user, |encoding| encoding)
    }

    /// The same, with integers that are scaled whatever the accessor says.
    pub(super) fn fractions<const N: usize>(
        &mut self,
        index: Index<Accessor>,
        user: &str,
    ) -> Result<Vec<[f32; N]>, Fault> {
        self.vectors(index, user, |encoding| Encoding {
            is_normalized: true,
            ..encoding
        })
    }

    /// Whether an accessor has integers that stand for themselves.
    pub(super) fn has_plain_integers(
        &self,
        index: Index<Accessor>,
        user: &str,
    ) -> Result<bool, Fault> {
        let accessor = get(&self.document.root.accessors, index, "accessors", user)?;
        let is_float = matches!(accessor.component_type, Checked::Valid(component) if component.0 == ComponentType::F32);
        Ok(!accessor.normalized && !is_float)
    }

    fn vectors<const N: usize>(
        &mut self,
        index: Index<Accessor>,
        user: &str,
        encoded: impl Fn(Encoding) -> Encoding,
    ) -> Result<Vec<[f32; N]>, Fault> {
        let expected = match N {
            1 => Type::Scalar,
            2 => Type::Vec2,
            3 => Type::Vec3,
            16 => Type::Mat4,
            _ => Type::Vec4,
        };
        let allowed = |component| match component {
            ComponentType::U32 => Err("may not be made of 32-bit integers"),
            _ => Ok(()),
        };
        let convert = |bytes: &[u8], encoding: Encoding| {
            let encoding = encoded(encoding);
            let size = encoding.component.size();
            std::array::from_fn(|i| encoding.to_f32(&bytes[i * size..]))
        };
        self.read(index, expected, user, allowed, convert, [0.0; N])
    }

    /// Triangle corner indices.
    pub(super) fn indices(
        &mut self,
        index: Index<Accessor>,
        user: &str,
    ) -> Result<Vec<u32>, Fault> {
        let allowed = |component| match component {
            ComponentType::U8 | ComponentType::U16 | ComponentType::U32 => Ok(()),
            ComponentType::I8 | ComponentType::I16 | ComponentType::F32 => {
                Err("indices must be unsigned integers")
            }
        };
        let convert = |bytes: &[u8], encoding: Encoding| to_u32(bytes, encoding.component);
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
        allowed: impl Fn(ComponentType) -> Result<(), &'static str>,
        convert: impl Fn(&[u8], Encoding) -> T,
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
        let decoded = self.document.draco.get(&index.value());
        let count = match decoded {
            Some(decoded) => decoded.count,
            None => usize::try_from(accessor.count.0)
                .map_err(|_| Fault::new(here.as_str(), "count is too large"))?,
        };
        let component = decoded.map_or(component.0, |decoded| decoded.component);
        allowed(component).map_err(|problem| Fault::new(here.as_str(), problem))?;
        let encoding = Encoding {
            component,
            is_normalized: accessor.normalized,
        };
        let elements = Elements {
            place: here,
            count,
            size: component.size() * expected.multiplicity(),
        };

        self.budget
            .charge(count as u64, size_of::<T>() as u64, &elements.place)?;
        let convert = |bytes: &[u8]| convert(bytes, encoding);
        let mut values = match (decoded, accessor.buffer_view) {
            (Some(decoded), _) => elements
                .slices(&decoded.bytes, 0, None)?
                .map(convert)
                .collect(),
            (None, Some(view)) => {
                let (bytes, stride) = self.document.view(view, &elements.place)?;
                let offset = accessor.byte_offset.unwrap_or_default().0;
                elements
                    .slices(bytes, offset, stride)?
                    .map(convert)
                    .collect()
            }
            (None, None) => vec![zero; count],
        };
        if let Some(sparse) = &accessor.sparse {
            self.replace(sparse, &elements, &mut values, convert)?;
        }
        Ok(values)
    }

    /// Puts the elements of a sparse accessor into their places.
    fn replace<T>(
        &self,
        sparse: &Sparse,
        elements: &Elements,
        values: &mut [T],
        convert: impl Fn(&[u8]) -> T,
    ) -> Result<(), Fault> {
        let here = format!("{}/sparse", elements.place);
        let count = usize::try_from(sparse.count.0).unwrap_or(usize::MAX);
        if count > elements.count {
            return Err(Fault::new(
                here,
                format!("replaces {count} of {} elements", elements.count),
            ));
        }
        let Checked::Valid(index_type) = sparse.indices.component_type else {
            return Err(Fault::new(here, "indices have an unknown componentType"));
        };
        let of_size = |size| Elements {
            place: here.clone(),
            count,
            size,
        };
        let (index_bytes, _) = self.document.view(sparse.indices.buffer_view, &here)?;
        let (value_bytes, _) = self.document.view(sparse.values.buffer_view, &here)?;
        let indices =
            of_size(index_type.0.size()).slices(index_bytes, sparse.indices.byte_offset.0, None)?;
        let replacements =
            of_size(elements.size).slices(value_bytes, sparse.values.byte_offset.0, None)?;
        for (index, replacement) in indices.zip(replacements) {
            let index = to_u32(index, index_type.0) as usize;
            let value = values.get_mut(index);
            *value.ok_or_else(|| {
                Fault::new(
                    &*here,
                    format!("replaces element {index} of {}", elements.count),
                )
            })? = convert(replacement);
        }
        Ok(())
    }
}
