//! Certified areas cut out of a square by quadratic curves.
//!
//! Over a rectangle of light with parameters `(a, b)` in `Q = [-1, 1]^2` each unresolved slab of a shadow beam gives two
//! quadratic polynomials with one error ([`Curve`]): where `lower > error` it is free, where `upper < -error` it hides. The
//! square is cut into strips along `b`. In a strip `b = b_m + d y`, `|y| <= 1`, each curve is replaced by straight lines on
//! both sides, which reduces areas to [`super::halfplanes`].
//!
//! **Lemma (line beside a curve).** Let `F(a, b)` be a quadratic polynomial with `s dF/da > 0` (`s = +-1`) in the strip, and
//! `x(y) = m + g y` any line. Let `F(x(y), b)` be in `[R-, R+]` for all `y`, and `s dF/da` in `[g-, g+]`, `g- > 0`, wherever
//! `|a - x(y)| <= tau`. For a threshold `e` put `z = e - R-` and `h = z/g-` if `z > 0`, else `z/g+`. If `|h| <= tau` then
//! `F >= e` wherever `s a >= s x(y) + h` in the square: on the line `a = x + s h` the mean value theorem gives
//! `F >= R- + h s F_a(xi) >= R- + z`, and F grows from there on (`F_a` is linear in a: positive at both ends of a segment, it
//! is positive in between). Likewise, with `z = -e - R+` and `h = z/g-` if `z < 0`, else `z/g+`: `F < -e` wherever
//! `s a < s x(y) + h`.
//!
//! Any line is sound; a tangent at the strip's middle makes `[R-, R+]` as thin as the curvature allows.
//!
//! Curves that turn back within the square have two lines in a strip, one at each branch (`branches`).
mod band;
mod branches;

use super::halfplanes::{self, Bound};
use antumbra_interval::Interval;
use antumbra_interval::quadratic::Paraboloid;
use antumbra_interval::round::{add_down, add_up, div_down, div_up, mul_down, mul_up, sub_down, sub_up};
pub use band::Band;
use band::Tracker;

/// What one slab says about a rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    /// The slab is free where this is above `error`.
    pub lower: Paraboloid,
    /// It hides where this is below `-error`, if `hides`.
    pub upper: Paraboloid,
    /// Bound of both errors, perhaps infinite.
    pub error: f64,
    /// Whether a negative `upper` hides.
    pub hides: bool,
}

impl Curve {
    /// Which of the two can be proved of a part, if any: by what a number near its middle says. No proof.
    #[must_use]
    pub fn leaning(&self, [a, b]: [Interval; 2]) -> Leaning {
        let at = |p: &Paraboloid| {
            let (a, b) = (0.5 * (a.lo() + a.hi()), 0.5 * (b.lo() + b.hi()));
            p.c + a * (p.l[0] + p.q[0] * a + p.q[2] * b) + b * (p.l[1] + p.q[1] * b)
        };
        if at(&self.lower) > self.error {
            Leaning::Free
        } else if self.hides && at(&self.upper) < -self.error {
            Leaning::Hiding
        } else {
            Leaning::Neither
        }
    }

    /// Whether the slab is proved free all over a part of the square.
    #[must_use]
    pub fn free_over(&self, part: [Interval; 2]) -> bool {
        self.lower.lower_bound_over(part) > self.error
    }

    /// Whether it is proved to hide all of a part.
    #[must_use]
    pub fn hides_over(&self, part: [Interval; 2]) -> bool {
        self.hides && self.upper.upper_bound_over(part) < -self.error
    }
}

/// What a curve may say of all of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Leaning {
    /// That the slab is free.
    Free,
    /// That it hides.
    Hiding,
    /// Neither.
    Neither,
}

/// Encloses the `x` in `[-1, 1]` of the places `(lo + hi)/2 + (hi - lo)/2 x` of a part of `[lo, hi]`.
///
/// The solution for a place t is `((t - lo) - (hi - t))/(hi - lo)`, which grows with t: the ends of the part have the ends. Both differences in
/// the numerator are at least 0 and add up to the denominator, so their roundings move the quotient by at most u, the other three, of
/// a number of at most 1, by little more than 3u. (If the denominator is 0 this is a NaN, and the answer `[-1, 1]`.)
#[must_use]
pub fn places(part: Interval, of: Interval) -> Interval {
    let place = |t: f64| ((t - of.lo()) - (of.hi() - t)) / (of.hi() - of.lo());
    let (lo, hi) = (place(part.lo()) - 8.0 * U, place(part.hi()) + 8.0 * U);
    Interval::new(lo.max(-1.0), hi.min(1.0))
}

