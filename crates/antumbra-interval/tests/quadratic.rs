//! Quadratic forms against exact arithmetic: ring operations on forms of every size, elimination, overflow.
mod affine_samples;

use affine_samples::{Dyadic, Random, exact};
use antumbra_interval::Interval;
use antumbra_interval::affine::Affine;
use antumbra_interval::quadratic::Quadratic;

/// Numbers of any size, or all of one size: then roundings matter.
fn form(r: &mut Random, nasty: bool) -> Quadratic {
    let mut number = |scale: f64| if nasty { r.nasty() } else { scale * r.signed() };
    let (c, l) = (number(1.0), std::array::from_fn(|_| number(0.5)));
    let (q, e) = (std::array::from_fn(|_| number(0.25)), number(1e-9).abs());
    Quadratic::polynomial(c, l, q, if r.below(2) == 0 { 0.0 } else { e })
}

/// The polynomial at symbol values, exactly.
fn polynomial(x: &Quadratic, p: &[f64; 3]) -> Dyadic {
    let [s, a, b] = [exact(p[0]), exact(p[1]), exact(p[2])];
    let terms = [s.clone(), a.clone(), b.clone(), &s * &s, &a * &a, &b * &b, &s * &a, &s * &b, &a * &b];
    let coefficients = x.linear().iter().chain(x.quadratic());
    coefficients.zip(&terms).fold(exact(x.centre()), |sum, (k, t)| sum + &exact(*k) * t)
}

fn member(x: &Quadratic, p: &[f64; 3], w: f64) -> Dyadic {
    polynomial(x, p) + exact(w) * exact(x.error())
}

fn allows(x: &Quadratic, p: &[f64; 3], v: &Dyadic) -> bool {
    !x.is_known() || (v - &polynomial(x, p)).abs() <= exact(x.error())
}

#[test]
fn ring_operations_contain_the_exact_value() {
    let mut r = Random(1);
    let mut known = 0;
    for round in 0..30_000 {
        let (x, y) = (form(&mut r, round % 3 == 0), form(&mut r, round % 3 == 0));
        if !x.is_known() || !y.is_known() {
            continue;
        }
        let p = r.symbols::<3>();
        let (v, w) = (member(&x, &p, r.symbol()), member(&y, &p, r.symbol()));
        let k = if round % 5 == 0 { r.nasty() } else { r.signed() };
        let wide = Interval::new(k, k + k.abs() * 1e-12);
        for (name, z, truth) in [
            ("sum", x + y, &v + &w),
            ("difference", x - y, &v - &w),
            ("product", x * y, &v * &w),
            ("square", x.sqr(), &v * &v),
            ("negative", -x, exact(0.0) - v.clone()),
            ("cube", x.powi(3), &(&v * &v) * &v),
            ("multiple", x.mul_f64(k), &v * &exact(k)),
            ("interval multiple", x.mul_interval(wide), &v * &exact(wide.hi())),
            ("shift", x.add_interval(wide), &v + &exact(wide.lo())),
        ] {
            assert!(allows(&z, &p, &truth), "{name} of {x:?}, {y:?}, {k} at {p:?}: {z:?}");
            known += u32::from(z.is_known());
            let range = z.range();
            let inside = |lo: f64, hi: f64| {
                (lo == f64::NEG_INFINITY || exact(lo) <= truth) && (hi == f64::INFINITY || truth <= exact(hi))
            };
            assert!(inside(range.lo(), range.hi()), "{name}: range {range:?} of {z:?}");
        }
    }
    assert!(known > 100_000, "{known}");
}

#[test]
fn products_of_planes_contain_the_exact_value_and_lose_only_rounding() {
    let mut r = Random(2);
    for round in 0..20_000 {
        let plane = |r: &mut Random| if round % 3 == 0 { r.nasty_form::<3>() } else { r.form(-1.0, 1.0, 1.0) };
        let (x, y) = (plane(&mut r), plane(&mut r));
        let z = Quadratic::product_of(&x, &y);
        if !x.is_known() || !y.is_known() {
            continue;
        }
        let p = r.symbols::<3>();
        let truth = &affine_samples::member(&x, &p, r.symbol()) * &affine_samples::member(&y, &p, r.symbol());
        assert!(allows(&z, &p, &truth), "{x:?}, {y:?} at {p:?}: {z:?}");
        if x.error() == 0.0 && y.error() == 0.0 && round % 3 != 0 {
            assert!(z.error() <= 1e-14, "{z:?}");
        }
    }
}

