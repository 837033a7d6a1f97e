//! A reader that knows the line it is at, so that another crate's error has a place.

use std::cell::Cell;
use std::io::{self, BufRead, Read};

/// Hands text out one line at a time, and counts.
pub(super) struct CountingLines<'a> {
    rest: &'a [u8],
    count: &'a Cell<usize>,
}

impl<'a> CountingLines<'a> {
    /// `count` is the number of lines handed out.
    pub(super) fn new(text: &'a str, count: &'a Cell<usize>) -> Self {
        Self {
            rest: text.as_bytes(),
            count,
        }
    }
}

impl Read for CountingLines<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.fill_buf()?.read(buffer)?;
        self.consume(read);
        Ok(read)
    }
}

impl BufRead for CountingLines<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        let end = self
            .rest
            .iter()
            .position(|&byte| byte == b'\n')
            .map_or(self.rest.len(), |at| at + 1);
        Ok(&self.rest[..end])
    }

    fn consume(&mut self, amount: usize) {
        if amount > 0 && self.rest.get(amount - 1) == Some(&b'\n') {
            self.count.set(self.count.get() + 1);
        }
        self.rest = &self.rest[amount..];
    }
}
