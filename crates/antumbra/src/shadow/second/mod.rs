//! Penumbrae to second order: the visible fraction of a light from one hit, by quadratic models.
//!
//! Where the first-order method ([`super::visible`]) covers an open part of the beam with many short pieces and bounds each
//! by a plane, this one follows the *least value along each ray*: near an occluder's silhouette it is a smooth function of
//! the point of the light. Its parts, each proved in `docs/mathematics.md`:
//!
//! * **Slabs** between two sheets `t = k + u_slope u + v_slope v`, sheared so that the least value stays in the middle
//!   ([`slab`]). Over a parallel slab a quadratic form of a polynomial of degree 2 is exact.
//! * **Convex cores**: where the function is proved convex in t, its value and slope on one sheet bound its least value
//!   ([`cell`]).
//! * **Elimination** of t elsewhere: bounds of the least value as quadratic polynomials over the light
//!   ([`antumbra_interval::quadratic`]).
//! * **Strips**: certified areas beside quadratic curves, and the band that stays unknown ([`crate::geom::strips`]).
//! * **Cropped subdivision**: a cell is divided along the silhouette, and only the band goes on.
mod cell;
mod policy;
mod slab;
mod undecided;

use super::desk::Desk;
use super::known::{Known, Part};
use super::ledger::{Ledger, Node, area};
use super::rectangle::Query;
use super::visible::{Bracket, Penumbra, Tolerance};
use crate::eval::Workspace;
use crate::geom::strips::{Areas, Band, Curve};
use crate::geom::{Fan, Passage, Sheet};
use crate::trace::{Cost, Piece, Surface, certainly_continuous};
use crate::verdict::Reason;
use antumbra_interval::Interval;
use antumbra_interval::round::sub_up;
use cell::{Answer, look};
pub(super) use policy::Learned;
pub(super) use slab::Way;
use slab::{Cell, Slab, State};
use undecided::Seen;

/// Scratch memory of one thread.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    cell: cell::Scratch,
    slabs: Vec<Slab>,
    curves: Vec<Curve>,
    ledger: Ledger<Rest>,
    parts: Vec<Job>,
    /// Everything that is claimed, if somebody wants to know.
    pub(super) claims: Option<Vec<Claim>>,
}

/// What was proved of a part of the light.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    /// Parameters u, v of the light.
    pub part: [Interval; 2],
    /// What is said of it.
    pub says: Says,
}

/// A statement about all points of a part of a light.
#[derive(Clone, Debug, PartialEq)]
pub enum Says {
    /// All are visible.
    Lit,
    /// None is.
    Dark,
    /// With `(a, b)` in `[-1, 1]^2` running over the part: those are visible at which every curve's `lower > error`; those are
    /// not at which some hiding curve's `upper < -error`.
    Curves(Vec<Curve>),
}

/// A part of the light and its slabs.
type Job = ([Interval; 2], (usize, usize));

/// What is remembered of a cell that is partly unknown.
#[derive(Clone, Debug)]
struct Rest {
    slabs: (usize, usize),
    /// What they say about the cell.
    curves: (usize, usize),
    band: Option<Band>,
}

/// Bounds of a visible fraction, and the cells that it took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fraction {
    pub(super) lo: f64,
    pub(super) hi: f64,
    pub(super) cells: u32,
    /// Whether the one part of the light that was open was proved lit at first sight.
    pub(super) first_lit: bool,
}

impl Fraction {
    /// Whether the bracket is as narrow as was asked for.
    pub(super) fn narrow(&self, tolerance: Tolerance) -> bool {
        sub_up(self.hi, self.lo) <= tolerance.width
    }

    /// Whether nothing more is to be done.
    pub(super) fn settles(&self, tolerance: Tolerance) -> bool {
        tolerance.penumbra == Penumbra::Second || sub_up(self.hi, self.lo) <= tolerance.width
    }

    pub(super) fn bracket(&self, known: &Known, tolerance: Tolerance) -> Bracket {
        let reason = (sub_up(self.hi, self.lo) > tolerance.width).then_some(Reason::Budget);
        Bracket { lo: self.lo, hi: self.hi, reason, first_free: known.whole() && self.first_lit && self.lo == 1.0 }
    }
}

