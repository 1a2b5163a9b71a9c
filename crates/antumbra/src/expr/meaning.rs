//! What the built-in functions mean, as operations of the graph.
//!
//! | call | meaning |
//! |---|---|
//! | `sec csc cot (a)` | `1/cos(a)`, `1/sin(a)`, `cos(a)/sin(a)` |
//! | `log10(a)`, `log2(a)` | `ln(a)/ln(10)`, `ln(a)/ln(2)` |
//! | `ceil(a)` | `-floor(-a)` |
//! | `mod(a, b)` | `a - b*floor(a/b)`: the sign of `b` |
//! | `pow(a, b)` | `a^b` |
//! | `powr(a, b)` | real power: `exp(b ln a)` for `a > 0`, 0 for `a = 0 < b`, else undefined; also for integer `b` |
//! | `union(a, ...)`, `intersection(a, ...)` | `min`, `max`: the inside of a solid is where its formula is negative |
//! | `difference(a, b, ...)` | `max(a, -b, ...)` |
//! | `smooth_union(a, b, k)` | `min(a, b) - max(k - \|a - b\|, 0)^2/(4k)`: the quadratic polynomial smooth minimum |
//! | `smooth_intersection(a, b, k)` | `max(a, b) + max(k - \|a - b\|, 0)^2/(4k)` |
//! | `smooth_difference(a, b, k)` | `smooth_intersection(a, -b, k)` |
//! | `translate(f, u, v, w)` | the shape moved by `(u, v, w)`: `f(x - u, y - v, z - w)` |
//! | `rotate(f, a, b, c)` | the shape turned about the x axis by `a` degrees, then about y by `b`, then about z by `c`, right-handed |
//! | `scale(f, s)` | the shape `s` times as large: `s*f(x/s, y/s, z/s)`, so that distances stay distances |
//! | `scale(f, a, b, c)` | stretched along the axes: `f(x/a, y/b, z/c)` |
//! | `sphere(r)` | `sqrt(x^2 + y^2 + z^2) - r`, the distance |
//! | `torus(R, r)` | `sqrt((sqrt(x^2 + y^2) - R)^2 + z^2) - r`, about the z axis, the distance |
//! | `box(a, b, c)`, `box(a)` | `max(\|x\| - a, \|y\| - b, \|z\| - c)`: half sizes; distance in the maximum norm |
//! | `cylinder(r)`, `cylinder(r, h)` | `sqrt(x^2 + y^2) - r` about the z axis; cut at `\|z\| = h` by `max` |
use super::{Axis, Binary, Graph, NodeId, Unary, function::Builtin};
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::ToPrimitive;
use rustc_hash::FxHashMap;

/// The divisor of a division by the constant 0.
pub(crate) struct ZeroDivisor;

/// `a/b`, unless `b` is exactly 0.
pub(crate) fn divide(g: &mut Graph, a: NodeId, b: NodeId) -> Result<NodeId, ZeroDivisor> {
    use num_traits::Zero;
    if g.exact(b).is_some_and(Zero::is_zero) { Err(ZeroDivisor) } else { Ok(g.binary(Binary::Div, a, b)) }
}

fn chain(g: &mut Graph, op: Binary, a: &[NodeId]) -> NodeId {
    a[1..].iter().fold(a[0], |left, &right| g.binary(op, left, right))
}

fn axes(g: &mut Graph) -> [NodeId; 3] {
    [Axis::X, Axis::Y, Axis::Z].map(|axis| g.axis(axis))
}

/// `sqrt(a^2 + b^2 ...)`.
fn norm(g: &mut Graph, a: &[NodeId]) -> NodeId {
    let squares: Vec<NodeId> = a.iter().map(|&a| g.unary(Unary::Sqr, a)).collect();
    let sum = chain(g, Binary::Add, &squares);
    g.unary(Unary::Sqrt, sum)
}

/// The value of the call; the number of arguments was checked.
///
/// `powr` and the other operators that the graph has are direct; `pow` and the transforms are the caller's, as they need
/// more than the graph.
pub(crate) fn call(g: &mut Graph, f: Builtin, a: &[NodeId]) -> Result<NodeId, ZeroDivisor> {
    use Builtin as F;
    let direct = match f {
        F::Sin => Unary::Sin,
        F::Cos => Unary::Cos,
        F::Tan => Unary::Tan,
        F::Asin => Unary::Asin,
        F::Acos => Unary::Acos,
        F::Atan => Unary::Atan,
        F::Sinh => Unary::Sinh,
        F::Cosh => Unary::Cosh,
        F::Tanh => Unary::Tanh,
        F::Exp => Unary::Exp,
        F::Ln => Unary::Ln,
        F::Sqrt => Unary::Sqrt,
        F::Cbrt => Unary::Cbrt,
        F::Abs => Unary::Abs,
        F::Sign => Unary::Sign,
        F::Floor => Unary::Floor,
        _ => return composed(g, f, a),
    };
    Ok(g.unary(direct, a[0]))
}

