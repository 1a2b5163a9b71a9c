//! Many questions at once: the interpreter over blocks of lanes.
//!
//! A tape is run once for up to [`MOST`] questions. Every lane has the bits of the one interpreter on single numbers
//! ([`run`](super::run)), on every machine: so whether, and with which neighbours, a question is asked in a batch changes no answer.
use super::{Gradient, Number, ShaftPoint, ShaftSlopePoint, forms};
use crate::expr::{Binary, Unary};
use crate::geom::{Beam, Box3, Fan, axes};
use crate::tape::{Op, Tape};
use antumbra_interval::Interval;
use antumbra_interval::affine::{Affine, Dual, Slope};
use antumbra_interval::lanes::Level;
use antumbra_interval::lanes::block::{Arithmetic, Block, MOST, Packed, WIDTH};

/// Parameters `t` of a thin beam.
#[derive(Clone, Copy, Debug)]
pub struct RayPiece {
    /// The ray.
    pub ray: Beam,
    /// Parameters, bounded and not empty.
    pub t: Interval,
}

impl RayPiece {
    /// Box of its points.
    #[must_use]
    #[inline]
    pub fn region(&self) -> Box3 {
        self.ray.at(self.t)
    }

    /// Its points, as linear functions of a symbol that runs along the piece, with their derivatives by t.
    #[must_use]
    #[inline]
    pub fn point(&self) -> [Dual<1>; 3] {
        let s = Affine::<1>::spanning(0, self.t);
        axes(|k| {
            let direction = Affine::constant(self.ray.direction[k]);
            Dual { value: (s * direction).add_f64(self.ray.origin[k]), derivative: direction }
        })
    }
}

/// Parameters `t` of a fan of rays.
#[derive(Clone, Copy, Debug)]
pub struct FanPiece {
    /// The rays.
    pub fan: Fan,
    /// Parameters, bounded and not empty.
    pub t: Interval,
}

/// Parameters `t` of the beams from the hits of a tile to a part of a light.
#[derive(Clone, Copy, Debug)]
pub struct ShaftPiece {
    /// Where they start.
    pub apex: ShaftPoint,
    /// Their directions.
    pub direction: ShaftPoint,
    /// Parameters, bounded and not empty.
    pub t: Interval,
}

impl ShaftPiece {
    /// Its points.
    #[must_use]
    #[inline]
    pub fn point(&self) -> ShaftPoint {
        let t = Affine::<5>::spanning(0, self.t);
        axes(|k| t * self.direction[k] + self.apex[k])
    }

    /// The same points, with the apex split off.
    #[must_use]
    #[inline]
    pub fn slopes(&self) -> ShaftSlopePoint {
        let t = Affine::<5>::spanning(0, self.t);
        axes(|k| Slope::coordinate(self.apex[k], t, self.direction[k]))
    }
}

/// Fewer questions than these are asked one by one.
pub(super) const FEWEST: usize = 3;

/// Slots before those of the tape: the parameter, three directions, three starting points, three coordinates.
pub(super) const OWN: usize = 10;
/// The first of the coordinates.
pub(super) const AXES: usize = 7;

/// How full batches were.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Occupancy {
    /// Questions that were answered in batches.
    pub questions: u64,
    /// Lanes of the vectors that answered them: eight for each vector begun.
    pub lanes: u64,
}

impl std::ops::AddAssign for Occupancy {
    fn add_assign(&mut self, o: Self) {
        self.questions += o.questions;
        self.lanes += o.lanes;
    }
}

impl Occupancy {
    pub(super) fn count(&mut self, questions: usize) {
        self.questions += questions as u64;
        self.lanes += questions.next_multiple_of(WIDTH) as u64;
    }
}

/// Scratch memory of batches.
#[derive(Debug)]
pub(super) struct Scratch {
    pub(super) occupancy: Occupancy,
    /// How often each tape is run on the same lanes: once, unless it is timed.
    pub(super) times: usize,
    level: Level,
    ranges: Block<Interval>,
    rays: Block<Dual<1>>,
    beams: Block<Affine<3>>,
    forms: forms::Blocks,
    /// Which slot holds the value of a slot of the tape.
    places: Vec<usize>,
}

impl Default for Scratch {
    fn default() -> Self {
        Self::on(Level::detect())
    }
}

impl Scratch {
    pub(super) fn on(level: Level) -> Self {
        Self {
            occupancy: Occupancy::default(),
            times: 1,
            level,
            ranges: Block::default(),
            rays: Block::default(),
            beams: Block::default(),
            forms: forms::Blocks::default(),
            places: Vec::new(),
        }
    }
}

