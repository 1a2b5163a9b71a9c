//! The start-up probe: is the arithmetic of this adapter what the proofs assume?
//!
//! Asked on the user's own adapter, with the very text that the kernels contain: is every fenced operation rounded
//! by itself, alone and in expressions that compilers rewrite; what happens to subnormal numbers. A
//! probe is no proof of a compiler; it finds those that do not respect the fence.
use crate::error::Error;
use crate::machine::{Machine, Usage};
use antumbra::eval::wgsl::{FORMS, FUNCTIONS};
use antumbra_interval::Interval;
use std::fmt;

/// What the probe found in order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Random triples that were asked.
    pub cases: usize,
    /// Subnormal results were kept.
    pub subnormals: bool,
    /// Of the same expressions without fences, how many cases came out differently: what the fence is for.
    pub rewritten: [usize; 6],
}

/// The expressions of [`Report::rewritten`].
pub const BARE: [&str; 6] = ["(x+y)-x", "(x+1e6)-1e6", "x*y+x*z", "(x*3)*.3333", "x*y+z", "1/(1/x)"];

/// What the probe found wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct Doubt {
    /// The first expression that came out wrong.
    pub expression: &'static str,
    /// Its operands.
    pub operands: [f32; 3],
    /// What came out.
    pub found: f32,
    /// What should have, rounded to nearest.
    pub wanted: f32,
    /// Every expression that came out wrong, in how many cases.
    pub all: Vec<(&'static str, usize)>,
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { expression, operands: [x, y, z], found, wanted, all } = self;
        write!(
            f,
            "{expression} with x = {x:e}, y = {y:e}, z = {z:e} gave {found:e} instead of {wanted:e} (wrong of {CASES} cases:"
        )?;
        for (expression, count) in all {
            write!(f, " {expression} {count};")?;
        }
        f.write_str(")")
    }
}

const FENCED: [&str; 18] = [
    "x + y",
    "x - y",
    "x * y",
    "(x + y) - x",
    "(x + 1e6) - 1e6",
    "x*y + x*z",
    "(x * 3) * .3333",
    "x*y + z",
    "x*y - y*x",
    "((x + y) + z) - (x + (y + z))",
    "x / y",
    "the error of a product of forms",
    "the enclosure of 1/x",
    "the enclosure of sqrt(x)",
    "the enclosure of ln(x)",
    "the enclosure of exp(x)",
    "the enclosure of sin(x)",
    "the enclosure of cos(x)",
];

const CASES: usize = 1 << 14;

pub(crate) fn text() -> String {
    format!("{FORMS}\n{FUNCTIONS}\n{}", include_str!("probe.wgsl"))
}

/// Probes a GPU of which nothing is known yet.
///
/// # Errors
/// [`Error::Doubt`], or those of the device.
pub async fn run<M: Machine>(gpu: &M) -> Result<Report, Error> {
    run_text(gpu, &text()).await
}

/// Runs the probe with the given text: the real one, or one that was broken to see the probe find it.
pub(crate) async fn run_text<M: Machine>(gpu: &M, text: &str) -> Result<Report, Error> {
    let cases = cases();
    let zero = gpu.filled(bytemuck::cast_slice(&[0_u32; 4]), Usage::Uniform)?;
    let input = gpu.filled(bytemuck::cast_slice(&cases), Usage::Storage)?;
    let fenced = gpu.buffer((cases.len() * 48) as u64, Usage::Storage)?;
    let bare = gpu.buffer((cases.len() * 24) as u64, Usage::Storage)?;
    let functions = gpu.buffer((cases.len() * 48) as u64, Usage::Storage)?;
    let pipeline = gpu.pipeline(text, "probe", &[])?;
    let bind = gpu.bind(&pipeline, &[(0, &zero), (1, &input), (2, &fenced), (3, &bare), (4, &functions)])?;
    gpu.run(&pipeline, &bind, cases.len().div_ceil(64) as u32).await?;
    let fenced: Vec<[f32; 12]> = gpu.read_all(&fenced).await?;
    let bare: Vec<[f32; 6]> = gpu.read_all(&bare).await?;
    let functions: Vec<[[f32; 2]; 6]> = gpu.read_all(&functions).await?;

    let mut report = Report { cases: cases.len(), subnormals: true, rewritten: [0; 6] };
    let (mut first, mut counts) = (None, [0; FENCED.len()]);
    for (((case, fenced), bare), functions) in cases.iter().zip(&fenced).zip(&bare).zip(&functions) {
        let [x, y, z, _] = *case;
        for k in 0..12 {
            if let Some(wanted) = judge(&mut report, k, [x, y, z], fenced[k]) {
                counts[k] += 1;
                first.get_or_insert((k, [x, y, z], fenced[k], wanted));
            }
        }
        for k in 0..6 {
            if let Some(wanted) = judge_function(k, x, functions[k]) {
                counts[12 + k] += 1;
                first.get_or_insert((12 + k, [x, y, z], functions[k][0], wanted));
            }
        }
        let wanted = [(x + y) - x, (x + 1e6) - 1e6, x * y + x * z, (x * 3.0) * 0.3333, x * y + z, 1.0 / (1.0 / x)];
        for k in 0..6 {
            report.rewritten[k] += usize::from(!same(bare[k], wanted[k]) && !tiny_parts([x, y, z], wanted[k]));
        }
    }
    let Some((k, operands, found, wanted)) = first else { return Ok(report) };
    let all = FENCED.into_iter().zip(counts).filter(|(_, count)| *count > 0).collect();
    let doubt = Doubt { expression: FENCED[k], operands, found, wanted, all };
    Err(Error::Doubt { adapter: gpu.name().to_owned(), doubt })
}

