// Quotients, roots, exponentials, logarithms and waves over balls, forms and slopes: from + - * of `forms.wgsl` alone.
//
// No function of the driver is trusted, and no quotient: quotients and roots are guesses that a residual proves; the others are polynomials
// with their remainders, after reductions of which every rounding is counted, in units u = 2^-23 ("either neighbour").
// `b_...` is the function at a float. Over a form, h(x) = h(c) + h'(c) (x - c) + R, where R has a sign if h is convex or concave.
//
// Where nothing is known (poles, sizes that `wgsl::Reach` counts on not to occur) `lost` is set and any harmless number is returned; generated
// functions then answer `f_unknown`, which proves nothing: 0 +- 1. Where h is undefined nothing is claimed: callers need h to be continuous.

var<private> lost: bool;

fn f_unknown() -> Form { return Form(0.0, 1.0, vec3<f32>(0.0)); }
fn s_unknown() -> Slope { return Slope(Ball(0.0, 1.0), f_unknown(), f_unknown()); }
fn f_lost() -> Form { lost = true; return Form(1.0, F, vec3<f32>(0.0)); }

const SMALL: f32 = 8.6736174e-19;     // 2^-60
const LARGE: f32 = 1.1529215e18;      // 2^60
const POLE: f32 = 9.536743e-7;        // 2^-20: denominators nearer to 0 are lost
const SLACK: f32 = 1.00001;           // 84 u: more than the roundings of any error bound below

// 1/c, c in [2^-60, 2^60]: a guess q. |1/c - q| = |1 - q c|/c <= d q/(1 - d) for |1 - q c| <= d <= 1/1000;
// the product is off by u (1 + 1/1000), the difference by u/1000.
fn b_recip(c: f32) -> Ball {
    let q = reciprocal(c);
    let d = add(abs(sub(1.0, mul(q, c))), 1.5 * U);
    if !(d < 0.001) { lost = true; }
    return Ball(q, mul(mul(abs(q), d), 1.01));
}

// sqrt c, c <= 2^60, as c y with y about 1/sqrt c. |sqrt c - q| = |c - q^2|/(sqrt c + q) <= d/q <= d y/0.99, where q y >= 0.99 is asked.
// Below 2^-60 the root is in [0, 2^-30].
fn b_sqrt(c: f32) -> Ball {
    if c < SMALL { return Ball(0.0, 9.4e-10); }
    var y = bitcast<f32>(0x5f3759dfu - (bitcast<u32>(c) >> 1u));
    let h = 0.5 * c;
    y = mul(y, sub(1.5, mul(mul(h, y), y)));
    y = mul(y, sub(1.5, mul(mul(h, y), y)));
    y = mul(y, sub(1.5, mul(mul(h, y), y)));
    let q = mul(c, y);
    if !(y > 0.0 && mul(q, y) > 0.995) { lost = true; }
    let m = mul(q, q);
    let d = add(abs(sub(c, m)), mul(1.5 * U, m));
    return Ball(q, mul(mul(d, y), 1.02));
}

// e^c, c <= 41: c = k ln 2 + r, k whole, with ln 2 = 355/512 - 0.000212194440054690583 (the product with the first is exact). |r| <= 0.36 is asked, so k needs no
// proof. r is off by u (|r'| + |k LO| + |r|) + |k| 2^-37 < 0.8 u; the sum to r^7/7! leaves out 0.09 u, its steps lose 2.5 u
// (1.44 u + 0.44 u in the last, 0.52 u, 0.09 u ... in those before), coefficients 0.01 u: with 1.44 * 0.8 u less than 3.8 u.
fn b_exp(c: f32) -> Ball {
    if c < -60.0 { return Ball(0.0, 1e-26); }
    let k = floor(add(mul(c, 1.442695), 0.5));
    let r = sub(sub(c, mul(k, 0.693359375)), mul(k, -2.1219444e-4));
    if !(abs(r) <= 0.36 && abs(k) < 100.0) { lost = true; return Ball(1.0, F); }
    var p = add(mul(r, 1.9841270e-4), 1.3888889e-3);
    p = add(mul(r, p), 8.3333338e-3);
    p = add(mul(r, p), 4.1666667e-2);
    p = add(mul(r, p), 0.16666667);
    p = add(mul(r, p), 0.5);
    p = add(mul(r, p), 1.0);
    p = add(mul(r, p), 1.0);
    let scale = bitcast<f32>(u32(i32(k) + 127) << 23u);
    return Ball(mul(p, scale), mul(4.0 * U, scale));
}

