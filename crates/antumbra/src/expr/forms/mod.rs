//! Other ways to write the polynomial parts of a formula.
//!
//! # Why they are the same real function
//! Every form is made of the formula's nodes by identities of polynomials with exact rational coefficients: sums and products
//! are multiplied out, terms are collected, squares are completed. What is not a polynomial - a root, a quotient, a sine, a number
//! such as pi - is an unknown of these polynomials, computed as before. Nothing is rounded: a coefficient that would be too long ends the attempt. When
//! a form is compiled its coefficients become the tightest intervals around their exact values, as those of any formula do.
//!
//! The domain stays too. Polynomials are defined wherever their unknowns are. If an unknown that may be undefined somewhere dropped out
//! (`0 sqrt(x)`, `ln(x) - ln(x)`), the domain would grow: such a form is not made ([`Expansion::keeps_domain`]).
//!
//! So whoever chooses among forms may choose by any rule: enclosures differ in width and in cost, never in what they enclose.
mod build;
mod expansion;
mod polynomial;
mod square;

use super::{Axis, Formula};
use build::Style;
use expansion::{Depth, Expansion};
use std::fmt;

/// How a form came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Writing {
    /// As it was written.
    Written,
    /// Common factors of sums taken out, nothing multiplied out.
    Factored,
    /// Multiplied out and written as nested products (Horner), that coordinate first.
    Horner(Axis),
    /// Squares completed, nothing multiplied out.
    Squares,
    /// Multiplied out, and squares completed.
    AllSquares,
}

impl fmt::Display for Writing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Written => "as written",
            Self::Factored => "factored",
            Self::Horner(Axis::X) => "Horner, x first",
            Self::Horner(Axis::Y) => "Horner, y first",
            Self::Horner(Axis::Z) => "Horner, z first",
            Self::Squares => "squares",
            Self::AllSquares => "expanded, squares",
        })
    }
}

/// Formulas with more operations are not rewritten.
const MOST_NODES: usize = 500;
/// Most terms of a polynomial: what has more is not multiplied out.
const MOST_TERMS: usize = 120;
/// The same, of short formulas.
const LEAST_TERMS: usize = 16;

const X: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];
const Y: [Axis; 3] = [Axis::Y, Axis::Z, Axis::X];
const Z: [Axis; 3] = [Axis::Z, Axis::X, Axis::Y];

/// Forms in a fixed order, each once; the formula itself is not among them.
pub(super) fn forms(formula: &Formula) -> Vec<(Writing, Formula)> {
    let (graph, root) = (formula.graph(), formula.root());
    let mut forms: Vec<(Writing, Formula)> = vec![];
    if graph.nodes().len() > MOST_NODES {
        return forms;
    }
    let used = graph.reachable(root);
    // A sum of so many terms takes about as many operations, if no square is completed: more than the formula has are not worth it.
    let most = graph.nodes().len().clamp(LEAST_TERMS, MOST_TERMS);
    for depth in [Depth::Sums, Depth::All] {
        let expansion = Expansion::new(graph, &used, depth, most);
        let needed = expansion.needed(root);
        if !expansion.keeps_domain(&used, &needed) {
            continue;
        }
        let mut write = |writing: Writing, style: Style| {
            if let Some((graph, root)) = build::write(graph, root, &expansion, &needed, style, most) {
                forms.push((writing, Formula::new(graph, root).compacted()));
            }
        };
        let plain = Style { order: X, strict: false, squares: false, pairs: true };
        if depth == Depth::Sums {
            write(Writing::Factored, Style { pairs: false, ..plain });
            write(Writing::Factored, plain);
            write(Writing::Squares, Style { squares: true, ..plain });
            continue;
        }
        for order in [X, Y, Z] {
            write(Writing::Horner(order[0]), Style { order, ..plain });
            write(Writing::Horner(order[0]), Style { order, strict: true, ..plain });
        }
        write(Writing::AllSquares, Style { squares: true, ..plain });
        write(Writing::AllSquares, Style { squares: true, order: Z, ..plain });
    }
    forms
}
