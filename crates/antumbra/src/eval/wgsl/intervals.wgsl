// Intervals [x, y] in f32 for the paper's method: natural extensions, rounded outward on the integer bits.
//
// A rounded operation returns a neighbour of the exact value, so one step outward encloses it; the step is integer arithmetic, which no
// float optimiser can undo (a constant step could be folded: it is added to a zero known at run time only). A result below
// 2^-126 may have been flushed: its bounds are +-2^-126, and 0 where a sign is known. Overflow is excluded beforehand (`wgsl::Reach`).

const MIN_NORMAL: f32 = 1.1754944e-38;

fn down(r: f32) -> f32 {
    if abs(r) < MIN_NORMAL { return -MIN_NORMAL; }
    let step = i32(1u + runtime_zero());
    let q = bitcast<f32>(bitcast<i32>(r) + select(-step, step, r < 0.0));
    return select(q, 0.0, r > 0.0 && q < MIN_NORMAL);
}
fn up(r: f32) -> f32 { return -down(-r); }

fn i_const(lo: f32, hi: f32) -> vec2<f32> { return vec2<f32>(lo, hi); }
fn i_neg(x: vec2<f32>) -> vec2<f32> { return vec2<f32>(-x.y, -x.x); }
fn i_add(x: vec2<f32>, y: vec2<f32>) -> vec2<f32> { return vec2<f32>(down(x.x + y.x), up(x.y + y.y)); }
fn i_sub(x: vec2<f32>, y: vec2<f32>) -> vec2<f32> { return vec2<f32>(down(x.x - y.y), up(x.y - y.x)); }
fn i_mul(x: vec2<f32>, y: vec2<f32>) -> vec2<f32> {
    let a = x.x * y.x;
    let b = x.x * y.y;
    let c = x.y * y.x;
    let d = x.y * y.y;
    return vec2<f32>(min(min(down(a), down(b)), min(down(c), down(d))), max(max(up(a), up(b)), max(up(c), up(d))));
}
fn i_sqr(x: vec2<f32>) -> vec2<f32> {
    let m = abs(x);
    let far = max(m.x, m.y);
    let near = select(min(m.x, m.y), 0.0, x.x <= 0.0 && x.y >= 0.0);
    return vec2<f32>(max(down(near * near), 0.0), up(far * far));
}
fn i_abs(x: vec2<f32>) -> vec2<f32> {
    let m = abs(x);
    return vec2<f32>(select(min(m.x, m.y), 0.0, x.x <= 0.0 && x.y >= 0.0), max(m.x, m.y));
}
fn i_min(x: vec2<f32>, y: vec2<f32>) -> vec2<f32> { return min(x, y); }
fn i_max(x: vec2<f32>, y: vec2<f32>) -> vec2<f32> { return max(x, y); }
// Bounds of m^n for m >= 0, n >= 1.
fn i_point_power(m: f32, n: u32) -> vec2<f32> {
    var p = vec2<f32>(m, m);
    for (var bit = firstLeadingBit(n); bit > 0u; bit--) {
        p = vec2<f32>(max(down(p.x * p.x), 0.0), up(p.y * p.y));
        if ((n >> (bit - 1u)) & 1u) == 1u { p = vec2<f32>(max(down(p.x * m), 0.0), up(p.y * m)); }
    }
    return p;
}
// x^n, n >= 1, by its ends: monotone on both sides of 0.
fn i_pow(x: vec2<f32>, n: u32) -> vec2<f32> {
    let a = i_point_power(abs(x.x), n);
    let b = i_point_power(abs(x.y), n);
    if (n & 1u) == 1u { return vec2<f32>(select(-a.y, a.x, x.x >= 0.0), select(-b.x, b.y, x.y >= 0.0)); }
    return vec2<f32>(select(min(a.x, b.x), 0.0, x.x <= 0.0 && x.y >= 0.0), max(a.y, b.y));
}
