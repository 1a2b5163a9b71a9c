//! Beams of interval arithmetic (paper, section 2).
use super::{Box3, Vec3, vector::axes};
use antumbra_interval::Interval;

/// The paper's beam `X = c + T (Xs - c)`: all rays from the exact point `origin` whose direction lies in the box
/// `direction` (the intervals `Xs - c`). A ray is the beam whose direction is a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    /// Common starting point `c` of the rays.
    pub origin: Vec3,
    /// Enclosure of `Xs - c`.
    pub direction: Box3,
}

impl Beam {
    /// The beam from `origin` towards every point of `target`, which it reaches at `t = 1`.
    #[must_use]
    pub fn towards(origin: Vec3, target: Box3) -> Self {
        Self { origin, direction: Box3(axes(|i| target[i] - Interval::point(origin[i]))) }
    }

    /// Enclosure of every point that a ray of the beam reaches at a parameter in `t`. Three products and sums.
    #[must_use]
    #[inline]
    pub fn at(&self, t: Interval) -> Box3 {
        Box3(axes(|i| Interval::point(self.origin[i]) + t * self.direction[i]))
    }

    /// Enclosure of the parameters `t >= 0` at which a ray of the beam may have its coordinate `axis` in `range`
    /// (paper: `T_z = (V_z - z0) / (Z_a - z0)`); empty if there are none.
    ///
    /// With `n = range - origin` and `t d = n`, `t >= 0`: if all of `n` is positive so is `d`, and the quotient may be
    /// taken with the positive part of the direction alone; likewise if all of it is negative.
    #[must_use]
    #[inline]
    pub fn parameters_in(&self, axis: usize, range: Interval) -> Interval {
        const POSITIVE: Interval = Interval::NON_NEGATIVE;
        let n = range - Interval::point(self.origin[axis]);
        let d = self.direction[axis];
        let quotient = if n.certainly_positive() {
            n / d.intersection(POSITIVE)
        } else if n.certainly_negative() {
            n / d.intersection(-POSITIVE)
        } else {
            // 0 is in n: t = 0 is a solution, and where d holds 0 every t is, though no quotient says so.
            if d.possibly_zero() { POSITIVE } else { n / d }
        };
        quotient.intersection(POSITIVE)
    }
}

/// Section number `index` (from 0) of the `2^level` equal sections of `t`.
///
/// Neighbours share their computed edge bit for bit, the first begins at `t.lo()` and the last ends at `t.hi()`, and
/// edges are monotone in the index (products and sums round monotonically); so the sections cover `t` whatever the
/// rounding. An edge of one level is the same number at the next, as scaling by powers of two is exact.
/// Requires a bounded `t`, `index < 2^level` and `level <= 62`.
#[must_use]
#[inline]
pub fn section(t: Interval, index: u64, level: u32) -> Interval {
    let count = 1u64 << level;
    debug_assert!(index < count && t.lo().is_finite() && t.hi().is_finite());
    let (lo, hi) = (t.lo(), t.hi());
    let step = (hi - lo) / count as f64;
    let edge = |k: u64| if k == count { hi } else { (lo + step * k as f64).min(hi) };
    Interval::new(edge(index), edge(index + 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_beam_contains_its_rays() {
        let target = Box3([Interval::new(0.9, 1.1), Interval::new(-0.1, 0.1), Interval::new(2.0, 2.0)]);
        let beam = Beam::towards(Vec3::new(0.1, 0.2, 0.3), target);
        for t in [0.0, 0.25, 1.0, 3.0] {
            let box3 = beam.at(Interval::point(t));
            for (x, y) in [(0.9, -0.1), (1.1, 0.1), (1.0, 0.05)] {
                for (axis, goal) in [x, y, 2.0].into_iter().enumerate() {
                    let o = beam.origin[axis];
                    assert!(box3[axis].contains(o + t * (goal - o)));
                }
            }
        }
    }

    #[test]
    fn parameters_are_those_of_the_slab() {
        let beam = Beam {
            origin: Vec3::default(),
            direction: Box3([Interval::new(-1.0, 2.0), Interval::new(1.0, 1.0), Interval::new(0.0, 0.0)]),
        };
        // A ray gets to x in [4, 6] with a direction in (0, 2]: from t = 2 on.
        let t = beam.parameters_in(0, Interval::new(4.0, 6.0));
        assert!(t.lo() <= 2.0 && t.lo() > 1.999_999 && t.hi() == f64::INFINITY);
        // ... and to x in [-6, -4] with a direction in [-1, 0): from t = 4 on.
        let t = beam.parameters_in(0, Interval::new(-6.0, -4.0));
        assert!(t.lo() <= 4.0 && t.lo() > 3.999_999 && t.hi() == f64::INFINITY);
        let t = beam.parameters_in(1, Interval::new(2.0, 3.0));
        assert!(t.contains(2.0) && t.contains(3.0) && t.width() < 1.000_001);
        assert!(beam.parameters_in(1, Interval::new(-3.0, -2.0)).is_empty(), "behind the origin");
        assert!(beam.parameters_in(2, Interval::new(1.0, 2.0)).is_empty(), "never leaves z = 0");
        for range in [Interval::new(-1.0, 2.0), Interval::new(0.0, 2.0), Interval::ZERO] {
            assert_eq!(
                beam.parameters_in(2, range),
                Interval::NON_NEGATIVE,
                "never leaves z = 0, which is in the range"
            );
        }
    }

    #[test]
    fn sections_share_edges_and_cover() {
        for t in [Interval::new(0.1, 0.3), Interval::new(-1e-300, 1e300), Interval::new(1.0, 1.0_f64.next_up())] {
            for level in [1, 2, 7] {
                let n = 1u64 << level;
                assert_eq!(section(t, 0, level).lo(), t.lo());
                assert_eq!(section(t, n - 1, level).hi(), t.hi());
                for k in 1..n {
                    assert_eq!(section(t, k - 1, level).hi(), section(t, k, level).lo());
                    assert_eq!(section(t, k, level).lo(), section(t, 2 * k, level + 1).lo());
                }
            }
        }
    }
}
