//! Simplification rules. Each keeps the real function and its domain: the two sides are defined at the same points and equal
//! there. Letters: `g`, `h` any formula, `c`, `d` exact rational constants, `m`, `n` integers. "g total" means that `g` is
//! known to be defined everywhere; without it, dropping `g` would enlarge the domain.
//!
//! | before | after | condition, reason |
//! |---|---|---|
//! | `g + 0`, `g - 0`, `1*g`, `g/1`, `g^1` | `g` | |
//! | `0 - g`, `-1*g`, `g/-1` | `-g` | |
//! | `0*g`, `g - g` | `0` | g total |
//! | `0/g` | `0` | g total and never 0 |
//! | `g^0` | `1` | g total |
//! | `-(-g)`; `-(g - h)`; `-(c*g)` | `g`; `h - g`; `(-c)*g` | |
//! | `g + (-h)`, `(-h) + g`; `g - (-h)` | `g - h`; `g + h` | |
//! | `g + c`, `g - c` with `c < 0` | `g - (-c)`, `g + (-c)` | |
//! | `g + g` | `2*g` | |
//! | `(-g)*(-h)`; `(-g)*h`, `g*(-h)` | `g*h`; `-(g*h)` | |
//! | `c*(d*g)`; `c*(-g)`; `g*c` | `(c d)*g`; `(-c)*g`; `c*g` | c, d of at most 64 bits; ; |
//! | `g^m * g^n`, `g*g` | `g^(m+n)` | m, n >= 1 |
//! | `g/c` | `(1/c)*g` | 1/c = p/2^k with p below 2^53: nothing is rounded away |
//! | `(-g)/h`, `g/(-h)` | `-(g/h)` | |
//! | `(g^m)^n` | `g^(m n)` | m >= 1 or n >= 1 (both negative would lose `g != 0`) |
//! | `(-g)^n` | `g^n` or `-(g^n)` | n even or odd |
//! | `\|g\|^n` | `g^n` | n even |
//! | `cbrt(g)^3`, `cbrt(g^3)` | `g` | both total in g |
//! | `sqrt(g^n)` | `\|g^(n/2)\|` | n even, n >= 2 |
//! | `\|-g\|`; `\|g\|` | `\|g\|`; `g` | ; g never negative |
//! | `min(g, g)`, `max(g, g)` | `g` | |
//! | `e^g` (real power) | `exp(g)` | definition of the power of a positive base |
//! | `1^g` (real power) | `1` | g total |
//! | `g^(1/2)` (real power) | `sqrt(g)` | both defined for g >= 0, both 0 at 0 |
//! | `c^n` (real power) | `c^n` (integer power) | c > 0 |
//! | `ln(exp(g))` | `g` | exp is positive everywhere |
//! | `cos(-g)`, `cosh(-g)` | `cos(g)`, `cosh(g)` | even |
//! | `f(-g)` for f = sin, tan, asin, atan, sinh, tanh, cbrt, sign | `-f(g)` | odd, domain symmetric |
//!
//! Not done, because the domain would change: `sqrt(g)^2 -> g`, `exp(ln g) -> g`, `g/g -> 1`, `g^(1/3) -> cbrt(g)`.
use super::{Binary, Graph, Node, NodeId, Unary, exact};
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

