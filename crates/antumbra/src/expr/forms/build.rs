//! Polynomials as operations: Horner forms, common factors, completed squares.
use super::super::{Axis, Binary, Graph, Node, NodeId, Unary};
use super::polynomial::{Atom, Limit, Monomial, Polynomial};
use super::{expansion::Expansion, square};
use num_rational::BigRational;
use num_traits::{One, Signed};
use std::{cmp::Reverse, collections::BTreeMap};

/// How sums are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Style {
    /// Which coordinate comes first: the one that is factored out where several could be.
    pub(super) order: [Axis; 3],
    /// Whether the first one that can be is factored out, though another is in more terms.
    pub(super) strict: bool,
    /// Whether squares are completed first.
    pub(super) squares: bool,
    /// Whether `a^2 b^2` is written `(a b)^2`.
    pub(super) pairs: bool,
}

pub(super) struct Builder<'a> {
    source: &'a Graph,
    style: Style,
    graph: Graph,
    /// Where nodes of the source are in the graph that is built.
    place: Vec<Option<NodeId>>,
    limit: Limit,
    /// Nodes of the graph that is built at most.
    most_nodes: usize,
}

/// The formula of an expansion, written in that style: the same real function, as every step is an identity of polynomials with
/// exact coefficients. `None` where it would have many times more operations than the source.
pub(super) fn write(
    source: &Graph,
    root: NodeId,
    expansion: &Expansion<'_>,
    needed: &[bool],
    style: Style,
    most: usize,
) -> Option<(Graph, NodeId)> {
    let mut builder = Builder {
        source,
        style,
        graph: Graph::new(true),
        place: vec![None; needed.len()],
        limit: Limit::new(most),
        most_nodes: 6 * source.nodes().len() + 100,
    };
    for i in (0..needed.len()).filter(|&i| needed[i]) {
        let id = source.id(i);
        builder.place[i] = Some(match expansion.of(id) {
            Some(p) => builder.sum(p),
            None => {
                let place = &builder.place;
                builder.graph.copy(source, id, |child| placed(place, child.index()))
            }
        });
    }
    let root = placed(&builder.place, root.index());
    (!builder.is_full()).then_some((builder.graph, root))
}

fn placed(place: &[Option<NodeId>], index: usize) -> NodeId {
    match place[index] {
        Some(id) => id,
        None => unreachable!("operands stand before what needs them"),
    }
}

