//! What is known about the real function at a node without evaluating it. Every fact is a theorem about the real numbers;
//! "unknown" is `false`.
use super::{Axis, Binary, Graph, Node, NodeId, Unary};
use num_traits::{Signed, Zero};

/// Theorems about one node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Facts {
    /// The rational constant that it is.
    pub(crate) exact: Option<u32>,
    /// Defined at every point of space.
    pub(crate) total: bool,
    /// Defined and continuous at every point of space.
    pub(crate) continuous: bool,
    /// Not negative wherever it is defined.
    pub(crate) nonnegative: bool,
    /// Not zero wherever it is defined.
    pub(crate) nonzero: bool,
    /// Depends on no coordinate.
    pub(crate) constant: bool,
}

impl Facts {
    pub(crate) fn positive(self) -> bool {
        self.nonnegative && self.nonzero
    }
}

/// The facts about every used node of a graph, where more is `known` about some than their form tells. Nodes that are not used
/// get meaningless facts.
pub(crate) fn given(graph: &Graph, used: &[bool], known: impl Fn(NodeId) -> Option<Facts>) -> Vec<Facts> {
    let mut facts: Vec<Facts> = Vec::with_capacity(used.len());
    for (i, used) in used.iter().enumerate() {
        let id = graph.id(i);
        let own = graph.facts(id);
        facts.push(if !used {
            own
        } else {
            known(id).unwrap_or_else(|| from_children(graph, graph.node(id), own.exact, |id| facts[id.index()]))
        });
    }
    facts
}

/// The facts about a node that is about to be stored; its children are.
pub(crate) fn of(graph: &Graph, node: Node, exact: Option<u32>) -> Facts {
    from_children(graph, node, exact, |id| graph.facts(id))
}

fn from_children(graph: &Graph, node: Node, exact: Option<u32>, at: impl Fn(NodeId) -> Facts) -> Facts {
    if let Some(i) = exact {
        // A node with an exact value is defined: folding gives no value otherwise.
        let q = graph.rational_at(i);
        let (nonnegative, nonzero) = (!q.is_negative(), !q.is_zero());
        return Facts { exact, total: true, continuous: true, nonnegative, nonzero, constant: true };
    }
    match node {
        // A rational node always comes with its value, above.
        Node::Rational(_) | Node::Pi | Node::E => {
            Facts { exact: None, total: true, continuous: true, nonnegative: true, nonzero: true, constant: true }
        }
        Node::Axis(Axis::X | Axis::Y | Axis::Z) => {
            Facts { exact: None, total: true, continuous: true, nonnegative: false, nonzero: false, constant: false }
        }
        Node::Unary(op, a) => unary(op, at(a)),
        Node::Powi(a, n) => powi(at(a), n),
        Node::Binary(op, a, b) => binary(op, at(a), at(b)),
    }
}

fn unary(op: Unary, a: Facts) -> Facts {
    // Where the operator is defined and continuous on all values that the argument can have.
    let (defined, continuous) = match op {
        Unary::Sign => (true, a.nonzero),
        Unary::Floor => (true, false),
        Unary::Sqrt => (a.nonnegative, a.nonnegative),
        Unary::Ln => (a.positive(), a.positive()),
        Unary::Tan | Unary::Asin | Unary::Acos => (false, false),
        _ => (true, true),
    };
    let (nonnegative, nonzero) = match op {
        Unary::Neg => (false, a.nonzero),
        Unary::Abs | Unary::Sqr | Unary::Sqrt => (true, a.nonzero),
        Unary::Exp | Unary::Cosh => (true, true),
        // Odd and increasing.
        Unary::Sign | Unary::Cbrt | Unary::Atan | Unary::Sinh | Unary::Tanh | Unary::Asin => (a.nonnegative, a.nonzero),
        Unary::Floor => (a.nonnegative, false),
        Unary::Acos => (true, false),
        Unary::Ln | Unary::Sin | Unary::Cos | Unary::Tan => (false, false),
    };
    Facts {
        exact: None,
        total: a.total && defined,
        continuous: a.continuous && continuous,
        nonnegative,
        nonzero,
        constant: a.constant,
    }
}

fn powi(a: Facts, n: i32) -> Facts {
    let defined = n >= 0 || a.nonzero;
    Facts {
        exact: None,
        total: a.total && defined,
        continuous: a.continuous && defined,
        nonnegative: n % 2 == 0 || a.nonnegative,
        // A negative power is never 0 where it is defined, and g^0 is 1.
        nonzero: n <= 0 || a.nonzero,
        constant: a.constant,
    }
}

fn binary(op: Binary, a: Facts, b: Facts) -> Facts {
    let both_nonnegative = a.nonnegative && b.nonnegative;
    let both_nonzero = a.nonzero && b.nonzero;
    let defined = match op {
        Binary::Add | Binary::Sub | Binary::Mul | Binary::Min | Binary::Max => true,
        Binary::Div => b.nonzero,
        // a^b with a >= 0, b > 0 is continuous up to a = 0, where it is 0.
        Binary::Pow => a.positive() || (a.nonnegative && b.positive()),
        // Away from the half line b <= 0, a = 0.
        Binary::Atan2 => a.nonzero || b.positive(),
    };
    let (nonnegative, nonzero) = match op {
        Binary::Add => (both_nonnegative, both_nonnegative && (a.nonzero || b.nonzero)),
        Binary::Sub => (false, false),
        Binary::Mul => (both_nonnegative, both_nonzero),
        Binary::Div => (both_nonnegative, a.nonzero),
        // The result is one of the two.
        Binary::Min => (both_nonnegative, both_nonzero),
        Binary::Max => (a.nonnegative || b.nonnegative, both_nonzero || a.positive() || b.positive()),
        Binary::Pow => (true, a.nonzero),
        // The upper half plane has angles from 0 to pi; off the axis b the angle is not 0.
        Binary::Atan2 => (a.nonnegative, a.nonzero),
    };
    Facts {
        exact: None,
        total: a.total && b.total && defined,
        continuous: a.continuous && b.continuous && defined,
        nonnegative,
        nonzero,
        constant: a.constant && b.constant,
    }
}
