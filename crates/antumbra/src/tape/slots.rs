//! Which slot holds which value: a slot is used again as soon as its value is no longer needed.
use super::{Clause, Op};

/// An operation whose operands are the places of earlier operations. Unused operands are 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    pub(super) op: Op,
    pub(super) a: u32,
    pub(super) b: u32,
}

impl Step {
    /// The places that the step reads, in order.
    pub(super) fn operands(self) -> impl Iterator<Item = u32> {
        [self.a, self.b].into_iter().take(self.op.operands())
    }
}

/// The same operations on slots. The last step is the one whose value is wanted.
pub(super) fn allot(steps: &[Step]) -> Vec<Clause> {
    let mut last_use: Vec<usize> = (0..steps.len()).collect();
    for (i, step) in steps.iter().enumerate() {
        for operand in step.operands() {
            last_use[operand as usize] = i;
        }
    }
    let mut slot_of: Vec<u32> = Vec::with_capacity(steps.len());
    let mut free: Vec<u32> = vec![];
    let mut slots = 0_u32;
    let mut clauses = Vec::with_capacity(steps.len());
    for (i, step) in steps.iter().enumerate() {
        let slot = |k: usize| step.operands().nth(k).map_or(0, |place| slot_of[place as usize]);
        let (a, b) = (slot(0), slot(1));
        // An operand that dies here gives its slot to the result; twice the same operand gives it once.
        for (k, operand) in step.operands().enumerate() {
            if last_use[operand as usize] == i && !step.operands().take(k).any(|before| before == operand) {
                free.push(slot_of[operand as usize]);
            }
        }
        let out = free.pop().unwrap_or_else(|| {
            slots += 1;
            slots - 1
        });
        slot_of.push(out);
        clauses.push(Clause { op: step.op, out, a, b });
    }
    clauses
}
