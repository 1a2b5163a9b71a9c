//! Drawings as plates: a formula without z.
use crate::expr::{Axis, Binary, Formula, Unary};
use crate::geom::{Box3, Clip, Vec3};
use crate::scene::{self, Extent, Object, Scene, View, extent};
use antumbra_interval::Interval;
use num_rational::BigRational;

/// Half the thickness of a plate, as a share of its half width rounded up to a power of two.
const THICKNESS: f64 = 1.0 / 64.0;
/// Half widths of drawings, rounded up, go up to here.
const WIDEST: f64 = (1 << 20) as f64;

/// The drawing `f(x, y) < 0` as the plate `max(f, |z| - h) < 0`, seen from above. A drawing without bounds, or with a formula too
/// long to be searched for them, is cut to the square from -1 to 1, the part that Fidget shows.
pub(super) fn scene(drawing: &Formula, name: &str, title: String) -> Result<Scene, scene::Error> {
    let thick = Object::from_formula(&slab(drawing, 1.0), Clip::Everywhere)?;
    let square = Interval::new(-1.0, 1.0);
    let [x, y] = match extent(thick.surface.as_ref()) {
        Extent::Bounded(b) => [b[0], b[1]],
        Extent::Open(_) | Extent::Nowhere => [square, square],
    };
    let mut size = 1.0 / 1024.0;
    while size < x.magnitude().max(y.magnitude()) && size < WIDEST {
        size *= 2.0;
    }
    let half = THICKNESS * size;
    let clip = Clip::Box(Box3([x, y, Interval::new(-2.0 * half, 2.0 * half)]));
    let object = Object::from_formula(&slab(drawing, half), clip)?;
    let mut scene = Scene::around(name.to_owned(), title, vec![object]);
    let target = Vec3::new(x.mid(), y.mid(), 0.0);
    scene.view = View { eye: target + Vec3::new(0.17, -1.31, 3.07) * size, target, fov_deg: 40.0 };
    scene.floor_height = -1.25 * half;
    Ok(scene)
}

/// `max(f, |z| - half)`. The half thickness is a power of two, so a short exact decimal.
fn slab(drawing: &Formula, half: f64) -> Formula {
    let (mut graph, root) = (drawing.graph().clone(), drawing.root());
    let exact = BigRational::from_float(half).unwrap_or_default();
    let z = graph.axis(Axis::Z);
    let (distance, half) = (graph.unary(Unary::Abs, z), graph.rational(exact));
    let beyond = graph.binary(Binary::Sub, distance, half);
    let root = graph.binary(Binary::Max, root, beyond);
    Formula::new(graph, root)
}