/// `Q(s, a, b) >= lower - error` at every place, and `<= upper + error` for the least of many s.
#[test]
fn elimination_is_exact_up_to_its_error() {
    let mut r = Random(3);
    let mut used = 0;
    for round in 0..20_000 {
        let x = form(&mut r, round % 4 == 0);
        let least = x.eliminate();
        if !least.error.is_finite() {
            continue;
        }
        used += 1;
        let p = r.symbols::<3>();
        let paraboloid = |m: &antumbra_interval::quadratic::Paraboloid| {
            let (a, b) = (exact(p[1]), exact(p[2]));
            let terms = [a.clone(), b.clone(), &a * &a, &b * &b, &a * &b];
            m.l.iter().chain(&m.q).zip(&terms).fold(exact(m.c), |sum, (k, t)| sum + &exact(*k) * t)
        };
        let (lower, upper, error) = (paraboloid(&least.lower), paraboloid(&least.upper), exact(least.error));
        let at = |s: f64| polynomial(&x, &[s, p[1], p[2]]) - exact(x.error());
        assert!(&lower - &error <= at(p[0]), "{x:?} at {p:?}: {least:?}");
        // The minimiser, rounded; close to it the parabola is flat.
        let [h, n] = [x.quadratic()[0], x.linear()[0] + x.quadratic()[3] * p[1] + x.quadratic()[4] * p[2]];
        let inner = -0.5 * n / h;
        let best = [-1.0, 1.0, if inner.abs() <= 1.0 { inner } else { 0.0 }]
            .map(at)
            .into_iter()
            .reduce(|a, b| if a < b { a } else { b })
            .unwrap();
        let slack = exact(1e-15 * (h.abs() + n.abs()) + f64::MIN_POSITIVE);
        assert!(best <= &(upper + error) + &slack, "{x:?} at {p:?}: {least:?}");
        assert!(
            exact(least.lower.lower_bound()) <= lower && exact(least.upper.upper_bound()) >= paraboloid(&least.upper)
        );
    }
    assert!(used > 10_000, "{used}");
}

/// Numbers of which one in some rules the form along `s`: slopes for zeros, squares for turns.
fn along_s(r: &mut Random, slope: f64, square: f64, across: f64) -> Quadratic {
    let mut number = |scale: f64| scale * r.signed();
    let (c, l) = (number(0.5 * (slope + square)), [number(slope), number(across), number(across)]);
    let q = [number(square), number(across), number(across), number(across), number(across), number(across)];
    Quadratic::polynomial(c, l, q, number(1e-3).abs())
}

/// On a line the function, whatever it is within the error, is negative before the zeros and positive behind them, or the other way round.
#[test]
fn zeros_on_a_line_hold_every_zero_and_the_signs_around_them_differ() {
    let mut r = Random(4);
    let (mut found, mut tight) = (0, 0);
    for round in 0..30_000 {
        let x = if round % 8 == 0 { form(&mut r, true) } else { along_s(&mut r, 1.0, 0.3, 0.05) };
        let [_, a, b] = r.symbols::<3>();
        // The place is known up to a little.
        let wide = |at: f64, d: f64| Interval::new(at - d, at + d).intersection(Interval::new(-1.0, 1.0));
        let d = [0.0, 1e-12, 1e-3][round % 3];
        let Some(zero) = x.zero_along(wide(a, d), wide(b, d)) else { continue };
        found += 1;
        let sign = |s: f64, w: f64| {
            let value = member(&x, &[s, a, b], w);
            if value.is_zero() {
                0
            } else if value > exact(0.0) {
                1
            } else {
                -1
            }
        };
        let behind = if zero.rises { 1 } else { -1 };
        let (lo, hi) = (zero.at.lo(), zero.at.hi());
        assert!(-1.0 < lo && hi < 1.0, "{zero:?}");
        for w in [-1.0, 1.0, r.symbol()] {
            for k in 0..4 {
                let u = f64::from(k) / 4.0;
                let (before, after) = (-1.0 + u * (lo + 1.0), hi + (1.0 - u) * (1.0 - hi));
                assert!(before >= lo || sign(before, w) == -behind, "{x:?} at {before}, {a}, {b}: {zero:?}");
                assert!(after <= hi || sign(after, w) == behind, "{x:?} at {after}, {a}, {b}: {zero:?}");
            }
            let (below, above) = (lo.next_down(), hi.next_up());
            assert!(sign(below, w) == -behind && sign(above, w) == behind, "{x:?} at {a}, {b}: {zero:?}");
        }
        // As wide as the error makes it, and hardly more.
        let least = x.linear()[0].abs() - 2.0 * x.quadratic()[0].abs() - 0.1;
        tight += u32::from(d == 0.0 && least > 0.1 && zero.at.width() <= 2.0 * x.error() / least * 1.01 + 1e-12);
    }
    assert!(found > 5000 && tight > 1000, "{found} {tight}");
}

