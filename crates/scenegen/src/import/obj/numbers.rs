//! Numbers as programs print them.

/// Reads a finite number; one with a decimal comma, as programs of some languages write, counts.
pub(super) fn parse(word: &str) -> Option<f32> {
    let number = match word.contains(',') && !word.contains('.') {
        true => word.replacen(',', ".", 1).parse(),
        false => word.parse(),
    };
    number.ok().filter(|number: &f32| number.is_finite())
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
        ] {
            assert_eq!(parse(word), Some(value), "{word}");
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
        ] {
            assert_eq!(parse(word), None, "{word}");
        }
    }
}
