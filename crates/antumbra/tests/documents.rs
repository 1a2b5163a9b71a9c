//! The pages: every link leads somewhere, every promise of the guarantee names tests that exist, pictures are small.
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Every page with its text: those of the project and those of `docs`.
fn pages() -> Vec<(PathBuf, String)> {
    let folders = [root(), root().join("docs")];
    let files = folders.iter().flat_map(|folder| fs::read_dir(folder).unwrap()).map(|entry| entry.unwrap().path());
    let mut pages: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|e| e == "md")).collect();
    pages.sort();
    pages.into_iter().map(|path| (path.clone(), fs::read_to_string(path).unwrap())).collect()
}

/// The text without fenced blocks.
fn prose(text: &str) -> String {
    text.split("```").step_by(2).collect()
}

/// Targets of the links of a text in Markdown.
fn links(text: &str) -> Vec<&str> {
    text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target).collect()
}

/// The anchor that a heading gets.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().to_lowercase();
    kept.chars()
        .filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'))
        .map(|c| if c == ' ' { '-' } else { c })
        .collect()
}

#[test]
fn every_link_leads_somewhere() {
    let pages = pages();
    assert!(pages.len() >= 15, "{} pages", pages.len());
    let mut seen = 0;
    for (path, text) in &pages {
        let text = prose(text);
        for target in links(&text).into_iter().filter(|t| !t.starts_with("http")) {
            seen += 1;
            let (file, place) = target.split_once('#').map_or((target, None), |(file, place)| (file, Some(place)));
            let there = if file.is_empty() { path.clone() } else { path.parent().unwrap().join(file) };
            assert!(there.exists(), "{}: {target} leads nowhere", path.display());
            if let Some(place) = place.filter(|_| there.extension().is_some_and(|e| e == "md")) {
                let page = fs::read_to_string(&there).unwrap();
                let found =
                    page.lines().filter(|l| l.starts_with('#')).any(|l| anchor(l.trim_start_matches('#')) == place);
                assert!(found, "{}: {target} names no heading", path.display());
            }
        }
    }
    assert!(seen > 50, "{seen} links");
}

/// Each page is reached from the first one.
#[test]
fn every_page_is_linked() {
    let pages = pages();
    let all: String = pages.iter().map(|(_, text)| text.as_str()).collect();
    for (path, _) in pages.iter().filter(|(path, _)| path.parent().is_some_and(|p| p.ends_with("docs"))) {
        let name = path.file_name().unwrap().to_string_lossy();
        assert!(all.contains(&format!("{name})")) || all.contains(&format!("{name}#")), "nobody links to {name}");
    }
}

#[test]
fn pictures_of_the_first_page_are_few_and_small() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let pictures: Vec<&str> = links(&readme).into_iter().filter(|target| target.ends_with(".png")).collect();
    assert!((1..=8).contains(&pictures.len()), "{pictures:?}");
    for picture in pictures {
        let size = fs::metadata(root().join(picture)).unwrap_or_else(|e| panic!("{picture}: {e}")).len();
        assert!(size < 120_000, "{picture}: {size} bytes");
    }
}

#[test]
fn every_promise_names_tests_that_exist() {
    let docs = root().join("docs");
    let text = fs::read_to_string(docs.join("guarantee.md")).unwrap();
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
