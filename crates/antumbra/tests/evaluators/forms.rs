//! What the kinds of number say besides a range: planes over symbols, slopes, derivatives.
use crate::containment::{Operator, around};
use antumbra::eval::{Gradient, run};
use antumbra::expr::{Axis, Formula};
use antumbra::tape::Tape;
use antumbra_interval::affine::{Affine, Apex, Dual, Slope};
use antumbra_interval::{Decorated, Interval};
use fastrand::Rng;

/// A multiple of 2^-20 in [-1, 1]: products and sums of a few of them are exact.
pub(super) fn coarse(r: &mut Rng) -> f64 {
    f64::from(r.i32(-(1 << 20)..=1 << 20)) / f64::from(1 << 20)
}

/// A multiple of 1/8 in [-1, 1], often an end.
pub(super) fn symbol(r: &mut Rng) -> f64 {
    f64::from([-8, 8, r.i32(-8..=8)][r.usize(0..3)]) / 8.0
}

/// A form and a member of it at `s`: exact.
fn form<const N: usize>(r: &mut Rng, s: &[f64; N]) -> (Affine<N>, f64) {
    let c = coarse(r) * [0.0, 1.0, 4.0, 16.0][r.usize(0..4)];
    let scale = [0.0, 1.0, 2.0, 1.0 / 1024.0][r.usize(0..4)];
    let a: [f64; N] = std::array::from_fn(|_| coarse(r) * scale);
    let e = if r.bool() { 0.0 } else { coarse(r).abs() * scale };
    let value = (0..N).fold(c + e * symbol(r), |sum, i| sum + a[i] * s[i]);
    (Affine::linear(c, a, e), value)
}

/// The values that a form admits at `s`.
fn at<const N: usize>(x: &Affine<N>, s: &[f64; N]) -> Interval {
    if !x.is_known() {
        return Interval::ENTIRE;
    }
    let e = x.error();
    let start = Interval::point(x.centre()) + Interval::new(-e, e);
    (0..N).fold(start, |sum, i| sum + Interval::point(x.coefficients()[i]) * Interval::point(s[i]))
}

fn planes<const N: usize>(seed: u64) {
    let mut r = Rng::with_seed(seed);
    for operator in Operator::all() {
        let mut known = 0;
        for _ in 0..1500 {
            let s: [f64; N] = std::array::from_fn(|_| symbol(&mut r));
            let ((a, p), (b, q)) = (form(&mut r, &s), form(&mut r, &s));
            let y = operator.apply(a, b);
            let Some(truth) = operator.truth(p, q) else { continue };
            let admitted = at(&y, &s);
            assert!(
                truth.possibly_in(admitted.lo(), admitted.hi()),
                "{} of {a:?}, {b:?} at {s:?}: {y:?} does not admit {truth:?}",
                operator.name()
            );
            known += u32::from(y.is_known());
        }
        assert!(known > 50, "{}: {known} known forms", operator.name());
    }
}

#[test]
fn planes_hold_at_every_symbol_value() {
    planes::<1>(41);
    planes::<3>(42);
    planes::<5>(43);
}

/// `f(P + t D) = f(P) + t g` where all three are exact floats: t in [0, 1] from symbol 0.
fn slopes<P: Apex<Affine<N>> + std::fmt::Debug, const N: usize>(seed: u64) {
    let mut r = Rng::with_seed(seed);
    for operator in Operator::all() {
        let mut known = 0;
        for _ in 0..1500 {
            let s: [f64; N] = std::array::from_fn(|_| symbol(&mut r));
            let t_of = |s: f64| 0.5 * s + 0.5;
            let t = Affine::linear(0.5, std::array::from_fn(|i| if i == 0 { 0.5 } else { 0.0 }), 0.0);
            let mut operand = || {
                let p = coarse(&mut r) * [1.0, 4.0, 16.0][r.usize(0..3)];
                let (d, direction) = form(&mut r, &s);
                (Slope::<P, N>::coordinate(P::constant(Interval::point(p)), t, d), p, direction)
            };
            let ((a, pa, da), (b, pb, db)) = (operand(), operand());
            let tau = t_of(s[0]);
            let y = operator.apply(a, b);
            // Multiples of 2^-23 below 64 times 2^-4: exact.
            let values = (operator.truth(pa, pb), operator.truth(pa + tau * da, pb + tau * db));
            let (Some(from), Some(to)) = values else { continue };
            let rise = around(to) - around(from);
            let admitted = at(&y.slope, &s) * Interval::point(tau);
            assert!(
                rise.possibly_intersects(admitted),
                "{} of {a:?}, {b:?} at {s:?}: {y:?}, but the values are {from:?} and {to:?}",
                operator.name()
            );
            let apex = y.apex.range();
            assert!(from.possibly_in(apex.lo(), apex.hi()), "{}: apex of {y:?} is {from:?}", operator.name());
            known += u32::from(y.slope.is_known());
        }
        // Powers of a thousand and more overflow almost everywhere.
        let huge = matches!(operator, Operator::Powi(n) if n.unsigned_abs() > 100);
        assert!(known > 50 || huge, "{}: {known} known slopes", operator.name());
    }
}

