//! Brackets of the visible fraction against plain sampling, on random pixels of every preset. The sampler has its own
//! code path (`truth/sampler.rs`): the hit again by bisection in twice the precision, the light at the corners of a
//! grid, each ray by many values of f. A cell whose corners disagree counts as unknown, so the sampled share is itself
//! a pair of bounds; what cells with equal corners may hide is allowed for by a few cells of slack.
#![allow(
    clippy::disallowed_methods,
    reason = "the checker is independent on purpose: it uses other functions than the library"
)]
#[path = "truth/double.rs"]
mod double;
#[path = "truth/light.rs"]
mod light;
#[path = "truth/sampler.rs"]
mod sampler;

use antumbra::eval::Workspace;
use antumbra::geom::{Box3, Clip, Rect, Vec3};
use antumbra::render::{Frame, Method, RenderSpec, Renderer, RunSpec};
use antumbra::scene::{Object, PRESETS, Scene, View, preset};
use antumbra::shadow::{self, Known, Penumbra, Receiver, Scratch, Tolerance};
use antumbra::trace::{Cost, Sign, Surface};
use antumbra_interval::Interval;
use light::{found, root, sees, sees_finely, visible};
use sampler::{Judge, Point, Seen, Shares, point};
use std::sync::Arc;
use std::time::Duration;

/// Side of the pictures.
const SIZE: usize = 20;
/// Cells along each side of the light.
const GRID: usize = 16;
/// Pixels looked at in each picture.
const PIXELS: usize = 6;

/// Surfaces thinner than what lies between two rays of the grid: their shadows may hide between the corners.
const THIN: [&str; 3] = ["twister", "wire3", "wire6"];

fn slack(name: &str) -> f64 {
    let cells = if THIN.contains(&name) { 12.0 } else { 3.0 };
    cells / (GRID * GRID) as f64
}

fn render(scene: &Arc<Scene>, light_scale: f64, floor: bool) -> Frame {
    let method = Method::Certified;
    // Few rectangles: brackets may stay wide, never wrong. One of the blade's costs a hundred times another's.
    let rectangles = match scene.name.as_str() {
        "twister" => 4,
        "gyroid" => 40,
        _ => 200,
    };
    let spec =
        RenderSpec { width: SIZE, height: SIZE, method, light_scale, floor, rectangles, ..RenderSpec::default() };
    let mut renderer = Renderer::new(Arc::clone(scene), spec, RunSpec { threads: Some(1) }).unwrap();
    while !renderer.refine(Duration::from_secs(60)) {}
    renderer.frame().clone()
}

/// The sampler's answer for a proved hit.
fn sampled(
    scene: &Scene,
    judges: &[Judge],
    frame: &Frame,
    index: usize,
    light: usize,
    light_scale: f64,
) -> Option<Shares> {
    let (own, p, before) = found(scene, judges, frame, index)?;
    Some(visible(judges, own, &p, before, &scene.lights[light].rect.scaled(light_scale), GRID))
}

/// Of all hits that are said to see the whole light or nothing of it: pixels in which one of five points of the light
/// says otherwise. Most of these claims are made by shafts, for many pixels at once.
fn contradicted(scene: &Scene, judges: &[Judge], frame: &Frame, light_scale: f64) -> Vec<usize> {
    let mut wrong = Vec::new();
    let lights = scene.lights.iter().map(|l| l.rect.scaled(light_scale)).zip(&frame.lights);
    for (index, (light, planes)) in
        (0..SIZE * SIZE).filter(|&i| frame.verdict[i] == 1).flat_map(|i| lights.clone().map(move |l| (i, l)))
    {
        let (lit, dark) = (planes.visible_lo[index] == 1.0, planes.visible_hi[index] == 0.0);
        let Some((own, p, before)) = found(scene, judges, frame, index).filter(|_| lit || dark) else { continue };
        // Not the very corners: what is lit up to a set without area may be tangent there.
        let corners = [[-0.98, -0.98], [0.98, -0.98], [-0.98, 0.98], [0.98, 0.98], [0.0, 0.0]];
        // A blade may be crossed between two samples: what seems to be a contradiction is looked at again.
        let against = |&at: &[f64; 2]| {
            sees(judges, own, &p, before, &light, at) == Some(dark)
                && sees_finely(judges, own, &p, before, &light, at) == Some(dark)
        };
        if corners.iter().any(against) {
            wrong.push(index);
        }
    }
    wrong
}

fn judges(scene: &Scene, floor: bool) -> Vec<Judge> {
    let floor = floor.then(|| scene.floor().unwrap());
    scene.objects.iter().chain(&floor).map(Judge::new).collect()
}

#[derive(Default, Debug)]
struct Tally {
    checked: usize,
    undecided: usize,
    lit: usize,
    dark: usize,
    partly: usize,
    /// Penumbrae in which the sampler itself knows the share up to 0.2.
    sharp: usize,
}

