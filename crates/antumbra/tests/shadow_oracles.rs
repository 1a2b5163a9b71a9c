//! Brackets of the visible fraction against exact answers: rational arithmetic where they are rational, enclosures of pi
//! and one-dimensional integrals with a proved margin where they are not. The scene is a floor `z = 0` with a light above
//! it and one occluder in between, unless said otherwise.
#![allow(
    clippy::disallowed_methods,
    reason = "the checker is independent on purpose: it uses other functions than the library"
)]
#[path = "truth/bench.rs"]
mod bench;
#[path = "truth/exact.rs"]
mod exact;

use antumbra::geom::{Rect, Vec3};
use bench::{Bench, WIDTHS, holds};
use exact::{Point3, exact as rational, ratio, share_above, share_beside};
use num_rational::BigRational;
use num_traits::{One, ToPrimitive, Zero};
use std::f64::consts::PI;

/// Somewhere above the floor: the viewer's side.
const ABOVE: Vec3 = Vec3::new(0.0, 0.0, 100.0);
const FLOOR: &str = "z = 0";

fn light(x: f64, y: f64, z: f64, half: f64) -> Rect {
    Rect::horizontal(Vec3::new(x, y, z), 2.0 * half)
}

fn just(x: BigRational) -> (BigRational, BigRational) {
    (x.clone(), x)
}

fn share(x: i64) -> (BigRational, BigRational) {
    just(ratio(x, 1))
}

/// A number known up to `margin`.
fn about(x: f64, margin: f64) -> (BigRational, BigRational) {
    (rational(x - margin), rational(x + margin))
}

/// Bounds of `1 - k pi`, k >= 0.
fn one_minus_pi_times(k: &BigRational) -> (BigRational, BigRational) {
    let tens = 1_000_000_000_000_000_i64;
    let (lo, hi) = (ratio(3_141_592_653_589_793, tens), ratio(3_141_592_653_589_794, tens));
    (BigRational::one() - k * hi, BigRational::one() - k * lo)
}

fn corners(a: &BigRational, b: &BigRational, z: [&BigRational; 2]) -> Vec<Point3> {
    let mut all = Vec::new();
    for x in [a.clone(), -a] {
        for y in [b.clone(), -b] {
            all.extend(z.map(|z| [x.clone(), y.clone(), z.clone()]));
        }
    }
    all
}

/// A box `|x| <= 1/2, |y| <= 1/3, |z - 2| <= 1/4` and where receivers under it are.
const BOX: &str = "max(max(abs(x) - 1/2, abs(y) - 1/3), abs(z - 2) - 1/4) = 0";

fn box_corners() -> Vec<Point3> {
    corners(&ratio(1, 2), &ratio(1, 3), [&ratio(7, 4), &ratio(9, 4)])
}

#[test]
fn a_box_over_the_floor() {
    let (bench, light) = (Bench::new(&[FLOOR, BOX]), light(0.0, 0.0, 4.0, 1.0));
    let mut seen = [false; 3];
    for (x, y) in
        [(0.0, 0.0), (0.25, 0.0), (0.5, 0.25), (0.75, -0.5), (1.25, 0.125), (-1.625, 0.75), (2.5, 1.0), (0.0, 3.0)]
    {
        let at = Vec3::new(x, y, 0.0);
        let truth = share_beside(&exact::point(at), &box_corners(), &light);
        seen[if truth.is_zero() { 0 } else { 1 + usize::from(truth.is_one()) }] = true;
        bench.expect(at, ABOVE, &light, &just(truth));
    }
    // A smaller light has an umbra.
    let small = Rect::horizontal(Vec3::new(0.0, 0.0, 4.0), 0.5);
    let truth = share_beside(&exact::point(Vec3::default()), &box_corners(), &small);
    seen[0] = truth.is_zero();
    bench.expect(Vec3::default(), ABOVE, &small, &just(truth));
    assert_eq!(seen, [true; 3], "umbra, penumbra and lit");
}

