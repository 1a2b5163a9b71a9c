//! Tapes as WGSL: straight-line functions over f32 enclosures, for GPUs whose compilers cannot be trusted with floats.
//!
//! The arithmetic is text of its own ([`FORMS`], [`INTERVALS`], [`FUNCTIONS`]), with the reasons for every bound beside it; it needs one
//! function from its user, `fn runtime_zero() -> u32`, which must return 0 in a way that no compiler can see. [`function`] writes
//! a tape as calls of that arithmetic; [`Reach`] proves that nothing in it overflows, without which nothing holds.
mod reach;
mod width;

pub use reach::Reach;
pub use width::Width;

use crate::expr::{Binary, Unary};
use crate::tape::{Op, Tape};
use antumbra_interval::Interval;
use antumbra_interval::round::sub_up;
use std::fmt::Write;

/// Balls, affine forms and slopes.
pub const FORMS: &str = concat!(include_str!("single.wgsl"), include_str!("forms.wgsl"));
/// Intervals.
pub const INTERVALS: &str = include_str!("intervals.wgsl");
/// Quotients, roots and the elementary functions that have an enclosure here: over balls, forms and slopes; needs [`FORMS`].
pub const FUNCTIONS: &str = include_str!("functions.wgsl");
/// The same over intervals; needs [`INTERVALS`] and [`FUNCTIONS`].
pub const INTERVAL_FUNCTIONS: &str = include_str!("interval_functions.wgsl");

/// The least error bound of any form or ball: 2^-100.
pub const FLOOR: f32 = f32::from_bits((127 - 100) << 23);

/// What kind of number a function computes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `vec2<f32>`, of [`INTERVALS`].
    Interval,
    /// `Form`, of [`FORMS`].
    Form,
    /// `Slope`, of [`FORMS`].
    Slope,
}

/// Why a function stays on the CPU.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// An operator that has no f32 enclosure here.
    #[error("the operator `{0}` has no enclosure in 32-bit numbers")]
    Operator(&'static str),
    /// A number may get too large.
    #[error("an intermediate result may reach {0:.1e}, which 32-bit numbers do not hold safely")]
    Overflow(f64),
    /// A straight-line function of that many operations is too long for the compilers of drivers.
    #[error("{0} operations are too many for one kernel")]
    Long(usize),
    /// Quotients, roots, functions and intervals have no kernels in 64 bits.
    #[error("it has kernels in 32 bits only")]
    Single,
    /// No formula is known, only a function of the user's own.
    #[error("the surface is not given by a formula")]
    NoFormula,
}

/// Longest tape that becomes a function: drivers take some seconds for 3000 operations.
pub const LONGEST: usize = 2000;

impl Kind {
    fn prefix(self) -> &'static str {
        match self {
            Self::Interval => "i",
            Self::Form => "f",
            Self::Slope => "s",
        }
    }

    fn type_name(self) -> &'static str {
        match self {
            Self::Interval => "vec2<f32>",
            Self::Form => "Form",
            Self::Slope => "Slope",
        }
    }
}

/// The tape as a WGSL function `fn name(x, y, z) -> T` of the given kind of number.
///
/// # Errors
/// [`Refusal::Operator`], [`Refusal::Long`]. Overflow is [`Reach`]'s business.
pub fn function(tape: &Tape, name: &str, kind: Kind) -> Result<String, Refusal> {
    function_of(tape, name, kind, Width::Single)
}

