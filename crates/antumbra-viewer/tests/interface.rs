//! The window without a display: hands and keys as events, answers as labels.
use antumbra::{
    geom::Vec3,
    render::{Frame, RunSpec},
    scene::{SceneFile, file_named},
};
use antumbra_viewer::{
    host::{Found, Host, Place, SharedHost},
    ui::App,
};
use eframe::egui::{
    Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, Pos2, Role, TouchPhase, Vec2,
};
use egui_kittest::{Harness, kittest::Queryable};
use std::{
    path::{Path, PathBuf},
    sync::Arc,
    time::{Duration, Instant},
};

/// Writes files as they come.
struct Plain;

struct Written(PathBuf);

impl Place for Written {
    fn fill(self: Box<Self>, bytes: &[u8]) -> Result<(), String> {
        std::fs::write(&self.0, bytes).map_err(|e| e.to_string())
    }
}

fn formula(text: &str) -> Found {
    Found { name: "formula".to_owned(), file: SceneFile::of_formula(text), own: false }
}

impl Host for Plain {
    fn find(&self, text: &str) -> Result<Found, String> {
        match file_named(text) {
            Some(file) => Ok(Found { name: text.to_owned(), file: file.map_err(|e| e.to_string())?, own: false }),
            None if text.contains('x') => Ok(formula(text)),
            None => Err(format!("no preset named `{text}`")),
        }
    }

    fn reserve(&self, path: &Path) -> Result<Box<dyn Place>, String> {
        Ok(Box::new(Written(path.to_owned())))
    }
}

type Window = Harness<'static, App>;

fn window(start: Found) -> Window {
    sized(start, [1180.0, 760.0])
}

fn sized(start: Found, size: [f32; 2]) -> Window {
    let mut harness = Harness::builder().with_size(size).build_eframe(|creation| {
        let host: SharedHost = Arc::new(Plain);
        App::new(&creation.egui_ctx, host, RunSpec::default(), start).unwrap()
    });
    harness.step();
    harness
}

/// A small ball: everything is done soon.
fn ball() -> Window {
    let mut window = window(formula("x^2 + y^2 + z^2 = 1"));
    until(&mut window, "the picture", |w| w.state().is_done());
    window
}

/// Steps until something is so.
fn until(window: &mut Window, what: &str, so: impl Fn(&Window) -> bool) {
    let begun = Instant::now();
    while !so(window) {
        assert!(begun.elapsed() < Duration::from_secs(180), "{what} did not come");
        std::thread::sleep(Duration::from_millis(4));
        window.step();
    }
}

fn has(window: &Window, text: &str) -> bool {
    window
        .query_all_by(|node| {
            node.label().is_some_and(|l| l.contains(text)) || node.value().is_some_and(|v| v.contains(text))
        })
        .next()
        .is_some()
}

fn button(window: &Window, pos: Pos2, pressed: bool, modifiers: Modifiers) {
    window.event(Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers });
}

fn drag(window: &mut Window, from: Pos2, by: Vec2, modifiers: Modifiers) {
    window.event(Event::ModifiersChanged(modifiers));
    window.event(Event::PointerMoved(from));
    window.step();
    button(window, from, true, modifiers);
    window.step();
    for k in 1..=4 {
        window.event(Event::PointerMoved(from + by * (k as f32 / 4.0)));
        window.step();
    }
    button(window, from + by, false, modifiers);
    window.step();
    window.event(Event::ModifiersChanged(Modifiers::NONE));
    window.step();
}

fn middle(window: &Window) -> Pos2 {
    window.get_by_label("Picture").rect().center()
}

#[test]
fn it_draws_to_the_proof_and_says_so() {
    let window = ball();
    assert!(has(&window, "pixels proved") && has(&window, "done in"));
    assert_eq!(window.state().model().document().file.surface.len(), 1);
    assert_eq!(window.state().model().ways(), [false, false], "nobody has done anything");
}

#[test]
fn no_scene_is_changed_by_being_looked_at() {
    for name in ["chubs", "links", "mcmullen"] {
        let file = file_named(name).unwrap().unwrap();
        let mut window = window(Found { name: name.to_owned(), file: file.clone(), own: false });
        until(&mut window, "the scene", |w| w.state().model().scene().is_some());
        window.run_steps(5);
        assert_eq!(window.state().model().document().file, file, "{name}");
    }
}

