//! Where buffers are bound. Adapters promise eight storage buffers a stage, so several share one binding.

use std::collections::BTreeSet;
use std::fmt::Write;

use residual_render::domain::Buffer;

/// A storage buffer of group 0: an array of words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Binding {
    /// Triangles and their vertices.
    Geometry,
    /// Texels of all images.
    Texels,
    /// Parameters, lights, the environment, the camera.
    Tables,
}

impl Binding {
    /// All of them; their places here are their numbers.
    pub const ALL: [Self; 3] = [Self::Geometry, Self::Texels, Self::Tables];
    /// The number of the uniform buffer behind them, which says where each [`Buffer`] begins.
    pub const BASES: u32 = Self::ALL.len() as u32;

    /// The binding that a buffer is part of.
    pub const fn of(buffer: Buffer) -> Self {
        match buffer {
            Buffer::Triangles
            | Buffer::Normals
            | Buffer::Tangents
            | Buffer::Uvs
            | Buffer::Colors => Self::Geometry,
            Buffer::Texels => Self::Texels,
            Buffer::Params
            | Buffer::Lights
            | Buffer::LightAlias
            | Buffer::LightTree
            | Buffer::Environment
            | Buffer::Camera
            | Buffer::Objects
            | Buffer::Media => Self::Tables,
        }
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Geometry => "geometry",
            Self::Texels => "texels",
            Self::Tables => "tables",
        }
    }

    /// The buffers in it, in their order.
    pub fn buffers(self) -> impl Iterator<Item = Buffer> {
        Buffer::ALL
            .into_iter()
            .filter(move |&buffer| Self::of(buffer) == self)
    }

    /// Whether a buffer is its first, which begins at 0.
    fn begins_with(self, buffer: Buffer) -> bool {
        self.buffers().next() == Some(buffer)
    }
}

/// The name of a buffer: `LightAlias` is `light_alias`.
fn buffer_name(buffer: Buffer) -> String {
    let mut name = String::new();
    for letter in format!("{buffer:?}").chars() {
        if letter.is_ascii_uppercase() && !name.is_empty() {
            name.push('_');
        }
        name.push(letter.to_ascii_lowercase());
    }
    name
}

/// A word of a buffer as an expression; `index` may stand as an operand.
pub(crate) fn load(buffer: Buffer, index: &str) -> String {
    let binding = Binding::of(buffer);
    let word = match (binding.begins_with(buffer), index) {
        (true, index) => index.to_owned(),
        (false, "0u") => format!("bases.{}", buffer_name(buffer)),
        (false, index) => format!("bases.{} + {index}", buffer_name(buffer)),
    };
    format!("{}[{word}]", binding.name())
}

/// The bindings that a text refers to.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bindings(BTreeSet<Binding>, bool);

impl Bindings {
    /// Adds what reading a buffer needs.
    pub(crate) fn insert(&mut self, buffer: Buffer) {
        let binding = Binding::of(buffer);
        self.0.insert(binding);
        self.1 |= !binding.begins_with(buffer);
    }

    pub(crate) fn extend(&mut self, other: &Self) {
        self.0.extend(&other.0);
        self.1 |= other.1;
    }

    /// Their declarations.
    pub(crate) fn declarations(&self) -> String {
        let mut text = String::new();
        for binding in &self.0 {
            let (number, name) = (*binding as u32, binding.name());
            let _ = writeln!(
                text,
                "@group(0) @binding({number}) var<storage, read> {name}: array<u32>;"
            );
        }
        if self.1 {
            let fields = Buffer::ALL.map(|buffer| format!("    {}: u32,\n", buffer_name(buffer)));
            let _ = write!(
                text,
                "@group(0) @binding({}) var<uniform> bases: Bases;\n\n// Where each buffer begins in its binding.\nstruct Bases {{\n{}}}\n",
                Binding::BASES,
                fields.concat()
            );
        }
        text
    }
}
