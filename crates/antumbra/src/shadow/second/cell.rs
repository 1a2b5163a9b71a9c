//! One rectangle of a light, seen from one hit, to second order.
use super::policy::{self, CORES, Nearest, Plan, Trial, between};
use super::slab::{Cell, Convexity, Kind, Looker, Slab, State, merged};
use crate::geom::Sheet;
use crate::geom::strips::{self, Areas, Curve, areas};
use crate::shadow::desk::Desk;
use crate::trace::Cost;
use antumbra_interval::Interval;
use antumbra_interval::quadratic::{Eliminated, Quadratic};
use antumbra_interval::round::{div_up, mul_down, mul_up};
use std::ops::Range;

/// What is known of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Answer {
    Lit,
    Dark,
    Open(Areas),
}

/// What one slab that stays open says.
#[derive(Clone, Copy, Debug)]
struct Constraint {
    curve: Curve,
    kind: Kind,
    /// About its place.
    t: f64,
    /// Its slab has its sheets in order on all rays, hence the curve runs in it: only then may others be dropped for it, as what is inherited is
    /// the slab.
    ordered: bool,
}

/// Scratch memory.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    stack: Vec<Slab>,
    constraints: Vec<Constraint>,
    curves: Vec<Curve>,
    areas: strips::Scratch,
    /// Evaluations before this cell.
    before: u64,
}

impl Scratch {
    /// What the last open cell said.
    pub(super) fn curves(&self) -> &[Curve] {
        &self.curves
    }
}

/// A slab is settled, or the whole cell.
enum Settled {
    Slab,
    DarkCell,
}

/// Looks at a cell in the given slabs; appends those that stay open.
///
/// **Invariant.** On every ray of the cell that is hidden, the function of some open slab is `<= 0` somewhere in it. The slabs
/// given have it; every step below keeps it.
pub(super) async fn look(
    cell: &Cell<'_>,
    slabs: Range<usize>,
    enough: f64,
    open: &mut Vec<Slab>,
    s: &mut Scratch,
    desk: &Desk<'_>,
    cost: &mut Cost,
) -> Answer {
    cost.beams += 1;
    s.before = cost.evaluations;
    s.constraints.clear();
    s.stack.clear();
    s.stack.extend(open[slabs].iter().rev());
    let begin = open.len();
    while let Some(slab) = s.stack.pop() {
        let Some(slab) = cell.clipped(&slab) else { continue };
        let search = match slab.state {
            State::Outer => false,
            State::Open => !cell.shape.short(cell.extent(&slab)),
            State::Convex(_) => true,
        };
        let settled = if search {
            narrow(cell, &slab, open, s, desk, cost).await
        } else {
            plain(cell, &slab, open, s, desk, cost).await
        };
        if let Settled::DarkCell = settled {
            open.truncate(begin);
            return Answer::Dark;
        }
    }
    if open.len() == begin {
        return Answer::Lit;
    }
    drop_implied(&mut s.constraints, open, begin);
    join(cell, open, begin);
    s.curves.clear();
    s.curves.extend(s.constraints.iter().map(|c| c.curve));
    Answer::Open(areas(&s.curves, enough, &mut s.areas))
}

/// A slab beside the least value, or a short one: free, dominated, hiding, to be cut, or open.
async fn plain(
    cell: &Cell<'_>,
    slab: &Slab,
    open: &mut Vec<Slab>,
    s: &mut Scratch,
    desk: &Desk<'_>,
    cost: &mut Cost,
) -> Settled {
    let extent = cell.extent(slab);
    if slab.state == State::Outer && extent.lo > Trial::NEAREST {
        let which = usize::from(cell.shape.short(extent));
        if desk.learned().trials[which].worth() {
            let free = cell.certainly_free(slab, &mut desk.work(), cost);
            desk.learned().trials[which].tell(free);
            if free {
                return Settled::Slab;
            }
        }
    }
    let kind = cell.kind(slab);
    let form = cell.form(slab, kind, desk, cost).await;
    let least = form.eliminate();
    if least.certainly_positive() || dominated(&form, kind, &s.constraints) {
        return Settled::Slab;
    }
    let hides = cell.inside(slab);
    if hides && least.certainly_negative_somewhere() {
        return Settled::DarkCell;
    }
    if cell.shape.long(extent, cost.evaluations - s.before) {
        let middle = between(&slab.lo, &slab.hi);
        if middle.is_finite() {
            // All parameters of the slab are in one of both halves, whatever sheet divides them.
            let near = Slab { hi: middle, state: State::Outer, ..*slab };
            let far = Slab { lo: middle, state: State::Outer, ..*slab };
            let falls = form.linear()[0] < 0.0;
            s.stack.extend(if falls { [near, far] } else { [far, near] });
            return Settled::Slab;
        }
    }
    open.push(*slab);
    s.constraints.push(constraint(
        &least,
        hides,
        kind,
        extent.middle(),
        slab.lo.certainly_at_most(&slab.hi, cell.part),
    ));
    Settled::Slab
}