#[test]
fn what_is_typed_is_drawn_and_mistakes_show_their_place() {
    let mut window = ball();
    window.get_by_label("Text of the formula").focus();
    window.step();
    window.get_by_label("Text of the formula").type_text(" + $");
    until(&mut window, "the error", |w| has(w, "last one that could be drawn"));
    assert!(has(&window, "^^") || has(&window, " ^"), "a caret stands under the place");
    assert!(window.state().model().document().file.surface[0].formula.contains('$'));
    window.key_press(Key::Backspace);
    window.step();
    window.get_by_label("Text of the formula").type_text("0.5");
    until(&mut window, "the other ball", |w| w.state().is_done() && !has(w, "last one that could be drawn"));
    assert!(window.state().model().document().file.surface[0].formula.contains("0.5"));
}

#[test]
fn drags_turn_move_and_light_and_are_taken_back() {
    let mut window = ball();
    let at = middle(&window) + Vec2::new(40.0, 0.0);
    let start = window.state().model().orbit().unwrap();
    drag(&mut window, at, Vec2::new(60.0, 20.0), Modifiers::NONE);
    let turned = window.state().model().orbit().unwrap();
    assert!(turned.towards.azimuth < start.towards.azimuth && turned.towards.elevation > start.towards.elevation);
    assert_eq!(turned.width, start.width);
    drag(&mut window, at, Vec2::new(60.0, 0.0), Modifiers::SHIFT);
    assert_ne!(window.state().model().orbit().unwrap().target, turned.target);
    let light = window.state().model().light_direction(0).unwrap();
    drag(&mut window, at, Vec2::new(60.0, 0.0), Modifiers::COMMAND);
    assert!(window.state().model().light_direction(0).unwrap().azimuth != light.azimuth);
    until(&mut window, "the picture", |w| w.state().is_done());
    for _ in 0..3 {
        window.get_by_label("Undo").click();
        window.step();
        window.step();
    }
    // What was chosen for the scene is known again when it is built.
    until(&mut window, "the picture", |w| w.state().is_done());
    let back = window.state().model().orbit().unwrap();
    assert_eq!((back.towards, back.target), (start.towards, start.target));
    window.get_by_label("Redo").click();
    window.step();
    window.step();
    assert_eq!(window.state().model().orbit().unwrap(), turned);
}

