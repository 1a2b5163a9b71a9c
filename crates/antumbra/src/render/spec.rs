//! What to draw and how to run.
use crate::image::{SizeError, check_size};
use crate::paper;
use crate::shadow::Penumbra;
use crate::trace::Bisection;

/// How shadows are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// Everything proved or counted: brackets of the visible fraction, without an offset.
    Certified,
    /// One of the paper's, on the hits of its beam casting.
    Paper(paper::Method),
}

impl Method {
    /// Every method with the name it has on the command line, and what it is.
    pub const ALL: [(Self, &'static str, &'static str); 7] = [
        (Self::Certified, "certified", "proved hits, light fractions as proved brackets"),
        (
            Self::Paper(paper::Method::Initial),
            "paper",
            "one initial shadow beam, n x n sub-beams where it may be blocked",
        ),
        (Self::Paper(paper::Method::Fixed), "fixed49", "always n x n sub-beams (the paper's baseline)"),
        (Self::Paper(paper::Method::Quadtree), "paper-quadtree", "the light divided as a quadtree"),
        (Self::Paper(paper::Method::Four), "paper-4", "four initial beams, for big lights"),
        (Self::Paper(paper::Method::RegularRays), "rays", "one ray per pixel, n x n shadow rays (classical)"),
        (Self::Paper(paper::Method::RandomRays), "rays-mc", "one ray per pixel, n x n random shadow rays"),
    ];

    /// The method of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|(_, n, _)| *n == name).map(|(method, ..)| method)
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::ALL.into_iter().find(|(m, ..)| *m == self).map_or("", |(_, name, _)| name)
    }

    /// Whether pixels and shadows are sampled by rays.
    #[must_use]
    pub fn uses_rays(self) -> bool {
        matches!(self, Self::Paper(paper::Method::RegularRays | paper::Method::RandomRays))
    }
}

/// What to draw.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderSpec {
    /// Pixels per row, 1 to 65,536.
    pub width: usize,
    /// Rows, 1 to 65,536.
    pub height: usize,
    /// How shadows are found.
    pub method: Method,
    /// Factor on the edges of the light.
    pub light_scale: f64,
    /// Whether the floor is there.
    pub floor: bool,
    /// Cells of the paper's grid along each axis, 1 to 512.
    pub grid: usize,
    /// Sub-beams along each side of the light, 1 to 256.
    pub sub_beams: usize,
    /// Distance at which shadow beams start, in units of the scene; by default [`RenderSpec::OFFSET`] of its scale.
    pub offset: Option<f64>,
    /// Where the bisection of T ends.
    pub bisection: Bisection,
    /// Seed of the random rays.
    pub seed: u64,
    /// Certified: width of a bracket of the visible fraction that is narrow enough.
    pub tolerance: f64,
    /// Certified: rectangles of the light that one hit may take.
    pub rectangles: u32,
    /// Certified: how penumbrae are resolved.
    pub penumbra: Penumbra,
    /// Whether long formulas are shortened region by region ([`crate::eval::Regions`]). All claims hold with and without; the
    /// bits may differ.
    pub regions: bool,
    /// Certified: whether unions are drawn as their parts, where that is proved to be the same. The bits may differ.
    pub unions: bool,
}

impl RenderSpec {
    /// Default offset, as a fraction of half the largest edge of the scene's clip box.
    pub const OFFSET: f64 = 0.01;
}

impl Default for RenderSpec {
    fn default() -> Self {
        Self {
            width: 512,
            height: 512,
            method: Method::ALL[0].0,
            light_scale: 1.0,
            floor: false,
            grid: 32,
            sub_beams: 7,
            offset: None,
            bisection: Bisection::default(),
            seed: 1,
            tolerance: 1.0 / 255.0,
            rectangles: 4000,
            penumbra: Penumbra::default(),
            regions: true,
            unions: true,
        }
    }
}

/// How to run; nothing here changes a single bit of the result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RunSpec {
    /// Threads; `None` takes all processors. Where a program cannot start threads itself (WebAssembly), they are those of rayon's
    /// global pool, whatever is said here: the caller alone, unless somebody has built that pool.
    pub threads: Option<usize>,
}

/// Why a picture cannot be begun.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A number of the spec is outside its range.
    #[error("{what} must be {range}, not {value}")]
    OutOfRange {
        /// Which number.
        what: &'static str,
        /// What it may be.
        range: &'static str,
        /// What it is.
        value: String,
    },
    /// Width and height are not those of a picture.
    #[error(transparent)]
    Size(#[from] SizeError),
    /// The threads could not be started.
    #[error("the threads could not be started: {0}")]
    Threads(String),
    /// The frame does not fit into memory.
    #[error("a picture of {width} x {height} pixels needs {bytes} bytes of memory, which could not be had")]
    Memory {
        /// Pixels per row.
        width: usize,
        /// Rows.
        height: usize,
        /// Bytes asked for.
        bytes: usize,
    },
}

impl RenderSpec {
    /// Checks every number against its range.
    ///
    /// # Errors
    /// The first number that is outside.
    pub fn validate(&self) -> Result<(), Error> {
        let bad = |what, range, value: String| Err(Error::OutOfRange { what, range, value });
        check_size([self.width, self.height])?;
        if !(1..=512).contains(&self.grid) {
            return bad("the grid", "1 to 512 cells", self.grid.to_string());
        }
        if !(1..=256).contains(&self.sub_beams) {
            return bad("the number of sub-beams", "1 to 256", self.sub_beams.to_string());
        }
        if !(self.light_scale > 0.0 && self.light_scale <= 1e6) {
            return bad("the light scale", "greater than 0 and at most 1e6", self.light_scale.to_string());
        }
        if let Some(offset) = self.offset
            && !(0.0..=1e300).contains(&offset)
        {
            return bad("the offset", "a finite distance of at least 0", offset.to_string());
        }
        if !(self.tolerance >= 1e-9 && self.tolerance <= 1.0) {
            return bad("the tolerance", "from 1e-9 to 1", self.tolerance.to_string());
        }
        if self.rectangles == 0 {
            return bad("the number of rectangles", "at least 1", self.rectangles.to_string());
        }
        if !(self.bisection.width > 0.0 && self.bisection.width.is_finite()) {
            return bad("the bisection width", "finite and greater than 0", self.bisection.width.to_string());
        }
        Ok(())
    }
}
