//! The first root along one ray, certified.
use super::piece::certainly_continuous;
use super::policy::{Effort, Reach, cut, thin, tiny};
use super::{Cost, Piece, Sign, Surface};
use crate::eval::Workspace;
use crate::geom::Beam;
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

/// Scratch memory of a ray search.
#[derive(Debug, Default)]
pub struct Scratch {
    stack: Vec<Interval>,
}

/// The first meeting of a thin beam with a surface in one of the open pieces. `None` proves that there is none.
///
/// Each piece is settled by the enclosure of f; or, where the derivative along the ray has a proved sign, by the signs of
/// f at both ends: equal signs exclude a root (f is monotone), opposite ones prove exactly one if f is continuous on the
/// piece, which interval Newton then encloses: `N = m - f(m) / f'(T)` contains every root in T (mean value theorem).
pub fn first_meeting(
    surfaces: &[Surface<'_>],
    ray: &Beam,
    open: &[Piece],
    effort: Effort,
    scratch: &mut Scratch,
    work: &mut Workspace,
    cost: &mut Cost,
) -> Option<Meeting> {
    let mut best: Option<Meeting> = None;
    let mut next = 0;
    while next < open.len() {
        let surface = open[next].surface;
        let end = next + open[next..].iter().take_while(|p| p.surface == surface).count();
        let pieces = &open[next..end];
        next = end;
        // Up to the end of the enclosure: within it, the order of two surfaces is not known.
        let until = best.map_or(f64::INFINITY, |b| b.t.hi());
        let found = first_of_surface(surface, &surfaces[surface], ray, pieces, until, effort, scratch, work, cost);
        // Two surfaces whose enclosures overlap: the earlier bound wins, and the order is not proved.
        best = match (best, found) {
            (Some(a), Some(b)) => {
                let (first, second) = if b.t.lo() < a.t.lo() { (b, a) } else { (a, b) };
                let overlap = first.t.hi() >= second.t.lo();
                Some(if overlap { Meeting { reason: first.reason.or(Some(Reason::Touching)), ..first } } else { first })
            }
            (a, b) => a.or(b),
        };
    }
    best
}

#[expect(clippy::too_many_arguments, reason = "one call site; the search and its scratch memory")]
fn first_of_surface(
    surface: usize,
    of: &Surface<'_>,
    ray: &Beam,
    pieces: &[Piece],
    until: f64,
    effort: Effort,
    scratch: &mut Scratch,
    work: &mut Workspace,
    cost: &mut Cost,
) -> Option<Meeting> {
    let f = of.function;
    let passage = of.passage(&ray.origin.to_box(), &ray.direction);
    let direction: [Affine<1>; 3] = ray.direction.0.map(Affine::constant);
    let (reach, begin) = (Reach::of(&passage), cost.evaluations);
    scratch.stack.clear();
    scratch.stack.extend(pieces.iter().rev().map(|p| p.t));
    let mut before = None;
    while let Some(t) = scratch.stack.pop() {
        let t = t.intersection(passage.outer);
        if t.is_empty() || t.lo() > until {
            continue;
        }
        if t.hi() == f64::INFINITY {
            return Some(Meeting { surface, t, before, reason: Some(Reason::Resolution) });
        }
        if cost.evaluations - begin > effort.evaluations() {
            return Some(Meeting { surface, t, before, reason: Some(Reason::Budget) });
        }
        let s = Affine::<1>::spanning(0, t);
        let point = std::array::from_fn(|k| Dual {
            value: (s * direction[k]).add_f64(ray.origin[k]),
            derivative: direction[k],
        });
        cost.evaluations += 1;
        let Dual { value, derivative } = f.ray(point, work);
        let (mut value, derivative) = (value.range(), derivative.range());
        if value == Interval::ENTIRE {
            // Affine forms say nothing at the ends of domains; intervals do.
            cost.evaluations += 1;
            value = f.range(&ray.at(t), work);
        }
        if !value.possibly_zero() {
            before = Sign::of(value).or(before);
            continue;
        }
        if !derivative.possibly_zero() && certainly_continuous(f, &ray.at(t), work) {
            cost.evaluations += 2;
            let mut sign_at = |t: f64| Sign::of(f.range(&ray.at(Interval::point(t)), work));
            match (sign_at(t.lo()), sign_at(t.hi())) {
                (Some(a), Some(b)) if a == b => {
                    before = Some(b);
                    continue;
                }
                (Some(a), Some(_)) => {
                    let t = newton(of, ray, t, derivative, effort, work, cost);
                    // The root must lie where the surface exists.
                    let inside = t.intersection(passage.inner) == t;
                    let reason = (!inside).then_some(Reason::Resolution);
                    return Some(Meeting { surface, t, before: Some(a), reason });
                }
                _ => {}
            }
        }
        if tiny(t, reach, effort) {
            let reason = if certainly_continuous(f, &ray.at(t), work) { Reason::Touching } else { Reason::Domain };
            return Some(Meeting { surface, t, before, reason: Some(reason) });
        }
        let [near, far] = cut(t);
        scratch.stack.push(far);
        scratch.stack.push(near);
    }
    None
}

/// Narrows an interval that holds exactly one root, with the given enclosure of the derivative.
fn newton(
    of: &Surface<'_>,
    ray: &Beam,
    mut t: Interval,
    derivative: Interval,
    effort: Effort,
    work: &mut Workspace,
    cost: &mut Cost,
) -> Interval {
    let f = of.function;
    let mut slope = derivative;
    if thin(t, t, effort) {
        return t;
    }
    for _ in 0..40 {
        let middle = Interval::point(t.mid());
        cost.evaluations += 1;
        let step = f.range(&ray.at(middle), work) / slope;
        let narrower = (middle - step).intersection(t);
        if narrower.is_empty() {
            // Only possible if an enclosure failed; keep what is proved.
            return t;
        }
        let old = t;
        t = narrower;
        if thin(t, old, effort) {
            break;
        }
        let direction: [Affine<1>; 3] = ray.direction.0.map(Affine::constant);
        let s = Affine::<1>::spanning(0, t);
        let point = std::array::from_fn(|k| Dual {
            value: (s * direction[k]).add_f64(ray.origin[k]),
            derivative: direction[k],
        });
        cost.evaluations += 1;
        let sharper = f.ray(point, work).derivative.range();
        if !sharper.possibly_zero() {
            slope = sharper.intersection(slope);
        }
    }
    t
}
