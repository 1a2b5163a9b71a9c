//! What all rays of a small frustum meet, to second order: where each of them meets it is known at once, and nearly.
use super::crossing::Course;
use super::piece::certainly_continuous;
use super::policy;
use super::{Cost, Piece, Sign, Surface};
use crate::eval::{FanPiece, QuadraticPoint, Workspace};
use crate::geom::Fan;
use antumbra_interval::Interval;
use antumbra_interval::affine::Affine;
use antumbra_interval::quadratic::Quadratic;

/// The part of a surface that the rays of a frustum meet in one open piece, as a function of the two symbols of its fan.
#[derive(Clone, Copy, Debug)]
pub struct Patch {
    surface: usize,
    /// Parameters of the piece.
    t: Interval,
    course: Course,
    layer: Layer,
    /// Parameters of the layer, on all rays: the function is continuous there.
    reach: Interval,
    /// The function over the layer, symbol 0 running through it.
    form: Quadratic,
}

/// Two parallel planes across the fan: with `x` in `[-1, 1]` along a piece, `x = k + p_1 s_1 + p_2 s_2`, `k` in an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Layer {
    pub(super) k: Interval,
    pub(super) slopes: [f64; 2],
}

/// A piece of a ray that holds the first root: proved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bracket {
    /// Index of the surface.
    pub surface: usize,
    /// Parameters.
    pub t: Interval,
    /// The sign of f before the root, from the beginning of the open piece on; behind it f has the other one.
    pub before: Sign,
}

impl Layer {
    /// Encloses `x` throughout the layer.
    fn range(&self) -> Interval {
        self.form(Affine::constant(self.k)).range()
    }

    /// `x` across the fan on one of the planes, or between them.
    fn form(&self, k: Affine<3>) -> Affine<3> {
        k + Affine::linear(0.0, [0.0, self.slopes[0], self.slopes[1]], 0.0)
    }

    /// Whether the function has one sign before and the other one behind the layer on all rays, as far as that is in the piece over which
    /// its affine form is given. The form is of first degree in `x`, its symbol 0: before the lower plane it is farther from 0 than on it.
    fn certainly_divides(&self, form: &Affine<3>) -> bool {
        let [along, across @ ..] = *form.coefficients();
        let rest = Affine::linear(form.centre(), [0.0, across[0], across[1]], form.error());
        let on = |k: f64| Sign::of((self.form(Affine::constant(Interval::point(k))).mul_f64(along) + rest).range());
        let before = if along > 0.0 { Sign::Negative } else { Sign::Positive };
        along != 0.0 && on(self.k.lo()) == Some(before) && on(self.k.hi()) == Some(before.opposite())
    }

    /// The points of the layer, symbol 0 running through it.
    fn points(&self, fan: &Fan, course: Course) -> QuadraticPoint {
        course.points(self.form(Affine::spanning(0, self.k)), fan)
    }
}

/// The patches of frusta that have one open piece each, in which all their rays are inside the surface's region. `None` where there is no telling
/// that each ray meets the surface once in a thin layer of the piece, or what is there is too far from flat. And what each cost: one or two evaluations.
pub fn patches(
    surfaces: &[Surface<'_>],
    asked: &[(Fan, Piece)],
    work: &mut Workspace,
    mut found: impl FnMut(usize, Option<Patch>, Cost),
) {
    for (surface, of) in surfaces.iter().enumerate() {
        let own = || asked.iter().enumerate().filter(move |(_, (_, piece))| piece.surface == surface);
        let pieces: Vec<FanPiece> = own().map(|(_, (fan, piece))| FanPiece { fan: *fan, t: piece.t }).collect();
        let mut forms = vec![Affine::UNKNOWN; pieces.len()];
        of.function.beams(&pieces, &mut forms, work);
        let layers: Vec<Option<Layer>> =
            forms.iter().map(|form| policy::layer(form).filter(|layer| layer.certainly_divides(form))).collect();
        let divided = || pieces.iter().zip(&layers).filter_map(|(piece, layer)| Some((piece, (*layer)?)));
        let points: Vec<QuadraticPoint> =
            divided().map(|(piece, layer)| layer.points(&piece.fan, Course::of(piece.t))).collect();
        let mut forms = vec![Quadratic::UNKNOWN; points.len()];
        of.function.quadratics(&points, &mut forms, work);
        let mut forms = forms.into_iter();
        for (((k, _), piece), layer) in own().zip(&pieces).zip(&layers) {
            let patch = layer.and_then(|layer| {
                let form = forms.next()?;
                let course = Course::of(piece.t);
                // The layer may reach beyond the piece.
                let reach = course.at(layer.range());
                let continuous = of.function.continuous_everywhere()
                    || certainly_continuous(of.function, &piece.fan.box_at(reach), work);
                continuous.then_some(Patch { surface, t: piece.t, course, layer, reach, form })
            });
            let evaluations = 1 + u64::from(layer.is_some());
            found(k, patch, Cost { beams: 0, evaluations });
        }
    }
}

impl Patch {
    /// Where the ray of these symbol values meets the patch; the symbols are known to lie in the intervals.
    ///
    /// Outside of the layer the function is not 0 in the piece. Within it [`Quadratic::zero_along`] tells all its zeros, and that there is
    /// one; what is found must lie in the piece. What rounding adds beyond the layer is cut off: so the function is continuous on the bracket.
    #[must_use]
    pub fn bracket(&self, [a, b]: [Interval; 2]) -> Option<Bracket> {
        let zero = self.form.zero_along(a, b)?;
        let half = Interval::point(0.5);
        let [lo, hi] = [self.layer.k.lo(), self.layer.k.hi()].map(Interval::point);
        let k = (lo + hi) * half + (hi - lo) * half * zero.at;
        let [p, q] = self.layer.slopes.map(Interval::point);
        let t = self.course.at(k + p * a + q * b).intersection(self.reach);
        let before = if zero.rises { Sign::Negative } else { Sign::Positive };
        (!t.is_empty() && t.is_subset_of(self.t)).then_some(Bracket { surface: self.surface, t, before })
    }
}
