//! The one public trait: what the renderer needs to know of a function.
use super::batch::{self, FanPiece, Occupancy, RayPiece, ShaftPiece, Unasked};
use super::{Gradient, PointJet, Regions, run};
use crate::geom::Box3;
use crate::tape::Tape;
use antumbra_interval::affine::{Affine, Dual, Form, Jet, Slope, SlopeOf};
use antumbra_interval::lanes::Level;
use antumbra_interval::quadratic::Quadratic;
use antumbra_interval::{Decorated, Decoration, Interval};
use std::sync::Arc;

/// Scratch memory of one thread. Start from `default()` and keep it: it only grows.
#[derive(Debug, Default)]
pub struct Workspace {
    intervals: Vec<Interval>,
    decorated: Vec<Decorated>,
    gradients: Vec<Gradient>,
    rays: Vec<Dual<1>>,
    beams: Vec<Affine<3>>,
    beam_slopes: Vec<Slope<Interval, 3>>,
    shafts: Vec<Affine<5>>,
    shaft_slopes: Vec<Slope<Affine<5>, 5>>,
    quadratics: Vec<Quadratic>,
    quadratic_slopes: Vec<SlopeOf<Interval, Quadratic>>,
    jets: Vec<Jet<Affine<3>>>,
    jet_slopes: Vec<SlopeOf<Interval, Jet<Affine<3>>>>,
    points: Vec<PointJet>,
    batch: batch::Scratch,
}

impl Workspace {
    /// One whose batches use certain instructions, not the best of this processor. No answer depends on it.
    #[must_use]
    pub fn on(level: Level) -> Self {
        Self { batch: batch::Scratch::on(level), ..Self::default() }
    }

    /// From now on every tape is run so often on the lanes of a batch, once they are filled: a tape alone is timed by this. No answer
    /// depends on it.
    pub fn repeat_tapes(&mut self, times: usize) {
        self.batch.times = times.max(1);
    }

    /// How full the batches were since this was asked last.
    pub fn take_occupancy(&mut self) -> Occupancy {
        std::mem::take(&mut self.batch.occupancy)
    }
}

/// A point on a beam piece, as linear functions of the beam's symbols: (t, i, j) of a camera frustum, (t, u, v) of a
/// shadow beam.
pub type BeamPoint = [Affine<3>; 3];
/// A point in a shaft between a tile of hits and a light, over (t, u, v, i, j).
pub type ShaftPoint = [Affine<5>; 3];
/// The same with the slopes from an apex that varies with the hit.
pub type ShaftSlopePoint = [Slope<Affine<5>, 5>; 3];
/// A point on a beam piece, as quadratic functions of (s, a, b): along the piece, and across it.
pub type QuadraticPoint = [Quadratic; 3];
/// The same with the slopes from an apex.
pub type QuadraticSlopePoint = [SlopeOf<Interval, Quadratic>; 3];
/// A point on a beam piece and its motion along the beam.
pub type JetPoint = [Jet<Affine<3>>; 3];
/// The same with the slopes from an apex.
pub type JetSlopePoint = [SlopeOf<Interval, Jet<Affine<3>>>; 3];

/// A real function of space with its inclusion functions (paper, section 2): everything a renderer may ask of it.
///
/// Tapes implement it; so may a user's own code, for which `range`, `decorated` and `gradient` suffice: the rest follows
/// by the mean value theorem. The law for every method: the answer encloses the true value at every point at which the
/// function is defined; the empty interval says that it is defined nowhere there.
pub trait Inclusion: Send + Sync {
    /// Enclosure of the function over the box: the paper's `F(X, Y, Z)`.
    fn range(&self, region: &Box3, work: &mut Workspace) -> Interval;

    /// The same, and whether the function is proved defined and continuous on the whole box.
    fn decorated(&self, region: &Box3, work: &mut Workspace) -> Decorated;

    /// Enclosures of the function and of its gradient over the box. At kinks: of all generalised gradients.
    fn gradient(&self, region: &Box3, work: &mut Workspace) -> Gradient;

    /// True only if the function is known to be defined and continuous everywhere; then nobody asks for decorations.
    fn continuous_everywhere(&self) -> bool {
        false
    }

    /// The tape that computes this function, if there is one: what a GPU can be told.
    fn as_tape(&self) -> Option<&Tape> {
        None
    }