#[test]
fn a_box_under_tilted_lights() {
    let bench = Bench::new(&[FLOOR, BOX]);
    let lights = [
        // Turned about the vertical by the angle of the triangle 3, 4, 5.
        ([0.25, 0.0, 4.0], [0.75, 1.0, 0.0], [-1.0, 0.75, 0.0], [(0.0, 0.0), (0.5, -0.25), (-2.0, 0.0)]),
        // Leaning, and neither square nor rectangular.
        ([0.0, 0.5, 4.0], [1.0, 0.0, 0.5], [0.25, 0.75, -0.25], [(0.0, 0.0), (-0.75, 0.125), (1.5, -0.5)]),
        // Upright.
        ([3.0, 0.0, 4.0], [0.0, 1.5, 0.0], [0.0, 0.0, 1.0], [(-2.0, 0.0), (-1.5, 0.5), (-1.0, -0.25)]),
    ];
    for (center, u, v, receivers) in lights {
        let light = Rect { center: Vec3(center), edge_u: Vec3(u), edge_v: Vec3(v) };
        for (x, y) in receivers {
            let at = Vec3::new(x, y, 0.0);
            let truth = share_beside(&exact::point(at), &box_corners(), &light);
            bench.expect_within(2.0, at, ABOVE, &light, &just(truth));
        }
    }
}

/// `X = M x + T` with an integer matrix of orthogonal columns of length 3: the shares stay the same, and all numbers of
/// the moved scene are exact. Backwards: `x = M^t (X - T) / 9`.
#[test]
fn a_motion_changes_nothing() {
    let (m, shift) = ([[1.0, 2.0, -2.0], [2.0, 1.0, 2.0], [2.0, -2.0, -1.0]], [5.0, -7.0, 11.0]);
    let turned = |v: Vec3| Vec3(std::array::from_fn(|i| (0..3).map(|k| m[i][k] * v[k]).sum()));
    let moved = |p: Vec3| turned(p) + Vec3(shift);
    let old = |k: usize| {
        let sum: Vec<String> =
            (0..3).map(|i| format!("({}) * ({} - ({}))", m[i][k], ["x", "y", "z"][i], shift[i])).collect();
        format!("({}) / 9", sum.join(" + "))
    };
    let [x, y, z] = [old(0), old(1), old(2)];
    let text = format!("max(max(abs({x}) - 1/2, abs({y}) - 1/3), abs({z} - 2) - 1/4) = 0");
    let bench = Bench::new(&[&format!("{z} = 0"), &text]);
    let flat = light(0.0, 0.0, 4.0, 1.0);
    let tilted = Rect { center: moved(flat.center), edge_u: turned(flat.edge_u), edge_v: turned(flat.edge_v) };
    for (px, py) in [(0.0, 0.0), (0.75, -0.5), (-1.625, 0.75), (2.5, 1.0)] {
        let at = Vec3::new(px, py, 0.0);
        let truth = share_beside(&exact::point(at), &box_corners(), &flat);
        // The same geometry again, by the oracle in the moved scene.
        let there: Vec<Point3> = box_corners()
            .iter()
            .map(|c| std::array::from_fn(|i| (0..3).fold(rational(shift[i]), |sum, k| sum + rational(m[i][k]) * &c[k])))
            .collect();
        assert_eq!(truth, share_beside(&exact::point(moved(at)), &there, &tilted));
        bench.expect(moved(at), moved(ABOVE), &tilted, &just(truth));
    }
}

