//! An interval on a ray that holds the first root of a surface, and how it becomes a short one.
use super::crossing::contract;
use super::policy::{Effort, Reach, smaller, straight, thin, tiny};
use super::{Bracket, Meeting};
use antumbra_interval::Interval;
use antumbra_interval::affine::Dual;

/// Steps towards one root at most.
const STEPS: u32 = 40;

/// An interval that holds the first root: f has one sign before it, is not 0 from the beginning of the search up to its lower end,
/// has the other sign behind it, and is continuous in between.
#[derive(Clone, Copy, Debug)]
pub(super) struct Root {
    pub(super) bracket: Bracket,
    /// Encloses f' on the interval, if f' has a sign there; else it says nothing.
    derivative: Interval,
    /// Questions that were asked about it.
    pub(super) steps: u32,
}

/// What comes next for a root.
#[derive(Clone, Copy, Debug)]
pub(super) enum Goal {
    /// A question: value and derivative on it.
    Narrow(Root),
    /// A question: the value in its middle, for interval Newton.
    Middle(Root),
    /// Nothing: it is short, or gets no shorter.
    Proved(Root),
    /// There may be several roots: which one is the first?
    Unclear(Root),
}

impl Root {
    /// The derivative says nothing or has a sign ([`signed`]).
    pub(super) fn new(bracket: Bracket, derivative: Interval) -> Self {
        Self { bracket, derivative, steps: 0 }
    }

    /// Goes on, if that pays; the interval was `wider` before.
    pub(super) fn enclose(self, wider: Interval, effort: Effort) -> Goal {
        let t = self.bracket.t;
        if thin(t, effort) || self.steps >= STEPS {
            Goal::Proved(self)
        } else if !self.derivative.possibly_zero() && (straight(self.derivative) || !smaller(t, wider)) {
            Goal::Middle(self)
        } else {
            Goal::Narrow(self)
        }
    }

    /// With value and derivative on it.
    pub(super) fn narrowed(self, dual: &Dual<1>, reach: Reach, effort: Effort) -> Goal {
        let (t, steps) = (self.bracket.t, self.steps + 1);
        let derivative = signed(dual.derivative.range().intersection(self.derivative));
        let open = contract(t, &dual.value).map_or(t, |c| c.open);
        if derivative.possibly_zero() && !smaller(open, t) {
            let root = Self { steps, ..self };
            return if tiny(t, reach, effort) { Goal::Proved(root) } else { Goal::Unclear(root) };
        }
        Self { bracket: Bracket { t: open, ..self.bracket }, derivative, steps }.enclose(t, effort)
    }

    /// With the value in its middle: `N = m - f(m) / f'(T)`.
    pub(super) fn stepped(self, value: Interval, effort: Effort) -> Goal {
        let (t, steps) = (self.bracket.t, self.steps + 1);
        let narrower = (Interval::point(t.mid()) - value / self.derivative).intersection(t);
        if narrower.is_empty() || narrower == t {
            // Empty only if an enclosure failed: keep what is proved. Else rounding leaves no more.
            return Goal::Proved(Self { steps, ..self });
        }
        Self { bracket: Bracket { t: narrower, ..self.bracket }, steps, ..self }.enclose(t, effort)
    }

    /// The meeting there, if the surface exists there.
    pub(super) fn meeting(&self) -> Meeting {
        let Bracket { surface, t, before } = self.bracket;
        Meeting { surface, t, before: Some(before), reason: None }
    }
}

/// An enclosure of a derivative that has a sign; of another one nothing is kept.
pub(super) fn signed(derivative: Interval) -> Interval {
    if derivative.is_empty() || derivative.possibly_zero() { Interval::ENTIRE } else { derivative }
}
