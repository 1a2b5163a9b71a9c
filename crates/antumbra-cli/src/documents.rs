//! The commands in the pages are commands: each line of a shell block that calls this program is read as the program would
//! read it, and the formulas and scenes that it names are looked at.

use std::{fs, path::Path};

use crate::{
    args::{Args, Command, SceneCommand},
    options::find_scene,
};

/// The words of a command line of a shell, up to a comment, a pipe, a redirection or the next command. Quotes are known, nothing
/// else is.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut word, mut quote) = (Vec::new(), None::<String>, None);
    for c in line.chars() {
        match (quote, c) {
            (Some(q), c) if c == q => quote = None,
            (Some(_), c) => word.get_or_insert_default().push(c),
            (None, '\'' | '"') => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            (None, c) if c.is_whitespace() => words.extend(word.take()),
            (None, '#') if word.is_none() => break,
            (None, '|' | '>' | '<' | '&' | ';') => break,
            (None, c) => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    words
}

/// Lines of the shell blocks of a page, joined where one ends with a backslash, with their numbers.
fn commands(page: &str) -> Vec<(usize, String)> {
    let (mut inside, mut found) = (false, Vec::<(usize, String)>::new());
    let mut open = false;
    for (number, line) in page.lines().enumerate() {
        if line.starts_with("```") {
            inside = line == "```sh";
            continue;
        }
        if !inside {
            continue;
        }
        let (text, goes_on) = line.strip_suffix('\\').map_or((line, false), |text| (text, true));
        match found.last_mut().filter(|_| open) {
            Some((_, command)) => command.push_str(text),
            None => found.push((number + 1, text.to_owned())),
        }
        open = goes_on;
    }
    found
}

#[test]
fn every_command_of_the_pages_is_one() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let docs = fs::read_dir(root.join("docs")).unwrap().map(|entry| entry.unwrap().path());
    let pages = docs.chain([root.join("README.md")]).filter(|path| path.extension().is_some_and(|e| e == "md"));
    let mut checked = 0;
    for page in pages {
        let text = fs::read_to_string(&page).unwrap();
        for (line, command) in commands(&text) {
            let place = format!("{}, line {line}: {command}", page.display());
            let mut words = words(&command);
            if command.starts_with("cargo run --release -- ") {
                words.drain(..4);
                words.insert(0, "antumbra".to_owned());
            }
            if words.first().is_none_or(|word| word != "antumbra") {
                continue;
            }
            checked += 1;
            let args = match Args::of(words.iter().map(Into::into)) {
                Ok(args) => args,
                Err(e) if !e.use_stderr() => continue,
                Err(e) => panic!("{place}\n{e}"),
            };
            let scene = match args.command {
                Command::Render(args) => args.scene,
                Command::View(args) => args.scene,
                Command::Compare(args) => args.scene,
                Command::Audit(args) => args.frame,
                Command::Scene(SceneCommand::Show { scene } | SceneCommand::Check { scene }) => scene,
                _ => continue,
            };
            // Files are the reader's own.
            let file =
                scene == "-" || scene.ends_with('/') || Path::new(&scene).extension().is_some_and(|e| e.len() < 6);
            if !file {
                find_scene(&scene).unwrap_or_else(|e| panic!("{place}\n{e}"));
            }
        }
    }
    assert!(checked > 60, "{checked} commands");
}

#[test]
fn words_of_a_shell() {
    assert_eq!(words("antumbra render 'a b' --x=\"c d\" # why"), ["antumbra", "render", "a b", "--x=c d"]);
    assert_eq!(words("antumbra render - < formula.txt"), ["antumbra", "render", "-"]);
    assert_eq!(commands("```sh\na \\\nb\n```\n```\nc\n```\n"), [(2, "a b".to_owned())]);
}
