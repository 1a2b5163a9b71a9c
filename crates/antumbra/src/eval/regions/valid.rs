//! A tape and the box in which it stands for the function.
use crate::eval::machine::watch;
use crate::expr::{Binary, Unary};
use crate::geom::Box3;
use crate::tape::{Fate, Op, Tape};
use antumbra_interval::{Decorated, Interval};
use std::sync::Arc;

/// A tape that stands for a function inside a box. There is no way to the tape but to ask with a box, and no way to a tape for
/// a smaller box but the proofs of [`shortened`](Self::shortened).
#[derive(Clone, Debug)]
pub(super) struct Valid {
    region: Box3,
    tape: Arc<Tape>,
}

impl Valid {
    /// A function's own tape, which stands for it everywhere.
    pub(super) fn everywhere(tape: Arc<Tape>) -> Self {
        Self { region: Box3([Interval::ENTIRE; 3]), tape }
    }

    /// The tape, for a question about nothing outside of the region.
    #[inline]
    pub(super) fn on(&self, question: &Box3) -> Option<&Tape> {
        // The comparisons are of the bounds themselves, so exact. An empty part of a question is no question.
        let inside = (0..3).all(|k| question[k].is_subset_of(self.region[k]) && !question[k].is_empty());
        inside.then_some(&*self.tape)
    }

    /// Operations of the tape.
    pub(super) fn length(&self) -> usize {
        self.tape.clauses().len()
    }

    /// What a choice of the policy needs to know. (Not a way to run the tape: that takes a question.)
    pub(super) fn judged<R>(&self, by: impl FnOnce(&Tape) -> R) -> R {
        by(&self.tape)
    }

    /// The function in the common part of this region and another one, with what can be decided there. `None` if there is no
    /// common part.
    ///
    /// Each step keeps, at every point of the region, both the value and whether there is one. Enclosures hold at the points where
    /// an operand is defined; that an operand is defined *throughout* the region is proved by its decoration, or by the whole
    /// function being defined everywhere (an operation is undefined where an operand is). With `a` in `A` and `b` in `B`:
    ///
    /// * `max(a, b)` is `a` where `A >= B` (each number of A, each of B) and b is defined throughout: where a is undefined so is
    ///   the maximum, elsewhere `a >= b`. Likewise with a and b exchanged, and for `min`.
    /// * `|a|` is `a` where `A >= 0` and `-a` where `A <= 0`.
    /// * An operation defined throughout whose enclosure is one number *is* that number: `sign`, `floor`, `max(a, 0)`.
    /// * `a + 0`, `a - 0`, `a * 1` are `a` where the 0 or 1 is defined throughout.
    ///
    /// What only the parts left out depended on is left out too.
    pub(super) fn shortened(&self, region: &Box3, slots: &mut Vec<Decorated>) -> Option<Self> {
        let region = self.region.intersection(*region)?;
        let mut fates = Vec::with_capacity(self.length());
        let total = self.tape.is_continuous_everywhere();
        watch(&self.tape, region.0.map(Decorated::from), slots, |op, operands, value| {
            fates.push(fate(op, operands, value, total));
        });
        if fates.iter().all(|fate| *fate == Fate::Keep) {
            return Some(Self { region, tape: self.tape.clone() });
        }
        Some(Self { region, tape: Arc::new(self.tape.rewritten(&fates)) })
    }
}

/// What an operation comes to, by the rules of [`Valid::shortened`]; `total` if everything is defined everywhere.
fn fate(op: Op, [a, b]: [Decorated; 2], value: Decorated, total: bool) -> Fate {
    let defined = |x: Decorated| (total || x.certainly_defined()) && !x.interval.is_empty();
    let is = |x: Decorated, number: f64| defined(x) && x.interval.lo() == number && x.interval.hi() == number;
    // Every number of x is at least every number of y.
    let above = |x: Decorated, y: Decorated| {
        !x.interval.is_empty() && !y.interval.is_empty() && x.interval.lo() >= y.interval.hi()
    };
    if matches!(op, Op::Constant(_) | Op::Axis(_)) {
        return Fate::Keep;
    }
    if defined(value) && value.interval.is_point() && value.interval.lo().is_finite() {
        return Fate::Number(value.interval.lo());
    }
    let zero = Decorated::from(Interval::ZERO);
    match op {
        Op::Binary(Binary::Max) if above(a, b) && defined(b) => Fate::First,
        Op::Binary(Binary::Max) if above(b, a) && defined(a) => Fate::Second,
        Op::Binary(Binary::Min) if above(b, a) && defined(b) => Fate::First,
        Op::Binary(Binary::Min) if above(a, b) && defined(a) => Fate::Second,
        Op::Unary(Unary::Abs) if above(a, zero) => Fate::First,
        Op::Unary(Unary::Abs) if above(zero, a) => Fate::Minus,
        Op::Binary(Binary::Add | Binary::Sub) if is(b, 0.0) => Fate::First,
        Op::Binary(Binary::Add) if is(a, 0.0) => Fate::Second,
        Op::Binary(Binary::Mul) if is(b, 1.0) => Fate::First,
        Op::Binary(Binary::Mul) if is(a, 1.0) => Fate::Second,
        _ => Fate::Keep,
    }
}
