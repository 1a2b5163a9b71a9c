//! The steps one by one, on functions of which everything is known.
use super::cell::{self, Answer, fall, implies, level, look};
use super::policy::{Learned, Plan};
use super::slab::{Cell, Convexity, Kind, Slab, State, Way};
use crate::eval::{Gradient, Inclusion, JetPoint, QuadraticPoint, Workspace};
use crate::geom::strips::Curve;
use crate::geom::{Box3, Clip, Passage, Rect, Sheet, Vec3};
use crate::shadow::desk::Desk;
use crate::shadow::ledger::Ledger;
use crate::shadow::occluders::Front;
use crate::shadow::rectangle::Query;
use crate::shadow::{Known, Penumbra, Receiver, Says, Scratch, Tolerance, visible};
use crate::trace::{Cost, Piece, Sign, Surface};
use antumbra_interval::affine::{Affine, Jet};
use antumbra_interval::quadratic::{Paraboloid, Quadratic};
use antumbra_interval::{Decorated, Interval};
use std::ops::{Add, Mul, Sub};

/// `50 (z - 3/10)^2 (z - 7/10)^2 + x + (y/3) z - 1/50`: two valleys along rays that go up, the deeper one by turns.
fn valleys<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<Output = T>>(
    [x, y, z]: [T; 3],
    k: impl Fn(f64) -> T,
) -> T {
    let (a, b) = (z - k(0.3), z - k(0.7));
    k(50.0) * (a * a) * (b * b) + x + k(1.0 / 3.0) * y * z - k(0.02)
}

/// The function above as a surface; everything else follows by default.
struct Valleys;

impl Inclusion for Valleys {
    fn range(&self, region: &Box3, _: &mut Workspace) -> Interval {
        valleys(region.0, Interval::point)
    }
    fn decorated(&self, region: &Box3, work: &mut Workspace) -> Decorated {
        Decorated::from(self.range(region, work))
    }
    fn gradient(&self, region: &Box3, work: &mut Workspace) -> Gradient {
        let [_, y, z] = region.0;
        let point = Interval::point;
        let (a, b) = (z - point(0.3), z - point(0.7));
        let third = point(1.0 / 3.0);
        let up = point(100.0) * (a * b * (a + b)) + third * y;
        Gradient { value: self.range(region, work), partials: [Interval::ONE, third * z, up] }
    }
    fn continuous_everywhere(&self) -> bool {
        true
    }
    fn quadratic(&self, point: QuadraticPoint, _: &mut Workspace) -> Quadratic {
        valleys(point, |k| Quadratic::constant(Interval::point(k)))
    }
    fn jet(&self, point: JetPoint, _: &mut Workspace) -> Jet<Affine<3>> {
        valleys(point, |k| Jet::constant(Interval::point(k)))
    }
}

/// A floor that is nowhere near.
struct Floor;

impl Inclusion for Floor {
    fn range(&self, region: &Box3, _: &mut Workspace) -> Interval {
        region[2]
    }
    fn decorated(&self, region: &Box3, _: &mut Workspace) -> Decorated {
        Decorated::from(region[2])
    }
    fn gradient(&self, region: &Box3, _: &mut Workspace) -> Gradient {
        Gradient { value: region[2], partials: [Interval::ZERO, Interval::ZERO, Interval::ONE] }
    }
    fn continuous_everywhere(&self) -> bool {
        true
    }
}

/// No clip, no break.
const CLEAR: [Way; 2] =
    [Way { reach: 1.0, passage: Passage { outer: Interval::NON_NEGATIVE, inner: Interval::NON_NEGATIVE } }; 2];

fn surfaces() -> [Surface<'static>; 2] {
    let everywhere = |function| Surface { function, clip: Clip::Everywhere, region: Clip::Everywhere };
    [everywhere(&Floor), everywhere(&Valleys)]
}

fn light(half: f64) -> Rect {
    Rect::horizontal(Vec3::new(0.095, -0.3, 1.0), 2.0 * half)
}

fn receiver() -> Receiver {
    Receiver { point: Vec3::default().to_box(), surface: 0, side: Sign::Positive }
}

