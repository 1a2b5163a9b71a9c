//! The progressive renderer.
use super::book::Book;
use super::by_proof::BLOCK;
use super::crew::{Clock, Crew, std_clock};
use super::given::{Given, Traced};
use super::spare::Spare;
use super::state::{self, StateError, Stopped};
use super::task::Task;
use super::window::Window;
use super::{Error, Frame, Method, RenderSpec, RunSpec, Stats};
use crate::grid::Grid;
use crate::scene::Scene;
use serde::{Deserialize, Serialize};
use std::io::{Read, Seek, Write};
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Draws one scene. Ask it to [`refine`](Self::refine) until it is done; look at [`frame`](Self::frame) and
/// [`stats`](Self::stats) whenever you like. The finished frame is the same, bit for bit, for any number of threads and any
/// budgets, and whether it was drawn at one go or saved and resumed. After a panic in a user's own function it is spent.
pub struct Renderer {
    pub(super) task: Task,
    pub(super) spec: RenderSpec,
    /// Whether hits are on parts of unions. Once they are, they are so for every method.
    divided: bool,
    pub(super) crew: Crew,
    pub(super) clock: Clock,
    pub(super) grids: Vec<Grid>,
    pub(super) book: Book,
    pub(super) given: Option<Given>,
    pub(super) traced: Option<Traced>,
    pub(super) stage: Stage,
    pub(super) part: Part,
    pub(super) next_tile: usize,
    pub(super) stop: Arc<AtomicBool>,
    pub(super) spare: Spare,
    /// Hits get their colours with their light only.
    pub(super) late_colors: bool,
}

/// What a renderer is about to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Stage {
    Grid,
    Primary,
    Shadow,
    Edges,
    /// All that is held is finished.
    Done,
    /// The part is done, and the others are awaited.
    Parted,
}

/// Which tiles are drawn: every `of`-th, beginning with the one that comes as number `number`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Part {
    pub(super) number: usize,
    pub(super) of: usize,
}

impl Part {
    pub(super) const WHOLE: Self = Self { number: 0, of: 1 };
}

impl Renderer {
    /// A renderer that has not begun.
    ///
    /// # Errors
    /// A spec out of range, no memory, no threads.
    pub fn new(scene: Arc<Scene>, spec: RenderSpec, run: RunSpec) -> Result<Self, Error> {
        let rows = spec.height;
        Self::in_bands(scene, spec, run, rows)
    }

    /// A renderer that holds a band of at least that many rows at a time, so that memory is bounded whatever the size of the picture: when
    /// [`refine`](Self::refine) has finished a band, take its rows ([`finished_rows`](Self::finished_rows)) and go on to the
    /// [`next_band`](Self::next_band). All rows are those of a picture that is drawn at one go, bit for bit, and in the end so are the
    /// statistics. Up to 64 rows are held beside those of the band.
    ///
    /// # Errors
    /// As for [`Renderer::new`].
    pub fn in_bands(scene: Arc<Scene>, spec: RenderSpec, run: RunSpec, rows: usize) -> Result<Self, Error> {
        let divided = spec.unions && spec.method == Method::Certified;
        Self::begin(scene, spec, run, rows, divided)
    }

    fn begin(scene: Arc<Scene>, spec: RenderSpec, run: RunSpec, rows: usize, divided: bool) -> Result<Self, Error> {
        spec.validate()?;
        let window = Window::first(spec.height, rows);
        let frame = Frame::new(spec.width, window.held().len(), scene.lights.len())?;
        let crew = run.crew()?;
        let task = Task::new(scene, &spec, window, divided)?;
        let book = Book::new(frame, &spec, crew.size());
        let (stage, stop) = (Stage::Grid, Arc::default());
        let spare = Spare::default();
        let (grids, clock, part) = (Vec::new(), std_clock, Part::WHOLE);
        let (given, traced) = (None, None);
        Ok(Self {
            task,
            spec,
            divided,
            crew,
            clock,
            grids,
            book,
            given,
            traced,
            stage,
            part,
            next_tile: 0,
            stop,
            spare,
            late_colors: false,
        })
    }

    /// Writes everything that is known, so that [`Renderer::resume`] can go on with it: some 50 to 300 bytes for each
    /// pixel that was looked at, and a checksum. To be called between two calls of [`refine`](Self::refine).
    ///
    /// # Errors
    /// Those of `out`.
    pub fn save(&self, out: &mut dyn Write) -> Result<(), StateError> {
        let (task, book) = (&self.task, &self.book);
        let window = task.window.clone();
        let divided = self.divided;
        let how_far = Stopped { stage: self.stage, part: self.part, tiles: self.next_tile, window, divided, book };
        state::write(&task.scene, &self.spec, &how_far, out)
    }

    /// A renderer that goes on where the saved one was. Frame and statistics will be those of a render at one go, bit for
    /// bit, but for the threads (those of `run`) and the times (those of both are added up).
    ///
    /// The checksum finds accidents, not forgery: proofs in a state are believed.
    ///
    /// # Errors
    /// Those of [`Renderer::new`]; [`StateError`] for a state that is not whole, or is not that of the same scene, spec and
    /// program.
    pub fn resume(
        scene: Arc<Scene>,
        spec: RenderSpec,
        run: RunSpec,
        input: &mut (impl Read + Seek),
    ) -> Result<Self, StateError> {
        spec.validate()?;
        let Stopped { stage, part, tiles, window, divided, book } = state::read(&scene, &spec, input)?;
        // It has planes of its own.
        let mut renderer = Self::begin(scene, spec, run, 1, divided)?;
        let threads = renderer.crew.size();
        (renderer.part, renderer.stage, renderer.task.window) = (part, stage, window);
        let holds = book.holds(renderer.task.objects.len());
        if part.number >= part.of || tiles > renderer.turns() || !holds {
            return Err(StateError::Damaged);
        }
        (renderer.next_tile, renderer.book) = (tiles, book);
        renderer.book.stats.threads = threads;
        if stage != Stage::Grid && matches!(renderer.task.method, Method::Paper(_)) {
            let begin = (renderer.clock)();
            renderer.build_grids();
            renderer.book.stats.grid_seconds += renderer.since(begin).as_secs_f64();
        }
        renderer.put_missing_colors();
        Ok(renderer)
    }