/// What is known of each surface on all rays: up to where it is proved continuous, so that an opposite sign is a proof.
/// `None` if the method does not apply to these pieces: then some surface has no front sign, or may break.
pub(super) fn ways(query: &Query<'_>, whole: &Fan, known: &Known, work: &mut Workspace) -> Option<Vec<Way>> {
    const NOWHERE: Way = Way { reach: 0.0, passage: Passage { outer: Interval::EMPTY, inner: Interval::EMPTY } };
    let directions = whole.directions();
    let mut way = |(surface, at): (usize, &Surface<'_>)| {
        let mut of = known.open.iter().flat_map(|part| &part.pieces).filter(|p| p.surface == surface).map(|p| p.t);
        let Some(first) = of.next() else { return Some(NOWHERE) };
        query.fronts[surface]?;
        let passage = at.passage(&whole.apex, &directions);
        if at.function.continuous_everywhere() {
            return Some(Way { reach: 1.0, passage });
        }
        let t = of.fold(first, Interval::hull).hull(Interval::ZERO);
        certainly_continuous(at.function, &whole.box_at(t), work).then_some(Way { reach: t.hi(), passage })
    };
    query.surfaces.iter().enumerate().map(&mut way).collect()
}

/// The visible fraction, given what is known of the light.
pub(super) async fn fraction(
    query: &Query<'_>,
    ways: &[Way],
    known: &Known,
    tolerance: Tolerance,
    s: &mut Scratch,
    desk: &Desk<'_>,
    cost: &mut Cost,
) -> Fraction {
    let Scratch { cell: scratch, slabs, curves, ledger, parts, claims } = s;
    let most = match tolerance.penumbra {
        Penumbra::Auto => cost.evaluations + policy::fair(tolerance.width),
        _ => u64::MAX,
    };
    ledger.clear();
    known.book(ledger);
    slabs.clear();
    curves.clear();
    parts.clear();
    for Part { part, pieces } in &known.open {
        let begin = slabs.len();
        slabs.extend(whole_slabs(pieces));
        parts.push((*part, (begin, slabs.len())));
    }
    let (mut cells, mut first_lit) = (0, false);
    loop {
        while let Some((part, (from, to))) = parts.pop() {
            cells += 1;
            let begin = slabs.len();
            let cell = Cell::new(query, ways, part);
            let enough = policy::enough(tolerance.width, area(part)[1]);
            let answer = look(&cell, from..to, enough, slabs, scratch, desk, cost).await;
            if let Some(claims) = claims {
                let says = match answer {
                    Answer::Lit => Says::Lit,
                    Answer::Dark => Says::Dark,
                    Answer::Open(_) => Says::Curves(scratch.curves().to_vec()),
                };
                claims.push(Claim { part, says });
            }
            match answer {
                Answer::Dark => ledger.shaded(),
                Answer::Lit => {
                    first_lit |= cells == 1 && known.open.len() == 1;
                    ledger.lit(area(part));
                }
                Answer::Open(Areas { lit, open, band }) => {
                    let first = curves.len();
                    curves.extend_from_slice(scratch.curves());
                    let rest = Rest { slabs: (begin, slabs.len()), curves: (first, curves.len()), band };
                    ledger.open(part, [lit, open], rest);
                }
            }
        }
        if cells >= tolerance.rectangles || cost.evaluations >= most {
            break;
        }
        if ledger.unknown() <= tolerance.width {
            // Narrow enough; but lit or dark all over is worth a little more.
            let [lo, hi] = ledger.bounds();
            if ledger.settled() || !policy::perhaps_all_the_same(lo, hi, cells) {
                break;
            }
        }
        let Some(node) = ledger.next() else { break };
        let band = node.rest.band.filter(policy::crop_pays);
        if let Some(band) = band {
            crop(&node, &band, ledger, parts);
        } else {
            let (from, to) = node.rest.curves;
            let seen = Seen { part: node.part, curves: &curves[from..to] };
            let Some(part) = seen.undecided(node.part, ledger, claims) else { continue };
            let shape = policy::Shape::of(query.light, query.receiver.point.mid(), part);
            let undecided = divide(part, shape.halved()).filter_map(|part| seen.undecided(part, ledger, claims));
            parts.extend(undecided.map(|part| (part, node.rest.slabs)));
        }
    }
    let [lo, hi] = ledger.bounds();
    Fraction { lo, hi, cells, first_lit }
}

