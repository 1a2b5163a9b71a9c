//! Fans of rays in affine form: camera frusta and shadow beams.
use super::{Box3, Rect, Vec3, camera::Film, vector::axes};
use antumbra_interval::Interval;
use antumbra_interval::affine::{Affine, Slope};
use std::ops::Range;

/// Rays `P + t D(s_1, s_2)`: the apex is known to lie in a box, the direction is a linear function of two symbols in
/// `[-1, 1]` (film coordinates, or coordinates on a light). Symbol 0 is kept for t.
///
/// Unlike a [`Beam`](super::Beam), a fan remembers which ray is which: so enclosures over it are of first order.
#[derive(Clone, Copy, Debug)]
pub struct Fan {
    /// Where the rays start.
    pub apex: Box3,
    /// Their directions.
    pub direction: [Affine<3>; 3],
}

impl Fan {
    /// The fan from a box of possible apexes to the part `u x v` of a light, which it reaches at `t = 1`.
    #[must_use]
    #[inline]
    pub fn towards(apex: Box3, light: &Rect, u: Interval, v: Interval) -> Self {
        let (u, v) = (Affine::spanning(1, u), Affine::spanning(2, v));
        let direction = axes(|k| {
            let span = u.mul_f64(light.edge_u[k]) + v.mul_f64(light.edge_v[k]);
            span.add_f64(light.center[k]).add_interval(-apex[k])
        });
        Self { apex, direction }
    }

    /// Enclosure of all directions.
    #[must_use]
    pub fn directions(&self) -> Box3 {
        Box3(self.direction.map(|d| d.range()))
    }

    /// The points at parameters in `t`.
    #[must_use]
    #[inline]
    pub fn at(&self, t: Interval) -> [Affine<3>; 3] {
        let t = Affine::spanning(0, t);
        axes(|k| (t * self.direction[k]).add_interval(self.apex[k]))
    }

    /// The same points, with the apex split off.
    #[must_use]
    #[inline]
    pub fn slopes_at(&self, t: Interval) -> [Slope<Interval, 3>; 3] {
        let t = Affine::spanning(0, t);
        axes(|k| Slope::coordinate(self.apex[k], t, self.direction[k]))
    }

    /// Box of the points at parameters in `t`.
    #[must_use]
    pub fn box_at(&self, t: Interval) -> Box3 {
        Box3(self.at(t).map(|x| x.range()))
    }
}

impl Film {
    /// The fan of all rays through the pixels `columns x rows` (half-open ranges).
    #[must_use]
    pub fn fan(&self, columns: Range<usize>, rows: Range<usize>) -> Fan {
        let [x, y] = self.window(columns, rows);
        self.fan_of(x, y)
    }

    /// The fan of all rays with film coordinates in `x` and `y`.
    #[must_use]
    pub fn fan_of(&self, x: Interval, y: Interval) -> Fan {
        let (x, y) = (Affine::spanning(1, x), Affine::spanning(2, y));
        let Vec3(forward) = self.camera.forward;
        let direction = axes(|k| (x.mul_f64(self.camera.right[k]) + y.mul_f64(self.camera.up[k])).add_f64(forward[k]));
        Fan { apex: self.camera.eye.to_box(), direction }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Camera;

    #[test]
    fn a_fan_agrees_with_the_beam_of_its_pixel_and_is_no_wider() {
        let camera = Camera::look_at(Vec3::new(3.0, -4.0, 3.0), Vec3::default(), 25.5, 1.0);
        let film = Film { camera, width: 64, height: 64 };
        let t = Interval::new(4.0, 4.5);
        for (column, row) in [(0, 0), (31, 40), (63, 5)] {
            let (fan, beam) = (film.fan(column..column + 1, row..row + 1), film.beam(column, row));
            let ray = film.ray(column, row);
            for k in 0..3 {
                let (f, b, r) = (fan.box_at(t)[k], beam.at(t)[k], ray.at(t)[k]);
                assert!(f.lo() <= r.lo() + 1e-12 && r.hi() - 1e-12 <= f.hi(), "the middle ray is in the fan");
                assert!(f.width() <= b.width() * 1.05, "{} {}", f.width(), b.width());
            }
        }
    }

    #[test]
    fn a_fan_reaches_its_light_at_one() {
        let light = Rect {
            center: Vec3::new(0.0, 0.3, 2.0),
            edge_u: Vec3::new(0.5, 0.1, 0.0),
            edge_v: Vec3::new(0.0, 0.2, 0.4),
        };
        let (u, v) = (Interval::new(-1.0, 0.5), Interval::new(0.25, 1.0));
        let apex = Vec3::new(0.1, -0.2, 0.3).to_box();
        let fan = Fan::towards(apex, &light, u, v);
        let end = fan.box_at(Interval::ONE);
        let part = light.part(u, v);
        for k in 0..3 {
            assert!((end[k].lo() - part[k].lo()).abs() < 1e-12 && (end[k].hi() - part[k].hi()).abs() < 1e-12);
        }
    }
}
