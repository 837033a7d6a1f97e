//! Sources as Rust: each as a type and as a value.

use residual_render::program::{ColorNode, ImageNode, ScalarNode};

/// A type whose only value has its name.
pub(super) fn unit(name: &str) -> (String, String) {
    (name.to_owned(), name.to_owned())
}

/// A number that reads back as the same bits. Plans hold finite numbers only.
fn number(value: f32) -> String {
    assert!(value.is_finite(), "a plan holds finite numbers");
    format!("{value:?}")
}

/// A colour source as a type and as a value.
pub(super) fn color(node: &ColorNode) -> (String, String) {
    match node {
        ColorNode::Const(value) => {
            let [r, g, b] = value.map(number);
            (
                "Const<[f32; 3]>".to_owned(),
                format!("Const([{r}, {g}, {b}])"),
            )
        }
        ColorNode::Param(offset) => ("Param".to_owned(), format!("Param({offset})")),
        ColorNode::VertexColor => unit("VertexColor"),
        ColorNode::Image(node) => image(node),
        ColorNode::Gray(node) => {
            let (kind, value) = scalar(node);
            (format!("Gray<{kind}>"), format!("Gray({value})"))
        }
        ColorNode::Product(a, b) => product(color(a), color(b)),
    }
}

/// A scalar source as a type and as a value.
pub(super) fn scalar(node: &ScalarNode) -> (String, String) {
    match node {
        ScalarNode::Const(value) => (
            "Const<f32>".to_owned(),
            format!("Const({}_f32)", number(*value)),
        ),
        ScalarNode::Param(offset) => ("Param".to_owned(), format!("Param({offset})")),
        ScalarNode::VertexAlpha => unit("VertexColor"),
        ScalarNode::Image(node) => image(node),
        ScalarNode::Product(a, b) => product(scalar(a), scalar(b)),
    }
}

fn product(a: (String, String), b: (String, String)) -> (String, String) {
    (
        format!("Product<{}, {}>", a.0, b.0),
        format!("Product({}, {})", a.1, b.1),
    )
}

fn image(node: &ImageNode) -> (String, String) {
    let (u, v) = node.wrap;
    let (filter, format) = (node.filter, node.format);
    let transform = match node.uv.transform {
        None => "None".to_owned(),
        Some(offset) => format!("Some({offset})"),
    };
    (
        format!("Image<{u:?}, {v:?}, {filter:?}, {format:?}>"),
        format!(
            "Image {{ slot: {}, uv: UvMap {{ set: {}, transform: {transform} }}, channel: {}, wrap: ({u:?}, {v:?}), \
             filter: {filter:?}, format: {format:?} }}",
            node.slot, node.uv.set, node.channel
        ),
    )
}
