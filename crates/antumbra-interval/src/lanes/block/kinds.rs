//! What shadow searches ask, as kinds of number that blocks hold: quadratic forms, jets, slopes of both, slopes of affine forms from
//! apexes that are such forms too, and plain jets.
use super::kernels::{AffineOf, IntervalOf, JetOf, PointJetOf, QuadraticOf, SlopeLanes};
use super::{Arithmetic, Packed, Vector, arithmetic, sealed};
use crate::affine::{Affine, Jet, SlopeOf};
use crate::quadratic::Quadratic;
use crate::{Interval, PointJet};

impl sealed::Sealed for Quadratic {
    type Of<V: Vector> = QuadraticOf<V>;
}
impl<const N: usize> sealed::Sealed for Jet<Affine<N>> {
    type Of<V: Vector> = JetOf<V, N>;
}
impl sealed::Sealed for SlopeOf<Interval, Quadratic> {
    type Of<V: Vector> = SlopeLanes<IntervalOf<V>, QuadraticOf<V>>;
}
impl<const N: usize> sealed::Sealed for SlopeOf<Interval, Jet<Affine<N>>> {
    type Of<V: Vector> = SlopeLanes<IntervalOf<V>, JetOf<V, N>>;
}
impl<const N: usize> sealed::Sealed for SlopeOf<Affine<N>, Affine<N>> {
    type Of<V: Vector> = SlopeLanes<AffineOf<V, N>, AffineOf<V, N>>;
}
impl sealed::Sealed for PointJet {
    type Of<V: Vector> = PointJetOf<V>;
}

/// The operators; a coordinate is the sum of a product.
macro_rules! operators {
    () => {
        arithmetic!();
        #[inline]
        fn power(self, n: i32) -> Self {
            self.powi(n)
        }
        #[inline]
        fn coordinate(t: Self, d: Self, p: Self) -> Self {
            t * d + p
        }
    };
}

impl Packed for Quadratic {
    const COMPONENTS: usize = 11;
    #[inline(always)]
    fn component(&self, i: usize) -> f64 {
        match i {
            0 => self.c,
            1 => self.e,
            2..5 => self.l[i - 2],
            _ => self.q[i - 5],
        }
    }
    #[inline(always)]
    fn from_components(of: impl Fn(usize) -> f64) -> Self {
        let (l, q) = ([of(2), of(3), of(4)], [of(5), of(6), of(7), of(8), of(9), of(10)]);
        Self { c: of(0), e: of(1), l, q }
    }
    operators!();
}

impl<const N: usize> Packed for Jet<Affine<N>>
where
    Self: sealed::Compiled,
    Affine<N>: Packed,
{
    const COMPONENTS: usize = 3 * (N + 2);
    #[inline(always)]
    fn component(&self, i: usize) -> f64 {
        let part = N + 2;
        if i < part {
            self.value.component(i)
        } else if i < 2 * part {
            self.first.component(i - part)
        } else {
            self.second.component(i - 2 * part)
        }
    }
    #[inline(always)]
    fn from_components(of: impl Fn(usize) -> f64) -> Self {
        let part = |k: usize| Affine::from_components(|i| of(k * (N + 2) + i));
        Self { value: part(0), first: part(1), second: part(2) }
    }
    operators!();
}

macro_rules! slopes {
    ([$($generic:tt)*] $apex:ty, $form:ty) => {
        impl<$($generic)*> Packed for SlopeOf<$apex, $form>
        where
            Self: sealed::Compiled,
            $apex: Packed,
            $form: Packed,
        {
            const COMPONENTS: usize = <$apex>::COMPONENTS + 2 * <$form>::COMPONENTS;
            #[inline(always)]
            fn component(&self, i: usize) -> f64 {
                let (value, slope) = (<$apex>::COMPONENTS, <$apex>::COMPONENTS + <$form>::COMPONENTS);
                if i < value {
                    self.apex.component(i)
                } else if i < slope {
                    self.value.component(i - value)
                } else {
                    self.slope.component(i - slope)
                }
            }
            #[inline(always)]
            fn from_components(of: impl Fn(usize) -> f64) -> Self {
                let part = |from: usize| <$form>::from_components(|i| of(from + i));
                let (value, slope) = (<$apex>::COMPONENTS, <$apex>::COMPONENTS + <$form>::COMPONENTS);
                let apex = <$apex>::from_components(&of);
                Self { apex, value: part(value), slope: part(slope) }
            }
            operators!();
        }
    };
}
slopes!([] Interval, Quadratic);
slopes!([const N: usize] Interval, Jet<Affine<N>>);
slopes!([const N: usize] Affine<N>, Affine<N>);

impl Packed for PointJet {
    const COMPONENTS: usize = 3;
    #[inline(always)]
    fn component(&self, i: usize) -> f64 {
        match i {
            0 => self.value,
            1 => self.first,
            _ => self.second,
        }
    }
    #[inline(always)]
    fn from_components(of: impl Fn(usize) -> f64) -> Self {
        Self { value: of(0), first: of(1), second: of(2) }
    }
    operators!();
}
