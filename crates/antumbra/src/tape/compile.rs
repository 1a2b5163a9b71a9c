//! Formula -> tape: order of operations, constants, slots.
use super::slots::{Step, allot};
use super::{MAX_CLAUSES, Op, Tape, TapeError, constant};
use crate::expr::{Facts, Formula, Graph, Node, NodeId, facts_given};
use antumbra_interval::Interval;
use std::collections::HashMap;

impl Tape {
    /// Flattens a formula; equal operations are done once. It is compiled as it is: simplify or take
    /// [`Formula::surface`] before, if that is wanted.
    ///
    /// Constants are enclosed by the tightest intervals of their exact values; constant parts that are proved to be defined
    /// are evaluated here, once, by interval arithmetic. A slot is used again as soon as its value is no longer needed.
    ///
    /// # Errors
    /// [`TapeError::TooLong`].
    pub fn compile(formula: &Formula) -> Result<Self, TapeError> {
        let (graph, root) = (formula.graph(), formula.root());
        let used = graph.reachable(root);
        let folded = constant::fold(graph, &used);
        // A folded constant is proved to be defined, and its enclosure tells its sign.
        let known = |id: NodeId| {
            folded[id.index()].map(|value| Facts {
                exact: None,
                total: true,
                continuous: true,
                nonnegative: value.lo() >= 0.0,
                nonzero: !value.possibly_zero(),
                constant: true,
            })
        };
        let continuous = facts_given(graph, &used, known)[root.index()].continuous;
        let order = order(graph, root, &folded)?;

        let mut constants: Vec<Interval> = vec![];
        let mut place_of_constant: HashMap<[u64; 2], u32> = HashMap::new();
        let mut place = vec![0_u32; root.index() + 1];
        let mut steps = Vec::with_capacity(order.len());
        for (i, &id) in order.iter().enumerate() {
            let op = match (folded[id.index()], graph.node(id)) {
                (Some(value), _) => {
                    let bits = [value.lo().to_bits(), value.hi().to_bits()];
                    Op::Constant(*place_of_constant.entry(bits).or_insert_with(|| {
                        constants.push(value);
                        constants.len() as u32 - 1
                    }))
                }
                (None, Node::Axis(axis)) => Op::Axis(axis),
                (None, Node::Unary(op, _)) => Op::Unary(op),
                (None, Node::Powi(_, n)) => Op::Powi(n),
                (None, Node::Binary(op, ..)) => Op::Binary(op),
                (None, Node::Rational(_) | Node::Pi | Node::E) => unreachable!("these constants are always folded"),
            };
            let mut children = operands(graph, id, &folded).map(|child| place[child.index()]);
            let (a, b) = (children.next().unwrap_or(0), children.next().unwrap_or(0));
            place[id.index()] = i as u32;
            steps.push(Step { op, a, b });
        }
        let clauses = allot(&steps);
        Self::checked(clauses, constants, continuous)
    }
}

/// What the tape's clause for a node reads: nothing, if the node is folded.
fn operands<'a>(
    graph: &'a Graph,
    id: NodeId,
    folded: &[Option<Interval>],
) -> impl DoubleEndedIterator<Item = NodeId> + 'a {
    let folded = folded[id.index()].is_some();
    graph.node(id).children().filter(move |_| !folded)
}

/// Nodes in the order of a depth-first walk, children before parents: values are used soon after they are made, so that few
/// are alive at a time.
fn order(graph: &Graph, root: NodeId, folded: &[Option<Interval>]) -> Result<Vec<NodeId>, TapeError> {
    let mut done = vec![false; root.index() + 1];
    let mut order = vec![];
    let mut stack = vec![(root, false)];
    while let Some((id, children_done)) = stack.pop() {
        if done[id.index()] {
            continue;
        }
        if children_done {
            done[id.index()] = true;
            order.push(id);
        } else {
            stack.push((id, true));
            stack.extend(operands(graph, id, folded).rev().map(|child| (child, false)));
        }
    }
    if order.len() > MAX_CLAUSES { Err(TapeError::TooLong { clauses: order.len() }) } else { Ok(order) }
}
