//! Symbolic partial derivatives, forward over the graph.
use super::{Axis, Binary, Formula, Graph, Node, NodeId, Unary};
use num_rational::BigRational;
use num_traits::Zero;

/// A partial derivative and where it holds.
///
/// At every point where the formula is defined in a neighbourhood and none of its `abs`, `min`, `max`, `sign`, `floor` is at
/// its kink or step, nor a `sqrt`, `cbrt`, `asin`, `acos` or real power at the end of its domain with an infinite slope, the
/// value is the derivative. At a kink of `abs`, `min`, `max` it is the mean of the one-sided operators' slopes, which is *not* a derivative; at the
/// steps of `sign` and `floor` it is 0. Elsewhere (where the formula is undefined) the value, if there is one, means nothing:
/// `ln(x)` has the derivative `1/x`, which is defined for negative x too.
#[derive(Clone, Debug)]
pub struct Derivative {
    formula: Formula,
    kinks: bool,
}

impl Derivative {
    /// The derivative's formula, simplified.
    #[must_use]
    pub fn formula(&self) -> &Formula {
        &self.formula
    }

    /// Whether the formula depends on the axis through an `abs`, `min`, `max`, `sign` or `floor`, so that the derivative may
    /// fail to exist inside the domain.
    #[must_use]
    pub fn has_kinks(&self) -> bool {
        self.kinks
    }
}

pub(crate) fn derivative(formula: &Formula, axis: Axis) -> Derivative {
    let simple = formula.simplify();
    let mut g = simple.graph().clone().into_simplifying();
    let count = simple.root().index() + 1;
    let zero = g.integer(0);
    let mut slopes = vec![zero; count];
    let mut kinks = false;
    for i in 0..count {
        let id = NodeId(i as u32);
        let node = g.node(id);
        // A function that does not change along the axis has the slope 0 wherever it is defined.
        let flat = node.children().all(|c| slopes[c.index()] == zero);
        if flat && node != Node::Axis(axis) {
            continue;
        }
        let at = |id: NodeId| slopes[id.index()];
        slopes[i] = match node {
            Node::Axis(_) => g.integer(1),
            Node::Rational(_) | Node::Pi | Node::E => zero,
            Node::Unary(op, a) => {
                kinks |= matches!(op, Unary::Abs | Unary::Sign | Unary::Floor);
                unary(&mut g, op, id, a, at(a))
            }
            Node::Powi(a, n) => {
                // (a^n)' = n a^(n-1) a'
                let (factor, power) = (g.integer(n.into()), power_below(&mut g, a, n));
                let outer = mul(&mut g, factor, power);
                mul(&mut g, outer, at(a))
            }
            Node::Binary(op, a, b) => {
                kinks |= matches!(op, Binary::Min | Binary::Max);
                binary(&mut g, op, id, (a, at(a)), (b, at(b)))
            }
        };
    }
    Derivative { formula: Formula::new(g, slopes[count - 1]).compacted(), kinks }
}

fn mul(g: &mut Graph, a: NodeId, b: NodeId) -> NodeId {
    let zero = |id: NodeId, g: &Graph| g.exact(id).is_some_and(Zero::is_zero);
    // A slope that is 0 stays 0 whatever it is multiplied with.
    if zero(a, g) || zero(b, g) { g.integer(0) } else { g.binary(Binary::Mul, a, b) }
}

/// `a^(n-1)`; the least exponent is its own, one more `1/a`.
fn power_below(g: &mut Graph, a: NodeId, n: i32) -> NodeId {
    match n.checked_sub(1) {
        Some(m) => g.powi(a, m),
        None => {
            let power = g.powi(a, n);
            g.binary(Binary::Div, power, a)
        }
    }
}

