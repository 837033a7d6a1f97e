//! Corners of faces: `v`, `v/vt`, `v//vn` or `v/vt/vn`.

use super::numbers;

/// What a corner refers to, in the order of its indices.
#[derive(Debug, Clone, Copy)]
pub(super) enum Attribute {
    Position,
    TextureCoordinate,
    Normal,
}

/// A corner without the attribute.
const NONE: u32 = u32::MAX;

/// A reference that nothing can be at: 0, before the first line, or beyond 32 bits.
const NOWHERE: u32 = u32::MAX - 1;

/// Indices of attributes, by [`Attribute`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Corner([u32; 3]);

impl Corner {
    /// Reads a corner; `counts` are the attributes so far, from which negative indices count back. `None` where
    /// something is no index.
    pub(super) fn parse(word: &str, counts: [usize; 3]) -> Option<Self> {
        let mut indices = [NONE; 3];
        for (part, text) in word.split('/').enumerate() {
            if text.is_empty() && part > 0 {
                continue;
            }
            let index = index(text)?;
            let from_0 = match index {
                1.. => index - 1,
                0 => -1,
                _ => index.saturating_add_unsigned(*counts.get(part)? as u64),
            };
            *indices.get_mut(part)? = u32::try_from(from_0).unwrap_or(NOWHERE).min(NOWHERE);
        }
        Some(Self(indices))
    }

    /// The index of an attribute, if the corner has it.
    pub(super) fn get(self, attribute: Attribute) -> Option<usize> {
        let index = self.0[attribute as usize];
        (index != NONE).then_some(index as usize)
    }

    /// The index of the position, which every corner has.
    pub(super) fn position(self) -> usize {
        self.0[Attribute::Position as usize] as usize
    }

    /// Takes the attribute away.
    pub(super) fn remove(&mut self, attribute: Attribute) {
        self.0[attribute as usize] = NONE;
    }
}

/// A whole number, which some programs print as any other: `1.0`, `1,000000`, `1e0`.
fn index(text: &str) -> Option<i64> {
    text.parse().ok().or_else(|| {
        let number = numbers::parse_exactly(text)?;
        // Beyond, whole numbers have gaps.
        (number.fract() == 0.0 && number.abs() < 9e15).then_some(number as i64)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_have_one_to_three_indices() {
        let parse = |word| Corner::parse(word, [10, 20, 30]).map(|corner| corner.0);
        assert_eq!(parse("1"), Some([0, NONE, NONE]));
        assert_eq!(parse("1/"), parse("1"));
        assert_eq!(parse("1//"), parse("1"));
        assert_eq!(parse("7/8"), Some([6, 7, NONE]));
        assert_eq!(parse("7//9"), Some([6, NONE, 8]));
        assert_eq!(parse("+7/8/9"), Some([6, 7, 8]));
        assert_eq!(parse("-1/-2/-30"), Some([9, 18, 0]));
        assert_eq!(parse("1.0"), parse("1"));
        assert_eq!(parse("7.000000/8.0/9."), parse("7/8/9"));
        assert_eq!(parse("7,0//9,000"), parse("7//9"));
        assert_eq!(parse("-1.0/1.2e1"), parse("-1/12"));
        for nowhere in [
            "0",
            "-11",
            "4294967296",
            "9223372036854775807",
            "-9223372036854775808",
        ] {
            assert_eq!(parse(nowhere), Some([NOWHERE, NONE, NONE]), "{nowhere}");
        }
        for word in [
            "",
            "/1",
            "a",
            "1/b",
            "1/2/3/4",
            "1.5",
            "1/2.25",
            "1e300",
            "nan",
            "1,2",
            "9223372036854775808",
            "1\\2",
        ] {
            assert_eq!(parse(word), None, "{word}");
        }
    }
}
