//! The tree of regions: which tape answers which question.
use super::policy;
use super::valid::Valid;
use crate::eval::{
    BeamPoint, FanPiece, Gradient, Inclusion, JetPoint, JetSlopePoint, PointJet, QuadraticPoint, QuadraticSlopePoint,
    RayPiece, ShaftPiece, ShaftPoint, ShaftSlopePoint, Workspace,
};
use crate::geom::Box3;
use crate::tape::Tape;
use antumbra_interval::affine::{Affine, Dual, Jet, Slope};
use antumbra_interval::lanes::block::MOST;
use antumbra_interval::quadratic::Quadratic;
use antumbra_interval::{Decorated, Interval};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

/// A tape with shorter ones for parts of space: the same function, the same law, and the same answers for any order of questions
/// and any number of threads, as the tape that answers depends on the question alone.
///
/// Cost: a question goes down a tree of at most a dozen levels. A region's tape is made when it is first asked for, which costs
/// about as much as a few evaluations of its parent's. Memory: the tapes of the regions that were asked for.
#[derive(Debug)]
pub struct Regions {
    whole: Arc<Tape>,
    /// Its region is everywhere, and its tape the whole one.
    root: Node,
}

/// A cell, a cube, and its region, which reaches beyond it so that neighbours overlap.
#[derive(Debug)]
struct Node {
    centre: [f64; 3],
    half: f64,
    level: u32,
    function: Valid,
    /// Operations in the parent's tape.
    above: usize,
    divides: bool,
    children: [OnceLock<Option<Box<Node>>>; 8],
    /// Questions that this region's tape answered.
    asked: AtomicU64,
}

/// What a tree holds and what it has done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RegionCount {
    /// Regions with a tape.
    pub regions: u64,
    /// Operations of the whole tape.
    pub longest: usize,
    /// Operations of the shortest tape.
    pub shortest: usize,
    /// Operations stored in all of them; a tape that a region shares with its parent counts once.
    pub stored: u64,
    /// Questions answered.
    pub questions: u64,
    /// Operations executed to answer them.
    pub operations: u64,
    /// Operations executed, on decorated intervals, to find the tapes.
    pub preparation: u64,
}

impl Regions {
    /// Whether a tree pays for a tape and a box of interest.
    #[must_use]
    pub fn worth(tape: &Tape, bounds: &Box3) -> bool {
        bounds.0.iter().all(|side| !side.is_empty() && side.magnitude() < 1e150) && policy::worth(tape)
    }

    /// A tree for a function of interest in and around the bounds; outside, the tape itself answers.
    #[must_use]
    pub fn new(tape: Tape, bounds: &Box3) -> Self {
        let half = bounds.half_extent().0.into_iter().fold(f64::MIN_POSITIVE, f64::max);
        let whole = Arc::new(tape);
        let root = Node {
            centre: bounds.mid().0,
            half,
            level: 0,
            function: Valid::everywhere(whole.clone()),
            above: whole.clauses().len(),
            divides: true,
            children: Default::default(),
            asked: AtomicU64::new(0),
        };
        Self { whole, root }
    }

    /// The tape that answers a question about points of a box.
    #[inline]
    fn tape(&self, question: &Box3) -> &Tape {
        let (mut tape, mut node) = (&*self.whole, &self.root);
        let centre = question.mid().0;
        while let Some(child) = node.child(centre)
            && let Some(shorter) = child.function.on(question)
        {
            (tape, node) = (shorter, child);
        }
        node.asked.fetch_add(1, Ordering::Relaxed);
        tape
    }

    /// Many questions: those that one tape answers together.
    fn ask_all<Q: Copy, A: Copy>(
        &self,
        questions: &[Q],
        out: &mut [A],
        region: impl Fn(&Q) -> Box3,
        mut ask: impl FnMut(&Tape, &[Q], &mut [A]),
    ) {
        assert_eq!(questions.len(), out.len(), "as many answers as questions");
        for (questions, out) in questions.chunks(MOST).zip(out.chunks_mut(MOST)) {
            let mut tapes = [&*self.whole; MOST];
            for (tape, question) in tapes.iter_mut().zip(questions) {
                *tape = self.tape(&region(question));
            }
            let tapes = &tapes[..questions.len()];
            if tapes.iter().all(|tape| std::ptr::eq(*tape, tapes[0])) {
                ask(tapes[0], questions, out);
                continue;
            }
            let (mut answered, mut places) = ([false; MOST], [0; MOST]);
            let (mut some, mut answers) = ([questions[0]; MOST], [out[0]; MOST]);
            for first in 0..questions.len() {
                let mut n = 0;
                for k in first..questions.len() {
                    if !answered[k] && std::ptr::eq(tapes[k], tapes[first]) {
                        (answered[k], places[n], some[n]) = (true, k, questions[k]);
                        n += 1;
                    }
                }
                if n > 0 {
                    ask(tapes[first], &some[..n], &mut answers[..n]);
                    places[..n].iter().zip(&answers).for_each(|(place, answer)| out[*place] = *answer);
                }
            }
        }
    }

