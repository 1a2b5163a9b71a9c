//! Every bad input gives a message that says what to do, the right exit code, and no file.

use std::fs;

use crate::bench::Bench;
use predicates::{
    prelude::{PredicateBooleanExt, predicate},
    str::contains,
};

/// Runs the program, expects the exit code and all of the words on standard error, and an empty folder afterwards.
fn refused(args: &[&str], code: i32, words: &[&str]) {
    let bench = Bench::new();
    let mut result = bench.antumbra(args).assert().code(code).stdout(predicate::str::is_empty());
    for word in words {
        result = result.stderr(contains(*word));
    }
    result.stderr(contains("panicked").not());
    assert_eq!(bench.names(), [""; 0], "{args:?} left files");
}

#[test]
fn sizes_that_are_none() {
    refused(&["render", "chubs", "--size", "0"], 2, &["--size", "at least 1 pixel"]);
    refused(&["render", "chubs", "--size", "1000000000"], 2, &["--size", "at most 65535 pixels a side"]);
    refused(&["render", "chubs", "--size", "60000x60000"], 2, &["--size", "altogether"]);
    refused(&["render", "chubs", "--size", "-5"], 2, &["--size", "800x600"]);
    refused(&["render", "chubs", "--size", "512x"], 2, &["--size", "800x600"]);
    refused(&["compare", "chubs", "--size", "0"], 2, &["--size", "at least 1 pixel"]);
    refused(&["paper", "fig6", "--size", "0"], 2, &["--size", "at least 1 pixel"]);
}

#[test]
fn numbers_out_of_range() {
    refused(&["render", "chubs", "--threads", "-2"], 2, &["--threads", "from 1 to 1024", "leave it out"]);
    refused(&["render", "chubs", "--threads", "0"], 2, &["--threads", "from 1 to 1024"]);
    refused(&["render", "chubs", "--grid", "0"], 2, &["--grid", "from 1 to 512"]);
    refused(&["render", "chubs", "--sub-beams", "1.5"], 2, &["--sub-beams", "from 1 to 64"]);
    refused(&["render", "chubs", "--light-scale", "0"], 2, &["--light-scale", "greater than 0"]);
    refused(&["render", "chubs", "--light-scale", "NaN"], 2, &["--light-scale", "finite"]);
    refused(&["render", "chubs", "--offset", "inf"], 2, &["--offset", "finite"]);
    refused(&["render", "chubs", "--offset", "-1"], 2, &["--offset", "0 or more"]);
    refused(&["render", "chubs", "--bits", "12"], 2, &["--bits", "16"]);
}

#[test]
fn a_budget_of_time() {
    refused(&["render", "chubs", "--budget", "0"], 2, &["--budget", "greater than 0"]);
    refused(&["render", "chubs", "--budget", "NaN"], 2, &["--budget", "seconds"]);
    let spent = ["the budget of 0.001 s is spent", "nothing was written", "--size"];
    refused(&["audit", "chubs", "--size", "256", "--budget", "0.001"], 1, &spent);
    refused(&["compare", "chubs", "--size", "256", "--budget", "0.001"], 1, &spent);
}

#[test]
fn scenes_and_methods_that_do_not_exist() {
    refused(&["render", "orthocirle"], 2, &["no preset named `orthocirle`; did you mean `orthocircle`?"]);
    refused(&["compare", "orthocirle"], 2, &["did you mean `orthocircle`?"]);
    refused(&["render", "teapot"], 2, &["no preset named `teapot`", "chubs", "formula"]);
    refused(&["render", "chubs", "--method", "papr"], 2, &["did you mean `paper`?"]);
    refused(&["compare", "chubs", "--methods", "paper,fast"], 2, &["fixed49"]);
    refused(&["compare", "chubs", "--methods", "paper,paper"], 2, &["named twice"]);
    refused(&["paper", "fig9"], 2, &["table1", "fig7"]);
}

