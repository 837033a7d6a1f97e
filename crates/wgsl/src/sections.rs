//! Texts of which parts are there only where they are called for.

/// A text with its sections: lines between `//[name` and `//]` stay where the name is among these.
pub(crate) fn sections(text: &str, names: &[&str]) -> String {
    let mut kept = String::with_capacity(text.len());
    let mut is_kept = true;
    for line in text.lines() {
        match line.trim().strip_prefix("//[") {
            Some(name) => is_kept = names.contains(&name),
            None if line.trim() == "//]" => is_kept = true,
            None if is_kept => {
                kept += line;
                kept.push('\n');
            }
            None => {}
        }
    }
    kept
}
