//! One rectangle of a light, seen from one hit, to second order.
use super::policy::{self, Plan, TRIES, Trial, between};
use super::slab::{Cell, Kind, Slab, State, merged};
use crate::eval::Workspace;
use crate::geom::strips::{self, Areas, Curve, areas};
use crate::trace::Cost;
use antumbra_interval::quadratic::{Eliminated, Quadratic};
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
}

/// Scratch memory.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    stack: Vec<Slab>,
    constraints: Vec<Constraint>,
    curves: Vec<Curve>,
    areas: strips::Scratch,
    /// Of long and of short slabs.
    trials: [Trial; 2],
    /// Evaluations before this cell.
    before: u64,
}

impl Scratch {
    /// Another hit: what was learnt of the last one is forgotten, so that results do not depend on the order of hits.
    pub(super) fn forget(&mut self) {
        self.trials = Default::default();
    }

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
pub(super) fn look(
    cell: &Cell<'_>,
    slabs: Range<usize>,
    enough: f64,
    open: &mut Vec<Slab>,
    s: &mut Scratch,
    work: &mut Workspace,
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
        let settled = if slab.state != State::Outer && !cell.shape.short(cell.extent(&slab)) {
            narrow(cell, &slab, open, s, work, cost)
        } else {
            plain(cell, &slab, open, s, work, cost)
        };
        if let Settled::DarkCell = settled {
            open.truncate(begin);
            return Answer::Dark;
        }
    }
    if open.len() == begin {
        return Answer::Lit;
    }
    join(cell, open, begin);
    s.curves.clear();
    s.curves.extend(s.constraints.iter().map(|c| c.curve));
    Answer::Open(areas(&s.curves, enough, &mut s.areas))
}

/// A slab beside the least value, or a short one: free, dominated, hiding, to be cut, or open.
fn plain(
    cell: &Cell<'_>,
    slab: &Slab,
    open: &mut Vec<Slab>,
    s: &mut Scratch,
    work: &mut Workspace,
    cost: &mut Cost,
) -> Settled {
    let extent = cell.extent(slab);
    if slab.state == State::Outer && extent.lo > Trial::NEAREST {
        let trial = &mut s.trials[usize::from(cell.shape.short(extent))];
        if trial.worth() {
            let free = cell.certainly_free(slab, work, cost);
            trial.tell(free);
            if free {
                return Settled::Slab;
            }
        }
    }
    let kind = cell.kind(slab);
    let form = cell.form(slab, kind, work, cost);
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
    open.push(Slab { state: State::Open, ..*slab });
    s.constraints.push(constraint(&least, hides, kind, extent.middle()));
    Settled::Slab
}

