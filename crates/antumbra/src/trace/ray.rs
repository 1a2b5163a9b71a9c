//! The first roots along rays, certified: many rays in lockstep, so that evaluations come in batches.
use super::crossing::{Contracted, contract};
use super::piece::certainly_continuous;
use super::policy::{Effort, Reach, cut, smaller, tiny};
use super::root::{Goal, Root, signed};
use super::{Bracket, Cost, Piece, Sign, Surface};
use crate::eval::{RayPiece, Workspace};
use crate::geom::{Beam, Passage};
use crate::verdict::Reason;
use antumbra_interval::Interval;
use antumbra_interval::affine::{Affine, Dual};

/// Where a ray first meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// Index of the surface.
    pub surface: usize,
    /// No surface is met before `t.lo()`; a root of this surface lies in `t` if `reason` is none.
    pub t: Interval,
    /// The sign of f just before `t`, where known.
    pub before: Option<Sign>,
    /// Why the root is not proved; `None` if it is.
    pub reason: Option<Reason>,
}

/// A thin beam, and where on it a surface may be met.
#[derive(Clone, Copy, Debug)]
pub struct Ray<'a> {
    /// The ray.
    pub beam: Beam,
    /// Open pieces, ascending per surface.
    pub open: &'a [Piece],
    /// In all of them the ray is inside the region of their surface: proved.
    pub inside: bool,
}

/// Scratch memory of ray searches: keep it, it only grows.
#[derive(Debug, Default)]
pub struct Scratch {
    searches: Vec<Search>,
    active: Vec<usize>,
    pieces: Vec<RayPiece>,
    values: Vec<Dual<1>>,
    ranges: Vec<Interval>,
    points: Vec<RayPiece>,
}

const UNKNOWN: Dual<1> = Dual { value: Affine::UNKNOWN, derivative: Affine::UNKNOWN };

/// What a search does next. Every step but the last asks for one or two evaluations.
#[derive(Clone, Copy, Debug)]
enum Step {
    /// Value and derivative on a piece.
    Look(Interval),
    /// The signs at those ends of a piece of which they are not known, f being monotone on it.
    Ends(Ends),
    /// Value and derivative on an interval that holds the first root.
    Narrow(Root),
    /// The value in its middle: for interval Newton.
    Middle(Root),
    /// Nothing more.
    Done,
}

/// A piece on which f is monotone, its derivative, where in it a root may be, and the signs of f at its ends where known.
#[derive(Clone, Copy, Debug)]
struct Ends {
    t: Interval,
    derivative: Interval,
    found: Option<Contracted>,
    signs: [Option<Sign>; 2],
}

/// A part of a ray that comes next.
#[derive(Clone, Copy, Debug)]
enum Next {
    /// To be looked at.
    Look(Interval),
    /// No root there: a sign of f.
    Free(Sign),
}

/// The search along one ray.
#[derive(Debug)]
struct Search {
    step: Step,
    best: Option<Meeting>,
    cost: Cost,
    /// Of the surface that is looked for: its index, the first of its pieces that follow, where it may be.
    surface: usize,
    next: usize,
    passage: Passage,
    reach: Reach,
    /// Evaluations before this surface.
    begin: u64,
    before: Option<Sign>,
    stack: Vec<Next>,
}

impl Default for Search {
    fn default() -> Self {
        let passage = Passage { outer: Interval::EMPTY, inner: Interval::EMPTY };
        Self {
            step: Step::Done,
            best: None,
            cost: Cost::default(),
            surface: 0,
            next: 0,
            passage,
            reach: Reach::NONE,
            begin: 0,
            before: None,
            stack: Vec::new(),
        }
    }
}

