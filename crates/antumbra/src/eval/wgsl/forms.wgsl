// Balls, affine forms and slopes in f32, enclosing whatever the compiler of the driver does.
//
// Every rounded operation stands alone: its result passes through `fence`, an exclusive or of its bits with a zero that is
// known at run time only, so that no operation can be contracted, reassociated or cancelled with another. What is left is WGSL's
// "correctly rounded" for + - *: one of the two neighbours of the exact value. So |fl(x op y) - x op y| <= u |fl(x op y)| with
// u = 2^-23, unless a subnormal number is flushed (2^-126 for a result; for an operand 2^-126 times the other one).
// With that u the step counts are those of the affine forms in f64 (`antumbra_interval::affine`), beside whose code they are derived.
//
// The centre of a product is rounded twice at most: that counts by itself, |c_a c_b| being much larger than what depends on the radii
// R = |a|_1 + e where rounding matters at all.
//
// Flushing, of operands and of results: every error bound that occurs is at least F = 2^-100 (constants and coordinates begin with it,
// products add it; |x| may have half of it, which the slack below covers). In products a flushed operand costs 2^-126 times the other one; the terms R |c_b| and |c_a| T of `rest` contain F |c_b| and
// F |c_a|, so that u rest >= 2^-123 |other operand|: the slack of seven steps in each count covers 56 of them. Flushed results cost less than
// 64 * 2^-126 < F together. In sums all costs together are at most 12 * 2^-126, and t >= 2^-99 has u t >= 2^-122.
// Overflow: excluded beforehand on the CPU (`wgsl::Reach`): no size passes 2^120. So there is no NaN either.

fn add(x: f32, y: f32) -> f32 { return fence(x + y); }
fn sub(x: f32, y: f32) -> f32 { return fence(x - y); }
fn mul(x: f32, y: f32) -> f32 { return fence(x * y); }
fn add3(x: vec3<f32>, y: vec3<f32>) -> vec3<f32> { return fence3(x + y); }
fn sub3(x: vec3<f32>, y: vec3<f32>) -> vec3<f32> { return fence3(x - y); }
fn mul3(x: vec3<f32>, y: vec3<f32>) -> vec3<f32> { return fence3(x * y); }
// |x| + |y| + |z| + s, three sums.
fn sum3(s: f32, x: vec3<f32>) -> f32 { let m = abs(x); return add(add(add(s, m.x), m.y), m.z); }

// A number m +- r.
struct Ball { m: f32, r: f32 }

fn b_const(m: f32, r: f32) -> Ball { return Ball(m, r); }
fn b_neg(x: Ball) -> Ball { return Ball(-x.m, x.r); }
// As f_add, with a = 0.
fn b_add(x: Ball, y: Ball) -> Ball {
    let m = add(x.m, y.m);
    let t = add(x.r, y.r);
    return Ball(m, add(t, mul(3.0 * U, add(abs(m), t))));
}
fn b_sub(x: Ball, y: Ball) -> Ball { return b_add(x, b_neg(y)); }
// As f_mul, with a = 0: the rest, of at most 5 steps, is the error itself; last sums 3. The centre is rounded once.
fn b_mul(x: Ball, y: Ball) -> Ball {
    let p = abs(x.m);
    let q = abs(y.m);
    let rest = add(mul(p, y.r), mul(x.r, add(q, y.r)));
    let m = mul(x.m, y.m);
    return Ball(m, add(add(mul(rest, 1.0 + 20.0 * U), mul(3.0 * U, abs(m))), F));
}
fn b_sqr(x: Ball) -> Ball { return b_mul(x, x); }
// ||v| - |m|| <= |v - m|.
fn b_abs(x: Ball) -> Ball { return Ball(abs(x.m), x.r); }

// A function of three symbols in [-1, 1], c + a.s +- e.
struct Form { c: f32, e: f32, a: vec3<f32> }

