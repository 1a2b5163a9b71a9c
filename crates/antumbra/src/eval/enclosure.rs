//! The operators of the language on the enclosures of `antumbra-interval`: each is the method of that name.
use super::Number;
use crate::expr::{Binary, Unary};
use antumbra_interval::affine::{Affine, Apex, Dual, Form, Jet, SlopeOf};
use antumbra_interval::quadratic::Quadratic;
use antumbra_interval::{Decorated, Interval};

macro_rules! number {
    ([$($generics:tt)*] $kind:ty, $constant:expr) => {
        impl<$($generics)*> Number for $kind {
            #[inline(always)]
            fn constant(value: Interval) -> Self {
                $constant(value)
            }

            #[inline(always)]
            fn unary(self, op: Unary) -> Self {
                match op {
                    Unary::Neg => -self,
                    Unary::Abs => self.abs(),
                    Unary::Sign => self.sign(),
                    Unary::Floor => self.floor(),
                    Unary::Sqr => self.sqr(),
                    Unary::Sqrt => self.sqrt(),
                    Unary::Cbrt => self.cbrt(),
                    Unary::Exp => self.exp(),
                    Unary::Ln => self.ln(),
                    Unary::Sin => self.sin(),
                    Unary::Cos => self.cos(),
                    Unary::Tan => self.tan(),
                    Unary::Asin => self.asin(),
                    Unary::Acos => self.acos(),
                    Unary::Atan => self.atan(),
                    Unary::Sinh => self.sinh(),
                    Unary::Cosh => self.cosh(),
                    Unary::Tanh => self.tanh(),
                }
            }

            #[inline(always)]
            fn powi(self, n: i32) -> Self {
                <$kind>::powi(self, n)
            }

            #[inline(always)]
            fn binary(self, op: Binary, other: Self) -> Self {
                match op {
                    Binary::Add => self + other,
                    Binary::Sub => self - other,
                    Binary::Mul => self * other,
                    Binary::Div => self / other,
                    Binary::Min => self.min(other),
                    Binary::Max => self.max(other),
                    Binary::Pow => self.pow(other),
                    Binary::Atan2 => self.atan2(other),
                }
            }
        }
    };
}

number!([] Interval, |k| k);
number!([] Decorated, Decorated::from);
number!([const N: usize] Affine<N>, Affine::constant);
number!([const N: usize] Dual<N>, Dual::constant);
number!([P: Apex<F>, F: Form] SlopeOf<P, F>, SlopeOf::constant);
number!([F: Form] Jet<F>, Jet::constant);
number!([] Quadratic, Quadratic::constant);