/// Least value along the ray to `(u, v)`, by many samples; between them it may be lower by 1e-5.
fn least(light: &Rect, u: f64, v: f64, [from, to]: [f64; 2]) -> f64 {
    let q = light.point(u, v);
    let at = |t: f64| valleys((q * t).0, |k| k);
    (0..=2000).map(|k| at(from + (to - from) * f64::from(k) / 2000.0)).fold(f64::INFINITY, f64::min)
}

fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

#[test]
fn claims_about_two_valleys_hold_on_dense_rays() {
    let (surfaces, receiver) = (surfaces(), receiver());
    let mut state = 1;
    let (mut lit, mut dark) = (0, 0);
    for half in [0.02, 0.1, 0.4] {
        for width in [1.0 / 255.0, 1e-4] {
            let light = light(half);
            let (mut scratch, mut work, mut cost) = (Scratch::default(), Workspace::default(), Cost::default());
            scratch.record_claims();
            let tolerance = Tolerance { width, rectangles: 4000, penumbra: Penumbra::Second };
            let pieces = Known::nothing(&surfaces);
            let b = visible(&surfaces, &receiver, &light, &pieces, tolerance, &mut scratch, &mut work, &mut cost);
            assert!(b.hi - b.lo <= width, "{b:?}");
            let n = 60;
            let place = |k: usize| (2 * k + 1) as f64 / n as f64 - 1.0;
            let seen = (0..n * n).filter(|k| least(&light, place(k % n), place(k / n), [0.0, 1.0]) > 0.0).count();
            let share = seen as f64 / (n * n) as f64;
            assert!(b.lo <= share + 0.01 && b.hi >= share - 0.01, "{b:?}, {share}");
            let claims = scratch.take_claims();
            assert!(!claims.is_empty());
            for claim in claims {
                for _ in 0..40 {
                    let at = [random(&mut state), random(&mut state)];
                    let [u, v] =
                        [0, 1].map(|k| claim.part[k].mid() + 0.5 * (claim.part[k].hi() - claim.part[k].lo()) * at[k]);
                    let truth = least(&light, u, v, [0.0, 1.0]);
                    let value = |p: &Paraboloid| {
                        p.c + at[0] * (p.l[0] + p.q[0] * at[0] + p.q[2] * at[1]) + at[1] * (p.l[1] + p.q[1] * at[1])
                    };
                    let (free, hidden) = match &claim.says {
                        Says::Lit => (true, false),
                        Says::Dark => (false, true),
                        Says::Curves(curves) => (
                            curves.iter().all(|c| value(&c.lower) > c.error + 1e-13),
                            curves.iter().any(|c| c.hides && value(&c.upper) < -c.error - 1e-13),
                        ),
                    };
                    lit += usize::from(free);
                    dark += usize::from(hidden);
                    assert!(!free || truth > 0.0, "{claim:?} at {at:?}: {truth}");
                    assert!(!hidden || truth < 1e-5, "{claim:?} at {at:?}: {truth}");
                }
            }
        }
    }
    assert!(lit > 500 && dark > 500, "{lit} {dark}");
}

/// Slabs that are said to be convex after a look at a cell and at parts of it, together with the function's true bend.
#[test]
fn a_convex_range_must_not_grow() {
    let (surfaces, receiver, light) = (surfaces(), receiver(), light(0.1));
    let fronts = [Some(Front { sign: Sign::Positive, at: 0.0 }); 2];
    let query = Query { surfaces: &surfaces, receiver: &receiver, fronts: &fronts, light: &light };
    let (mut scratch, mut work, mut cost) = (cell::Scratch::default(), Workspace::default(), Cost::default());
    let desk = Desk::new(&surfaces, &mut work, Learned::default());
    // g'' > 0 up to z = 0.3845 only: here it is proved, and the valley's floor is at 0.3.
    let (lo, hi) = (Sheet::level(0.05), Sheet::level(0.37));
    let known = Convexity { kind: Kind::Plain, bend: 0.0, least_at: Sheet::level(0.3) };
    let convex = Slab { surface: 1, lo, hi, state: State::Convex(known) };
    let mut state = 5;
    let mut seen = 0;
    for _ in 0..200 {
        let part = [0, 1].map(|_| {
            let (a, b) = (random(&mut state), random(&mut state));
            Interval::new(a.min(b), a.max(b) + 1e-3)
        });
        let cell = Cell::new(&query, &CLEAR, part);
        let mut open = vec![convex];
        if let Answer::Open(_) = desk.alone(look(&cell, 0..1, 1e-4, &mut open, &mut scratch, &desk, &mut cost)) {
            for slab in &open[1..] {
                let inside = convex.lo.certainly_at_most(&slab.lo, part) && slab.hi.certainly_at_most(&convex.hi, part);
                assert!(inside || !matches!(slab.state, State::Convex(_)), "{slab:?} has grown");
                seen += usize::from(matches!(slab.state, State::Convex(_)));
            }
        }
        // What is certified is true at every sampled place, and the certificate ends where convexity does.
        let wide = Slab { hi: Sheet::level(0.40), ..convex };
        assert_eq!(desk.alone(cell.bend(&wide, Kind::Plain, &desk, &mut cost)), None);
    }
    assert!(seen > 20, "{seen}");
}