    /// Draws only part `number` of `of`, the tiles being dealt out in turn: to be called before it begins. When [`refine`](Self::refine)
    /// has done the part, it is to be saved for another renderer of the same picture to [`join`](Self::join), or to join the others.
    /// Panics unless `number < of`, where it has begun, and where it draws in bands.
    pub fn take_part(&mut self, number: usize, of: usize) {
        let whole = self.task.window.is_whole();
        assert!(
            number < of && self.stage == Stage::Grid && whole,
            "part {number} of {of} of a whole picture, before it begins"
        );
        self.part = Part { number, of };
    }

    /// Takes over a part that another renderer has done and saved. When all parts are there, [`refine`](Self::refine) does the rest;
    /// frame and counters are then those of one renderer that did all, bit for bit (times are those of the slowest part).
    ///
    /// # Errors
    /// Those of [`Renderer::resume`]; [`StateError::Part`] where this part or that one is not done, or tiles are there already.
    pub fn join(&mut self, input: &mut (impl Read + Seek)) -> Result<(), StateError> {
        let Stopped { stage, window, divided, book, .. } = state::read(&self.task.scene, &self.spec, input)?;
        if !book.holds(self.task.objects.len()) {
            return Err(StateError::Damaged);
        }
        let same = window.is_whole() && divided == self.divided;
        if [self.stage, stage] != [Stage::Parted; 2] || !same || !self.book.join(book) {
            return Err(StateError::Part);
        }
        if self.book.is_whole() {
            (self.stage, self.part, self.next_tile) = (Stage::Edges, Part::WHOLE, 0);
        }
        Ok(())
    }

    /// Set it, from any thread, and [`refine`](Self::refine) returns as soon as the tiles under way are done; nothing else
    /// changes. While it is set, `refine` gets little or nothing done.
    #[must_use]
    pub fn stop_flag(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.stop)
    }

    /// Measures budgets and times by another clock than that of std.
    pub fn set_clock(&mut self, clock: Clock) {
        self.clock = clock;
    }

    /// The time since a moment of the clock.
    fn since(&self, begin: Duration) -> Duration {
        (self.clock)().saturating_sub(begin)
    }

    /// The scene that is drawn.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.task.scene
    }

    /// Finds the shadows again with another method, for the hits that have been found. What the hits cost stays in the
    /// statistics; everything about shadows begins anew. A grid is built if the method needs one. Panics where it draws in bands.
    pub fn restart_shadows(&mut self, method: Method) {
        assert!(self.task.window.is_whole(), "shadows of a whole picture");
        (self.task.method, self.spec.method, self.traced) = (method, method, None);
        self.book.restart_shadows(method);
        self.next_tile = 0;
        if self.stage != Stage::Grid {
            self.stage = if self.stage == Stage::Primary { Stage::Primary } else { Stage::Shadow };
            if matches!(method, Method::Paper(_)) && self.grids.is_empty() {
                self.build_grids();
            }
        }
    }

    /// Works for about `budget` (at least one step) and tells whether the picture, or the part of it that was taken, is finished.
    pub fn refine(&mut self, budget: Duration) -> bool {
        let begin = (self.clock)();
        while !self.rests() {
            let step = (self.clock)();
            let stage = self.stage;
            self.step(begin.saturating_add(budget));
            let seconds = self.since(step).as_secs_f64();
            let stats = &mut self.book.stats;
            match stage {
                Stage::Grid => stats.grid_seconds += seconds,
                Stage::Primary => stats.primary_seconds += seconds,
                Stage::Shadow => stats.shadow_seconds += seconds,
                Stage::Edges | Stage::Done | Stage::Parted => stats.shading_seconds += seconds,
            }
            if self.since(begin) >= budget || self.stop.load(Ordering::Relaxed) {
                break;
            }
        }
        self.rests()
    }

    /// Nothing is left to do, here.
    fn rests(&self) -> bool {
        matches!(self.stage, Stage::Done | Stage::Parted)
    }

    /// The picture as far as it is known.
    #[must_use]
    pub fn frame(&self) -> &Frame {
        &self.book.frame
    }

    /// Counters and times so far.
    #[must_use]
    pub fn stats(&self) -> Stats {
        self.book.stats.totalled()
    }

    /// Share of the tiles of this stage that are done.
    pub(super) fn share(&self) -> f64 {
        self.next_tile as f64 / self.turns().max(1) as f64
    }

    pub(super) fn tiles(&self) -> usize {
        let rows = self.rows();
        self.task.film.width.div_ceil(BLOCK) * (rows.end.div_ceil(BLOCK) - rows.start / BLOCK)
    }

    /// Rows that this stage works on; they begin at the border of a tile.
    pub(super) fn rows(&self) -> Range<usize> {
        if self.stage == Stage::Edges { self.task.window.finished() } else { self.task.window.fresh() }
    }

    /// Tiles of the part that is drawn here.
    pub(super) fn turns(&self) -> usize {
        self.tiles().saturating_sub(self.part.number).div_ceil(self.part.of)
    }
}
