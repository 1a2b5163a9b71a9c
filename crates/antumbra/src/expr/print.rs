//! Graph -> text that reads back as the same graph. A loop with its own stack: depth does not matter.
use super::{Axis, Binary, Graph, Node, NodeId, Unary};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Pow, Signed, Zero};
use std::{collections::HashMap, fmt};

/// Up to this many operations a formula is written without definitions, shared parts again and again.
const MAX_INLINE: u64 = 2000;

/// How tightly a text holds together, as in the grammar.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Tightness {
    Sum,
    Product,
    Signed,
    Power,
    Atom,
}

enum Piece {
    Text(&'static str),
    Exponent(i32),
    Node(NodeId, Tightness),
}

pub(crate) fn print(graph: &Graph, root: NodeId, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    let used = graph.reachable(root);
    let mut uses = vec![0_u32; used.len()];
    let mut sizes = vec![0_u64; used.len()];
    for i in (0..used.len()).filter(|&i| used[i]) {
        sizes[i] = 1;
        for child in graph.nodes()[i].children() {
            uses[child.index()] += 1;
            sizes[i] = sizes[i].saturating_add(sizes[child.index()]);
        }
    }
    let mut names: HashMap<NodeId, usize> = HashMap::new();
    if sizes[root.index()] > MAX_INLINE {
        for i in (0..used.len()).filter(|&i| used[i] && uses[i] > 1 && sizes[i] > 3) {
            let id = NodeId(i as u32);
            write!(f, "t{} = ", names.len() + 1)?;
            write_tree(graph, id, &names, f)?;
            f.write_str("; ")?;
            names.insert(id, names.len() + 1);
        }
    }
    write_tree(graph, root, &names, f)
}

fn write_tree(graph: &Graph, root: NodeId, names: &HashMap<NodeId, usize>, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    let mut stack = vec![Piece::Node(root, Tightness::Sum)];
    while let Some(piece) = stack.pop() {
        let (id, least) = match piece {
            Piece::Text(text) => {
                f.write_str(text)?;
                continue;
            }
            Piece::Exponent(n) => {
                write!(f, "^{n}")?;
                continue;
            }
            Piece::Node(id, least) => (id, least),
        };
        if let Some(name) = names.get(&id) {
            write!(f, "t{name}")?;
            continue;
        }
        let node = graph.node(id);
        if let Node::Rational(i) = node {
            write_rational(graph.rational_at(i), least, f)?;
            continue;
        }
        let (own, pieces) = pieces(graph, node);
        let wrapped = own < least;
        if wrapped {
            f.write_str("(")?;
            stack.push(Piece::Text(")"));
        }
        stack.extend(pieces.into_iter().rev());
    }
    Ok(())
}

/// An operation's text, and how tightly it holds.
fn pieces(graph: &Graph, node: Node) -> (Tightness, Vec<Piece>) {
    use Piece::{Node as N, Text as T};
    use Tightness::{Atom, Power, Product, Signed, Sum};
    match node {
        Node::Rational(_) => (Atom, vec![]),
        Node::Pi => (Atom, vec![T("pi")]),
        Node::E => (Atom, vec![T("e")]),
        Node::Axis(Axis::X) => (Atom, vec![T("x")]),
        Node::Axis(Axis::Y) => (Atom, vec![T("y")]),
        Node::Axis(Axis::Z) => (Atom, vec![T("z")]),
        Node::Unary(Unary::Neg, a) => (Signed, vec![T("-"), N(a, Power)]),
        Node::Unary(Unary::Sqr, a) => (Power, vec![N(a, Atom), T("^2")]),
        Node::Powi(a, n) => (Power, vec![N(a, Atom), Piece::Exponent(n)]),
        Node::Unary(op, a) => (Atom, vec![T(name(op)), T("("), N(a, Sum), T(")")]),
        Node::Binary(Binary::Add, a, b) => (Sum, vec![N(a, Sum), T(" + "), N(b, Product)]),
        Node::Binary(Binary::Sub, a, b) => (Sum, vec![N(a, Sum), T(" - "), N(b, Product)]),
        Node::Binary(Binary::Mul, a, b) => (Product, vec![N(a, Product), T("*"), N(b, Signed)]),
        Node::Binary(Binary::Div, a, b) => (Product, vec![N(a, Product), T("/"), N(b, Signed)]),
        Node::Binary(Binary::Pow, a, b) if graph.exact(b).is_none_or(|q| !q.is_integer()) => {
            (Power, vec![N(a, Atom), T("^"), N(b, Power)])
        }
        Node::Binary(op, a, b) => {
            let name = match op {
                Binary::Min => "min(",
                Binary::Max => "max(",
                Binary::Atan2 => "atan2(",
                _ => "powr(",
            };
            (Atom, vec![T(name), N(a, Sum), T(", "), N(b, Sum), T(")")])
        }
    }
}

fn name(op: Unary) -> &'static str {
    match op {
        Unary::Neg => "-",
        Unary::Abs => "abs",
        Unary::Sign => "sign",
        Unary::Floor => "floor",
        Unary::Sqr => "^2",
        Unary::Sqrt => "sqrt",
        Unary::Cbrt => "cbrt",
        Unary::Exp => "exp",
        Unary::Ln => "ln",
        Unary::Sin => "sin",
        Unary::Cos => "cos",
        Unary::Tan => "tan",
        Unary::Asin => "asin",
        Unary::Acos => "acos",
        Unary::Atan => "atan",
        Unary::Sinh => "sinh",
        Unary::Cosh => "cosh",
        Unary::Tanh => "tanh",
    }
}

