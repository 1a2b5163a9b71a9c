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
use sealed::{Act, Operation};
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
}

/// Slots of a batch: each holds one number per lane. Scratch memory: keep it, it only grows.
#[derive(Clone, Debug)]
pub struct Block<F> {
    memory: Vec<Eight>,
    vectors: usize,
    kind: std::marker::PhantomData<F>,
}

impl<F> Default for Block<F> {
    fn default() -> Self {
        Self { memory: Vec::new(), vectors: 1, kind: std::marker::PhantomData }
    }
}

impl<F: Packed> Block<F> {
    /// Makes room for so many slots of so many lanes. What they hold does not matter, and is unknown.
    /// Panics unless there are 1 to [`MOST`] lanes.
    pub fn prepare(&mut self, slots: usize, lanes: usize) {
        assert!((1..=MOST).contains(&lanes), "1 to {MOST} lanes");
        self.vectors = lanes.div_ceil(WIDTH);
        let size = slots * self.size();
        if self.memory.len() < size {
            self.memory.resize(size, Eight::default());
        }
    }

    /// Vectors of a slot.
    #[inline(always)]
    fn size(&self) -> usize {
        self.vectors * F::COMPONENTS
    }

    /// The first of the vectors that hold a lane.
    #[inline(always)]
    fn place(&self, slot: usize, lane: usize) -> (usize, usize) {
        assert!(lane < self.vectors * WIDTH, "a lane of the block");
        ((slot * self.vectors + lane / WIDTH) * F::COMPONENTS, lane % WIDTH)
    }

    /// Writes one lane.
    #[inline]
    pub fn set(&mut self, slot: usize, lane: usize, x: F) {
        let (first, k) = self.place(slot, lane);
        let part = &mut self.memory[first..first + F::COMPONENTS];
        for (i, vector) in part.iter_mut().enumerate() {
            vector.0[k] = x.component(i);
        }
    }

    /// Writes all lanes of a slot, or the first components of them: the others hold anything. The last lane is repeated up to the
    /// end of its vector. Panics if `G` has more components.
    #[inline]
    pub fn load<G: Packed>(&mut self, slot: usize, lanes: usize, of: impl Fn(usize) -> G) {
        let size = self.size();
        let vectors = self.memory[slot * size..][..size].chunks_exact_mut(F::COMPONENTS);
        for (first, vector) in (0..lanes).step_by(WIDTH).zip(vectors) {
            let vector = &mut vector[..G::COMPONENTS];
            for k in 0..WIDTH {
                let x = of(usize::min(first + k, lanes - 1));
                for (i, eight) in vector.iter_mut().enumerate() {
                    eight.0[k] = x.component(i);
                }
            }
        }
    }

    /// Writes components of all lanes, from `first` on, that stand in a slot of another block. Panics unless that has as many vectors, and
    /// there are so many components.
    pub fn put<G: Packed>(&mut self, slot: usize, first: usize, other: &Block<G>, from: usize) {
        assert_eq!(self.vectors, other.vectors, "blocks of as many lanes");
        let size = self.size();
        let to = self.memory[slot * size..][..size].chunks_exact_mut(F::COMPONENTS);
        let from = other.memory[from * other.size()..].chunks_exact(G::COMPONENTS);
        to.zip(from).for_each(|(to, from)| to[first..first + G::COMPONENTS].copy_from_slice(from));
    }

    /// Reads one lane.
    #[inline]
    #[must_use]
    pub fn get(&self, slot: usize, lane: usize) -> F {
        let (first, k) = self.place(slot, lane);
        let part = &self.memory[first..first + F::COMPONENTS];
        F::from_components(|i| part[i].0[k])
    }

    /// Writes the same number into all lanes.
    pub fn fill(&mut self, slot: usize, x: F) {
        let size = self.size();
        for part in self.memory[slot * size..][..size].chunks_exact_mut(F::COMPONENTS) {
            for (i, vector) in part.iter_mut().enumerate() {
                *vector = Eight([x.component(i); WIDTH]);
            }
        }
    }

    /// Repeats the last of the lanes in the rest of its vector, so that no operation meets numbers that nobody chose.
    pub fn pad(&mut self, slot: usize, lanes: usize) {
        let x = self.get(slot, lanes - 1);
        for lane in lanes..self.vectors * WIDTH {
            self.set(slot, lane, x);
        }
    }

    /// `slot[out] = op(slot[a], slot[b])` in every lane; the slots may be the same. Operations of one operand take `a`.
    #[inline]
    pub fn arithmetic(&mut self, level: Level, op: Arithmetic, out: usize, a: usize, b: usize) {
        self.act(level, Operation::Arithmetic(op), out, [a, b, b]);
    }

    /// `slot[out] = slot[a]^n` in every lane: by vectors for n from 3 to 8, else lane by lane.
    #[inline]
    pub fn power(&mut self, level: Level, lanes: usize, n: i32, out: usize, a: usize) {
        match n {
            3..=8 => self.act(level, Operation::Power(n as u32), out, [a; 3]),
            _ => self.map(lanes, out, a, |x| x.power(n)),
        }
    }

