//! What has been found of a picture elsewhere, on a GPU for instance: the passes take it as it is and do the rest.
use super::renderer::Stage;
use super::{Method, Renderer};
use crate::geom::{Film, Rect};
use crate::paper;
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

/// What one of the paper's methods found of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TracedPixel {
    /// The surface (index among [`Question::surfaces`]) that its beam may meet first, and the section of T in which it may. `None`
    /// proves that it meets none.
    pub find: Option<(usize, Interval)>,
    /// Evaluations that it took.
    pub evaluations: u32,
}

/// What one of the paper's methods found between the hit of a pixel and a light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TracedLight {
    /// Whether an initial beam was traced and may be blocked.
    pub initial_occluded: bool,
    /// Sub-beams that may be blocked.
    pub blocked: u32,
    /// Initial beams and sub-beams that were traced.
    pub beams: [u32; 2],
    /// Evaluations that they took.
    pub evaluations: [u64; 2],
}

/// A picture by [`paper::Method::Initial`] or [`paper::Method::Fixed`], but for its colours. What it proves is believed.
#[derive(Clone, Debug, PartialEq)]
pub struct Traced {
    /// Evaluations that the grids took.
    pub grid_evaluations: u64,
    /// Row by row.
    pub pixels: Vec<TracedPixel>,
    /// Per light and pixel; of pixels without a find, anything.
    pub lights: Vec<Vec<TracedLight>>,
}

/// What a picture asks for.
pub struct Question<'a> {
    /// All surfaces, the floor as well: then it is the last.
    pub surfaces: Vec<Surface<'a>>,
    /// Whether there is a floor.
    pub floor: bool,
    /// The rays of the pixels.
    pub film: Film,
    /// The lights.
    pub lights: Vec<Rect>,
    /// How shadows are to be found.
    pub method: Method,
    /// Certified: width of a bracket of the visible fraction that is narrow enough.
    pub tolerance: f64,
    /// The constants of the paper's methods.
    pub settings: paper::Settings,
    /// Cells of their grids along each axis.
    pub cells: usize,
}

impl Renderer {
    /// What is to be found: for those who can find some of it faster.
    #[must_use]
    pub fn question(&self) -> Question<'_> {
        Question {
            surfaces: self.task.surfaces(),
            floor: self.task.has_floor,
            film: self.task.film,
            lights: self.task.lights.iter().map(|l| l.rect).collect(),
            method: self.task.method,
            tolerance: self.task.tolerance.width,
            settings: self.task.settings,
            cells: self.spec.grid,
        }
    }

    /// Whether it may have use for what others find: it has not begun, and draws no bands.
    #[must_use]
    pub fn takes(&self) -> bool {
        self.stage == Stage::Grid && self.task.window.is_whole()
    }

    /// Takes over what has been proved of the [`question`](Self::question); only the rest will be looked for. It is not part of what
    /// is saved. Tells whether it was of use: only the certified method has use for it, only where this
    /// [`takes`](Self::takes) anything, and only if it speaks of this picture.
    pub fn give(&mut self, given: Given) -> bool {
        let pixels = self.task.film.width * self.task.film.height;
        let wanted = self.takes() && self.task.method == Method::Certified;
        let useful = wanted && given.fits(pixels, self.task.lights.len());
        if useful {
            self.given = Some(given);
        }
        useful
    }

    /// Takes over what one of the paper's methods found of the [`question`](Self::question); what is left are points, normals and colours. It is
    /// not part of what is saved. Tells whether it was of use: only [`paper::Method::Initial`] and [`paper::Method::Fixed`] have use for
    /// it, without a floor, only where this [`takes`](Self::takes) anything, and only if it speaks of this picture.
    pub fn give_traced(&mut self, traced: Traced) -> bool {
        let Question { film, lights, method, floor, .. } = self.question();
        let useful = self.takes()
            && !floor
            && matches!(method, Method::Paper(paper::Method::Initial | paper::Method::Fixed))
            && traced.fits(film.width * film.height, lights.len(), self.task.objects.len());
        if useful {
            self.traced = Some(traced);
        }
        useful
    }
}

impl Traced {
    /// Whether it speaks of a picture of so many pixels, lights and surfaces.
    fn fits(&self, pixels: usize, lights: usize, surfaces: usize) -> bool {
        self.pixels.len() == pixels
            && self.lights.len() == lights
            && self.lights.iter().all(|l| l.len() == pixels)
            && self.pixels.iter().all(|p| p.find.is_none_or(|(object, _)| object < surfaces))
    }
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
