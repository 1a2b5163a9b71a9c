//! Tapes from arbitrary clauses, and from formulas.
use crate::input::Input;
use crate::truth::Truth;
use antumbra::eval::{Gradient, Number, run, value_at};
use antumbra::expr::{Axis, Binary, Formula, Node, Unary};
use antumbra::geom::Vec3;
use antumbra::tape::{Clause, Op, Tape};
use antumbra_interval::affine::Affine;
use antumbra_interval::{Decorated, Interval};

/// Clauses that read what nobody wrote are refused, all others run; a compiled formula computes what its graph denotes.
pub fn tape(bytes: &[u8]) {
    let mut input = Input::new(bytes);
    if input.below(2) == 0 { clauses(&mut input) } else { compiled(&mut input) }
}

fn clauses(input: &mut Input<'_>) {
    let constants: Vec<Interval> = (0..input.below(4)).map(|_| input.interval()).collect();
    let mut list = vec![];
    let length = input.below(24);
    for _ in 0..length {
        let mut slot = || {
            // Mostly small, so that some tapes are right.
            match input.below(8) {
                0 => input.below(usize::MAX) as u32,
                _ => input.below(4) as u32,
            }
        };
        let (out, a, b) = (slot(), slot(), slot());
        let op = match input.below(8) {
            0 => Op::Constant(slot_of_constant(input)),
            1..4 => Op::Axis(input.pick(&[Axis::X, Axis::Y, Axis::Z])),
            4 => Op::Powi(input.below(usize::MAX) as i32),
            5 => Op::Unary(input.pick(&Unary::ALL)),
            _ => Op::Binary(input.pick(&Binary::ALL)),
        };
        list.push(Clause { op, out, a, b });
    }
    let valid = is_valid(&list, constants.len());
    let tape = Tape::from_clauses(list.clone(), constants);
    assert_eq!(tape.is_ok(), valid, "{list:?}: {tape:?}");
    let Ok(tape) = tape else { return };
    let x: [Interval; 3] = std::array::from_fn(|_| input.interval());
    let point = x.map(|x| input.member(x));
    let _ = value_at(&tape, Vec3::new(point[0], point[1], point[2]), &mut vec![]);
    let range = run(&tape, x, &mut vec![]);
    let truth = Truth::at(&tape, point);
    assert!(truth.possibly_in(range), "{range} over {x:?}, {truth:?} at {point:?}: {tape:?}");
    assert!(!range.lo().is_nan() && !range.hi().is_nan(), "{range:?} over {x:?}: {tape:?}");
    let _ = run(&tape, Gradient::coordinates(x), &mut vec![]);
    let _ = run(&tape, [Affine::<3>::UNKNOWN; 3], &mut vec![]);
}

fn slot_of_constant(input: &mut Input<'_>) -> u32 {
    input.below(5) as u32
}

/// The rules of a tape, written down once more.
fn is_valid(clauses: &[Clause], constants: usize) -> bool {
    let mut written = std::collections::HashSet::new();
    for clause in clauses {
        if clause.operands().any(|slot| !written.contains(&slot)) || clause.out as usize >= clauses.len() {
            return false;
        }
        if let Op::Constant(k) = clause.op
            && k as usize >= constants
        {
            return false;
        }
        written.insert(clause.out);
    }
    !clauses.is_empty()
}

/// A formula with every operator of the graph, compiled and run against the graph itself.
fn compiled(input: &mut Input<'_>) {
    const FUNCTIONS: [&str; 18] = [
        "-", "abs", "sign", "floor", "sqrt", "cbrt", "exp", "ln", "sin", "cos", "tan", "asin", "acos", "atan", "sinh",
        "cosh", "tanh", "",
    ];
    // Definitions keep the text short and the graph shared.
    let mut text = String::new();
    let mut names: Vec<String> = ["x", "y", "z", "0.1", "2", "pi", "e", "(1/3)", "1e-310"].map(String::from).to_vec();
    let operations = 1 + input.below(20);
    for i in 0..operations {
        let pick = |input: &mut Input<'_>| {
            if input.below(2) == 0 {
                &names[input.below(names.len())]
            } else {
                &names[names.len() - 1 - input.below(3)]
            }
        };
        let (a, b) = (pick(input), pick(input));
        let value = match input.below(5) {
            0 => format!("{}({a})", input.pick(&FUNCTIONS)),
            1 => format!("({a})^({})", input.pick(&["-3", "-1", "2", "3", "4", "9", "0.5"])),
            2 => format!("{}({a}, {b})", input.pick(&["min", "max", "atan2", "powr"])),
            _ => format!("({a}) {} ({b})", input.pick(&["+", "-", "*", "/"])),
        };
        text += &format!("v{i} = {value}; ");
        names.push(format!("v{i}"));
    }
    text += names.last().expect("a name");
    let Ok(formula) = Formula::parse_as_written(&text) else { return };
    let tape = Tape::compile(&formula).expect("a short formula");
    assert!(tape.slots() <= tape.clauses().len());
    assert!(Tape::from_clauses(tape.clauses().to_vec(), tape.constants().to_vec()).is_ok(), "{text}");
    let x: [Interval; 3] =
        std::array::from_fn(|_| if input.below(2) == 0 { input.interval() } else { input.ordinary() });
    let point = x.map(|x| Interval::point(input.member(x)));
    for place in [x, point] {
        let (got, expected) = (run(&tape, place.map(Decorated::from), &mut vec![]), graph(&formula, place));
        // Both enclose the same values; a folded constant is narrower than what the graph's operations give.
        let contradiction = (got.interval.is_empty() && expected.certainly_defined())
            || (expected.interval.is_empty() && got.certainly_defined());
        let apart = got.certainly_defined()
            && expected.certainly_defined()
            && !got.interval.possibly_intersects(expected.interval);
        assert!(!contradiction && !apart, "{text} over {place:?}: tape {got:?}, graph {expected:?}");
        if tape.is_continuous_everywhere() {
            assert!(!expected.interval.is_empty(), "{text} is continuous everywhere, but undefined over {place:?}");
        }
    }
}

/// The graph run node by node, without slots and without folding.
fn graph(formula: &Formula, x: [Interval; 3]) -> Decorated {
    let graph = formula.graph();
    let mut values: Vec<Decorated> = vec![];
    for (i, node) in graph.nodes().iter().enumerate() {
        let at = |id: antumbra::expr::NodeId| values[id.index()];
        let value = match *node {
            Node::Rational(_) => {
                let q = graph.exact(graph.id(i)).expect("a rational node has its value");
                Decorated::from(crate::truth::around(q))
            }
            Node::Pi => Decorated::from(Interval::PI),
            Node::E => Decorated::from(Interval::ONE.exp()),
            Node::Axis(axis) => Decorated::from(x[axis as usize]),
            Node::Unary(op, a) => at(a).unary(op),
            Node::Powi(a, n) => at(a).powi(n),
            Node::Binary(op, a, b) => at(a).binary(op, at(b)),
        };
        values.push(value);
    }
    values[formula.root().index()]
}
