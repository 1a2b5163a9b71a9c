//! What hostile readers found, each as they found it.
use antumbra::audit::{Audit, AuditSpec};
use antumbra::eval::Workspace;
use antumbra::geom::{Beam, Box3, Clip, Rect, Vec3};
use antumbra::grid::Grid;
use antumbra::render::{Frame, RenderSpec, Renderer, RunSpec, Stats};
use antumbra::scene::{Light, Object, Scene, View, preset};
use antumbra::shadow::Penumbra;
use antumbra::trace::{Bisection, Cost, Effort, Piece, Scratch, Surface, Target, first_meeting, possibly_blocked};
use antumbra_interval::Interval;
use std::sync::Arc;
use std::time::Duration;

fn drawn(scene: Scene, size: usize, floor: bool) -> (Frame, Stats) {
    let spec = RenderSpec { width: size, height: size, floor, rectangles: 64, ..RenderSpec::default() };
    let mut renderer = Renderer::new(Arc::new(scene), spec, RunSpec::default()).unwrap();
    while !renderer.refine(Duration::from_secs(60)) {}
    (renderer.frame().clone(), renderer.stats())
}

fn scene_of(texts: &[&str], clip: Box3, eye: Vec3) -> Scene {
    let objects = texts.iter().map(|text| Object::parse(text, Clip::Box(clip)).unwrap()).collect();
    Scene {
        floor_height: -4.0,
        view: View { eye, target: Vec3::default(), fov_deg: 20.0 },
        lights: vec![Light::white(Rect::horizontal(Vec3::new(1.0, 2.0, 9.0), 1.0))],
        ..Scene::new("attack", objects)
    }
}

/// A function that is 0 in all of its clip hides what is behind it; its form has no error and no slope.
#[test]
fn a_solid_of_zeros_lets_no_light_through() {
    for text in ["0 = 0", "floor(z/100 + 1/2)"] {
        let scene = Scene::from_formula(text).unwrap();
        let (clip, light) = (scene.objects[0].clip().bounds(), scene.lights[0].rect.center);
        let camera = scene.view.camera(1.0);
        let (frame, _) = drawn(scene, 24, true);
        let mut shaded = 0;
        for i in (0..24 * 24).filter(|&i| frame.verdict[i] == 1) {
            let film = |k: usize| (k as f64 + 0.5) / 12.0 - 1.0;
            let d = camera.forward + camera.right * film(i % 24) - camera.up * film(i / 24);
            let p = camera.eye + d * frame.t_lo[i];
            // The middle of the segment to the light's centre, well inside the clip.
            let inside = |s: f64| {
                let q = p + (light - p) * s;
                (0..3).all(|k| clip[k].lo() + 0.3 < q[k] && q[k] < clip[k].hi() - 0.3)
            };
            if (1..100).any(|k| inside(f64::from(k) / 100.0)) {
                shaded += 1;
                assert_eq!(frame.lights[0].visible_lo[i], 0.0, "{text}, pixel {i}");
            }
        }
        assert!(shaded > 5, "{text}: {shaded}");
    }
}

/// A ray along an axis, between two faces of the clip: it is inside for ever, though `0 / 0` is the empty set.
#[test]
fn rays_along_the_axes_are_not_lost() {
    let clip = Clip::Box(Box3::cube(1.01));
    let ball = Object::parse("x^2 + y^2 + z^2 - 1", clip).unwrap();
    let f = ball.surface.as_ref();
    let surfaces = [Surface { function: f, clip, region: ball.region() }];
    let ray = Beam { origin: Vec3::new(-3.0, 0.0, 0.0), direction: Vec3::new(1.0, 0.0, 0.0).to_box() };
    let open = [Piece { surface: 0, t: Interval::new(0.0, 10.0) }];
    let (mut work, mut cost) = (Workspace::default(), Cost::default());
    let found =
        first_meeting(&surfaces, &ray, &open, Effort::FINE, &mut Scratch::default(), &mut work, &mut cost).unwrap();
    assert!(found.t.contains(2.0) && found.reason.is_none(), "{found:?}");
    let grid = Grid::build(f, clip.bounds(), 8);
    for x in [0.0, 1e-12] {
        let ray = Beam::towards(Vec3::new(x, 0.0, -3.0), Vec3::new(0.0, 0.0, 3.0).to_box());
        let target = Target { function: f, grid: &grid };
        let t = Interval::new(0.0, 1.0);
        assert!(possibly_blocked(target, &ray, t, Bisection::default().into(), &mut work, &mut cost), "x = {x}");
    }
}

