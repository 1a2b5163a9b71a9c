//! Which share of a pixel is covered: its parts as frusta of their own.
use super::spare::Scratch;
use crate::geom::Film;
use crate::trace::{Cost, Frustum, Known as Open, Piece, Surface, narrow};
use antumbra_interval::Interval;

/// A part of the film, and what is known of all its rays.
#[derive(Debug)]
pub(super) struct Part {
    film: [Interval; 2],
    pub(super) open: Open,
}

impl Part {
    /// Whether the rays of these film coordinates are in it: proved.
    pub(super) fn certainly_holds(&self, [x, y]: [Interval; 2]) -> bool {
        x.is_subset_of(self.film[0]) && y.is_subset_of(self.film[1])
    }
}

/// What was found out about a window of the film.
#[derive(Debug)]
pub(super) struct Covered {
    /// Bounds of the share of it that is covered, as if its parts were exact quarters ([`outward`]).
    pub(super) share: [f64; 2],
    /// What that cost.
    pub(super) cost: Cost,
    /// It is divided into these.
    pub(super) parts: Vec<Part>,
}

/// A part of the film, and what is known of one that it is a part of.
#[derive(Clone, Copy)]
pub(super) struct Window<'a> {
    pub(super) film: [Interval; 2],
    pub(super) parent: &'a Open,
}

impl Window<'_> {
    fn quarters(&self) -> [Self; 4] {
        let ([left, right], [below, above]) = (halves(self.film[0]), halves(self.film[1]));
        [[left, below], [right, below], [left, above], [right, above]].map(|film| Self { film, ..*self })
    }
}

/// Where frusta are looked at.
pub(super) struct Looking<'a> {
    pub(super) film: &'a Film,
    pub(super) surfaces: &'a [Surface<'a>],
    pub(super) scratch: &'a mut Scratch,
}

impl Looking<'_> {
    fn narrow(&mut self, windows: &[Window<'_>]) -> Vec<(Open, Cost)> {
        let fan = |w: &Window<'_>| self.film.fan_of(w.film[0], w.film[1]);
        let jobs: Vec<Frustum<'_>> = windows.iter().map(|w| Frustum { fan: fan(w), parent: w.parent }).collect();
        let mut found = Vec::with_capacity(jobs.len());
        let Scratch { frusta, work, .. } = &mut *self.scratch;
        narrow(self.surfaces, &jobs, frusta, work, |_, known, cost| found.push((std::mem::take(known), cost)));
        found
    }

    /// Whether the surface of a piece stays possible before `until` in some part of a window of the film.
    pub(super) fn remains(
        &mut self,
        piece: &Piece,
        until: f64,
        window: Window<'_>,
        levels: u32,
        cost: &mut Cost,
    ) -> bool {
        window.quarters().into_iter().any(|part| {
            let (open, spent) = self.narrow(&[part]).remove(0);
            *cost += spent;
            let there = open.open.iter().any(|p| p.surface == piece.surface && p.t.lo() < until);
            there && (levels <= 1 || self.remains(piece, until, Window { parent: &open, ..part }, levels - 1, cost))
        })
    }

    /// The covered shares of windows of the film.
    pub(super) fn coverage(&mut self, windows: &[Window<'_>], levels: u32) -> Vec<Covered> {
        let quarters: Vec<Window<'_>> = windows.iter().flat_map(Window::quarters).collect();
        let open = self.narrow(&quarters);
        // Where no quarter is settled (a sheet thinner than the pixel, say), going on would only cost.
        let settled = |o: &(Open, Cost)| o.0.certainly_empty() || o.0.certainly_covered();
        let worth = |four: &[(Open, Cost)]| levels > 1 && four.iter().any(settled);
        let further: Vec<Window<'_>> = open
            .chunks(4)
            .zip(quarters.chunks(4))
            .filter(|(four, _)| worth(four))
            .flat_map(|(four, parts)| four.iter().zip(parts).filter(|(o, _)| !settled(o)))
            .map(|(o, part)| Window { film: part.film, parent: &o.0 })
            .collect();
        let mut finer = if further.is_empty() { Vec::new() } else { self.coverage(&further, levels - 1) }.into_iter();
        // Which of them are divided further, window by window.
        let divided: Vec<bool> =
            open.chunks(4).flat_map(|four| four.iter().map(|o| worth(four) && !settled(o))).collect();
        let films: Vec<[Interval; 2]> = quarters.iter().map(|q| q.film).collect();
        let mut quarters = open.into_iter().zip(films).zip(divided);
        let one = |_: &Window<'_>| {
            let mut all = Covered { share: [0.0; 2], cost: Cost::default(), parts: Vec::new() };
            for (((open, cost), film), divided) in quarters.by_ref().take(4) {
                all.cost += cost;
                let share = if divided && let Some(finer) = finer.next() {
                    all.cost += finer.cost;
                    all.parts.extend(finer.parts);
                    finer.share
                } else {
                    let share = match (open.certainly_empty(), open.certainly_covered()) {
                        (true, _) => [0.0, 0.0],
                        (_, true) => [1.0, 1.0],
                        _ => [0.0, 1.0],
                    };
                    all.parts.push(Part { film, open });
                    share
                };
                all.share = [all.share[0] + 0.25 * share[0], all.share[1] + 0.25 * share[1]];
            }
            all
        };
        windows.iter().map(one).collect()
    }
}

/// Bounds of a share of a pixel, for parts that are quarters only up to rounding: film coordinates, in `[-1, 1]`, are known
/// up to 2^-50; a pixel has at least the side 2^-15, so two edges move a share by less than 2 * 2 * 2^-35 < 1e-9. All and
/// nothing are exact, whatever the parts are.
pub(super) fn outward([lo, hi]: [f64; 2]) -> [f64; 2] {
    const ROUNDING: f64 = 1e-9;
    [if lo < 1.0 { (lo - ROUNDING).max(0.0) } else { lo }, if hi > 0.0 { (hi + ROUNDING).min(1.0) } else { hi }]
}

/// The two halves of an interval; they share their edge.
fn halves(t: Interval) -> [Interval; 2] {
    let mid = t.mid();
    [Interval::new(t.lo(), mid), Interval::new(mid, t.hi())]
}
