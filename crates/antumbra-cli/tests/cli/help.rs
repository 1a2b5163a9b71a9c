//! What the program says of itself: help with examples, completions, manual pages, and what there is.

use crate::bench::Bench;
use predicates::str::contains;

const COMMANDS: [&[&str]; 14] = [
    &["render"],
    &["view"],
    &["compare"],
    &["paper"],
    &["audit"],
    &["gallery"],
    &["scene"],
    &["scene", "new"],
    &["scene", "check"],
    &["scene", "show"],
    &["info"],
    &["serve"],
    &["completions"],
    &["man"],
];

#[test]
fn every_command_has_examples() {
    let bench = Bench::new();
    for command in COMMANDS {
        let help = bench.antumbra(&[command, &["--help"]].concat()).assert().success();
        help.stdout(contains("Examples:\n  antumbra "));
    }
}

#[test]
fn completions_and_pages_know_every_option() {
    let bench = Bench::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = bench.antumbra(&["completions", shell]).assert().success();
        script.stdout(contains("light-scale")).stdout(contains("turntable"));
    }
    bench.antumbra(&["completions", "basch"]).assert().code(2).stderr(contains("bash"));
    bench.antumbra(&["man"]).assert().success().stdout(contains(".TH antumbra 1"));
    bench.antumbra(&["man", "render"]).assert().success().stdout(contains("light\\-scale"));
    let unknown = bench.antumbra(&["man", "rendr"]).assert().code(2);
    unknown.stderr(contains("there is no command `rendr`; did you mean `render`?"));
    bench.antumbra(&["man", "-o", "man1"]).assert().success().stderr(contains("pages in man1"));
    for command in COMMANDS {
        assert!(bench.file(&format!("man1/antumbra-{}.1", command.join("-"))).exists(), "{command:?}");
    }
}

#[test]
fn info_lists_what_there_is() {
    let bench = Bench::new();
    let info = bench.antumbra(&["info"]).assert().success();
    let words = ["orthocircle", "viviani", "barth-sextic", "Barth sextic", "paper-quadtree", "threads:"];
    words.iter().fold(info, |info, word| info.stdout(contains(*word)));
}

#[test]
fn nothing_to_see_is_explained() {
    let bench = Bench::new();
    let render = |scene: &str| bench.antumbra(&["render", scene, "--size", "16", "-o", "p.png"]).assert().success();
    let none = "nothing to see: the formula has no zero (proved for |x|, |y|, |z| <= 2^20)";
    render("x^2 + y^2 + z^2 + 1 = 0").stderr(contains(none));
    std::fs::write(bench.file("s.toml"), "[[surface]]\nformula = \"z = 2\"\nclip = { box = [1, 1, 1] }").unwrap();
    render("s.toml").stderr(contains("no ray of the picture meets a surface (proved)"));
}