#[test]
fn files_that_are_not_there() {
    let bench = Bench::new();
    fs::write(bench.file("rings.toml"), "[[surface]]\nformula = \"x\"").unwrap();
    let said = |text: &str, words: &str| {
        let result = bench.antumbra(&["render", text]).assert().code(2).stdout(predicate::str::is_empty());
        result.stderr(contains(words));
    };
    said("rigns.toml", "error: there is no file `rigns.toml`\ndid you mean `rings.toml`?\n");
    said("rings.tml", "there is no file `rings.tml`, and it is no formula: `.` has no meaning here\ndid you mean");
    said("boy.tmol", "did you mean `boy`?");
    said(
        "nosuch/rings.toml",
        "there is no file `nosuch/rings.toml`, not even a folder `nosuch`\ndid you mean `rings.toml`?",
    );
    said("nosuch/rings", "not even a folder `nosuch`, and it is no formula: ");
    said("rings.toml/a.vm", "there is no file `rings.toml/a.vm`, not even a folder `rings.toml`");
    said("x^2 + y.z", "1 | x^2 + y.z");
    bench.antumbra(&["scene", "check", "rigns.toml"]).assert().code(2).stderr(contains("did you mean `rings.toml`?"));
    bench.antumbra(&["view", "rigns.toml"]).assert().code(2).stderr(contains("did you mean `rings.toml`?"));
    assert_eq!(bench.names(), ["rings.toml"]);
}

#[test]
fn formulas_that_are_none() {
    refused(&["render", ""], 2, &["empty"]);
    refused(&["render", "   "], 2, &["empty"]);
    refused(&["render", "x^2 + $"], 2, &["error: `$` has no meaning here", "1 | x^2 + $", "      ^"]);
    refused(&["compare", "x^2 + $"], 2, &["has no meaning here"]);
    refused(&["render", "(x + 1"], 2, &["never closed"]);
    refused(&["render", "x/0"], 2, &["division by a constant that is exactly 0"]);
    refused(&["render", "x + 1/(2 - 2)"], 2, &["division by a constant that is exactly 0"]);
    refused(&["render", "nan"], 2, &["`nan` is not a real number"]);
    refused(&["render", "x + inf"], 2, &["`inf` is not a real number"]);
    refused(&["render", "-x^2 + $"], 2, &["`$` has no meaning here"]);
    refused(&["render", "-sze", "64"], 2, &["unexpected argument '-s'"]);
    refused(&["render"], 2, &["SCENE-OR-FORMULA"]);
}

#[test]
fn formulas_from_standard_input() {
    let bench = Bench::new();
    bench.antumbra(&["render", "-"]).write_stdin("").assert().code(2).stderr(contains("empty"));
    bench.antumbra(&["render", "-"]).write_stdin(b"\xff".as_slice()).assert().code(1).stderr(contains("UTF-8"));
    assert_eq!(bench.names(), [""; 0]);
    let args = ["render", "-", "--size", "4", "-o", "p.png"];
    bench.antumbra(&args).write_stdin("x^2 + y^2\n + z^2 - 1\n").assert().success();
}

#[test]
fn monstrous_formulas() {
    let bench = Bench::new();
    let run = |text: String| bench.antumbra(&["render", "-", "--size", "2", "-q"]).write_stdin(text).assert();
    run("x+".repeat(5_000_000) + "1").code(2).stderr(contains("10000001 bytes; the most is"));
    run("(".repeat(100_000) + "x").code(2).stderr(contains("never closed"));
    run("x".to_owned() + &")".repeat(100_000)).code(2).stderr(contains("error: "));
    assert_eq!(bench.names(), [""; 0]);
    // As deep, but in order: a plane.
    run("(".repeat(100_000) + "x" + &")".repeat(100_000)).success();
    assert_eq!(bench.names(), ["antumbra.png"]);
    // One argument may not be longer than 128 KiB on Linux.
    refused(&["render", &("(".repeat(100_000) + "x")], 2, &["never closed"]);
}

