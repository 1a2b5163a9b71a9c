//! One rectangle of a light, seen from one hit.
use super::occluders::{Front, Receiver, hides, no_zero};
use super::policy::{halves, long, size, slope_pays};
use crate::eval::Workspace;
use crate::geom::halfplanes::{self, HalfPlane, shares};
use crate::geom::{Fan, Passage, Rect};
use crate::trace::{Cost, Piece, Sign, Surface};
use antumbra_interval::Interval;
use antumbra_interval::round::{add_up, sub_down, sub_up};

/// What is known of a rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Answer {
    /// All of it is visible.
    Lit,
    /// None of it is.
    Dark,
    /// Bounds of the visible share of the rectangle.
    Open {
        /// At least this share is.
        lit: f64,
        /// At most this share is.
        open: f64,
    },
}

/// Scratch memory.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    stack: Vec<Piece>,
    /// One per surface.
    passages: Vec<Passage>,
    planes: Vec<HalfPlane>,
    areas: halfplanes::Scratch,
}

/// The light, the hit and everything around them.
pub(super) struct Query<'a> {
    pub(super) surfaces: &'a [Surface<'a>],
    pub(super) receiver: &'a Receiver,
    pub(super) fronts: &'a [Option<Front>],
    pub(super) light: &'a Rect,
}

/// A form over a piece, seen from the front's side: `bottom` is its centre minus the change along t.
struct Form {
    bottom: f64,
    error: f64,
    u: f64,
    v: f64,
    /// Parameter at which the form is lowest.
    lowest_at: f64,
    /// The lower half is the nearer one.
    falls: bool,
}

impl Query<'_> {
    /// Looks at the part `u x v` of the light, in the given open pieces; appends those that stay open to `open`.
    pub(super) fn look(
        &self,
        [u, v]: [Interval; 2],
        pieces: std::ops::Range<usize>,
        open: &mut Vec<Piece>,
        s: &mut Scratch,
        work: &mut Workspace,
        cost: &mut Cost,
    ) -> Answer {
        cost.beams += 1;
        let fan = Fan::towards(self.receiver.point, self.light, u, v);
        let directions = fan.directions();
        let distance = (0..3).map(|k| directions[k].magnitude()).fold(0.0, f64::max);
        let (width, root) = (size(self.light, u, v), u.width() >= 2.0);
        s.passages.clear();
        s.passages.extend(self.surfaces.iter().map(|at| at.passage(&fan.apex, &directions)));
        s.planes.clear();
        s.stack.clear();
        s.stack.extend(open[pieces].iter().rev());
        let begin = open.len();
        while let Some(Piece { surface, t }) = s.stack.pop() {
            let at = &self.surfaces[surface];
            let passage = s.passages[surface];
            // Beyond the region, and beyond the light, nothing occludes.
            let t = t.intersection(passage.outer);
            if t.is_empty() {
                continue;
            }
            let front = self.fronts[surface];
            cost.evaluations += 1;
            let own = surface == self.receiver.surface;
            let form = if own && slope_pays(t) {
                at.function.beam_slope(fan.slopes_at(t), work)
            } else {
                at.function.beam(fan.at(t), work)
            };
            if form.range() == Interval::ENTIRE && no_zero(at.function, &fan.box_at(t), work, cost) {
                continue;
            }
            let (range, form) = if front.is_some_and(|f| f.sign == Sign::Negative) {
                (-form.range(), -form)
            } else {
                (form.range(), form)
            };
            if range.certainly_positive() {
                continue;
            }
            let form = lowest(&form, t);
            // Upper bound of the form, at its lowest parameter, over the rectangle.
            let across = add_up(form.u.abs(), form.v.abs());
            let top = add_up(add_up(form.bottom, across), form.error);
            let region = |t| fan.box_at(t);
            if top < 0.0 && hides(at, front, form.lowest_at, &passage, region, work) {
                open.truncate(begin);
                return Answer::Dark;
            }
            if range.certainly_negative() {
                // A negative slope at t = 0: every segment leaves to the wrong side.
                if own && t.lo() == 0.0 {
                    open.truncate(begin);
                    return Answer::Dark;
                }
                // No zero in this piece, though that proves nothing more.
                continue;
            }
            if long(t, distance, width, root) {
                let [near, far] = halves(t);
                let (first, second) = if form.falls { (far, near) } else { (near, far) };
                s.stack.push(Piece { surface, t: second });
                s.stack.push(Piece { surface, t: first });
            } else {
                open.push(Piece { surface, t });
                let hides = hides(at, front, form.lowest_at, &passage, region, work);
                s.planes.push(HalfPlane { k: form.bottom, a: form.u, b: form.v, e: form.error, hides });
            }
        }
        if open.len() == begin {
            return Answer::Lit;
        }
        let shares = shares(&s.planes, &mut s.areas);
        Answer::Open { lit: shares.lit, open: shares.open }
    }
}

/// The form at the end of the piece where it is lowest. An unknown form has infinite error.
fn lowest(form: &antumbra_interval::affine::Affine<3>, t: Interval) -> Form {
    let [along, u, v] = *form.coefficients();
    // c - |a_t| is rounded down; the real one lies at most one rounding above.
    let bottom = sub_down(form.centre(), along.abs());
    let error = add_up(form.error(), sub_up(sub_up(form.centre(), along.abs()), bottom));
    let falls = along < 0.0;
    Form { bottom, error, u, v, lowest_at: if falls { t.hi() } else { t.lo() }, falls }
}