/// The operation that blocks have in vectors.
pub(super) fn in_vectors(op: Op) -> Option<Arithmetic> {
    match op {
        Op::Unary(op) => match op {
            Unary::Neg => Some(Arithmetic::Neg),
            Unary::Sqr => Some(Arithmetic::Sqr),
            Unary::Sqrt => Some(Arithmetic::Sqrt),
            Unary::Abs => Some(Arithmetic::Abs),
            _ => None,
        },
        Op::Binary(op) => match op {
            Binary::Add => Some(Arithmetic::Add),
            Binary::Sub => Some(Arithmetic::Sub),
            Binary::Mul => Some(Arithmetic::Mul),
            Binary::Div => Some(Arithmetic::Div),
            Binary::Min => Some(Arithmetic::Min),
            Binary::Max => Some(Arithmetic::Max),
            _ => None,
        },
        _ => None,
    }
}

/// Runs a tape on a block whose slots 0 to 6 hold parameter, directions and starting points; tells where the value is.
fn run_block<F: Number + Packed>(
    tape: &Tape,
    block: &mut Block<F>,
    lanes: usize,
    level: Level,
    places: &mut Vec<usize>,
) -> usize {
    for axis in 0..3 {
        block.coordinate(level, AXES + axis, 0, 1 + axis, 4 + axis);
    }
    run_clauses(tape, block, lanes, level, places, (AXES, OWN), in_vectors)
}

/// Runs a tape on a block that holds the coordinates in slots from `axes` on; slots from `own` on are those of the tape. Tells where the
/// value is.
pub(super) fn run_clauses<F: Number + Packed>(
    tape: &Tape,
    block: &mut Block<F>,
    lanes: usize,
    level: Level,
    places: &mut Vec<usize>,
    (axes, own): (usize, usize),
    in_vectors: impl Fn(Op) -> Option<Arithmetic>,
) -> usize {
    places.clear();
    places.resize(tape.slots(), 0);
    let mut last = 0;
    for clause in tape.clauses() {
        let (a, b) = (places[clause.a as usize], places[clause.b as usize]);
        let out = own + clause.out as usize;
        last = out;
        match (clause.op, in_vectors(clause.op)) {
            (_, Some(op)) => block.arithmetic(level, op, out, a, b),
            (Op::Constant(index), _) => block.fill(out, F::constant(tape.constants()[index as usize])),
            // Nothing writes the slots of the axes: they need no copy.
            (Op::Axis(axis), _) => last = axes + axis as usize,
            (Op::Unary(op), _) => block.map(lanes, out, a, |x| x.unary(op)),
            (Op::Powi(n), _) => block.power(level, lanes, n, out, a),
            (Op::Binary(op), _) => block.map2(lanes, out, a, b, |x, y| x.binary(op, y)),
        }
        places[clause.out as usize] = last;
    }
    last
}

/// Starting points: mostly one for all lanes.
fn start<F: Packed, T>(
    block: &mut Block<F>,
    pieces: &[T],
    of: impl Fn(&T) -> [Interval; 3],
    form: impl Fn(Interval) -> F,
) {
    let first = of(&pieces[0]);
    // By bits and without a branch: as many comparisons as there are numbers, of which vectors take several.
    let bits = |x: &T| of(x).map(|x| [x.lo().to_bits(), x.hi().to_bits()]);
    let wanted = bits(&pieces[0]);
    let differ = pieces.iter().fold(0, |differ, piece| {
        let found = bits(piece);
        (0..3).fold(differ, |d, k| d | (found[k][0] ^ wanted[k][0]) | (found[k][1] ^ wanted[k][1]))
    });
    for (axis, first) in first.into_iter().enumerate() {
        if differ == 0 {
            block.fill(4 + axis, form(first));
        } else {
            block.load(4 + axis, pieces.len(), |lane| form(of(&pieces[lane])[axis]));
        }
    }
}

/// What runs of all kinds share.
struct Runs<'a> {
    tape: &'a Tape,
    level: Level,
    places: &'a mut Vec<usize>,
    occupancy: &'a mut Occupancy,
    times: usize,
}

impl Runs<'_> {
    /// Answers all questions but a few at the end. `load` writes the ends of the parameter, directions and starting points into
    /// slots 0 to 6.
    fn answer<F: Number + Packed, T>(
        self,
        block: &mut Block<F>,
        pieces: &[T],
        out: &mut [F],
        load: impl Fn(&mut Block<F>, &[T]),
    ) -> Unasked {
        for (pieces, out) in pieces.chunks(MOST).zip(out.chunks_mut(MOST)) {
            let lanes = pieces.len();
            if lanes < FEWEST {
                return Unasked(lanes);
            }
            self.occupancy.count(lanes);
            block.prepare(OWN + self.tape.slots(), lanes);
            load(block, pieces);
            block.spanning(self.level, 0);
            let mut value = 0;
            for _ in 0..self.times {
                value = run_block(self.tape, block, lanes, self.level, self.places);
            }
            block.read(value, lanes, |lane, x| out[lane] = x);
        }
        Unasked(0)
    }
}