/// The simpler form of `op(a)`, if a rule applies.
pub(crate) fn unary(g: &mut Graph, op: Unary, a: NodeId) -> Option<NodeId> {
    let node = g.node(a);
    Some(match (op, node) {
        (Unary::Neg, Node::Unary(Unary::Neg, b)) => b,
        (Unary::Neg, Node::Binary(Binary::Sub, b, c)) => g.binary(Binary::Sub, c, b),
        (Unary::Neg, Node::Binary(Binary::Mul, c, b)) if g.exact(c).is_some() => {
            let c = g.unary(Unary::Neg, c);
            g.binary(Binary::Mul, c, b)
        }
        (Unary::Abs, Node::Unary(Unary::Neg, b)) => g.unary(Unary::Abs, b),
        (Unary::Abs, _) if g.facts(a).nonnegative => a,
        (Unary::Sqr, _) => return powi(g, a, 2),
        (Unary::Sqrt, Node::Unary(Unary::Sqr, b)) => g.unary(Unary::Abs, b),
        (Unary::Sqrt, Node::Powi(b, n)) if n >= 2 && n % 2 == 0 => {
            let half = g.powi(b, n / 2);
            g.unary(Unary::Abs, half)
        }
        (Unary::Cbrt, Node::Powi(b, 3)) => b,
        (Unary::Ln, Node::Unary(Unary::Exp, b)) => b,
        (Unary::Cos | Unary::Cosh, Node::Unary(Unary::Neg, b)) => g.unary(op, b),
        (
            Unary::Sin | Unary::Tan | Unary::Asin | Unary::Atan | Unary::Sinh | Unary::Tanh | Unary::Cbrt | Unary::Sign,
            Node::Unary(Unary::Neg, b),
        ) => {
            let b = g.unary(op, b);
            g.unary(Unary::Neg, b)
        }
        _ => return None,
    })
}

/// The simpler form of the integer power, if a rule applies.
pub(crate) fn powi(g: &mut Graph, a: NodeId, n: i32) -> Option<NodeId> {
    if n == 0 {
        return g.facts(a).total.then(|| g.integer(1));
    }
    if n == 1 {
        return Some(a);
    }
    match g.node(a) {
        Node::Unary(Unary::Neg, b) => {
            let power = g.powi(b, n);
            return Some(if n % 2 == 0 { power } else { g.unary(Unary::Neg, power) });
        }
        Node::Unary(Unary::Abs, b) if n % 2 == 0 => return Some(g.powi(b, n)),
        Node::Unary(Unary::Cbrt, b) if n == 3 => return Some(b),
        _ => {}
    }
    // A square is stored as `Sqr`, so it has to be recognised as a power here.
    let (base, m) = match g.node(a) {
        Node::Unary(Unary::Sqr, b) => (b, 2),
        Node::Powi(b, m) => (b, m),
        _ => (a, 1),
    };
    if m != 1
        && (m >= 1 || n >= 1)
        && let Some(product) = m.checked_mul(n)
    {
        return Some(g.powi(base, product));
    }
    None
}

/// `(g, n)` for a node `g^n` with `n >= 1`.
fn as_power(g: &Graph, a: NodeId) -> (NodeId, i32) {
    match g.node(a) {
        Node::Unary(Unary::Sqr, b) => (b, 2),
        Node::Powi(b, n) if n >= 1 => (b, n),
        _ => (a, 1),
    }
}

fn negated(g: &Graph, a: NodeId) -> Option<NodeId> {
    match g.node(a) {
        Node::Unary(Unary::Neg, b) => Some(b),
        _ => None,
    }
}

/// The simpler form of `op(a, b)`, if a rule applies. Two exact constants with an exact result never get here.
pub(crate) fn binary(g: &mut Graph, op: Binary, a: NodeId, b: NodeId) -> Option<NodeId> {
    match op {
        Binary::Add => add(g, a, b),
        Binary::Sub => subtract(g, a, b),
        Binary::Mul => multiply(g, a, b),
        Binary::Div => divide(g, a, b),
        Binary::Min | Binary::Max => (a == b).then_some(a),
        Binary::Pow => power(g, a, b),
        Binary::Atan2 => None,
    }
}

fn add(g: &mut Graph, a: NodeId, b: NodeId) -> Option<NodeId> {
    for (one, other) in [(a, b), (b, a)] {
        if let Some(q) = g.exact(one) {
            if q.is_zero() {
                return Some(other);
            }
            if q.is_negative() {
                let c = g.unary(Unary::Neg, one);
                return Some(g.binary(Binary::Sub, other, c));
            }
        }
    }
    if a == b {
        let two = g.integer(2);
        return Some(g.binary(Binary::Mul, two, a));
    }
    if let Some(b) = negated(g, b) {
        return Some(g.binary(Binary::Sub, a, b));
    }
    let a = negated(g, a)?;
    Some(g.binary(Binary::Sub, b, a))
}

