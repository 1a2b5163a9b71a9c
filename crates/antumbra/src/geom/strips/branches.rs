//! Curves that turn back: where `F(a, b)` is not monotone in a, it is convex or concave in it, and each of its two branches has a line.
//!
//! **Lemma (branches).** Let `F_aa >= 0`, and a line of sign s as in the lemma of [strips](super) with `s F_a` in `[g-, g+]`, `g- > 0`, within
//! tau of it, but perhaps nowhere else. On the line moved by h, `|h| <= tau`, `F >= e` for the h of the first claim, and `F <= -e` for
//! that of the second one, by the mean value theorem as there. Then
//!
//! * `F >= e` wherever `s a >= s x + h`: there `s F_a`, which grows with `s a`, is at least what it is on the line, positive;
//! * between two lines of signs -1 and 1 on which `F <= -e`, `F <= -e`, as F is convex along a.
//!
//! So a strip is lit beyond both lines, and hidden between them. If `F_aa <= 0`, the same of `-F`: lit between, hidden beyond.
use super::{Along, Line, Strip, length_down, length_up};
use antumbra_interval::Interval;
use antumbra_interval::quadratic::Paraboloid;
use antumbra_interval::round::{add_down, add_up, sub_down, sub_up};

/// Lower bound of the mean length of the part of a strip, in `[0, 2]`, in which `p >= e`.
pub(super) fn lit(p: &Paraboloid, e: f64, strip: Strip) -> f64 {
    if p.q[0] > 0.0 { beyond(p, e, strip) } else { between(&negated(p), e, strip) }
}

/// Upper bound of the mean length of the part in which `p < -e` is not proved.
pub(super) fn open(p: &Paraboloid, e: f64, strip: Strip) -> f64 {
    let hidden = if p.q[0] > 0.0 { between(p, e, strip) } else { beyond(&negated(p), e, strip) };
    sub_up(2.0, hidden)
}

fn negated(p: &Paraboloid) -> Paraboloid {
    Paraboloid { c: -p.c, l: p.l.map(|v| -v), q: p.q.map(|v| -v) }
}

/// Lower bound of the length in which a polynomial that is convex along a is at least e.
fn beyond(p: &Paraboloid, e: f64, strip: Strip) -> f64 {
    let along = Interval::new(strip.middle - strip.half, strip.middle + strip.half);
    if p.lower_bound_over([Interval::new(-1.0, 1.0), along]) > e {
        return 2.0;
    }
    let [left, right] = lines(p, e, strip).map(|along| along.and_then(|along| along.above(e)));
    let length = |line: &Option<Line>| line.as_ref().map_or(0.0, |line| length_down(line.lengths_down()));
    let (first, second) = (length(&left), length(&right));
    let apart = match (left, right) {
        // The whole square is not longer than both parts: they do not overlap.
        (Some(left), Some(right)) => {
            let ([a, b], [c, d]) = (left.lengths_up(), right.lengths_up());
            add_up(a, c) <= 2.0 && add_up(b, d) <= 2.0
        }
        _ => true,
    };
    if apart { add_down(first, second) } else { f64::max(first, second) }
}

/// Lower bound of the length in which a polynomial that is convex along a is at most -e. Where the lines cross, that is less than 0.
fn between(p: &Paraboloid, e: f64, strip: Strip) -> f64 {
    let [Some(left), Some(right)] = lines(p, -e, strip).map(|along| along.and_then(|along| along.below(e))) else {
        return 0.0;
    };
    let outside = add_up(length_up(left.lengths_up()), length_up(right.lengths_up()));
    f64::max(sub_down(2.0, outside), 0.0)
}

/// Tangents where a convex polynomial is about `level` in the middle of the strip, of signs -1 and 1: any lines are sound, and so is none.
fn lines(p: &Paraboloid, level: f64, strip: Strip) -> [Option<Along>; 2] {
    let (aa, [c0, l0]) = (p.q[0], Along::middle(p, strip));
    let discriminant = l0 * l0 - 4.0 * aa * (c0 - level);
    [-1.0, 1.0].map(|sign| {
        let root = (sign * discriminant.sqrt() - l0) / (2.0 * aa);
        let line = if root.is_finite() { Along::through(p, strip, root.clamp(-8.0, 8.0))? } else { return None };
        // Its steepness matters within tau only.
        (line.sign == sign && aa > 0.0).then_some(Along { least: f64::INFINITY, ..line })
    })
}
