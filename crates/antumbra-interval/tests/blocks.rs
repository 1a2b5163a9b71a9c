//! Blocks against the scalar operators: the same bits in every lane, on every level that this machine has.
mod nasty;

use antumbra_interval::affine::{Affine, Dual, Jet, SlopeOf};
use antumbra_interval::lanes::Level;
use antumbra_interval::lanes::block::{Arithmetic, Block, MOST, Packed};
use antumbra_interval::quadratic::Quadratic;
use antumbra_interval::{Interval, PointJet};
use nasty::Generator;

/// Numbers that break things, among ordinary ones.
fn number(g: &mut Generator) -> f64 {
    if g.below(3) == 0 { g.number() } else { g.moderate() }
}

fn affine<const N: usize>(g: &mut Generator) -> Affine<N> {
    match g.below(12) {
        0 => Affine::UNKNOWN,
        1 => -Affine::UNKNOWN,
        2 => Affine::constant(g.any()),
        3 => Affine::symbol(g.below(N as u64) as usize),
        _ => {
            let e = if g.below(4) == 0 { 0.0 } else { number(g).abs() };
            Affine::linear(number(g), std::array::from_fn(|_| if g.below(4) == 0 { 0.0 } else { number(g) }), e)
        }
    }
}

/// Such as renderers meet: narrow and wide beside the distance from 0, which lies in few of them.
fn ordinary<const N: usize>(g: &mut Generator) -> Affine<N> {
    let c = if g.below(2) == 0 { g.unit() + 0.01 } else { -50.0 * g.unit() };
    let width = c * [1e-17, 1e-15, 1e-9, 1e-3, 0.1, 0.5, 0.9, 0.999, 1.001, 3.0, 1e6][g.below(11) as usize];
    let (share, rest) = (g.unit(), [0.0, 1e-18, 1e-3][g.below(3) as usize]);
    let a = std::array::from_fn(|i| if i == 0 { width * share } else { width * (1.0 - share) / N as f64 });
    Affine::linear(c, a, width.abs() * rest)
}

fn dual<const N: usize>(g: &mut Generator) -> Dual<N> {
    Dual { value: affine(g), derivative: if g.below(4) == 0 { Affine::ZERO } else { affine(g) } }
}

fn quadratic(g: &mut Generator) -> Quadratic {
    match g.below(12) {
        0 => Quadratic::UNKNOWN,
        1 => -Quadratic::UNKNOWN,
        2 => Quadratic::constant(g.any()),
        3 => Quadratic::from(affine::<3>(g)),
        _ => {
            let e = if g.below(4) == 0 { 0.0 } else { number(g).abs() };
            let mut some = || if g.below(4) == 0 { 0.0 } else { number(g) };
            Quadratic::polynomial(some(), std::array::from_fn(|_| some()), std::array::from_fn(|_| some()), e)
        }
    }
}

fn jet<const N: usize>(g: &mut Generator) -> Jet<Affine<N>> {
    let mut some = || if g.below(4) == 0 { Affine::ZERO } else { affine(g) };
    Jet { value: some(), first: some(), second: some() }
}

/// Apexes of every kind: such as every lane takes, and such as the scalar operator takes.
fn slope<F>(g: &mut Generator, form: impl Fn(&mut Generator) -> F) -> SlopeOf<Interval, F> {
    let apex = match g.below(8) {
        0 => g.any(),
        1 => Interval::ZERO,
        _ => Interval::point(g.moderate()),
    };
    SlopeOf { apex, value: form(g), slope: form(g) }
}

fn point_jet(g: &mut Generator) -> PointJet {
    let mut some = || if g.below(6) == 0 { 0.0 } else { number(g) };
    PointJet { value: some(), first: some(), second: some() }
}

