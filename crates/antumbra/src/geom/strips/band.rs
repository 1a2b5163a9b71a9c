//! The band along a curve in which a square is undecided.
use super::Strip;
use antumbra_interval::round::{sub_down, sub_up};

/// Where the undecided part of a square lies, if it is a band along a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// The coordinate across the band: 0 for a, 1 for b.
    pub across: usize,
    /// Whether the lit side is that of larger values.
    pub lit_above: bool,
    /// Undecided values of this coordinate, for the lower and for the upper half of the other one: within `[-1, 1]`; all
    /// values on one side of them are lit, all on the other hidden. The first one is larger where nothing is undecided.
    pub undecided: [[f64; 2]; 2],
}

/// Collects the band of a single curve.
#[derive(Default)]
pub(super) struct Tracker {
    broken: bool,
    sign: f64,
    /// In the direction of the sign, for both halves: from where on not certainly hidden, from where on certainly lit.
    halves: [Option<[f64; 2]>; 2],
}

impl Tracker {
    /// A strip has no line on one side.
    pub(super) fn broken(&mut self) {
        self.broken = true;
    }

    /// The signs of both lines of a strip, lower bounds of the lengths beyond one and upper bounds of those beyond the other.
    pub(super) fn add(&mut self, strip: Strip, [inner, outer]: [f64; 2], lit: [f64; 2], hidden: [f64; 2]) {
        self.broken |= inner != outer || (self.sign != 0.0 && self.sign != inner);
        self.sign = inner;
        // 1 - length is the place.
        let to = f64::max(sub_up(1.0, lit[0]), sub_up(1.0, lit[1]));
        let from = f64::min(sub_down(1.0, hidden[0]), sub_down(1.0, hidden[1]));
        let half = &mut self.halves[usize::from(strip.upper)];
        *half = Some(half.map_or([from, to], |[f, t]| [f64::min(f, from), f64::max(t, to)]));
    }

    pub(super) fn finish(self, across: usize) -> Option<Band> {
        let [Some(first), Some(second)] = self.halves else { return None };
        if self.broken {
            return None;
        }
        let lit_above = self.sign > 0.0;
        let undecided = [first, second].map(|[from, to]| {
            let (from, to) = (f64::max(from, -1.0), f64::min(to, 1.0));
            if lit_above { [from, to] } else { [-to, -from] }
        });
        Some(Band { across, lit_above, undecided })
    }
}