impl Scratch {
    /// Enclosures of the function over the boxes of the pieces.
    pub(super) fn ranges(&mut self, tape: &Tape, pieces: &[RayPiece], out: &mut [Interval]) -> Unasked {
        let Self { occupancy, level, ranges, places, times, .. } = self;
        Runs { tape, level: *level, places, occupancy, times: *times }.answer(ranges, pieces, out, |block, pieces| {
            block.load(0, pieces.len(), |lane| pieces[lane].t);
            (0..3).for_each(|axis| block.load(1 + axis, pieces.len(), |lane| pieces[lane].ray.direction[axis]));
            start(block, pieces, |piece| axes(|k| Interval::point(piece.ray.origin[k])), |p| p);
        })
    }

    /// Values and derivatives along the pieces.
    pub(super) fn rays(&mut self, tape: &Tape, pieces: &[RayPiece], out: &mut [Dual<1>]) -> Unasked {
        let Self { occupancy, level, rays, places, times, .. } = self;
        Runs { tape, level: *level, places, occupancy, times: *times }.answer(rays, pieces, out, |block, pieces| {
            // Of parameters and directions only the values are read.
            block.load(0, pieces.len(), |lane| pieces[lane].t);
            for axis in 0..3 {
                block.load(1 + axis, pieces.len(), |lane| Affine::<1>::constant(pieces[lane].ray.direction[axis]));
            }
            start(block, pieces, |piece| axes(|k| Interval::point(piece.ray.origin[k])), Dual::constant);
        })
    }

    /// The function as linear functions over the pieces.
    pub(super) fn beams(&mut self, tape: &Tape, pieces: &[FanPiece], out: &mut [Affine<3>]) -> Unasked {
        let Self { occupancy, level, beams, places, times, .. } = self;
        Runs { tape, level: *level, places, occupancy, times: *times }.answer(beams, pieces, out, |block, pieces| {
            block.load(0, pieces.len(), |lane| pieces[lane].t);
            (0..3).for_each(|axis| block.load(1 + axis, pieces.len(), |lane| pieces[lane].fan.direction[axis]));
            start(block, pieces, |piece| axes(|k| piece.fan.apex[k]), Affine::constant);
        })
    }
}

impl Scratch {
    /// Answers to questions of the second-order search.
    pub(super) fn forms(&mut self) -> forms::Runs<'_> {
        let Self { occupancy, level, forms: blocks, places, .. } = self;
        forms::Runs { level: *level, places, occupancy, blocks }
    }
}

/// Interval slots of a gradient: value and partial derivatives.
const PARTS: usize = 4;
/// Interval slots before those of the tape: the coordinates, and three for intermediate results.
const OWN_OF_GRADIENTS: usize = 3 * PARTS + 3;

impl Scratch {
    /// Enclosures of value and gradient over boxes.
    pub(super) fn gradients(&mut self, tape: &Tape, regions: &[Box3], out: &mut [Gradient]) -> Unasked {
        let Self { occupancy, ranges: block, .. } = self;
        for (regions, out) in regions.chunks(MOST).zip(out.chunks_mut(MOST)) {
            let lanes = regions.len();
            if lanes < FEWEST {
                return Unasked(lanes);
            }
            occupancy.count(lanes);
            block.prepare(OWN_OF_GRADIENTS + PARTS * tape.slots(), lanes);
            for (axis, slot) in (0..3).map(|axis| (axis, PARTS * axis)) {
                block.load(slot, lanes, |lane| regions[lane][axis]);
                for k in 0..3 {
                    block.fill(slot + 1 + k, if k == axis { Interval::ONE } else { Interval::ZERO });
                }
            }
            let mut machine = Gradients { block, level: self.level, lanes };
            let mut value = 0;
            for _ in 0..self.times {
                value = machine.run(tape, &mut self.places);
            }
            out.iter_mut().enumerate().for_each(|(lane, out)| *out = machine.get(value, lane));
        }
        Unasked(0)
    }
}

/// Gradients in a block of intervals: step by step the operations of [`Gradient`]'s `Number`.
struct Gradients<'a> {
    block: &'a mut Block<Interval>,
    level: Level,
    lanes: usize,
}