/// A long slab: finds the least value along each ray.
///
/// The slab is covered by an outer slab below, a core, and an outer slab above, which share their sheets: so every parameter
/// is in one of them, wherever the sheets are. If the function is proved convex in the core, one sheet of it bounds the
/// least value.
async fn narrow(
    cell: &Cell<'_>,
    slab: &Slab,
    open: &mut Vec<Slab>,
    s: &mut Scratch,
    desk: &Desk<'_>,
    cost: &mut Cost,
) -> Settled {
    let part = cell.part;
    let (searched, start) = match slab.state {
        State::Convex(known) => (known.kind, Some(known.least_at)),
        _ => (cell.kind(slab), None),
    };
    let about = Looker { cell, surface: slab.surface, kind: searched, desk };
    let plan = cell.shape.plan(&slab.lo, &slab.hi, start.as_ref(), &about).await;
    if !plan.sheet(1.0).is_finite() {
        return plain(cell, &Slab { state: State::Outer, ..*slab }, open, s, desk, cost).await;
    }
    let least_at = plan.least_at;
    let (core, convex) = match slab.state {
        // A range that is proved convex is never enlarged: its own sheets stay.
        State::Convex(known) => (*slab, Some(Convexity { least_at, ..known })),
        _ => {
            let whole =
                Slab { lo: slab.lo.below(plan.slopes(), part), hi: slab.hi.above(plan.slopes(), part), ..*slab };
            let (core, bend) = core(cell, slab, &whole, &plan, desk, cost).await;
            if core != *slab && core.hi != whole.hi {
                s.stack.push(Slab { lo: core.hi, hi: whole.hi, state: State::Outer, ..*slab });
            }
            if core != *slab && core.lo != whole.lo {
                s.stack.push(Slab { lo: whole.lo, hi: core.lo, state: State::Outer, ..*slab });
            }
            (core, bend.map(|(kind, bend)| Convexity { kind, bend, least_at }))
        }
    };
    if let Some(convex) = convex {
        let (level, reach) = level(cell, &core, &plan);
        let least = cell.form(&level, convex.kind, desk, cost).await.eliminate();
        let hides = cell.inside(&level);
        if hides && least.certainly_negative_somewhere() {
            return Settled::DarkCell;
        }
        let fall = fall(cell.slope(&level, convex.kind, desk, cost).await, convex.bend, reach);
        if fall.is_finite() {
            let least = least.lowered(fall);
            if !least.certainly_positive() {
                let (kept, t) = (Slab { state: State::Convex(convex), ..core }, cell.extent(&level).middle());
                open.push(kept);
                let ordered = kept.lo.certainly_at_most(&kept.hi, part);
                s.constraints.push(constraint(&least, hides, convex.kind, t, ordered));
            }
            return Settled::Slab;
        }
    }
    // The core in up to three parts, which share their sheets.
    let (main, [cut_lo, cut_hi]) = main_slab(cell, &core, &plan);
    if cut_hi {
        s.stack.push(Slab { lo: main.hi, hi: core.hi, state: State::Outer, ..*slab });
    }
    if cut_lo {
        s.stack.push(Slab { lo: core.lo, hi: main.lo, state: State::Outer, ..*slab });
    }
    s.stack.push(Slab { state: State::Outer, ..main });
    Settled::Slab
}

