//! What the page asks and is told, without a browser.
use antumbra_web::Studio;
use serde_json::{Value, json};
use std::time::Duration;

fn open(studio: &mut Studio, request: &Value) -> Value {
    serde_json::from_str(&studio.open(&request.to_string())).unwrap()
}

fn parsed(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

fn finish(studio: &mut Studio) {
    while !studio.refine(Duration::MAX) {}
}

#[test]
fn an_error_names_its_place_as_javascript_counts() {
    let mut studio = Studio::default();
    let scene = "# Ω𝛀\nx^2 + foo(z) = 1";
    let answer = open(&mut studio, &json!({ "scene": scene, "width": 8, "height": 8 }));
    let units: Vec<u16> = scene.encode_utf16().collect();
    let [start, end] = [0, 1].map(|k| answer["error"]["place"][k].as_u64().unwrap() as usize);
    assert_eq!(String::from_utf16(&units[start..end]).unwrap(), "foo", "{answer}");
    assert!(answer["error"]["message"].as_str().unwrap().contains("foo"));
}

#[test]
fn what_is_refused_leaves_the_picture_that_is_there() {
    let mut studio = Studio::default();
    let good = json!({ "scene": "sphere", "width": 8, "height": 8 });
    assert_eq!(open(&mut studio, &good)["title"], "Sphere");
    finish(&mut studio);
    let before = studio.pixels("", false);
    let eye = json!({ "eye": [0, 0, 0], "target": [0, 0, 0], "angle": 30 });
    for (change, part) in [
        (json!({ "scene": "x +" }), "end"),
        (json!({ "width": 100_000, "height": 100_000 }), "at most"),
        (json!({ "width": 0 }), "at least 1 pixel"),
        (json!({ "camera": eye }), "camera"),
        (json!({ "light": { "center": [0, 0, 5], "scale": -1 } }), "light"),
        (json!({ "set": { "a": 1 } }), "no parameters"),
        (json!({ "part": [2, 2] }), "no part"),
        (json!({ "tolerance": 0 }), "tolerance"),
        (json!({ "colour": "red" }), "unknown field"),
    ] {
        let mut bad = good.clone();
        bad.as_object_mut().unwrap().extend(change.as_object().unwrap().clone());
        let answer = open(&mut studio, &bad);
        assert!(answer["error"]["message"].as_str().is_some_and(|m| m.contains(part)), "{change}: {answer}");
        assert_eq!(studio.pixels("", false), before, "{change}");
    }
}

#[test]
fn numbers_of_a_formula_become_sliders() {
    let mut studio = Studio::default();
    let scene = "a = 1/2; r = x^2 + y^2; b = 0; r + a z^2 = 1 + b x";
    let request = json!({ "scene": scene, "width": 8, "height": 8, "set": { "a": 2.0 } });
    let answer = open(&mut studio, &request);
    let wanted = json!([
        { "name": "a", "value": 0.5, "min": -1.0, "max": 1.0 },
        { "name": "b", "value": 0.0, "min": -1.0, "max": 1.0 },
    ]);
    assert_eq!(answer["parameters"], wanted);
    assert!(answer["formulas"][0].as_str().unwrap().contains("a = (2.0)"), "{answer}");
}

#[test]
fn parts_of_two_studios_make_one_picture() {
    let request = |part: Value| json!({ "scene": "chubs", "width": 70, "height": 70, "part": part });
    let [mut whole, mut first, mut second] = [Studio::default(), Studio::default(), Studio::default()];
    for (studio, part) in [(&mut whole, Value::Null), (&mut first, json!([0, 2])), (&mut second, json!([1, 2]))] {
        open(studio, &request(part));
        finish(studio);
    }
    let seen = |studio: &Studio| studio.pixels("", false).chunks(4).filter(|c| c[3] == 255).count();
    assert!(seen(&first) < 70 * 70 && seen(&first) + seen(&second) == 70 * 70);
    assert_eq!(first.join(b"nothing"), "it is not the state of a render");
    assert_eq!(first.join(&second.state()), "");
    finish(&mut first);
    assert_eq!(first.pixels("", false), whole.pixels("", false));
    assert_eq!(first.png(""), whole.png(""));
    assert_eq!(parsed(&first.report())["evaluations"], parsed(&whole.report())["evaluations"]);
}

#[test]
fn pixels_are_hidden_until_they_are_known() {
    let mut studio = Studio::default();
    open(&mut studio, &json!({ "scene": "sphere", "width": 64, "height": 64, "floor": true }));
    assert!(studio.pixels("", false).chunks(4).all(|c| c[3] == 0), "nobody has looked");
    studio.refine(Duration::ZERO);
    studio.refine(Duration::ZERO);
    let opaque = |lit| studio.pixels("", lit).chunks(4).filter(|c| c[3] == 255).count();
    assert!(opaque(true) < opaque(false), "{} {}: hits wait for their light", opaque(true), opaque(false));
    finish(&mut studio);
    assert!(studio.pixels("", false).chunks(4).all(|c| c[3] == 255));
    let legend = parsed(&studio.legend("verdict"));
    let counted: u64 = legend.as_array().unwrap().iter().map(|line| line["pixels"].as_u64().unwrap()).sum();
    assert_eq!(counted, 64 * 64);
    let middle = parsed(&studio.pixel(32, 32));
    assert_eq!(middle["verdict"], "hit (proved)");
    let [lo, hi] = [0, 1].map(|k| middle["t"][k].as_f64().unwrap());
    assert!(lo <= hi && hi - lo < 1e-6);
    assert_eq!(parsed(&studio.pixel(64, 0)), Value::Null);
}

#[test]
fn the_gallery_is_listed_without_drawing_it() {
    let gallery = parsed(&Studio::default().gallery());
    let gallery = gallery.as_array().unwrap();
    assert_eq!(gallery.len(), antumbra::scene::GALLERY.len());
    let of = |name: &str| gallery.iter().find(|e| e["name"] == name).unwrap();
    assert_eq!(of("cayley")["author"], "Arthur Cayley");
    assert!(of("chubs")["formula"].as_str().unwrap().contains("x^4"));
}