#[test]
fn a_bar_too_thin_for_samplers() {
    let text = "max(max(abs(x) - 0.000000001, abs(y) - 1/2), abs(z - 2) - 1/100) = 0";
    let (bench, light) = (Bench::new(&[FLOOR, text]), light(0.0, 0.0, 4.0, 1.0));
    let (a, h) = (ratio(1, 1_000_000_000), ratio(1, 100));
    let bar = corners(&a, &ratio(1, 2), [&(ratio(2, 1) - &h), &(ratio(2, 1) + &h)]);
    for x in [0.0, 0.125, 0.5] {
        let at = Vec3::new(x, 0.25, 0.0);
        let truth = share_beside(&exact::point(at), &bar, &light);
        assert!(truth < BigRational::one());
        for width in WIDTHS {
            let b = bench.ask(at, ABOVE, &light, width, 50_000);
            assert!(holds(&b, &just(truth.clone())) && b.lo < 1.0, "{b:?}");
            assert!(b.hi - b.lo <= 0.01, "{b:?}");
        }
    }
}

/// `x <= 0` hides, between `z = h - d` and `z = h + d`: a ray from p to q on the light is inside at `t = z / H` iff
/// `p_x + t (q_x - p_x) <= 0`, so q is hidden iff `q_x <= p_x (1 - 1/t)` at one of the two ends.
#[test]
fn a_half_plane_gives_a_ramp() {
    let bench = Bench::new(&[FLOOR, "max(x, abs(z - 1) - 1/8) = 0"]);
    let light = light(0.0, 0.0, 4.0, 1.0);
    for n in -4..=6 {
        let p = f64::from(n) / 8.0;
        let limit = [ratio(7, 32), ratio(9, 32)].map(|t| rational(p) * (BigRational::one() - t.recip()));
        let limit = limit[0].clone().max(limit[1].clone());
        let truth = ((BigRational::one() - limit) / ratio(2, 1)).clamp(BigRational::zero(), BigRational::one());
        bench.expect(Vec3::new(p, 0.375, 0.0), ABOVE, &light, &just(truth));
    }
}

/// The ball of radius r at height h over the receiver blocks a disc of radius `R = H r / sqrt(h^2 - r^2)`.
#[test]
fn a_sphere_on_the_axis() {
    let bench = Bench::new(&[FLOOR, "x^2 + y^2 + (z - 1.25)^2 = 0.75^2"]);
    // H = 4: R = 3.
    for half in [5.0, 3.5, 3.0] {
        let k = ratio(9, 4) / (rational(half) * rational(half));
        bench.expect(Vec3::default(), ABOVE, &light(0.0, 0.0, 4.0, half), &one_minus_pi_times(&k));
    }
    // R between L and L sqrt 2: four caps of the disc are outside of the light.
    let half = 2.5_f64;
    let cap = 9.0 * (half / 3.0).acos() - half * (9.0 - half * half).sqrt();
    let truth = 1.0 - (9.0 * PI - 4.0 * cap) / (4.0 * half * half);
    bench.expect(Vec3::default(), ABOVE, &light(0.0, 0.0, 4.0, half), &about(truth, 1e-12));
    // R > L sqrt 2.
    for half in [2.0, 0.5] {
        bench.expect(Vec3::default(), ABOVE, &light(0.0, 0.0, 4.0, half), &share(0));
    }
}

/// Bounds of the share of a horizontal light that a ball leaves visible. Whether the ball hides q is a quadratic
/// inequality in `q_y`, so each column of the light has an exact chord; the hidden region is convex, so the chord is a
/// concave function of `q_x`. Chords at nodes bound its integral: from below by trapezia, from above by continued
/// secants; here simply by the largest change of the clipped chord, which rises once and falls once.
fn beside_ball(p: [f64; 2], center: [f64; 3], radius: f64, light: &Rect) -> (BigRational, BigRational) {
    let (half, height) = (light.edge_u[0], light.center[2]);
    let chord = |qx: f64| {
        let (dx, c) = (qx - p[0], [center[0] - p[0], center[1] - p[1], center[2]]);
        // (d.c)^2 >= |d|^2 (|c|^2 - r^2), with d = (dx, y, height).
        let k = c[0] * c[0] + c[1] * c[1] + c[2] * c[2] - radius * radius;
        let (a, s) = (c[1] * c[1] - k, dx * c[0] + height * c[2]);
        let (b, c0) = (s * c[1], s * s - (dx * dx + height * height) * k);
        // a y^2 + 2 b y + c0 >= 0 with a < 0: an ellipse.
        let disc = b * b - a * c0;
        assert!(a < 0.0);
        if disc <= 0.0 {
            return 0.0;
        }
        let (y0, y1) = ((-b + disc.sqrt()) / a + p[1], (-b - disc.sqrt()) / a + p[1]);
        let (lo, hi) = (light.center[1] - half, light.center[1] + half);
        (y1.min(hi) - y0.max(lo)).max(0.0)
    };
    let n = 200_000;
    let step = 2.0 * half / f64::from(n);
    let chords: Vec<f64> = (0..=n).map(|i| chord(light.center[0] - half + step * f64::from(i))).collect();
    let sum: f64 = chords.windows(2).map(|w| 0.5 * (w[0] + w[1]) * step).sum();
    // Unimodal: upper minus lower sum is at most two steps of the full height.
    let margin = 2.0 * step * 2.0 * half + 1e-9;
    let area = 4.0 * half * half;
    about(1.0 - sum / area, margin / area)
}