    /// `slot[out] = p + t d` in every lane: [`Packed::coordinate`].
    #[inline]
    pub fn coordinate(&mut self, level: Level, out: usize, t: usize, d: usize, p: usize) {
        self.act(level, Operation::Coordinate, out, [t, d, p]);
    }

    #[inline]
    fn act(&mut self, level: Level, op: Operation, out: usize, operands: [usize; 3]) {
        let size = self.size();
        let act_ = Act { op, out: out * size, operands: operands.map(|slot| slot * size) };
        F::run(level, act_, &mut self.memory, self.vectors);
    }

    /// `slot[out] = f(slot[a])`, lane by lane.
    #[inline]
    pub fn map(&mut self, lanes: usize, out: usize, a: usize, f: impl Fn(F) -> F) {
        for lane in 0..lanes {
            let x = f(self.get(a, lane));
            self.set(out, lane, x);
        }
        self.pad(out, lanes);
    }

    /// `slot[out] = f(slot[a], slot[b])`, lane by lane.
    #[inline]
    pub fn map2(&mut self, lanes: usize, out: usize, a: usize, b: usize, f: impl Fn(F, F) -> F) {
        for lane in 0..lanes {
            let x = f(self.get(a, lane), self.get(b, lane));
            self.set(out, lane, x);
        }
        self.pad(out, lanes);
    }
}

/// The operation on all vectors. Operands are read before the result is written: slots may be the same.
///
/// Always inlined, macros instead of closures: the code takes the features of the function that it is inlined into.
#[inline(always)]
fn act<V: Vector, F: Packed>(act: Act, memory: &mut [Eight], vectors: usize) {
    macro_rules! each {
        ($($x:ident = $k:literal),* => $value:expr) => {
            for i in 0..vectors {
                let at = i * F::COMPONENTS;
                $( let $x = <F::Of<V> as Kernel<V>>::load(&memory[act.operands[$k] + at..][..F::COMPONENTS]); )*
                let (value, proper): (F::Of<V>, V::Mask) = $value;
                let proper = V::bits(proper);
                if proper == u8::MAX {
                    value.store(&mut memory[act.out + at..][..F::COMPONENTS]);
                } else {
                    let again = again::<F>(act, memory, at, !proper);
                    value.store(&mut memory[act.out + at..][..F::COMPONENTS]);
                    replace(&mut memory[act.out + at..][..F::COMPONENTS], !proper, &again);
                }
            }
        };
    }
    match act.op {
        Operation::Arithmetic(Arithmetic::Neg) => each!(x = 0 => x.neg()),
        Operation::Arithmetic(Arithmetic::Add) => each!(x = 0, y = 1 => x.add(y)),
        Operation::Arithmetic(Arithmetic::Sub) => each!(x = 0, y = 1 => x.sub(y)),
        Operation::Arithmetic(Arithmetic::Mul) => each!(x = 0, y = 1 => x.mul(y)),
        Operation::Arithmetic(Arithmetic::Div) => each!(x = 0, y = 1 => x.div(y)),
        Operation::Arithmetic(Arithmetic::Sqr) => each!(x = 0 => x.sqr()),
        Operation::Arithmetic(Arithmetic::Sqrt) => each!(x = 0 => x.sqrt()),
        Operation::Arithmetic(Arithmetic::Abs) => each!(x = 0 => x.abs()),
        Operation::Arithmetic(Arithmetic::Min) => each!(x = 0, y = 1 => x.min(y)),
        Operation::Arithmetic(Arithmetic::Max) => each!(x = 0, y = 1 => x.max(y)),
        Operation::Power(n) => each!(x = 0 => x.power(n)),
        Operation::Coordinate => each!(t = 0, d = 1, p = 2 => Kernel::coordinate(t, d, p)),
    }
}

/// The operation on the chosen lanes of one vector, by the scalar operator; of the others, an operand.
#[cold]
#[inline(never)]
fn again<F: Packed>(act: Act, memory: &[Eight], at: usize, chosen: u8) -> [F; WIDTH] {
    std::array::from_fn(|k| {
        let operand = |j: usize| F::from_components(|i| memory[act.operands[j] + at + i].0[k]);
        if chosen >> k & 1 == 0 {
            return operand(0);
        }
        match act.op {
            Operation::Arithmetic(op) => F::arithmetic(op, operand(0), operand(1)),
            Operation::Power(n) => operand(0).power(n as i32),
            Operation::Coordinate => F::coordinate(operand(0), operand(1), operand(2)),
        }
    })
}

/// Puts the chosen lanes in place.
#[cold]
#[inline(never)]
fn replace<F: Packed>(to: &mut [Eight], chosen: u8, from: &[F; WIDTH]) {
    for (k, x) in from.iter().enumerate().filter(|(k, _)| chosen >> k & 1 == 1) {
        for (i, vector) in to.iter_mut().enumerate() {
            vector.0[k] = x.component(i);
        }
    }
}
