//! The polynomial parts of a formula.
use super::super::{Binary, Graph, Node, NodeId, Unary};
use super::polynomial::{Limit, Polynomial};
use num_rational::BigRational;
use num_traits::{One, Zero};

/// Each node of a graph as a polynomial over others, where it is one.
///
/// Sums, differences, negations, products, powers with a positive exponent and division by a constant other than 0 are defined
/// wherever their operands are, so a polynomial in other nodes is the same real function as the node. All other nodes are *opaque*:
/// atoms, and so are nodes whose polynomial would be too large.
pub(super) struct Expansion<'a> {
    graph: &'a Graph,
    /// `None` for opaque nodes and for those that the root does not need.
    polynomials: Vec<Option<Polynomial>>,
}

/// What is multiplied out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Depth {
    /// Nothing: sums that are multiplied stay atoms.
    Sums,
    /// All that stays small enough.
    All,
}

impl<'a> Expansion<'a> {
    pub(super) fn new(graph: &'a Graph, used: &[bool], depth: Depth, most: usize) -> Self {
        let mut expansion = Self { graph, polynomials: vec![None; used.len()] };
        let mut limit = Limit::new(most);
        for i in (0..used.len()).filter(|&i| used[i]) {
            expansion.polynomials[i] = expansion.expand(graph.id(i), depth, &mut limit);
        }
        expansion
    }

    /// The polynomial of a node; `None` for an opaque one.
    pub(super) fn of(&self, id: NodeId) -> Option<&Polynomial> {
        self.polynomials[id.index()].as_ref()
    }

    /// The node as an operand: its polynomial, or itself as an atom.
    fn operand(&self, id: NodeId) -> Polynomial {
        self.of(id).cloned().unwrap_or_else(|| Polynomial::atom(id.0))
    }

    /// The node as a factor: a single term, or an atom.
    fn factor(&self, id: NodeId) -> Polynomial {
        self.of(id).filter(|p| p.len() <= 1).cloned().unwrap_or_else(|| Polynomial::atom(id.0))
    }

    fn expand(&self, id: NodeId, depth: Depth, limit: &mut Limit) -> Option<Polynomial> {
        let sum = |a: NodeId, c: BigRational, b: NodeId, limit: &mut Limit| {
            let copied = limit.spend(self.of(a).map_or(1, Polynomial::len));
            let whole = copied.and_then(|()| self.operand(a).plus(&c, &self.operand(b), limit));
            whole.or_else(|| self.factor(a).plus(&c, &self.factor(b), limit))
        };
        match self.graph.node(id) {
            _ if self.graph.exact(id).is_some() => self.graph.exact(id).cloned().map(Polynomial::constant),
            Node::Unary(Unary::Neg, a) => self.operand(a).scaled(&-BigRational::one()),
            Node::Unary(Unary::Sqr, a) => self.power(a, 2, depth, limit),
            Node::Powi(a, n) => self.power(a, u32::try_from(n).ok().filter(|n| *n > 0)?, depth, limit),
            Node::Binary(Binary::Add, a, b) => sum(a, BigRational::one(), b, limit),
            Node::Binary(Binary::Sub, a, b) => sum(a, -BigRational::one(), b, limit),
            Node::Binary(Binary::Mul, a, b) => {
                let whole = (depth == Depth::All).then(|| self.operand(a).times(&self.operand(b), limit)).flatten();
                whole.or_else(|| self.factor(a).times(&self.factor(b), limit))
            }
            Node::Binary(Binary::Div, a, b) => {
                let divisor = self.graph.exact(b).filter(|q| !q.is_zero())?;
                self.operand(a).scaled(&divisor.recip())
            }
            _ => None,
        }
    }

    fn power(&self, a: NodeId, n: u32, depth: Depth, limit: &mut Limit) -> Option<Polynomial> {
        let whole = (depth == Depth::All).then(|| self.operand(a).power(n, limit)).flatten();
        whole.or_else(|| self.factor(a).power(n, limit))
    }

    /// Which nodes have to be computed so that the root can be: atoms of polynomials, operands of opaque nodes.
    pub(super) fn needed(&self, root: NodeId) -> Vec<bool> {
        let mut needed = vec![false; root.index() + 1];
        needed[root.index()] = true;
        for i in (0..needed.len()).rev() {
            if !needed[i] {
                continue;
            }
            match &self.polynomials[i] {
                Some(p) => p.atoms().into_iter().for_each(|atom| needed[atom as usize] = true),
                None => self.graph.node(self.graph.id(i)).children().for_each(|child| needed[child.index()] = true),
            }
        }
        needed
    }

    /// Whether the polynomials have lost no node that may be undefined somewhere. Every operator is undefined where an operand is, so
    /// a formula is defined where all of its nodes are: with the same nodes it has the same domain.
    pub(super) fn keeps_domain(&self, used: &[bool], needed: &[bool]) -> bool {
        let lost = |i: usize| used[i] && !needed[i] && self.polynomials[i].is_none();
        !(0..used.len()).any(|i| lost(i) && !self.graph.facts(self.graph.id(i)).total)
    }
}
