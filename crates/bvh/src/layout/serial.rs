//! A hierarchy as bytes, for files.
//!
//! Everything is little-endian:
//!
//! ```text
//! magic      8 bytes "ResidBVH"
//! version    u32
//! N, P       u32, u32
//! nodes      u64, how many
//! packets    u64, how many
//! cost       f32, by the surface area heuristic
//! nodes      each 6 × N f32 bounds, N u32 children
//! packets    each 9 × P f32 vertices, P u32 triangle indices
//! ```
//!
//! What is read is checked as [`crate::BvhView::new`] checks, so that bytes from anywhere can be
//! traversed. Triangle indices are what the bytes say.

use std::fmt;
use std::io::{self, ErrorKind, Read, Write};

use crate::layout::bvh::Bvh;
use crate::layout::node::WideNode;
use crate::layout::triangle_packet::TrianglePacket;
use crate::layout::validate::{InvalidBvh, check_nodes};

const MAGIC: [u8; 8] = *b"ResidBVH";
const VERSION: u32 = 1;
/// Records that are read together: so much is allocated before it is delivered.
const CHUNK: usize = 256;

/// Why bytes are not a hierarchy that can be loaded.
#[derive(Debug)]
#[non_exhaustive]
pub enum LoadError {
    /// Reading failed.
    Io(io::Error),
    /// The bytes do not begin as a hierarchy does.
    NotAHierarchy,
    /// Another version of the format.
    Version(u32),
    /// A hierarchy of other widths.
    Widths {
        /// Children of a node, `N`.
        nodes: u32,
        /// Triangles of a packet, `P`.
        packets: u32,
    },
    /// The bytes end too early.
    Truncated,
    /// The nodes and packets do not form a hierarchy.
    Structure(InvalidBvh),
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LoadError::Io(error) => write!(f, "cannot read the hierarchy: {error}"),
            LoadError::NotAHierarchy => write!(f, "not a hierarchy"),
            LoadError::Version(version) => {
                write!(f, "hierarchy of version {version}, expected {VERSION}")
            }
            LoadError::Widths { nodes, packets } => write!(
                f,
                "hierarchy of other widths: {nodes} children a node, {packets} triangles a packet"
            ),
            LoadError::Truncated => write!(f, "the hierarchy ends too early"),
            LoadError::Structure(error) => write!(f, "broken hierarchy: {error}"),
        }
    }
}

impl std::error::Error for LoadError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            LoadError::Io(error) => Some(error),
            LoadError::Structure(error) => Some(error),
            LoadError::NotAHierarchy
            | LoadError::Version(_)
            | LoadError::Widths { .. }
            | LoadError::Truncated => None,
        }
    }
}

impl From<io::Error> for LoadError {
    fn from(error: io::Error) -> LoadError {
        if error.kind() == ErrorKind::UnexpectedEof {
            LoadError::Truncated
        } else {
            LoadError::Io(error)
        }
    }
}

impl<const N: usize, const P: usize> Bvh<N, P> {
    /// Writes the hierarchy, in pieces of some kilobytes. Equal hierarchies give equal bytes.
    pub fn write_to(&self, writer: &mut impl Write) -> io::Result<()> {
        writer.write_all(&MAGIC)?;
        for word in [VERSION, N as u32, P as u32] {
            writer.write_all(&word.to_le_bytes())?;
        }
        for count in [self.nodes.len(), self.packets.len()] {
            writer.write_all(&(count as u64).to_le_bytes())?;
        }
        writer.write_all(&self.sah_cost.to_le_bytes())?;
        write_records(writer, &self.nodes)?;
        write_records(writer, &self.packets)
    }

