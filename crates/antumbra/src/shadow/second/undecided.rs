//! What the curves of a cell say about its parts, without another evaluation.
use super::super::ledger::{Ledger, area};
use super::{Claim, Rest, Says, policy};
use crate::geom::strips::{Curve, Leaning, places};
use antumbra_interval::Interval;

/// A cell that was looked at, and what its slabs say of it ([`Says::Curves`](super::Says::Curves)).
pub(super) struct Seen<'a> {
    pub(super) part: [Interval; 2],
    pub(super) curves: &'a [Curve],
}

impl Seen<'_> {
    /// Whether a part of the cell is lit all over, or hidden all over; `None` if neither is proved. Only what the middle of the part speaks
    /// for is asked: most parts are neither.
    fn settles(&self, part: [Interval; 2]) -> Option<bool> {
        let places = [0, 1].map(|axis| places(part[axis], self.part[axis]));
        let mut lit = true;
        for curve in self.curves {
            match curve.leaning(places) {
                Leaning::Hiding if curve.hides_over(places) => return Some(false),
                Leaning::Free if lit => lit = curve.free_over(places),
                Leaning::Free => {}
                _ => lit = false,
            }
        }
        lit.then_some(true)
    }

    /// A rectangle that holds what is undecided of a part of the cell; what lies beside it is booked. `None` if nothing is left.
    pub(super) fn undecided(
        &self,
        part: [Interval; 2],
        ledger: &mut Ledger<Rest>,
        claims: &mut Option<Vec<Claim>>,
    ) -> Option<[Interval; 2]> {
        let mut book = |part, lit| {
            if lit {
                ledger.lit(area(part));
            } else {
                ledger.shaded();
            }
            if let Some(claims) = claims {
                claims.push(Claim { part, says: if lit { Says::Lit } else { Says::Dark } });
            }
        };
        if let Some(lit) = self.settles(part) {
            book(part, lit);
            return None;
        }
        let mut rest = part;
        for (axis, upper) in [(0, false), (0, true), (1, false), (1, true)] {
            for share in policy::CUTS {
                let Some([cut, kept]) = policy::cut_off(rest[axis], share, upper) else { break };
                let mut strip = rest;
                strip[axis] = cut;
                if let Some(lit) = self.settles(strip) {
                    book(strip, lit);
                    rest[axis] = kept;
                } else if share == policy::CUTS[0] {
                    break;
                }
            }
        }
        Some(rest)
    }
}