/// Shares of the square, in `[0, 1]`, and the band of what lies in between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Areas {
    /// Lower bound of the lit share.
    pub lit: f64,
    /// Upper bound of the share that is not hidden.
    pub open: f64,
    /// If there is one curve that crosses all strips.
    pub band: Option<Band>,
}

/// Scratch memory for [`areas`].
#[derive(Debug, Default)]
pub struct Scratch {
    curves: Vec<Curve>,
    bounds: Vec<Bound>,
    halfplanes: halfplanes::Scratch,
}

const U: f64 = f64::EPSILON / 2.0;
/// Most strips.
const STRIPS: f64 = 16.0;

/// Certified shares of the square that are lit and not hidden. `enough` is a share of the square that does not matter: it
/// decides how many strips are taken.
#[must_use]
pub fn areas(curves: &[Curve], enough: f64, s: &mut Scratch) -> Areas {
    const NOTHING: Areas = Areas { lit: 0.0, open: 1.0, band: None };
    if curves.iter().any(|c| !(c.error + c.lower.size() + c.upper.size()).is_finite()) {
        return NOTHING;
    }
    let turned = across(curves) == 1;
    s.curves.clear();
    s.curves.extend(
        curves.iter().map(|c| {
            if turned { Curve { lower: c.lower.transposed(), upper: c.upper.transposed(), ..*c } } else { *c }
        }),
    );
    let strips = strips(&s.curves, enough);
    let (mut lit, mut open) = (0.0, 0.0);
    let mut band = Tracker::default();
    for k in 0..strips {
        let strip = Strip::number(k, strips);
        let (inner, outer) = match s.curves.as_slice() {
            [curve] => single(curve, strip, &mut band, &mut s.halfplanes),
            curves => several(curves, strip, &mut s.bounds, &mut s.halfplanes),
        };
        lit = add_down(lit, inner);
        open = add_up(open, outer);
    }
    // The number of strips is a power of two: exact but for underflow, which is given away.
    let share = 0.5 / strips as f64;
    let (lit, open) = ((lit * share).next_down(), (open * share).next_up());
    let band = if curves.len() == 1 { band.finish(usize::from(turned)) } else { None };
    // NaN proves nothing.
    Areas {
        lit: if lit >= 0.0 { lit.min(1.0) } else { 0.0 },
        open: if open <= 1.0 { open.max(0.0) } else { 1.0 },
        band,
    }
}

/// The coordinate in which the curves are most surely monotone: any choice is sound.
fn across(curves: &[Curve]) -> usize {
    let (mut steep, mut least) = ([0.0; 2], [f64::INFINITY; 2]);
    for p in curves.iter().map(|c| c.upper) {
        let all = p.l[0].abs() + p.l[1].abs() + f64::MIN_POSITIVE;
        for i in 0..2 {
            steep[i] += p.l[i].abs();
            least[i] = f64::min(least[i], (p.l[i].abs() - 2.0 * p.q[i].abs() - p.q[2].abs()) / all);
        }
    }
    let both = least[0] > 0.1 && least[1] > 0.1;
    usize::from(if both { steep[1] > steep[0] } else { least[1] > least[0] })
}

/// As many strips as make the loss by straight lines at most that by the error, or `enough`: any power of two is sound. In a strip of
/// half width d the curve leaves its tangent by at most `curvature d^2/steepness`, and the square has twice that width.
fn strips(curves: &[Curve], enough: f64) -> usize {
    let wanted = curves.iter().fold(2.0, |most, c| {
        let p = c.upper;
        let steep = p.l[0].abs() + f64::MIN_POSITIVE;
        let least = f64::max(steep - 2.0 * p.q[0].abs() - p.q[2].abs(), 0.1 * steep);
        let tilt = p.l[1] / steep;
        let curvature = p.q[1].abs() + (p.q[2] * tilt).abs() + p.q[0].abs() * tilt * tilt;
        let loss = f64::max(0.5 * c.error / least, enough);
        f64::max(most, (0.5 * curvature / (least * loss)).sqrt())
    });
    let mut strips = 2;
    while f64::from(strips) < f64::min(wanted, STRIPS) {
        strips *= 2;
    }
    strips as usize
}