/// Where f passes through 0 with its derivatives, it has opposite signs all the same.
#[test]
fn triple_roots_are_proved() {
    let clip = Clip::Box(Box3::cube(1.5));
    let object = Object::parse("(x - 1/3) (x - 1/3)^2 (2 + sin(x))", clip).unwrap();
    let surfaces = [Surface { function: object.surface.as_ref(), clip, region: object.region() }];
    let ray = Beam { origin: Vec3::new(-3.0, 0.1, 0.0), direction: Vec3::new(1.0, 0.0, 0.0).to_box() };
    let open = [Piece { surface: 0, t: Interval::new(0.0, 10.0) }];
    let (mut work, mut cost) = (Workspace::default(), Cost::default());
    let found =
        first_meeting(&surfaces, &ray, &open, Effort::FINE, &mut Scratch::default(), &mut work, &mut cost).unwrap();
    assert!(found.reason.is_none() && found.t.contains(3.0 + 1.0 / 3.0) && found.t.width() < 1e-3, "{found:?}");
}

/// An eye on a surface sees it at distance 0, which nothing resolves: that is not tried for ever.
#[test]
fn an_eye_on_a_surface_is_no_endless_work() {
    for (text, clip) in [("x^2 + y^2 + z^2 - 1", 2.0), ("x + y^2 - 1", 2.0), ("x - 1", 1.0)] {
        let scene = scene_of(&[text], Box3::cube(clip), Vec3::new(1.0, 0.0, 0.0));
        let (_, stats) = drawn(scene, 32, false);
        assert!(stats.primary_evaluations < 60_000, "{text}: {} evaluations", stats.primary_evaluations);
    }
}

/// The first surface is known so vaguely that the second lies inside its enclosure, and in front: neither is proved first.
#[test]
fn the_order_of_overlapping_surfaces_is_not_proved() {
    for shift in ["0.001", "0.006", "0.021"] {
        let second = format!("x + {shift}");
        let scene = scene_of(&["x + 1e15 - 1e15", &second], Box3::cube(20.0), Vec3::new(-10.0, 0.3, 0.2));
        let (frame, _) = drawn(scene, 16, false);
        for i in (0..16 * 16).filter(|&i| frame.verdict[i] == 1) {
            let width = frame.t_hi[i] - frame.t_lo[i];
            assert!(width < 1e-9, "{shift}, pixel {i}: proved with an enclosure as wide as {width}");
        }
    }
}

/// Where f is undefined there is no surface, and intervals prove that.
#[test]
fn undefined_space_is_empty() {
    let clip = Box3([Interval::new(-3.0, -1.5), Interval::new(-1.0, 1.0), Interval::new(-1.0, 1.0)]);
    for text in ["y + ln(x)", "y + sqrt(x)", "y + asin(x)", "x^0.5 + y"] {
        let (_, stats) = drawn(scene_of(&[text], clip, Vec3::new(4.0, -7.0, 3.0)), 8, true);
        assert_eq!(stats.hits, stats.floor_hits, "{text}: {stats:?}");
        assert_eq!(stats.proved_empty + stats.floor_hits, 64, "{text}");
        assert_eq!((stats.partly, stats.dark), (0, 0), "{text}: undefined space casts a shadow");
    }
}

