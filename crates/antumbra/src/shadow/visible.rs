//! The visible fraction of a light from one hit.
use super::desk::Desk;
use super::known::{Known, Part};
use super::ledger::{Ledger, area};
use super::occluders::{Receiver, fronts};
use super::policy::{self, quarters};
use super::rectangle::{self, Answer, Query};
use super::second;
use crate::eval::Workspace;
use crate::geom::{Fan, Rect};
use crate::trace::{Cost, Piece, Surface};
use crate::verdict::Reason;
use antumbra_interval::Interval;
use antumbra_interval::round::sub_up;
use std::ops::Range;
use std::task::{Context, Poll, Waker};

/// The visible fraction lies in `[lo, hi]`: proved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bracket {
    /// Lower bound, at least 0.
    pub lo: f64,
    /// Upper bound, at most 1.
    pub hi: f64,
    /// Why the bracket is wider than was asked for; `None` if it is not.
    pub reason: Option<Reason>,
    /// Whether the first beam, over the whole light, was proved free (the paper's case 1).
    pub first_free: bool,
}

impl Bracket {
    /// All of the light.
    pub const LIT: Self = Self { lo: 1.0, hi: 1.0, reason: None, first_free: true };
}

/// How penumbrae are resolved. Both methods prove what they say; they differ in cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Penumbra {
    /// Planes over short pieces of beams.
    First,
    /// Quadratic models of the least value along each ray, where they apply; else planes.
    Second,
    /// Quadratic models first; where they do not settle a hit with a fair amount of work, planes.
    #[default]
    Auto,
}

impl Penumbra {
    /// Every choice with its name.
    pub const ALL: [(Self, &'static str); 3] = [(Self::First, "first"), (Self::Second, "second"), (Self::Auto, "auto")];

    /// The choice of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|(_, n)| *n == name).map(|(p, _)| p)
    }
}

/// When to stop, and by which method to go on until then.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Width of a bracket that is narrow enough.
    pub width: f64,
    /// Rectangles of a light that one hit may take; evaluations are bounded along with them.
    pub rectangles: u32,
    /// The method.
    pub penumbra: Penumbra,
}

/// Scratch memory of one thread. What hits have taught is kept in it too: [`begin`](Self::begin) each independent set of hits with it, or with a new one.
#[derive(Debug, Default)]
pub struct Scratch {
    pub(super) shafts: super::shafts::Scratch,
    /// Of searches that are done, for others.
    #[expect(clippy::vec_box, reason = "each moves into a search and out again")]
    idle: Vec<Box<Search>>,
    learned: second::Learned,
    claims: Option<Vec<second::Claim>>,
}

/// Scratch memory of one search.
#[derive(Debug, Default)]
struct Search {
    rectangle: rectangle::Scratch,
    second: second::Scratch,
    pieces: Vec<Piece>,
    ledger: Ledger<Range<usize>>,
}

impl Scratch {
    /// Ready for another set of hits: what others have taught is forgotten, the memory stays.
    pub fn begin(&mut self) {
        self.learned = second::Learned::default();
    }

    /// From now on, what the second-order method claims is written down.
    pub fn record_claims(&mut self) {
        self.claims = Some(Vec::new());
    }

    /// What it claimed since the last call, cell by cell. Every claim is a theorem; children repeat their parents.
    pub fn take_claims(&mut self) -> Vec<second::Claim> {
        self.claims.as_mut().map(std::mem::take).unwrap_or_default()
    }
}

/// A hit that asks for a light.
#[derive(Clone, Copy, Debug)]
pub struct Asking<'a> {
    /// The hit.
    pub receiver: &'a Receiver,
    /// The light.
    pub light: &'a Rect,
    /// What is known of it.
    pub known: &'a Known,
}

