//! Rectangles of light.
use super::{Box3, Vec3};
use antumbra_interval::Interval;

/// A rectangle `{center + u edge_u + v edge_v : u, v in [-1, 1]}` of any orientation: the exact numbers stored here
/// *are* the light. The paper's lights are squares parallel to two axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rect {
    /// Middle.
    pub center: Vec3,
    /// Half of the first edge.
    pub edge_u: Vec3,
    /// Half of the second edge.
    pub edge_v: Vec3,
}

impl Rect {
    /// A horizontal square (parallel to x and y) of side `side`.
    #[must_use]
    pub fn horizontal(center: Vec3, side: f64) -> Self {
        Self { center, edge_u: Vec3::new(0.5 * side, 0.0, 0.0), edge_v: Vec3::new(0.0, 0.5 * side, 0.0) }
    }

    /// The same middle, `factor` times the edges.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self { center: self.center, edge_u: self.edge_u * factor, edge_v: self.edge_v * factor }
    }

    /// Enclosure of the part with parameters in `u` and `v`: for rectangles parallel to the axes the paper's
    /// (L_x, L_y, L_z), one of which is a point up to rounding.
    #[must_use]
    pub fn part(&self, u: Interval, v: Interval) -> Box3 {
        Box3(std::array::from_fn(|i| {
            // A zero edge contributes exactly nothing: skipping it keeps the coordinate a point.
            let term = |k: f64, s: Interval| if k == 0.0 { Interval::ZERO } else { Interval::point(k) * s };
            match (self.edge_u[i] == 0.0, self.edge_v[i] == 0.0) {
                (true, true) => Interval::point(self.center[i]),
                _ => Interval::point(self.center[i]) + (term(self.edge_u[i], u) + term(self.edge_v[i], v)),
            }
        }))
    }

    /// The whole rectangle.
    #[must_use]
    pub fn whole(&self) -> Box3 {
        self.part(Interval::new(-1.0, 1.0), Interval::new(-1.0, 1.0))
    }

    /// Tile `(column, row)` of `n x n` equal tiles. The tiles cover the rectangle: edges are enclosed.
    #[must_use]
    pub fn tile(&self, column: usize, row: usize, n: usize) -> Box3 {
        let range = |k: usize| {
            let edge = |k: usize| {
                Interval::point(k as f64) / Interval::point(n as f64) * Interval::point(2.0) - Interval::ONE
            };
            edge(k).hull(edge(k + 1)).intersection(Interval::new(-1.0, 1.0))
        };
        self.part(range(column), range(row))
    }

    /// The point with parameters `(u, v)`, rounded.
    #[must_use]
    pub fn point(&self, u: f64, v: f64) -> Vec3 {
        self.center + self.edge_u * u + self.edge_v * v
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_the_light_and_little_more() {
        let light = Rect::horizontal(Vec3::new(2.0, 3.0, 5.0), 0.25);
        let whole = light.whole();
        assert_eq!(whole[2], Interval::point(5.0), "the light is flat");
        let mut hull: Option<Box3> = None;
        for row in 0..7 {
            for column in 0..7 {
                let tile = light.tile(column, row, 7);
                assert!(tile[0].width() < 0.25 / 7.0 + 1e-12);
                hull = Some(hull.map_or(tile, |h| h.hull(tile)));
                if column > 0 {
                    assert!(light.tile(column - 1, row, 7)[0].hi() >= tile[0].lo(), "no gap");
                }
            }
        }
        let hull = hull.unwrap();
        for axis in 0..3 {
            assert!(hull[axis].lo() <= whole[axis].lo().next_up().next_up() && hull[axis].contains(light.center[axis]));
        }
        assert!(hull[0].contains(1.875) && hull[0].contains(2.125) && hull[0].width() < 0.25 + 1e-12);
    }

    #[test]
    fn a_tilted_light_is_enclosed() {
        let light = Rect {
            center: Vec3::new(0.0, 0.0, 1.0),
            edge_u: Vec3::new(0.1, 0.2, 0.3),
            edge_v: Vec3::new(-0.2, 0.1, 0.0),
        };
        let whole = light.whole();
        for (u, v) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (0.3, -0.7)] {
            for axis in 0..3 {
                assert!(whole[axis].contains(light.point(u, v)[axis]));
            }
        }
    }
}
