//! One ray against one surface: many values along the way, looked at closely where they come near to zero.
use super::precise::{Big, NOISE, Precise, Scratch};
use crate::expr;
use crate::geom::{Clip, Vec3};
use crate::scene::Object;

/// A ray `origin + t direction`.
#[derive(Clone, Debug)]
pub(super) struct Ray {
    origin: [Big; 3],
    direction: [Big; 3],
    /// The same, rounded.
    rough: [Vec3; 2],
}

impl Ray {
    pub(super) fn new(origin: [Big; 3], direction: [Big; 3]) -> Self {
        let rough = [&origin, &direction].map(|v| Vec3(v.each_ref().map(Big::rounded)));
        Self { origin, direction, rough }
    }

    /// The point at a parameter.
    pub(super) fn at(&self, t: &Big) -> [Big; 3] {
        std::array::from_fn(|k| self.origin[k].add(&t.mul(&self.direction[k])))
    }
}

/// What a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Seen {
    /// No zero was found, nor anything near one.
    Clear,
    /// f is zero in this section: it changes sign with values that shrink, or it touches zero to forty digits.
    Zero([f64; 2]),
    /// Something is there that is neither: f comes near to zero, or it is undefined.
    Unclear,
}

/// A surface as the audit sees it.
pub(super) struct Judge {
    formula: Precise,
    clip: Clip,
}

/// Sections into which a ray is cut at first.
const SECTIONS: usize = 96;
/// Values below this share of the greatest one on the ray are found again in high precision.
const SCOUT: f64 = 1e-7;
/// Golden section: the part that stays.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Values along one ray: where, and f there.
struct Walk<'a> {
    judge: &'a Judge,
    ray: &'a Ray,
    scale: f64,
}

impl Walk<'_> {
    fn precise(&self, t: f64, s: &mut Scratch) -> f64 {
        self.judge.formula.value(&self.ray.at(&t.into()), s).rounded()
    }

    /// The value: in double precision, or in high precision where it is small.
    fn value(&self, t: f64, s: &mut Scratch) -> f64 {
        let [p, d] = self.ray.rough;
        let rough = self.judge.formula.rough(p + d * t, s);
        if rough.abs() > SCOUT * self.scale { rough } else { self.precise(t, s) }
    }
}

impl Judge {
    /// # Errors
    /// Where the formula is none.
    pub(super) fn new(object: &Object, s: &mut Scratch) -> Result<Self, expr::Error> {
        Ok(Self { formula: Precise::parse(&object.text, s)?, clip: object.clip() })
    }

    /// Parameters at which the ray is inside the clip, rounded.
    fn inside(&self, ray: &Ray, [from, to]: [f64; 2]) -> Option<[f64; 2]> {
        let [p, d] = ray.rough;
        let (mut lo, mut hi) = (from, to);
        match self.clip {
            Clip::Everywhere => {}
            Clip::Box(b) => {
                for k in 0..3 {
                    if d[k] == 0.0 {
                        if !b[k].contains(p[k]) {
                            return None;
                        }
                        continue;
                    }
                    let ends = [(b[k].lo() - p[k]) / d[k], (b[k].hi() - p[k]) / d[k]];
                    lo = lo.max(ends[0].min(ends[1]));
                    hi = hi.min(ends[0].max(ends[1]));
                }
            }
            Clip::Ball { center, radius } => {
                let q = p - center;
                let (a, b, c) = (d.dot(d), q.dot(d), q.dot(q) - radius * radius);
                let root = (b * b - a * c).sqrt();
                if root.is_nan() {
                    return None;
                }
                lo = lo.max((-b - root) / a);
                hi = hi.min((-b + root) / a);
            }
        }
        (lo < hi).then_some([lo, hi])
    }