#[test]
fn a_sphere_off_the_axis() {
    let bench = Bench::new(&[FLOOR, "x^2 + y^2 + (z - 2)^2 = 1/4"]);
    let light = light(0.25, -0.5, 4.0, 1.5);
    for (x, y) in [(0.25, 0.5), (1.0, 0.5), (-1.25, 1.0), (1.75, 0.75)] {
        let truth = beside_ball([x, y], [0.0, 0.0, 2.0], 0.5, &light);
        bench.expect(Vec3::new(x, y, 0.0), ABOVE, &light, &truth);
    }
}

/// The ring of radius 1 at height 2 with half the light's height: a ray of slope `k = rho / z` from the origin meets the
/// tube iff `g(k) = min_z ((k z)^2 - 1)^2 + (z - 2)^2 <= r^2`, which holds on an interval `[k_1, k_2]`.
fn ring_loss(r: f64, half: f64) -> (f64, f64) {
    // In z = 2 + b, slope k = (1 + a) / 2: k z - 1 = (a + b / 2 + a b / 2), no cancellation. Ternary search in b: g is
    // convex near the ring.
    let g = |a: f64| {
        let value = |b: f64| {
            let e = a + 0.5 * b + 0.5 * a * b;
            let square = e * (2.0 + e);
            square * square + b * b
        };
        let (mut lo, mut hi) = (-4.0 * r, 4.0 * r);
        for _ in 0..200 {
            let (b, c) = (lo + (hi - lo) / 3.0, hi - (hi - lo) / 3.0);
            if value(b) < value(c) { hi = c } else { lo = b }
        }
        value(0.5 * (lo + hi))
    };
    // Largest |a| of either sign with g(a) <= r^2, by bisection; g grows away from a = 0.
    let end = |sign: f64| {
        let (mut inside, mut outside) = (0.0, 4.0 * r);
        for _ in 0..200 {
            let middle = 0.5 * (inside + outside);
            if g(sign * middle) <= r * r { inside = middle } else { outside = middle }
        }
        sign * inside
    };
    // Area of the annulus on the light, 4 high: pi (4 k)^2 between the ends; (1 + a2)^2 - (1 + a1)^2 without cancellation.
    let (a1, a2) = (end(-1.0), end(1.0));
    let loss = PI * 4.0 * (a2 - a1) * (2.0 + a1 + a2) / (4.0 * half * half);
    (loss, 1e-6 * loss)
}

