//! Kernels in plain Rust: selects instead of branches, so that the compiler can use whatever vectors the target has.
//!
//! The same bounds as [`Interval`]'s operators, which are the specification (a test compares them).
use super::{Lanes, LanesMut};
use crate::Interval;
use crate::round::{add_down, add_up, greater, lesser, next_down, next_up};

/// Lower and upper bound.
type Pair = (f64, f64);

const EMPTY: Pair = (Interval::EMPTY.lo, Interval::EMPTY.hi);
const ENTIRE: Pair = (Interval::ENTIRE.lo, Interval::ENTIRE.hi);

/// Whether the lane has members: false for the empty set and for NaN.
#[inline(always)]
fn inhabited(a: Pair) -> bool {
    a.0 <= a.1
}

#[inline(always)]
fn has_nan(a: Pair) -> bool {
    a.0.is_nan() | a.1.is_nan()
}

#[inline(always)]
fn select(condition: bool, yes: Pair, no: Pair) -> Pair {
    (if condition { yes.0 } else { no.0 }, if condition { yes.1 } else { no.1 })
}

macro_rules! unary {
    ($($name:ident = $op:ident)*) => { $(
        pub(super) fn $name(a: Lanes<'_>, out: LanesMut<'_>) {
            let n = out.lo.len();
            let (a_lo, a_hi) = (&a.lo[..n], &a.hi[..n]);
            let (lo, hi) = (&mut out.lo[..n], &mut out.hi[..n]);
            for i in 0..n {
                let a = (a_lo[i], a_hi[i]);
                (lo[i], hi[i]) = select(has_nan(a), ENTIRE, select(inhabited(a), $op(a), EMPTY));
            }
        }
    )* };
}

macro_rules! binary {
    ($($name:ident = $op:ident)*) => { $(
        pub(super) fn $name(a: Lanes<'_>, b: Lanes<'_>, out: LanesMut<'_>) {
            let n = out.lo.len();
            let (a_lo, a_hi, b_lo, b_hi) = (&a.lo[..n], &a.hi[..n], &b.lo[..n], &b.hi[..n]);
            let (lo, hi) = (&mut out.lo[..n], &mut out.hi[..n]);
            for i in 0..n {
                let (a, b) = ((a_lo[i], a_hi[i]), (b_lo[i], b_hi[i]));
                let value = select(inhabited(a) & inhabited(b), $op(a, b), EMPTY);
                (lo[i], hi[i]) = select(has_nan(a) | has_nan(b), ENTIRE, value);
            }
        }
    )* };
}

unary! { neg = negative abs = absolute sqr = square sqrt = root }
binary! { add = sum sub = difference mul = product div = quotient min = minimum max = maximum }

/// Lane by lane: a fused operation has no faster portable form.
pub(super) fn mul_add(a: Lanes<'_>, b: Lanes<'_>, c: Lanes<'_>, out: LanesMut<'_>) {
    for i in 0..out.lo.len() {
        // A NaN bound makes no interval: every number, as `get` says.
        let operands = [(a.lo[i], a.hi[i]), (b.lo[i], b.hi[i]), (c.lo[i], c.hi[i])];
        let value =
            if operands.into_iter().any(has_nan) { Interval::ENTIRE } else { a.get(i).mul_add(b.get(i), c.get(i)) };
        (out.lo[i], out.hi[i]) = (value.lo, value.hi);
    }
}

#[inline(always)]
fn negative(a: Pair) -> Pair {
    (-a.1, -a.0)
}

/// Smallest and largest absolute value.
#[inline(always)]
fn absolute(a: Pair) -> Pair {
    // Of a.lo and -a.hi at most one is positive; both are not where 0 is a member.
    (greater(greater(a.0, -a.1), 0.0), greater(-a.0, a.1))
}

#[inline(always)]
fn square(a: Pair) -> Pair {
    let (near, far) = absolute(a);
    let (lo, hi) = (near * near, far * far);
    // The square is not negative, and 0 only where its root is.
    (greater(next_down(lo), 0.0), if far == 0.0 { 0.0 } else { next_up(hi) })
}

#[inline(always)]
fn root(a: Pair) -> Pair {
    let (lo, hi) = (greater(a.0, 0.0).sqrt(), greater(a.1, 0.0).sqrt());
    let value = (if lo == 0.0 { 0.0 } else { next_down(lo) }, if hi == 0.0 { 0.0 } else { next_up(hi) });
    select(a.1 < 0.0, EMPTY, value)
}

#[inline(always)]
fn sum(a: Pair, b: Pair) -> Pair {
    (add_down(a.0, b.0), add_up(a.1, b.1))
}

#[inline(always)]
fn difference(a: Pair, b: Pair) -> Pair {
    sum(a, negative(b))
}

#[inline(always)]
fn product(a: Pair, b: Pair) -> Pair {
    // 0 * inf = 0. Other NaN come from NaN operands, which the loop replaces.
    let corner = |x: f64, y: f64| {
        let p = x * y;
        if p.is_nan() { 0.0 } else { p }
    };
    let (p, q, r, s) = (corner(a.0, b.0), corner(a.0, b.1), corner(a.1, b.0), corner(a.1, b.1));
    let (least, most) = (lesser(lesser(p, q), lesser(r, s)), greater(greater(p, q), greater(r, s)));
    // Rounding is monotone: the least rounded corner is the rounded least corner. Products that vanished by underflow
    // keep the sign that their factors prove.
    let negative = ((a.0 < 0.0) & (b.1 > 0.0)) | ((a.1 > 0.0) & (b.0 < 0.0));
    let positive = ((a.0 < 0.0) & (b.0 < 0.0)) | ((a.1 > 0.0) & (b.1 > 0.0));
    let (lo, hi) = (next_down(least), next_up(most));
    (if negative { lo } else { greater(lo, 0.0) }, if positive { hi } else { lesser(hi, 0.0) })
}

#[inline(always)]
fn quotient(a: Pair, b: Pair) -> Pair {
    // x / y = (-x) / (-y): from here on b is not negative, unless 0 lies inside it.
    let flip = b.1 <= 0.0;
    let (x, y) = (select(flip, negative(a), a), select(flip, negative(b), b));
    // A zero end of y without its sign, so that x / 0 is the limit from the right.
    let y = (if y.0 == 0.0 { 0.0 } else { y.0 }, y.1);
    let (lo, hi) =
        (next_down(x.0 / if x.0 >= 0.0 { y.1 } else { y.0 }), next_up(x.1 / if x.1 <= 0.0 { y.1 } else { y.0 }));
    let value = (if x.0 >= 0.0 { greater(lo, 0.0) } else { lo }, if x.1 <= 0.0 { lesser(hi, 0.0) } else { hi });
    let value = select(y.0 < 0.0, ENTIRE, value);
    let value = select((a.0 == 0.0) & (a.1 == 0.0), (0.0, 0.0), value);
    select((b.0 == 0.0) & (b.1 == 0.0), EMPTY, value)
}

#[inline(always)]
fn minimum(a: Pair, b: Pair) -> Pair {
    (lesser(a.0, b.0), lesser(a.1, b.1))
}

#[inline(always)]
fn maximum(a: Pair, b: Pair) -> Pair {
    (greater(a.0, b.0), greater(a.1, b.1))
}
