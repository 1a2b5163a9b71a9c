//! Where on a piece of a beam the surface may be, by one form, affine or quadratic: what lies before and behind is settled without a question.
use super::Sign;
use crate::eval::QuadraticPoint;
use crate::geom::Fan;
use antumbra_interval::Interval;
use antumbra_interval::affine::Affine;
use antumbra_interval::quadratic::{Quadratic, Turn};
use antumbra_interval::round::{add_down, add_up, mul_down, mul_up, sub_down, sub_up};

/// How a symbol `x` in `[-1, 1]` runs along a piece: `t = middle + reach x`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    middle: Interval,
    reach: Interval,
}

impl Course {
    pub(super) fn of(t: Interval) -> Self {
        let [lo, hi, half] = [t.lo(), t.hi(), 0.5].map(Interval::point);
        Self { middle: (lo + hi) * half, reach: (hi - lo) * half }
    }

    /// Encloses the parameters.
    pub(super) fn at(self, x: Interval) -> Interval {
        self.middle + self.reach * x
    }

    /// The points of a fan at such values of `x`, which are an affine form themselves: so the points have degree 2, and nothing is lost.
    pub(super) fn points(self, x: Affine<3>, fan: &Fan) -> QuadraticPoint {
        let t = x.mul_interval(self.reach).add_interval(self.middle);
        let at = |k: usize| Quadratic::product_of(&t, &fan.direction[k]).add_interval(fan.apex[k]);
        [at(0), at(1), at(2)]
    }
}

/// What a form over a piece says along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Contracted {
    /// The function is 0 on no ray at any parameter of the piece outside of these, nor at their ends within the piece.
    pub(super) open: Interval,
    /// Its sign before them, where it is defined; behind them it has the other one.
    pub(super) before: Sign,
}

/// Contracts a piece along which symbol 0 of the form runs.
///
/// The form's symbol maps `[-1, 1]` linearly to `t` (in real numbers: [`Affine::spanning`] books its rounding as error), hence the
/// parameter at `s` is `lo + (hi - lo)/2 (s + 1)`, a sum and a product of numbers that are not negative. Rounded outward, a
/// parameter before `open` has an `s` before all zeros.
pub(super) fn contract<const N: usize>(t: Interval, form: &Affine<N>) -> Option<Contracted> {
    let crossing = form.crossing(0)?;
    let (lo, hi, zeros) = (t.lo(), t.hi(), crossing.zeros);
    let first = add_down(lo, mul_down(mul_down(0.5, sub_down(hi, lo)), add_down(zeros.lo(), 1.0)));
    let last = add_up(lo, mul_up(mul_up(0.5, sub_up(hi, lo)), add_up(zeros.hi(), 1.0)));
    let open = Interval::try_new(first, last)?.intersection(t);
    let before = if crossing.rises { Sign::Negative } else { Sign::Positive };
    (!open.is_empty()).then_some(Contracted { open, before })
}

/// Where on a piece a function may be 0 that has one sign on both sides of that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Turned {
    /// At parameters of the piece outside of these, and at their ends within the piece, the function has that sign on every ray. Empty if it has it
    /// on the whole piece.
    pub(super) open: Interval,
    pub(super) sign: Sign,
}

impl Turned {
    /// From what a quadratic form over the piece says.
    ///
    /// Products of intervals that are not 0 are rounded strictly outward, and the middle of a piece is such a product: so the ends of what is left
    /// are beyond the zeros, unless the piece ends there.
    pub(super) fn of(t: Interval, turn: Turn) -> Self {
        let open = Course::of(t).at(turn.zeros).intersection(t);
        let sign = if turn.positive { Sign::Positive } else { Sign::Negative };
        Self { open, sign }
    }
}

impl Contracted {
    /// The part of the piece before the open one, if there is one.
    pub(super) fn head(&self, t: Interval) -> Option<(Interval, Sign)> {
        (self.open.lo() > t.lo()).then(|| (Interval::new(t.lo(), self.open.lo()), self.before))
    }

