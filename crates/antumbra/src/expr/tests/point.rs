//! A reference evaluation at one point: rational where the value is rational, else `f64` with "cannot tell" near the borders of
//! domains.
use crate::expr::{Axis, Binary, Formula, Graph, Node, NodeId, Unary, exact};
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Exact(BigRational),
    Float(f64),
    Undefined,
    /// Too near to the border of a domain or a step, or too large, for rounded arithmetic to decide.
    Unclear,
}

/// How near rounded values must not come to a border.
const NEAR: f64 = 1e-6;

impl Value {
    pub(crate) fn float(&self) -> Option<f64> {
        match self {
            Self::Exact(q) => q.to_f64(),
            Self::Float(v) => Some(*v),
            _ => None,
        }
    }

    fn of(v: f64) -> Self {
        // Cancellation after values beyond 1e6 would hide more digits than the comparisons allow.
        if v.is_finite() && v.abs() < 1e6 { Self::Float(v) } else { Self::Unclear }
    }
}

/// The values of all nodes.
pub(crate) fn values(graph: &Graph, root: NodeId, point: &[BigRational; 3]) -> Vec<Value> {
    let mut out: Vec<Value> = vec![];
    for node in &graph.nodes()[..=root.index()] {
        let at = |id: NodeId| out[id.index()].clone();
        let value = match *node {
            Node::Rational(i) => Value::Exact(graph.rational_at(i).clone()),
            Node::Pi => Value::Float(std::f64::consts::PI),
            Node::E => Value::Float(std::f64::consts::E),
            Node::Axis(Axis::X) => Value::Exact(point[0].clone()),
            Node::Axis(Axis::Y) => Value::Exact(point[1].clone()),
            Node::Axis(Axis::Z) => Value::Exact(point[2].clone()),
            Node::Unary(op, a) => unary(op, at(a)),
            Node::Powi(a, n) => powi(at(a), n),
            Node::Binary(op, a, b) => binary(op, at(a), at(b)),
        };
        out.push(value);
    }
    out
}

pub(crate) fn value(formula: &Formula, point: &[BigRational; 3]) -> Value {
    values(formula.graph(), formula.root(), point).pop().unwrap()
}

fn unary(op: Unary, a: Value) -> Value {
    let v = match &a {
        Value::Undefined | Value::Unclear => return a,
        Value::Exact(q) => {
            let one = BigRational::from_integer(1.into());
            let outside = match op {
                Unary::Sqrt => q.is_negative(),
                Unary::Ln => !q.is_positive(),
                Unary::Asin | Unary::Acos => q.abs() > one,
                _ => false,
            };
            if outside {
                return Value::Undefined;
            }
            if let Some(q) = exact::unary(op, q) {
                return Value::Exact(q);
            }
            q.to_f64().unwrap()
        }
        Value::Float(v) => {
            let near = match op {
                Unary::Sqrt | Unary::Ln | Unary::Sign | Unary::Cbrt => v.abs() < NEAR,
                Unary::Floor => (v - v.round()).abs() < NEAR,
                Unary::Asin | Unary::Acos => (v.abs() - 1.0).abs() < NEAR,
                _ => false,
            };
            if near {
                return Value::Unclear;
            }
            *v
        }
    };
    let result = match op {
        Unary::Neg => -v,
        Unary::Abs => v.abs(),
        Unary::Sign => v.signum(),
        Unary::Floor => v.floor(),
        Unary::Sqr => v * v,
        Unary::Sqrt => v.sqrt(),
        Unary::Cbrt => v.cbrt(),
        Unary::Exp => v.exp(),
        Unary::Ln => v.ln(),
        Unary::Sin => v.sin(),
        Unary::Cos => v.cos(),
        Unary::Tan if v.cos().abs() < 1e-3 => return Value::Unclear,
        Unary::Tan => v.tan(),
        Unary::Asin => v.asin(),
        Unary::Acos => v.acos(),
        Unary::Atan => v.atan(),
        Unary::Sinh => v.sinh(),
        Unary::Cosh => v.cosh(),
        Unary::Tanh => v.tanh(),
    };
    if result.is_nan() { Value::Undefined } else { Value::of(result) }
}

fn powi(a: Value, n: i32) -> Value {
    match a {
        Value::Exact(q) if q.is_zero() && n < 0 => Value::Undefined,
        Value::Exact(q) => match exact::powi(&q, n) {
            Some(q) => Value::Exact(q),
            None => Value::of(q.to_f64().unwrap().powi(n)),
        },
        Value::Float(v) if n < 0 && v.abs() < 1e-3 => Value::Unclear,
        Value::Float(v) => Value::of(v.powi(n)),
        other => other,
    }
}

fn binary(op: Binary, a: Value, b: Value) -> Value {
    if a == Value::Undefined || b == Value::Undefined {
        return Value::Undefined;
    }
    if let (Value::Exact(a), Value::Exact(b)) = (&a, &b) {
        let outside = match op {
            Binary::Div => b.is_zero(),
            Binary::Pow => a.is_negative() || (a.is_zero() && !b.is_positive()),
            Binary::Atan2 => a.is_zero() && b.is_zero(),
            _ => false,
        };
        if outside {
            return Value::Undefined;
        }
        if let Some(q) = exact::binary(op, a, b) {
            return Value::Exact(q);
        }
    }
    let (Some(v), Some(w)) = (a.float(), b.float()) else { return Value::Unclear };
    let zero_exactly = |value: &Value| matches!(value, Value::Exact(q) if q.is_zero());
    Value::of(match op {
        Binary::Add => v + w,
        Binary::Sub => v - w,
        Binary::Mul => v * w,
        Binary::Div if zero_exactly(&b) => return Value::Undefined,
        Binary::Div if w.abs() < 1e-3 => return Value::Unclear,
        Binary::Div => v / w,
        Binary::Min => v.min(w),
        Binary::Max => v.max(w),
        Binary::Pow if zero_exactly(&a) && w > NEAR => return Value::Exact(BigRational::zero()),
        Binary::Pow if zero_exactly(&a) && w < -NEAR => return Value::Undefined,
        Binary::Pow if v.abs() < NEAR => return Value::Unclear,
        Binary::Pow if v < 0.0 => return Value::Undefined,
        Binary::Pow => v.powf(w),
        // The cut along the negative axis, and the origin.
        Binary::Atan2 if v.abs() < NEAR && !zero_exactly(&a) => return Value::Unclear,
        Binary::Atan2 if v.abs() < NEAR && w.abs() < NEAR => return Value::Unclear,
        Binary::Atan2 => {
            if zero_exactly(&a) {
                0.0_f64.atan2(w)
            } else {
                v.atan2(w)
            }
        }
    })
}
