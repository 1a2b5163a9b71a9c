//! What a tape denotes at a point: exact rationals where they suffice, else proved enclosures at a point.
use antumbra::eval::run;
use antumbra::expr::{Binary, Unary};
use antumbra::tape::{Op, Tape};
use antumbra_interval::{Decorated, Interval};
use num_rational::BigRational;
use num_traits::{Signed, Zero, pow};

/// Longest numbers, in bits of numerator and denominator together.
const MOST_BITS: u64 = 20_000;

/// What is known of the value at a point.
#[derive(Debug)]
pub(crate) enum Truth {
    /// The value.
    Exact(BigRational),
    /// It is defined, and the value is in here.
    In(Interval),
    /// Proved to be undefined.
    Undefined,
    /// Nothing.
    Unknown,
}

impl Truth {
    /// The value of a tape at a point.
    pub(crate) fn at(tape: &Tape, point: [f64; 3]) -> Self {
        if let Some(value) = exact(tape, point) {
            return value.map_or(Self::Undefined, Self::Exact);
        }
        let value = run(tape, point.map(|x| Decorated::from(Interval::point(x))), &mut vec![]);
        if value.interval.is_empty() {
            // Every value of the function is in the empty set.
            Self::Undefined
        } else if value.certainly_defined() {
            Self::In(value.interval)
        } else {
            Self::Unknown
        }
    }

    /// Whether the enclosure may be one of this value. False is a proof that it is not.
    pub(crate) fn possibly_in(&self, x: Interval) -> bool {
        match self {
            Self::Exact(q) => holds(x, q),
            Self::In(value) => value.possibly_intersects(x),
            Self::Undefined | Self::Unknown => true,
        }
    }

    /// An enclosure of the value, if it is known to be defined.
    pub(crate) fn enclosure(&self) -> Option<Interval> {
        match self {
            Self::Exact(q) => Some(around(q)),
            Self::In(value) => Some(*value),
            Self::Undefined | Self::Unknown => None,
        }
    }
}

/// Whether the interval contains the rational, exactly.
pub(crate) fn holds(x: Interval, q: &BigRational) -> bool {
    let below = x.lo() == f64::NEG_INFINITY || BigRational::from_float(x.lo()).is_some_and(|lo| lo <= *q);
    let above = x.hi() == f64::INFINITY || BigRational::from_float(x.hi()).is_some_and(|hi| hi >= *q);
    below && above
}

/// An interval around a rational, by its definition.
pub(crate) fn around(q: &BigRational) -> Interval {
    use num_traits::ToPrimitive;
    let near = q.to_f64().filter(|v| v.is_finite()).unwrap_or(0.0);
    let (mut lo, mut hi) = (near, near);
    // The conversion is a guess; a few steps are enough, or nothing is said.
    for _ in 0..4 {
        let x = Interval::new(lo, hi);
        if holds(x, q) {
            return x;
        }
        (lo, hi) = (lo.next_down().max(f64::MIN), hi.next_up().min(f64::MAX));
    }
    Interval::ENTIRE
}

/// The exact value of a tape whose operations keep rationals rational: `Some(None)` where it is undefined, `None` where
/// an operation or the length of the numbers forbids it.
fn exact(tape: &Tape, point: [f64; 3]) -> Option<Option<BigRational>> {
    // Undefined values spread to what uses them, and to nothing else.
    let mut slots: Vec<Option<BigRational>> = vec![None; tape.slots()];
    let mut value = None;
    for clause in tape.clauses() {
        let operand = |slot: u32| slots.get(slot as usize).and_then(Option::as_ref);
        let (a, b) = (operand(clause.a), operand(clause.b));
        value = match (clause.op, a, b) {
            (Op::Constant(k), ..) => {
                let constant = tape.constants()[k as usize];
                if !constant.is_point() {
                    return None;
                }
                Some(BigRational::from_float(constant.lo())?)
            }
            (Op::Axis(axis), ..) => Some(BigRational::from_float(point[axis as usize])?),
            (Op::Powi(n), Some(a), _) => power(a, n)?,
            (Op::Unary(op), Some(a), _) => Some(unary(op, a)?),
            (Op::Binary(Binary::Div), Some(_), Some(b)) if b.is_zero() => None,
            (Op::Binary(op), Some(a), Some(b)) => Some(binary(op, a, b)?),
            _ => None,
        };
        if value.as_ref().is_some_and(|v| v.numer().bits() + v.denom().bits() > MOST_BITS) {
            return None;
        }
        slots[clause.out as usize].clone_from(&value);
    }
    Some(value)
}

/// The power: `Some(None)` where it is undefined, `None` where it is too long.
fn power(a: &BigRational, n: i32) -> Option<Option<BigRational>> {
    if n < 0 && a.is_zero() {
        return Some(None);
    }
    if (a.numer().bits() + a.denom().bits()) * u64::from(n.unsigned_abs()) > MOST_BITS {
        return None;
    }
    let power = pow(a.clone(), n.unsigned_abs() as usize);
    Some(Some(if n < 0 { power.recip() } else { power }))
}

fn unary(op: Unary, a: &BigRational) -> Option<BigRational> {
    Some(match op {
        Unary::Neg => -a,
        Unary::Abs => a.abs(),
        Unary::Sign => a.signum(),
        Unary::Floor => a.floor(),
        Unary::Sqr => a * a,
        _ => return None,
    })
}

fn binary(op: Binary, a: &BigRational, b: &BigRational) -> Option<BigRational> {
    Some(match op {
        Binary::Add => a + b,
        Binary::Sub => a - b,
        Binary::Mul => a * b,
        Binary::Div => a / b,
        Binary::Min => a.min(b).clone(),
        Binary::Max => a.max(b).clone(),
        Binary::Pow | Binary::Atan2 => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use antumbra::expr::Formula;

    fn truth(text: &str, x: f64) -> Truth {
        let tape = Tape::compile(&Formula::parse_as_written(text).unwrap()).unwrap();
        Truth::at(&tape, [x, 1.0, 2.0])
    }

    /// The checks must be able to fail: enclosures that miss the value by one float, and points outside of domains.
    #[test]
    fn narrow_enclosures_and_domains_are_noticed() {
        // 3^2 / 7 is no float.
        let value = truth("x^2 / 7", 3.0);
        let tight = value.enclosure().unwrap();
        assert!(tight.width() < 1e-15 && value.possibly_in(tight));
        assert!(!value.possibly_in(Interval::point(tight.lo())) && !value.possibly_in(Interval::point(tight.hi())));
        let sine = truth("sin(x)", 3.0);
        assert!(sine.possibly_in(Interval::new(0.14, 0.15)) && !sine.possibly_in(Interval::new(0.15, 0.16)));
        for (text, x) in [("1/x", 0.0), ("x^-2 - x^-2", 0.0), ("sqrt(x)", -1.0), ("0 ln(x)", 0.0), ("asin(x)", 1.5)] {
            assert!(matches!(truth(text, x), Truth::Undefined), "{text} at {x}");
        }
    }
}
