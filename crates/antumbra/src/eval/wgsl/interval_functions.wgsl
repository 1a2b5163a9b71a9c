// The functions of `functions.wgsl` over intervals: by their ends where they are monotone, waves also by their extrema in between.

fn i_unknown() -> vec2<f32> { return vec2<f32>(-1.0, 1.0); }
fn i_lost() -> vec2<f32> { lost = true; return vec2<f32>(1.0, 1.0); }
fn low(b: Ball) -> f32 { return down(b.m - b.r); }
fn high(b: Ball) -> f32 { return up(b.m + b.r); }

fn i_recip(x: vec2<f32>) -> vec2<f32> {
    if x.y <= -POLE && x.x >= -LARGE {
        return vec2<f32>(-high(b_recip(-x.y)), -low(b_recip(-x.x)));
    }
    if x.x >= POLE && x.y <= LARGE { return vec2<f32>(low(b_recip(x.y)), high(b_recip(x.x))); }
    return i_lost();
}
fn i_div(x: vec2<f32>, y: vec2<f32>) -> vec2<f32> { return i_mul(x, i_recip(y)); }
fn i_sqrt(x: vec2<f32>) -> vec2<f32> {
    if !(x.y <= LARGE) { return i_lost(); }
    return vec2<f32>(max(low(b_sqrt(max(x.x, 0.0))), 0.0), high(b_sqrt(max(x.y, 0.0))));
}
fn i_exp(x: vec2<f32>) -> vec2<f32> {
    if !(x.y <= 20.0) { return i_lost(); }
    return vec2<f32>(max(low(b_exp(x.x)), 0.0), high(b_exp(x.y)));
}
fn i_ln(x: vec2<f32>) -> vec2<f32> {
    if !(x.x >= SMALL && x.y <= LARGE) { return i_lost(); }
    return vec2<f32>(low(b_ln(x.x)), high(b_ln(x.y)));
}
fn i_real(x: vec2<f32>, m: f32, r: f32) -> vec2<f32> {
    if !(x.y <= LARGE) { return i_lost(); }
    var lo = 0.0;
    if x.x >= SMALL { lo = i_exp(i_by(i_ln(vec2<f32>(x.x, x.x)), m, r)).x; }
    return vec2<f32>(lo, i_exp(i_by(i_ln(vec2<f32>(max(x.y, SMALL), max(x.y, SMALL))), m, r)).y);
}
fn i_by(x: vec2<f32>, m: f32, r: f32) -> vec2<f32> { return i_mul(x, vec2<f32>(down(m - r), up(m + r))); }
// Whether a whole number n + 4 j lies in [q.x, q.y].
fn meets(q: vec2<f32>, n: f32) -> bool { return add(mul(4.0, ceil(mul(0.25, sub(q.x, n)))), n) <= q.y; }
// Waves with their maxima at the quarter turn `top`. Quarter turns are known to 2 * 637 u: 0.001 is ample, and costs 2e-6 at an extremum.
fn i_wave(x: vec2<f32>, a: Ball, b: Ball, top: f32) -> vec2<f32> {
    let q = vec2<f32>(sub(mul(x.x, 0.63661975), 0.001), add(mul(x.y, 0.63661975), 0.001));
    var lo = max(min(low(a), low(b)), -1.0);
    var hi = min(max(high(a), high(b)), 1.0);
    if meets(q, top) { hi = 1.0; }
    if meets(q, top + 2.0) { lo = -1.0; }
    return vec2<f32>(lo, hi);
}
fn i_sin(x: vec2<f32>) -> vec2<f32> {
    if !(x.x >= -1000.0 && x.y <= 1000.0) { return i_unknown(); }
    let a = b_wave(x.x);
    let b = b_wave(x.y);
    return i_wave(x, Ball(a.s, a.e), Ball(b.s, b.e), 1.0);
}
fn i_cos(x: vec2<f32>) -> vec2<f32> {
    if !(x.x >= -1000.0 && x.y <= 1000.0) { return i_unknown(); }
    let a = b_wave(x.x);
    let b = b_wave(x.y);
    return i_wave(x, Ball(a.c, a.e), Ball(b.c, b.e), 0.0);
}
fn i_sinh(x: vec2<f32>) -> vec2<f32> {
    let d = i_sub(i_exp(x), i_exp(i_neg(x)));
    return vec2<f32>(0.5 * d.x, 0.5 * d.y);
}
fn i_cosh(x: vec2<f32>) -> vec2<f32> {
    let m = i_abs(x);
    // e^m + e^-m grows with m >= 0.
    let lo = i_add(i_exp(vec2<f32>(m.x, m.x)), i_exp(vec2<f32>(-m.x, -m.x))).x;
    let hi = i_add(i_exp(vec2<f32>(m.y, m.y)), i_exp(vec2<f32>(-m.y, -m.y))).y;
    return vec2<f32>(max(0.5 * lo, 1.0), 0.5 * hi);
}
