//! Parameters of functions.

/// What a parameter or an output is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ParameterKind {
    /// A real number.
    Real,
    /// An unsigned integer.
    Word,
    /// A truth value.
    Truth,
    /// Three real numbers.
    Vector,
}

/// A parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// Its name, `snake_case`.
    pub name: &'static str,
    /// What it is.
    pub kind: ParameterKind,
}