/// The same for forms and slopes of any width.
///
/// # Errors
/// As for [`function`]; functions, quotients and roots are there in 32 bits only, as are intervals.
pub fn function_of(tape: &Tape, name: &str, kind: Kind, width: Width) -> Result<String, Refusal> {
    if width == Width::Double && (kind == Kind::Interval || needs_functions(tape)) {
        return Err(Refusal::Single);
    }
    let clauses = tape.clauses();
    if clauses.len() > LONGEST {
        return Err(Refusal::Long(clauses.len()));
    }
    let (p, t) = (kind.prefix(), kind.type_name());
    let mut out = format!("fn {name}(x: {t}, y: {t}, z: {t}) -> {t} {{\n");
    let whole = !needs_functions(tape);
    if !whole {
        out.push_str("    lost = false;\n");
    }
    // Which value a slot holds, and whether that is a constant.
    let mut holds = vec![0; tape.slots()];
    let mut constant: Vec<Option<Interval>> = Vec::with_capacity(clauses.len());
    for (i, clause) in clauses.iter().enumerate() {
        let operand = |slot: u32| holds[slot as usize];
        let (a, b) = (operand(clause.a), operand(clause.b));
        let known = |v: usize| if kind == Kind::Interval { None } else { constant.get(v).copied().flatten() };
        let value = match clause.op {
            Op::Constant(k) => literal((kind, width), tape.constants()[k as usize]),
            Op::Axis(axis) => ["x", "y", "z"][axis as usize].to_owned(),
            Op::Unary(Unary::Neg) => format!("{p}_neg(v{a})"),
            Op::Unary(Unary::Abs) => format!("{p}_abs(v{a})"),
            Op::Unary(Unary::Sqr) => format!("{p}_sqr(v{a})"),
            Op::Unary(op) => format!("{p}_{}(v{a})", unary(op)?),
            Op::Powi(n) => power(&mut out, (kind, width), i, a, n),
            Op::Binary(Binary::Pow) => real_power((p, width), a, constant.get(b).copied().flatten())?,
            Op::Binary(op) => binary((p, width), op, (a, known(a)), (b, known(b)))?,
        };
        writeln!(out, "    let v{i} = {value};").expect("strings take any text");
        constant.push(if let Op::Constant(k) = clause.op { Some(tape.constants()[k as usize]) } else { None });
        holds[clause.out as usize] = i;
    }
    if !whole {
        writeln!(out, "    if lost {{ return {p}_unknown(); }}").expect("strings take any text");
    }
    writeln!(out, "    return v{};\n}}", clauses.len() - 1).expect("strings take any text");
    Ok(out)
}

/// Whether [`function`]'s text calls [`FUNCTIONS`].
#[must_use]
pub fn needs_functions(tape: &Tape) -> bool {
    tape.clauses().iter().any(|clause| match clause.op {
        Op::Constant(_) | Op::Axis(_) => false,
        Op::Unary(op) => !matches!(op, Unary::Neg | Unary::Abs | Unary::Sqr),
        Op::Powi(n) => n < 0,
        Op::Binary(op) => matches!(op, Binary::Div | Binary::Pow),
    })
}

/// The name of a function that has an enclosure here.
fn unary(op: Unary) -> Result<&'static str, Refusal> {
    match op {
        Unary::Sqrt | Unary::Exp | Unary::Ln | Unary::Sin | Unary::Cos | Unary::Sinh | Unary::Cosh => Ok(operator(op)),
        _ => Err(Refusal::Operator(operator(op))),
    }
}

/// A power with a constant real exponent, not 0; its sign must be known.
fn real_power((p, width): (&str, Width), a: usize, exponent: Option<Interval>) -> Result<String, Refusal> {
    let positive = |k: Interval| {
        let (m, r) = width.ball(k);
        (m > r).then(|| format!("{p}_real(v{a}, {}, {})", width.number(m), width.number(r)))
    };
    let inverse = |k: Interval| Some(format!("{p}_recip({})", positive(-k)?));
    let found = exponent.and_then(|k| positive(k).or_else(|| inverse(k)));
    found.ok_or(Refusal::Operator("^ with an exponent that varies, or is about 0"))
}

/// A sum, difference or product with a constant has cheaper forms.
fn binary(
    (p, width): (&str, Width),
    op: Binary,
    (a, ka): (usize, Option<Interval>),
    (b, kb): (usize, Option<Interval>),
) -> Result<String, Refusal> {
    Ok(match (op, ka, kb) {
        (Binary::Add, _, Some(k)) => shifted((p, width), a, k),
        (Binary::Sub, _, Some(k)) => shifted((p, width), a, -k),
        (Binary::Add, Some(k), _) => shifted((p, width), b, k),
        (Binary::Mul, _, Some(k)) => scaled((p, width), a, k),
        (Binary::Mul, Some(k), _) => scaled((p, width), b, k),
        (Binary::Div, _, Some(k)) if !k.possibly_zero() => scaled((p, width), a, Interval::ONE / k),
        (Binary::Div, ..) => format!("{p}_div(v{a}, v{b})"),
        (Binary::Add, ..) => format!("{p}_add(v{a}, v{b})"),
        (Binary::Sub, ..) => format!("{p}_sub(v{a}, v{b})"),
        (Binary::Mul, ..) => format!("{p}_mul(v{a}, v{b})"),
        (Binary::Min, ..) => format!("{p}_min(v{a}, v{b})"),
        (Binary::Max, ..) => format!("{p}_max(v{a}, v{b})"),
        (Binary::Pow | Binary::Atan2, ..) => {
            return Err(Refusal::Operator(if op == Binary::Pow { "^" } else { "atan2" }));
        }
    })
}

