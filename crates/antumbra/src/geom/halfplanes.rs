//! Certified areas cut out of a square by half planes.
//!
//! In a rectangle of light with parameters `(u, v)` in the square `Q = [-1, 1]^2`, each unresolved slab of a shadow beam
//! gives a linear form with an error: the part `{k + a u + b v > e}` is certainly free of it, and the part
//! `{k + a u + b v < -e}` certainly hidden by it. So with several slabs
//!
//! * the lit area is at least that of the polygon `Q` cut by all `k - e + a u + b v >= 0`,
//! * the area not hidden is at most that of `Q` cut by all `k + e + a u + b v >= 0`.
//!
//! **Rigour without polygon topology.** Let `w(u) = min_i top_i(u) - max_j bottom_j(u)` be the height of such a polygon
//! over `u`. Tops and bottoms are linear, so w is concave, and the area is the integral of `max(0, w)`. For *any* nodes
//! `u_0 < u_1 < ...` the chords of a concave function lie below it, and any single pair `top_i - bottom_j` lies above
//! it: both integrate in closed form, with every operation rounded outward. The nodes are the corners of a polygon
//! clipped in plain floating point; if rounding misplaces them the bounds get wider, never wrong. At exact corners
//! both bounds are equal.
use antumbra_interval::round::{add_down, add_up, div_down, div_up, mul_down, mul_up, sub_down, sub_up};

/// The linear form `k + a u + b v` with error `e >= 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfPlane {
    /// Value at the middle of the square.
    pub k: f64,
    /// Slope along u.
    pub a: f64,
    /// Slope along v.
    pub b: f64,
    /// Bound of the error of the form, at least 0, perhaps infinite.
    pub e: f64,
    /// Whether a negative form hides: if not, the plane only says where the square is lit.
    pub hides: bool,
}

/// Shares of the square, in `[0, 1]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shares {
    /// Lower bound of the lit share.
    pub lit: f64,
    /// Upper bound of the share that is not hidden.
    pub open: f64,
}

/// Scratch memory for [`shares`].
#[derive(Debug, Default)]
pub struct Scratch {
    polygon: Vec<[f64; 2]>,
    clipped: Vec<[f64; 2]>,
    nodes: Vec<f64>,
    bounds: Vec<Bound>,
}

/// A constraint `c + a u + b v >= 0` after the choice of the axis of integration, u.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bound {
    pub(super) c: f64,
    pub(super) a: f64,
    pub(super) b: f64,
}

/// Lower bound of the mean, over u in `[-1, 1]`, of the length of the v in `[-1, 1]` that meet all constraints.
pub(super) fn mean_in(bounds: &[Bound], s: &mut Scratch) -> f64 {
    s.bounds.clear();
    s.bounds.extend_from_slice(bounds);
    0.5 * inner_area(s)
}

/// Upper bound of the same.
pub(super) fn mean_out(bounds: &[Bound], s: &mut Scratch) -> f64 {
    s.bounds.clear();
    s.bounds.extend_from_slice(bounds);
    0.5 * outer_area(s)
}

/// Certified shares of the square that are lit and not hidden. Time: linear in planes times corners, some 100 ns for
/// one plane. A NaN or an infinite error in a plane gives the trivial `[0, 1]`.
#[must_use]
pub fn shares(planes: &[HalfPlane], scratch: &mut Scratch) -> Shares {
    if planes.iter().any(|p| !(p.k + p.a + p.b + p.e).is_finite()) {
        return Shares { lit: 0.0, open: 1.0 };
    }
    // Integrate along the axis in which the forms change less: so that few of them are steep.
    let (along, across) = planes.iter().fold((0.0, 0.0), |(a, b), p| (a + p.a.abs(), b + p.b.abs()));
    let turned = |p: &HalfPlane| if across >= along { (p.a, p.b) } else { (p.b, p.a) };
    let mut area = |inner: bool| {
        scratch.bounds.clear();
        scratch.bounds.extend(planes.iter().filter(|p| inner || p.hides).map(|p| {
            let (a, b) = turned(p);
            Bound { c: if inner { sub_down(p.k, p.e) } else { add_up(p.k, p.e) }, a, b }
        }));
        if inner { inner_area(scratch) } else { outer_area(scratch) }
    };
    let (lit, open) = (0.25 * area(true), 0.25 * area(false));
    // A quarter is exact. The true lit area is at most the true open one, but for a NaN nothing is known.
    Shares { lit: if lit >= 0.0 { lit.min(1.0) } else { 0.0 }, open: if open <= 1.0 { open.max(0.0) } else { 1.0 } }
}

