//! The passes over the tiles of a picture, and who does which tile.
use super::Method;
use super::by_paper;
use super::by_proof::{self, BLOCK, Block};
use super::coloring::{first_color, is_doubtful, lit_colors};
use super::crease;
use super::crew::{Clock, Crew};
use super::renderer::{Part, Renderer, Stage};
use super::spare::{Scratch, Spare};
use super::visibility;
use crate::eval::Occupancy;
use crate::grid::Grid;
use num_integer::Integer;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

impl Renderer {
    pub(super) fn build_grids(&mut self) {
        let (task, n) = (&self.task, self.spec.grid);
        self.grids = self.crew.install(|| by_paper::grids(task, n));
        self.book.stats.grid_evaluations = self.grids.iter().map(Grid::evaluations).sum();
    }

    /// One batch of tiles, or what comes between them. After the deadline no tile is begun but about one for each thread.
    pub(super) fn step(&mut self, deadline: Duration) {
        match self.stage {
            Stage::Grid => {
                match (self.task.method, &self.traced) {
                    (Method::Paper(_), None) => self.build_grids(),
                    (_, Some(traced)) => self.book.stats.grid_evaluations = traced.grid_evaluations,
                    (Method::Certified, None) => {}
                }
                self.stage = Stage::Primary;
                return;
            }
            Stage::Done | Stage::Parted => return,
            Stage::Primary | Stage::Shadow | Stage::Edges => {}
        }
        let batch = self.batch(deadline);
        self.next_tile += match self.stage {
            Stage::Primary => self.primary(&batch),
            Stage::Shadow => self.shadows(&batch),
            _ => self.creases(&batch),
        };
        if self.next_tile == self.turns() {
            self.next_tile = 0;
            self.stage = match self.stage {
                Stage::Primary => Stage::Shadow,
                // Edges look at the neighbours of pixels, which others draw.
                Stage::Shadow if self.part != Part::WHOLE => Stage::Parted,
                Stage::Shadow => Stage::Edges,
                _ => {
                    self.finish_colors(self.task.window.finished());
                    Stage::Done
                }
            };
        }
    }

    /// The tiles that are left of this stage.
    fn batch(&self, deadline: Duration) -> Batch {
        let (tiles, across) = (self.tiles(), self.task.film.width.div_ceil(BLOCK));
        // Some 0.618 n and without a common divisor with n: every tile has its turn. At most 2^22 tiles: no overflow.
        let stride = (tiles * 377 / 610..).find(|s| s.gcd(&tiles) == 1).unwrap_or(1);
        Batch {
            turns: self.next_tile..self.turns(),
            part: self.part,
            tiles,
            stride,
            across,
            top: self.rows().start,
            deadline,
            clock: self.clock,
            stop: Arc::clone(&self.stop),
        }
    }

    /// Finds the hits of tiles and tells how many of them are done: all, unless it is asked to stop.
    fn primary(&mut self, batch: &Batch) -> usize {
        let late = self.late_colors;
        let Self { task, book, crew, spare, given, traced, grids, .. } = self;
        let (task, given, traced, grids) = (&*task, given.as_ref(), traced.as_ref(), &*grids);
        let work = |block: Block, scratch: &mut Scratch| {
            let pixels = by_proof::indices(task, block);
            let (found, occupancy) = match (task.method, traced) {
                (Method::Certified, _) => visibility::primary(task, block.0, block.1, given, scratch),
                (_, Some(traced)) => (by_paper::traced_primary(task, traced, pixels), Occupancy::default()),
                _ => (by_paper::primary(task, grids, pixels, task.method.uses_rays()), Occupancy::default()),
            };
            let colors: Vec<_> = found.iter().map(|pixel| first_color(task, pixel, late)).collect();
            (block, found, colors, occupancy)
        };
        batch.each(crew, spare, work, |(block, found, colors, occupancy)| {
            book.put_occupancy(&occupancy);
            book.put_pixels(task, block, &found, &colors);
            for pixel in found.iter().filter(|pixel| is_doubtful(task, pixel)) {
                book.frame.rgb[pixel.index] = book.color(task, pixel.index, book.hits.at(pixel.index), |_| None);
            }
        })
    }

