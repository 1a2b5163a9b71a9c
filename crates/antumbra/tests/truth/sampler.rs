//! A slow and simple judge of rays: values of f at many points, refined where they come near to zero. It shares nothing
//! with the certified search but the compiled formula, which it runs on numbers of its own.
use super::double::Double;
use antumbra::eval::{run, value_at};
use antumbra::expr::{Formula, Unary};
use antumbra::geom::{Camera, Clip, Vec3};
use antumbra::scene::Object;
use antumbra::tape::{Op, Tape};

pub(crate) type Point = [Double; 3];

/// What a ray does on its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Seen {
    /// No zero was found, nor anything near one.
    Clear,
    /// f changes sign, and continuously, in this section.
    Blocked([f64; 2]),
    /// f comes so near to zero that its sign is not known.
    Unclear,
}

/// Sections of equal length into which a ray is cut at first.
pub(crate) const SAMPLES: usize = 96;
/// Values below this share of the greatest one on a ray are computed in twice the precision.
const NEAR: f64 = 1e-8;
/// Golden section: the section that stays.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// A formula and where its surface ends.
pub(crate) struct Judge {
    tape: Tape,
    clip: Clip,
    /// Relative error of an evaluation: what is nearer to zero has no known sign.
    noise: f64,
}

impl Judge {
    pub(crate) fn new(object: &Object) -> Self {
        let tape = Tape::compile(Formula::parse(&object.text).unwrap().surface().formula()).unwrap();
        let exact =
            |op: &Op| !matches!(op, Op::Unary(op) if !matches!(op, Unary::Neg | Unary::Abs | Unary::Sqr | Unary::Sqrt));
        let noise = if tape.clauses().iter().all(|c| exact(&c.op)) { 1e-24 } else { 1e-14 };
        Self { tape, clip: object.clip(), noise }
    }

    /// The value at `p + t d`: in double precision, and in twice that where it is near to zero on the given scale.
    fn value(&self, p: &Point, d: &Point, t: f64, scale: f64, slots: &mut Slots) -> f64 {
        let at: Point = std::array::from_fn(|k| p[k] + d[k] * t.into());
        let rough = value_at(&self.tape, Vec3(at.map(|x| x.hi)), &mut slots.single);
        if rough.abs() > NEAR * scale { rough } else { run(&self.tape, at, &mut slots.double).hi }
    }

    /// Parameters in `[from, to]` at which the ray is inside the region.
    fn inside(&self, p: &Point, d: &Point, from: f64, to: f64) -> Option<[f64; 2]> {
        let b = match self.clip {
            Clip::Box(b) => b,
            Clip::Ball { center, radius } => {
                let (q, d) = (Vec3(p.map(|x| x.hi)) - center, Vec3(d.map(|x| x.hi)));
                let (a, h) = (d.dot(d), q.dot(d));
                let root = (h * h - a * (q.dot(q) - radius * radius)).sqrt();
                if root.is_nan() {
                    return None;
                }
                let (lo, hi) = (from.max((-h - root) / a), to.min((-h + root) / a));
                return (lo < hi).then_some([lo, hi]);
            }
            Clip::Everywhere => return Some([from, to]),
        };
        let (mut lo, mut hi) = (from, to);
        for k in 0..3 {
            let (p, d) = (p[k].hi, d[k].hi);
            if d == 0.0 {
                if !b[k].contains(p) {
                    return None;
                }
                continue;
            }
            let ends = [(b[k].lo() - p) / d, (b[k].hi() - p) / d];
            lo = lo.max(ends[0].min(ends[1]));
            hi = hi.min(ends[0].max(ends[1]));
        }
        (lo < hi).then_some([lo, hi])
    }

    /// Follows `p + t d` from `from` to `to`. `leaving` says that the ray starts on this surface, with f = 0, and on
    /// which side it must leave: then f is looked at from very near on.
    pub(crate) fn follow(&self, p: &Point, d: &Point, from: f64, to: f64, leaving: Option<f64>) -> Seen {
        self.follow_in(SAMPLES, p, d, [from, to], leaving)
    }

