//! The shared graph: every distinct operation once, children before parents, constants exact.
use super::{
    Axis, Binary, Unary, exact,
    facts::{self, Facts},
    rules,
};
use num_rational::BigRational;
use rustc_hash::FxHashMap;

/// Place of a node in its [`Graph`]; smaller than the places of all nodes that use it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeId(pub(crate) u32);

impl NodeId {
    /// Place in [`Graph::nodes`].
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// One operation of a [`Graph`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// An exact rational constant: its value is [`Graph::exact`] of the node.
    Rational(u32),
    /// The circle constant.
    Pi,
    /// Euler's number.
    E,
    /// A coordinate.
    Axis(Axis),
    /// An operator of one argument.
    Unary(Unary, NodeId),
    /// Integer power: `a^0 = 1`; for a negative exponent undefined at 0.
    Powi(NodeId, i32),
    /// An operator of two arguments.
    Binary(Binary, NodeId, NodeId),
}

impl Node {
    /// Arguments in order.
    pub fn children(self) -> impl DoubleEndedIterator<Item = NodeId> {
        let (a, b) = match self {
            Self::Rational(_) | Self::Pi | Self::E | Self::Axis(_) => (None, None),
            Self::Unary(_, a) | Self::Powi(a, _) => (Some(a), None),
            Self::Binary(_, a, b) => (Some(a), Some(b)),
        };
        a.into_iter().chain(b)
    }
}

/// Operations on coordinates and exact constants, each stored once ("hash-consed").
///
/// Building never recurses deeper than a few calls; all passes are loops over the nodes in order.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    facts: Vec<Facts>,
    rationals: Vec<BigRational>,
    place: FxHashMap<Node, NodeId>,
    place_of_rational: FxHashMap<BigRational, u32>,
    simplifying: bool,
}

impl Graph {
    /// A graph that applies the rules of [`Formula::simplify`](super::Formula::simplify) to each operation that it is given, or
    /// keeps each as it is.
    pub(crate) fn new(simplifying: bool) -> Self {
        Self { simplifying, ..Self::default() }
    }

    /// The same graph, which applies the rules to each operation that is added from now on.
    pub(crate) fn into_simplifying(self) -> Self {
        Self { simplifying: true, ..self }
    }

    /// Every node; children stand before parents.
    #[must_use]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The operation at that place. Panics on a place of another, larger graph.
    #[must_use]
    pub fn node(&self, id: NodeId) -> Node {
        self.nodes[id.index()]
    }

    /// The id of the node at that place of [`Graph::nodes`].
    #[must_use]
    pub fn id(&self, index: usize) -> NodeId {
        assert!(index < self.nodes.len(), "no node at {index}");
        NodeId(index as u32)
    }

    /// The exact value of a node, where it is known to be a rational constant.
    #[must_use]
    pub fn exact(&self, id: NodeId) -> Option<&BigRational> {
        self.facts(id).exact.map(|i| &self.rationals[i as usize])
    }

    /// What is known about the real function at that node.
    pub(crate) fn facts(&self, id: NodeId) -> Facts {
        self.facts[id.index()]
    }

    /// For each node up to `root`, whether `root` depends on it.
    pub(crate) fn reachable(&self, root: NodeId) -> Vec<bool> {
        let mut used = vec![false; root.index() + 1];
        used[root.index()] = true;
        for i in (0..used.len()).rev() {
            if used[i] {
                for child in self.nodes[i].children() {
                    used[child.index()] = true;
                }
            }
        }
        used
    }

    fn insert(&mut self, node: Node, exact: Option<BigRational>) -> NodeId {
        let exact = exact.map(|q| self.rational_index(q));
        // In a simplifying graph a known constant is that constant.
        let node = match exact {
            Some(i) if self.simplifying => Node::Rational(i),
            _ => node,
        };
        if let Some(&id) = self.place.get(&node) {
            return id;
        }
        let id = NodeId(self.nodes.len() as u32);
        self.facts.push(facts::of(self, node, exact));
        self.nodes.push(node);
        self.place.insert(node, id);
        id
    }

    fn rational_index(&mut self, q: BigRational) -> u32 {
        if let Some(&i) = self.place_of_rational.get(&q) {
            return i;
        }
        let i = self.rationals.len() as u32;
        self.rationals.push(q.clone());
        self.place_of_rational.insert(q, i);
        i
    }

    /// The value behind a [`Node::Rational`] or a fact.
    pub(crate) fn rational_at(&self, index: u32) -> &BigRational {
        &self.rationals[index as usize]
    }

    pub(crate) fn rational(&mut self, q: BigRational) -> NodeId {
        let i = self.rational_index(q);
        let q = self.rationals[i as usize].clone();
        self.insert(Node::Rational(i), Some(q))
    }

    pub(crate) fn integer(&mut self, n: i64) -> NodeId {
        self.rational(BigRational::from_integer(n.into()))
    }

    pub(crate) fn axis(&mut self, axis: Axis) -> NodeId {
        self.insert(Node::Axis(axis), None)
    }

    pub(crate) fn pi(&mut self) -> NodeId {
        self.insert(Node::Pi, None)
    }

    pub(crate) fn e(&mut self) -> NodeId {
        self.insert(Node::E, None)
    }

    pub(crate) fn unary(&mut self, op: Unary, a: NodeId) -> NodeId {
        let exact = self.exact(a).and_then(|a| exact::unary(op, a));
        if self.simplifying
            && exact.is_none()
            && let Some(id) = rules::unary(self, op, a)
        {
            return id;
        }
        self.insert(Node::Unary(op, a), exact)
    }

    /// A square is always stored as [`Unary::Sqr`].
    pub(crate) fn powi(&mut self, a: NodeId, n: i32) -> NodeId {
        if n == 2 {
            return self.unary(Unary::Sqr, a);
        }
        let exact = self.exact(a).and_then(|a| exact::powi(a, n));
        if self.simplifying
            && exact.is_none()
            && let Some(id) = rules::powi(self, a, n)
        {
            return id;
        }
        self.insert(Node::Powi(a, n), exact)
    }

    pub(crate) fn binary(&mut self, op: Binary, a: NodeId, b: NodeId) -> NodeId {
        let exact = match (self.exact(a), self.exact(b)) {
            (Some(a), Some(b)) => exact::binary(op, a, b),
            _ => None,
        };
        if self.simplifying
            && exact.is_none()
            && let Some(id) = rules::binary(self, op, a, b)
        {
            return id;
        }
        // a + b and b + a are one node: the one that was written first.
        let commutes = matches!(op, Binary::Add | Binary::Mul | Binary::Min | Binary::Max);
        if commutes && let Some(&id) = self.place.get(&Node::Binary(op, b, a)) {
            return id;
        }
        self.insert(Node::Binary(op, a, b), exact)
    }

    /// Copies a node of another graph, whose children are here as `place` says.
    pub(crate) fn copy(&mut self, from: &Self, id: NodeId, place: impl Fn(NodeId) -> NodeId) -> NodeId {
        if self.simplifying
            && let Some(q) = from.exact(id)
        {
            return self.rational(q.clone());
        }
        match from.node(id) {
            Node::Rational(i) => self.rational(from.rational_at(i).clone()),
            Node::Pi => self.pi(),
            Node::E => self.e(),
            Node::Axis(axis) => self.axis(axis),
            Node::Unary(op, a) => self.unary(op, place(a)),
            Node::Powi(a, n) => self.powi(place(a), n),
            Node::Binary(op, a, b) => self.binary(op, place(a), place(b)),
        }
    }
}
