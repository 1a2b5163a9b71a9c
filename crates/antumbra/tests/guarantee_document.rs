//! The guarantee names the tests that attack each promise: they must exist.
use std::path::Path;

/// Targets of the links of a text in Markdown.
fn links(text: &str) -> Vec<&str> {
    text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target).collect()
}

#[test]
fn every_promise_names_tests_that_exist() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let text = std::fs::read_to_string(docs.join("guarantee.md")).unwrap();
    let promises: Vec<&str> = text.lines().filter(|line| line.starts_with("| **")).collect();
    assert!(promises.len() >= 13, "{} promises", promises.len());
    for promise in promises {
        let tests: Vec<&str> = links(promise).into_iter().filter(|target| target.starts_with("../")).collect();
        assert!(!tests.is_empty(), "no test attacks: {promise}");
        for test in tests {
            assert!(docs.join(test).is_file(), "{test} does not exist");
        }
    }
}
