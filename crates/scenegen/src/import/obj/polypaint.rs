//! Colours of vertices as ZBrush writes them: comments that begin with `#MRGB`, behind the vertices that they are for.

use super::lines::words;

/// Appends the colours of a line, display values in [0, 1]: eight hexadecimal digits each, of a mask, which is ignored,
/// red, green and blue. `None` where something is no colour, after those before it.
pub(super) fn read(rest: &str, colors: &mut Vec<[f32; 3]>) -> Option<()> {
    words(rest).try_for_each(|word| {
        let (codes, remainder) = word.as_bytes().as_chunks::<8>();
        for digits in codes {
            let code = u32::from_str_radix(str::from_utf8(digits).ok()?, 16).ok()?;
            let [_, rgb @ ..] = code.to_be_bytes();
            colors.push(rgb.map(|byte| f32::from(byte) / 255.0));
        }
        remainder.is_empty().then_some(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_digits_are_a_colour() {
        let colors = |rest| {
            let mut colors = Vec::new();
            let all = read(rest, &mut colors).is_some();
            let bytes = colors
                .iter()
                .map(|color: &[f32; 3]| color.map(|value| (255.0 * value) as u8));
            (bytes.collect::<Vec<_>>(), all)
        };
        assert_eq!(
            colors("ff0a0B0cFF010203 00ffffff"),
            (vec![[10, 11, 12], [1, 2, 3], [255; 3]], true)
        );
        assert_eq!(colors(""), (vec![], true));
        assert_eq!(colors("ff0a0b0cff01"), (vec![[10, 11, 12]], false));
        assert_eq!(
            colors("ff0a0b0cgg010203ff010203"),
            (vec![[10, 11, 12]], false)
        );
        assert_eq!(colors("ff0a0b0é"), (vec![], false));
    }
}