/// A decimal where the value is one, else a fraction: `0.25`, `-3`, `1e-30`, `1/3`.
fn write_rational(q: &BigRational, least: Tightness, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    let (text, own) = match decimal(&q.abs()) {
        Some(text) if q.is_negative() => (format!("-{text}"), Tightness::Signed),
        Some(text) => (text, Tightness::Atom),
        None => (format!("{}/{}", q.numer(), q.denom()), Tightness::Product),
    };
    if own < least { write!(f, "({text})") } else { f.write_str(&text) }
}

/// Most places of a number that the language reads: 2000 digits and an exponent of -400.
const MOST_PLACES: u32 = 2400;
/// Up to so many places a number is written without an exponent.
const PLAIN_PLACES: usize = 20;
/// Smallest exponent that the language reads, negated.
const MOST_EXPONENT: usize = 400;

/// The decimal that equals `q >= 0`. Every constant that was written in a text has one, so that it is read as a constant
/// again, and not as a quotient.
fn decimal(q: &BigRational) -> Option<String> {
    if q.is_integer() {
        return Some(q.numer().to_string());
    }
    // The places needed are the larger exponent of 2 and 5 in the denominator.
    let (mut rest, mut places) = (q.denom().clone(), [0_u32; 2]);
    for (prime, count) in [BigInt::from(2), BigInt::from(5)].iter().zip(&mut places) {
        while *count <= MOST_PLACES && (&rest % prime).is_zero() {
            rest /= prime;
            *count += 1;
        }
    }
    let places = places[0].max(places[1]);
    if !rest.is_one() || places > MOST_PLACES {
        return None;
    }
    let digits = (q * BigRational::from_integer(Pow::pow(BigInt::from(10), places))).to_integer().to_string();
    let places = places as usize;
    if places <= PLAIN_PLACES {
        let digits = format!("{digits:0>width$}", width = places + 1);
        let (whole, fraction) = digits.split_at(digits.len() - places);
        return Some(format!("{whole}.{fraction}"));
    }
    if places <= MOST_EXPONENT {
        return Some(format!("{digits}e-{places}"));
    }
    let fraction = places - MOST_EXPONENT;
    let digits = format!("{digits:0>fraction$}");
    let (whole, fraction) = digits.split_at(digits.len() - fraction);
    Some(format!("{whole}.{fraction}e-{MOST_EXPONENT}"))
}
