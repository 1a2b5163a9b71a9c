//! Where to cut: choices that cost or save time and never touch a proof. The only file of this room with float
//! arithmetic.
#![allow(clippy::float_arithmetic, reason = "choices of where to cut, never a proof")]
use super::patch::Layer;
use crate::geom::{Box3, Fan, Vec3};
use antumbra_interval::Interval;
use antumbra_interval::affine::Affine;
use antumbra_interval::quadratic::Quadratic;

/// A piece longer than this many widths of the frustum is halved.
const ASPECT: f64 = 2.0;

/// A part of a piece smaller than this share of it is worth to be looked at alone.
const SMALLER: f64 = 0.75;

/// How far a function may be off its plane, in what it varies across a frustum, before shorter pieces are looked at.
const CURVED: f64 = 0.1;

/// Relative width of an enclosure of f' up to which a step of Newton's gains more for its cost than a new form.
const STRAIGHT: f64 = 1e-3;

/// Where to cut an interval in two. Not at the middle: roots like to sit at round numbers, and a root at a cut cannot
/// be proved by signs.
const CUT: f64 = 0.497_31;

/// Evaluations that one frustum may take; what is open then stays open. The gallery's need less than a tenth of it.
pub(super) const FRUSTUM_EVALUATIONS: u64 = 2048;

/// A length along the rays below which nothing is resolved, however near to the eye: a share of how far the surface's
/// region reaches. (Relative lengths alone would cut for ever at t = 0, where the eye may be inside a surface.)
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach(f64);

impl Reach {
    pub(super) const NONE: Self = Self(0.0);

    pub(super) fn of(region: &Box3, eye: Vec3) -> Self {
        let side = |k: usize| (region[k].lo() - eye[k]).abs().max((region[k].hi() - eye[k]).abs());
        let end = (0..3).map(side).fold(0.0, f64::max);
        Self(if end.is_finite() { 1e-3 * end } else { 0.0 })
    }

    /// Whether a piece is long enough to be looked at alone.
    pub(super) fn resolves(self, t: Interval) -> bool {
        t.hi() - t.lo() > 1e-9 * t.hi().max(self.0)
    }
}

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
    pub(super) fn long(&self, t: Interval, reach: Reach) -> bool {
        self.parts(t) > 1.0 && reach.resolves(t)
    }

    /// Whether it would be halved often.
    pub(super) fn very_long(&self, t: Interval) -> bool {
        self.parts(t) > MANY
    }

    /// Into how many parts it would be cut. Not a number where it has no length and no width, nor where it is endless: then it is neither.
    fn parts(&self, t: Interval) -> f64 {
        (t.hi() - t.lo()) * self.speed / (ASPECT * self.spread * t.hi())
    }
}

/// A piece that would be halved into more parts than this is looked at to second order first.
const MANY: f64 = 8.0;

/// Whether a contracted piece is enough smaller than before.
pub(super) fn smaller(open: Interval, before: Interval) -> bool {
    open.hi() - open.lo() < SMALLER * (before.hi() - before.lo())
}

/// Whether shorter pieces tell much more than the form does: what is left open along a plane is open because of what the
/// function varies across.
pub(super) fn curved(form: &Affine<3>) -> bool {
    let [_, i, j] = form.coefficients();
    form.error() > CURVED * (i.abs() + j.abs())
}

/// The same of a quadratic form.
pub(super) fn bent(form: &Quadratic) -> bool {
    let [_, i, j] = form.linear();
    form.error() > CURVED * (i.abs() + j.abs())
}

/// The planes, a little apart from them, between which an affine form over a piece may be 0.
pub(super) fn layer(form: &Affine<3>) -> Option<Layer> {
    let [along, across @ ..] = *form.coefficients();
    let (middle, slopes) = (-form.centre() / along, across.map(|a| -a / along));
    let size = middle.abs() + slopes[0].abs() + slopes[1].abs() + 1.0;
    let reach = (form.error() / along).abs() * (1.0 + 1e-9) + 1e-13 * size;
    Some(Layer { k: Interval::try_new(middle - reach, middle + reach).filter(|k| k.is_bounded())?, slopes })
}

/// Whether a derivative varies little.
pub(super) fn straight(derivative: Interval) -> bool {
    derivative.hi() - derivative.lo() <= STRAIGHT * derivative.lo().abs().min(derivative.hi().abs())
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
    /// Evaluations to spend.
    most: u64,
}

impl Effort {
    /// Evaluations that one surface of one ray may take.
    pub(super) fn evaluations(self) -> u64 {
        self.most
    }

    /// For hits from which shadows start. About 2^-37 is what cancellation leaves of a double root.
    pub const FINE: Self = Self { shortest: 7.3e-12, root: 1e-12, most: 4096 };
    /// For colours.
    pub const COARSE: Self = Self { shortest: 1e-5, root: 1e-4, most: 1024 };
}

/// Whether a piece of a ray is too short to go on.
pub(super) fn tiny(t: Interval, reach: Reach, effort: Effort) -> bool {
    t.hi() - t.lo() <= effort.shortest * t.hi().abs().max(reach.0)
}

/// Whether a root is enclosed well enough.
pub(super) fn thin(t: Interval, effort: Effort) -> bool {
    t.hi() - t.lo() <= effort.root * t.hi().abs()
}
