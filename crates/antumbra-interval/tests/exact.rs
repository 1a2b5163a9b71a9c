//! Arithmetic against exact rational numbers: containment always, and no bound more than the stated number of steps out.
#![allow(clippy::disallowed_methods, reason = "no NaN and no sign of zero is at stake among finite test values")]
mod nasty;

use antumbra_interval::{Interval, round};
use dashu_ratio::Relaxed;
use nasty::{Generator, nudge};

const CASES: usize = 40_000;

/// The exact value of a finite float.
fn exact(x: f64) -> Relaxed {
    Relaxed::try_from(x).expect("a finite number")
}

/// Whether `lo` is below `value` and fewer than `steps + 1` floats below the greatest such float.
fn is_lower(lo: f64, value: &Relaxed, steps: i64) -> bool {
    let past = nudge(lo, steps + 1);
    (lo == f64::NEG_INFINITY || exact(lo) <= *value) && (past == f64::INFINITY || exact(past) > *value)
}

fn is_upper(hi: f64, value: &Relaxed, steps: i64) -> bool {
    is_lower(-hi, &-value.clone(), steps)
}

/// One step, but two where the two-term step of `round::next_down` is proved only to that.
fn one_step(value: &Relaxed) -> i64 {
    let size = if *value < Relaxed::ZERO { -value.clone() } else { value.clone() };
    let zone = exact(nasty::power_of_two(-1023))..exact(nasty::power_of_two(-1019));
    if zone.contains(&size) { 2 } else { 1 }
}

fn assert_tight(what: &str, got: Interval, range: &[Relaxed]) {
    let (least, most) = (range.iter().min().expect("values"), range.iter().max().expect("values"));
    assert!(is_lower(got.lo(), least, one_step(least)), "{what} = {got}: lower bound");
    assert!(is_upper(got.hi(), most, one_step(most)), "{what} = {got}: upper bound");
}

fn assert_contains(what: &str, got: Interval, value: &Relaxed) {
    let below = got.lo() == f64::NEG_INFINITY || exact(got.lo()) <= *value;
    let above = got.hi() == f64::INFINITY || exact(got.hi()) >= *value;
    assert!(!got.is_empty() && below && above, "{what} = {got} loses a value");
}

#[test]
fn exact_numbers_are_exact() {
    let tiny = exact(f64::from_bits(1));
    let mut product = tiny;
    for _ in 0..1074 {
        product *= exact(2.0);
    }
    assert_eq!(product, exact(1.0));
}

/// The checks of this file must be able to fail.
#[test]
fn too_wide_and_too_narrow_are_noticed() {
    let third = exact(1.0) / exact(3.0);
    let got = Interval::ONE / Interval::point(3.0);
    assert!(is_lower(got.lo(), &third, 1) && is_upper(got.hi(), &third, 1));
    assert!(!is_lower(nudge(got.lo(), -2), &third, 1) && !is_upper(nudge(got.hi(), 2), &third, 1));
    assert!(!is_lower(nudge(got.lo(), 2), &third, 1) && !is_upper(nudge(got.hi(), -2), &third, 1));
}

#[test]
fn directed_rounding_of_numbers() {
    let mut generator = Generator(1);
    for _ in 0..CASES {
        let (a, b) = (generator.number(), generator.number());
        let bounds = |lo: f64, hi: f64, value: &Relaxed, what: &str| {
            assert!(is_lower(lo, value, one_step(value)), "{what}_down({a:e}, {b:e}) = {lo:e}");
            assert!(is_upper(hi, value, one_step(value)), "{what}_up({a:e}, {b:e}) = {hi:e}");
        };
        bounds(round::add_down(a, b), round::add_up(a, b), &(exact(a) + exact(b)), "add");
        bounds(round::sub_down(a, b), round::sub_up(a, b), &(exact(a) - exact(b)), "sub");
        bounds(round::mul_down(a, b), round::mul_up(a, b), &(exact(a) * exact(b)), "mul");
        if b != 0.0 {
            bounds(round::div_down(a, b), round::div_up(a, b), &(exact(a) / exact(b)), "div");
        }
        let (root_down, root_up) = (round::sqrt_down(a.abs()), round::sqrt_up(a.abs()));
        let square = |x: f64| exact(x) * exact(x);
        assert!(square(root_down) <= square(a.abs().sqrt()) && exact(a.abs()) <= square(root_up));
        assert!(square(nudge(root_down, 2)) > exact(a.abs()) || a == 0.0, "sqrt_down({a:e})");
        assert!(root_up == 0.0 || square(nudge(root_up, -2)) < exact(a.abs()), "sqrt_up({a:e})");
        // The neighbours themselves.
        assert!(round::next_down(a) < a && round::next_down(a) >= nudge(a, -2));
        assert!(round::next_up(a) > a && round::next_up(a) <= nudge(a, 2));
        // No sign is lost.
        assert!(round::mul_down(a.abs(), b.abs()) >= 0.0 && round::mul_up(-a.abs(), b.abs()) <= 0.0);
    }
}

