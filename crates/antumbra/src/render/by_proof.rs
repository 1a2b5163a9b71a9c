//! The passes of the certified method: blocks of pixels that are divided until everything is proved or counted.
use super::pixel::{Edge, Hit, Known, Light, Pixel};
use super::task::Task;
use crate::eval::Workspace;
use crate::geom::Beam;
use crate::shadow::{self, Receiver, Shaft, ShaftVerdict, shaft, visible, whole_beam};
use crate::trace::{self, Cost, Effort, Known as Open, Meeting, Piece, Surface, first_meeting, narrow};
use crate::verdict::Reason;
use antumbra_interval::Interval;

/// Side of the blocks that both passes start with: a power of two.
pub(super) const BLOCK: usize = 32;
/// Blocks up to this side whose frustum is covered by one simple piece are not divided further.
const SIMPLE: usize = 4;
/// A pixel that an edge crosses is divided this often, for the bounds of its coverage.
const COVERAGE_LEVELS: u32 = 2;
/// Cosine between normals within a pixel from which it is shown as one surface.
const PLAIN_NORMAL: f64 = 0.97;
/// Rays along each side of such a pixel, for its colour.
const EDGE_RAYS: usize = 4;

/// A part of the picture: column, row and side, which may reach over the picture's border.
type Block = (usize, usize, usize);

struct Primary<'a> {
    task: &'a Task,
    surfaces: Vec<Surface<'a>>,
    work: Workspace,
    stack: Vec<Interval>,
    rays: trace::Scratch,
}

/// Primary visibility of the block at `(column, row)`, clipped to the picture.
pub(super) fn primary(task: &Task, column: usize, row: usize) -> Vec<Pixel> {
    let mut pass = Primary {
        task,
        surfaces: task.surfaces(),
        work: Workspace::default(),
        stack: Vec::new(),
        rays: trace::Scratch::default(),
    };
    let mut out = Vec::new();
    // What a frustum costs is booked on the first pixel below it.
    let mut owed = Cost::default();
    let fan = pass.fan((column, row, BLOCK));
    let mut blocks = vec![((column, row, BLOCK), Open::nothing(&pass.surfaces, &fan))];
    while let Some((block, parent)) = blocks.pop() {
        let (column, row, side) = block;
        let fan = pass.fan(block);
        let open = narrow(&pass.surfaces, &fan, &parent, &mut pass.stack, &mut pass.work, &mut owed);
        // Small, covered and simple: straight to the rays.
        let simple = side <= SIMPLE && open.certainly_covered() && open.open.len() == 1;
        if side == 1 || simple {
            for index in indices(task, block) {
                let (column, row) = (index % task.film.width, index / task.film.width);
                out.push(pass.pixel(column, row, &open, std::mem::take(&mut owed)));
            }
            continue;
        }
        if open.certainly_empty() {
            for index in indices(task, block) {
                let cost = std::mem::take(&mut owed);
                out.push(Pixel { index, known: Known::Empty, coverage: [0.0; 2], hit: None, edge: None, cost });
            }
            continue;
        }
        let half = side / 2;
        for (down, right) in [(1, 1), (1, 0), (0, 1), (0, 0)] {
            let child = (column + right * half, row + down * half, half);
            if child.0 < task.film.width && child.1 < task.film.height {
                blocks.push((child, open.clone()));
            }
        }
    }
    out
}

/// Indices of the pixels of a block, row by row.
fn indices(task: &Task, (column, row, side): Block) -> impl Iterator<Item = usize> + use<> {
    let (width, height) = (task.film.width, task.film.height);
    let columns = column..(column + side).min(width);
    (row..(row + side).min(height)).flat_map(move |row| columns.clone().map(move |column| row * width + column))
}

