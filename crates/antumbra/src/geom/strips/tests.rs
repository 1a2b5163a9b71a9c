//! Lines, areas and bands against values and counts.
use super::*;

fn at(p: &Paraboloid, a: f64, b: f64) -> f64 {
    p.c + a * (p.l[0] + p.q[0] * a + p.q[2] * b) + b * (p.l[1] + p.q[1] * b)
}

struct Random(u64);
impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
    fn paraboloid(&mut self, bend: f64) -> Paraboloid {
        Paraboloid {
            c: self.next(),
            l: [self.next(), self.next()],
            q: [bend * self.next(), bend * self.next(), bend * self.next()],
        }
    }
}

/// Share of the square in which `inside` holds, by the middles of many cells.
fn counted(inside: impl Fn(f64, f64) -> bool) -> f64 {
    const N: usize = 400;
    let place = |k: usize| (2 * k + 1) as f64 / N as f64 - 1.0;
    let count = (0..N * N).filter(|k| inside(place(k % N), place(k / N))).count();
    count as f64 / (N * N) as f64
}

#[test]
fn lines_beside_curves_keep_to_their_side() {
    let mut r = Random(3);
    let mut used = 0;
    for round in 0..4000 {
        let p = r.paraboloid([0.0, 0.1, 0.5, 1e-9][round % 4]);
        let e = [0.0, 1e-3, 0.1][round % 3];
        let strip = Strip::number(round % 8, 8);
        let Some(along) = Along::tangent(&p, strip) else { continue };
        let (inner, outer) = (along.above(e), along.below(e));
        used += usize::from(inner.is_some() && outer.is_some());
        for _ in 0..200 {
            let (a, y) = (r.next(), r.next());
            let value = at(&p, a, strip.middle + strip.half * y);
            let beyond = |l: &Line| l.sign * a - (l.sign * (l.m + l.g * y) + l.h);
            assert!(!inner.is_some_and(|l| beyond(&l) >= 0.0) || value >= e - 1e-14, "{p:?} {e} {inner:?}");
            assert!(!outer.is_some_and(|l| beyond(&l) < 0.0) || value <= -e + 1e-14, "{p:?} {e} {outer:?}");
        }
    }
    assert!(used > 1000, "{used}");
}

#[test]
fn one_curve_is_enclosed_tightly_and_its_band_is_true() {
    let mut r = Random(5);
    let mut bands = 0;
    for round in 0..300 {
        let p = r.paraboloid([0.02, 0.1, 0.3, 1.0][round % 4]);
        let error = [0.0, 1e-3, 0.05][round % 3];
        let curve = Curve { lower: p, upper: p, error, hides: round % 10 != 9 };
        let got = areas(&[curve], 1e-4, &mut Scratch::default());
        let lit = counted(|a, b| at(&p, a, b) >= error);
        let open = if curve.hides { counted(|a, b| at(&p, a, b) >= -error) } else { 1.0 };
        assert!(got.lit <= lit + 2e-3, "{curve:?}: {got:?}, {lit}");
        assert!(got.open >= open - 2e-3, "{curve:?}: {got:?}, {open}");
        if round % 4 == 0 && curve.hides && p.l[0].abs().max(p.l[1].abs()) > 0.3 {
            assert!(got.lit >= lit - 8e-3 && got.open <= open + 8e-3, "{curve:?}: {got:?}, {lit} {open}");
        }
        let Some(band) = got.band else { continue };
        bands += 1;
        for _ in 0..2000 {
            let (x, y) = (r.next(), r.next());
            let (a, b) = if band.across == 0 { (x, y) } else { (y, x) };
            let [from, to] = band.undecided[usize::from(y >= 0.0)];
            let value = at(&p, a, b);
            let (lit, hidden) = if band.lit_above { (x > to, x < from) } else { (x < from, x > to) };
            assert!(!lit || value >= error - 1e-14, "{p:?}: {band:?} at {a} {b}");
            assert!(!hidden || value <= -error + 1e-14, "{p:?}: {band:?} at {a} {b}");
        }
    }
    assert!(bands > 100, "{bands}");
}

#[test]
fn several_curves_are_enclosed() {
    let mut r = Random(7);
    for round in 0..200 {
        let curves: Vec<Curve> = (0..2 + round % 3)
            .map(|k| {
                let mut upper = r.paraboloid(0.05);
                upper.l[k % 2] += 0.5_f64.copysign(upper.l[k % 2]);
                let lower = Paraboloid { c: upper.c - [0.0, 0.02][k % 2], ..upper };
                Curve { lower, upper, error: 1e-3, hides: k != 2 }
            })
            .collect();
        let got = areas(&curves, 1e-4, &mut Scratch::default());
        let lit = counted(|a, b| curves.iter().all(|c| at(&c.lower, a, b) >= c.error));
        let open = counted(|a, b| curves.iter().all(|c| !c.hides || at(&c.upper, a, b) >= -c.error));
        assert!(got.lit <= lit + 2e-3 && got.open >= open - 2e-3, "{curves:?}: {got:?}, {lit} {open}");
        assert!(got.lit >= lit - 8e-3 && got.open <= open + 8e-3, "{curves:?}: {got:?}, {lit} {open}");
    }
}

