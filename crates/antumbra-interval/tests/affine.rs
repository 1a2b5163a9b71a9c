//! Affine forms: containment against exact arithmetic, tightness, order of convergence, overflow and NaN.
mod affine_samples;

use affine_samples::{
    Dyadic, Random, allows, allows_ratio, exact, meets, member, neighbours, ordered, plane, power_of_two,
};
use antumbra_interval::{Interval, affine::Affine};

/// Ring operators on nasty forms, exactly.
fn ring<const N: usize>(seed: u64, rounds: usize) {
    let mut r = Random(seed);
    let mut known = 0;
    for _ in 0..rounds {
        let (x, y) = (r.nasty_form::<N>(), r.nasty_form::<N>());
        let same = x;
        let k = r.nasty();
        let h = r.nasty().abs();
        let wide = Interval::new(k - h, k + h);
        let forms = [
            x + y,
            x - y,
            x * y,
            x.sqr(),
            -x,
            x.mul_f64(k),
            x.add_f64(k),
            x.mul_interval(wide),
            x.add_interval(wide),
            x.max(y),
            x.min(y),
            x.abs(),
            x.powi(3),
            x.powi(4),
            x * x,
            x.max(x.mul_f64(0.5)),
        ];
        known += forms.iter().filter(|f| f.is_known()).count();
        for _ in 0..3 {
            let s = r.symbols::<N>();
            let (a, b) = (member(&x, &s, r.symbol()), member(&y, &s, r.symbol()));
            let (q, w) = (exact(k), exact(if r.below(2) == 0 { wide.lo() } else { wide.hi() }));
            let (zero, one) = (exact(0.0), exact(1.0));
            let larger = |a: &Dyadic, b: &Dyadic| if a > b { a.clone() } else { b.clone() };
            let smaller = |a: &Dyadic, b: &Dyadic| if a < b { a.clone() } else { b.clone() };
            let square = &a * &a;
            let values = [
                &a + &b,
                &a - &b,
                &a * &b,
                square.clone(),
                &zero - &a,
                &a * &q,
                &a + &q,
                &a * &w,
                &a + &w,
                larger(&a, &b),
                smaller(&a, &b),
                a.abs(),
                &square * &a,
                &square * &square,
                square,
                larger(&a, &(&a * &exact(0.5))),
            ];
            for (i, (f, v)) in forms.iter().zip(&values).enumerate() {
                assert!(allows(f, &s, v), "operator {i} of {x:?}, {y:?}, {k:e} at {s:?}: {f:?}");
            }
            assert!(a.is_zero() || allows_ratio(&x.recip(), &s, &one, &a), "1/{x:?} at {s:?}");
            assert!(b.is_zero() || allows_ratio(&(x / y), &s, &a, &b), "{x:?} / {y:?} at {s:?}");
            // The same member on both sides.
            assert!(x.error() > 0.0 || allows(&(x - same), &s, &zero), "{x:?}");
        }
    }
    assert!(known > 14 * rounds, "mostly unknown: {known} forms in {rounds} rounds of 16");
}

#[test]
fn ring_operators_contain_the_exact_value() {
    ring::<0>(1, 3000);
    ring::<1>(2, 8000);
    ring::<3>(3, 8000);
    ring::<5>(4, 4000);
}

