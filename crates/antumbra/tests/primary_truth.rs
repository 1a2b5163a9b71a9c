//! What the camera sees, against plain sampling: random pixels of every preset, curves that must not vanish, poles and
//! steps that must not be drawn, domains, threads.
#![allow(
    clippy::disallowed_methods,
    reason = "the checker is independent on purpose: it uses other functions than the library"
)]
#[path = "truth/double.rs"]
mod double;
#[path = "truth/sampler.rs"]
mod sampler;

use antumbra::geom::Vec3;
use antumbra::render::{Frame, Method, RenderSpec, Renderer, RunSpec};
use antumbra::scene::{PRESETS, Scene, named};
use sampler::{Judge, Seen, Shares, camera_ray};
use std::sync::Arc;
use std::time::Duration;

const EMPTY: u8 = 0;
const HIT: u8 = 1;
const TOUCHING: u8 = 3;

fn spec(size: usize, floor: bool) -> RenderSpec {
    RenderSpec { width: size, height: size, method: Method::Certified, floor, rectangles: 4, ..RenderSpec::default() }
}

fn render(scene: &Arc<Scene>, spec: RenderSpec, threads: usize) -> Frame {
    let mut renderer = Renderer::new(Arc::clone(scene), spec, RunSpec { threads: Some(threads) }).unwrap();
    while !renderer.refine(Duration::from_secs(60)) {}
    renderer.frame().clone()
}

fn scene(name: &str) -> Arc<Scene> {
    Arc::new(named(name).unwrap().unwrap())
}

fn judges(scene: &Scene, floor: bool) -> Vec<Judge> {
    let floor = floor.then(|| scene.floor().unwrap());
    scene.objects.iter().chain(&floor).map(Judge::new).collect()
}

/// A picture and everything that is needed to send rays through it.
struct Picture {
    scene: Arc<Scene>,
    frame: Frame,
    judges: Vec<Judge>,
}

/// Far behind every scene.
const FAR: f64 = 1e4;

impl Picture {
    fn new(name: &str, size: usize, floor: bool) -> Self {
        Self::of(scene(name), size, floor)
    }

    fn of(scene: Arc<Scene>, size: usize, floor: bool) -> Self {
        let frame = render(&scene, spec(size, floor), 1);
        Self { judges: judges(&scene, floor), scene, frame }
    }

    /// What the ray through a place of the film, in pixels, does up to `to`.
    fn look(&self, column: f64, row: f64, to: f64) -> Seen {
        let size = [self.frame.width, self.frame.height];
        let (eye, direction) = camera_ray(&self.scene.view.camera(1.0), size, column, row);
        let mut all = Seen::Clear;
        for judge in &self.judges {
            match judge.follow(&eye, &direction, 0.0, to, None) {
                Seen::Clear => {}
                Seen::Unclear => all = Seen::Unclear,
                blocked @ Seen::Blocked(_) => return blocked,
            }
        }
        all
    }

