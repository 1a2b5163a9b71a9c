//! Where does a beam meet a surface first? And: does it meet one at all?
//!
//! Two families. The paper's: stackless bisection ("Root Searching") in the marked cells of a grid; what it reports is a
//! section of T narrower than a limit in which the inclusion function could not exclude a zero, and its absence is a
//! proof. The certified one: frusta in affine form, and quadratic where rays touch, that hand their open pieces down ([`narrow`]), what all
//! rays of a block meet to second order ([`patches`]), and the first root of a ray, proved by signs ([`first_meeting`]) and enclosed by contraction and interval Newton
//! ([`enclose`], where a patch has proved it).
#![deny(clippy::float_arithmetic)]
mod bisection;
mod bracketed;
mod crossing;
mod frustum;
mod patch;
mod piece;
mod policy;
mod ray;
mod root;

pub use bisection::{Bisection, Search, first_section};
pub use bracketed::{Bracketed, Brackets, enclose};
pub use frustum::{Frusta, Frustum, Known, narrow};
pub use patch::{Bracket, Patch, patches};
pub use piece::{Piece, Sign, Surface, certainly_continuous};
pub use policy::Effort;
pub use ray::{Meeting, Ray, Scratch, first_meeting, first_meetings};

use crate::eval::{Inclusion, Workspace};
use crate::geom::Beam;
use crate::grid::{Grid, rows};
use antumbra_interval::Interval;

/// Work done: the machine-independent cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Beams (or rays, which are thin beams) followed.
    pub beams: u64,
    /// Evaluations of an inclusion function.
    pub evaluations: u64,
}

impl std::ops::AddAssign for Cost {
    fn add_assign(&mut self, o: Self) {
        self.beams += o.beams;
        self.evaluations += o.evaluations;
    }
}

/// A surface prepared for tracing: its function and the grid of the cells it may cross.
#[derive(Clone, Copy)]
pub struct Target<'a> {
    /// The function.
    pub function: &'a dyn Inclusion,
    /// Cells that it may cross; outside its bounds the surface does not exist.
    pub grid: &'a Grid,
}

/// The nearest section of `t` in which the beam may meet the surface. `None` proves that no ray of the beam meets it
/// at a parameter in `t`; `Some(section)` proves that none does before `section.lo()`.
pub fn nearest(
    target: Target<'_>,
    beam: &Beam,
    t: Interval,
    search: Search<'_>,
    work: &mut Workspace,
    cost: &mut Cost,
) -> Option<Interval> {
    cost.beams += 1;
    let mut best: Option<Interval> = None;
    for row in rows(target.grid, beam, t) {
        // Rows follow each other in T with some overlap: stop once no later row can begin before the find.
        if best.is_some_and(|b| row.t().lo() >= b.lo()) {
            break;
        }
        for crossing in row.crossings(target.grid, beam) {
            // Of this cell only the part before the find is of interest.
            let before = best.map_or(crossing, |b| {
                crossing.intersection(Interval::try_new(f64::NEG_INFINITY, b.lo()).unwrap_or(Interval::ENTIRE))
            });
            if before.is_empty() {
                continue;
            }
            if let Some(section) = first_section(target.function, beam, before, search, work, cost) {
                best = Some(section);
            }
        }
    }
    best
}

/// Whether the beam may meet the surface at a parameter in `t`: `false` is a proof that no ray of it does.
pub fn possibly_blocked(
    target: Target<'_>,
    beam: &Beam,
    t: Interval,
    search: Search<'_>,
    work: &mut Workspace,
    cost: &mut Cost,
) -> bool {
    cost.beams += 1;
    rows(target.grid, beam, t).any(|row| {
        row.crossings(target.grid, beam)
            .any(|crossing| first_section(target.function, beam, crossing, search, work, cost).is_some())
    })
}
