//! Random formulas and points.
use fastrand::Rng;
use num_rational::BigRational;

const FUNCTIONS: &[&str] = &[
    "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "ln", "sqrt", "cbrt", "abs", "sign",
    "floor", "-", "sqrt", "abs", "cbrt", "-",
];
const PAIRS: &[&str] = &["min", "max", "atan2", "powr"];
const CONSTANTS: &[&str] = &["0", "1", "2", "0.5", "(-1)", "(1/3)", "0.1", "pi", "e", "(-2)", "4", "phi"];
const EXPONENTS: &[&str] = &["0", "1", "2", "3", "4", "(-1)", "(-2)", "(-3)", "0.5", "1.5", "(1/3)", "(-0.5)"];

/// A formula text of about that many operations. Parts are used again often, so that rules on equal operands are met.
pub(crate) fn text(random: &mut Rng, size: usize) -> String {
    let mut parts: Vec<String> = ["x", "y", "z"].map(String::from).to_vec();
    for _ in 0..size {
        let pick = |random: &mut Rng| {
            if random.u32(..4) == 0 {
                CONSTANTS[random.usize(..CONSTANTS.len())].to_owned()
            } else {
                // Mostly the newest parts.
                let back = random.usize(..parts.len()).min(random.usize(..parts.len()));
                parts[parts.len() - 1 - back].clone()
            }
        };
        let a = pick(random);
        let part = match random.u32(..20) {
            0..6 => format!("{}({a})", FUNCTIONS[random.usize(..FUNCTIONS.len())]),
            6..8 => format!("({a})^{}", EXPONENTS[random.usize(..EXPONENTS.len())]),
            8..10 => format!("{}({a}, {})", PAIRS[random.usize(..PAIRS.len())], pick(random)),
            10 => format!("({a})^({})", pick(random)),
            _ => format!("(({a}) {} ({}))", ["+", "-", "*", "/", "*", "-"][random.usize(..6)], pick(random)),
        };
        parts.push(part);
    }
    parts.pop().unwrap()
}

/// A point of small rationals, so that zeros, poles and borders of domains are met exactly.
pub(crate) fn point(random: &mut Rng) -> [BigRational; 3] {
    [(); 3].map(|()| BigRational::new(random.i32(-6..=6).into(), [1, 1, 2, 3][random.usize(..4)].into()))
}
