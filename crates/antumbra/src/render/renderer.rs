//! The progressive renderer.
use super::book::Book;
use super::by_paper;
use super::by_proof::{self, BLOCK};
use super::task::Task;
use super::{Error, Frame, Method, RenderSpec, RunSpec, Stats};
use crate::grid::Grid;
use crate::scene::Scene;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Draws one scene. Ask it to [`refine`](Self::refine) until it is done; look at [`frame`](Self::frame) and
/// [`stats`](Self::stats) whenever you like. The frame is the same, bit for bit, for any number of threads and any
/// budgets.
pub struct Renderer {
    task: Task,
    grid_cells: usize,
    pool: rayon::ThreadPool,
    grids: Vec<Grid>,
    book: Book,
    stage: Stage,
    next_tile: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    Grid,
    Primary,
    Shadow,
    Edges,
    Done,
}

impl Renderer {
    /// A renderer that has not begun.
    ///
    /// # Errors
    /// A spec out of range, no memory, no threads.
    pub fn new(scene: Arc<Scene>, spec: RenderSpec, run: RunSpec) -> Result<Self, Error> {
        spec.validate()?;
        let frame = Frame::new(spec.width, spec.height, scene.lights.len())?;
        let pool = run.pool()?;
        let task = Task::new(scene, &spec)?;
        let book = Book::new(frame, spec.method, pool.current_num_threads());
        let stage = Stage::Grid;
        Ok(Self { task, grid_cells: spec.grid, pool, grids: Vec::new(), book, stage, next_tile: 0 })
    }

    /// Finds the shadows again with another method, for the hits that have been found. What the hits cost stays in the
    /// statistics; everything about shadows begins anew. A grid is built if the method needs one.
    pub fn restart_shadows(&mut self, method: Method) {
        self.task.method = method;
        self.book.restart_shadows(method);
        self.next_tile = 0;
        if self.stage != Stage::Grid {
            self.stage = if self.stage == Stage::Primary { Stage::Primary } else { Stage::Shadow };
            if matches!(method, Method::Paper(_)) && self.grids.is_empty() {
                self.build_grids();
            }
        }
    }

    /// Works for about `budget` (at least one step) and tells whether the picture is finished.
    pub fn refine(&mut self, budget: Duration) -> bool {
        let begin = Instant::now();
        while self.stage != Stage::Done {
            let step = Instant::now();
            let stage = self.stage;
            self.step();
            let seconds = step.elapsed().as_secs_f64();
            let stats = &mut self.book.stats;
            match stage {
                Stage::Grid => stats.grid_seconds += seconds,
                Stage::Primary => stats.primary_seconds += seconds,
                Stage::Shadow => stats.shadow_seconds += seconds,
                Stage::Edges | Stage::Done => stats.shading_seconds += seconds,
            }
            if begin.elapsed() >= budget {
                break;
            }
        }
        self.stage == Stage::Done
    }

    /// Share of the work that is done, 0 to 1, roughly: tiles, the shadows counted three times.
    #[must_use]
    pub fn progress(&self) -> f64 {
        let share = self.next_tile as f64 / self.tiles() as f64;
        match self.stage {
            Stage::Grid => 0.0,
            Stage::Primary => 0.25 * share,
            Stage::Shadow => 0.25 + 0.75 * share,
            Stage::Edges | Stage::Done => 1.0,
        }
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

    fn tiles(&self) -> usize {
        self.task.film.width.div_ceil(BLOCK) * self.task.film.height.div_ceil(BLOCK)
    }

    /// Left column and top row of a tile.
    fn corner(&self, tile: usize) -> (usize, usize) {
        let across = self.task.film.width.div_ceil(BLOCK);
        (tile % across * BLOCK, tile / across * BLOCK)
    }

    /// Pixels of a tile as indices of the planes.
    fn pixels(&self, tile: usize) -> impl Iterator<Item = usize> + use<> {
        let (width, height) = (self.task.film.width, self.task.film.height);
        let (left, top) = self.corner(tile);
        let (right, bottom) = ((left + BLOCK).min(width), (top + BLOCK).min(height));
        (top..bottom).flat_map(move |row| (left..right).map(move |column| row * width + column))
    }

    fn build_grids(&mut self) {
        let (task, n) = (&self.task, self.grid_cells);
        self.grids = self.pool.install(|| by_paper::grids(task, n));
        self.book.stats.grid_evaluations = self.grids.iter().map(Grid::evaluations).sum();
    }

    /// One tile per thread: so cancelling is quick. Threads wait for the slowest of a batch; batches are cheap tiles or
    /// few.
    fn step(&mut self) {
        match self.stage {
            Stage::Grid => {
                if matches!(self.task.method, Method::Paper(_)) {
                    self.build_grids();
                }
                self.stage = Stage::Primary;
                return;
            }
            Stage::Edges | Stage::Done => {
                self.book.shade_edges(&self.task);
                self.stage = Stage::Done;
                return;
            }
            Stage::Primary | Stage::Shadow => {}
        }
        let end = (self.next_tile + 4 * self.pool.current_num_threads()).min(self.tiles());
        if self.stage == Stage::Primary {
            self.primary(self.next_tile..end);
        } else {
            self.shadows(self.next_tile..end);
        }
        self.next_tile = end;
        if end == self.tiles() {
            self.next_tile = 0;
            self.stage = if self.stage == Stage::Primary { Stage::Shadow } else { Stage::Edges };
        }
    }

    fn primary(&mut self, batch: Range<usize>) {
        let this = &*self;
        let found: Vec<Vec<_>> = self.pool.install(|| {
            batch
                .into_par_iter()
                .map(|tile| match this.task.method {
                    Method::Certified => {
                        let (column, row) = this.corner(tile);
                        by_proof::primary(&this.task, column, row)
                    }
                    Method::Paper(_) => {
                        let rays = this.task.method.uses_rays();
                        by_paper::primary(&this.task, &this.grids, this.pixels(tile), rays)
                    }
                })
                .collect()
        });
        found.into_iter().flatten().for_each(|pixel| self.book.put_pixel(&self.task, pixel));
    }

    fn shadows(&mut self, batch: Range<usize>) {
        let this = &*self;
        let found: Vec<Vec<_>> = self.pool.install(|| {
            batch
                .into_par_iter()
                .map(|tile| match this.task.method {
                    Method::Certified => {
                        let (column, row) = this.corner(tile);
                        let receiver = |index| this.book.hit(index).and_then(|h| h.receiver.as_ref());
                        by_proof::shadows(&this.task, column, row, &receiver)
                    }
                    Method::Paper(method) => {
                        let hits = this.pixels(tile).filter_map(|index| Some((index, this.book.hit(index)?.point)));
                        by_paper::shadows(&this.task, &this.grids, method, hits)
                    }
                })
                .collect()
        });
        found.into_iter().flatten().for_each(|light| self.book.put_light(&self.task, &light));
    }
}
