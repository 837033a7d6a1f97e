//! Names of materials and files, as programs write them: in quotes, with comments behind them, or with a `#` in them.

use super::lines::comment_start;
use crate::import::folders::comparable;

/// The readings of what stands where a name does, the most literal first: without quotes, then without what may be a
/// comment.
pub(super) fn readings(text: &str) -> impl Iterator<Item = &str> {
    let without_comment = comment_start(text).map(|end| &text[..end]);
    let texts = [Some(text), without_comment].into_iter().flatten();
    texts
        .map(|text| unquoted(text.trim()))
        .filter(|name| !name.is_empty())
}

fn unquoted(name: &str) -> &str {
    let inside = |quote| name.strip_prefix(quote)?.strip_suffix(quote);
    inside('"').or_else(|| inside('\'')).unwrap_or(name).trim()
}

/// A name by which two that differ in case, in how accents are composed or in their spaces are the same.
pub(super) fn relaxed(name: &str) -> String {
    let words: Vec<&str> = name.split_whitespace().collect();
    comparable(&words.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_may_have_quotes_and_comments() {
        let all = |text| readings(text).collect::<Vec<_>>();
        assert_eq!(all("Red"), ["Red"]);
        assert_eq!(all(" \"red tray.mtl\" "), ["red tray.mtl"]);
        assert_eq!(all("Material #25"), ["Material #25", "Material"]);
        assert_eq!(all("'a b' # c"), ["'a b' # c", "a b"]);
        assert_eq!(all("# c"), ["# c"]);
        assert_eq!(all("a#b"), ["a#b"]);
        assert_eq!(all("\""), ["\""]);
        assert_eq!(relaxed("Red  Tray"), relaxed("red tray"));
        assert_eq!(comparable("\u{d6}l"), comparable("o\u{308}L"));
        assert_ne!(comparable("\u{d6}l"), comparable("ol"));
    }
}