#[test]
fn a_zero_is_not_claimed_where_the_function_may_not_change_its_sign() {
    let line = |c: f64, l: f64, h: f64, e: f64| {
        Quadratic::polynomial(c, [l, 0.0, 0.0], [h, 0.0, 0.0, 0.0, 0.0, 0.0], e)
            .zero_along(Interval::ZERO, Interval::ZERO)
    };
    assert!(line(0.0, 1.0, 0.0, 0.5).is_some());
    assert!(line(0.0, 1.0, 0.0, 1.0).is_none(), "0 at an end");
    assert!(line(1.0, 1.0, 0.0, 0.0).is_none(), "0 at an end");
    assert!(line(2.0, 1.0, 0.0, 0.0).is_none(), "0 nowhere");
    assert!(line(0.0, 1.0, 0.6, 0.0).is_none(), "not monotone");
    assert!(line(0.0, 0.0, 0.0, 0.0).is_none() && line(f64::NAN, 1.0, 0.0, 0.0).is_none());
    assert!(Quadratic::UNKNOWN.zero_along(Interval::ZERO, Interval::ZERO).is_none());
    let x = Quadratic::from(Affine::<3>::symbol(0));
    for nowhere in [Interval::EMPTY, Interval::ENTIRE, Interval::point(2.0)] {
        assert!(x.zero_along(nowhere, Interval::ZERO).is_none(), "{nowhere:?}");
    }
}

#[test]
fn around_a_turn_the_function_has_one_sign() {
    let mut r = Random(5);
    let (mut cut, mut nowhere) = (0, 0);
    for round in 0..30_000 {
        let x = if round % 8 == 0 { form(&mut r, true) } else { along_s(&mut r, 0.4, 1.0, 0.03) };
        let Some(turn) = x.turn() else { continue };
        cut += u32::from(turn.zeros.width() < 1.0);
        nowhere += u32::from(turn.zeros.is_empty());
        for _ in 0..8 {
            let p = r.symbols::<3>();
            if turn.zeros.contains(p[0]) {
                continue;
            }
            let value = member(&x, &p, r.symbol());
            let zero = exact(0.0);
            let holds = if turn.positive { value > zero } else { value < zero };
            assert!(holds, "{x:?} at {p:?}: {turn:?}");
        }
    }
    assert!(cut > 5000 && nowhere > 100, "{cut} {nowhere}");
    assert!(Quadratic::UNKNOWN.turn().is_none() && Quadratic::from(Affine::<3>::symbol(0)).turn().is_none());
    // (s - 1/2)^2 + a/100, which is 0 up to 1/10 from there.
    let x = Quadratic::polynomial(0.25, [-1.0, 0.01, 0.0], [1.0, 0.0, 0.0, 0.0, 0.0, 0.0], 0.0);
    let zeros = x.turn().unwrap().zeros;
    assert!(
        zeros.lo() <= 0.4 && zeros.lo() > 0.4 - 1e-12 && zeros.hi() >= 0.6 && zeros.hi() < 0.6 + 1e-12,
        "{zeros:?}"
    );
}

#[test]
fn what_is_too_large_is_unknown() {
    for bad in [f64::NAN, f64::INFINITY, 1e302] {
        assert!(!Quadratic::polynomial(bad, [0.0; 3], [0.0; 6], 0.0).is_known());
        assert!(!Quadratic::polynomial(0.0, [0.0; 3], [0.0, 0.0, bad, 0.0, 0.0, 0.0], 0.0).is_known());
        assert!(!Quadratic::polynomial(0.0, [0.0; 3], [0.0; 6], bad).is_known());
    }
    let large = Quadratic::polynomial(1e200, [1e200; 3], [0.0; 6], 0.0);
    assert!(large.is_known() && !(large * large).is_known() && !large.sqr().is_known());
    assert!(!(Quadratic::UNKNOWN + Quadratic::ZERO).is_known() && !(Quadratic::UNKNOWN * Quadratic::ZERO).is_known());
    assert_eq!(Quadratic::UNKNOWN.range(), Interval::ENTIRE);
    assert_eq!(Quadratic::constant(Interval::point(3.0)).range(), Interval::point(3.0));
    assert!(!Quadratic::from(Affine::UNKNOWN).is_known() && !Quadratic::UNKNOWN.to_affine().is_known());
    assert!(
        !Quadratic::from(Affine::symbol(0)).recip().is_known() && !Quadratic::from(Affine::symbol(0)).ln().is_known()
    );
}