/// Every operation on blocks of every length, in place and not, against the operator.
fn agree<F: Packed + std::fmt::Debug>(any: impl Fn(&mut Generator) -> F, seed: u64, rounds: usize) {
    let mut g = Generator(seed);
    let mut block = Block::<F>::default();
    for level in Level::all() {
        for round in 0..rounds {
            let lanes = round % MOST + 1;
            let operands: [Vec<F>; 3] = std::array::from_fn(|_| (0..lanes).map(|_| any(&mut g)).collect());
            for op in 0..=Arithmetic::ALL.len() + 8 {
                // Results in a slot of their own, or in that of an operand.
                let out = [3, 0, 1][round % 3];
                block.prepare(4, lanes);
                for (slot, operand) in operands.iter().enumerate() {
                    operand.iter().enumerate().for_each(|(lane, x)| block.set(slot, lane, *x));
                    block.pad(slot, lanes);
                }
                let ring = Arithmetic::ALL.get(op).copied();
                let n = op as i32 - Arithmetic::ALL.len() as i32;
                match ring {
                    Some(ring) => block.arithmetic(level, ring, out, 0, 1),
                    None if n == 0 => block.coordinate(level, out, 0, 1, 2),
                    None => block.power(level, lanes, n, out, 0),
                }
                for (lane, ((a, b), c)) in operands[0].iter().zip(&operands[1]).zip(&operands[2]).enumerate() {
                    let (a, b, c) = (*a, *b, *c);
                    let wanted = match ring {
                        Some(ring) => F::arithmetic(ring, a, b),
                        None if n == 0 => F::coordinate(a, b, c),
                        None => a.power(n),
                    };
                    let got = block.get(out, lane);
                    // Only plain jets know a NaN, and nothing depends on which.
                    let same = (0..F::COMPONENTS).all(|i| {
                        let (x, y) = (got.component(i), wanted.component(i));
                        x.to_bits() == y.to_bits() || (x.is_nan() && y.is_nan())
                    });
                    let question = || format!("{level:?} {ring:?} {n} lane {lane} of {lanes}: {a:?} {b:?} {c:?}");
                    assert!(same, "{}: {got:?} instead of {wanted:?}", question());
                }
            }
        }
    }
}

#[test]
fn intervals() {
    agree(Generator::any, 1, 1000);
    // Such as renderers meet: no lane is left to the scalar operator.
    let ordinary = |g: &mut Generator| {
        if g.below(6) == 0 {
            return Interval::ZERO;
        }
        let (a, b) = (number(g), number(g));
        if a <= b { Interval::new(a, b) } else { Interval::new(b, a) }
    };
    agree(ordinary, 2, 1000);
}

/// All pairs of intervals with ends of every kind, also such as no operator makes. All lanes hold the same one, so that vectors take the
/// short ways that are for vectors of one kind.
#[test]
fn intervals_with_all_ends() {
    let sizes = [0.0, f64::from_bits(1), 1e-200, 1e-150, 0.75, 3.0, 1e160, f64::MAX, f64::INFINITY];
    let ends = sizes.iter().flat_map(|&x| [-x, x]).chain([f64::NAN]).collect::<Vec<_>>();
    let pairs = ends.iter().flat_map(|&lo| ends.iter().map(move |&hi| [lo, hi]));
    // The empty one is [+inf, -inf]; of others no lower end is +inf, no upper one -inf.
    let inner =
        |lo: f64, hi: f64| lo != f64::INFINITY && hi != f64::NEG_INFINITY && (lo <= hi || lo.is_nan() || hi.is_nan());
    let some = pairs.filter(|[lo, hi]| inner(*lo, *hi)).map(|ends| Interval::from_components(|i| ends[i]));
    let intervals = some.chain([Interval::EMPTY]).collect::<Vec<_>>();
    let mut block = Block::<Interval>::default();
    block.prepare(3, 1);
    for level in Level::all() {
        for &a in &intervals {
            for &b in &intervals {
                for op in Arithmetic::ALL {
                    // Of a uniform slot and of one that is not.
                    block.fill(0, a);
                    block.load(1, 1, |_| b);
                    block.arithmetic(level, op, 2, 0, 1);
                    let (got, wanted) = (block.get(2, 0), Interval::arithmetic(op, a, b));
                    let same = (0..2).all(|i| {
                        let (x, y) = (got.component(i), wanted.component(i));
                        x.to_bits() == y.to_bits() || (x.is_nan() && y.is_nan())
                    });
                    assert!(same, "{level:?} {op:?} {a:?} {b:?}: {got:?} instead of {wanted:?}");
                }
            }
        }
    }
}

