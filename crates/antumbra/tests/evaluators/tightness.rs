//! Enclosures are not only true but narrow: against each other, and with the right order of convergence.
use crate::containment::{Kind, Operator, interval, power_of_two};
use antumbra::eval::{Gradient, run};
use antumbra::expr::{Formula, Unary};
use antumbra::scene::PRESETS;
use antumbra::tape::Tape;
use antumbra_interval::affine::{Affine, Dual, Slope};
use antumbra_interval::{Decorated, Interval};
use fastrand::Rng;

fn compile(text: &str) -> Tape {
    Tape::compile(&Formula::parse(text).unwrap_or_else(|e| panic!("{}", e.render(text)))).unwrap()
}

/// Kinds that carry an interval carry the same interval.
#[test]
fn decorated_intervals_and_gradients_carry_the_interval_itself() {
    let mut r = Rng::with_seed(51);
    for operator in Operator::all() {
        for _ in 0..300 {
            let x = [interval(&mut r), interval(&mut r)];
            let plain = operator.apply(x[0], x[1]);
            let [a, b] = Decorated::over(x);
            assert_eq!(operator.apply(a, b).interval, plain, "{} over {x:?}", operator.name());
            let [a, b] = Gradient::over(x);
            assert_eq!(operator.apply(a, b).value, plain, "{} over {x:?}", operator.name());
        }
    }
}

/// Ratio of the widths of a form's range and of the interval, for one operator over boxes of width `2^-8` away from poles,
/// steps and ends of domains. A form that were never wider than 1 + 2^-5 times an interval loses nothing anywhere.
#[test]
fn forms_are_not_wider_than_intervals_on_small_boxes() {
    fn width<K: Kind>(operator: Operator, x: [Interval; 2]) -> f64 {
        let [a, b] = K::over(x);
        operator.apply(a, b).range().width()
    }
    let mut r = Rng::with_seed(52);
    for operator in Operator::all() {
        if matches!(operator, Operator::Powi(n) if n.unsigned_abs() > 9) {
            continue;
        }
        for _ in 0..200 {
            let x: [Interval; 2] = std::array::from_fn(|_| {
                let a = 0.25 + r.f64() * 0.5;
                Interval::new(a, a + power_of_two(-8))
            });
            let plain = width::<Interval>(operator, x);
            // A choice between operands that are both possible costs an affine form more.
            let most = if x[0].possibly_intersects(x[1]) { 2.0 } else { 1.0 + power_of_two(-5) };
            let limit = most * plain + 1e-13;
            let what = || format!("{} over {x:?}: the interval is {plain:e} wide", operator.name());
            assert!(width::<Affine<3>>(operator, x) <= limit, "{}", what());
            assert!(width::<Affine<5>>(operator, x) <= limit, "{}", what());
            if !operator.is_binary() {
                assert!(width::<Dual<1>>(operator, x) <= limit, "{}", what());
                assert!(width::<Slope<Interval, 3>>(operator, x) <= 1.1 * limit, "{}", what());
                assert!(width::<Slope<Affine<5>, 5>>(operator, x) <= 1.1 * limit, "{}", what());
            }
        }
    }
}

/// Symbols keep their meaning: what cancels, cancels.
#[test]
fn affine_forms_cancel() {
    let x = [Interval::new(-1.0, 1.0), Interval::new(2.0, 3.0), Interval::new(-0.5, 0.25)];
    for (text, limit) in [
        ("x - x", 1e-13),
        ("(x + y) - (y + x)", 1e-13),
        ("x (1 + y) - x - x y", 3.1),
        ("(x + 1)^2 - x^2 - 2x - 1", 4.1),
        ("max(x, y) - y", 1e-13),
        ("abs(y) - y", 1e-13),
    ] {
        // As written: the simplifier would see some of these itself.
        let tape = Tape::compile(&Formula::parse_as_written(text).unwrap()).unwrap();
        let form = run(&tape, Affine::<3>::over(x), &mut vec![]).range();
        let plain = run(&tape, x, &mut vec![]);
        assert!(form.width() <= limit && form.width() < plain.width(), "{text}: {form:?}, {plain:?}");
    }
}

/// The width of the enclosures of f over boxes of edge `w` around a point, from `w = 2^-6` down: interval, and error of the affine
/// form.
fn errors(tape: &Tape, at: [f64; 3], k: i32) -> (f64, f64) {
    let h = power_of_two(-k - 1);
    let x = at.map(|v| Interval::new(v - h, v + h));
    let form = run(tape, Affine::<3>::over(x), &mut vec![]);
    (run(tape, x, &mut vec![]).width(), form.error())
}

/// Intervals: half the box, half the width (order 1). Affine forms: half the box, a quarter of the error (order 2).
#[test]
fn enclosures_converge_with_their_orders() {
    let surfaces = PRESETS[..4].iter().map(|preset| preset.formula.split('=').next().unwrap());
    let others =
        ["sin(x) cos(y) + exp(z x)", "ln(2 + x y) / (3 + z)", "sqrt(x + y) - atan2(z, x + 1)", "tan(x/2) + cosh(y z)"];
    for text in surfaces.chain(others) {
        let tape = compile(text);
        for at in [[0.3, 0.4, 0.6], [0.7, 0.2, 0.9]] {
            for k in 6..10 {
                let ((wide, coarse), (narrow, fine)) = (errors(&tape, at, k), errors(&tape, at, k + 1));
                let (interval, affine) = (core_math::log2(wide / narrow), core_math::log2(coarse / fine));
                assert!((0.9..1.15).contains(&interval), "{text} at {at:?}: interval order {interval} at 2^-{k}");
                assert!((1.8..2.3).contains(&affine), "{text} at {at:?}: affine order {affine} at 2^-{k}");
            }
        }
    }
}

/// Every smooth operator for itself.
#[test]
fn smooth_operators_converge_with_order_two() {
    for operator in Operator::all() {
        let smooth = match operator {
            Operator::Unary(op) => !matches!(op, Unary::Neg | Unary::Abs | Unary::Sign | Unary::Floor),
            Operator::Powi(n) => !matches!(n, 0 | 1) && n.unsigned_abs() < 100,
            Operator::Binary(op) => {
                format!("{op:?}") == "Mul" || format!("{op:?}") == "Div" || format!("{op:?}") == "Pow"
            }
        };
        if !smooth {
            continue;
        }
        let error = |k: i32| {
            let x = [0.4, 0.55].map(|a| Interval::new(a, a + power_of_two(-k)));
            let [a, b] = Affine::<3>::over(x);
            operator.apply(a, b).error()
        };
        for k in 6..10 {
            let order = core_math::log2(error(k) / error(k + 1));
            assert!((1.7..2.4).contains(&order), "{}: order {order} at 2^-{k}", operator.name());
        }
    }
}
