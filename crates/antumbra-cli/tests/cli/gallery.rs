//! The gallery: pictures, the page that shows them, counts, and what happens when a surface fails.

use std::fs;

use crate::bench::Bench;
use predicates::{
    prelude::{PredicateBooleanExt, predicate},
    str::contains,
};

#[test]
fn the_list_has_names_and_titles() {
    let result = Bench::new().antumbra(&["gallery", "--list"]).assert().success();
    let text = String::from_utf8(result.get_output().stdout.clone()).unwrap();
    assert!(text.lines().count() >= 44, "{text}");
    for words in ["orthocircle", "barth-sextic     Barth sextic", "klein            Klein bottle"] {
        assert!(text.contains(words), "{words}\n{text}");
    }
}

#[test]
fn two_surfaces_become_pictures_and_a_page() {
    let bench = Bench::new();
    let args = ["gallery", "heart", "cayley", "-o", "g", "--size", "16"];
    bench.antumbra(&args).assert().success().stderr(contains("cayley (1 of 2)").and(contains("undecided")));
    let mut names: Vec<String> =
        fs::read_dir(bench.file("g")).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    assert_eq!(names, ["cayley.png", "gallery.json", "gallery.md", "heart.png", "index.html", "sheet.png"]);

    let page = fs::read_to_string(bench.file("g/index.html")).unwrap();
    assert_eq!(page.matches("src=\"data:image/png;base64,").count(), 2);
    assert!(!page.contains("http"), "the page loads something");
    for words in ["Cayley cubic", "Arthur Cayley, 1869", "no cubic", "prefers-color-scheme", "viewport", "proved empty"]
    {
        assert!(page.to_lowercase().contains(&words.to_lowercase()), "{words}");
    }
    let size = |name: &str| {
        let bytes = fs::read(bench.file(name)).unwrap();
        let reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        (reader.info().width, reader.info().height)
    };
    assert_eq!(size("g/heart.png"), (16, 16));
    assert_eq!(size("g/sheet.png"), (33, 16));

    let counts: serde_json::Value = serde_json::from_slice(&fs::read(bench.file("g/gallery.json")).unwrap()).unwrap();
    for row in counts.as_array().unwrap() {
        let number = |key: &str| row[key].as_u64().unwrap();
        let all = number("proved_hit") + number("proved_partly") + number("proved_empty") + number("undecided");
        assert_eq!(all, 256, "{row}");
    }
    let table = fs::read_to_string(bench.file("g/gallery.md")).unwrap();
    assert!(table.contains("| cayley ") && table.contains("| heart "), "{table}");
}

#[test]
fn surfaces_of_the_gallery_are_scenes_like_others() {
    let bench = Bench::new();
    bench.antumbra(&["render", "zitrus", "--size", "8", "-q"]).assert().success();
    assert_eq!(bench.names(), ["zitrus.png"]);
    let shown = bench.antumbra(&["scene", "show", "heart"]).assert().success();
    shown.stdout(contains("[about]").and(contains("Gabriel Taubin")));
    bench.antumbra(&["audit", "ding-dong", "--size", "8", "--pixels", "5", "-q"]).assert().success();
}

#[test]
fn an_unknown_name_gets_a_suggestion() {
    let bench = Bench::new();
    let result = bench.antumbra(&["gallery", "hart", "-o", "g"]).assert().code(2);
    result.stderr(contains("no surface named `hart`; did you mean `heart`?"));
    bench.antumbra(&["gallery", "teapot"]).assert().code(2).stderr(contains("--list"));
    assert_eq!(bench.names(), [""; 0]);
}

#[test]
fn one_that_fails_does_not_stop_the_others() {
    let bench = Bench::new();
    // A folder stands where the picture should be.
    fs::create_dir_all(bench.file("g/cayley.png")).unwrap();
    let args = ["gallery", "heart", "cayley", "-o", "g", "--size", "8"];
    let result = bench.antumbra(&args).assert().code(1);
    result.stderr(contains("cayley (1 of 2) failed").and(contains("1 of 2 surfaces failed: cayley")));
    let page = fs::read_to_string(bench.file("g/index.html")).unwrap();
    assert!(page.contains("Gabriel Taubin") && !page.contains("Arthur Cayley"));

    // Where all fail, what was there stays.
    fs::write(bench.file("g/index.html"), "old").unwrap();
    bench.antumbra(&["gallery", "cayley", "-o", "g", "--size", "8"]).assert().code(1).stderr(contains("no surface"));
    assert_eq!(fs::read_to_string(bench.file("g/index.html")).unwrap(), "old");
    let hidden = |name: &String| name.starts_with('.');
    assert!(!fs::read_dir(bench.file("g")).unwrap().any(|e| hidden(&e.unwrap().file_name().into_string().unwrap())));
}

#[test]
fn quiet_is_quiet() {
    let args = ["gallery", "ding-dong", "--size", "8", "-q"];
    Bench::new().antumbra(&args).assert().success().stderr(predicate::str::is_empty());
}

/// Pictures that are finished stay; unfinished files go, those that were opened first too.
#[cfg(unix)]
#[test]
fn ctrl_c_keeps_what_is_finished() {
    use std::{
        process::{Command, Stdio},
        thread,
        time::Duration,
    };
    let bench = Bench::new();
    let mut child = Command::new(assert_cmd::cargo::cargo_bin("antumbra"))
        .current_dir(bench.path())
        .args(["gallery", "cayley", "labs-septic", "-o", "g", "--size", "192", "--threads", "1"])
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    for _ in 0..6000 {
        if bench.file("g/cayley.png").exists() {
            break;
        }
        thread::sleep(Duration::from_millis(10));
    }
    assert!(child.try_wait().expect("a child").is_none(), "finished too early to be interrupted");
    let kill = Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().expect("a shell");
    assert!(kill.success());
    assert_eq!(child.wait().expect("a child").code(), Some(130));
    let names: Vec<String> =
        fs::read_dir(bench.file("g")).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    assert_eq!(names, ["cayley.png"]);
}
