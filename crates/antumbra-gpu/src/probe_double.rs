//! The same for the 64-bit numbers of an adapter that has them: who fails here is not asked in 64 bits.
use crate::error::Error;
use crate::machine::{Machine, Usage};
use antumbra::eval::wgsl::{FLOOR, Width};

/// Cases that are asked.
const CASES: usize = 1 << 12;

pub(crate) fn text() -> String {
    format!("{}\n{}", Width::Double.forms(), include_str!("probe_double.wgsl"))
}

/// Whether every expression of the text comes out as it should, bit for bit. Subnormal numbers do not occur.
///
/// # Errors
/// Those of the device.
pub(crate) async fn passes<M: Machine>(gpu: &M, text: &str) -> Result<bool, Error> {
    let cases = cases();
    let zero = gpu.filled(bytemuck::cast_slice(&[0_u32; 4]), Usage::Uniform)?;
    let input = gpu.filled(bytemuck::cast_slice(&cases), Usage::Storage)?;
    let output = gpu.buffer((cases.len() * 96) as u64, Usage::Storage)?;
    let pipeline = gpu.pipeline(text, "probe", &[])?;
    let bind = gpu.bind(&pipeline, &[(0, &zero), (1, &input), (2, &output)])?;
    gpu.run(&pipeline, &bind, cases.len().div_ceil(64) as u32).await?;
    let found: Vec<[f64; 12]> = gpu.read_all(&output).await?;
    Ok(cases.iter().zip(&found).all(|(case, found)| *found == wanted(*case)))
}

/// What the expressions give where every operation is rounded to nearest.
pub(crate) fn wanted([x, y, z]: [f64; 3]) -> [f64; 12] {
    let (e, u) = (1e-6, f64::EPSILON);
    let sum3 = |s: f64, a: [f64; 3]| s + a[0].abs() + a[1].abs() + a[2].abs();
    let (r, t) = (sum3(e, [y, z, x]), sum3(e, [z, x, y]));
    let w = [y * z, z * x, x * y];
    let d = w[0].abs() + w[1].abs() + w[2].abs();
    let rest = x.abs() * t + r * (y.abs() + t);
    let pad = 4.0 * u * (x * y).abs() + 28.0 * u * rest;
    let form = (r * t - 0.5 * d) + (x.abs() * e + y.abs() * e) + pad + f64::from(FLOOR);
    [
        x + y,
        x - y,
        x * y,
        (x + y) - x,
        (x + 1e6) - 1e6,
        x * y + x * z,
        (x * 3.0) * 0.3333,
        x * y + z,
        0.0,
        ((x + y) + z) - (x + (y + z)),
        x + y * z,
        form,
    ]
}

/// Numbers of many sizes, in +-[2^-40, 2^40), most of them near 1.
pub(crate) fn cases() -> Vec<[f64; 3]> {
    let mut state = 11_u64;
    let mut number = move |case: usize| {
        // SplitMix64 (Steele, Lea, Flood 2014).
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let b = z ^ (z >> 31);
        let exponent = if case.is_multiple_of(3) { 983 + (b >> 52) % 80 } else { 1020 + (b >> 52) % 6 };
        f64::from_bits(b & 0x800f_ffff_ffff_ffff | exponent << 52)
    };
    (0..CASES).map(|case| [number(case), number(case), number(case)]).collect()
}