    /// About how many operations an evaluation takes: searches that may be long are cut short by it.
    fn operations(&self) -> usize {
        1
    }

    /// The same function, prepared for many questions inside a box: with shorter forms for parts of it. `None` where that would
    /// not pay, or nothing is known how.
    fn in_regions(&self, _bounds: &Box3) -> Option<Arc<dyn Inclusion>> {
        None
    }

    /// Value and derivative along a ray.
    fn ray(&self, point: [Dual<1>; 3], work: &mut Workspace) -> Dual<1> {
        let value = mean_value(self, point.map(|x| x.value), work);
        let gradient = self.gradient(&Box3(point.map(|x| x.value.range())), work);
        let derivative = inner_product(gradient.partials, point.map(|x| x.derivative));
        Dual { value, derivative }
    }

    /// The function over a piece of a beam.
    fn beam(&self, point: BeamPoint, work: &mut Workspace) -> Affine<3> {
        mean_value(self, point, work)
    }

    /// [`range`](Self::range) over the boxes of many pieces of rays. Panics unless there are as many answers as questions.
    fn ranges(&self, pieces: &[RayPiece], out: &mut [Interval], work: &mut Workspace) {
        assert_eq!(pieces.len(), out.len(), "as many answers as questions");
        pieces.iter().zip(out).for_each(|(piece, out)| *out = self.range(&piece.region(), work));
    }

    /// [`gradient`](Self::gradient) over many boxes. Panics unless there are as many answers as questions.
    fn gradients(&self, regions: &[Box3], out: &mut [Gradient], work: &mut Workspace) {
        assert_eq!(regions.len(), out.len(), "as many answers as questions");
        regions.iter().zip(out).for_each(|(region, out)| *out = self.gradient(region, work));
    }

    /// [`ray`](Self::ray) over many pieces. Panics unless there are as many answers as questions.
    fn rays(&self, pieces: &[RayPiece], out: &mut [Dual<1>], work: &mut Workspace) {
        assert_eq!(pieces.len(), out.len(), "as many answers as questions");
        pieces.iter().zip(out).for_each(|(piece, out)| *out = self.ray(piece.point(), work));
    }

    /// [`beam`](Self::beam) over many pieces. Panics unless there are as many answers as questions.
    fn beams(&self, pieces: &[FanPiece], out: &mut [Affine<3>], work: &mut Workspace) {
        assert_eq!(pieces.len(), out.len(), "as many answers as questions");
        pieces.iter().zip(out).for_each(|(piece, out)| *out = self.beam(piece.fan.at(piece.t), work));
    }

    /// The slope `g` of `f(P + t D) = f(P) + t g` over a piece of a beam from an apex known to be in an interval box.
    fn beam_slope(&self, point: [Slope<Interval, 3>; 3], work: &mut Workspace) -> Affine<3> {
        mean_slope(self, Box3(point.map(|x| x.apex.hull(x.value.range()))), point.map(|x| x.slope), work)
    }

    /// The function over a piece of a shaft.
    fn shaft(&self, point: ShaftPoint, work: &mut Workspace) -> Affine<5> {
        mean_value(self, point, work)
    }

    /// The slope over a piece of a shaft, whose apex varies with the tile.
    fn shaft_slope(&self, point: ShaftSlopePoint, work: &mut Workspace) -> Affine<5> {
        mean_slope(self, Box3(point.map(|x| x.apex.range().hull(x.value.range()))), point.map(|x| x.slope), work)
    }

    /// The function over a piece of a beam, to second order. By default of first order only.
    fn quadratic(&self, point: QuadraticPoint, work: &mut Workspace) -> Quadratic {
        self.beam(point.map(|x| x.to_affine()), work).into()
    }

    /// The slope over a piece of a beam, to second order. By default of first order only.
    fn quadratic_slope(&self, point: QuadraticSlopePoint, work: &mut Workspace) -> Quadratic {
        let slopes = point.map(|x| Slope { apex: x.apex, value: x.value.to_affine(), slope: x.slope.to_affine() });
        self.beam_slope(slopes, work).into()
    }

    /// The function and its first two derivatives along the rays of a beam piece: both are known only where the function is
    /// proved twice differentiable. By default nothing is known.
    fn jet(&self, _point: JetPoint, _work: &mut Workspace) -> Jet<Affine<3>> {
        Jet::UNKNOWN
    }

