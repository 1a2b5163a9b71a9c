//! Nodes: how many there are, and where. A node is a point at which f and its gradient vanish and the second derivatives do
//! not degenerate.
use super::field::{Field, Matrix, apply, determinant, random_point};
use antumbra::geom::{Box3, Vec3};
use antumbra_interval::Interval;
use fastrand::Rng;

const PHI: f64 = 1.618_033_988_749_895;

/// Rotation about an axis.
fn rotation(axis: Vec3, angle: f64) -> Matrix {
    let (s, c) = angle.sin_cos();
    let n = axis.normalized();
    std::array::from_fn(|i| {
        let mut e = Vec3::default();
        e.0[i] = 1.0;
        // Row i of R is e_i rotated backwards.
        (e * c + e.cross(n) * s + n * (n.dot(e) * (1.0 - c))).0
    })
}

fn diagonal(d: [f64; 3]) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { d[i] } else { 0.0 }))
}

/// The group made by some symmetries.
fn group(generators: &[Matrix]) -> Vec<Matrix> {
    let close = |a: &Matrix, b: &Matrix| a.iter().flatten().zip(b.iter().flatten()).all(|(x, y)| (x - y).abs() < 1e-6);
    let mut all = vec![diagonal([1.0; 3])];
    let mut k = 0;
    while k < all.len() {
        for g in generators {
            let columns: [Vec3; 3] = std::array::from_fn(|j| apply(g, Vec3(std::array::from_fn(|i| all[k][i][j]))));
            let product: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i]));
            if !all.iter().any(|m| close(m, &product)) {
                all.push(product);
            }
        }
        k += 1;
        assert!(all.len() <= 120, "not a finite group of space");
    }
    all
}

/// `|f|` is the same at all images of a point.
fn assert_symmetric(f: &Field, symmetries: &[Matrix]) {
    let mut r = Rng::with_seed(11);
    for _ in 0..20 {
        let at = random_point(&mut r, 1.5);
        let value = f.value(at).abs();
        for m in symmetries {
            let image = f.value(apply(m, at)).abs();
            assert!((image - value).abs() <= 1e-9 * (1.0 + value), "{}: {value} and {image}", f.name);
        }
    }
}

/// A zero of the gradient near `start`, by Newton's method.
fn critical(f: &Field, start: Vec3) -> Option<Vec3> {
    let mut at = start;
    for _ in 0..50 {
        let (g, h) = (f.gradient(at), f.hessian(at));
        let det = determinant(&h);
        let replaced = |k: usize| {
            let mut m = h;
            (0..3).for_each(|i| m[i][k] = g[i]);
            determinant(&m) / det
        };
        let step = Vec3([replaced(0), replaced(1), replaced(2)]);
        let length = step.length();
        if length.is_nan() || length >= 1e6 {
            return None;
        }
        at = at - step * (0.3 / length).min(1.0);
        if length < 1e-11 * (1.0 + at.length()) {
            return Some(at);
        }
    }
    None
}

/// All nodes that Newton's method finds from random starts and from `far`, with their images.
fn nodes(f: &Field, symmetries: &[Matrix], half: f64, starts: usize, far: Option<Vec3>) -> Vec<Vec3> {
    let mut r = Rng::with_seed(7);
    let mut found: Vec<Vec3> = vec![];
    let random: Vec<Vec3> = (0..starts).map(|_| random_point(&mut r, half)).collect();
    for start in far.into_iter().chain(random) {
        let Some(at) = critical(f, start) else { continue };
        let h = f.hessian(at);
        let size = h.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        let node = f.value(at).abs() < 1e-9 * size && determinant(&h).abs() > 1e-6 * size * size * size;
        if !node || found.iter().any(|p| (*p - at).length() < 1e-5) {
            continue;
        }
        for m in symmetries {
            let image = apply(m, at);
            if !found.iter().any(|p| (*p - image).length() < 1e-5) {
                found.push(image);
            }
        }
    }
    found
}

/// Checks symmetry and number.
fn assert_nodes(name: &'static str, generators: &[Matrix], order: usize, half: f64, starts: usize, count: usize) {
    assert_nodes_and_far(name, generators, order, half, starts, None, count);
}

fn assert_nodes_and_far(
    name: &'static str,
    generators: &[Matrix],
    order: usize,
    half: f64,
    starts: usize,
    far: Option<Vec3>,
    count: usize,
) {
    let f = Field::of(name);
    let symmetries = group(generators);
    assert_eq!(symmetries.len(), order, "{name}");
    assert_symmetric(&f, &symmetries);
    let found = nodes(&f, &symmetries, half, starts, far);
    assert_eq!(found.len(), count, "{name}");
}

fn cyclic() -> Matrix {
    [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]
}

fn icosahedral() -> [Matrix; 3] {
    [cyclic(), diagonal([-1.0, 1.0, 1.0]), rotation(Vec3::new(1.0, 0.0, PHI), std::f64::consts::TAU / 5.0)]
}

/// Rotations of order `n` about z, and the mirror y = 0.
fn pyramid(n: f64) -> [Matrix; 2] {
    [rotation(Vec3::new(0.0, 0.0, 1.0), std::f64::consts::TAU / n), diagonal([1.0, -1.0, 1.0])]
}

