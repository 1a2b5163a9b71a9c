//! Parameters and animations, as files that are looked into.

use std::{fs, io::BufReader};

use crate::bench::Bench;
use predicates::{
    prelude::PredicateBooleanExt,
    str::{contains, is_empty},
};

const BALL: &str = "a = 1; x^2 + y^2/a^2 + z^2 = 1";

fn codes(bench: &Bench, name: &str) -> Vec<u8> {
    let mut reader = png::Decoder::new(BufReader::new(fs::File::open(bench.file(name)).unwrap())).read_info().unwrap();
    let mut codes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut codes).unwrap();
    codes
}

fn hits(bench: &Bench, args: &[&str]) -> u64 {
    let args = [&["render"], args, &["--size", "24", "--quiet", "--json", "-", "-o", "p.png"]].concat();
    let out = bench.antumbra(&args).assert().success().get_output().stdout.clone();
    serde_json::from_slice::<serde_json::Value>(&out).unwrap()["hits"].as_u64().unwrap()
}

#[test]
fn parameters_of_files_and_formulas_are_set() {
    let bench = Bench::new();
    let file = "[parameters]\nr = { value = 1, min = 0.1, max = 2 }\n[[surface]]\nformula = \"x^2 + y^2 + z^2 = r^2\"\n\
                clip = { box = [2, 2, 2] }\n";
    fs::write(bench.file("ball.toml"), file).unwrap();
    let sizes = ["0.5", "1", "sqrt(2)"].map(|r| hits(&bench, &["ball.toml", "--set", &format!("r={r}")]));
    assert!(sizes[0] < sizes[1] && sizes[1] < sizes[2], "{sizes:?}");
    assert_eq!(hits(&bench, &["ball.toml"]), sizes[1]);
    let formula = "r = 1; x^2 + y^2 + z^2 = r^2";
    assert!(hits(&bench, &[formula, "--set", "r = 3/2"]) > 0);

    let refused = |args: &[&str], words: &str| {
        let args = [&["render"], args, &["-o", "q.png"]].concat();
        let result = bench.antumbra(&args).assert().code(2).stdout(is_empty());
        result.stderr(contains(words)).stderr(contains("panicked").not());
        assert!(!bench.file("q.png").exists());
    };
    refused(&["ball.toml", "--set", "r=3"], "parameter r: 3 is not between 0.1 and 2");
    refused(&["ball.toml", "--set", "R=1"], "parameter R: there is no such parameter; did you mean `r`?");
    refused(&["ball.toml", "--set", "size=1"], "parameter size: there is no such parameter; the scene has r");
    refused(&[formula, "--set", "b=1"], "parameter b");
    refused(&["chubs", "--set", "a=1"], "`chubs` has no parameters");
    refused(&["x = 1", "--set", "a=1"], "parameter a: the scene has no parameters");
    refused(&[formula, "--set", "r"], "such as a=0.05");
    refused(&[formula, "--set", "r=x"], "`x` is no number");
    refused(&[formula, "--set", "r=inf"], "no finite number");
}