    /// The same of the slope.
    fn jet_slope(&self, _point: JetSlopePoint, _work: &mut Workspace) -> Jet<Affine<3>> {
        Jet::UNKNOWN
    }

    /// About the value and two derivatives along a line, rounded: never for proofs. By default difference quotients.
    fn about(&self, point: [PointJet; 3], work: &mut Workspace) -> PointJet {
        super::jet::by_differences(self, point, work)
    }

    /// [`quadratic`](Self::quadratic) over many pieces. Panics unless there are as many answers as questions.
    fn quadratics(&self, points: &[QuadraticPoint], out: &mut [Quadratic], work: &mut Workspace) {
        one_by_one(points, out, |point| self.quadratic(point, work));
    }

    /// [`quadratic_slope`](Self::quadratic_slope) over many pieces. Panics unless there are as many answers as questions.
    fn quadratic_slopes(&self, points: &[QuadraticSlopePoint], out: &mut [Quadratic], work: &mut Workspace) {
        one_by_one(points, out, |point| self.quadratic_slope(point, work));
    }

    /// [`jet`](Self::jet) over many pieces. Panics unless there are as many answers as questions.
    fn jets(&self, points: &[JetPoint], out: &mut [Jet<Affine<3>>], work: &mut Workspace) {
        one_by_one(points, out, |point| self.jet(point, work));
    }

    /// [`jet_slope`](Self::jet_slope) over many pieces. Panics unless there are as many answers as questions.
    fn jet_slopes(&self, points: &[JetSlopePoint], out: &mut [Jet<Affine<3>>], work: &mut Workspace) {
        one_by_one(points, out, |point| self.jet_slope(point, work));
    }

    /// [`shaft`](Self::shaft) over many pieces. Panics unless there are as many answers as questions.
    fn shafts(&self, pieces: &[ShaftPiece], out: &mut [Affine<5>], work: &mut Workspace) {
        one_by_one(pieces, out, |piece| self.shaft(piece.point(), work));
    }

    /// [`shaft_slope`](Self::shaft_slope) over many pieces. Panics unless there are as many answers as questions.
    fn shaft_slopes(&self, pieces: &[ShaftPiece], out: &mut [Affine<5>], work: &mut Workspace) {
        one_by_one(pieces, out, |piece| self.shaft_slope(piece.slopes(), work));
    }

    /// [`about`](Self::about) at many points. Panics unless there are as many answers as questions.
    fn abouts(&self, points: &[[PointJet; 3]], out: &mut [PointJet], work: &mut Workspace) {
        one_by_one(points, out, |point| self.about(point, work));
    }
}

fn one_by_one<Q: Copy, A>(questions: &[Q], out: &mut [A], mut answer: impl FnMut(Q) -> A) {
    assert_eq!(questions.len(), out.len(), "as many answers as questions");
    questions.iter().zip(out).for_each(|(question, out)| *out = answer(*question));
}

/// The mean value form `f(m) + grad f . (X - m)` over a box X with middle m: of second order, where the natural extension
/// is of first. Everything (`ENTIRE`) where f is not proved to be defined and continuous on the box: the theorem speaks
/// of functions that are, along every segment from m. Two or three evaluations.
pub fn centred_range(f: &dyn Inclusion, region: &Box3, work: &mut Workspace) -> Interval {
    if !f.continuous_everywhere() && !f.decorated(region, work).certainly_continuous() {
        return Interval::ENTIRE;
    }
    let mid = region.mid().to_box();
    let centre = f.range(&mid, work);
    centred(region, &mid, centre, f.gradient(region, work).partials)
}

/// The same of a function that is continuous on the box, with its value in the middle and its slopes.
pub(super) fn centred(region: &Box3, mid: &Box3, centre: Interval, slope: [Interval; 3]) -> Interval {
    if slope.iter().any(|s| s.is_empty() || s.magnitude() == f64::INFINITY) {
        return Interval::ENTIRE;
    }
    (0..3).fold(centre, |sum, i| sum + slope[i] * (region[i] - mid[i]))
}

