//! The public vectors of ITF1788: tightest results of all operations of IEEE 1788, with decorations. They are not part of
//! this project: the environment variable `ANTUMBRA_ITF1788` names the folder of their `.itl` files.
//!
//! Interval results must contain the tightest ones and be at most [`steps`] floats wider at either end; everything else
//! must be equal. Kernels with directed rounding must give the tightest results themselves.
mod itl;
mod nasty;

use std::collections::BTreeMap;
use std::io::Write;

use antumbra_interval::lanes::{self, Lanes, LanesMut, Level};
use antumbra_interval::{Decorated, Decoration, Interval};
use itl::{Value, Vector};
use nasty::excess;

/// Written past the capture of test output: counts and skipped checks must be seen.
fn say(text: &str) {
    std::io::stderr().write_all(text.as_bytes()).expect("standard error");
}

/// The vectors, or `None` and a notice where there are none.
fn vectors() -> Option<Vec<Vector>> {
    let Some(folder) = std::env::var_os("ANTUMBRA_ITF1788") else {
        say("SKIPPED: the ITF1788 vectors were not checked; set ANTUMBRA_ITF1788 to the folder that holds them\n");
        return None;
    };
    Some(itl::read(std::path::Path::new(&folder)))
}

/// Most floats between a bound and the tightest one, per operation: what was measured, and no vector may exceed. Operations
/// that are not listed give the vectors' results themselves.
fn steps(operation: &str) -> u64 {
    match operation {
        "add" | "sub" | "mul" | "div" | "fma" | "recip" | "sqr" | "sqrt" | "cbrt" | "pow" => 1,
        "exp" | "log" | "sin" | "cos" | "tan" | "asin" | "acos" | "atan" | "atan2" | "sinh" | "cosh" | "tanh" => 1,
        "wid" | "rad" | "midRad" => 1,
        // A chain of products: up to 3 |n| by proof, see the table of the crate.
        "pown" => 11,
        _ => 0,
    }
}

fn decorated(value: &Value) -> Option<Decorated> {
    match value {
        Value::Box(x, decoration) => Some(Decorated::new(*x, decoration.unwrap_or(Decoration::Continuous))),
        _ => None,
    }
}

/// The operations whose results are intervals and that carry decorations.
fn function(vector: &Vector) -> Option<Decorated> {
    let x = |i: usize| decorated(&vector.operands[i]);
    Some(match (vector.operation.as_str(), vector.operands.len()) {
        ("pos", 1) => x(0)?,
        ("neg", 1) => -x(0)?,
        ("add", 2) => x(0)? + x(1)?,
        ("sub", 2) => x(0)? - x(1)?,
        ("mul", 2) => x(0)? * x(1)?,
        ("div", 2) => x(0)? / x(1)?,
        ("fma", 3) => x(0)?.mul_add(x(1)?, x(2)?),
        ("recip", 1) => x(0)?.recip(),
        ("sqr", 1) => x(0)?.sqr(),
        ("sqrt", 1) => x(0)?.sqrt(),
        ("cbrt", 1) => x(0)?.cbrt(),
        ("pown", 2) => match vector.operands[1] {
            Value::Number(n) if n == n.trunc() && n.abs() < 2e9 => x(0)?.powi(n as i32),
            _ => return None,
        },
        ("pow", 2) => x(0)?.pow(x(1)?),
        ("exp", 1) => x(0)?.exp(),
        ("log", 1) => x(0)?.ln(),
        ("sin", 1) => x(0)?.sin(),
        ("cos", 1) => x(0)?.cos(),
        ("tan", 1) => x(0)?.tan(),
        ("asin", 1) => x(0)?.asin(),
        ("acos", 1) => x(0)?.acos(),
        ("atan", 1) => x(0)?.atan(),
        ("atan2", 2) => x(0)?.atan2(x(1)?),
        ("sinh", 1) => x(0)?.sinh(),
        ("cosh", 1) => x(0)?.cosh(),
        ("tanh", 1) => x(0)?.tanh(),
        ("sign", 1) => x(0)?.sign(),
        ("ceil", 1) => x(0)?.ceil(),
        ("floor", 1) => x(0)?.floor(),
        ("abs", 1) => x(0)?.abs(),
        ("min", 2) => x(0)?.min(x(1)?),
        ("max", 2) => x(0)?.max(x(1)?),
        ("newDec", 1) => Decorated::from(x(0)?.interval),
        ("setDec", 2) => Decorated::new(x(0)?.interval, decoration(&vector.operands[1])?),
        ("d-numsToInterval", 2) => Decorated::from(from_numbers(vector)?),
        _ => return None,
    })
}