/// The widest part around the expected least value that is proved convex enough, with a lower bound of `g''/2` there; else the
/// narrowest one that was tried. It is the slab itself, or its ends are those of its parallel cover `whole` or between them.
async fn core(
    cell: &Cell<'_>,
    slab: &Slab,
    whole: &Slab,
    plan: &Plan,
    desk: &Desk<'_>,
    cost: &mut Cost,
) -> (Slab, Option<(Kind, f64)>) {
    let mut last = None;
    for (k, size) in CORES.into_iter().enumerate() {
        let part = match size {
            None => *slab,
            Some(size) => {
                let [lo, hi] = plan.around_by(size);
                let cut_lo = cell.shape.above(&lo, &whole.lo, plan.width);
                let cut_hi = cell.shape.above(&whole.hi, &hi, plan.width);
                let (lo, hi) = (if cut_lo { lo } else { whole.lo }, if cut_hi { hi } else { whole.hi });
                Slab { lo, hi, ..*whole }
            }
        };
        if last.is_some_and(|(before, _)| before == part) || (k + 1 < CORES.len() && !desk.learned().cores[k].worth()) {
            continue;
        }
        let kind = cell.kind(&part);
        let bend = cell.bend(&part, kind, desk, cost).await;
        let enough = bend.is_some_and(|bend| plan.bends_enough(bend));
        desk.learned().cores[k].tell(enough);
        last = Some((part, bend.map(|bend| (kind, bend))));
        if enough {
            break;
        }
    }
    last.unwrap_or((*slab, None))
}

/// The sheet of a core nearest to the expected place of the least value, proved to lie in the core on all rays of the cell; and
/// bounds of how far the core reaches below and above it.
///
/// Where values fall until the rays leave the region, the last sheet that is inside of it: beyond, nothing hides.
pub(super) fn level(cell: &Cell<'_>, core: &Slab, plan: &Plan) -> (Slab, [f64; 2]) {
    let part = cell.part;
    let expected = plan.least_at;
    let in_core = |sheet: &&Sheet| core.lo.certainly_at_most(sheet, part) && sheet.certainly_at_most(&core.hi, part);
    let sheet = match cell.shape.nearest(&core.lo, &expected, &core.hi, plan.margin()) {
        Nearest::Middle if in_core(&&expected) => expected,
        Nearest::Middle => {
            // It crosses an end of the core somewhere: one that is parallel to that end does not.
            let end = if cell.shape.nearer_to_lower(&core.lo, &expected, &core.hi) { core.lo } else { core.hi };
            Some(cell.shape.through(&end, &expected)).filter(|sheet| in_core(&sheet)).unwrap_or(end)
        }
        Nearest::Lower => core.lo,
        _ => *cell.last_inside(core.surface).filter(in_core).unwrap_or(&core.hi),
    };
    // The core is all that lies between its sheets, whichever is the lower one.
    let (under, over) = (sheet.minus(&core.lo, part), core.hi.minus(&sheet, part));
    let below = under.hi().max((-over).hi()).max(0.0);
    let above = over.hi().max((-under).hi()).max(0.0);
    (Slab { lo: sheet, hi: sheet, state: State::Outer, ..*core }, [below, above])
}

/// How far below its value on a sheet the least value over a convex slab may lie, which reaches so far below and above it.
///
/// **Lemma (sheet).** Let `g''/2 >= m >= 0` in the slab, and `t_0` in it. With `d = g'(t_0)` and `x = t - t_0`, Taylor's
/// formula gives `g(t) >= g(t_0) + d x + m x^2`. That is at least `g(t_0)` where `d x >= 0`; elsewhere at least
/// `g(t_0) - d^2/(4m)`, and at least `g(t_0) - |d| |x|`.
pub(super) fn fall(slope: Interval, bend: f64, [below, above]: [f64; 2]) -> f64 {
    let one_side = |steepness: f64, reach: f64| {
        if steepness <= 0.0 || reach <= 0.0 {
            return 0.0;
        }
        let (four, line) = (mul_down(4.0, bend), mul_up(steepness, reach));
        let parabola = if four > 0.0 { div_up(mul_up(steepness, steepness), four) } else { f64::INFINITY };
        parabola.min(line)
    };
    one_side(slope.hi(), below).max(one_side((-slope).hi(), above))
}

