//! The batched kernels against the scalar operators, lane by lane, on every level that this machine has.
#![allow(clippy::disallowed_methods, reason = "no NaN and no sign of zero is at stake among finite test values")]
mod nasty;

use std::io::Write;

use antumbra_interval::Interval;
use antumbra_interval::lanes::{self, Lanes, LanesMut, Level};
use dashu_ratio::Relaxed;
use nasty::Generator;

type Unary = (&'static str, fn(Level, Lanes<'_>, LanesMut<'_>), fn(Interval) -> Interval);
type Binary = (&'static str, fn(Level, Lanes<'_>, Lanes<'_>, LanesMut<'_>), fn(Interval, Interval) -> Interval);

const UNARY: [Unary; 4] = [
    ("neg", lanes::neg, |a| -a),
    ("abs", lanes::abs, Interval::abs),
    ("sqr", lanes::sqr, Interval::sqr),
    ("sqrt", lanes::sqrt, Interval::sqrt),
];
const BINARY: [Binary; 6] = [
    ("add", lanes::add, |a, b| a + b),
    ("sub", lanes::sub, |a, b| a - b),
    ("mul", lanes::mul, |a, b| a * b),
    ("div", lanes::div, |a, b| a / b),
    ("min", lanes::min, Interval::min),
    ("max", lanes::max, Interval::max),
];

fn mul_add(level: Level, a: &[Interval], b: &[Interval], c: &[Interval]) -> Batch {
    let mut out = Batch::blank(a.len());
    lanes::mul_add(level, Batch::of(a).lanes(), Batch::of(b).lanes(), Batch::of(c).lanes(), out.lanes_mut());
    out
}

/// Triples: the pairs with a third interval each, one in three of which cancels the product.
fn triples(generated: usize) -> [Vec<Interval>; 3] {
    let (a, b) = pairs(generated);
    let mut generator = Generator(22);
    let third = |i: usize, generator: &mut Generator| {
        let product = -(a[i] * b[i]);
        if generator.below(3) == 0 && !product.is_empty() { product } else { generator.any() }
    };
    let c = (0..a.len()).map(|i| third(i, &mut generator)).collect();
    [a, b, c]
}

#[test]
fn portable_fused_lanes_are_the_scalar_operator() {
    let [a, b, c] = triples(50_000);
    let out = mul_add(Level::Portable, &a, &b, &c);
    for i in 0..a.len() {
        assert_eq!(out.interval(i), a[i].mul_add(b[i], c[i]), "{} {} {}", a[i], b[i], c[i]);
    }
}

/// As for the other kernels: inside the portable bounds by at most a step, tightest among finite operands, any length, NaN.
#[test]
fn directed_fused_lanes() {
    let Some(level) = directed() else { return };
    let [a, b, c] = triples(100_000);
    let out = mul_add(level, &a, &b, &c);
    let exact = |x: f64| Relaxed::try_from(x).expect("a finite number");
    for i in 0..a.len() {
        let (got, scalar) = (out.interval(i), a[i].mul_add(b[i], c[i]));
        let text = format!("{} {} {}: {got} against {scalar}", a[i], b[i], c[i]);
        assert!(nasty::excess(scalar, got).is_some_and(|steps| steps <= 1), "{text}");
        if ![a[i], b[i], c[i]].iter().all(|x| x.is_bounded()) {
            continue;
        }
        let corners = [(a[i].lo(), b[i].lo()), (a[i].lo(), b[i].hi()), (a[i].hi(), b[i].lo()), (a[i].hi(), b[i].hi())];
        let products = corners.map(|(x, y)| exact(x) * exact(y));
        let least = products.iter().min().expect("corners").clone() + exact(c[i].lo());
        let most = products.iter().max().expect("corners").clone() + exact(c[i].hi());
        let lower = (got.lo() == f64::NEG_INFINITY && least < exact(f64::MIN))
            || (got.lo().is_finite()
                && exact(got.lo()) <= least
                && (got.lo() == f64::MAX || exact(got.lo().next_up()) > least));
        let upper = (got.hi() == f64::INFINITY && most > exact(f64::MAX))
            || (got.hi().is_finite()
                && exact(got.hi()) >= most
                && (got.hi() == f64::MIN || exact(got.hi().next_down()) < most));
        assert!(lower && upper, "{text}");
    }
    for n in 0..=33 {
        let part = mul_add(level, &a[..n], &b[..n], &c[..n]);
        assert!(part.lo == out.lo[..n] && part.hi == out.hi[..n], "{n} lanes");
    }
}

