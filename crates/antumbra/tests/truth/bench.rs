//! A bench for the function under test: surfaces from text, a receiver, a light, a bracket.
use super::exact::exact;
use antumbra::eval::Workspace;
use antumbra::geom::{Clip, Rect, Vec3};
use antumbra::scene::Object;
use antumbra::shadow::{Bracket, Known, Penumbra, Receiver, Scratch, Tolerance, visible};
use antumbra::trace::{Cost, Sign, Surface};
use num_rational::BigRational;
use num_traits::ToPrimitive;

/// The tolerances at which every oracle is asked.
pub(crate) const WIDTHS: [f64; 2] = [1.0 / 255.0, 1.0 / 4096.0];

/// Objects; the first one is the receiver's.
pub(crate) struct Bench {
    objects: Vec<Object>,
}

impl Bench {
    pub(crate) fn new(texts: &[&str]) -> Self {
        let object = |text: &&str| Object::parse(text, Clip::Everywhere).unwrap_or_else(|e| panic!("{text}: {e}"));
        Self { objects: texts.iter().map(object).collect() }
    }

    /// The sign of the first surface's function at a point on the viewer's side: rewriting may change it.
    fn side(&self, towards: Vec3) -> Sign {
        let mut work = Workspace::default();
        Sign::of(self.objects[0].surface.range(&towards.to_box(), &mut work)).expect("off the surface")
    }

    /// The bracket at a point on the first surface, which is looked at from `towards`.
    pub(crate) fn ask(&self, at: Vec3, towards: Vec3, light: &Rect, width: f64, rectangles: u32) -> Bracket {
        let surfaces: Vec<Surface<'_>> = self
            .objects
            .iter()
            .map(|o| Surface { function: o.surface.as_ref(), clip: o.clip(), region: o.region() })
            .collect();
        let receiver = Receiver { point: at.to_box(), surface: 0, side: self.side(towards) };
        let tolerance = Tolerance { width, rectangles, penumbra: Penumbra::default() };
        let (mut scratch, mut work, mut cost) = (Scratch::default(), Workspace::default(), Cost::default());
        visible(&surfaces, &receiver, light, &Known::nothing(&surfaces), tolerance, &mut scratch, &mut work, &mut cost)
    }

    /// Asks at both tolerances: each bracket must meet the enclosure `[truth.0, truth.1]` and be as narrow as asked for.
    #[track_caller]
    pub(crate) fn expect(&self, at: Vec3, towards: Vec3, light: &Rect, truth: &(BigRational, BigRational)) {
        self.expect_within(1.0, at, towards, light, truth);
    }

    /// The same, if the budget may end the search at `factor` times the width asked for.
    #[track_caller]
    pub(crate) fn expect_within(
        &self,
        factor: f64,
        at: Vec3,
        towards: Vec3,
        light: &Rect,
        truth: &(BigRational, BigRational),
    ) {
        for width in WIDTHS {
            let b = self.ask(at, towards, light, width, 50_000);
            let what = || format!("{:?} at {at:?}: {b:?}", self.objects);
            assert!(holds(&b, truth), "{} misses {:?} .. {:?}", what(), truth.0.to_f64(), truth.1.to_f64());
            assert!(b.hi - b.lo <= factor * width, "{} is wider than {factor} x {width}", what());
            assert_eq!(b.reason.is_some(), b.hi - b.lo > width, "{}", what());
        }
    }
}

/// Whether the bracket can hold the truth, of which an enclosure is known.
pub(crate) fn holds(b: &Bracket, (lo, hi): &(BigRational, BigRational)) -> bool {
    exact(b.lo) <= *hi && exact(b.hi) >= *lo
}
