//! Where to look and where to cut: choices that cost or save time and never touch a proof.
#![allow(clippy::float_arithmetic, reason = "choices of where to cut, never a proof")]
use super::slab::{Kind, Looker};
use crate::eval::PointJet;
use crate::geom::strips::{Band, Curve};
use crate::geom::{Rect, Sheet, Vec3};
use crate::shadow::Penumbra;
use antumbra_interval::Interval;
use antumbra_interval::quadratic::Paraboloid;

/// Half thickness of the main slab, in widths of the cell.
const MAIN: f64 = 1.0;
/// Half thicknesses of cores that may be convex, in widths of the cell; first the whole slab.
pub(super) const CORES: [Option<f64>; 3] = [None, Some(8.0), Some(3.0)];
/// A core is taken if its least bend is at least this part of the bend at the least value.
const BEND: f64 = 0.25;
/// A slab is short if its half length is at most this many widths.
const SHORT: f64 = 2.1;
/// Widths grow along the beam as t, but count at least as at this t.
const NEAR: f64 = 0.1;
/// The slope form is used where `lo <= SLOPE hi`, or `hi < CLOSE`.
const SLOPE: f64 = 0.3;
const CLOSE: f64 = 0.15;
/// No slab is cut below this length, ...
const SHORTEST: f64 = 1e-9;
/// ... nor after so many evaluations in one cell.
const MOST: u64 = 400;
/// A band is cropped if its width is at most this part of the cell's 2.
const CROP: f64 = 1.3;
/// A core follows the least value by at most so many widths from the middle of the cell to its edge: the covers of what lies beside it
/// grow with its tilt. Twice as much costs 5 % more evaluations on the Kusner-Schmitt surface, half as much 2 %, none 20 to 30 %.
const TILT: f64 = 1.0;
/// The sheet in it follows the least value where it can: what that moves beside the sheet widens the bracket.
const STEEP: f64 = 16.0;
/// Newton steps on the middle ray.
const STEPS: usize = 7;
/// Cells that certainty may take where the bracket is narrow already.
const CERTAIN: u32 = 9;
/// Evaluations for one hit after which planes get their chance, at a tolerance of 1/255.
const FAIR: f64 = 4000.0;

/// Most hits that are looked at together: enough to fill lanes with each kind of question, few enough to stay in a cache.
const COMPANY: usize = 64;
/// How many join when the method has settled one.
const JOIN: usize = 4;

/// Sizes of a cell, in plain numbers.
pub(super) struct Shape {
    apex: Vec3,
    light: Rect,
    centre: [f64; 2],
    half: [f64; 2],
    /// Length of the middle ray.
    distance: f64,
    /// Half the longer edge, on the light.
    width: f64,
}

/// Begin and end of a slab on the middle ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub(super) lo: f64,
    pub(super) hi: f64,
}

impl Extent {
    pub(super) fn slope_pays(self) -> bool {
        self.lo <= SLOPE * self.hi || self.hi < CLOSE
    }

    pub(super) fn middle(self) -> f64 {
        0.5 * (self.lo + self.hi)
    }
}

fn at(sheet: &Sheet, [u, v]: [f64; 2]) -> f64 {
    sheet.k + sheet.slopes[0] * u + sheet.slopes[1] * v
}

impl Shape {
    pub(super) fn of(light: &Rect, apex: Vec3, part: [Interval; 2]) -> Self {
        let centre = part.map(|r| r.mid());
        let half = part.map(|r| 0.5 * (r.hi() - r.lo()));
        let distance = (light.point(centre[0], centre[1]) - apex).length();
        let width = (half[0] * light.edge_u.length()).max(half[1] * light.edge_v.length());
        Self { apex, light: *light, centre, half, distance, width }
    }

    pub(super) fn extent(&self, lo: &Sheet, hi: &Sheet) -> Extent {
        Extent { lo: at(lo, self.centre), hi: at(hi, self.centre) }
    }

    /// Half width of the beam at t, in units of t.
    fn lateral(&self, t: f64) -> f64 {
        self.width * t.max(NEAR) / self.distance
    }

    pub(super) fn short(&self, x: Extent) -> bool {
        0.5 * (x.hi - x.lo) <= (SHORT * self.lateral(x.middle())).max(SHORTEST)
    }

    /// Whether a slab beside the main one is to be cut in two, after so many evaluations in this cell.
    pub(super) fn long(&self, x: Extent, evaluations: u64) -> bool {
        !self.short(x) && evaluations < MOST
    }

