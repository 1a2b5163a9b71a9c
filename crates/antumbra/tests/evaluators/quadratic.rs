//! Quadratic forms, their slopes, and jets: pointwise truth at symbol values, orders of convergence, elimination.
use super::forms::{FORMULAS, coarse, compile, symbol};
use crate::containment::{Operator, around, power_of_two};
use antumbra::eval::{Inclusion, PointJet, Workspace, run};
use antumbra::expr::{Axis, Unary};
use antumbra::scene::PRESETS;
use antumbra::tape::Tape;
use antumbra_interval::Interval;
use antumbra_interval::affine::{Affine, Jet, SlopeOf};
use antumbra_interval::quadratic::{Eliminated, Paraboloid, Quadratic};
use fastrand::Rng;

/// The values that a form admits at `(s, a, b)`.
fn at(x: &Quadratic, [s, a, b]: [f64; 3]) -> Interval {
    if !x.is_known() {
        return Interval::ENTIRE;
    }
    let point = Interval::point;
    let e = x.error();
    let terms = [s, a, b, s * s, a * a, b * b, s * a, s * b, a * b];
    let coefficients = x.linear().iter().chain(x.quadratic());
    coefficients.zip(terms).fold(point(x.centre()) + Interval::new(-e, e), |sum, (k, t)| sum + point(*k) * point(t))
}

/// A form with coefficients that are multiples of 2^-20, and a member of it at `x`: exact for symbols that are multiples
/// of 1/8.
fn form(r: &mut Rng, x: [f64; 3]) -> (Quadratic, f64) {
    let c = coarse(r) * [0.0, 1.0, 4.0, 16.0][r.usize(0..4)];
    let scale = [0.0, 1.0, 2.0, 1.0 / 1024.0][r.usize(0..4)];
    let bend = scale * [0.0, 0.25, 1.0][r.usize(0..3)];
    let l: [f64; 3] = std::array::from_fn(|_| coarse(r) * scale);
    let q: [f64; 6] = std::array::from_fn(|_| coarse(r) * bend);
    let e = if r.bool() { 0.0 } else { coarse(r).abs() * scale };
    let [s, a, b] = x;
    let terms = [s, a, b, s * s, a * a, b * b, s * a, s * b, a * b];
    let value = l.iter().chain(&q).zip(terms).fold(c + e * symbol(r), |sum, (k, t)| sum + k * t);
    (Quadratic::polynomial(c, l, q, e), value)
}

#[test]
fn forms_hold_at_every_symbol_value() {
    let mut r = Rng::with_seed(81);
    for operator in Operator::all() {
        let mut known = 0;
        for _ in 0..1500 {
            let x: [f64; 3] = std::array::from_fn(|_| symbol(&mut r));
            let ((a, p), (b, q)) = (form(&mut r, x), form(&mut r, x));
            let y = operator.apply(a, b);
            let Some(truth) = operator.truth(p, q) else { continue };
            let admitted = at(&y, x);
            assert!(
                truth.possibly_in(admitted.lo(), admitted.hi()),
                "{} of {a:?}, {b:?} at {x:?}: {y:?} does not admit {truth:?}",
                operator.name()
            );
            let (range, affine) = (y.range(), y.to_affine());
            assert!(truth.possibly_in(range.lo(), range.hi()), "{}: range {range:?}", operator.name());
            let plane = at(&affine.into(), x);
            assert!(truth.possibly_in(plane.lo(), plane.hi()), "{}: {affine:?} of {y:?}", operator.name());
            known += u32::from(y.is_known());
        }
        assert!(known > 50, "{}: {known} known forms", operator.name());
    }
}

