//! A user's own inclusion function: three methods, the rest follows by the mean value theorem.
use antumbra::eval::{Gradient, Inclusion, Number, Workspace};
use antumbra::expr::{Binary, Unary};
use antumbra::geom::Box3;
use antumbra_interval::affine::{Affine, Slope};
use antumbra_interval::{Decorated, Interval};

/// A function written down once for every kind of number, known to the renderer by the three methods alone.
struct Own<F>(F);

/// Implemented by hand, as closures cannot be generic.
trait Anywhere: Send + Sync {
    fn at<N: Number>(&self, x: [N; 3]) -> N;
}

impl<F: Anywhere> Inclusion for Own<F> {
    fn range(&self, region: &Box3, _: &mut Workspace) -> Interval {
        self.0.at(region.0)
    }
    fn decorated(&self, region: &Box3, _: &mut Workspace) -> Decorated {
        self.0.at(region.0.map(Decorated::from))
    }
    fn gradient(&self, region: &Box3, _: &mut Workspace) -> Gradient {
        self.0.at(Gradient::coordinates(region.0))
    }
}

struct Pole;
impl Anywhere for Pole {
    fn at<N: Number>(&self, x: [N; 3]) -> N {
        N::constant(Interval::ONE).binary(Binary::Div, x[0])
    }
}

struct Jump;
impl Anywhere for Jump {
    fn at<N: Number>(&self, x: [N; 3]) -> N {
        x[1].binary(Binary::Atan2, x[0])
    }
}

struct Smooth;
impl Anywhere for Smooth {
    fn at<N: Number>(&self, x: [N; 3]) -> N {
        x[0].unary(Unary::Sqr).binary(Binary::Add, x[1].unary(Unary::Sin)).binary(Binary::Sub, x[2])
    }
}

/// The path from `p` to `p + d`, t in [0, 1].
fn path(p: [f64; 3], d: [f64; 3]) -> [Slope<Interval, 3>; 3] {
    let t = Affine::spanning(0, Interval::new(0.0, 1.0));
    std::array::from_fn(|k| Slope::coordinate(Interval::point(p[k]), t, Affine::constant(Interval::point(d[k]))))
}

#[test]
fn slopes_across_a_pole_or_a_jump_are_unknown() {
    let mut work = Workspace::default();
    // f(1) - f(-1) = 2, although f' < 0 everywhere.
    assert!(!Own(Pole).beam_slope(path([-1.0, 0.0, 0.0], [2.0, 0.0, 0.0]), &mut work).is_known());
    // f jumps from -pi to pi, although its derivative is small.
    assert!(!Own(Jump).beam_slope(path([-1.0, -0.1, 0.0], [0.0, 0.2, 0.0]), &mut work).is_known());
    assert!(Own(Pole).beam_slope(path([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]), &mut work).range().contains(-0.5));
}

#[test]
fn values_and_slopes_of_smooth_functions_are_enclosed() {
    let mut work = Workspace::default();
    let (p, d) = ([0.5, -0.25, 1.0], [0.5, 0.75, -0.25]);
    let path = path(p, d);
    let (value, slope) = (Own(Smooth).beam(path.map(|x| x.value), &mut work), Own(Smooth).beam_slope(path, &mut work));
    let f = |t: f64| {
        let x: [f64; 3] = std::array::from_fn(|k| p[k] + t * d[k]);
        x[0] * x[0] + core_math::sin(x[1]) - x[2]
    };
    for k in 1..=16 {
        let t = f64::from(k) / 16.0;
        assert!(value.range().contains(f(t)));
        assert!(slope.range().contains((f(t) - f(0.0)) / t));
    }
    assert!(value.range().width() < 6.0 && slope.range().width() < 2.0, "{value:?} {slope:?}");
}