    /// Follows a ray between two parameters, cut into `fine` times the usual number of sections. `leaving` says that it
    /// starts on this surface, where f = 0, and on which side it must leave.
    pub(super) fn follow(
        &self,
        ray: &Ray,
        range: [f64; 2],
        leaving: Option<f64>,
        fine: usize,
        s: &mut Scratch,
    ) -> Seen {
        let Some([lo, hi]) = self.inside(ray, range) else { return Seen::Clear };
        // Just inside the clip: its border is rounded.
        let margin = 1e-12 * (hi - lo);
        let [lo, hi] = if leaving.is_some() { [lo, hi - margin] } else { [lo + margin, hi - margin] };
        let sections = SECTIONS * fine;
        let step = (hi - lo) / sections as f64;
        let mut places = Vec::with_capacity(sections + 32);
        if leaving.is_some() {
            // 2^-30 of a step to half of one.
            places.extend((1..=30).rev().map(|k| lo + step / f64::from(1_u32 << k)));
        }
        places.extend((usize::from(leaving.is_some())..=sections).map(|k| lo + step * k as f64));
        let [p, d] = ray.rough;
        let mut values: Vec<f64> = places.iter().map(|&t| self.formula.rough(p + d * t, s)).collect();
        let scale = values.iter().fold(0.0_f64, |m, v| if v.is_finite() { m.max(v.abs()) } else { m });
        let walk = Walk { judge: self, ray, scale };
        for (value, &t) in values.iter_mut().zip(&places) {
            if value.is_nan() || value.abs() <= SCOUT * scale {
                *value = walk.precise(t, s);
            }
        }
        let near = NOISE * scale;
        if let Some(side) = leaving
            && let Some(first) = values.iter().position(|v| v.abs() > near)
            && values[first] * side < 0.0
        {
            return Seen::Zero([lo, places[first]]);
        }
        let mut unclear = values.iter().any(|v| v.is_nan());
        for k in 0..values.len().saturating_sub(1) {
            let (v, next) = (values[k], values[k + 1]);
            if v * next < 0.0 {
                match walk.crossing([places[k], places[k + 1]], [v, next], s) {
                    Seen::Zero(section) => return Seen::Zero(section),
                    other => unclear |= other == Seen::Unclear,
                }
            } else if k > 0 && values[k - 1].abs() >= v.abs() && v.abs() <= next.abs() {
                match walk.dip([places[k - 1], places[k + 1]], v, s) {
                    Seen::Zero(section) => return Seen::Zero(section),
                    other => unclear |= other == Seen::Unclear,
                }
            }
        }
        if unclear { Seen::Unclear } else { Seen::Clear }
    }

    /// Whether a point is inside the clip, or at most `slack` outside.
    pub(super) fn holds(&self, at: &[Big; 3], slack: f64) -> bool {
        let p = Vec3(at.each_ref().map(Big::rounded));
        match self.clip {
            Clip::Everywhere => true,
            Clip::Box(b) => (0..3).all(|k| b[k].lo() - slack <= p[k] && p[k] <= b[k].hi() + slack),
            Clip::Ball { center, radius } => (p - center).length() <= radius + slack,
        }
    }

    /// Whether f is zero between two parameters that are very near to each other.
    pub(super) fn zero_in(&self, ray: &Ray, [lo, hi]: [f64; 2], s: &mut Scratch) -> Seen {
        let around = (hi - lo).max(1e-3 * hi.abs());
        let mut at = |t: f64| self.formula.value(&ray.at(&t.into()), s).rounded();
        let scale = [lo - around, hi + around].into_iter().map(&mut at).fold(0.0_f64, |m, v| m.max(v.abs()));
        let ends = [at(lo), at(hi)];
        let walk = Walk { judge: self, ray, scale };
        if ends.iter().any(|v| v.abs() <= NOISE * scale) {
            return Seen::Zero([lo, hi]);
        }
        if ends[0] * ends[1] < 0.0 { walk.crossing([lo, hi], ends, s) } else { walk.touch([lo, hi], s) }
    }

    /// The root in a section at whose ends f has opposite signs, to the last digit: the point, and the sign before it.
    pub(super) fn root(&self, ray: &Ray, [lo, hi]: [f64; 2], s: &mut Scratch) -> Option<([Big; 3], f64)> {
        let (mut lo, mut hi) = (Big::from(lo), Big::from(hi));
        let first = self.formula.value(&ray.at(&lo), s).rounded();
        let last = self.formula.value(&ray.at(&hi), s).rounded();
        if first * last >= 0.0 || first.is_nan() || last.is_nan() {
            return None;
        }
        let half = Big::from(0.5);
        for _ in 0..150 {
            let middle = lo.add(&hi).mul(&half);
            let value = self.formula.value(&ray.at(&middle), s).rounded();
            if value * first > 0.0 { lo = middle } else { hi = middle }
        }
        Some((ray.at(&lo.add(&hi).mul(&half)), first.signum()))
    }
}