/// `f(P + t D) = f(P) + t g`, t in [0, 1] from symbol 0.
#[test]
fn slopes_hold_at_every_symbol_value() {
    let mut r = Rng::with_seed(82);
    for operator in Operator::all() {
        let mut known = 0;
        for _ in 0..1500 {
            let x: [f64; 3] = std::array::from_fn(|_| symbol(&mut r));
            let tau = 0.5 * x[0] + 0.5;
            let t = Quadratic::polynomial(0.5, [0.5, 0.0, 0.0], [0.0; 6], 0.0);
            let mut operand = || {
                let p = coarse(&mut r) * [1.0, 4.0, 16.0][r.usize(0..3)];
                let (d, direction) = form(&mut r, x);
                (SlopeOf::<Interval, Quadratic>::coordinate(Interval::point(p), t, d), p, direction)
            };
            let ((a, pa, da), (b, pb, db)) = (operand(), operand());
            let y = operator.apply(a, b);
            let values = (operator.truth(pa, pb), operator.truth(pa + tau * da, pb + tau * db));
            let (Some(from), Some(to)) = values else { continue };
            let rise = around(to) - around(from);
            let admitted = at(&y.slope, x) * Interval::point(tau);
            assert!(
                rise.possibly_intersects(admitted),
                "{} of {a:?}, {b:?} at {x:?}: {y:?}, but the values are {from:?} and {to:?}",
                operator.name()
            );
            known += u32::from(y.slope.is_known());
        }
        let huge = matches!(operator, Operator::Powi(n) if n.unsigned_abs() > 100);
        assert!(known > 50 || huge, "{}: {known} known slopes", operator.name());
    }
}

/// Products keep exactly what degree 2 can hold.
#[test]
fn polynomials_of_degree_two_are_exact() {
    let [s, a, b] = [0, 1, 2].map(|k| Quadratic::from(Affine::symbol(k)));
    let y = (s + a) * (b - s) + a.sqr() - (a + b).sqr();
    assert!(y.error() < 1e-13, "{y:?}");
    assert_eq!(y.quadratic(), &[-1.0, 0.0, -1.0, -1.0, 1.0, -1.0], "{y:?}");
    assert!(Quadratic::product_of(&Affine::symbol(0), &Affine::symbol(1)).quadratic()[3] == 1.0);
    // s^3 = 3/4 s +- 1/4.
    let cube = s * s * s;
    assert!((cube.error() - 0.25).abs() < 1e-13 && cube.linear()[0] == 0.75, "{cube:?}");
}

/// Half the box, an eighth of the error.
#[test]
fn forms_converge_with_order_three() {
    let surfaces = PRESETS[..4].iter().map(|preset| preset.formula.split('=').next().unwrap());
    let others = [
        "sin(x) cos(y) + exp(z x)",
        "ln(2 + x y) / (3 + z)",
        "sqrt(x + y) - atan2(z, x + 1)",
        "tan(x/2) + cosh(y z)",
        "cbrt(x + 1) (y + 2)^1.5 - tanh(z) + asin(x/2) acos(y/2) sinh(z)",
    ];
    for text in surfaces.chain(others) {
        let (_, tape) = compile(text);
        let error = |p: [f64; 3], k: i32| {
            let h = power_of_two(-k - 1);
            let x: [Affine<3>; 3] = std::array::from_fn(|i| Affine::spanning(i, Interval::new(p[i] - h, p[i] + h)));
            run(&tape, x.map(Quadratic::from), &mut vec![]).error()
        };
        for p in [[0.3, 0.4, 0.6], [0.7, 0.2, 0.9]] {
            for k in 4..8 {
                let order = core_math::log2(error(p, k) / error(p, k + 1));
                assert!((2.7..3.4).contains(&order), "{text} at {p:?}: order {order} at 2^-{k}");
            }
        }
    }
}

#[test]
fn smooth_operators_converge_with_order_three() {
    for operator in Operator::all() {
        let smooth = match operator {
            Operator::Unary(op) => !matches!(op, Unary::Neg | Unary::Abs | Unary::Sign | Unary::Floor | Unary::Sqr),
            Operator::Powi(n) => !matches!(n, 0..=2) && n.unsigned_abs() < 16,
            Operator::Binary(op) => ["Div", "Pow"].contains(&format!("{op:?}").as_str()),
        };
        if !smooth {
            continue;
        }
        let error = |k: i32| {
            let x: [Affine<3>; 2] =
                [(0, 0.4), (1, 0.55)].map(|(i, a)| Affine::spanning(i, Interval::new(a, a + power_of_two(-k))));
            let [a, b] = x.map(Quadratic::from);
            operator.apply(a, b).error()
        };
        for k in 7..11 {
            let order = core_math::log2(error(k) / error(k + 1));
            assert!((2.5..3.5).contains(&order), "{}: order {order} at 2^-{k}", operator.name());
        }
    }
}

