//! Random checks that enclosures enclose: shared by the test suite and by the example `containment`.
#![allow(dead_code, unused_imports, reason = "the example and the tests use different parts of it")]
mod kind;
mod operator;
mod sample;

pub(crate) use kind::Kind;
pub(crate) use operator::{Operator, Truth};
pub(crate) use sample::{interval, member, number, power_of_two};

use antumbra::eval::Gradient;
use antumbra_interval::affine::Affine;
use antumbra_interval::{Decorated, Interval};
use fastrand::Rng;
use rayon::prelude::*;

/// Points tried in each box.
const POINTS: usize = 4;
/// Boxes of one piece of work.
const ROUND: u64 = 512;

/// What happened to one operator.
#[derive(Clone, Debug)]
pub(crate) struct Count {
    pub(crate) operator: Operator,
    /// Checks that were made, points outside the domain not counted.
    pub(crate) checks: u64,
    /// The data of every violation.
    pub(crate) violations: Vec<String>,
}

/// At least `checks` containment checks, spread evenly over all operators, of the interval, gradient and affine
/// evaluators. Depends on nothing but the arguments.
pub(crate) fn run(checks: u64, seed: u64) -> Vec<Count> {
    let operators = Operator::all();
    let share = checks.div_ceil(operators.len() as u64);
    operators.par_iter().enumerate().map(|(index, &operator)| count(operator, index as u64, share, seed)).collect()
}

/// Rounds until there are enough checks; operators with a small domain need more.
fn count(operator: Operator, index: u64, share: u64, seed: u64) -> Count {
    let mut total = Count { operator, checks: 0, violations: vec![] };
    let mut round = 0;
    while total.checks < share {
        let seeds: Vec<u64> = (0..8).map(|k| seed ^ (index << 40) ^ (round * 8 + k)).collect();
        let parts: Vec<Count> = seeds.into_par_iter().map(|seed| one_round(operator, seed)).collect();
        for part in parts {
            total.checks += part.checks;
            total.violations.extend(part.violations);
        }
        round += 1;
    }
    total
}

fn one_round(operator: Operator, seed: u64) -> Count {
    let mut count = Count { operator, checks: 0, violations: vec![] };
    let mut r = Rng::with_seed(seed);
    for _ in 0..ROUND {
        let x = [interval(&mut r), interval(&mut r)];
        let points: [[f64; 2]; POINTS] = std::array::from_fn(|_| x.map(|x| member(&mut r, x)));
        contains::<Interval>(operator, x, &points, &mut count);
        contains::<Gradient>(operator, x, &points, &mut count);
        contains::<Affine<3>>(operator, x, &points, &mut count);
        mean_value(operator, x, &points, &mut count);
    }
    count
}

/// The value at every point lies in the enclosure over the box.
pub(crate) fn contains<K: Kind>(operator: Operator, x: [Interval; 2], points: &[[f64; 2]], count: &mut Count) {
    let [a, b] = K::over(x);
    let range = operator.apply(a, b).range();
    for p in points {
        let Some(truth) = operator.truth(p[0], p[1]) else { continue };
        count.checks += 1;
        if !truth.possibly_in(range.lo(), range.hi()) {
            count.violations.push(format!(
                "{} of {:?} (operands {a:?}, {b:?}): {range:?} does not contain the value {truth:?} at {p:?}",
                operator.name(),
                K::NAME,
            ));
        }
    }
}

/// The gradient over a box on which the operator is continuous: `f(q) - f(p)` lies in `sum G_k (q_k - p_k)`.
fn mean_value(operator: Operator, x: [Interval; 2], points: &[[f64; 2]], count: &mut Count) {
    let decorated = operator.apply(Decorated::from(x[0]), Decorated::from(x[1]));
    if !decorated.certainly_continuous() {
        return;
    }
    let [a, b] = Gradient::over(x);
    let slopes = operator.apply(a, b).partials;
    for pair in points.windows(2) {
        let (p, q) = (pair[0], pair[1]);
        let Some((f, g)) = operator.truth(p[0], p[1]).zip(operator.truth(q[0], q[1])) else { continue };
        count.checks += 1;
        let rise = around(g) - around(f);
        let bound =
            (0..2).fold(Interval::ZERO, |sum, k| sum + slopes[k] * (Interval::point(q[k]) - Interval::point(p[k])));
        if !rise.possibly_intersects(bound) {
            count.violations.push(format!(
                "gradient of {} over {x:?}: {slopes:?} contradicts the values {f:?} at {p:?} and {g:?} at {q:?}",
                operator.name(),
            ));
        }
    }
}

/// An enclosure of the real value that was rounded to nearest.
pub(crate) fn around(truth: Truth) -> Interval {
    Interval::new(truth.rounded.next_down(), truth.rounded.next_up())
}