#[test]
fn the_wheel_and_keys_move_the_camera() {
    let mut window = ball();
    let start = window.state().model().orbit().unwrap();
    window.event(Event::PointerMoved(middle(&window)));
    window.step();
    window.event(Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: Vec2::new(0.0, 80.0),
        phase: TouchPhase::Move,
        source: MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    window.run_steps(20);
    assert!(window.state().model().orbit().unwrap().width < start.width);
    window.key_press(Key::P);
    window.step();
    assert!(window.state().model().orbit().unwrap().parallel);
    window.key_press(Key::R);
    window.run_steps(2);
    until(&mut window, "the picture", |w| w.state().is_done());
    let back = window.state().model().orbit().unwrap();
    assert!((back.width - start.width).abs() < 1e-9 * start.width && !back.parallel);
}

#[test]
fn sliders_move_parameters_and_play() {
    let mut window = window(formula("r = 1; x^2 + y^2 + z^2 = r^2"));
    until(&mut window, "the picture", |w| w.state().is_done());
    let value = |w: &Window| w.state().model().sliders()[0].value;
    let slider = window.get_by_role_and_label(Role::Slider, "r");
    slider.set_value_accesskit(0.5);
    window.run_steps(2);
    assert_eq!(value(&window), 0.5);
    window.get_by_label("Move r").click();
    window.step();
    until(&mut window, "a movement", |w| value(w) != 0.5);
    window.get_by_label("Stop r").click();
    window.run_steps(2);
    until(&mut window, "the end", |w| w.state().is_done());
}

#[test]
fn the_gallery_opens_surfaces_and_draws_small_pictures() {
    let mut window = ball();
    window.get_by_label("Search the gallery").focus();
    window.step();
    window.get_by_label("Search the gallery").type_text("torus");
    window.run_steps(3);
    window.get_by_label("torus").click();
    window.step();
    until(&mut window, "the torus", |w| w.state().model().document().name == "torus" && w.state().is_done());
    window.get_by_label("Open").focus();
    window.step();
    window.get_by_label("Open").type_text("teapot");
    window.step();
    window.key_press(Key::Enter);
    until(&mut window, "the refusal", |w| has(w, "no preset named"));
    assert_eq!(window.state().model().document().name, "torus", "what was there stays");
}

#[test]
fn overlays_have_legends_and_pixels_are_inspected() {
    let mut window = ball();
    window.get_by_label("Verdict").click();
    window.step();
    until(&mut window, "the legend", |w| has(w, "hit (proved)"));
    window.event(Event::PointerMoved(middle(&window)));
    window.run_steps(2);
    assert!(has(&window, "hit, proved") && has(&window, "evaluations") && has(&window, "t in ["));
    window.get_by_label("Colours").click();
    window.step();
    until(&mut window, "the colours", |w| !has(w, "hit (proved)"));
    assert_eq!(Frame::UNSEEN, 255);
}

#[test]
fn every_overlay_has_its_legend_within_the_picture() {
    for size in [[1180.0, 760.0], [760.0, 480.0]] {
        let mut window = sized(formula("x^2 + y^2 + z^2 = 1"), size);
        until(&mut window, "the picture", |w| w.state().is_done());
        let overlays = [
            ("Verdict", "empty (proved)", "hit (proved)"),
            ("Shadow class", "no surface", "lit (all of each light)"),
            ("Cost", "cost below 2 evaluations", "cost from 64"),
            ("Bracket width", "no surface", "width below 2^-15"),
        ];
        for (button, one, other) in overlays {
            window.get_by_label(button).click();
            window.run_steps(2);
            until(&mut window, button, |w| has(w, one) && has(w, other));
            // Its place follows from its size: one frame later.
            window.run_steps(2);
            let picture = window.get_by_label("Picture").rect().expand(1.0);
            for text in [one, other] {
                let words = window.get_by_label(text).rect();
                assert!(picture.contains_rect(words), "{button}, {size:?}: {words} is not in {picture}");
            }
        }
    }
}

/// The lights of the scene that is drawn: centre, length of an edge, brightness.
fn drawn_light(window: &Window) -> (Vec3, f64, f64) {
    let light = window.state().model().scene().expect("a scene is drawn").lights[0];
    (light.rect.center, light.rect.edge_u.length(), light.color[1])
}

#[test]
fn light_has_size_distance_and_strength() {
    let mut window = ball();
    let orbit = window.state().model().orbit().unwrap();
    let away = |centre: Vec3| (centre - orbit.target).length();
    let (centre, edge, bright) = drawn_light(&window);
    let side = 2.0 * edge;
    let about = |a: f64, b: f64| (a - b).abs() < 2e-3 * b.abs().max(1.0);
    for (label, to) in [
        ("Size of the light", 2.0 * side),
        ("Distance of the light", 1.5 * away(centre)),
        ("Strength of the light", 2.0),
    ] {
        window.get_by_role_and_label(Role::Slider, label).set_value_accesskit(to);
        window.run_steps(2);
        until(&mut window, label, |w| w.state().is_done());
        let now = drawn_light(&window);
        let (distance, size, strength) = (away(now.0), 2.0 * now.1, now.2 / bright);
        match label {
            "Size of the light" => assert!(about(size, to) && now.0 == centre && strength == 1.0, "{now:?}"),
            "Distance of the light" => assert!(about(distance, to) && about(size, side) && strength == 1.0, "{now:?}"),
            _ => assert!(about(strength, to) && now.0 == centre && about(size, side), "{now:?}"),
        }
        window.get_by_label("Undo").click();
        window.run_steps(2);
        until(&mut window, "the picture", |w| w.state().is_done());
        assert_eq!(drawn_light(&window), (centre, edge, bright), "{label} is taken back");
        assert_eq!(window.state().model().ways(), [false, true], "{label} was one step");
    }
}

#[test]
fn a_hand_takes_the_light_in_the_picture() {
    let mut window = ball();
    let away = (drawn_light(&window).0 - window.state().model().orbit().unwrap().target).length();
    // The light is brought so near that it is in the picture.
    window.get_by_role_and_label(Role::Slider, "Distance of the light").set_value_accesskit(0.2 * away);
    window.get_by_label("Sun").click();
    window.run_steps(2);
    until(&mut window, "the picture", |w| w.state().is_done());
    let orbit = window.state().model().orbit().unwrap();
    let depth = |centre: Vec3| orbit.view().camera(1.0).project(centre).expect("before the camera").1;
    let handle = |w: &Window| w.get_by_role_and_label(Role::Slider, "Light").rect().center();
    let (from, centre) = (handle(&window), drawn_light(&window).0);
    let by = Vec2::new(50.0, -30.0);
    drag(&mut window, from, by, Modifiers::NONE);
    until(&mut window, "the picture", |w| w.state().is_done());
    let moved = drawn_light(&window).0;
    assert!((handle(&window) - from - by).length() < 3.0, "it is where the hand has left it");
    assert!(moved != centre && (depth(moved) - depth(centre)).abs() < 1e-6, "parallel to the picture");
    assert_eq!(window.state().model().orbit().unwrap(), orbit, "the camera stays");
    window.get_by_label("Undo").click();
    window.run_steps(2);
    until(&mut window, "the picture", |w| w.state().is_done());
    assert_eq!(drawn_light(&window).0, centre, "one drag is one step");
    // Beside the handle the same tool turns the light.
    drag(&mut window, from + Vec2::new(-60.0, 90.0), Vec2::new(40.0, 0.0), Modifiers::NONE);
    until(&mut window, "the picture", |w| w.state().is_done());
    let turned = drawn_light(&window).0;
    let length = |centre: Vec3| (centre - orbit.target).length();
    assert!(turned != centre && (length(turned) - length(centre)).abs() < 1e-9);
    assert_eq!(window.state().model().orbit().unwrap(), orbit);
}

#[test]
fn two_methods_stand_side_by_side() {
    let mut window = ball();
    window.get_by_label("another one beside it").click();
    window.run_steps(2);
    until(&mut window, "both pictures", |w| w.state().is_done());
    assert_eq!(window.state().model().document().methods().len(), 2);
    let line = window.get_by_label("Line between the methods").rect().center();
    let start = window.state().model().orbit().unwrap();
    drag(&mut window, line + Vec2::new(0.0, 30.0), Vec2::new(-80.0, 0.0), Modifiers::NONE);
    let moved = window.get_by_label("Line between the methods").rect().center();
    assert!((moved.x - line.x + 80.0).abs() < 12.0, "{line} to {moved}");
    assert_eq!(window.state().model().orbit().unwrap(), start, "the picture is not turned with it");
}

#[test]
fn clips_are_boxes_or_balls_and_light_has_a_pad() {
    let mut window = ball();
    window.get_by_label("Ball").click();
    window.run_steps(2);
    let clip = |w: &Window| w.state().model().document().file.surface[0].clip;
    assert!(clip(&window).unwrap().ball.is_some());
    window.get_by_label("Box").click();
    window.run_steps(2);
    assert!(clip(&window).unwrap().min.is_some());
    window.get_by_label("Chosen").click();
    window.run_steps(2);
    assert_eq!(clip(&window), None);
    let pad = window.get_by_label("Direction of the light").rect();
    drag(&mut window, pad.center(), Vec2::new(15.0, 10.0), Modifiers::NONE);
    let place = window.state().model().light_direction(0).unwrap();
    assert!((0.1..0.6).contains(&place.elevation), "inside of the horizon it is above, if not by much: {place:?}");
    until(&mut window, "the picture", |w| w.state().is_done());
}

#[test]
fn scenes_are_saved_and_pictures_exported() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, picture) = (folder.path().join("s.toml"), folder.path().join("p.png"));
    let mut window = ball();
    window.get_by_label("Save…").click();
    window.run_steps(2);
    window.get_by_label("File name").set_text_value_accesskit(scene.to_str().unwrap());
    window.run_steps(2);
    window.get_by_label("Write").click();
    until(&mut window, "the file", |_| scene.exists());
    let read = SceneFile::parse(&std::fs::read_to_string(&scene).unwrap()).unwrap();
    assert_eq!(read.surface, window.state().model().document().complete().surface);
    window.get_by_label("Export…").click();
    window.run_steps(2);
    window.get_by_label("Picture file").set_text_value_accesskit(picture.to_str().unwrap());
    window.run_steps(2);
    window.get_by_label("Write picture").click();
    // The files of this test are written in place (the program renames finished ones), and "wrote" is said of the scene already.
    let written = || std::fs::metadata(&picture).is_ok_and(|file| file.len() > 0);
    until(&mut window, "the picture", |w| written() && has(w, "wrote"));
    assert_eq!(std::fs::read(&picture).unwrap()[1..4], *b"PNG");
}