/// Second derivatives along rays: enclosed by jets over boxes and met by rounded jets; those of slopes agree with
/// `t^3 g'' = t^2 f'' - 2 t f' + 2 (f - f(P))`.
/// The range of the second derivative where both are known; the first one must be the given one.
fn known_bend(jet: &Jet<Affine<3>>, slope: Interval) -> Interval {
    assert!(jet.first.range().possibly_intersects(slope), "{jet:?}, {slope:?}");
    if jet.first.is_known() { jet.second.range() } else { Interval::ENTIRE }
}

#[test]
fn jets_agree_with_symbolic_derivatives() {
    let mut r = Rng::with_seed(83);
    let mut known = [0; 2];
    for text in FORMULAS {
        let (formula, tape) = compile(text);
        let axes = [Axis::X, Axis::Y, Axis::Z];
        let first = axes.map(|axis| formula.derivative(axis).formula().clone());
        let second: Vec<Vec<Tape>> = first
            .iter()
            .map(|f| axes.iter().map(|axis| Tape::compile(f.derivative(*axis).formula()).unwrap()).collect())
            .collect();
        let first = first.map(|f| Tape::compile(&f).unwrap());
        for _ in 0..150 {
            let p: [f64; 3] = std::array::from_fn(|_| coarse(&mut r));
            let d: [f64; 3] = std::array::from_fn(|_| coarse(&mut r));
            let (t, w) = (0.25 + 0.5 * r.f64(), [0.0, 1e-3, 0.05][r.usize(0..3)]);
            let range = Interval::new(t - w * r.f64(), t + w * r.f64());
            let point = Interval::point;
            let there: [Interval; 3] = std::array::from_fn(|k| point(p[k]) + point(t) * point(d[k]));
            let value = |tape: &Tape, x: [Interval; 3]| run(tape, x, &mut vec![]);
            let slope = (0..3).fold(Interval::ZERO, |s, k| s + value(&first[k], there) * point(d[k]));
            let bend = (0..9).fold(Interval::ZERO, |s, k| {
                s + value(&second[k / 3][k % 3], there) * point(d[k / 3]) * point(d[k % 3])
            });
            let span = Affine::<3>::spanning(0, range);
            let line: [Jet<Affine<3>>; 3] = std::array::from_fn(|k| {
                let dk = Affine::constant(point(d[k]));
                Jet::line((span * dk).add_interval(point(p[k])), dk)
            });
            let half = point(0.5);
            let mut work = Workspace::default();
            let got = known_bend(&tape.jet(line, &mut work), slope);
            assert!(got.possibly_intersects(bend * half), "{text} at {p:?} along {d:?}, {t}: {got:?}, {bend:?}");
            let about = tape.about(
                std::array::from_fn(|k| PointJet { value: there[k].mid(), first: d[k], second: 0.0 }),
                &mut work,
            );
            if bend.is_bounded() && bend.magnitude() < 1e6 {
                known[0] += usize::from(got.is_bounded());
                assert!(
                    (about.second - 0.5 * bend.mid()).abs() < 1e-6 * (1.0 + bend.magnitude()),
                    "{text}: {about:?}, {bend:?}"
                );
                assert!((about.first - slope.mid()).abs() < 1e-8 * (1.0 + slope.magnitude()), "{text}: {about:?}");
            }
            let slopes = std::array::from_fn(|k| SlopeOf {
                apex: point(p[k]),
                value: line[k],
                slope: Jet::line(line[k].first, Affine::ZERO),
            });
            let got = known_bend(&tape.jet_slope(slopes, &mut work), Interval::ENTIRE);
            let (f, f0, t) = (value(&tape, there), value(&tape, p.map(point)), point(t));
            let truth = (t.sqr() * bend - point(2.0) * t * slope + point(2.0) * (f - f0)) / (t.sqr() * t);
            assert!(got.possibly_intersects(truth * half), "{text} at {p:?} along {d:?}, {t}: {got:?}, {truth:?}");
            known[1] += usize::from(got.is_bounded());
        }
    }
    assert!(known[0] > 700 && known[1] > 700, "{known:?}");
}

