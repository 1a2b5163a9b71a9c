//! What the commands write when all is well.

use std::{fs, io::Cursor, process::Stdio};

use crate::bench::Bench;
use predicates::{prelude::predicate, str::contains};
use serde_json::Value;

fn json(text: &[u8]) -> Value {
    serde_json::from_slice(text).expect("JSON")
}

#[test]
fn a_preset_becomes_a_picture_of_its_name() {
    let bench = Bench::new();
    let result = bench.antumbra(&["render", "chubs", "--size", "24x16"]).assert().success();
    result.stdout(predicate::str::is_empty()).stderr(contains("hits")).stderr(contains("wrote chubs.png"));
    assert_eq!(bench.names(), ["chubs.png"]);
    let bytes = fs::read(bench.file("chubs.png")).unwrap();
    let reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
    let info = reader.info();
    assert_eq!((info.width, info.height, info.bit_depth), (24, 16, png::BitDepth::Eight));
    assert_eq!(info.srgb, Some(png::SrgbRenderingIntent::Perceptual));
}

#[test]
fn a_formula_becomes_a_picture() {
    let bench = Bench::new();
    let args = ["render", "x^2 + y^2 + z^2 - 1", "--size", "8", "--bits", "16", "--quiet"];
    bench.antumbra(&args).assert().success().stderr(predicate::str::is_empty());
    let bytes = fs::read(bench.file("antumbra.png")).unwrap();
    let reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
    assert_eq!(reader.info().bit_depth, png::BitDepth::Sixteen);
    bench.antumbra(&["render", "-q", "-o", "m.png", "--size", "8", "--", "-x^2 + 1"]).assert().success();
}

#[test]
fn exr_has_color_and_planes() {
    let bench = Bench::new();
    bench.antumbra(&["render", "chubs", "--size", "6x4", "-o", "p.exr"]).assert().success();
    let meta = exr::meta::MetaData::read_from_file(bench.file("p.exr"), false).unwrap();
    let names: Vec<String> = meta.headers[0].channels.list.iter().map(|c| c.name.to_string()).collect();
    for name in ["R", "G", "B", "t_lo", "verdict"] {
        assert!(names.iter().any(|n| n == name), "{name} is not in {names:?}");
    }
}

#[test]
fn planes_and_json_say_the_same_size() {
    let bench = Bench::new();
    let args = ["render", "chubs", "--size", "6x4", "-o", "planes/p.png", "--planes", "planes", "--json", "s.json"];
    bench.antumbra(&args).assert().success();
    let shape = |name: &str| {
        let bytes = fs::read(bench.file(name)).unwrap();
        npyz::NpyFile::new(&bytes[..]).unwrap().shape().to_vec()
    };
    assert_eq!(shape("planes/rgb.npy"), [4, 6, 3]);
    assert_eq!(shape("planes/t_lo.npy"), [4, 6]);
    assert!(bench.file("planes/p.png").exists());
    let stats = json(&fs::read(bench.file("s.json")).unwrap());
    assert_eq!((&stats["scene"], &stats["method"]), (&"chubs".into(), &"paper".into()));
    assert_eq!(stats["size"], serde_json::json!([6, 4]));
    for name in ["hits", "beams", "evaluations", "primary_seconds", "shadow_seconds", "seconds", "threads"] {
        assert!(stats[name].is_number(), "{name}: {stats}");
    }
    assert!(stats["classes"].is_object());
}

#[test]
fn json_on_standard_output_is_alone_there() {
    let bench = Bench::new();
    let output = bench.antumbra(&["render", "chubs", "--size", "4", "--json", "-"]).assert().success();
    assert!(json(&output.get_output().stdout)["hits"].is_number());
    let output = bench.antumbra(&["compare", "chubs", "--size", "4", "--json", "-"]).assert().success();
    assert_eq!(json(&output.get_output().stdout)["methods"].as_array().map(Vec::len), Some(2));
    output.stderr(contains("evaluations"));
}

#[test]
fn compare_prints_a_table_and_writes_its_json() {
    let bench = Bench::new();
    let args = ["compare", "chubs", "--size", "8", "--methods", "fixed49,paper,rays", "--threads", "1"];
    let result = bench.antumbra(&[&args[..], &["--json", "c.json"]].concat()).assert().success();
    result.stdout(contains("evaluations")).stdout(contains("fixed49")).stdout(contains("1.00x"));
    let record = json(&fs::read(bench.file("c.json")).unwrap());
    assert_eq!((&record["scene"], &record["threads"]), (&"chubs".into(), &1.into()));
    let methods = record["methods"].as_array().unwrap();
    assert_eq!(methods.iter().map(|m| m["method"].as_str().unwrap()).collect::<Vec<_>>(), ["fixed49", "paper", "rays"]);
    for name in ["hits", "beams", "evaluations", "primary_seconds", "shadow_seconds", "seconds"] {
        assert!(methods.iter().all(|m| m[name].is_number()), "{name}");
    }
    assert_eq!(bench.names(), ["c.json"]);
}

#[test]
fn paper_prints_tables_and_writes_figures() {
    let bench = Bench::new();
    bench.antumbra(&["paper", "table1", "--size", "4"]).assert().success().stdout(contains("Table1"));
    assert_eq!(bench.names(), [""; 0]);
    bench.antumbra(&["paper", "fig6", "--size", "4", "-o", "figures"]).assert().success().stderr(contains("wrote"));
    assert!(bench.file("figures/fig6.md").exists());
    assert!(
        fs::read_dir(bench.file("figures")).unwrap().any(|e| e.unwrap().path().extension() == Some("png".as_ref()))
    );
}

#[test]
fn info_names_presets_and_methods() {
    let result = Bench::new().antumbra(&["info"]).assert().success();
    for word in [env!("CARGO_PKG_VERSION"), "threads", "orthocircle", "mcmullen", "paper-quadtree", "rays-mc"] {
        assert!(String::from_utf8_lossy(&result.get_output().stdout).contains(word), "{word}");
    }
}

#[test]
fn help_has_examples_and_exit_codes() {
    let bench = Bench::new();
    for command in ["render", "compare", "paper"] {
        let result = bench.antumbra(&[command, "--help"]).assert().success();
        result.stdout(contains("Examples:")).stdout(contains("130"));
    }
    bench.antumbra(&["--help"]).assert().success().stdout(contains("Exit codes:"));
    bench.antumbra(&["--version"]).assert().success().stdout(contains(env!("CARGO_PKG_VERSION")));
}

#[cfg(unix)]
#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let program = assert_cmd::cargo::cargo_bin("antumbra");
    let mut child = std::process::Command::new(program)
        .args(["compare", "chubs", "--size", "64", "--quiet"])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    assert_eq!(child.wait().unwrap().code(), Some(0));
    if let Ok(full) = fs::OpenOptions::new().write(true).open("/dev/full") {
        let result = std::process::Command::new(assert_cmd::cargo::cargo_bin("antumbra"))
            .arg("info")
            .stdout(full)
            .output()
            .unwrap();
        assert_eq!(result.status.code(), Some(1));
        assert!(String::from_utf8_lossy(&result.stderr).contains("cannot write to standard output"));
    }
}

#[test]
fn devices_are_written_directly() {
    if cfg!(target_os = "linux") {
        let bench = Bench::new();
        let args = ["render", "chubs", "--size", "4", "-o", "p.png", "--json", "/dev/stdout", "--quiet"];
        let result = bench.antumbra(&args).assert().success();
        assert!(json(&result.get_output().stdout)["hits"].is_number());
        assert_eq!(bench.names(), ["p.png"]);
    }
}
