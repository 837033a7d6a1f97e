//! How much memory a file may make us allocate.
//!
//! A file of a few bytes can ask for gigabytes (an accessor without data, a thousand uses of one buffer,
//! a PNG of 2³¹ pixels). Everything decoded is charged here before it is allocated.

use super::error::{Fault, MAKE_SMALLER};

/// Bytes of each kind of decoded data.
const LIMIT: u64 = 1 << 30;

/// Bytes that may still be allocated.
#[derive(Debug)]
pub(super) struct Budget {
    left: u64,
    what: &'static str,
}

impl Budget {
    /// For vertices, indices and instances.
    pub(super) fn geometry() -> Self {
        Self {
            left: LIMIT,
            what: "geometry",
        }
    }

    /// For texels.
    pub(super) fn images() -> Self {
        Self {
            left: LIMIT,
            what: "images",
        }
    }

    /// Takes `count` elements of `size` bytes, or says that it is too much.
    pub(super) fn charge(&mut self, count: u64, size: u64, place: &str) -> Result<(), Fault> {
        match count
            .checked_mul(size)
            .and_then(|bytes| self.left.checked_sub(bytes))
        {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => Err(
                Fault::new(place, format!("more than 1 GiB of decoded {}", self.what))
                    .advise(MAKE_SMALLER),
            ),
        }
    }
}