fn composed(g: &mut Graph, f: Builtin, a: &[NodeId]) -> Result<NodeId, ZeroDivisor> {
    use Builtin as F;
    Ok(match f {
        F::Sec | F::Csc => {
            let below = g.unary(if f == F::Sec { Unary::Cos } else { Unary::Sin }, a[0]);
            let one = g.integer(1);
            divide(g, one, below)?
        }
        F::Cot => {
            let (cos, sin) = (g.unary(Unary::Cos, a[0]), g.unary(Unary::Sin, a[0]));
            divide(g, cos, sin)?
        }
        F::Log10 | F::Log2 => {
            let base = g.integer(if f == F::Log2 { 2 } else { 10 });
            let (above, below) = (g.unary(Unary::Ln, a[0]), g.unary(Unary::Ln, base));
            g.binary(Binary::Div, above, below)
        }
        F::Ceil => {
            let a = g.unary(Unary::Neg, a[0]);
            let floor = g.unary(Unary::Floor, a);
            g.unary(Unary::Neg, floor)
        }
        F::Mod => {
            let quotient = divide(g, a[0], a[1])?;
            let floor = g.unary(Unary::Floor, quotient);
            let whole = g.binary(Binary::Mul, a[1], floor);
            g.binary(Binary::Sub, a[0], whole)
        }
        F::Atan2 => g.binary(Binary::Atan2, a[0], a[1]),
        F::Powr => g.binary(Binary::Pow, a[0], a[1]),
        F::Min | F::Union => chain(g, Binary::Min, a),
        F::Max | F::Intersection => chain(g, Binary::Max, a),
        F::Difference => {
            let mut parts = vec![a[0]];
            parts.extend(a[1..].iter().map(|&b| g.unary(Unary::Neg, b)));
            chain(g, Binary::Max, &parts)
        }
        F::SmoothUnion => {
            let blend = blend(g, a[0], a[1], a[2])?;
            let least = g.binary(Binary::Min, a[0], a[1]);
            g.binary(Binary::Sub, least, blend)
        }
        F::SmoothIntersection | F::SmoothDifference => {
            let b = if f == F::SmoothDifference { g.unary(Unary::Neg, a[1]) } else { a[1] };
            let blend = blend(g, a[0], b, a[2])?;
            let most = g.binary(Binary::Max, a[0], b);
            g.binary(Binary::Add, most, blend)
        }
        F::Sphere => {
            let axes = axes(g);
            let norm = norm(g, &axes);
            g.binary(Binary::Sub, norm, a[0])
        }
        F::Torus => {
            let [x, y, z] = axes(g);
            let around = norm(g, &[x, y]);
            let from_circle = g.binary(Binary::Sub, around, a[0]);
            let norm = norm(g, &[from_circle, z]);
            g.binary(Binary::Sub, norm, a[1])
        }
        F::Box => {
            let mut parts = vec![];
            for (i, axis) in axes(g).into_iter().enumerate() {
                let half = a.get(i).copied().unwrap_or(a[a.len() - 1]);
                let abs = g.unary(Unary::Abs, axis);
                parts.push(g.binary(Binary::Sub, abs, half));
            }
            chain(g, Binary::Max, &parts)
        }
        _ => {
            // Cylinder: the only one left.
            let [x, y, z] = axes(g);
            let around = norm(g, &[x, y]);
            let side = g.binary(Binary::Sub, around, a[0]);
            match a.get(1) {
                None => side,
                Some(&half) => {
                    let abs = g.unary(Unary::Abs, z);
                    let caps = g.binary(Binary::Sub, abs, half);
                    g.binary(Binary::Max, side, caps)
                }
            }
        }
    })
}

/// `max(k - |a - b|, 0)^2/(4k)`.
fn blend(g: &mut Graph, a: NodeId, b: NodeId, k: NodeId) -> Result<NodeId, ZeroDivisor> {
    let difference = g.binary(Binary::Sub, a, b);
    let distance = g.unary(Unary::Abs, difference);
    let (rest, zero, four) = (g.binary(Binary::Sub, k, distance), g.integer(0), g.integer(4));
    let depth = g.binary(Binary::Max, rest, zero);
    let (above, below) = (g.unary(Unary::Sqr, depth), g.binary(Binary::Mul, four, k));
    divide(g, above, below)
}

