//! Slabs of shadow beams between two sheets, and the function over them.
use super::super::desk::Desk;
use super::super::rectangle::Query;
use super::policy::{Extent, Shape};
use crate::eval::{PointJet, Workspace};
use crate::geom::{Box3, Fan, Leaving, Passage, Sheet};
use crate::trace::{Cost, Sign};
use antumbra_interval::Interval;
use antumbra_interval::affine::{Affine, Jet, SlopeOf};
use antumbra_interval::quadratic::Quadratic;
use smallvec::SmallVec;
use std::cell::OnceCell;

/// Which function of t is looked at: f itself, or the slope g with `f = t g`, for the surface that was hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Plain,
    Slope,
}

/// What is known of a slab.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum State {
    /// Nothing.
    Open,
    /// It lies beside the least value: not worth a search.
    Outer,
    /// It is a core in which the function is proved convex.
    Convex(Convexity),
}

/// What is proved of a slab on all rays of a cell, hence of its parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Convexity {
    pub(super) kind: Kind,
    /// `g''/2` is at least this, which is at least 0, for the function `g` of this kind throughout the slab.
    pub(super) bend: f64,
    /// About the place of the least value.
    pub(super) least_at: Sheet,
}

/// The parameters `lo(u, v) <= t <= hi(u, v)` of one surface: none where the sheets cross.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Slab {
    pub(super) surface: usize,
    pub(super) lo: Sheet,
    pub(super) hi: Sheet,
    pub(super) state: State,
}

/// What is known of a surface on all rays to the light.
#[derive(Clone, Copy, Debug)]
pub(in crate::shadow) struct Way {
    /// The parameter up to which it is proved continuous.
    pub(super) reach: f64,
    /// Where the rays pass its region.
    pub(super) passage: Passage,
}

/// How the rays of a cell pass the region of a surface.
struct Sight {
    passage: Passage,
    /// If the clip cuts the surface, and all rays begin inside of it: where they leave it.
    leaving: Option<Leaving>,
}

/// A rectangle of the light, seen from one hit.
pub(super) struct Cell<'a> {
    pub(super) query: &'a Query<'a>,
    pub(super) part: [Interval; 2],
    pub(super) shape: Shape,
    /// The parameters u and v of the light, as forms.
    symbols: [Affine<3>; 2],
    fan: Fan,
    /// For each surface.
    ways: &'a [Way],
    /// For each surface of which that does not say enough.
    sights: SmallVec<[OnceCell<Box<Sight>>; 2]>,
}

impl<'a> Cell<'a> {
    pub(super) fn new(query: &'a Query<'a>, ways: &'a [Way], part: [Interval; 2]) -> Self {
        Self {
            query,
            part,
            shape: Shape::of(query.light, query.receiver.point.mid(), part),
            symbols: [Affine::spanning(1, part[0]), Affine::spanning(2, part[1])],
            fan: Fan::towards(query.receiver.point, query.light, part[0], part[1]),
            ways,
            sights: ways.iter().map(|_| OnceCell::new()).collect(),
        }
    }

    fn sight(&self, surface: usize) -> &Sight {
        self.sights[surface].get_or_init(|| {
            let at = &self.query.surfaces[surface];
            let passage = at.passage(&self.fan.apex, &self.fan.directions());
            let cuts = at.region == at.clip && passage.inner.contains(0.0);
            let leaving = if cuts { at.clip.leaving(&self.fan, &self.symbols) } else { None };
            Box::new(Sight { passage, leaving })
        })
    }

    pub(super) fn extent(&self, slab: &Slab) -> Extent {
        self.shape.extent(&slab.lo, &slab.hi)
    }

    /// What of a slab is inside the surface's region: beyond it nothing occludes. `None` if nothing is.
    ///
    /// A parameter of the slab that is not beyond the region on every ray lies in `outer`, so it may be cut off at the ends of
    /// that; and below the sheet beyond which no ray is inside: if the slab's sheets are in order, what it has inside is
    /// between its lower sheet and that one. That pays only where the clip cuts the surface: elsewhere it would but tilt the
    /// sheets. A convex slab must not grow: it is cut only by a sheet that is proved to lie in it on all rays.
    ///
    /// What is inside on all rays to the light is so on those to a part of it: then nothing is to be cut off.
    pub(super) fn clipped(&self, slab: &Slab) -> Option<Slab> {
        let Way { passage, .. } = &self.ways[slab.surface];
        let t = slab.lo.range(self.part).hull(slab.hi.range(self.part));
        let at = &self.query.surfaces[slab.surface];
        if at.region != at.clip {
            return t.possibly_intersects(passage.outer).then_some(*slab);
        }
        if t.is_subset_of(passage.inner) {
            return Some(*slab);
        }
        let Sight { passage: Passage { outer, .. }, leaving } = self.sight(slab.surface);
        if !t.possibly_intersects(*outer) {
            return None;
        }
        let (lo, hi) = (Sheet::level(outer.lo()), Sheet::level(outer.hi()));
        let mut inside = *slab;
        if !matches!(slab.state, State::Convex(_)) {
            if slab.lo.certainly_at_most(&lo, self.part) {
                inside.lo = lo;
            }
            if outer.hi() < f64::INFINITY && hi.certainly_at_most(&slab.hi, self.part) {
                inside.hi = hi;
            }
        }
        if let Some(Leaving { outer, .. }) = leaving {
            let proved = |a: &Sheet, b: &Sheet| a.certainly_at_most(b, self.part);
            let pays = match slab.state {
                State::Convex(_) => proved(&slab.lo, outer) && proved(outer, &slab.hi),
                _ => proved(&slab.lo, &slab.hi) && self.shape.above(&inside.hi, outer, 0.0),
            };
            if pays {
                inside.hi = *outer;
            }
        }
        Some(inside)
    }

