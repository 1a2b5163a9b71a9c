//! The four surfaces as other programs are told of them.
use fidget::context::Tree;

/// A surface in single precision.
pub(crate) struct Surface {
    /// Name of the preset.
    pub(crate) name: &'static str,
    /// The function, negative inside.
    pub(crate) value: fn(f64, f64, f64) -> f64,
    /// It lies in `[-half, half]^3`.
    pub(crate) half: f32,
    /// In Fidget.
    pub(crate) tree: fn(Tree, Tree, Tree) -> Tree,
    /// For POV-Ray: the statement of the object. `None` where its polynomials are known to come out wrong.
    pub(crate) povray: Option<&'static str>,
}

const RINGS: f64 = 0.075 * 0.075 * 3.0;

fn sq(x: f64) -> f64 {
    x * x
}

pub(crate) const SURFACES: [Surface; 4] = [
    Surface {
        name: "orthocircle",
        value: |x, y, z| {
            let (a, b, c) = (x * x, y * y, z * z);
            let ring = |p: f64, q: f64, r: f64| sq(p + q - 1.0) + r;
            ring(a, b, c) * ring(b, c, a) * ring(c, a, b) - RINGS * (a + b + c + 1.0 / 3.0)
        },
        half: 1.2,
        tree: |x, y, z| {
            let (a, b, c) = (x.square(), y.square(), z.square());
            let ring = |p: &Tree, q: &Tree, r: &Tree| (p.clone() + q.clone() - 1.0).square() + r.clone();
            let rings = ring(&a, &b, &c) * ring(&b, &c, &a) * ring(&c, &a, &b);
            rings - (a + b + c + 1.0 / 3.0) * RINGS as f32
        },
        povray: None,
    },
    Surface {
        name: "chubs",
        value: |x, y, z| sq(x * x) + sq(y * y) + sq(z * z) - x * x - y * y - z * z + 0.5,
        half: 1.05,
        tree: |x, y, z| {
            let (a, b, c) = (x.square(), y.square(), z.square());
            a.square() + b.square() + c.square() - a - b - c + 0.5
        },
        povray: Some(
            "polynomial { 4, xyz(4,0,0):1, xyz(0,4,0):1, xyz(0,0,4):1, xyz(2,0,0):-1, xyz(0,2,0):-1, xyz(0,0,2):-1, xyz(0,0,0):0.5",
        ),
    },
    Surface {
        name: "kusner",
        value: |x, y, z| (x * x + 3.0) * (y * y + 3.0) * (z * z + 3.0) - 32.0 * (x * y * z + 1.0),
        half: 1.1,
        tree: |x, y, z| {
            let (a, b, c) = (x.square(), y.square(), z.square());
            (a + 3.0) * (b + 3.0) * (c + 3.0) - (x * y * z + 1.0) * 32.0
        },
        povray: Some(
            "polynomial { 6, xyz(2,2,2):1, xyz(2,2,0):3, xyz(2,0,2):3, xyz(0,2,2):3, xyz(2,0,0):9, xyz(0,2,0):9, xyz(0,0,2):9, xyz(1,1,1):-32, xyz(0,0,0):-5",
        ),
    },
    Surface {
        name: "mcmullen",
        value: |x, y, z| (1.0 + x * x) * (1.0 + y * y) * (1.0 + z * z) + 8.0 * x * y * z - 2.0,
        half: 1.78,
        tree: |x, y, z| {
            let (a, b, c) = (x.square(), y.square(), z.square());
            (a + 1.0) * (b + 1.0) * (c + 1.0) + x * y * z * 8.0 - 2.0
        },
        povray: Some(
            "polynomial { 6, xyz(2,2,2):1, xyz(2,2,0):1, xyz(2,0,2):1, xyz(0,2,2):1, xyz(2,0,0):1, xyz(0,2,0):1, xyz(0,0,2):1, xyz(1,1,1):8, xyz(0,0,0):-1",
        ),
    },
];
