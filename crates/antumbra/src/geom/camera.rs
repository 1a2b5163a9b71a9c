//! The camera and its film.
use super::{Beam, Box3, Vec3, vector::axes};
use antumbra_interval::Interval;
use std::ops::Range;

/// A perspective camera. The exact numbers stored here *are* the camera of which a picture speaks: the ray through the
/// film coordinates `(x, y)` in `[-1, 1]^2` has direction `forward + x right + y up` and leaves from `eye`; `forward`
/// reaches the image plane at `t = 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where all rays start.
    pub eye: Vec3,
    /// Unit vector (rounded) of the view.
    pub forward: Vec3,
    /// From the middle of the film to its right edge.
    pub right: Vec3,
    /// From the middle of the film to its upper edge.
    pub up: Vec3,
}

impl Camera {
    /// A camera at `eye` that looks at `target`, the z axis upwards, with the full angle `fov_deg` (degrees) over the
    /// shorter side of a film of `width / height = aspect`. The image's right is `forward x up`.
    #[must_use]
    pub fn look_at(eye: Vec3, target: Vec3, fov_deg: f64, aspect: f64) -> Self {
        let forward = (target - eye).normalized();
        let vertical = Vec3::new(0.0, 0.0, 1.0);
        let side = forward.cross(vertical).normalized();
        // Straight up or down: any horizontal direction will do.
        let side = if side == Vec3::default() { Vec3::new(1.0, 0.0, 0.0) } else { side };
        let half = tan_deg(0.5 * fov_deg);
        let (half_x, half_y) = if aspect >= 1.0 { (half * aspect, half) } else { (half, half / aspect) };
        Self { eye, forward, right: side * half_x, up: side.cross(forward) * half_y }
    }
}

impl Camera {
    /// Where a point is seen: its film coordinates, in [-1, 1] where it is in the picture, and its parameter along the view axis;
    /// `None` behind the camera. Rounded: for handles that are drawn over a picture.
    #[must_use]
    pub fn project(&self, point: Vec3) -> Option<([f64; 2], f64)> {
        let to = point - self.eye;
        // right and up are square to forward.
        let t = to.dot(self.forward);
        let film = |axis: Vec3| to.dot(axis) / (t * axis.dot(axis));
        (t > 0.0).then(|| ([film(self.right), film(self.up)], t))
    }

    /// The point at film coordinates and a parameter along the view axis: the inverse of [`Camera::project`].
    #[must_use]
    pub fn point(&self, [x, y]: [f64; 2], t: f64) -> Vec3 {
        self.eye + (self.forward + self.right * x + self.up * y) * t
    }
}

/// Tangent of an angle in degrees.
fn tan_deg(angle_deg: f64) -> f64 {
    core_math::tan(angle_deg.to_radians())
}

/// The film: which rays belong to which pixel. Row 0 is at the top.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film {
    /// Where the rays come from.
    pub camera: Camera,
    /// Pixels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

impl Film {
    /// Enclosure of the film coordinate of pixel edge number `k` of `n`: `2k/n - 1`.
    fn edge(k: usize, n: usize) -> Interval {
        Interval::point(2.0 * k as f64) / Interval::point(n as f64) - Interval::ONE
    }

    /// Enclosure of the directions of all rays with film coordinates in `x` and `y`.
    fn directions(&self, x: Interval, y: Interval) -> Box3 {
        let c = &self.camera;
        Box3(axes(|i| Interval::point(c.forward[i]) + (x.mul_point(c.right[i]) + y.mul_point(c.up[i]))))
    }

    /// Film coordinates of the pixels `columns x rows` (half-open ranges), y upwards.
    #[must_use]
    pub fn window(&self, columns: Range<usize>, rows: Range<usize>) -> [Interval; 2] {
        [
            Self::edge(columns.start, self.width).hull(Self::edge(columns.end, self.width)),
            -Self::edge(rows.start, self.height).hull(Self::edge(rows.end, self.height)),
        ]
    }

    /// What symbol 1 of the fan of a window of the film ([`Film::fan_of`]), of which `x` are the film coordinates across, is on the centre rays of
    /// a column of pixels in it.
    #[must_use]
    pub fn column_symbol(&self, x: Interval, column: usize) -> Interval {
        Self::symbol(x, Self::middle(column, self.width))
    }