/// The first meeting of each ray with a surface in one of its open pieces, and what it cost; in the order of the rays. `None`
/// proves that there is none.
///
/// The affine form of f along a piece tells where its roots may be, and which sign f has before and behind them: opposite ones
/// prove a root if f is continuous on the piece. Where the roots may be at an end of the piece and the derivative has a proved
/// sign, the signs of f at both ends decide: equal ones exclude a root (f is monotone), opposite ones prove one.
///
/// The first root is then enclosed by new forms on shorter and shorter pieces, each about as narrow as the square of the one
/// before, and where the derivative is nearly constant by interval Newton, which takes half the time:
/// `N = m - f(m) / f'(T)` contains every root in T (mean value theorem).
///
/// The searches do not know of each other: the answer for a ray, and its cost, are the same in any company.
pub fn first_meetings(
    surfaces: &[Surface<'_>],
    rays: &[Ray<'_>],
    effort: Effort,
    scratch: &mut Scratch,
    work: &mut Workspace,
    mut found: impl FnMut(usize, Option<Meeting>, Cost),
) {
    let Scratch { searches, active, pieces, values, ranges, points } = scratch;
    if searches.len() < rays.len() {
        searches.resize_with(rays.len(), Search::default);
    }
    active.clear();
    for (k, ray) in rays.iter().enumerate() {
        searches[k].begin(&Context { surfaces, ray, effort });
        active.push(k);
    }
    loop {
        active.retain(|k| !matches!(searches[*k].step, Step::Done));
        if active.is_empty() {
            break;
        }
        for (surface, of) in surfaces.iter().enumerate() {
            let of_this = |search: &Search| search.surface == surface;
            pieces.clear();
            points.clear();
            for &k in active.iter().filter(|k| of_this(&searches[**k])) {
                let ray = rays[k].beam;
                let mut at = |t: f64| points.push(RayPiece { ray, t: Interval::point(t) });
                match searches[k].step {
                    Step::Look(t) | Step::Narrow(Root { bracket: Bracket { t, .. }, .. }) => {
                        pieces.push(RayPiece { ray, t })
                    }
                    Step::Ends(Ends { t, signs, .. }) => {
                        [t.lo(), t.hi()].into_iter().zip(signs).filter(|(_, s)| s.is_none()).for_each(|(t, _)| at(t));
                    }
                    Step::Middle(root) => at(root.bracket.t.mid()),
                    Step::Done => {}
                }
            }
            values.resize(pieces.len(), UNKNOWN);
            ranges.resize(points.len(), Interval::ENTIRE);
            of.function.rays(pieces, values, work);
            of.function.ranges(points, ranges, work);
            // In the order of the questions. Nothing known where there is no answer, which does not happen.
            let (mut value, mut range) = (values.iter(), ranges.iter());
            let mut value = || value.next().copied().unwrap_or(UNKNOWN);
            let mut range = || range.next().copied().unwrap_or(Interval::ENTIRE);
            for &k in active.iter() {
                let search = &mut searches[k];
                if !of_this(search) {
                    continue;
                }
                let context = Context { surfaces, ray: &rays[k], effort };
                match search.step {
                    Step::Look(t) => search.looked(&context, t, value(), work),
                    Step::Narrow(root) => {
                        let goal = root.narrowed(&value(), search.reach, effort);
                        search.pursue(&context, goal, work);
                    }
                    Step::Ends(mut ends) => {
                        ends.signs = ends.signs.map(|sign| sign.or_else(|| Sign::of(range())));
                        search.met(&context, ends, work);
                    }
                    Step::Middle(root) => search.pursue(&context, root.stepped(range(), effort), work),
                    Step::Done => {}
                }
            }
        }
    }
    for (k, search) in searches[..rays.len()].iter().enumerate() {
        found(k, search.best, search.cost);
    }
}

/// The same for one ray; the cost is added to `cost`.
pub fn first_meeting(
    surfaces: &[Surface<'_>],
    beam: &Beam,
    open: &[Piece],
    effort: Effort,
    scratch: &mut Scratch,
    work: &mut Workspace,
    cost: &mut Cost,
) -> Option<Meeting> {
    let mut meeting = None;
    first_meetings(surfaces, &[Ray { beam: *beam, open, inside: false }], effort, scratch, work, |_, found, spent| {
        meeting = found;
        *cost += spent;
    });
    meeting
}

/// What every step of a search needs.
struct Context<'a> {
    surfaces: &'a [Surface<'a>],
    ray: &'a Ray<'a>,
    effort: Effort,
}

impl Context<'_> {
    /// Whether a surface's function is proved continuous on a piece.
    fn continuous(&self, surface: usize, t: Interval, work: &mut Workspace) -> bool {
        let f = self.surfaces[surface].function;
        f.continuous_everywhere() || certainly_continuous(f, &self.ray.beam.at(t), work)
    }
}

