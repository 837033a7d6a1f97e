//! Rows of four words, as records are read from them and written to them.

use super::numbers::Numbers;
use crate::math::Vec3;
use crate::math::vec3::vec3;

/// The words of a record in rows: 0, 1, 2, 3; 4, …
#[inline(always)]
pub(crate) fn words_of_rows<const ROWS: usize>() -> [[u32; 4]; ROWS] {
    std::array::from_fn(|row| [0, 1, 2, 3].map(|word| 4 * row as u32 + word))
}

/// Takes the fields of a record off its rows, one after the other.
pub(crate) struct RowReader<N: Numbers, const ROWS: usize> {
    numbers: N,
    rows: [[N::U; 4]; ROWS],
    next: usize,
}

impl<N: Numbers, const ROWS: usize> RowReader<N, ROWS> {
    #[inline(always)]
    pub(crate) fn new(numbers: N, rows: [[N::U; 4]; ROWS]) -> Self {
        Self {
            numbers,
            rows,
            next: 0,
        }
    }

    /// What was read last ends its row.
    #[inline(always)]
    pub(crate) fn end_row(&mut self) {
        self.next = self.next.next_multiple_of(4);
    }

    #[inline(always)]
    pub(crate) fn word(&mut self) -> N::U {
        let word = self.rows[self.next / 4][self.next % 4];
        self.next += 1;
        word
    }

    #[inline(always)]
    pub(crate) fn real(&mut self) -> N::F {
        let word = self.word();
        self.numbers.real(word)
    }

    #[inline(always)]
    pub(crate) fn vector(&mut self) -> Vec3<N::F> {
        let [x, y, z] = [self.real(), self.real(), self.real()];
        vec3(x, y, z)
    }
}

/// Puts the fields of a record into words, one after the other.
pub(crate) struct RowWriter<'a> {
    words: &'a mut [u32],
    next: usize,
}

impl<'a> RowWriter<'a> {
    pub(crate) fn new(words: &'a mut [u32]) -> Self {
        words.fill(0);
        Self { words, next: 0 }
    }

    /// What was written last ends its row.
    pub(crate) fn end_row(&mut self) {
        self.next = self.next.next_multiple_of(4);
    }

    pub(crate) fn word(&mut self, value: u32) {
        self.words[self.next] = value;
        self.next += 1;
    }

    pub(crate) fn real(&mut self, value: f32) {
        self.word(value.to_bits());
    }

    pub(crate) fn vector(&mut self, value: Vec3<f32>) {
        for component in value.to_array() {
            self.real(component);
        }
    }
}

/// A row whose fields have these numbers of words; too many are an error of compilation.
pub(crate) const fn row(fields: &[usize]) {
    let (mut words, mut k) = (0, 0);
    while k < fields.len() {
        words += fields[k];
        k += 1;
    }
    assert!(words <= 4, "a row has four words");
}