fn decoration(value: &Value) -> Option<Decoration> {
    match value {
        Value::Other(name) => match name.as_str() {
            "com" | "dac" => Some(Decoration::Continuous),
            "def" => Some(Decoration::Defined),
            "trv" => Some(Decoration::Trivial),
            _ => None,
        },
        _ => None,
    }
}

/// The interval with the given bounds; the empty set where the vectors expect an error.
fn from_numbers(vector: &Vector) -> Option<Interval> {
    match vector.operands[..] {
        [Value::Number(lo), Value::Number(hi)] => Some(Interval::try_new(lo, hi).unwrap_or(Interval::EMPTY)),
        _ => None,
    }
}

/// Operations on sets: their results carry no decoration.
fn set(vector: &Vector) -> Option<Interval> {
    let x = |i: usize| Some(decorated(&vector.operands[i])?.interval);
    match vector.operation.as_str() {
        "intersection" => Some(x(0)?.intersection(x(1)?)),
        "convexHull" => Some(x(0)?.hull(x(1)?)),
        "intervalPart" => x(0),
        "b-numsToInterval" => from_numbers(vector),
        _ => None,
    }
}

fn predicate(vector: &Vector) -> Option<bool> {
    let x = |i: usize| Some(decorated(&vector.operands[i])?.interval);
    Some(match vector.operation.as_str() {
        "isEmpty" => x(0)?.is_empty(),
        "isEntire" => x(0)? == Interval::ENTIRE,
        "isSingleton" => x(0)?.is_point(),
        "isCommonInterval" => x(0)?.is_bounded(),
        "isMember" => match vector.operands[0] {
            Value::Number(m) => x(1)?.contains(m),
            _ => return None,
        },
        "equal" => x(0)? == x(1)?,
        "subset" => x(0)?.is_subset_of(x(1)?),
        "interior" => x(0)?.is_interior_to(x(1)?),
        "disjoint" => !x(0)?.possibly_intersects(x(1)?),
        "precedes" => x(0)?.certainly_at_most(x(1)?),
        "strictPrecedes" => x(0)?.certainly_less(x(1)?),
        _ => return None,
    })
}

/// Numbers of an interval.
fn numbers(vector: &Vector) -> Option<Vec<f64>> {
    let [value] = &vector.operands[..] else { return None };
    let x = decorated(value)?.interval;
    Some(match vector.operation.as_str() {
        "inf" => vec![x.lo()],
        "sup" => vec![x.hi()],
        "mag" => vec![x.magnitude()],
        "mig" => vec![x.mignitude()],
        "mid" => vec![x.mid()],
        "wid" => vec![x.width()],
        "rad" => vec![x.radius()],
        "midRad" => vec![x.mid(), x.radius()],
        _ => return None,
    })
}

/// How many floats above the expected numbers the given ones are; `None` if below.
fn above(got: &[f64], expected: &[f64]) -> Option<u64> {
    let one = |(got, expected): (&f64, &f64)| match got == expected || (got.is_nan() && expected.is_nan()) {
        true => Some(0),
        false => (got > expected).then(|| nasty::excess_of_bound(*got, *expected)),
    };
    got.iter().zip(expected).map(one).try_fold(0, |most, steps| Some(steps?.max(most)))
}

/// What came of the vectors of one operation.
#[derive(Default)]
struct Count {
    run: usize,
    failed: usize,
    decorated: usize,
    widest: u64,
    skipped: BTreeMap<&'static str, usize>,
}