/// Bounds of derivatives hold for the true ones: `g''/2` throughout a slab, `g'` on a sheet; and they are no wider than needed.
#[test]
fn bends_and_slopes_are_enclosed() {
    let (surfaces, receiver, light) = (surfaces(), receiver(), light(0.1));
    let fronts = [Some(Front { sign: Sign::Positive, at: 0.0 }); 2];
    let query = Query { surfaces: &surfaces, receiver: &receiver, fronts: &fronts, light: &light };
    let (mut work, mut cost, mut state) = (Workspace::default(), Cost::default(), 3);
    let desk = Desk::new(&surfaces, &mut work, Learned::default());
    let cell = Cell::new(&query, &CLEAR, [Interval::new(-1.0, 0.0), Interval::new(0.5, 1.0)]);
    let (lo, hi) = (Sheet { k: 0.27, slopes: [0.01, 0.0] }, Sheet { k: 0.32, slopes: [0.0, 0.01] });
    let slab = Slab { surface: 1, lo, hi, state: State::Outer };
    let bend = desk.alone(cell.bend(&slab, Kind::Plain, &desk, &mut cost)).unwrap();
    let on_sheet = desk.alone(cell.slope(&Slab { hi: lo, ..slab }, Kind::Plain, &desk, &mut cost));
    let (mut least, mut slopes) = (f64::INFINITY, Interval::EMPTY);
    for _ in 0..2000 {
        let (u, v) = (0.5 * random(&mut state) - 0.5, 0.25 * random(&mut state) + 0.75);
        let q = light.point(u, v);
        let at = |t: f64| valleys((q * t).0, |k| k);
        let place = |s: &Sheet| s.k + s.slopes[0] * u + s.slopes[1] * v;
        let (from, to) = (place(&lo), place(&hi));
        let (t, h) = (from + 0.5 * (1.0 + random(&mut state)) * (to - from), 1e-3);
        least = least.min(0.5 * (at(t + h) - 2.0 * at(t) + at(t - h)) / (h * h));
        let slope = (at(from + h) - at(from - h)) / (2.0 * h);
        slopes = slopes.hull(Interval::point(slope));
    }
    assert!(bend <= least + 1e-3 && least < bend + 2.0, "{bend}, {least}");
    assert!(on_sheet.lo() <= slopes.lo() + 1e-3 && slopes.hi() <= on_sheet.hi() + 1e-3, "{on_sheet:?}, {slopes:?}");
    assert!(on_sheet.width() < 1.5 * slopes.width() + 0.1, "{on_sheet:?}, {slopes:?}");
}

