//! Frusta of the camera: which parts of which rays may meet which surface (certified; second order where rays touch). Many frusta in lockstep, so
//! that evaluations come in batches.
use super::crossing::{Course, Turned, contract};
use super::piece::certainly_continuous;
use super::policy::{FRUSTUM_EVALUATIONS, Reach, Shape, bent, curved, cut, smaller};
use super::{Cost, Piece, Sign, Surface};
use crate::eval::{FanPiece, QuadraticPoint, Workspace};
use crate::geom::{Box3, Fan, Passage};
use antumbra_interval::Interval;
use antumbra_interval::affine::Affine;
use antumbra_interval::quadratic::Quadratic;
use smallvec::{SmallVec, smallvec};

/// What is known of all rays of a frustum. Valid for every part of the frustum.
#[derive(Clone, Debug, PartialEq)]
pub struct Known {
    /// The pieces that are open; outside of them no ray meets a surface before `cover`. Ascending per surface.
    pub open: SmallVec<[Piece; 3]>,
    /// Every ray meets some surface at a parameter up to this one: proved. Infinite if that is not so.
    pub cover: f64,
    /// Per surface: a sign of f, and a parameter before its first open piece at which f has it on all rays, all of them
    /// inside the surface's region; where proved.
    front: SmallVec<[Option<(Sign, f64)>; 2]>,
    /// In their open pieces all rays are inside the surfaces' regions: proved.
    pub inside: bool,
}

/// Says nothing: neither empty nor covered. A place to write to.
impl Default for Known {
    fn default() -> Self {
        let anywhere = Piece { surface: 0, t: Interval::ENTIRE };
        Self { open: smallvec![anywhere], cover: f64::INFINITY, front: SmallVec::new(), inside: false }
    }
}

impl Known {
    /// Nothing is known but where the surfaces are.
    #[must_use]
    pub fn nothing(surfaces: &[Surface<'_>], fan: &Fan) -> Self {
        let directions = fan.directions();
        let open = surfaces.iter().enumerate().filter_map(|(surface, s)| {
            let t = s.passage(&fan.apex, &directions).outer;
            (!t.is_empty()).then_some(Piece { surface, t })
        });
        let front = smallvec![None; surfaces.len()];
        Self { open: open.collect(), cover: f64::INFINITY, front, inside: false }
    }

    /// No ray meets anything: proved.
    #[must_use]
    pub fn certainly_empty(&self) -> bool {
        self.open.is_empty() && self.cover == f64::INFINITY
    }

    /// Every ray meets something: proved.
    #[must_use]
    pub fn certainly_covered(&self) -> bool {
        self.cover < f64::INFINITY
    }
}

/// Appends a piece; neighbours with one edge are one piece.
fn join(open: &mut SmallVec<[Piece; 3]>, first: usize, piece: Piece) {
    match open[first..].last_mut() {
        Some(last) if last.t.hi() == piece.t.lo() => last.t = last.t.hull(piece.t),
        _ => open.push(piece),
    }
}

/// A frustum to look at, and what is known of one that it is a part of.
#[derive(Clone, Copy, Debug)]
pub struct Frustum<'a> {
    /// Its rays.
    pub fan: Fan,
    /// What is known already.
    pub parent: &'a Known,
}

/// Scratch memory for frusta: keep it, it only grows.
#[derive(Debug, Default)]
pub struct Frusta {
    searches: Vec<Search>,
    active: Vec<usize>,
    pieces: Vec<FanPiece>,
    forms: Vec<Affine<3>>,
    points: Vec<QuadraticPoint>,
    quadratics: Vec<Quadratic>,
}

/// What a search asks about a piece.
#[derive(Clone, Copy, Debug)]
enum Asked {
    /// The function as a plane.
    Plane(Interval),
    /// To second order.
    Parabola(Interval),
}

/// A part of the rays of a frustum that comes next.
#[derive(Clone, Copy, Debug)]
enum Next {
    /// To be looked at.
    Look(Interval),
    /// No surface there: a sign of f on all rays.
    Free(Interval, Sign),
}