    /// Reads what [`write_to`](Bvh::write_to) wrote, and no byte more. Memory is taken as the bytes
    /// arrive, however many are said to follow.
    pub fn read_from(reader: &mut impl Read) -> Result<Bvh<N, P>, LoadError> {
        let magic: [u8; 8] = read(reader)?;
        if magic != MAGIC {
            return Err(LoadError::NotAHierarchy);
        }
        let version = u32::from_le_bytes(read(reader)?);
        if version != VERSION {
            return Err(LoadError::Version(version));
        }
        let nodes = u32::from_le_bytes(read(reader)?);
        let packets = u32::from_le_bytes(read(reader)?);
        if (nodes as usize, packets as usize) != (N, P) {
            return Err(LoadError::Widths { nodes, packets });
        }
        let node_count = u64::from_le_bytes(read(reader)?);
        let packet_count = u64::from_le_bytes(read(reader)?);
        let sah_cost = f32::from_le_bytes(read(reader)?);
        let nodes: Vec<WideNode<N>> = read_records(reader, node_count)?;
        let packets: Vec<TrianglePacket<P>> = read_records(reader, packet_count)?;
        check_nodes(&nodes, packets.len()).map_err(LoadError::Structure)?;
        Ok(Bvh {
            nodes,
            packets,
            sah_cost,
        })
    }
}

fn read<const BYTES: usize>(reader: &mut impl Read) -> io::Result<[u8; BYTES]> {
    let mut bytes = [0; BYTES];
    reader.read_exact(&mut bytes)?;
    Ok(bytes)
}

/// A node or a packet as a sequence of 32-bit words.
trait FileRecord: Sized {
    const WORDS: usize;
    fn write(&self, word: &mut dyn FnMut(u32));
    fn read(word: &mut dyn FnMut() -> u32) -> Self;
}

impl<const N: usize> FileRecord for WideNode<N> {
    const WORDS: usize = 7 * N;

    fn write(&self, word: &mut dyn FnMut(u32)) {
        self.bounds.iter().flatten().for_each(|x| word(x.to_bits()));
        self.children.iter().for_each(|&child| word(child));
    }

    fn read(word: &mut dyn FnMut() -> u32) -> Self {
        let mut node = WideNode::VACANT;
        for x in node.bounds.iter_mut().flatten() {
            *x = f32::from_bits(word());
        }
        node.children = std::array::from_fn(|_| word());
        node
    }
}

impl<const P: usize> FileRecord for TrianglePacket<P> {
    const WORDS: usize = 10 * P;

    fn write(&self, word: &mut dyn FnMut(u32)) {
        let coordinates = self.vertices.iter().flatten().flatten();
        coordinates.for_each(|x| word(x.to_bits()));
        self.prim_ids.iter().for_each(|&prim| word(prim));
    }

    fn read(word: &mut dyn FnMut() -> u32) -> Self {
        let mut packet = TrianglePacket::VACANT;
        for x in packet.vertices.iter_mut().flatten().flatten() {
            *x = f32::from_bits(word());
        }
        packet.prim_ids = std::array::from_fn(|_| word());
        packet
    }
}

fn write_records<R: FileRecord>(writer: &mut impl Write, records: &[R]) -> io::Result<()> {
    let mut bytes = Vec::with_capacity(4 * R::WORDS * CHUNK);
    for chunk in records.chunks(CHUNK) {
        bytes.clear();
        for record in chunk {
            record.write(&mut |word| bytes.extend(word.to_le_bytes()));
        }
        writer.write_all(&bytes)?;
    }
    Ok(())
}

fn read_records<R: FileRecord>(reader: &mut impl Read, count: u64) -> io::Result<Vec<R>> {
    let mut bytes = vec![0; 4 * R::WORDS * CHUNK];
    let mut records = Vec::new();
    let mut left = count;
    while left > 0 {
        let here = left.min(CHUNK as u64);
        let bytes = &mut bytes[..4 * R::WORDS * here as usize];
        reader.read_exact(bytes)?;
        let (words, _) = bytes.as_chunks();
        let mut words = words.iter().map(|&word| u32::from_le_bytes(word));
        let mut word = || words.next().expect("as many words as the records have");
        records.extend((0..here).map(|_| R::read(&mut word)));
        left -= here;
    }
    Ok(records)
}