#[test]
fn infinities_and_nan_of_directed_rounding() {
    let infinity = f64::INFINITY;
    assert_eq!(round::add_down(f64::MAX, f64::MAX), f64::MAX);
    assert_eq!(round::add_up(f64::MAX, f64::MAX), infinity);
    assert_eq!(round::mul_up(-f64::MAX, f64::MAX), f64::MIN);
    assert_eq!(round::div_down(1.0, f64::from_bits(1)), f64::MAX);
    assert_eq!(round::next_down(-infinity), -infinity);
    assert_eq!((round::mul_down(0.0, infinity), round::mul_up(-infinity, 0.0)), (0.0, 0.0));
    assert_eq!((round::div_down(-1.0, infinity), round::div_up(1.0, infinity)), (0.0, 0.0));
    let nan = f64::NAN;
    let operations: [fn(f64, f64) -> f64; 8] = [
        round::add_down,
        round::add_up,
        round::sub_down,
        round::sub_up,
        round::mul_down,
        round::mul_up,
        round::div_down,
        round::div_up,
    ];
    for operation in operations {
        for other in [0.0, 1.0, -1.0, infinity, -infinity, nan] {
            assert!(operation(nan, other).is_nan() && operation(other, nan).is_nan());
        }
    }
    assert!(round::div_down(1.0, 0.0).is_nan() && round::div_up(0.0, 0.0).is_nan());
    assert!(round::sqrt_down(-1.0).is_nan() && round::next_up(nan).is_nan());
}

#[test]
fn bounded_operands_are_tight() {
    let mut generator = Generator(2);
    for _ in 0..CASES {
        let (a, b) = (generator.bounded(), generator.bounded());
        let corners = |f: &dyn Fn(Relaxed, Relaxed) -> Relaxed| -> Vec<Relaxed> {
            [(a.lo(), b.lo()), (a.lo(), b.hi()), (a.hi(), b.lo()), (a.hi(), b.hi())]
                .map(|(x, y)| f(exact(x), exact(y)))
                .into()
        };
        let text = |name: &str| format!("{a} {name} {b}");
        assert_tight(&text("+"), a + b, &corners(&|x, y| x + y));
        assert_tight(&text("-"), a - b, &corners(&|x, y| x - y));
        assert_tight(&text("*"), a * b, &corners(&|x, y| x * y));
        assert_tight(&text("point *"), a.mul_point(b.lo()), &[a.lo(), a.hi()].map(|x| exact(x) * exact(b.lo())));
        assert_tight(&text("point +"), a.add_point(b.lo()), &[a.lo(), a.hi()].map(|x| exact(x) + exact(b.lo())));
        if !b.contains(0.0) {
            assert_tight(&text("/"), a / b, &corners(&|x, y| x / y));
            assert_tight(&text("recip"), b.recip(), &[b.lo(), b.hi()].map(|y| exact(1.0) / exact(y)));
        }
        let squares = [a.mignitude(), a.magnitude()].map(|x| exact(x) * exact(x));
        assert_tight(&text("squared"), a.sqr(), &squares);
        // Exact operations.
        assert_eq!(-a, Interval::new(-a.hi(), -a.lo()));
        assert_eq!((a.abs().lo(), a.abs().hi()), (a.mignitude(), a.magnitude()));
        assert_eq!(a.min(b), Interval::new(a.lo().min(b.lo()), a.hi().min(b.hi())));
        assert_eq!(a.max(b), Interval::new(a.lo().max(b.lo()), a.hi().max(b.hi())));
        assert_eq!((a + Interval::ZERO, a * Interval::ZERO), (a, Interval::ZERO));
        // Middle, radius, width.
        let middle = a.mid();
        assert!(a.contains(middle));
        for end in [a.lo(), a.hi()] {
            let distance = if end < middle { exact(middle) - exact(end) } else { exact(end) - exact(middle) };
            assert!(a.radius() == f64::INFINITY || exact(a.radius()) >= distance);
        }
        let width = exact(a.hi()) - exact(a.lo());
        assert!(is_upper(a.width(), &width, one_step(&width)));
    }
}

