//! Boxes and points where rounding errors, domain edges and poles hide.
use antumbra_interval::Interval;
use fastrand::Rng;
use std::f64::consts::FRAC_PI_2;

/// `2^e`, subnormal ones included.
pub(crate) fn power_of_two(e: i32) -> f64 {
    if e >= -1022 { f64::from_bits(((e + 1023) as u64) << 52) } else { f64::from_bits(1 << (e + 1074)) }
}

/// `steps` floats further up, or down if negative; finite.
fn nudge(x: f64, steps: i32) -> f64 {
    let moved = (0..steps.abs()).fold(x, |x, _| if steps > 0 { x.next_up() } else { x.next_down() });
    moved.clamp(f64::MIN, f64::MAX)
}

/// A finite number of a kind that breaks things.
pub(crate) fn number(r: &mut Rng) -> f64 {
    let magnitude = match r.u32(0..14) {
        0 => 0.0,
        1 => power_of_two(r.i32(-1074..1024)),
        2 => nudge(power_of_two(r.i32(-1020..1020)), r.i32(-3..4)),
        3 => f64::from_bits(r.u64(0..1 << 52)),
        4 => f64::from_bits(r.u64(0..5)),
        5 => nudge(f64::MAX, -r.i32(0..4)),
        6 => nudge(f64::from(r.u32(0..20)), r.i32(-2..3)),
        // Few bits: products and sums that are exact or ties.
        7 => r.u32(0..1 << 27) as f64 * power_of_two(r.i32(-30..30)),
        // Extrema and poles of the periodic functions.
        8 => nudge(FRAC_PI_2 * f64::from(r.u32(0..1000)), r.i32(-2..3)),
        9 => f64::from_bits(r.u64(0..f64::INFINITY.to_bits())),
        // Where exp and sinh over- or underflow.
        10 => nudge([708.0, 709.782712893384, 710.4758600739439, 745.1332191019411][r.usize(0..4)], r.i32(-3..4)),
        // Ends of the domain of asin and acos.
        11 => nudge(1.0, r.i32(-4..5)),
        _ => r.f64() * 10.0,
    };
    if r.bool() { magnitude } else { -magnitude }
}

/// An interval that is not empty: often a point or a few floats wide, sometimes unbounded.
pub(crate) fn interval(r: &mut Rng) -> Interval {
    let a = number(r);
    let b = match r.u32(0..12) {
        0 | 1 => a,
        2 | 3 => nudge(a, r.i32(-5..6)),
        4 => -a,
        5 | 6 => (a * (1.0 + r.f64())).clamp(f64::MIN, f64::MAX),
        7 | 8 => (a + power_of_two(r.i32(-30..4))).clamp(f64::MIN, f64::MAX),
        9 => [f64::INFINITY, f64::NEG_INFINITY][r.usize(0..2)],
        _ => number(r),
    };
    if a <= b { Interval::new(a, b) } else { Interval::new(b, a) }
}

/// A finite member: often a bound.
pub(crate) fn member(r: &mut Rng, x: Interval) -> f64 {
    let (lo, hi) = (x.lo().max(f64::MIN), x.hi().min(f64::MAX));
    match r.u32(0..5) {
        0 => lo,
        1 => hi,
        2 => number(r).clamp(lo, hi),
        _ => {
            let s = r.f64();
            (lo * (1.0 - s) + hi * s).clamp(lo, hi)
        }
    }
}
