//! Frusta of the camera: which parts of which rays may meet which surface (certified, first order).
use super::piece::certainly_continuous;
use super::policy::{FRUSTUM_EVALUATIONS, Reach, Shape, cut};
use super::{Cost, Piece, Sign, Surface};
use crate::eval::Workspace;
use crate::geom::Fan;
use antumbra_interval::Interval;

/// What is known of all rays of a frustum. Valid for every part of the frustum.
#[derive(Clone, Debug, PartialEq)]
pub struct Known {
    /// The pieces that are open; outside of them no ray meets a surface before `cover`. Ascending per surface.
    pub open: Vec<Piece>,
    /// Every ray meets some surface at a parameter up to this one: proved. Infinite if that is not so.
    pub cover: f64,
    /// Per surface: a sign of f, and a parameter before its first open piece at which f has it on all rays, all of them
    /// inside the surface's region; where proved.
    front: Vec<Option<(Sign, f64)>>,
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
        Self { open: open.collect(), cover: f64::INFINITY, front: vec![None; surfaces.len()] }
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
fn join(open: &mut Vec<Piece>, first: usize, piece: Piece) {
    match open[first..].last_mut() {
        Some(last) if last.t.hi() == piece.t.lo() => last.t = last.t.hull(piece.t),
        _ => open.push(piece),
    }
}

/// Looks at a part of a frustum of which `parent` is known, and settles as much of the open pieces as pays.
///
/// A piece in which the enclosure of f excludes 0 holds no surface (wherever f is undefined there is none either). If f
/// has one sign on all rays at a parameter inside the surface's region, and the other sign at a later one, still inside,
/// and is continuous in between, then every ray meets the surface in between: what lies behind is of no interest.
pub fn narrow(
    surfaces: &[Surface<'_>],
    fan: &Fan,
    parent: &Known,
    stack: &mut Vec<Interval>,
    work: &mut Workspace,
    cost: &mut Cost,
) -> Known {
    cost.beams += 1;
    let (shape, directions) = (Shape::of(fan), fan.directions());
    let begin = cost.evaluations;
    let mut known = Known { open: Vec::new(), cover: parent.cover, front: parent.front.clone() };
    let mut next = 0;
    while next < parent.open.len() {
        let surface = parent.open[next].surface;
        let end = next + parent.open[next..].iter().take_while(|p| p.surface == surface).count();
        let pieces = &parent.open[next..end];
        next = end;
        let function = surfaces[surface].function;
        let passage = surfaces[surface].passage(&fan.apex, &directions);
        let (reach, first_open) = (Reach::of(&passage), known.open.len());
        stack.clear();
        stack.extend(pieces.iter().rev().map(|p| p.t));
        while let Some(t) = stack.pop() {
            let t = t.intersection(passage.outer);
            if t.is_empty() || t.lo() >= known.cover {
                continue;
            }
            if t.hi() == f64::INFINITY {
                // An unbounded region: nothing can be evaluated, nothing is claimed.
                known.open.push(Piece { surface, t });
                continue;
            }
            if cost.evaluations - begin > FRUSTUM_EVALUATIONS {
                // The work of one frustum is spent: the rest stays open.
                join(&mut known.open, first_open, Piece { surface, t });
                continue;
            }
            cost.evaluations += 1;
            let mut range = function.beam(fan.at(t), work).range();
            if range == Interval::ENTIRE {
                // Affine forms say nothing at the ends of domains; intervals do.
                cost.evaluations += 1;
                range = function.range(&fan.box_at(t), work);
            }
            if range.possibly_zero() {
                if shape.long(t, reach) {
                    let [near, far] = cut(t);
                    stack.push(far);
                    stack.push(near);
                } else {
                    join(&mut known.open, first_open, Piece { surface, t });
                }
                continue;
            }
            let Some(sign) = Sign::of(range) else { continue };
            // Only parameters at which all rays are inside the region can prove a meeting.
            let inside = t.intersection(passage.inner);
            if inside.is_empty() {
                continue;
            }
            if known.open.len() == first_open {
                known.front[surface] = Some((sign, inside.hi()));
            } else if let Some((front, at)) = known.front[surface]
                && front != sign
                && at <= inside.lo()
            {
                let between = fan.box_at(Interval::new(at, inside.lo()));
                if certainly_continuous(function, &between, work) {
                    known.cover = known.cover.min(inside.lo());
                    break;
                }
            }
        }
    }
    let cover = known.cover;
    known.open.retain(|p| p.t.lo() < cover);
    known
}