#[test]
fn frames_move_and_are_kept() {
    let bench = Bench::new();
    let args = |more: &[&'static str]| {
        let all = ["render", BALL, "--animate", "a=0.5:1", "--frames", "3", "--size", "20", "-o", "frames/%02d.png"];
        [&all, more].concat()
    };
    let first = bench.antumbra(&args(&[])).assert().success();
    first.stderr(contains("wrote frames/00.png to frames/02.png: 3 frames, 25 per second"));
    let names: Vec<bool> = (0..4).map(|k| bench.file(&format!("frames/{k:02}.png")).exists()).collect();
    assert_eq!(names, [true, true, true, false]);
    assert_ne!(codes(&bench, "frames/00.png"), codes(&bench, "frames/02.png"));
    let all = || [0, 1, 2].map(|k| fs::read(bench.file(&format!("frames/0{k}.png"))).unwrap());
    let before = all();

    // One is missing, one is of something else: those are drawn again.
    fs::remove_file(bench.file("frames/01.png")).unwrap();
    bench.antumbra(&["render", "sphere", "--size", "20", "-o", "frames/02.png"]).assert().success();
    let kept = bench.antumbra(&args(&["--resume"])).assert().success();
    kept.stderr(contains("1 of them kept")).stderr(contains("1 of the frames that were there are of other scenes"));
    assert!(all() == before);
    bench.antumbra(&args(&["--resume"])).assert().success().stderr(contains("3 of them kept"));
    // Another tolerance is another picture.
    bench.antumbra(&args(&["--resume", "--tolerance", "0.5"])).assert().success().stderr(contains("kept").not());
    bench.antumbra(&args(&[])).assert().success().stderr(contains("--resume keeps them").not());
    let again = bench.antumbra(&args(&[])).assert().success();
    again.stderr(contains("3 of the frames were there and have been drawn again (--resume keeps them)"));
    assert!(all() == before);
}

#[test]
fn an_interrupted_animation_goes_on() {
    let bench = Bench::new();
    let render = |more: &[&str]| {
        let all = ["render", "links", "--turntable", "--frames", "4", "--size", "96", "--floor", "-o", "t.gif"];
        bench.antumbra(&[&all, more].concat()).assert()
    };
    let spent = render(&["--budget", "0.001"]).code(1);
    spent.stderr(contains("0 of 4 frames are done")).stderr(contains("the same command with --resume goes on"));
    // Somewhere on the way, or not even that, on a fast machine.
    let _ = render(&["--resume", "--budget", "0.3"]);
    assert!(bench.file("t.gif").exists() != bench.file("t.gif.frames").exists());
    render(&["--resume"]).success().stderr(contains("wrote t.gif: 4 frames"));
    assert_eq!(bench.names(), ["t.gif"]);
    let resumed = fs::read(bench.file("t.gif")).unwrap();
    render(&[]).success();
    assert!(resumed == fs::read(bench.file("t.gif")).unwrap());
    assert_eq!((&resumed[..6], &resumed[6..10]), (&b"GIF89a"[..], &[96, 0, 96, 0][..]));
}

#[test]
fn moving_pictures_loop() {
    let bench = Bench::new();
    let base = ["render", BALL, "--animate", "a=0.5:1", "--loop", "--frames", "4", "--fps", "10", "--size", "16"];
    for name in ["b.apng", "b.png", "b.gif"] {
        bench.antumbra(&[&base[..], &["-o", name]].concat()).assert().success();
    }
    assert_eq!(bench.names(), ["b.apng", "b.gif", "b.png"]);
    let reader = png::Decoder::new(BufReader::new(fs::File::open(bench.file("b.apng")).unwrap())).read_info().unwrap();
    let control = reader.info().animation_control.unwrap();
    assert_eq!((control.num_frames, control.num_plays), (4, 0));
    // There and back: the second frame is the last.
    bench.antumbra(&[&base[..], &["-o", "f%d.png"]].concat()).assert().success();
    assert_eq!(codes(&bench, "f1.png"), codes(&bench, "f3.png"));
    assert_ne!(codes(&bench, "f0.png"), codes(&bench, "f2.png"));
    // Without an extension of its own, a GIF.
    bench.antumbra(&base).assert().success().stderr(contains("wrote antumbra.gif"));
}