impl Primary<'_> {
    fn fan(&self, (column, row, side): Block) -> crate::geom::Fan {
        let film = &self.task.film;
        film.fan(column..(column + side).min(film.width), row..(row + side).min(film.height))
    }

    /// One pixel, of whose frustum `open` is known.
    fn pixel(&mut self, column: usize, row: usize, open: &Open, mut cost: Cost) -> Pixel {
        let index = row * self.task.film.width + column;
        if open.certainly_empty() {
            return Pixel { index, known: Known::Empty, coverage: [0.0; 2], hit: None, edge: None, cost };
        }
        let ray = self.task.film.ray(column, row);
        let centre = self.meet(&ray, open, Effort::FINE, &mut cost);
        let mut hit = centre.map(|m| self.hit(&ray, &m));
        let mut known = match centre {
            Some(Meeting { reason: None, .. }) => Known::Hit,
            Some(Meeting { reason: Some(reason), .. }) => Known::Undecided(reason),
            None => Known::Undecided(Reason::Resolution),
        };
        if known == Known::Undecided(Reason::Budget) {
            return Pixel { index, known, coverage: [0.0, 1.0], hit, edge: None, cost };
        }
        let covered = open.certainly_covered();
        if covered && open.open.len() == 1 && known == Known::Hit {
            return Pixel { index, known, coverage: [1.0; 2], hit, edge: None, cost };
        }
        // An edge, or something thin: how much of the pixel is covered, and by what?
        let window = self.task.film.window(column..column + 1, row..row + 1);
        let coverage = if covered { [1.0; 2] } else { self.coverage(window, open, COVERAGE_LEVELS, &mut cost) };
        let coverage = outward(coverage);
        if coverage[1] == 0.0 {
            return Pixel { index, known: Known::Empty, coverage, hit: None, edge: None, cost };
        }
        let thin = hit.and_then(|hit| {
            let before = |p: &&Piece| p.surface != hit.object && p.t.lo() < hit.t.lo();
            let piece = open.open.iter().find(before)?;
            let beam = self.task.film.beam(column, row);
            Some(self.task.hit(piece.surface, &beam, piece.t, None, &mut self.work))
        });
        if thin.is_none() && hit.is_some_and(|hit| self.plain((column, row), &hit, open, &mut cost)) {
            return Pixel { index, known, coverage, hit, edge: None, cost };
        }
        let mut rays = Vec::with_capacity(EDGE_RAYS * EDGE_RAYS);
        for k in 0..EDGE_RAYS * EDGE_RAYS {
            let ray = self.task.film.sub_ray(column, row, k % EDGE_RAYS, k / EDGE_RAYS, EDGE_RAYS);
            let meeting = self.meet(&ray, open, Effort::COARSE, &mut cost);
            rays.push(meeting.map(|m| self.hit(&ray, &m)));
            if let (None, Some(Meeting { reason: None, .. })) = (hit, meeting)
                && let Some(m @ Meeting { reason: None, .. }) = self.meet(&ray, open, Effort::FINE, &mut cost)
            {
                (known, hit) = (Known::Partly, Some(self.hit(&ray, &m)));
            }
        }
        // Something may be there that no ray of the grid meets: it must not vanish.
        if hit.is_none()
            && let Some(piece) = open.open.first()
        {
            let beam = self.task.film.beam(column, row);
            hit = Some(self.task.hit(piece.surface, &beam, piece.t, None, &mut self.work));
        }
        Pixel { index, known, coverage, hit, edge: Some(Edge { rays, thin }), cost }
    }

    /// Whether rays near the corners of a pixel meet about the same as its centre ray: then one colour will do.
    fn plain(&mut self, (column, row): (usize, usize), centre: &Hit, open: &Open, cost: &mut Cost) -> bool {
        [(0, 0), (1, 0), (0, 1), (1, 1)].into_iter().all(|(i, j)| {
            let last = EDGE_RAYS - 1;
            let ray = self.task.film.sub_ray(column, row, i * last, j * last, EDGE_RAYS);
            let meeting = self.meet(&ray, open, Effort::COARSE, cost);
            meeting.is_some_and(|m| {
                let corner = self.hit(&ray, &m);
                corner.normal.dot(centre.normal) > PLAIN_NORMAL && corner.object == centre.object
            })
        })
    }

    fn meet(&mut self, ray: &Beam, open: &Open, effort: Effort, cost: &mut Cost) -> Option<Meeting> {
        first_meeting(&self.surfaces, ray, &open.open, effort, &mut self.rays, &mut self.work, cost)
    }

    fn hit(&mut self, ray: &Beam, m: &Meeting) -> Hit {
        let hit = self.task.hit(m.surface, ray, m.t, m.before, &mut self.work);
        let receiver = match (m.reason, m.before) {
            (None, Some(side)) => Some(Receiver { point: ray.at(m.t), surface: m.surface, side }),
            _ => None,
        };
        Hit { receiver, ..hit }
    }

    /// Bounds of the covered share of a window of the film, as if its parts were exact quarters: see [`outward`].
    fn coverage(&mut self, window: [Interval; 2], parent: &Open, levels: u32, cost: &mut Cost) -> [f64; 2] {
        let ([left, right], [below, above]) = (halves(window[0]), halves(window[1]));
        let quarters = [[left, below], [right, below], [left, above], [right, above]];
        let open = quarters.map(|[x, y]| {
            let fan = self.task.film.fan_of(x, y);
            narrow(&self.surfaces, &fan, parent, &mut self.stack, &mut self.work, cost)
        });
        // Where no quarter is settled (a sheet thinner than the pixel, say), going on would only cost.
        let settled = open.iter().any(|o| o.certainly_empty() || o.certainly_covered());
        let mut sum = [0.0; 2];
        for (window, open) in quarters.into_iter().zip(&open) {
            let part = if open.certainly_empty() {
                [0.0, 0.0]
            } else if open.certainly_covered() {
                [1.0, 1.0]
            } else if levels <= 1 || !settled {
                [0.0, 1.0]
            } else {
                self.coverage(window, open, levels - 1, cost)
            };
            sum = [sum[0] + 0.25 * part[0], sum[1] + 0.25 * part[1]];
        }
        sum
    }
}