    /// The kind of function that suits a slab.
    pub(super) fn kind(&self, slab: &Slab) -> Kind {
        let own = slab.surface == self.query.receiver.surface;
        if own && self.extent(slab).slope_pays() { Kind::Slope } else { Kind::Plain }
    }

    /// Whether the function is to be taken with the opposite sign, so that it is positive at the front.
    fn negative(&self, surface: usize) -> bool {
        self.query.fronts[surface].is_some_and(|f| f.sign == Sign::Negative)
    }

    /// Whether a negative value at any parameter of the slab, on a ray, proves that the ray is hidden: it must lie between
    /// the front and the light, inside the region together with the front, on all rays, and where f has been proved
    /// continuous from the apex on. (Regions are convex: what is inside at the apex and at the sheet where rays leave is so in
    /// between.)
    pub(super) fn inside(&self, slab: &Slab) -> bool {
        let t = slab.lo.range(self.part).hull(slab.hi.range(self.part));
        let way = &self.ways[slab.surface];
        let before =
            |sheet: &Sheet| slab.lo.certainly_at_most(sheet, self.part) && slab.hi.certainly_at_most(sheet, self.part);
        let in_region = || {
            t.is_subset_of(way.passage.inner)
                || t.is_subset_of(self.sight(slab.surface).passage.inner)
                || self.last_inside(slab.surface).is_some_and(before)
        };
        self.query.fronts[slab.surface].is_some_and(|front| {
            front.at <= t.lo() && t.hi() <= way.reach && t.is_subset_of(Interval::new(0.0, 1.0)) && in_region()
        })
    }

    /// A sheet up to which all rays are inside the region of a surface that the clip cuts.
    pub(super) fn last_inside(&self, surface: usize) -> Option<&Sheet> {
        self.sight(surface).leaving.as_ref().and_then(|leaving| leaving.inner.as_ref())
    }

    /// The points of the slab, `s` running from one sheet to the other.
    ///
    /// With `A = (lo + hi)/2`, `B = (hi - lo)/2`: `t = A + B s` takes every value in between. Parallel sheets have a constant
    /// `B`: then t is affine and `P + t D` has degree 2, so nothing is lost.
    fn points(&self, slab: &Slab) -> [Quadratic; 3] {
        let apex = &self.fan.apex;
        let s = Affine::symbol(0);
        if slab.lo.slopes == slab.hi.slopes {
            let t = if slab.lo.k == slab.hi.k {
                slab.lo.form(&self.symbols)
            } else {
                let (lo, hi) = (Interval::point(slab.lo.k), Interval::point(slab.hi.k));
                let [mean, half] = [lo + hi, hi - lo].map(|k| k * Interval::point(0.5));
                slab.lo.tilt(&self.symbols).add_interval(mean) + s.mul_interval(half)
            };
            // No from_fn here and below: its closures are not always inlined.
            let at = |k: usize| Quadratic::product_of(&t, &self.fan.direction[k]).add_interval(apex[k]);
            [at(0), at(1), at(2)]
        } else {
            let (lo, hi) = (slab.lo.form(&self.symbols), slab.hi.form(&self.symbols));
            let (mean, half) = ((lo + hi).mul_f64(0.5), (hi - lo).mul_f64(0.5));
            let t = Quadratic::from(mean) + Quadratic::product_of(&half, &s);
            let at = |k: usize| (t * Quadratic::from(self.fan.direction[k])).add_interval(apex[k]);
            [at(0), at(1), at(2)]
        }
    }

