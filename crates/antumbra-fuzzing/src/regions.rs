//! Shorter tapes for parts of space against the tape that they stand for.
use crate::containment::Operator;
use crate::input::Input;
use crate::truth::Truth;
use antumbra::eval::{Inclusion, Regions, Workspace};
use antumbra::expr::{Binary, Unary};
use antumbra::geom::Box3;
use antumbra_interval::Interval;

/// What a smaller region decides.
const CHOICES: [Operator; 6] = [
    Operator::Binary(Binary::Max),
    Operator::Binary(Binary::Min),
    Operator::Unary(Unary::Abs),
    Operator::Binary(Binary::Add),
    Operator::Binary(Binary::Mul),
    Operator::Unary(Unary::Sign),
];

/// Over boxes of any size in and around the bounds, the tape of a region contains the values of the whole one, and claims to be
/// defined only where that is.
pub fn regions(bytes: &[u8]) {
    let mut input = Input::new(bytes);
    let mut operators = Operator::all();
    // Mostly choices, between parts of every kind.
    (0..8).for_each(|_| operators.extend(CHOICES));
    let constants = std::array::from_fn(|_| Interval::point(input.coarse() / 8.0));
    let tape = input.tape(&operators, 90, constants);
    let bounds = Box3([Interval::new(-2.0, 2.0); 3]);
    let (divided, mut work) = (Regions::new(tape.clone(), &bounds), Workspace::default());
    loop {
        let x: [Interval; 3] = std::array::from_fn(|_| input.ordinary());
        let (range, decorated) = (divided.range(&Box3(x), &mut work), divided.decorated(&Box3(x), &mut work));
        for _ in 0..3 {
            let p = x.map(|x| input.member(x));
            let truth = Truth::at(&tape, p);
            for enclosure in [range, decorated.interval] {
                assert!(truth.possibly_in(enclosure), "{enclosure} over {x:?}, {truth:?} at {p:?}: {tape:?}");
            }
            assert!(
                !(decorated.certainly_defined() && matches!(truth, Truth::Undefined)),
                "claimed to be defined over {x:?}, not at {p:?}: {tape:?}"
            );
        }
        if input.is_spent() {
            return;
        }
    }
}