    /// What symbol 2 is on those of a row of pixels; `y` are the film coordinates upwards.
    #[must_use]
    pub fn row_symbol(&self, y: Interval, row: usize) -> Interval {
        Self::symbol(y, -Self::middle(row, self.height))
    }

    /// The symbol that is -1 at one end of the window and 1 at the other, at a place in it: the fan's coordinates are exactly linear in it, up to their
    /// error ([`Affine::spanning`](antumbra_interval::affine::Affine::spanning)). Where the place is in the window, it is in `[-1, 1]`.
    fn symbol(window: Interval, at: Interval) -> Interval {
        let [lo, hi] = [window.lo(), window.hi()].map(Interval::point);
        (((at - lo) + (at - hi)) / (hi - lo)).intersection(Interval::new(-1.0, 1.0))
    }

    /// Enclosure of the film coordinate of the middle of pixel number `k` of `n`.
    fn middle(k: usize, n: usize) -> Interval {
        Interval::point((2 * k + 1) as f64) / Interval::point(n as f64) - Interval::ONE
    }

    /// The beam of one pixel: it contains every ray of the pixel's area (paper, section 3).
    #[must_use]
    pub fn beam(&self, column: usize, row: usize) -> Beam {
        let [x, y] = self.window(column..column + 1, row..row + 1);
        Beam { origin: self.camera.eye, direction: self.directions(x, y) }
    }

    /// The beam of the pixel's centre ray, thin up to rounding.
    #[must_use]
    pub fn ray(&self, column: usize, row: usize) -> Beam {
        self.sub_ray(column, row, 0, 0, 1)
    }

    /// Film coordinates of the middle of part `(i, j)` of the `n x n` parts of a pixel; `j` counts downwards.
    #[must_use]
    pub fn place(&self, column: usize, row: usize, i: usize, j: usize, n: usize) -> [Interval; 2] {
        [Self::middle(column * n + i, self.width * n), -Self::middle(row * n + j, self.height * n)]
    }

    /// The ray through the middle of part `(i, j)` of the `n x n` parts of a pixel, thin up to rounding.
    #[must_use]
    pub fn sub_ray(&self, column: usize, row: usize, i: usize, j: usize, n: usize) -> Beam {
        let [x, y] = self.place(column, row, i, j, n);
        Beam { origin: self.camera.eye, direction: self.directions(x, y) }
    }

    /// The centre rays of the pixels `columns x rows` (half-open ranges).
    #[must_use]
    pub fn rays(&self, columns: Range<usize>, rows: Range<usize>) -> Rays {
        let Camera { eye, forward, right, up } = self.camera;
        let corner = [columns.start, rows.start];
        let across = columns.map(|k| Self::middle(k, self.width)).map(|x| axes(|i| x.mul_point(right[i]))).collect();
        let upward = rows.map(|k| -Self::middle(k, self.height)).map(|y| axes(|i| y.mul_point(up[i]))).collect();
        Rays { eye, forward: axes(|i| Interval::point(forward[i])), corner, across, upward }
    }
}

/// The centre rays of a block of pixels: what a row or column has in common is computed once.
#[derive(Clone, Debug)]
pub struct Rays {
    eye: Vec3,
    forward: [Interval; 3],
    corner: [usize; 2],
    /// Of each column the part of the direction to the right, of each row the part upwards.
    across: Vec<[Interval; 3]>,
    upward: Vec<[Interval; 3]>,
}

