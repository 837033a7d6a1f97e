//! When a test ends that no lane passes.

/// [`Early`] or [`Even`].
pub trait Ending: Copy {
    /// Whether as soon as that is known.
    const EARLY: bool;
}

/// At once, without an answer: a branch saves the rest.
#[derive(Clone, Copy)]
pub(crate) struct Early;

/// As any other test: without a branch that may be mispredicted.
#[derive(Clone, Copy)]
pub(crate) struct Even;

impl Ending for Early {
    const EARLY: bool = true;
}

impl Ending for Even {
    const EARLY: bool = false;
}
