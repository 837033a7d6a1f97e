//! A recorded function, ready to be printed.

use residual_render::domain::tape::Function;

/// A recorded function with what is printed around it.
#[derive(Clone, Debug)]
pub struct Recorded {
    /// The function.
    pub function: Function,
    /// The structure that it returns, if it has several outputs.
    pub result: &'static str,
    /// What it is for.
    pub comment: String,
}

impl Recorded {
    /// The expression that reads an output from `value`, which the function has returned; `None` if there is no such
    /// output.
    pub fn output(&self, value: &str, output: &str) -> Option<String> {
        let outputs = &self.function.outputs;
        let is_there = outputs.iter().any(|o| o.name == output);
        is_there.then(|| match outputs.len() {
            1 => value.to_owned(),
            _ => format!("{value}.{output}"),
        })
    }
}
