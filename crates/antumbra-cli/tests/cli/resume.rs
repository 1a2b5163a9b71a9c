//! Renders that are stopped, by a budget, by Ctrl-C or by `kill -9`, and go on to the identical files.

use std::{
    fs,
    path::Path,
    process::{Child, Command, Stdio},
    thread,
    time::Duration,
};

use crate::bench::Bench;
use predicates::{prelude::PredicateBooleanExt, str::contains};
use serde_json::Value;

const WHAT: [&str; 10] =
    ["render", "links", "--floor", "--size", "256", "--threads", "1", "--save-every", "0.001", "--quiet"];

/// Picture, planes and JSON of a render, without its times.
fn result(bench: &Bench, folder: &str) -> (Vec<(String, Vec<u8>)>, Value) {
    let root = bench.file(folder);
    let mut files: Vec<(String, Vec<u8>)> = fs::read_dir(root.join("planes"))
        .unwrap()
        .map(|e| e.unwrap().path())
        .chain([root.join("p.png")])
        .map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), fs::read(&path).unwrap()))
        .collect();
    files.sort();
    let mut json: Value = serde_json::from_slice(&fs::read(root.join("s.json")).unwrap()).unwrap();
    json.as_object_mut().unwrap().retain(|key, _| !key.ends_with("seconds"));
    (files, json)
}

fn arguments(folder: &str, more: &[&str]) -> Vec<String> {
    let own = [("-o", "p.png"), ("--planes", "planes"), ("--json", "s.json")];
    let own = own.into_iter().flat_map(|(option, name)| [option.to_owned(), format!("{folder}/{name}")]);
    WHAT.iter().chain(more).map(|s| (*s).to_owned()).chain(own).collect()
}

fn run(bench: &Bench, folder: &str, more: &[&str]) -> assert_cmd::assert::Assert {
    let arguments = arguments(folder, more);
    bench.antumbra(&arguments.iter().map(String::as_str).collect::<Vec<_>>()).assert()
}

/// The program, running, as soon as it has saved a state.
fn running(bench: &Bench, folder: &str) -> Child {
    let mut child = Command::new(assert_cmd::cargo::cargo_bin("antumbra"))
        .current_dir(bench.path())
        .args(arguments(folder, &["--resume"]))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    let state = bench.file(folder).join("p.png.state");
    let changed = |path: &Path| fs::metadata(path).and_then(|m| m.modified()).ok();
    let before = changed(&state);
    for _ in 0..3000 {
        if changed(&state) != before || child.try_wait().expect("a child").is_some() {
            break;
        }
        thread::sleep(Duration::from_millis(2));
    }
    child
}

#[test]
fn a_killed_render_goes_on_to_the_identical_files() {
    let bench = Bench::new();
    for folder in ["whole", "killed"] {
        fs::create_dir(bench.file(folder)).unwrap();
    }
    run(&bench, "whole", &[]).success();
    // Ten times, at ten moments after something was saved; where it was done before that, it begins again.
    let (mut kills, mut moment) = (0, 7);
    for _ in 0..40 {
        let mut child = running(&bench, "killed");
        moment = (moment * 29 + 11) % 61;
        thread::sleep(Duration::from_millis(moment));
        child.kill().expect("SIGKILL");
        let killed = !child.wait().expect("a child").success();
        assert!(bench.file("killed/p.png.state").exists() || bench.file("killed/p.png").exists());
        kills += u32::from(killed);
        if kills == 10 {
            break;
        }
        if !killed {
            fs::remove_file(bench.file("killed/p.png")).unwrap();
        }
    }
    assert_eq!(kills, 10, "it was killed on the way");
    run(&bench, "killed", &["--resume"]).success();
    assert!(result(&bench, "whole") == result(&bench, "killed"));
    assert!(!bench.file("killed/p.png.state").exists());
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_what_is_done() {
    let bench = Bench::new();
    fs::create_dir(bench.file("whole")).unwrap();
    fs::create_dir(bench.file("stopped")).unwrap();
    run(&bench, "whole", &[]).success();
    let mut child = running(&bench, "stopped");
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill").success());
    assert_eq!(child.wait().expect("a child").code(), Some(130));
    let mut names: Vec<String> = fs::read_dir(bench.file("stopped"))
        .unwrap()
        .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    assert_eq!(names, ["p.png.state", "p.unfinished.png"]);
    let preview =
        png::Decoder::new(std::io::BufReader::new(fs::File::open(bench.file("stopped/p.unfinished.png")).unwrap()));
    assert_eq!(preview.read_info().unwrap().info().size(), (256, 256));
    run(&bench, "stopped", &["--resume"]).success().stderr(contains("going on with `stopped/p.png.state`"));
    assert!(result(&bench, "whole") == result(&bench, "stopped"));
    assert!(!bench.file("stopped/p.unfinished.png").exists() && !bench.file("stopped/p.png.state").exists());
}

#[test]
fn a_spent_budget_can_be_resumed_and_a_state_is_not_used_unasked() {
    let bench = Bench::new();
    let sized = |size: &str, more: &[&str]| {
        let args = [&["render", "gyroid", "-o", "p.png", "--size", size], more].concat();
        bench.antumbra(&args).assert()
    };
    let render = |more: &[&str]| sized("128", more);
    let spent = render(&["--budget", "0.05"]).code(1);
    let spent = spent.stderr(contains("the budget of 0.05 s is spent")).stderr(contains("--resume goes on with it"));
    spent.stderr(contains("p.unfinished.png")).stderr(contains("--tolerance"));
    assert_eq!(bench.names(), ["p.png.state", "p.unfinished.png"]);
    let state = fs::read(bench.file("p.png.state")).unwrap();

    // Not that picture, or not a whole state.
    let other = sized("64", &["--resume"]).code(1);
    other.stderr(contains("cannot go on with `p.png.state`: it is of other options: width: 128, height: 128 there"));
    fs::write(bench.file("p.png.state"), &state[..state.len() / 2]).unwrap();
    let cut = render(&["--resume"]).code(1);
    cut.stderr(contains("it is damaged")).stderr(contains("leave out --resume")).stderr(contains("panicked").not());
    assert_eq!(bench.names(), ["p.png.state", "p.unfinished.png"]);

    // Unasked, it is not used, and what is not of this render stays.
    fs::write(bench.file("p.png.state"), &state).unwrap();
    let fresh = bench.antumbra(&["render", "sphere", "--size", "16", "-o", "p.png"]).assert().success();
    fresh.stderr(contains("`p.png.state` is there")).stderr(contains("not used"));
    assert_eq!(fs::read(bench.file("p.png.state")).unwrap(), state);

    let none = bench.antumbra(&["render", "sphere", "--size", "16", "-o", "q.png", "--resume"]).assert().success();
    none.stderr(contains("wrote q.png"));
}
