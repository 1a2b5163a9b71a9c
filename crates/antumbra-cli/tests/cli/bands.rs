//! Pictures in bands: the same pixels and planes in less memory, whatever stops them.

use std::{
    fs,
    process::{Command, Stdio},
    thread,
    time::Duration,
};

use crate::bench::Bench;
use predicates::{prelude::PredicateBooleanExt, str::contains};

const WHAT: [&str; 7] = ["render", "links", "--floor", "--size", "96x256", "--threads", "1"];

/// Codes of a PNG and the bytes of all planes.
fn result(bench: &Bench, name: &str) -> Vec<(String, Vec<u8>)> {
    let file = fs::File::open(bench.file(&format!("{name}.png"))).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut codes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut codes).unwrap();
    let planes = fs::read_dir(bench.file(name)).unwrap().map(|e| e.unwrap().path());
    let planes = planes.filter(|path| path.extension().is_some_and(|e| e == "npy"));
    let mut all: Vec<(String, Vec<u8>)> =
        planes.map(|p| (p.file_name().unwrap().to_string_lossy().into_owned(), fs::read(&p).unwrap())).collect();
    all.push((String::new(), codes));
    all.sort();
    all
}

fn arguments<'a>(picture: &'a str, planes: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&WHAT[..], &["-o", picture, "--planes", planes], more].concat()
}

#[test]
fn a_picture_in_bands_is_the_picture() {
    let bench = Bench::new();
    for bits in ["8", "16"] {
        bench.antumbra(&arguments("whole.png", "whole", &["--bits", bits])).assert().success();
        let bands = bench.antumbra(&arguments("bands.png", "bands", &["--bits", bits, "--memory", "1"])).assert();
        bands.success().stderr(contains("wrote bands.png and bands/*: 96x256"));
        let (whole, bands) = (result(&bench, "whole"), result(&bench, "bands"));
        assert_eq!(whole.len(), 17, "16 planes under two lights");
        assert!(whole == bands);
    }
    assert_eq!(bench.names(), ["bands", "bands.png", "whole", "whole.png"], "nothing else is left");
}

#[test]
fn a_picture_in_bands_goes_on_after_a_budget_and_after_kill() {
    let bench = Bench::new();
    bench.antumbra(&arguments("whole.png", "whole", &[])).assert().success();
    let more = ["--memory", "1", "--save-every", "0.001", "--resume", "--quiet"];
    let mut kills = 0;
    for moment in (0..).map(|k: u64| 40 + k * 37 % 200) {
        let mut child = Command::new(assert_cmd::cargo::cargo_bin("antumbra"))
            .current_dir(bench.path())
            .args(arguments("bands.png", "bands", &more))
            .stderr(Stdio::null())
            .spawn()
            .expect("the program starts");
        thread::sleep(Duration::from_millis(moment));
        child.kill().expect("SIGKILL");
        if child.wait().expect("a child").success() || kills == 8 {
            break;
        }
        kills += 1;
    }
    // Then by budgets, of which a few seconds are enough for the whole.
    let mut spent = 0;
    while spent < 500 && !bench.file("bands.png").exists() {
        spent += 1;
        let tried =
            bench.antumbra(&arguments("bands.png", "bands", &[&more[..], &["--budget", "0.2"]].concat())).assert();
        if !bench.file("bands.png").exists() {
            tried.code(1).stderr(contains("--resume goes on with it").or(contains("nothing was written")));
        }
    }
    assert!(kills + spent > 1, "it was stopped");
    assert!(result(&bench, "whole") == result(&bench, "bands"));
    let left: Vec<String> = bench.names().into_iter().filter(|name| !name.ends_with(".part")).collect();
    assert_eq!(left, ["bands", "bands.png", "whole", "whole.png"], "but for what SIGKILL left, nothing is left");
}

#[test]
fn rows_that_were_damaged_are_found() {
    let bench = Bench::new();
    let more = ["--memory", "1", "--save-every", "0.001"];
    let again = |budget: &str| {
        bench.antumbra(&arguments("p.png", "planes", &[&more[..], &["--resume", "--budget", budget]].concat())).assert()
    };
    let rows = bench.file("p.png.bands/picture-8");
    for _ in 0..500 {
        if fs::metadata(&rows).is_ok_and(|m| m.len() > 0) {
            break;
        }
        again("0.1");
    }
    let mut bytes = fs::read(&rows).expect("rows were finished");
    assert!(!bench.file("p.png").exists(), "it is not finished");
    bytes[140] ^= 1;
    fs::write(&rows, bytes).unwrap();
    again("100")
        .code(1)
        .stderr(contains("cannot go on"))
        .stderr(contains("damaged"))
        .stderr(contains("leave out --resume"));
    assert!(!bench.file("p.png").exists());
    bench.antumbra(&arguments("p.png", "planes", &more)).assert().success();
}

