//! What a compiled renderer is made of: which source files its instructions come from, through inlined calls too.
//!
//! It is compiled as any renderer, but with line tables, which the optimiser does not see.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use addr2line::gimli::{Dwarf, EndianSlice, LittleEndian};
use object::{Object as _, ObjectSection as _, ObjectSymbol as _, SymbolKind};
use residual_device_cpu::LaneCount;
use residual_driver::compile_with_line_tables;
use residual_scenegen::plan::Plan;

/// A library's contents.
#[derive(Debug, Default)]
pub struct Library {
    /// Bytes of instructions, the standard library's included.
    pub size: u64,
    /// Bytes of functions of the project and of the lanes that its functions are inlined into.
    pub own: u64,
    /// Bytes of those whose place in the sources is known.
    pub known: u64,
    /// Bytes of instructions to which a file contributed: its own, and what was inlined into it.
    pub files: BTreeMap<String, u64>,
    /// Names of functions, of inlined ones too.
    pub functions: BTreeSet<String>,
    /// Names in the symbol table.
    pub symbols: BTreeSet<String>,
}

impl Library {
    /// Compiles a plan's renderer for eight lanes.
    ///
    /// # Panics
    /// If that fails, or what cargo makes cannot be read.
    pub fn compile(plan: &Plan) -> Self {
        let place = tempfile::NamedTempFile::new().expect("a temporary file");
        compile_with_line_tables(plan, LaneCount::Eight, place.path()).expect("a library");
        let data = fs::read(place.path()).expect("the library that cargo made");
        Self::read(&data)
    }

    fn read(data: &[u8]) -> Self {
        let object = object::File::parse(data).expect("a shared library");
        let section = |id: addr2line::gimli::SectionId| {
            let section = object.section_by_name(id.name());
            let data = section.map_or(Ok(&[][..]), |section| section.data())?;
            Ok::<_, object::Error>(EndianSlice::new(data, LittleEndian))
        };
        let dwarf = Dwarf::load(section).expect("sections");
        let context = addr2line::Context::from_dwarf(dwarf).expect("debugging information");
        let text = object.section_by_name(".text").expect("instructions");

        let mut library = Self {
            size: text.size(),
            ..Self::default()
        };
        let mut own = BTreeMap::new();
        for symbol in object.symbols() {
            let name = symbol.name().expect("a name of the compiler's");
            let name = addr2line::demangle_auto(name.into(), None).into_owned();
            let own_name = ["residual_", "fearless_simd"]
                .iter()
                .any(|part| name.contains(part));
            if symbol.kind() == SymbolKind::Text && own_name {
                own.insert(symbol.address(), symbol.address() + symbol.size());
            }
            library.symbols.insert(name);
        }
        library.own = own.iter().map(|(start, end)| end - start).sum();
        let is_own = |address| {
            let before = own.range(..=address).next_back();
            before.is_some_and(|(_, end)| address < *end)
        };

        let (start, end) = (text.address(), text.address() + text.size());
        let ranges = context
            .find_location_range(start, end)
            .expect("line tables");
        for (address, length, _) in ranges {
            if is_own(address) {
                library.known += length;
            }
            let mut frames = context
                .find_frames(address)
                .skip_all_loads()
                .expect("frames");
            let mut files = BTreeSet::new();
            while let Some(frame) = frames.next().expect("a frame") {
                files.extend(frame.location.and_then(|location| location.file));
                if let Some(name) = frame
                    .function
                    .and_then(|f| Some(f.demangle().ok()?.into_owned()))
                {
                    library.functions.insert(name);
                }
            }
            for file in files {
                *library.files.entry(file.to_owned()).or_default() += length;
            }
        }
        library
    }

    /// The project's source files, from `crates/` on, with the bytes of instructions that they contributed to.
    pub fn sources(&self) -> impl Iterator<Item = (&str, u64)> {
        let below = |(file, bytes): (&'_ String, &u64)| {
            let start = CRATES
                .iter()
                .find_map(|name| file.find(&format!("crates/{name}/")))?;
            Some((start + "crates/".len(), *bytes))
        };
        self.files.iter().filter_map(move |entry| {
            let (start, bytes) = below(entry)?;
            Some((&entry.0[start..], bytes))
        })
    }

    /// Whether a function is in it, inlined or not, whose name contains this.
    pub fn has_function(&self, part: &str) -> bool {
        let mut names = self.functions.iter().chain(&self.symbols);
        names.any(|name| name.contains(part))
    }

    /// Bytes of instructions to which a source file contributed.
    pub fn bytes_of(&self, file: &str) -> u64 {
        let found = self.sources().filter(|(source, _)| *source == file);
        found.map(|(_, bytes)| bytes).sum()
    }
}

/// The crates that renderers are made of.
const CRATES: [&str; 3] = ["bvh", "render", "device-cpu"];