#[derive(PartialEq)]
enum Outcome {
    Passed { steps: u64, decorated: bool },
    Failed(String),
    Skipped(&'static str),
}

fn check(vector: &Vector) -> Outcome {
    if vector.operands.iter().chain(&vector.results).any(|v| *v == Value::NotAnInterval) {
        return Outcome::Skipped("\"not an interval\" does not exist here");
    }
    if vector.operands.iter().chain(&vector.results).any(|v| *v == Value::NotAFloat) {
        return Outcome::Skipped("a bound of more than 53 bits");
    }
    let failed = |got: &dyn std::fmt::Debug| Outcome::Failed(format!("{}: {} got {got:?}", vector.file, vector.text));
    let name = vector.operation.as_str();
    if let (Some(got), [Value::Box(tight, decoration)]) = (function(vector), vector.results.as_slice()) {
        let wrong_decoration = decoration.is_some_and(|expected| expected != got.decoration);
        return match excess(got.interval, *tight) {
            Some(s) if s <= steps(name) && !wrong_decoration => {
                Outcome::Passed { steps: s, decorated: decoration.is_some() }
            }
            steps => failed(&(got, steps)),
        };
    }
    if let (Some(got), [Value::Box(expected, _)]) = (set(vector), vector.results.as_slice()) {
        return if got == *expected { Outcome::Passed { steps: 0, decorated: false } } else { failed(&got) };
    }
    if let (Some(got), [Value::Boolean(expected)]) = (predicate(vector), vector.results.as_slice()) {
        return if got == *expected { Outcome::Passed { steps: 0, decorated: false } } else { failed(&got) };
    }
    let expected = |v: &Value| if let Value::Number(n) = v { Some(*n) } else { None };
    if let (Some(got), Some(expected)) =
        (numbers(vector), vector.results.iter().map(expected).collect::<Option<Vec<_>>>())
    {
        if got.iter().zip(&expected).any(|(got, expected)| expected.is_nan() && !got.is_nan()) {
            return Outcome::Skipped("the empty set has the number 0 or +inf here, not NaN");
        }
        // The midpoint of midRad must be the vector's; only the radius may be above it.
        let exact = if name == "midRad" { 1 } else { 0 };
        return match above(&got, &expected) {
            Some(s) if s <= steps(name) && got[..exact] == expected[..exact] => {
                Outcome::Passed { steps: s, decorated: false }
            }
            _ => failed(&got),
        };
    }
    if name == "decorationPart"
        && let (Some(x), Some(expected)) = (decorated(&vector.operands[0]), decoration(&vector.results[0]))
    {
        return if x.decoration == expected { Outcome::Passed { steps: 0, decorated: true } } else { failed(&x) };
    }
    Outcome::Skipped("no such operation")
}

#[test]
fn every_operation_gives_the_vectors_results() {
    let Some(vectors) = vectors() else { return };
    let mut counts = BTreeMap::<&str, Count>::new();
    let mut failures = Vec::new();
    for vector in &vectors {
        let count = counts.entry(&vector.operation).or_default();
        match check(vector) {
            Outcome::Passed { steps, decorated } => {
                count.run += 1;
                count.decorated += usize::from(decorated);
                count.widest = count.widest.max(steps);
            }
            Outcome::Failed(what) => {
                count.run += 1;
                count.failed += 1;
                failures.push(what);
            }
            Outcome::Skipped(why) => *count.skipped.entry(why).or_default() += 1,
        }
    }
    say(&report(&counts));
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
    let run: usize = counts.values().map(|c| c.run).sum();
    let operations = counts.values().filter(|c| c.run > 0).count();
    assert!(run >= 5891 && operations >= 58, "vectors missing: {run} of {operations} operations");
}

fn report(counts: &BTreeMap<&str, Count>) -> String {
    let mut out = String::from("\nITF1788: operation, vectors run, passed, with decorations, widest (allowed) steps\n");
    let mut skipped = BTreeMap::<&str, Vec<String>>::new();
    let (mut run, mut passed, mut left) = (0, 0, 0);
    for (name, c) in counts {
        for (why, n) in &c.skipped {
            skipped.entry(why).or_default().push(format!("{name} {n}"));
            left += n;
        }
        if c.run > 0 {
            let good = c.run - c.failed;
            out += &format!("{name:>16} {:>5} {good:>5} {:>5} {:>3} ({})\n", c.run, c.decorated, c.widest, steps(name));
            (run, passed) = (run + c.run, passed + good);
        }
    }
    out += &format!("{:>16} {run:>5} {passed:>5}\n{left} of {} left out:\n", "all", run + left);
    for (why, names) in skipped {
        out += &format!("  {why}: {}\n", names.join(", "));
    }
    out
}

type Kernel = fn(Level, &[Lanes<'_>], LanesMut<'_>);

/// The operations that have kernels.
const KERNELS: [(&str, Kernel); 11] = [
    ("neg", |level, x, out| lanes::neg(level, x[0], out)),
    ("abs", |level, x, out| lanes::abs(level, x[0], out)),
    ("sqr", |level, x, out| lanes::sqr(level, x[0], out)),
    ("sqrt", |level, x, out| lanes::sqrt(level, x[0], out)),
    ("add", |level, x, out| lanes::add(level, x[0], x[1], out)),
    ("sub", |level, x, out| lanes::sub(level, x[0], x[1], out)),
    ("mul", |level, x, out| lanes::mul(level, x[0], x[1], out)),
    ("div", |level, x, out| lanes::div(level, x[0], x[1], out)),
    ("min", |level, x, out| lanes::min(level, x[0], x[1], out)),
    ("max", |level, x, out| lanes::max(level, x[0], x[1], out)),
    ("fma", |level, x, out| lanes::mul_add(level, x[0], x[1], x[2], out)),
];

/// All vectors of one operation in one batch; failures and how many there were.
fn kernel(vectors: &[Vector], name: &str, kernel: Kernel, level: Level) -> (Vec<String>, usize) {
    let intervals =
        |values: &[Value]| -> Option<Vec<Interval>> { values.iter().map(|v| Some(decorated(v)?.interval)).collect() };
    let mine: Vec<(&Vector, Vec<Interval>, Interval)> = vectors
        .iter()
        .filter(|v| v.operation == name)
        .filter_map(|v| Some((v, intervals(&v.operands)?, *intervals(&v.results)?.first()?)))
        .collect();
    let operands = mine.first().map_or(0, |(_, x, _)| x.len());
    let bounds: Vec<(Vec<f64>, Vec<f64>)> =
        (0..operands).map(|k| mine.iter().map(|(_, x, _)| (x[k].lo(), x[k].hi())).unzip()).collect();
    let inputs: Vec<Lanes<'_>> = bounds.iter().map(|(lo, hi)| Lanes::new(lo, hi)).collect();
    // Results not written would be noticed: `[7, 7]`.
    let (mut lo, mut hi) = (vec![7.0; mine.len()], vec![7.0; mine.len()]);
    kernel(level, &inputs, LanesMut::new(&mut lo, &mut hi));
    let allowed = if level.is_directed() { 0 } else { steps(name) };
    let failures = mine.iter().enumerate().filter_map(|(i, (vector, _, tight))| {
        let got = Interval::from_bounds_or_entire(lo[i], hi[i]);
        let good = excess(got, *tight).is_some_and(|steps| steps <= allowed);
        (!good).then(|| format!("{}: {} got {got} with {level:?}", vector.file, vector.text))
    });
    (failures.collect(), mine.len())
}

#[test]
fn kernels_give_the_vectors_results() {
    let Some(vectors) = vectors() else { return };
    let best = Level::detect();
    if !best.is_directed() {
        say("SKIPPED: no AVX-512 here: the vectors were not run on the kernels with directed rounding\n");
    }
    let levels = if best == Level::Portable { vec![best] } else { vec![Level::Portable, best] };
    for level in levels {
        let mut total = 0;
        let mut line = format!("ITF1788 on lanes, {level:?}:");
        for (name, function) in KERNELS {
            let (failures, run) = kernel(&vectors, name, function, level);
            assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
            assert!(run > 10, "{name}: {run} vectors");
            line += &format!(" {name} {run}");
            total += run;
        }
        say(&format!("{line}; all {total} passed\n"));
    }
}

/// The checks of this file must be able to fail.
#[test]
fn wrong_results_are_noticed() {
    let vector = |text: &str| {
        let (call, result) = text.split_once('=').unwrap();
        let (operation, operands) = call.split_once(' ').unwrap();
        let mut parsed = itl::parse(&format!("testcase t {{ {operation} {operands} = {result}; }}"));
        assert_eq!(parsed.len(), 1);
        check(&parsed.remove(0))
    };
    assert!(matches!(vector("add [1,2] [3,4] = [4,6]"), Outcome::Passed { .. }));
    for wrong in [
        "add [1,2] [3,4] = [4,7]",
        "add [1,2] [3,4] = [4.5,6]",
        "sqrt [1,4]_com = [1,2]_def",
        "sqrt [-1,4]_com = [0,2]_com",
        "floor [0.5,0.75] = [0,1]",
        "subset [1,2] [0,3] = false",
        "mid [0,2] = 1.5",
        "wid [0,2] = 2.5",
    ] {
        assert!(matches!(vector(wrong), Outcome::Failed(_)), "{wrong}");
    }
    assert!(matches!(vector("sin [nai] = [nai]"), Outcome::Skipped(_)));
}