/// One step, also where the sum cancels; signs of values that underflow are kept.
#[test]
fn fused_products_and_sums() {
    let mut generator = Generator(5);
    for i in 0..CASES {
        let (a, b) = (generator.bounded(), generator.bounded());
        let cancels = (-(a * b)).intersection(Interval::new(f64::MIN, f64::MAX));
        let c = if i % 2 == 0 && !cancels.is_empty() { cancels } else { generator.bounded() };
        let got = a.mul_add(b, c);
        let corners = [(a.lo(), b.lo()), (a.lo(), b.hi()), (a.hi(), b.lo()), (a.hi(), b.hi())];
        let products = corners.map(|(x, y)| exact(x) * exact(y));
        let least = products.iter().min().expect("corners").clone() + exact(c.lo());
        let most = products.iter().max().expect("corners").clone() + exact(c.hi());
        assert!(is_lower(got.lo(), &least, 1) && is_upper(got.hi(), &most, 1), "{a} * {b} + {c} = {got}");
        assert!(least < Relaxed::ZERO || got.lo() >= 0.0, "{a} * {b} + {c} = {got}: a sign is lost");
        assert!(most > Relaxed::ZERO || got.hi() <= 0.0, "{a} * {b} + {c} = {got}: a sign is lost");
    }
    let (inf, nan) = (f64::INFINITY, f64::NAN);
    assert_eq!((round::mul_add_down(0.0, inf, 3.0), round::mul_add_up(-inf, 0.0, 3.0)), (3.0, 3.0));
    assert_eq!(round::mul_add_down(f64::MAX, 2.0, 0.0), f64::MAX);
    for [a, b, c] in [[nan, 0.0, 1.0], [0.0, nan, 1.0], [1.0, 1.0, nan], [inf, 1.0, -inf]] {
        assert!(round::mul_add_down(a, b, c).is_nan() && round::mul_add_up(a, b, c).is_nan());
    }
    assert_eq!(Interval::new(0.0, inf).mul_add(Interval::ENTIRE, Interval::ENTIRE), Interval::ENTIRE);
    assert_eq!(Interval::ENTIRE.mul_add(Interval::ZERO, Interval::ONE), Interval::ONE);
    assert_eq!(Interval::ONE.mul_add(Interval::EMPTY, Interval::ONE), Interval::EMPTY);
}

#[test]
fn any_operands_are_enclosed() {
    let mut generator = Generator(3);
    for _ in 0..CASES {
        let (a, b) = (generator.any(), generator.any());
        if a.is_empty() || b.is_empty() {
            for value in [a + b, a - b, a * b, a / b, a.min(b), a.max(b), a.intersection(b)] {
                assert_eq!(value, Interval::EMPTY);
            }
            assert_eq!(a.hull(b), if a.is_empty() { b } else { a });
            continue;
        }
        let (x, y) = (generator.member(a), generator.member(b));
        let text = |name: &str| format!("{a} {name} {b} at {x:e}, {y:e}");
        assert_contains(&text("+"), a + b, &(exact(x) + exact(y)));
        assert_contains(&text("-"), a - b, &(exact(x) - exact(y)));
        assert_contains(&text("*"), a * b, &(exact(x) * exact(y)));
        assert_contains(&text("squared"), a.sqr(), &(exact(x) * exact(x)));
        assert!((a * b).is_subset_of(Interval::ENTIRE) && a.sqr().certainly_nonnegative());
        if y != 0.0 {
            assert_contains(&text("/"), a / b, &(exact(x) / exact(y)));
        }
        if x >= 0.0 {
            let root = a.sqrt();
            assert!(exact(root.lo()) * exact(root.lo()) <= exact(x), "{}", text("root"));
            assert!(root.hi() == f64::INFINITY || exact(root.hi()) * exact(root.hi()) >= exact(x), "{}", text("root"));
        }
        assert!(a.hull(b).contains(x) && a.hull(b).contains(y));
        assert_eq!(a.intersection(b).contains(x), b.contains(x));
    }
}

#[test]
fn integer_powers() {
    let mut generator = Generator(4);
    let mut widest = 0;
    for _ in 0..CASES / 4 {
        let n = generator.below(25) as i32 - 12;
        let x = generator.moderate();
        let a = generator.around(x);
        let a = a.intersection(Interval::new(-1e12, 1e12));
        if a.is_empty() || n == 0 || (n < 0 && a.contains(0.0)) {
            continue;
        }
        let power = |x: f64| exact(x).pow(n as isize);
        let got = a.powi(n);
        let (near, far) = if n % 2 == 0 { (a.mignitude(), a.magnitude()) } else { (a.lo(), a.hi()) };
        let (near, far) = (power(near), power(far));
        let (least, most) = if near <= far { (near, far) } else { (far, near) };
        let text = format!("{a}^{n}");
        assert_contains(&text, got, &least);
        assert_contains(&text, got, &most);
        let steps = (0..).find(|&s| is_lower(got.lo(), &least, s) && is_upper(got.hi(), &most, s)).expect("a number");
        // |n| - 1 products (and a quotient) move a bound by 1.5 * 2^-52 each: at most 3 of the finest steps.
        let allowed = if n.abs() > 8 { 1 } else { 3 * i64::from(n.abs()) };
        assert!(steps <= allowed, "{text} = {got}: {steps} steps");
        widest = widest.max(steps);
        let inside = generator.member(a);
        assert_contains(&text, got, &power(inside));
    }
    assert!(widest > 1, "the chain's rounding was never seen: is the check alive?");
}