    /// What is wrong with what is said of a pixel; `None` if nothing was found.
    fn fault(&self, index: usize, frame: &Frame, random: &mut fastrand::Rng, slack: f64) -> Option<String> {
        let size = frame.width;
        let (column, row) = ((index % size) as f64, (index / size) as f64);
        let (verdict, coverage) = (frame.verdict[index], [frame.coverage_lo[index], frame.coverage_hi[index]]);
        match verdict {
            EMPTY => {
                for _ in 0..6 {
                    // Not at the very edge, where the pixel's border and the sampler's rays are rounded.
                    let [x, y] = [random.f64(), random.f64()].map(|k| 1e-9 + (1.0 - 2e-9) * k);
                    let seen = self.look(column + x, row + y, FAR);
                    if seen != Seen::Clear {
                        return Some(format!("empty, but ({x}, {y}) is {seen:?}"));
                    }
                }
            }
            HIT => {
                let (eye, direction) = camera_ray(&self.scene.view.camera(1.0), [size; 2], column + 0.5, row + 0.5);
                let (lo, hi) = (frame.t_lo[index], frame.t_hi[index]);
                let wide = 1e-12 * hi;
                let crosses =
                    |j: &Judge| j.sign(&eye, &direction, lo - wide) * j.sign(&eye, &direction, hi + wide) < 0.0;
                if !self.judges.iter().any(crosses) {
                    return Some(format!("hit, but no change of sign in [{lo}, {hi}]"));
                }
                if hi - lo > 1e-6 * hi {
                    return Some(format!("hit, but only known to be in [{lo}, {hi}]"));
                }
                // 1e-7 before the hit f is small; the sampler knows its sign there.
                if let seen @ Seen::Blocked(_) = self.look(column + 0.5, row + 0.5, lo - 1e-7) {
                    return Some(format!("hit at {lo}, but {seen:?} before"));
                }
            }
            _ => {}
        }
        let n = 8;
        let part = |k: usize| (k as f64 / n as f64).clamp(1e-9, 1.0 - 1e-9);
        let shares = Shares::of(n, |i, j| match self.look(column + part(i), row + part(j), FAR) {
            Seen::Clear => Some(false),
            Seen::Blocked(_) => Some(true),
            Seen::Unclear => None,
        });
        let agree = shares.agree(coverage[0], coverage[1], slack);
        (!agree).then(|| format!("coverage {coverage:?}, sampled {shares:?}"))
    }
}

/// Random pixels of a picture: how many of each verdict were looked at.
fn check(scene: Arc<Scene>, floor: bool, pixels: usize) -> [usize; 256] {
    let picture = Picture::of(scene, 16, floor);
    let name = picture.scene.name.as_str();
    let mut random = fastrand::Rng::with_seed(5);
    let mut seen = [0; 256];
    // Edges of cells with equal corners may hide a little; thin things hide better.
    let slack = if ["twister", "wire3", "wire6"].contains(&name) { 0.2 } else { 4.0 / 64.0 };
    for _ in 0..pixels {
        let index = random.usize(0..picture.frame.verdict.len());
        if let Some(fault) = picture.fault(index, &picture.frame, &mut random, slack) {
            panic!("{name}, floor {floor}, pixel {index}: {fault}");
        }
        seen[usize::from(picture.frame.verdict[index])] += 1;
    }
    seen
}

#[test]
fn sampling_confirms_what_pixels_show() {
    let mut all = [0; 256];
    for preset in PRESETS {
        for floor in [false, true] {
            let seen = check(scene(preset.name), floor, 12);
            all.iter_mut().zip(seen).for_each(|(a, s)| *a += s);
        }
    }
    assert!(all[usize::from(EMPTY)] > 60 && all[usize::from(HIT)] > 60, "{:?}", &all[..8]);
}

#[test]
fn sampling_confirms_formulas_with_poles_steps_and_domains() {
    let mut all = [0; 256];
    for text in [
        "sqrt(x) - y = 0",
        "1/x + y + z = 0",
        "tan(2x) - z = 0",
        "max(abs(x) - 0.5, abs(y) - 0.7) = 0",
        "floor(2x) + 0.5 + y/3 = 0",
        "sqrt(1 - x^2 - y^2) - z = 0",
        "asin(x) + y - z/2 = 0",
        "x / (y^2 + z - 0.2) - 0.3 = 0",
        "atan2(y, x) - z = 0",
        "mod(x, 1) - 0.5 + z/5 = 0",
    ] {
        let seen = check(Arc::new(Scene::from_formula(text).unwrap()), false, 60);
        all.iter_mut().zip(seen).for_each(|(a, s)| *a += s);
    }
    assert!(all[usize::from(EMPTY)] > 10 && all[usize::from(HIT)] > 60, "{:?}", &all[..8]);
}

