//! Surfaces as the certified search sees them, and pieces of beams that are still open.
use crate::eval::{Inclusion, Workspace};
use crate::geom::{Box3, Clip, Passage};
use antumbra_interval::Interval;
use serde::{Deserialize, Serialize};

/// A surface `{f = 0}` inside a region.
#[derive(Clone, Copy)]
pub struct Surface<'a> {
    /// The function.
    pub function: &'a dyn Inclusion,
    /// Outside of this there is no surface.
    pub clip: Clip,
    /// Every zero in here is on the surface. Contains the clip; larger if the clip cuts nothing away.
    pub region: Clip,
}

impl Surface<'_> {
    /// Where on the rays `P + t D` the surface can be (outer), and where a zero is one of its points (inner).
    #[must_use]
    pub fn passage(&self, apex: &Box3, direction: &Box3) -> Passage {
        let clip = self.clip.passage(apex, direction);
        if self.region == self.clip {
            return clip;
        }
        Passage { outer: clip.outer, inner: self.region.passage(apex, direction).inner }
    }
}

/// A piece of a beam, parameters `t`, in which a surface may be met: everything else is settled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Index of the surface.
    pub surface: usize,
    /// Parameters.
    pub t: Interval,
}

impl Passage {
    /// Of rays that are inside a convex region in all of the given pieces: and so they are in between.
    pub(super) fn inside(pieces: &[Piece]) -> Self {
        let all = pieces.iter().fold(Interval::EMPTY, |all, piece| all.hull(piece.t));
        Self { outer: all, inner: all }
    }
}

/// A proved sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Sign {
    /// Less than 0.
    Negative,
    /// Greater than 0.
    Positive,
}

impl Sign {
    /// The other sign.
    #[must_use]
    pub const fn opposite(self) -> Self {
        match self {
            Self::Negative => Self::Positive,
            Self::Positive => Self::Negative,
        }
    }

    /// The sign of every number in the interval, if it is one and the same; none for the empty interval.
    #[must_use]
    #[inline]
    pub fn of(range: Interval) -> Option<Self> {
        if range.is_empty() {
            None
        } else if range.certainly_positive() {
            Some(Self::Positive)
        } else if range.certainly_negative() {
            Some(Self::Negative)
        } else {
            None
        }
    }
}

/// Whether the function is proved defined and continuous on the box.
pub fn certainly_continuous(f: &dyn Inclusion, region: &Box3, work: &mut Workspace) -> bool {
    f.continuous_everywhere() || f.decorated(region, work).certainly_continuous()
}
