//! Many questions at once get the answers of one after another, bit for bit, at every operator of the language.
use crate::containment::Operator;
use antumbra::eval::{FanPiece, Gradient, Inclusion, PointJet, RayPiece, ShaftPiece, Workspace};
use antumbra::expr::{Axis, Formula};
use antumbra::geom::{Beam, Box3, Fan, Vec3};
use antumbra::scene::PRESETS;
use antumbra::tape::{Clause, Op, Tape};
use antumbra_interval::Interval;
use antumbra_interval::affine::{Affine, Dual, Form, Jet, SlopeOf};
use antumbra_interval::lanes::Level;
use antumbra_interval::lanes::block::Packed;
use antumbra_interval::quadratic::Quadratic;
use fastrand::Rng;

/// `op(x - 1/8 y, z^2 + x)` and the like: every operator on operands of both signs, with what vectors do before and after it.
fn tape(operator: Operator) -> Tape {
    let axis = |out: u32, axis| Clause { op: Op::Axis(axis), out, a: 0, b: 0 };
    let binary = |op, out, a, b| Clause { op: Op::Binary(op), out, a, b };
    let constants = vec![Interval::new(0.125, 0.126), Interval::point(0.5)];
    let constant = |out: u32, index| Clause { op: Op::Constant(index), out, a: 0, b: 0 };
    use antumbra::expr::{Binary, Unary};
    let op = match operator {
        Operator::Unary(op) => Op::Unary(op),
        Operator::Powi(n) => Op::Powi(n),
        Operator::Binary(op) => Op::Binary(op),
    };
    let clauses = vec![
        axis(0, Axis::X),
        axis(1, Axis::Y),
        axis(2, Axis::Z),
        constant(3, 0),
        binary(Binary::Mul, 3, 3, 1),
        binary(Binary::Sub, 1, 0, 3),
        Clause { op: Op::Unary(Unary::Sqr), out: 2, a: 2, b: 0 },
        binary(Binary::Add, 2, 2, 0),
        Clause { op, out: 3, a: 1, b: 2 },
        Clause { op: Op::Unary(Unary::Neg), out: 3, a: 3, b: 0 },
        constant(4, 1),
        binary(Binary::Mul, 3, 3, 4),
    ];
    Tape::from_clauses(clauses, constants).expect("a valid tape")
}

fn interval(r: &mut Rng) -> Interval {
    let a = [0.0, 2.0 * r.f64() - 1.0, 1e-3 * r.f64(), 40.0 * r.f64() - 20.0, 1e200 * r.f64()]
        [r.usize(0..5).min(r.usize(0..5))];
    let width = [0.0, 1e-12, 1e-3, 1.0][r.usize(0..4)] * r.f64();
    Interval::new(a, a + width)
}

fn bits(x: Interval) -> [u64; 2] {
    [x.lo().to_bits(), x.hi().to_bits()]
}

fn form_bits<const N: usize>(x: &Affine<N>) -> Vec<u64> {
    let parts = [x.centre(), x.error()].into_iter().chain(x.coefficients().iter().copied());
    parts.map(f64::to_bits).collect()
}

fn gradient_bits(g: &Gradient) -> Vec<[u64; 2]> {
    std::iter::once(g.value).chain(g.partials).map(bits).collect()
}

/// A NaN is a NaN: only plain jets know one.
fn packed_bits<F: Packed>(x: &F) -> Vec<u64> {
    let bits = |x: f64| if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() };
    (0..F::COMPONENTS).map(|i| bits(x.component(i))).collect()
}

