//! Formula -> tape: order of operations, constants, slots.
use super::{Clause, MAX_CLAUSES, Op, Tape, TapeError, constant};
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

        let mut last_use = vec![0_usize; root.index() + 1];
        for (i, id) in order.iter().enumerate() {
            last_use[id.index()] = i;
            for child in operands(graph, *id, &folded) {
                last_use[child.index()] = i;
            }
        }

        let mut constants: Vec<Interval> = vec![];
        let mut place: HashMap<[u64; 2], u32> = HashMap::new();
        let mut slot_of = vec![0_u32; root.index() + 1];
        let mut free: Vec<u32> = vec![];
        let mut slots = 0_u32;
        let mut clauses = Vec::with_capacity(order.len());
        for (i, &id) in order.iter().enumerate() {
            let op = match (folded[id.index()], graph.node(id)) {
                (Some(value), _) => {
                    let bits = [value.lo().to_bits(), value.hi().to_bits()];
                    Op::Constant(*place.entry(bits).or_insert_with(|| {
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
            let children: Vec<NodeId> = operands(graph, id, &folded).collect();
            let slot = |k: usize| children.get(k).map_or(0, |c| slot_of[c.index()]);
            let (a, b) = (slot(0), slot(1));
            // An operand that dies here gives its slot to the result; twice the same operand gives it once.
            for (k, child) in children.iter().enumerate() {
                if last_use[child.index()] == i && !children[..k].contains(child) {
                    free.push(slot_of[child.index()]);
                }
            }
            let out = free.pop().unwrap_or_else(|| {
                slots += 1;
                slots - 1
            });
            slot_of[id.index()] = out;
            clauses.push(Clause { op, out, a, b });
        }
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