#[test]
fn rings_of_wire_cost_a_little_light() {
    for (text, r) in [
        ("(x^2 + y^2 - 1)^2 + (z - 2)^2 - 0.001^2 = 0", 1e-3),
        ("(x^2 + y^2 - 1)^2 + (z - 2)^2 - 0.000001^2 = 0", 1e-6),
    ] {
        let (bench, light) = (Bench::new(&[FLOOR, text]), light(0.0, 0.0, 4.0, 3.0));
        let (loss, margin) = ring_loss(r, 3.0);
        // To first order the tube is an ellipse with half axes r/2 and r, as wide as 2 r sqrt(1/4 + k^2), k = 1/2.
        assert!((loss / r - PI * 32.0 * 0.5_f64.sqrt() / 2.0 / 36.0).abs() < 2.0 * r, "{}", loss / r);
        let truth = (rational(1.0) - rational(loss + margin), rational(1.0) - rational(loss - margin));
        // The ring's shadow is long: the bracket narrows like one over the number of rectangles.
        for (rectangles, width) in [(4000, 0.04), (40_000, WIDTHS[0])] {
            let b = bench.ask(Vec3::default(), ABOVE, &light, WIDTHS[1], rectangles);
            assert!(holds(&b, &truth) && b.lo < 1.0, "{b:?}, truth {}", 1.0 - loss);
            assert!(b.hi - b.lo <= width, "{b:?}");
        }
    }
}

#[test]
fn squares_cast_the_shadows_of_their_roots() {
    let [plain, squared] =
        ["x^2 + y^2 + (z - 2)^2 - 1 = 0", "(x^2 + y^2 + (z - 2)^2 - 1)^2 = 0"].map(|text| Bench::new(&[FLOOR, text]));
    let light = light(0.0, 0.0, 4.0, 1.0);
    let mut partly = 0;
    for k in 0..12 {
        let at = Vec3::new(0.25 * f64::from(k), 0.125, 0.0);
        let [a, b] = [&plain, &squared].map(|bench| bench.ask(at, ABOVE, &light, WIDTHS[0], 4000));
        assert_eq!(a, b);
        partly += usize::from(a.lo > 0.0 && a.hi < 1.0);
    }
    assert!(partly >= 4);
}

#[test]
fn curves_cast_shadows_without_area() {
    let (bench, light) = (Bench::new(&[FLOOR, "(x^2 + y^2 - 1)^2 + (z - 2)^2 = 0"]), light(0.0, 0.0, 4.0, 3.0));
    for (x, y) in [(0.0, 0.0), (0.5, -0.25), (4.0, 1.0)] {
        let b = bench.ask(Vec3::new(x, y, 0.0), ABOVE, &light, WIDTHS[0], 4000);
        assert!(b.hi == 1.0 && b.lo >= 0.95, "{b:?}");
    }
}

#[test]
fn poles_cast_no_shadow() {
    let light = light(0.0, 0.0, 4.0, 1.0);
    for text in ["1 / (x^2 + y^2 + (z - 2)^2 - 1) = 0", "1 / (z - 2) = 0", "1 / (z - 2) + x / 1000 = 0"] {
        let bench = Bench::new(&[FLOOR, text]);
        for (x, y) in [(0.0, 0.0), (0.75, 0.5), (2.0, 0.0)] {
            let at = Vec3::new(x, y, 0.0);
            let b = bench.ask(at, ABOVE, &light, WIDTHS[0], 1000);
            // The third formula is 0 only where |x| |z - 2| = 1000.
            assert!(b.hi == 1.0, "{text} at {at:?}: {b:?}");
        }
    }
}

#[test]
fn undefined_places_hide_nothing() {
    let (above, light) = (Vec3::default(), light(0.0, 0.0, 4.0, 1.0));
    // sqrt(x) = y is the half parabola x = y^2, y >= 0, upright. A ray from the origin meets it where t x = (t y)^2, at
    // t = x / y^2, which is at most 1 where y^2 >= x.
    // The share with x >= 0, y >= sqrt x: a quarter of the square times the integral of 1 - sqrt x, which is 1/3.
    let bench = Bench::new(&["z = 0", "sqrt(x) - y = 0"]);
    let b = bench.ask(above, ABOVE, &light, WIDTHS[0], 4000);
    assert!(holds(&b, &just(ratio(11, 12))), "{b:?}");
    // From (1, -1, 0), in the convex region under the curve: a segment leaves it through the curve iff q is above the
    // curve (x >= 0) or above the line y = -x (x < 0). Hidden: 1/3 + 1/2 of the square's 4.
    let b = bench.ask(Vec3::new(1.0, -1.0, 0.0), ABOVE, &light, WIDTHS[0], 20_000);
    assert!(holds(&b, &just(ratio(19, 24))) && b.hi - b.lo < 0.5, "{b:?}");
}

