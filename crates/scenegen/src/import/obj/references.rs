//! The indices of faces, checked with their lines: tobj checks them late, and with arithmetic that overflows.

use super::lines::{line_fault, line_place};
use crate::import::error::Fault;
use crate::import::warnings::Warnings;

/// What a face's corner refers to, in the order of its indices.
#[derive(Debug, Clone, Copy)]
pub(super) enum Attribute {
    Position,
    TextureCoordinate,
    Normal,
}

impl Attribute {
    const ALL: [Self; 3] = [Self::Position, Self::TextureCoordinate, Self::Normal];

    /// What a statement defines, if it is one of these.
    pub(super) fn defined_by(keyword: &str) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|attribute| attribute.keyword() == keyword)
    }

    /// The statement that defines one.
    pub(super) fn keyword(self) -> &'static str {
        match self {
            Self::Position => "v",
            Self::TextureCoordinate => "vt",
            Self::Normal => "vn",
        }
    }
}

/// Attributes and references to them so far.
#[derive(Default)]
pub(super) struct References {
    /// How many there are, by attribute.
    counts: [usize; 3],
    /// The largest index to each of them, counted from 1, and the index of its line.
    largest: [(usize, usize); 3],
}

impl References {
    /// Counts an attribute.
    pub(super) fn define(&mut self, attribute: Attribute) {
        self.counts[attribute as usize] += 1;
    }

    /// Notes the corners of a face.
    pub(super) fn refer(&mut self, corners: &[&str], line: usize) -> Result<(), Fault> {
        for corner in corners {
            for (attribute, text) in Attribute::ALL.into_iter().zip(corner.split('/')) {
                if text.is_empty() {
                    continue;
                }
                let index: i64 = text.parse().map_err(|_| {
                    line_fault(line, format!("\"{text}\" in a face is not an index"))
                })?;
                let count = self.counts[attribute as usize];
                // Positive ones may refer to what follows; negative ones count back from here.
                let absolute = if index < 0 {
                    index.saturating_add_unsigned(count as u64) + 1
                } else {
                    index
                };
                if absolute < 1 {
                    return Err(out_of_range(line, index, attribute, count));
                }
                let largest = &mut self.largest[attribute as usize];
                *largest = (*largest).max((absolute as usize, line));
            }
        }
        Ok(())
    }

    /// Refuses references to what the whole file does not define.
    pub(super) fn check(&self, warnings: &mut Warnings) -> Result<(), Fault> {
        for attribute in Attribute::ALL {
            let count = self.counts[attribute as usize];
            let (index, line) = self.largest[attribute as usize];
            match attribute {
                // Some exporters leave out the attribute and keep the indices.
                Attribute::TextureCoordinate | Attribute::Normal if index > 0 && count == 0 => {
                    let keyword = attribute.keyword();
                    let message = format!("faces refer to {keyword}, of which there are none");
                    warnings.push(line_place(line), message);
                }
                _ if index > count => {
                    return Err(out_of_range(line, index as i64, attribute, count));
                }
                _ => {}
            }
        }
        Ok(())
    }
}

fn out_of_range(line: usize, index: i64, attribute: Attribute, count: usize) -> Fault {
    let keyword = attribute.keyword();
    line_fault(
        line,
        format!("a face refers to {keyword} {index}, but there are {count}"),
    )
}
