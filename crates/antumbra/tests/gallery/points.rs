//! Points that are known to lie on a surface: parametrisations, lines, singular curves.
use super::field::Field;
use antumbra::geom::Vec3;
use fastrand::Rng;
use std::f64::consts::{SQRT_2, TAU};

/// A surface and points of it from two parameters.
fn parametrised(name: &'static str, mut point: impl FnMut(f64, f64) -> [f64; 3]) {
    let f = Field::of(name);
    let mut r = Rng::with_seed(5);
    for _ in 0..200 {
        f.assert_on(Vec3(point(r.f64() * TAU, r.f64() * TAU)));
    }
}

/// Stereographic projection from the point w = 1 of the three-sphere.
fn stereographic([x, y, z, w]: [f64; 4]) -> [f64; 3] {
    [x, y, z].map(|c| c / (1.0 - w))
}

#[test]
fn parametrisations_lie_on_their_surfaces() {
    parametrised("steiner", |u, v| {
        let n = [u.cos() * v.sin(), u.sin() * v.sin(), v.cos()];
        [n[1] * n[2], n[2] * n[0], n[0] * n[1]]
    });
    // Apéry's parametrisation.
    parametrised("boy", |u, v| {
        let d = 2.0 - SQRT_2 * (3.0 * u).sin() * (2.0 * v).sin();
        let c = v.cos().powi(2);
        [
            (SQRT_2 * c * (2.0 * u).cos() + u.cos() * (2.0 * v).sin()) / d,
            (SQRT_2 * c * (2.0 * u).sin() - u.sin() * (2.0 * v).sin()) / d,
            3.0 * c / d,
        ]
    });
    // Lawson's minimal Klein bottle in the three-sphere: Re((b + iz)^2 (a - ix)) = 0.
    parametrised("klein", |u, v| {
        let (b, z) = (u.cos() * v.cos(), u.cos() * v.sin());
        let (a, x) = (u.sin() * (TAU / 4.0 - 2.0 * v).cos(), -u.sin() * (TAU / 4.0 - 2.0 * v).sin());
        stereographic([x, (a - b) / SQRT_2, z, (a + b) / SQRT_2])
    });
    parametrised("whitney", |u, v| [(u - 3.0) * (v - 3.0), u - 3.0, (v - 3.0).powi(2)]);
    // The quartic t^4 + x t^2 + y t - z with the double root t.
    parametrised("swallowtail", |u, v| {
        let (x, t) = (u - 4.0, (v - 3.0) / 3.0);
        [x, -4.0 * t.powi(3) - 2.0 * x * t, -3.0 * t.powi(4) - x * t * t]
    });
    parametrised("sine-surface", |u, v| [u.sin(), v.sin(), (u + v).sin()]);
    parametrised("dupin-cyclide", |u, v| {
        let (a, c, d) = (1.0_f64, 0.45_f64, 0.62);
        let b = (a * a - c * c).sqrt();
        let over = a - c * u.cos() * v.cos();
        [
            (d * (c - a * u.cos() * v.cos()) + b * b * u.cos()) / over,
            b * u.sin() * (a - d * v.cos()) / over,
            b * v.sin() * (c * u.cos() - d) / over,
        ]
    });
    // Gielis' superformula with m = 5, n1 = 1, n2 = n3 = 4, turned upright by a half circle.
    parametrised("supershape", |u, v| {
        let radius = 1.0 / ((1.25 * u).cos().powi(4) + (1.25 * u).sin().powi(4));
        // Latitudes end at the poles: beyond them five lobes would point the other way.
        let across = radius * v.cos().abs();
        [across * u.cos(), across * u.sin(), v.sin() / 3.0_f64.sqrt()]
    });
    parametrised("catenoid", |u, v| {
        let z = (v - 3.0) / 3.0;
        [u.cos() * z.cosh(), u.sin() * z.cosh(), z]
    });
    parametrised("zitrus", |u, v| {
        let y = v / TAU;
        let radius = (y * (1.0 - y)).powf(1.5);
        [radius * u.cos(), y, radius * u.sin()]
    });
    parametrised("himmel-hoelle", |u, v| [(u - 3.0) * (v - 3.0), u - 3.0, 3.0 - v]);
}

