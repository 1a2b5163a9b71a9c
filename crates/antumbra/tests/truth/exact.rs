//! Plane geometry in exact rational arithmetic: polygons on a rectangle of light.
use antumbra::geom::{Rect, Vec3};
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

pub(crate) type Point3 = [BigRational; 3];
/// A place on the light: its coordinates `(u, v)`; the light is the square `[-1, 1]^2`.
pub(crate) type Place = [BigRational; 2];

/// The exact value of a number of the machine.
pub(crate) fn exact(x: f64) -> BigRational {
    BigRational::from_float(x).unwrap()
}

pub(crate) fn ratio(n: i64, d: i64) -> BigRational {
    BigRational::new(n.into(), d.into())
}

pub(crate) fn point(p: Vec3) -> Point3 {
    p.0.map(exact)
}

fn minus(a: &Point3, b: &Point3) -> Point3 {
    std::array::from_fn(|k| &a[k] - &b[k])
}

pub(crate) fn dot(a: &Point3, b: &Point3) -> BigRational {
    (0..3).map(|k| &a[k] * &b[k]).fold(BigRational::zero(), |s, x| s + x)
}

fn det(a: &Point3, b: &Point3, c: &Point3) -> BigRational {
    let cross = [&b[1] * &c[2] - &b[2] * &c[1], &b[2] * &c[0] - &b[0] * &c[2], &b[0] * &c[1] - &b[1] * &c[0]];
    dot(a, &cross)
}

/// Where the line from `p` through `c` meets the plane of the light: `p + s (c - p) = center + u edge_u + v edge_v`, by
/// Cramer's rule. `None` if it meets it at `s < 1` or never: then c is not between p and the light.
pub(crate) fn project(p: &Point3, c: &Point3, light: &Rect) -> Option<Place> {
    let (eu, ev) = (point(light.edge_u), point(light.edge_v));
    let back = minus(p, c);
    let right = minus(p, &point(light.center));
    // u eu + v ev + s (p - c) = p - center.
    let d = det(&eu, &ev, &back);
    if d.is_zero() {
        return None;
    }
    let s = det(&eu, &ev, &right) / &d;
    (s >= BigRational::one()).then(|| [det(&right, &ev, &back) / &d, det(&eu, &right, &back) / &d])
}

/// The whole light, counter-clockwise.
pub(crate) fn square() -> Vec<Place> {
    [(-1, -1), (1, -1), (1, 1), (-1, 1)].map(|(u, v)| [ratio(u, 1), ratio(v, 1)]).to_vec()
}

/// The part of a convex polygon with `a u + b v + c >= 0`.
pub(crate) fn clip(polygon: &[Place], a: &BigRational, b: &BigRational, c: &BigRational) -> Vec<Place> {
    let value = |p: &Place| a * &p[0] + b * &p[1] + c;
    let mut out = Vec::new();
    for (k, p) in polygon.iter().enumerate() {
        let q = &polygon[(k + 1) % polygon.len()];
        let (f, g) = (value(p), value(q));
        if !f.is_negative() {
            out.push(p.clone());
        }
        if (f.is_positive() && g.is_negative()) || (f.is_negative() && g.is_positive()) {
            let s = &f / (&f - &g);
            out.push(std::array::from_fn(|i| &p[i] + &s * (&q[i] - &p[i])));
        }
    }
    out
}

/// Area of a polygon, counter-clockwise.
pub(crate) fn area(polygon: &[Place]) -> BigRational {
    let twice = (0..polygon.len()).fold(BigRational::zero(), |sum, k| {
        let (p, q) = (&polygon[k], &polygon[(k + 1) % polygon.len()]);
        sum + &p[0] * &q[1] - &p[1] * &q[0]
    });
    twice / ratio(2, 1)
}

/// Twice the signed area of a triangle.
fn turn(a: &Place, b: &Place, c: &Place) -> BigRational {
    (&b[0] - &a[0]) * (&c[1] - &a[1]) - (&b[1] - &a[1]) * (&c[0] - &a[0])
}

/// Convex hull, counter-clockwise (monotone chain).
pub(crate) fn hull(mut points: Vec<Place>) -> Vec<Place> {
    points.sort();
    points.dedup();
    let half = |points: &mut dyn Iterator<Item = &Place>| {
        let mut chain: Vec<Place> = Vec::new();
        for p in points {
            while chain.len() >= 2 && !turn(&chain[chain.len() - 2], &chain[chain.len() - 1], p).is_positive() {
                chain.pop();
            }
            chain.push(p.clone());
        }
        chain.pop();
        chain
    };
    let mut lower = half(&mut points.iter());
    lower.extend(half(&mut points.iter().rev()));
    lower
}

/// The share of the light that the convex body with these corners leaves visible from `p`; the body lies between p and
/// the plane of the light.
pub(crate) fn share_beside(p: &Point3, corners: &[Point3], light: &Rect) -> BigRational {
    let shadow = hull(corners.iter().map(|c| project(p, c, light).expect("in between")).collect());
    // The part of the square inside all edges of the shadow.
    let mut blocked = square();
    for k in 0..shadow.len() {
        let (a, b) = (&shadow[k], &shadow[(k + 1) % shadow.len()]);
        // Inside is where turn(a, b, (u, v)) >= 0.
        let (du, dv) = (&b[0] - &a[0], &b[1] - &a[1]);
        let c = &dv * &a[0] - &du * &a[1];
        blocked = clip(&blocked, &-dv, &du, &c);
        if blocked.is_empty() {
            break;
        }
    }
    BigRational::one() - area(&blocked) / ratio(4, 1)
}

/// The share of the light with `n . (q - p) > 0`.
pub(crate) fn share_above(p: &Point3, n: &Point3, light: &Rect) -> BigRational {
    let [center, eu, ev] = [light.center, light.edge_u, light.edge_v].map(point);
    let above = clip(&square(), &dot(n, &eu), &dot(n, &ev), &dot(n, &minus(&center, p)));
    area(&above) / ratio(4, 1)
}
