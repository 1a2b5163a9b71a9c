//! Where to cut: choices that cost or save time and never touch a proof. The only file of this room with float
//! arithmetic.
#![allow(clippy::float_arithmetic, reason = "choices of where to cut, never a proof")]
use crate::geom::Fan;
use antumbra_interval::Interval;

/// A piece longer than this many widths of the frustum is halved.
const ASPECT: f64 = 2.0;

/// Where to cut an interval in two. Not at the middle: roots like to sit at round numbers, and a root at a cut cannot
/// be proved by signs.
const CUT: f64 = 0.497_31;

/// The sizes of a fan that decide how it is cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    /// Length per unit of t.
    speed: f64,
    /// Width across per unit of t.
    spread: f64,
}

impl Shape {
    pub(super) fn of(fan: &Fan) -> Self {
        let largest = |f: &dyn Fn(usize) -> f64| (0..3).map(f).fold(0.0, f64::max);
        let d = &fan.direction;
        Self {
            speed: largest(&|k| d[k].centre().abs()),
            spread: 2.0 * largest(&|k| d[k].coefficients()[1].abs() + d[k].coefficients()[2].abs()),
        }
    }

    /// Whether a piece is long enough to be halved rather than divided across.
    pub(super) fn long(&self, t: Interval) -> bool {
        let length = t.hi() - t.lo();
        length * self.speed > ASPECT * self.spread * t.hi() && length > 1e-9 * t.hi()
    }
}

/// The two parts of an interval.
pub(super) fn cut(t: Interval) -> [Interval; 2] {
    let at = (t.lo() + CUT * (t.hi() - t.lo())).clamp(t.lo(), t.hi());
    [Interval::new(t.lo(), at), Interval::new(at, t.hi())]
}

/// How far a ray search goes; all lengths are relative to the distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Pieces shorter than this are given up: f touches 0, or nearly.
    shortest: f64,
    /// An enclosed root thinner than this is thin enough.
    root: f64,
}

impl Effort {
    /// For hits from which shadows start. About 2^-37 is what cancellation leaves of a double root.
    pub const FINE: Self = Self { shortest: 7.3e-12, root: 1e-14 };
    /// For colours.
    pub const COARSE: Self = Self { shortest: 1e-5, root: 1e-4 };
}

/// Whether a piece of a ray is too short to go on.
pub(super) fn tiny(t: Interval, effort: Effort) -> bool {
    t.hi() - t.lo() <= effort.shortest * t.hi().abs()
}

/// Whether a root is enclosed well enough, or interval Newton has stopped to pay.
pub(super) fn thin(t: Interval, before: Interval, effort: Effort) -> bool {
    let (width, old) = (t.hi() - t.lo(), before.hi() - before.lo());
    width <= effort.root * t.hi().abs() || (width > 0.5 * old && width <= 1e-12 * t.hi().abs())
}
