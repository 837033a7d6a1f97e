//! Sources as Rust: each as a type and as a value.

use residual_render::program::{ColorNode, ImageNode, ScalarNode, SourceNode, Structure};

use super::layout::Code;

/// A type, and its value.
pub(super) type Typed = (Code, Code);

/// A type whose only value has its name.
pub(super) fn unit(name: &str) -> Typed {
    (Code::word(name), Code::word(name))
}

/// A number that reads back as the same bits. Plans hold finite numbers only.
fn number(value: f32) -> String {
    assert!(value.is_finite(), "a plan holds finite numbers");
    format!("{value:?}")
}

/// The images that a structure reads, each once: constants of the emitted module.
#[derive(Debug, Default)]
pub(super) struct Textures<'a>(Vec<&'a ImageNode>);

impl<'a> Textures<'a> {
    pub(super) fn of(structure: &'a Structure) -> Self {
        let mut textures = Self::default();
        for program in &structure.programs {
            for input in &program.inputs {
                match &input.source {
                    SourceNode::Color(node) => textures.add_color(node),
                    SourceNode::Scalar(node) => textures.add_scalar(node),
                }
            }
            if let Some(alpha) = &program.alpha {
                textures.add_scalar(&alpha.alpha);
            }
        }
        textures
    }

    fn add(&mut self, node: &'a ImageNode) {
        if !self.0.contains(&node) {
            self.0.push(node);
        }
    }

    fn add_color(&mut self, node: &'a ColorNode) {
        match node {
            ColorNode::Const(_) | ColorNode::Param(_) | ColorNode::VertexColor => {}
            ColorNode::Image(node) => self.add(node),
            ColorNode::Gray(node) => self.add_scalar(node),
            ColorNode::Product(a, b) => {
                self.add_color(a);
                self.add_color(b);
            }
        }
    }

    fn add_scalar(&mut self, node: &'a ScalarNode) {
        match node {
            ScalarNode::Const(_) | ScalarNode::Param(_) | ScalarNode::VertexAlpha => {}
            ScalarNode::Image(node) => self.add(node),
            ScalarNode::Product(a, b) => {
                self.add_scalar(a);
                self.add_scalar(b);
            }
        }
    }

    /// The constants.
    pub(super) fn constants(&self) -> impl Iterator<Item = String> {
        self.0.iter().enumerate().map(|(number, node)| {
            let (kind, value) = image(node);
            let start = format!("const {}: {} = ", name(number), kind.lines(0, 0, 0));
            format!("{start}{};", value.lines(0, start.len(), 1))
        })
    }

    /// A colour source.
    pub(super) fn color(&self, node: &ColorNode) -> Typed {
        match node {
            ColorNode::Const(value) => {
                let [r, g, b] = value.map(number);
                let value = Code::word(format!("Const([{r}, {g}, {b}])"));
                (Code::word("Const<[f32; 3]>"), value)
            }
            ColorNode::Param(offset) => param(*offset),
            ColorNode::VertexColor => unit("VertexColor"),
            ColorNode::Image(node) => self.texture(node),
            ColorNode::Gray(node) => {
                let (kind, value) = self.scalar(node);
                (Code::generic("Gray", [kind]), Code::call("Gray", [value]))
            }
            ColorNode::Product(a, b) => product(self.color(a), self.color(b)),
        }
    }

    /// A scalar source.
    pub(super) fn scalar(&self, node: &ScalarNode) -> Typed {
        match node {
            ScalarNode::Const(value) => {
                let value = Code::word(format!("Const({}_f32)", number(*value)));
                (Code::word("Const<f32>"), value)
            }
            ScalarNode::Param(offset) => param(*offset),
            ScalarNode::VertexAlpha => unit("VertexColor"),
            ScalarNode::Image(node) => self.texture(node),
            ScalarNode::Product(a, b) => product(self.scalar(a), self.scalar(b)),
        }
    }

    fn texture(&self, node: &ImageNode) -> Typed {
        let number = self.0.iter().position(|other| *other == node);
        let number = number.expect("all images of the structure were collected");
        (image(node).0, Code::word(name(number)))
    }
}

fn name(number: usize) -> String {
    format!("TEXTURE_{number}")
}

fn param(offset: u32) -> Typed {
    (Code::word("Param"), Code::word(format!("Param({offset})")))
}

fn product(a: Typed, b: Typed) -> Typed {
    (
        Code::generic("Product", [a.0, b.0]),
        Code::call("Product", [a.1, b.1]),
    )
}

fn image(node: &ImageNode) -> Typed {
    let (u, v) = node.wrap;
    let (filter, format) = (node.filter, node.format);
    let transform = match node.uv.transform {
        None => "None".to_owned(),
        Some(offset) => format!("Some({offset})"),
    };
    let uv = [
        ("set", Code::word(node.uv.set.to_string())),
        ("transform", Code::word(transform)),
    ];
    let fields = [
        ("slot", Code::word(node.slot.to_string())),
        ("uv", Code::literal("UvMap", uv)),
        ("channel", Code::word(node.channel.to_string())),
        ("wrap", Code::word(format!("({u:?}, {v:?})"))),
        ("filter", Code::word(format!("{filter:?}"))),
        ("format", Code::word(format!("{format:?}"))),
    ];
    let kinds = [
        format!("{u:?}"),
        format!("{v:?}"),
        format!("{filter:?}"),
        format!("{format:?}"),
    ];
    (
        Code::generic("Image", kinds.map(Code::Word)),
        Code::literal("Image", fields),
    )
}
