//! Enclosures of constants.
use crate::expr::{Binary, Graph, Node, NodeId, Unary};
use antumbra_interval::Interval;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive};
use std::cmp::Ordering;

/// The tightest interval of `f64` around `q`: a point if `q` is one, else two neighbours. Beyond the largest `f64` it is
/// `[f64::MAX, inf]`.
pub(super) fn enclose(q: &BigRational) -> Interval {
    if q.is_negative() {
        return -enclose(&-q);
    }
    // The conversion is only a guess. The exact comparisons prove lo <= q <= hi, whatever the guess was.
    let mut lo = q.to_f64().filter(|v| !v.is_nan()).unwrap_or(0.0).clamp(0.0, f64::MAX);
    while compare(lo, q) == Ordering::Greater {
        lo = lo.next_down();
    }
    // Now lo <= q; go up while the next number is not above q.
    while lo < f64::MAX && compare(lo.next_up(), q) != Ordering::Greater {
        lo = lo.next_up();
    }
    if compare(lo, q) == Ordering::Equal { Interval::point(lo) } else { Interval::new(lo, lo.next_up()) }
}

/// Exact comparison of a finite float with a rational.
fn compare(v: f64, q: &BigRational) -> Ordering {
    match BigRational::from_float(v) {
        Some(v) => v.cmp(q),
        None => Ordering::Greater,
    }
}

/// pi is between `f64::consts::PI = 3.141592653589793115...` and its upper neighbour: pi = 3.141592653589793238...
const PI: Interval = Interval::new(std::f64::consts::PI, std::f64::consts::PI.next_up());
/// e is between `f64::consts::E = 2.718281828459045090...` and its upper neighbour: e = 2.718281828459045235...
const E: Interval = Interval::new(std::f64::consts::E, std::f64::consts::E.next_up());

/// For each node up to the root: an enclosure of its value if it depends on no coordinate and is *proved* to be defined.
///
/// A constant that may be undefined keeps its operations, so that evaluators see where the domain ends: `sqrt(c)` with `c`
/// enclosed by `[-1e-16, 1e-16]` must not turn into the harmless-looking `[0, 1e-8]`.
pub(super) fn fold(graph: &Graph, used: &[bool]) -> Vec<Option<Interval>> {
    let mut values: Vec<Option<Interval>> = vec![None; used.len()];
    for i in (0..used.len()).filter(|&i| used[i]) {
        let id = graph.nodes()[i];
        let at = |id: NodeId| values[id.index()];
        values[i] = match (id, graph.exact(graph.id(i))) {
            (_, Some(q)) => Some(enclose(q)),
            (Node::Rational(_) | Node::Axis(_), None) => None,
            (Node::Pi, _) => Some(PI),
            (Node::E, _) => Some(E),
            (Node::Unary(op, a), _) => at(a).and_then(|a| unary(op, a)),
            (Node::Powi(a, n), _) => at(a).filter(|a| n >= 0 || !a.possibly_zero()).map(|a| a.powi(n)),
            (Node::Binary(op, a, b), _) => at(a).zip(at(b)).and_then(|(a, b)| binary(op, a, b)),
        };
        // An empty enclosure of a defined constant would be a contradiction; it proves nothing here.
        values[i] = values[i].filter(|v| !v.is_empty());
    }
    values
}

fn unary(op: Unary, a: Interval) -> Option<Interval> {
    let within = |lo: f64, hi: f64| a.lo() >= lo && a.hi() <= hi;
    Some(match op {
        Unary::Neg => -a,
        Unary::Abs => a.abs(),
        Unary::Sign => a.sign(),
        Unary::Floor => a.floor(),
        Unary::Sqr => a.sqr(),
        Unary::Sqrt if within(0.0, f64::INFINITY) => a.sqrt(),
        Unary::Cbrt => a.cbrt(),
        Unary::Exp => a.exp(),
        Unary::Ln if a.certainly_positive() => a.ln(),
        Unary::Sin => a.sin(),
        Unary::Cos => a.cos(),
        // Defined where the cosine is not 0.
        Unary::Tan if !a.cos().possibly_zero() => a.tan(),
        Unary::Asin if within(-1.0, 1.0) => a.asin(),
        Unary::Acos if within(-1.0, 1.0) => a.acos(),
        Unary::Atan => a.atan(),
        Unary::Sinh => a.sinh(),
        Unary::Cosh => a.cosh(),
        Unary::Tanh => a.tanh(),
        Unary::Sqrt | Unary::Ln | Unary::Tan | Unary::Asin | Unary::Acos => return None,
    })
}

fn binary(op: Binary, a: Interval, b: Interval) -> Option<Interval> {
    Some(match op {
        Binary::Add => a + b,
        Binary::Sub => a - b,
        Binary::Mul => a * b,
        Binary::Div if !b.possibly_zero() => a / b,
        Binary::Min => a.min(b),
        Binary::Max => a.max(b),
        Binary::Pow if a.certainly_positive() => a.pow(b),
        Binary::Atan2 if !a.possibly_zero() || b.certainly_positive() || b.certainly_negative() => a.atan2(b),
        Binary::Div | Binary::Pow | Binary::Atan2 => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decimal(text: &str) -> BigRational {
        let (whole, fraction) = text.split_once('.').unwrap_or((text, ""));
        let power = num_traits::Pow::pow(num_bigint::BigInt::from(10), fraction.len());
        BigRational::new(format!("{whole}{fraction}").parse().unwrap(), power)
    }

    #[test]
    fn enclosures_of_rationals_are_the_tightest() {
        assert_eq!(enclose(&decimal("0.5")), Interval::point(0.5));
        assert_eq!(enclose(&decimal("0")), Interval::ZERO);
        // The float nearest to 0.1 is above it: 0.1000000000000000055...
        assert_eq!(enclose(&decimal("0.1")), Interval::new(0.1_f64.next_down(), 0.1));
        assert_eq!(enclose(&-decimal("0.1")), Interval::new(-0.1, -(0.1_f64.next_down())));
        let large = decimal("1000") * BigRational::from_float(f64::MAX).unwrap();
        assert_eq!(enclose(&large), Interval::new(f64::MAX, f64::INFINITY));
        let tiny = BigRational::from_float(f64::from_bits(1)).unwrap() / decimal("3");
        assert_eq!(enclose(&tiny), Interval::new(0.0, f64::from_bits(1)));
    }

    #[test]
    fn random_rationals_are_enclosed_by_a_point_or_neighbours() {
        let mut random = fastrand::Rng::with_seed(7);
        for _ in 0..3000 {
            let exponent = random.i32(-1070..1020);
            let v = core_math::exp2(f64::from(exponent)) * random.f64();
            let q = BigRational::from_float(v).unwrap() + BigRational::new(random.i64(-3..3).into(), 7.into());
            let i = enclose(&q);
            assert!(compare(i.lo(), &q) != Ordering::Greater && compare(i.hi(), &q) != Ordering::Less, "{q}");
            assert!(i.lo() == i.hi() || i.lo().next_up() == i.hi(), "{q} {i:?}");
        }
    }

    #[test]
    fn pi_and_e_are_between_neighbours() {
        for (interval, digits) in [
            (PI, "3.14159265358979323846264338327950288419716939937510"),
            (E, "2.71828182845904523536028747135266249775724709369995"),
        ] {
            assert_eq!(enclose(&decimal(digits)), interval);
        }
    }
}
