//! Tapes from clauses, checked.
use super::{Clause, MAX_CLAUSES, Op, Tape};
use antumbra_interval::Interval;
use std::fmt;

/// Why clauses are not a tape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TapeError {
    /// No clause, so no value.
    Empty,
    /// More than [`MAX_CLAUSES`] clauses.
    TooLong {
        /// How many there are.
        clauses: usize,
    },
    /// A clause reads a slot that no earlier clause wrote.
    UnwrittenSlot {
        /// Place of the clause.
        clause: usize,
        /// The slot it reads.
        slot: u32,
    },
    /// A clause names a slot as large as the number of clauses or larger; that many are never needed.
    SlotTooLarge {
        /// Place of the clause.
        clause: usize,
        /// The slot it names.
        slot: u32,
    },
    /// A clause names a constant that there is not.
    NoConstant {
        /// Place of the clause.
        clause: usize,
        /// The constant's index.
        constant: u32,
    },
}

impl fmt::Display for TapeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => f.write_str("a tape needs at least one clause"),
            Self::TooLong { clauses } => write!(f, "{clauses} clauses are more than a tape's {MAX_CLAUSES}"),
            Self::UnwrittenSlot { clause, slot } => {
                write!(f, "clause {clause} reads slot {slot}, which no earlier clause wrote")
            }
            Self::SlotTooLarge { clause, slot } => {
                write!(f, "clause {clause} names slot {slot}; a tape needs no more slots than clauses")
            }
            Self::NoConstant { clause, constant } => {
                write!(f, "clause {clause} names constant {constant}, which does not exist")
            }
        }
    }
}

impl std::error::Error for TapeError {}

impl Op {
    /// How many of a clause's operands the operation reads.
    #[must_use]
    pub const fn operands(self) -> usize {
        match self {
            Self::Constant(_) | Self::Axis(_) => 0,
            Self::Unary(_) | Self::Powi(_) => 1,
            Self::Binary(_) => 2,
        }
    }
}

impl Clause {
    /// The slots that the clause reads, in order.
    pub fn operands(self) -> impl Iterator<Item = u32> {
        [self.a, self.b].into_iter().take(self.op.operands())
    }
}

impl Tape {
    /// A tape of the given clauses; operands that an operation does not read become 0.
    ///
    /// Whether it is continuous everywhere is decided from the operators alone: each must be total and continuous
    /// ([`Unary::is_total_and_continuous`](crate::expr::Unary::is_total_and_continuous)); an integer power is if its exponent
    /// is not negative.
    ///
    /// # Errors
    /// See [`TapeError`].
    pub fn from_clauses(clauses: Vec<Clause>, constants: Vec<Interval>) -> Result<Self, TapeError> {
        let continuous = clauses.iter().all(|clause| match clause.op {
            Op::Constant(_) | Op::Axis(_) => true,
            Op::Unary(op) => op.is_total_and_continuous(),
            Op::Powi(n) => n >= 0,
            Op::Binary(op) => op.is_total_and_continuous(),
        });
        Self::checked(clauses, constants, continuous)
    }

    pub(super) fn checked(
        mut clauses: Vec<Clause>,
        constants: Vec<Interval>,
        continuous: bool,
    ) -> Result<Self, TapeError> {
        if clauses.is_empty() {
            return Err(TapeError::Empty);
        }
        if clauses.len() > MAX_CLAUSES {
            return Err(TapeError::TooLong { clauses: clauses.len() });
        }
        let mut written = vec![false; clauses.len()];
        for (i, clause) in clauses.iter().enumerate() {
            for slot in clause.operands() {
                if !written.get(slot as usize).is_some_and(|w| *w) {
                    return Err(TapeError::UnwrittenSlot { clause: i, slot });
                }
            }
            match written.get_mut(clause.out as usize) {
                Some(w) => *w = true,
                None => return Err(TapeError::SlotTooLarge { clause: i, slot: clause.out }),
            }
            if let Op::Constant(constant) = clause.op
                && constant as usize >= constants.len()
            {
                return Err(TapeError::NoConstant { clause: i, constant });
            }
        }
        // What an operation does not read names a slot that there is: evaluators may look at it.
        for clause in &mut clauses {
            let read = clause.op.operands();
            (clause.a, clause.b) = (if read > 0 { clause.a } else { 0 }, if read > 1 { clause.b } else { 0 });
        }
        let slots = clauses.iter().map(|c| c.out as usize + 1).max().unwrap_or(0);
        Ok(Self { clauses, constants, slots, continuous })
    }
}