fn paraboloid(p: &Paraboloid, a: f64, b: f64) -> Interval {
    let point = Interval::point;
    let terms = [(p.l[0], a), (p.l[1], b), (p.q[0], a * a), (p.q[1], b * b), (p.q[2], a * b)];
    terms.iter().fold(point(p.c), |sum, (k, t)| sum + point(*k) * point(*t))
}

/// `lower - error <= min over s`, and some s with a value `<= upper + error`; exact where the minimiser stays inside.
#[test]
fn elimination_bounds_the_least_value() {
    let mut r = Rng::with_seed(84);
    let mut cases = [0; 2];
    for round in 0..20_000 {
        let (mut x, _) = form(&mut r, [0.0; 3]);
        if round % 3 == 0 {
            // A parabola well inside.
            let mut q = *x.quadratic();
            q[0] = 1.0 + 4.0 * r.f64() + q[0].abs();
            x = Quadratic::polynomial(x.centre(), x.linear().map(|v| 0.5 * v), q, x.error());
        }
        let least = x.eliminate();
        let (low, high) = (least.lower.lower_bound(), least.upper.upper_bound());
        let exact = least.lower == least.upper;
        cases[usize::from(exact)] += 1;
        for _ in 0..8 {
            let (a, b) = (symbol(&mut r), symbol(&mut r));
            let error = Interval::new(-least.error, least.error);
            let (lower, upper) = (paraboloid(&least.lower, a, b), paraboloid(&least.upper, a, b));
            assert!(low <= lower.hi() && upper.lo() <= high);
            let mut best = f64::INFINITY;
            for k in 0..=64 {
                let value = at(&x, [f64::from(k) / 32.0 - 1.0, a, b]);
                assert!((lower + error).lo() <= value.hi(), "{x:?}: {least:?} at {a} {b}, {k}");
                best = best.min(value.lo());
            }
            // Between two of these s a parabola falls by at most q/64^2.
            let gap = x.quadratic()[0].abs() / 4096.0;
            assert!(best - gap <= (upper + error).hi() + 1e-12, "{x:?}: {least:?} at {a} {b}");
            if exact {
                assert!((best - x.error() - lower.mid()).abs() <= gap + 3.0 * x.error() + 1e-9, "{x:?}: {least:?}");
            }
        }
        // Both bounds of a lowered one: the lower by all of it, the upper not at all.
        let by = [0.0, 1e-9, 0.3][round % 3];
        let lowered = least.lowered(by);
        let (a, b) = (symbol(&mut r), symbol(&mut r));
        let bounds = |e: &Eliminated| {
            let error = Interval::point(e.error);
            (paraboloid(&e.lower, a, b) - error, paraboloid(&e.upper, a, b) + error)
        };
        let ((before, above), (after, still)) = (bounds(&least), bounds(&lowered));
        assert!(after.lo() <= (before - Interval::point(by)).hi() && above.lo() <= still.hi(), "{least:?} by {by}");
        let slack = 1e-13 * (1.0 + least.lower.size() + least.upper.size() + least.error);
        assert!(before.lo() - by - after.hi() <= slack && still.lo() - above.hi() <= slack, "{least:?} by {by}");
    }
    assert!(cases[0] > 2000 && cases[1] > 5000, "{cases:?}");
    assert_eq!(Quadratic::UNKNOWN.eliminate().error, f64::INFINITY);
}

#[test]
fn differences_with_paraboloids_are_enclosed() {
    let mut r = Rng::with_seed(85);
    for _ in 0..5000 {
        let x: [f64; 3] = std::array::from_fn(|_| symbol(&mut r));
        let (f, value) = form(&mut r, x);
        let p = Paraboloid {
            c: coarse(&mut r),
            l: [coarse(&mut r), coarse(&mut r)],
            q: [coarse(&mut r), coarse(&mut r), coarse(&mut r)],
        };
        let (k, e) = ([1.0, 0.3, 7.0][r.usize(0..3)], coarse(&mut r).abs());
        let member = paraboloid(&p, x[1], x[2]) + Interval::point(e * symbol(&mut r));
        let truth = Interval::point(value) - Interval::point(k) * member;
        assert!(at(&f.minus(k, &p, e), x).possibly_intersects(truth));
    }
}