/// What the second-order search asks.
fn forms_agree(
    count: usize,
    name: &str,
    tape: &dyn Inclusion,
    r: &mut Rng,
    work: &mut Workspace,
    fresh: &mut Workspace,
) {
    let scale = [1e-3, 0.1, 1.0][r.usize(0..3)];
    let mut line = |kind: usize| {
        let error = [0.0, 1e-9][kind % 2];
        let mut some = || scale * (2.0 * r.f64() - 1.0);
        let linear = Affine::linear(3.0 * some(), [some(), 0.3 * some(), some()], error);
        let q = [some(), some(), 0.0, some(), 0.0, some()];
        let curved = Quadratic::polynomial(linear.centre(), *linear.coefficients(), q, error);
        let direction = Affine::linear(some(), [0.0, some(), some()], error);
        let apex = if kind.is_multiple_of(3) { interval(r) } else { Interval::point(r.f64() - 0.5) };
        (linear, curved, direction, apex)
    };
    let lines: Vec<_> = (0..count).map(|k| [line(k), line(k + 1), line(k)]).collect();
    macro_rules! compare {
        ($many:ident, $one:ident, $unknown:expr, $of:expr) => {
            let points: Vec<_> = lines.iter().map(|line| line.map($of)).collect();
            let mut out = vec![$unknown; count];
            tape.$many(&points, &mut out, work);
            for (point, found) in points.iter().zip(&out) {
                let wanted = tape.$one(*point, fresh);
                assert_eq!(packed_bits(found), packed_bits(&wanted), "{name}: {found:?}, {wanted:?} at {point:?}");
            }
        };
    }
    let jet = |value, first| Jet { value, first, second: Affine::ZERO };
    compare!(quadratics, quadratic, Quadratic::ZERO, |(_, curved, _, _)| curved);
    compare!(quadratic_slopes, quadratic_slope, Quadratic::ZERO, |(_, value, direction, apex)| {
        SlopeOf { apex, value, slope: Quadratic::from(direction) }
    });
    compare!(jets, jet, Jet::<Affine<3>>::UNKNOWN, |(value, _, direction, _)| jet(value, direction));
    compare!(jet_slopes, jet_slope, Jet::<Affine<3>>::UNKNOWN, |(value, _, direction, apex)| {
        SlopeOf { apex, value: jet(value, direction), slope: jet(direction, Affine::ZERO) }
    });
    compare!(abouts, about, PointJet::default(), |(value, _, direction, _)| {
        PointJet { value: value.centre(), first: direction.centre(), second: 0.0 }
    });
}

/// What shafts ask.
fn shafts_agree(
    count: usize,
    name: &str,
    tape: &dyn Inclusion,
    r: &mut Rng,
    work: &mut Workspace,
    fresh: &mut Workspace,
) {
    let pieces: Vec<ShaftPiece> = (0..count)
        .map(|_| {
            let scale = [1e-3, 0.1, 1.0][r.usize(0..3)];
            let mut some = || 2.0 * r.f64() - 1.0;
            let apex = [(); 3].map(|()| Affine::linear(some(), [0.0, 0.0, 0.0, scale * some(), scale * some()], 1e-9));
            let direction = [(); 3].map(|()| Affine::linear(some(), [(); 5].map(|()| scale * some()), 0.0));
            ShaftPiece { apex, direction, t: interval(r) }
        })
        .collect();
    let (mut values, mut slopes) = (vec![Affine::ZERO; count], vec![Affine::ZERO; count]);
    tape.shafts(&pieces, &mut values, work);
    tape.shaft_slopes(&pieces, &mut slopes, work);
    for (k, piece) in pieces.iter().enumerate() {
        assert_eq!(form_bits(&values[k]), form_bits(&tape.shaft(piece.point(), fresh)), "{name} {piece:?}");
        assert_eq!(form_bits(&slopes[k]), form_bits(&tape.shaft_slope(piece.slopes(), fresh)), "{name} {piece:?}");
    }
}

fn agree(name: &str, tape: &dyn Inclusion, r: &mut Rng) {
    Level::all().for_each(|level| agree_on(level, name, tape, r));
}