#[test]
fn slopes_hold_at_every_symbol_value() {
    slopes::<Interval, 3>(44);
    slopes::<Affine<5>, 5>(45);
}

pub(super) fn compile(text: &str) -> (Formula, Tape) {
    let formula = Formula::parse(text).unwrap_or_else(|e| panic!("{}", e.render(text)));
    let tape = Tape::compile(&formula).unwrap();
    (formula, tape)
}

pub(super) const FORMULAS: [&str; 12] = [
    "((x^2 + y^2 - 1)^2 + z^2) ((y^2 + z^2 - 1)^2 + x^2) ((z^2 + x^2 - 1)^2 + y^2) - 0.01",
    "x^4 + y^4 + z^4 - x^2 - y^2 - z^2 + 1/2",
    "(x^2 + 3) (y^2 + 3) (z^2 + 3) - 32 (x y z + 1)",
    "(1 + x^2) (1 + y^2) (1 + z^2) + 8 x y z - 2",
    "sin(x) cos(y) + sin(y) cos(z) + sin(z) cos(x)",
    "exp(x y) / (2 + sin(z)) - ln(3 + x^2)",
    "sqrt(x^2 + y^2 + 0.1) - cbrt(z + 5) + tanh(x - z)",
    "atan2(y + 3, x) asin(z/4) + acos(x/4) atan(y) - tan(z/2)",
    "sinh(x) cosh(y) - (2 + cos(z))^(1.5 + x/4)",
    "abs(x - y) + max(x, z) - min(y z, 0.3)",
    "smooth_union(sphere(0.8), translate(box(0.5), 0.3, 0, 0), 0.2)",
    "(x + 3)^-2 - (x + 3)^7 / 1000 + floor(x / 10) + sign(y + 9)",
];

/// The derivative's formula, enclosed at a point, meets the partial enclosed over a box around it, and the derivative along a
/// ray is the one of the gradient.
#[test]
fn gradients_agree_with_symbolic_derivatives_and_with_dual_numbers() {
    let mut r = Rng::with_seed(46);
    for text in FORMULAS {
        let (formula, tape) = compile(text);
        let derivatives = [Axis::X, Axis::Y, Axis::Z].map(|axis| formula.derivative(axis));
        let symbolic = derivatives.map(|d| Tape::compile(d.formula()).unwrap());
        for _ in 0..200 {
            let p: [f64; 3] = std::array::from_fn(|_| r.f64() * 3.0 - 1.5);
            let width = [0.0, 1e-6, 0.1][r.usize(0..3)];
            let x = p.map(|v| Interval::new(v - width * r.f64(), v + width * r.f64()));
            let gradient = run(&tape, Gradient::coordinates(x), &mut vec![]);
            let point = p.map(Interval::point);
            for (axis, derivative) in symbolic.iter().enumerate() {
                let exact = run(derivative, point.map(Decorated::from), &mut vec![]);
                let (partial, exact) = (gradient.partials[axis], exact.interval);
                assert!(partial.possibly_intersects(exact), "{text} by axis {axis} at {p:?}: {partial:?}, {exact:?}");
                if width == 0.0 {
                    let size = 1.0 + exact.magnitude();
                    assert!(partial.width() < 1e-9 * size, "{text} by axis {axis} at {p:?}: {partial:?} is wide");
                }
            }
            let d: [f64; 3] = std::array::from_fn(|_| coarse(&mut r));
            let ray = std::array::from_fn(|k| Dual {
                value: Affine::<1>::constant(x[k]),
                derivative: Affine::constant(Interval::point(d[k])),
            });
            let along = run(&tape, ray, &mut vec![]).derivative.range();
            let inner = (0..3).fold(Interval::ZERO, |sum, k| sum + gradient.partials[k] * Interval::point(d[k]));
            assert!(along.possibly_intersects(inner), "{text} along {d:?} in {x:?}: {along:?}, {inner:?}");
        }
    }
}

/// Difference quotients lie in the gradient over the box of both points: the mean value theorem, kinks included.
#[test]
fn difference_quotients_lie_in_the_gradient() {
    let mut r = Rng::with_seed(47);
    for text in FORMULAS {
        let (_, tape) = compile(text);
        for _ in 0..300 {
            let p: [f64; 3] = std::array::from_fn(|_| r.f64() * 3.0 - 1.5);
            let q: [f64; 3] = std::array::from_fn(|k| p[k] + [1e-3, 0.05, 1.0][r.usize(0..3)] * coarse(&mut r));
            let x: [Interval; 3] = std::array::from_fn(|k| Interval::point(p[k]).hull(Interval::point(q[k])));
            if !run(&tape, x.map(Decorated::from), &mut vec![]).certainly_continuous() {
                continue;
            }
            let value = |p: [f64; 3]| run(&tape, p.map(Interval::point), &mut vec![]);
            let gradient = run(&tape, Gradient::coordinates(x), &mut vec![]);
            let bound = (0..3).fold(Interval::ZERO, |sum, k| {
                sum + gradient.partials[k] * (Interval::point(q[k]) - Interval::point(p[k]))
            });
            assert!((value(q) - value(p)).possibly_intersects(bound), "{text} from {p:?} to {q:?}: {bound:?}");
        }
    }
}