/// Whether the constraint is so steep that it is better taken as one on u alone. (Any choice is sound.)
fn steep(p: Bound) -> bool {
    p.b.abs() <= 1e-9 * p.a.abs() || p.b == 0.0
}

/// Lower bound of the area in which all constraints hold.
fn inner_area(s: &mut Scratch) -> f64 {
    // Steep constraints hold wherever c - |b| + a u >= 0.
    let (mut left, mut right) = (-1.0_f64, 1.0_f64);
    for p in s.bounds.iter().filter(|p| steep(**p)) {
        let c = sub_down(p.c, p.b.abs());
        if p.a == 0.0 {
            // A form that is 0 everywhere has no visible point. (Others vanish on sets without area.)
            if c <= 0.0 {
                return 0.0;
            }
        } else if p.a > 0.0 {
            left = left.max(-div_down(c, p.a));
        } else {
            right = right.min(div_down(c, -p.a));
        }
    }
    if left >= right {
        return 0.0;
    }
    nodes(s, left, right);
    // Lower bound of the height at u: tops rounded down, bottoms up.
    let height = |u: f64| {
        let (mut top, mut bottom) = (1.0_f64, -1.0_f64);
        for p in s.bounds.iter().filter(|p| !steep(**p)) {
            let q = div_down(add_down(p.c, mul_down(p.a, u)), p.b.abs());
            // Were q not a number, the constraint would be taken as failing.
            let q = if q.is_nan() { f64::NEG_INFINITY } else { q };
            if p.b < 0.0 { top = top.min(q) } else { bottom = bottom.max(-q) }
        }
        sub_down(top, bottom)
    };
    let mut sum = 0.0;
    let mut before = (s.nodes[0], height(s.nodes[0]));
    for &u in &s.nodes[1..] {
        let now = (u, height(u));
        let width = sub_down(now.0, before.0);
        let (lo, hi) = if before.1 < now.1 { (before.1, now.1) } else { (now.1, before.1) };
        // Mean height of the chord where it is positive.
        let mean = if lo >= 0.0 {
            0.5 * add_down(lo, hi)
        } else if hi > 0.0 {
            0.5 * div_down(mul_down(hi, hi), sub_up(hi, lo))
        } else {
            0.0
        };
        sum = add_down(sum, mul_down(mean, width)).max(0.0);
        before = now;
    }
    sum
}

/// Upper bound of the area in which all constraints hold.
fn outer_area(s: &mut Scratch) -> f64 {
    let (mut left, mut right) = (-1.0_f64, 1.0_f64);
    for p in s.bounds.iter().filter(|p| steep(**p)) {
        let c = add_up(p.c, p.b.abs());
        if p.a == 0.0 {
            if c < 0.0 {
                return 0.0;
            }
        } else if p.a > 0.0 {
            left = left.max(-div_up(c, p.a));
        } else {
            right = right.min(div_up(c, -p.a));
        }
    }
    if left >= right {
        return 0.0;
    }
    nodes(s, left, right);
    // Upper bounds of one top (or, negated, of one bottom) at u.
    let reach = |p: &Bound, u: f64| div_up(add_up(p.c, mul_up(p.a, u)), p.b.abs());
    // Mean height, over a strip, of the pair that is lowest top and highest bottom at `at`: any choice is sound.
    let mean = |strip: &[f64], at: f64| {
        let (mut top, mut bottom): (Option<&Bound>, Option<&Bound>) = (None, None);
        let (mut best_top, mut best_bottom) = (1.0, 1.0);
        for p in s.bounds.iter().filter(|p| !steep(**p)) {
            let q = reach(p, at);
            if p.b < 0.0 && q < best_top {
                (best_top, top) = (q, Some(p));
            } else if p.b > 0.0 && q < best_bottom {
                (best_bottom, bottom) = (q, Some(p));
            }
        }
        let height = |u: f64| add_up(top.map_or(1.0, |p| reach(p, u)), bottom.map_or(1.0, |p| reach(p, u)));
        let (a, b) = (height(strip[0]), height(strip[1]));
        let (lo, hi, upper) = if a < b { (a, b, strip[1]) } else { (b, a, strip[0]) };
        if lo >= 0.0 {
            (0.5 * add_up(lo, hi), None)
        } else if lo < 0.0 && hi > 0.0 {
            // The pair leaves the polygon within the strip: at its better end another one may be tighter.
            (0.5 * div_up(mul_up(hi, hi), sub_down(hi, lo)), Some(upper))
        } else if hi <= 0.0 {
            (0.0, None)
        } else {
            // Not numbers: the whole height.
            (2.0, None)
        }
    };
    let mut sum = 0.0;
    for strip in s.nodes.windows(2) {
        let (height, other) = mean(strip, 0.5 * (strip[0] + strip[1]));
        let height = other.map_or(height, |at| height.min(mean(strip, at).0));
        sum = add_up(sum, mul_up(height, sub_up(strip[1], strip[0])));
    }
    sum
}

