//! What forms say besides a range: planes over symbols, slopes from an apex, derivatives along a ray.
use crate::containment::Operator;
use crate::input::Input;
use crate::truth::Truth;
use antumbra::eval::run;
use antumbra::tape::Tape;
use antumbra_interval::affine::{Affine, Apex, Dual, Slope};
use antumbra_interval::{Decorated, Interval};

/// Planes admit the values at every symbol value, `f(P + t D) = f(P) + t g` holds for the slopes, and derivatives along a
/// ray explain the differences of values.
pub fn forms(bytes: &[u8]) {
    let mut input = Input::new(bytes);
    let operators = Operator::all();
    let constants = std::array::from_fn(|_| Interval::point(input.coarse() / 8.0));
    let tape = input.tape(&operators, 12, constants);
    loop {
        planes::<1>(&tape, &mut input);
        planes::<3>(&tape, &mut input);
        planes::<5>(&tape, &mut input);
        slopes::<Interval, 3>(&tape, &mut input);
        slopes::<Affine<5>, 5>(&tape, &mut input);
        rays(&tape, &mut input);
        if input.is_spent() {
            return;
        }
    }
}

/// A form and a member of it at `s`: every number is a multiple of 2^-23 below 256, so the sums are exact.
fn form<const N: usize>(input: &mut Input<'_>, s: &[f64; N]) -> (Affine<N>, f64) {
    let c = input.coarse() / 8.0;
    let scale = input.pick(&[0.0, 1.0, 0.125, 1.0 / 1024.0]);
    let a: [f64; N] = std::array::from_fn(|_| input.coarse() / 32.0 * scale);
    let e = if input.below(2) == 0 { 0.0 } else { input.coarse().abs() / 32.0 * scale };
    let value = (0..N).fold(c + e * input.symbol(), |sum, i| sum + a[i] * s[i]);
    (Affine::linear(c, a, e), value)
}

/// The values that a form admits at `s`.
fn admitted<const N: usize>(x: &Affine<N>, s: &[f64; N]) -> Interval {
    if !x.is_known() {
        return Interval::ENTIRE;
    }
    let e = x.error();
    let start = Interval::point(x.centre()) + Interval::new(-e, e);
    (0..N).fold(start, |sum, i| sum + Interval::point(x.coefficients()[i]) * Interval::point(s[i]))
}

fn planes<const N: usize>(tape: &Tape, input: &mut Input<'_>) {
    let s: [f64; N] = std::array::from_fn(|_| input.symbol());
    let operands: [(Affine<N>, f64); 3] = std::array::from_fn(|_| form(input, &s));
    let y = run(tape, operands.map(|(x, _)| x), &mut vec![]);
    let p = operands.map(|(_, p)| p);
    let truth = Truth::at(tape, p);
    let values = admitted(&y, &s);
    assert!(truth.possibly_in(values), "{y:?} at {s:?} does not admit {truth:?}, the value at {p:?}: {tape:?}");
}

fn slopes<P: Apex<Affine<N>> + std::fmt::Debug, const N: usize>(tape: &Tape, input: &mut Input<'_>) {
    let s: [f64; N] = std::array::from_fn(|_| input.symbol());
    let t = Affine::linear(0.5, std::array::from_fn(|i| if i == 0 { 0.5 } else { 0.0 }), 0.0);
    let tau = 0.5 * s[0] + 0.5;
    let paths: [(Slope<P, N>, f64, f64); 3] = std::array::from_fn(|_| {
        let p = input.coarse() / 8.0;
        let (d, direction) = form(input, &s);
        (Slope::coordinate(P::constant(Interval::point(p)), t, d), p, p + tau * direction)
    });
    let y = run(tape, paths.map(|(x, ..)| x), &mut vec![]);
    let (start, end) = (paths.map(|(_, p, _)| p), paths.map(|(.., q)| q));
    let (from, to) = (Truth::at(tape, start), Truth::at(tape, end));
    assert!(from.possibly_in(y.apex.range()), "apex of {y:?} is {from:?} at {start:?}: {tape:?}");
    assert!(to.possibly_in(admitted(&y.value, &s)), "value of {y:?} at {s:?} is {to:?} at {end:?}: {tape:?}");
    if let (Some(from), Some(to)) = (from.enclosure(), to.enclosure()) {
        let rise = admitted(&y.slope, &s) * Interval::point(tau);
        assert!(
            (to - from).possibly_intersects(rise),
            "{y:?} at {s:?}, t = {tau} contradicts {from} at {start:?} and {to} at {end:?}: {tape:?}"
        );
    }
}

fn rays(tape: &Tape, input: &mut Input<'_>) {
    let point: [(Dual<1>, f64, f64); 3] = std::array::from_fn(|_| {
        let (c, a) = (input.coarse() / 8.0, input.coarse() / 32.0);
        let value = Affine::linear(c, [a], 0.0);
        (Dual { value, derivative: Affine::constant(Interval::point(a)) }, c, a)
    });
    let y = run(tape, point.map(|(x, ..)| x), &mut vec![]);
    let place = |s: f64| point.map(|(_, c, a)| c + a * s);
    let ends: [f64; 2] = [input.symbol(), input.symbol()];
    let truths = ends.map(|s| Truth::at(tape, place(s)));
    for (s, truth) in ends.iter().zip(&truths) {
        let values = admitted(&y.value, &[*s]);
        assert!(truth.possibly_in(values), "value of {y:?} at {s} is {truth:?}: {tape:?}");
    }
    let all = point.map(|(_, c, a)| Interval::new(c - a.abs(), c + a.abs()));
    if !run(tape, all.map(Decorated::from), &mut vec![]).certainly_continuous() {
        return;
    }
    if let (Some(f), Some(g)) = (truths[0].enclosure(), truths[1].enclosure()) {
        let rise = y.derivative.range() * (Interval::point(ends[1]) - Interval::point(ends[0]));
        assert!((g - f).possibly_intersects(rise), "{y:?} contradicts {f} and {g} at {ends:?}: {tape:?}");
    }
}
