//! Claims of continuity, attacked: every point of the box must have a value, and no jump or pole may be between two points.
use crate::truth::Truth;
use antumbra::eval::{Gradient, run};
use antumbra::expr::Binary;
use antumbra::tape::{Op, Tape};
use antumbra_interval::Interval;

/// Checks the claim that the tape is defined and continuous on a box that contains `p` and `q`. Panics if it is false.
pub fn attack(tape: &Tape, p: [f64; 3], q: [f64; 3]) {
    for at in [p, q] {
        if matches!(Truth::at(tape, at), Truth::Undefined) {
            panic!("claimed to be continuous, but undefined at {at:?}: {tape:?}");
        }
    }
    if is_tame(tape, p, q) {
        hunt(tape, p, q);
    }
}

/// Whether a jump can be told from a steep place: no powers so high or so small, no numbers so large or so near to 0, that
/// a continuous function changes much between neighbouring floats with an unbounded slope.
fn is_tame(tape: &Tape, p: [f64; 3], q: [f64; 3]) -> bool {
    let coarse = |x: f64| (x * 1024.0).fract() == 0.0 && x.abs() <= 64.0;
    let constants = tape.constants().iter().all(|k| coarse(k.lo()) && coarse(k.hi()));
    // The exponents of real powers that are constants not near 0.
    let mut constant = vec![None; tape.slots()];
    let operations = tape.clauses().iter().all(|clause| {
        let tame = match clause.op {
            Op::Powi(n) => n.unsigned_abs() < 10,
            Op::Binary(Binary::Pow) => constant[clause.b as usize].is_some_and(|k: Interval| k.mignitude() >= 0.25),
            _ => true,
        };
        constant[clause.out as usize] = match clause.op {
            Op::Constant(k) => Some(tape.constants()[k as usize]),
            _ => None,
        };
        tame
    });
    constants && operations && p.into_iter().chain(q).all(coarse)
}

fn value(tape: &Tape, at: [f64; 3]) -> Interval {
    run(tape, at.map(Interval::point), &mut vec![])
}

/// A lower bound of the distance between numbers of `a` and `b`.
fn gap(a: Interval, b: Interval) -> f64 {
    (a.lo() - b.hi()).max(b.lo() - a.hi()).max(0.0)
}

/// Halves the segment, towards the half with the larger gap of values, until its ends are neighbours.
///
/// A jump of 0.9 among values up to 1000, or a change of sign among values beyond a million, is one if no bounded slope
/// explains it.
fn hunt(tape: &Tape, mut p: [f64; 3], mut q: [f64; 3]) {
    let (mut a, mut b) = (value(tape, p), value(tape, q));
    while gap(a, b) > 0.9 {
        let middle: [f64; 3] = std::array::from_fn(|k| 0.5 * p[k] + 0.5 * q[k]);
        if middle == p || middle == q {
            let small = a.magnitude() <= 1e3 && b.magnitude() <= 1e3;
            let pole = a.mignitude() >= 1e6 && b.mignitude() >= 1e6 && a.certainly_positive() != b.certainly_positive();
            let x = std::array::from_fn(|k| Interval::point(p[k]).hull(Interval::point(q[k])));
            let slopes = run(tape, Gradient::coordinates(x), &mut vec![]).partials;
            let steep = slopes.iter().any(|s| !s.is_bounded());
            assert!(
                !(steep && (small || pole)),
                "claimed to be continuous, but {a} at {p:?} and {b} at its neighbour {q:?}: {tape:?}"
            );
            return;
        }
        let m = value(tape, middle);
        assert!(!m.is_empty(), "claimed to be continuous, but undefined at {middle:?}: {tape:?}");
        if gap(a, m) >= gap(m, b) {
            (q, b) = (middle, m);
        } else {
            (p, a) = (middle, m);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use antumbra::expr::Formula;

    fn refuted(text: &str, p: f64, q: f64) -> bool {
        let tape = Tape::compile(&Formula::parse(text).unwrap()).unwrap();
        std::panic::catch_unwind(|| attack(&tape, [p, 0.5, 0.25], [q, 0.5, 0.25])).is_err()
    }

    /// The attack finds false claims, and only those.
    #[test]
    fn jumps_and_poles_are_found() {
        for text in
            ["floor(x)", "sign(x)", "3/x", "tan(x)", "x/abs(x)", "atan2(-0.5 - 0*x, x)*0 + sign(x - 1/8)", "1/sin(x)"]
        {
            assert!(refuted(text, -1.75, 3.5), "{text}");
        }
        assert!(refuted("sqrt(x)", -1.0, 1.0) && refuted("ln(x)", 0.0, 1.0) && refuted("asin(x)", 0.0, 1.5));
        assert!(refuted("atan2(x, -y)", -1.0, 1.0));
        for text in ["exp(x)^5", "1/x", "sqrt(x)", "ln(x)", "tan(x)", "floor(x + 1/4)", "cbrt(x - 1/8)", "abs(x)*1000"]
        {
            assert!(!refuted(text, 1.0 / 8.0, 3.0 / 8.0), "{text}");
        }
    }
}