// ln c, c in [2^-60, 2^60]: c = m 2^k, m in [0.7, 1.42]; ln m = 2 atanh s, s = (m - 1)/(m + 1), |s| < 0.1737. m - 1 is exact; s is off by u |s| for m + 1, for
// the product, and by the quotient's error; 2 atanh' < 2.07. The series to s^9 leaves out 0.01 u; what follows 2 s is below 0.0037
// and loses less than 0.04 u. Sums: u |y|, u (|k LO| + |y|), u |L|; k LO itself 2 u |k LO|, |LO| < 0.00022.
fn b_ln(c: f32) -> Ball {
    let bits = bitcast<u32>(c);
    var k = f32(i32(bits >> 23u) - 127);
    var m = bitcast<f32>((bits & 0x7fffffu) | 0x3f800000u);
    if m > 1.4142135 { m = 0.5 * m; k = k + 1.0; }
    let d = sub(m, 1.0);
    let q = b_recip(add(m, 1.0));
    let s = mul(d, q.m);
    let off = add(mul(2.2 * U, abs(s)), mul(1.02, mul(abs(d), q.r)));
    let z = mul(s, s);
    var p = add(mul(z, 0.22222222), 0.2857143);
    p = add(mul(z, p), 0.4);
    p = add(mul(z, p), 0.6666667);
    let y = add(2.0 * s, mul(s, mul(z, p)));
    let l = add(mul(k, 0.693359375), add(mul(k, -2.1219444e-4), y));
    let size = add(add(abs(l), 2.0 * abs(y)), add(mul(0.001, abs(k)), 0.1));
    return Ball(l, mul(SLACK, add(mul(2.2, off), mul(U, size))));
}

// sin c and cos c, both off by at most e.
struct Wave { s: f32, c: f32, e: f32 }

// |c| <= 1000: c = k pi/2 + r, k whole, pi/2 = 1.5703125 + 4.8375129699707031e-4 + 7.5497899548918821e-8 (- 1e-20); products with the first two are exact for |k| < 2^11.
// |r| <= 0.8 is asked. r is off by u (|r'| + |r''| + |r|) + ..., |r'| <= 0.8 + 0.0005 |k|: 2.5 u + 0.001 |k| u; by nothing for k = 0. sin: the sum to r^9 leaves out
// 0.02 u, loses 0.42 u in what follows r and 0.72 u in the last sum; cos: to r^8, 0.26 u, 1.1 u, 1 u. Less than 2.5 u each.
fn b_wave(c: f32) -> Wave {
    let k = floor(add(mul(c, 0.63661975), 0.5));
    let r = sub(sub(sub(c, mul(k, 1.5703125)), mul(k, 4.837512969970703125e-4)), mul(k, 7.54979e-8));
    if !(abs(r) <= 0.8 && abs(k) < 2000.0) { lost = true; return Wave(0.0, 0.0, 1.0); }
    let z = mul(r, r);
    var p = add(mul(z, 2.7557319e-6), -1.9841270e-4);
    p = add(mul(z, p), 8.3333338e-3);
    p = add(mul(z, p), -0.16666667);
    let s = add(r, mul(r, mul(z, p)));
    var o = add(mul(z, 2.4801587e-5), -1.3888889e-3);
    o = add(mul(z, o), 4.1666667e-2);
    o = add(mul(z, o), -0.5);
    let w = add(1.0, mul(z, o));
    let e = select(mul(U, add(5.0, mul(0.0011, abs(k)))), 2.5 * U, k == 0.0);
    let n = i32(k) & 3;
    if n == 0 { return Wave(s, w, e); }
    if n == 1 { return Wave(w, -s, e); }
    if n == 2 { return Wave(-s, -w, e); }
    return Wave(-w, s, e);
}

