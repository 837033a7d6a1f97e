//! A rectangle of pixels.

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct TileRect {
    /// Leftmost column.
    pub x: u32,
    /// Topmost row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl TileRect {
    /// Square tiles of `side` pixels that cover an image of this size, row by row from the top; less at the right and bottom edges.
    pub fn tiles([width, height]: [u32; 2], side: u32) -> impl Iterator<Item = Self> {
        let starts = move |length: u32| (0..length).step_by(side as usize);
        let tile = move |x: u32, y: u32| Self {
            x,
            y,
            width: side.min(width - x),
            height: side.min(height - y),
        };
        starts(height).flat_map(move |y| starts(width).map(move |x| tile(x, y)))
    }

    /// How many pixels it has.
    pub fn area(&self) -> usize {
        self.width as usize * self.height as usize
    }
}
