//! Euler characteristics. The signs of f at the points of a grid, joined to tetrahedra, make a surface of triangles and
//! quadrilaterals: one corner for each edge on which the sign changes, one edge for each such triangle, one face for each such
//! tetrahedron.
use super::field::Field;
use antumbra::geom::Vec3;

/// Points along each side of the grid.
const N: usize = 72;

fn euler(name: &'static str, half: Vec3) -> i64 {
    let f = Field::of(name);
    let index = |p: [usize; 3]| (p[0] * N + p[1]) * N + p[2];
    // Shifted a little, so that no point of symmetry is a point of the grid.
    let place = |p: [usize; 3]| {
        Vec3(std::array::from_fn(|k| half[k] * ((2 * p[k]) as f64 / (N - 1) as f64 - 1.0) + 0.001_731 * (k + 1) as f64))
    };
    let mut positive = vec![false; N * N * N];
    let all = || (0..N).flat_map(|i| (0..N).flat_map(move |j| (0..N).map(move |k| [i, j, k])));
    for p in all() {
        let value = f.value(place(p));
        assert!(value != 0.0, "{name}: the grid meets the surface at {p:?}");
        positive[index(p)] = value > 0.0;
        let outside = p.iter().any(|&c| c == 0 || c == N - 1);
        assert!(!outside || positive[index(p)] == positive[0], "{name} leaves the grid at {p:?}");
    }
    // Kuhn's triangulation: chains of corners of the unit cube, each above the last, are its simplices.
    let bits = |m: usize| [m & 1, (m >> 1) & 1, (m >> 2) & 1];
    let above = |a: usize, b: usize| a != b && a & b == a;
    let mut chains = [vec![], vec![], vec![]];
    for a in 1..8 {
        chains[0].push(vec![0, a]);
        for b in (1..8).filter(|&b| above(a, b)) {
            chains[1].push(vec![0, a, b]);
            for c in (1..8).filter(|&c| above(b, c)) {
                chains[2].push(vec![0, a, b, c]);
            }
        }
    }
    assert_eq!(chains.each_ref().map(Vec::len), [7, 12, 6]);
    let mut sum = 0;
    for p in all() {
        for (dimension, simplices) in chains.iter().enumerate() {
            for simplex in simplices {
                let corners = || simplex.iter().map(|&m| std::array::from_fn::<usize, 3, _>(|k| p[k] + bits(m)[k]));
                if corners().any(|c| c.iter().any(|&x| x >= N)) {
                    continue;
                }
                let crossed = corners().any(|c| positive[index(c)] != positive[index(p)]);
                sum += i64::from(crossed) * if dimension == 1 { -1 } else { 1 };
            }
        }
    }
    sum
}

/// 2 - 2 genus.
#[test]
fn genera() {
    for (name, half, genus) in [
        ("tangle", Vec3::new(2.6, 2.6, 2.6), 5),
        ("decocube", Vec3::new(1.25, 1.25, 1.25), 13),
        ("double-torus", Vec3::new(1.3, 0.85, 0.45), 2),
        ("bretzel", Vec3::new(2.4, 2.4, 0.6), 5),
        ("dupin-cyclide", Vec3::new(2.3, 2.0, 1.3), 1),
        ("trefoil", Vec3::new(3.6, 3.6, 2.4), 1),
        ("orthocircle", Vec3::new(1.3, 1.3, 1.3), 7),
        ("bracket", Vec3::new(1.7, 1.7, 1.5), 5),
        ("blobs", Vec3::new(1.4, 1.5, 1.5), 0),
        ("superellipsoid", Vec3::new(1.2, 1.0, 0.8), 0),
        ("supershape", Vec3::new(2.3, 2.3, 0.8), 0),
        ("die", Vec3::new(1.2, 1.2, 1.2), 0),
        ("distel", Vec3::new(1.2, 1.2, 1.2), 0),
    ] {
        assert_eq!(euler(name, half), 2 - 2 * genus, "{name}");
    }
}
