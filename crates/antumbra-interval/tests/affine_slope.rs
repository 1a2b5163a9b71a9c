//! Slopes and duals: `f(P + t D) = f(P) + t g` on every operator and on random expressions, tightness, convergence.
mod affine_samples;

use affine_samples::{Dyadic, Random, exact, meets, neighbours, plane, power_of_two};
use antumbra_interval::{
    Interval,
    affine::{Affine, Apex, Dual, Slope},
};

/// What an expression needs of a number.
trait Number: Copy {
    fn constant(k: Interval) -> Self;
    fn unary(self, op: Unary) -> Self;
    fn binary(self, o: Self, op: Binary) -> Self;
    fn powi(self, n: i32) -> Self;
    /// `k self + k`.
    fn line(self, k: Interval) -> Self;
}

macro_rules! number {
    ([$($bound:tt)*] $type:ty, $constant:expr, $line:expr) => {
        impl $($bound)* Number for $type {
            fn constant(k: Interval) -> Self {
                let make: fn(Interval) -> Self = $constant;
                make(k)
            }
            fn unary(self, op: Unary) -> Self {
                match op {
                    Unary::Neg => -self,
                    Unary::Abs => self.abs(),
                    Unary::Sign => self.sign(),
                    Unary::Floor => self.floor(),
                    Unary::Sqr => self.sqr(),
                    Unary::Sqrt => self.sqrt(),
                    Unary::Cbrt => self.cbrt(),
                    Unary::Exp => self.exp(),
                    Unary::Ln => self.ln(),
                    Unary::Sin => self.sin(),
                    Unary::Cos => self.cos(),
                    Unary::Tan => self.tan(),
                    Unary::Asin => self.asin(),
                    Unary::Acos => self.acos(),
                    Unary::Atan => self.atan(),
                    Unary::Sinh => self.sinh(),
                    Unary::Cosh => self.cosh(),
                    Unary::Tanh => self.tanh(),
                }
            }
            fn binary(self, o: Self, op: Binary) -> Self {
                match op {
                    Binary::Add => self + o,
                    Binary::Sub => self - o,
                    Binary::Mul => self * o,
                    Binary::Div => self / o,
                    Binary::Min => self.min(o),
                    Binary::Max => self.max(o),
                    Binary::Pow => self.pow(o),
                    Binary::Atan2 => self.atan2(o),
                }
            }
            fn powi(self, n: i32) -> Self {
                self.powi(n)
            }
            fn line(self, k: Interval) -> Self {
                let line: fn(Self, Interval) -> Self = $line;
                line(self, k)
            }
        }
    };
}
number!([] Interval, |k| k, |x, k| x * k + k);
number!([<P: Apex<Affine<N>>, const N: usize>] Slope<P, N>, Slope::constant, |x, k| x.mul_interval(k).add_interval(k));
number!([<const N: usize>] Dual<N>, Dual::constant, |x, k| x.mul_interval(k).add_interval(k));

#[derive(Clone, Copy, Debug)]
enum Unary {
    Neg,
    Abs,
    Sign,
    Floor,
    Sqr,
    Sqrt,
    Cbrt,
    Exp,
    Ln,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
}
const UNARY: [Unary; 18] = {
    use Unary::*;
    [Neg, Abs, Sign, Floor, Sqr, Sqrt, Cbrt, Exp, Ln, Sin, Cos, Tan, Asin, Acos, Atan, Sinh, Cosh, Tanh]
};
#[derive(Clone, Copy, Debug)]
enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    Min,
    Max,
    Pow,
    Atan2,
}
const BINARY: [Binary; 8] = {
    use Binary::*;
    [Add, Sub, Mul, Div, Min, Max, Pow, Atan2]
};

#[derive(Clone, Debug)]
enum Expression {
    Axis(usize),
    Constant(f64),
    Unary(Unary, Box<Expression>),
    Binary(Binary, Box<Expression>, Box<Expression>),
    Powi(i32, Box<Expression>),
    Line(f64, Box<Expression>),
}

impl Expression {
    fn random(r: &mut Random, depth: u32) -> Self {
        let child = |r: &mut Random| Box::new(Self::random(r, depth.saturating_sub(1)));
        match if depth == 0 { r.below(4) } else { 4 + r.below(8) } {
            0 => Self::Constant([0.5, 2.0, 3.0, -1.0, 0.1][r.below(5) as usize]),
            i @ 1..4 => Self::Axis(i as usize - 1),
            4 => Self::Powi(r.below(9) as i32 - 3, child(r)),
            5..8 => Self::Unary(UNARY[r.below(18) as usize], child(r)),
            _ => Self::Binary(BINARY[r.below(8) as usize], child(r), child(r)),
        }
    }

