//! The language: texts from raw bytes and texts that are nearly right.
use crate::continuity;
use crate::input::Input;
use crate::truth::Truth;
use antumbra::expr::{Axis, Formula};
use antumbra::tape::Tape;

const UNARY: &[&str] = &[
    "sin", "cos", "tan", "sec", "csc", "cot", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "ln", "log10",
    "log2", "sqrt", "cbrt", "abs", "sign", "floor", "ceil", "-", "sphere", "box", "cylinder",
];
const PAIRS: &[&str] = &["min", "max", "atan2", "powr", "pow", "mod", "union", "intersection", "difference", "torus"];
const CONSTANTS: &[&str] =
    &["0", "1", "2", "0.5", "(-1)", "(1/3)", "0.1", "pi", "e", "(-2)", "4", "phi", "1e300", "1e-320", "tau", "1e400"];
const EXPONENTS: &[&str] = &["0", "1", "2", "3", "(-1)", "(-2)", "0.5", "1.5", "(1/3)", "(-0.5)", "17", "1000", "x"];
const SCRAPS: &[&str] = &[
    "x",
    "y",
    "z",
    "x y",
    "2",
    "1.5e3",
    ".5",
    "(",
    ")",
    ",",
    "=",
    ";",
    "\n",
    "+",
    "-",
    "*",
    "/",
    "^",
    "**",
    "²",
    "³",
    "√",
    "π",
    "·",
    "×",
    "÷",
    "−",
    "a",
    "b",
    "f",
    "f(t) = ",
    "a = 3",
    "#c\n",
    "translate(",
    "rotate(",
    "scale(",
    "smooth_union(",
    "e",
    "xyz",
    "1e999",
    "9999999999",
    "^-",
    "if",
    "\u{0}",
    "\"",
    "[",
    "sin",
    "cos(",
];

/// Longest text that is evaluated; longer ones are only read.
const MOST_TEXT: usize = 4000;
/// Longest tape that is evaluated.
const MOST_CLAUSES: usize = 2000;

/// Reading never panics, errors can be shown, and a formula that is read means the same after printing, simplifying,
/// compiling; its rewritten surface has the same zeros.
pub fn formula(bytes: &[u8]) {
    let mut input = Input::new(bytes);
    let text = match input.below(3) {
        0 => input.rest_as_text(),
        1 => scraps(&mut input),
        _ => {
            let text = expression(&mut input);
            return check(&text, &mut input);
        }
    };
    check(&text, &mut Input::new(bytes));
}

fn scraps(input: &mut Input<'_>) -> String {
    let mut text = String::new();
    while !input.is_spent() && text.len() < MOST_TEXT {
        text += input.pick(SCRAPS);
        if input.below(4) == 0 {
            text.push(' ');
        }
    }
    text
}

/// A text that is a formula but for its constants' domains.
fn expression(input: &mut Input<'_>) -> String {
    let mut parts: Vec<String> = ["x", "y", "z"].map(String::from).to_vec();
    let operations = 1 + input.below(14);
    for _ in 0..operations {
        let part = |input: &mut Input<'_>, parts: &[String]| match input.below(4) {
            0 => input.pick(CONSTANTS).to_owned(),
            1 => parts[input.below(parts.len())].clone(),
            _ => parts[parts.len() - 1 - input.below(parts.len().min(2))].clone(),
        };
        let (a, b) = (part(input, &parts), part(input, &parts));
        let new = match input.below(8) {
            0 | 1 => format!("{}({a})", input.pick(UNARY)),
            2 => format!("{}({a}, {b})", input.pick(PAIRS)),
            3 => format!("({a})^{}", input.pick(EXPONENTS)),
            4 => match input.below(4) {
                0 => format!("translate({a}, {b}, 0.5, 1)"),
                1 => format!("scale({a}, {})", input.pick(CONSTANTS)),
                2 => format!("rotate({a}, 30, {}, 0)", input.pick(CONSTANTS)),
                _ => format!("smooth_union({a}, {b}, 0.25)"),
            },
            _ => format!("(({a}) {} ({b}))", input.pick(&["+", "-", "*", "/", "=", "*", "-"])),
        };
        if new.len() < MOST_TEXT {
            parts.push(new);
        }
    }
    parts.pop().unwrap_or_default()
}

