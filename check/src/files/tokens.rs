//! Paths in tokens that are no syntax yet: definitions of macros, and what macros are called with.

use proc_macro2::{Span, TokenStream, TokenTree};

/// Names with `::` between them; `$crate` is one of them.
pub(crate) struct TokenPath {
    pub(crate) segments: Vec<String>,
    pub(crate) span: Span,
}

/// Paths that can only be that: those of several names, and single names that are types by their case, or are called. A
/// single name in small letters is more likely a variable or a field.
pub(crate) fn paths(tokens: TokenStream) -> Vec<TokenPath> {
    let mut paths = Vec::new();
    add_paths(tokens, &mut paths);
    paths
}

/// All names.
pub(crate) fn names(tokens: TokenStream) -> Vec<String> {
    let mut found = Vec::new();
    for token in tokens {
        match token {
            TokenTree::Ident(name) => found.push(name.to_string()),
            TokenTree::Group(group) => found.extend(names(group.stream())),
            _ => (),
        }
    }
    found
}

fn add_paths(tokens: TokenStream, paths: &mut Vec<TokenPath>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut index = 0;
    while index < tokens.len() {
        match &tokens[index] {
            TokenTree::Group(group) => {
                add_paths(group.stream(), paths);
                index += 1;
            }
            TokenTree::Ident(first) => {
                let mut segments = vec![first.to_string()];
                let start = index;
                index += 1;
                while let Some(TokenTree::Ident(next)) = tokens.get(index + 2)
                    && is_separator(&tokens[index..])
                {
                    segments.push(next.to_string());
                    index += 3;
                }
                let before = &tokens[..start];
                let after = &tokens[index..];
                if is_variable(before) && segments[0] == "crate" {
                    segments[0] = "$crate".to_owned();
                } else if is_variable(before) || is_member(before) || is_new_name(before) {
                    continue;
                }
                if segments.len() > 1 || is_type(&segments[0]) || is_call(after) {
                    let span = first.span();
                    paths.push(TokenPath { segments, span });
                }
            }
            _ => index += 1,
        }
    }
}

fn is_punct(token: Option<&TokenTree>, char: char) -> bool {
    matches!(token, Some(TokenTree::Punct(punct)) if punct.as_char() == char)
}

fn is_separator(tokens: &[TokenTree]) -> bool {
    is_punct(tokens.first(), ':') && is_punct(tokens.get(1), ':')
}

/// After the dollar of a macro's variable.
fn is_variable(before: &[TokenTree]) -> bool {
    is_punct(before.last(), '$')
}

/// After a point: a field or a method; but not after two, the end of a range. Or after `::`, which begins the path of
/// another crate, or goes on with one that began with a macro's variable.
fn is_member(before: &[TokenTree]) -> bool {
    let end = before.len();
    let at = |back: usize| end.checked_sub(back).and_then(|index| before.get(index));
    is_punct(at(1), '.') && !is_punct(at(2), '.') || is_punct(at(1), ':') && is_punct(at(2), ':')
}

/// After a keyword that gives a new name.
fn is_new_name(before: &[TokenTree]) -> bool {
    const DEFINE: [&str; 10] = [
        "fn", "struct", "enum", "union", "trait", "type", "const", "static", "let", "mod",
    ];
    matches!(before.last(), Some(TokenTree::Ident(name)) if DEFINE.iter().any(|word| name == word))
}

fn is_type(name: &str) -> bool {
    name.starts_with(char::is_uppercase)
}

/// Before arguments, of a function or of a macro.
fn is_call(after: &[TokenTree]) -> bool {
    is_punct(after.first(), '!') && matches!(after.get(1), Some(TokenTree::Group(_)))
        || matches!(after.first(), Some(TokenTree::Group(group))
            if group.delimiter() == proc_macro2::Delimiter::Parenthesis)
}
