//! Compiled formulas and hand-made tapes.
use antumbra::{
    expr::{Axis, Binary, Formula, Unary},
    tape::{Clause, MAX_CLAUSES, Op, Tape, TapeError},
};
use antumbra_interval::Interval;

fn compile(text: &str) -> Tape {
    Tape::compile(&Formula::parse(text).unwrap_or_else(|e| panic!("{}", e.render(text)))).unwrap()
}

#[test]
fn a_small_formula_clause_by_clause() {
    let tape = compile("x*y + 0.5");
    let clause = |op, out, a, b| Clause { op, out, a, b };
    assert_eq!(
        tape.clauses(),
        [
            clause(Op::Axis(Axis::X), 0, 0, 0),
            clause(Op::Axis(Axis::Y), 1, 0, 0),
            clause(Op::Binary(Binary::Mul), 1, 0, 1),
            clause(Op::Constant(0), 0, 0, 0),
            clause(Op::Binary(Binary::Add), 0, 1, 0),
        ]
    );
    assert_eq!((tape.constants(), tape.slots()), (&[Interval::point(0.5)][..], 2));
}

#[test]
fn constants_are_the_tightest_and_stored_once() {
    let constants = |text: &str| compile(text).constants().to_vec();
    assert_eq!(constants("x + 0.1"), [Interval::new(0.1_f64.next_down(), 0.1)]);
    assert_eq!(constants("x + 0.1 + (0.3 - 0.2)"), [Interval::new(0.1_f64.next_down(), 0.1)]);
    assert_eq!(constants("x + pi"), [Interval::new(std::f64::consts::PI, std::f64::consts::PI.next_up())]);
    assert_eq!(constants("x + 1e400"), [Interval::new(f64::MAX, f64::INFINITY)]);
    assert_eq!(constants("x + 1/3").len(), 1);
    let third = constants("x + 1/3")[0];
    assert_eq!(third.lo().next_up(), third.hi());
    assert!(third.contains(1.0 / 3.0));
}

#[test]
fn equal_operations_are_done_once_and_slots_are_used_again() {
    let tape = compile("(x + y)^2 + sin(x + y) + cos(y + x)");
    assert_eq!(tape.clauses().iter().filter(|c| c.op == Op::Binary(Binary::Add)).count(), 3);
    let long: Vec<String> = (1..200).map(|k| format!("sin({k}x)")).collect();
    let tape = compile(&long.join(" + "));
    assert!(tape.clauses().len() > 500 && tape.slots() <= 4, "{}", tape.slots());
}

#[test]
fn continuity_is_proved_before_evaluation() {
    for text in [
        "x^4 + y^4 - 1",
        "sphere(1)",
        "torus(1, 0.2)",
        "sin(x)/(2 + cos(y)^2)",
        "ln(1 + x^2)",
        "x/pi",
        "exp(x)^-1",
        "cosh(x)^y",
        "atan2(y, 1 + x^2)",
        "x*sqrt(pi - 3)",
        "x*ln(0.1)",
        "x*asin(0.3)",
        "x/3 + floor(2.5)",
    ] {
        assert!(compile(text).is_continuous_everywhere(), "{text}");
    }
    for text in [
        "1/x",
        "sqrt(x)",
        "ln(x)",
        "tan(x)",
        "floor(x)",
        "sign(x)",
        "x^-1",
        "x^y",
        "x^0.5",
        "asin(x)",
        "atan2(y, x)",
        "x + sqrt(3 - pi)",
        "x + ln(-2)",
        "x + asin(2)",
        "x*sqrt(-1)",
        "mod(x, 2)",
        "x/(pi - pi)",
    ] {
        assert!(!compile_or_nothing(text), "{text}");
    }
}

/// Whether there is a tape that claims continuity.
fn compile_or_nothing(text: &str) -> bool {
    Formula::parse(text).is_ok_and(|f| Tape::compile(&f).unwrap().is_continuous_everywhere())
}

#[test]
fn a_constant_that_may_be_undefined_keeps_its_operations() {
    for (text, op) in [
        ("x + sqrt(3 - pi)", Op::Unary(Unary::Sqrt)),
        ("x + sqrt(-2)", Op::Unary(Unary::Sqrt)),
        ("x + ln(3 - pi)", Op::Unary(Unary::Ln)),
        ("x + asin(pi)", Op::Unary(Unary::Asin)),
        ("x + (-2)^pi", Op::Binary(Binary::Pow)),
    ] {
        assert!(compile(text).clauses().iter().any(|c| c.op == op), "{text}");
    }
    assert!(compile("x + sqrt(pi)").clauses().iter().all(|c| c.op != Op::Unary(Unary::Sqrt)));
}

#[test]
fn hand_made_tapes_are_checked() {
    let clause = |op, out, a, b| Clause { op, out, a, b };
    let x = clause(Op::Axis(Axis::X), 0, 0, 0);
    let build = |clauses: Vec<Clause>| Tape::from_clauses(clauses, vec![Interval::ONE]);
    let add = |out, a, b| clause(Op::Binary(Binary::Add), out, a, b);
    assert_eq!(build(vec![]).unwrap_err(), TapeError::Empty);
    assert_eq!(build(vec![x, add(0, 0, 1)]).unwrap_err(), TapeError::UnwrittenSlot { clause: 1, slot: 1 });
    assert_eq!(build(vec![add(0, 0, 0)]).unwrap_err(), TapeError::UnwrittenSlot { clause: 0, slot: 0 });
    assert_eq!(build(vec![x, add(2, 0, 0)]).unwrap_err(), TapeError::SlotTooLarge { clause: 1, slot: 2 });
    assert_eq!(
        build(vec![clause(Op::Constant(1), 0, 0, 0)]).unwrap_err(),
        TapeError::NoConstant { clause: 0, constant: 1 }
    );
    assert_eq!(build(vec![x; MAX_CLAUSES + 1]).unwrap_err(), TapeError::TooLong { clauses: MAX_CLAUSES + 1 });
    let tape = build(vec![x, clause(Op::Constant(0), 1, 0, 0), add(1, 0, 1)]).unwrap();
    assert_eq!((tape.slots(), tape.is_continuous_everywhere()), (2, true));
    assert!(!build(vec![x, clause(Op::Powi(-1), 0, 0, 0)]).unwrap().is_continuous_everywhere());
    assert!(!build(vec![x, clause(Op::Unary(Unary::Ln), 0, 0, 0)]).unwrap().is_continuous_everywhere());
}