/// The certified visible fraction of `light` from a hit, given what is known of it (by default [`Known::nothing`]).
///
/// Guarantee: `lo <= V <= hi` for the true hit. Cost: one evaluation settles most hits; in a penumbra some hundred.
#[expect(clippy::too_many_arguments, reason = "the question, then the scratch memory of the thread")]
pub fn visible(
    surfaces: &[Surface<'_>],
    receiver: &Receiver,
    light: &Rect,
    known: &Known,
    tolerance: Tolerance,
    s: &mut Scratch,
    work: &mut Workspace,
    cost: &mut Cost,
) -> Bracket {
    let (bracket, own) = visibles(surfaces, &[Asking { receiver, light, known }], tolerance, s, work)[0];
    *cost += own;
    bracket
}

/// The same for many hits, with what each cost.
///
/// They are looked at in lockstep, some at a time, the next one as soon as one is done, so that evaluations come in batches. What
/// they learn of choices depends on their order alone; what is proved does not depend on it.
pub fn visibles(
    surfaces: &[Surface<'_>],
    hits: &[Asking<'_>],
    tolerance: Tolerance,
    s: &mut Scratch,
    work: &mut Workspace,
) -> Vec<(Bracket, Cost)> {
    let desk = Desk::new(surfaces, work, s.learned);
    let mut out = vec![(Bracket::LIT, Cost::default()); hits.len()];
    let mut coming = hits.iter().enumerate();
    let mut searches = Vec::new();
    let mut context = Context::from_waker(Waker::noop());
    loop {
        while searches.len() < desk.learned().company()
            && let Some((index, hit)) = coming.next()
        {
            if hit.known.settled() {
                let [lo, hi] = hit.known.bounds();
                out[index].0 = Bracket { lo, hi, reason: None, first_free: hit.known.whole() && lo == 1.0 };
                continue;
            }
            let worth = desk.learned().worth(tolerance.penumbra);
            let mut own = s.idle.pop().unwrap_or_default();
            own.second.claims = s.claims.is_some().then(Vec::new);
            searches.push((index, Box::pin(search(&desk, hit, worth, tolerance, own))));
        }
        if searches.is_empty() {
            s.learned = *desk.learned();
            return out;
        }
        searches.retain_mut(|(index, search)| {
            let Poll::Ready(found) = search.as_mut().poll(&mut context) else { return true };
            let Found { bracket, cost, settled, mut own } = found;
            out[*index] = (bracket, cost);
            desk.learned().done(settled);
            if let (Some(all), Some(claims)) = (&mut s.claims, own.second.claims.take()) {
                all.extend(claims);
            }
            s.idle.push(own);
            false
        });
        desk.answer();
    }
}

/// What a search found, and its memory.
struct Found {
    bracket: Bracket,
    cost: Cost,
    /// Whether the second-order method settled it; `None` if that was not tried.
    settled: Option<bool>,
    own: Box<Search>,
}

/// One hit; `worth`: whether the second-order method is.
async fn search(desk: &Desk<'_>, hit: &Asking<'_>, worth: bool, tolerance: Tolerance, mut own: Box<Search>) -> Found {
    let (mut cost, mut settled) = (Cost::default(), None);
    let bracket = bracket(desk, hit, worth, tolerance, &mut own, &mut settled, &mut cost).await;
    Found { bracket, cost, settled, own }
}

async fn bracket(
    desk: &Desk<'_>,
    hit: &Asking<'_>,
    worth: bool,
    tolerance: Tolerance,
    own: &mut Search,
    settled: &mut Option<bool>,
    cost: &mut Cost,
) -> Bracket {
    let Asking { receiver, light, known } = *hit;
    let surfaces = desk.surfaces();
    let unit = Interval::new(-1.0, 1.0);
    let whole = Fan::towards(receiver.point, light, unit, unit);
    let fronts = fronts(surfaces, receiver, &whole, &mut desk.work(), cost);
    let query = Query { surfaces, receiver, fronts: &fronts, light };
    let Search { rectangle, second, pieces: arena, ledger } = own;
    // The second-order method may be tried once.
    let ways = |known: &Known| second::ways(&query, &whole, known, &mut desk.work());
    // A bracket of it.
    let mut other = [0.0, 1.0];
    if worth && let Some(ways) = ways(known) {
        let found = second::fraction(&query, &ways, known, tolerance, second, desk, cost).await;
        *settled = Some(found.narrow(tolerance));
        if found.settles(tolerance) {
            return found.bracket(known, tolerance);
        }
        other = [found.lo, found.hi];
    }
    arena.clear();
    ledger.clear();
    known.book(ledger);
    let (mut rectangles, most) = (0, cost.evaluations + policy::evaluations(tolerance.rectangles));
    let mut parts = Vec::new();
    for Part { part, pieces } in &known.open {
        let begin = arena.len();
        arena.extend_from_slice(pieces);
        parts.push((*part, begin..arena.len()));
    }
    let inherited = arena.len();
    loop {
        for (part, pieces) in parts.drain(..) {
            rectangles += 1;
            let begin = arena.len();
            match query.look(part, pieces, arena, rectangle, &mut desk.work(), cost) {
                Answer::Dark => ledger.shaded(),
                Answer::Lit => ledger.lit(area(part)),
                Answer::Open { lit, open } => ledger.open(part, [lit, open], begin..arena.len()),
            }
        }
        if ledger.unknown() <= tolerance.width || rectangles >= tolerance.rectangles || cost.evaluations >= most {
            break;
        }
        if rectangles == 1 && worth && settled.is_none() {
            // What was too long a beam to be proved continuous may have become short.
            let shorter = known.with_pieces(&arena[inherited..]);
            if let Some(ways) = ways(&shorter) {
                let found = second::fraction(&query, &ways, &shorter, tolerance, second, desk, cost).await;
                *settled = Some(found.narrow(tolerance));
                other = [found.lo, found.hi];
                rectangles += found.cells;
                if found.settles(tolerance) {
                    break;
                }
            }
        }
        let Some(node) = ledger.next() else { break };
        parts.extend(quarters(node.part[0], node.part[1]).map(|part| (part, node.rest.clone())));
    }
    // Both brackets hold, so they meet.
    let [lo, hi] = ledger.bounds();
    let (lo, hi) = (lo.max(other[0]), hi.min(other[1]));
    let reason = (sub_up(hi, lo) > tolerance.width).then_some(Reason::Budget);
    Bracket { lo, hi, reason, first_free: known.whole() && rectangles == 1 && lo == 1.0 }
}