/// Convex functions fall below their value on a sheet by no more than was said, and parabolas by just that.
#[test]
fn a_convex_function_falls_no_deeper() {
    let mut state = 11;
    let mut used = 0.0_f64;
    for round in 0..2000 {
        let [c, d, quartic] = [random(&mut state), 3.0 * random(&mut state), 5.0 * (1.0 + random(&mut state))];
        // g = d x + m x^2 + (quartic) x^4 - c x^3, x = t - t_0: g''/2 = m - 3 c x + 6 quartic x^2 >= m - 3 c^2 / (8 quartic).
        let quartic = if round % 3 == 0 { 0.0 } else { quartic };
        let c = if round % 3 == 0 { 0.0 } else { c };
        let m = 2.0 * (1.0 + random(&mut state)) + 1e-3;
        let bend = m - if quartic > 0.0 { 0.375 * c * c / quartic } else { 0.0 };
        if bend < 0.0 {
            continue;
        }
        let reach = 1.0 + random(&mut state);
        for (below, above) in [(reach, reach), (0.0, reach), (reach, 0.0), (0.2 * reach, reach)] {
            let (from, to) = (-below, above);
            let said = fall(Interval::new(d - 1e-3, d + 1e-3), bend, [below, above]);
            let g = |x: f64| x * (d + x * (m + x * (quartic * x - c)));
            let deepest = (0..=400).map(|k| g(from + (to - from) * f64::from(k) / 400.0)).fold(0.0, f64::min);
            assert!(-deepest <= said + 1e-12, "{d} {m} {c} {quartic}, reach {below} {above}: {deepest}, {said}");
            used = used.max(-deepest / said.max(1e-2));
        }
    }
    assert!(used > 0.98, "{used}: bounds are tight for parabolas");
    // Without bend it is a line, and nothing falls where it rises.
    assert!((fall(Interval::new(-2.0, 1.0), 0.0, [0.5; 2]) - 1.0).abs() < 1e-12);
    assert_eq!(fall(Interval::new(0.0, 1.0), 0.0, [0.0, 0.5]), 0.0);
    assert!(fall(Interval::new(-0.1, 1.0), 0.0, [0.0, 0.5]) > 0.0);
    assert!(fall(Interval::new(0.0, 0.1), 0.0, [0.5, 0.0]) > 0.0);
    assert!(!fall(Interval::ENTIRE, 1.0, [0.5; 2]).is_finite(), "nothing known");
}

/// A sheet of which not all is proved to lie in the core is none; where the core's sheets cross, it lies on both sides of its ends.
#[test]
fn sheets_in_the_wrong_order_prove_nothing() {
    let (surfaces, receiver, light) = (surfaces(), receiver(), light(0.1));
    let fronts = [Some(Front { sign: Sign::Positive, at: 0.0 }); 2];
    let query = Query { surfaces: &surfaces, receiver: &receiver, fronts: &fronts, light: &light };
    let unit = Interval::new(-1.0, 1.0);
    let cell = Cell::new(&query, &CLEAR, [unit, unit]);
    let core = |lo, hi| Slab { surface: 1, lo, hi, state: State::Outer };
    let plan = |k: f64, slope: f64| Plan::around(Sheet { k, slopes: [slope, 0.0] }, 0.01);
    let straight = core(Sheet::level(0.2), Sheet::level(0.4));
    let found = |core: &Slab, plan: &Plan| {
        let (slab, [below, above]) = level(&cell, core, plan);
        assert_eq!(slab.lo, slab.hi);
        (slab.lo, [below, above].map(|x| (1e6 * x).round() / 1e6))
    };
    assert_eq!(found(&straight, &plan(0.3, 0.05)), (Sheet { k: 0.3, slopes: [0.05, 0.0] }, [0.15, 0.15]));
    assert_eq!(found(&straight, &plan(0.1, 0.0)), (straight.lo, [0.0, 0.2]));
    assert_eq!(found(&straight, &plan(0.5, 0.0)), (straight.hi, [0.2, 0.0]));
    // A plan that leaves the core on some rays: parallel to the nearer end, in its place.
    assert_eq!(found(&straight, &plan(0.28, 0.2)), (Sheet::level(0.28), [0.08, 0.12]));
    let crossed = core(Sheet { k: 0.3, slopes: [0.2, 0.0] }, Sheet { k: 0.32, slopes: [-0.2, 0.0] });
    assert_eq!(found(&crossed, &plan(0.1, 0.0)), (crossed.lo, [0.38, 0.42]));
    assert_eq!(found(&crossed, &plan(0.5, 0.0)), (crossed.hi, [0.42, 0.38]));
    // Between sheets that cross nothing is proved to lie: the nearer end.
    assert_eq!(found(&crossed, &plan(0.308, 0.0)), (crossed.lo, [0.38, 0.42]));
}

