//! The shape of the source, held by machine: who may import whom, where `unsafe` and raw float arithmetic may stand,
//! how long a file may be.
use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

/// Every room of the heart, lowest first, with the rooms it may import: only lower ones.
const ROOMS: &[(&str, &[&str])] = &[
    ("verdict", &[]),
    ("geom", &[]),
    ("image", &[]),
    ("expr", &[]),
    ("tape", &["expr"]),
    ("eval", &["expr", "geom", "tape"]),
    ("grid", &["eval", "geom", "verdict"]),
    ("trace", &["eval", "geom", "grid", "verdict"]),
    ("shadow", &["eval", "geom", "trace", "verdict"]),
    ("paper", &["eval", "geom", "grid", "trace", "shadow", "verdict"]),
    ("scene", &["eval", "expr", "geom", "image", "tape"]),
    ("import", &["eval", "expr", "geom", "scene", "tape"]),
    ("render", &["eval", "expr", "geom", "grid", "image", "paper", "scene", "shadow", "tape", "trace", "verdict"]),
    ("audit", &["eval", "expr", "geom", "render", "scene"]),
    (
        "report",
        &["eval", "expr", "geom", "grid", "image", "paper", "render", "scene", "shadow", "tape", "trace", "verdict"],
    ),
];

/// Rooms in which claims are proved: float arithmetic only through intervals there, but for files named `policy.rs`,
/// which choose search paths.
const NO_FLOATS: [&str; 3] = ["grid", "trace", "shadow"];

/// Longest file of the source.
const MOST_LINES: usize = 500;

fn crates() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a crate lies in the folder of crates").to_owned()
}

/// Every `.rs` file below a folder, in a fixed order, with its text.
fn sources(folder: &Path) -> Vec<(PathBuf, String)> {
    let (mut out, mut folders) = (vec![], vec![folder.to_owned()]);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display())) {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let text = fs::read_to_string(&path).unwrap();
                out.push((path, text));
            }
        }
    }
    out.sort();
    out
}

/// The text without line comments: they may mention what code may not.
fn code(text: &str) -> String {
    text.lines().map(|line| line.split("//").next().unwrap_or("")).collect::<Vec<_>>().join("\n")
}

/// First segment below `src`, without extension.
fn room_of(path: &Path, src: &Path) -> String {
    let first = path.strip_prefix(src).unwrap().components().next().unwrap();
    first.as_os_str().to_str().unwrap().trim_end_matches(".rs").to_owned()
}

/// Rooms named after `crate::` in the code, in both `crate::a::b` and `crate::{a, b::c}` form.
fn imports(code: &str) -> BTreeSet<String> {
    let word = |s: &str| s.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    let mut out = BTreeSet::new();
    for (i, _) in code.match_indices("crate::") {
        let rest = &code[i + 7..];
        let Some(group) = rest.strip_prefix('{') else {
            out.insert(word(rest));
            continue;
        };
        let (mut depth, mut start) = (0, 0);
        for (j, c) in group.char_indices() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => {
                    out.insert(word(&group[start..]));
                    break;
                }
                '}' => depth -= 1,
                ',' if depth == 0 => {
                    out.insert(word(&group[start..]));
                    start = j + 1;
                }
                _ => {}
            }
        }
    }
    out.remove("");
    out
}

#[test]
fn the_table_of_rooms_is_in_layer_order() {
    for (i, (room, may)) in ROOMS.iter().enumerate() {
        for m in *may {
            assert!(ROOMS[..i].iter().any(|(lower, _)| lower == m), "{room} lists {m}, which is not a lower row");
        }
    }
}

#[test]
fn imports_are_found_in_every_form() {
    let text = "use crate::geom::Vec3; use crate::{eval::{Inclusion, run}, tape::Tape, verdict}; crate::scene::f();";
    let wanted = ["geom", "eval", "tape", "verdict", "scene"].map(String::from);
    assert_eq!(imports(&code(text)), BTreeSet::from(wanted));
    assert!(imports(&code("// crate::render is above")).is_empty());
}