/// What oscillates faster than anybody can follow ends in "budget", not in an evening.
#[test]
fn hopeless_functions_end_in_a_budget() {
    let (_, stats) = drawn(Scene::from_formula("sin(10000000 x) cos(10000000 x) + 0.6 = 0").unwrap(), 3, false);
    assert!(stats.undecided_budget > 0 && stats.primary_evaluations < 200_000, "{stats:?}");
}

/// A camera exactly on the surface, and one inside a solid.
#[test]
fn cameras_on_and_in_surfaces_come_to_an_end() {
    for (text, eye) in
        [("z - 0.2", Vec3::new(1.0, 1.0, 0.2)), ("max(0, x^2 + y^2 + z^2 - 1)", Vec3::new(0.1, 0.2, 0.3))]
    {
        let (_, stats) = drawn(scene_of(&[text], Box3::cube(1.5), eye), 4, false);
        assert!(stats.hits > 0 && stats.primary_evaluations < 400_000, "{text}: {stats:?}");
    }
}

/// First beams that are blocked though their hits are lit: they exist, and are counted.
#[test]
fn false_alarms_are_counted() {
    let (frame, stats) = drawn(preset("orthocircle").unwrap().unwrap(), 64, false);
    let planes = &frame.lights[0];
    let lit = |i: &usize| planes.initial_occluded[*i] && planes.visible_hi[*i] == 1.0 && planes.visible_lo[*i] > 0.9961;
    assert!(stats.false_alarms > 0);
    assert_eq!(stats.false_alarms, (0..64 * 64).filter(lit).count() as u64);
}

/// A clip beyond 10^9 on one axis only: its cells are looked at when a render is saved.
#[test]
fn far_clips_can_be_saved() {
    for far in [2e9, -3e9] {
        let clip = Box3([Interval::new(far, far + 1e9), Interval::new(-1e8, 1e8), Interval::new(-1e8, 1e8)]);
        let scene = Arc::new(scene_of(&["(x - 2.5e9)^2 + y^2 + z^2 = 1e16"], clip, Vec3::new(0.0, 0.0, 1.0)));
        let spec = RenderSpec { width: 2, height: 2, ..RenderSpec::default() };
        let renderer = Renderer::new(scene, spec, RunSpec::default()).unwrap();
        assert!(renderer.save(&mut Vec::new()).is_ok());
    }
}

/// At a cusp values shrink so slowly that a search in doubles never sees the zero: the audit must not call that a surface missed.
#[test]
fn the_audit_does_not_accuse_cusps() {
    for text in ["sqrt(abs(x + 0.5 z - 0.2)) = 0", "cbrt(x + 0.5 z - 0.2)^2 = 0"] {
        let scene = Arc::new(Scene::from_formula(text).unwrap());
        let spec = RenderSpec { width: 12, height: 12, ..RenderSpec::default() };
        let mut renderer = Renderer::new(Arc::clone(&scene), spec, RunSpec::default()).unwrap();
        while !renderer.refine(Duration::from_secs(60)) {}
        let spec = AuditSpec { pixels: 30, seed: 1, light_scale: 1.0, floor: false };
        let mut audit = Audit::new(&scene, renderer.frame(), spec, RunSpec::default()).unwrap();
        while !audit.step().unwrap() {}
        let report = audit.report();
        assert_eq!(report.violations, Vec::<String>::new(), "{text}");
        assert!(report.total().unclear > 0, "{text}: {report:?}");
    }
}

/// Where forms overflow, intervals still know a sign; and where nothing is known, a hit ends within its budget.
#[test]
fn overflowing_forms_end() {
    let scene = scene_of(&["x^196608 = 1"], Box3::cube(3.0), Vec3::new(8.0, -13.0, 9.0));
    let spec = RenderSpec { width: 4, height: 4, penumbra: Penumbra::First, ..RenderSpec::default() };
    let mut renderer = Renderer::new(Arc::new(scene), spec, RunSpec::default()).unwrap();
    while !renderer.refine(Duration::from_secs(60)) {}
    let stats = renderer.stats();
    assert!(stats.hits > 0 && stats.shadow_evaluations < stats.hits * 400_000, "{stats:?}");
}
