//! Light of a rectangle on a small patch of surface. For colours: rounded, not certified.
use crate::geom::{Rect, Vec3};
use smallvec::SmallVec;

/// What reaches a patch of a rectangle that nothing hides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Irradiance {
    /// The form factor: the share of all light that would come from a glowing half space.
    pub(super) form: f64,
    /// Share of the rectangle's area above the patch's horizon.
    pub(super) above: f64,
}

/// Of a rectangle that glows evenly to both sides, on a patch at `point` with that unit normal.
///
/// Lambert's formula (*Photometria*, 1760): the part of the polygon above the horizon with corners `v_i` (as unit vectors
/// from the point) gives `1/(2 pi) |sum angle(v_i, v_i+1) (v_i x v_i+1)/|v_i x v_i+1| . n|`.
pub(super) fn irradiance(point: Vec3, normal: Vec3, rect: &Rect) -> Irradiance {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(u, v)| rect.point(u, v) - point);
    let heights = corners.map(|corner| corner.dot(normal));
    if heights.iter().all(|height| *height > 0.0) {
        return Irradiance { form: form(&corners, normal), above: 1.0 };
    }
    // A quadrangle cut by a plane.
    let mut polygon = SmallVec::<[Vec3; 5]>::new();
    for k in 0..4 {
        let (a, b, x, y) = (corners[k], corners[(k + 1) % 4], heights[k], heights[(k + 1) % 4]);
        if x > 0.0 {
            polygon.push(a);
        }
        if (x > 0.0) != (y > 0.0) {
            polygon.push(a + (b - a) * (x / (x - y)));
        }
    }
    if polygon.len() < 3 {
        return Irradiance { form: 0.0, above: 0.0 };
    }
    let first = polygon[0];
    let doubled = polygon.windows(2).map(|w| (w[0] - first).cross(w[1] - first)).fold(Vec3::default(), |s, x| s + x);
    let whole = 8.0 * rect.edge_u.cross(rect.edge_v).length();
    Irradiance { form: form(&polygon, normal), above: (doubled.length() / whole).min(1.0) }
}

/// Lambert's formula for a polygon above the horizon.
fn form(polygon: &[Vec3], normal: Vec3) -> f64 {
    let mut sum = 0.0;
    let mut a = polygon[polygon.len() - 1];
    for &b in polygon {
        let cross = a.cross(b);
        let sine = cross.length();
        if sine > 0.0 {
            sum += core_math::atan2(sine, a.dot(b)) * cross.dot(normal) / sine;
        }
        a = b;
    }
    sum.abs() / std::f64::consts::TAU
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: Vec3 = Vec3([0.0, 0.0, 1.0]);

    #[test]
    fn a_parallel_square_is_the_textbook_one() {
        // From the middle of a square of half side a at height h, four times the corner formula (Howell, C-11):
        // 2/pi (x/sqrt(1+x^2)) atan(x/sqrt(1+x^2)) * 2, with x = a/h.
        for (half, height) in [(0.5, 1.0), (2.0, 1.0), (0.01, 3.0)] {
            let light = Rect::horizontal(Vec3::new(0.0, 0.0, height), 2.0 * half);
            let x: f64 = half / height;
            let s = x / (1.0 + x * x).sqrt();
            let want = 4.0 / std::f64::consts::PI * s * core_math::atan(s);
            let got = irradiance(Vec3::default(), UP, &light);
            assert!((got.form - want).abs() < 1e-12 && (got.above - 1.0).abs() < 1e-12, "{got:?}, {want}");
        }
    }

    #[test]
    fn the_horizon_cuts_and_the_back_is_dark() {
        let wall = Rect {
            center: Vec3::new(2.0, 0.0, 0.0),
            edge_u: Vec3::new(0.0, 1.0, 0.0),
            edge_v: Vec3::new(0.0, 0.0, 1.0),
        };
        let got = irradiance(Vec3::default(), UP, &wall);
        let upper = Rect { center: Vec3::new(2.0, 0.0, 0.5), edge_v: Vec3::new(0.0, 0.0, 0.5), ..wall };
        let half = irradiance(Vec3::default(), UP, &upper);
        assert!((got.above - 0.5).abs() < 1e-12 && (got.form - half.form).abs() < 1e-12 && got.form > 0.01);
        let below = Rect::horizontal(Vec3::new(0.0, 0.0, -1.0), 1.0);
        assert_eq!(irradiance(Vec3::default(), UP, &below), Irradiance { form: 0.0, above: 0.0 });
    }
}