/// The same number; the sign of zero does not matter, nor what is beyond the numbers that are proved to occur.
fn same(a: f32, b: f32) -> bool {
    a == b || !b.is_finite()
}

/// Whether some part of an expression may be subnormal, so that a GPU may take it for 0.
fn tiny_parts([x, y, z]: [f32; 3], value: f32) -> bool {
    let parts = [x, y, z, x * y, x * z, y * z, x + y, x - y, y + z, x / y, 1.0 / x, value];
    parts.iter().any(|v| v.abs() < 4.0 * f32::MIN_POSITIVE)
}

/// What expression number `k` should have given, if it gave something else.
///
/// Bit for bit: proofs would do with either neighbour of an exact value, but all known adapters round to nearest, and only so can the
/// expressions be told from rewritten ones. Single operations may take subnormal operands and results for 0; expressions with
/// subnormal parts are not judged.
pub(crate) fn judge(report: &mut Report, k: usize, [x, y, z]: [f32; 3], found: f32) -> Option<f32> {
    if k < 3 {
        let flush = |v: f32| if v.abs() < f32::MIN_POSITIVE { 0.0 } else { v };
        let of = |x: f32, y: f32| [x + y, x - y, x * y][k];
        let wanted = of(x, y);
        if same(found, wanted) {
            return None;
        }
        // Where no operand and no result is subnormal, all these are the same number.
        let operands = [(x, y), (flush(x), y), (x, flush(y)), (flush(x), flush(y))];
        let allowed = operands.into_iter().any(|(x, y)| found == of(x, y) || found == flush(of(x, y)));
        report.subnormals &= !allowed;
        return (!allowed).then_some(wanted);
    }
    let form = || {
        let sum3 = |s: f32, a: [f32; 3]| s + a[0].abs() + a[1].abs() + a[2].abs();
        let (e, u) = (1e-6_f32, f32::EPSILON);
        let (r, t) = (sum3(e, [y, z, x]), sum3(e, [z, x, y]));
        let w = [y * z, z * x, x * y];
        let d = w[0].abs() + w[1].abs() + w[2].abs();
        let rest = x.abs() * t + r * (y.abs() + t);
        let pad = 4.0 * u * (x * y).abs() + 28.0 * u * rest;
        (r * t - 0.5 * d) + (x.abs() * e + y.abs() * e) + pad + antumbra::eval::wgsl::FLOOR
    };
    let wanted = match k {
        3 => (x + y) - x,
        4 => (x + 1e6) - 1e6,
        5 => x * y + x * z,
        6 => (x * 3.0) * 0.3333,
        7 => x * y + z,
        8 => 0.0,
        9 => ((x + y) + z) - (x + (y + z)),
        10 => x / y,
        _ => form(),
    };
    // A zero difference of equal parts is right whatever the parts are.
    let vague = tiny_parts([x, y, z], if k == 8 { 1.0 } else { wanted }) && wanted != found;
    // A division may be off by 2.5 units.
    let close = k == 10 && (found - wanted).abs() <= 4.0 * f32::EPSILON * wanted.abs();
    (!same(found, wanted) && !close && !vague).then_some(wanted)
}

/// What function number `k` of `x` is about, if its enclosure `[middle, error]` does not hold it or is wider than it should be.
fn judge_function(k: usize, x: f32, [middle, error]: [f32; 2]) -> Option<f32> {
    let at = |v: f32| Interval::point(f64::from(v));
    let a = at(x.abs().clamp(2.0_f32.powi(-60), 2.0_f32.powi(60)));
    // The clamp of a subnormal number may be 0.
    let w = at(if x.is_subnormal() { 0.0 } else { x.clamp(-1000.0, 1000.0) });
    let e = at(if x.is_subnormal() { 0.0 } else { x.clamp(-59.0, 40.0) });
    let value = match k {
        0 => Interval::ONE / a,
        1 => a.sqrt(),
        2 => a.ln(),
        3 => e.exp(),
        4 => w.sin(),
        _ => w.cos(),
    };
    // Units of 2^-23 of the value, and for logarithms and waves of 1.
    let size = value.magnitude() + if matches!(k, 2 | 4 | 5) { 1.0 } else { 0.0 };
    let fine = (value - at(middle)).magnitude() <= f64::from(error)
        && f64::from(error) <= 8.0 * f64::from(f32::EPSILON) * size;
    (!fine).then_some(value.mid() as f32)
}

/// Random numbers of many sizes, small whole numbers, and subnormal ones.
pub(crate) fn cases() -> Vec<[f32; 4]> {
    let mut state = 7_u64;
    let mut bits = move || {
        // SplitMix64 (Steele, Lea, Flood 2014).
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) as u32
    };
    let mut number = move |case: usize| {
        let b = bits();
        let fraction = b & 0x807f_ffff;
        match case % 4 {
            // In +-[1/8, 8).
            0 | 1 => f32::from_bits(fraction | (124 + (b >> 23) % 6) << 23),
            // In +-[2^-40, 2^40).
            2 => f32::from_bits(fraction | (87 + (b >> 23) % 80) << 23),
            // Exponents at the lower end, and whole numbers.
            _ if case % 8 == 3 => f32::from_bits(fraction | ((b >> 23) % 70) << 23),
            _ => (b % 64) as f32 - 31.0,
        }
    };
    (0..CASES).map(|case| [number(case), number(case), number(case), 0.0]).collect()
}