    /// What the tree holds and what it has done so far.
    #[must_use]
    pub fn count(&self) -> RegionCount {
        let longest = self.whole.clauses().len();
        let mut count = RegionCount { longest, shortest: longest, ..RegionCount::default() };
        let mut stack = vec![&self.root];
        while let Some(node) = stack.pop() {
            let (length, asked) = (node.function.length(), node.asked.load(Ordering::Relaxed));
            count.regions += 1;
            count.shortest = count.shortest.min(length);
            if length < node.above || node.level == 0 {
                count.stored += length as u64;
            }
            count.questions += asked;
            count.operations += asked * length as u64;
            if node.level > 0 {
                count.preparation += node.above as u64;
            }
            stack.extend(node.children.iter().filter_map(|c| c.get()?.as_deref()));
        }
        count
    }
}

impl Node {
    /// The region of the child in whose cell the point lies; `None` if there is no better one.
    fn child(&self, at: [f64; 3]) -> Option<&Self> {
        if !self.divides {
            return None;
        }
        let upper: [bool; 3] = std::array::from_fn(|k| at[k] > self.centre[k]);
        let index = upper.iter().enumerate().fold(0, |sum, (k, upper)| sum + (usize::from(*upper) << k));
        self.children[index].get_or_init(|| self.make(upper).map(Box::new)).as_deref()
    }

    fn make(&self, upper: [bool; 3]) -> Option<Self> {
        let half = 0.5 * self.half;
        let centre: [f64; 3] = std::array::from_fn(|k| self.centre[k] + if upper[k] { half } else { -half });
        // Twice the overlap, as it is counted in sides. Whatever these numbers are, the region is what they say.
        let reach = half * (1.0 + 2.0 * policy::OVERLAP);
        let side = |k: usize| Interval::try_new(centre[k] - reach, centre[k] + reach).unwrap_or(Interval::EMPTY);
        let region = Box3(std::array::from_fn(side));
        let function = self.function.shortened(&region, &mut Vec::new())?;
        let (level, above) = (self.level + 1, self.function.length());
        let divides = function.judged(|tape| policy::divides(tape, level, [above, self.above]));
        let (children, asked) = (Default::default(), AtomicU64::new(0));
        Some(Self { centre, half, level, function, above, divides, children, asked })
    }
}

impl Inclusion for Regions {
    fn as_tape(&self) -> Option<&Tape> {
        Some(&self.whole)
    }

    fn range(&self, region: &Box3, work: &mut Workspace) -> Interval {
        self.tape(region).range(region, work)
    }

    fn decorated(&self, region: &Box3, work: &mut Workspace) -> Decorated {
        self.tape(region).decorated(region, work)
    }

    fn gradient(&self, region: &Box3, work: &mut Workspace) -> Gradient {
        self.tape(region).gradient(region, work)
    }

    fn ranges(&self, pieces: &[RayPiece], out: &mut [Interval], work: &mut Workspace) {
        self.ask_all(pieces, out, RayPiece::region, |tape, pieces, out| tape.ranges(pieces, out, work));
    }

    fn gradients(&self, regions: &[Box3], out: &mut [Gradient], work: &mut Workspace) {
        self.ask_all(regions, out, |region| *region, |tape, regions, out| tape.gradients(regions, out, work));
    }

    fn rays(&self, pieces: &[RayPiece], out: &mut [Dual<1>], work: &mut Workspace) {
        let region = |piece: &RayPiece| Box3(piece.point().map(|x| x.value.range()));
        self.ask_all(pieces, out, region, |tape, pieces, out| tape.rays(pieces, out, work));
    }

    fn beams(&self, pieces: &[FanPiece], out: &mut [Affine<3>], work: &mut Workspace) {
        let region = |piece: &FanPiece| Box3(piece.fan.at(piece.t).map(|x| x.range()));
        self.ask_all(pieces, out, region, |tape, pieces, out| tape.beams(pieces, out, work));
    }

    fn continuous_everywhere(&self) -> bool {
        self.whole.is_continuous_everywhere()
    }

    fn operations(&self) -> usize {
        self.whole.clauses().len()
    }