/// `sum g_k d_k` for numbers `g_k` of intervals that may differ from symbol value to symbol value.
fn inner_product<const N: usize>(g: [Interval; 3], d: [Affine<N>; 3]) -> Affine<N> {
    (0..3).fold(Affine::ZERO, |sum, k| sum + d[k].mul_interval(g[k]))
}

/// `f(P + t D) - f(P) = t g . D` with g in the gradient over a box of the whole segment, by the mean value theorem. A jump or
/// a pole on the segment would make that false: unknown unless f is continuous on the box.
fn mean_slope<const N: usize>(
    f: &(impl Inclusion + ?Sized),
    region: Box3,
    direction: [Affine<N>; 3],
    work: &mut Workspace,
) -> Affine<N> {
    if !f.continuous_everywhere() && !f.decorated(&region, work).certainly_continuous() {
        return Affine::UNKNOWN;
    }
    inner_product(f.gradient(&region, work).partials, direction)
}

/// `f(x) = f(m) + g (x - m)` with g in the gradient over the box of all x. Needs f continuous on that (convex) box: it
/// is then Lipschitz along the segment from m to x with its generalised gradients as slopes.
fn mean_value<const N: usize>(f: &(impl Inclusion + ?Sized), x: [Affine<N>; 3], work: &mut Workspace) -> Affine<N> {
    let region = Box3(x.map(|x| x.range()));
    let plain = f.decorated(&region, work);
    if plain.decoration < Decoration::Continuous {
        return Affine::constant(plain.interval);
    }
    let mid = region.mid().to_box();
    let centre = f.range(&mid, work);
    let partials = f.gradient(&region, work).partials;
    let offsets = std::array::from_fn(|k| x[k].add_interval(-mid[k]));
    let form = inner_product(partials, offsets).add_interval(centre);
    let constant = Affine::constant(plain.interval);
    if form.error() <= constant.error() { form } else { constant }
}

impl Inclusion for Tape {
    #[inline]
    fn range(&self, region: &Box3, work: &mut Workspace) -> Interval {
        run(self, region.0, &mut work.intervals)
    }

    fn decorated(&self, region: &Box3, work: &mut Workspace) -> Decorated {
        run(self, region.0.map(Decorated::from), &mut work.decorated)
    }

    fn gradient(&self, region: &Box3, work: &mut Workspace) -> Gradient {
        run(self, Gradient::coordinates(region.0), &mut work.gradients)
    }

    fn continuous_everywhere(&self) -> bool {
        self.is_continuous_everywhere()
    }

    fn as_tape(&self) -> Option<&Tape> {
        Some(self)
    }

    fn operations(&self) -> usize {
        self.clauses().len()
    }

    fn in_regions(&self, bounds: &Box3) -> Option<Arc<dyn Inclusion>> {
        Regions::worth(self, bounds).then(|| Arc::new(Regions::new(self.clone(), bounds)) as Arc<dyn Inclusion>)
    }

    #[inline]
    fn ray(&self, point: [Dual<1>; 3], work: &mut Workspace) -> Dual<1> {
        run(self, point, &mut work.rays)
    }

    #[inline]
    fn beam(&self, point: BeamPoint, work: &mut Workspace) -> Affine<3> {
        run(self, point, &mut work.beams)
    }

    fn ranges(&self, pieces: &[RayPiece], out: &mut [Interval], work: &mut Workspace) {
        assert_eq!(pieces.len(), out.len(), "as many answers as questions");
        let Unasked(rest) = work.batch.ranges(self, pieces, out);
        for k in pieces.len() - rest..pieces.len() {
            out[k] = self.range(&pieces[k].region(), work);
        }
    }

    fn gradients(&self, regions: &[Box3], out: &mut [Gradient], work: &mut Workspace) {
        assert_eq!(regions.len(), out.len(), "as many answers as questions");
        let Unasked(rest) = work.batch.gradients(self, regions, out);
        for k in regions.len() - rest..regions.len() {
            out[k] = self.gradient(&regions[k], work);
        }
    }

    fn rays(&self, pieces: &[RayPiece], out: &mut [Dual<1>], work: &mut Workspace) {
        assert_eq!(pieces.len(), out.len(), "as many answers as questions");
        let Unasked(rest) = work.batch.rays(self, pieces, out);
        for k in pieces.len() - rest..pieces.len() {
            out[k] = self.ray(pieces[k].point(), work);
        }
    }