/// The trefoil's core satisfies u^3 = v^2 on the three-sphere: the tube's function is at its least there.
#[test]
fn the_trefoil_has_a_trefoil_in_its_middle() {
    let f = Field::of("trefoil");
    // |u| = a, |v| = b with a^3 = b^2 and a^2 + b^2 = 1, that is a^3 + a^2 = 1.
    let a = (0..60).fold(0.7_f64, |a, _| a - (a.powi(3) + a * a - 1.0) / (3.0 * a * a + 2.0 * a));
    let b = a.powf(1.5);
    for k in 0..100 {
        let t = TAU * f64::from(k) / 100.0;
        let p =
            Vec3(stereographic([a * (2.0 * t).cos(), a * (2.0 * t).sin(), b * (3.0 * t).cos(), b * (3.0 * t).sin()]));
        let share = f.value(p) / (p.dot(p) + 1.0).powi(6);
        assert!((share + 0.09).abs() < 1e-9, "{share} at {p:?}");
    }
}

/// The 27 lines of Clebsch's cubic, on which five forms of sum 0 have cubes of sum 0. Fifteen have two pairs of opposite forms
/// and a form that is 0; twelve are spanned by the real and the imaginary part of the powers of a fifth root of unity,
/// permuted.
#[test]
fn the_clebsch_cubic_has_its_27_lines() {
    let f = Field::of("clebsch");
    let mut lines: Vec<[[f64; 5]; 2]> = vec![];
    for zero in 0..5 {
        let others: Vec<usize> = (0..5).filter(|k| *k != zero).collect();
        for partner in 1..4 {
            let (mut p, mut q) = ([0.0; 5], [0.0; 5]);
            (p[others[0]], p[others[partner]]) = (1.0, -1.0);
            let rest: Vec<usize> = (1..4).filter(|k| *k != partner).collect();
            (q[others[rest[0]]], q[others[rest[1]]]) = (1.0, -1.0);
            lines.push([p, q]);
        }
    }
    // Orders of five letters in a circle, up to turning and reflection.
    for order in permutations(&[1, 2, 3, 4]).into_iter().filter(|o| o[0] < o[3]) {
        let (mut p, mut q) = ([1.0; 5], [0.0; 5]);
        for (k, &letter) in order.iter().enumerate() {
            let angle = TAU * (k + 1) as f64 / 5.0;
            (p[letter], q[letter]) = (angle.cos(), angle.sin());
        }
        lines.push([p, q]);
    }
    assert_eq!(lines.len(), 27);
    for (n, [p, q]) in lines.iter().enumerate() {
        let mut finite = 0;
        for k in 0..12 {
            let t = 0.3 + 0.5 * f64::from(k);
            let u: [f64; 5] = std::array::from_fn(|i| t.cos() * p[i] + t.sin() * q[i]);
            // The fourth form is 1 in the affine part.
            if u[3].abs() > 1e-3 {
                f.assert_on(Vec3([u[0] / u[3], u[1] / u[3], u[2] / u[3]]));
                finite += 1;
            }
        }
        // Three of them lie in the plane at infinity.
        assert!(finite > 8 || (p[3] == 0.0 && q[3] == 0.0), "line {n}");
    }
}

fn permutations(of: &[usize]) -> Vec<Vec<usize>> {
    if of.is_empty() {
        return vec![vec![]];
    }
    let without = |k: usize| of.iter().copied().filter(move |x| *x != k).collect::<Vec<_>>();
    of.iter().flat_map(|&k| permutations(&without(k)).into_iter().map(move |rest| [vec![k], rest].concat())).collect()
}

/// Curves along which the gradient vanishes, as the histories say.
#[test]
fn singular_curves_are_singular() {
    let heart = Field::of("heart");
    let cross = Field::of("cross-cap");
    for k in 0..50 {
        let t = TAU * f64::from(k) / 50.0;
        let waist = Vec3::new(t.cos(), 2.0 / 3.0 * t.sin(), 0.0);
        assert!(heart.gradient(waist).length() < 1e-12 && heart.value(waist).abs() < 1e-12);
        // The cut along which the cross-cap's halves pass through each other.
        let cut = Vec3::new(0.0, 0.0, -f64::from(k) / 50.0);
        assert!(cross.gradient(cut).length() < 1e-12 && cross.value(cut).abs() < 1e-12);
    }
}