type Row<const N: usize> =
    (&'static str, fn(Affine<N>) -> Affine<N>, fn(f64) -> f64, fn(Interval) -> Interval, f64, f64);

/// Name, form, correctly rounded function, interval function, where to look.
fn functions<const N: usize>() -> Vec<Row<N>> {
    vec![
        ("sqrt", Affine::sqrt, f64::sqrt, Interval::sqrt, -0.2, 5.0),
        ("cbrt", Affine::cbrt, core_math::cbrt, Interval::cbrt, -3.0, 3.0),
        ("exp", Affine::exp, core_math::exp, Interval::exp, -20.0, 20.0),
        ("ln", Affine::ln, core_math::log, Interval::ln, -0.1, 9.0),
        ("sin", Affine::sin, core_math::sin, Interval::sin, -12.0, 12.0),
        ("sin far", Affine::sin, core_math::sin, Interval::sin, 1e6, 1e6 + 9.0),
        ("cos", Affine::cos, core_math::cos, Interval::cos, -12.0, 12.0),
        ("tan", Affine::tan, core_math::tan, Interval::tan, -5.0, 5.0),
        ("asin", Affine::asin, core_math::asin, Interval::asin, -1.1, 1.1),
        ("acos", Affine::acos, core_math::acos, Interval::acos, -1.1, 1.1),
        ("atan", Affine::atan, core_math::atan, Interval::atan, -9.0, 9.0),
        ("sinh", Affine::sinh, core_math::sinh, Interval::sinh, -9.0, 9.0),
        ("cosh", Affine::cosh, core_math::cosh, Interval::cosh, -9.0, 9.0),
        ("tanh", Affine::tanh, core_math::tanh, Interval::tanh, -9.0, 9.0),
        ("recip", Affine::recip, |x| 1.0 / x, |x| Interval::ONE / x, 0.01, 9.0),
        ("powi 5", |x| x.powi(5), |x| core_math::pow(x, 5.0), |x| x.powi(5), -3.0, 3.0),
        ("powi 6", |x| x.powi(6), |x| core_math::pow(x, 6.0), |x| x.powi(6), -3.0, 3.0),
        ("powi -3", |x| x.powi(-3), |x| core_math::pow(x, -3.0), |x| x.powi(-3), -3.0, 3.0),
        ("powi -2", |x| x.powi(-2), |x| core_math::pow(x, -2.0), |x| x.powi(-2), -3.0, 3.0),
        ("pow 0.3", |x| x.pow(number(0.3)), |x| core_math::pow(x, 0.3), |x| x.pow(Interval::point(0.3)), -0.1, 9.0),
        ("pow 2.5", |x| x.pow(number(2.5)), |x| core_math::pow(x, 2.5), |x| x.pow(Interval::point(2.5)), -0.1, 9.0),
        ("pow -1.5", |x| x.pow(number(-1.5)), |x| core_math::pow(x, -1.5), |x| x.pow(Interval::point(-1.5)), 0.01, 9.0),
        ("2 pow", |x| number(2.0).pow(x), |x| core_math::pow(2.0, x), |x| Interval::point(2.0).pow(x), -9.0, 9.0),
        ("floor", Affine::floor, f64::floor, Interval::floor, -4.0, 4.0),
        ("sign", Affine::sign, |x| f64::from(i8::from(x > 0.0) - i8::from(x < 0.0)), Interval::sign, -1.0, 1.0),
        ("abs", Affine::abs, f64::abs, Interval::abs, -1.0, 1.0),
    ]
}

fn number<const N: usize>(x: f64) -> Affine<N> {
    Affine::constant(Interval::point(x))
}

/// The true value is between the floats around the correctly rounded values at the floats around the argument (the
/// functions are monotone there, or so flat that the difference is below an ulp).
fn elementary<const N: usize>(seed: u64, rounds: usize) {
    for (name, form, function, _, lo, hi) in functions::<N>() {
        let mut r = Random(seed);
        let (mut known, mut checked) = (0, 0);
        for i in 0..rounds {
            let x = r.form::<N>(lo, hi, if i % 8 == 0 { 3.0 * (hi - lo) } else { 0.3 * (hi - lo) });
            let f = form(x);
            known += usize::from(f.is_known());
            for _ in 0..6 {
                let s = r.symbols::<N>();
                let (p, q) = neighbours(&member(&x, &s, r.symbol()));
                let (u, v) = (function(p), function(q));
                if u.is_nan() || v.is_nan() {
                    continue; // undefined here
                }
                if matches!(name, "floor" | "sign") && u != v {
                    continue;
                }
                checked += 1;
                let (below, above) = (ordered(u, v).0.next_down(), ordered(u, v).1.next_up());
                assert!(meets(&f, &s, below, above), "{name} of {x:?} at {s:?}: {f:?}, true in [{below}, {above}]");
            }
        }
        assert!(checked > rounds, "{name}: nothing checked");
        assert!(known * 2 > rounds, "{name}: known only {known} of {rounds} times");
    }
}

#[test]
fn elementary_functions_contain_the_true_value() {
    elementary::<1>(11, 2000);
    elementary::<3>(12, 1500);
    elementary::<5>(13, 500);
}

/// Extreme arguments neither panic nor lie.
#[test]
fn elementary_functions_of_extreme_arguments() {
    let mut r = Random(99);
    for (name, form, function, ..) in functions::<1>() {
        for _ in 0..1500 {
            let c = r.nasty() * if r.below(4) == 0 { 1e150 } else { 1.0 };
            let x = Affine::linear(c, [r.nasty()], if r.below(2) == 0 { 0.0 } else { r.nasty().abs() });
            let f = form(x);
            for _ in 0..3 {
                let s = r.symbols::<1>();
                let (p, q) = neighbours(&member(&x, &s, r.symbol()));
                let (u, v) = (function(p), function(q));
                // An ulp of a large argument is a large step: skip what is not monotone or has jumps there.
                let jumps = matches!(name, "floor" | "sign") && u != v;
                let waves = matches!(name, "sin" | "sin far" | "cos" | "tan") && p.abs() > 1e3 && p != q;
                if u.is_nan() || v.is_nan() || jumps || waves {
                    continue;
                }
                let (below, above) = (ordered(u, v).0.next_down(), ordered(u, v).1.next_up());
                assert!(meets(&f, &s, below, above), "{name} of {x:?} at {s:?}: {f:?}, true in [{below:e}, {above:e}]");
            }
        }
    }
}

#[test]
fn atan2_contains_the_angle() {
    let mut r = Random(5);
    let mut known = 0;
    for _ in 0..4000 {
        let (y, x) = (r.form::<3>(-2.0, 2.0, 0.5), r.form::<3>(-2.0, 2.0, 0.5));
        let f = y.atan2(x);
        known += usize::from(f.is_known() && f.error() < 0.2);
        for _ in 0..4 {
            let s = r.symbols::<3>();
            let (a, b) = (member(&y, &s, r.symbol()), member(&x, &s, r.symbol()));
            let ((y0, y1), (x0, x1)) = (neighbours(&a), neighbours(&b));
            let v = [(y0, x0), (y0, x1), (y1, x0), (y1, x1)].map(|(y, x)| core_math::atan2(y, x));
            let (lo, hi) =
                v.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (ordered(l, *v).0, ordered(h, *v).1));
            assert!(meets(&f, &s, lo.next_down(), hi.next_up()), "{y:?} {x:?} {f:?}");
        }
    }
    assert!(known > 3000, "{known}");
}

