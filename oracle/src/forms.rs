//! Affine forms and slopes against MPFR: at exact members of their operands, with values to 200 bits.
use crate::nasty::Generator;
use antumbra_interval::Interval;
use antumbra_interval::affine::{Affine, Apex, Slope};
use rug::Float;
use rug::float::Round;
use rug::ops::PowAssignRound;

/// Bits of a reference value.
const BITS: u32 = 200;
/// Bits in which sums and products of a few floats of ordinary size are exact.
const EXACT: u32 = 2200;

/// An operator that forms have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Operator {
    Unary(Unary),
    Power(i32),
    Binary(Binary),
}

/// Kinds of forms: the operators by name.
trait Form: Copy {
    fn apply(operator: Operator, a: Self, b: Self) -> Self;
}

macro_rules! operators {
    (unary: $($unary:ident $u:ident)*; binary: $($binary:ident $b:ident)*;) => {
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(crate) enum Unary { Neg, $($unary,)* }
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(crate) enum Binary { Add, Sub, Mul, Div, $($binary,)* }

        const UNARY: &[Unary] = &[Unary::Neg, $(Unary::$unary,)*];
        const BINARY: &[Binary] = &[Binary::Add, Binary::Sub, Binary::Mul, Binary::Div, $(Binary::$binary,)*];

        operators!(@form [const N: usize] Affine<N>; $($unary $u)*; $($binary $b)*;);
        operators!(@form [P: Apex<Affine<N>>, const N: usize] Slope<P, N>; $($unary $u)*; $($binary $b)*;);
    };
    (@form [$($generics:tt)*] $kind:ty; $($unary:ident $u:ident)*; $($binary:ident $b:ident)*;) => {
        impl<$($generics)*> Form for $kind {
            fn apply(operator: Operator, a: Self, b: Self) -> Self {
                match operator {
                    Operator::Unary(Unary::Neg) => -a,
                    $(Operator::Unary(Unary::$unary) => a.$u(),)*
                    Operator::Power(n) => a.powi(n),
                    Operator::Binary(Binary::Add) => a + b,
                    Operator::Binary(Binary::Sub) => a - b,
                    Operator::Binary(Binary::Mul) => a * b,
                    Operator::Binary(Binary::Div) => a / b,
                    $(Operator::Binary(Binary::$binary) => a.$b(b),)*
                }
            }
        }
    };
}
operators! {
    unary: Abs abs Sign sign Floor floor Sqr sqr Sqrt sqrt Cbrt cbrt Exp exp Ln ln Sin sin Cos cos Tan tan Asin asin
        Acos acos Atan atan Sinh sinh Cosh cosh Tanh tanh;
    binary: Min min Max max Pow pow Atan2 atan2;
}

pub(crate) fn operators() -> Vec<Operator> {
    let powers = [-9, -3, -2, -1, 3, 4, 5, 8, 9, 17].map(Operator::Power);
    let unary = UNARY.iter().map(|op| Operator::Unary(*op));
    unary.chain(powers).chain(BINARY.iter().map(|op| Operator::Binary(*op))).collect()
}

impl Operator {
    fn name(self) -> String {
        match self {
            Self::Unary(op) => format!("{op:?}").to_lowercase(),
            Self::Power(n) => format!("powi {n}"),
            Self::Binary(op) => format!("{op:?}").to_lowercase(),
        }
    }

    /// Bounds of the value at floats; `None` where it is undefined.
    fn truth(self, a: f64, b: f64) -> Option<[Float; 2]> {
        self.defined(a, b).then(|| [Round::Down, Round::Up].map(|round| self.rounded(a, b, round)))
    }

    fn defined(self, a: f64, b: f64) -> bool {
        match self {
            Self::Unary(Unary::Sqrt) => a >= 0.0,
            Self::Unary(Unary::Ln) => a > 0.0,
            Self::Unary(Unary::Asin | Unary::Acos) => a.abs() <= 1.0,
            Self::Power(n) => n >= 0 || a != 0.0,
            Self::Binary(Binary::Div) => b != 0.0,
            Self::Binary(Binary::Pow) => a > 0.0 || (a == 0.0 && b > 0.0),
            Self::Binary(Binary::Atan2) => a != 0.0 || b != 0.0,
            _ => true,
        }
    }

