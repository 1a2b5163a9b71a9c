//! Who may import whom. Rows are in layer order: a room may import only the rooms listed.
use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

const ROOMS: &[(&str, &[&str])] =
    &[("geom", &[]), ("tape", &[]), ("eval", &["tape"]), ("trace", &["eval", "geom", "tape"])];

fn files(p: &Path, out: &mut Vec<PathBuf>) {
    if p.is_dir() {
        for e in fs::read_dir(p).unwrap() {
            files(&e.unwrap().path(), out)
        }
    } else if p.extension().is_some_and(|e| e == "rs") {
        out.push(p.into())
    }
}

/// Rooms named after `crate::` in the text, in both `crate::a::b` and `crate::{a, b::c}` form.
fn imports(text: &str) -> BTreeSet<String> {
    let mut out = BTreeSet::new();
    for (i, _) in text.match_indices("crate::") {
        let rest = &text[i + 7..];
        let word =
            |s: &str| s.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
        if let Some(group) = rest.strip_prefix('{') {
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
                        start = j + 1
                    }
                    _ => {}
                }
            }
        } else {
            out.insert(word(rest));
        }
    }
    out
}

#[test]
fn rooms_import_only_what_they_may() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut seen = BTreeSet::new();
    let mut bad = vec![];
    let mut all = vec![];
    files(&src, &mut all);
    for f in all {
        let room = f
            .strip_prefix(&src)
            .unwrap()
            .components()
            .next()
            .unwrap()
            .as_os_str()
            .to_str()
            .unwrap()
            .trim_end_matches(".rs")
            .to_string();
        if room == "lib" {
            continue;
        }
        seen.insert(room.clone());
        let Some((_, may)) = ROOMS.iter().find(|(r, _)| *r == room) else {
            bad.push(format!("{room}: not in the table"));
            continue;
        };
        for i in imports(&fs::read_to_string(&f).unwrap()) {
            if ROOMS.iter().any(|(r, _)| *r == i) && i != room && !may.contains(&i.as_str()) {
                bad.push(format!("{}: {room} may not import {i}", f.display()))
            }
        }
    }
    for (i, (r, may)) in ROOMS.iter().enumerate() {
        for m in *may {
            assert!(ROOMS[..i].iter().any(|(x, _)| x == m), "{r} lists {m}, which is not a lower row")
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}