/// No error bound is larger than half the width of the interval function, but for rounding.
#[test]
fn errors_are_at_most_the_radius_of_the_interval_function() {
    for (name, form, function, over, lo, hi) in functions::<3>() {
        if over(Interval::new(0.5, 0.75)) == Interval::ENTIRE && name != "sqrt" {
            panic!("{name}: the interval function says nothing");
        }
        let mut r = Random(21);
        for _ in 0..1500 {
            let x = r.form::<3>(lo, hi, 0.5 * (hi - lo));
            let y = over(x.range());
            if y.is_empty() || !(y.hi() - y.lo()).is_finite() {
                continue;
            }
            let (radius, f) = (0.5 * (y.hi() - y.lo()), form(x));
            let scale = y.magnitude() + x.range().magnitude() * slope_scale(name, function, x.centre());
            assert!(
                f.error() <= 1.001 * radius + 64.0 * f64::EPSILON * scale,
                "{name} of {x:?} in {:?}: {f:?} against {y:?}",
                x.range()
            );
        }
    }
}

/// About `|h'|`, which multiplies the rounding of the argument.
fn slope_scale(name: &str, function: fn(f64) -> f64, x: f64) -> f64 {
    let d = (function(x + 1e-4) - function(x - 1e-4)).abs() / 2e-4;
    if d.is_finite() && name != "floor" { 2.0 * d + 1.0 } else { 1e3 }
}

