//! Random expressions: exact rational values of polynomials, and point enclosures of everything else.
use crate::containment::{Kind, Operator, interval, member};
use antumbra::eval::{Gradient, run};
use antumbra::expr::{Axis, Binary, Unary};
use antumbra::tape::{Clause, Op, Tape};
use antumbra_interval::affine::{Affine, Dual, Jet, Slope, SlopeOf};
use antumbra_interval::quadratic::Quadratic;
use antumbra_interval::{Decorated, Interval};
use fastrand::Rng;
use num_rational::BigRational;
use num_traits::{Signed, Zero, pow};

/// A tape of `length` random operations on the coordinates and four constants, no slot used twice; each reads recent slots
/// more often.
fn tape(r: &mut Rng, length: usize, operations: &[Operator], constants: [f64; 4]) -> Tape {
    let mut clauses = vec![];
    let mut push = |op, a, b| clauses.push(Clause { op, out: clauses.len() as u32, a, b });
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        push(Op::Axis(axis), 0, 0);
    }
    for k in 0..4 {
        push(Op::Constant(k), 0, 0);
    }
    for written in 7..7 + length as u32 {
        let slot = |r: &mut Rng| if r.bool() { r.u32(0..written) } else { r.u32(written.saturating_sub(4)..written) };
        let (a, b) = (slot(r), slot(r));
        match operations[r.usize(0..operations.len())] {
            Operator::Unary(op) => push(Op::Unary(op), a, 0),
            Operator::Powi(n) => push(Op::Powi(n), a, 0),
            Operator::Binary(op) => push(Op::Binary(op), a, b),
        }
    }
    Tape::from_clauses(clauses, constants.map(Interval::point).to_vec()).unwrap()
}

/// Operators under which rational numbers stay rational.
fn rational_operators() -> Vec<Operator> {
    let unary = [Unary::Neg, Unary::Abs, Unary::Sign, Unary::Floor, Unary::Sqr].map(Operator::Unary);
    let powers = [0, 1, 2, 3, 4, 5].map(Operator::Powi);
    let binary = [Binary::Add, Binary::Sub, Binary::Mul, Binary::Div, Binary::Min, Binary::Max].map(Operator::Binary);
    // Sums and products four times as often.
    let ring = [Binary::Add, Binary::Sub, Binary::Mul].map(Operator::Binary).repeat(3);
    unary.into_iter().chain(powers).chain(binary).chain(ring).collect()
}

/// The exact value at a point; `None` where it is undefined or its numbers grow too long.
fn exact(tape: &Tape, point: &[BigRational; 3]) -> Option<BigRational> {
    let mut slots: Vec<BigRational> = vec![BigRational::zero(); tape.slots()];
    let mut value = BigRational::zero();
    for clause in tape.clauses() {
        let (a, b) = (&slots[clause.a as usize], &slots[clause.b as usize]);
        value = match clause.op {
            Op::Constant(k) => BigRational::from_float(tape.constants()[k as usize].lo())?,
            Op::Axis(axis) => point[axis as usize].clone(),
            Op::Powi(n) => pow(a.clone(), usize::try_from(n).ok()?),
            Op::Unary(op) => match op {
                Unary::Neg => -a,
                Unary::Abs => a.abs(),
                Unary::Sign => a.signum(),
                Unary::Floor => a.floor(),
                Unary::Sqr => a * a,
                _ => return None,
            },
            Op::Binary(op) => match op {
                Binary::Add => a + b,
                Binary::Sub => a - b,
                Binary::Mul => a * b,
                Binary::Div if b.is_zero() => return None,
                Binary::Div => a / b,
                Binary::Min => a.min(b).clone(),
                Binary::Max => a.max(b).clone(),
                _ => return None,
            },
        };
        if value.numer().bits() + value.denom().bits() > 40_000 {
            return None;
        }
        slots[clause.out as usize].clone_from(&value);
    }
    Some(value)
}