/// Pieces of one surface that touch as slabs on all rays.
fn whole_slabs(pieces: &[Piece]) -> Vec<Slab> {
    let mut sorted = pieces.to_vec();
    sorted.sort_by(|a, b| a.surface.cmp(&b.surface).then(a.t.lo().total_cmp(&b.t.lo())));
    let mut joined: Vec<Piece> = Vec::with_capacity(sorted.len());
    for piece in sorted {
        match joined.last_mut() {
            Some(last) if last.surface == piece.surface && piece.t.lo() <= last.t.hi() => last.t = last.t.hull(piece.t),
            _ => joined.push(piece),
        }
    }
    let slab = |p: Piece| Slab {
        surface: p.surface,
        lo: Sheet::level(p.t.lo()),
        hi: Sheet::level(p.t.hi()),
        state: State::Open,
    };
    joined.into_iter().map(slab).collect()
}

/// Halves of an interval; they share their edge.
fn halves(t: Interval) -> [Interval; 2] {
    let mid = t.mid();
    [Interval::new(t.lo(), mid), Interval::new(mid, t.hi())]
}

/// Two or four equal parts.
fn divide([u, v]: [Interval; 2], halved: [bool; 2]) -> impl Iterator<Item = [Interval; 2]> {
    let cuts = |t: Interval, cut: bool| if cut { halves(t).map(Some) } else { [Some(t), None] };
    let (across, along) = (cuts(u, halved[0]), cuts(v, halved[1]));
    along.into_iter().flatten().flat_map(move |v| across.into_iter().flatten().map(move |u| [u, v]))
}

/// Two halves along the band. Across it, only the undecided part goes on; what lies beyond on one side is lit and booked,
/// on the other hidden.
///
/// The place `x` of `[-1, 1]` is `(lo + hi)/2 + (hi - lo)/2 x` of the range across: enclosed, cut to it. A part from the lower end
/// of one enclosure to the upper end of the other holds all undecided places; both rests are settled all over.
///
/// The halves meet at a float, the middle as it is computed, where the band speaks of `b <= 0` and `b >= 0`. But forms over the cell hold for the symbol too that is
/// 0 at that float and linear on either side of it: [`Affine::spanning`](antumbra_interval::affine::Affine::spanning) has that float as its centre, and gives away more than its distance from the middle.
fn crop(node: &Node<Rest>, band: &Band, ledger: &mut Ledger<Rest>, parts: &mut Vec<Job>) {
    ledger.shaded();
    let (across, along) = (node.part[band.across], halves(node.part[1 - band.across]));
    let point = Interval::point;
    let half = point(0.5);
    let place = |x: f64| {
        let (lo, hi) = (point(across.lo()), point(across.hi()));
        ((lo + hi) * half + (hi - lo) * half * point(x)).intersection(across)
    };
    let oriented = |across: Interval, along: Interval| if band.across == 0 { [across, along] } else { [along, across] };
    for ([from, to], along) in band.undecided.into_iter().zip(along) {
        let (first, last) = (place(from.clamp(-1.0, 1.0)), place(to.clamp(-1.0, 1.0)));
        // Beyond [-1, 1] nothing is left on that side.
        let begin = if from <= -1.0 || first.is_empty() { across.lo() } else { first.lo() };
        let end = if to >= 1.0 || last.is_empty() { across.hi() } else { last.hi() };
        let beyond = |edge: f64| {
            let lit = if band.lit_above { Interval::new(edge, across.hi()) } else { Interval::new(across.lo(), edge) };
            area(oriented(lit, along))
        };
        if from < to && begin < end {
            ledger.lit(beyond(if band.lit_above { end } else { begin }));
            parts.push((oriented(Interval::new(begin, end), along), node.rest.slabs));
            continue;
        }
        // Nothing is undecided. Certainly lit beyond one edge, certainly not before the other.
        let (lit, hidden) = if band.lit_above { (last, first) } else { (first, last) };
        let edge = |x: Interval, up: bool, whole: f64| {
            if x.is_empty() {
                whole
            } else if up {
                x.hi()
            } else {
                x.lo()
            }
        };
        let least = if band.lit_above { edge(lit, true, across.hi()) } else { edge(lit, false, across.lo()) };
        let most = if band.lit_above { edge(hidden, false, across.lo()) } else { edge(hidden, true, across.hi()) };
        let ([lo, _], [_, hi]) = (beyond(least), beyond(most));
        ledger.lit([lo, hi]);
    }
}

#[cfg(test)]
#[allow(clippy::float_arithmetic, reason = "truths to compare with")]
mod tests;