impl Rays {
    /// The same as [`Film::ray`], bit for bit. Panics if the pixel is not in the block.
    #[must_use]
    #[inline]
    pub fn ray(&self, column: usize, row: usize) -> Beam {
        let (across, upward) = (&self.across[column - self.corner[0]], &self.upward[row - self.corner[1]]);
        Beam { origin: self.eye, direction: Box3(axes(|i| self.forward[i] + (across[i] + upward[i]))) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_lie_inside_the_beams_of_their_pixels() {
        let camera = Camera::look_at(Vec3::new(4.0, -2.0, 2.0), Vec3::default(), 30.5, 1.0);
        let film = Film { camera, width: 37, height: 37 };
        for (column, row) in [(0, 0), (36, 36), (18, 18), (3, 29)] {
            let (beam, ray) = (film.beam(column, row), film.ray(column, row));
            for axis in 0..3 {
                let (b, r) = (beam.direction[axis], ray.direction[axis]);
                assert!(b.lo() <= r.lo() && r.hi() <= b.hi() && r.width() < 1e-14);
            }
        }
    }

    #[test]
    fn rays_of_a_block_are_those_of_its_pixels() {
        let camera = Camera::look_at(Vec3::new(4.0, -2.0, 2.0), Vec3::default(), 30.5, 37.0 / 23.0);
        let film = Film { camera, width: 37, height: 23 };
        let rays = film.rays(32..37, 3..23);
        for (column, row) in (32..37).flat_map(|i| (3..23).map(move |j| (i, j))) {
            assert_eq!(rays.ray(column, row), film.ray(column, row));
        }
    }

    #[test]
    fn symbols_are_those_of_the_fan() {
        let camera = Camera::look_at(Vec3::new(4.0, -2.0, 2.0), Vec3::default(), 30.5, 37.0 / 23.0);
        let film = Film { camera, width: 37, height: 23 };
        // The last block is clipped at the picture's border.
        for (columns, rows) in [(0..8, 0..8), (32..37, 16..23), (36..37, 22..23)] {
            let (fan, [x, y]) = (film.fan(columns.clone(), rows.clone()), film.window(columns.clone(), rows.clone()));
            for (column, row) in columns.clone().flat_map(|i| rows.clone().map(move |j| (i, j))) {
                let symbols = [film.column_symbol(x, column), film.row_symbol(y, row)];
                assert!(symbols.iter().all(|s| s.width() < 1e-11 && s.magnitude() <= 1.0), "{symbols:?}");
                for k in 0..3 {
                    let [_, a, b] = *fan.direction[k].coefficients();
                    let at = [a, b].into_iter().zip(symbols).fold(
                        Interval::point(fan.direction[k].centre())
                            + Interval::new(-1.0, 1.0).mul_point(fan.direction[k].error()),
                        |sum, (a, s)| sum + s.mul_point(a),
                    );
                    let ray = film.ray(column, row).direction[k];
                    assert!(at.possibly_intersects(ray) && at.hull(ray).width() < 1e-13, "{at:?} {ray:?}");
                }
                // The parts of a pixel lie around its middle, the first one up and left.
                let [mid, first] = [film.place(column, row, 0, 0, 1), film.place(column, row, 0, 0, 4)];
                assert!(first[0].certainly_less(mid[0]) && mid[1].certainly_less(first[1]));
            }
        }
    }

    #[test]
    fn the_image_is_upright_and_not_mirrored() {
        // From -y towards the origin: +x is to the right, +z up.
        let camera = Camera::look_at(Vec3::new(0.0, -3.0, 0.0), Vec3::default(), 90.0, 2.0);
        assert!(camera.right[0] > 0.0 && camera.up[2] > 0.0);
        assert!((camera.up.length() - 1.0).abs() < 1e-12, "the angle spans the shorter side");
        assert!((camera.right.length() - 2.0).abs() < 1e-12);
        let film = Film { camera, width: 4, height: 2 };
        let d = film.ray(3, 0).direction.mid();
        assert!(d[0] > 0.0 && d[2] > 0.0, "the last pixel of the top row is up and right");
    }

    #[test]
    fn points_are_seen_where_their_rays_go() {
        let camera = Camera::look_at(Vec3::new(4.0, -2.0, 2.0), Vec3::default(), 30.5, 1.5);
        let p = Vec3::new(0.3, -0.2, 0.5);
        let (film, t) = camera.project(p).unwrap();
        assert!((camera.point(film, t) - p).length() < 1e-12);
        assert!(camera.project(Vec3::new(8.0, -4.0, 4.0)).is_none(), "it is behind");
        let ([x, y], _) = camera.project(Vec3::default()).unwrap();
        assert!(x.abs() < 1e-12 && y.abs() < 1e-12, "the target is in the middle");
    }

    #[test]
    fn looking_straight_down_works() {
        let camera = Camera::look_at(Vec3::new(0.0, 0.0, 5.0), Vec3::default(), 40.0, 1.0);
        assert!(camera.right.length() > 0.1 && camera.up.length() > 0.1);
    }
}