fn f_const(m: f32, r: f32) -> Form { return Form(m, r, vec3<f32>(0.0)); }
fn f_neg(x: Form) -> Form { return Form(-x.c, x.e, -x.a); }
// e of a sum, where t is the sum of errors: the true error is at most t + u t + u S, S = |c| + |a|_1; with v = fl(3 u (S + t)),
// fl(t + v) >= t + v - u t - u v >= t + 2 u t + 3 u S less terms of second order. As `Affine::sum`.
fn f_sum(c: f32, a: vec3<f32>, t: f32) -> Form {
    let w = sum3(add(abs(c), t), a);
    return Form(c, add(t, mul(3.0 * U, w)), a);
}
fn f_add(x: Form, y: Form) -> Form { return f_sum(add(x.c, y.c), add3(x.a, y.a), add(x.e, y.e)); }
fn f_sub(x: Form, y: Form) -> Form { return f_sum(sub(x.c, y.c), sub3(x.a, y.a), add(x.e, y.e)); }
// x + k for a number k = m +- r: only the centre and the error are rounded.
fn f_addk(x: Form, m: f32, r: f32) -> Form {
    let c = add(x.c, m);
    let t = add(x.e, r);
    return Form(c, add(t, mul(3.0 * U, add(abs(c), t))), x.a);
}
// k x for an exact k: 5 products, then as a sum.
fn f_scale(x: Form, k: f32) -> Form {
    let c = mul(x.c, k);
    let a = mul3(x.a, vec3<f32>(k));
    let t = mul(x.e, abs(k));
    let w = sum3(add(abs(c), t), a);
    return Form(c, add(add(t, mul(5.0 * U, w)), F), a);
}
// k x for a number k = m +- r, as `Affine::mul_interval`.
fn f_mulk(x: Form, m: f32, r: f32) -> Form {
    let s = sum3(x.e, x.a);
    let p = abs(x.c);
    let rest = add(mul(p, r), mul(s, add(abs(m), r)));
    let e = add(mul(x.e, abs(m)), mul(add(p, s), r));
    let c = mul(x.c, m);
    let pad = add(mul(3.0 * U, abs(c)), mul(20.0 * U, rest));
    return Form(c, add(add(e, pad), F), mul3(x.a, vec3<f32>(m)));
}
// As `Affine::mul`: centre c_a c_b + Q/2, error R T - D/2 + |c_a| e_b + |c_b| e_a. The centre costs u |c_a c_b| and u |c'|, which is less than
// u |c_a c_b| and u R T; all other steps, 21 as there, are on numbers below the rest |c_a| T + R (|c_b| + T).
fn f_mul(x: Form, y: Form) -> Form {
    let r = sum3(x.e, x.a);
    let t = sum3(y.e, y.a);
    let w = mul3(x.a, y.a);
    let q = add(add(w.x, w.y), w.z);
    let m = abs(w);
    let d = add(add(m.x, m.y), m.z);
    let p = abs(x.c);
    let o = abs(y.c);
    let rest = add(mul(p, t), mul(r, add(o, t)));
    let e = add(sub(mul(r, t), 0.5 * d), add(mul(p, y.e), mul(o, x.e)));
    let a = add3(mul3(vec3<f32>(x.c), y.a), mul3(vec3<f32>(y.c), x.a));
    let c = mul(x.c, y.c);
    let pad = add(mul(4.0 * U, abs(c)), mul(28.0 * U, rest));
    return Form(add(c, 0.5 * q), add(add(e, pad), F), a);
}
// As `Affine::sqr`: centre c^2 + R^2/2, error R^2/2 + 2 |c| e.
fn f_sqr(x: Form) -> Form {
    let r = sum3(x.e, x.a);
    let p = abs(x.c);
    let h = 0.5 * mul(r, r);
    let e = add(h, mul(2.0 * p, x.e));
    let c = mul(x.c, x.c);
    let pad = add(mul(4.0 * U, c), mul(28.0 * U, mul(r, add(2.0 * p, r))));
    return Form(add(c, h), add(add(e, pad), F), mul3(vec3<f32>(2.0 * x.c), x.a));
}
// Upper bound of |a|_1 + e: three sums and a product.
fn f_radius(x: Form) -> f32 { return mul(sum3(x.e, x.a), 1.0 + 8.0 * U); }
// The sign that the function has everywhere, 0 if that is not proved. Exact comparisons.
fn f_sign(x: Form) -> i32 {
    let r = f_radius(x);
    return select(0, 1, x.c > r) - select(0, 1, x.c < -r);
}
// Outward bounds: one more rounding, of at most u (|c| + r).
fn f_range(x: Form) -> vec2<f32> {
    let r = f_radius(x);
    let s = add(r, mul(4.0 * U, add(abs(x.c), r)));
    return vec2<f32>(sub(x.c, s), add(x.c, s));
}
// About 1/c, c > 0: by its bits (12 % off), each step squares the error. A guess, never a proof.
fn reciprocal(c: f32) -> f32 {
    var q = guess(c);
    q = mul(q, sub(2.0, mul(c, q)));
    q = mul(q, sub(2.0, mul(c, q)));
    return mul(q, sub(2.0, mul(c, q)));
}
// |x| by sign; else k x + [0, b] for any k in [-1, 1], best c/r: |x| - k x is convex, not negative, and largest at an end, c + r or c - r.
fn f_abs(x: Form) -> Form {
    let s = f_sign(x);
    if s > 0 { return x; }
    if s < 0 { return f_neg(x); }
    let r = f_radius(x);
    let k = clamp(mul(x.c, reciprocal(r)), -1.0, 1.0);
    let b = max(mul(sub(1.0, k), add(r, x.c)), mul(add(1.0, k), sub(r, x.c)));
    let h = mul(0.5 * (1.0 + 8.0 * U), add(b, mul(4.0 * U, r)));
    return f_addk(f_scale(x, k), h, h);
}
// The larger one where that is proved; else (x + y + |x - y|)/2.
fn f_max(x: Form, y: Form) -> Form {
    let d = f_sub(x, y);
    let s = f_sign(d);
    if s > 0 { return x; }
    if s < 0 { return y; }
    return f_scale(f_add(f_add(x, y), f_abs(d)), 0.5);
}
fn f_min(x: Form, y: Form) -> Form { return f_neg(f_max(f_neg(x), f_neg(y))); }