/// Whether `[lo, hi]` contains the rational, exactly.
fn holds(x: Interval, q: &BigRational) -> bool {
    let below = x.lo() == f64::NEG_INFINITY || BigRational::from_float(x.lo()).is_some_and(|lo| lo <= *q);
    let above = x.hi() == f64::INFINITY || BigRational::from_float(x.hi()).is_some_and(|hi| hi >= *q);
    below && above
}

fn ranges(tape: &Tape, x: [Interval; 3]) -> Vec<(&'static str, Interval)> {
    fn one<K: Kind>(tape: &Tape, x: [Interval; 3]) -> (&'static str, Interval) {
        (K::NAME, run(tape, K::over(x), &mut vec![]).range())
    }
    vec![
        one::<Interval>(tape, x),
        one::<Decorated>(tape, x),
        one::<Gradient>(tape, x),
        one::<Affine<1>>(tape, x),
        one::<Affine<3>>(tape, x),
        one::<Affine<5>>(tape, x),
        one::<Slope<Interval, 3>>(tape, x),
        one::<Slope<Affine<5>, 5>>(tape, x),
        one::<Dual<1>>(tape, x),
        one::<Quadratic>(tape, x),
        one::<SlopeOf<Interval, Quadratic>>(tape, x),
        one::<Jet<Affine<3>>>(tape, x),
        one::<SlopeOf<Interval, Jet<Affine<3>>>>(tape, x),
    ]
}

/// A box of the size of pictures, down to a few floats wide.
fn ordinary(r: &mut Rng) -> Interval {
    let a = r.f64() * 4.0 - 2.0;
    let width = [0.0, 1e-15, 1e-9, 1e-4, 0.01, 0.3, 2.0][r.usize(0..7)];
    Interval::new(a, a + width * r.f64())
}

#[test]
fn exact_values_of_rational_expressions_are_enclosed() {
    let mut r = Rng::with_seed(21);
    let operators = rational_operators();
    let mut checks = 0;
    for round in 0..4000 {
        let length = r.usize(1..12);
        let constants = std::array::from_fn(|_| r.f64() * 4.0 - 2.0);
        let tape = tape(&mut r, length, &operators, constants);
        let x: [Interval; 3] =
            std::array::from_fn(|_| if round % 4 == 0 { interval(&mut r) } else { ordinary(&mut r) });
        let ranges = ranges(&tape, x);
        for _ in 0..2 {
            let p = x.map(|x| member(&mut r, x));
            let exact_point = p.map(|v| BigRational::from_float(v).unwrap());
            let Some(value) = exact(&tape, &exact_point) else { continue };
            for (name, range) in &ranges {
                assert!(
                    holds(*range, &value),
                    "{name}: {range:?} does not contain the value at {p:?} in {x:?}: {tape:?}"
                );
                checks += 1;
            }
        }
    }
    assert!(checks > 40_000, "{checks}");
}

/// Where the expression is proved to be defined at a point, its value lies in the enclosures over the point and over the box:
/// these must meet.
#[test]
fn points_and_boxes_agree_on_every_expression() {
    let mut r = Rng::with_seed(22);
    let operators = Operator::all();
    let mut checks = 0;
    for round in 0..20_000 {
        let length = r.usize(1..10);
        let constants = std::array::from_fn(|_| r.f64() * 4.0 - 2.0);
        let tape = tape(&mut r, length, &operators, constants);
        let x: [Interval; 3] =
            std::array::from_fn(|_| if round % 4 == 0 { interval(&mut r) } else { ordinary(&mut r) });
        let p = x.map(|x| Interval::point(member(&mut r, x)));
        let at = run(&tape, p.map(Decorated::from), &mut vec![]);
        if !at.certainly_defined() {
            continue;
        }
        for (name, range) in ranges(&tape, x).into_iter().chain(ranges(&tape, p)) {
            assert!(
                range.possibly_intersects(at.interval),
                "{name}: {range:?} misses {at:?} at {p:?} in {x:?}: {tape:?}"
            );
            checks += 1;
        }
    }
    assert!(checks > 80_000, "{checks}");
}