/// A slab is looked at as a whole, whichever sheet is the lower one.
#[test]
fn crossing_sheets_enclose_what_lies_between() {
    let (surfaces, receiver, light) = (surfaces(), receiver(), light(0.3));
    let fronts = [Some(Front { sign: Sign::Positive, at: 0.0 }); 2];
    let query = Query { surfaces: &surfaces, receiver: &receiver, fronts: &fronts, light: &light };
    let (mut work, mut cost) = (Workspace::default(), Cost::default());
    let desk = Desk::new(&surfaces, &mut work, Learned::default());
    let part = [Interval::new(-0.5, 0.25), Interval::new(0.0, 1.0)];
    let cell = Cell::new(&query, &CLEAR, part);
    let mut state = 9;
    for (lo, hi) in [
        (Sheet { k: 0.2, slopes: [0.1, -0.1] }, Sheet { k: 0.4, slopes: [0.1, -0.1] }),
        (Sheet { k: 0.3, slopes: [0.2, 0.1] }, Sheet { k: 0.35, slopes: [-0.2, 0.0] }),
    ] {
        let slab = Slab { surface: 1, lo, hi, state: State::Outer };
        let form = desk.alone(cell.form(&slab, Kind::Plain, &desk, &mut cost));
        for _ in 0..500 {
            let [s, a, b] = [random(&mut state), random(&mut state), random(&mut state)];
            let (u, v) = (-0.125 + 0.375 * a, 0.5 + 0.5 * b);
            let at = |s: &Sheet| s.k + s.slopes[0] * u + s.slopes[1] * v;
            let t = 0.5 * (at(&lo) + at(&hi)) + 0.5 * s * (at(&hi) - at(&lo));
            let truth = valleys((light.point(u, v) * t).0, |k| k);
            let terms = [s, a, b, s * s, a * a, b * b, s * a, s * b, a * b];
            let model: f64 = form.linear().iter().chain(form.quadratic()).zip(terms).map(|(k, t)| k * t).sum::<f64>()
                + form.centre();
            assert!((truth - model).abs() <= form.error() + 1e-12, "{slab:?} at {s} {a} {b}: {truth}, {form:?}");
        }
        assert!(form.error() < 0.5, "{form:?}");
    }
}

/// A band and its two rests are a partition, whatever is undecided.
#[test]
fn cropping_loses_nothing() {
    let part = [Interval::new(-0.7, 0.1), Interval::new(0.3, 0.31)];
    let whole = super::area(part);
    for (from, to) in [(-0.2, 0.3), (-1.0, 0.5), (0.4, 1.0), (-1.0, 1.0), (0.6, 0.2), (1.5, 1.0), (-1.0, -3.0)] {
        for across in 0..2 {
            for lit_above in [false, true] {
                let band = crate::geom::strips::Band { across, lit_above, undecided: [[from, to]; 2] };
                let mut ledger = Ledger::default();
                ledger.open(part, [0.0, 1.0], super::Rest { slabs: (0, 0), curves: (0, 0), band: Some(band) });
                let (node, mut parts) = (ledger.next().unwrap(), Vec::new());
                super::crop(&node, &band, &mut ledger, &mut parts);
                let [sums_lo, sums_hi] = ledger.bounds();
                let going_on: f64 = parts.iter().map(|(p, _)| super::area(*p)[0]).sum();
                let share = if from < to { 0.5 * (to - from) } else { 0.0 };
                assert!((going_on / whole[0] - share).abs() < 1e-9, "{band:?}");
                let clamped = |x: f64| x.clamp(-1.0, 1.0);
                let lit = if lit_above { 0.5 * (1.0 - clamped(to)) } else { 0.5 * (1.0 + clamped(from)) };
                let not_hidden = if lit_above { 0.5 * (1.0 - clamped(from)) } else { 0.5 * (1.0 + clamped(to)) };
                assert!(
                    sums_lo <= lit * whole[1] + 1e-15 && sums_lo >= lit * whole[0] - 1e-9,
                    "{band:?}: {sums_lo}, {sums_hi}"
                );
                assert!(sums_hi + going_on >= not_hidden * whole[0] - 1e-15, "{band:?}: {sums_lo}, {sums_hi}");
            }
        }
    }
}

fn curve(state: &mut u64, bend: f64) -> Curve {
    let mut next = |scale: f64| scale * random(state);
    let lower = Paraboloid { c: next(1.0), l: [next(1.0), next(1.0)], q: [next(bend), next(bend), next(bend)] };
    Curve {
        lower,
        upper: Paraboloid { c: lower.c + next(0.01), ..lower },
        error: next(0.05).abs(),
        hides: next(1.0) > -0.8,
    }
}

