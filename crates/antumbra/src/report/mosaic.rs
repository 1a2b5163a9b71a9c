//! Pictures beside each other.
use super::{Error, Picture};
use crate::image::{COLOR_PLANE, Plane, Planes};
use crate::render::Frame;

/// Linear colours, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tile {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) rgb: Vec<[f32; 3]>,
}

impl Tile {
    /// The colours of a frame.
    pub(super) fn of(frame: &Frame) -> Self {
        Self { width: frame.width, height: frame.height, rgb: frame.rgb.clone() }
    }

    /// As a picture of a report.
    pub(super) fn picture(self, name: impl Into<String>, caption: impl Into<String>) -> Result<Picture, Error> {
        Ok(Picture { name: name.into(), caption: caption.into(), planes: self.planes()? })
    }

    fn planes(self) -> Result<Planes, Error> {
        let mut planes = Planes::new();
        let samples = self.rgb.into_iter().flatten().collect::<Vec<f32>>();
        planes.add(Plane::with_channels(COLOR_PLANE, self.height, self.width, 3, samples)?)?;
        Ok(planes)
    }
}

/// A contact sheet: frames of one size, in the order in which they come.
#[derive(Clone, Debug, Default)]
pub struct Sheet {
    tiles: Vec<Tile>,
}

impl Sheet {
    /// Puts a frame behind the others; its colours are kept, the rest is not. All frames have the size of the first.
    pub fn add(&mut self, frame: &Frame) {
        self.tiles.push(Tile::of(frame));
    }

    /// The sheet as planes: rows of `columns` frames.
    ///
    /// # Errors
    /// Where the planes are too large.
    pub fn planes(&self, columns: usize) -> Result<Planes, Error> {
        mosaic(columns, &self.tiles).planes()
    }
}

/// Tiles of one size in rows of `columns`, white gaps between them; places without a tile are white.
pub(super) fn mosaic(columns: usize, tiles: &[Tile]) -> Tile {
    let Some(first) = tiles.first() else { return Tile { width: 0, height: 0, rgb: vec![] } };
    let (w, h) = (first.width, first.height);
    let gap = w.max(h) / 64 + 1;
    let columns = columns.clamp(1, tiles.len());
    let rows = tiles.len().div_ceil(columns);
    let (width, height) = (columns * (w + gap) - gap, rows * (h + gap) - gap);
    let mut rgb = vec![[1.0; 3]; width * height];
    for (k, tile) in tiles.iter().enumerate() {
        let (left, top) = (k % columns * (w + gap), k / columns * (h + gap));
        for (row, line) in tile.rgb.chunks(w).enumerate() {
            let start = (top + row) * width + left;
            rgb[start..start + w].copy_from_slice(line);
        }
    }
    Tile { width, height, rgb }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_lie_where_they_should() {
        let tile = |value: f32| Tile { width: 2, height: 1, rgb: vec![[value; 3]; 2] };
        let made = mosaic(2, &[tile(0.1), tile(0.2), tile(0.3)]);
        assert_eq!((made.width, made.height), (5, 3));
        let row = |k: usize| made.rgb[5 * k..5 * k + 5].iter().map(|c| c[0]).collect::<Vec<_>>();
        assert_eq!(row(0), [0.1, 0.1, 1.0, 0.2, 0.2]);
        assert_eq!(row(1), [1.0; 5]);
        assert_eq!(row(2), [0.3, 0.3, 1.0, 1.0, 1.0]);
    }
}