// m + k (x - c) +- err over a form with |x - c| <= r: k e and 3 u |k| |a|_1 come with it.
fn f_line(x: Form, r: f32, m: f32, k: f32, err: f32) -> Form {
    let w = abs(k);
    let e = add(add(mul(w, x.e), mul(mul(2.0 * U, w), r)), add(err, mul(2.0 * U, abs(m))));
    return Form(m, add(mul(SLACK, e), F), mul3(x.a, vec3<f32>(k)));
}
// Anything in [a, b].
fn f_between(a: f32, b: f32) -> Form {
    let e = add(mul(0.5, sub(b, a)), mul(3.0 * U, add(abs(a), abs(b))));
    return Form(mul(0.5, add(a, b)), add(mul(SLACK, e), F), vec3<f32>(0.0));
}
// Bounds c - r and c + r, outward.
fn f_ends(x: Form, r: f32) -> vec2<f32> {
    let s = add(r, mul(4.0 * U, add(abs(x.c), r)));
    return vec2<f32>(sub(x.c, s), add(x.c, s));
}

// R = (x - c)^2/(c^2 x), in [0, r^2/(c^2 lo)].
fn f_recip(y: Form) -> Form {
    var x = y;
    if y.c < 0.0 { x = f_neg(y); }
    let r = f_radius(x);
    let ends = f_ends(x, r);
    if !(ends.x >= POLE && ends.y <= LARGE) { return f_lost(); }
    let q = b_recip(x.c);
    let j = b_recip(ends.x);
    let t = mul(r, q.m);
    let h = mul(0.5 * SLACK, mul(mul(t, t), j.m));
    let k = mul(q.m, q.m);
    let off = add(mul(2.01, mul(q.m, q.r)), mul(U, k));
    let f = f_line(x, r, add(q.m, h), -k, add(add(h, q.r), mul(off, r)));
    if y.c < 0.0 { return f_neg(f); }
    return f;
}
fn f_div(x: Form, y: Form) -> Form { return f_mul(x, f_recip(y)); }

// sqrt x = s + (x - c)/(2 s) - (sqrt x - s)^2/(2 s) with |sqrt x - s| = |x - c|/(sqrt x + s), sqrt x >= s (1 - t), t = r/c <= 1, and 1/(2 - t) <= (1 + t)/2.
fn f_sqrt(x: Form) -> Form {
    let r = f_radius(x);
    let top = f_ends(x, r).y;
    if !(top <= LARGE) { return f_lost(); }
    if top <= 0.0 { return Form(0.0, F, vec3<f32>(0.0)); }
    if x.c < SMALL || r > x.c {
        let b = b_sqrt(top);
        return f_between(0.0, add(b.m, b.r));
    }
    let s = b_sqrt(x.c);
    let j = b_recip(s.m);
    let t = min(mul(mul(r, j.m), mul(j.m, SLACK)), 1.0);
    let w = mul(mul(r, j.m), mul(0.5, add(1.0, t)));
    let h = mul(0.25 * SLACK, mul(mul(w, w), j.m));
    let k = 0.5 * j.m;
    let off = add(0.5 * j.r, mul(1.01, mul(k, mul(s.r, j.m))));
    return f_line(x, r, sub(s.m, h), k, add(add(h, s.r), mul(off, r)));
}

// Anything between e^a and e^b.
fn f_exp_between(a: f32, b: f32) -> Form {
    let lo = b_exp(a);
    let hi = b_exp(b);
    return f_between(max(sub(lo.m, lo.r), 0.0), add(hi.m, hi.r));
}
// R = e^c (e^t - 1 - t), |t| <= r <= 3/2, in [0, e^c r^2/2 (1 + r/3 + r^2/8)]: 1/12 + r/60 + ... <= 1/8.
fn f_exp(x: Form) -> Form {
    let r = f_radius(x);
    let ends = f_ends(x, r);
    if !(ends.y <= 20.0) { return f_lost(); }
    if r > 1.5 { return f_exp_between(ends.x, ends.y); }
    let b = b_exp(x.c);
    let q = mul(r, r);
    let g = mul(q, add(1.0, add(mul(0.33333334, r), mul(0.125, q))));
    let h = mul(0.25 * SLACK, mul(add(b.m, b.r), g));
    return f_line(x, r, add(b.m, h), b.m, add(h, mul(b.r, add(1.0, r))));
}

