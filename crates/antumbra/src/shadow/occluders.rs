//! What stands between a hit and a light.
use crate::eval::{Inclusion, Workspace};
use crate::geom::{Box3, Fan, Passage};
use crate::trace::{Cost, Sign, Surface, certainly_continuous};
use antumbra_interval::Interval;
use serde::{Deserialize, Serialize};

/// A proved hit, where shadow beams start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Receiver {
    /// Contains the true hit, at which the surface's function is 0.
    pub point: Box3,
    /// Index of the surface.
    pub surface: usize,
    /// Sign of its function on the viewer's side.
    pub side: Sign,
}

/// A sign that a surface's function has on all rays at a parameter at which they are all inside its region. A proved
/// opposite sign further on, still inside, with f continuous in between, proves a zero in between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Front {
    pub(super) sign: Sign,
    pub(super) at: f64,
}

impl Front {
    /// Of the surface that was hit it is the viewer's side, at `t = 0`: a segment that has the other sign anywhere either left the
    /// surface to the wrong side or met it again.
    pub(super) fn of(receiver: &Receiver) -> Self {
        Self { sign: receiver.side, at: 0.0 }
    }
}

/// The front signs of all surfaces for one receiver and the whole light.
pub(super) fn fronts(
    surfaces: &[Surface<'_>],
    receiver: &Receiver,
    light: &Fan,
    work: &mut Workspace,
    cost: &mut Cost,
) -> Vec<Option<Front>> {
    let mut front_of = |(index, surface): (usize, &Surface<'_>)| {
        if index == receiver.surface { Some(Front::of(receiver)) } else { front(surface, receiver, light, work, cost) }
    };
    surfaces.iter().enumerate().map(&mut front_of).collect()
}

/// The front sign of another surface than that of the receiver.
pub(super) fn front(
    surface: &Surface<'_>,
    receiver: &Receiver,
    light: &Fan,
    work: &mut Workspace,
    cost: &mut Cost,
) -> Option<Front> {
    let passage = surface.passage(&light.apex, &light.directions());
    if passage.inner.contains(0.0) {
        cost.evaluations += 1;
        return Sign::of(surface.function.range(&receiver.point, work)).map(|sign| Front { sign, at: 0.0 });
    }
    // The receiver is outside of the region: look at a short stretch behind its border.
    if passage.inner.is_empty() || passage.inner.hi() == f64::INFINITY {
        return None;
    }
    (4..10).find_map(|level| {
        let stretch = crate::geom::section(passage.inner, 0, level);
        cost.evaluations += 1;
        let sign = Sign::of(surface.function.beam(light.at(stretch), work).range())?;
        Some(Front { sign, at: stretch.lo() })
    })
}

/// Whether f has no zero in the box: where a form says nothing (it overflows, or reaches the end of a domain) intervals often do.
/// Where f is undefined nothing occludes.
pub(super) fn no_zero(f: &dyn Inclusion, region: &Box3, work: &mut Workspace, cost: &mut Cost) -> bool {
    cost.evaluations += 1;
    !f.range(region, work).possibly_zero()
}

/// Whether the opposite sign of `front` at the parameter `at`, on some of the rays, proves a zero on these rays: all
/// points in between must be inside the region (it is convex, so its ends suffice) and f continuous there.
pub(super) fn hides(
    surface: &Surface<'_>,
    front: Option<Front>,
    at: f64,
    passage: &Passage,
    region: impl FnOnce(Interval) -> Box3,
    work: &mut Workspace,
) -> bool {
    let Some(front) = front else { return false };
    if !passage.inner.contains(at) || front.at > at {
        return false;
    }
    surface.function.continuous_everywhere()
        || certainly_continuous(surface.function, &region(Interval::new(front.at, at)), work)
}