fn subtract(g: &mut Graph, a: NodeId, b: NodeId) -> Option<NodeId> {
    if let Some(q) = g.exact(b) {
        if q.is_zero() {
            return Some(a);
        }
        if q.is_negative() {
            let c = g.unary(Unary::Neg, b);
            return Some(g.binary(Binary::Add, a, c));
        }
    }
    if g.exact(a).is_some_and(Zero::is_zero) {
        return Some(g.unary(Unary::Neg, b));
    }
    if a == b && g.facts(a).total {
        return Some(g.integer(0));
    }
    let b = negated(g, b)?;
    Some(g.binary(Binary::Add, a, b))
}

fn multiply(g: &mut Graph, a: NodeId, b: NodeId) -> Option<NodeId> {
    match (g.exact(a).cloned(), g.exact(b).is_some()) {
        (None, true) => return Some(g.binary(Binary::Mul, b, a)),
        (Some(c), false) => return scale(g, &c, b),
        _ => {}
    }
    match (negated(g, a), negated(g, b)) {
        (Some(a), Some(b)) => return Some(g.binary(Binary::Mul, a, b)),
        (Some(a), None) => {
            let product = g.binary(Binary::Mul, a, b);
            return Some(g.unary(Unary::Neg, product));
        }
        (None, Some(b)) => {
            let product = g.binary(Binary::Mul, a, b);
            return Some(g.unary(Unary::Neg, product));
        }
        (None, None) => {}
    }
    let ((base, m), (other, n)) = (as_power(g, a), as_power(g, b));
    let sum = m.checked_add(n)?;
    (base == other).then(|| if sum == 2 { square(g, base) } else { g.powi(base, sum) })
}

/// `g^2` in its stored form.
fn square(g: &mut Graph, base: NodeId) -> NodeId {
    g.unary(Unary::Sqr, base)
}

fn scale(g: &mut Graph, c: &BigRational, b: NodeId) -> Option<NodeId> {
    if c.is_zero() {
        return g.facts(b).total.then(|| g.integer(0));
    }
    if c.is_one() {
        return Some(b);
    }
    if (-c).is_one() {
        return Some(g.unary(Unary::Neg, b));
    }
    match g.node(b) {
        Node::Unary(Unary::Neg, b) => {
            let c = g.rational(-c);
            Some(g.binary(Binary::Mul, c, b))
        }
        Node::Binary(Binary::Mul, d, b) => {
            let d = g.exact(d).filter(|d| exact::is_short(d) && exact::is_short(c))?;
            let product = exact::binary(Binary::Mul, c, d)?;
            let c = g.rational(product);
            Some(g.binary(Binary::Mul, c, b))
        }
        _ => None,
    }
}

fn divide(g: &mut Graph, a: NodeId, b: NodeId) -> Option<NodeId> {
    if let Some(c) = g.exact(b) {
        if c.is_one() {
            return Some(a);
        }
        if !c.is_zero() {
            let reciprocal = c.recip();
            if exact::is_short_dyadic(&reciprocal) {
                let c = g.rational(reciprocal);
                return Some(g.binary(Binary::Mul, c, a));
            }
        }
    }
    let facts = g.facts(b);
    if g.exact(a).is_some_and(Zero::is_zero) && facts.total && facts.nonzero {
        return Some(a);
    }
    let (a, b) = match (negated(g, a), negated(g, b)) {
        (Some(a), _) => (a, b),
        (_, Some(b)) => (a, b),
        _ => return None,
    };
    let quotient = g.binary(Binary::Div, a, b);
    Some(g.unary(Unary::Neg, quotient))
}

/// Real powers: `exp(b ln a)` for `a > 0`, 0 for `a = 0 < b`.
fn power(g: &mut Graph, a: NodeId, b: NodeId) -> Option<NodeId> {
    if g.node(a) == Node::E {
        return Some(g.unary(Unary::Exp, b));
    }
    if let Some(q) = g.exact(b) {
        if *q == BigRational::new(1.into(), 2.into()) {
            return Some(g.unary(Unary::Sqrt, a));
        }
        if let Some(n) = exact::integer(q)
            && g.exact(a).is_some_and(Signed::is_positive)
        {
            return Some(g.powi(a, n));
        }
    }
    (g.exact(a).is_some_and(One::is_one) && g.facts(b).total).then_some(a)
}
