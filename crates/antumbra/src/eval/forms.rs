//! Many questions of shadow searches at once: quadratic forms, jets and slopes of both over pieces of beams, affine forms and their
//! slopes over pieces of shafts, and plain jets at points.
//!
//! As [`batch`](super::batch): every lane has the bits of the one interpreter on single numbers.
use super::Number;
use super::batch::{FEWEST, OWN, Occupancy, ShaftPiece, Unasked, in_vectors, run_clauses};
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
        let load = |blocks: &mut Blocks, _, points: &[[F; 3]]| {
            (0..3).for_each(|axis| F::block(blocks).load(axis, points.len(), |lane| points[lane][axis]));
        };
        self.run(tape, points, out, (0, 3), load, wanted)
    }

    /// The function over pieces of shafts.
    pub(super) fn shafts(self, tape: &Tape, pieces: &[ShaftPiece], out: &mut [Affine<5>]) -> Unasked {
        let load = |blocks: &mut Blocks, level, pieces: &[ShaftPiece]| points(&mut blocks.shafts, level, pieces, 1);
        self.run(tape, pieces, out, (1, OWN), load, |x: Affine<5>| x)
    }

    /// The slope over pieces of shafts.
    pub(super) fn shaft_slopes(self, tape: &Tape, pieces: &[ShaftPiece], out: &mut [Affine<5>]) -> Unasked {
        let load = |blocks: &mut Blocks, level, pieces: &[ShaftPiece]| {
            let Blocks { shafts, shaft_slopes, .. } = blocks;
            shafts.prepare(OWN + 3, pieces.len());
            points(shafts, level, pieces, OWN);
            for axis in 0..3 {
                // Apex, value and slope of each coordinate.
                for (part, from) in [4, OWN, 1].into_iter().enumerate() {
                    shaft_slopes.put(axis, part * Affine::<5>::COMPONENTS, shafts, from + axis);
                }
            }
        };
        self.run(tape, pieces, out, (0, 3), load, |x: Slope<Affine<5>, 5>| x.slope)
    }

    /// Answers all questions but a few at the end. `load` writes the coordinates into the slots from `axes` on, of those before `own`.
    fn run<F: Blocked, Q, T>(
        self,
        tape: &Tape,
        questions: &[Q],
        out: &mut [T],
        (axes, own): (usize, usize),
        load: impl Fn(&mut Blocks, Level, &[Q]),
        wanted: impl Fn(F) -> T,
    ) -> Unasked {
        for (questions, out) in questions.chunks(MOST).zip(out.chunks_mut(MOST)) {
            let lanes = questions.len();
            if lanes < FEWEST {
                return Unasked(lanes);
            }
            self.occupancy.count(lanes);
            F::block(self.blocks).prepare(own + tape.slots(), lanes);
            load(self.blocks, self.level, questions);
            let block = F::block(self.blocks);
            let value = run_clauses(tape, block, lanes, self.level, self.places, (axes, own), F::in_vectors);
            block.read(value, lanes, |lane, x| out[lane] = wanted(x));
        }
        Unasked(0)
    }
}

/// The coordinates `p + t d` in slots from `out` on, with t in slot 0, directions from slot 1 on and starting points behind them.
fn points(block: &mut Block<Affine<5>>, level: Level, pieces: &[ShaftPiece], out: usize) {
    block.load(0, pieces.len(), |lane| pieces[lane].t);
    block.spanning(level, 0);
    for axis in 0..3 {
        block.load(1 + axis, pieces.len(), |lane| pieces[lane].direction[axis]);
        block.load(4 + axis, pieces.len(), |lane| pieces[lane].apex[axis]);
        block.arithmetic(level, Arithmetic::Mul, out + axis, 0, 1 + axis);
        block.arithmetic(level, Arithmetic::Add, out + axis, out + axis, 4 + axis);
    }
}
