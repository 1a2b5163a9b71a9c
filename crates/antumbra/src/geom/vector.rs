//! Exact points and vectors of `f64`, and boxes of intervals.
use antumbra_interval::Interval;
use serde::{Deserialize, Serialize};
use std::ops::{Add, Index, Mul, Neg, Sub};

/// A point or a vector whose coordinates are exactly these numbers. Its operations round to nearest: they serve
/// framing, shading and the choice of a search path, never a proof.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Vec3(pub [f64; 3]);

impl Vec3 {
    /// From coordinates.
    #[must_use]
    pub const fn new(x: f64, y: f64, z: f64) -> Self {
        Self([x, y, z])
    }

    /// Scalar product.
    #[must_use]
    pub fn dot(self, o: Self) -> f64 {
        self.0[0] * o.0[0] + self.0[1] * o.0[1] + self.0[2] * o.0[2]
    }

    /// Vector product.
    #[must_use]
    pub fn cross(self, o: Self) -> Self {
        let ([a, b, c], [d, e, f]) = (self.0, o.0);
        Self([b * f - c * e, c * d - a * f, a * e - b * d])
    }

    /// Length.
    #[must_use]
    pub fn length(self) -> f64 {
        self.dot(self).sqrt()
    }

    /// The vector of length 1 in this direction, or zero where there is none (zero, infinite or NaN coordinates).
    #[must_use]
    pub fn normalized(self) -> Self {
        let length = self.length();
        if length > 0.0 && length.is_finite() { self * (1.0 / length) } else { Self::default() }
    }

    /// The box that holds just this point.
    #[must_use]
    pub fn to_box(self) -> Box3 {
        Box3(self.0.map(Interval::point))
    }
}

impl Index<usize> for Vec3 {
    type Output = f64;

    fn index(&self, axis: usize) -> &f64 {
        &self.0[axis]
    }
}

impl Add for Vec3 {
    type Output = Self;

    fn add(self, o: Self) -> Self {
        Self(axes(|i| self.0[i] + o.0[i]))
    }
}

impl Sub for Vec3 {
    type Output = Self;

    fn sub(self, o: Self) -> Self {
        Self(axes(|i| self.0[i] - o.0[i]))
    }
}

impl Mul<f64> for Vec3 {
    type Output = Self;

    fn mul(self, k: f64) -> Self {
        Self(self.0.map(|x| x * k))
    }
}

impl Neg for Vec3 {
    type Output = Self;

    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

/// An axis-aligned box, one interval per coordinate; as an enclosure it holds every point it stands for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Box3(pub [Interval; 3]);

/// One value for each axis. (`std::array::from_fn` leaves calls in the hot loops.)
#[inline(always)]
pub(crate) fn axes<T>(of: impl Fn(usize) -> T) -> [T; 3] {
    [of(0), of(1), of(2)]
}

impl Box3 {
    /// The cube `[-half, half]^3`.
    #[must_use]
    pub fn cube(half: f64) -> Self {
        Self([Interval::new(-half, half); 3])
    }

    /// Smallest box that contains both.
    #[must_use]
    pub fn hull(self, o: Self) -> Self {
        Self(axes(|i| self.0[i].hull(o.0[i])))
    }

    /// Common part, `None` if there is none.
    #[must_use]
    pub fn intersection(self, o: Self) -> Option<Self> {
        let common = Self(axes(|i| self.0[i].intersection(o.0[i])));
        (!common.0.iter().any(|i| i.is_empty())).then_some(common)
    }

    /// A point near the middle.
    #[must_use]
    pub fn mid(self) -> Vec3 {
        Vec3(self.0.map(Interval::mid))
    }

    /// Half the lengths of the edges, rounded up.
    #[must_use]
    pub fn half_extent(self) -> Vec3 {
        Vec3(self.0.map(|i| 0.5 * i.width()))
    }
}

impl Index<usize> for Box3 {
    type Output = Interval;

    fn index(&self, axis: usize) -> &Interval {
        &self.0[axis]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_follow_the_right_hand_rule() {
        let (x, y) = (Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0));
        assert_eq!(x.cross(y), Vec3::new(0.0, 0.0, 1.0));
        assert_eq!(Vec3::default().normalized(), Vec3::default());
        assert_eq!(Vec3::new(f64::NAN, 0.0, 0.0).normalized(), Vec3::default());
        assert_eq!(Vec3::new(3.0, 4.0, 0.0).length(), 5.0);
    }

    #[test]
    fn boxes_meet_and_join() {
        let (a, b) = (Box3::cube(1.0), Box3([Interval::new(0.5, 2.0); 3]));
        assert_eq!(a.intersection(b), Some(Box3([Interval::new(0.5, 1.0); 3])));
        assert_eq!(a.hull(b), Box3([Interval::new(-1.0, 2.0); 3]));
        assert_eq!(a.intersection(Box3([Interval::new(3.0, 4.0); 3])), None);
    }
}
