//! Where is the surface, and from where does one look at it?
use super::{Light, Object, Scene, View};
use crate::eval::{Inclusion, Sieve, Workspace};
use crate::geom::{Box3, Clip, Rect, Vec3};
use antumbra_interval::Interval;

/// Where a surface lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Extent {
    /// Proved: no part of it is outside this box (within the searched cube of half side 2^20).
    Bounded(Box3),
    /// It could not be shut in: it runs off to far away, or only seems to. The box is a good part to look at.
    Open(Box3),
    /// Proved: it has no point at all in the searched cube.
    Nowhere,
}

impl Extent {
    /// The box to draw: with some room around what is flat, and around a point a cube of half side 1, so that points and
    /// curves are looked at from a sensible distance.
    #[must_use]
    pub fn clip(&self) -> Box3 {
        let b = match self {
            Self::Bounded(b) | Self::Open(b) => *b,
            Self::Nowhere => return Box3::cube(1.0),
        };
        let (half, middle) = (b.half_extent(), b.mid());
        let widest = half.0.into_iter().fold(0.0, f64::max);
        let least = if widest < POINT * (1.0 + middle.length()) { 1.0 } else { FLAT * widest };
        Box3(std::array::from_fn(|k| {
            let room = (least - half[k]).max(0.0);
            b[k] + Interval::new(-room, room)
        }))
    }
}

/// Cells along each side of one round of the search.
const CELLS: usize = 16;
/// Operations that finding the extent, and proving a region, may take each: about a second or two.
const WORK: usize = 400_000_000;
/// Cells that are asked for together when a region is proved.
const TOGETHER: usize = 64;
/// Half the side of the cube that is searched at first.
const FARTHEST: f64 = (1 << 20) as f64;
/// Half sizes of a clip box by which its neighbourhood reaches further.
const NEIGHBOURHOOD: f64 = 10.0;
/// What is smaller than this share of its distance from the origin is looked at as a point.
const POINT: f64 = 1e-6;
/// Least half size of a box, as a share of its largest.
const FLAT: f64 = 0.05;
/// Half the side of the part of an open surface that is drawn.
const OPEN_HALF: f64 = 3.0;

/// Encloses the surface `{f = 0}` by rounds of 16^3 cells: the hull of the cells that may hold a zero is the next
/// round's region, until it no longer shrinks. About ten rounds, some 50,000 evaluations; formulas of more than some two
/// thousand operations are not searched and count as open.
#[must_use]
pub fn extent(f: &dyn Inclusion) -> Extent {
    // A round looks at 16^3 cells, with up to five evaluations each; give it room for ten rounds.
    if f.operations() > WORK / (50 * CELLS * CELLS * CELLS) {
        return Extent::Open(Box3::cube(OPEN_HALF));
    }
    let mut work = Workspace::default();
    let mut region = Box3::cube(FARTHEST);
    let farthest = region;
    for round in 0..60 {
        let Some(hull) = hull_of_zeros(f, region, &mut work) else { return Extent::Nowhere };
        let hull = hull.intersection(region).unwrap_or(region);
        if round == 0 && (0..3).any(|i| hull[i].lo() <= farthest[i].lo() || hull[i].hi() >= farthest[i].hi()) {
            return Extent::Open(part_to_look_at(f, &mut work));
        }
        let shrunk = (0..3).any(|i| hull[i].width() < 0.97 * region[i].width());
        region = hull;
        if !shrunk {
            break;
        }
    }
    Extent::Bounded(region)
}

/// The part of an endless surface in the middle of space; further away, where it does not come near.
fn part_to_look_at(f: &dyn Inclusion, work: &mut Workspace) -> Box3 {
    let mut half = OPEN_HALF;
    while half < FARTHEST {
        let mut region = Box3::cube(half);
        // A surface that is there has cells at every round.
        for round in 0..4 {
            match hull_of_zeros(f, region, work) {
                None if round == 0 => break,
                hull => region = hull.and_then(|h| h.intersection(region)).unwrap_or(region),
            }
            if round == 3 {
                return region;
            }
        }
        half *= 4.0;
    }
    Box3::cube(OPEN_HALF)
}

