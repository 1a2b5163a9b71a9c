//! Many questions of shadow searches at once: quadratic forms, jets and slopes of both over pieces of beams, affine forms and their
//! slopes over pieces of shafts, and plain jets at points.
//!
//! As [`batch`](super::batch): every lane has the bits of the one interpreter on single numbers.
use super::Number;
use super::batch::{FEWEST, Occupancy, Unasked, in_vectors, run_clauses};
use crate::tape::{Op, Tape};
use antumbra_interval::affine::{Affine, Jet, Slope, SlopeOf};
use antumbra_interval::lanes::Level;
use antumbra_interval::lanes::block::{Arithmetic, Block, MOST, Packed};
use antumbra_interval::quadratic::Quadratic;
use antumbra_interval::{Interval, PointJet};

/// Scratch memory of batches.
#[derive(Debug, Default)]
pub(super) struct Blocks {
    quadratics: Block<Quadratic>,
    quadratic_slopes: Block<SlopeOf<Interval, Quadratic>>,
    jets: Block<Jet<Affine<3>>>,
    jet_slopes: Block<SlopeOf<Interval, Jet<Affine<3>>>>,
    points: Block<PointJet>,
    shafts: Block<Affine<5>>,
    shaft_slopes: Block<Slope<Affine<5>, 5>>,
}

/// Kinds of number with a block of their own.
pub(super) trait Blocked: Number + Packed {
    fn block(of: &mut Blocks) -> &mut Block<Self>;
    /// What these kinds have in vectors; the rest is done lane by lane.
    fn in_vectors(op: Op) -> Option<Arithmetic> {
        use Arithmetic::{Add, Mul, Neg, Sqr, Sub};
        in_vectors(op).filter(|op| matches!(op, Neg | Add | Sub | Mul | Sqr))
    }
}

macro_rules! blocked {
    ($($field:ident: $kind:ty),* $(,)?) => { $(
        impl Blocked for $kind {
            fn block(of: &mut Blocks) -> &mut Block<Self> {
                &mut of.$field
            }
        }
    )* };
}
blocked!(
    quadratics: Quadratic,
    quadratic_slopes: SlopeOf<Interval, Quadratic>,
    jets: Jet<Affine<3>>,
    jet_slopes: SlopeOf<Interval, Jet<Affine<3>>>,
    points: PointJet,
    shaft_slopes: Slope<Affine<5>, 5>,
);

impl Blocked for Affine<5> {
    fn block(of: &mut Blocks) -> &mut Block<Self> {
        &mut of.shafts
    }
    fn in_vectors(op: Op) -> Option<Arithmetic> {
        in_vectors(op)
    }
}

/// What runs of all kinds share.
pub(super) struct Runs<'a> {
    pub(super) level: Level,
    pub(super) places: &'a mut Vec<usize>,
    pub(super) occupancy: &'a mut Occupancy,
    pub(super) blocks: &'a mut Blocks,
}

impl Runs<'_> {
    /// Answers all questions but a few at the end: the tape's value at each point, or what of it is wanted.
    pub(super) fn answer<F: Blocked, T>(
        self,
        tape: &Tape,
        points: &[[F; 3]],
        out: &mut [T],
        wanted: impl Fn(F) -> T,
    ) -> Unasked {
        let block = F::block(self.blocks);
        for (points, out) in points.chunks(MOST).zip(out.chunks_mut(MOST)) {
            let lanes = points.len();
            if lanes < FEWEST {
                return Unasked(lanes);
            }
            self.occupancy.count(lanes);
            block.prepare(3 + tape.slots(), lanes);
            (0..3).for_each(|axis| block.load(axis, lanes, |lane| points[lane][axis]));
            let value = run_clauses(tape, block, lanes, self.level, self.places, (0, 3), F::in_vectors);
            out.iter_mut().enumerate().for_each(|(lane, out)| *out = wanted(block.get(value, lane)));
        }
        Unasked(0)
    }
}
