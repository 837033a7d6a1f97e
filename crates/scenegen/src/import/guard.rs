//! A last line of defence around third-party parsers.

use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs a parser or decoder of another crate and turns a panic into an error.
///
/// Image decoders have had index panics on hostile input. Their state is dropped with the closure, so nothing half-made
/// is seen afterwards. Our own code does not rely on this.
pub(super) fn without_panic<T>(work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work))
        .unwrap_or_else(|_| Err("the parser gave up on malformed data".into()))
}