fn check(scenes: Vec<Scene>) -> Tally {
    let mut tally = Tally::default();
    let mut wrong = Vec::new();
    let mut random = fastrand::Rng::with_seed(11);
    for scene in scenes.into_iter().map(Arc::new) {
        let name = scene.name.as_str();
        for (light_scale, floor) in [(1.0, false), (4.0, false), (1.0, true), (4.0, true)] {
            let frame = render(&scene, light_scale, floor);
            let judges = judges(&scene, floor);
            let against = contradicted(&scene, &judges, &frame, light_scale);
            if !against.is_empty() {
                wrong.push(format!("{name}, light x{light_scale}, floor {floor}: pixels {against:?}"));
            }
            let hits: Vec<usize> = (0..SIZE * SIZE).filter(|&i| frame.verdict[i] == 1).collect();
            tally.undecided += frame.verdict.iter().filter(|v| (2..=5).contains(*v)).count();
            // Half of them where the light is partly visible, as far as there are such.
            for (k, (light, planes)) in (0..PIXELS).flat_map(|k| frame.lights.iter().enumerate().map(move |l| (k, l))) {
                let (edge, rest): (Vec<usize>, Vec<usize>) =
                    hits.iter().partition(|&&i| planes.visible_hi[i] > 0.0 && planes.visible_lo[i] < 1.0);
                let from = if k % 2 == 0 && !edge.is_empty() || rest.is_empty() { &edge } else { &rest };
                let Some(&index) = random.choice(from) else { continue };
                let (lo, hi) = (planes.visible_lo[index], planes.visible_hi[index]);
                let what =
                    format!("{name}, light x{light_scale}, floor {floor}, pixel {index}, light {light}: [{lo}, {hi}]");
                let Some(shares) = sampled(&scene, &judges, &frame, index, light, light_scale) else {
                    wrong.push(format!("{what}: no hit"));
                    continue;
                };
                if !shares.agree(lo, hi, slack(name)) {
                    wrong.push(format!("{what}, sampled {shares:?}"));
                }
                tally.checked += 1;
                tally.lit += usize::from(lo == 1.0);
                tally.dark += usize::from(hi == 0.0);
                let partly = hi > 0.05 && lo < 0.95;
                tally.partly += usize::from(partly);
                tally.sharp += usize::from(partly && shares.hi - shares.lo < 0.2);
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}\n{tally:?}");
    tally
}

#[test]
fn sampling_confirms_the_paper_s_surfaces() {
    let tally = check(PRESETS[..4].iter().map(|p| preset(p.name).unwrap().unwrap()).collect());
    assert!(
        tally.checked >= 90 && tally.lit > 10 && tally.dark > 10 && tally.partly > 10 && tally.sharp > 5,
        "{tally:?}"
    );
}

#[test]
fn sampling_confirms_the_other_presets() {
    let tally = check(PRESETS[4..].iter().map(|p| preset(p.name).unwrap().unwrap()).collect());
    assert!(tally.checked >= 200 && tally.undecided > 100 && tally.partly > 20, "{tally:?}");
}

/// From the usual place no centre of a pixel meets a wire: look at one point of it through a telescope.
#[test]
fn sampling_confirms_hits_on_wires() {
    let near = |name: &str, fov_deg: f64| {
        let mut scene = preset(name).unwrap().unwrap();
        scene.view = View { target: Vec3::new(0.8, -0.6, 0.0), fov_deg, ..scene.view };
        scene
    };
    let tally = check(vec![near("wire3", 0.02), near("wire6", 2e-5)]);
    assert!(tally.checked == 8 * PIXELS && tally.lit + tally.dark > 10, "{tally:?}");
}

/// Formulas with poles, steps, kinks and borders of their domain, and plain ones.
const ODD: [&str; 20] = [
    "x^2 + y^2 + z^2 = 1",
    "sqrt(x) - y = 0",
    "1/x + y + z = 0",
    "ln(x + 1) + z = 0",
    "tan(2x) - z = 0",
    "max(abs(x) - 0.5, abs(y) - 0.7) = 0",
    "abs(x) - abs(y) + z = 0",
    "min(x^2 + y^2 - 0.3, z) = 0",
    "floor(2x) + 0.5 + y/3 = 0",
    "x y z - 0.05 = 0",
    "sqrt(1 - x^2 - y^2) - z = 0",
    "(x^2 + y^2 - 0.5)^2 + z^2 - 0.01 = 0",
    "asin(x) + y - z/2 = 0",
    "x / (y^2 + z - 0.2) - 0.3 = 0",
    "sin(5x) + y = 0",
    "cbrt(x) - z = 0",
    "x^0.5 - z^2 + y = 0",
    "atan2(y, x) - z = 0",
    "mod(x, 1) - 0.5 + z/5 = 0",
    "sign(x) + 2y = 0",
];

/// One or two odd surfaces in random boxes, a receiver on one of them wherever a random ray meets it, and a light of any
/// shape and place: it may lie in the surface, behind it, or beyond its box.
#[test]
fn sampling_confirms_odd_surfaces() {
    let mut random = fastrand::Rng::with_seed(2);
    let (mut brackets, mut partly) = (0, 0);
    let parsed = [Clip::Everywhere, Clip::Box(Box3::cube(1.2))]
        .map(|clip| ODD.iter().map(|text| Object::parse(text, clip).unwrap()).collect::<Vec<_>>());
    for round in 0..2500 {
        let objects: Vec<Object> = (0..random.usize(1..3))
            .map(|_| {
                let mut side = || {
                    let lo = 2.0 * random.f64() - 1.5;
                    Interval::new(lo, lo + 0.3 + 1.5 * random.f64())
                };
                let small = Box3([side(), side(), side()]);
                let which = random.usize(0..3);
                let formula = random.usize(0..ODD.len());
                let small = Clip::Box(small);
                match which {
                    0 | 1 => parsed[which][formula].clone(),
                    _ => parsed[0][formula].clone().with_clip(small),
                }
            })
            .collect();
        let judges: Vec<Judge> = objects.iter().map(Judge::new).collect();
        let own = random.usize(0..objects.len());
        let mut vector = |size: f64| Vec3(std::array::from_fn(|_| size * (2.0 * random.f64() - 1.0)));
        let (eye, direction) = (point(vector(1.2)), point(vector(1.5)));
        let Seen::Blocked([a, b]) = judges[own].follow(&eye, &direction, 0.0, 1.0, None) else { continue };
        let ends = [a - 1e-9, b + 1e-9];
        let [before, behind] = ends.map(|t| judges[own].sign(&eye, &direction, t));
        if before * behind >= 0.0 {
            continue;
        }
        let t = root(&judges[own], &eye, &direction, ends);
        let hit: Point = std::array::from_fn(|k| eye[k] + direction[k] * t);
        let light = Rect { center: vector(2.5), edge_u: vector(0.8), edge_v: vector(0.8) };
        let surfaces: Vec<Surface<'_>> = objects
            .iter()
            .map(|o| Surface { function: o.surface.as_ref(), clip: o.clip(), region: o.region() })
            .collect();
        let receiver = Receiver {
            point: Box3(hit.map(|x| Interval::new(x.hi - 1e-14, x.hi + 1e-14))),
            surface: own,
            side: if before > 0.0 { Sign::Positive } else { Sign::Negative },
        };
        let tolerance = Tolerance { width: 1.0 / 255.0, rectangles: 300, penumbra: Penumbra::default() };
        let (mut scratch, mut work, mut cost) = (Scratch::default(), Workspace::default(), Cost::default());
        let pieces = Known::nothing(&surfaces);
        let b = shadow::visible(&surfaces, &receiver, &light, &pieces, tolerance, &mut scratch, &mut work, &mut cost);
        let shares = visible(&judges, own, &hit, before, &light, 12);
        assert!(
            shares.agree(b.lo, b.hi, 4.0 / 144.0),
            "round {round}: {objects:?}, on {own} at {receiver:?}, {light:?}: {b:?}, sampled {shares:?}"
        );
        brackets += 1;
        partly += usize::from(b.hi > 0.02 && b.lo < 0.98);
    }
    assert!(brackets > 300 && partly > 100, "{brackets} brackets, {partly} of penumbrae");
}

/// The check must be able to fail: brackets that are wrong on purpose are found.
#[test]
fn wrong_brackets_are_found() {
    let scene = Arc::new(preset("sphere").unwrap().unwrap());
    let frame = render(&scene, 4.0, true);
    let judges = judges(&scene, true);
    let (mut penumbrae, mut found) = (0, 0);
    for index in (0..SIZE * SIZE).filter(|&i| frame.verdict[i] == 1).step_by(5) {
        let (lo, hi) = (frame.lights[0].visible_lo[index], frame.lights[0].visible_hi[index]);
        let shares = sampled(&scene, &judges, &frame, index, 0, 4.0).unwrap();
        let agree = |lo, hi| shares.agree(lo, hi, slack("sphere"));
        assert!(agree(lo, hi));
        if lo == 1.0 || hi == 0.0 {
            assert!(!agree(1.0 - hi, 1.0 - lo), "light and shadow exchanged at {index}");
        } else {
            penumbrae += 1;
            found += usize::from(!agree(lo + 0.15, hi + 0.15) && !agree(lo - 0.15, hi - 0.15));
        }
    }
    assert!(penumbrae >= 3 && 2 * found > penumbrae, "{found} of {penumbrae}");
    // A hit that is not there.
    let mut moved = frame.clone();
    let index = (0..SIZE * SIZE).find(|&i| frame.verdict[i] == 1).unwrap();
    (moved.t_lo[index], moved.t_hi[index]) = (frame.t_lo[index] + 1e-9, frame.t_hi[index] + 1e-9);
    assert!(sampled(&scene, &judges, &moved, index, 0, 1.0).is_none());
}
