//! What slopes and jets need of a form: the operators of the language on enclosures of functions of symbols.
use super::{Affine, curve::narrower, derivative::Smooth, point::exact};
use crate::Interval;
use std::ops::{Add, Div, Mul, Neg, Sub};

macro_rules! forms {
    ($($name:ident)*) => {
        /// An enclosure of a function of symbols in `[-1, 1]`, closed under the operators of the language.
        ///
        /// Implemented for [`Affine`], for [`Quadratic`](crate::quadratic::Quadratic) and for [`Jet`](super::Jet)s of
        /// forms: only for these.
        pub trait Form:
            Copy + PartialEq + Neg<Output = Self> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
            + Div<Output = Self> + sealed::Sealed
        {
            /// The number 0.
            const ZERO: Self;
            /// Nothing known.
            const UNKNOWN: Self;
            /// Some number of `k`.
            #[must_use]
            fn constant(k: Interval) -> Self;
            /// Contains every value of the function.
            #[must_use]
            fn range(&self) -> Interval;
            /// `self + k`.
            #[must_use]
            fn add_interval(self, k: Interval) -> Self;
            /// `self * k`.
            #[must_use]
            fn mul_interval(self, k: Interval) -> Self;
            /// `self * k` for an exact number.
            #[must_use]
            fn mul_f64(self, k: f64) -> Self;
            /// `self^n`.
            #[must_use]
            fn powi(self, n: i32) -> Self;
            /// `self^y`.
            #[must_use]
            fn pow(self, y: Self) -> Self;
            /// Angle of the point `(x, self)`.
            #[must_use]
            fn atan2(self, x: Self) -> Self;
            /// The smaller one.
            #[must_use]
            fn min(self, o: Self) -> Self;
            /// The larger one.
            #[must_use]
            fn max(self, o: Self) -> Self;
            /// Any mean `w self + (1 - w) o`, `0 <= w <= 1`, where `w` may vary with the symbols.
            #[must_use]
            fn between(self, o: Self) -> Self;
            /// The mean of `h'` over the segment from `p` to `v`: `(h(v) - h(p))/(v - p)` where these differ.
            ///
            /// `both` holds all of `p` and `v`, `middle = (p + v)/2`, `difference = v - p`; `p` does not vary where the form
            /// is a jet.
            #[must_use]
            fn mean_derivative(h: Smooth, both: Interval, middle: Self, difference: Self) -> Self;
            $(
                /// The operator of that name.
                #[must_use]
                fn $name(self) -> Self;
            )*
        }

        /// The kind of number at the apex of a slope: [`Interval`] where the apex is (nearly) one point, the form itself where
        /// it varies with the symbols. Implemented for intervals and affine forms only.
        pub trait Apex<F: Form>:
            Copy + Neg<Output = Self> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
            + sealed::Sealed
        {
            /// Some number of `k`.
            #[must_use]
            fn constant(k: Interval) -> Self;
            /// Range of the values.
            #[must_use]
            fn range(self) -> Interval;
            /// `x + self`.
            #[must_use]
            fn shift(self, x: F) -> F;
            /// `x * self`.
            #[must_use]
            fn scale(self, x: F) -> F;
            /// `self + k`.
            #[must_use]
            fn add_interval(self, k: Interval) -> Self;
            /// `self * k`.
            #[must_use]
            fn mul_interval(self, k: Interval) -> Self;
            /// `self^n`.
            #[must_use]
            fn powi(self, n: i32) -> Self;
            /// `self^y`.
            #[must_use]
            fn pow(self, y: Self) -> Self;
            /// Angle of the point `(x, self)`.
            #[must_use]
            fn atan2(self, x: Self) -> Self;
            /// The smaller one.
            #[must_use]
            fn min(self, o: Self) -> Self;
            /// The larger one.
            #[must_use]
            fn max(self, o: Self) -> Self;
            $(
                /// The operator of that name.
                #[must_use]
                fn $name(self) -> Self;
            )*
        }
        impl<F: Form> Apex<F> for Interval {
            fn constant(k: Interval) -> Self { k }
            fn range(self) -> Interval { self }
            fn shift(self, x: F) -> F { x.add_interval(self) }
            fn scale(self, x: F) -> F { x.mul_interval(self) }
            fn add_interval(self, k: Interval) -> Self { self + k }
            fn mul_interval(self, k: Interval) -> Self { self * k }
            fn powi(self, n: i32) -> Self { Interval::powi(self, n) }
            fn pow(self, y: Self) -> Self { Interval::pow(self, y) }
            fn atan2(self, x: Self) -> Self { Interval::atan2(self, x) }
            fn min(self, o: Self) -> Self { Interval::min(self, o) }
            fn max(self, o: Self) -> Self { Interval::max(self, o) }
            $( fn $name(self) -> Self { Interval::$name(self) } )*
        }
        impl<const N: usize> Apex<Affine<N>> for Affine<N> {
            fn constant(k: Interval) -> Self { Affine::constant(k) }
            fn range(self) -> Interval { Affine::range(&self) }
            fn shift(self, x: Self) -> Self { x + self }
            fn scale(self, x: Self) -> Self { x * self }
            fn add_interval(self, k: Interval) -> Self { Affine::add_interval(self, k) }
            fn mul_interval(self, k: Interval) -> Self { Affine::mul_interval(self, k) }
            fn powi(self, n: i32) -> Self { Affine::powi(self, n) }
            fn pow(self, y: Self) -> Self { Affine::pow(self, y) }
            fn atan2(self, x: Self) -> Self { Affine::atan2(self, x) }
            fn min(self, o: Self) -> Self { Affine::min(self, o) }
            fn max(self, o: Self) -> Self { Affine::max(self, o) }
            $( fn $name(self) -> Self { Affine::$name(self) } )*
        }
    };
}
forms!(sqr sqrt cbrt abs sign floor exp ln sin cos tan asin acos atan sinh cosh tanh);

