//! A formula as a flat list of operations on slots: what every evaluator runs.
mod build;
mod compile;
mod constant;
mod shorten;
mod slots;
#[cfg(test)]
#[allow(clippy::disallowed_methods, reason = "a rough second opinion, compared with a tolerance")]
mod tests;

pub use build::TapeError;
pub(crate) use shorten::Fate;

use crate::expr::{Axis, Binary, Unary};
use antumbra_interval::Interval;

/// Most operations of a tape.
pub const MAX_CLAUSES: usize = 1 << 20;

/// What a [`Clause`] computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Op {
    /// The constant of that index in [`Tape::constants`].
    Constant(u32),
    /// A coordinate.
    Axis(Axis),
    /// An operator on slot `a`.
    Unary(Unary),
    /// Integer power of slot `a`, as IEEE 1788 `pown`: `a^0 = 1` everywhere; for a negative exponent undefined at `a = 0`.
    Powi(i32),
    /// An operator on slots `a`, `b`.
    Binary(Binary),
}

/// One operation: `slot[out] = op(slot[a], slot[b])`. Unused operands are 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clause {
    /// Operation.
    pub op: Op,
    /// Slot that receives the result; it may be the same as `a` or `b`.
    pub out: u32,
    /// First operand slot.
    pub a: u32,
    /// Second operand slot.
    pub b: u32,
}

/// A compiled formula: clauses in execution order; the last clause's `out` slot holds the value of the formula.
#[derive(Clone, Debug)]
pub struct Tape {
    clauses: Vec<Clause>,
    constants: Vec<Interval>,
    slots: usize,
    continuous: bool,
}

impl Tape {
    /// Operations in execution order, never empty.
    #[must_use]
    pub fn clauses(&self) -> &[Clause] {
        &self.clauses
    }

    /// Enclosures of the exact constants.
    #[must_use]
    pub fn constants(&self) -> &[Interval] {
        &self.constants
    }

    /// How many slots an evaluator needs.
    #[must_use]
    pub fn slots(&self) -> usize {
        self.slots
    }

    /// Proved, before any evaluation: defined and continuous at every point of space. `false` means "not proved".
    ///
    /// It is a statement about the real function; an evaluator that carries decorations may skip them where it holds.
    #[must_use]
    pub fn is_continuous_everywhere(&self) -> bool {
        self.continuous
    }
}
