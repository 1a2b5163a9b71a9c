//! The kinds of number that tapes run on.
use antumbra::eval::{Gradient, Number};
use antumbra_interval::affine::{Affine, Dual, Jet, Slope, SlopeOf};
use antumbra_interval::quadratic::Quadratic;
use antumbra_interval::{Decorated, Interval};
use std::fmt::Debug;

/// A kind of number that encloses real numbers.
pub(crate) trait Kind: Number + Debug {
    const NAME: &'static str;
    /// Independent variables over a box.
    fn over<const K: usize>(x: [Interval; K]) -> [Self; K];
    /// The values that the number admits.
    fn range(&self) -> Interval;
}

impl Kind for Interval {
    const NAME: &'static str = "interval";
    fn over<const K: usize>(x: [Interval; K]) -> [Self; K] {
        x
    }
    fn range(&self) -> Interval {
        *self
    }
}

impl Kind for Decorated {
    const NAME: &'static str = "decorated interval";
    fn over<const K: usize>(x: [Interval; K]) -> [Self; K] {
        x.map(Self::from)
    }
    fn range(&self) -> Interval {
        self.interval
    }
}

impl Kind for Gradient {
    const NAME: &'static str = "gradient";
    fn over<const K: usize>(x: [Interval; K]) -> [Self; K] {
        let all = Self::coordinates(std::array::from_fn(|k| x.get(k).copied().unwrap_or(Interval::ZERO)));
        std::array::from_fn(|k| all[k])
    }
    fn range(&self) -> Interval {
        self.value
    }
}

/// A symbol for each variable; those for which there is none become constants.
fn variables<const N: usize, const K: usize>(x: [Interval; K]) -> [Affine<N>; K] {
    std::array::from_fn(|k| if k < N { Affine::spanning(k, x[k]) } else { Affine::constant(x[k]) })
}

macro_rules! affine {
    ($($n:literal)*) => { $(
        impl Kind for Affine<$n> {
            const NAME: &'static str = concat!("affine form of ", $n, " symbols");
            fn over<const K: usize>(x: [Interval; K]) -> [Self; K] {
                variables(x)
            }
            fn range(&self) -> Interval {
                Affine::range(self)
            }
        }
    )* };
}
affine!(1 3 5);

impl Kind for Dual<1> {
    const NAME: &'static str = "dual number";
    fn over<const K: usize>(x: [Interval; K]) -> [Self; K] {
        variables(x).map(|value| Self { value, derivative: Affine::constant(Interval::ONE) })
    }
    fn range(&self) -> Interval {
        self.value.range()
    }
}

/// `P + t D` with t in [0, 1], P a point of the box and D enclosing all of the box around it.
fn path<P, const N: usize, const K: usize>(x: [Interval; K], apex: impl Fn(Interval) -> P) -> [Slope<P, N>; K]
where
    P: antumbra_interval::affine::Apex<Affine<N>>,
{
    let t = Affine::spanning(0, Interval::new(0.0, 1.0));
    std::array::from_fn(|k| {
        let p = Interval::point(x[k].mid());
        let d = x[k] - p;
        let direction = if k + 1 < N { Affine::spanning(k + 1, d) } else { Affine::constant(d) };
        Slope::coordinate(apex(p), t, direction)
    })
}

impl Kind for Slope<Interval, 3> {
    const NAME: &'static str = "slope from a point";
    fn over<const K: usize>(x: [Interval; K]) -> [Self; K] {
        path(x, |p| p)
    }
    fn range(&self) -> Interval {
        self.value.range()
    }
}

impl Kind for Slope<Affine<5>, 5> {
    const NAME: &'static str = "slope from an affine form";
    fn over<const K: usize>(x: [Interval; K]) -> [Self; K] {
        path(x, Affine::constant)
    }
    fn range(&self) -> Interval {
        self.value.range()
    }
}

impl Kind for Quadratic {
    const NAME: &'static str = "quadratic form";
    fn over<const K: usize>(x: [Interval; K]) -> [Self; K] {
        variables::<3, K>(x).map(Self::from)
    }
    fn range(&self) -> Interval {
        Self::range(self)
    }
}

impl Kind for SlopeOf<Interval, Quadratic> {
    const NAME: &'static str = "quadratic slope from a point";
    fn over<const K: usize>(x: [Interval; K]) -> [Self; K] {
        let affine: [Slope<Interval, 3>; K] = path(x, |p| p);
        affine.map(|x| Self { apex: x.apex, value: x.value.into(), slope: x.slope.into() })
    }
    fn range(&self) -> Interval {
        self.value.range()
    }
}

impl Kind for Jet<Affine<3>> {
    const NAME: &'static str = "jet of affine forms";
    fn over<const K: usize>(x: [Interval; K]) -> [Self; K] {
        variables(x).map(|value| Self::line(value, Affine::constant(Interval::ONE)))
    }
    fn range(&self) -> Interval {
        self.value.range()
    }
}

impl Kind for SlopeOf<Interval, Jet<Affine<3>>> {
    const NAME: &'static str = "slope of jets from a point";
    fn over<const K: usize>(x: [Interval; K]) -> [Self; K] {
        let affine: [Slope<Interval, 3>; K] = path(x, |p| p);
        affine.map(|x| Self {
            apex: x.apex,
            value: Jet::line(x.value, x.slope),
            slope: Jet::line(x.slope, Affine::ZERO),
        })
    }
    fn range(&self) -> Interval {
        self.value.value.range()
    }
}