#[test]
fn four_sixteen_and_thirty_one() {
    let tetrahedral = [cyclic(), diagonal([-1.0, -1.0, 1.0]), [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]];
    assert_nodes("cayley", &tetrahedral, 24, 1.5, 60, 4);
    let octahedral = [cyclic(), diagonal([-1.0, 1.0, 1.0]), [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]];
    assert_nodes("chubs", &octahedral, 48, 1.5, 60, 12);
    let roto = [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -1.0]];
    assert_nodes("kummer", &[roto, diagonal([-1.0, 1.0, 1.0])], 8, 2.0, 300, 16);
    assert_nodes("togliatti", &pyramid(5.0), 10, 8.0, 800, 31);
    assert_nodes("cassini", &[diagonal([-1.0, 1.0, 1.0])], 2, 1.5, 60, 2);
}

/// Fifty and three hundred are finite; the others lie on the plane at infinity.
#[test]
fn the_nodes_of_barth() {
    assert_nodes("barth-sextic", &icosahedral(), 120, 2.0, 200, 50);
    assert_nodes("barth-decic", &icosahedral(), 120, 2.0, 600, 300);
}

/// On the plane at infinity the sextic's highest part and its gradient vanish in fifteen directions, the axes of its
/// half turns: f has no part of degree five, so they are nodes. Where they vanish, f grows by the fourth power only.
#[test]
fn fifteen_nodes_of_the_sextic_are_at_infinity() {
    let f = Field::of("barth-sextic");
    let mut axes: Vec<Vec3> = vec![];
    for m in group(&icosahedral()) {
        let axis = apply(&m, Vec3::new(1.0, 0.0, 0.0));
        if !axes.iter().any(|a| a.cross(axis).length() < 1e-6) {
            axes.push(axis);
        }
    }
    assert_eq!(axes.len(), 15);
    for axis in axes {
        let growth = |t: f64| (f.value(axis * t) / t.powi(4)).abs();
        assert!(growth(1e3) < 10.0, "{axis:?}: {}", growth(1e3));
        let slope = |t: f64| f.gradient(axis * t).length() / t.powi(3);
        assert!(slope(1e3) < 100.0, "{axis:?}: {}", slope(1e3));
    }
    let other = Vec3::new(0.6, 0.64, 0.48) * 1e3;
    assert!(f.value(other).abs() > 1e16);
}

#[test]
fn ninety_nine_and_one_hundred_and_forty_four() {
    // Seven are far outside, where few random starts lead.
    let far = Some(Vec3::new(11.7, 0.1, 10.5));
    assert_nodes_and_far("labs-septic", &pyramid(7.0), 14, 10.0, 4000, far, 99);
    // The other 24 of the octic are at infinity.
    let prism = [pyramid(8.0)[0], pyramid(8.0)[1], diagonal([1.0, 1.0, -1.0])];
    assert_nodes("endrass-octic", &prism, 32, 3.0, 1500, 144);
}

/// Where coordinates are known exactly, f and its gradient are enclosed there: around 0, and tightly.
#[test]
fn known_nodes_are_enclosed() {
    let i = Interval::point;
    let one = |signs: [f64; 3], size: Interval| Box3(signs.map(|s| i(s) * size));
    let odd = [[-1.0, -1.0, -1.0], [-1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, -1.0]];
    let even = odd.map(|p| p.map(|x: f64| -x));
    let mut known = vec![];
    for p in odd {
        known.push(("cayley", one(p, i(0.5))));
    }
    for p in even {
        known.push(("kusner", one(p, i(1.0))));
    }
    let half_root = i(0.5).sqrt();
    for (a, b) in [(0, 1), (1, 2), (2, 0)] {
        for (s, t) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            let mut p = [Interval::ZERO; 3];
            (p[a], p[b]) = (i(s) * half_root, i(t) * half_root);
            known.push(("chubs", Box3(p)));
        }
    }
    let phi = (i(1.0) + i(5.0).sqrt()) / i(2.0);
    for p in [[i(1.0), i(1.0), i(1.0)], [phi, Interval::ZERO, i(1.0) / phi], [i(1.0), i(0.0), i(0.0)]] {
        known.push(("barth-sextic", Box3(p)));
    }
    known.push(("cassini", Box3([i(1.0), i(0.0), i(0.0)])));
    known.push(("ding-dong", Box3([Interval::ZERO; 3])));
    known.push(("vis-a-vis", Box3([Interval::ZERO; 3])));
    for (name, at) in known {
        let f = Field::of(name);
        let g = f.over(&at);
        // The coordinates are known to a few units of their last place; second derivatives turn that into the gradient's width.
        let curved = f.hessian(at.mid()).iter().flatten().fold(1.0_f64, |m, h| m.max(h.abs()));
        let narrow = 40.0 * f64::EPSILON * curved * (1.0 + at.mid().length());
        for x in [g.value, g.partials[0], g.partials[1], g.partials[2]] {
            assert!(x.possibly_zero() && x.width() < narrow, "{name} at {at:?}: {x:?}, wider than {narrow}");
        }
    }
}