#[test]
fn wrong_claims_are_found() {
    let picture = Picture::new("sphere", 16, false);
    let mut random = fastrand::Rng::with_seed(3);
    let mut fault = |index, frame: &Frame| picture.fault(index, frame, &mut random, 4.0 / 64.0);
    for index in 0..256 {
        let mut lie = picture.frame.clone();
        match picture.frame.verdict[index] {
            EMPTY => {
                (lie.verdict[index], lie.t_lo[index], lie.t_hi[index]) = (HIT, 4.0, 4.0 + 1e-9);
                assert!(fault(index, &lie).is_some(), "a hit that is none");
                lie.verdict[index] = EMPTY;
                (lie.coverage_lo[index], lie.coverage_hi[index]) = (0.2, 1.0);
                assert!(fault(index, &lie).is_some(), "covered by nothing");
            }
            HIT if picture.frame.coverage_lo[index] == 1.0 => {
                lie.verdict[index] = EMPTY;
                assert!(fault(index, &lie).is_some(), "an empty pixel that is not");
                lie.verdict[index] = HIT;
                (lie.t_lo[index], lie.t_hi[index]) = (lie.t_lo[index] + 1e-6, lie.t_hi[index] + 1e-6);
                assert!(fault(index, &lie).is_some(), "behind the hit");
            }
            _ => {}
        }
    }
}

/// All planes, bit for bit.
fn bits(frame: &Frame) -> impl PartialEq + std::fmt::Debug + use<> {
    let f64s = |plane: &[f64]| plane.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    let f32s = |plane: &[f32]| plane.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    (
        frame.verdict.clone(),
        [
            &frame.t_lo,
            &frame.t_hi,
            &frame.lights[0].visible_lo,
            &frame.lights[0].visible_hi,
            &frame.coverage_lo,
            &frame.coverage_hi,
        ]
        .map(|p| f64s(p)),
        [frame.normal.as_flattened(), frame.rgb.as_flattened(), &frame.lights[0].facing].map(f32s),
        frame.lights[0].initial_occluded.clone(),
        frame.cost.clone(),
    )
}

#[test]
fn a_squared_sphere_is_a_sphere() {
    let [plain, squared] =
        ["sphere", "sphere2"].map(|name| render(&scene(name), RenderSpec { rectangles: 4000, ..spec(40, true) }, 2));
    assert!(plain.verdict.iter().filter(|v| **v == HIT).count() > 500);
    assert!(bits(&plain) == bits(&squared));
}

#[test]
fn threads_and_steps_change_no_bit() {
    for name in ["chubs", "wire3", "whitney", "pole"] {
        let scene = scene(name);
        // More than one tile in each direction.
        let one = render(&scene, spec(70, true), 1);
        let two = render(&scene, spec(70, true), 2);
        assert!(bits(&one) == bits(&two), "{name}");
        let mut renderer = Renderer::new(scene, spec(70, true), RunSpec { threads: Some(2) }).unwrap();
        while !renderer.refine(Duration::ZERO) {}
        assert!(bits(&one) == bits(renderer.frame()), "{name}, in small steps");
    }
}

#[test]
fn poles_and_steps_are_not_surfaces() {
    for text in [
        "1 / (x^2 + y^2 + z^2 - 1) = 0",
        "1 / x = 0",
        "floor(x) + 1/2 = 0",
        "sign(x + 0.1) + 1/3 = 0",
        "x / abs(x) + y^2 / 100 = 0",
    ] {
        let scene = Arc::new(Scene::from_formula(text).unwrap());
        let frame = render(&scene, spec(24, false), 1);
        assert!(frame.verdict.iter().all(|v| *v != HIT && *v != Frame::PARTLY), "{text}: {:?}", frame.verdict);
        assert!(frame.coverage_lo.iter().all(|c| *c == 0.0), "{text}");
    }
    // A pole in front of a floor: nothing but the floor is hit, and it is not in its shadow.
    let scene = scene("pole");
    let frame = render(&scene, RenderSpec { rectangles: 100, ..spec(24, true) }, 1);
    let camera = scene.view.camera(1.0);
    let mut floor = 0;
    for index in (0..frame.verdict.len()).filter(|&i| frame.verdict[i] == HIT) {
        let (_, d) = camera_ray(&camera, [24, 24], (index % 24) as f64 + 0.5, (index / 24) as f64 + 0.5);
        let z = camera.eye[2] + frame.t_lo[index] * d[2].hi;
        assert!(
            (z - scene.floor_height).abs() < 1e-9 && frame.lights[0].visible_hi[index] == 1.0,
            "pixel {index}, z = {z}"
        );
        floor += 1;
    }
    assert!(floor > 50, "{floor}");
}