    /// The same with another number of sections: a passage through a solid that is shorter than one may be missed.
    pub(crate) fn follow_in(
        &self,
        samples: usize,
        p: &Point,
        d: &Point,
        [from, to]: [f64; 2],
        leaving: Option<f64>,
    ) -> Seen {
        let Some([lo, hi]) = self.inside(p, d, from, to) else { return Seen::Clear };
        let mut slots = Slots::default();
        let step = (hi - lo) / samples as f64;
        let mut places = Vec::with_capacity(samples + 32);
        if leaving.is_some() {
            // 2^-30 of a step to half of one.
            places.extend((1..=30).rev().map(|k| lo + step * 0.5_f64.powi(k)));
        }
        places.extend((usize::from(leaving.is_some())..=samples).map(|k| lo + step * k as f64));
        let mut values: Vec<f64> = places.iter().map(|&t| self.value(p, d, t, 0.0, &mut slots)).collect();
        let scale = values.iter().fold(0.0_f64, |m, v| if v.is_finite() { m.max(v.abs()) } else { m });
        for (v, &t) in values.iter_mut().zip(&places) {
            if v.is_nan() || v.abs() <= NEAR * scale {
                *v = self.value(p, d, t, scale, &mut slots);
            }
        }
        let near = self.noise * scale;
        if let Some(side) = leaving
            && let Some(first) = values.iter().position(|v| v.abs() > near)
            && values[first] * side < 0.0
        {
            return Seen::Blocked([lo, places[first]]);
        }
        let mut unclear = false;
        for k in 0..values.len() {
            let v = values[k];
            // Near the start the true value is near zero; there only the wrong sign counts, and that was looked at.
            if v.abs() <= near && !(leaving.is_some() && k < 8) {
                unclear = true;
            }
            let Some(&next) = values.get(k + 1) else { continue };
            if v * next < 0.0 {
                let mut section = [places[k], places[k + 1]];
                let mut ends = [v, next];
                for _ in 0..32 {
                    let middle = 0.5 * (section[0] + section[1]);
                    let value = self.value(p, d, middle, scale, &mut slots);
                    let upper = usize::from(value * ends[0] < 0.0);
                    (section[upper], ends[upper]) = (middle, value);
                }
                // At a pole the values grow; at a step they do not shrink.
                let shrunk = ends[0].abs().max(ends[1].abs()) <= 1e-6 * v.abs().max(next.abs());
                if shrunk && v.abs() > near && next.abs() > near {
                    return Seen::Blocked(section);
                }
                unclear |= shrunk || ends.iter().any(|e| e.is_nan());
            }
            if k > 0 && values[k - 1].abs() >= v.abs() && v.abs() <= next.abs() && may_dip([values[k - 1], v, next]) {
                let (mut a, mut b) = (places[k - 1], places[k + 1]);
                for _ in 0..44 {
                    let (c, e) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
                    let [at_c, at_e] = [c, e].map(|t| self.value(p, d, t, scale, &mut slots));
                    for (t, value) in [(c, at_c), (e, at_e)] {
                        if value * v < 0.0 && value.abs() > near && v.abs() > near {
                            return Seen::Blocked([places[k - 1], t]);
                        }
                        unclear |= value.abs() <= near;
                    }
                    if at_c.abs() <= at_e.abs() { b = e } else { a = c }
                }
            }
        }
        if unclear { Seen::Unclear } else { Seen::Clear }
    }

    /// The value at `p + t d`, in twice the usual precision.
    pub(crate) fn exact(&self, p: &Point, d: &Point, t: Double) -> f64 {
        let at: Point = std::array::from_fn(|k| p[k] + d[k] * t);
        run(&self.tape, at, &mut Vec::new()).hi
    }

    /// The sign of f at a parameter of a ray, 1 or -1, or 0 if it is not known.
    pub(crate) fn sign(&self, p: &Point, d: &Point, t: f64) -> f64 {
        let v = self.exact(p, d, t.into());
        if v.abs() > self.noise { v.signum() } else { 0.0 }
    }
}

/// Whether the parabola through three values of one sign, the middle one the least, comes near to zero.
fn may_dip(values: [f64; 3]) -> bool {
    let [a, b, c] = values.map(f64::abs);
    let (bend, slope) = (a - 2.0 * b + c, 0.5 * (c - a));
    // Equal values have no bend. Twice as deep as the parabola goes is allowed for.
    bend <= 0.0 || b - slope * slope / bend <= 0.25 * b
}

#[derive(Default)]
struct Slots {
    single: Vec<f64>,
    double: Vec<Double>,
}

pub(crate) fn point(p: Vec3) -> Point {
    p.0.map(Double::from)
}

/// Eye and direction of the ray through `(column, row)`, in pixels from the upper left corner.
pub(crate) fn camera_ray(camera: &Camera, [width, height]: [usize; 2], column: f64, row: f64) -> (Point, Point) {
    let film = |k: f64, n: usize| Double::from(2.0 * k) / Double::from(n as f64) - 1.0.into();
    let (x, y) = (film(column, width), -film(row, height));
    let c = camera;
    let direction =
        std::array::from_fn(|k| Double::from(c.forward[k]) + x * Double::from(c.right[k]) + y * Double::from(c.up[k]));
    (point(c.eye), direction)
}

/// Shares of a square of which the corners of `n x n` equal cells were looked at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shares {
    /// Cells whose corners all say yes.
    pub(crate) lo: f64,
    /// And those whose corners disagree, or do not know: the border runs through them.
    pub(crate) hi: f64,
}

impl Shares {
    /// `yes(i, j)` is asked at the corners, `0 <= i, j <= n`.
    pub(crate) fn of(n: usize, mut yes: impl FnMut(usize, usize) -> Option<bool>) -> Self {
        let corners: Vec<Vec<Option<bool>>> = (0..=n).map(|j| (0..=n).map(|i| yes(i, j)).collect()).collect();
        let (mut sure, mut open) = (0, 0);
        for j in 0..n {
            for i in 0..n {
                let cell = [corners[j][i], corners[j][i + 1], corners[j + 1][i], corners[j + 1][i + 1]];
                sure += usize::from(cell == [Some(true); 4]);
                open += usize::from(cell != [Some(true); 4] && cell != [Some(false); 4]);
            }
        }
        let cell = 1.0 / (n * n) as f64;
        Self { lo: sure as f64 * cell, hi: (sure + open) as f64 * cell }
    }

    /// Whether a bracket agrees, up to a slack for what may be hidden inside cells whose corners agree.
    pub(crate) fn agree(&self, lo: f64, hi: f64, slack: f64) -> bool {
        lo <= self.hi + slack && hi >= self.lo - slack
    }
}
