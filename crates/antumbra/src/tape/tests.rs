//! Random formulas: the tape computes what the graph denotes.
use super::{Op, Tape};
use crate::expr::{
    Binary, Formula, Unary,
    tests::{point::value, random::point},
};
use fastrand::Rng;
use num_traits::ToPrimitive;

/// The tape's value with constants at the middle of their enclosures.
fn run(tape: &Tape, p: [f64; 3]) -> f64 {
    let mut slots = vec![f64::NAN; tape.slots()];
    for clause in tape.clauses() {
        let (a, b) = (slots[clause.a as usize], slots[clause.b as usize]);
        slots[clause.out as usize] = match clause.op {
            Op::Constant(i) => tape.constants()[i as usize].mid(),
            Op::Axis(axis) => p[axis as usize],
            Op::Powi(n) => a.powi(n),
            Op::Unary(op) => {
                use Unary as U;
                match op {
                    U::Neg => -a,
                    U::Abs => a.abs(),
                    U::Sqr => a * a,
                    U::Sqrt => a.sqrt(),
                    U::Sin => a.sin(),
                    U::Cos => a.cos(),
                    U::Exp => a.exp(),
                    _ => panic!("not in the formulas of this test"),
                }
            }
            Op::Binary(op) => {
                use Binary as B;
                match op {
                    B::Add => a + b,
                    B::Sub => a - b,
                    B::Mul => a * b,
                    B::Div => a / b,
                    B::Min => a.min(b),
                    B::Max => a.max(b),
                    B::Pow => a.powf(b),
                    B::Atan2 => a.atan2(b),
                }
            }
        };
    }
    slots[tape.clauses().last().unwrap().out as usize]
}

#[test]
fn tapes_compute_the_formula() {
    let mut random = Rng::with_seed(7);
    let mut shared = 0;
    for _ in 0..3000 {
        let mut parts: Vec<String> = ["x", "y", "z", "0.1", "2", "(1/3)"].map(String::from).to_vec();
        for _ in 0..random.usize(1..14) {
            let mut pick = || {
                let back = random.usize(..parts.len()).min(random.usize(..parts.len()));
                parts[parts.len() - 1 - back].clone()
            };
            let (a, b) = (pick(), pick());
            parts.push(match random.u32(..8) {
                0 => format!("sin({a})"),
                1 => format!("min({a}, {b})"),
                2 => format!("({a})^3"),
                3 => format!("({a})*({b})"),
                4 => format!("abs({a})"),
                _ => format!("({a}) {} ({b})", ["+", "-"][random.usize(..2)]),
            });
        }
        let text = parts.pop().unwrap();
        if text.len() > 4000 {
            continue;
        }
        let formula = Formula::parse(&text).unwrap();
        let tape = Tape::compile(&formula).unwrap();
        assert!(tape.is_continuous_everywhere(), "{text}");
        assert!(tape.slots() <= tape.clauses().len());
        shared += usize::from(tape.slots() < tape.clauses().len());
        // With the constants fixed to points the tape is a valid one for `from_clauses` too.
        assert!(Tape::from_clauses(tape.clauses().to_vec(), tape.constants().to_vec()).is_ok());
        // The middle of a wide constant is not its value.
        if !tape.constants().iter().all(|c| c.width() < 1e-9) {
            continue;
        }
        let p = point(&mut random);
        let wanted = value(&formula, &p);
        let (Some(wanted), got) = (wanted.float(), run(&tape, p.clone().map(|c| c.to_f64().unwrap()))) else {
            continue;
        };
        assert!((wanted - got).abs() <= 1e-6 * (1.0 + wanted.abs()), "{text}\n{wanted} {got}");
    }
    assert!(shared > 1000, "{shared}");
}