#[test]
fn rooms_import_only_what_they_may() {
    let src = crates().join("antumbra/src");
    let mut bad = vec![];
    for (path, text) in sources(&src) {
        let room = room_of(&path, &src);
        if room == "lib" {
            continue;
        }
        let Some((_, may)) = ROOMS.iter().find(|(r, _)| *r == room) else {
            bad.push(format!("{room} is a room that the table does not list"));
            continue;
        };
        for import in imports(&code(&text)) {
            if import != room && ROOMS.iter().any(|(r, _)| *r == import) && !may.contains(&import.as_str()) {
                bad.push(format!("{}: {room} may not import {import}", path.display()));
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

#[test]
fn unsafe_stands_only_in_the_lanes() {
    let home = crates().join("antumbra-interval/src/lanes");
    // A dash too: a policy of the web is called wasm-unsafe-eval.
    let word = |line: &str| line.split(|c: char| !c.is_alphanumeric() && !"_-".contains(c)).any(|w| w == "unsafe");
    let all: Vec<_> =
        sources(&crates()).into_iter().filter(|(path, _)| !path.ends_with("tests/architecture.rs")).collect();
    let (inside, outside): (Vec<_>, Vec<_>) =
        all.iter().filter(|(_, text)| code(text).lines().any(word)).partition(|(path, _)| path.starts_with(&home));
    // WebAssembly's exports have names, which is unsafe in a word; no block is.
    let exports = crates().join("antumbra-web/src/abi.rs");
    let named = |line: &str| {
        let line = line.trim();
        !word(line) || ["#[unsafe(no_mangle)]", "unsafe extern \"C\" {"].contains(&line)
    };
    let names = |(path, text): &&&(PathBuf, String)| *path == exports && code(text).lines().all(named);
    let outside: Vec<_> = outside.iter().filter(|file| !names(file)).map(|(path, _)| path).collect();
    assert!(outside.is_empty(), "{outside:#?}");
    assert!(!inside.is_empty(), "the search finds nothing: it is broken");
}

#[test]
fn rooms_of_proofs_forbid_float_arithmetic() {
    let src = crates().join("antumbra/src");
    let (all, mut seen) = (sources(&src), 0);
    let denies = |text: &str| text.contains("#![deny(clippy::float_arithmetic)]");
    for room in NO_FLOATS {
        let files: Vec<_> = all.iter().filter(|(path, _)| room_of(path, &src) == room).collect();
        // The attribute of a module holds for its children.
        let root = files.iter().any(|(path, text)| path.ends_with("mod.rs") && denies(text));
        for (path, text) in files.into_iter().filter(|(path, _)| !path.ends_with("policy.rs")) {
            // The attribute binds tests too; they may lift it for their own slack.
            let text = text.split("#[cfg(test)]").next().unwrap_or_default();
            let code = code(text);
            let bound = root || denies(&code) || !code.contains("fn ");
            assert!(bound, "{} does not deny float arithmetic", path.display());
            assert!(!code.contains("allow(clippy::float_arithmetic"), "{} allows float arithmetic", path.display());
            seen += 1;
        }
    }
    assert!(seen >= 3, "{seen} files: the rooms are elsewhere");
}

#[test]
fn files_are_short() {
    for krate in ["antumbra-interval", "antumbra", "antumbra-viewer", "antumbra-cli", "antumbra-web"] {
        for (path, text) in sources(&crates().join(krate).join("src")) {
            let lines = text.lines().count();
            assert!(lines <= MOST_LINES, "{} has {lines} lines", path.display());
        }
    }
}

#[test]
fn every_crate_bans_the_elementary_functions_of_std() {
    for krate in ["antumbra-interval", "antumbra"] {
        let text = fs::read_to_string(crates().join(krate).join("clippy.toml")).unwrap();
        for name in ["sin", "cos", "tan", "exp", "ln", "powf", "powi", "cbrt", "hypot", "atan2", "mul_add"] {
            let rule = format!("path = \"f64::{name}\", reason = ");
            assert!(text.contains(&rule), "{krate}/clippy.toml does not ban f64::{name} with a reason");
        }
    }
}