impl Search {
    /// Starts anew.
    fn begin(&mut self, c: &Context<'_>) {
        (self.best, self.cost, self.next) = (None, Cost::default(), 0);
        if self.begin_surface(c) {
            self.go_on(c);
        }
    }

    /// Turns to the next surface that has open pieces, if there is one.
    fn begin_surface(&mut self, c: &Context<'_>) -> bool {
        let Some(first) = c.ray.open.get(self.next) else {
            self.step = Step::Done;
            return false;
        };
        let pieces = &c.ray.open[self.next..];
        let count = pieces.iter().take_while(|p| p.surface == first.surface).count();
        self.next += count;
        self.surface = first.surface;
        self.passage = if c.ray.inside {
            Passage::inside(&pieces[..count])
        } else {
            c.surfaces[first.surface].passage(&c.ray.beam.origin.to_box(), &c.ray.beam.direction)
        };
        self.reach = Reach::of(&c.surfaces[first.surface].clip.bounds(), c.ray.beam.origin);
        (self.begin, self.before) = (self.cost.evaluations, None);
        self.stack.clear();
        self.stack.extend(pieces[..count].iter().rev().map(|p| Next::Look(p.t)));
        true
    }

    /// The next piece to look at, of this surface or of a later one.
    fn go_on(&mut self, c: &Context<'_>) {
        loop {
            // Up to the end of the enclosure of what was found: within it, the order of two surfaces is not known.
            let until = self.best.map_or(f64::INFINITY, |b| b.t.hi());
            let mut found = None;
            while let Some(next) = self.stack.pop() {
                let t = match next {
                    Next::Look(t) => t.intersection(self.passage.outer),
                    Next::Free(sign) => {
                        self.before = Some(sign);
                        continue;
                    }
                };
                if t.is_empty() || t.lo() > until {
                    continue;
                }
                let give_up = |reason| Meeting { surface: self.surface, t, before: self.before, reason: Some(reason) };
                if t.hi() == f64::INFINITY {
                    found = Some(give_up(Reason::Resolution));
                    break;
                }
                if self.cost.evaluations - self.begin > c.effort.evaluations() {
                    found = Some(give_up(Reason::Budget));
                    break;
                }
                self.ask(1, Step::Look(t));
                return;
            }
            self.keep(found);
            if !self.begin_surface(c) {
                return;
            }
        }
    }

    fn ask(&mut self, evaluations: u64, step: Step) {
        self.cost.evaluations += evaluations;
        self.step = step;
    }

    /// Takes what was found on a surface. Two surfaces whose enclosures overlap: the earlier bound wins, and the order is not
    /// proved.
    fn keep(&mut self, found: Option<Meeting>) {
        self.best = match (self.best, found) {
            (Some(a), Some(b)) => {
                let (first, second) = if b.t.lo() < a.t.lo() { (b, a) } else { (a, b) };
                let overlap = first.t.hi() >= second.t.lo();
                Some(if overlap { Meeting { reason: first.reason.or(Some(Reason::Touching)), ..first } } else { first })
            }
            (a, b) => a.or(b),
        };
    }

