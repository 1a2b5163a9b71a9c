//! Pictures that are larger than memory, band by band.
use super::renderer::{Renderer, Stage};
use super::{Frame, LightPlanes};
use std::ops::Range;

impl Renderer {
    /// Rows of the picture that [`refine`](Self::refine) has finished since the band before, once it has finished a band, and
    /// their planes.
    #[must_use]
    pub fn finished_rows(&self) -> Option<(Range<usize>, Frame)> {
        let window = &self.task.window;
        let (rows, first) = (window.finished(), window.held().start);
        let frame = || self.book.frame.rows(rows.start - first..rows.end - first);
        (self.stage == Stage::Done).then(|| (rows.clone(), frame()))
    }

    /// Rows of the picture that are finished and no more held: those of the bands before.
    #[must_use]
    pub fn rows_before(&self) -> usize {
        self.task.window.finished().start
    }

    /// Whether all of the picture is held.
    #[must_use]
    pub fn holds_all(&self) -> bool {
        self.task.window.is_whole()
    }

    /// Forgets what is finished and turns to the band below; tells whether there is one. To be called when [`refine`](Self::refine) has
    /// finished a band.
    pub fn next_band(&mut self) -> bool {
        let below = self.task.window.next().filter(|_| self.stage == Stage::Done);
        let Some(window) = below else { return false };
        let forget = (window.held().start - self.task.window.held().start) * self.task.film.width;
        self.book.slide(forget, window.held().len() * self.task.film.width);
        self.task.window = window;
        // Grids are those of the picture.
        (self.stage, self.next_tile) = (Stage::Primary, 0);
        true
    }

    /// Bytes that the pixels of a picture take while it is drawn, were all of them hits: the planes, the cost, the place of a hit, and a hit. Beside it
    /// come up to 1.1 kB for each pixel that an edge crosses, and what is proportional to formulas and threads.
    #[must_use]
    pub fn bytes(width: usize, rows: usize, lights: usize) -> u64 {
        let hit = super::hits::Hits::BYTES_PER_PIXEL + size_of::<u32>();
        (width as u64).saturating_mul(rows as u64).saturating_mul((Frame::bytes_per_pixel(lights) + hit) as u64)
    }
}

impl Frame {
    /// Bytes of all planes under that many lights, per pixel.
    pub(super) fn bytes_per_pixel(lights: usize) -> usize {
        let colors = 2 * size_of::<[f32; 3]>();
        let bounds = 4 * size_of::<f64>();
        size_of::<u8>() + size_of::<u32>() + colors + bounds + lights * LightPlanes::BYTES_PER_PIXEL
    }
}

impl LightPlanes {
    const BYTES_PER_PIXEL: usize = 2 * size_of::<f64>() + size_of::<f32>() + size_of::<bool>();
}