fn value(p: &Paraboloid, [a, b]: [f64; 2]) -> f64 {
    p.c + a * (p.l[0] + p.q[0] * a + p.q[2] * b) + b * (p.l[1] + p.q[1] * b)
}

/// What is said of parts of a cell is true of points in them, and with what stays undecided it is all of the part.
#[test]
fn curves_tell_the_truth_of_parts() {
    let mut state = 11;
    let [mut lit, mut dark, mut settled] = [0; 3];
    let cell = [Interval::new(-0.75, -0.25), Interval::new(0.1, 0.3)];
    for round in 0..2000 {
        let curves: Vec<Curve> = (0..1 + round % 3).map(|_| curve(&mut state, [0.0, 0.3, 1.0][round % 3])).collect();
        let seen = super::Seen { part: cell, curves: &curves };
        let part = [Interval::new(-0.75, -0.5), cell[1]];
        let (mut ledger, mut claims) = (Ledger::default(), Some(Vec::new()));
        let rest = seen.undecided(part, &mut ledger, &mut claims);
        let claims = claims.unwrap();
        settled += usize::from(rest.is_none());
        let area = |part| super::area(part)[1];
        let sum: f64 = claims.iter().map(|claim| area(claim.part)).sum::<f64>() + rest.map_or(0.0, area);
        assert!((sum - area(part)).abs() < 1e-15, "{claims:?} {rest:?}: a partition");
        for claim in &claims {
            for _ in 0..50 {
                let at = [0, 1].map(|k| {
                    let place = claim.part[k].mid() + 0.5 * claim.part[k].width() * random(&mut state);
                    (place - cell[k].mid()) / (0.5 * cell[k].width())
                });
                let free = |c: &Curve| value(&c.lower, at) > c.error - 1e-12;
                let hides = |c: &Curve| c.hides && value(&c.upper, at) < -c.error + 1e-12;
                match claim.says {
                    Says::Lit => assert!(curves.iter().all(free), "{claim:?} {curves:?} at {at:?}"),
                    Says::Dark => assert!(curves.iter().any(hides), "{claim:?} {curves:?} at {at:?}"),
                    Says::Curves(_) => panic!("settled"),
                }
            }
            lit += usize::from(claim.says == Says::Lit);
            dark += usize::from(claim.says == Says::Dark);
        }
    }
    assert!(lit > 500 && dark > 500 && settled > 300, "{lit} lit, {dark} dark, {settled} settled");
}

/// A slab that is dropped for another one hides nowhere where that does not; and curves that run side by side are told apart.
#[test]
fn what_is_implied_is_hidden_already() {
    let mut state = 13;
    let mut found = 0;
    for round in 0..20_000 {
        let (first, mut other) = (curve(&mut state, 0.3), curve(&mut state, 0.3));
        if round % 2 == 0 {
            // About a multiple of the first one, moved.
            let up = 0.3 * random(&mut state);
            let near = |p: &Paraboloid| Paraboloid { c: 2.0 * p.c + up, l: p.l.map(|x| 2.0 * x), q: p.q };
            other = Curve { lower: near(&first.lower), upper: near(&first.upper), ..other };
        }
        if !implies(&first, &other) {
            continue;
        }
        found += 1;
        for _ in 0..50 {
            let at = [random(&mut state), random(&mut state)];
            let may_hide = value(&other.lower, at) <= other.error;
            assert!(
                !may_hide || first.hides && value(&first.upper, at) < -first.error,
                "{first:?} {other:?} at {at:?}"
            );
        }
    }
    assert!(found > 500, "{found}");
}

/// Touching and overlapping pieces become one slab, others stay apart.
#[test]
fn pieces_become_slabs() {
    let piece = |surface, lo, hi| Piece { surface, t: Interval::new(lo, hi) };
    let slabs = super::whole_slabs(&[piece(1, 0.5, 0.6), piece(0, 0.2, 0.3), piece(0, 0.0, 0.2), piece(0, 0.4, 0.5)]);
    let found: Vec<_> = slabs.iter().map(|s| (s.surface, s.lo.k, s.hi.k)).collect();
    assert_eq!(found, [(0, 0.0, 0.3), (0, 0.4, 0.5), (1, 0.5, 0.6)]);
}
