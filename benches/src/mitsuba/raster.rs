//! Numbers on a grid, and the files that have them.

use std::path::Path;

use anyhow::{Context, Result};
use residual_frontend::pictures::{Picture, write};

/// Numbers on a grid, linear, row by row from the top of the file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Raster {
    size: [u32; 2],
    channels: Vec<(&'static str, Vec<f32>)>,
}

impl Raster {
    /// The colours at columns and rows.
    pub(super) fn of_colors(size: [u32; 2], color: impl Fn(u32, u32) -> [f32; 3]) -> Self {
        let colors: Vec<_> = places(size).map(|[x, y]| color(x, y)).collect();
        let channel = |k: usize| colors.iter().map(|color| color[k]).collect();
        Self {
            size,
            channels: vec![("R", channel(0)), ("G", channel(1)), ("B", channel(2))],
        }
    }

    /// The numbers at columns and rows.
    pub(super) fn of_numbers(size: [u32; 2], number: impl Fn(u32, u32) -> f32) -> Self {
        let numbers = places(size).map(|[x, y]| number(x, y)).collect();
        Self {
            size,
            channels: vec![("Y", numbers)],
        }
    }

    fn write(self, path: &Path) -> Result<()> {
        let picture = Picture {
            size: self.size.map(|length| length as usize),
            colors: Vec::new(),
            channels: self.channels,
            comment: None,
        };
        write(path, &picture).with_context(|| path.display().to_string())
    }
}

fn places([width, height]: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]))
}

/// The images of an exported scene, each once.
#[derive(Debug, Default)]
pub(super) struct Rasters(Vec<Raster>);

impl Rasters {
    /// The name of the file that has these numbers.
    pub(super) fn file(&mut self, raster: Raster) -> String {
        let known = self.0.iter().position(|known| *known == raster);
        let index = known.unwrap_or_else(|| {
            self.0.push(raster);
            self.0.len() - 1
        });
        format!("{index}.exr")
    }

    /// Writes the files.
    pub(super) fn write(self, folder: &Path) -> Result<()> {
        let mut rasters = self.0.into_iter().enumerate();
        rasters.try_for_each(|(index, raster)| raster.write(&folder.join(format!("{index}.exr"))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_have_the_numbers_and_equal_images_share_one() {
        let mut rasters = Rasters::default();
        let color = |x: u32, y: u32| [x as f32, y as f32, 0.1];
        assert_eq!(rasters.file(Raster::of_colors([3, 2], color)), "0.exr");
        let number = |x: u32, y: u32| (x + 10 * y) as f32;
        assert_eq!(rasters.file(Raster::of_numbers([3, 2], number)), "1.exr");
        assert_eq!(rasters.file(Raster::of_colors([3, 2], color)), "0.exr");
        let folder = tempfile::tempdir().unwrap();
        rasters.write(folder.path()).unwrap();
        let read = |file: &str| residual_frontend::input::read(&folder.path().join(file)).unwrap();
        let colors = read("0.exr");
        assert_eq!(colors.size, [3, 2]);
        assert_eq!(colors.pixels[4], [1.0, 1.0, 0.1]);
        assert!(!folder.path().join("2.exr").exists());
    }
}
