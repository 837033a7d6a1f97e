//! Halstead's measures of a program's size (M. H. Halstead, *Elements of Software Science*, 1977).

use std::collections::BTreeMap;

use proc_macro2::{Delimiter, LexError, TokenStream, TokenTree};

/// How often each operator and operand of a program occurs.
///
/// Operators are punctuation, keywords and pairs of brackets; operands are names, literals and lifetimes, and the keywords
/// that stand for a value, a type or a module. What a macro is called with counts as it is written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Halstead {
    operators: BTreeMap<String, usize>,
    operands: BTreeMap<String, usize>,
}

/// Punctuation of several characters, the longest first. `>>` counts as one operator also where it ends two lists of
/// generic arguments.
const JOINED: [&str; 24] = [
    "<<=", ">>=", "...", "..=", "::", "->", "=>", "==", "!=", "<=", ">=", "&&", "||", "+=", "-=",
    "*=", "/=", "%=", "^=", "&=", "|=", "<<", ">>", "..",
];

/// Keywords but `self`, `Self`, `super`, `crate`, `true` and `false`.
const KEYWORDS: [&str; 32] = [
    "as", "async", "await", "break", "const", "continue", "dyn", "else", "enum", "extern", "fn",
    "for", "if", "impl", "in", "let", "loop", "match", "mod", "move", "mut", "pub", "ref",
    "return", "static", "struct", "trait", "type", "unsafe", "use", "where", "while",
];

impl Halstead {
    /// Adds a source file. Its comments do not count, not even those that are documentation.
    ///
    /// # Errors
    /// If it is not Rust.
    pub fn add(&mut self, source: &str) -> Result<(), LexError> {
        self.add_tokens(source.parse()?);
        Ok(())
    }

    fn add_tokens(&mut self, tokens: TokenStream) {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let mut rest = &tokens[..];
        while let Some(token) = rest.first() {
            let mut taken = 1;
            match token {
                TokenTree::Group(group) => {
                    self.operator(brackets(group.delimiter()));
                    self.add_tokens(group.stream());
                }
                TokenTree::Ident(name) => {
                    let name = name.to_string();
                    if KEYWORDS.contains(&name.as_str()) {
                        self.operator(&name);
                    } else {
                        self.operand(name);
                    }
                }
                TokenTree::Literal(literal) => self.operand(literal.to_string()),
                TokenTree::Punct(punct) => {
                    if let Some(comment) = documentation(rest) {
                        taken = comment;
                    } else if let ('\'', Some(name)) = (punct.as_char(), rest.get(1)) {
                        self.operand(format!("'{name}"));
                        taken = 2;
                    } else {
                        let operator = joined(rest);
                        taken = operator.len();
                        self.operator(&operator);
                    }
                }
            }
            rest = &rest[taken..];
        }
    }

    fn operator(&mut self, operator: &str) {
        *self.operators.entry(operator.to_owned()).or_default() += 1;
    }

    fn operand(&mut self, operand: String) {
        *self.operands.entry(operand).or_default() += 1;
    }

    /// V = N log₂ n: the bits of a program of N operators and operands, of which n are distinct.
    pub fn volume(&self) -> f64 {
        let distinct = self.operators.len() + self.operands.len();
        let all = total(&self.operators) + total(&self.operands);
        all * (distinct.max(1) as f64).log2()
    }

    /// D = n₁ / 2 · N₂ / n₂: half of the distinct operators, times how often an operand occurs on average.
    pub fn difficulty(&self) -> f64 {
        let distinct = self.operands.len().max(1) as f64;
        self.operators.len() as f64 / 2.0 * total(&self.operands) / distinct
    }

    /// E = D V: elementary decisions that writing the program takes.
    pub fn effort(&self) -> f64 {
        self.difficulty() * self.volume()
    }
}

fn total(counts: &BTreeMap<String, usize>) -> f64 {
    counts.values().sum::<usize>() as f64
}

fn brackets(delimiter: Delimiter) -> &'static str {
    match delimiter {
        Delimiter::Parenthesis => "()",
        Delimiter::Brace => "{}",
        Delimiter::Bracket => "[]",
        Delimiter::None => unreachable!("only macros make groups without brackets"),
    }
}

