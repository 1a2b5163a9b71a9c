//! Sheets of parameters over a light: where, along each ray, a slab of a shadow beam begins or ends.
use antumbra_interval::Interval;
use antumbra_interval::affine::Affine;
use antumbra_interval::round::{add_up, mul_up, sub_down, sub_up};

/// The parameter `t(u, v) = k + u_slope u + v_slope v` on the ray to the point `(u, v)` of a light: exactly this function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheet {
    /// At the middle of the light.
    pub k: f64,
    /// Slopes by u and v.
    pub slopes: [f64; 2],
}

/// Upper bound of the products of an interval that does not cross 0, as the difference of two different numbers does not, with one from
/// `from` to `to`.
///
/// Of a number `s >= 0` the greatest product is one with `to`: that of the least s if `to <= 0`, else of the greatest. Products with 0 are
/// left out: they are exactly 0.
#[inline]
fn product_up([low, high]: [f64; 2], [from, to]: [f64; 2]) -> f64 {
    let ([low, high], to) = if high <= 0.0 { ([-high, -low], -from) } else { ([low, high], to) };
    if to == 0.0 { 0.0 } else { mul_up(if to < 0.0 { low } else { high }, to) }
}

impl Sheet {
    /// The same parameter on every ray.
    #[must_use]
    pub const fn level(t: f64) -> Self {
        Self { k: t, slopes: [0.0; 2] }
    }

    /// Encloses the difference `self - o` over the part `u x v` of the light: exactly 0 where both are the same.
    ///
    /// Equal slopes are left out: their difference is exactly 0, and most sheets that are compared are parallel.
    #[must_use]
    #[inline]
    pub fn minus(&self, o: &Self, part: [Interval; 2]) -> Interval {
        Interval::try_new(-o.above_by(self, part), self.above_by(o, part)).unwrap_or(Interval::ENTIRE)
    }

    /// Upper bound of `self - o` over the part; NaN, which proves nothing, where numbers are not finite.
    #[inline]
    fn above_by(&self, o: &Self, part: [Interval; 2]) -> f64 {
        let k = sub_up(self.k, o.k);
        if self.slopes == o.slopes { k } else { self.tilted_above_by(o, k, part) }
    }

    fn tilted_above_by(&self, o: &Self, mut hi: f64, part: [Interval; 2]) -> f64 {
        for (i, along) in part.into_iter().enumerate() {
            if self.slopes[i] != o.slopes[i] {
                let slope = [sub_down(self.slopes[i], o.slopes[i]), sub_up(self.slopes[i], o.slopes[i])];
                hi = add_up(hi, product_up(slope, [along.lo(), along.hi()]));
            }
        }
        hi
    }

    /// Whether all numbers are finite: only then may anything else be asked.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.k.is_finite() && self.slopes.iter().all(|s| s.is_finite())
    }

    /// Encloses the parameters over the part `u x v` of the light.
    #[must_use]
    pub fn range(&self, part: [Interval; 2]) -> Interval {
        self.minus(&Self::level(0.0), part)
    }

    /// A sheet with the given slopes below this one over the part.
    #[must_use]
    pub fn below(&self, slopes: [f64; 2], part: [Interval; 2]) -> Self {
        Self { k: self.minus(&Self { k: 0.0, slopes }, part).lo(), slopes }
    }

    /// A sheet with the given slopes above this one over the part.
    #[must_use]
    pub fn above(&self, slopes: [f64; 2], part: [Interval; 2]) -> Self {
        Self { k: self.minus(&Self { k: 0.0, slopes }, part).hi(), slopes }
    }

    /// Whether this sheet is proved to lie at or below another over the part.
    #[must_use]
    pub fn certainly_at_most(&self, o: &Self, part: [Interval; 2]) -> bool {
        self.is_finite() && o.is_finite() && self.above_by(o, part) <= 0.0
    }

    /// The sheet as a form, `u` and `v` given as forms.
    #[must_use]
    #[inline]
    pub fn form(&self, symbols: &[Affine<3>; 2]) -> Affine<3> {
        self.tilt(symbols).add_f64(self.k)
    }

    /// What of it moves with `u` and `v`, which are given as forms.
    #[must_use]
    #[inline]
    pub fn tilt(&self, [u, v]: &[Affine<3>; 2]) -> Affine<3> {
        u.mul_f64(self.slopes[0]) + v.mul_f64(self.slopes[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn covers_lie_beyond_what_they_cover() {
        let part = [Interval::new(-0.3, 0.7), Interval::new(0.1, 0.2)];
        let sheet = Sheet { k: 0.5, slopes: [0.1, -0.2] };
        for slopes in [[0.0, 0.0], [0.3, 0.1], [0.1, -0.2], [-1.0, 1e-9]] {
            let (below, above) = (sheet.below(slopes, part), sheet.above(slopes, part));
            assert!(below.certainly_at_most(&sheet, part) || slopes != sheet.slopes);
            for u in [-0.3, 0.0, 0.7] {
                for v in [0.1, 0.15, 0.2] {
                    let at = |s: &Sheet| s.k + s.slopes[0] * u + s.slopes[1] * v;
                    assert!(at(&below) <= at(&sheet) + 1e-15 && at(&sheet) <= at(&above) + 1e-15);
                }
            }
            let gap = (above.k - below.k) - 0.5 * ((slopes[0] - 0.1).abs() * 2.0 + (slopes[1] + 0.2).abs() * 0.2);
            assert!(gap.abs() < 1e-14, "{gap}: no more than needed");
        }
        let far = sheet.minus(&Sheet::level(0.0), part).hi();
        assert!((far - (0.5 + 0.07 - 0.02)).abs() < 1e-14, "{far}: at u = 0.7, v = 0.1");
        assert_eq!(sheet.minus(&sheet, part), Interval::ZERO);
        assert_eq!(sheet.below(sheet.slopes, part), sheet, "the same sheet is its own cover");
        assert!(
            !Sheet::level(0.5).certainly_at_most(&sheet, part) && !sheet.certainly_at_most(&Sheet::level(0.5), part)
        );
    }
}
