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
    let mut length_a = a.length();
    for &b in polygon {
        let (cross, length_b) = (a.cross(b), b.length());
        sum += angle_by_sine(cross.dot(cross), a.dot(b), length_a * length_b) * cross.dot(normal);
        (a, length_a) = (b, length_b);
    }
    sum.abs() / std::f64::consts::TAU
}

/// The angle in [0, pi] over its sine times `scale`, of which the square, and the cosine times `scale`, are given. Within 1e-14 of itself, by
/// operations that round alike everywhere, and much faster than a correctly rounded arc tangent: colours claim nothing. Angles of 0 and of pi, which have no sine, give 0.
///
/// The tangent of half the angle is `sine/(scale + cosine)`: an edge of a light that is small beside its distance needs only its square, and no root.
fn angle_by_sine(sine_squared: f64, cosine: f64, scale: f64) -> f64 {
    let over = 1.0 / (scale + cosine);
    let square = sine_squared * over * over;
    // False where it is no number.
    if cosine > 0.0 && square < SMALL {
        return 2.0 * over * arc(square, &SERIES[..3]);
    }
    let sine = sine_squared.sqrt();
    if sine > 0.0 { angle(sine, cosine, scale) / sine } else { 0.0 }
}

/// Below this square six terms of the series of the arc tangent are enough: the next is below `2^-48/13 < 3e-16`.
const SMALL: f64 = 1.0 / 256.0;

/// The angle in [0, pi] whose sine and cosine, both times `scale`, are given.
///
/// The tangent of half the angle, or of half of what it lacks of pi, is in [0, 1], and nothing cancels in it. Halved at most twice more, by
/// `tan(a/2) = tan a/(1 + sqrt(1 + tan^2 a))`, it is below 1/5, where the series of the arc tangent ends after eleven terms: the next
/// is below `0.2^22/23 < 2e-17`.
fn angle(sine: f64, cosine: f64, scale: f64) -> f64 {
    let (mut tangent, mut times) = (sine / (scale + cosine.abs()), 2.0);
    while tangent > 0.2 {
        tangent /= 1.0 + (1.0 + tangent * tangent).sqrt();
        times *= 2.0;
    }
    let acute = times * tangent * arc(tangent * tangent, &SERIES);
    if cosine < 0.0 { std::f64::consts::PI - acute } else { acute }
}

/// The arc tangent over its argument, of which the square is given: `1 - square/3 + square^2/5 - ...`, by squares of it: half as many
/// steps that wait for each other.
fn arc(square: f64, series: &[[f64; 2]]) -> f64 {
    series.iter().rev().fold(0.0, |sum, [a, b]| sum * (square * square) + (a + b * square))
}

/// Of the arc tangent, two by two: `(-1)^k/(2k + 1)`.
const SERIES: [[f64; 2]; 6] = [
    [1.0, -1.0 / 3.0],
    [1.0 / 5.0, -1.0 / 7.0],
    [1.0 / 9.0, -1.0 / 11.0],
    [1.0 / 13.0, -1.0 / 15.0],
    [1.0 / 17.0, -1.0 / 19.0],
    [1.0 / 21.0, 0.0],
];

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
    fn angles_are_those_of_the_arc_tangent() {
        let mut most = 0.0_f64;
        let small = |k: u32| std::f64::consts::PI * core_math::exp2(-f64::from(k) / 8.0);
        for turn in (1..300).flat_map(|k| [small(k), std::f64::consts::PI - small(k)]) {
            let (sine, cosine) = (3.0 * core_math::sin(turn).abs(), 3.0 * core_math::cos(turn));
            let want = core_math::atan2(sine, cosine);
            most = most.max((angle(sine, cosine, 3.0) / want - 1.0).abs());
            let by_sine = angle_by_sine(sine * sine, cosine, 3.0);
            most = most.max((by_sine * sine / want - 1.0).abs());
        }
        assert!(most < 1e-14, "{most}");
        assert_eq!([angle_by_sine(0.0, -1.0, 1.0), angle_by_sine(0.0, 0.0, 0.0)], [0.0; 2], "no sine");
        assert_eq!(angle(0.0, -1.0, 1.0), std::f64::consts::PI);
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
