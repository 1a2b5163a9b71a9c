//! Defined and continuous are claimed only where they are true, and where it is plain they are claimed.
use crate::containment::{Operator, interval, member};
use antumbra::eval::run;
use antumbra::expr::Formula;
use antumbra::tape::Tape;
use antumbra_interval::{Decorated, Decoration, Interval};
use fastrand::Rng;

#[test]
fn operators_are_continuous_exactly_where_they_are() {
    let mut r = Rng::with_seed(31);
    for operator in Operator::all() {
        let (mut claimed, mut refused) = (0, 0);
        for _ in 0..2000 {
            let x = [interval(&mut r), interval(&mut r)];
            let y = operator.apply(Decorated::from(x[0]), Decorated::from(x[1]));
            let Some(breaks) = operator.breaks(x[0].bounds(), x[1].bounds()) else { continue };
            let what = || format!("{} over {x:?}: {y:?}", operator.name());
            // No claim is false, none that holds is missed.
            assert_eq!(y.certainly_continuous(), !breaks, "{}", what());
            (claimed, refused) = (claimed + u32::from(!breaks), refused + u32::from(breaks));
            if y.certainly_defined() {
                let p = x.map(|x| member(&mut r, x));
                assert!(operator.truth(p[0], p[1]).is_some(), "undefined at {p:?}: {}", what());
            }
        }
        assert!(claimed > 10, "{}: continuous in {claimed} boxes", operator.name());
        let can_break = operator.breaks([-1.25, 1.25], [-1.25, 1.25]) == Some(true);
        assert_eq!(refused > 0, can_break || operator.name() == "tan", "{}: {refused}", operator.name());
    }
}

trait Bounds {
    fn bounds(self) -> [f64; 2];
}

impl Bounds for Interval {
    fn bounds(self) -> [f64; 2] {
        [self.lo(), self.hi()]
    }
}

fn decorated(text: &str, x: [f64; 2]) -> Decorated {
    let tape = Tape::compile(&Formula::parse(text).unwrap_or_else(|e| panic!("{}", e.render(text)))).unwrap();
    run(&tape, [Decorated::from(Interval::new(x[0], x[1])); 3], &mut vec![])
}

#[test]
fn formulas_carry_the_weakest_claim_of_their_parts() {
    use Decoration::{Continuous, Defined, Trivial};
    for (text, x, wanted) in [
        ("1/x", [-1.0, 1.0], Trivial),
        ("1/x", [0.5, 1.0], Continuous),
        ("x/x", [-1.0, 1.0], Trivial),
        ("tan(x)", [1.0, 2.0], Trivial),
        ("tan(x)", [2.0, 4.0], Continuous),
        ("floor(x)", [0.5, 1.5], Defined),
        ("floor(x)", [0.25, 0.75], Continuous),
        ("sign(x) + x", [-1.0, 1.0], Defined),
        ("1/(2 + sign(x))", [-1.0, 1.0], Defined),
        ("sqrt(x - 1)", [0.5, 3.0], Trivial),
        ("sqrt(x - 1) - sqrt(x - 1)", [0.5, 3.0], Trivial),
        ("0 ln(x)", [-1.0, 1.0], Trivial),
        ("max(1/x, 5)", [-1.0, 1.0], Trivial),
        ("atan(1/x)", [-1.0, 1.0], Trivial),
        ("asin(2x)", [0.0, 0.25], Continuous),
        ("acos(2x)", [0.0, 0.75], Trivial),
        ("x^0.5 + cbrt(y)", [0.0, 1.0], Continuous),
        ("x^-3", [-1.0, 1.0], Trivial),
        ("atan2(y - 2, x)", [-1.0, 1.0], Continuous),
        ("atan2(y, x - 2)", [-1.0, 1.0], Defined),
        ("exp(sin(x)) cosh(y) - tanh(z)", [-9.0, 9.0], Continuous),
    ] {
        assert_eq!(decorated(text, x).decoration, wanted, "{text} over {x:?}");
    }
}

/// A tape that is proved continuous everywhere never has a weaker decoration on any box, as nobody asks for it then.
#[test]
fn continuity_proved_beforehand_is_confirmed_on_boxes() {
    let mut r = Rng::with_seed(32);
    let texts = ["x^4 + y^4 - 1", "sphere(1)", "torus(1, 0.2)", "sin(x)/(2 + cos(y)^2)", "ln(1 + x^2)", "exp(x)^-1"];
    for text in texts {
        let tape = Tape::compile(&Formula::parse(text).unwrap()).unwrap();
        assert!(tape.is_continuous_everywhere(), "{text}");
        for _ in 0..500 {
            let x: [Interval; 3] = std::array::from_fn(|_| {
                let a = r.f64() * 40.0 - 20.0;
                Interval::new(a, a + r.f64())
            });
            let y = run(&tape, x.map(Decorated::from), &mut vec![]);
            assert!(y.certainly_continuous(), "{text} over {x:?}");
        }
    }
}
