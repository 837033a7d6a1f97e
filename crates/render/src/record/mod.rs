//! Records: what buffers hold, each defined once, with its reader and its writer.
//!
//! `record!` declares a record as rows of four words, since lanes read rows (see
//! [`Domain::load_rows`](crate::domain::Domain::load_rows)). The struct that it makes is generic over [`Numbers`]: over a
//! domain it is what a formula has loaded, over [`Plain`] it is what a planner writes and a test reads back.

mod numbers;
mod rows;
#[cfg(test)]
mod tests;

pub use numbers::{Numbers, Offsets, Plain};
pub(crate) use rows::{RowReader, RowWriter, row, words_of_rows};

use crate::domain::Buffer;

/// A record of plain numbers, which can be written to a buffer and read back.
pub trait BufferRecord: Copy {
    /// Words that it occupies, a multiple of four. Those that no field has are 0.
    const WORDS: u32;

    /// Writes the record to the first [`WORDS`](BufferRecord::WORDS) of `words`.
    ///
    /// # Panics
    /// If there are fewer.
    fn write_to(self, words: &mut [u32]);

    /// Reads the record from the first [`WORDS`](BufferRecord::WORDS) of `words`.
    ///
    /// # Panics
    /// If there are fewer.
    fn from_words(words: &[u32]) -> Self;

    /// Appends the record to a buffer.
    fn append_to(self, buffer: &mut Vec<u32>) {
        let first = buffer.len();
        buffer.resize(first + Self::WORDS as usize, 0);
        self.write_to(&mut buffer[first..]);
    }
}

/// A record that has a buffer to itself: the buffer is an array of such records, or begins with one.
pub trait IndexedRecord: BufferRecord {
    /// The buffer.
    const BUFFER: Buffer;
}

/// How many words a kind of field has, and its type.
macro_rules! field {
    (words: vector) => {
        3
    };
    (words: $single:ident) => {
        1
    };
    (type of $n:ident: vector) => {
        $crate::math::Vec3<$n::F>
    };
    (type of $n:ident: real) => {
        $n::F
    };
    (type of $n:ident: word) => {
        $n::U
    };
}
pub(crate) use field;

/// Declares a record by its rows. A row has up to four words: a `word` is one, a `real` one, a `vector` of reals three; those
/// left over at its end are 0. With `in Buffer`, that buffer is an array of such records, or begins with one.
macro_rules! record {
    (
        $(#[$meta:meta])*
        pub struct $name:ident $(in $buffer:ident)? {
            $( row { $( $(#[$field_meta:meta])* $field:ident: $kind:ident ),+ $(,)? } )+
        }
    ) => {
        $(#[$meta])*
        pub struct $name<N: $crate::record::Numbers = $crate::record::Plain> {
            $( $( $(#[$field_meta])* pub $field: $crate::record::field!(type of N: $kind), )+ )+
        }

        impl $name {
            /// Rows of four words that it occupies.
            pub const ROWS: usize = [$( $crate::record::row(&[$( $crate::record::field!(words: $kind) ),+]) ),+].len();
            /// Words that it occupies.
            pub const WORDS: u32 = 4 * Self::ROWS as u32;
        }

        impl<N: $crate::record::Numbers> $name<N> {
            #[inline(always)]
            fn from_rows(numbers: N, rows: [[N::U; 4]; $name::<$crate::record::Plain>::ROWS]) -> Self {
                let mut reader = $crate::record::RowReader::new(numbers, rows);
                $( $( let $field = reader.$kind(); )+ reader.end_row(); )+
                Self { $( $( $field ),+ ),+ }
            }
        }

        impl $name<$crate::record::Offsets> {
            /// For each field, the word of the record at which it lies.
            #[inline(always)]
            pub fn offsets() -> Self {
                Self::from_rows($crate::record::Offsets, $crate::record::words_of_rows())
            }
        }

        impl<D: $crate::domain::Domain> $name<D> {
            /// The record that starts at word `first` of a buffer.
            #[inline(always)]
            pub fn load_at(d: D, buffer: $crate::domain::Buffer, first: D::U) -> Self {
                Self::from_rows(d, d.load_rows(buffer, first))
            }

            /// The record that starts at word `first` of a buffer, the same for all lanes.
            #[inline(always)]
            pub fn uniform_at(d: D, buffer: $crate::domain::Buffer, first: u32) -> Self {
                let words = $crate::record::words_of_rows();
                Self::from_rows(d, words.map(|row| row.map(|word| d.uniform(buffer, first + word))))
            }
        }

        $(
            impl $crate::record::IndexedRecord for $name {
                const BUFFER: $crate::domain::Buffer = $crate::domain::Buffer::$buffer;
            }

            impl<D: $crate::domain::Domain> $name<D> {
                /// The record with this index.
                #[inline(always)]
                pub fn load(d: D, index: D::U) -> Self {
                    let first = index * d.uint($name::<$crate::record::Plain>::WORDS);
                    Self::load_at(d, $crate::domain::Buffer::$buffer, first)
                }

                /// The buffer's first record, the same for all lanes.
                #[inline(always)]
                pub fn uniform(d: D) -> Self {
                    Self::uniform_at(d, $crate::domain::Buffer::$buffer, 0)
                }
            }
        )?

        // By hand, since types that a macro makes cannot be derived for.
        impl<N: $crate::record::Numbers> Clone for $name<N> {
            #[inline(always)]
            fn clone(&self) -> Self {
                *self
            }
        }

        impl<N: $crate::record::Numbers> Copy for $name<N> {}

        impl std::fmt::Debug for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                let mut fields = f.debug_struct(stringify!($name));
                $( $( fields.field(stringify!($field), &self.$field); )+ )+
                fields.finish()
            }
        }

        impl PartialEq for $name {
            fn eq(&self, other: &Self) -> bool {
                true $( $( && self.$field == other.$field )+ )+
            }
        }

        impl $crate::record::BufferRecord for $name {
            const WORDS: u32 = $name::<$crate::record::Plain>::WORDS;

            fn write_to(self, words: &mut [u32]) {
                let words = &mut words[..4 * Self::ROWS];
                let mut writer = $crate::record::RowWriter::new(words);
                $( $( writer.$kind(self.$field); )+ writer.end_row(); )+
            }

            fn from_words(words: &[u32]) -> Self {
                let (rows, _) = words.as_chunks();
                let rows = rows.first_chunk().expect("as many words as the record has");
                Self::from_rows($crate::record::Plain, *rows)
            }
        }
    };
}
pub(crate) use record;
