//! Elementary functions against correctly rounded values: at sampled points for containment, at the ends for tightness.
#![allow(clippy::disallowed_methods, reason = "no NaN and no sign of zero is at stake among finite test values")]
mod nasty;

use std::f64::consts::TAU;

use antumbra_interval::Interval;
use dashu_ratio::Relaxed;
use nasty::{Generator, excess, nudge};

const CASES: usize = 20_000;

/// Whether `x` is a member, or one step from one: `value` is rounded, the real value is within half a step of it.
fn holds(x: Interval, value: f64) -> bool {
    x.lo() <= value.next_up() && value.next_down() <= x.hi() && !x.is_empty()
}

/// An enclosure must hold the interval between the correctly rounded extremes, and be at most one step wider.
fn assert_close(what: &str, got: Interval, least: f64, most: f64) {
    // The rounded extremes may lie half a step outside the real range, but the enclosure steps over them.
    let tight = Interval::new(least.min(f64::MAX), most.max(f64::MIN));
    let steps = excess(got, tight);
    assert!(steps.is_some_and(|steps| steps <= 1), "{what}: {got}, rounded extremes {tight}: {steps:?} steps");
}

type Function = (&'static str, fn(Interval) -> Interval, fn(f64) -> f64, f64, f64);

#[test]
fn monotone_functions() {
    let increasing: [Function; 7] = [
        ("exp", Interval::exp, core_math::exp, f64::MIN, f64::MAX),
        ("ln", Interval::ln, core_math::log, f64::from_bits(1), f64::MAX),
        ("cbrt", Interval::cbrt, core_math::cbrt, f64::MIN, f64::MAX),
        ("asin", Interval::asin, core_math::asin, -1.0, 1.0),
        ("atan", Interval::atan, core_math::atan, f64::MIN, f64::MAX),
        ("sinh", Interval::sinh, core_math::sinh, f64::MIN, f64::MAX),
        ("tanh", Interval::tanh, core_math::tanh, f64::MIN, f64::MAX),
    ];
    let mut generator = Generator(10);
    for (name, enclose, value, least, most) in increasing {
        for i in 0..CASES {
            let centre = if i % 2 == 0 { generator.number() } else { generator.moderate() };
            let a = generator.around(if name == "asin" { centre % 1.0 } else { centre });
            let got = enclose(a);
            let inside = a.intersection(Interval::new(least, most));
            if inside.is_empty() {
                // ln alone has a limit at the edge of its domain.
                assert!(got.is_empty(), "{name}({a}) = {got}");
                continue;
            }
            let member = generator.member(inside);
            assert!(got.contains(value(member)) || !value(member).is_finite(), "{name}({a}) = {got} at {member:e}");
            if name == "ln" && a.lo() <= 0.0 {
                assert_eq!(got.lo(), f64::NEG_INFINITY);
            } else {
                assert_close(&format!("{name}({a})"), got, value(inside.lo()), value(inside.hi()));
            }
        }
    }
}

#[test]
fn acos_and_cosh() {
    let mut generator = Generator(11);
    for _ in 0..CASES {
        let centre = generator.moderate();
        let a = generator.around(centre);
        let inside = a.intersection(Interval::new(-1.0, 1.0));
        let got = a.acos();
        assert_eq!(got.is_empty(), inside.is_empty());
        if !inside.is_empty() {
            let (lo, hi) = (core_math::acos(inside.hi()), core_math::acos(inside.lo()));
            assert_close(&format!("acos({a})"), got, lo, hi);
            assert!(holds(got, core_math::acos(generator.member(inside))));
        }
        let (near, far) = (core_math::cosh(a.mignitude()), core_math::cosh(a.magnitude()));
        assert_close(&format!("cosh({a})"), a.cosh(), near, far);
        assert!(a.cosh().lo() >= 1.0);
    }
}

#[test]
fn exact_values_and_unbounded_operands() {
    let zero = Interval::ZERO;
    let one = Interval::ONE;
    for (got, expected) in [
        (zero.exp(), one),
        (one.ln(), zero),
        (zero.sin(), zero),
        (zero.cos(), one),
        (zero.tan(), zero),
        (zero.asin(), zero),
        (one.acos(), zero),
        (zero.atan(), zero),
        (zero.sinh(), zero),
        (zero.cosh(), one),
        (zero.tanh(), zero),
        (zero.cbrt(), zero),
        (one.cbrt(), one),
        ((-one).cbrt(), -one),
        (zero.sqrt(), zero),
        (zero.atan2(one), zero),
        (one.pow(Interval::ENTIRE), one),
        (Interval::new(2.0, 9.0).pow(zero), one),
        (Interval::ENTIRE.exp(), Interval::new(0.0, f64::INFINITY)),
        (Interval::ENTIRE.cosh(), Interval::new(1.0, f64::INFINITY)),
        (Interval::ENTIRE.sin(), Interval::new(-1.0, 1.0)),
        (Interval::ENTIRE.tan(), Interval::ENTIRE),
        (Interval::new(-1.0, 0.0).ln(), Interval::EMPTY),
        (Interval::new(2.0, 3.0).asin(), Interval::EMPTY),
        (zero.atan2(zero), Interval::EMPTY),
        (zero.pow(zero), Interval::EMPTY),
        (Interval::new(-2.0, -1.0).sqrt(), Interval::EMPTY),
        (Interval::new(800.0, 900.0).exp(), Interval::new(f64::MAX, f64::INFINITY)),
        (Interval::new(-900.0, -800.0).exp(), Interval::new(0.0, f64::from_bits(1))),
        (Interval::new(-1.5, 2.5).floor(), Interval::new(-2.0, 2.0)),
        (Interval::new(-1.5, 2.5).ceil(), Interval::new(-1.0, 3.0)),
        (Interval::new(-0.0, 2.5).sign(), Interval::new(0.0, 1.0)),
        (Interval::ENTIRE.floor(), Interval::ENTIRE),
        (Interval::ENTIRE.sign(), Interval::new(-1.0, 1.0)),
    ] {
        assert_eq!(got, expected);
    }
    let unary: [fn(Interval) -> Interval; 21] = [
        Interval::exp,
        Interval::ln,
        Interval::cbrt,
        Interval::asin,
        Interval::acos,
        Interval::atan,
        Interval::sinh,
        Interval::cosh,
        Interval::tanh,
        Interval::sin,
        Interval::cos,
        Interval::tan,
        Interval::sqrt,
        Interval::sqr,
        Interval::abs,
        Interval::floor,
        Interval::ceil,
        Interval::sign,
        Interval::recip,
        |x| x.powi(-3),
        |x| x.powi(0),
    ];
    for function in unary {
        assert_eq!(function(Interval::EMPTY), Interval::EMPTY);
        assert!(!function(Interval::ENTIRE).is_empty());
    }
}

#[test]
fn real_powers() {
    let mut generator = Generator(12);
    for _ in 0..CASES {
        let (x, y) = (generator.moderate().abs(), generator.moderate());
        let base = generator.around(x).intersection(Interval::new(0.0, f64::INFINITY));
        let exponent = generator.around(y);
        let got = base.pow(exponent);
        if base.is_empty() || base.hi() == 0.0 {
            assert!(got.is_empty() || got == Interval::ZERO);
            continue;
        }
        // All four corners, and no thought about which: the extremes are there, limits included.
        let mut corners = Vec::new();
        for x in [base.lo() + 0.0, base.hi()] {
            for y in [exponent.lo(), exponent.hi()] {
                corners.push(core_math::pow(x, y));
            }
        }
        let least = corners.iter().copied().fold(f64::INFINITY, f64::min);
        let most = corners.iter().copied().fold(0.0, f64::max);
        assert_close(&format!("{base}^{exponent}"), got, least, most);
        let (x, y) = (generator.member(base), generator.member(exponent));
        if x > 0.0 {
            assert!(holds(got, core_math::pow(x, y)), "{base}^{exponent} = {got} at {x:e}, {y:e}");
        }
    }
}

#[test]
fn angles() {
    let mut generator = Generator(13);
    for i in 0..CASES {
        let (y, x) = if i % 2 == 0 {
            (generator.any(), generator.any())
        } else {
            let (y, x) = (generator.moderate(), generator.moderate());
            (generator.around(y), generator.around(x))
        };
        let got = y.atan2(x);
        if y.is_empty() || x.is_empty() || (y == Interval::ZERO && x == Interval::ZERO) {
            assert!(got.is_empty());
            continue;
        }
        for _ in 0..4 {
            let (v, u) = (generator.member(y) + 0.0, generator.member(x) + 0.0);
            if v != 0.0 || u != 0.0 {
                let angle = core_math::atan2(v, u);
                assert!(got.contains(angle), "atan2({y}, {x}) = {got} at {v:e}, {u:e}");
            }
        }
        let cut = y.lo() < 0.0 && y.hi() >= 0.0 && x.lo() < 0.0;
        if cut {
            assert_eq!(got, Interval::new(-Interval::PI.hi(), Interval::PI.hi()));
        } else if y.is_bounded() && x.is_bounded() && !(y.contains(0.0) && x.contains(0.0)) {
            // Off the origin and the cut the angle is extreme at corners.
            let mut corners = Vec::new();
            for v in [y.lo() + 0.0, y.hi() + 0.0] {
                for u in [x.lo(), x.hi()] {
                    corners.push(core_math::atan2(v, u));
                }
            }
            let least = corners.iter().copied().fold(f64::INFINITY, f64::min);
            let most = corners.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            assert_close(&format!("atan2({y}, {x})"), got, least, most);
        }
    }
}

/// pi / 2 to 70 decimals, as a lower and an upper rational: an oracle of its own for the range reduction.
fn half_pi() -> (Relaxed, Relaxed) {
    let digits = "15707963267948966192313216916397514420985846996875529104874722961539082";
    let mut lo = Relaxed::ZERO;
    let ten = Relaxed::from(10_u8);
    for digit in digits.bytes() {
        lo = lo * ten.clone() + Relaxed::from(digit - b'0');
    }
    let scale = ten.pow(digits.len() as isize - 1);
    ((lo.clone() / scale.clone()), (lo + Relaxed::ONE) / scale)
}

/// Indices k of all multiples k pi/2 inside [lo, hi], `|lo|, |hi| < 2^60`, at most the first eight.
fn multiples_inside(lo: f64, hi: f64, half_pi: &(Relaxed, Relaxed)) -> Vec<i64> {
    let exact = |x: f64| Relaxed::try_from(x).expect("a finite number");
    let mut k = (lo / std::f64::consts::FRAC_PI_2) as i64;
    k -= 2 + (k.abs() >> 50);
    let multiple = |k: i64| {
        let (a, b) = (half_pi.0.clone() * Relaxed::from(k), half_pi.1.clone() * Relaxed::from(k));
        // The 70 digits decide: between the two bounds there is no float but 0.
        if k >= 0 { (a, b) } else { (b, a) }
    };
    while multiple(k).0 < exact(lo) {
        k += 1;
    }
    let mut found = Vec::new();
    while multiple(k).1 <= exact(hi) && found.len() < 8 {
        found.push(k);
        k += 1;
    }
    found
}

#[test]
fn sine_cosine_tangent() {
    let half_pi = half_pi();
    let mut generator = Generator(14);
    for i in 0..CASES {
        let size = nasty::power_of_two(generator.below(58) as i32);
        let centre = match i % 4 {
            // A float next to a multiple of pi/2.
            0 => nudge((generator.unit() * size).floor() * std::f64::consts::FRAC_PI_2, generator.below(5) as i64 - 2),
            1 => generator.moderate(),
            2 => generator.number() % 1e3,
            _ => generator.unit() * size,
        };
        let centre = if generator.below(2) == 0 { centre } else { -centre };
        let width = [0.0, 1e-300, 1e-9, 0.5, 1.6, 3.0, 3.2, 4.7, 6.2, TAU, 6.3, 20.0][generator.below(12) as usize];
        let a = Interval::new(centre, nudge(centre + width, generator.below(4) as i64).max(centre));
        let inside = multiples_inside(a.lo(), a.hi(), &half_pi);
        let includes = |r: i64| inside.iter().any(|k| k.rem_euclid(4) == r);
        let (s, t) = (core_math::sin(a.lo()), core_math::sin(a.hi()));
        let (c, d) = (core_math::cos(a.lo()), core_math::cos(a.hi()));
        let range = |p: f64, q: f64, top: i64, bottom: i64| {
            (if includes(bottom) { -1.0 } else { p.min(q) }, if includes(top) { 1.0 } else { p.max(q) })
        };
        let ((s_lo, s_hi), (c_lo, c_hi)) = (range(s, t, 1, 3), range(c, d, 0, 2));
        // Between a full turn and TAU rounded, the wider answer is allowed.
        if !(TAU - 1e-9..TAU + 1e-9).contains(&a.width()) {
            assert_close(&format!("sin({a})"), a.sin(), s_lo, s_hi);
            assert_close(&format!("cos({a})"), a.cos(), c_lo, c_hi);
        }
        assert!(Interval::new(s_lo, s_hi).is_subset_of(a.sin()) && Interval::new(c_lo, c_hi).is_subset_of(a.cos()));
        if includes(1) || includes(3) {
            assert_eq!(a.tan(), Interval::ENTIRE, "tan({a})");
        } else {
            assert_close(&format!("tan({a})"), a.tan(), core_math::tan(a.lo()), core_math::tan(a.hi()));
        }
        let x = generator.member(a);
        assert!(holds(a.sin(), core_math::sin(x)) && holds(a.cos(), core_math::cos(x)));
        assert!(holds(a.tan(), core_math::tan(x)));
    }
}

#[test]
fn sine_of_huge_arguments() {
    let mut generator = Generator(15);
    for _ in 0..CASES {
        let x = generator.unit() * nasty::power_of_two(generator.below(1000) as i32);
        let a = Interval::new(x, nudge(x, generator.below(4) as i64));
        let mut v = a.lo();
        while v <= a.hi() {
            assert!(a.sin().contains(core_math::sin(v)) && a.cos().contains(core_math::cos(v)));
            assert!(a.tan().contains(core_math::tan(v)));
            v = v.next_up();
        }
    }
    // A point stays a point however large: the bounds are the neighbours of the value.
    let far = Interval::point(1e300);
    assert_close("sin(1e300)", far.sin(), core_math::sin(1e300), core_math::sin(1e300));
}

/// The checks of this file must be able to fail.
#[test]
fn too_wide_and_too_narrow_are_noticed() {
    let got = Interval::point(0.7).sin();
    let value = core_math::sin(0.7);
    assert_eq!(excess(got, Interval::point(value)), Some(1));
    assert_eq!(excess(Interval::new(nudge(got.lo(), -1), got.hi()), Interval::point(value)), Some(2));
    assert_eq!(excess(Interval::new(nudge(value, 1), nudge(value, 2)), Interval::point(value)), None);
}
