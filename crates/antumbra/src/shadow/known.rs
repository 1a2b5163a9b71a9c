//! What is known of a light before one hit is looked at: what a whole tile of hits has proved.
use super::ledger::{Ledger, area};
use super::policy::quarters;
use crate::trace::{Piece, Surface};
use antumbra_interval::Interval;
use antumbra_interval::round::{add_down, add_up};

/// A part of a light, and the pieces of the beam to it in which something may be in the way.
#[derive(Clone, Debug)]
pub struct Part {
    /// Parameters u, v of the light.
    pub part: [Interval; 2],
    /// Elsewhere on the beam, nothing is.
    pub pieces: Vec<Piece>,
}

/// Parts of a light that some hits see or do not see, all of them, and the parts that are open.
#[derive(Clone, Debug)]
pub struct Known {
    /// Bounds of the share of the light that is certainly seen.
    lit: [f64; 2],
    /// Whether some part is certainly not seen.
    shaded: bool,
    /// The rest.
    pub(super) open: Vec<Part>,
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
        Self { lit: [0.0; 2], shaded: false, open: vec![Part { part: [unit; 2], pieces }], whole: true }
    }

    /// Takes the open parts out, to be looked at.
    #[must_use]
    pub fn take_open(&mut self) -> Vec<Part> {
        std::mem::take(&mut self.open)
    }

    /// All hits see all of a part that was taken out.
    pub fn lit(&mut self, part: &Part) {
        let [lo, hi] = area(part.part);
        self.lit = [add_down(self.lit[0], lo), add_up(self.lit[1], hi)];
    }

    /// None sees any of it.
    pub fn shaded(&mut self) {
        self.shaded = true;
    }

    /// It stays open.
    pub fn open(&mut self, part: Part) {
        self.open.push(part);
    }

    /// The quarters of a part that was taken out, to be looked at.
    pub fn divide(&mut self, part: &Part) -> [Part; 4] {
        self.whole = false;
        quarters(part.part[0], part.part[1]).map(|quarter| Part { part: quarter, pieces: part.pieces.clone() })
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
        let part = |of: &Part| Part { part: of.part, pieces: pieces.to_vec() };
        Self { open: self.open.iter().map(part).collect(), ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quartered() -> (Known, [Part; 4]) {
        let mut known = Known::nothing(&[]);
        assert!(known.whole() && !known.settled() && known.bounds() == [0.0, 1.0]);
        let whole = known.take_open().remove(0);
        let quarters = known.divide(&whole);
        (known, quarters)
    }

    #[test]
    fn a_light_that_is_seen_by_quarters_is_seen_as_a_whole_but_not_at_first_sight() {
        let (mut known, quarters) = quartered();
        quarters.iter().for_each(|quarter| known.lit(quarter));
        assert!(known.settled() && !known.whole());
        assert_eq!(known.bounds(), [1.0; 2]);
    }

    #[test]
    fn quarters_count_a_quarter_each() {
        let (mut known, [lit, _, open, other]) = quartered();
        known.lit(&lit);
        known.shaded();
        known.open(open);
        known.open(other);
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