/// The search in one frustum.
#[derive(Debug)]
struct Search {
    known: Known,
    cost: Cost,
    /// What is asked; `None` when all is done.
    asked: Option<Asked>,
    stack: Vec<Next>,
    shape: Shape,
    directions: Box3,
    /// Of the surface that is looked for: its index, the first of the parent's pieces that follow, where it may be.
    surface: usize,
    next: usize,
    passage: Passage,
    reach: Reach,
    /// The first of its open pieces.
    first_open: usize,
}

/// Looks at frusta and settles as much of their open pieces as pays; what is then known of each, and what it cost, in their
/// order. The `Known` may be taken; what is left in its place does not matter.
///
/// A piece in which the enclosure of f excludes 0 holds no surface (wherever f is undefined there is none either); where it does
/// not, the plane of the affine form cuts off what lies before and behind all zeros, with the signs there; or, where rays touch the surface, a
/// quadratic form does ([`Quadratic::turn`]). If f
/// has one sign on all rays at a parameter inside the surface's region, and the other sign at a later one, still inside,
/// and is continuous in between, then every ray meets the surface in between: what lies behind is of no interest.
///
/// The searches do not know of each other: the answer for a frustum, and its cost, are the same in any company.
pub fn narrow(
    surfaces: &[Surface<'_>],
    jobs: &[Frustum<'_>],
    scratch: &mut Frusta,
    work: &mut Workspace,
    mut found: impl FnMut(usize, &mut Known, Cost),
) {
    let Frusta { searches, active, pieces, forms, points, quadratics } = scratch;
    active.clear();
    for (k, job) in jobs.iter().enumerate() {
        if searches.len() == k {
            searches.push(Search::new(&job.fan));
        }
        searches[k].begin(surfaces, job, work);
        active.push(k);
    }
    loop {
        active.retain(|k| searches[*k].asked.is_some());
        if active.is_empty() {
            break;
        }
        for (surface, of) in surfaces.iter().enumerate() {
            pieces.clear();
            points.clear();
            for &k in active.iter().filter(|k| searches[**k].surface == surface) {
                match searches[k].asked {
                    Some(Asked::Plane(t)) => pieces.push(FanPiece { fan: jobs[k].fan, t }),
                    Some(Asked::Parabola(t)) => {
                        points.push(Course::of(t).points(Affine::symbol(0), &jobs[k].fan));
                    }
                    None => {}
                }
            }
            forms.resize(pieces.len(), Affine::UNKNOWN);
            quadratics.resize(points.len(), Quadratic::UNKNOWN);
            of.function.beams(pieces, forms, work);
            of.function.quadratics(points, quadratics, work);
            // In the order of the questions.
            let (mut planes, mut parabolas) = (forms.iter(), quadratics.iter());
            for &k in active.iter() {
                let search = &mut searches[k];
                if search.surface != surface {
                    continue;
                }
                match search.asked {
                    Some(Asked::Plane(t)) => {
                        let form = planes.next().unwrap_or(&Affine::UNKNOWN);
                        search.looked(surfaces, &jobs[k], t, form, work);
                    }
                    Some(Asked::Parabola(t)) => {
                        let form = parabolas.next().unwrap_or(&Quadratic::UNKNOWN);
                        search.looked_closely(surfaces, &jobs[k], t, form, work);
                    }
                    None => {}
                }
            }
        }
    }
    for (k, search) in searches[..jobs.len()].iter_mut().enumerate() {
        let cover = search.known.cover;
        search.known.open.retain(|p| p.t.lo() < cover);
        found(k, &mut search.known, search.cost);
    }
}

impl Search {
    fn new(fan: &Fan) -> Self {
        let passage = Passage { outer: Interval::EMPTY, inner: Interval::EMPTY };
        Self {
            known: Known::default(),
            cost: Cost::default(),
            asked: None,
            stack: Vec::new(),
            shape: Shape::of(fan),
            directions: fan.directions(),
            surface: 0,
            next: 0,
            passage,
            reach: Reach::NONE,
            first_open: 0,
        }
    }

    fn begin(&mut self, surfaces: &[Surface<'_>], job: &Frustum<'_>, work: &mut Workspace) {
        self.known.open.clear();
        self.known.cover = job.parent.cover;
        self.known.inside = true;
        self.known.front.clear();
        self.known.front.extend_from_slice(&job.parent.front);
        self.cost = Cost { beams: 1, evaluations: 0 };
        (self.shape, self.next) = (Shape::of(&job.fan), 0);
        if !job.parent.inside {
            self.directions = job.fan.directions();
        }
        self.stack.clear();
        self.go_on(surfaces, job, work);
    }

    /// Turns to the next surface that has open pieces, if there is one.
    fn begin_surface(&mut self, surfaces: &[Surface<'_>], job: &Frustum<'_>) -> bool {
        let Some(first) = job.parent.open.get(self.next) else { return false };
        let pieces = &job.parent.open[self.next..];
        let count = pieces.iter().take_while(|p| p.surface == first.surface).count();
        self.next += count;
        self.surface = first.surface;
        self.passage = if job.parent.inside {
            Passage::inside(&pieces[..count])
        } else {
            surfaces[first.surface].passage(&job.fan.apex, &self.directions)
        };
        self.reach = Reach::of(&surfaces[first.surface].clip.bounds(), job.fan.apex.mid());
        self.first_open = self.known.open.len();
        self.stack.clear();
        self.stack.extend(pieces[..count].iter().rev().map(|p| Next::Look(p.t)));
        true
    }

    /// The next piece to look at, of this surface or of a later one.
    fn go_on(&mut self, surfaces: &[Surface<'_>], job: &Frustum<'_>, work: &mut Workspace) {
        loop {
            while let Some(next) = self.stack.pop() {
                let (Next::Look(t) | Next::Free(t, _)) = next;
                let t = t.intersection(self.passage.outer);
                if t.is_empty() || t.lo() >= self.known.cover {
                    continue;
                }
                if let Next::Free(_, sign) = next {
                    self.free(surfaces, job, t, sign, work);
                    continue;
                }
                if t.hi() == f64::INFINITY {
                    // An unbounded region: nothing can be evaluated, nothing is claimed.
                    self.known.open.push(Piece { surface: self.surface, t });
                    self.known.inside = false;
                    continue;
                }
                if self.cost.evaluations > FRUSTUM_EVALUATIONS {
                    // The work of one frustum is spent: the rest stays open.
                    self.keep_open(t);
                    continue;
                }
                return self.ask(Asked::Plane(t));
            }
            if !self.begin_surface(surfaces, job) {
                self.asked = None;
                return;
            }
        }
    }

    fn ask(&mut self, question: Asked) {
        self.cost.evaluations += 1;
        self.asked = Some(question);
    }

    fn keep_open(&mut self, t: Interval) {
        self.known.inside &= t.is_subset_of(self.passage.inner);
        join(&mut self.known.open, self.first_open, Piece { surface: self.surface, t });
    }

    fn looked(
        &mut self,
        surfaces: &[Surface<'_>],
        job: &Frustum<'_>,
        t: Interval,
        form: &Affine<3>,
        work: &mut Workspace,
    ) {
        let mut range = form.range();
        if range == Interval::ENTIRE {
            // Affine forms say nothing at the ends of domains; intervals do.
            self.cost.evaluations += 1;
            range = surfaces[self.surface].function.range(&job.fan.box_at(t), work);
        }
        if !range.possibly_zero() {
            if let Some(sign) = Sign::of(range) {
                self.free(surfaces, job, t, sign, work);
            }
        } else if let Some(found) = contract(t, form).filter(|c| smaller(c.open, t)) {
            self.stack.extend(found.tail(t).map(|(t, sign)| Next::Free(t, sign)));
            let again = curved(form) && self.reach.resolves(found.open);
            if again {
                self.stack.push(Next::Look(found.open));
            }
            if let Some((t, sign)) = found.head(t) {
                self.free(surfaces, job, t, sign, work);
            }
            if !again {
                self.keep_open(found.open);
            }
        } else if curved(form) && self.shape.long(t, self.reach) {
            if self.shape.very_long(t) {
                return self.ask(Asked::Parabola(t));
            }
            self.halve(t);
        } else {
            self.keep_open(t);
        }
        self.go_on(surfaces, job, work);
    }

    fn halve(&mut self, t: Interval) {
        let [near, far] = cut(t);
        self.stack.push(Next::Look(far));
        self.stack.push(Next::Look(near));
    }

    /// A piece that is long for the frustum's width, on which the plane is no good: rays may touch the surface there.
    fn looked_closely(
        &mut self,
        surfaces: &[Surface<'_>],
        job: &Frustum<'_>,
        t: Interval,
        form: &Quadratic,
        work: &mut Workspace,
    ) {
        let [positive, negative] = [*form, -*form].map(|form| form.eliminate());
        let turned = form.turn().map(|turn| Turned::of(t, turn));
        let free = match turned {
            _ if positive.certainly_positive() => Some(Sign::Positive),
            _ if negative.certainly_positive() => Some(Sign::Negative),
            Some(turned) if turned.open.is_empty() => Some(turned.sign),
            _ => None,
        };
        if let Some(sign) = free {
            self.free(surfaces, job, t, sign, work);
        } else if let Some(Turned { open, sign }) = turned.filter(|found| smaller(found.open, t)) {
            if open.hi() < t.hi() {
                self.stack.push(Next::Free(Interval::new(open.hi(), t.hi()), sign));
            }
            self.stack.push(Next::Look(open));
            if t.lo() < open.lo() {
                self.free(surfaces, job, Interval::new(t.lo(), open.lo()), sign, work);
            }
        } else {
            // Every ray has the other sign somewhere in the piece than in front of it.
            let covered = |front: Sign| match front {
                Sign::Positive => positive.certainly_negative_somewhere(),
                Sign::Negative => negative.certainly_negative_somewhere(),
            };
            if let Some((front, at)) = self.known.front[self.surface]
                && covered(front)
                && at <= t.lo()
                && t.is_subset_of(self.passage.inner)
                && self.continuous(surfaces, job, Interval::new(at, t.hi()), work)
            {
                self.known.cover = self.known.cover.min(t.hi());
                self.stack.clear();
                self.keep_open(t);
            } else if bent(form) {
                self.halve(t);
            } else {
                self.keep_open(t);
            }
        }
        self.go_on(surfaces, job, work);
    }

    /// Whether the function of this surface is proved continuous on all rays at parameters in `t`.
    fn continuous(&self, surfaces: &[Surface<'_>], job: &Frustum<'_>, t: Interval, work: &mut Workspace) -> bool {
        let function = surfaces[self.surface].function;
        function.continuous_everywhere() || certainly_continuous(function, &job.fan.box_at(t), work)
    }

    /// No ray meets the surface at a parameter in `t`: f has one sign there, where it is defined.
    fn free(&mut self, surfaces: &[Surface<'_>], job: &Frustum<'_>, t: Interval, sign: Sign, work: &mut Workspace) {
        let surface = self.surface;
        // Only parameters at which all rays are inside the region can prove a meeting.
        let inside = t.intersection(self.passage.inner);
        if inside.is_empty() {
            return;
        }
        if self.known.open.len() == self.first_open {
            self.known.front[surface] = Some((sign, inside.hi()));
        } else if let Some((front, at)) = self.known.front[surface]
            && front != sign
            && at <= inside.lo()
            && self.continuous(surfaces, job, Interval::new(at, inside.lo()), work)
        {
            self.known.cover = self.known.cover.min(inside.lo());
            // What lies behind is of no interest.
            self.stack.clear();
        }
    }
}