// R in [-(r/lo)^2/2, 0].
fn f_ln(x: Form) -> Form {
    let r = f_radius(x);
    let ends = f_ends(x, r);
    if !(ends.x >= SMALL && ends.y <= LARGE) { return f_lost(); }
    if r > 0.7 * x.c {
        let a = b_ln(ends.x);
        let b = b_ln(ends.y);
        return f_between(sub(a.m, a.r), add(b.m, b.r));
    }
    let l = b_ln(x.c);
    let k = b_recip(x.c);
    let j = b_recip(ends.x);
    let z = mul(r, j.m);
    let h = mul(0.25 * SLACK, mul(z, z));
    return f_line(x, r, sub(l.m, h), k.m, add(add(h, l.r), mul(k.r, r)));
}

// With value v and slope d at the centre, both off by e: R = -(integral of (t - s) h(c + s) from 0 to t), and h(c + s) is in v +- (e + s), so that R is in
// -(v +- (e + r/3)) t^2/2.
fn f_wave(x: Form, r: f32, v: f32, d: f32, e: f32) -> Form {
    let s = mul(SLACK, add(e, mul(0.33333334, r)));
    let q = mul(0.5 * SLACK, mul(r, r));
    let p = mul(clamp(add(v, s), 0.0, 1.0), q);
    let n = mul(clamp(sub(s, v), 0.0, 1.0), q);
    let m = add(v, mul(0.5, sub(n, p)));
    let h = mul(0.5, add(n, p));
    return f_line(x, r, m, d, add(add(h, mul(2.0 * U, add(n, p))), mul(e, add(1.0, r))));
}
fn f_sin(x: Form) -> Form {
    let r = f_radius(x);
    if !(r <= 1.6 && abs(x.c) <= 1000.0) { return f_unknown(); }
    let w = b_wave(x.c);
    return f_wave(x, r, w.s, w.c, w.e);
}
fn f_cos(x: Form) -> Form {
    let r = f_radius(x);
    if !(r <= 1.6 && abs(x.c) <= 1000.0) { return f_unknown(); }
    let w = b_wave(x.c);
    return f_wave(x, r, w.c, -w.s, w.e);
}
fn f_cosh(x: Form) -> Form { return f_scale(f_add(f_exp(x), f_exp(f_neg(x))), 0.5); }
fn f_sinh(x: Form) -> Form { return f_scale(f_sub(f_exp(x), f_exp(f_neg(x))), 0.5); }
// x^y = e^(y ln x), y = m +- r > 0; up to 0, where it is 0: between 0 and the power of the upper end.
fn f_real(x: Form, m: f32, r: f32) -> Form {
    let ends = f_ends(x, f_radius(x));
    if ends.x >= SMALL { return f_exp(f_mulk(f_ln(x), m, r)); }
    if !(ends.y <= LARGE) { return f_lost(); }
    let b = b_ln(max(ends.y, SMALL));
    let z = b_mul(b, Ball(m, r));
    let top = f_exp(Form(z.m, z.r, vec3<f32>(0.0)));
    return f_between(0.0, add(top.c, top.e));
}

