//! Whether a surface is there.

/// What alpha makes of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Opacity {
    /// It is there everywhere.
    Opaque,
    /// It is there where a test passes.
    Tested,
    /// It is nowhere.
    Transparent,
}
