//! Which rows of a picture a renderer holds: all, or a band of them that moves down.
use super::by_proof::BLOCK;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// A band of rows, from tile border to tile border or to an end of the picture.
///
/// Tiles need nothing of each other; only colours look at neighbouring pixels. So the last row of tiles waits with its colours until the
/// next band is there, and the row of tiles above it stays to be looked at: a band begins with two rows of tiles of the one before.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Window {
    /// Rows of the picture.
    height: usize,
    /// Rows that come anew with each band.
    step: usize,
    /// Rows that are held.
    held: Range<usize>,
    /// First row that no band before has looked at.
    fresh: usize,
    /// First row whose colours no band before has finished.
    open: usize,
}

impl Window {
    /// Rows of tiles that two bands share.
    const SHARED: usize = 2;

    /// The first band, of at least `rows` rows or the whole picture.
    pub(super) fn first(height: usize, rows: usize) -> Self {
        let step = rows.clamp(1, height).next_multiple_of(BLOCK);
        // Two rows of tiles, so that one can be finished.
        let end = step.max(Self::SHARED * BLOCK).min(height);
        Self { height, step, held: 0..end, fresh: 0, open: 0 }
    }

    /// The band below; `None` below the last.
    pub(super) fn next(&self) -> Option<Self> {
        let end = self.held.end;
        let start = end.saturating_sub(Self::SHARED * BLOCK);
        let below = || Self {
            held: start..(end + self.step).min(self.height),
            fresh: end,
            open: self.finished().end,
            ..self.clone()
        };
        (end < self.height).then(below)
    }

    /// Whether it is one that [`Window::first`] and [`Window::next`] make: what is read from a file may be anything.
    pub(super) fn holds(&self, height: usize) -> bool {
        let Self { height: own, step, held, fresh, open } = self;
        let end = |rows: usize| rows == height || rows.is_multiple_of(BLOCK);
        let one = step.is_multiple_of(BLOCK)
            && (1..=height.next_multiple_of(BLOCK)).contains(step)
            && end(held.end)
            && held.end <= height
            && fresh < &held.end;
        let start = fresh.saturating_sub(Self::SHARED * BLOCK);
        let seen = if *fresh == 0 { 0 } else { fresh.saturating_sub(BLOCK) };
        *own == height && one && fresh.is_multiple_of(BLOCK) && held.start == start && *open == seen
    }

    /// Rows that are held.
    pub(super) fn held(&self) -> Range<usize> {
        self.held.clone()
    }

    /// Rows that are to be looked at.
    pub(super) fn fresh(&self) -> Range<usize> {
        self.fresh..self.held.end
    }

    /// Rows whose colours are to be finished: all but those whose neighbours below are not held.
    pub(super) fn finished(&self) -> Range<usize> {
        self.open..if self.held.end == self.height { self.height } else { self.held.end - BLOCK }
    }

    /// Whether all of the picture is held.
    pub(super) fn is_whole(&self) -> bool {
        self.held == (0..self.height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_look_at_every_row_once_and_finish_every_row_once() {
        for height in [1, 31, 32, 33, 64, 65, 100, 1000] {
            for rows in [1, 32, 33, 64, 200, 5000] {
                let (mut looked, mut finished) = (0, 0);
                let mut window = Some(Window::first(height, rows));
                while let Some(w) = window {
                    assert!(w.holds(height), "{w:?}");
                    assert_eq!((w.fresh().start, w.finished().start), (looked, finished));
                    (looked, finished) = (w.fresh().end, w.finished().end);
                    // Neighbours of what is finished are held, or outside of the picture.
                    let (first, last) = (w.finished().start, w.finished().end);
                    assert!(first < last && (first == 0 || w.held().contains(&(first - 1))));
                    assert!(last == height || w.held().contains(&last));
                    assert!(w.held().len() <= rows.next_multiple_of(BLOCK) + 2 * BLOCK);
                    window = w.next();
                }
                assert_eq!((looked, finished), (height, height));
            }
        }
    }

    #[test]
    fn a_window_that_was_changed_is_not_believed() {
        let window = Window::first(100, 32).next().unwrap();
        assert!(window.holds(100) && !window.holds(99));
        for wrong in [
            Window { held: 1..64, ..window.clone() },
            Window { held: 0..95, ..window.clone() },
            Window { fresh: 32, ..window.clone() },
            Window { open: 0, ..window.clone() },
            Window { step: 0, ..window.clone() },
        ] {
            assert!(!wrong.holds(100), "{wrong:?}");
        }
    }
}
