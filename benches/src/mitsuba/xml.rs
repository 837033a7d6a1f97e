//! Elements of XML, as Mitsuba reads them.

use std::fmt::{self, Display};

/// An element with its attributes and children.
#[derive(Clone, Debug)]
pub(super) struct Element {
    tag: &'static str,
    attributes: Vec<(&'static str, String)>,
    children: Vec<Element>,
}

impl Element {
    /// An empty element.
    pub(super) fn new(tag: &'static str) -> Self {
        Self {
            tag,
            attributes: Vec::new(),
            children: Vec::new(),
        }
    }

    /// A plugin of a kind, such as `bsdf`, and its type, such as `diffuse`.
    pub(super) fn plugin(kind: &'static str, plugin_type: &str) -> Self {
        Self::new(kind).attribute("type", plugin_type)
    }

    /// A property: an element with a name and a value.
    fn property(tag: &'static str, name: &str, value: impl Display) -> Self {
        Self::new(tag)
            .attribute("name", name)
            .attribute("value", value)
    }

    /// With one attribute more.
    pub(super) fn attribute(mut self, name: &'static str, value: impl Display) -> Self {
        self.attributes.push((name, value.to_string()));
        self
    }

    /// With one child more.
    pub(super) fn child(mut self, child: Element) -> Self {
        self.children.push(child);
        self
    }

    /// With more children.
    pub(super) fn children(mut self, children: impl IntoIterator<Item = Element>) -> Self {
        self.children.extend(children);
        self
    }

    /// A colour, linear Rec. 709.
    pub(super) fn color(name: &str, [r, g, b]: [f32; 3]) -> Self {
        Self::property("rgb", name, format_args!("{r}, {g}, {b}"))
    }

    /// A transform by a matrix, whose rows are given.
    pub(super) fn matrix(name: &str, rows: [[f32; 3]; 3]) -> Self {
        let numbers = rows.as_flattened().iter().map(f32::to_string);
        let numbers = numbers.collect::<Vec<_>>().join(" ");
        let matrix = Self::new("matrix").attribute("value", numbers);
        Self::new("transform").attribute("name", name).child(matrix)
    }

    /// With a colour.
    pub(super) fn rgb(self, name: &str, color: [f32; 3]) -> Self {
        self.child(Self::color(name, color))
    }

    /// With a number.
    pub(super) fn float(self, name: &str, value: impl Display) -> Self {
        self.child(Self::property("float", name, value))
    }

    /// With a whole number.
    pub(super) fn integer(self, name: &str, value: u32) -> Self {
        self.child(Self::property("integer", name, value))
    }

    /// With a text.
    pub(super) fn string(self, name: &str, value: &str) -> Self {
        self.child(Self::property("string", name, value))
    }

    /// With a property that is set.
    pub(super) fn enabled(self, name: &str) -> Self {
        self.child(Self::property("boolean", name, true))
    }

    /// With a point or a vector.
    pub(super) fn triple(self, tag: &'static str, name: &str, [x, y, z]: [f32; 3]) -> Self {
        let triple = Self::new(tag).attribute("name", name);
        self.child(triple.attribute("x", x).attribute("y", y).attribute("z", z))
    }

    fn print(&self, f: &mut fmt::Formatter<'_>, depth: usize) -> fmt::Result {
        let indent = 4 * depth;
        write!(f, "{:indent$}<{}", "", self.tag)?;
        for (name, value) in &self.attributes {
            write!(f, " {name}=\"{}\"", escaped(value))?;
        }
        if self.children.is_empty() {
            return writeln!(f, "/>");
        }
        writeln!(f, ">")?;
        for child in &self.children {
            child.print(f, depth + 1)?;
        }
        writeln!(f, "{:indent$}</{}>", "", self.tag)
    }
}

impl Display for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.print(f, 0)
    }
}

fn escaped(value: &str) -> String {
    value
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_nest_and_values_are_escaped() {
        let element = Element::plugin("shape", "ply")
            .string("filename", "a \"b\" & <c>")
            .child(Element::plugin("bsdf", "diffuse").rgb("reflectance", [0.1, 0.25, 1.0]));
        let expected = r#"<shape type="ply">
    <string name="filename" value="a &quot;b&quot; &amp; &lt;c&gt;"/>
    <bsdf type="diffuse">
        <rgb name="reflectance" value="0.1, 0.25, 1"/>
    </bsdf>
</shape>
"#;
        assert_eq!(element.to_string(), expected);
    }
}
