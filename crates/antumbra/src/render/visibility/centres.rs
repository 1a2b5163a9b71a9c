//! What centre rays meet: mostly what the patches of their blocks say.
use super::{Met, Node, Primary, SIMPLE, Sight, Stage, empty, is_given};
use crate::geom::Film;
use crate::render::by_proof::{BLOCK, Block, indices};
use crate::render::pixel::{Known, Pixel};
use crate::render::spare::Scratch;
use crate::trace::{Bracketed, Cost, Effort, Meeting, Ray, enclose};
use crate::verdict::Reason;
use antumbra_interval::Interval;

/// Rays of patches that are followed together: few enough for the nearest caches.
const COMPANY: usize = 128;

/// Rays of which patches know what they meet; the numbers are those of the pixels and of their blocks.
#[derive(Default)]
struct Waiting {
    rays: Vec<Bracketed>,
    pixels: Vec<(usize, usize)>,
}

impl Primary<'_> {
    /// What the centre rays of all pixels meet that may show something: those of which nothing else is to be found out, as patches say what they
    /// meet, and the others.
    pub(super) fn centres<'n>(&mut self, nodes: &'n [Node]) -> (Vec<Pixel>, Vec<Sight<'n>>) {
        let task = self.task;
        let (mut simple, mut sights) = (Vec::with_capacity(BLOCK * BLOCK), Vec::new());
        let Some(&Node { block: (column, row, side), .. }) = nodes.first() else { return (simple, sights) };
        let ends = [(column + side).min(task.film.width), (row + side).min(task.film.height)];
        let rays = task.film.rays(column..ends[0], row..ends[1]);
        let mut waiting = Waiting::default();
        for (k, node) in nodes.iter().enumerate().filter(|(_, n)| n.children.is_empty() && !n.open.certainly_empty()) {
            let patch = node.patch.as_ref().map(|patch| (patch, Places::of(&task.film, node.block)));
            for index in indices(task, node.block).filter(|index| !is_given(self.given, *index)) {
                let (column, row) = task.place(index);
                let beam = rays.ray(column, row);
                match patch.as_ref().and_then(|(patch, places)| patch.bracket(places.symbols(column, row))) {
                    Some(bracket) => {
                        waiting.rays.push(Bracketed { beam, bracket });
                        waiting.pixels.push((index, k));
                    }
                    None => sights.push(Sight::new(task, index, &node.open, beam, Cost::default())),
                }
            }
            if waiting.rays.len() >= COMPANY {
                self.simple(&mut waiting, nodes, &mut simple, &mut sights);
            }
        }
        self.simple(&mut waiting, nodes, &mut simple, &mut sights);
        let rays: Vec<Ray<'_>> =
            sights.iter().map(|s| Ray { beam: s.ray, open: &s.open.open, inside: s.open.inside }).collect();
        let found = self.meet(&rays, Effort::FINE);
        let met: Vec<Met> =
            sights.iter().zip(&found).enumerate().filter_map(|(k, (s, (m, _)))| Some((k, s.ray, (*m)?))).collect();
        self.hits(&met, |k, hit| sights[k].pixel.hit = Some(hit));
        for (sight, (centre, cost)) in sights.iter_mut().zip(found) {
            let pixel = &mut sight.pixel;
            pixel.cost += cost;
            pixel.known = match centre {
                Some(Meeting { reason: None, .. }) => Known::Hit,
                Some(Meeting { reason: Some(reason), .. }) => Known::Undecided(reason),
                None => Known::Undecided(Reason::Resolution),
            };
            let covered = sight.open.certainly_covered();
            if pixel.known == Known::Undecided(Reason::Budget) {
                pixel.coverage = [0.0, 1.0];
            } else {
                pixel.coverage = [1.0; 2];
                // Else an edge, or something thin: how much of the pixel is covered, and by what?
                if !(covered && sight.open.open.len() == 1 && pixel.known == Known::Hit) {
                    sight.stage = Stage::Coverage;
                }
            }
        }
        (simple, sights)
    }

    /// The pixels whose rays wait: what they meet is the surface of their patches, which covers them. One whose bracket is not enough is seen as the
    /// others are.
    fn simple<'n>(
        &mut self,
        waiting: &mut Waiting,
        nodes: &'n [Node],
        simple: &mut Vec<Pixel>,
        sights: &mut Vec<Sight<'n>>,
    ) {
        let Waiting { rays, pixels } = waiting;
        let Scratch { brackets, work, .. } = &mut *self.scratch;
        let mut met: Vec<Met> = Vec::with_capacity(rays.len());
        enclose(&self.surfaces, rays, Effort::FINE, brackets, work, |k, meeting, cost| {
            let ((index, node), beam) = (pixels[k], rays[k].beam);
            if let Some(meeting) = meeting {
                met.push((simple.len(), beam, meeting));
                simple.push(Pixel { known: Known::Hit, coverage: [1.0; 2], cost, ..empty(index) });
            } else {
                sights.push(Sight::new(self.task, index, &nodes[node].open, beam, cost));
            }
        });
        self.hits(&met, |k, hit| simple[k].hit = Some(hit));
        rays.clear();
        pixels.clear();
    }
}

/// What the symbols of a block's fan are on its centre rays, column by column and row by row.
struct Places {
    corner: [usize; 2],
    columns: [Interval; SIMPLE],
    rows: [Interval; SIMPLE],
}

impl Places {
    fn of(film: &Film, (column, row, side): Block) -> Self {
        let [x, y] = film.window(column..(column + side).min(film.width), row..(row + side).min(film.height));
        let columns = std::array::from_fn(|k| film.column_symbol(x, column + k));
        Self { corner: [column, row], columns, rows: std::array::from_fn(|k| film.row_symbol(y, row + k)) }
    }

    fn symbols(&self, column: usize, row: usize) -> [Interval; 2] {
        [self.columns[column - self.corner[0]], self.rows[row - self.corner[1]]]
    }
}