#[test]
fn a_nan_makes_a_fused_lane_say_nothing() {
    for level in [Some(Level::Portable), directed()].into_iter().flatten() {
        for place in 0..3 {
            let mut operands = [(); 3].map(|()| Batch::of(&[Interval::new(1.0, 2.0); 11]));
            operands[place].lo[4] = f64::NAN;
            let mut out = Batch::blank(11);
            let [a, b, c] = &operands;
            lanes::mul_add(level, a.lanes(), b.lanes(), c.lanes(), out.lanes_mut());
            assert_eq!(out.interval(4), Interval::ENTIRE);
            assert!((0..11).filter(|i| *i != 4).all(|i| out.interval(i).is_bounded()));
        }
    }
}

/// The levels to test besides the portable one.
fn directed() -> Option<Level> {
    let level = Level::all().find(|level| level.is_directed());
    if level.is_none() {
        // Not eprintln: the test harness would swallow it.
        let notice = "\n*** skipped: no AVX-512: the directed-rounding kernels were NOT tested on this machine ***\n";
        std::io::stderr().write_all(notice.as_bytes()).expect("standard error");
    }
    level
}

/// Bounds of intervals as the kernels take them.
struct Batch {
    lo: Vec<f64>,
    hi: Vec<f64>,
}

impl Batch {
    fn of(intervals: &[Interval]) -> Self {
        Self { lo: intervals.iter().map(|x| x.lo()).collect(), hi: intervals.iter().map(|x| x.hi()).collect() }
    }
    /// Results not written would be noticed: `[7, 7]`.
    fn blank(n: usize) -> Self {
        Self { lo: vec![7.0; n], hi: vec![7.0; n] }
    }
    fn lanes(&self) -> Lanes<'_> {
        Lanes::new(&self.lo, &self.hi)
    }
    fn lanes_mut(&mut self) -> LanesMut<'_> {
        LanesMut::new(&mut self.lo, &mut self.hi)
    }
    /// The bounds themselves: unlike `Lanes::get` this hides no invalid lane.
    fn interval(&self, i: usize) -> Interval {
        if self.lo[i] == f64::INFINITY && self.hi[i] == f64::NEG_INFINITY {
            Interval::EMPTY
        } else {
            Interval::new(self.lo[i], self.hi[i])
        }
    }
}

fn unary(level: Level, (_, kernel, _): Unary, a: &[Interval]) -> Batch {
    let mut out = Batch::blank(a.len());
    kernel(level, Batch::of(a).lanes(), out.lanes_mut());
    out
}

fn binary(level: Level, (_, kernel, _): Binary, a: &[Interval], b: &[Interval]) -> Batch {
    let mut out = Batch::blank(a.len());
    kernel(level, Batch::of(a).lanes(), Batch::of(b).lanes(), out.lanes_mut());
    out
}

/// Pairs that meet every case of signs, zeros, infinities and emptiness, then generated ones.
fn pairs(generated: usize) -> (Vec<Interval>, Vec<Interval>) {
    let bounds = [f64::NEG_INFINITY, f64::MIN, -2.5, -f64::MIN_POSITIVE, -f64::from_bits(1), -0.0, 0.0];
    let bounds = bounds.iter().flat_map(|&x| [x, -x]).collect::<Vec<_>>();
    let mut special = vec![Interval::EMPTY];
    for &lo in &bounds {
        special.extend(bounds.iter().filter_map(|&hi| Interval::try_new(lo, hi)));
    }
    let mut a = Vec::new();
    let mut b = Vec::new();
    for &x in &special {
        for &y in &special {
            a.push(x);
            b.push(y);
        }
    }
    let mut generator = Generator(20);
    for _ in 0..generated {
        a.push(generator.any());
        b.push(generator.any());
    }
    (a, b)
}

