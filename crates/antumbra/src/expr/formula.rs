//! The formula as a value: a graph and its root.
use super::{
    Axis, Binary, Derivative, Error, ErrorKind, Graph, MAX_SOURCE, Node, NodeId, Surface, Unary, Writing,
    derivative::derivative, forms, lower::lower, print, statement, surface::zero_set,
};
use num_traits::Zero;
use std::{fmt, ops::Range};

/// The real function that a formula denotes, exactly.
///
/// Equality is structural: the same operations on the same constants in the same order.
#[derive(Clone)]
pub struct Formula {
    graph: Graph,
    root: NodeId,
}

impl Formula {
    /// Reads a formula in the language described at [`crate::expr`], and simplifies it (same function, same domain).
    ///
    /// # Errors
    /// Says what is wrong, where, and what to do: see [`Error`]. Never panics, whatever the text.
    ///
    /// Cost: linear in the length of the text, apart from the expansion of functions and transforms, which is capped.
    pub fn parse(source: &str) -> Result<Self, Error> {
        // Simplified afterwards, not on the way: what `a^b` means depends on whether b is an integer constant *as written*.
        let (written, equation) = Self::read(source)?;
        let simple = written.simplify();
        if simple.divides_by_zero() {
            let message = "a divisor is 0 everywhere";
            return Err(Error::new(source, ErrorKind::DivisionByZero, equation, message)
                .with_help("the formula would be defined nowhere"));
        }
        Ok(simple)
    }

    /// As [`parse`](Self::parse), without the simplification: the operations as they were written.
    ///
    /// # Errors
    /// As `parse`.
    pub fn parse_as_written(source: &str) -> Result<Self, Error> {
        Ok(Self::read(source)?.0)
    }

    /// The definitions of a formula, and its equation as one expression in parentheses, so that it can be put into calls: a
    /// text made of the first and of `max(second, z)` means the formula's solid below `z = 0`.
    ///
    /// # Errors
    /// As [`parse`](Self::parse), but only where the words themselves are wrong.
    pub fn split(source: &str) -> Result<[String; 2], Error> {
        statement::split_text(source)
    }

    /// The formula as written, and the place of its equation.
    fn read(source: &str) -> Result<(Self, Range<usize>), Error> {
        if source.len() > MAX_SOURCE {
            let message = format!("the formula has {} bytes; the most is {MAX_SOURCE}", source.len());
            return Err(Error::new(source, ErrorKind::TooLarge, 0..0, message));
        }
        let program = statement::read(source)?;
        let (graph, root) = lower(source, &program)?;
        Ok((Self { graph, root }.compacted(), program.tree.span(program.equation.root)))
    }

    /// A quotient by the exact constant 0: every operator is undefined where an operand is, so the whole formula is nowhere
    /// defined.
    pub(crate) fn divides_by_zero(&self) -> bool {
        let zero = |id: NodeId| self.graph.exact(id).is_some_and(Zero::is_zero);
        self.graph.nodes().iter().any(|node| match *node {
            Node::Binary(Binary::Div, _, b) => zero(b),
            Node::Powi(a, n) => n < 0 && zero(a),
            _ => false,
        })
    }

    pub(crate) fn new(graph: Graph, root: NodeId) -> Self {
        Self { graph, root }
    }

    /// Whether the formula depends on a coordinate, as written.
    #[must_use]
    pub fn uses(&self, axis: Axis) -> bool {
        let used = self.graph.reachable(self.root);
        self.graph.nodes().iter().zip(used).any(|(node, used)| used && *node == Node::Axis(axis))
    }

    /// The operations; all of them are used by the root unless said otherwise.
    #[must_use]
    pub fn graph(&self) -> &Graph {
        &self.graph
    }

    /// The operation whose value is the formula's.
    #[must_use]
    pub fn root(&self) -> NodeId {
        self.root
    }