/// A region in which every zero of f is known to be inside `clip`: if f has none in a wide neighbourhood, the clip cuts
/// nothing away there, and that is the region; otherwise it is the clip itself. Proved by a search that gives up after
/// some 100,000 evaluations.
#[must_use]
pub(super) fn region(f: &dyn Inclusion, clip: &Clip) -> Clip {
    let Clip::Box(kept) = *clip else { return *clip };
    let mut work = Workspace::default();
    let wide = Box3(kept.0.map(|k| k + (k - Interval::point(k.mid())) * Interval::point(NEIGHBOURHOOD)));
    let (region, start) = match extent(f) {
        Extent::Nowhere => return Clip::Box(Box3::cube(FARTHEST)),
        Extent::Bounded(b) => (Box3::cube(FARTHEST), b),
        Extent::Open(_) => (wide, wide),
    };
    let (mut cells, mut asked, mut sieve) = (vec![start], Vec::with_capacity(TOGETHER), Sieve::default());
    let mut budget = (WORK / (5 * f.operations())).min(60_000);
    while !cells.is_empty() {
        // How many cells there are in the end, and with it the answer, does not depend on their order.
        asked.extend(cells.drain(cells.len().saturating_sub(TOGETHER)..).filter(|c| c.intersection(kept) != Some(*c)));
        if budget < asked.len() {
            return *clip;
        }
        budget -= asked.len();
        sieve.retain(f, &mut asked, &mut work);
        cells.extend(asked.drain(..).flat_map(|cell| halves(&cell, &kept)));
    }
    Clip::Box(region)
}

/// A cell in two, cut along its longest edge, or at the border of the kept box if that runs through it.
fn halves(cell: &Box3, kept: &Box3) -> [Box3; 2] {
    let axis = (1..3).fold(0, |a, b| if cell[b].width() > cell[a].width() { b } else { a });
    let border = (0..3).find_map(|k| {
        [kept[k].lo(), kept[k].hi()].into_iter().find(|x| cell[k].lo() < *x && *x < cell[k].hi()).map(|x| (k, x))
    });
    let (axis, at) = border.unwrap_or((axis, cell[axis].mid()));
    let (mut low, mut high) = (*cell, *cell);
    low.0[axis] = Interval::new(cell[axis].lo(), at);
    high.0[axis] = Interval::new(at, cell[axis].hi());
    [low, high]
}

/// Hull of the cells of `region` in which f may be zero.
fn hull_of_zeros(f: &dyn Inclusion, region: Box3, work: &mut Workspace) -> Option<Box3> {
    let mut hull: Option<Box3> = None;
    for_cells_with_zeros(f, region, work, |_| true, |cell| hull = Some(hull.map_or(cell, |h| h.hull(cell))));
    hull
}

/// Those `wanted` cells of `region` in which f may be zero: by its range, and by the mean value form.
fn for_cells_with_zeros(
    f: &dyn Inclusion,
    region: Box3,
    work: &mut Workspace,
    wanted: impl Fn(&Box3) -> bool,
    mut found: impl FnMut(Box3),
) {
    let edge = |axis: usize, k: usize| {
        let (lo, hi) = (Interval::point(region[axis].lo()), Interval::point(region[axis].hi()));
        lo + (hi - lo) * (Interval::point(k as f64) / Interval::point(CELLS as f64))
    };
    let slab = |axis: usize, k: usize| edge(axis, k).hull(edge(axis, k + 1));
    let slabs: [[Interval; CELLS]; 3] = std::array::from_fn(|axis| std::array::from_fn(|k| slab(axis, k)));
    let (mut cells, mut sieve) = (Vec::with_capacity(CELLS * CELLS), Sieve::default());
    for z in slabs[2] {
        cells.clear();
        cells.extend(slabs[1].iter().flat_map(|y| slabs[0].map(|x| Box3([x, *y, z]))).filter(&wanted));
        sieve.retain(f, &mut cells, work);
        cells.iter().copied().for_each(&mut found);
    }
}

