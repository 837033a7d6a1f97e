//! Closures that are inlined for sure.
//!
//! What works on lanes has to be: a function of its own is compiled for the instruction set of the crate, not for that of the kernel
//! around it, and where the two differ (in programs that are compiled for any machine, and choose when they run) each operation in it
//! becomes a call. Kernels took ten times as long so.

/// A closure that says itself that it is to be inlined: Rust takes attributes of closures only where they are arguments.
#[inline(always)]
pub(crate) fn inlined<F>(closure: F) -> F {
    closure
}

/// `array.map(f)`, which is several functions in the standard library.
#[inline(always)]
pub(crate) fn each<T: Copy, U: Copy, const L: usize>(
    array: [T; L],
    mut f: impl FnMut(T) -> U,
) -> [U; L] {
    let mut results = [f(array[0]); L];
    for i in 1..L {
        results[i] = f(array[i]);
    }
    results
}