// The value at the apex, as a form without symbols.
fn s_apex(x: Slope) -> Form { return Form(x.p.m, x.p.r, vec3<f32>(0.0)); }
fn ball_of(x: Form) -> Ball { return Ball(x.c, f_radius(x)); }
// (v + p)/2, and at most this is |v - p|.
fn s_middle(x: Slope) -> Form { return f_scale(f_addk(x.v, x.p.m, x.p.r), 0.5); }
fn s_step(x: Slope) -> f32 {
    return mul(SLACK, add(add(abs(sub(x.v.c, x.p.m)), f_radius(x.v)), x.p.r));
}
// v_a/v_b - q = ((v_a - p_a) - q (v_b - p_b))/v_b with q = p_a/p_b.
fn s_div(x: Slope, y: Slope) -> Slope {
    let q = b_mul(x.p, ball_of(f_recip(s_apex(y))));
    let w = f_recip(y.v);
    return Slope(q, f_mul(x.v, w), f_mul(f_sub(x.g, f_mulk(y.g, q.m, q.r)), w));
}
fn s_recip(y: Slope) -> Slope { return s_div(s_const(1.0, F), y); }
// sqrt v - sqrt p = (v - p)/(sqrt v + sqrt p).
fn s_sqrt(x: Slope) -> Slope {
    let p = ball_of(f_sqrt(s_apex(x)));
    let v = f_sqrt(x.v);
    return Slope(p, v, f_mul(x.g, f_recip(f_addk(v, p.m, p.r))));
}
// The mean of h' from p to v, m their middle and D at least |v - p|: for e^x, e^m sinh(D/2)/(D/2), the quotient in [1, 1 + 1.05 D^2/24] for D <= 3/2;
// else it is between e to the smaller and e to the larger one.
fn s_exp(x: Slope) -> Slope {
    let d = s_step(x);
    var mean: Form;
    if d <= 1.5 {
        let w = mul(0.022, mul(d, d));
        mean = f_mulk(f_exp(s_middle(x)), add(1.0, w), add(w, 2.0 * U));
    } else {
        let v = f_ends(x.v, f_radius(x.v));
        let p = f_ends(s_apex(x), x.p.r);
        if max(v.y, p.y) <= 20.0 { mean = f_exp_between(min(v.x, p.x), max(v.y, p.y)); } else { mean = f_lost(); }
    }
    return Slope(ball_of(f_exp(s_apex(x))), f_exp(x.v), f_mul(x.g, mean));
}
// Else the mean is h'(m) + h''' D^2/24.
fn s_wide(f: Form, d: f32) -> Form {
    if d > 4.0 { return f_unknown(); }
    return Form(f.c, add(f.e, mul(0.042, mul(d, d))), f.a);
}
fn s_sin(x: Slope) -> Slope {
    let mean = s_wide(f_cos(s_middle(x)), s_step(x));
    return Slope(ball_of(f_sin(s_apex(x))), f_sin(x.v), f_mul(x.g, mean));
}
fn s_cos(x: Slope) -> Slope {
    let mean = f_neg(s_wide(f_sin(s_middle(x)), s_step(x)));
    return Slope(ball_of(f_cos(s_apex(x))), f_cos(x.v), f_mul(x.g, mean));
}
// 1/m + [0, 2/lo^3] D^2/24, or between 0 and 1/lo.
fn s_ln(x: Slope) -> Slope {
    let d = s_step(x);
    let lo = min(f_ends(x.v, f_radius(x.v)).x, f_ends(s_apex(x), x.p.r).x);
    var mean: Form;
    if lo >= POLE && lo <= LARGE {
        let j = b_recip(lo);
        let t = mul(d, j.m);
        if t <= 1.0 {
            let w = mul(0.042, mul(mul(t, t), j.m));
            mean = f_addk(f_recip(s_middle(x)), w, w);
        } else {
            mean = f_between(0.0, mul(SLACK, j.m));
        }
    } else {
        mean = f_lost();
    }
    return Slope(ball_of(f_ln(s_apex(x))), f_ln(x.v), f_mul(x.g, mean));
}
fn s_cosh(x: Slope) -> Slope { return s_scale(s_add(s_exp(x), s_exp(s_neg(x))), 0.5); }
fn s_sinh(x: Slope) -> Slope { return s_scale(s_sub(s_exp(x), s_exp(s_neg(x))), 0.5); }
fn s_real(x: Slope, m: f32, r: f32) -> Slope { return s_exp(s_mulk(s_ln(x), m, r)); }
