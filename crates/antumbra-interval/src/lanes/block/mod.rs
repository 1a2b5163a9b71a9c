//! Blocks: one operation on up to [`MOST`] numbers of any kind at once, with the bits of the operators on single ones.
//!
//! The operators of [`Interval`], [`Affine`] and [`Dual`] are the specification. A block performs the same IEEE operations in the
//! same order in every lane, rounded to nearest, on every [`Level`]: so results do not depend on the machine, on a
//! lane's position or on its neighbours (tests compare all bits). Where a scalar operator branches, a vector selects; lanes for
//! which that is not worth the while (overflow of an interval, a product that vanished) are done again by the operator.
//!
//! **Layout.** `[slot][vector][component][8 lanes]`, 64-byte aligned: an operation reads and writes whole cache lines, one
//! stream per operand.
mod kernels;
mod kinds;
mod run;
mod slots;
mod vector;
#[cfg(target_arch = "x86_64")]
mod x86;

#[cfg(target_arch = "x86_64")]
pub use x86::Avx2;

use super::Level;
use crate::affine::{Affine, Dual, Jet, SlopeOf};
use crate::quadratic::Quadratic;
use crate::{Interval, PointJet};
use kernels::{AffineOf, DualOf, IntervalOf, Kernel};
use run::act;
use sealed::Act;
pub use slots::Block;
pub use vector::WIDTH;
use vector::{Eight, Plain, Vector};

/// Most lanes of a block.
pub const MOST: usize = 64;

/// An operation that all kinds of number have in vectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arithmetic {
    /// `-a`.
    Neg,
    /// `a + b`.
    Add,
    /// `a - b`.
    Sub,
    /// `a b`.
    Mul,
    /// `a / b`.
    Div,
    /// `a^2`.
    Sqr,
    /// Square root.
    Sqrt,
    /// `|a|`.
    Abs,
    /// The smaller one.
    Min,
    /// The larger one.
    Max,
}

impl Arithmetic {
    /// Every operation.
    pub const ALL: [Self; 10] =
        [Self::Neg, Self::Add, Self::Sub, Self::Mul, Self::Div, Self::Sqr, Self::Sqrt, Self::Abs, Self::Min, Self::Max];
}

/// A kind of number that blocks hold. Implemented for [`Interval`], [`Affine`] forms in 1, 3 and 5 symbols, [`Dual`]s in one, [`PointJet`],
/// [`Quadratic`], [`Jet`] of affine forms, and slopes: only for these. (Slopes of both from
/// intervals, and of affine forms from affine forms.)
pub trait Packed: Copy + sealed::Sealed + sealed::Compiled {
    /// Numbers in it.
    const COMPONENTS: usize;
    /// Number `i` of it.
    fn component(&self, i: usize) -> f64;
    /// From its numbers, which were components of such a value or of a result.
    fn from_components(of: impl Fn(usize) -> f64) -> Self;
    /// The scalar operator.
    #[must_use]
    fn arithmetic(op: Arithmetic, a: Self, b: Self) -> Self;
    /// The scalar operator `a^n`.
    #[must_use]
    fn power(self, n: i32) -> Self;
    /// A coordinate `p + t d` of a point on a ray; for a [`Dual`] with the derivative `d` by t.
    #[must_use]
    fn coordinate(t: Self, d: Self, p: Self) -> Self;
    /// A parameter, from the interval that its first two numbers are: a function of the first symbol that runs from one end to the other,
    /// of kinds that have symbols (of a [`Dual`] the value; its derivative is anything).
    #[must_use]
    fn spanning(self) -> Self {
        self
    }
}

mod sealed {
    use super::{Arithmetic, Eight, Kernel, Level, Vector};
    /// An operation and its slots, as offsets in vectors of numbers.
    #[derive(Clone, Copy, Debug)]
    pub struct Act {
        /// What.
        pub(super) op: Operation,
        /// Where the result goes.
        pub(super) out: usize,
        /// Where the operands are.
        pub(super) operands: [usize; 3],
        /// From one vector of an operand to the next: 0 where all lanes hold the same number.
        pub(super) steps: [usize; 3],
    }

    /// An operation.
    #[derive(Clone, Copy, Debug)]
    pub(super) enum Operation {
        /// An operator.
        Arithmetic(Arithmetic),
        /// A power from 3 to 8.
        Power(u32),
        /// A coordinate on a ray.
        Coordinate,
        /// A parameter from its ends.
        Spanning,
    }
    /// Kinds of number with kernels.
    pub trait Sealed {
        /// Eight of them.
        type Of<V: Vector>: Kernel<V>;
    }
    /// Kinds whose kernels are compiled here, once, and not again in every crate that runs them: they are most of what there is to compile.
    pub trait Compiled {
        /// The operation on all vectors.
        fn run(level: Level, act: Act, memory: &mut [Eight], vectors: usize);
    }
}

