//! What is known of a light before one hit is looked at: what a whole tile of hits has proved.
use super::ledger::{Ledger, area};
use super::policy::quarters;
use crate::trace::{Piece, Surface};
use antumbra_interval::Interval;
use antumbra_interval::round::{add_down, add_up};
use smallvec::{SmallVec, smallvec};

/// A part of a light, and the pieces of the beam to it in which something may be in the way.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Parameters u, v of the light.
    pub part: [Interval; 2],
    /// Elsewhere on the beam, nothing is.
    pub pieces: SmallVec<[Piece; 4]>,
}

/// Parts of a light that some hits see or do not see, all of them, and the parts that are open. By default nothing of it is left: what there
/// is before parts are booked.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Known {
    /// Bounds of the share of the light that is certainly seen.
    lit: [f64; 2],
    /// Whether some part is certainly not seen.
    shaded: bool,
    /// The rest.
    pub(super) open: SmallVec<[Part; 1]>,
    /// Nothing has been divided.
    whole: bool,
}

impl Known {
    /// Nothing is known: each surface, all the way to the light.
    #[must_use]
    pub fn nothing(surfaces: &[Surface<'_>]) -> Self {
        let unit = Interval::new(-1.0, 1.0);
        let beam = |surface| Piece { surface, t: Interval::new(0.0, 1.0) };
        let pieces = (0..surfaces.len()).map(beam).collect();
        Self { lit: [0.0; 2], shaded: false, open: smallvec![Part { part: [unit; 2], pieces }], whole: true }
    }

    /// The same without the open parts, which are looked at again.
    pub(super) fn settled_part(&self) -> Self {
        Self { open: SmallVec::new(), ..*self }
    }

    /// All hits see all of a part that was looked at.
    pub(super) fn lit(&mut self, part: [Interval; 2]) {
        let [lo, hi] = area(part);
        self.lit = [add_down(self.lit[0], lo), add_up(self.lit[1], hi)];
    }

    /// None sees any of it.
    pub(super) fn shaded(&mut self) {
        self.shaded = true;
    }

    /// It stays open.
    pub(super) fn open(&mut self, part: Part) {
        self.open.push(part);
    }

    /// Its quarters, to be looked at.
    pub(super) fn divide(&mut self, part: [Interval; 2]) -> [[Interval; 2]; 4] {
        self.whole = false;
        quarters(part[0], part[1])
    }

    /// Whether the light has not been divided.
    #[must_use]
    pub fn whole(&self) -> bool {
        self.whole
    }

    /// Whether nothing is open.
    #[must_use]
    pub fn settled(&self) -> bool {
        self.open.is_empty()
    }

    /// Bounds of the visible fraction.
    #[must_use]
    pub fn bounds(&self) -> [f64; 2] {
        let mut ledger = Ledger::<()>::default();
        self.book(&mut ledger);
        for part in &self.open {
            ledger.open(part.part, [0.0, 1.0], ());
        }
        ledger.bounds()
    }

    /// Begins the bookkeeping of one hit.
    pub(super) fn book<T>(&self, ledger: &mut Ledger<T>) {
        ledger.lit(self.lit);
        if self.shaded {
            ledger.shaded();
        }
    }

    /// The same light with other pieces, of a beam that has not been divided.
    pub(super) fn with_pieces(&self, pieces: &[Piece]) -> Self {
        let part = |of: &Part| Part { part: of.part, pieces: pieces.into() };
        Self { open: self.open.iter().map(part).collect(), ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quartered() -> (Known, [[Interval; 2]; 4]) {
        let told = Known::nothing(&[]);
        assert!(told.whole() && !told.settled() && told.bounds() == [0.0, 1.0]);
        let mut known = told.settled_part();
        let quarters = known.divide(told.open[0].part);
        (known, quarters)
    }

    #[test]
    fn a_light_that_is_seen_by_quarters_is_seen_as_a_whole_but_not_at_first_sight() {
        let (mut known, quarters) = quartered();
        quarters.iter().for_each(|quarter| known.lit(*quarter));
        assert!(known.settled() && !known.whole());
        assert_eq!(known.bounds(), [1.0; 2]);
    }

    #[test]
    fn quarters_count_a_quarter_each() {
        let (mut known, [lit, _, open, other]) = quartered();
        known.lit(lit);
        known.shaded();
        for part in [open, other] {
            known.open(Part { part, pieces: SmallVec::new() });
        }
        let [lo, hi] = known.bounds();
        assert!(lo <= 0.25 && lo > 0.25 - 1e-12 && (0.75..0.75 + 1e-12).contains(&hi), "[{lo}, {hi}]");
        assert!(!known.settled());
    }

    #[test]
    fn dark_quarters_make_no_light() {
        let (mut known, quarters) = quartered();
        quarters.iter().for_each(|_| known.shaded());
        let [lo, hi] = known.bounds();
        assert!(lo == 0.0 && hi < 1e-300, "[{lo}, {hi}]");
    }
}
