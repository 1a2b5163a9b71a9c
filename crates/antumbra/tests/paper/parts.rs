//! Bisection and grid.
use antumbra::eval::{Gradient, Inclusion, Workspace};
use antumbra::expr::Formula;
use antumbra::geom::{Beam, Box3, Vec3, section};
use antumbra::grid::Grid;
use antumbra::scene::{PRESETS, preset};
use antumbra::tape::Tape;
use antumbra::trace::{Bisection, Cost, first_section};
use antumbra_interval::{Decorated, Interval};
use fastrand::Rng;

/// `product of (x - root)`, or anything else of x alone.
fn compile(text: &str) -> Tape {
    Tape::compile(&Formula::parse(text).unwrap_or_else(|e| panic!("{}", e.render(text)))).unwrap()
}

/// The ray along x: its parameter is the coordinate.
fn along_x() -> Beam {
    Beam { origin: Vec3::default(), direction: Vec3::new(1.0, 0.0, 0.0).to_box() }
}

/// The same search with a stack: the paper's is meant to do without, not to do something else.
fn recursive(f: &dyn Inclusion, t: Interval, cs: u64, ns: u32, width: f64, work: &mut Workspace) -> Option<Interval> {
    let part = section(t, cs, ns);
    if !f.range(&along_x().at(part), work).possibly_zero() {
        return None;
    }
    if part.width() < width {
        return Some(part);
    }
    recursive(f, t, 2 * cs, ns + 1, width, work).or_else(|| recursive(f, t, 2 * cs + 1, ns + 1, width, work))
}

#[test]
fn stackless_bisection_finds_what_recursion_finds() {
    let mut r = Rng::with_seed(71);
    let mut work = Workspace::default();
    let (mut found, mut none) = (0, 0);
    for round in 0..300 {
        let roots: Vec<f64> = (0..r.usize(0..5)).map(|_| r.f64() * 2.0).collect();
        let factors: String = roots.iter().map(|v| format!(" (x - {v:?})")).collect();
        let text = match round % 4 {
            0 => format!("sin({} x) - {:?}", r.u32(1..40), r.f64() * 1.2),
            1 => format!("(x^2 + {:?}){factors}", r.f64()),
            2 => format!("({:?} + x - x^2) - x^3{factors}", r.f64() - 0.5),
            _ => format!("exp(-x) cos({}x) - {:?}", r.u32(1..30), r.f64() * 0.8),
        };
        let f = compile(&text);
        let t = Interval::new(r.f64(), 1.0 + r.f64());
        let width = [1e-5, 1e-3, 0.1][r.usize(0..3)];
        let mut cost = Cost::default();
        let stackless = first_section(&f, &along_x(), t, Bisection { width }.into(), &mut work, &mut cost);
        // The paper's search begins with the halves.
        let wanted = recursive(&f, t, 0, 1, width, &mut work).or_else(|| recursive(&f, t, 1, 1, width, &mut work));
        assert_eq!(stackless, wanted, "{text} on {t:?}");
        assert!(cost.evaluations > 0);
        (found, none) = (found + u32::from(wanted.is_some()), none + u32::from(wanted.is_none()));
        // No zero before it: by the signs at a thousand points.
        let end = stackless.map_or(t.hi(), |s| s.lo());
        let signs: Vec<Interval> = (0..1000)
            .map(|k| t.lo() + (end - t.lo()) * f64::from(k) / 1000.0)
            .map(|x| f.range(&Vec3::new(x, 0.0, 0.0).to_box(), &mut work))
            .filter(|v| !v.possibly_zero())
            .collect();
        let change = signs.windows(2).any(|w| w[0].certainly_positive() != w[1].certainly_positive());
        assert!(!change, "{text} on {t:?} changes its sign before {end}");
    }
    assert!(found > 50 && none > 50, "{found} with a zero, {none} without");
}

/// A function made of steps: zero in exactly the given sections of [0, 1], at level 10.
struct Marked(Vec<u64>);