    fn ray(&self, point: [Dual<1>; 3], work: &mut Workspace) -> Dual<1> {
        self.tape(&Box3(point.map(|x| x.value.range()))).ray(point, work)
    }

    fn beam(&self, point: BeamPoint, work: &mut Workspace) -> Affine<3> {
        self.tape(&Box3(point.map(|x| x.range()))).beam(point, work)
    }

    // Slopes compare the values at two points: both belong to the question. What lies between them does not, but the regions
    // are convex.
    fn beam_slope(&self, point: [Slope<Interval, 3>; 3], work: &mut Workspace) -> Affine<3> {
        self.tape(&Box3(point.map(|x| x.apex.hull(x.value.range())))).beam_slope(point, work)
    }

    fn shaft(&self, point: ShaftPoint, work: &mut Workspace) -> Affine<5> {
        self.tape(&Box3(point.map(|x| x.range()))).shaft(point, work)
    }

    fn shaft_slope(&self, point: ShaftSlopePoint, work: &mut Workspace) -> Affine<5> {
        self.tape(&Box3(point.map(|x| x.apex.range().hull(x.value.range())))).shaft_slope(point, work)
    }

    fn quadratic(&self, point: QuadraticPoint, work: &mut Workspace) -> Quadratic {
        self.tape(&Box3(point.map(|x| x.range()))).quadratic(point, work)
    }

    fn quadratic_slope(&self, point: QuadraticSlopePoint, work: &mut Workspace) -> Quadratic {
        self.tape(&Box3(point.map(|x| x.apex.hull(x.value.range())))).quadratic_slope(point, work)
    }

    fn jet(&self, point: JetPoint, work: &mut Workspace) -> Jet<Affine<3>> {
        self.tape(&Box3(point.map(|x| x.value.range()))).jet(point, work)
    }

    fn jet_slope(&self, point: JetSlopePoint, work: &mut Workspace) -> Jet<Affine<3>> {
        self.tape(&Box3(point.map(|x| x.apex.hull(x.value.range())))).jet_slope(point, work)
    }

    fn about(&self, point: [PointJet; 3], work: &mut Workspace) -> PointJet {
        self.tape(&around(&point)).about(point, work)
    }

    fn quadratics(&self, points: &[QuadraticPoint], out: &mut [Quadratic], work: &mut Workspace) {
        let region = |point: &QuadraticPoint| Box3(point.map(|x| x.range()));
        self.ask_all(points, out, region, |tape, points, out| tape.quadratics(points, out, work));
    }

    fn quadratic_slopes(&self, points: &[QuadraticSlopePoint], out: &mut [Quadratic], work: &mut Workspace) {
        let region = |point: &QuadraticSlopePoint| Box3(point.map(|x| x.apex.hull(x.value.range())));
        self.ask_all(points, out, region, |tape, points, out| tape.quadratic_slopes(points, out, work));
    }

    fn jets(&self, points: &[JetPoint], out: &mut [Jet<Affine<3>>], work: &mut Workspace) {
        let region = |point: &JetPoint| Box3(point.map(|x| x.value.range()));
        self.ask_all(points, out, region, |tape, points, out| tape.jets(points, out, work));
    }

    fn jet_slopes(&self, points: &[JetSlopePoint], out: &mut [Jet<Affine<3>>], work: &mut Workspace) {
        let region = |point: &JetSlopePoint| Box3(point.map(|x| x.apex.hull(x.value.range())));
        self.ask_all(points, out, region, |tape, points, out| tape.jet_slopes(points, out, work));
    }

    fn shafts(&self, pieces: &[ShaftPiece], out: &mut [Affine<5>], work: &mut Workspace) {
        let region = |piece: &ShaftPiece| Box3(piece.point().map(|x| x.range()));
        self.ask_all(pieces, out, region, |tape, pieces, out| tape.shafts(pieces, out, work));
    }

    fn shaft_slopes(&self, pieces: &[ShaftPiece], out: &mut [Affine<5>], work: &mut Workspace) {
        let region = |piece: &ShaftPiece| Box3(piece.slopes().map(|x| x.apex.range().hull(x.value.range())));
        self.ask_all(pieces, out, region, |tape, pieces, out| tape.shaft_slopes(pieces, out, work));
    }

    fn abouts(&self, points: &[[PointJet; 3]], out: &mut [PointJet], work: &mut Workspace) {
        self.ask_all(points, out, around, |tape, points, out| tape.abouts(points, out, work));
    }
}

/// The point itself: rounded numbers, which prove nothing, so any tape would do.
fn around(point: &[PointJet; 3]) -> Box3 {
    Box3(point.map(|x| Interval::try_new(x.value, x.value).unwrap_or(Interval::EMPTY)))
}
