//! Numbers that arguments may be.

use std::str::FromStr;

/// A finite number.
pub(crate) fn finite<T: FromStr + Into<f64> + Copy>(text: &str) -> Result<T, String> {
    let number: T = text
        .parse()
        .map_err(|_| format!("{text:?} is not a number"))?;
    if number.into().is_finite() {
        Ok(number)
    } else {
        Err("expected a finite number".to_owned())
    }
}

/// One above 0.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    let number = finite(text)?;
    if number > 0.0 {
        Ok(number)
    } else {
        Err("expected a number greater than zero".to_owned())
    }
}
