//! Relations between intervals, division and continuity: the cases that proofs rest on.
use antumbra_interval::{Decorated, Decoration, Interval};

const INFINITY: f64 = f64::INFINITY;

fn interval(lo: f64, hi: f64) -> Interval {
    Interval::new(lo, hi)
}

#[test]
fn division_is_that_of_sets() {
    let (a, minus_a) = (interval(1.0, 2.0), interval(-2.0, -1.0));
    let (right, left, around) = (interval(0.0, 1.0), interval(-1.0, -0.0), interval(-1.0, 1.0));
    for (got, lo, hi) in [
        (a / right, 1.0, INFINITY),
        (a / left, -INFINITY, -1.0),
        (minus_a / right, -INFINITY, -1.0),
        (minus_a / left, 1.0, INFINITY),
    ] {
        // One step outward at the finite end.
        assert!(interval(lo, hi).is_subset_of(got) && got.is_subset_of(interval(lo.next_down(), hi.next_up())));
    }
    assert_eq!(a / around, Interval::ENTIRE);
    assert_eq!(around / right, Interval::ENTIRE);
    assert_eq!(Interval::ZERO / around, Interval::ZERO);
    assert_eq!(Interval::ZERO / right, Interval::ZERO);
    assert_eq!(a / Interval::ZERO, Interval::EMPTY);
    assert_eq!(a / interval(-0.0, 0.0), Interval::EMPTY);
    assert_eq!(interval(0.0, 1.0) / right, interval(0.0, INFINITY));
    assert_eq!((a / interval(1.0, INFINITY)).lo(), 0.0);
    assert_eq!(Interval::ENTIRE * Interval::ZERO, Interval::ZERO);
    assert_eq!((interval(0.0, INFINITY) * interval(0.0, INFINITY)).lo(), 0.0);
}

#[test]
fn sums_of_squares_keep_their_sign() {
    let x = interval(-1e-200, 1e-200);
    let norm = x.sqr() + x.sqr();
    assert!(norm.certainly_nonnegative());
    assert!(Decorated::from(norm).sqrt().certainly_continuous());
}

#[test]
fn relations() {
    let (a, b) = (interval(1.0, 2.0), interval(1.0, 3.0));
    let empty = Interval::EMPTY;
    assert!(a.is_subset_of(b) && !b.is_subset_of(a) && empty.is_subset_of(empty) && empty.is_subset_of(a));
    assert!(!a.is_interior_to(b) && a.is_interior_to(interval(0.0, 3.0)) && empty.is_interior_to(empty));
    assert!(Interval::ENTIRE.is_interior_to(Interval::ENTIRE) && !Interval::ENTIRE.is_interior_to(a));
    assert!(!a.is_subset_of(empty) && !a.is_interior_to(empty));
    assert!(a.certainly_at_most(interval(2.0, 5.0)) && !a.certainly_less(interval(2.0, 5.0)));
    assert!(a.certainly_less(interval(2.5, 5.0)) && empty.certainly_less(a) && a.certainly_less(empty));
    assert!(a.possibly_intersects(b) && !a.possibly_intersects(interval(2.5, 3.0)) && !a.possibly_intersects(empty));
    assert!(!empty.possibly_zero() && interval(-0.0, 0.0).possibly_zero() && !a.possibly_zero());
    assert!(!Interval::ENTIRE.contains(INFINITY) && !Interval::ENTIRE.contains(f64::NAN));
    assert!(!Interval::ENTIRE.is_bounded() && !empty.is_bounded() && a.is_bounded());
}

#[test]
fn middle_and_size_of_unusual_intervals() {
    assert_eq!(Interval::ENTIRE.mid(), 0.0);
    assert_eq!(interval(1.0, INFINITY).mid(), f64::MAX);
    assert_eq!(interval(-INFINITY, 1.0).mid(), f64::MIN);
    assert_eq!(interval(f64::MIN, f64::MAX).mid(), 0.0);
    let tiny = f64::from_bits(1);
    assert_eq!(Interval::point(tiny).mid(), tiny);
    let empty = Interval::EMPTY;
    assert!(empty.mid().is_nan());
    assert_eq!((empty.width(), empty.radius(), empty.magnitude(), empty.mignitude()), (0.0, 0.0, 0.0, INFINITY));
    assert_eq!((Interval::ENTIRE.width(), Interval::ENTIRE.radius()), (INFINITY, INFINITY));
    assert_eq!(Interval::point(0.1).width(), 0.0);
}

#[test]
fn display() {
    assert_eq!(interval(0.1, 1e300).to_string(), "[0.1, 1e300]");
    assert_eq!(Interval::ONE.to_string(), "[1.0]");
    assert_eq!(Interval::EMPTY.to_string(), "[empty]");
    assert_eq!(Interval::ENTIRE.to_string(), "[-inf, inf]");
}

#[test]
fn numbers_that_are_none_give_no_information() {
    let a = interval(1.0, 2.0);
    for x in [f64::NAN, INFINITY, -INFINITY] {
        assert_eq!(a.add_point(x), Interval::ENTIRE);
        assert_eq!(a.mul_point(x), Interval::ENTIRE);
        assert!(Interval::try_new(x, x).is_none());
    }
    assert!(Interval::try_new(2.0, 1.0).is_none() && Interval::try_new(f64::NAN, 1.0).is_none());
    assert_eq!(Interval::from_bounds_or_entire(2.0, 1.0), Interval::EMPTY);
    assert_eq!(Interval::from_bounds_or_entire(2.0, f64::NAN), Interval::ENTIRE);
}

#[test]
#[should_panic(expected = "out of order")]
fn bounds_out_of_order() {
    let _ = interval(1.0, 0.0);
}

/// A sign change proves a root only where the function is continuous.
#[test]
fn sign_changes_without_a_root_are_not_continuous() {
    let x = Decorated::from(interval(-1.0, 1.0));
    let two = Decorated::from(Interval::point(2.0));
    let wide = Decorated::from(interval(1.0, 2.0));
    assert!(!(two / x).certainly_continuous() && !x.recip().certainly_defined());
    assert!(!x.powi(-1).certainly_continuous() && x.powi(3).certainly_continuous());
    assert!(!wide.tan().certainly_continuous() && x.tan().certainly_continuous());
    assert_eq!(x.floor().decoration, Decoration::Defined);
    assert_eq!(x.sign().decoration, Decoration::Defined);
    assert!(wide.sign().certainly_continuous());
    assert!(!x.sqrt().certainly_defined() && !x.ln().certainly_defined() && !wide.asin().certainly_defined());
    assert!(!x.pow(two).certainly_defined() && wide.pow(x).certainly_continuous());
    // The angle jumps at the negative x axis and is not defined at the origin.
    assert_eq!(x.atan2(Decorated::from(interval(-2.0, -1.0))).decoration, Decoration::Defined);
    assert_eq!(x.atan2(x).decoration, Decoration::Trivial);
    assert!(x.atan2(wide).certainly_continuous());
    // Once lost it stays lost, and an empty value proves nothing.
    assert!(!((two / x) + wide).certainly_continuous());
    assert_eq!(Decorated::new(Interval::EMPTY, Decoration::Continuous).decoration, Decoration::Trivial);
    assert_eq!(x.min(Decorated::from(Interval::EMPTY)).decoration, Decoration::Trivial);
}