/// A long slab: finds the least value, and looks at a thin slab around it.
///
/// The slab is covered by an outer slab below, a core, and an outer slab above, which share their sheets: so every parameter
/// is in one of them, wherever the sheets are.
///
/// **Lemma (core).** Let the function be convex in t in the core, on every ray of the cell, and let the main slab
/// `[m_0, m_1]`, `m_0 <= m_1`, lie in the core. Let there be on every ray a parameter `t_U` of the main slab with a value at
/// most `U + e`. If at an end that is not the core's the value is above `U + e`, then on every ray all values of the core
/// beyond that end are above it too (a convex function that has risen from `t_U` to the end goes on rising). So the least
/// value over the core is that over the main slab, and if it is positive the core is free.
fn narrow(
    cell: &Cell<'_>,
    slab: &Slab,
    open: &mut Vec<Slab>,
    s: &mut Scratch,
    work: &mut Workspace,
    cost: &mut Cost,
) -> Settled {
    let part = cell.part;
    let searched = match slab.state {
        State::Convex(kind) => kind,
        _ => cell.kind(slab),
    };
    let mut plan = cell.shape.plan(&slab.lo, &slab.hi, |at, t| cell.about(slab.surface, searched, at, t, work));
    if !plan.sheet(1.0).is_finite() {
        return plain(cell, &Slab { state: State::Outer, ..*slab }, open, s, work, cost);
    }
    // A range that is proved convex is never enlarged: its own sheets stay.
    let core = match slab.state {
        State::Convex(_) => *slab,
        _ => {
            let (below, above) = (slab.lo.below(plan.slopes(), part), slab.hi.above(plan.slopes(), part));
            let [lo, hi] = plan.core();
            let cut_lo = cell.shape.above(&lo, &below, plan.width);
            let cut_hi = cell.shape.above(&above, &hi, plan.width);
            let (lo, hi) = (if cut_lo { lo } else { below }, if cut_hi { hi } else { above });
            if cut_hi {
                s.stack.push(Slab { lo: hi, hi: above, state: State::Outer, ..*slab });
            }
            if cut_lo {
                s.stack.push(Slab { lo: below, hi: lo, state: State::Outer, ..*slab });
            }
            Slab { lo, hi, ..*slab }
        }
    };
    let convex = match slab.state {
        State::Convex(kind) => Some(kind),
        _ => {
            let kind = cell.kind(&core);
            cell.certainly_convex(&core, kind, work, cost).then_some(kind)
        }
    };
    if let Some(kind) = convex {
        for _ in 0..TRIES {
            let (main, [cut_lo, cut_hi]) = main_slab(cell, &core, &plan);
            let ordered = !(cut_lo || cut_hi) || main.lo.certainly_at_most(&main.hi, part);
            let form = cell.form(&main, kind, work, cost);
            let least = form.eliminate();
            let hides = cell.inside(&main);
            if hides && least.certainly_negative_somewhere() {
                return Settled::DarkCell;
            }
            let rises = |cut: bool, s: f64| !cut || rises_beyond(&form, &least, s);
            if ordered && rises(cut_lo, -1.0) && rises(cut_hi, 1.0) {
                if !least.certainly_positive() {
                    open.push(Slab { state: State::Convex(kind), ..core });
                    s.constraints.push(constraint(&least, hides, kind, cell.extent(&main).middle()));
                }
                return Settled::Slab;
            }
            if !plan.thicker(&form) {
                break;
            }
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

/// Whether on every ray the function at the end `s` of the slab is above its upper bound `U + e` inside:
/// `Q(s) - e > U + e`, with the error of the bound, which is at least that of the form.
fn rises_beyond(form: &Quadratic, least: &Eliminated, s: f64) -> bool {
    let twice = antumbra_interval::round::add_up(least.error, least.error);
    form.rise_at(s, &least.upper) > twice
}

/// Whether a slab that hides on some ray lies beside another that hides there too: `g >= k U + k e > k g'(t_U)` wherever
/// `min(Q - k U) > e + k e`, so `g <= 0` implies `g'(t_U) < 0`. Then the other one is enough.
fn dominated(form: &Quadratic, kind: Kind, constraints: &[Constraint]) -> bool {
    constraints.iter().filter(|c| c.curve.hides).any(|c| {
        let factor = policy::factor(c.kind, kind, c.t);
        form.minus(factor, &c.curve.upper, c.curve.error).eliminate().certainly_positive()
    })
}

fn constraint(least: &Eliminated, hides: bool, kind: Kind, t: f64) -> Constraint {
    let curve = Curve { lower: least.lower, upper: least.upper, error: least.error, hides };
    Constraint { curve, kind, t }
}

/// Joins open slabs of one surface that touch: a larger slab keeps the invariant, and there are fewer.
fn join(cell: &Cell<'_>, open: &mut Vec<Slab>, begin: usize) {
    let shape = &cell.shape;
    open[begin..].sort_by(|a, b| {
        let order = shape.place(&a.lo).total_cmp(&shape.place(&b.lo));
        a.surface.cmp(&b.surface).then(order)
    });
    let mut last = begin;
    for k in begin + 1..open.len() {
        let (slab, before) = (open[k], open[last]);
        let joint = merged(&before, &slab, cell.part);
        let touch = slab.surface == before.surface && shape.touch(&before.hi, &slab.lo, &slab.hi);
        if touch && joint.lo.is_finite() && joint.hi.is_finite() {
            open[last] = joint;
        } else {
            last += 1;
            open[last] = slab;
        }
    }
    open.truncate(last + 1);
}