    /// The part behind it.
    pub(super) fn tail(&self, t: Interval) -> Option<(Interval, Sign)> {
        (self.open.hi() < t.hi()).then(|| (Interval::new(self.open.hi(), t.hi()), self.before.opposite()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `f = t - 2 + 0.1 i +- 0.01` over `t` in `[1, 4]`.
    fn form() -> Affine<2> {
        Affine::spanning(0, Interval::new(1.0, 4.0)) + Affine::linear(-2.0, [0.0, 0.1], 0.01)
    }

    #[test]
    fn what_is_cut_off_has_one_sign_and_no_more_is_left_than_need_be() {
        let t = Interval::new(1.0, 4.0);
        let found = contract(t, &form()).unwrap();
        assert_eq!(found.before, Sign::Negative);
        assert!(found.open.lo() < 1.89 && found.open.hi() > 2.11, "zeros at 2 +- 0.11: {:?}", found.open);
        assert!(found.open.lo() > 1.89 - 1e-12 && found.open.hi() < 2.11 + 1e-12, "{:?}", found.open);
        let (head, sign) = found.head(t).unwrap();
        assert_eq!((head.lo(), head.hi(), sign), (1.0, found.open.lo(), Sign::Negative));
        let (tail, sign) = found.tail(t).unwrap();
        assert_eq!((tail.lo(), tail.hi(), sign), (found.open.hi(), 4.0, Sign::Positive));
        assert_eq!(contract(t, &-form()).unwrap().before, Sign::Positive);
    }

    #[test]
    fn nothing_is_cut_off_where_the_form_is_flat_unknown_or_far_too_wide() {
        let t = Interval::new(1.0, 4.0);
        assert_eq!(contract(t, &Affine::linear(0.0, [0.0, 1.0], 0.0)), None);
        assert_eq!(contract(t, &Affine::<2>::UNKNOWN), None);
        let wide = contract(t, &Affine::linear(0.0, [1.0, 2.0], 0.0)).unwrap();
        assert_eq!((wide.open, wide.head(t), wide.tail(t)), (t, None, None));
    }

    #[test]
    #[allow(clippy::float_arithmetic, reason = "a parabola at places that floats hold exactly")]
    fn around_a_turn_nothing_but_the_zeros_is_left_and_their_ends_are_beyond_them() {
        // 4 (t - 2)^2 - 1/4 over t in [1, 3], x = t - 2: zeros at 7/4 and 9/4, which are floats.
        let form = |c: f64| Quadratic::polynomial(c, [0.0; 3], [4.0, 0.0, 0.0, 0.0, 0.0, 0.0], 0.0);
        let t = Interval::new(1.0, 3.0);
        let found = Turned::of(t, form(-0.25).turn().unwrap());
        assert_eq!(found.sign, Sign::Positive);
        assert!(found.open.lo() < 1.75 && found.open.lo() > 1.75 - 1e-12, "{:?}", found.open);
        assert!(found.open.hi() > 2.25 && found.open.hi() < 2.25 + 1e-12, "{:?}", found.open);
        // A double zero at a float, with no rounding but that of the course.
        let found = Turned::of(t, form(0.0).turn().unwrap());
        assert!(found.open.lo() < 2.0 && found.open.hi() > 2.0 && found.open.width() < 1e-12, "{:?}", found.open);
        assert_eq!(Turned::of(t, (-form(-0.25)).turn().unwrap()).sign, Sign::Negative);
        assert!(Turned::of(t, form(0.25).turn().unwrap()).open.is_empty(), "no zero");
        // Zeros at the ends of the piece: nothing is cut off.
        assert_eq!(Turned::of(t, form(-4.0).turn().unwrap()).open, t);
    }

    #[test]
    fn a_piece_of_one_point_and_one_at_the_ends_of_the_numbers_stay_within_themselves() {
        for t in [Interval::point(3.0), Interval::new(0.0, f64::MAX), Interval::new(0.0, 5e-324)] {
            let form = Affine::<1>::linear(0.0, [1.0], 0.0);
            assert!(contract(t, &form).is_none_or(|found| found.open.is_subset_of(t)), "{t:?}");
        }
    }
}