/// The strip `b = middle + half y`: exact numbers.
#[derive(Clone, Copy, Debug)]
struct Strip {
    middle: f64,
    half: f64,
    upper: bool,
}

impl Strip {
    fn number(k: usize, strips: usize) -> Self {
        let half = 1.0 / strips as f64;
        Self { middle: (2 * k + 1) as f64 * half - 1.0, half, upper: 2 * k >= strips }
    }
}

/// The line `s a >= s (m + g y) + h`.
#[derive(Clone, Copy, Debug)]
struct Line {
    sign: f64,
    m: f64,
    g: f64,
    /// Lower or upper bound of h, whichever makes the claim weaker.
    h: f64,
}

/// What a polynomial does along a line in a strip.
#[derive(Clone, Copy, Debug)]
struct Along {
    sign: f64,
    m: f64,
    g: f64,
    /// Bounds of the values on the line.
    values: [f64; 2],
    /// Magnitude of the steepness at the middle, its possible change per unit of a, and along the strip.
    steep: f64,
    change: f64,
    along: f64,
    slack: f64,
    /// Lower bound of the steepness, with its sign, in the strip; infinite where it need be known near the line only.
    least: f64,
}

impl Along {
    /// The tangent at the middle of the strip, in plain arithmetic, and what is certain about it.
    ///
    /// With `a = m + g y`, `b = b_m + d y`: `F = r_0 + r_1 y + r_2 y^2`. Every coefficient is a sum of at most 6 terms of at
    /// most 4 factors; the terms' magnitudes sum up to at most `size`: 16 roundings `u size` each, all told less than 64.
    fn tangent(p: &Paraboloid, strip: Strip) -> Option<Self> {
        let (aa, [c0, l0]) = (p.q[0], Self::middle(p, strip));
        // About the root nearest to the square; any number will do.
        let discriminant = l0 * l0 - 4.0 * aa * c0;
        let root = if discriminant >= 0.0 {
            let q = l0 + discriminant.sqrt().copysign(l0);
            if q == 0.0 { 0.0 } else { -2.0 * c0 / q }
        } else {
            -c0.signum() * l0.signum()
        };
        let m = if root > 1.0 {
            1.0
        } else if root >= -1.0 {
            root
        } else {
            -1.0
        };
        Self::through(p, strip, m)
    }

    /// In the middle of a strip, p is about `c + l a + q_aa a^2`.
    fn middle(p: &Paraboloid, strip: Strip) -> [f64; 2] {
        let bm = strip.middle;
        [p.c + bm * (p.l[1] + p.q[1] * bm), p.l[0] + p.q[2] * bm]
    }

    /// The same for any line's place m in the middle of the strip.
    fn through(p: &Paraboloid, strip: Strip, m: f64) -> Option<Self> {
        let (bm, d) = (strip.middle, strip.half);
        let [la, lb] = p.l;
        let [aa, bb, ab] = p.q;
        let [c0, l0] = Self::middle(p, strip);
        let steepness = l0 + 2.0 * aa * m;
        let g = -(lb + 2.0 * bb * bm + ab * m) / steepness * d;
        // A line that runs away says nothing.
        if g.abs() > 64.0 || g.is_nan() {
            return None;
        }
        let reach = m.abs() + g.abs();
        let size = p.c.abs() + la.abs() * reach + lb.abs() + aa.abs() * reach * reach + bb.abs() + ab.abs() * reach;
        let slack = 64.0 * U * size + f64::MIN_POSITIVE;
        let r0 = c0 + m * (l0 + aa * m);
        let r1 = la * g + lb * d + 2.0 * (aa * m * g + bb * bm * d) + ab * (m * d + g * bm);
        let r2 = aa * g * g + bb * d * d + ab * g * d;
        let values = [r0 - r1.abs() + f64::min(0.0, r2) - slack, r0 + r1.abs() + f64::max(0.0, r2) + slack];
        let sign = if steepness < 0.0 { -1.0 } else { 1.0 };
        let slack = 64.0 * U * (la.abs() + 2.0 * aa.abs() * reach + ab.abs()) + f64::MIN_POSITIVE;
        let least = sign * l0 - ((2.0 * aa.abs() + ab.abs() * d) * (1.0 + 16.0 * U) + slack);
        let (steep, change, along) = (steepness.abs(), 2.0 * aa.abs(), ab.abs() * d + 2.0 * aa.abs() * g.abs());
        Some(Self { sign, m, g, values, steep, change, along, slack, least })
    }