impl Builder<'_> {
    /// Recursion: what goes down has fewer terms, or as many of lower degree without their common factor, or is a square's root: some
    /// hundred levels at most.
    fn sum(&mut self, p: &Polynomial) -> NodeId {
        if self.is_full() {
            // What is written from here on is thrown away.
            return self.graph.integer(0);
        }
        let mut terms = p.terms();
        let (first, second) = (terms.next(), terms.next());
        match (first, second) {
            (None, _) => return self.graph.integer(0),
            (Some((m, q)), None) => return self.term(m, q),
            _ => {}
        }
        if is_negative(p)
            && let Some(p) = p.scaled(&-BigRational::one())
        {
            let positive = self.sum(&p);
            return self.graph.unary(Unary::Neg, positive);
        }
        if let Some((c, p)) = content(p) {
            let (c, inner) = (self.graph.rational(c), self.sum(&p));
            return self.graph.binary(Binary::Mul, c, inner);
        }
        if self.style.squares
            && let Some(square) = self.square(p)
        {
            return square;
        }
        let Some((atom, n)) = self.best_factor(p) else { return self.leaves(p) };
        let (quotient, rest) = p.split(atom, n);
        let power = self.power(atom, n);
        let (negative, inner) = self.signed(&quotient);
        let product = self.graph.binary(Binary::Mul, power, inner);
        self.with_rest((negative, product), &rest)
    }

    fn is_full(&self) -> bool {
        self.graph.nodes().len() > self.most_nodes
    }

    fn square(&mut self, p: &Polynomial) -> Option<NodeId> {
        let mut atoms = p.atoms();
        atoms.retain(|atom| !self.is_constant(*atom));
        atoms.sort_by_key(|atom| self.rank(*atom));
        let square = atoms.into_iter().find_map(|v| square::complete(p, v, &mut self.limit))?;
        let root = self.sum(&square.root);
        let power = self.graph.unary(Unary::Sqr, root);
        let factor = self.graph.rational(square.factor.abs());
        let product = self.graph.binary(Binary::Mul, factor, power);
        Some(self.with_rest((square.factor.is_negative(), product), &square.rest))
    }

    /// A sum, or minus one without minus signs: what is subtracted needs no operation for its sign.
    fn signed(&mut self, p: &Polynomial) -> (bool, NodeId) {
        match is_negative(p).then(|| p.scaled(&-BigRational::one())).flatten() {
            Some(positive) => (true, self.sum(&positive)),
            None => (false, self.sum(p)),
        }
    }

    /// A signed term and the rest of its sum.
    fn with_rest(&mut self, (negative, term): (bool, NodeId), rest: &Polynomial) -> NodeId {
        if rest.len() == 0 {
            return self.added(None, negative, term);
        }
        let (subtracted, rest) = self.signed(rest);
        if negative {
            let rest = self.added(None, subtracted, rest);
            return self.added(Some(rest), true, term);
        }
        self.added(Some(term), subtracted, rest)
    }

    /// The atom to be factored out of two terms or more, and its least exponent in them.
    fn best_factor(&self, p: &Polynomial) -> Option<(Atom, u32)> {
        let mut found: BTreeMap<Atom, (usize, u32)> = BTreeMap::new();
        for &(atom, n) in p.terms().flat_map(|(m, _)| m.powers()) {
            let (count, least) = found.entry(atom).or_insert((0, n));
            (*count, *least) = (*count + 1, n.min(*least));
        }
        let first = |(atom, (count, _)): &(Atom, (usize, u32))| {
            let count = if self.style.strict { 0 } else { *count };
            (self.is_constant(*atom), Reverse(count), self.rank(*atom))
        };
        let (atom, (_, least)) = found.into_iter().filter(|(_, (count, _))| *count >= 2).min_by_key(first)?;
        Some((atom, least))
    }

    /// A sum of terms that share no atom: those with the same coefficient share the product with it.
    fn leaves(&mut self, p: &Polynomial) -> NodeId {
        let mut groups: Vec<(BigRational, Vec<(&Monomial, bool)>)> = vec![];
        for (m, q) in p.terms() {
            let term = (m, q.is_negative());
            match groups.iter_mut().find(|(c, _)| !m.powers().is_empty() && *c == q.abs()) {
                Some((_, group)) => group.push(term),
                None => groups.push((q.abs(), vec![term])),
            }
        }
        let mut sum = None;
        // Constants, which stand first in a polynomial, are added last.
        for (c, group) in groups.into_iter().rev() {
            // The sign of the first term is that of the group.
            let negative = group[0].1;
            let mut inner = None;
            for (m, sign) in group {
                let product = self.product(m);
                inner = Some(self.added(inner, sign != negative, product));
            }
            let Some(inner) = inner else { continue };
            let c = self.graph.rational(c);
            let product = self.graph.binary(Binary::Mul, c, inner);
            sum = Some(self.added(sum, negative, product));
        }
        match sum {
            Some(sum) => sum,
            None => self.graph.integer(0),
        }
    }

    fn added(&mut self, sum: Option<NodeId>, negative: bool, term: NodeId) -> NodeId {
        match sum {
            None if negative => self.graph.unary(Unary::Neg, term),
            None => term,
            Some(sum) => self.graph.binary(if negative { Binary::Sub } else { Binary::Add }, sum, term),
        }
    }

    fn term(&mut self, m: &Monomial, q: &BigRational) -> NodeId {
        let (c, product) = (self.graph.rational(q.clone()), self.product(m));
        self.graph.binary(Binary::Mul, c, product)
    }

    /// The product of the powers, constants first: they are folded when the formula is compiled.
    fn product(&mut self, m: &Monomial) -> NodeId {
        if self.style.pairs
            && m.powers().len() >= 2
            && let Some(root) = m.root()
        {
            let root = self.product(&root);
            return self.graph.unary(Unary::Sqr, root);
        }
        let mut powers = m.powers().to_vec();
        powers.sort_by_key(|(atom, _)| (!self.is_constant(*atom), *atom));
        let mut product = None;
        for (atom, n) in powers {
            let power = self.power(atom, n);
            product = Some(match product {
                None => power,
                Some(product) => self.graph.binary(Binary::Mul, product, power),
            });
        }
        match product {
            Some(product) => product,
            None => self.graph.integer(1),
        }
    }

    fn power(&mut self, atom: Atom, n: u32) -> NodeId {
        let base = placed(&self.place, atom as usize);
        match i32::try_from(n) {
            Ok(n) => self.graph.powi(base, n),
            Err(_) => unreachable!("monomials have smaller exponents"),
        }
    }

    fn is_constant(&self, atom: Atom) -> bool {
        self.source.facts(NodeId(atom)).constant
    }

    /// Coordinates in the order of the style, then what is not a coordinate.
    fn rank(&self, atom: Atom) -> (usize, Atom) {
        let place = match self.source.node(NodeId(atom)) {
            Node::Axis(axis) => self.style.order.iter().position(|a| *a == axis),
            _ => None,
        };
        (place.unwrap_or(3), atom)
    }
}

/// Whether all coefficients are negative.
fn is_negative(p: &Polynomial) -> bool {
    p.terms().all(|(_, q)| q.is_negative())
}

/// `(c, p / c)` if all coefficients are c or -c, which is not 1; c has the sign of the last term.
fn content(p: &Polynomial) -> Option<(BigRational, Polynomial)> {
    let (_, c) = p.terms().next_back()?;
    let same = !c.is_one() && p.terms().all(|(_, q)| q.abs() == c.abs());
    let p = same.then(|| p.scaled(&c.recip())).flatten()?;
    Some((c.clone(), p))
}