impl Gradients<'_> {
    fn run(&mut self, tape: &Tape, places: &mut Vec<usize>) -> usize {
        places.clear();
        places.resize(tape.slots(), 0);
        let mut last = 0;
        for clause in tape.clauses() {
            let (a, b) = (places[clause.a as usize], places[clause.b as usize]);
            let out = OWN_OF_GRADIENTS + PARTS * clause.out as usize;
            last = out;
            match clause.op {
                Op::Constant(index) => {
                    self.block.fill(out, tape.constants()[index as usize]);
                    (1..PARTS).for_each(|k| self.block.fill(out + k, Interval::ZERO));
                }
                Op::Axis(axis) => last = PARTS * axis as usize,
                Op::Unary(Unary::Neg) => {
                    (0..PARTS).for_each(|k| self.arithmetic(Arithmetic::Neg, out + k, a + k, a + k))
                }
                Op::Unary(Unary::Sqr) => self.sqr(out, a),
                Op::Binary(Binary::Add) => {
                    (0..PARTS).for_each(|k| self.arithmetic(Arithmetic::Add, out + k, a + k, b + k))
                }
                Op::Binary(Binary::Sub) => {
                    (0..PARTS).for_each(|k| self.arithmetic(Arithmetic::Sub, out + k, a + k, b + k))
                }
                Op::Binary(Binary::Mul) => self.mul(out, a, b),
                Op::Binary(Binary::Div) => self.div(out, a, b),
                Op::Unary(op) => self.map(out, a, a, |x, _| x.unary(op)),
                Op::Powi(n @ 3..=8) => self.power(n, out, a),
                Op::Powi(n) => self.map(out, a, a, |x, _| x.powi(n)),
                Op::Binary(op) => self.map(out, a, b, |x, y| x.binary(op, y)),
            }
            places[clause.out as usize] = last;
        }
        last
    }

    fn arithmetic(&mut self, op: Arithmetic, out: usize, a: usize, b: usize) {
        self.block.arithmetic(self.level, op, out, a, b);
    }

    /// `(a b)' = a b' + a' b`; the value last, as the slots may be the same.
    fn mul(&mut self, out: usize, a: usize, b: usize) {
        let [left, right] = [3 * PARTS, 3 * PARTS + 1];
        for k in 1..PARTS {
            self.arithmetic(Arithmetic::Mul, left, a, b + k);
            self.arithmetic(Arithmetic::Mul, right, a + k, b);
            self.arithmetic(Arithmetic::Add, out + k, left, right);
        }
        self.arithmetic(Arithmetic::Mul, out, a, b);
    }

    /// `(a / b)' = (a' - (a/b) b') / b`. It is empty only where the quotient is: nowhere has the scalar operator to mend it.
    fn div(&mut self, out: usize, a: usize, b: usize) {
        let [quotient, above] = [3 * PARTS, 3 * PARTS + 1];
        self.arithmetic(Arithmetic::Div, quotient, a, b);
        for k in 1..PARTS {
            self.arithmetic(Arithmetic::Mul, above, quotient, b + k);
            self.arithmetic(Arithmetic::Sub, above, a + k, above);
            self.arithmetic(Arithmetic::Div, out + k, above, b);
        }
        self.arithmetic(Arithmetic::Div, out, a, b);
    }

    /// `(a^n)' = n a^(n-1) a'`, `3 <= n <= 8`.
    fn power(&mut self, n: i32, out: usize, a: usize) {
        let [slope, factor, lower] = [3 * PARTS, 3 * PARTS + 1, 3 * PARTS + 2];
        self.block.fill(factor, Interval::point(f64::from(n)));
        match n - 1 {
            2 => self.arithmetic(Arithmetic::Sqr, lower, a, a),
            m => self.block.power(self.level, self.lanes, m, lower, a),
        }
        self.arithmetic(Arithmetic::Mul, slope, factor, lower);
        (1..PARTS).for_each(|k| self.arithmetic(Arithmetic::Mul, out + k, slope, a + k));
        self.block.power(self.level, self.lanes, n, out, a);
    }

    /// `(a^2)' = 2 a a'`.
    fn sqr(&mut self, out: usize, a: usize) {
        let twice = 3 * PARTS;
        self.arithmetic(Arithmetic::Add, twice, a, a);
        (1..PARTS).for_each(|k| self.arithmetic(Arithmetic::Mul, out + k, twice, a + k));
        self.arithmetic(Arithmetic::Sqr, out, a, a);
    }

    fn map(&mut self, out: usize, a: usize, b: usize, f: impl Fn(Gradient, Gradient) -> Gradient) {
        for lane in 0..self.lanes {
            let x = f(self.get(a, lane), self.get(b, lane));
            self.block.set(out, lane, x.value);
            (0..3).for_each(|k| self.block.set(out + 1 + k, lane, x.partials[k]));
        }
        (0..PARTS).for_each(|k| self.block.pad(out + k, self.lanes));
    }

    fn get(&self, slot: usize, lane: usize) -> Gradient {
        let at = |k: usize| self.block.get(slot + k, lane);
        Gradient { value: at(0), partials: [at(1), at(2), at(3)] }
    }
}

/// So many questions at the end are still to be asked, one by one.
#[must_use]
pub(super) struct Unasked(pub(super) usize);