#[test]
fn tangent_edges_of_the_light() {
    let bench = Bench::new(&[FLOOR, "x^2 + y^2 + (z - 1.25)^2 = 0.75^2"]);
    // The disc of radius 3 touches the edge x = 3 of the light, from outside and from inside.
    bench.expect(Vec3::default(), ABOVE, &light(4.0, 0.0, 4.0, 1.0), &share(1));
    bench.expect(Vec3::default(), ABOVE, &light(0.0, 0.0, 4.0, 3.0), &one_minus_pi_times(&ratio(1, 4)));
    // The plate's edge is exactly the edge of the light, from either side.
    let plate = Bench::new(&[FLOOR, "max(x, abs(z - 2) - 1/4) = 0"]);
    plate.expect(Vec3::default(), ABOVE, &light(1.0, 0.0, 4.0, 1.0), &share(1));
    let b = plate.ask(Vec3::default(), ABOVE, &light(-1.0, 0.0, 4.0, 1.0), WIDTHS[0], 50_000);
    assert!(b.lo == 0.0 && b.hi <= WIDTHS[0], "{b:?}");
}

/// A ball is convex: from its surface a point is visible iff it is above the tangent plane.
#[test]
fn the_horizon_of_a_sphere() {
    let bench = Bench::new(&["x^2 + y^2 + z^2 = 25"]);
    let outside = Vec3::new(50.0, 0.0, 0.0);
    let mut partly = 0;
    for p in [[3.0, 0.0, 4.0], [0.0, -4.0, 3.0], [-4.0, 0.0, 3.0], [5.0, 0.0, 0.0]] {
        let p = Vec3(p);
        for k in -6..=6 {
            let center = Vec3::new(0.5 * f64::from(k) + 7.0 * p[0] / 5.0, p[1], 7.0);
            let light = Rect { center, edge_u: Vec3::new(2.0, 0.25, 0.0), edge_v: Vec3::new(0.0, 1.0, 0.5) };
            let truth = share_above(&exact::point(p), &exact::point(p), &light);
            partly += usize::from(truth > BigRational::zero() && truth < BigRational::one());
            bench.expect(p, outside, &light, &just(truth));
        }
    }
    assert!(partly >= 8, "{partly}");
}

#[test]
fn the_horizon_of_a_plane() {
    let bench = Bench::new(&[FLOOR]);
    // Light that dips below the floor, by shares that are exact.
    for (z, share) in
        [(2.0, ratio(1, 1)), (1.0, ratio(1, 1)), (0.5, ratio(3, 4)), (0.0, ratio(1, 2)), (-0.75, ratio(1, 8))]
    {
        let light =
            Rect { center: Vec3::new(5.0, 1.0, z), edge_u: Vec3::new(0.5, 1.0, 0.0), edge_v: Vec3::new(1.0, 0.0, 1.0) };
        bench.expect(Vec3::new(0.25, 0.5, 0.0), ABOVE, &light, &just(share));
    }
    // Below the horizon: dark, and nothing else.
    for half in [0.5, 50.0] {
        let b = bench.ask(Vec3::default(), ABOVE, &light(0.0, 0.0, -1.0, half), WIDTHS[0], 100);
        assert!(b.lo == 0.0 && b.hi == 0.0, "{b:?}");
    }
    // From below, the other way round.
    let below = Vec3::new(0.0, 0.0, -100.0);
    bench.expect(Vec3::default(), below, &light(0.0, 0.0, -1.0, 3.0), &share(1));
    bench.expect(Vec3::default(), below, &light(0.0, 0.0, 1.0, 3.0), &share(0));
}

