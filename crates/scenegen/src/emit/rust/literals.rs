//! Nodes as Rust: each as a value, and those without inputs as types. What a node is made of is said by the node table.

use residual_render::program::{Field, Form, ImageNode, Literal, Program, Source, Structure};
use residual_render::surface::Attributes;
use residual_render::texture::UvMap;

use super::layout::{Code, Name};

/// How nodes are printed: what stands for images and inputs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Literals<'a> {
    images: &'a Images<'a>,
    inputs: &'a [String],
}

impl<'a> Literals<'a> {
    /// Of nodes with inputs of these names.
    pub(super) fn new(images: &'a Images<'a>, inputs: &'a [String]) -> Self {
        Self { images, inputs }
    }

    /// The node's value.
    pub(super) fn value(&self, node: &Literal<'_>) -> Code {
        let name = Name::of(node.module, node.name);
        let mut fields = node.fields.iter().map(|(_, field)| self.value_of(field));
        match node.form {
            Form::Unit => Code::Word(name),
            Form::Value => fields.next().expect("the field is the node"),
            Form::Tuple => Code::call(name, fields.collect::<Vec<_>>()),
            Form::Struct => {
                let names = node.fields.iter().map(|(name, _)| *name);
                Code::literal(name, names.zip(fields))
            }
        }
    }

    fn value_of(&self, field: &Field<'_>) -> Code {
        match *field {
            Field::Input(input) => Code::word(self.inputs[input.0].as_str()),
            Field::Bsdf(node) => self.value(&node.literal()),
            Field::Fresnel(node) => self.value(&node.literal()),
            Field::Roughness(node) => self.value(&node.literal()),
            Field::LayerFrame(node) => self.value(&node.literal()),
            Field::ColorSource(node) => self.value(&node.literal()),
            Field::ScalarSource(node) => self.value(&node.literal()),
            Field::Image(image) => Code::Word(self.images.name(image)),
            Field::Interface(interface) => Code::Word(Name::of("bsdf", format!("{interface:?}"))),
            Field::Number(value) => Code::word(format!("{}_f32", number(value))),
            Field::Color(color) => Code::word(format!("[{}]", color.map(number).join(", "))),
            Field::Offset(offset) => Code::word(offset.to_string()),
            Field::Coordinates(uv) => coordinates(uv),
            Field::Attributes(attributes) => attribute_set(attributes),
        }
    }

    /// The node's type.
    pub(super) fn kind(&self, node: &Literal<'_>) -> Code {
        let name = Name::of(node.module, node.name);
        let arguments = node.fields.iter();
        let arguments: Vec<_> = arguments
            .filter_map(|(_, field)| self.kind_of(field))
            .collect();
        match (node.form, arguments.is_empty()) {
            (Form::Value, _) => arguments.into_iter().next().expect("the field is the node"),
            (_, true) => Code::Word(name),
            (_, false) => Code::generic(name, arguments),
        }
    }

    /// The type of a field, if it is a parameter of the node's type.
    fn kind_of(&self, field: &Field<'_>) -> Option<Code> {
        match *field {
            Field::Input(_) => unreachable!("nodes with inputs are printed as values only"),
            Field::Bsdf(node) => Some(self.kind(&node.literal())),
            Field::Fresnel(node) => Some(self.kind(&node.literal())),
            Field::Roughness(node) => Some(self.kind(&node.literal())),
            Field::LayerFrame(node) => Some(self.kind(&node.literal())),
            Field::ColorSource(node) => Some(self.kind(&node.literal())),
            Field::ScalarSource(node) => Some(self.kind(&node.literal())),
            Field::Image(image) => Some(image_kind(image)),
            Field::Interface(_) => Some(self.value_of(field)),
            Field::Number(_) => Some(Code::word("f32")),
            Field::Color(_) => Some(Code::word("[f32; 3]")),
            Field::Offset(_) | Field::Coordinates(_) | Field::Attributes(_) => None,
        }
    }
}

/// A number that reads back as the same bits. Plans hold finite numbers only.
fn number(value: f32) -> String {
    assert!(value.is_finite(), "a plan holds finite numbers");
    format!("{value:?}")
}

/// The vertex attributes that are read.
pub(super) fn attribute_set(attributes: Attributes) -> Code {
    let Attributes {
        normals,
        tangents,
        uv0,
        uv1,
        colors,
    } = attributes;
    let named = [
        ("normals", normals),
        ("tangents", tangents),
        ("uv0", uv0),
        ("uv1", uv1),
        ("colors", colors),
    ];
    if attributes == Attributes::NONE {
        return Code::Word(Name::of("surface", "Attributes::NONE"));
    }
    let set = named.into_iter().filter(|(_, on)| *on);
    let set = set.map(|(name, _)| (name, Code::word("true")));
    Code::literal(Name::of("surface", "Attributes"), set).with_rest("Attributes::NONE")
}

fn coordinates(uv: UvMap) -> Code {
    let transform = match uv.transform {
        None => "None".to_owned(),
        Some(offset) => format!("Some({offset})"),
    };
    let fields = [
        ("set", Code::word(uv.set.to_string())),
        ("transform", Code::word(transform)),
    ];
    Code::literal(Name::of("texture", "UvMap"), fields)
}

/// The images that a structure reads, each once: constants of the emitted module.
#[derive(Debug)]
pub(super) struct Images<'a>(Vec<&'a ImageNode>);

impl<'a> Images<'a> {
    pub(super) fn of(structure: &'a Structure) -> Self {
        let mut images = Vec::new();
        for leaf in structure.programs.iter().flat_map(Program::leaves) {
            if let residual_render::program::Leaf::Image(image) = leaf
                && !images.contains(&image)
            {
                images.push(image);
            }
        }
        Self(images)
    }

    /// For each image its name, its type and its value.
    pub(super) fn constants(&self) -> impl Iterator<Item = (String, Code, Code)> {
        let constant = |(index, image): (usize, &&ImageNode)| {
            (name(index), image_kind(image), image_value(image))
        };
        self.0.iter().enumerate().map(constant)
    }

    fn name(&self, image: &ImageNode) -> Name {
        let index = self.0.iter().position(|other| *other == image);
        Name::emitted(name(
            index.expect("all images of the structure were collected"),
        ))
    }
}

fn name(index: usize) -> String {
    format!("TEXTURE_{index}")
}

/// The unit types of an image: wraps, filter, format.
fn image_kinds(image: &ImageNode) -> [Code; 4] {
    let (u, v) = image.wrap;
    let kinds = [
        format!("{u:?}"),
        format!("{v:?}"),
        format!("{:?}", image.filter),
        format!("{:?}", image.format),
    ];
    kinds.map(|kind| Code::Word(Name::of("texture", kind)))
}

fn image_kind(image: &ImageNode) -> Code {
    Code::generic(Name::of("texture", "Image"), image_kinds(image))
}

fn image_value(image: &ImageNode) -> Code {
    let [u, v, filter, format] = image_kinds(image);
    let fields = [
        ("slot", Code::word(image.slot.to_string())),
        ("uv", coordinates(image.uv)),
        ("channel", Code::word(image.channel.to_string())),
        ("wrap", Code::tuple([u, v])),
        ("filter", filter),
        ("format", format),
    ];
    Code::literal(Name::of("texture", "Image"), fields)
}