macro_rules! compiled {
    ($($kind:ty),* $(,)?) => { $(
        impl sealed::Compiled for $kind {
            fn run(level: Level, act_: Act, memory: &mut [Eight], vectors: usize) {
                match level {
                    Level::Portable => act::<Plain, Self>(act_, memory, vectors),
                    #[cfg(target_arch = "x86_64")]
                    Level::Avx2(proof) => x86::with_avx2::<Self>(proof, act_, memory, vectors),
                    #[cfg(target_arch = "x86_64")]
                    Level::Avx512(proof) => x86::with_avx512::<Self>(proof, act_, memory, vectors),
                }
            }
        }
    )* };
}
compiled!(
    Interval,
    Affine<1>,
    Affine<3>,
    Affine<5>,
    Dual<1>,
    PointJet,
    Quadratic,
    Jet<Affine<3>>,
    SlopeOf<Interval, Quadratic>,
    SlopeOf<Interval, Jet<Affine<3>>>,
    SlopeOf<Affine<5>, Affine<5>>,
);

impl sealed::Sealed for Interval {
    type Of<V: Vector> = IntervalOf<V>;
}
impl<const N: usize> sealed::Sealed for Affine<N> {
    type Of<V: Vector> = AffineOf<V, N>;
}
impl<const N: usize> sealed::Sealed for Dual<N> {
    type Of<V: Vector> = DualOf<V, N>;
}

macro_rules! arithmetic {
    () => {
        #[inline]
        fn arithmetic(op: Arithmetic, a: Self, b: Self) -> Self {
            match op {
                Arithmetic::Neg => -a,
                Arithmetic::Add => a + b,
                Arithmetic::Sub => a - b,
                Arithmetic::Mul => a * b,
                Arithmetic::Div => a / b,
                Arithmetic::Sqr => a.sqr(),
                Arithmetic::Sqrt => a.sqrt(),
                Arithmetic::Abs => a.abs(),
                Arithmetic::Min => a.min(b),
                Arithmetic::Max => a.max(b),
            }
        }
    };
}
use arithmetic;

impl Packed for Interval {
    const COMPONENTS: usize = 2;
    #[inline(always)]
    fn component(&self, i: usize) -> f64 {
        if i == 0 { self.lo } else { self.hi }
    }
    #[inline(always)]
    fn from_components(of: impl Fn(usize) -> f64) -> Self {
        Self { lo: of(0), hi: of(1) }
    }
    arithmetic!();
    #[inline]
    fn power(self, n: i32) -> Self {
        self.powi(n)
    }
    #[inline]
    fn coordinate(t: Self, d: Self, p: Self) -> Self {
        p + t * d
    }
}

impl<const N: usize> Packed for Affine<N>
where
    Self: sealed::Compiled,
{
    const COMPONENTS: usize = N + 2;
    #[inline(always)]
    fn component(&self, i: usize) -> f64 {
        match i {
            0 => self.c,
            1 => self.e,
            _ => self.a[i - 2],
        }
    }
    #[inline(always)]
    fn from_components(of: impl Fn(usize) -> f64) -> Self {
        Self { c: of(0), e: of(1), a: std::array::from_fn(|i| of(i + 2)) }
    }
    arithmetic!();
    #[inline]
    fn power(self, n: i32) -> Self {
        self.powi(n)
    }
    /// `p` is a number (its coefficients are 0), known by centre and radius.
    #[inline]
    fn coordinate(t: Self, d: Self, p: Self) -> Self {
        (t * d).add_centre_radius(p.c, p.e)
    }
    #[inline]
    fn spanning(self) -> Self {
        Self::spanning(0, Interval { lo: self.c, hi: self.e })
    }
}

impl<const N: usize> Packed for Dual<N>
where
    Self: sealed::Compiled,
    Affine<N>: Packed,
{
    const COMPONENTS: usize = 2 * N + 4;
    #[inline(always)]
    fn component(&self, i: usize) -> f64 {
        if i < N + 2 { self.value.component(i) } else { self.derivative.component(i - N - 2) }
    }
    #[inline(always)]
    fn from_components(of: impl Fn(usize) -> f64) -> Self {
        let derivative = Affine::from_components(|i| of(i + N + 2));
        Self { value: Affine::from_components(of), derivative }
    }
    arithmetic!();
    #[inline]
    fn power(self, n: i32) -> Self {
        self.powi(n)
    }
    #[inline]
    fn coordinate(t: Self, d: Self, p: Self) -> Self {
        Self { value: Affine::coordinate(t.value, d.value, p.value), derivative: d.value }
    }
    #[inline]
    fn spanning(self) -> Self {
        Self { value: Packed::spanning(self.value), ..self }
    }
}