impl Walk<'_> {
    /// A change of sign: a zero if the values shrink towards it. At a pole they grow, at a jump they stay.
    fn crossing(&self, [mut lo, mut hi]: [f64; 2], [mut below, mut above]: [f64; 2], s: &mut Scratch) -> Seen {
        let first = below.abs().max(above.abs());
        for _ in 0..60 {
            let middle = 0.5 * (lo + hi);
            if middle <= lo || middle >= hi {
                break;
            }
            let value = self.value(middle, s);
            if value.is_nan() {
                return Seen::Unclear;
            }
            if value * below < 0.0 { (hi, above) = (middle, value) } else { (lo, below) = (middle, value) }
        }
        // The section may begin narrow, with values that are small already.
        let now = below.abs().max(above.abs());
        if now <= 1e-6 * first || now <= 1e-9 * self.scale {
            Seen::Zero([lo, hi])
        } else if now >= 1e6 * first {
            Seen::Clear
        } else {
            Seen::Unclear
        }
    }

    /// Whether f touches zero in a section: like [`Walk::dip`], with parameters of many digits.
    fn touch(&self, [lo, hi]: [f64; 2], s: &mut Scratch) -> Seen {
        let (mut low, mut high) = (Big::from(lo), Big::from(hi));
        let (mut least, mut halfway) = (f64::INFINITY, f64::INFINITY);
        for step in 0..160 {
            let part = high.sub(&low).mul(&GOLDEN.into());
            let (c, e) = (high.sub(&part), low.add(&part));
            let [at_c, at_e] = [&c, &e].map(|t| self.judge.formula.value(&self.ray.at(t), s).rounded().abs());
            least = least.min(at_c).min(at_e);
            if step == 80 {
                halfway = least;
            }
            if at_c <= at_e { high = e } else { low = c }
        }
        if least <= NOISE * self.scale {
            Seen::Zero([lo, hi])
        } else if shrinks(halfway, least) {
            Seen::Unclear
        } else {
            Seen::Clear
        }
    }

    /// The least value in a section whose values all seem to have one sign.
    fn dip(&self, [mut lo, mut hi]: [f64; 2], sign: f64, s: &mut Scratch) -> Seen {
        let ends = [lo, hi];
        let mut lesser = Vec::with_capacity(80);
        for _ in 0..80 {
            let (c, e) = (hi - GOLDEN * (hi - lo), lo + GOLDEN * (hi - lo));
            if !(lo < c && c < e && e < hi) {
                break;
            }
            let [at_c, at_e] = [c, e].map(|t| self.value(t, s));
            for (t, value) in [(c, at_c), (e, at_e)] {
                if value * sign < 0.0 {
                    // A crossing after all, on both sides of this place.
                    return self.crossing([ends[0], t], [self.value(ends[0], s), value], s);
                }
            }
            lesser.push(at_c.abs().min(at_e.abs()));
            if at_c.abs() <= at_e.abs() { hi = e } else { lo = c }
        }
        let halfway = lesser.get(lesser.len() / 2).copied().unwrap_or(f64::INFINITY);
        let least = self.precise(0.5 * (lo + hi), s).abs();
        // Parameters are doubles here: a touching zero is met to the square of their spacing.
        if least <= 1e-28 * self.scale {
            Seen::Zero([lo, hi])
        } else if least <= 1e-12 * self.scale || shrinks(halfway, least) {
            Seen::Unclear
        } else {
            Seen::Clear
        }
    }
}

/// Whether values still shrink with the section around them: towards a cusp of 0, such as that of `sqrt(abs(x))`, which is met only
/// as nearly as parameters are dense. Around a least value above 0 they settle.
fn shrinks(halfway: f64, least: f64) -> bool {
    halfway.is_nan() || least < 0.9 * halfway
}