    /// The value, written down here once more, apart from the evaluators.
    fn rounded(self, a: f64, b: f64, round: Round) -> Float {
        // One zero.
        let (mut v, w) = (Float::with_val(BITS, a + 0.0), Float::with_val(BITS, b + 0.0));
        match self {
            Self::Unary(op) => match op {
                Unary::Neg => return -v,
                Unary::Abs => return v.abs(),
                Unary::Sign => return Float::with_val(BITS, i8::from(a > 0.0) - i8::from(a < 0.0)),
                Unary::Floor => return v.floor(),
                Unary::Sqr => v.square_round(round),
                Unary::Sqrt => v.sqrt_round(round),
                Unary::Cbrt => v.cbrt_round(round),
                Unary::Exp => v.exp_round(round),
                Unary::Ln => v.ln_round(round),
                Unary::Sin => v.sin_round(round),
                Unary::Cos => v.cos_round(round),
                Unary::Tan => v.tan_round(round),
                Unary::Asin => v.asin_round(round),
                Unary::Acos => v.acos_round(round),
                Unary::Atan => v.atan_round(round),
                Unary::Sinh => v.sinh_round(round),
                Unary::Cosh => v.cosh_round(round),
                Unary::Tanh => v.tanh_round(round),
            },
            Self::Power(n) => v.pow_assign_round(n, round),
            Self::Binary(op) => match op {
                Binary::Add => return Float::with_val_round(BITS, &v + &w, round).0,
                Binary::Sub => return Float::with_val_round(BITS, &v - &w, round).0,
                Binary::Mul => return Float::with_val_round(BITS, &v * &w, round).0,
                Binary::Div => return Float::with_val_round(BITS, &v / &w, round).0,
                Binary::Min => return if a < b { v } else { w },
                Binary::Max => return if a > b { v } else { w },
                Binary::Pow => v.pow_assign_round(&w, round),
                Binary::Atan2 => v.atan2_round(&w, round),
            },
        };
        v
    }
}

/// A multiple of 2^-20 in [-1, 1]: products and sums of a few of them are exact floats.
fn coarse(g: &mut Generator) -> f64 {
    (g.below((1 << 21) + 1) as f64 - f64::from(1 << 20)) / f64::from(1 << 20)
}

/// A multiple of 1/8 in [-1, 1], often an end.
fn symbol(g: &mut Generator) -> f64 {
    (match g.below(3) {
        0 => 8.0,
        1 => -8.0,
        _ => g.below(17) as f64 - 8.0,
    }) / 8.0
}

/// A form and a member of it at the symbol values `s`: an exact float.
fn form<const N: usize>(g: &mut Generator, s: &[f64; N]) -> (Affine<N>, f64) {
    let c = coarse(g) * [0.0, 1.0, 4.0, 16.0][g.below(4) as usize];
    let scale = [0.0, 1.0, 2.0, 1.0 / 1024.0, 1.0 / f64::from(1 << 20)][g.below(5) as usize];
    let a: [f64; N] = std::array::from_fn(|_| coarse(g) * scale);
    let e = if g.below(2) == 0 { 0.0 } else { coarse(g).abs() * scale };
    let value = (0..N).fold(c + e * symbol(g), |sum, i| sum + a[i] * s[i]);
    (Affine::linear(c, a, e), value)
}

/// The plane of a known form at symbol values, exactly.
fn plane<const N: usize>(x: &Affine<N>, s: &[f64; N]) -> Float {
    let mut sum = Float::with_val(EXACT, x.centre());
    for (a, s) in x.coefficients().iter().zip(s) {
        sum += Float::with_val(106, Float::with_val(53, *a) * *s);
    }
    sum
}

/// The distance of `truth / t` from the plane of a form at symbol values, in units of its error bound: above 1 if the form
/// does not admit it. `None` for forms that say nothing.
fn strain<const N: usize>(x: &Affine<N>, s: &[f64; N], t: f64, truth: &[Float; 2]) -> Option<f64> {
    if !x.is_known() {
        return None;
    }
    let plane = plane(x, s) * t;
    let far = Float::with_val(EXACT, &truth[0] - &plane).max(&Float::with_val(EXACT, &plane - &truth[1]));
    let bound = Float::with_val(EXACT, x.error()) * t;
    if far <= bound {
        return Some(if bound > 0u32 { (far.clone() / bound).to_f64().max(0.0) } else { 0.0 });
    }
    Some(f64::INFINITY)
}

