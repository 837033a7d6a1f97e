//! How much memory a file may make us allocate.
//!
//! A file of a few bytes can ask for gigabytes (an accessor without data, a thousand uses of one buffer,
//! a PNG of 2³¹ pixels). Everything decoded is charged here before it is allocated.

use super::error::{Fault, MAKE_SMALLER};

/// Bytes of each kind of decoded data.
const LIMIT: u64 = 1 << 30;

/// How many bytes of texels a byte of image files may become beyond that: those of photographs become ten to fifty.
const TEXEL_BYTES_PER_BYTE: u64 = 64;

/// Bytes that may still be allocated.
#[derive(Debug)]
pub(super) struct Budget {
    left: u64,
    limit: u64,
    what: &'static str,
}

impl Budget {
    /// For vertices, indices and instances.
    pub(super) fn geometry() -> Self {
        Self::new(LIMIT, "geometry")
    }

    /// For texels of files of so many bytes: scenes may have as many pictures as they bring along.
    pub(super) fn images(encoded_bytes: u64) -> Self {
        let limit = encoded_bytes.saturating_mul(TEXEL_BYTES_PER_BYTE);
        Self::new(LIMIT.saturating_add(limit), "images")
    }

    fn new(limit: u64, what: &'static str) -> Self {
        Self {
            left: limit,
            limit,
            what,
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
            None => Err(Fault::new(
                place,
                format!(
                    "more than {} GiB of decoded {}",
                    self.limit >> 30,
                    self.what
                ),
            )
            .advise(MAKE_SMALLER)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_may_become_as_much_as_they_bring_along() {
        let gib = 1 << 30;
        let mut small = Budget::images(1000);
        assert!(small.charge(gib, 1, "images").is_ok());
        let fault = small.charge(64_001, 1, "images").unwrap_err();
        assert!(fault.problem.contains("1 GiB of decoded images"));
        assert!(Budget::images(gib).charge(60 * gib, 1, "").is_ok());
        assert!(Budget::images(u64::MAX).charge(u64::MAX, 1, "").is_ok());
        assert!(Budget::geometry().charge(u64::MAX, 2, "").is_err());
    }
}
