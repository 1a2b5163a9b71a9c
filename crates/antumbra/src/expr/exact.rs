//! Exact arithmetic on rational constants, with a cap on their size: `None` means "not a rational, undefined, or too large to
//! be worth it"; the operation then stays in the graph and is enclosed when the formula is compiled.
use super::{Binary, Unary};
use num_bigint::{BigInt, Sign};
use num_rational::BigRational;
use num_traits::{One, Pow, Signed, ToPrimitive, Zero};

/// Most bits of a numerator or denominator, of operands and results: reducing a fraction takes time quadratic in its bits, and a
/// text of the largest size has 10^5 constants. Operations that need no reduction are free of it.
const MAX_BITS: u64 = 512;

/// How much dearer an operation with that exact result is than one of the graph's other steps: about one step's time for every
/// 160 products of bits, as measured.
pub(crate) fn cost(q: &BigRational) -> usize {
    let bits = q.numer().bits().max(q.denom().bits()) as usize;
    bits * bits / 160
}

/// Whether both parts have at most 64 bits: cheap to compute with, however often.
pub(crate) fn is_short(q: &BigRational) -> bool {
    q.numer().bits() <= 64 && q.denom().bits() <= 64
}

fn is_small(q: &BigRational) -> bool {
    q.numer().bits() <= MAX_BITS && q.denom().bits() <= MAX_BITS
}

fn capped(q: BigRational) -> Option<BigRational> {
    is_small(&q).then_some(q)
}

/// `op(a)` if it is rational by one of the identities below.
pub(crate) fn unary(op: Unary, a: &BigRational) -> Option<BigRational> {
    let zero = a.is_zero();
    match op {
        Unary::Neg => Some(-a),
        Unary::Abs => Some(a.abs()),
        Unary::Sign => Some(a.signum()),
        Unary::Floor => Some(a.floor()),
        Unary::Sqr if is_small(a) => capped(a * a),
        Unary::Sqr => None,
        Unary::Sqrt => root(a, 2),
        Unary::Cbrt => root(a, 3),
        Unary::Exp | Unary::Cos | Unary::Cosh => zero.then(BigRational::one),
        Unary::Sin | Unary::Tan | Unary::Asin | Unary::Atan | Unary::Sinh | Unary::Tanh => zero.then(BigRational::zero),
        Unary::Ln | Unary::Acos => a.is_one().then(BigRational::zero),
    }
}

/// The square or cube root of a lowest-terms fraction is rational only if both parts are perfect powers; `None` otherwise, and
/// for the square root of a negative number.
fn root(a: &BigRational, n: u32) -> Option<BigRational> {
    if (n == 2 && a.is_negative()) || !is_small(a) {
        return None;
    }
    let exact = |v: &BigInt| {
        let r = v.nth_root(n);
        (Pow::pow(&r, n) == *v).then_some(r)
    };
    Some(BigRational::new(exact(a.numer())?, exact(a.denom())?))
}

/// `a^n`, with `0^0 = 1`; undefined for `a = 0, n < 0`.
pub(crate) fn powi(a: &BigRational, n: i32) -> Option<BigRational> {
    if n == 0 {
        return Some(BigRational::one());
    }
    if a.is_zero() {
        return (n > 0).then(BigRational::zero);
    }
    // 1 and -1 have one bit and powers of any exponent; otherwise the size of the result is known beforehand.
    if a.is_integer() && a.numer().magnitude().is_one() {
        let negative = a.numer().sign() == Sign::Minus && n % 2 != 0;
        return Some(if negative { -BigRational::one() } else { BigRational::one() });
    }
    let bits = a.numer().bits().max(a.denom().bits());
    if bits.saturating_sub(1) * u64::from(n.unsigned_abs()) > MAX_BITS {
        return None;
    }
    capped(Pow::pow(a, n))
}

/// `op(a, b)` if it is rational.
pub(crate) fn binary(op: Binary, a: &BigRational, b: &BigRational) -> Option<BigRational> {
    let comparison = matches!(op, Binary::Min | Binary::Max);
    if !comparison && (!is_small(a) || !is_small(b)) {
        return None;
    }
    match op {
        Binary::Add => capped(a + b),
        Binary::Sub => capped(a - b),
        Binary::Mul => capped(a * b),
        Binary::Div => (!b.is_zero()).then(|| a / b).and_then(capped),
        Binary::Min => Some(a.min(b).clone()),
        Binary::Max => Some(a.max(b).clone()),
        // exp(b ln a): for a > 0 and integer b that is the integer power; 0^b = 0 for b > 0.
        Binary::Pow if a.is_positive() => integer(b).and_then(|n| powi(a, n)),
        Binary::Pow => (a.is_zero() && b.is_positive()).then(BigRational::zero),
        Binary::Atan2 => (a.is_zero() && b.is_positive()).then(BigRational::zero),
    }
}

/// The value as an `i32`, if it is one.
pub(crate) fn integer(q: &BigRational) -> Option<i32> {
    if q.is_integer() { q.numer().to_i32() } else { None }
}

/// Whether the value is `p / 2^k` with few enough bits to be an `f64` of moderate size: arithmetic with it rounds nothing away.
pub(crate) fn is_short_dyadic(q: &BigRational) -> bool {
    let denominator = q.denom().magnitude();
    q.numer().bits() <= 53 && denominator.bits() <= 512 && denominator.trailing_zeros() == Some(denominator.bits() - 1)
}