    /// The function over the slab, positive at the front.
    pub(super) async fn form(&self, slab: &Slab, kind: Kind, desk: &Desk<'_>, cost: &mut Cost) -> Quadratic {
        cost.evaluations += 1;
        let points = self.points(slab);
        let [form] = match kind {
            Kind::Plain => desk.ask(slab.surface, [points]).await,
            Kind::Slope => {
                let at = |k: usize| SlopeOf {
                    apex: self.fan.apex[k],
                    value: points[k],
                    slope: Quadratic::from(self.fan.direction[k]),
                };
                desk.ask(slab.surface, [[at(0), at(1), at(2)]]).await
            }
        };
        if self.negative(slab.surface) { -form } else { form }
    }

    /// A lower bound of `g''/2` throughout the slab, on every ray of the cell, if that proves `g` convex in t there.
    pub(super) async fn bend(&self, slab: &Slab, kind: Kind, desk: &Desk<'_>, cost: &mut Cost) -> Option<f64> {
        let jet = self.jet(slab, kind, desk, cost).await;
        let bend = jet.second.range();
        (jet.first.is_known() && !bend.is_empty() && bend.lo() >= 0.0).then(|| bend.lo())
    }

    /// Encloses `g'` on a sheet, on every ray of the cell.
    pub(super) async fn slope(&self, level: &Slab, kind: Kind, desk: &Desk<'_>, cost: &mut Cost) -> Interval {
        let jet = self.jet(level, kind, desk, cost).await;
        if jet.second.is_known() { jet.first.range() } else { Interval::ENTIRE }
    }

    /// The function over the slab, positive at the front, with its derivatives by t.
    ///
    /// `t = A + B s` with the largest `B` covers the slab.
    async fn jet(&self, slab: &Slab, kind: Kind, desk: &Desk<'_>, cost: &mut Cost) -> Jet<Affine<3>> {
        cost.evaluations += 1;
        let (lo, hi) = (slab.lo.form(&self.symbols), slab.hi.form(&self.symbols));
        let t = if slab.lo == slab.hi {
            lo
        } else {
            let reach = (hi - lo).mul_f64(0.5).range().magnitude();
            (lo + hi).mul_f64(0.5) + Affine::symbol(0).mul_f64(reach)
        };
        let direction = &self.fan.direction;
        let at = |k: usize| Jet::line((t * direction[k]).add_interval(self.fan.apex[k]), direction[k]);
        let points: [Jet<Affine<3>>; 3] = [at(0), at(1), at(2)];
        let [jet] = match kind {
            Kind::Plain => desk.ask(slab.surface, [points]).await,
            Kind::Slope => {
                let at = |k: usize| SlopeOf {
                    apex: self.fan.apex[k],
                    value: points[k],
                    slope: Jet::line(direction[k], Affine::ZERO),
                };
                desk.ask(slab.surface, [[at(0), at(1), at(2)]]).await
            }
        };
        if self.negative(slab.surface) { -jet } else { jet }
    }

    /// Whether plain intervals prove the slab free.
    pub(super) fn certainly_free(&self, slab: &Slab, work: &mut Workspace, cost: &mut Cost) -> bool {
        let t = slab.lo.range(self.part).hull(slab.hi.range(self.part));
        if t.lo() <= 0.0 {
            return false;
        }
        cost.evaluations += 1;
        let directions = self.fan.directions();
        let region = Box3(std::array::from_fn(|k| self.fan.apex[k] + t * directions[k]));
        let range = self.query.surfaces[slab.surface].function.range(&region, work);
        let range = if self.negative(slab.surface) { -range } else { range };
        range.certainly_positive()
    }
}

/// About the function of a kind on rays of a cell, and its derivatives by t: for choices only.
pub(super) struct Looker<'a, 'd> {
    pub(super) cell: &'a Cell<'a>,
    pub(super) surface: usize,
    pub(super) kind: Kind,
    pub(super) desk: &'a Desk<'d>,
}

impl Looker<'_, '_> {
    /// On the rays to the places `(u, v)`, at `t`.
    pub(super) async fn at<const K: usize>(&self, places: [[f64; 2]; K], t: f64) -> [PointJet; K] {
        let Self { cell, surface, kind, desk } = *self;
        let t = super::policy::apart(kind, t);
        let jets = desk.ask(surface, places.map(|at| cell.shape.line(at, t))).await;
        jets.map(|jet| super::policy::seen_from_front(jet, kind, t, cell.negative(surface)))
    }
}

/// One slab that holds all parameters of both, over the cell: sheets parallel to those of the first.
pub(super) fn merged(a: &Slab, b: &Slab, part: [Interval; 2]) -> Slab {
    let (below, above) = (b.lo.below(a.lo.slopes, part), b.hi.above(a.hi.slopes, part));
    let lo = if below.k < a.lo.k { below } else { a.lo };
    let hi = if above.k > a.hi.k { above } else { a.hi };
    Slab { surface: a.surface, lo, hi, state: State::Outer }
}