    fn eval<T: Number>(&self, x: &[T; 3]) -> T {
        match self {
            Self::Axis(i) => x[*i],
            Self::Constant(k) => T::constant(Interval::point(*k)),
            Self::Unary(op, a) => a.eval(x).unary(*op),
            Self::Binary(op, a, b) => a.eval(x).binary(b.eval(x), *op),
            Self::Powi(n, a) => a.eval(x).powi(*n),
            Self::Line(k, a) => a.eval(x).line(Interval::point(*k)),
        }
    }
}

/// Every operator once on the axes, then random expressions.
fn expressions(r: &mut Random, random: usize) -> Vec<Expression> {
    let axis = |i| Box::new(Expression::Axis(i));
    let mut all: Vec<_> = UNARY.iter().map(|op| Expression::Unary(*op, axis(0))).collect();
    all.extend(BINARY.iter().map(|op| Expression::Binary(*op, axis(0), axis(1))));
    all.extend([-3, -1, 0, 1, 2, 3, 6].map(|n| Expression::Powi(n, axis(2))));
    all.extend(
        [0.3, 2.5, -1.5, 1.0].map(|y| Expression::Binary(Binary::Pow, axis(1), Box::new(Expression::Constant(y)))),
    );
    all.push(Expression::Line(-0.7, axis(1)));
    all.extend((0..random).map(|_| {
        let depth = 1 + r.below(3) as u32;
        Expression::random(r, depth)
    }));
    all
}

/// A finite, non-empty interval that knows something.
fn known(x: Interval) -> bool {
    !x.is_empty() && x.lo().is_finite() && x.hi().is_finite()
}

fn around(x: &Dyadic) -> Interval {
    let (lo, hi) = neighbours(x);
    Interval::new(lo, hi)
}

/// `P + t D` over a box of symbols: exact forms, their real values at sample points known exactly.
struct Path<const N: usize> {
    apex: [Affine<N>; 3],
    t: Affine<N>,
    direction: [Affine<N>; 3],
}

impl<const N: usize> Path<N> {
    fn random(r: &mut Random, thin_apex: bool) -> Self {
        let scale = power_of_two(-(r.below(12) as i32));
        let small = |r: &mut Random, k: f64| Affine::linear(0.0, std::array::from_fn(|_| k * scale * r.signed()), 0.0);
        let moved = |r: &mut Random, c: f64, k: f64| {
            let x = small(r, k);
            Affine::linear(c, *x.coefficients(), 0.0)
        };
        let centre = |r: &mut Random| if r.below(3) == 0 { r.signed() } else { 1.5 * r.signed().abs() };
        Self {
            apex: std::array::from_fn(|_| {
                let c = centre(r);
                moved(r, c, if thin_apex { 0.0 } else { 0.2 })
            }),
            t: {
                let c = 0.5 * r.signed();
                moved(r, c, 0.3)
            },
            direction: std::array::from_fn(|_| {
                let c = r.signed();
                moved(r, c, 0.2)
            }),
        }
    }
}

/// Returns how often the slope was known.
fn identity<P: Apex<Affine<N>>, const N: usize>(
    seed: u64,
    random: usize,
    apex: fn(Affine<N>) -> P,
    thin: bool,
) -> (usize, usize) {
    let mut r = Random(seed);
    let (mut checked, mut informative) = (0, 0);
    for f in expressions(&mut r, random) {
        for _ in 0..if random == 0 { 60 } else { 6 } {
            let path = Path::<N>::random(&mut r, thin);
            let x: [Slope<P, N>; 3] =
                std::array::from_fn(|i| Slope::coordinate(apex(path.apex[i]), path.t, path.direction[i]));
            let y = f.eval(&x);
            for _ in 0..3 {
                let s = r.symbols::<N>();
                let t = plane(&path.t, &s);
                let start = path.apex.map(|p| plane(&p, &s));
                let end: [_; 3] = std::array::from_fn(|i| &start[i] + &(&t * &plane(&path.direction[i], &s)));
                let p = f.eval(&start.each_ref().map(around));
                let v = f.eval(&end.each_ref().map(around));
                if known(v) {
                    assert!(meets(&y.value, &s, v.lo(), v.hi()), "value of {f:?}: {:?} at {s:?}, true {v:?}", y.value);
                }
                if known(p) {
                    assert!(known(y.apex.range().intersection(p)), "apex of {f:?}");
                }
                let t = around(&t);
                if known(p) && known(v) && !t.possibly_zero() {
                    let g = (v - p) / t;
                    assert!(meets(&y.slope, &s, g.lo(), g.hi()), "slope of {f:?}: {:?} at {s:?}, true {g:?}", y.slope);
                    checked += 1;
                    informative += usize::from(y.slope.is_known());
                }
            }
        }
    }
    (checked, informative)
}

