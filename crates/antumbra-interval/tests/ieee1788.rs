//! The public vectors of ITF1788: tightest results of elementary functions, with decorations. They are not part of this
//! project: the environment variable `ANTUMBRA_ITF1788` names the folder that holds `libieeep1788_elem.itl`.
mod nasty;

use std::collections::BTreeMap;

use antumbra_interval::{Decorated, Decoration, Interval};
use nasty::excess;

/// Allowed steps outward from the tightest result.
fn allowed_steps(operation: &str) -> u64 {
    match operation {
        "neg" | "abs" | "min" | "max" | "floor" | "ceil" | "sign" => 0,
        // A chain of up to 7 products and a quotient, see the table of the crate.
        "pown" => 24,
        _ => 1,
    }
}

fn number(text: &str) -> f64 {
    let text = text.trim().to_ascii_lowercase();
    let (sign, magnitude) = match text.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, text.strip_prefix('+').unwrap_or(&text)),
    };
    let value = if magnitude.starts_with("inf") {
        f64::INFINITY
    } else if let Some(hex) = magnitude.strip_prefix("0x") {
        let (digits, exponent) = hex.split_once('p').unwrap_or((hex, "0"));
        let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
        let mantissa = u64::from_str_radix(&format!("{whole}{fraction}"), 16).expect("hexadecimal digits");
        let mut e = exponent.trim().parse::<i32>().expect("an exponent") - 4 * fraction.len() as i32;
        // Exact: the digits fit a float, and only the last scaling can reach the subnormals.
        let mut value = mantissa as f64;
        while e < -1000 {
            value *= nasty::power_of_two(-500);
            e += 500;
        }
        value * nasty::power_of_two(e)
    } else {
        magnitude.parse().expect("a decimal")
    };
    sign * value
}

#[derive(Clone, Copy, Debug)]
enum Operand {
    Box(Interval, Option<Decoration>),
    Integer(i32),
}

/// Reads one operand off the front; `None` for forms that the test leaves out (`[nai]`).
fn operand(text: &str) -> Option<(Operand, &str)> {
    let text = text.trim_start();
    let Some(inside) = text.strip_prefix('[') else {
        let end = text.find(char::is_whitespace).unwrap_or(text.len());
        return Some((Operand::Integer(text[..end].parse().ok()?), &text[end..]));
    };
    let (inside, mut rest) = inside.split_once(']')?;
    let value = match inside {
        "empty" => Interval::EMPTY,
        "entire" => Interval::ENTIRE,
        "nai" => return None,
        _ => {
            let (lo, hi) = inside.split_once(',').unwrap_or((inside, inside));
            Interval::new(number(lo), number(hi))
        }
    };
    let mut decoration = None;
    for (name, meaning) in [
        ("_com", Decoration::Continuous),
        ("_dac", Decoration::Continuous),
        ("_def", Decoration::Defined),
        ("_trv", Decoration::Trivial),
    ] {
        if let Some(after) = rest.strip_prefix(name) {
            (decoration, rest) = (Some(meaning), after);
        }
    }
    Some((Operand::Box(value, decoration), rest))
}

fn apply(name: &str, operands: &[Operand]) -> Option<Decorated> {
    let x = |i: usize| match operands[i] {
        Operand::Box(x, decoration) => Decorated::new(x, decoration.unwrap_or(Decoration::Continuous)),
        Operand::Integer(_) => panic!("an integer where an interval was expected"),
    };
    Some(match name {
        "neg" => -x(0),
        "add" => x(0) + x(1),
        "sub" => x(0) - x(1),
        "mul" => x(0) * x(1),
        "div" => x(0) / x(1),
        "recip" => x(0).recip(),
        "sqr" => x(0).sqr(),
        "sqrt" => x(0).sqrt(),
        "pown" => match operands[1] {
            Operand::Integer(n) => x(0).powi(n),
            Operand::Box(..) => panic!("an interval where an integer was expected"),
        },
        "pow" => x(0).pow(x(1)),
        "exp" => x(0).exp(),
        "log" => x(0).ln(),
        "sin" => x(0).sin(),
        "cos" => x(0).cos(),
        "tan" => x(0).tan(),
        "asin" => x(0).asin(),
        "acos" => x(0).acos(),
        "atan" => x(0).atan(),
        "atan2" => x(0).atan2(x(1)),
        "sinh" => x(0).sinh(),
        "cosh" => x(0).cosh(),
        "tanh" => x(0).tanh(),
        "sign" => x(0).sign(),
        "ceil" => x(0).ceil(),
        "floor" => x(0).floor(),
        "abs" => x(0).abs(),
        "min" => x(0).min(x(1)),
        "max" => x(0).max(x(1)),
        _ => return None,
    })
}

#[test]
fn vectors() {
    let Some(folder) = std::env::var_os("ANTUMBRA_ITF1788") else {
        // Written past the capture of test output: a skipped check must be seen.
        let note =
            b"SKIPPED: the ITF1788 vectors were not checked; set ANTUMBRA_ITF1788 to the folder that holds them\n";
        std::io::Write::write_all(&mut std::io::stderr(), note).expect("standard error");
        return;
    };
    let file = std::path::Path::new(&folder).join("libieeep1788_elem.itl");
    let text = std::fs::read_to_string(&file).unwrap_or_else(|e| panic!("cannot read {}: {e}", file.display()));
    let mut counts = BTreeMap::<&str, (usize, u64)>::new();
    let mut failures = Vec::new();
    for line in text.lines().map(str::trim).filter(|line| line.ends_with(';')) {
        let Some((call, expected)) = line.trim_end_matches(';').split_once('=') else { continue };
        let Some((name, mut rest)) = call.trim().split_once(' ') else { continue };
        let mut operands = Vec::new();
        while !rest.trim().is_empty() {
            let Some((value, after)) = operand(rest) else { break };
            operands.push(value);
            rest = after;
        }
        let Some((Operand::Box(tight, decoration), _)) = operand(expected) else { continue };
        if !rest.trim().is_empty() || operands.is_empty() {
            continue;
        }
        let Some(got) = apply(name, &operands) else { continue };
        let steps = excess(got.interval, tight);
        if steps.is_none_or(|steps| steps > allowed_steps(name)) {
            failures.push(format!("{line} got {} ({steps:?} steps)", got.interval));
        }
        if decoration.is_some_and(|expected| expected != got.decoration) {
            failures.push(format!("{line} got {:?}", got.decoration));
        }
        let count = counts.entry(name).or_default();
        *count = (count.0 + 1, count.1.max(steps.unwrap_or(0)));
    }
    println!("{counts:?}");
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
    assert!(counts.len() == 28 && counts.values().map(|count| count.0).sum::<usize>() > 3000, "vectors missing");
}
