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

#[test]
fn what_is_wrong_in_a_file_is_named() {
    let bench = Bench::new();
    let refused = |text: &str, words: &[&str]| {
        fs::write(bench.file("s.toml"), text).unwrap();
        let result = bench.antumbra(&["render", "s.toml"]).assert().code(2).stdout(predicate::str::is_empty());
        let result = result.stderr(contains("`s.toml`")).stderr(contains("panicked").not());
        words.iter().fold(result, |result, word| result.stderr(contains(*word)));
        assert_eq!(bench.names(), ["s.toml"]);
    };
    let sphere = "[[surface]]\nformula = \"x^2 + y^2 + z^2 - 1\"\n";
    refused("", &["surface"]);
    refused("[[surface]\n", &["line 1"]);
    refused("surface = []", &["surface", "[[surface]]"]);
    refused("[[surface]]\nformla = \"x\"", &["line 2", "formla", "did you mean `formula`?"]);
    refused("[[surface]]\nformula = 3", &["line 2", "string"]);
    refused("[[surface]]\nformula = \"x^2 + $\"", &["surface[1].formula", "^"]);
    refused("[[surface]]\nformula = \"x + a\"", &["surface[1].formula", "`a`"]);
    refused(&format!("{sphere}clip = {{}}"), &["surface[1].clip", "either `box`"]);
    refused(&format!("{sphere}clip = {{ box = [1, 0, 1] }}"), &["surface[1].clip", "empty"]);
    refused(&format!("{sphere}clip = {{ ball = -1.0 }}"), &["surface[1].clip.ball", "greater than 0"]);
    refused(&format!("{sphere}clip = {{ box = [1, inf, 1] }}"), &["surface[1].clip", "infinite"]);
    refused(&format!("{sphere}outside = [2, 0, 0]"), &["surface[1].outside", "from 0 to 1"]);
    refused(&format!("{sphere}[[light]]\ncenter = [0, 0, 3]"), &["light[1]", "`side`"]);
    refused(&format!("{sphere}[[light]]\ncenter = [0, 0, 3]\nside = 0"), &["light[1].side", "greater than 0"]);
    let thin = "[[light]]\ncenter = [0, 0, 3]\nu = [1, 0, 0]\nv = [2, 0, 0]";
    refused(&format!("{sphere}{thin}"), &["light[1]", "no rectangle"]);
    refused(&format!("{sphere}[camera]\neye = [0, 0, 0]\nangle = 30"), &["camera", "the same point"]);
    refused(&format!("{sphere}[camera]\neye = [0, 0, 9]\nangle = 300"), &["camera.angle", "170"]);
    refused(&format!("{sphere}[floor]\nheight = nan"), &["floor.height"]);
    refused(&format!("{sphere}[parameters]\na = {{ value = 3, min = 0, max = 1 }}"), &["parameters.a", "between"]);
    refused(&format!("[parameters]\n\"a b\" = 1\n{sphere}"), &["formula"]);
    fs::remove_file(bench.file("s.toml")).unwrap();
    let missing = bench.antumbra(&["render", "s.toml"]).assert().code(1);
    missing.stderr(contains("cannot read `s.toml`"));
    fs::write(bench.file("s.toml"), [0xff, 0xfe]).unwrap();
    bench.antumbra(&["render", "s.toml"]).assert().code(2).stderr(contains("UTF-8"));
}