#[test]
fn zeros_between_poles_are_surfaces() {
    // tan changes sign at its zeros, k pi, and at its poles in between: only the zeros are hit.
    let scene = Arc::new(Scene::from_formula("tan(x) = 0").unwrap());
    let frame = render(&scene, spec(24, false), 1);
    let camera = scene.view.camera(1.0);
    let mut hits = 0;
    for index in (0..frame.verdict.len()).filter(|&i| frame.verdict[i] == HIT) {
        let (_, d) = camera_ray(&camera, [24, 24], (index % 24) as f64 + 0.5, (index / 24) as f64 + 0.5);
        let x = camera.eye[0] + frame.t_lo[index] * d[0].hi;
        let k = (x / std::f64::consts::PI).round();
        assert!((x - k * std::f64::consts::PI).abs() < 1e-9, "pixel {index}, x = {x}");
        hits += 1;
    }
    assert!(hits > 20, "{hits}");
}

#[test]
fn surfaces_end_where_their_formulas_do() {
    // Each: a formula, and what holds of every point of its surface.
    type Domain = fn([f64; 3]) -> f64;
    let rows: [(&str, Domain, Domain); 4] = [
        ("sqrt(x) - y = 0", |p| p[1] - p[0].max(0.0).sqrt(), |p| p[0]),
        ("ln(x) + z^2 = 0", |p| p[0] - (-p[2] * p[2]).exp(), |p| p[0]),
        ("sqrt(1 - x^2 - y^2) - z = 0", |p| p[0] * p[0] + p[1] * p[1] + p[2] * p[2] - 1.0, |p| p[2]),
        ("asin(x) - z = 0", |p| p[0] - p[2].sin(), |p| std::f64::consts::FRAC_PI_2 - p[2].abs()),
    ];
    for (text, zero, inside) in rows {
        let scene = Arc::new(Scene::from_formula(text).unwrap());
        let frame = render(&scene, spec(24, false), 1);
        let camera = scene.view.camera(1.0);
        let mut hits = 0;
        for index in (0..frame.verdict.len()).filter(|&i| frame.verdict[i] == HIT) {
            let (_, d) = camera_ray(&camera, [24, 24], (index % 24) as f64 + 0.5, (index / 24) as f64 + 0.5);
            let p = std::array::from_fn(|k| camera.eye[k] + frame.t_lo[index] * d[k].hi);
            assert!(zero(p).abs() < 1e-8 && inside(p) > -1e-8, "{text}, pixel {index}: {p:?}");
            hits += 1;
        }
        assert!(hits > 8, "{text}: {hits}");
    }
}

/// The pixel that shows a point, or none if it is outside of the picture or within `1e-6` of a pixel's edge.
fn pixel_of(scene: &Scene, size: usize, p: [f64; 3]) -> Option<usize> {
    let camera = scene.view.camera(1.0);
    let v = Vec3(p) - camera.eye;
    // v = t (forward + x right + y up), with orthogonal vectors.
    let t = v.dot(camera.forward) / camera.forward.dot(camera.forward);
    let x = v.dot(camera.right) / camera.right.dot(camera.right) / t;
    let y = v.dot(camera.up) / camera.up.dot(camera.up) / t;
    let place = [0.5 * (1.0 + x), 0.5 * (1.0 - y)].map(|k| k * size as f64);
    let near_edge = place.iter().any(|k| (k - k.round()).abs() < 1e-6);
    let outside = place.iter().any(|k| *k < 0.0 || *k >= size as f64);
    (!near_edge && !outside).then(|| place[1] as usize * size + place[0] as usize)
}