    /// This surface is done with.
    fn conclude(&mut self, c: &Context<'_>, found: Meeting) {
        self.keep(Some(found));
        if self.begin_surface(c) {
            self.go_on(c);
        }
    }

    fn looked(&mut self, c: &Context<'_>, t: Interval, dual: Dual<1>, work: &mut Workspace) {
        let mut value = dual.value.range();
        if value == Interval::ENTIRE {
            // Affine forms say nothing at the ends of domains; intervals do.
            self.cost.evaluations += 1;
            value = c.surfaces[self.surface].function.range(&c.ray.beam.at(t), work);
        }
        if !value.possibly_zero() {
            self.before = Sign::of(value).or(self.before);
            return self.go_on(c);
        }
        let derivative = signed(dual.derivative.range());
        let found = contract(t, &dual.value);
        let signs = [found.and_then(|c| c.head(t)), found.and_then(|c| c.tail(t))].map(|end| end.map(|(_, sign)| sign));
        let monotone = !derivative.possibly_zero();
        if (monotone || !signs.contains(&None)) && c.continuous(self.surface, t, work) {
            let ends = Ends { t, derivative, found, signs };
            return match signs.iter().filter(|sign| sign.is_none()).count() {
                0 => self.met(c, ends, work),
                questions => self.ask(questions as u64, Step::Ends(ends)),
            };
        }
        self.go_closer(c, t, found, work);
    }

    /// Goes on with a smaller piece, or two.
    fn go_closer(&mut self, c: &Context<'_>, t: Interval, found: Option<Contracted>, work: &mut Workspace) {
        let Some(found) = found.filter(|c| smaller(c.open, t)) else { return self.divide(c, t, work) };
        self.before = found.head(t).map_or(self.before, |(_, sign)| Some(sign));
        self.stack.extend(found.tail(t).map(|(_, sign)| Next::Free(sign)));
        self.stack.push(Next::Look(found.open));
        self.go_on(c);
    }

    fn divide(&mut self, c: &Context<'_>, t: Interval, work: &mut Workspace) {
        if tiny(t, self.reach, c.effort) {
            let reason = if c.continuous(self.surface, t, work) { Reason::Touching } else { Reason::Domain };
            return self.conclude(c, Meeting { surface: self.surface, t, before: self.before, reason: Some(reason) });
        }
        let [near, far] = cut(t);
        self.stack.push(Next::Look(far));
        self.stack.push(Next::Look(near));
        self.go_on(c);
    }

    /// All is known of a piece on which f is continuous, and monotone or with opposite signs before and behind its zeros.
    fn met(&mut self, c: &Context<'_>, Ends { t, derivative, found, signs }: Ends, work: &mut Workspace) {
        match signs {
            [Some(a), Some(b)] if a == b => {
                self.before = Some(b);
                self.go_on(c);
            }
            [Some(before), Some(_)] => {
                let bracket = Bracket { surface: self.surface, t: found.map_or(t, |c| c.open), before };
                self.pursue(c, Root::new(bracket, derivative).enclose(t, c.effort), work);
            }
            _ => self.go_closer(c, t, found, work),
        }
    }

    fn pursue(&mut self, c: &Context<'_>, goal: Goal, work: &mut Workspace) {
        match goal {
            Goal::Narrow(root) => self.ask(1, Step::Narrow(root)),
            Goal::Middle(root) => self.ask(1, Step::Middle(root)),
            Goal::Proved(root) => self.proved(c, root),
            Goal::Unclear(Root { bracket: Bracket { t, before, .. }, .. }) => {
                self.before = Some(before);
                self.divide(c, t, work);
            }
        }
    }

    /// The interval holds the first root. It must lie where the surface exists.
    fn proved(&mut self, c: &Context<'_>, root: Root) {
        let t = root.bracket.t;
        let inside = t.intersection(self.passage.inner) == t;
        let reason = (!inside).then_some(Reason::Resolution);
        self.conclude(c, Meeting { reason, ..root.meeting() });
    }
}
