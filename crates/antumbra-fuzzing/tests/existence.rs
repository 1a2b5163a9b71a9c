//! A change of sign proves a root only of a function that is defined and continuous in between: the operators that are not
//! so everywhere, one inside the other, with every claim attacked, and the claims that must be made.
use antumbra::eval::run;
use antumbra::expr::Formula;
use antumbra::tape::Tape;
use antumbra_fuzzing::attack_continuity;
use antumbra_interval::{Decorated, Interval};

const INSIDE: &[&str] = &["x", "x^2 - 1/2", "x*y - 1/4", "sin(3x)", "floor(2x)/2", "2x + y", "1 - x", "abs(x) - y"];
const OUTSIDE: &[&str] = &[
    "1/(G)",
    "(G)/abs(G)",
    "y/(G)",
    "sqrt(G)",
    "sqrt(abs(G))",
    "ln(G)",
    "ln(1 + (G)^2)",
    "tan(G)",
    "tan((G)/8)",
    "cot(G)",
    "sec(2*(G))",
    "powr(G, 1.5)",
    "powr(G, -0.5)",
    "(G)^-3",
    "(G)^-2",
    "floor(G)",
    "ceil(G)",
    "sign(G)",
    "mod(G, 1/2)",
    "mod(1, G)",
    "asin(G)",
    "acos((G)/4)",
    "atan2(G, y - 1/2)",
    "atan2(y - 1/2, G)",
    "max(1/(G), 2)",
    "min(G, sqrt(G))",
    "cbrt(G)",
    "exp(G)",
    "tanh(1/(G))",
    "atan(1/(G))",
    "0*ln(G)",
    "sqrt(G) - sqrt(G)",
    "log10(G)",
    "cosh(G) - 2",
];

/// SplitMix64.
fn bits(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A multiple of 2^-10 in [-4, 4].
fn coarse(state: &mut u64) -> f64 {
    f64::from((bits(state) % 8193) as u32) / 1024.0 - 4.0
}

fn compile(text: &str) -> Tape {
    Tape::compile(&Formula::parse_as_written(text).unwrap_or_else(|e| panic!("{}", e.render(text)))).unwrap()
}

#[test]
fn claims_of_continuity_withstand_attacks() {
    let (mut state, mut claimed, mut refused, mut everywhere) = (1, 0, 0, 0);
    for outer in OUTSIDE {
        for inner in INSIDE {
            let once = outer.replace('G', inner);
            for text in [once.clone(), OUTSIDE[bits(&mut state) as usize % OUTSIDE.len()].replace('G', &once)] {
                let tape = compile(&text);
                everywhere += u32::from(tape.is_continuous_everywhere());
                for _ in 0..24 {
                    // Boxes of three sizes, and points of them.
                    let width = [1.0 / 64.0, 0.25, 2.0][bits(&mut state) as usize % 3];
                    let low = [(); 3].map(|()| coarse(&mut state));
                    let x = low.map(|a| Interval::new(a, a + width));
                    let mut member = || {
                        let steps = width * 1024.0;
                        low.map(|a| a + ((bits(&mut state) % (steps as u64 + 1)) as f64) / 1024.0)
                    };
                    let y = run(&tape, x.map(Decorated::from), &mut vec![]);
                    if !(y.certainly_continuous() || tape.is_continuous_everywhere()) {
                        refused += 1;
                        continue;
                    }
                    claimed += 1;
                    for _ in 0..4 {
                        attack_continuity(&tape, member(), member());
                    }
                    attack_continuity(&tape, x.map(|x| x.lo()), x.map(|x| x.hi()));
                }
            }
        }
    }
    assert!(claimed > 2500 && refused > 2500 && everywhere > 30, "{claimed} claimed, {refused} refused, {everywhere}");
}

/// The claims that proofs of roots live on: a box on which the operator is plainly continuous is one, and one that touches
/// the end of its domain, a pole or a step is none.
#[test]
fn claims_are_made_where_they_hold() {
    for (text, holds, fails) in [
        ("1/x", [0.25, 1.0], [0.0, 1.0]),
        ("y/(x - 1)", [1.5, 2.0], [0.5, 1.5]),
        ("sqrt(x)", [0.0, 1.0], [-0.25, 1.0]),
        ("ln(x)", [0.25, 1.0], [0.0, 1.0]),
        ("tan(x)", [-1.5, 1.5], [1.5, 1.75]),
        ("powr(x, 0.5)", [0.0, 1.0], [-0.25, 1.0]),
        ("powr(x, -0.5)", [0.25, 1.0], [0.0, 1.0]),
        ("x^-1", [-2.0, -1.0], [-1.0, 0.0]),
        ("floor(x)", [0.25, 0.75], [0.75, 1.0]),
        ("sign(x)", [0.25, 0.75], [0.0, 0.75]),
        ("asin(x)", [-1.0, 1.0], [0.5, 1.25]),
    ] {
        let tape = compile(text);
        let claim = |[lo, hi]: [f64; 2]| {
            run(&tape, [Interval::new(lo, hi); 3].map(Decorated::from), &mut vec![]).certainly_continuous()
        };
        assert!(claim(holds), "{text} over {holds:?}");
        assert!(!claim(fails), "{text} over {fails:?}");
        assert!(!tape.is_continuous_everywhere(), "{text}");
    }
}
