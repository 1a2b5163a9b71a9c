//! The one interpreter of tapes.
use crate::expr::{Binary, Unary};
use crate::tape::{Op, Tape};
use antumbra_interval::Interval;

/// A kind of number on which the operators of the language are implemented.
///
/// For enclosures the law is: if every operand encloses its true value, so does the result, wherever the operator is
/// defined.
pub trait Number: Copy {
    /// A constant, known by its enclosure.
    fn constant(value: Interval) -> Self;
    /// An operator of one argument.
    fn unary(self, op: Unary) -> Self;
    /// An integer power.
    fn powi(self, n: i32) -> Self;
    /// An operator of two arguments.
    fn binary(self, op: Binary, other: Self) -> Self;
}

/// Runs a tape on the given coordinates. `slots` is scratch memory; it is resized as needed and its old content does
/// not matter. Time and memory are linear in the tape; no allocation once `slots` is large enough.
#[inline]
pub fn run<N: Number>(tape: &Tape, point: [N; 3], slots: &mut Vec<N>) -> N {
    watch(tape, point, slots, |_, _, _| {})
}

/// The same; each clause is shown with its two operands (of no meaning where it has fewer) and its value.
#[inline]
pub(super) fn watch<N: Number>(
    tape: &Tape,
    point: [N; 3],
    slots: &mut Vec<N>,
    mut seen: impl FnMut(Op, [N; 2], N),
) -> N {
    let constants = tape.constants();
    slots.resize(tape.slots().max(slots.len()), point[0]);
    let slots = slots.as_mut_slice();
    let mut value = point[0];
    for clause in tape.clauses() {
        let (a, b) = (clause.a as usize, clause.b as usize);
        value = match clause.op {
            Op::Constant(index) => N::constant(constants[index as usize]),
            Op::Axis(axis) => point[axis as usize],
            Op::Unary(op) => slots[a].unary(op),
            Op::Powi(n) => slots[a].powi(n),
            Op::Binary(op) => slots[a].binary(op, slots[b]),
        };
        seen(clause.op, [slots[a], slots[b]], value);
        slots[clause.out as usize] = value;
    }
    value
}
