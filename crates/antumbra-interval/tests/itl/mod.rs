//! Reader of ITL, the language of the ITF1788 test vectors: `operation operand... = result, ... [<= accurate] [signal X];`.
use antumbra_interval::{Decoration, Interval};
use std::path::Path;

/// What stands where an operand or a result may stand.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    /// An interval, with a decoration where one is written.
    Box(Interval, Option<Decoration>),
    /// `[nai]`, "not an interval", or an interval decorated `_ill`.
    NotAnInterval,
    /// An interval with a bound that is no float: the expected result depends on how that is rounded.
    NotAFloat,
    /// A floating-point number, possibly infinite or NaN, exactly as written.
    Number(f64),
    /// `true` or `false`.
    Boolean(bool),
    /// Anything else: text, lists, names of decorations and overlaps.
    Other(String),
}

/// One test vector.
#[derive(Clone, Debug)]
pub(crate) struct Vector {
    pub(crate) file: String,
    pub(crate) text: String,
    pub(crate) operation: String,
    pub(crate) operands: Vec<Value>,
    pub(crate) results: Vec<Value>,
}

/// The vectors of all files `*.itl` of a folder, in the order of their names.
pub(crate) fn read(folder: &Path) -> Vec<Vector> {
    let list = std::fs::read_dir(folder).unwrap_or_else(|e| panic!("cannot list {}: {e}", folder.display()));
    let mut files: Vec<_> = list.map(|entry| entry.expect("a folder entry").path()).collect();
    files.retain(|file| file.extension().is_some_and(|e| e == "itl"));
    files.sort();
    assert!(!files.is_empty(), "no .itl files in {}", folder.display());
    let mut vectors = Vec::new();
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap_or_else(|e| panic!("cannot read {}: {e}", file.display()));
        let name = file.file_name().expect("a file has a name").to_string_lossy().into_owned();
        vectors.extend(parse(&text).into_iter().map(|vector| Vector { file: name.clone(), ..vector }));
    }
    vectors
}

/// The vectors of one text.
pub(crate) fn parse(text: &str) -> Vec<Vector> {
    statements(&without_comments(text)).iter().map(|statement| vector(statement)).collect()
}

fn without_comments(text: &str) -> String {
    let (mut out, mut rest) = (String::new(), text);
    while let Some(start) = rest.find("/*") {
        out.push_str(&rest[..start]);
        let end = rest[start..].find("*/").expect("a comment that ends");
        rest = &rest[start + end + 2..];
    }
    out.push_str(rest);
    // Vectors of text conversion hold neither mark inside their strings.
    let code = |line: &str| line.split("//").next().unwrap_or("").split('#').next().unwrap_or("").trim().to_owned();
    out.lines().map(code).collect::<Vec<_>>().join(" ")
}

/// The statements of all test cases.
fn statements(text: &str) -> Vec<String> {
    let mut out = Vec::new();
    for case in text.split("testcase").skip(1) {
        // The first brace opens the case and the last one closes it; between them braces are lists.
        let (start, end) = (case.find('{').expect("an opening brace"), case.rfind('}').expect("a closing brace"));
        out.extend(case[start + 1..end].split(';').map(|s| s.trim().to_owned()).filter(|s| !s.is_empty()));
    }
    out
}

fn vector(statement: &str) -> Vector {
    let (call, results) = statement.split_once('=').unwrap_or_else(|| panic!("no result in {statement}"));
    let (operation, operands) = call.trim().split_once(char::is_whitespace).expect("an operand");
    let results = results.split("signal").next().unwrap_or("").split("<=").next().unwrap_or("");
    Vector {
        file: String::new(),
        text: statement.to_owned(),
        operation: operation.to_owned(),
        operands: values(operands),
        results: values(results),
    }
}

fn values(text: &str) -> Vec<Value> {
    let (mut out, mut rest) = (Vec::new(), text.trim());
    while !rest.is_empty() {
        let (value, after) = value(rest);
        out.push(value);
        rest = after.trim_start_matches(|c: char| c.is_whitespace() || c == ',');
    }
    out
}

/// The first value of a text, and what follows it.
fn value(text: &str) -> (Value, &str) {
    if let Some(inside) = text.strip_prefix('[') {
        let (inside, rest) = inside.split_once(']').expect("a closing bracket");
        let suffix = if rest.starts_with('_') { &rest[1..usize::min(4, rest.len())] } else { "" };
        let rest = if suffix.is_empty() { rest } else { &rest[4..] };
        let decoration = match suffix {
            "com" | "dac" => Some(Decoration::Continuous),
            "def" => Some(Decoration::Defined),
            "trv" => Some(Decoration::Trivial),
            "" => None,
            "ill" => return (Value::NotAnInterval, rest),
            other => panic!("decoration {other} of {text}"),
        };
        let interval = match inside.trim().to_ascii_lowercase().as_str() {
            "nai" => return (Value::NotAnInterval, rest),
            "empty" => Interval::EMPTY,
            "entire" => Interval::ENTIRE,
            bounds => {
                let (lo, hi) = bounds.split_once(',').unwrap_or((bounds, bounds));
                let (lo, hi) = (number(lo).expect("a lower bound"), number(hi).expect("an upper bound"));
                if lo.is_nan() || hi.is_nan() {
                    return (Value::NotAFloat, rest);
                }
                Interval::new(lo, hi)
            }
        };
        return (Value::Box(interval, decoration), rest);
    }
    let close = match text.as_bytes()[0] {
        b'"' => Some('"'),
        b'{' => Some('}'),
        _ => None,
    };
    if let Some(close) = close {
        let end = text[1..].find(close).expect("a closing mark") + 2;
        return (Value::Other(text[..end].to_owned()), &text[end..]);
    }
    let end = text.find(|c: char| c.is_whitespace() || c == ',').unwrap_or(text.len());
    let (word, rest) = text.split_at(end);
    let value = match word {
        "true" => Value::Boolean(true),
        "false" => Value::Boolean(false),
        _ => number(word).map_or_else(|| Value::Other(word.to_owned()), Value::Number),
    };
    (value, rest)
}

/// A C99 number. Hexadecimal ones are read exactly, NaN if they are no float.
fn number(text: &str) -> Option<f64> {
    let text = text.trim().to_ascii_lowercase();
    let (sign, magnitude) = match text.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, text.strip_prefix('+').unwrap_or(&text)),
    };
    let value = match magnitude {
        "inf" | "infinity" => f64::INFINITY,
        "nan" => f64::NAN,
        _ => match magnitude.strip_prefix("0x") {
            Some(hex) => hexadecimal(hex)?,
            None => magnitude.parse().ok()?,
        },
    };
    Some(sign * value)
}

fn hexadecimal(text: &str) -> Option<f64> {
    let (digits, exponent) = text.split_once('p').unwrap_or((text, "0"));
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let mut mantissa = u128::from_str_radix(&format!("{whole}{fraction}"), 16).ok()?;
    let mut e = exponent.trim().parse::<i32>().ok()? - 4 * fraction.len() as i32;
    if mantissa == 0 {
        return Some(0.0);
    }
    // An odd mantissa below 2^53 times a power of two.
    e += mantissa.trailing_zeros() as i32;
    mantissa >>= mantissa.trailing_zeros();
    if mantissa >= 1 << 53 || e < -1074 {
        return Some(f64::NAN);
    }
    // Two exact steps: the first cannot leave the normal range, the second ends at a float.
    let half = e / 2;
    let value = mantissa as f64 * crate::nasty::power_of_two(half) * crate::nasty::power_of_two(e - half);
    assert!(value.is_finite(), "{text} is no float");
    Some(value)
}
