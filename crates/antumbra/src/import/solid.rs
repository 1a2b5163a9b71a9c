//! The same solid without sheets: for models that mean `f < 0`.
//!
//! Where a solid is cut along a face of its own, as in `max(e, -max(e, g))`, the formula is `|e|` beside that face: it touches 0
//! on a sheet that bounds nothing. The zero set contains the sheet, the solid does not. `max` reads as "and", `min` as "or",
//! minus as "not" of statements `g < 0`; what follows from statements that must hold anyway is left out:
//!
//! | in | is |
//! |---|---|
//! | `max(e, ...)` | below, `e < 0` may be assumed: there e counts as true and `-e` as false, for `-e < 0` says `e > 0` |
//! | `min(e, ...)` | below, `e >= 0` may be assumed: there e counts as false |
//!
//! So `f < 0` holds at exactly the same points as before, and f may take other values. Only formulas that are defined everywhere
//! are touched.
use crate::expr::{Binary, Formula, Graph, Node, NodeId, Unary};
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// Most visits of operations: shared parts are visited once for each way to them.
const MOST: usize = 1 << 18;
/// Deepest change between `and` and `or`; what lies below stays.
const DEEPEST: usize = 64;

/// A statement `g < 0`, or `-g < 0`: `a - b` and `b - a` are one g.
type Statement = (Subject, bool);

/// What a statement is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Subject {
    Value(NodeId),
    Difference(NodeId, NodeId),
}

/// What a part comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Outcome {
    Same,
    Holds,
    Fails,
    Other(NodeId),
}

/// A part as a statement: all of its parts, some of them, or a statement of its own.
enum View {
    All(Vec<(NodeId, bool)>),
    Any(Vec<(NodeId, bool)>),
    One(Statement),
}

struct Search {
    graph: Graph,
    /// What may be assumed of statements.
    known: HashMap<Statement, bool>,
    visits: usize,
}

/// A formula that is negative at the same points; the same one if there is nothing to gain.
pub(super) fn without_sheets(formula: &Formula) -> Formula {
    if !formula.is_continuous_everywhere() {
        return formula.clone();
    }
    let mut search = Search { graph: formula.graph().clone(), known: HashMap::new(), visits: 0 };
    match search.outcome((formula.root(), false), 0) {
        Outcome::Other(root) if search.visits <= MOST => Formula::new(search.graph, root).compacted(),
        _ => formula.clone(),
    }
}

impl Search {
    /// A part, with its sign, as a statement. Chains of one kind are flat: this is a loop, however long they are.
    fn view(&mut self, part: (NodeId, bool)) -> View {
        let (node, minus) = self.unsigned(part);
        let kind = match self.graph.node(node) {
            Node::Binary(op @ (Binary::Min | Binary::Max), ..) => (op == Binary::Max) != minus,
            _ => return View::One(self.statement(node, minus)),
        };
        let (mut parts, mut stack) = (vec![], vec![(node, minus)]);
        while let Some(part) = stack.pop() {
            self.visits += 1;
            let (node, minus) = self.unsigned(part);
            match self.graph.node(node) {
                Node::Binary(op @ (Binary::Min | Binary::Max), a, b) if ((op == Binary::Max) != minus) == kind => {
                    if self.visits <= MOST {
                        stack.extend([(b, minus), (a, minus)]);
                    }
                }
                _ => parts.push((node, minus)),
            }
        }
        if kind { View::All(parts) } else { View::Any(parts) }
    }

    fn unsigned(&self, (mut node, mut minus): (NodeId, bool)) -> (NodeId, bool) {
        while let Node::Unary(Unary::Neg, a) = self.graph.node(node) {
            (node, minus) = (a, !minus);
        }
        (node, minus)
    }

    fn statement(&self, node: NodeId, minus: bool) -> Statement {
        match self.graph.node(node) {
            Node::Binary(Binary::Sub, a, b) if a <= b => (Subject::Difference(a, b), minus),
            Node::Binary(Binary::Sub, a, b) => (Subject::Difference(b, a), !minus),
            _ => (Subject::Value(node), minus),
        }
    }

    fn outcome(&mut self, part: (NodeId, bool), depth: usize) -> Outcome {
        if self.visits > MOST || depth > DEEPEST {
            return Outcome::Same;
        }
        match self.view(part) {
            View::One(statement) => match self.known.get(&statement) {
                Some(true) => Outcome::Holds,
                Some(false) => Outcome::Fails,
                None => Outcome::Same,
            },
            View::All(parts) => self.several(parts, true, depth),
            View::Any(parts) => self.several(parts, false, depth),
        }
    }

    /// All of the parts, or any of them. Among all, one that fails decides, and one that holds drops out; among any, the other
    /// way round.
    fn several(&mut self, parts: Vec<(NodeId, bool)>, all: bool, depth: usize) -> Outcome {
        let decided = |holds: bool| if holds { Outcome::Holds } else { Outcome::Fails };
        // Statements among the parts come first; the others may rest on them.
        let mut assumed = vec![];
        let mut kept: Vec<Option<(NodeId, bool)>> = vec![];
        let mut changed = false;
        let mut end = None;
        let mut rest = vec![];
        for part in parts {
            let View::One(statement) = self.view(part) else {
                rest.push((kept.len(), part));
                kept.push(Some(part));
                continue;
            };
            match self.known.get(&statement) {
                Some(holds) if *holds == all => changed = true,
                Some(_) => {
                    end = Some(decided(!all));
                    break;
                }
                None => {
                    kept.push(Some(part));
                    let mut assume = |of: Statement, holds: bool| {
                        if let Entry::Vacant(entry) = self.known.entry(of) {
                            entry.insert(holds);
                            assumed.push(of);
                        }
                    };
                    assume(statement, all);
                    if all {
                        assume((statement.0, !statement.1), false);
                    }
                }
            }
        }
        if end.is_none() {
            for (place, part) in rest {
                match self.outcome(part, depth + 1) {
                    Outcome::Same => {}
                    Outcome::Other(node) => (kept[place], changed) = (Some((node, false)), true),
                    Outcome::Holds if all => (kept[place], changed) = (None, true),
                    Outcome::Fails if !all => (kept[place], changed) = (None, true),
                    Outcome::Holds | Outcome::Fails => {
                        end = Some(decided(!all));
                        break;
                    }
                }
            }
        }
        for statement in assumed {
            self.known.remove(&statement);
        }
        if let Some(end) = end {
            return end;
        }
        if !changed {
            return Outcome::Same;
        }
        let op = if all { Binary::Max } else { Binary::Min };
        let kept: Vec<_> = kept.into_iter().flatten().collect();
        let mut built = None;
        for (node, minus) in kept {
            let node = if minus { self.graph.unary(Unary::Neg, node) } else { node };
            built = Some(built.map_or(node, |before| self.graph.binary(op, before, node)));
        }
        built.map_or(decided(all), Outcome::Other)
    }
}
