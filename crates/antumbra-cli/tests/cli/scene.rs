//! Scene files, from `scene new` to a picture, and every way in which one can be wrong.

use std::fs;

use crate::bench::Bench;
use predicates::{
    prelude::{PredicateBooleanExt, predicate},
    str::contains,
};

#[test]
fn a_new_scene_is_checked_shown_and_rendered() {
    let bench = Bench::new();
    bench.antumbra(&["scene", "new", "rings.toml"]).assert().success().stderr(contains("antumbra render rings.toml"));
    bench.antumbra(&["scene", "new", "rings.toml"]).assert().code(1).stderr(contains("exists and is kept"));
    bench.antumbra(&["scene", "new", "rings.txt"]).assert().code(1).stderr(contains(".toml"));
    let check = bench.antumbra(&["scene", "check", "rings.toml"]).assert().success();
    check.stdout(contains("surfaces: 2")).stdout(contains("lights: 2")).stdout(contains("floor: yes"));
    let json = ["--size", "12", "--quiet", "--json", "-"];
    let stats = |scene: &str| {
        let args = [&["render", scene], &json[..]].concat();
        let out = bench.antumbra(&args).assert().success().get_output().stdout.clone();
        let stats: serde_json::Value = serde_json::from_slice(&out).unwrap();
        ["hits", "floor_hits", "lit", "partly", "dark", "evaluations"].map(|k| stats[k].as_u64().unwrap())
    };
    let first = stats("rings.toml");
    assert!(first[0] > 100 && first[1] > 10, "{first:?}");
    assert!(bench.file("rings.png").exists());
    // What `show` prints is the same scene.
    let shown = bench.antumbra(&["scene", "show", "rings.toml"]).assert().success().get_output().stdout.clone();
    fs::write(bench.file("shown.toml"), shown).unwrap();
    assert_eq!(first, stats("shown.toml"));
}

#[test]
fn presets_and_formulas_are_shown_as_scenes() {
    let bench = Bench::new();
    for scene in ["links", "kusner", "x^2 + y^2 + z^2 - 1"] {
        let shown = bench.antumbra(&["scene", "show", scene]).assert().success().get_output().stdout.clone();
        fs::write(bench.file("s.toml"), &shown).unwrap();
        let again = bench.antumbra(&["scene", "show", "s.toml"]).assert().success().get_output().stdout.clone();
        assert_eq!(shown, again, "{scene}");
    }
}

/// Every class of errors: what stands in the file, and words of the message. `docs/scenes.md` shows the same words.
fn wrong_files() -> Vec<(String, &'static str)> {
    let sphere = "[[surface]]\nformula = \"x^2 + y^2 + z^2 - 1\"\n";
    let light = format!("{sphere}\n[[light]]\ncenter = [0, 0, 3]\n");
    let with = |more: &str| format!("{sphere}{more}");
    vec![
        ("title = ".to_owned(), "a value is missing after `=`"),
        ("title = Rings".to_owned(), "text stands in quotes, as in title = \"Rings\""),
        (with("[parameters]\n\"q = 1 #\" = 2"), "a name is made of letters, digits and _"),
        (with("[camera]\ntarget = [1e6, 0, 0]\nfrom = [1, 0, 0]\nwidth = 1e-16"), "is too small for a target so far"),
        (String::new(), "begin a surface with [[surface]], and give it a formula"),
        ("surface = []".to_owned(), "line 1, surface: there is none; begin one with [[surface]]"),
        ("[[surface]]\noutside = [1, 0, 0]".to_owned(), "missing field `formula`"),
        ("[[surface]]\nformla = \"x\"".to_owned(), "did you mean `formula`?"),
        ("[[surface]]\nformula = 3".to_owned(), "invalid type: integer `3`, expected a string"),
        ("[[surface]]\nformula = \"x^2 + $\"".to_owned(), "line 2, surface[1].formula: error: `$` has no meaning here"),
        ("[[surface]]\nformula = \"x + a\"".to_owned(), "surface[1].formula: error: unknown name `a`"),
        (with("clip = {}"), "line 3, surface[1].clip: give either `box` (half sizes), `min` and `max`, or `ball`"),
        (with("clip = { box = [1, 0, 1] }"), "line 3, surface[1].clip: the box is empty"),
        (with("clip = { ball = -1 }"), "line 3, surface[1].clip.ball: the radius must be greater than 0"),
        (
            with("clip = { box = [1, inf, 1] }"),
            "line 3, surface[1].clip: a number is infinite, too large or not a number",
        ),
        (with("outside = [1, 0]"), "points and colours are lists of numbers, such as [1.0, 0.0, 0.5]"),
        (with("clip = { ball = 1 }\nclip = { ball = 2 }"), "the key is given twice: remove one"),
        (with("outside = [2, 0, 0]"), "line 3, surface[1].outside: a colour has three components from 0 to 1"),
        (with("finish = \"glos\""), "did you mean `gloss`?"),
        (with("caps = true"), "line 3, surface[1].caps: there is no clip that could cut the solid"),
        (with("transform = { scale = 0 }"), "line 3, surface[1].transform.scale: must be greater than 0"),
        (
            with("color_by = \"normal\"\nfield = { formula = \"x\", from = 0, to = 1 }"),
            "surface[1]: give either `color_by` or `field`",
        ),
        (
            with("field = { formula = \"x\", from = 1, to = 1 }"),
            "line 3, surface[1].field: `from` and `to` are the same value",
        ),
        (light.clone(), "light[1]: give either `side` (a horizontal square) or `u` and `v`"),
        (format!("{light}side = 0"), "line 6, light[1].side: must be greater than 0"),
        (format!("{light}u = [1, 0, 0]\nv = [2, 0, 0]"), "light[1]: `u` and `v` span no rectangle"),
        (format!("{light}side = 1\nstrength = -1"), "light[1]: colour and strength must not be negative"),
        (
            with("[camera]\neye = [0, 0, 9]\nfrom = [0, 0, 1]"),
            "camera: give either `eye` (a point) or `from` (a direction)",
        ),
        (with("[camera]\neye = [0, 0, 0]\nangle = 30"), "camera: eye and target are the same point"),
        (with("[camera]\nfrom = [0, 0, 0]"), "camera.from: a direction cannot be zero"),
        (with("[camera]\neye = [0, 0, 9]\nangle = 300"), "camera.angle: must be from 0.0001 to 170 degrees, not 300"),
        (with("[camera]\nangle = 30\nwidth = 2"), "camera.angle: an orthographic camera has no angle"),
        (with("[camera]\nwidth = -1"), "camera.width: must be greater than 0"),
        (with("[floor]\nheight = nan"), "floor.height: a number is infinite, too large or not a number"),
        (with("[sky]\nabove = [-1, 0, 0]"), "sky.above: a colour has three components, none of them negative"),
        (with("[backdrop]\nfalloff = -1"), "backdrop.falloff: must be from 0 (even) to 100"),
        (with("[look]\nexposure = 99"), "look.exposure: must be \"auto\" or from -20 to 20 stops"),
        (with("[look]\nexposure = \"bright\""), "the exposure is a number of stops, or \"auto\""),
        (with("[look]\ntone = \"sof\""), "did you mean `soft`?"),
        (with("[output]\nsize = [0, 10]"), "output.size: a picture needs at least 1 pixel a side"),
        (with("[output]\ntolerance = 2"), "output.tolerance: must be from 1e-9 to 1"),
        (with("[parameters]\na = { value = 3, min = 0, max = 1 }"), "parameters.a: 3 is not between 0 and 1"),
        (with("[parameters]\na = \"3\""), "a parameter is a number, or { value = .., min = .., max = .. }"),
        (format!("[parameters]\n\"a b\" = 1\n{sphere}"), "parameters.a b: a name is made of letters"),
    ]
}

