//! Tapes on boxes: intervals, decorations, gradients, and the ranges of all other kinds of number.
use crate::containment::{Kind, Operator};
use crate::continuity;
use crate::input::Input;
use crate::truth::Truth;
use antumbra::eval::{Gradient, run};
use antumbra::tape::Tape;
use antumbra_interval::affine::{Affine, Dual, Slope};
use antumbra_interval::{Decorated, Interval};

/// Values at points of a box lie in the ranges of all kinds of number over the box; where f is claimed to be defined and
/// continuous it is, and differences of values are explained by the gradient.
pub fn evaluators(bytes: &[u8]) {
    let mut input = Input::new(bytes);
    let operators = Operator::all();
    let tame = input.below(2) == 0;
    let constants =
        std::array::from_fn(|_| if tame { Interval::point(input.coarse() / 8.0) } else { input.interval() });
    let tape = input.tape(&operators, 12, constants);
    // At least one round, then as long as there are bytes.
    loop {
        let x: [Interval; 3] = std::array::from_fn(|_| match input.below(4) {
            0 => input.interval(),
            1 => {
                let (a, b) = (input.coarse() / 8.0, input.coarse() / 8.0);
                Interval::new(a.min(b), a.max(b))
            }
            _ => input.ordinary(),
        });
        let points: [[f64; 3]; 2] = std::array::from_fn(|_| x.map(|x| input.member(x)));
        check(&tape, x, points);
        if input.is_spent() {
            return;
        }
    }
}

fn check(tape: &Tape, x: [Interval; 3], points: [[f64; 3]; 2]) {
    let truths = points.map(|p| Truth::at(tape, p));
    ranges(tape, x, &points, &truths);
    for p in points {
        ranges(tape, p.map(Interval::point), &points[..1], &[Truth::at(tape, p)]);
    }
    let decorated = run(tape, x.map(Decorated::from), &mut vec![]);
    if decorated.certainly_defined() {
        for (p, truth) in points.iter().zip(&truths) {
            assert!(!matches!(truth, Truth::Undefined), "claimed to be defined over {x:?}, not at {p:?}: {tape:?}");
        }
    }
    let everywhere = tape.is_continuous_everywhere();
    if !(everywhere || decorated.certainly_continuous()) {
        return;
    }
    continuity::attack(tape, points[0], points[1]);
    let gradient = run(tape, Gradient::coordinates(x), &mut vec![]);
    if let (Some(f), Some(g)) = (truths[0].enclosure(), truths[1].enclosure()) {
        let step = |k: usize| Interval::point(points[1][k]) - Interval::point(points[0][k]);
        let bound = (0..3).fold(Interval::ZERO, |sum, k| sum + gradient.partials[k] * step(k));
        assert!(
            (g - f).possibly_intersects(bound),
            "gradient {gradient:?} over {x:?} contradicts {f} and {g} at {points:?}: {tape:?}"
        );
    }
}

fn ranges(tape: &Tape, x: [Interval; 3], points: &[[f64; 3]], truths: &[Truth]) {
    fn one<K: Kind>(tape: &Tape, x: [Interval; 3], points: &[[f64; 3]], truths: &[Truth]) {
        let range = run(tape, K::over(x), &mut vec![]).range();
        assert!(!range.lo().is_nan() && !range.hi().is_nan(), "{}: {range:?} over {x:?}: {tape:?}", K::NAME);
        for (p, truth) in points.iter().zip(truths) {
            assert!(
                truth.possibly_in(range),
                "{}: {range} over {x:?} does not contain {truth:?}, the value at {p:?}: {tape:?}",
                K::NAME
            );
        }
    }
    one::<Interval>(tape, x, points, truths);
    one::<Decorated>(tape, x, points, truths);
    one::<Gradient>(tape, x, points, truths);
    one::<Affine<1>>(tape, x, points, truths);
    one::<Affine<3>>(tape, x, points, truths);
    one::<Affine<5>>(tape, x, points, truths);
    one::<Slope<Interval, 3>>(tape, x, points, truths);
    one::<Slope<Affine<5>, 5>>(tape, x, points, truths);
    one::<Dual<1>>(tape, x, points, truths);
}