/// What came of the forms of one operator.
pub(crate) struct Count {
    operator: Operator,
    /// Comparisons of planes with values.
    pub(crate) checks: u64,
    values: u64,
    slopes: u64,
    unknown: u64,
    strain: [f64; 2],
    pub(crate) violations: Vec<String>,
}

pub(crate) fn check(operator: Operator, points: u64, seed: u64) -> Count {
    let mut count =
        Count { operator, checks: 0, values: 0, slopes: 0, unknown: 0, strain: [0.0; 2], violations: vec![] };
    let salt = operator.name().bytes().fold(seed, |s, b| s.wrapping_mul(0x100_0000_01b3) ^ u64::from(b));
    let mut g = Generator(salt);
    for _ in 0..points {
        value::<1>(operator, &mut g, &mut count);
        value::<3>(operator, &mut g, &mut count);
        value::<5>(operator, &mut g, &mut count);
        slope::<Interval, 3>(operator, &mut g, &mut count);
        slope::<Affine<5>, 5>(operator, &mut g, &mut count);
    }
    count
}

fn value<const N: usize>(operator: Operator, g: &mut Generator, count: &mut Count) {
    let s: [f64; N] = std::array::from_fn(|_| symbol(g));
    let ((a, p), (b, q)) = (form(g, &s), form(g, &s));
    let Some(truth) = operator.truth(p, q) else { return };
    count.checks += 1;
    count.values += 1;
    let y = Form::apply(operator, a, b);
    match strain(&y, &s, 1.0, &truth) {
        None => count.unknown += 1,
        Some(strain) if strain <= 1.0 => count.strain[0] = count.strain[0].max(strain),
        Some(_) => count.violations.push(format!(
            "{} of {a:?}, {b:?} at {s:?}: {y:?} does not admit {truth:?}, the value at {p}, {q}",
            operator.name()
        )),
    }
}

/// `f(P + t D) = f(P) + t g` where P, t and D are exact floats: t in [0, 1] from symbol 0.
fn slope<P: Apex<Affine<N>> + std::fmt::Debug, const N: usize>(
    operator: Operator,
    g: &mut Generator,
    count: &mut Count,
) {
    let s: [f64; N] = std::array::from_fn(|_| symbol(g));
    let t = Affine::linear(0.5, std::array::from_fn(|i| if i == 0 { 0.5 } else { 0.0 }), 0.0);
    let tau = 0.5 * s[0] + 0.5;
    let mut operand = || {
        let p = coarse(g) * [1.0, 4.0, 16.0][g.below(3) as usize];
        let (d, direction) = form(g, &s);
        // Multiples of 2^-43 below 64, times a multiple of 2^-4: exact floats.
        (Slope::<P, N>::coordinate(P::constant(Interval::point(p)), t, d), p, p + tau * direction)
    };
    let ((a, p, p_end), (b, q, q_end)) = (operand(), operand());
    let (Some(from), Some(to)) = (operator.truth(p, q), operator.truth(p_end, q_end)) else { return };
    if tau == 0.0 {
        return;
    }
    count.checks += 1;
    count.slopes += 1;
    let y = Form::apply(operator, a, b);
    let rise = [
        Float::with_val_round(EXACT, &to[0] - &from[1], Round::Down).0,
        Float::with_val_round(EXACT, &to[1] - &from[0], Round::Up).0,
    ];
    match strain(&y.slope, &s, tau, &rise) {
        None => count.unknown += 1,
        Some(strain) if strain <= 1.0 => count.strain[1] = count.strain[1].max(strain),
        Some(_) => count.violations.push(format!(
            "{} of {a:?}, {b:?} at {s:?}: {y:?} does not admit the rise {rise:?} from {p}, {q} to {p_end}, {q_end}",
            operator.name()
        )),
    }
}

/// A table in Markdown.
pub(crate) fn table(counts: &[Count]) -> String {
    let mut out = String::from(
        "| operator on forms | values | slopes | said nothing | violations | most of the error bound used: values, slopes |\n\
         |---|---:|---:|---:|---:|---:|\n",
    );
    for c in counts {
        out += &format!(
            "| `{}` | {} | {} | {} | {} | {:.3}, {:.3} |\n",
            c.operator.name(),
            c.values,
            c.slopes,
            c.unknown,
            c.violations.len(),
            c.strain[0],
            c.strain[1]
        );
    }
    out
}
