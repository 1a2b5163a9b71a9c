//! `antumbra audit`: honest frames pass, corrupted ones do not.

use std::fs;

use crate::bench::Bench;
use predicates::{
    prelude::{PredicateBooleanExt, predicate},
    str::contains,
};

const RENDER: [&str; 7] = ["render", "sphere", "--size", "16", "--planes", "p", "--quiet"];

#[test]
fn a_scene_is_rendered_and_audited() {
    let bench = Bench::new();
    let args = ["audit", "x^2 + y^2 + z^2 - 1", "--size", "16", "--pixels", "12", "--floor", "--json", "-", "--quiet"];
    let output = bench.antumbra(&args).assert().success().stderr(contains("violations")).get_output().stdout.clone();
    let counts: serde_json::Value = serde_json::from_slice(&output).unwrap();
    assert_eq!(counts["pixels"], 12);
    assert_eq!(counts["total"]["violations"], 0);
    assert!(counts["kinds"]["hit"]["claims"].as_u64().unwrap() > 0);
    assert_eq!(bench.names(), [""; 0]);
}

#[test]
fn a_folder_is_audited_and_a_corrupted_one_is_found() {
    let bench = Bench::new();
    bench.antumbra(&RENDER).assert().success();
    let audit = ["audit", "p", "--pixels", "40", "--quiet"];
    bench.antumbra(&audit).assert().success().stdout(contains("violations"));
    // The whole light becomes invisible everywhere.
    for name in ["visible_lo", "visible_hi"] {
        let path = bench.file(&format!("p/{name}.npy"));
        let mut bytes = fs::read(&path).unwrap();
        let data = bytes.len() - 16 * 16 * 8;
        for value in bytes[data..].chunks_exact_mut(8) {
            if f64::from_le_bytes((&*value).try_into().unwrap()) == 1.0 {
                value.fill(0);
            }
        }
        fs::write(&path, bytes).unwrap();
    }
    let result = bench.antumbra(&audit).assert().code(1).stdout(contains("dark"));
    result.stderr(contains("claims are wrong")).stderr(contains("that point says otherwise"));
}

#[test]
fn folders_that_cannot_be_audited() {
    let bench = Bench::new();
    let refused = |words: [&str; 2]| {
        let result = bench.antumbra(&["audit", "p/", "--pixels", "4"]).assert().code(1);
        let result = result.stdout(predicate::str::is_empty()).stderr(contains("panicked").not());
        words.iter().fold(result, |result, word| result.stderr(contains(*word)));
    };
    refused(["cannot read `p/frame.json`", "--planes DIR"]);
    bench.antumbra(&RENDER).assert().success();
    let record = fs::read_to_string(bench.file("p/frame.json")).unwrap();
    fs::write(bench.file("p/frame.json"), record.replace("certified", "paper")).unwrap();
    refused(["the method `paper`", "nothing to audit"]);
    fs::write(bench.file("p/frame.json"), record.replace("\"width\": 16", "\"width\": 17")).unwrap();
    refused(["not of the size", "frame.json"]);
    fs::write(bench.file("p/frame.json"), &record[..20]).unwrap();
    refused(["frame.json", "is not what `render --planes` writes"]);
    fs::write(bench.file("p/frame.json"), &record).unwrap();
    fs::write(bench.file("p/t_lo.npy"), b"\x93NUMPY").unwrap();
    refused(["plane `t_lo` cannot be read", "error"]);
    fs::remove_file(bench.file("p/t_lo.npy")).unwrap();
    refused(["cannot read `p/t_lo.npy`", "--planes DIR"]);
}
