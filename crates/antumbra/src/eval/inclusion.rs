//! The one public trait: what the renderer needs to know of a function.
use super::{Gradient, run};
use crate::geom::Box3;
use crate::tape::Tape;
use antumbra_interval::Interval;

/// Scratch memory of one thread. Start from `default()` and keep it: it only grows.
#[derive(Debug, Default)]
pub struct Workspace {
    intervals: Vec<Interval>,
    gradients: Vec<Gradient>,
}

/// A real function of space with an inclusion function (paper, section 2): everything a renderer may ask of it.
///
/// Tapes implement it; so may a user's own code. The law for every method: the answer encloses the true value at
/// every point of the box at which the function is defined; the empty interval says that it is defined nowhere there.
pub trait Inclusion: Send + Sync {
    /// Enclosure of the function over the box: the paper's `F(X, Y, Z)`.
    fn range(&self, region: &Box3, work: &mut Workspace) -> Interval;

    /// Enclosures of the function and of its gradient over the box.
    fn gradient(&self, region: &Box3, work: &mut Workspace) -> Gradient;
}

impl Inclusion for Tape {
    #[inline]
    fn range(&self, region: &Box3, work: &mut Workspace) -> Interval {
        run(self, region.0, &mut work.intervals)
    }

    #[inline]
    fn gradient(&self, region: &Box3, work: &mut Workspace) -> Gradient {
        run(self, Gradient::coordinates(region.0), &mut work.gradients)
    }
}