/// A uniform slot is as good as one that was written lane by lane, also where it receives a result or one lane of its own.
#[test]
fn uniform_slots() {
    let one = |lane: usize| Interval::new(1.0 + lane as f64, 2.0 + lane as f64);
    for level in Level::all() {
        for lanes in [1, 8, 9, 64] {
            let mut block = Block::<Interval>::default();
            block.prepare(3, lanes);
            block.load(0, lanes, one);
            for (out, a, b) in [(2, 0, 1), (1, 0, 1), (1, 1, 1), (1, 1, 0)] {
                block.fill(1, Interval::new(3.0, 4.0));
                let operand = |slot: usize, lane: usize| if slot == 0 { one(lane) } else { Interval::new(3.0, 4.0) };
                block.arithmetic(level, Arithmetic::Mul, out, a, b);
                let mut asked = 0;
                block.read(out, lanes, |lane, x| {
                    assert_eq!(x, operand(a, lane) * operand(b, lane), "{level:?} {out} {a} {b} lane {lane}");
                    asked += 1;
                });
                assert_eq!(asked, lanes);
            }
            block.fill(1, Interval::ONE);
            block.set(1, lanes - 1, Interval::ZERO);
            (0..lanes - 1).for_each(|lane| assert_eq!(block.get(1, lane), Interval::ONE));
            assert_eq!(block.get(1, lanes - 1), Interval::ZERO);
        }
    }
}

/// Parameters from their ends: those of the scalar function.
#[test]
fn parameters() {
    let mut g = Generator(15);
    for level in Level::all() {
        for _ in 0..500 {
            let ends: [Interval; 9] = std::array::from_fn(|_| g.bounded());
            let mut block = Block::<Affine<3>>::default();
            block.prepare(1, ends.len());
            block.load(0, ends.len(), |lane| ends[lane]);
            block.spanning(level, 0);
            for (lane, &ends) in ends.iter().enumerate() {
                let (got, wanted) = (block.get(0, lane), Affine::<3>::spanning(0, ends));
                assert!(
                    (0..5).all(|i| got.component(i).to_bits() == wanted.component(i).to_bits()),
                    "{level:?} {ends:?}"
                );
            }
        }
    }
}

#[test]
fn affine_forms() {
    agree(affine::<1>, 3, 500);
    agree(affine::<3>, 4, 500);
    agree(affine::<5>, 5, 500);
    agree(ordinary::<1>, 8, 500);
    agree(ordinary::<3>, 9, 1000);
}

#[test]
fn values_with_derivatives() {
    agree(dual::<1>, 6, 500);
    agree(|g| Dual { value: ordinary::<1>(g), derivative: ordinary(g) }, 10, 500);
}

#[test]
fn quadratic_forms() {
    agree(quadratic, 8, 400);
    agree(|g| slope(g, quadratic), 9, 400);
}

#[test]
fn jets() {
    agree(jet::<3>, 10, 400);
    agree(|g| slope(g, jet::<3>), 11, 400);
}

/// Also from apexes and values whose powers are those of narrow ranges, and of ranges beside 0.
#[test]
fn slopes_from_forms() {
    agree(|g| SlopeOf { apex: affine::<5>(g), value: affine::<5>(g), slope: affine(g) }, 13, 300);
    agree(|g| SlopeOf { apex: ordinary::<5>(g), value: ordinary::<5>(g), slope: affine(g) }, 14, 300);
}

#[test]
fn plain_jets() {
    agree(point_jet, 12, 400);
}

#[test]
fn lanes_one_by_one_and_constants() {
    let mut block = Block::<Affine<3>>::default();
    for lanes in [1, 7, 8, 9, 64] {
        block.prepare(3, lanes);
        block.fill(0, Affine::constant(Interval::new(1.0, 2.0)));
        block.map(lanes, 1, 0, Affine::sqrt);
        block.map2(lanes, 2, 1, 0, |a, b| a / b);
        let root = Affine::<3>::constant(Interval::new(1.0, 2.0)).sqrt();
        for lane in 0..lanes {
            assert_eq!(block.get(1, lane), root);
            assert_eq!(block.get(2, lane), root / Affine::constant(Interval::new(1.0, 2.0)));
        }
    }
}