/// Halving the argument's width divides the error by four.
#[test]
fn smooth_functions_converge_quadratically() {
    type Function = fn(Affine<3>) -> Affine<3>;
    let smooth: [(Function, f64); 18] = [
        (Affine::sqrt, 1.3),
        (Affine::cbrt, -0.7),
        (Affine::exp, 0.4),
        (Affine::ln, 2.0),
        (Affine::sin, 1.1),
        (Affine::cos, 7.0),
        (Affine::tan, 0.6),
        (Affine::asin, 0.5),
        (Affine::acos, -0.4),
        (Affine::atan, 0.8),
        (Affine::sinh, -1.0),
        (Affine::cosh, 0.3),
        (Affine::tanh, 0.5),
        (Affine::recip, -2.0),
        (Affine::sqr, 0.9),
        (|x| x.powi(7), 0.8),
        (|x| x.pow(number(1.7)), 0.8),
        (|x| (x.sin() * x.exp() - x.sqr() / x.add_f64(3.0)).tanh(), 0.8),
    ];
    for (i, (form, at)) in smooth.into_iter().enumerate() {
        let error = |w: f64| form(Affine::linear(at, [w, -0.5 * w, 0.2 * w], 0.0)).error();
        for k in 5..9 {
            let (wide, narrow) = (error(power_of_two(-k)), error(power_of_two(-k - 1)));
            let order = core_math::log2(wide / narrow);
            assert!((1.85..2.15).contains(&order), "function {i}: order {order} at width 2^-{k}");
        }
    }
}

/// The best linear approximations are known in closed form.
#[test]
fn linearisations_are_chebyshev() {
    let over = |lo, hi| Affine::<1>::spanning(0, Interval::new(lo, hi));
    let close = |name: &str, f: Affine<1>, best: f64| {
        assert!(f.error() >= best * (1.0 - 1e-12) && f.error() <= best * 1.001, "{name}: {} for {best}", f.error());
    };
    close("sqrt", over(0.0, 1.0).sqrt(), 0.125);
    close("sqr", over(-1.0, 1.0).sqr(), 0.5);
    close("abs", over(-1.0, 1.0).abs(), 0.5);
    close("cube", over(-1.0, 1.0).powi(3), 0.25);
    close("fourth", over(-1.0, 1.0).powi(4), 0.5);
    // e^x on [0, 1]: slope e - 1, half of the largest deviation from the secant.
    let m = std::f64::consts::E - 1.0;
    close("exp", over(0.0, 1.0).exp(), 0.5 * (1.0 - (m - m * core_math::log(m))));
    close("ln", over(1.0, 2.0).ln(), 0.5 * (-core_math::log(core_math::log(2.0)) - 1.0 + core_math::log(2.0)));
    close("recip", over(1.0, 2.0).recip(), 0.5 * (1.5 - 2f64.sqrt()));
    close("max", over(-1.0, 1.0).max(Affine::ZERO), 0.25);
}

#[test]
fn positive_functions_stay_positive() {
    for (lo, hi) in [(0.05, 9.0), (0.5, 20.0), (1.0, 1.5)] {
        let x = Affine::<2>::spanning(1, Interval::new(lo, hi));
        for f in [x.exp(), x.recip(), x.cosh(), x.powi(3), x.powi(4), x.powi(-3), x.pow(number(2.5))] {
            assert!(f.range().certainly_positive(), "{x:?} -> {f:?}, {:?}", f.range());
        }
    }
}