#[test]
fn what_is_wrong_in_a_file_is_named() {
    let bench = Bench::new();
    let mut other = Vec::new();
    for (text, words) in wrong_files() {
        fs::write(bench.file("s.toml"), &text).unwrap();
        let result = bench.antumbra(&["render", "s.toml"]).assert().code(2).stdout(predicate::str::is_empty());
        let result = result.stderr(contains("`s.toml`")).stderr(contains("panicked").not());
        let said = String::from_utf8(result.get_output().stderr.clone()).unwrap();
        if !said.contains(words) {
            other.push(format!("expected: {words}\n{said}"));
        }
        assert_eq!(bench.names(), ["s.toml"]);
    }
    assert!(other.is_empty(), "{}", other.join("\n"));
    fs::write(bench.file("s.toml"), "[parameters]\nabc = 1\n[[surface]]\nformula = \"x - abc\"").unwrap();
    let unknown = bench.antumbra(&["render", "s.toml", "--set", "abd=1"]).assert().code(2);
    unknown.stderr(contains("parameter abd: there is no such parameter; did you mean `abc`?"));
    fs::remove_file(bench.file("s.toml")).unwrap();
    let missing = bench.antumbra(&["render", "s.toml"]).assert().code(2);
    missing.stderr(contains("there is no file `s.toml`"));
    fs::write(bench.file("s.toml"), [0xff, 0xfe]).unwrap();
    bench.antumbra(&["render", "s.toml"]).assert().code(2).stderr(contains("UTF-8"));
}

/// The page of scene files says what the program says, and its examples are scenes.
#[test]
fn the_page_of_scene_files_is_true() {
    const PAGE: &str = include_str!("../../../../docs/scenes.md");
    for (_, words) in wrong_files() {
        assert!(PAGE.contains(words), "docs/scenes.md does not have `{words}`");
    }
    let bench = Bench::new();
    for (k, example) in PAGE.split("```toml\n").skip(1).map(|rest| rest.split("```").next().unwrap()).enumerate() {
        let name = format!("{k}.toml");
        fs::write(bench.file(&name), example).unwrap();
        bench.antumbra(&["scene", "check", &name]).assert().success().stdout(contains("surfaces:"));
        // What `show` prints is the same scene, with its parameters, and prints itself.
        let show = |name: &str| bench.antumbra(&["scene", "show", name]).assert().success().get_output().stdout.clone();
        let shown = show(&name);
        fs::write(bench.file("shown.toml"), &shown).unwrap();
        assert!(shown == show("shown.toml"));
        assert_eq!(example.contains("[parameters]"), String::from_utf8(shown).unwrap().contains("[parameters]"));
        let digest = |name: &str| {
            let args = ["render", name, "--size", "16x10", "--tolerance", "1/4", "-q", "-o", "p.png"];
            bench.antumbra(&args).assert().success();
            fs::read(bench.file("p.png")).unwrap()
        };
        assert!(digest(&name) == digest("shown.toml"), "{name}");
    }
}
