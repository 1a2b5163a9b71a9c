//! One operation of interval arithmetic at a time.
use crate::containment::Operator;
use crate::input::Input;
use crate::truth::holds;
use antumbra_interval::lanes::{self, Lanes, LanesMut, Level};
use antumbra_interval::{Decorated, Interval};
use num_rational::BigRational;
use num_traits::Zero;

/// The value of an operation at members of its operands is a member of the result, for every operation; and the kernels
/// for batches agree with the scalar operators: portable ones exactly, those with directed rounding from inside.
pub fn arithmetic(bytes: &[u8]) {
    let mut input = Input::new(bytes);
    while !input.is_spent() {
        let (a, b, c) = (input.interval(), input.interval(), input.interval());
        let p = [input.member(a), input.member(b), input.member(c)];
        rational([a, b, c], p);
        let operators = Operator::all();
        let operator = input.pick(&operators);
        elementary(operator, [a, b], [p[0], p[1]]);
        batches(a, b, c);
        sets(a, b, p);
    }
}

/// Exact rationals.
fn rational([a, b, c]: [Interval; 3], p: [f64; 3]) {
    let [x, y, z] = p.map(|v| BigRational::from_float(v).expect("a finite number"));
    let zero = BigRational::zero();
    let check = |name: &str, got: Interval, value: BigRational| {
        assert!(holds(got, &value), "{name} of {a}, {b}, {c} is {got}: it misses the value at {p:?}");
    };
    check("sum", a + b, &x + &y);
    check("difference", a - b, &x - &y);
    check("product", a * b, &x * &y);
    check("fused product and sum", a.mul_add(b, c), &x * &y + &z);
    check("square", a.sqr(), &x * &x);
    check("sum with a number", a.add_point(p[1]), &x + &y);
    check("product with a number", a.mul_point(p[1]), &x * &y);
    if y != zero {
        check("quotient", a / b, &x / &y);
        check("reciprocal", b.recip(), y.recip());
    }
    check("ceiling", a.ceil(), x.ceil());
    let root = a.sqrt();
    if p[0] >= 0.0 {
        let square = |v: f64| BigRational::from_float(v).map(|v| &v * &v);
        let below = square(root.lo()).is_some_and(|s| s <= x);
        let above = root.hi() == f64::INFINITY || square(root.hi()).is_some_and(|s| s >= x);
        assert!(below && above, "root of {a} is {root}: it misses that of {:?}", p[0]);
    }
}

/// Correctly rounded values.
fn elementary(operator: Operator, x: [Interval; 2], p: [f64; 2]) {
    let got = operator.apply(Decorated::from(x[0]), Decorated::from(x[1]));
    match operator.truth(p[0], p[1]) {
        Some(value) => assert!(
            value.possibly_in(got.interval.lo(), got.interval.hi()),
            "{} of {x:?} is {got:?}: it misses {value:?}, the value at {p:?}",
            operator.name()
        ),
        None => assert!(!got.certainly_defined(), "{} of {x:?} is {got:?}, but undefined at {p:?}", operator.name()),
    }
    if x.iter().all(|x| x.is_bounded())
        && let Some(breaks) = operator.breaks([x[0].lo(), x[0].hi()], [x[1].lo(), x[1].hi()])
    {
        assert_eq!(got.certainly_continuous(), !breaks, "{} of {x:?} is {got:?}", operator.name());
    }
}

type Kernel = fn(Level, [Lanes<'_>; 3], LanesMut<'_>);

type Scalar = fn([Interval; 3]) -> Interval;

const KERNELS: [(&str, Kernel, Scalar); 11] = [
    ("neg", |level, [a, ..], out| lanes::neg(level, a, out), |[a, ..]| -a),
    ("abs", |level, [a, ..], out| lanes::abs(level, a, out), |[a, ..]| a.abs()),
    ("sqr", |level, [a, ..], out| lanes::sqr(level, a, out), |[a, ..]| a.sqr()),
    ("sqrt", |level, [a, ..], out| lanes::sqrt(level, a, out), |[a, ..]| a.sqrt()),
    ("add", |level, [a, b, _], out| lanes::add(level, a, b, out), |[a, b, _]| a + b),
    ("sub", |level, [a, b, _], out| lanes::sub(level, a, b, out), |[a, b, _]| a - b),
    ("mul", |level, [a, b, _], out| lanes::mul(level, a, b, out), |[a, b, _]| a * b),
    ("div", |level, [a, b, _], out| lanes::div(level, a, b, out), |[a, b, _]| a / b),
    ("min", |level, [a, b, _], out| lanes::min(level, a, b, out), |[a, b, _]| a.min(b)),
    ("max", |level, [a, b, _], out| lanes::max(level, a, b, out), |[a, b, _]| a.max(b)),
    ("mul_add", |level, [a, b, c], out| lanes::mul_add(level, a, b, c, out), |[a, b, c]| a.mul_add(b, c)),
];

fn batches(a: Interval, b: Interval, c: Interval) {
    // The empty set and unbounded neighbours too.
    let lanes = [[a, b, c], [b, c, a], [Interval::EMPTY, a, b], [c, Interval::ENTIRE, a], [a, a, -a]];
    let column = |k: usize| -> (Vec<f64>, Vec<f64>) { lanes.iter().map(|x| (x[k].lo(), x[k].hi())).unzip() };
    let columns = [column(0), column(1), column(2)];
    let operands = [0, 1, 2].map(|k| Lanes::new(&columns[k].0, &columns[k].1));
    for (name, kernel, scalar) in KERNELS {
        for level in [Level::Portable, Level::detect()] {
            let (mut lo, mut hi) = ([7.0; 5], [7.0; 5]);
            kernel(level, operands, LanesMut::new(&mut lo, &mut hi));
            for (i, x) in lanes.iter().enumerate() {
                let (got, expected) = (Interval::from_bounds_or_entire(lo[i], hi[i]), scalar(*x));
                let good = if level == Level::Portable { got == expected } else { got.is_subset_of(expected) };
                assert!(good, "{name} of {x:?} on {level:?} is {got}, alone {expected}");
            }
        }
    }
}

fn sets(a: Interval, b: Interval, p: [f64; 3]) {
    let (hull, both) = (a.hull(b), a.intersection(b));
    assert!(hull.contains(p[0]) && hull.contains(p[1]), "hull of {a}, {b} is {hull}");
    assert_eq!(both.contains(p[0]), b.contains(p[0]), "intersection of {a}, {b} is {both}");
    assert!(a.contains(a.mid()) && !a.radius().is_nan() && a.radius() >= 0.0, "{a}");
    assert!(a.mignitude() <= p[0].abs() && p[0].abs() <= a.magnitude(), "{a}");
    assert_eq!(a.possibly_intersects(b), !both.is_empty(), "{a}, {b}");
    assert!(!a.certainly_less(b) || p[0] < p[1], "{a}, {b}");
    assert!(!a.is_interior_to(b) || a.is_subset_of(b), "{a}, {b}");
}