#[test]
fn portable_is_the_scalar_operator() {
    let (a, b) = pairs(50_000);
    for op in UNARY {
        let out = unary(Level::Portable, op, &a);
        for (i, &a) in a.iter().enumerate() {
            assert_eq!(out.interval(i), op.2(a), "{} {a}", op.0);
        }
    }
    for op in BINARY {
        let out = binary(Level::Portable, op, &a, &b);
        for (i, (&a, &b)) in a.iter().zip(&b).enumerate() {
            assert_eq!(out.interval(i), op.2(a, b), "{} {a} {b}", op.0);
        }
    }
}

/// The tightest bounds are inside the portable ones, and one or two steps from them.
#[test]
fn directed_rounding_is_inside_portable_and_close() {
    let Some(level) = directed() else { return };
    let (a, b) = pairs(200_000);
    let check = |name: &str, got: Interval, scalar: Interval, i: usize| {
        let steps = nasty::excess(scalar, got);
        assert!(steps.is_some_and(|s| s <= 2), "{name} {} {}: {got} against {scalar}", a[i], b[i]);
    };
    for op in UNARY {
        let out = unary(level, op, &a);
        (0..a.len()).for_each(|i| check(op.0, out.interval(i), op.2(a[i]), i));
    }
    for op in BINARY {
        let out = binary(level, op, &a, &b);
        (0..a.len()).for_each(|i| check(op.0, out.interval(i), op.2(a[i], b[i]), i));
    }
}

/// Against exact rational numbers: the bounds are the two nearest floats.
#[test]
fn directed_rounding_is_tightest() {
    let Some(level) = directed() else { return };
    let exact = |x: f64| Relaxed::try_from(x).expect("a finite number");
    let mut generator = Generator(21);
    let (a, b): (Vec<_>, Vec<_>) = (0..40_000).map(|_| (generator.bounded(), generator.bounded())).unzip();
    let tightest = |name: &str, got: Interval, values: &[Relaxed]| {
        let (least, most) = (values.iter().min().expect("values"), values.iter().max().expect("values"));
        let lower = (got.lo() == f64::NEG_INFINITY && *least < exact(f64::MIN))
            || (exact(got.lo()) <= *least
                && (got.lo().next_up() == f64::INFINITY || exact(got.lo().next_up()) > *least));
        let upper = (got.hi() == f64::INFINITY && *most > exact(f64::MAX))
            || (exact(got.hi()) >= *most
                && (got.hi().next_down() == f64::NEG_INFINITY || exact(got.hi().next_down()) < *most));
        assert!(lower && upper, "{name}: {got}");
    };
    let operations: [fn(Relaxed, Relaxed) -> Relaxed; 4] = [|x, y| x + y, |x, y| x - y, |x, y| x * y, |x, y| x / y];
    for (op, exactly) in BINARY.into_iter().zip(operations) {
        let out = binary(level, op, &a, &b);
        for (i, (&a, &b)) in a.iter().zip(&b).enumerate() {
            if op.0 == "div" && b.contains(0.0) {
                continue;
            }
            let corners = [(a.lo(), b.lo()), (a.lo(), b.hi()), (a.hi(), b.lo()), (a.hi(), b.hi())];
            let corners = corners.map(|(x, y)| exactly(exact(x), exact(y)));
            tightest(&format!("{a} {} {b}", op.0), out.interval(i), &corners);
        }
    }
    let squares = unary(level, UNARY[2], &a);
    let roots = unary(level, UNARY[3], &a);
    for (i, a) in a.iter().enumerate() {
        let ends = [a.mignitude(), a.magnitude()].map(|x| exact(x) * exact(x));
        tightest(&format!("{a} squared"), squares.interval(i), &ends);
        let root = roots.interval(i);
        let square = |x: f64| exact(x) * exact(x);
        if !root.is_empty() {
            let (lo, hi) = (exact(a.lo().max(0.0)), exact(a.hi()));
            assert!(square(root.lo()) <= lo && square(root.lo().next_up()) > lo, "root of {a}");
            assert!(square(root.hi()) >= hi && (hi == Relaxed::ZERO || square(root.hi().next_down()) < hi));
        }
    }
}

