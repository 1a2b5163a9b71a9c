//! Every operator on random boxes.
use crate::containment::{self, Count, Kind, Operator, contains, interval, member};
use antumbra::eval::Gradient;
use antumbra_interval::affine::{Affine, Dual, Jet, Slope, SlopeOf};
use antumbra_interval::quadratic::Quadratic;
use antumbra_interval::{Decorated, Interval};
use fastrand::Rng;

/// The data of the first few violations.
#[track_caller]
fn none(violations: &[String]) {
    let shown = violations.iter().take(5).cloned().collect::<Vec<_>>().join("\n");
    assert!(violations.is_empty(), "{} violations:\n{shown}", violations.len());
}

fn enclose_every_value<K: Kind>(seed: u64) {
    let mut r = Rng::with_seed(seed);
    for operator in Operator::all() {
        let mut count = Count { operator, checks: 0, violations: vec![] };
        for _ in 0..600 {
            let x = [interval(&mut r), interval(&mut r)];
            let points: [[f64; 2]; 4] = std::array::from_fn(|_| x.map(|x| member(&mut r, x)));
            contains::<K>(operator, x, &points, &mut count);
        }
        assert!(count.checks > 200, "{}: {} checks", operator.name(), count.checks);
        none(&count.violations);
    }
}

#[test]
fn every_kind_of_number_encloses_every_value() {
    enclose_every_value::<Interval>(1);
    enclose_every_value::<Decorated>(2);
    enclose_every_value::<Gradient>(3);
    enclose_every_value::<Affine<1>>(4);
    enclose_every_value::<Affine<3>>(5);
    enclose_every_value::<Affine<5>>(6);
    enclose_every_value::<Slope<Interval, 3>>(7);
    enclose_every_value::<Slope<Affine<5>, 5>>(8);
    enclose_every_value::<Dual<1>>(9);
    enclose_every_value::<Quadratic>(12);
    enclose_every_value::<SlopeOf<Interval, Quadratic>>(13);
    enclose_every_value::<Jet<Affine<3>>>(14);
    enclose_every_value::<SlopeOf<Interval, Jet<Affine<3>>>>(15);
}

/// What the example `containment` runs, smaller.
#[test]
fn many_containment_checks() {
    let counts = containment::run(400_000, 11);
    assert!(counts.iter().map(|c| c.checks).sum::<u64>() >= 400_000);
    none(&counts.into_iter().flat_map(|c| c.violations).collect::<Vec<_>>());
}