/// The coordinates at which a transformed shape's formula is evaluated.
pub(crate) fn transformed(g: &mut Graph, f: Builtin, a: &[NodeId]) -> Result<[NodeId; 3], ZeroDivisor> {
    let [x, y, z] = axes(g);
    Ok(match f {
        Builtin::Translate => {
            [g.binary(Binary::Sub, x, a[0]), g.binary(Binary::Sub, y, a[1]), g.binary(Binary::Sub, z, a[2])]
        }
        Builtin::Rotate => {
            // The shape's rotation is Rz Ry Rx; its formula is evaluated at the inverse, Rx' Ry' Rz' of the point.
            let (x, y) = turned_back(g, a[2], x, y);
            let (z, x) = turned_back(g, a[1], z, x);
            let (y, z) = turned_back(g, a[0], y, z);
            [x, y, z]
        }
        _ => {
            let by = |i: usize| a.get(i).copied().unwrap_or(a[0]);
            [divide(g, x, by(0))?, divide(g, y, by(1))?, divide(g, z, by(2))?]
        }
    })
}

/// `(u cos + v sin, v cos - u sin)`: the plane's point turned back by an angle of that many degrees from u towards v.
fn turned_back(g: &mut Graph, degrees: NodeId, u: NodeId, v: NodeId) -> (NodeId, NodeId) {
    let (cos, sin) = cos_sin(g, degrees);
    let product = |g: &mut Graph, a, b| g.binary(Binary::Mul, a, b);
    let (uc, vs, vc, us) = (product(g, u, cos), product(g, v, sin), product(g, v, cos), product(g, u, sin));
    (g.binary(Binary::Add, uc, vs), g.binary(Binary::Sub, vc, us))
}

/// Exact where the angle is a multiple of 30 or 45 degrees.
fn cos_sin(g: &mut Graph, degrees: NodeId) -> (NodeId, NodeId) {
    let whole = g.exact(degrees).filter(|q| q.is_integer()).map(|q| q.numer().mod_floor(&360.into()));
    if let Some(angle) = whole.and_then(|d| d.to_i64()) {
        // cos and sin of the angle, each as sign * squared value * 4.
        let quarter = |d: i64| match d.rem_euclid(360) {
            0 => Some(4),
            30 | 330 => Some(3),
            45 | 315 => Some(2),
            60 | 300 => Some(1),
            90 | 270 => Some(0),
            120 | 240 => Some(-1),
            135 | 225 => Some(-2),
            150 | 210 => Some(-3),
            180 => Some(-4),
            _ => None,
        };
        if let (Some(c), Some(s)) = (quarter(angle), quarter(angle - 90)) {
            return (signed_root(g, c), signed_root(g, s));
        }
    }
    let (pi, half_turn) = (g.pi(), g.integer(180));
    let product = g.binary(Binary::Mul, degrees, pi);
    let angle = g.binary(Binary::Div, product, half_turn);
    (g.unary(Unary::Cos, angle), g.unary(Unary::Sin, angle))
}

/// `sign(q) sqrt(|q|/4)`.
fn signed_root(g: &mut Graph, q: i64) -> NodeId {
    let square = g.rational(BigRational::new(q.abs().into(), 4.into()));
    let root = g.unary(Unary::Sqrt, square);
    if q < 0 { g.unary(Unary::Neg, root) } else { root }
}

/// `root` with the coordinates replaced. `spend` is asked once for each node visited and stops the work.
pub(crate) fn substitute<E>(
    g: &mut Graph,
    root: NodeId,
    by: [NodeId; 3],
    mut spend: impl FnMut(&Graph) -> Result<(), E>,
) -> Result<NodeId, E> {
    let mut place: FxHashMap<NodeId, NodeId> = FxHashMap::default();
    let from = [Axis::X, Axis::Y, Axis::Z].map(|axis| g.axis(axis));
    place.extend(from.into_iter().zip(by));
    let mut stack = vec![root];
    while let Some(&id) = stack.last() {
        if place.contains_key(&id) {
            stack.pop();
            continue;
        }
        spend(g)?;
        let node = g.node(id);
        if g.facts(id).constant {
            place.insert(id, id);
            continue;
        }
        let before = stack.len();
        stack.extend(node.children().filter(|c| !place.contains_key(c)));
        if stack.len() == before {
            let at = |id: NodeId| place.get(&id).copied().unwrap_or(id);
            let new = match node {
                super::Node::Unary(op, a) => g.unary(op, at(a)),
                super::Node::Powi(a, n) => g.powi(at(a), n),
                super::Node::Binary(op, a, b) => g.binary(op, at(a), at(b)),
                _ => id,
            };
            place.insert(id, new);
        }
    }
    Ok(place.get(&root).copied().unwrap_or(root))
}