/// Where everything is: what an automatic camera goes by.
pub(super) struct Stage<'a> {
    objects: &'a [Object],
    bounds: Box3,
    /// The clips cut nothing away.
    whole: bool,
    /// Middle of everything.
    pub(super) centre: Vec3,
    /// Half the largest edge of the box around it.
    radius: f64,
}

impl<'a> Stage<'a> {
    /// From where one looks: from the front, a little to the right and above. No small integers: many a plane, x = z for
    /// one, would be seen from its edge. Times the radius it is the usual distance.
    pub(super) const FROM: Vec3 = Vec3([2.6, -4.3, 2.9]);

    /// That of objects, at least one.
    pub(super) fn of(objects: &'a [Object]) -> Self {
        let bounds = objects.iter().map(|o| o.clip().bounds()).reduce(Box3::hull).unwrap_or(Box3::cube(1.0));
        let whole = objects.iter().all(|o| o.region() != o.clip());
        let radius = bounds.half_extent().0.into_iter().fold(0.0, f64::max).max(f64::MIN_POSITIVE);
        Self { objects, bounds, whole, centre: bounds.mid(), radius }
    }

    /// The usual distance of the camera.
    pub(super) fn distance(&self) -> f64 {
        Self::FROM.length() * self.radius
    }

    /// How far from a target there is something to see: all of the box where it cuts surfaces off; where they are whole, the
    /// ellipsoid inside and a margin (corners are mostly empty then), or as far as the surface goes, as a cube does.
    fn reach(&self, target: Vec3) -> f64 {
        let corner = self.bounds.half_extent().length();
        let farthest = || self.objects.iter().map(|o| farthest(o, self.centre, 0.75 * corner)).fold(0.0, f64::max);
        let seen = if self.whole { (0.78 * corner).max(1.04 * farthest().min(corner)) } else { corner };
        seen + (target - self.centre).length()
    }

    /// The full angle, in degrees, that shows all of that.
    pub(super) fn angle(&self, eye: Vec3, target: Vec3) -> f64 {
        2.0 * core_math::asin((self.reach(target) / (eye - target).length()).min(0.9)).to_degrees()
    }

    /// The width that shows all of it without perspective.
    pub(super) fn width(&self, target: Vec3) -> f64 {
        2.0 * self.reach(target)
    }
}

/// Distance from a point beyond which an object has nothing in its clip, up to a sixteenth of the clip, where that is more than `least`; 0 where
/// it is not, and for long formulas, which are not searched.
fn farthest(object: &Object, from: Vec3, least: f64) -> f64 {
    let (f, bounds) = (object.framed(), object.clip().bounds());
    let distance =
        |cell: &Box3| Vec3(std::array::from_fn(|k| (cell[k].hi() - from[k]).max(from[k] - cell[k].lo()))).length();
    let mut most = 0.0_f64;
    let bounded = bounds.0.iter().all(|side| side.magnitude() < f64::INFINITY);
    if bounded && f.operations() <= WORK / (50 * CELLS * CELLS * CELLS) {
        let far = |cell: &Box3| distance(cell) > least;
        for_cells_with_zeros(f, bounds, &mut Workspace::default(), far, |cell| most = most.max(distance(&cell)));
    }
    most
}