fn shifted((p, width): (&str, Width), a: usize, k: Interval) -> String {
    let (m, r) = width.ball(k);
    format!("{p}_addk(v{a}, {}, {})", width.number(m), width.number(r))
}

fn scaled((p, width): (&str, Width), a: usize, k: Interval) -> String {
    match width.exact(k) {
        Some(k) => format!("{p}_scale(v{a}, {})", width.number(k)),
        None => {
            let (m, r) = width.ball(k);
            format!("{p}_mulk(v{a}, {}, {})", width.number(m), width.number(r))
        }
    }
}

/// Powers by squaring, from the highest bit down; the steps before the last are written as statements.
fn power(out: &mut String, (kind, width): (Kind, Width), i: usize, a: usize, n: i32) -> String {
    let p = kind.prefix();
    if n == 0 {
        return literal((kind, width), Interval::ONE);
    }
    let inverse = |value: String| if n < 0 { format!("{p}_recip({value})") } else { value };
    let n = n.unsigned_abs();
    if kind == Kind::Interval && n > 2 {
        return inverse(format!("i_pow(v{a}, {n}u)"));
    }
    let mut value = format!("v{a}");
    for bit in (0..n.ilog2()).rev() {
        writeln!(out, "    let v{i}_{bit} = {p}_sqr({value});").expect("strings take any text");
        value = format!("v{i}_{bit}");
        if n >> bit & 1 == 1 {
            writeln!(out, "    let v{i}_{bit}x = {p}_mul({value}, v{a});").expect("strings take any text");
            value = format!("v{i}_{bit}x");
        }
    }
    inverse(value)
}

/// A constant as a number of the kind.
fn literal((kind, width): (Kind, Width), k: Interval) -> String {
    match kind {
        Kind::Interval => {
            let [lo, hi] = outward(k);
            format!("i_const({}, {})", width.number(lo.into()), width.number(hi.into()))
        }
        Kind::Form | Kind::Slope => {
            let (m, r) = width.ball(k);
            format!("{}_const({}, {})", kind.prefix(), width.number(m), width.number(r))
        }
    }
}

/// The number, if the interval holds one only and f32 holds it as a normal number.
#[must_use]
pub fn exact(k: Interval) -> Option<f32> {
    let v = k.lo() as f32;
    (k.lo() == k.hi() && f64::from(v) == k.lo() && (v == 0.0 || v.is_normal())).then_some(v)
}

/// `(m, r)` with `|x - m| <= r` for every x in the interval, `r >= FLOOR`: for numbers that get into f32's range
/// only ([`Reach`] refuses others).
#[must_use]
pub fn ball(k: Interval) -> (f32, f32) {
    let m = k.mid() as f32;
    let m = if m.is_normal() { m } else { 0.0 };
    let r = sub_up(k.hi(), f64::from(m)).max(sub_up(f64::from(m), k.lo()));
    (m, up(r).max(FLOOR))
}

/// The interval with bounds in f32, outside it, never subnormal.
#[must_use]
pub fn outward(k: Interval) -> [f32; 2] {
    [-up(-k.lo()), up(k.hi())]
}

/// A float `>= r` that is normal or 0.
fn up(r: f64) -> f32 {
    let v = r as f32;
    let v = if f64::from(v) < r { v.next_up() } else { v };
    match v {
        _ if v == 0.0 || v.is_normal() => v,
        _ if v > 0.0 => f32::MIN_POSITIVE,
        _ => 0.0,
    }
}

fn operator(op: Unary) -> &'static str {
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