    /// The same function on the same domain, with the rules of `rules.rs` applied from the leaves to the root.
    #[must_use]
    pub fn simplify(&self) -> Self {
        self.rebuilt(true).compacted()
    }

    /// The same function with `g^4`, `g^8`, `g^16` as repeated squares: these are shared with other powers of g, and their
    /// enclosures are cheap. Done last, before compiling; the simplifier would turn squares back into powers.
    #[must_use]
    pub fn repeated_squares(&self) -> Self {
        let mut graph = Graph::new(false);
        let used = self.graph.reachable(self.root);
        let mut place = vec![NodeId(0); used.len()];
        for i in (0..used.len()).filter(|&i| used[i]) {
            place[i] = match self.graph.node(NodeId(i as u32)) {
                Node::Powi(a, n @ (4 | 8 | 16)) => {
                    (0..n.ilog2()).fold(place[a.index()], |square, _| graph.unary(Unary::Sqr, square))
                }
                _ => graph.copy(&self.graph, NodeId(i as u32), |id| place[id.index()]),
            };
        }
        Self { root: place[self.root.index()], graph }
    }

    /// The same function on the same domain, written in other ways: see [`Writing`]. In a fixed order; some may be equal, or equal to this one. None for
    /// formulas of more than 500 operations.
    ///
    /// Cost: a millisecond or two for formulas of some dozens of operations, ten times that at most: what would become too long is not
    /// multiplied out.
    #[must_use]
    pub fn forms(&self) -> Vec<(Writing, Self)> {
        forms::forms(self)
    }

    /// Without operations that the root does not use.
    pub(crate) fn compacted(self) -> Self {
        let all = self.root.index() + 1 == self.graph.nodes().len();
        if all && self.graph.reachable(self.root).iter().all(|&used| used) { self } else { self.rebuilt(false) }
    }

    fn rebuilt(&self, simplifying: bool) -> Self {
        let mut graph = Graph::new(simplifying);
        let used = self.graph.reachable(self.root);
        let mut place = vec![NodeId(0); used.len()];
        for i in (0..used.len()).filter(|&i| used[i]) {
            place[i] = graph.copy(&self.graph, NodeId(i as u32), |id| place[id.index()]);
        }
        Self { root: place[self.root.index()], graph }
    }

    /// A simpler formula with the same zero set, and what was done to get it.
    #[must_use]
    pub fn surface(&self) -> Surface {
        zero_set(self)
    }

    /// The partial derivative along an axis: see [`Derivative`] for where it holds.
    #[must_use]
    pub fn derivative(&self, axis: Axis) -> Derivative {
        derivative(self, axis)
    }

    /// Proved to be defined and continuous at every point of space; `false` means "not proved".
    /// A tape, which encloses the constants, may prove it where their form alone does not.
    #[must_use]
    pub fn is_continuous_everywhere(&self) -> bool {
        self.graph.facts(self.root).continuous
    }

    /// Whether both are the same operations on the same operands, shared or not.
    #[must_use]
    pub fn same_as(&self, other: &Self) -> bool {
        // Copying both into one graph that shares equal operations makes equal formulas one node.
        let mut graph = Graph::new(false);
        let mut roots = [self, other].map(|formula| {
            let used = formula.graph.reachable(formula.root);
            let mut place = vec![NodeId(0); used.len()];
            for i in (0..used.len()).filter(|&i| used[i]) {
                place[i] = graph.copy(&formula.graph, NodeId(i as u32), |id| place[id.index()]);
            }
            place[formula.root.index()]
        });
        let [a, b] = &mut roots;
        a == b
    }
}

impl PartialEq for Formula {
    fn eq(&self, other: &Self) -> bool {
        self.same_as(other)
    }
}

/// Text that [`Formula::parse_as_written`] reads as the same formula, unless it divides by the constant 0. Large shared parts are written once, as definitions.
impl fmt::Display for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        print::print(&self.graph, self.root, f)
    }
}

impl fmt::Debug for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Formula({self})")
    }
}