#[test]
fn choices_are_tight_where_settled() {
    let x = Affine::linear(3.0, [0.5, 0.25], 0.125);
    let y = Affine::linear(1.0, [0.25, -0.25], 0.25);
    assert_eq!(x.max(y), x);
    assert_eq!(y.max(x), x);
    assert_eq!(x.min(y), y);
    assert_eq!(x.abs(), x);
    assert_eq!((-x).abs(), x);
    assert_eq!(x.sign().range(), Interval::ONE);
    assert_eq!(x.mul_f64(0.1).floor(), Affine::ZERO);
    // Parallel planes, one certainly above although the errors overlap: max >= x, max <= x + e.
    let z = x.add_f64(-0.5);
    let w = Affine::linear(z.centre(), *z.coefficients(), 0.5);
    assert_eq!(x.max(w), x);
    // An unknown operand leaves nothing: no one-sided forms.
    assert!(!x.max(Affine::UNKNOWN).is_known());
}

#[test]
fn symbols_cancel() {
    let x = Affine::<3>::linear(1.0, [0.5, 0.25, 2.0], 0.0);
    let same = x;
    assert!((x - same).range().magnitude() < 1e-14);
    assert!((x.sqr() - x * x).error() < 2.0 * x.sqr().error() + (x * x).error());
    // (x + 1)^2 - x^2 - 2x = 1.
    let one = x.add_f64(1.0).sqr() - x.sqr() - x.mul_f64(2.0);
    assert!(one.range().contains(1.0));
}

#[test]
fn ranges_and_planes_bound_the_form() {
    let mut r = Random(31);
    for _ in 0..3000 {
        let x = r.nasty_form::<3>();
        let s = r.symbols::<3>();
        let (low, high) = (member(&x, &s, -1.0), member(&x, &s, 1.0));
        let range = x.range();
        assert!(exact(range.lo()) <= low && high <= exact(range.hi()), "{x:?} {range:?}");
        let with = |k: f64, a: &[f64; 3]| plane(&Affine::linear(k, *a, 0.0), &s);
        let ((k, a), (q, b)) = (x.lower_plane(), x.upper_plane());
        assert!(with(k, &a) <= low && with(q, &b) >= high, "{x:?}");
    }
}

#[test]
fn outside_of_its_crossing_a_form_has_the_sign_that_is_said() {
    let mut r = Random(33);
    let (mut outside, mut cut) = (0, 0);
    for _ in 0..20000 {
        let x = r.nasty_form::<3>();
        let Some(found) = x.crossing(1) else {
            assert!(x.coefficients()[1] == 0.0 || !x.range().possibly_zero() || !x.is_known(), "{x:?}");
            continue;
        };
        let zeros = found.zeros;
        cut += u32::from(zeros.lo() > -1.0 || zeros.hi() < 1.0);
        let inner_end = |end: f64| (-1.0 < end && end < 1.0).then_some(end);
        // Their ends within (-1, 1) too.
        let ends = [inner_end(zeros.lo()), inner_end(zeros.hi())].into_iter().flatten();
        let symbols: Vec<f64> = ends.chain([-1.0, 1.0, r.signed(), r.signed()]).collect();
        for symbol in symbols {
            let before = symbol <= zeros.lo() && zeros.lo() > -1.0;
            if !before && (symbol < zeros.hi() || zeros.hi() >= 1.0) {
                continue;
            }
            let mut s = r.symbols::<3>();
            s[1] = symbol;
            for error in [-1.0, r.symbol(), 1.0] {
                let value = member(&x, &s, error);
                let positive = value > exact(0.0);
                assert!(!value.is_zero() && positive == (before != found.rises), "{x:?} at {s:?}: {found:?}");
                outside += 1;
            }
        }
    }
    assert!(outside > 10000 && cut > 2000, "{outside} values, {cut} forms");
}