    /// Bounds of `s dF/da` within `tau` of the line (7 roundings, in `slack` and a factor).
    fn steepness(&self, tau: f64) -> [f64; 2] {
        let change = (self.along + self.change * tau) * (1.0 + 16.0 * U) + self.slack;
        [sub_down(self.steep, change), add_up(self.steep, change)]
    }

    /// The lemma's line for `F >= e`.
    fn above(&self, e: f64) -> Option<Line> {
        self.offset(sub_up(e, self.values[0]), true)
    }

    /// The lemma's line for `F < -e`.
    fn below(&self, e: f64) -> Option<Line> {
        self.offset(sub_down(-e, self.values[1]), false)
    }

    fn offset(&self, z: f64, up: bool) -> Option<Line> {
        if self.least <= 0.0 || self.least.is_nan() || z.is_nan() {
            return None;
        }
        // About twice the offset; then all that the square may need.
        let near = 2.0 * z.abs() / self.steep;
        [near, 4.0].into_iter().find_map(|tau| {
            let [least, most] = self.steepness(tau);
            if least <= 0.0 || least.is_nan() {
                return None;
            }
            let h = match (up, z > 0.0) {
                (true, true) => div_up(z, least),
                (true, false) => div_up(z, most),
                (false, true) => div_down(z, most),
                (false, false) => div_down(z, least),
            };
            (h.abs() <= tau).then_some(Line { sign: self.sign, m: self.m, g: self.g, h })
        })
    }
}

impl Line {
    /// Bounds of `1 - s x - h` at both ends of the strip: the length, up to 2, of the part of `[-1, 1]` that is beyond the line.
    fn lengths_down(&self) -> [f64; 2] {
        let at = |y: f64| sub_down(1.0, add_up(add_up(self.sign * self.m, y * self.sign * self.g), self.h));
        [at(-1.0), at(1.0)]
    }
    fn lengths_up(&self) -> [f64; 2] {
        let at = |y: f64| sub_up(1.0, add_down(add_down(self.sign * self.m, y * self.sign * self.g), self.h));
        [at(-1.0), at(1.0)]
    }
}

/// Lower and upper bound of the mean of `max(w, 0)` for the linear function from p to q.
fn positive_mean_down(p: f64, q: f64) -> f64 {
    let (lo, hi) = if p < q { (p, q) } else { (q, p) };
    if lo >= 0.0 {
        0.5 * add_down(lo, hi)
    } else if hi > 0.0 {
        0.5 * div_down(mul_down(hi, hi), sub_up(hi, lo))
    } else {
        0.0
    }
}
fn positive_mean_up(p: f64, q: f64) -> f64 {
    let (lo, hi) = if p < q { (p, q) } else { (q, p) };
    if lo >= 0.0 {
        0.5 * add_up(lo, hi)
    } else if hi > 0.0 {
        0.5 * div_up(mul_up(hi, hi), sub_down(hi, lo))
    } else if hi <= 0.0 {
        0.0
    } else {
        f64::INFINITY
    }
}

/// Bounds of the mean length of the part of `[-1, 1]` beyond a line, `clamp(w, 0, 2) = max(w, 0) - max(w - 2, 0)`.
/// Most lines leave all of the strip on one side, or neither end of `[-1, 1]`. (Each way asks for both lengths: a NaN takes the last one.)
fn length_down([p, q]: [f64; 2]) -> f64 {
    let (lo, hi) = if p < q { (p, q) } else { (q, p) };
    if lo <= 0.0 && hi <= 0.0 {
        0.0
    } else if lo >= 2.0 && hi >= 2.0 {
        2.0
    } else if lo >= 0.0 && hi <= 2.0 {
        0.5 * add_down(lo, hi)
    } else {
        sub_down(positive_mean_down(p, q), positive_mean_up(sub_up(p, 2.0), sub_up(q, 2.0)))
    }
}
fn length_up([p, q]: [f64; 2]) -> f64 {
    let (lo, hi) = if p < q { (p, q) } else { (q, p) };
    if lo <= 0.0 && hi <= 0.0 {
        0.0
    } else if lo >= 2.0 && hi >= 2.0 {
        2.0
    } else if lo >= 0.0 && hi <= 2.0 {
        0.5 * add_up(lo, hi)
    } else {
        sub_up(positive_mean_up(p, q), positive_mean_down(sub_down(p, 2.0), sub_down(q, 2.0)))
    }
}

