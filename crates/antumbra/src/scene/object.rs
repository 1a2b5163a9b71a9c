//! A surface of a scene.
use super::{Coloring, Finish, form};
use crate::eval::Inclusion;
use crate::expr::{self, Formula, Writing};
use crate::geom::Clip;
use crate::tape::{Tape, TapeError};
use std::sync::Arc;

/// Colours of the two sides of a surface, linear Rec. 709.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Colors {
    /// Of the side on which f > 0.
    pub outside: [f64; 3],
    /// Of the other side.
    pub inside: [f64; 3],
}

impl Default for Colors {
    /// Warm clay outside, slate blue inside.
    fn default() -> Self {
        Self { outside: [0.80, 0.43, 0.20], inside: [0.16, 0.36, 0.50] }
    }
}

/// One surface `{f = 0}` inside its clip box.
#[derive(Clone)]
pub struct Object {
    /// The formula as written.
    pub text: String,
    /// Its zero set's function, rewritten so that it changes sign where it can.
    pub surface: Arc<dyn Inclusion>,
    /// Colours of its sides.
    pub colors: Colors,
    /// How it throws back light.
    pub finish: Finish,
    /// What decides its colour.
    pub coloring: Coloring,
    // Together, so that no clip is ever paired with the region of another.
    clip: Clip,
    region: Clip,
    source: Source,
}

/// From what the surface was compiled.
#[derive(Clone)]
struct Source {
    formula: Arc<Formula>,
    written: Arc<dyn Inclusion>,
    /// The form in which it is drawn.
    chosen: Arc<dyn Inclusion>,
    writing: Writing,
}

impl std::fmt::Debug for Object {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut all = f.debug_struct("Object");
        all.field("text", &self.text).field("clip", &self.clip).field("writing", &self.writing());
        all.finish_non_exhaustive()
    }
}

/// Why a formula does not make an object.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The text is not a formula.
    #[error(transparent)]
    Formula(#[from] expr::Error),
    /// It is one, but cannot be compiled.
    #[error(transparent)]
    Tape(#[from] TapeError),
}

impl Object {
    /// Reads, rewrites and compiles a formula.
    ///
    /// # Errors
    /// See [`Error`].
    pub fn parse(text: &str, clip: Clip) -> Result<Self, Error> {
        Self::of(text.to_owned(), &Formula::parse(text)?, clip)
    }

    /// Rewrites and compiles a formula that was built as written. Its text is printed from it and stands for the same function.
    ///
    /// # Errors
    /// [`Error::Tape`]: nobody checks that the text is short enough to be read again.
    pub fn from_formula(written: &Formula, clip: Clip) -> Result<Self, Error> {
        Self::of(written.to_string(), &written.simplify(), clip)
    }

    fn of(text: String, simple: &Formula, clip: Clip) -> Result<Self, Error> {
        let formula = simple.surface().into_formula();
        let written: Arc<dyn Inclusion> = Arc::new(Tape::compile(&formula.repeated_squares())?);
        let surface = Arc::clone(&written);
        let (colors, finish, coloring) = Default::default();
        let source =
            Source { formula: Arc::new(formula), written, chosen: Arc::clone(&surface), writing: Writing::Written };
        Ok(Self { text, surface, colors, finish, coloring, clip, region: clip, source }.with_clip(clip))
    }

    /// The same surface in another clip. Searches for a proof that the clip cuts nothing away (a second at most), and for the form of
    /// the formula that is the least work there ([`writing`](Self::writing); some milliseconds).
    #[must_use]
    pub fn with_clip(mut self, clip: Clip) -> Self {
        self = self.as_written();
        self.region = super::framing::region(self.surface.as_ref(), &clip);
        self.clip = clip;
        if Arc::ptr_eq(&self.surface, &self.source.written)
            && let Some(written) = self.surface.as_tape()
            && let Some(form::Chosen { writing, tape }) = form::choose(&self.source.formula, written, &clip.bounds())
        {
            self.surface = Arc::new(tape);
            self.source.chosen = Arc::clone(&self.surface);
            self.source.writing = writing;
        }
        self
    }

    /// The surface exists only in here, and ends at its border.
    #[must_use]
    pub fn clip(&self) -> Clip {
        self.clip
    }

    /// Every zero of the function in here is inside the clip: larger than it if the clip cuts nothing away.
    #[must_use]
    pub fn region(&self) -> Clip {
        self.region
    }

    /// In which form its formula is drawn: the written one, or another of the same real function ([`Formula::forms`]) that was found to
    /// be less work in this clip.
    #[must_use]
    pub fn writing(&self) -> Writing {
        self.source.writing
    }

    /// The same surface, drawn in the form in which its formula is written. A function that was put in place of the compiled one
    /// stays.
    #[must_use]
    pub fn as_written(mut self) -> Self {
        if self.is_compiled() {
            self.surface = Arc::clone(&self.source.written);
        }
        self.source.chosen = Arc::clone(&self.source.written);
        self.source.writing = Writing::Written;
        self
    }

    /// The function by which a scene is framed: as written, so that the form in which it is drawn moves no camera.
    pub(super) fn framed(&self) -> &dyn Inclusion {
        if self.is_compiled() { self.source.written.as_ref() } else { self.surface.as_ref() }
    }

    /// Nobody has put another function in place of the one that was compiled.
    fn is_compiled(&self) -> bool {
        Arc::ptr_eq(&self.surface, &self.source.chosen)
    }
}