    /// The point at t on the ray to `(u, v)`, moving with t.
    pub(super) fn line(&self, [u, v]: [f64; 2], t: f64) -> [PointJet; 3] {
        let d = self.light.point(u, v) - self.apex;
        std::array::from_fn(|k| PointJet { value: self.apex[k] + t * d[k], first: d[k], second: 0.0 })
    }

    /// About the place of the least value between two sheets, and how it moves across the cell. `about` gives values on
    /// rays.
    pub(super) async fn plan(&self, lo: &Sheet, hi: &Sheet, start: Option<&Sheet>, about: &Looker<'_, '_>) -> Plan {
        let Extent { lo: first, hi: last } = self.extent(lo, hi);
        let length = last - first;
        let (mut t, mut a, mut b) = (0.5 * (first + last), first, last);
        if let Some(sheet) = start {
            t = at(sheet, self.centre).max(first).min(last);
        }
        let mut g = PointJet::default();
        let mut found = false;
        for _ in 0..STEPS {
            [g] = about.at([self.centre], t).await;
            if g.first > 0.0 {
                b = t
            } else {
                a = t
            }
            let mut next = if g.second > 0.0 {
                t - 0.5 * g.first / g.second
            } else if g.first > 0.0 {
                0.5 * (a + t)
            } else {
                0.5 * (b + t)
            };
            if next <= a || next.is_nan() {
                next = if t - a > 0.3 * length { 0.5 * (a + t) } else { a };
            }
            if next >= b || next.is_nan() {
                next = if b - t > 0.3 * length { 0.5 * (b + t) } else { b };
            }
            let moved = (next - t).abs();
            t = next;
            if moved < 0.05 * self.lateral(t) {
                found = true;
                break;
            }
        }
        let width = MAIN * self.lateral(t);
        let (mut slopes, mut steep) = ([0.0; 2], [0.0; 2]);
        if found && g.second > 0.0 && t > first + 0.05 * width && t < last - 0.05 * width {
            let beside = |k: usize, d: f64| {
                let mut place = self.centre;
                place[k] += d * self.half[k];
                place
            };
            let places = [beside(0, 0.5), beside(0, -0.5), beside(1, 0.5), beside(1, -0.5)];
            let around = about.at(places, t).await.map(|g| g.first);
            for k in 0..2 {
                let slope = -(around[2 * k] - around[2 * k + 1]) / (2.0 * g.second * self.half[k]);
                let at_most = |widths: f64| {
                    let most = widths * width / self.half[k];
                    if slope.is_finite() { slope.max(-most).min(most) } else { 0.0 }
                };
                (slopes[k], steep[k]) = (at_most(TILT), at_most(STEEP));
            }
            // The covers of the inherited sheets must stay between hit and light.
            let over = |sheet: &Sheet| {
                (0..2).map(|k| ((sheet.slopes[k] - slopes[k]).abs() + slopes[k].abs()) * self.half[k]).sum::<f64>()
            };
            if first - over(lo) < 0.0 || last + over(hi) > 1.0 {
                (slopes, steep) = ([0.0; 2], [0.0; 2]);
            }
        }
        // At an end it follows that.
        if t >= last - 0.05 * width {
            (slopes, steep) = (hi.slopes, hi.slopes);
        } else if t <= first + 0.05 * width {
            (slopes, steep) = (lo.slopes, lo.slopes);
        }
        let through =
            |slopes: [f64; 2]| Sheet { k: t - slopes[0] * self.centre[0] - slopes[1] * self.centre[1], slopes };
        Plan { least_at: through(steep), middle: through(slopes), width, bend: g.second }
    }

    /// Whether a cut is well inside: above `lo` by a margin at the middle ray.
    pub(super) fn above(&self, cut: &Sheet, lo: &Sheet, margin: f64) -> bool {
        at(cut, self.centre) > at(lo, self.centre) + margin
    }

    /// Whether two slabs touch, up to little.
    pub(super) fn touch(&self, before: &Sheet, lo: &Sheet, hi: &Sheet) -> bool {
        let (end, begin) = (at(before, self.centre), at(lo, self.centre));
        begin <= end + 1e-3 * (at(hi, self.centre) - begin)
    }

    /// Which of the sheets is nearest to the one in the middle, up to a margin.
    pub(super) fn nearest(&self, lo: &Sheet, middle: &Sheet, hi: &Sheet, margin: f64) -> Nearest {
        let (lo, t, hi) = (self.place(lo), self.place(middle), self.place(hi));
        if lo + margin < t && t < hi - margin {
            Nearest::Middle
        } else if t - lo < hi - t {
            Nearest::Lower
        } else {
            Nearest::Upper
        }
    }