/// Mean lengths, in `[0, 2]`, of the lit and of the not hidden part of a strip with one curve.
fn single(curve: &Curve, strip: Strip, band: &mut Tracker, s: &mut halfplanes::Scratch) -> (f64, f64) {
    let inside = Along::tangent(&curve.lower, strip);
    let outside = if !curve.hides {
        None
    } else if curve.upper == curve.lower {
        inside
    } else {
        Along::tangent(&curve.upper, strip)
    };
    let beyond = inside.and_then(|p| p.above(curve.error)).map(|line| line.lengths_down());
    let until = outside.and_then(|p| p.below(curve.error)).map(|line| line.lengths_up());
    match (inside, outside) {
        // Where no line is found, nothing is proved beyond it: lengths 0 and 2.
        (Some(inner), Some(outer)) if inner.least > 0.0 && outer.least > 0.0 => {
            band.add(strip, [inner.sign, outer.sign], beyond.unwrap_or([0.0; 2]), until.unwrap_or([2.0; 2]));
        }
        _ => band.broken(),
    }
    let lit = match beyond {
        Some(lengths) => length_down(lengths),
        None => {
            let plane = halfplanes::mean_in(&[flat(&curve.lower, curve.error, strip, true)], s);
            f64::max(plane, branches::lit(&curve.lower, curve.error, strip))
        }
    };
    let open = match until {
        Some(lengths) => length_up(lengths),
        None if curve.hides => {
            let plane = halfplanes::mean_out(&[flat(&curve.upper, curve.error, strip, false)], s);
            f64::min(plane, branches::open(&curve.upper, curve.error, strip))
        }
        None => 2.0,
    };
    // NaN proves nothing.
    (if lit > 0.0 { lit } else { 0.0 }, if open < 2.0 { open } else { 2.0 })
}

/// The same with several curves: half planes `c + (coefficient of y) y + (coefficient of a) a >= 0`.
fn several(curves: &[Curve], strip: Strip, bounds: &mut Vec<Bound>, s: &mut halfplanes::Scratch) -> (f64, f64) {
    let mut mean = |inner: bool| {
        bounds.clear();
        for curve in curves.iter().filter(|c| inner || c.hides) {
            let p = if inner { &curve.lower } else { &curve.upper };
            let along = Along::tangent(p, strip);
            let line = along.and_then(|p| if inner { p.above(curve.error) } else { p.below(curve.error) });
            bounds.push(match line {
                // s a - s m - s g y - h >= 0
                Some(Line { sign, m, g, h }) => {
                    let c = if inner { sub_down(-sign * m, h) } else { sub_up(-sign * m, h) };
                    Bound { c, a: -sign * g, b: sign }
                }
                None => flat(p, curve.error, strip, inner),
            });
        }
        if inner { halfplanes::mean_in(bounds, s) } else { halfplanes::mean_out(bounds, s) }
    };
    let (lit, open) = (mean(true), mean(false));
    (if lit > 0.0 { lit } else { 0.0 }, if open < 2.0 { open } else { 2.0 })
}

/// Linear bound of a polynomial in a strip, as a half plane over `(y, a)`: inner, `F - e` is at least it; else `F + e` is at
/// most it.
///
/// `a^2 = 1/2 +- 1/2`, `y^2 = 1/2 +- 1/2`, `a y = 0 +- 1`. At most 20 roundings on terms of sum `size`.
fn flat(p: &Paraboloid, e: f64, strip: Strip, inner: bool) -> Bound {
    let (bm, d) = (strip.middle, strip.half);
    let [la, lb] = p.l;
    let [aa, bb, ab] = p.q;
    let (sa, sb) = (0.5 * aa, 0.5 * bb * d * d);
    let middle = p.c + bm * (lb + bb * bm) + sa + sb;
    let rest = sa.abs() + sb.abs() + ab.abs() * d + e + (64.0 * U * (p.size() + e) + f64::MIN_POSITIVE);
    let (a, b) = (d * (lb + 2.0 * bb * bm), la + ab * bm);
    Bound { c: if inner { sub_down(middle, rest) } else { add_up(middle, rest) }, a, b }
}

#[cfg(test)]
mod tests;
