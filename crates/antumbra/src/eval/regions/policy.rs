//! Where shorter tapes pay: choices that cost or save time and never touch a proof.
use crate::expr::{Binary, Unary};
use crate::tape::{Op, Tape};

/// Shorter tapes than this are run as they are: finding another one would cost as much as running it.
const SHORT: usize = 40;
/// A formula with fewer choices than this is not divided at all.
const CHOICES: usize = 4;
/// Levels of the tree below its root.
const LEVELS: u32 = 12;
/// Share of the operations that must go, over two levels, for a region to be divided further.
const GAIN: f64 = 0.15;
/// A region reaches so far beyond its cell, in sides of the cell: a box of half that size always fits into some region.
pub(super) const OVERLAP: f64 = 0.5;

/// Operations that a smaller region may decide.
fn choices(tape: &Tape) -> usize {
    let choice = |op: Op| {
        matches!(op, Op::Binary(Binary::Min | Binary::Max) | Op::Unary(Unary::Abs | Unary::Sign | Unary::Floor))
    };
    tape.clauses().iter().filter(|clause| choice(clause.op)).count()
}

/// Whether a tape is long enough, with enough to decide, for a tree.
pub(super) fn worth(tape: &Tape) -> bool {
    tape.clauses().len() > SHORT && choices(tape) >= CHOICES
}

/// Whether a region with this tape is divided, `lengths` being those of the tapes of its parent and grandparent.
pub(super) fn divides(tape: &Tape, level: u32, lengths: [usize; 2]) -> bool {
    let now = tape.clauses().len();
    let gains = (now as f64) < (1.0 - GAIN) * lengths[1] as f64;
    level < LEVELS && now > SHORT && choices(tape) > 0 && (level < 4 || gains)
}