#[test]
fn a_sphere_that_rests_on_the_floor() {
    let bench = Bench::new(&[FLOOR, "x^2 + y^2 + (z - 1)^2 = 1"]);
    let light = light(1.0, 0.0, 4.0, 1.0);
    for x in [0.5, 1.0, -0.5, -1.25] {
        let truth = beside_ball([x, 0.25], [0.0, 0.0, 1.0], 1.0, &light);
        bench.expect(Vec3::new(x, 0.25, 0.0), ABOVE, &light, &truth);
    }
    // The point of contact itself: every segment enters the ball at once. Nothing proves that, as f = 0 there; the
    // bracket must say so rather than guess.
    let b = bench.ask(Vec3::default(), ABOVE, &light, WIDTHS[0], 1000);
    assert!(b.lo == 0.0, "{b:?}");
    // From the ball, near its terminator: the floor is below the light, only the horizon counts. The ball of radius 5
    // has points with whole coordinates.
    let bench = Bench::new(&["x^2 + y^2 + (z - 5)^2 = 25", FLOOR]);
    for (p, n, center) in [
        ([4.0, 0.0, 2.0], [4.0, 0.0, -3.0], [16.5, 0.0, 18.0]),
        ([0.0, 5.0, 5.0], [0.0, 1.0, 0.0], [1.0, 6.0, 20.0]),
        ([0.0, 3.0, 9.0], [0.0, 3.0, 4.0], [0.0, -10.0, 18.0]),
    ] {
        let light = Rect::horizontal(Vec3(center), 8.0);
        let truth = share_above(&exact::point(Vec3(p)), &exact::point(Vec3(n)), &light);
        assert!(truth > ratio(1, 10) && truth < ratio(9, 10), "{}", truth.to_f64().unwrap());
        bench.expect(Vec3(p), ABOVE, &light, &just(truth));
    }
}

#[test]
fn a_light_that_cuts_the_surface() {
    // A ball around the light's centre, r = 3, H = 5: what lies inside it is hidden by its lower half, and what lies
    // outside as for any ball on the axis, R = 5 * 3 / 4.
    let bench = Bench::new(&[FLOOR, "x^2 + y^2 + (z - 5)^2 = 9"]);
    let light = light(0.0, 0.0, 5.0, 4.0);
    bench.expect(Vec3::default(), ABOVE, &light, &one_minus_pi_times(&(ratio(225, 16) / ratio(64, 1))));
}

#[test]
fn inside_a_hollow_sphere() {
    let bench = Bench::new(&["x^2 + y^2 + z^2 = 25"]);
    let at = Vec3::new(3.0, 0.0, 4.0);
    let inside = Vec3::default();
    bench.expect(at, inside, &light(0.0, 0.0, -1.0, 2.0), &share(1));
    bench.expect(at, inside, &light(0.0, 0.0, 8.0, 2.0), &share(0));
    // Behind the far wall.
    bench.expect(at, inside, &light(-1.0, 0.0, -8.0, 1.0), &share(0));
    // A light that reaches through the wall: the disc of radius 5 is inside.
    bench.expect(at, inside, &light(0.0, 0.0, 0.0, 5.0), &{
        let (lo, hi) = one_minus_pi_times(&ratio(1, 4));
        (ratio(1, 1) - hi, ratio(1, 1) - lo)
    });
}

#[test]
fn the_comparison_can_fail() {
    let truth = share_beside(&exact::point(Vec3::default()), &box_corners(), &light(0.0, 0.0, 4.0, 1.0));
    let bench = Bench::new(&[FLOOR, BOX]);
    let mut b = bench.ask(Vec3::default(), ABOVE, &light(0.0, 0.0, 4.0, 1.0), WIDTHS[1], 50_000);
    assert!(holds(&b, &just(truth.clone())));
    (b.lo, b.hi) = (b.lo + 2.0 * WIDTHS[1], b.hi + 2.0 * WIDTHS[1]);
    assert!(!holds(&b, &just(truth)));
}