/// Bounds of a share of a pixel, for parts that are quarters only up to rounding: film coordinates, in `[-1, 1]`, are known
/// up to 2^-50; a pixel has at least the side 2^-15, so two edges move a share by less than 2 * 2 * 2^-35 < 1e-9. All and
/// nothing are exact, whatever the parts are.
fn outward([lo, hi]: [f64; 2]) -> [f64; 2] {
    const ROUNDING: f64 = 1e-9;
    [if lo < 1.0 { (lo - ROUNDING).max(0.0) } else { lo }, if hi > 0.0 { (hi + ROUNDING).min(1.0) } else { hi }]
}

/// The two halves of an interval; they share their edge.
fn halves(t: Interval) -> [Interval; 2] {
    let mid = t.mid();
    [Interval::new(t.lo(), mid), Interval::new(mid, t.hi())]
}

/// Shadows of the hits of the block at `(column, row)`; `receiver_of` gives the proved hit of a pixel, if it has one.
pub(super) fn shadows<'a>(
    task: &Task,
    column: usize,
    row: usize,
    receiver_of: &(dyn Fn(usize) -> Option<&'a Receiver> + 'a),
) -> Vec<Light> {
    let surfaces = task.surfaces();
    let (mut work, mut scratch, mut stack) = (Workspace::default(), shadow::Scratch::default(), Vec::new());
    let mut out = Vec::new();
    // What a shaft costs is booked on the first pixel below it.
    let mut owed = Cost::default();
    let start = |light| ((column, row, BLOCK), light, whole_beam(&surfaces));
    let mut blocks: Vec<(Block, usize, Vec<Piece>)> = (0..task.lights.len()).rev().map(start).collect();
    while let Some((block, light, mut pieces)) = blocks.pop() {
        let rect = &task.lights[light].rect;
        let hits: Vec<(usize, &Receiver)> =
            indices(task, block).filter_map(|index| Some((index, receiver_of(index)?))).collect();
        if hits.is_empty() {
            continue;
        }
        let (column, row, side) = block;
        if hits.len() >= 2 {
            let placed: Vec<(u32, u32, &Receiver)> = hits
                .iter()
                .map(|(index, r)| ((index % task.film.width) as u32, (index / task.film.width) as u32, *r))
                .collect();
            if let Some(fit) = Shaft::fit(&placed)
                && (side <= 4 || !fit.rough())
            {
                let mut open = Vec::new();
                let found = shaft(&surfaces, &fit, rect, &pieces, &mut open, &mut stack, &mut work, &mut owed);
                if found != ShaftVerdict::Open {
                    let visible = f64::from(u8::from(found == ShaftVerdict::Lit));
                    for (index, _) in hits {
                        let initial = std::mem::take(&mut owed);
                        let first_occluded = found == ShaftVerdict::Dark;
                        out.push(Light {
                            index,
                            light,
                            lo: visible,
                            hi: visible,
                            first_occluded,
                            initial,
                            ..Light::default()
                        });
                    }
                    continue;
                }
                pieces = open;
            }
        }
        if side > 2 && hits.len() >= 2 {
            let half = side / 2;
            for (down, right) in [(1, 1), (1, 0), (0, 1), (0, 0)] {
                blocks.push(((column + right * half, row + down * half, half), light, pieces.clone()));
            }
            continue;
        }
        for (index, receiver) in hits {
            let mut cost = Cost::default();
            let bracket =
                visible(&surfaces, receiver, rect, &pieces, task.tolerance, &mut scratch, &mut work, &mut cost);
            out.push(Light {
                index,
                light,
                lo: bracket.lo,
                hi: bracket.hi,
                reason: bracket.reason,
                first_occluded: !bracket.first_free,
                initial: std::mem::take(&mut owed),
                sub: cost,
            });
        }
    }
    out
}
