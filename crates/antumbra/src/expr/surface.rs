//! Zero-preserving rewriting: another formula with exactly the same set {f = 0, f defined}.
//!
//! A squared formula touches zero without changing sign, so that no sign can prove its surface; its root can. Each step, with
//! Z(f) = {p : f defined at p and f(p) = 0}; "factor" steps apply to the factors of a product at the root, "root" steps to the
//! whole formula only.
//!
//! | step | proof |
//! |---|---|
//! | `-g`, `abs(g)`, `g^2`, `g^n` (n >= 1), `cbrt(g)` -> `g` (factor) | defined where g is; 0 iff g is |
//! | `sqrt(g)` -> `g` (root) | sqrt is defined for g >= 0 and 0 iff g = 0; where g < 0, g is not 0 |
//! | `g^c`, real power, c > 0 -> `g` (root) | undefined for g < 0, 0 for g = 0, positive for g > 0 |
//! | `c*g` -> `g`, c never 0 and defined everywhere (factor) | a product is 0 iff a factor is; c never is and hides no point |
//! | `g/h` -> `g`, h never 0 and defined everywhere (factor) | defined where g is; 0 iff g is |
//! | `c/h` -> `c`, c a constant that is not 0 (root) | neither is ever 0: a pole is not a surface |
//! | `g*g*h` -> `g*h` (factors) | same domain; both are 0 iff g or h is |
//! | `sqrt(g) - c`, `c - sqrt(g)` -> `g - c^2`, c >= 0 (root) | sqrt(g) = c iff g = c^2, since then g >= 0 |
//!
//! The *sign* of the formula is not kept: `-g` becomes `g`, so inside and outside may change places.
//!
//! A square root inside a product stays: `sqrt(g)*h` is undefined for g < 0, where `g*h` may vanish with h.
use super::{Binary, Formula, Graph, Node, NodeId, Unary};
use num_traits::Signed;
use std::{collections::HashSet, fmt};

/// What [`Formula::surface`] did.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ZeroStep {
    /// Removed a sign.
    Sign,
    /// Removed an absolute value.
    Abs,
    /// Took the root of a power.
    Power,
    /// Removed a square or cube root.
    Root,
    /// Removed a factor or divisor that is never 0.
    Factor,
    /// Removed a repeated factor.
    Repeated,
    /// Squared a distance equation, `sqrt(g) = c`.
    Distance,
}

impl fmt::Display for ZeroStep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Sign => "removed a sign",
            Self::Abs => "removed an absolute value",
            Self::Power => "took the root of a power",
            Self::Root => "removed a root",
            Self::Factor => "removed a factor that is never 0",
            Self::Repeated => "removed a repeated factor",
            Self::Distance => "squared both sides of a distance equation",
        })
    }
}

/// A formula with the same zero set as another.
#[derive(Clone, Debug)]
pub struct Surface {
    formula: Formula,
    steps: Vec<ZeroStep>,
}

impl Surface {
    /// The rewritten, simplified formula.
    #[must_use]
    pub fn formula(&self) -> &Formula {
        &self.formula
    }

    /// What was done, in order; empty if the formula is the original one, simplified.
    #[must_use]
    pub fn steps(&self) -> &[ZeroStep] {
        &self.steps
    }

    /// The rewritten formula alone.
    #[must_use]
    pub fn into_formula(self) -> Formula {
        self.formula
    }
}

pub(crate) fn zero_set(formula: &Formula) -> Surface {
    let simple = formula.simplify();
    let mut graph = simple.graph().clone().into_simplifying();
    let mut root = simple.root();
    let mut steps = vec![];
    // Each step but the last two makes the part of the graph below the root smaller; those two remove a root.
    while let Some((next, step)) = root_step(&mut graph, root) {
        root = next;
        steps.extend(step);
    }
    Surface { formula: Formula::new(graph, root).compacted(), steps }
}

/// One step at the root, or `None` when nothing is left to do.
fn root_step(g: &mut Graph, root: NodeId) -> Option<(NodeId, Vec<ZeroStep>)> {
    if let Some((next, step)) = factor_step(g, root) {
        return Some((next, vec![step]));
    }
    match g.node(root) {
        Node::Unary(Unary::Sqrt, a) => Some((a, vec![ZeroStep::Root])),
        Node::Binary(Binary::Pow, a, b) if g.exact(b).is_some_and(Signed::is_positive) => {
            Some((a, vec![ZeroStep::Power]))
        }
        Node::Binary(Binary::Sub, a, b) => {
            let (inside, c) = match (g.node(a), g.node(b)) {
                (Node::Unary(Unary::Sqrt, inside), _) => (inside, b),
                (_, Node::Unary(Unary::Sqrt, inside)) => (inside, a),
                _ => return None,
            };
            if g.exact(c).is_none_or(Signed::is_negative) {
                return None;
            }
            let square = g.unary(Unary::Sqr, c);
            Some((g.binary(Binary::Sub, inside, square), vec![ZeroStep::Distance]))
        }
        Node::Binary(Binary::Div, a, _) if g.facts(a).constant && g.facts(a).total && g.facts(a).nonzero => {
            Some((a, vec![ZeroStep::Factor]))
        }
        Node::Binary(Binary::Mul, ..) => product_step(g, root),
        _ => None,
    }
}

/// A step that keeps domain and zero set, so that it may be taken inside a product.
fn factor_step(g: &Graph, id: NodeId) -> Option<(NodeId, ZeroStep)> {
    let never_zero = |id: NodeId| {
        let facts = g.facts(id);
        facts.total && facts.nonzero
    };
    Some(match g.node(id) {
        Node::Unary(Unary::Neg, a) => (a, ZeroStep::Sign),
        Node::Unary(Unary::Abs, a) => (a, ZeroStep::Abs),
        Node::Unary(Unary::Sqr, a) => (a, ZeroStep::Power),
        Node::Powi(a, n) if n >= 1 => (a, ZeroStep::Power),
        Node::Unary(Unary::Cbrt, a) => (a, ZeroStep::Root),
        Node::Binary(Binary::Div, a, b) if never_zero(b) => (a, ZeroStep::Factor),
        Node::Binary(Binary::Mul, a, b) if never_zero(a) => (b, ZeroStep::Factor),
        Node::Binary(Binary::Mul, a, b) if never_zero(b) => (a, ZeroStep::Factor),
        _ => return None,
    })
}

/// The product of the distinct factors, each stepped as far as it goes. Each node of the product is visited once, so a product
/// that shares its parts costs no more than its graph.
fn product_step(g: &mut Graph, root: NodeId) -> Option<(NodeId, Vec<ZeroStep>)> {
    let mut steps = vec![];
    let mut factors = vec![];
    let mut seen = HashSet::new();
    let mut stack = vec![root];
    while let Some(mut id) = stack.pop() {
        while let Some((next, step)) = factor_step(g, id) {
            steps.push(step);
            id = next;
        }
        if !seen.insert(id) {
            steps.push(ZeroStep::Repeated);
        } else if let Node::Binary(Binary::Mul, a, b) = g.node(id) {
            stack.extend([b, a]);
        } else {
            factors.push(id);
        }
    }
    if steps.is_empty() {
        return None;
    }
    let product = factors[1..].iter().fold(factors[0], |left, &right| g.binary(Binary::Mul, left, right));
    Some((product, steps))
}