    /// Whether a sheet is nearer to the lower end than to the upper one.
    pub(super) fn nearer_to_lower(&self, lo: &Sheet, sheet: &Sheet, hi: &Sheet) -> bool {
        self.place(sheet) - self.place(lo) < self.place(hi) - self.place(sheet)
    }

    /// The sheet parallel to one that meets the middle ray where another does.
    pub(super) fn through(&self, parallel: &Sheet, other: &Sheet) -> Sheet {
        Sheet { k: parallel.k + (self.place(other) - self.place(parallel)), ..*parallel }
    }

    /// For sorting along the middle ray.
    pub(super) fn place(&self, sheet: &Sheet) -> f64 {
        at(sheet, self.centre)
    }

    /// How the light is divided: which parameters are halved.
    pub(super) fn halved(&self) -> [bool; 2] {
        let edges = [self.half[0] * self.light.edge_u.length(), self.half[1] * self.light.edge_v.length()];
        if edges[0] > 2.0 * edges[1] {
            [true, false]
        } else if edges[1] > 2.0 * edges[0] {
            [false, true]
        } else {
            [true, true]
        }
    }
}

/// One of three sheets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Nearest {
    Lower,
    Middle,
    Upper,
}

/// Where the least value of a slab is expected: a sheet, and half a thickness around it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan {
    /// Follows the least value.
    pub(super) least_at: Sheet,
    /// Follows it, less steeply.
    middle: Sheet,
    pub(super) width: f64,
    /// About `g''/2` there.
    bend: f64,
}

impl Plan {
    /// Around a given sheet.
    #[cfg(test)]
    pub(super) fn around(middle: Sheet, width: f64) -> Self {
        Self { least_at: middle, middle, width, bend: 1.0 }
    }

    pub(super) fn slopes(&self) -> [f64; 2] {
        self.middle.slopes
    }

    /// The sheets so many widths below and above the middle.
    pub(super) fn around_by(&self, widths: f64) -> [Sheet; 2] {
        [self.sheet(-widths), self.sheet(widths)]
    }

    /// The sheet so many widths beyond the middle.
    pub(super) fn sheet(&self, widths: f64) -> Sheet {
        Sheet { k: self.middle.k + widths * self.width, ..self.middle }
    }

    /// What a cut must be inside of the core to be worth it.
    pub(super) fn margin(&self) -> f64 {
        0.02 * self.width
    }

    /// Whether a core bends enough to tell where its least value is.
    pub(super) fn bends_enough(&self, bend: f64) -> bool {
        bend >= BEND * self.bend
    }
}

/// The sheet half-way.
pub(super) fn between(lo: &Sheet, hi: &Sheet) -> Sheet {
    Sheet { k: 0.5 * (lo.k + hi.k), slopes: std::array::from_fn(|i| 0.5 * (lo.slopes[i] + hi.slopes[i])) }
}

/// A parameter at which to look: the slope is a quotient, of which at the hit nothing but noise would be left.
pub(super) fn apart(kind: Kind, t: f64) -> f64 {
    if kind == Kind::Slope { t.max(1e-4) } else { t }
}

/// Signs and kind applied to a jet of f at t.
pub(super) fn seen_from_front(f: PointJet, kind: Kind, t: f64, negative: bool) -> PointJet {
    let sign = if negative { -1.0 } else { 1.0 };
    let f = PointJet { value: sign * f.value, first: sign * f.first, second: sign * f.second };
    match kind {
        Kind::Plain => f,
        // f = t g: g = f/t, g' = (f' - g)/t, g''/2 = (f''/2 - g')/t.
        Kind::Slope => {
            let value = f.value / t;
            let first = (f.first - value) / t;
            PointJet { value, first, second: (f.second - first) / t }
        }
    }
}

/// Evaluations that are fair for one hit: the second-order method needs at most about `width^-0.3`.
pub(super) fn fair(width: f64) -> u64 {
    (FAIR * (1.0 / (255.0 * width)).max(1.0).sqrt()) as u64
}

/// Whether the method is worth trying: it has settled hits of late, or it is time to try again. After each failure but the
/// first two the pause is twice as long.
#[derive(Clone, Copy, Debug, Default)]
struct Trust {
    pause: u32,
    failures: u32,
}

impl Trust {
    fn worth(&mut self) -> bool {
        let worth = self.pause == 0;
        self.pause = self.pause.saturating_sub(1);
        worth
    }