    /// Finds the shadows of tiles and tells how many of them are done.
    fn shadows(&mut self, batch: &Batch) -> usize {
        let Self { task, book, crew, spare, given, traced, grids, .. } = self;
        let (task, given, traced, grids) = (&*task, given.as_ref(), traced.as_ref(), &*grids);
        let (hits, mut in_light) = book.in_light();
        let work = |block: Block, scratch: &mut Scratch| {
            let points = || by_proof::indices(task, block).filter_map(|index| Some((index, hits.at(index)?.point)));
            let found = match (task.method, traced) {
                (Method::Certified, _) => {
                    let receiver = |index| hits.receiver(index);
                    by_proof::shadows(task, block.0, block.1, &receiver, given, scratch)
                }
                (_, Some(traced)) => by_paper::traced_shadows(task, traced, points().map(|(index, _)| index)),
                (Method::Paper(method), None) => by_paper::shadows(task, grids, method, points()),
            };
            let colors = lit_colors(task, hits, block, &found);
            (found, colors)
        };
        batch.each(crew, spare, work, |(found, colors)| {
            found.iter().for_each(|light| in_light.put(task, light));
            colors.into_iter().for_each(|color| in_light.put_color(color));
        })
    }

    /// Looks closer at inner edges in tiles and tells how many of them are done. The paper's pictures have none.
    fn creases(&mut self, batch: &Batch) -> usize {
        if self.task.method != Method::Certified {
            return batch.turns.len();
        }
        let Self { task, book, crew, spare, .. } = self;
        let (task, so_far, mut found) = (&*task, &*book, Vec::new());
        let work = |block, scratch: &mut Scratch| crease::grids(task, &so_far.creases(task, block), scratch);
        let done = batch.each(crew, spare, work, |grids| found.push(grids));
        found.into_iter().for_each(|grids| book.put_creases(grids));
        done
    }
}

/// Tiles to be worked on, and when to stop beginning with others.
struct Batch {
    /// Which of them, by the order in which they come.
    turns: Range<usize>,
    part: Part,
    /// All tiles of the stage, and what the number of one grows by from turn to turn.
    tiles: usize,
    stride: usize,
    /// Tiles side by side.
    across: usize,
    /// First row of the first ones.
    top: usize,
    deadline: Duration,
    clock: Clock,
    stop: Arc<AtomicBool>,
}

impl Batch {
    /// The tile that comes as number `turn` of this part. The order is scattered over the picture, by the golden section: then any number of
    /// tiles is a fair sample of all.
    fn block(&self, turn: usize) -> Block {
        let tile = (self.part.number + turn * self.part.of) * self.stride % self.tiles;
        (tile % self.across * BLOCK, self.top + tile / self.across * BLOCK, BLOCK)
    }

    /// Works on the tiles in their order, and tells how many of them were done. Each thread takes the next tile when it has done one, and
    /// has what it found `put` at once, while its caches hold it: one thread at a
    /// time, the tiles in any order. Whatever is begun is done, so what is done has no gaps. A panic ends the batch when the other threads are done with it;
    /// tiles are then booked that do not count as done.
    fn each<T>(
        &self,
        crew: &Crew,
        spare: &Spare,
        work: impl Fn(Block, &mut Scratch) -> T + Sync,
        put: impl FnMut(T) + Send,
    ) -> usize {
        let Range { start, end } = self.turns;
        let (next, threads, put) = (AtomicUsize::new(start), crew.size(), Mutex::new(put));
        let go_on = || {
            let first = next.load(Ordering::Relaxed) < start + threads;
            !self.stop.load(Ordering::Relaxed) && (first || (self.clock)() < self.deadline)
        };
        let tiles = |_| {
            let mut scratch = spare.take();
            while go_on() {
                let turn = next.fetch_add(1, Ordering::Relaxed);
                if turn >= end {
                    break;
                }
                let found = work(self.block(turn), &mut scratch);
                // Poisoned by a panic, which ends the batch at once.
                let Ok(mut put) = put.lock() else { break };
                put(found);
            }
            spare.give(scratch);
        };
        crew.install(|| (0..threads).into_par_iter().with_max_len(1).for_each(tiles));
        next.into_inner().min(end) - start
    }
}