/// Slope of `value = op(a)` where `a` has the slope `s`.
fn unary(g: &mut Graph, op: Unary, value: NodeId, a: NodeId, s: NodeId) -> NodeId {
    let one = g.integer(1);
    let outer = match op {
        Unary::Neg => return g.unary(Unary::Neg, s),
        Unary::Sign | Unary::Floor => return g.integer(0),
        Unary::Abs => g.unary(Unary::Sign, a),
        Unary::Sqr => {
            let two = g.integer(2);
            mul(g, two, a)
        }
        Unary::Exp => value,
        Unary::Sin => g.unary(Unary::Cos, a),
        Unary::Cos => {
            let sin = g.unary(Unary::Sin, a);
            g.unary(Unary::Neg, sin)
        }
        Unary::Sinh => g.unary(Unary::Cosh, a),
        Unary::Cosh => g.unary(Unary::Sinh, a),
        // 1 + tan^2, 1 - tanh^2
        Unary::Tan | Unary::Tanh => {
            let square = g.unary(Unary::Sqr, value);
            g.binary(if op == Unary::Tan { Binary::Add } else { Binary::Sub }, one, square)
        }
        // The others are s over a divisor.
        Unary::Sqrt => {
            let two = g.integer(2);
            let below = mul(g, two, value);
            return g.binary(Binary::Div, s, below);
        }
        Unary::Cbrt => {
            let (three, square) = (g.integer(3), g.unary(Unary::Sqr, value));
            let below = mul(g, three, square);
            return g.binary(Binary::Div, s, below);
        }
        Unary::Ln => return g.binary(Binary::Div, s, a),
        Unary::Asin | Unary::Acos => {
            let square = g.unary(Unary::Sqr, a);
            let rest = g.binary(Binary::Sub, one, square);
            let below = g.unary(Unary::Sqrt, rest);
            let slope = g.binary(Binary::Div, s, below);
            return if op == Unary::Acos { g.unary(Unary::Neg, slope) } else { slope };
        }
        Unary::Atan => {
            let square = g.unary(Unary::Sqr, a);
            let below = g.binary(Binary::Add, one, square);
            return g.binary(Binary::Div, s, below);
        }
    };
    mul(g, outer, s)
}

/// Slope of `value = op(a, b)` where `a` has the slope `s` and `b` the slope `t`.
fn binary(g: &mut Graph, op: Binary, value: NodeId, (a, s): (NodeId, NodeId), (b, t): (NodeId, NodeId)) -> NodeId {
    match op {
        Binary::Add | Binary::Sub => g.binary(op, s, t),
        Binary::Mul => {
            let (left, right) = (mul(g, s, b), mul(g, a, t));
            g.binary(Binary::Add, left, right)
        }
        Binary::Div => {
            // (s - value t)/b
            let part = mul(g, value, t);
            let above = g.binary(Binary::Sub, s, part);
            g.binary(Binary::Div, above, b)
        }
        Binary::Min | Binary::Max => {
            // max, min (a, b) = (a + b +- |a - b|)/2
            let half = g.rational(BigRational::new(1.into(), 2.into()));
            let difference = g.binary(Binary::Sub, a, b);
            let side = g.unary(Unary::Sign, difference);
            let (sum, gap) = (g.binary(Binary::Add, s, t), g.binary(Binary::Sub, s, t));
            let turned = mul(g, side, gap);
            let twice = g.binary(if op == Binary::Max { Binary::Add } else { Binary::Sub }, sum, turned);
            mul(g, half, twice)
        }
        Binary::Pow => {
            // Constant exponent: b a^(b-1) s. Else a^b (t ln a + b s/a).
            if g.facts(b).constant {
                let one = g.integer(1);
                let below = g.binary(Binary::Sub, b, one);
                let power = g.binary(Binary::Pow, a, below);
                let outer = mul(g, b, power);
                return mul(g, outer, s);
            }
            let (log, bs) = (g.unary(Unary::Ln, a), mul(g, b, s));
            let (left, right) = (mul(g, t, log), g.binary(Binary::Div, bs, a));
            let rate = g.binary(Binary::Add, left, right);
            mul(g, value, rate)
        }
        Binary::Atan2 => {
            // (b s - a t)/(a^2 + b^2)
            let (left, right) = (mul(g, b, s), mul(g, a, t));
            let above = g.binary(Binary::Sub, left, right);
            let (a2, b2) = (g.unary(Unary::Sqr, a), g.unary(Unary::Sqr, b));
            let below = g.binary(Binary::Add, a2, b2);
            g.binary(Binary::Div, above, below)
        }
    }
}
