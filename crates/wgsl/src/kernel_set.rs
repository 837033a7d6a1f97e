//! All kernels of a scene, by name: what a device loads, and a build script writes down.

use std::collections::BTreeMap;
use std::fmt::{self, Write};
use std::str::FromStr;

use residual_render::layer::Layers;
use residual_render::program::Structure;
use residual_render::tracer::{DebugView, PathOrigin, TracerNode};

use crate::arithmetic::Arithmetic;
use crate::kernels::{Kernels, Traits};

/// How work is divided into kernels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mapping {
    /// A kernel for each kind of work, between which paths wait in queues.
    #[default]
    Wavefront,
    /// One kernel, in which a thread follows a path to its end.
    Megakernel,
}

impl Mapping {
    const ALL: [Self; 2] = [Self::Wavefront, Self::Megakernel];
}

impl fmt::Display for Mapping {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Wavefront => "wavefront",
            Self::Megakernel => "megakernel",
        })
    }
}

/// The kernels of a scene, and what a device has to know of them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KernelSet {
    /// How work is divided.
    pub mapping: Mapping,
    /// What a sample has beside radiance.
    pub layers: Layers,
    /// The image is of what traversal visits: a sample is their number.
    pub shows_traversal: bool,
    /// Queues of hits: one a program, and one of rays that hit nothing.
    pub queues: usize,
    texts: BTreeMap<String, String>,
}

impl KernelSet {
    /// The kernels of a structure, with operations spelled for an adapter.
    pub fn new(
        structure: &Structure,
        mapping: Mapping,
        sided: bool,
        f64: bool,
        arithmetic: Arithmetic,
    ) -> Self {
        let shows_traversal = structure.tracer == TracerNode::Debug(DebugView::TraversalCost);
        let traits = Traits {
            sided,
            visits: shows_traversal,
            f64,
        };
        let from = |origin| Kernels::new(structure, origin, traits, arithmetic);
        let of_camera = from(PathOrigin::Camera);
        let mut set = Self {
            mapping,
            layers: structure.layers,
            shows_traversal,
            queues: of_camera.queues(),
            texts: BTreeMap::new(),
        };
        set.add(&of_camera);
        if structure.tracer.has_light_paths() {
            set.add(&from(PathOrigin::Lights));
        }
        set
    }

    fn add(&mut self, kernels: &Kernels) {
        let prefix = prefix(kernels.origin());
        let mut add = |name: &str, text| self.texts.insert(format!("{prefix}{name}"), text);
        match self.mapping {
            Mapping::Wavefront => {
                add("control", kernels.control());
                add("emit", kernels.emit());
                add("scatter", kernels.scatter());
                add("trace", kernels.trace());
                let folded = kernels.folded();
                if !folded.is_empty() {
                    add(FOLDED, kernels.shade_folded());
                }
                let alone = |queue: &usize| !folded.contains(queue);
                for queue in kernels.queues_with_steps().filter(alone) {
                    add(&format!("shade {queue}"), kernels.shade(queue));
                }
            }
            Mapping::Megakernel => {
                add("megakernel", kernels.megakernel());
            }
        }
    }

    /// The kernels of the paths that begin at one end; `None` if none do.
    pub fn of(&self, origin: PathOrigin) -> Option<KernelTexts<'_>> {
        let prefix = prefix(origin);
        let is_of = |name: &String| name.starts_with(prefix);
        let texts = KernelTexts { set: self, prefix };
        self.texts.keys().any(is_of).then_some(texts)
    }

    /// The names of all kernels with their texts.
    pub fn texts(&self) -> impl Iterator<Item = (&str, &str)> {
        let texts = self.texts.iter();
        texts.map(|(name, text)| (name.as_str(), text.as_str()))
    }
}

/// The kernels of paths that begin at one end.
#[derive(Clone, Copy, Debug)]
pub struct KernelTexts<'s> {
    set: &'s KernelSet,
    prefix: &'static str,
}

impl<'s> KernelTexts<'s> {
    /// The text of a kernel: `emit`, `trace`, `control`, `scatter`, or `megakernel`.
    pub fn text(self, name: &str) -> Option<&'s str> {
        let name = format!("{}{name}", self.prefix);
        self.set.texts.get(&name).map(String::as_str)
    }

    /// The kernels that shade, each with its queue; the one of folded queues has the number behind them.
    pub fn shade(self) -> impl Iterator<Item = (usize, &'s str)> {
        let queues = self.set.queues;
        let alone = move |queue| Some((queue, self.text(&format!("shade {queue}"))?));
        let folded = self.text(FOLDED).map(|text| (queues, text));
        (0..queues).filter_map(alone).chain(folded)
    }
}

/// What the names of kernels begin with.
fn prefix(origin: PathOrigin) -> &'static str {
    match origin {
        PathOrigin::Camera => "",
        PathOrigin::Lights => "lights: ",
    }
}

/// The kernel of the queues whose steps are short.
const FOLDED: &str = "shade folded";
const HEAD: &str = "// residual kernels, version 3: ";
const KERNEL: &str = "// kernel: ";

/// One text, which is read back.
impl fmt::Display for KernelSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut text = format!(
            "{HEAD}{} {} {} {}\n",
            self.mapping,
            self.layers.bits(),
            u8::from(self.shows_traversal),
            self.queues
        );
        for (name, kernel) in &self.texts {
            let _ = write!(text, "{KERNEL}{name}\n{kernel}");
        }
        f.write_str(&text)
    }
}

impl FromStr for KernelSet {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let error =
            |what: &str| format!("these are no kernels of this version: {what}; emit them anew");
        let (head, rest) = text.split_once('\n').unwrap_or((text, ""));
        let head = head
            .strip_prefix(HEAD)
            .ok_or_else(|| error("the first line"))?;
        let words: Vec<&str> = head.split(' ').collect();
        let [mapping, layers, shows_traversal, queues] = words[..] else {
            return Err(error("the first line"));
        };
        let mapping = Mapping::ALL.into_iter().find(|m| m.to_string() == mapping);
        let number = |word: &str| word.parse::<u32>().map_err(|_| error("a number"));
        let mut texts = BTreeMap::new();
        for kernel in rest.split(KERNEL).skip(1) {
            let (name, text) = kernel.split_once('\n').ok_or_else(|| error("a kernel"))?;
            texts.insert(name.to_owned(), text.to_owned());
        }
        Ok(Self {
            mapping: mapping.ok_or_else(|| error("the mapping"))?,
            layers: Layers::from_bits(number(layers)?),
            shows_traversal: number(shows_traversal)? != 0,
            queues: number(queues)? as usize,
            texts,
        })
    }
}