fn agree_on(level: Level, name: &str, tape: &dyn Inclusion, r: &mut Rng) {
    let (mut work, mut fresh) = (Workspace::on(level), Workspace::default());
    for count in [1, 2, 3, 7, 8, 9, 63, 64, 65, 130] {
        forms_agree(count, name, tape, r, &mut work, &mut fresh);
        shafts_agree(count, name, tape, r, &mut work, &mut fresh);
        let eye = Vec3::new(3.0 * r.f64(), [0.0, r.f64()][r.usize(0..2)], 1.0);
        let rays: Vec<RayPiece> = (0..count)
            .map(|_| {
                let origin = if count == 9 { Vec3::new(r.f64(), 0.0, 2.0) } else { eye };
                let ray = Beam { origin, direction: Box3(std::array::from_fn(|_| interval(r))) };
                RayPiece { ray, t: interval(r) }
            })
            .collect();
        let mut ranges = vec![Interval::ZERO; count];
        tape.ranges(&rays, &mut ranges, &mut work);
        let mut duals = vec![Dual { value: Affine::ZERO, derivative: Affine::ZERO }; count];
        tape.rays(&rays, &mut duals, &mut work);
        let pieces: Vec<FanPiece> = rays
            .iter()
            .map(|piece| {
                let direction = std::array::from_fn(|_| Affine::linear(r.f64(), [0.0, r.f64(), 0.1 * r.f64()], 1e-9));
                FanPiece { fan: Fan { apex: piece.ray.origin.to_box(), direction }, t: piece.t }
            })
            .collect();
        let mut forms = vec![Affine::ZERO; count];
        tape.beams(&pieces, &mut forms, &mut work);
        let regions: Vec<Box3> = (0..count).map(|_| Box3(std::array::from_fn(|_| interval(r)))).collect();
        let mut gradients = vec![Gradient { value: Interval::ZERO, partials: [Interval::ZERO; 3] }; count];
        tape.gradients(&regions, &mut gradients, &mut work);
        for k in 0..count {
            assert_eq!(bits(ranges[k]), bits(tape.range(&rays[k].region(), &mut fresh)), "{name} {:?}", rays[k]);
            let dual = tape.ray(rays[k].point(), &mut fresh);
            assert_eq!(form_bits(&duals[k].value), form_bits(&dual.value), "{name} {:?}", rays[k]);
            assert_eq!(form_bits(&duals[k].derivative), form_bits(&dual.derivative), "{name} {:?}", rays[k]);
            let form = tape.beam(pieces[k].fan.at(pieces[k].t), &mut fresh);
            assert_eq!(form_bits(&forms[k]), form_bits(&form), "{name} {:?}", pieces[k]);
            let gradient = tape.gradient(&regions[k], &mut fresh);
            assert_eq!(gradient_bits(&gradients[k]), gradient_bits(&gradient), "{name} {:?}", regions[k]);
        }
    }
}

#[test]
fn every_operator() {
    let mut r = Rng::with_seed(3);
    for operator in Operator::all() {
        (0..4).for_each(|_| agree(&operator.name(), &tape(operator), &mut r));
    }
}

/// Questions of one batch are answered by different tapes.
#[test]
fn a_formula_that_is_shortened_region_by_region() {
    let mut r = Rng::with_seed(6);
    let pillar = |k: usize| {
        let (x, y) = (0.3 * (k % 4) as f64 - 0.5, 0.4 * (k / 4) as f64 - 0.5);
        format!("max(max(abs(x - ({x})), abs(y - ({y}))) - 0.05, abs(z) - 0.{}) + x^2/50", k + 2)
    };
    let all = (0..12).map(pillar).reduce(|a, b| format!("min({a}, {b})")).expect("pillars");
    let tape = Tape::compile(&Formula::parse(&all).expect("a formula")).expect("a formula");
    let regions = tape.in_regions(&Box3::cube(1.0)).expect("it is long enough");
    agree("pillars", &*regions, &mut r);
}

#[test]
fn every_preset() {
    let mut r = Rng::with_seed(4);
    for preset in PRESETS {
        let formula = Formula::parse(preset.formula).expect("a preset");
        let tape = Tape::compile(formula.surface().formula()).expect("a preset");
        agree(preset.name, &tape, &mut r);
    }
}
