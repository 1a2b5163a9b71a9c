//! Shorter tapes: operations replaced by simpler ones, and what nobody reads any more left out.
use super::slots::{Step, allot};
use super::{Op, Tape};
use crate::expr::{Binary, Unary};
use antumbra_interval::Interval;

/// What becomes of an operation. Whether that is right is for the caller to prove.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fate {
    /// It stays.
    Keep,
    /// Its value is that of its first operand.
    First,
    /// Its value is that of its second operand.
    Second,
    /// Its value is minus that of its first operand.
    Minus,
    /// Its value is this number.
    Number(f64),
}

impl Tape {
    /// The tape with each clause replaced as told, one fate per clause in order; clauses whose values are no longer read are
    /// gone. It keeps the flag of continuity: a statement about the function that this tape stands for somewhere.
    ///
    /// Cost: linear in the length of the tape.
    pub(crate) fn rewritten(&self, fates: &[Fate]) -> Self {
        assert_eq!(fates.len(), self.clauses.len(), "one fate per clause");
        let mut constants = self.constants.clone();
        let mut steps: Vec<Step> = Vec::with_capacity(fates.len());
        // The step whose value a slot holds.
        let mut place = vec![0_u32; self.slots];
        for (clause, fate) in self.clauses.iter().zip(fates) {
            let (a, b) = (place[clause.a as usize], place[clause.b as usize]);
            let step = match *fate {
                Fate::First => Err(a),
                Fate::Second => Err(b),
                Fate::Keep => Ok(Step { op: clause.op, a, b }),
                Fate::Minus => Ok(Step { op: Op::Unary(Unary::Neg), a, b: 0 }),
                Fate::Number(value) => {
                    constants.push(Interval::point(value));
                    Ok(Step { op: Op::Constant(constants.len() as u32 - 1), a: 0, b: 0 })
                }
            };
            place[clause.out as usize] = step.map_or_else(
                |same| same,
                |step| {
                    steps.push(step);
                    steps.len() as u32 - 1
                },
            );
        }
        let root = self.clauses.last().map_or(0, |last| place[last.out as usize] as usize);
        steps.truncate(root + 1);
        Self::of_steps(&steps, &constants, self.continuous)
    }

    /// The functions of which this one is the minimum, or whatever operation is asked for, by its outermost operations: itself, if it is none.
    /// Where they would be more than `most`, some of them stay together. Each keeps the flag of continuity, which is one of all operations.
    /// Equal ones come once. `None` where they have more than `longest` operations together.
    ///
    /// Cost: the length of the tape for each of them.
    pub(crate) fn terms(&self, op: Binary, most: usize, longest: usize) -> Option<Vec<Self>> {
        let (mut stack, mut terms): (_, Vec<Self>) = (vec![self.clone()], Vec::new());
        let mut together = 0;
        while let Some(tape) = stack.pop() {
            let is_one = tape.clauses.last().is_some_and(|clause| clause.op == Op::Binary(op));
            if !is_one || stack.len() + terms.len() + 2 > most {
                let same = |term: &Self| term.clauses == tape.clauses && term.constants == tape.constants;
                if !terms.iter().any(same) {
                    together += tape.clauses.len();
                    terms.push(tape);
                }
                if together > longest {
                    return None;
                }
                continue;
            }
            let mut fates = vec![Fate::Keep; tape.clauses.len()];
            for operand in [Fate::Second, Fate::First] {
                if let Some(last) = fates.last_mut() {
                    *last = operand;
                }
                stack.push(tape.rewritten(&fates));
            }
        }
        Some(terms)
    }

    /// The steps that the last one depends on, with the constants that they name.
    fn of_steps(steps: &[Step], constants: &[Interval], continuous: bool) -> Self {
        let mut needed = vec![false; steps.len()];
        if let Some(last) = needed.last_mut() {
            *last = true;
        }
        for (i, step) in steps.iter().enumerate().rev() {
            if needed[i] {
                step.operands().for_each(|operand| needed[operand as usize] = true);
            }
        }
        let mut place = vec![0_u32; steps.len()];
        let mut constant_of = vec![None; constants.len()];
        let (mut kept, mut kept_constants) = (Vec::new(), Vec::new());
        for (i, step) in steps.iter().enumerate().filter(|(i, _)| needed[*i]) {
            let op = match step.op {
                Op::Constant(index) => Op::Constant(*constant_of[index as usize].get_or_insert_with(|| {
                    kept_constants.push(constants[index as usize]);
                    kept_constants.len() as u32 - 1
                })),
                op => op,
            };
            place[i] = kept.len() as u32;
            kept.push(Step { op, a: place[step.a as usize], b: place[step.b as usize] });
        }
        let clauses = allot(&kept);
        let slots = clauses.iter().map(|c| c.out as usize + 1).max().unwrap_or(0);
        Self { clauses, constants: kept_constants, slots, continuous }
    }
}