impl Inclusion for Marked {
    fn range(&self, region: &Box3, _: &mut Workspace) -> Interval {
        let inside = |k: &u64| {
            // Touching an edge, up to the rounding of the beam's points, does not count.
            let cell = [*k as f64 / 1024.0 + 1e-12, (*k + 1) as f64 / 1024.0 - 1e-12];
            region[0].lo() < cell[1] && region[0].hi() > cell[0]
        };
        if self.0.iter().any(inside) { Interval::new(-1.0, 1.0) } else { Interval::ONE }
    }
    fn decorated(&self, region: &Box3, work: &mut Workspace) -> Decorated {
        self.range(region, work).into()
    }
    fn gradient(&self, region: &Box3, work: &mut Workspace) -> Gradient {
        Gradient { value: self.range(region, work), partials: [Interval::ENTIRE; 3] }
    }
}

/// The first of the sections is found, wherever they are, without an evaluation more than needed.
#[test]
fn bisection_returns_the_first_section() {
    let mut r = Rng::with_seed(72);
    let mut work = Workspace::default();
    for _ in 0..300 {
        let mut marked: Vec<u64> = (0..r.usize(1..6)).map(|_| r.u64(0..1024)).collect();
        marked.sort_unstable();
        let first = marked[0];
        let mut cost = Cost::default();
        let search = Bisection { width: 1.0 / 1000.0 }.into();
        let found = first_section(&Marked(marked), &along_x(), Interval::new(0.0, 1.0), search, &mut work, &mut cost);
        assert_eq!(found, Some(section(Interval::new(0.0, 1.0), first, 10)));
        // At most one rejected sibling on each of the ten levels.
        assert!((10..=20).contains(&cost.evaluations), "{}", cost.evaluations);
    }
    let mut cost = Cost::default();
    let search = Bisection::default().into();
    let t = Interval::new(0.0, 1.0);
    assert_eq!(first_section(&Marked(vec![]), &along_x(), t, search, &mut work, &mut cost), None);
    assert_eq!(cost.evaluations, 2, "both halves are rejected at once");
}

/// A point of the surface near `p`, by Newton's method along the gradient; rounded.
fn newton(f: &dyn Inclusion, mut p: Vec3, work: &mut Workspace) -> Option<Vec3> {
    for _ in 0..40 {
        let g = f.gradient(&p.to_box(), work);
        let slope = Vec3(g.partials.map(Interval::mid));
        let value = g.value.mid();
        p = p - slope * (value / slope.dot(slope));
        if !p.0.iter().all(|v| v.is_finite()) {
            return None;
        }
    }
    Some(p)
}

#[test]
fn cells_that_hold_a_zero_are_marked() {
    let mut r = Rng::with_seed(73);
    let mut work = Workspace::default();
    for row in PRESETS.iter().filter(|p| !["pole", "viviani", "circle", "sphere2", "flat"].contains(&p.name)) {
        let scene = preset(row.name).unwrap().unwrap();
        let (f, clip) = (scene.objects[0].surface.as_ref(), scene.objects[0].clip().bounds());
        let grids = [7, 32].map(|n| Grid::build(f, clip, n));
        let mut zeros = 0;
        for _ in 0..400 {
            let start = Vec3(std::array::from_fn(|_| (r.f64() * 2.0 - 1.0) * row.half));
            let Some(p) = newton(f, start, &mut work) else { continue };
            if !(0..3).all(|k| clip[k].contains(p[k])) {
                continue;
            }
            // A true zero lies between p and its neighbour where the sign changes: intermediate values along the gradient.
            let slope = Vec3(f.gradient(&p.to_box(), &mut work).partials.map(Interval::mid)).normalized();
            let step = slope * 1e-9;
            let (a, b) = (p - step, p + step);
            let (below, above) = (f.range(&a.to_box(), &mut work), f.range(&b.to_box(), &mut work));
            if !(below.certainly_negative() && above.certainly_positive()) {
                continue;
            }
            zeros += 1;
            for grid in &grids {
                // The zero's cell is among those that meet the segment's box.
                let range = |k: usize| grid.cells_meeting(k, Interval::point(a[k]).hull(Interval::point(b[k])));
                let marked = range(0).any(|i| range(1).any(|j| range(2).any(|k| grid.possibly_crossed([i, j, k]))));
                assert!(marked, "{}: no cell around the zero near {p:?} is marked", row.name);
            }
        }
        assert!(zeros > 100, "{}: {zeros} zeros", row.name);
        let n = grids[1].resolution();
        assert!(10 * grids[1].marked_count() < 9 * n * n * n, "{}: {} cells marked", row.name, grids[1].marked_count());
    }
}