/// The main slab, and which of its ends are not the core's: only sheets proved to lie inside of the core are ends of it.
fn main_slab(cell: &Cell<'_>, core: &Slab, plan: &Plan) -> (Slab, [bool; 2]) {
    let (lo, hi) = (plan.sheet(-1.0), plan.sheet(1.0));
    let inside = |cut: &_| core.lo.certainly_at_most(cut, cell.part) && cut.certainly_at_most(&core.hi, cell.part);
    let margin = plan.margin();
    let cut_lo = cell.shape.above(&lo, &core.lo, margin) && inside(&lo);
    let cut_hi = cell.shape.above(&core.hi, &hi, margin) && inside(&hi);
    let (lo, hi) = (if cut_lo { lo } else { core.lo }, if cut_hi { hi } else { core.hi });
    (Slab { lo, hi, state: State::Outer, ..*core }, [cut_lo, cut_hi])
}

/// Whether a slab that hides on some ray lies beside another that hides there too: `g >= k U + k e > k g'(t_U)` wherever
/// `min(Q - k U) > e + k e`, so `g <= 0` implies `g'(t_U) < 0`. Then the other one is enough.
fn dominated(form: &Quadratic, kind: Kind, constraints: &[Constraint]) -> bool {
    constraints.iter().filter(|c| c.curve.hides && c.ordered).any(|c| {
        let factor = policy::factor(c.kind, kind, c.t);
        form.minus(factor, &c.curve.upper, c.curve.error).eliminate().certainly_positive()
    })
}

/// Whether one slab hides wherever another one may hide.
///
/// Let `L - k U > d + k e` all over the cell, k > 0, with the lower curve L of that other slab, its error d, and the upper curve U of the
/// first one, which hides where `U < -e`. Where the other one may hide, `L <= d`, so `U < -e`.
pub(super) fn implies(first: &Curve, other: &Curve) -> bool {
    let ([la, lb], [aa, bb, ab]) = (other.lower.l, other.lower.q);
    let lower = Quadratic::polynomial(other.lower.c, [0.0, la, lb], [0.0, aa, bb, 0.0, 0.0, ab], other.error);
    let factor = policy::steepness_ratio(other, first);
    first.hides && lower.minus(factor, &first.upper, first.error).range().certainly_positive()
}

/// Drops slabs that hide nothing but what another one hides (constraints and slabs come in the same order): of curves that run side by
/// side one is left, along which the cell can be cropped.
fn drop_implied(constraints: &mut Vec<Constraint>, open: &mut Vec<Slab>, begin: usize) {
    let mut k = 0;
    while k < constraints.len() {
        let this = &constraints[k].curve;
        if constraints.iter().enumerate().any(|(other, by)| other != k && by.ordered && implies(&by.curve, this)) {
            constraints.remove(k);
            open.remove(begin + k);
        } else {
            k += 1;
        }
    }
}

fn constraint(least: &Eliminated, hides: bool, kind: Kind, t: f64, ordered: bool) -> Constraint {
    let curve = Curve { lower: least.lower, upper: least.upper, error: least.error, hides };
    Constraint { curve, kind, t, ordered }
}

/// Joins open slabs of one surface that touch: a larger slab keeps the invariant, and there are fewer. Convex ones stay as they
/// are; beside them nothing is worth a search.
fn join(cell: &Cell<'_>, open: &mut Vec<Slab>, begin: usize) {
    let shape = &cell.shape;
    open[begin..].sort_by(|a, b| {
        let order = shape.place(&a.lo).total_cmp(&shape.place(&b.lo));
        a.surface.cmp(&b.surface).then(order)
    });
    let convex = |slab: &Slab| matches!(slab.state, State::Convex(_));
    let mut last = begin;
    for k in begin + 1..open.len() {
        let (slab, before) = (open[k], open[last]);
        let joint = merged(&before, &slab, cell.part);
        let touch = slab.surface == before.surface && shape.touch(&before.hi, &slab.lo, &slab.hi);
        if touch && !convex(&slab) && !convex(&before) && joint.lo.is_finite() && joint.hi.is_finite() {
            open[last] = joint;
        } else {
            last += 1;
            open[last] = slab;
        }
    }
    open.truncate(last + 1);
    for k in begin..open.len() {
        let beside = |o: &Slab| o.surface == open[k].surface && convex(o);
        if !convex(&open[k]) && !open[begin..].iter().any(beside) {
            open[k].state = State::Open;
        }
    }
}