    fn beams(&self, pieces: &[FanPiece], out: &mut [Affine<3>], work: &mut Workspace) {
        assert_eq!(pieces.len(), out.len(), "as many answers as questions");
        let Unasked(rest) = work.batch.beams(self, pieces, out);
        for k in pieces.len() - rest..pieces.len() {
            out[k] = self.beam(pieces[k].fan.at(pieces[k].t), work);
        }
    }

    #[inline]
    fn beam_slope(&self, point: [Slope<Interval, 3>; 3], work: &mut Workspace) -> Affine<3> {
        run(self, point, &mut work.beam_slopes).slope
    }

    #[inline]
    fn shaft(&self, point: ShaftPoint, work: &mut Workspace) -> Affine<5> {
        run(self, point, &mut work.shafts)
    }

    #[inline]
    fn shaft_slope(&self, point: ShaftSlopePoint, work: &mut Workspace) -> Affine<5> {
        run(self, point, &mut work.shaft_slopes).slope
    }

    #[inline]
    fn quadratic(&self, point: QuadraticPoint, work: &mut Workspace) -> Quadratic {
        run(self, point, &mut work.quadratics)
    }

    #[inline]
    fn quadratic_slope(&self, point: QuadraticSlopePoint, work: &mut Workspace) -> Quadratic {
        run(self, point, &mut work.quadratic_slopes).slope
    }

    fn jet(&self, point: JetPoint, work: &mut Workspace) -> Jet<Affine<3>> {
        run(self, point, &mut work.jets)
    }

    fn jet_slope(&self, point: JetSlopePoint, work: &mut Workspace) -> Jet<Affine<3>> {
        run(self, point, &mut work.jet_slopes).slope
    }

    fn about(&self, point: [PointJet; 3], work: &mut Workspace) -> PointJet {
        run(self, point, &mut work.points)
    }

    fn quadratics(&self, points: &[QuadraticPoint], out: &mut [Quadratic], work: &mut Workspace) {
        let unasked = work.batch.forms().answer(self, points, out, |x| x);
        the_rest(unasked, points, out, |point| self.quadratic(point, work));
    }

    fn quadratic_slopes(&self, points: &[QuadraticSlopePoint], out: &mut [Quadratic], work: &mut Workspace) {
        let unasked = work.batch.forms().answer(self, points, out, |x| x.slope);
        the_rest(unasked, points, out, |point| self.quadratic_slope(point, work));
    }

    fn jets(&self, points: &[JetPoint], out: &mut [Jet<Affine<3>>], work: &mut Workspace) {
        let unasked = work.batch.forms().answer(self, points, out, |x| x);
        the_rest(unasked, points, out, |point| self.jet(point, work));
    }

    fn jet_slopes(&self, points: &[JetSlopePoint], out: &mut [Jet<Affine<3>>], work: &mut Workspace) {
        let unasked = work.batch.forms().answer(self, points, out, |x| x.slope);
        the_rest(unasked, points, out, |point| self.jet_slope(point, work));
    }

    fn shafts(&self, pieces: &[ShaftPiece], out: &mut [Affine<5>], work: &mut Workspace) {
        let unasked = work.batch.forms().shafts(self, pieces, out);
        the_rest(unasked, pieces, out, |piece| self.shaft(piece.point(), work));
    }

    fn shaft_slopes(&self, pieces: &[ShaftPiece], out: &mut [Affine<5>], work: &mut Workspace) {
        let unasked = work.batch.forms().shaft_slopes(self, pieces, out);
        the_rest(unasked, pieces, out, |piece| self.shaft_slope(piece.slopes(), work));
    }

    fn abouts(&self, points: &[[PointJet; 3]], out: &mut [PointJet], work: &mut Workspace) {
        let unasked = work.batch.forms().answer(self, points, out, |x| x);
        the_rest(unasked, points, out, |point| self.about(point, work));
    }
}

/// What batches left over, one by one.
fn the_rest<Q: Copy, A>(Unasked(rest): Unasked, questions: &[Q], out: &mut [A], answer: impl FnMut(Q) -> A) {
    assert_eq!(questions.len(), out.len(), "as many answers as questions");
    let asked = questions.len() - rest;
    one_by_one(&questions[asked..], &mut out[asked..], answer);
}