/// The methods of [`Form`] that are inherent methods of the type.
macro_rules! inherent {
    ($type:ident: $($name:ident)*) => {
        fn constant(k: Interval) -> Self { $type::constant(k) }
        fn range(&self) -> Interval { $type::range(self) }
        fn add_interval(self, k: Interval) -> Self { $type::add_interval(self, k) }
        fn mul_interval(self, k: Interval) -> Self { $type::mul_interval(self, k) }
        fn mul_f64(self, k: f64) -> Self { $type::mul_f64(self, k) }
        fn powi(self, n: i32) -> Self { $type::powi(self, n) }
        fn pow(self, y: Self) -> Self { $type::pow(self, y) }
        fn atan2(self, x: Self) -> Self { $type::atan2(self, x) }
        fn min(self, o: Self) -> Self { $type::min(self, o) }
        fn max(self, o: Self) -> Self { $type::max(self, o) }
        fn between(self, o: Self) -> Self { $type::between(self, o) }
        $( fn $name(self) -> Self { $type::$name(self) } )*
    };
}
pub(crate) use inherent;

impl<const N: usize> Form for Affine<N> {
    const ZERO: Self = Self::ZERO;
    const UNKNOWN: Self = Self::UNKNOWN;
    inherent!(Affine: sqr sqrt cbrt abs sign floor exp ln sin cos tan asin acos atan sinh cosh tanh);

    /// The mean of `h'` from `p` to `v` is
    /// - in the range of `h'` over the hull of both, and
    /// - `h'(m) + h'''(xi) (v - p)^2 / 24`, `m = (p + v)/2`, `xi` between `p` and `v` (midpoint rule for `h'`).
    ///
    /// The domain being convex, `m` and `xi` are in it. The narrower enclosure is used.
    fn mean_derivative(h: Smooth, both: Interval, middle: Self, difference: Self) -> Self {
        let d = exact(difference.range().magnitude());
        // (v - p)^2 is anything from 0 to d^2.
        let remainder = h.third_range(both) * (d.sqr() / exact(24.0)).hull(Interval::ZERO);
        let curved = h.first(middle).add_interval(remainder);
        narrower(curved, Affine::constant(h.first_range(both)))
    }
}

pub(crate) mod sealed {
    pub trait Sealed {}
    impl Sealed for crate::Interval {}
    impl<const N: usize> Sealed for super::Affine<N> {}
}