#[test]
fn slope_identity_with_an_affine_apex() {
    let (checked, informative) = identity::<Affine<5>, 5>(1, 0, |p| p, false);
    assert!(checked > 3000 && informative * 3 > checked * 2, "{informative} of {checked}");
    let (checked, informative) = identity::<Affine<5>, 5>(2, 500, |p| p, false);
    assert!(checked > 2000 && informative * 3 > checked, "{informative} of {checked}");
    identity::<Affine<1>, 1>(3, 300, |p| p, false);
}

#[test]
fn slope_identity_with_an_interval_apex() {
    let (checked, informative) = identity::<Interval, 3>(4, 0, |p| p.range(), true);
    assert!(checked > 3000 && informative * 3 > checked * 2, "{informative} of {checked}");
    let (checked, informative) = identity::<Interval, 3>(5, 500, |p| p.range(), true);
    assert!(checked > 2000 && informative * 3 > checked, "{informative} of {checked}");
}

/// The derivative of a dual against a difference quotient: crude, but independent.
#[test]
fn duals_contain_the_derivative() {
    let mut r = Random(6);
    let (mut checked, mut informative) = (0, 0);
    for f in expressions(&mut r, 400) {
        for _ in 0..8 {
            let path = Path::<3>::random(&mut r, false);
            let x: [Dual<3>; 3] = std::array::from_fn(|i| Dual {
                value: path.apex[i] + path.t * path.direction[i],
                derivative: path.direction[i],
            });
            let y = f.eval(&x);
            let s = r.symbols::<3>();
            let at = |h: f64| {
                let t = plane(&path.t, &s) + exact(h);
                let point: [_; 3] =
                    std::array::from_fn(|i| plane(&path.apex[i], &s) + &t * &plane(&path.direction[i], &s));
                f.eval(&point.each_ref().map(around))
            };
            let value = at(0.0);
            if known(value) {
                assert!(meets(&y.value, &s, value.lo(), value.hi()), "value of {f:?}");
            }
            // Both one-sided quotients, at two distances: where they agree f is smooth enough for the comparison.
            let h = 1e-6;
            let q = [-2.0, -1.0, 1.0, 2.0].map(|k| (at(k * h) - value) / Interval::point(k * h));
            if !known(value) || q.iter().any(|q| !known(*q)) {
                continue;
            }
            let all = q.into_iter().reduce(Interval::hull).unwrap();
            let size = 1.0 + all.magnitude();
            if all.width() < 1e-3 * size {
                checked += 1;
                informative += usize::from(y.derivative.is_known());
                let slack = 1e-3 * size;
                let (lo, hi) = (all.lo() - slack, all.hi() + slack);
                assert!(meets(&y.derivative, &s, lo, hi), "derivative of {f:?}: {:?}, true {all:?}", y.derivative);
            }
        }
    }
    assert!(checked > 2000 && informative * 2 > checked, "{informative} of {checked}");
}

/// Halving all widths divides the error of the slope by four, and of the dual too.
#[test]
fn slopes_of_smooth_functions_converge_quadratically() {
    let axis = || Box::new(Expression::Axis(0));
    let mut smooth: Vec<_> = UNARY[4..].iter().map(|op| Expression::Unary(*op, axis())).collect();
    smooth.extend([-2, 5].map(|n| Expression::Powi(n, axis())));
    smooth.push(Expression::Binary(Binary::Pow, axis(), Box::new(Expression::Constant(2.5))));
    smooth.push(Expression::Binary(Binary::Div, axis(), Box::new(Expression::Unary(Unary::Exp, axis()))));
    for f in smooth {
        let error = |w: f64| {
            let apex = Affine::<3>::linear(0.4, [w, 0.0, 0.5 * w], 0.0);
            let t = Affine::linear(w, [0.0, w, 0.0], 0.0);
            let d = Affine::linear(0.7, [0.0, 0.0, w], 0.0);
            let x = Slope::coordinate(apex, t, d);
            let y = Dual { value: x.value, derivative: d };
            (f.eval(&[x; 3]).slope.error(), f.eval(&[y; 3]).derivative.error())
        };
        for k in 6..9 {
            let ((a, b), (c, d)) = (error(power_of_two(-k)), error(power_of_two(-k - 1)));
            for (what, order) in [("slope", core_math::log2(a / c)), ("dual", core_math::log2(b / d))] {
                assert!((1.8..2.3).contains(&order), "{what} of {f:?}: order {order} at width 2^-{k}");
            }
        }
    }
}

