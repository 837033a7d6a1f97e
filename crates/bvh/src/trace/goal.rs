//! What a query looks for, as a type.

use std::ops::ControlFlow;

/// [`ClosestHit`] or [`AnyHit`].
pub(crate) trait Goal: Copy {
    /// Whether any hit will do: then the order of visits does not matter.
    const ANY: bool;

    /// A hit was found: breaks if nothing else needs to be visited.
    #[inline(always)]
    fn found(self) -> ControlFlow<()> {
        if Self::ANY {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

/// The nearest hit of the ray's interval.
#[derive(Clone, Copy)]
pub(crate) struct ClosestHit;

/// Any hit of the ray's interval.
#[derive(Clone, Copy)]
pub(crate) struct AnyHit;

impl Goal for ClosestHit {
    const ANY: bool = false;
}

impl Goal for AnyHit {
    const ANY: bool = true;
}