    fn tell(&mut self, settled: bool) {
        self.failures = if settled { 0 } else { self.failures + 1 };
        self.pause = if self.failures > 2 { 1 << (self.failures.min(6) - 2) } else { 0 };
    }
}

/// What searches teach each other: of choices only.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::shadow) struct Learned {
    trust: Trust,
    /// Hits that the method has settled.
    hits: usize,
    /// Plain intervals for long and for short slabs.
    pub(super) trials: [Trial; 2],
    /// Convexity of cores of different sizes.
    pub(super) cores: [Trial; CORES.len()],
}

impl Learned {
    /// Most hits that are looked at together.
    pub(in crate::shadow) const COMPANY: usize = COMPANY;

    /// Whether the method is to be tried on the next hit: with `Auto`, not where it has failed of late.
    pub(in crate::shadow) fn worth(&mut self, penumbra: Penumbra) -> bool {
        match penumbra {
            Penumbra::First => false,
            Penumbra::Second => true,
            Penumbra::Auto => self.trust.worth(),
        }
    }

    /// How many hits are to be looked at together: the first one is alone, and so is each one where the method fails.
    pub(in crate::shadow) fn company(&self) -> usize {
        if self.trust.failures > 0 { 1 } else { (1 + JOIN * self.hits).min(COMPANY) }
    }

    /// A hit is done; whether the method settled it, if it was tried.
    pub(in crate::shadow) fn done(&mut self, settled: Option<bool>) {
        if let Some(settled) = settled {
            self.hits += usize::from(settled);
            self.trust.tell(settled);
        }
    }
}

/// Whether a narrow bracket may be that of a light that is visible as a whole, or not at all, which a few more cells might
/// prove.
pub(super) fn perhaps_all_the_same(lo: f64, hi: f64, cells: u32) -> bool {
    cells < CERTAIN && (hi > 1.0 - 1e-9 || lo < 1e-9)
}

/// The factor that makes two kinds of function comparable at about t: any positive one is sound.
pub(super) fn factor(from: Kind, to: Kind, t: f64) -> f64 {
    let t = t.max(1e-3);
    match (from, to) {
        (Kind::Plain, Kind::Slope) => 1.0 / t,
        (Kind::Slope, Kind::Plain) => t,
        _ => 1.0,
    }
}

/// The factor that makes one curve about as steep as another: any positive one is sound.
pub(super) fn steepness_ratio(of: &Curve, to: &Curve) -> f64 {
    let steepness = |p: &Paraboloid| p.l[0].abs() + p.l[1].abs();
    let ratio = steepness(&of.lower) / steepness(&to.upper);
    if ratio > 0.0 && ratio < f64::INFINITY { ratio } else { 1.0 }
}

/// Whether to divide a cell along its band rather than in quarters.
pub(super) fn crop_pays(band: &Band) -> bool {
    band.undecided.iter().all(|[from, to]| to - from < CROP)
}

/// Shares of a part that are tried to be cut off at each of its sides; the others only where the first one was.
pub(super) const CUTS: [f64; 4] = [0.125, 0.5, 0.5, 0.25];

/// A share of an interval at one of its ends, and the rest. `None` if it cannot be divided.
pub(super) fn cut_off(t: Interval, share: f64, upper: bool) -> Option<[Interval; 2]> {
    let length = share * (t.hi() - t.lo());
    let cut = if upper { t.hi() - length } else { t.lo() + length };
    let inside = t.lo() < cut && cut < t.hi();
    let (below, above) = (Interval::try_new(t.lo(), cut)?, Interval::try_new(cut, t.hi())?);
    inside.then_some(if upper { [above, below] } else { [below, above] })
}

/// A share of the cell that does not matter against the tolerance.
pub(super) fn enough(tolerance: f64, area: f64) -> f64 {
    0.1 * tolerance / area
}

/// Whether something that may spare work is worth trying: as long as it keeps succeeding.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Trial {
    asked: u32,
    run: u32,
    free: u32,
}

impl Trial {
    /// Slabs that begin nearer than this are never free by plain intervals.
    pub(super) const NEAREST: f64 = 0.02;

    pub(super) fn worth(&mut self) -> bool {
        self.asked += 1;
        self.asked < 6 || self.free * 6 > self.run || self.asked.is_multiple_of(16)
    }

    pub(super) fn tell(&mut self, free: bool) {
        self.run += 1;
        self.free += u32::from(free);
    }
}