/// The pixels of points of a curve, at least `least` of them.
fn pixels_of(scene: &Scene, size: usize, curve: impl Fn(f64) -> [f64; 3], least: usize) -> Vec<usize> {
    let mut pixels: Vec<usize> =
        (0..4000).filter_map(|k| pixel_of(scene, size, curve(f64::from(k) / 4000.0))).collect();
    pixels.sort_unstable();
    pixels.dedup();
    assert!(pixels.len() >= least, "{}: {}", scene.name, pixels.len());
    pixels
}

/// Odd: the z axis is seen in the middle of pixels, not at their edges.
const SIZE: usize = 63;

fn circle(k: f64) -> [f64; 3] {
    let a = std::f64::consts::TAU * k;
    [a.cos(), a.sin(), 0.0]
}

fn viviani(k: f64) -> [f64; 3] {
    let a = 2.0 * std::f64::consts::TAU * k;
    [1.0 + a.cos(), a.sin(), 2.0 * (0.5 * a).sin()]
}

#[test]
fn curves_do_not_vanish() {
    for (name, curve) in [("circle", circle as fn(f64) -> [f64; 3]), ("viviani", viviani)] {
        let scene = scene(name);
        let frame = render(&scene, spec(SIZE, false), 2);
        for index in pixels_of(&scene, SIZE, curve, 60) {
            assert!(frame.verdict[index] != EMPTY, "{name} passes through pixel {index}: proved empty");
            assert!(frame.coverage_hi[index] > 0.0);
        }
        // f >= 0: no sign can prove anything.
        assert!(frame.verdict.iter().all(|v| *v != HIT && *v != Frame::PARTLY), "{name}");
        assert!(frame.coverage_lo.iter().all(|c| *c == 0.0));
        let undecided = frame.verdict.iter().filter(|v| **v != EMPTY).count();
        assert!(undecided < 1000, "{name}: {undecided} of {} pixels are not proved empty", SIZE * SIZE);
    }
}

#[test]
fn the_handle_of_the_umbrella_does_not_vanish() {
    let scene = scene("whitney");
    let frame = render(&scene, spec(SIZE, false), 2);
    for index in pixels_of(&scene, SIZE, |k| [0.0, 0.0, -0.59 * k], 8) {
        assert!(frame.verdict[index] != EMPTY, "the handle passes through pixel {index}: proved empty");
    }
}

#[test]
fn wires_and_blades_do_not_vanish() {
    for name in ["wire3", "wire6"] {
        let scene = scene(name);
        let frame = render(&scene, spec(SIZE, false), 2);
        for index in pixels_of(&scene, SIZE, circle, 60) {
            assert!(frame.verdict[index] != EMPTY, "{name} passes through pixel {index}: proved empty");
        }
        let shown = frame.verdict.iter().filter(|v| **v != EMPTY).count();
        assert!(shown < 1000, "{name}: {shown}");
    }
    let scene = scene("twister");
    let frame = render(&scene, RenderSpec { rectangles: 1, ..spec(SIZE, false) }, 2);
    for u in [-0.95, -0.5, 0.0, 0.3, 0.99] {
        let line = |k: f64| {
            let z = 3.1 * k - 1.55;
            [u * (3.0 * z).cos(), u * (3.0 * z).sin(), z]
        };
        for index in pixels_of(&scene, SIZE, line, 30) {
            assert!(frame.verdict[index] != EMPTY, "the blade passes through pixel {index}: proved empty");
        }
    }
}

#[test]
fn touching_is_what_undecided_pixels_say() {
    for name in ["circle", "viviani"] {
        let scene = scene(name);
        let frame = render(&scene, spec(SIZE, false), 2);
        let reasons = frame.verdict.iter().fold([0; 7], |mut n, v| {
            n[usize::from(*v)] += 1;
            n
        });
        assert!(reasons[usize::from(TOUCHING)] + reasons[2] > 50 && reasons[4] == 0, "{name}: {reasons:?}");
    }
}
