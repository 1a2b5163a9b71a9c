//! Directions as two angles: what turns when something is turned by hand. Nothing here is certified.
use super::Vec3;
use std::f64::consts::PI;

/// A vector as length, azimuth and elevation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polar {
    /// Its length.
    pub length: f64,
    /// Angle about the vertical axis, from x towards y, radians, in [-pi, pi].
    pub azimuth: f64,
    /// Angle above the horizontal plane, radians, at most [`Polar::STEEPEST`] either way.
    pub elevation: f64,
}

impl Polar {
    /// Steepest elevation, a little below the vertical: there the azimuth would mean nothing.
    pub const STEEPEST: f64 = 0.4999 * PI;

    /// That of a vector; the zero vector has length 0 and both angles 0. What is steeper than [`Polar::STEEPEST`] is tilted to it.
    #[must_use]
    pub fn of(v: Vec3) -> Self {
        let [x, y, z] = v.0;
        let flat = Vec3::new(x, y, 0.0).length();
        let steep = core_math::atan2(z, flat).clamp(-Self::STEEPEST, Self::STEEPEST);
        Self { length: v.length(), azimuth: core_math::atan2(y, x), elevation: steep }
    }

    /// The vector.
    #[must_use]
    pub fn vector(&self) -> Vec3 {
        let (cos, sin) = (core_math::cos(self.elevation), core_math::sin(self.elevation));
        Vec3::new(cos * core_math::cos(self.azimuth), cos * core_math::sin(self.azimuth), sin) * self.length
    }

    /// Turned by angles in radians; the elevation stops at [`Polar::STEEPEST`].
    #[must_use]
    pub fn turned(self, azimuth: f64, elevation: f64) -> Self {
        let around = self.azimuth + azimuth;
        let around = around - 2.0 * PI * (around / (2.0 * PI)).round();
        let above = (self.elevation + elevation).clamp(-Self::STEEPEST, Self::STEEPEST);
        Self { azimuth: around, elevation: above, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_come_back_and_turn() {
        for v in [Vec3::new(1.0, 2.0, -3.0), Vec3::new(-4.0, 0.0, 0.5), Vec3::new(0.0, -1e-3, 0.0)] {
            assert!((Polar::of(v).vector() - v).length() < 1e-12 * v.length().max(1.0), "{v:?}");
        }
        let turned = Polar::of(Vec3::new(2.0, 0.0, 0.0)).turned(0.5 * PI, 0.0).vector();
        assert!((turned - Vec3::new(0.0, 2.0, 0.0)).length() < 1e-12);
        let above = Polar::of(Vec3::new(2.0, 0.0, 0.0)).turned(0.0, 9.0);
        assert_eq!(above.elevation, Polar::STEEPEST);
        let many = (0..100).fold(above, |p, _| p.turned(1.0, 0.0));
        assert!(many.azimuth.abs() <= PI, "{many:?}");
        assert_eq!(Polar::of(Vec3::default()), Polar { length: 0.0, azimuth: 0.0, elevation: 0.0 });
    }
}