/// Until some rows of a picture in bands are finished.
fn begun(bench: &Bench, scene: &str) -> Vec<u8> {
    let rows = bench.file("p.png.bands/picture-8");
    for _ in 0..500 {
        let args = ["render", scene, "--size", "96x256", "--threads", "1", "-o", "p.png", "--memory", "1"];
        let _ =
            bench.antumbra(&[&args[..], &["--save-every", "0.001", "--resume", "--budget", "0.1"]].concat()).assert();
        if fs::metadata(&rows).is_ok_and(|m| m.len() > 0) {
            break;
        }
    }
    assert!(!bench.file("p.png").exists(), "it is not finished");
    fs::read(&rows).expect("rows were finished")
}

#[test]
fn rows_of_another_picture_are_not_taken() {
    let bench = Bench::new();
    let of_links = begun(&bench, "links");
    let state = fs::read(bench.file("p.png.state")).unwrap();
    // Another render of that name that ends before it has rows leaves them alone.
    let other = ["render", "chubs", "--size", "96x256", "-o", "p.png", "--memory", "1"];
    bench.antumbra(&[&other[..], &["--budget", "0.000001"]].concat()).assert().code(1);
    assert_eq!(fs::read(bench.file("p.png.bands/picture-8")).unwrap(), of_links);
    // One that has rows, with the first one's state put back: they are not its own.
    fs::remove_file(bench.file("p.png.state")).unwrap();
    begun_anew(&bench);
    fs::write(bench.file("p.png.state"), state).unwrap();
    let args = ["render", "links", "--size", "96x256", "--threads", "1", "-o", "p.png", "--memory", "1", "--resume"];
    bench.antumbra(&args).assert().code(1).stderr(contains("are not of this picture")).stderr(contains("--resume"));
    assert!(!bench.file("p.png").exists());
    // One that draws the whole anew takes the state's rows, so the state goes with it.
    bench.antumbra(&args[..args.len() - 1]).assert().success();
    assert_eq!(bench.names(), ["p.png"]);
}

/// Rows of another picture in the place of those that are there.
fn begun_anew(bench: &Bench) {
    fs::remove_dir_all(bench.file("p.png.bands")).unwrap();
    begun(bench, "gyroid");
}

#[test]
fn what_is_not_ours_is_left_alone() {
    let bench = Bench::new();
    let render = || bench.antumbra(&["render", "sphere", "--size", "96x256", "-o", "p.png", "--memory", "1"]).assert();
    fs::create_dir(bench.file("p.png.bands")).unwrap();
    fs::write(bench.file("p.png.bands/picture-8"), "my pictures").unwrap();
    render().code(1).stderr(contains("something else is in it"));
    assert_eq!(fs::read(bench.file("p.png.bands/picture-8")).unwrap(), b"my pictures");
    fs::remove_file(bench.file("p.png.bands/picture-8")).unwrap();
    #[cfg(unix)]
    {
        fs::write(bench.file("precious"), "").unwrap();
        std::os::unix::fs::symlink(bench.file("precious"), bench.file("p.png.bands/picture-8")).unwrap();
        render().code(1).stderr(contains("no plain file"));
        fs::remove_file(bench.file("p.png.bands/picture-8")).unwrap();
    }
    fs::write(bench.file("p.png.bands/notes"), "mine").unwrap();
    render().success();
    assert_eq!(fs::read(bench.file("p.png.bands/notes")).unwrap(), b"mine");
    fs::remove_dir_all(bench.file("p.png.bands")).unwrap();
    fs::write(bench.file("p.png.bands"), "a file").unwrap();
    render().code(1).stderr(contains("p.png.bands"));
}

#[test]
fn what_needs_the_whole_picture_says_so() {
    let bench = Bench::new();
    let refused = |more: &[&str], what: &str| {
        let args = [&["render", "chubs", "--size", "512", "--memory", "10"][..], more].concat();
        bench.antumbra(&args).assert().code(2).stderr(contains(what)).stderr(contains("--memory"));
    };
    refused(&["-o", "p.exr"], "an EXR file needs the whole picture");
    refused(&["--outline"], "an outline needs");
    refused(&["--exposure", "auto"], "automatic exposure needs");
    refused(&["--overlay", "verdict"], "an overlay with its legend needs");
    bench.antumbra(&["render", "chubs", "--memory", "0"]).assert().code(2).stderr(contains("--memory"));
    assert!(bench.names().is_empty());
}
