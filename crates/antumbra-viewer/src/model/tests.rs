use super::*;
use antumbra::scene::{file_named, preset};

fn found(text: &str) -> Found {
    Found { name: "formula".to_owned(), file: SceneFile::of_formula(text), own: false }
}

fn built(text: &str) -> Model {
    let mut model = Model::new(found(text));
    build(&mut model);
    model
}

fn build(model: &mut Model) {
    let scene = model.document().complete().scene("s").unwrap();
    model.built(model.revision(), Arc::new(scene));
}

#[test]
fn steps_of_a_gesture_are_taken_back_together() {
    let mut model = built("x^2 + y^2 + z^2 = 1");
    let before = model.document().clone();
    for _ in 0..5 {
        model.move_camera(|orbit| orbit.turned(0.1, 0.0));
    }
    model.settle();
    model.move_camera(|orbit| orbit.zoomed(0.5));
    let zoomed = model.document().clone();
    model.undo();
    assert_ne!(model.document(), &before, "five turns are left");
    model.undo();
    assert_eq!(model.document(), &before);
    assert_eq!(model.ways(), [false, true]);
    model.redo();
    model.redo();
    assert_eq!(model.document(), &zoomed);
    model.undo();
    model.set_tolerance(0.1);
    assert_eq!(model.ways(), [true, false], "another way was taken");
}

#[test]
fn nothing_is_a_step_that_changes_nothing() {
    let mut model = built("x^2 + y^2 + z^2 = 1");
    let revision = model.revision();
    model.set_formula(0, "x^2 + y^2 + z^2 = 1");
    model.set_formula(7, "x");
    model.change_light(9, |light| light.strength = Some(2.0));
    assert_eq!((model.revision(), model.ways()), (revision, [false, false]));
}

#[test]
fn a_new_formula_is_framed_anew_from_the_same_direction() {
    let file = SceneFile::of(&preset("chubs").unwrap().unwrap());
    let mut model = Model::new(Found { name: "chubs".to_owned(), file, own: false });
    build(&mut model);
    model.move_camera(|orbit| orbit.turned(0.7, 0.2));
    let before = model.orbit().unwrap();
    model.set_formula(0, "x^2 + y^2 + z^2 = 100");
    build(&mut model);
    let after = model.orbit().unwrap();
    assert!((after.towards.azimuth - before.towards.azimuth).abs() < 1e-9, "{after:?}");
    assert!(after.width > 20.0, "all of the large ball is seen: {}", after.width);
    let mut own = Model::new(Found { own: true, ..found("x^2 + y^2 + z^2 = 1") });
    build(&mut own);
    own.set_clip(0, Some(ClipEntry { ball: Some(0.5), ..ClipEntry::default() }));
    own.set_formula(0, "x^2 + y^2 + z^2 = 4");
    assert_eq!(own.document().file.surface[0].clip.unwrap().ball, Some(0.5), "a file of one's own stays as it is");
}

#[test]
fn only_the_surface_moves_with_a_parameter() {
    let mut model = built("r = 1; x^2 + y^2 + z^2 = r^2");
    let [clip, view] =
        [model.scene().unwrap().objects[0].clip().bounds(), model.scene().unwrap().objects[0].clip().bounds()];
    assert_eq!(clip, view);
    let camera = model.scene().unwrap().view;
    assert_eq!(model.sliders(), [Slider { name: "r".to_owned(), value: 1.0, range: [0.0, 2.0] }]);
    model.set_parameter("r", 0.5).unwrap();
    build(&mut model);
    let scene = model.scene().unwrap();
    assert_eq!((scene.objects[0].clip().bounds(), scene.view), (clip, camera));
    assert_eq!(model.sliders()[0].value, 0.5);
    assert!(model.document().file.surface[0].formula.starts_with("r = (0.5);"));
    assert!(model.set_parameter("q", 1.0).unwrap_err().contains("no such parameter"));
    assert!(model.set_parameter("r", f64::NAN).is_err());
}

#[test]
fn clips_lights_and_floor_are_written_to_the_file() {
    let mut model = built("x^2 + y^2 + z^2 = 1");
    let place = model.light_direction(0).unwrap();
    model.place_light(0, place.turned(0.5, 0.0));
    model.change_light(0, |light| light.strength = Some(0.5));
    model.set_clip(0, Some(ClipEntry { ball: Some(0.75), ..ClipEntry::default() }));
    model.set_floor(true);
    model.set_tolerance(0.01);
    let text = model.document().complete().text().unwrap();
    let read = SceneFile::parse(&text).unwrap();
    assert_eq!(read, model.document().complete());
    let scene = read.scene("s").unwrap();
    assert!(scene.floor_shown && scene.output.tolerance == Some(0.01));
    let target = model.orbit().unwrap().target;
    let there = Polar::of(scene.lights[0].rect.center - target);
    assert!(
        (there.azimuth - place.turned(0.5, 0.0).azimuth).abs() < 1e-9 && (there.length - place.length).abs() < 1e-9
    );
}

#[test]
fn the_camera_goes_back_and_fits() {
    let mut model = built("x^2 + y^2 + z^2 = 1");
    let opened = model.orbit().unwrap();
    model.move_camera(|orbit| orbit.zoomed(0.1).turned(1.0, 0.0));
    model.fit_camera();
    build(&mut model);
    let fitted = model.orbit().unwrap();
    assert!((fitted.width - opened.width).abs() < 0.2 * opened.width, "{fitted:?}");
    model.reset_camera();
    build(&mut model);
    let back = model.orbit().unwrap();
    assert!((back.width - opened.width).abs() < 1e-9 && (back.towards.azimuth - opened.towards.azimuth).abs() < 1e-9);
}

#[test]
fn parallel_and_perspective_show_the_target_equally_large() {
    let mut model = built("x^2 + y^2 + z^2 = 1");
    let width = model.orbit().unwrap().width;
    model.move_camera(|orbit| Orbit { parallel: true, ..orbit });
    build(&mut model);
    assert!(model.orbit().unwrap().parallel);
    assert!((Orbit::of(&model.scene().unwrap().view).width - width).abs() < 1e-6 * width);
}

#[test]
fn sliders_of_files_keep_their_ranges() {
    let text = "parameters = { a = { value = 0.5, min = 0.1, max = 0.9 }, b = 2 }\n[[surface]]\nformula = \"c = -3; a x + b y + c z\"\n";
    let all = sliders(&SceneFile::parse(text).unwrap(), &[]);
    let shown: Vec<_> = all.iter().map(|s| (s.name.as_str(), s.value, s.range)).collect();
    assert_eq!(shown, [("a", 0.5, [0.1, 0.9]), ("b", 2.0, [0.0, 4.0]), ("c", -3.0, [-6.0, 0.0])]);
    assert_eq!(sliders(&SceneFile::of_formula("a = b; $"), &[]), []);
}

#[test]
fn every_scene_by_name_is_a_file() {
    for name in antumbra::scene::names() {
        assert!(file_named(name).unwrap().is_ok(), "{name}");
    }
    assert!(file_named("nothing").is_none());
}
