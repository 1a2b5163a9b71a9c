//! NaN and infinity prove nothing.
use crate::containment::{Kind, Operator, number};
use antumbra::eval::{Gradient, Inclusion, Number, Workspace, run};
use antumbra::expr::Formula;
use antumbra::geom::{Beam, Box3, Vec3};
use antumbra::tape::Tape;
use antumbra_interval::affine::{Affine, Dual, Jet, Slope, SlopeOf};
use antumbra_interval::quadratic::Quadratic;
use antumbra_interval::{Decorated, Interval};
use fastrand::Rng;

/// Operands of which nothing is known, or nothing finite.
fn unknown() -> Vec<Interval> {
    let inf = f64::INFINITY;
    vec![
        Interval::ENTIRE,
        Interval::from_bounds_or_entire(f64::NAN, 1.0),
        Interval::from_bounds_or_entire(1.0, f64::NAN),
        Interval::from_bounds_or_entire(inf, inf),
        Interval::new(f64::MAX, inf),
        Interval::new(-inf, f64::MIN),
        Interval::new(0.0, inf),
        Interval::new(-inf, 0.0),
    ]
}

#[test]
fn not_a_number_is_no_interval() {
    for (lo, hi) in [(f64::NAN, 0.0), (0.0, f64::NAN), (f64::NAN, f64::NAN), (1.0, 0.0)] {
        assert_eq!(Interval::try_new(lo, hi), None, "{lo} {hi}");
    }
    for nan in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(!Affine::<3>::linear(nan, [0.0; 3], 0.0).is_known());
        assert!(!Affine::<3>::linear(0.0, [0.0, nan, 0.0], 0.0).is_known());
        assert!(!Affine::<3>::linear(0.0, [0.0; 3], nan).is_known());
    }
}

/// With such operands every value of the operator on them stays possible, and no bound is a NaN.
fn nothing_is_excluded<K: Kind>(seed: u64) {
    let mut r = Rng::with_seed(seed);
    for operator in Operator::all() {
        for x in unknown() {
            for other in unknown().into_iter().chain([Interval::point(number(&mut r)), Interval::ONE]) {
                let [a, b] = K::over([x, other]);
                for (y, order) in [(operator.apply(a, b), [x, other]), (operator.apply(b, a), [other, x])] {
                    let range = y.range();
                    assert!(!range.lo().is_nan() && !range.hi().is_nan(), "{}: {y:?}", operator.name());
                    for _ in 0..6 {
                        let p = order.map(|x| number(&mut r).clamp(x.lo().max(f64::MIN), x.hi().min(f64::MAX)));
                        let Some(truth) = operator.truth(p[0], p[1]) else { continue };
                        let inside = truth.possibly_in(range.lo(), range.hi());
                        assert!(inside, "{} {}: {range:?} of {order:?} excludes {truth:?}", K::NAME, operator.name());
                    }
                }
            }
        }
    }
}

#[test]
fn nothing_is_excluded_of_unknown_operands() {
    nothing_is_excluded::<Interval>(61);
    nothing_is_excluded::<Decorated>(62);
    nothing_is_excluded::<Gradient>(63);
    nothing_is_excluded::<Affine<1>>(64);
    nothing_is_excluded::<Affine<3>>(65);
    nothing_is_excluded::<Slope<Interval, 3>>(66);
    nothing_is_excluded::<Slope<Affine<5>, 5>>(67);
    nothing_is_excluded::<Dual<1>>(68);
    nothing_is_excluded::<Quadratic>(69);
    nothing_is_excluded::<SlopeOf<Interval, Quadratic>>(70);
    nothing_is_excluded::<Jet<Affine<3>>>(71);
}

/// No kind of number decides the sign of a surface that has both signs out there.
#[test]
fn unknown_places_prove_no_sign() {
    for text in
        ["x + y + z", "x y z - 1", "x^3 - z", "sin(x) + cos(y)", "exp(x) - 2", "atan2(y, x)", "1/x", "cbrt(x) - y"]
    {
        let tape = Tape::compile(&Formula::parse(text).unwrap()).unwrap();
        fn open<K: Kind>(tape: &Tape, text: &str, x: [K; 3]) {
            let range = run(tape, x, &mut vec![]).range();
            assert!(range.possibly_zero(), "{}: {text} is {range:?}", K::NAME);
        }
        let x = [Interval::ENTIRE; 3];
        open(&tape, text, Interval::over(x));
        open(&tape, text, Decorated::over(x));
        open(&tape, text, Gradient::over(x));
        open(&tape, text, [Affine::<1>::UNKNOWN; 3]);
        open(&tape, text, [Affine::<3>::linear(f64::NAN, [1.0; 3], 0.0); 3]);
        open(&tape, text, [Slope::<Interval, 3>::coordinate(Interval::ENTIRE, Affine::UNKNOWN, Affine::UNKNOWN); 3]);
        open(&tape, text, [Quadratic::UNKNOWN; 3]);
        open(&tape, text, [Quadratic::polynomial(0.0, [0.0; 3], [f64::NAN; 6], 0.0); 3]);
        open(&tape, text, [Dual::<1> { value: Affine::UNKNOWN, derivative: Affine::UNKNOWN }; 3]);
    }
}

/// Rounded values are no proof; a NaN stays one.
#[test]
fn rounded_values_keep_what_is_undefined() {
    for operator in Operator::all() {
        let y = operator.apply::<f64>(f64::NAN, f64::NAN);
        assert!(y.is_nan(), "{} of NaN is {y}", operator.name());
        if operator.is_binary() {
            for y in [operator.apply::<f64>(f64::NAN, 1.0), operator.apply::<f64>(1.0, f64::NAN)] {
                assert!(y.is_nan(), "{} of NaN and 1 is {y}", operator.name());
            }
        }
    }
}

/// A beam from nowhere, or to everywhere, misses nothing for certain.
#[test]
fn beams_of_nonsense_exclude_nothing() {
    let tape = Tape::compile(&Formula::parse("x^2 + y^2 + z^2 - 1").unwrap()).unwrap();
    let mut work = Workspace::default();
    for (origin, direction) in [
        (Vec3::new(0.0, 0.0, 5.0), Box3([Interval::ENTIRE; 3])),
        (Vec3::new(f64::MAX, 0.0, 0.0), Box3([Interval::new(f64::MIN, 0.0), Interval::ZERO, Interval::ZERO])),
        (Vec3::new(0.0, 0.0, 5.0), Box3([Interval::from_bounds_or_entire(f64::NAN, f64::NAN); 3])),
    ] {
        let place = Beam { origin, direction }.at(Interval::new(0.0, f64::INFINITY));
        assert!(tape.range(&place, &mut work).possibly_zero(), "{origin:?} {direction:?}");
    }
    // Constants that overflow are unknown, not infinite.
    let huge = Tape::compile(&Formula::parse("x - 1e400").unwrap()).unwrap();
    let range = run(&huge, [Interval::point(f64::MAX); 3], &mut vec![]);
    assert!(range.lo() < 0.0 && range.hi() >= 0.0, "{range:?}");
    assert_eq!(f64::constant(Interval::ENTIRE), 0.0);
}