/// Every length gives the same lanes, and nothing else is written.
#[test]
fn any_length() {
    let (a, b) = pairs(0);
    let levels = [Some(Level::Portable), directed()];
    for level in levels.into_iter().flatten() {
        for op in BINARY {
            let whole = binary(level, op, &a, &b);
            for n in (0..=33).chain([64, 100]) {
                let part = binary(level, op, &a[..n], &b[..n]);
                assert!(part.lo == whole.lo[..n] && part.hi == whole.hi[..n], "{} of {n} lanes", op.0);
            }
        }
        for op in UNARY {
            let whole = unary(level, op, &a);
            for n in 0..=33 {
                let part = unary(level, op, &a[..n]);
                assert!(part.lo == whole.lo[..n] && part.hi == whole.hi[..n], "{} of {n} lanes", op.0);
            }
        }
    }
}

/// A NaN makes its lane say nothing, whichever bound it is, and leaves the neighbours alone.
#[test]
fn nan_lanes_say_nothing() {
    let everything = (f64::NEG_INFINITY, f64::INFINITY);
    let levels = [Some(Level::Portable), directed()];
    for level in levels.into_iter().flatten() {
        for (lo, hi) in [(f64::NAN, 1.0), (1.0, f64::NAN), (f64::NAN, f64::NAN), (-f64::NAN, f64::INFINITY)] {
            for other in [(2.0, 3.0), (0.0, 0.0), (f64::INFINITY, f64::NEG_INFINITY), (f64::NAN, 0.0)] {
                for at in 0..11 {
                    let mut bad = Batch::of(&[Interval::new(1.0, 2.0); 11]);
                    (bad.lo[at], bad.hi[at]) = (lo, hi);
                    let mut good = Batch::of(&[Interval::new(1.0, 2.0); 11]);
                    (good.lo[at], good.hi[at]) = other;
                    for op in BINARY {
                        for (x, y) in [(&bad, &good), (&good, &bad)] {
                            let mut out = Batch::blank(11);
                            op.1(level, x.lanes(), y.lanes(), out.lanes_mut());
                            assert_eq!((out.lo[at], out.hi[at]), everything, "{}", op.0);
                            assert!(out.hi[(at + 1) % 11].is_finite());
                        }
                    }
                    for op in UNARY {
                        let mut out = Batch::blank(11);
                        op.1(level, bad.lanes(), out.lanes_mut());
                        assert_eq!((out.lo[at], out.hi[at]), everything, "{}", op.0);
                    }
                }
            }
        }
    }
    let nan = Batch { lo: vec![f64::NAN], hi: vec![1.0] };
    assert_eq!(nan.lanes().get(0), Interval::ENTIRE);
}

#[test]
fn functions_without_a_kernel() {
    let (a, b) = pairs(100);
    let (a_batch, b_batch) = (Batch::of(&a), Batch::of(&b));
    let mut out = Batch::blank(a.len());
    lanes::map(a_batch.lanes(), out.lanes_mut(), Interval::exp);
    assert!((0..a.len()).all(|i| out.interval(i) == a[i].exp()));
    lanes::map2(a_batch.lanes(), b_batch.lanes(), out.lanes_mut(), Interval::pow);
    assert!((0..a.len()).all(|i| out.interval(i) == a[i].pow(b[i])));
}

#[test]
#[should_panic(expected = "as many results as operands")]
fn lengths_must_agree() {
    let (a, mut out) = (Batch::blank(3), Batch::blank(4));
    lanes::neg(Level::detect(), a.lanes(), out.lanes_mut());
}