fn check(text: &str, input: &mut Input<'_>) {
    let written = match Formula::parse_as_written(text) {
        Ok(written) => written,
        Err(error) => {
            // Shown without a panic, and placed inside the text.
            assert!(!error.render(text).is_empty() && !error.message().is_empty());
            assert!(
                error.span().end <= text.len() && error.line() >= 1 && error.column() >= 1,
                "{error:?} of {text:?}"
            );
            assert!(Formula::parse(text).is_err(), "{text:?}");
            return;
        }
    };
    let simple = match Formula::parse(text) {
        Ok(simple) => simple,
        Err(error) => {
            // The one reason that simplification finds: defined nowhere.
            assert!(!error.render(text).is_empty());
            return;
        }
    };
    if text.len() > MOST_TEXT {
        return;
    }
    let printed = written.to_string();
    match Formula::parse_as_written(&printed) {
        Ok(again) => assert!(again == written, "{text:?} is printed as {printed:?}, which is {again}"),
        Err(error) => panic!("{text:?} is printed as {printed:?}: {}", error.render(&printed)),
    }
    assert!(simple.simplify() == simple.simplify().simplify(), "{text:?}: simplifying twice changes {simple}");
    let surface = simple.surface();
    let tapes = [&written, &simple, surface.formula()].map(|f| Tape::compile(f).expect("a short formula"));
    if tapes.iter().any(|tape| tape.clauses().len() > MOST_CLAUSES) {
        return;
    }
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        assert!(Tape::compile(simple.derivative(axis).formula()).is_ok());
    }
    let points: [[f64; 3]; 3] = std::array::from_fn(|_| std::array::from_fn(|_| input.coarse() / 8.0));
    for p in points {
        same(text, &tapes, p);
    }
    for (writing, form) in simple.forms() {
        let form = Tape::compile(&form.repeated_squares()).expect("a short formula");
        if form.clauses().len() <= MOST_CLAUSES {
            let [simple, form] = [&tapes[1], &form].map(|tape| Truth::at(tape, points[0]));
            equal(&format!("{text:?}, {writing}, at {:?}", points[0]), &simple, &form);
        }
    }
    for tape in tapes.iter().filter(|tape| tape.is_continuous_everywhere()) {
        continuity::attack(tape, points[0], points[1]);
    }
}

/// Both are the same value, or both are undefined.
fn equal(what: &str, a: &Truth, b: &Truth) {
    match (a, b) {
        (Truth::Undefined, Truth::Undefined) => {}
        (Truth::Undefined, other) | (other, Truth::Undefined) => {
            assert!(other.enclosure().is_none(), "{what}: {a:?} became {b:?}");
        }
        _ => {
            if let (Some(before), Some(after)) = (a.enclosure(), b.enclosure()) {
                assert!(before.possibly_intersects(after), "{what}: {before} became {after}");
            }
        }
    }
}

/// The formula as written and simplified have the same value, and the surface has the same zeros.
fn same(text: &str, tapes: &[Tape; 3], p: [f64; 3]) {
    let [written, simple, surface] = tapes.each_ref().map(|tape| Truth::at(tape, p));
    let defined = |truth: &Truth| truth.enclosure();
    equal(&format!("{text:?} at {p:?}"), &written, &simple);
    for (zero, other) in [(&simple, &surface), (&surface, &simple)] {
        let certainly_zero = defined(zero).is_some_and(|v| v.lo() == 0.0 && v.hi() == 0.0);
        let certainly_not = matches!(other, Truth::Undefined) || defined(other).is_some_and(|v| !v.possibly_zero());
        assert!(!(certainly_zero && certainly_not), "{text:?} at {p:?}: formula {simple:?}, surface {surface:?}");
    }
}