/// Nodes of integration over `[left, right]`: the corners of the polygon, clipped without rigour, in ascending order.
fn nodes(s: &mut Scratch, left: f64, right: f64) {
    let (polygon, clipped) = (&mut s.polygon, &mut s.clipped);
    polygon.clear();
    polygon.extend([[left, -1.0], [right, -1.0], [right, 1.0], [left, 1.0]]);
    for p in &s.bounds {
        let f = |q: [f64; 2]| p.c + p.a * q[0] + p.b * q[1];
        clipped.clear();
        for (i, &q) in polygon.iter().enumerate() {
            let r = polygon[(i + 1) % polygon.len()];
            let (fq, fr) = (f(q), f(r));
            if fq >= 0.0 {
                clipped.push(q);
            }
            if (fq >= 0.0) != (fr >= 0.0) {
                let t = fq / (fq - fr);
                clipped.push([q[0] + t * (r[0] - q[0]), q[1] + t * (r[1] - q[1])]);
            }
        }
        std::mem::swap(polygon, clipped);
    }
    s.nodes.clear();
    s.nodes.push(left);
    if polygon.is_empty() {
        // Nothing is left of it: corners of the height function, which may be negative everywhere, are where two
        // constraints meet. With all of them as nodes the bounds are exact up to rounding.
        for (i, p) in s.bounds.iter().enumerate() {
            let square = [Bound { c: 1.0, a: 0.0, b: 1.0 }, Bound { c: 1.0, a: 0.0, b: -1.0 }];
            for q in s.bounds[..i].iter().chain(&square) {
                let u = (p.b * q.c - q.b * p.c) / (q.b * p.a - p.b * q.a);
                if left < u && u < right {
                    s.nodes.push(u);
                }
            }
        }
    }
    s.nodes.extend(polygon.iter().map(|q| q[0]).filter(|u| left < *u && *u < right));
    s.nodes.push(right);
    s.nodes.sort_unstable_by(f64::total_cmp);
    s.nodes.dedup();
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_rational::BigRational;
    use num_traits::{FromPrimitive, Signed, ToPrimitive, Zero};

    /// Exact area share by rational clipping; `sign` of the error: -1 inner, +1 outer.
    fn exact(planes: &[HalfPlane], sign: f64) -> BigRational {
        let r = |x: f64| BigRational::from_f64(x).unwrap();
        let mut polygon: Vec<[BigRational; 2]> =
            [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|p| p.map(r)).to_vec();
        for p in planes {
            let f = |q: &[BigRational; 2]| r(p.k) + r(sign) * r(p.e) + r(p.a) * &q[0] + r(p.b) * &q[1];
            let mut out = Vec::new();
            for i in 0..polygon.len() {
                let (q, s) = (&polygon[i], &polygon[(i + 1) % polygon.len()]);
                let (fq, fs) = (f(q), f(s));
                if !fq.is_negative() {
                    out.push(q.clone());
                }
                if fq.is_negative() != fs.is_negative() {
                    let t = &fq / (&fq - &fs);
                    out.push([&q[0] + &t * (&s[0] - &q[0]), &q[1] + &t * (&s[1] - &q[1])]);
                }
            }
            polygon = out;
        }
        let mut twice = BigRational::zero();
        for i in 0..polygon.len() {
            let (q, s) = (&polygon[i], &polygon[(i + 1) % polygon.len()]);
            twice += &q[0] * &s[1] - &q[1] * &s[0];
        }
        twice.abs() / r(8.0)
    }

    fn check(planes: &[HalfPlane], slack: f64) {
        let got = shares(planes, &mut Scratch::default());
        let r = |x: f64| BigRational::from_f64(x).unwrap();
        let (lit, open) = (exact(planes, -1.0), exact(planes, 1.0));
        assert!(r(got.lit) <= lit, "lit {} > {:?} for {planes:?}", got.lit, lit.to_f64());
        assert!(r(got.open) >= open, "open {} < {:?} for {planes:?}", got.open, open.to_f64());
        assert!((lit - r(got.lit)).to_f64().unwrap() <= slack, "loose lit for {planes:?}");
        assert!(
            (r(got.open) - &open).to_f64().unwrap() <= slack,
            "loose open: {} against {:?} for {planes:?}",
            got.open,
            open.to_f64()
        );
    }

    #[test]
    fn a_form_that_is_zero_everywhere_is_not_visible() {
        let zero = HalfPlane { k: 0.0, a: 0.0, b: 0.0, e: 0.0, hides: true };
        assert_eq!(shares(&[zero], &mut Scratch::default()).lit, 0.0);
        let above = HalfPlane { k: 1e-300, ..zero };
        assert!(shares(&[above], &mut Scratch::default()).lit > 0.999);
    }

    #[test]
    fn one_plane() {
        let plane = |k, a, b, e| HalfPlane { k, a, b, e, hides: true };
        check(&[plane(0.0, 1.0, 0.0, 0.0)], 1e-15);
        check(&[plane(0.5, 0.0, 1.0, 0.25)], 1e-15);
        check(&[plane(0.1, 0.3, -0.7, 1e-3)], 1e-15);
        check(&[plane(3.0, 1.0, 1.0, 0.5)], 1e-15);
        check(&[plane(-3.0, 1.0, 1.0, 0.5)], 1e-15);
        check(&[plane(1e-17, 1e-17, 1e-17, 0.0)], 1e-15);
        check(&[plane(0.3, 1.0, 1e-12, 0.0)], 1e-11);
    }

    #[test]
    fn many_random_planes_are_enclosed_and_tight() {
        let mut state = 1u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        for round in 0..3000 {
            let planes: Vec<HalfPlane> = (0..1 + round % 6)
                .map(|_| {
                    let scale = if round % 5 == 0 { 1e-9 } else { 1.0 };
                    let tilt = if round % 7 == 0 { 1e-6 } else { 1.0 };
                    HalfPlane {
                        k: next() * scale,
                        a: next() * scale,
                        b: next() * scale * tilt,
                        e: next().abs() * 0.05 * scale,
                        hides: true,
                    }
                })
                .collect();
            check(&planes, 1e-9);
        }
    }

    #[test]
    fn nothing_is_known_from_nothing() {
        for bad in [f64::NAN, f64::INFINITY] {
            let plane = HalfPlane { k: 1.0, a: 0.0, b: 0.0, e: bad, hides: true };
            assert_eq!(shares(&[plane], &mut Scratch::default()), Shares { lit: 0.0, open: 1.0 });
            let plane = HalfPlane { k: bad, a: 0.0, b: 0.0, e: 0.0, hides: true };
            assert_eq!(shares(&[plane], &mut Scratch::default()), Shares { lit: 0.0, open: 1.0 });
        }
        let lit_only = HalfPlane { k: 0.0, a: 1.0, b: 0.0, e: 0.0, hides: false };
        let got = shares(&[lit_only], &mut Scratch::default());
        assert!(got.lit <= 0.5 && got.lit > 0.499_999 && got.open == 1.0);
        let all = shares(&[], &mut Scratch::default());
        assert!(all.lit > 0.999_999 && all.open == 1.0);
    }
}