// f(P), f(P + t D), and g with f(P + t D) = f(P) + t g.
struct Slope { p: Ball, v: Form, g: Form }

fn s_const(m: f32, r: f32) -> Slope { return Slope(Ball(m, r), f_const(m, r), f_const(0.0, F)); }
fn s_neg(x: Slope) -> Slope { return Slope(b_neg(x.p), f_neg(x.v), f_neg(x.g)); }
fn s_add(x: Slope, y: Slope) -> Slope { return Slope(b_add(x.p, y.p), f_add(x.v, y.v), f_add(x.g, y.g)); }
fn s_sub(x: Slope, y: Slope) -> Slope { return Slope(b_sub(x.p, y.p), f_sub(x.v, y.v), f_sub(x.g, y.g)); }
fn s_addk(x: Slope, m: f32, r: f32) -> Slope { return Slope(b_add(x.p, Ball(m, r)), f_addk(x.v, m, r), x.g); }
fn s_scale(x: Slope, k: f32) -> Slope { return Slope(b_mul(x.p, Ball(k, F)), f_scale(x.v, k), f_scale(x.g, k)); }
fn s_mulk(x: Slope, m: f32, r: f32) -> Slope {
    return Slope(b_mul(x.p, Ball(m, r)), f_mulk(x.v, m, r), f_mulk(x.g, m, r));
}
// v_a v_b - p_a p_b = (v_a - p_a) v_b + p_a (v_b - p_b).
fn s_mul(x: Slope, y: Slope) -> Slope {
    return Slope(b_mul(x.p, y.p), f_mul(x.v, y.v), f_add(f_mul(x.g, y.v), f_mulk(y.g, x.p.m, x.p.r)));
}
// v^2 - p^2 = (v - p)(v + p).
fn s_sqr(x: Slope) -> Slope { return Slope(b_sqr(x.p), f_sqr(x.v), f_mul(x.g, f_addk(x.v, x.p.m, x.p.r))); }
// The sign that f has at the apex, strictly, and everywhere beyond; 0 if that is not proved.
fn s_sign(x: Slope) -> i32 {
    let s = f_sign(x.v);
    return select(0, s, abs(x.p.m) > x.p.r && (x.p.m > 0.0) == (s > 0));
}
// +-g where f has one sign; else ||v| - |p|| <= |v - p|.
fn s_abs(x: Slope) -> Slope {
    let s = s_sign(x);
    if s > 0 { return x; }
    if s < 0 { return s_neg(x); }
    let h = mul(add(abs(x.g.c), f_radius(x.g)), 1.0 + 8.0 * U);
    return Slope(b_abs(x.p), f_abs(x.v), Form(0.0, h, vec3<f32>(0.0)));
}
fn s_max(x: Slope, y: Slope) -> Slope {
    let d = s_sub(x, y);
    let s = s_sign(d);
    if s > 0 { return x; }
    if s < 0 { return y; }
    return s_scale(s_add(s_add(x, y), s_abs(d)), 0.5);
}
fn s_min(x: Slope, y: Slope) -> Slope { return s_neg(s_max(s_neg(x), s_neg(y))); }
