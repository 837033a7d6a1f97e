//! What the fields of a record are: numbers of a domain, plain ones, or offsets.

use crate::domain::Domain;

/// The numbers that a record is made of: a domain's, or plain ones.
pub trait Numbers: Copy {
    /// Real numbers.
    type F: Copy;
    /// 32-bit words.
    type U: Copy;
    /// The real number whose bits a word has.
    fn real(self, word: Self::U) -> Self::F;
}

impl<D: Domain> Numbers for D {
    type F = D::F;
    type U = D::U;
    #[inline(always)]
    fn real(self, word: D::U) -> D::F {
        self.from_bits(word)
    }
}

/// Plain numbers, `f32` and `u32`: records outside formulas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plain;

impl Numbers for Plain {
    type F = f32;
    type U = u32;
    #[inline(always)]
    fn real(self, word: u32) -> f32 {
        f32::from_bits(word)
    }
}

/// In place of its value, a field has the word of the record at which it lies: for formulas that read one field alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offsets;

impl Numbers for Offsets {
    type F = u32;
    type U = u32;
    #[inline(always)]
    fn real(self, word: u32) -> u32 {
        word
    }
}