/// The operator that begins here: the longest known one of adjacent punctuation.
fn joined(tokens: &[TokenTree]) -> String {
    let mut text = String::new();
    for token in tokens.iter().take(3) {
        let TokenTree::Punct(punct) = token else {
            break;
        };
        text.push(punct.as_char());
        if punct.spacing() == proc_macro2::Spacing::Alone {
            break;
        }
    }
    let known = JOINED.iter().find(|operator| text.starts_with(**operator));
    known.map_or(&text[..1], |operator| operator).to_owned()
}

/// How many tokens a comment for documentation takes, if one begins here: it reads as `#[doc = "…"]` or `#![doc = "…"]`.
fn documentation(tokens: &[TokenTree]) -> Option<usize> {
    let is = |place: usize, character: char| matches!(tokens.get(place), Some(TokenTree::Punct(punct)) if punct.as_char() == character);
    let place = 1 + usize::from(is(1, '!'));
    let TokenTree::Group(group) = tokens.get(place).filter(|_| is(0, '#'))? else {
        return None;
    };
    let mut inside = group.stream().into_iter();
    let name = inside.next()?.to_string();
    (name == "doc" && inside.next()?.to_string() == "=").then_some(place + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(source: &str) -> Halstead {
        let mut halstead = Halstead::default();
        halstead.add(source).unwrap();
        halstead
    }

    fn list(counts: &BTreeMap<String, usize>) -> String {
        let pairs: Vec<_> = counts.iter().map(|(k, n)| format!("{k} {n}")).collect();
        pairs.join(", ")
    }

    #[test]
    fn counted_by_hand() {
        let halstead = of("
            //! A module.

            /// The larger.
            fn max(a: u32, b: u32) -> u32 {
                // Equal ones are the same.
                if a >= b { a } else { b }
            }
        ");
        assert_eq!(
            list(&halstead.operators),
            "() 1, , 1, -> 1, : 2, >= 1, else 1, fn 1, if 1, {} 3"
        );
        assert_eq!(list(&halstead.operands), "a 3, b 3, max 1, u32 3");
        // n₁ = 9, N₁ = 12, n₂ = 4, N₂ = 10.
        let (volume, difficulty) = (22.0 * 13f64.log2(), 4.5 * 2.5);
        assert!((halstead.volume() - volume).abs() < 1e-9);
        assert!((halstead.difficulty() - difficulty).abs() < 1e-9);
        assert!((halstead.effort() - volume * difficulty).abs() < 1e-9);
        assert_eq!(of("").effort(), 0.0);
    }

    #[test]
    fn adjacent_punctuation_is_cut_into_operators() {
        let cases = [
            ("a<<=-b", "- 1, <<= 1"),
            ("x..=*y", "* 1, ..= 1"),
            ("|&x| !!x", "! 2, & 1, | 2"),
            ("a::<b>()", "() 1, :: 1, < 1, > 1"),
            ("&&mut a", "&& 1, mut 1"),
            ("a = =b", "= 2"),
        ];
        for (source, expected) in cases {
            assert_eq!(list(&of(source).operators), expected, "{source}");
        }
    }

    #[test]
    fn lifetimes_literals_and_what_stands_for_a_value_are_operands() {
        let halstead = of("impl<'a> Self { true; self; 'a'; \"'a\"; -1.5e3f32 }");
        assert_eq!(
            list(&halstead.operands),
            "\"'a\" 1, '\u{61} 1, 'a' 1, 1.5e3f32 1, Self 1, self 1, true 1"
        );
        assert_eq!(
            of("#[doc = \"no\"] #![doc = \"no\"] #[inline]"),
            of("#[inline]")
        );
    }

    /// What occurs in two files is one operand.
    #[test]
    fn files_share_a_vocabulary() {
        let mut two = of("f(a);");
        two.add("f(b);").unwrap();
        assert_eq!(two, of("f(a); f(b);"));
        assert!(two.add("f(").is_err());
    }
}