/// A circle of which the area is known: pi/4 of the square.
#[test]
fn a_circle_converges_to_its_area() {
    let circle = Paraboloid { c: -1.0, l: [0.0; 2], q: [1.0, 1.0, 0.0] };
    // One quarter, as a cell of its own: a = (1 + x)/2, b = (1 + y)/2.
    let quarter = Paraboloid { c: -0.5, l: [0.5, 0.5], q: [0.25, 0.25, 0.0] };
    let whole = Curve { lower: circle, upper: circle, error: 0.0, hides: true };
    let part = Curve { lower: quarter, upper: quarter, ..whole };
    let truth = 1.0 - std::f64::consts::FRAC_PI_4;
    for curve in [whole, part] {
        let got = areas(&[curve], 1e-6, &mut Scratch::default());
        assert!(got.lit <= truth && truth <= got.open, "{got:?}");
    }
    let unknown = Curve { error: f64::INFINITY, ..whole };
    assert_eq!(areas(&[unknown], 1e-6, &mut Scratch::default()), Areas { lit: 0.0, open: 1.0, band: None });
    let nan = Curve { lower: Paraboloid { c: f64::NAN, ..circle }, ..whole };
    assert_eq!(areas(&[nan], 1e-6, &mut Scratch::default()), Areas { lit: 0.0, open: 1.0, band: None });
}

/// Of curves that are not monotone across, convex and concave ones: strips are enclosed, and tightly where they are thin. The truth
/// by roots of the quadratic on many lines.
#[test]
fn branches_are_enclosed_tightly() {
    let mut r = Random(23);
    let (mut turning, mut loose) = (0, 0);
    for round in 0..4000 {
        let mut p = r.paraboloid(0.3);
        let bend = (0.6 + r.next().abs()).copysign(r.next());
        (p.l[0], p.q[0]) = (0.5 * p.l[0], bend);
        let e = [0.0, 1e-3, 0.05][round % 3];
        let strip = Strip::number(round % 8, 8);
        let (lit, open) = (branches::lit(&p, e, strip), branches::open(&p, e, strip));
        // Length of the part of [-1, 1] in which p >= level on the line at y.
        let length = |level: f64, y: f64| {
            let [c, l] = Along::middle(&p, Strip { middle: strip.middle + strip.half * y, ..strip });
            let d = l * l - 4.0 * bend * (c - level);
            let inside = if d > 0.0 {
                let [a, b] = [-1.0, 1.0].map(|s| (s * d.sqrt() - l) / (2.0 * bend));
                (a.max(b).clamp(-1.0, 1.0) - a.min(b).clamp(-1.0, 1.0)).max(0.0)
            } else {
                0.0
            };
            if bend > 0.0 { 2.0 - inside } else { inside }
        };
        let mean = |level: f64| (0..64).map(|k| length(level, f64::from(2 * k + 1) / 64.0 - 1.0)).sum::<f64>() / 64.0;
        let (lit_truth, open_truth) = (mean(e), mean(-e));
        assert!(
            lit <= lit_truth + 5e-3 && open >= open_truth - 5e-3,
            "{p:?} {e} {strip:?}: {lit} {lit_truth}, {open} {open_truth}"
        );
        let both = length(e, 0.0);
        if 0.2 < both && both < 1.8 {
            turning += 1;
            loose += usize::from(lit < lit_truth - 0.05 || open > open_truth + 0.05);
        }
    }
    assert!(turning > 500 && 5 * loose < turning, "{loose} of {turning} are loose");
}

/// Places within a part are enclosed: against exact fractions.
#[test]
fn places_are_enclosed() {
    use num_rational::BigRational;
    let exact = |x: f64| BigRational::from_float(x).unwrap();
    let mut r = Random(17);
    for round in 0..2000 {
        let width = [1.0, 1e-3, 1e-12][round % 3];
        let (lo, x) = (r.next(), r.next());
        let of = Interval::new(lo, lo + width * (1.5 + r.next()));
        let t = (of.mid() + 0.5 * of.width() * x).clamp(of.lo(), of.hi());
        let found = places(Interval::new(t, of.hi()), of);
        let [low, high, t] = [of.lo(), of.hi(), t].map(exact);
        let place = (&t + &t - &low - &high) / (high - low);
        assert!(exact(found.lo()) <= place && found.hi() == 1.0, "{found:?} of {of:?}");
        assert!(place - exact(found.lo()) <= exact(1e-14), "no lower than needed: {found:?} of {of:?}");
    }
}

/// Bounds over parts of the square hold at points, and are exact where nothing is mixed.
#[test]
fn bounds_over_parts_hold() {
    let mut r = Random(19);
    for round in 0..2000 {
        let mut p = r.paraboloid([0.0, 0.3, 2.0][round % 3]);
        if round % 2 == 0 {
            p.q[2] = 0.0;
        }
        let mut range = || {
            let (x, y) = (r.next(), r.next());
            Interval::new(x.min(y), x.max(y))
        };
        let [a, b] = [range(), range()];
        let (lo, hi) = (p.lower_bound_over([a, b]), p.upper_bound_over([a, b]));
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        let place = |t: Interval, k: i32| t.lo() + t.width() * f64::from(k) / 64.0;
        for (i, j) in (0..=64).flat_map(|i| (0..=64).map(move |j| (i, j))) {
            let value = at(&p, place(a, i).min(1.0), place(b, j).min(1.0));
            (least, most) = (least.min(value), most.max(value));
        }
        assert!(lo <= least + 1e-14 && most - 1e-14 <= hi, "{p:?} {a:?} {b:?}: {lo} {least} {most} {hi}");
        if p.q[2] == 0.0 {
            assert!(least - lo < 2e-3 && hi - most < 2e-3, "{p:?} {a:?} {b:?}: {lo} {least} {most} {hi}");
        }
    }
}