#[test]
fn what_is_no_animation_is_refused() {
    let bench = Bench::new();
    let refused = |args: &[&str], words: &str| {
        let result = bench.antumbra(&[&["render"], args].concat()).assert().code(2).stdout(is_empty());
        result.stderr(contains(words)).stderr(contains("panicked").not());
        assert_eq!(bench.names(), [""; 0]);
    };
    refused(&[BALL, "--animate", "a=0.5:1"], "--frames");
    refused(&[BALL, "--animate", "a=0.5:1", "--frames", "0"], "1 to 100000");
    refused(&[BALL, "--animate", "a=0.5", "--frames", "3"], "such as a=0:1");
    refused(&[BALL, "--animate", "a=1:1", "--frames", "3"], "nothing would move");
    refused(&[BALL, "--animate", "b=0:1", "--frames", "3"], "parameter b: there is no such parameter");
    refused(&["chubs", "--animate", "a=0:1", "--frames", "3"], "`chubs` has no parameters");
    refused(&["chubs", "--frames", "3"], "nothing moves");
    refused(&["chubs", "--turntable"], "--frames");
    refused(&["chubs", "--turntable", "--frames", "3", "--loop"], "--animate");
    refused(&[BALL, "--animate", "a=0.5:1", "--frames", "3", "--loop=twice"], "`back`");
    refused(&[BALL, "--animate", "a=0.5:1", "--frames", "3", "-o", "%d%d.png"], "twice");
    refused(&[BALL, "--animate", "a=0.5:1", "--frames", "3", "-o", "out.webm"], ".gif");
    refused(&[BALL, "--animate", "a=0.5:1", "--frames", "3", "-o", "%d.exr"], "frames are PNG");
    refused(&["chubs", "--turntable", "--frames", "3", "--planes", "p"], "not to an animation");
    refused(&["chubs", "--turntable", "--frames", "3", "--bits", "16"], "frames of their own");
    refused(&["chubs", "--turntable", "--frames", "3", "--fps", "0"], "0.01 to 100");
    let above = "[[surface]]\nformula = \"x^2 + y^2 + z^2 = 1\"\n[camera]\neye = [0, 0, 5]\nangle = 40\n";
    fs::write(bench.file("above.toml"), above).unwrap();
    let result = bench.antumbra(&["render", "above.toml", "--turntable", "--frames", "3"]).assert().code(2);
    result.stderr(contains("vertical axis"));
}

#[cfg(unix)]
#[test]
fn an_mp4_is_what_ffmpeg_makes_of_the_frames() {
    use std::os::unix::fs::PermissionsExt;
    let bench = Bench::new();
    let args = ["render", BALL, "--animate", "a=0.5:1", "--frames", "3", "--size", "16", "-o", "m.mp4"];
    let none = bench.antumbra(&args).env("PATH", bench.path()).assert().code(1);
    none.stderr(contains("needs the program ffmpeg")).stderr(contains("install it, or write a .gif"));
    assert_eq!(bench.names(), [""; 0]);
    // One that knows its encoder, counts what it is fed, and may fail.
    let fake = |last: &str| {
        let script = format!("#!/bin/sh\ncase \"$*\" in *-encoders*) echo libx264; exit;; esac\n{last}\n");
        fs::write(bench.file("ffmpeg"), script).unwrap();
        fs::set_permissions(bench.file("ffmpeg"), fs::Permissions::from_mode(0o755)).unwrap();
    };
    let path = format!("{}:/usr/bin:/bin", bench.path().display());
    fake("wc -c");
    bench.antumbra(&args).env("PATH", &path).assert().success();
    assert_eq!(fs::read_to_string(bench.file("m.mp4")).unwrap().trim(), (3 * 16 * 16 * 3).to_string());
    fs::remove_file(bench.file("m.mp4")).unwrap();
    fake("cat > /dev/null; echo no such luck >&2; exit 3");
    let failed = bench.antumbra(&args).env("PATH", &path).assert().code(1);
    failed.stderr(contains("ffmpeg failed")).stderr(contains("no such luck"));
    assert_eq!(bench.names(), ["ffmpeg", "m.mp4.frames"]);
    let odd = ["render", BALL, "--animate", "a=0.5:1", "--frames", "3", "--size", "15", "-o", "m.mp4"];
    bench.antumbra(&odd).env("PATH", &path).assert().code(2).stderr(contains("even --size"));
}