#[test]
fn outputs_that_cannot_be() {
    let small = ["render", "chubs", "--size", "4"];
    let with = |more: &[&'static str]| [&small[..], more].concat();
    refused(&with(&["-o", "missing/p.png"]), 1, &["missing/p.png", "the folder `missing` does not exist", "make it"]);
    refused(&with(&["-o", "p.jpg"]), 2, &["p.jpg", ".png or .exr"]);
    refused(&with(&["-o", "p"]), 2, &[".png or .exr"]);
    for moving in ["p.gif", "p.apng", "p.mp4"] {
        refused(&with(&["-o", moving]), 2, &[moving, "nothing moves", "--turntable", "--frames N", ".png or .exr"]);
    }
    refused(&with(&["-o", "."]), 1, &["it is a folder", "add a file name"]);
    refused(&with(&["-o", ""]), 2, &["--output"]);
    refused(&with(&["--json", "missing/s.json"]), 1, &["missing/s.json", "does not exist"]);
    refused(&with(&["--json", "."]), 1, &["it is a folder"]);
    refused(&with(&["--planes", "missing/planes"]), 1, &["`missing` does not exist"]);
    refused(&with(&["-o", "p.png", "--json", "p.png"]), 2, &["both"]);
    refused(&["compare", "chubs", "--size", "4", "--json", "missing/s.json"], 1, &["does not exist"]);
    refused(&["paper", "fig6", "--size", "4", "-o", "missing/figures"], 1, &["does not exist"]);
}

#[test]
fn a_file_is_no_folder_and_a_folder_no_file() {
    let bench = Bench::new();
    fs::write(bench.file("plain"), "x").unwrap();
    fs::create_dir(bench.file("folder.png")).unwrap();
    let run = |args: &[&str]| bench.antumbra(&[&["render", "chubs", "--size", "4"], args].concat()).assert().code(1);
    run(&["-o", "folder.png"]).stderr(contains("`folder.png`: it is a folder"));
    run(&["-o", "plain/p.png"]).stderr(contains("`plain` is not a folder"));
    run(&["--planes", "plain"]).stderr(contains("`plain`: it is a file, not a folder"));
    assert_eq!(bench.names(), ["folder.png", "plain"]);
    assert_eq!(fs::read(bench.file("plain")).unwrap(), b"x");
}

#[test]
fn a_wrong_path_is_found_before_the_work() {
    // This picture would take minutes; the refusal must not.
    let long = ["render", "mcmullen", "--size", "8192", "--method", "fixed49", "--threads", "1"];
    let bench = Bench::new();
    for more in [["-o", "missing/p.png"], ["--json", "missing/s.json"], ["--planes", "missing/planes"]] {
        let args = [&long[..], &more].concat();
        bench.antumbra(&args).timeout(std::time::Duration::from_secs(30)).assert().code(1);
    }
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::{
        os::unix::fs::{PermissionsExt, symlink},
        path::Path,
    };

    #[test]
    fn a_read_only_file_is_not_replaced() {
        let bench = Bench::new();
        fs::write(bench.file("p.png"), "old").unwrap();
        fs::set_permissions(bench.file("p.png"), fs::Permissions::from_mode(0o444)).unwrap();
        let args = ["render", "chubs", "--size", "4", "-o", "p.png"];
        bench.antumbra(&args).assert().code(1).stderr(contains("`p.png`: the file exists and is read-only"));
        assert_eq!(fs::read(bench.file("p.png")).unwrap(), b"old");
        assert_eq!(bench.names(), ["p.png"]);
    }

    #[test]
    fn a_folder_without_permission() {
        let bench = Bench::new();
        fs::create_dir(bench.file("closed")).unwrap();
        fs::set_permissions(bench.file("closed"), fs::Permissions::from_mode(0o555)).unwrap();
        // A superuser may write everywhere; the kernel's own folders refuse even him.
        let superuser = fs::write(bench.file("closed/probe"), "").is_ok();
        let place = if superuser { "/proc/self" } else { "closed" };
        if Path::new(place).is_dir() {
            let output = format!("{place}/p.png");
            let args = ["render", "chubs", "--size", "4", "-o", &output];
            bench.antumbra(&args).assert().code(1).stderr(contains(format!("cannot write `{output}`")));
        }
    }

    #[test]
    fn a_full_device() {
        if !Path::new("/dev/full").exists() {
            return;
        }
        let bench = Bench::new();
        symlink("/dev/full", bench.file("p.png")).unwrap();
        let full =
            |args: &[&str]| bench.antumbra(&[&["render", "chubs", "--size", "4"], args].concat()).assert().code(1);
        full(&["-o", "p.png"]).stderr(contains("cannot write `p.png`: no space left"));
        full(&["-o", "q.png", "--json", "/dev/full"]).stderr(contains("cannot write `/dev/full`: no space left"));
        // The picture, already rendered, goes with it: all files or none.
        assert_eq!(bench.names(), ["p.png"]);
    }

    /// The program under a limit of 8 KiB (16 blocks of 512 bytes) a file: a disk that fills up in the middle.
    #[test]
    fn a_disk_that_fills_up_on_the_way() {
        let bench = Bench::new();
        let program = assert_cmd::cargo::cargo_bin("antumbra");
        let script = "trap '' XFSZ; ulimit -f 16; exec \"$0\" render chubs --size 128 -o p.png --planes planes";
        let mut shell = assert_cmd::Command::new("sh");
        shell.current_dir(bench.path()).args(["-c", script]).arg(program);
        shell.assert().code(1).stderr(contains("cannot write `").and(contains("no space left")));
        assert_eq!(bench.names(), [""; 0]);
    }
}
