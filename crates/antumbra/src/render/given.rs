//! What has been proved of a picture elsewhere, on a GPU for instance: the passes take it as it is and do the rest.
use crate::geom::{Film, Rect};
use crate::trace::{Sign, Surface};
use antumbra_interval::Interval;

/// A pixel of which everything is proved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GivenPixel {
    /// No ray of it meets a surface.
    Empty,
    /// Every ray of it meets `surface`. What its centre ray meets first, it meets in `t`: a root of that surface's function.
    Hit {
        /// Index among [`Question::surfaces`].
        surface: usize,
        /// Where.
        t: Interval,
        /// The sign of the function just before.
        before: Sign,
    },
}

/// Proofs of a picture. Every one is believed.
#[derive(Clone, Debug, PartialEq)]
pub struct Given {
    /// Row by row; `None` where nothing is known.
    pub pixels: Vec<Option<GivenPixel>>,
    /// Per light and pixel: bounds of the visible fraction from the true hit of a [`GivenPixel::Hit`]; `[0, 1]` where nothing is known.
    pub lights: Vec<Vec<[f64; 2]>>,
}

/// What is to be proved of a picture by the certified method.
pub struct Question<'a> {
    /// All surfaces, the floor as well.
    pub surfaces: Vec<Surface<'a>>,
    /// The rays of the pixels.
    pub film: Film,
    /// The lights.
    pub lights: Vec<Rect>,
    /// Width of a bracket of the visible fraction that is narrow enough.
    pub tolerance: f64,
}

impl Given {
    /// Whether it speaks of a picture of so many pixels and lights.
    pub(super) fn fits(&self, pixels: usize, lights: usize) -> bool {
        self.pixels.len() == pixels && self.lights.len() == lights && self.lights.iter().all(|l| l.len() == pixels)
    }

    /// Bounds of what reaches a pixel of a light, where it is a given hit.
    pub(super) fn light(&self, light: usize, index: usize) -> Option<[f64; 2]> {
        matches!(self.pixels[index], Some(GivenPixel::Hit { .. })).then(|| self.lights[light][index])
    }
}
