//! Numbers as programs print them.

use std::str::FromStr;

/// What programs write behind numbers that needs no more than a space.
pub(super) const SEPARATORS: [char; 2] = [',', ';'];

/// Reads a number that 32 bits can hold; one with a decimal comma, as programs of some languages write, counts, and so does
/// one with [`SEPARATORS`] behind it.
pub(super) fn parse(word: &str) -> Option<f32> {
    read(word).filter(|number: &f32| number.is_finite())
}

/// The same, exactly.
pub(super) fn parse_exactly(word: &str) -> Option<f64> {
    read(word).filter(|number: &f64| number.abs() <= f64::from(f32::MAX))
}

fn read<N: FromStr>(word: &str) -> Option<N> {
    let word = word.trim_end_matches(SEPARATORS);
    match word.contains(',') && !word.contains('.') {
        true => word.replacen(',', ".", 1).parse().ok(),
        false => word.parse().ok(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_told_from_what_is_none() {
        for (word, value) in [
            ("1", 1.0),
            ("+.5", 0.5),
            ("-2.e1", -20.0),
            ("3E-1", 0.3),
            ("1,25", 1.25),
            ("1.25,", 1.25),
            ("1,25;", 1.25),
            ("3;", 3.0),
        ] {
            assert_eq!(parse(word), Some(value), "{word}");
            assert_eq!(parse_exactly(word).unwrap() as f32, value);
        }
        for word in [
            "nan",
            "-nan(ind)",
            "1.#IND",
            "-1.#QNAN00",
            "1.#INF",
            "inf",
            "1e39",
            "x",
            "",
            "1,2,3",
            "1,000.5",
            "3.1+e2",
            ",",
            ";",
            ";1",
        ] {
            assert_eq!((parse(word), parse_exactly(word)), (None, None), "{word}");
        }
    }
}