/// At a zero the slope keeps its sign however small `t` is, where the value cannot.
#[test]
fn slopes_decide_where_values_cancel() {
    let f = Expression::Binary(
        Binary::Sub,
        Box::new(Expression::Unary(Unary::Exp, Box::new(Expression::Axis(0)))),
        Box::new(Expression::Constant(1.0)),
    );
    for k in 0..300 {
        let w = power_of_two(-k);
        let t = Affine::<1>::spanning(0, Interval::new(0.0, w));
        let x = Slope::coordinate(Interval::ZERO, t, Affine::constant(Interval::ONE));
        let y = f.eval(&[x; 3]);
        assert!(y.slope.range().certainly_positive(), "{y:?}");
        assert!(y.value.range().possibly_zero());
        assert!(y.slope.range().width() <= w + 1e-14, "{y:?}");
    }
}

/// `x` is a part of `[lo, hi]`, up to rounding.
fn within(x: Interval, lo: f64, hi: f64) -> bool {
    x.lo() >= lo - 1e-14 && x.hi() <= hi + 1e-14
}

#[test]
fn kinks_lie_between_both_slopes() {
    let x = Slope::coordinate(Interval::ZERO, Affine::<1>::symbol(0), Affine::constant(Interval::ONE));
    let range = |y: Slope<Interval, 1>| y.slope.range();
    assert!(within(range(x.abs()), -1.0, 1.0));
    let twice = x.mul_f64(2.0);
    assert!(within(range(x.max(twice)), 1.0, 2.0));
    assert!(within(range(x.min(twice)), 1.0, 2.0));
    // Settled: the slope of the branch.
    let far = x + Slope::constant(Interval::point(9.0));
    assert_eq!(range(far.max(x)), range(far));
    assert_eq!(range((-far).abs()), range(far));
    assert_eq!(far.mul_f64(0.01).floor().slope, Affine::ZERO);
    assert_eq!(x.floor().slope, Affine::UNKNOWN);
    assert_eq!(x.sign().slope, Affine::UNKNOWN);
}

/// Poles, domain edges and overflow leave slopes unknown or true, never NaN.
#[test]
fn extreme_paths_prove_nothing_false() {
    let mut r = Random(8);
    for f in expressions(&mut r, 300) {
        for scale in [1e-200, 1e-30, 30.0, 1e80, 1e200] {
            let x: [Slope<Affine<3>, 3>; 3] = std::array::from_fn(|_| {
                let p = Affine::linear(scale * r.signed(), [scale * r.signed(), 0.0, 0.0], 0.0);
                Slope::coordinate(p, Affine::symbol(1), Affine::linear(scale * r.signed(), [0.0, 0.0, scale], 0.0))
            });
            let y = f.eval(&x);
            for g in [y.apex, y.value, y.slope] {
                let fine = g.coefficients().iter().all(|a| a.is_finite()) && g.centre().is_finite() && g.error() >= 0.0;
                assert!(fine, "{f:?}: {g:?}");
            }
        }
    }
}

/// At the apex itself a tie is no choice: the slope holds the limits of both.
#[test]
fn ties_at_the_apex_keep_both_slopes() {
    let zero = |slope: f64| Slope::<Interval, 3> {
        apex: Interval::ZERO,
        value: Affine::ZERO,
        slope: Affine::constant(Interval::point(slope)),
    };
    let (down, up) = (zero(-1.0), zero(1.0));
    for slope in [down.max(up).slope, up.max(down).slope, down.min(up).slope, down.abs().slope, up.abs().slope] {
        let range = slope.range();
        assert!(range.contains(-1.0) && range.contains(1.0), "{range:?}");
    }
}