#[test]
fn a_crossing_is_no_wider_than_the_plane_is_thick() {
    // s_0/2 + 0.1 s_1 - 0.2 +- 0.05: zeros at 0.4 +- 0.3.
    let found = Affine::<2>::linear(-0.2, [0.5, 0.1], 0.05).crossing(0).unwrap();
    let close = |a: f64, b: f64| (a - b).abs() < 1e-14;
    assert!(found.rises && close(found.zeros.lo(), 0.1) && close(found.zeros.hi(), 0.7), "{found:?}");
    assert_eq!(Affine::<2>::linear(3.0, [0.5, 0.1], 0.05).crossing(0), None, "nowhere 0");
    assert_eq!(Affine::<2>::UNKNOWN.crossing(0), None);
    let falls = Affine::<1>::linear(0.0, [-1e-300], 0.0).crossing(0).unwrap();
    assert!(!falls.rises && falls.zeros.contains(0.0));
}

#[test]
fn spanning_and_constant_contain_their_interval() {
    let mut r = Random(32);
    for _ in 0..3000 {
        let (p, q) = (r.nasty(), r.nasty());
        let k = Interval::new(ordered(p, q).0, ordered(p, q).1);
        let (x, c) = (Affine::<2>::spanning(1, k), Affine::<2>::constant(k));
        let s = r.symbols::<2>();
        let t = (exact(s[1]) + exact(1.0)) * exact(0.5);
        let v = exact(k.lo()) + (exact(k.hi()) - exact(k.lo())) * t;
        assert!(allows(&x, &s, &v) && allows(&c, &s, &v), "{k:?} {x:?} {c:?}");
    }
    assert_eq!(Affine::<2>::constant(Interval::point(0.1)).error(), 0.0);
}

#[test]
fn nan_and_overflow_prove_nothing() {
    let unknown = |f: Affine<2>| assert!(f == Affine::UNKNOWN && f.range() == Interval::ENTIRE, "{f:?}");
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX] {
        unknown(Affine::linear(bad, [0.0; 2], 0.0));
        unknown(Affine::linear(0.0, [0.0, bad], 0.0));
        unknown(Affine::linear(0.0, [0.0; 2], bad));
        unknown(Affine::linear(1.0, [0.0; 2], 1.0).mul_f64(bad).mul_f64(1e300));
        unknown(Affine::linear(0.0, [0.0; 2], 0.0).add_f64(bad));
    }
    unknown(Affine::linear(0.0, [0.0; 2], -1.0));
    unknown(Affine::constant(Interval::ENTIRE));
    unknown(Affine::constant(Interval::EMPTY));
    unknown(Affine::constant(Interval::new(0.0, f64::INFINITY)));
    let huge = Affine::linear(1e200, [1e200, 0.0], 0.0);
    unknown(huge * huge);
    unknown(huge.sqr());
    unknown(huge.powi(3));
    unknown(huge.exp());
    unknown(huge.sinh());
    unknown(huge * Affine::UNKNOWN);
    let u = Affine::<2>::UNKNOWN;
    let x = Affine::linear(0.5, [0.1, 0.1], 0.0);
    for f in
        [u + x, x - u, u * x, u * Affine::ZERO, u.sqr(), -u, u.max(x), x.min(u), u.abs(), u.mul_f64(0.0), u.recip()]
    {
        unknown(f);
    }
    for f in [u.sqrt(), u.ln(), u.exp(), u.tan(), u.powi(3), u.powi(-2), x / u, u / x, u.floor(), u.cosh(), u.pow(x)] {
        unknown(f);
    }
    // Bounded functions know their bounds.
    for f in [u.sin(), u.cos(), u.sign(), u.tanh()] {
        assert!(f.range().magnitude() < 1.000001);
    }
    let zero = Affine::linear(0.0, [1.0, 0.0], 0.0);
    for f in [zero.recip(), zero.ln(), x / zero, zero.powi(-1), zero.powi(-2), zero.mul_f64(2.0).tan()] {
        unknown(f);
    }
}
