//! Files that are not there: what was probably meant.

use std::{
    ffi::OsStr,
    fs,
    path::{Path, PathBuf},
};

use antumbra::scene;

use crate::{failure::Usage, import, values::likeness};

/// From this likeness on a name may be the one that was meant.
const NEAR: f64 = 0.85;
/// Most names that are offered.
const MOST: usize = 3;

/// Whether a text that is no formula was meant as the path of a file: it has nothing of a formula, and a folder or an extension.
pub(crate) fn is_path(text: &str) -> bool {
    let plain = |c: char| c.is_alphanumeric() || "._-~/\\".contains(c);
    if text.is_empty() || !text.chars().all(plain) {
        return false;
    }
    let word = |word: &str| word.len() >= 2 && word.starts_with(|c: char| c.is_alphabetic());
    let from_here = ["./", "../", "~/", "/"].iter().any(|start| text.starts_with(start));
    let folders = text.contains('/') && text.split('/').all(word);
    let extension = Path::new(text).extension().and_then(OsStr::to_str).is_some_and(word);
    from_here || folders || extension
}

/// The message for a path at which there is nothing; `formula` says why it is no formula either, where that was looked at.
pub(crate) fn message(text: &str, formula: Option<&str>) -> Usage {
    let path = Path::new(text);
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut words = format!("there is no file `{text}`");
    if !folder.is_dir() {
        words += &format!(", not even a folder `{}`", folder.display());
    }
    // The first line says what is wrong, the others show where.
    if let Some(why) = formula.and_then(|why| why.lines().next()) {
        words += &format!(", and it is no formula: {why}");
    }
    let near: Vec<String> = near(path, folder).iter().map(|name| format!("`{name}`")).collect();
    words += &match near.split_last() {
        None => {
            "\n`antumbra info` lists the presets and the gallery; `antumbra scene new FILE.toml` writes a scene file"
                .to_owned()
        }
        Some((last, [])) => format!("\ndid you mean {last}?"),
        Some((last, others)) => format!("\ndid you mean {} or {last}?", others.join(", ")),
    };
    Usage(words)
}

/// Names of scenes, and scene files in the folder or, without one, here, that are like the path; the likest first.
fn near(path: &Path, folder: &Path) -> Vec<String> {
    let lower = |part: Option<&OsStr>| part.unwrap_or_default().to_string_lossy().to_lowercase();
    let (name, stem) = (lower(path.file_name()), lower(path.file_stem()));
    let mut found: Vec<(f64, String)> = scene::names().map(|n| (likeness(&stem, n), n.to_owned())).collect();
    let folder = if folder.is_dir() { folder } else { Path::new(".") };
    // What cannot be listed has nothing to offer.
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let file = PathBuf::from(entry.file_name());
        if import::is_known(&file) || file.extension().is_some_and(|e| e == "toml") {
            let like = likeness(&name, &lower(file.file_name())).max(likeness(&stem, &lower(file.file_stem())));
            let shown = if folder == Path::new(".") { file } else { folder.join(file) };
            found.push((like, shown.display().to_string()));
        }
    }
    found.retain(|(like, _)| *like > NEAR);
    // Equal ones by name: the order in a folder is any.
    found.sort_by(|(a, m), (b, n)| b.total_cmp(a).then_with(|| m.cmp(n)));
    found.into_iter().take(MOST).map(|(_, name)| name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_look_otherwise_than_formulas() {
        for path in ["boy.tmol", "scenes/rings", "./rings", "../a.vm", "/a/x", "a-b/c_d.scene", "rings.TOML2"] {
            assert!(is_path(path), "{path}");
        }
        for formula in ["", "x", "x^2 + $", "x.y", "2.5x", "x/y", "sin(x).y", "orthocirle", "x = 1.5", "-x.abc = 1"] {
            assert!(!is_path(formula), "{formula}");
        }
    }

    #[test]
    fn names_and_files_are_offered() {
        let folder = tempfile::tempdir().unwrap();
        for file in ["rings.toml", "ring.vm", "rings.png", "zebra.toml"] {
            fs::write(folder.path().join(file), "").unwrap();
        }
        let at = |name: &str| folder.path().join(name).display().to_string();
        let Usage(words) = message(&at("rigns.toml"), None);
        let first = format!("did you mean `{}`", at("rings.toml"));
        assert!(words.contains(&first) && !words.contains(".png") && !words.contains("zebra"), "{words}");
        let Usage(words) = message("nosuch/boy.tmol", Some("`.` has no meaning here\n  |"));
        assert!(
            words.contains("not even a folder `nosuch`, and it is no formula: `.` has no meaning here\n"),
            "{words}"
        );
        assert!(words.ends_with("did you mean `boy`?"), "{words}");
        let Usage(words) = message("qqqqq.toml", None);
        assert!(words.contains("antumbra info"), "{words}");
    }
}
