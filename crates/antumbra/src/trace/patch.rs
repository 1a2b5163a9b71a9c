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
                let region = || piece.fan.box_at(course.at(layer.range()));
                let continuous =
                    of.function.continuous_everywhere() || certainly_continuous(of.function, &region(), work);
                continuous.then_some(Patch { surface, t: piece.t, course, layer, form })
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
    /// one; what is found must lie in the piece.
    #[must_use]
    pub fn bracket(&self, [a, b]: [Interval; 2]) -> Option<Bracket> {
        let zero = self.form.zero_along(a, b)?;
        let half = Interval::point(0.5);
        let [lo, hi] = [self.layer.k.lo(), self.layer.k.hi()].map(Interval::point);
        let k = (lo + hi) * half + (hi - lo) * half * zero.at;
        let [p, q] = self.layer.slopes.map(Interval::point);
        let t = self.course.at(k + p * a + q * b);
        let before = if zero.rises { Sign::Negative } else { Sign::Positive };
        t.is_subset_of(self.t).then_some(Bracket { surface: self.surface, t, before })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Formula;
    use crate::geom::{Box3, Camera, Clip, Film, Vec3};
    use crate::tape::Tape;
    use crate::trace::{Frustum, Known, narrow};

    /// The patches of all blocks of 4 x 4 pixels, with their windows.
    fn all(text: &str, film: &Film) -> Vec<([usize; 2], Known, Option<Patch>)> {
        let formula = Formula::parse(text).unwrap();
        let tape = Tape::compile(formula.surface().formula()).unwrap();
        let cube = Clip::Box(Box3([Interval::new(-3.0, 3.0); 3]));
        let surfaces = [Surface { function: &tape, clip: cube, region: cube }];
        let mut work = Workspace::default();
        let corners = (0..film.height / 4).flat_map(|j| (0..film.width / 4).map(move |i| [4 * i, 4 * j]));
        let look = |corner: [usize; 2]| {
            let fan = film.fan(corner[0]..corner[0] + 4, corner[1]..corner[1] + 4);
            let parent = Known::nothing(&surfaces, &fan);
            let mut known = Known::default();
            narrow(&surfaces, &[Frustum { fan, parent: &parent }], &mut Default::default(), &mut work, |_, k, _| {
                known = k.clone();
            });
            let mut patch = None;
            if let [piece] = known.open[..]
                && known.inside
            {
                patches(&surfaces, &[(fan, piece)], &mut work, |_, found, _| patch = found);
            }
            (corner, known, patch)
        };
        corners.map(look).collect()
    }

    fn film(size: usize) -> Film {
        let camera = Camera::look_at(Vec3::new(3.0, -4.0, 3.0), Vec3::default(), 25.0, 1.0);
        Film { camera, width: size, height: size }
    }

    #[test]
    #[allow(clippy::float_arithmetic, reason = "the ball's true hits")]
    fn brackets_hold_the_first_hit_of_their_ray_and_are_narrow() {
        let film = film(64);
        let (mut brackets, mut covered, mut widest) = (0, 0, 0.0_f64);
        for ([column, row], known, patch) in all("x^2 + y^2 + z^2 = 1", &film) {
            covered += u32::from(known.certainly_covered());
            let Some(patch) = patch else { continue };
            let [x, y] = film.window(column..column + 4, row..row + 4);
            for (i, j) in (0..16).map(|k| (column + k % 4, row + k / 4)) {
                let Some(bracket) = patch.bracket([film.column_symbol(x, i), film.row_symbol(y, j)]) else { continue };
                brackets += 1;
                let (o, d) = (film.camera.eye, film.ray(i, j).direction.mid());
                let (a, b, c) = (d.dot(d), o.dot(d), o.dot(o) - 1.0);
                let t = (-b - (b * b - a * c).sqrt()) / a;
                assert!(bracket.t.lo() <= t + 1e-14 && t - 1e-14 <= bracket.t.hi(), "{i} {j}: {t}, {bracket:?}");
                assert_eq!((bracket.before, bracket.surface), (Sign::Positive, 0));
                widest = widest.max(bracket.t.width());
            }
        }
        assert!(covered > 50 && brackets >= 15 * covered, "{brackets} of {covered} blocks");
        assert!(widest < 0.02, "{widest}");
    }

    #[test]
    fn nothing_is_claimed_of_a_surface_that_is_touched_or_torn() {
        let film = film(16);
        let anywhere = |patch: &Patch| {
            let places = [-1.0, -0.4, 0.0, 0.7, 1.0].map(Interval::point);
            places.iter().any(|a| places.iter().any(|b| patch.bracket([*a, *b]).is_some()))
        };
        let found = |text: &str| all(text, &film).iter().filter(|(_, _, p)| p.as_ref().is_some_and(anywhere)).count();
        assert!(found("x + y/3 = 0") > 0);
        assert_eq!(found("(x + y/3)^2 + z^4/1000 = 0"), 0, "no change of sign");
        assert_eq!(found("floor(3 x + y) + 1/2 = 0"), 0, "a step");
        assert_eq!(found("1/(x + y/3) = 0"), 0, "a pole");
    }
}