/// A scene around objects, at least one: the camera sees everything; a square light of a tenth of the picture's width (paper,
/// section 4) hangs above, to the left.
pub(super) fn scene(name: String, title: String, objects: Vec<Object>) -> Scene {
    let stage = Stage::of(&objects);
    let Stage { bounds, centre, radius, .. } = stage;
    let eye = centre + Stage::FROM * radius;
    let light = Light::white(Rect::horizontal(centre + Vec3::new(-1.0, -2.0, 6.0) * radius, 0.25 * radius));
    let view = View { eye, target: centre, fov_deg: stage.angle(eye, centre) };
    let floor_height = bounds[2].lo() - 0.05 * radius;
    let (sky, backdrop, look, output) = Default::default();
    let (about, floor_shown, lights) = (None, false, vec![light]);
    Scene { name, title, about, floor_height, floor_shown, view, lights, objects, sky, backdrop, look, output }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn extent_of(text: &str) -> Extent {
        extent(Object::parse(text, Clip::Everywhere).unwrap().surface.as_ref())
    }

    #[test]
    fn bounded_surfaces_are_shut_in_tightly() {
        for (text, half) in [
            ("x^2 + y^2 + z^2 = 1", 1.0),
            ("x^2 + y^2 + z^2 = 10000", 100.0),
            ("x^4 + y^4 + z^4 - x^2 - y^2 - z^2 + 1/2 = 0", 1.0),
        ] {
            let Extent::Bounded(b) = extent_of(text) else { panic!("{text} is bounded") };
            for axis in 0..3 {
                assert!(b[axis].hi() >= half && b[axis].hi() < 1.2 * half, "{text}: {:?}", b[axis]);
            }
        }
    }

    #[test]
    fn a_camera_that_frames_itself_shows_corners_too() {
        let view = |text: &str| {
            let scene = Scene::from_formula(text).unwrap();
            (scene.view.fov_deg, scene.view.camera(1.0))
        };
        let ((ball, _), (cube, camera)) = (view("x^2 + y^2 + z^2 = 1"), view("max(abs(x), max(abs(y), abs(z))) = 1"));
        assert!(ball < 28.0 && cube > ball, "{ball} {cube}");
        for k in 0..8 {
            let side = |bit: usize| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
            let ([x, y], _) = camera.project(Vec3::new(side(0), side(1), side(2))).unwrap();
            assert!(x.abs() < 1.0 && y.abs() < 1.0, "corner {k} at {x}, {y}");
        }
    }

    #[test]
    fn points_and_curves_get_room() {
        for text in ["x^2 + y^2 + z^2 = 0", "(x - 3)^2 + (y + 1)^2 + z^2 = 0"] {
            let clip = extent_of(text).clip();
            assert!((0..3).all(|k| (0.9..3.0).contains(&clip[k].width())), "{text}: {clip:?}");
        }
        let clip = extent_of("(x^2 + y^2 - 1)^2 + z^2 = 0").clip();
        assert!(clip[2].width() >= 0.09 && clip[0].width() < 2.6, "{clip:?}");
    }

    #[test]
    fn open_and_missing_surfaces_are_told_apart() {
        assert!(matches!(extent_of("z = 0"), Extent::Open(_)));
        assert!(matches!(extent_of("sin(x) + sin(y) + sin(z) = 0"), Extent::Open(_)));
        assert_eq!(extent_of("x^2 + y^2 + z^2 + 1 = 0"), Extent::Nowhere);
    }

    #[test]
    fn of_endless_surfaces_there_is_shown_what_is_there() {
        let part = |text: &str| {
            let Extent::Open(b) = extent_of(text) else { panic!("{text} is endless") };
            b.0.map(|side| (side.lo(), side.hi()))
        };
        // A paraboloid fills the upper half of a cube of half side 3, and reaches out to sqrt(3).
        let [x, y, z] = part("z = x^2 + y^2");
        for (lo, hi) in [x, y] {
            assert!(lo < -1.73 && lo > -1.9 && hi > 1.73 && hi < 1.9, "{lo} {hi}");
        }
        assert!(z.0 <= 0.0 && z.0 > -0.2 && z.1 == 3.0, "{z:?}");
        assert_eq!(part("sin(x) + sin(y) + sin(z) = 0"), [(-3.0, 3.0); 3]);
        let [x, _, z] = part("z = 100 + x/10");
        assert!(z.0 > 0.0 && z.1 < 150.0 && x.1 == 192.0, "{x:?} {z:?}");
    }
}
