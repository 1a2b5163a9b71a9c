//! `antumbra completions` and `antumbra man`: both from the source that reads the command line.

use anyhow::Result;
use clap::{Command, CommandFactory};

use crate::{
    args::{Args, CompletionsArgs, ManArgs},
    failure::Usage,
    output::{Folder, finish, print, remark},
    values,
};

const PROGRAM: &str = "antumbra";

/// Prints the script for a shell.
pub(super) fn completions(args: &CompletionsArgs) -> Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Args::command(), PROGRAM, &mut script);
    print(&String::from_utf8(script)?)
}

/// Prints a page, or writes all of them.
pub(super) fn man(args: &ManArgs) -> Result<()> {
    let pages = pages()?;
    if let Some(folder) = &args.output {
        let folder = Folder::open(folder)?;
        let mut sinks = Vec::new();
        for (name, page) in &pages {
            let mut sink = folder.sink(&format!("{name}.1"))?;
            sink.fill(page.as_bytes())?;
            sinks.push(sink);
        }
        let count = sinks.len();
        finish(sinks)?;
        remark(&format!("wrote {count} pages in {}", folder.path().display()));
        return Ok(());
    }
    let wanted = args.command.as_ref().map_or_else(|| PROGRAM.to_owned(), |name| format!("{PROGRAM}-{name}"));
    if let Some((_, page)) = pages.iter().find(|(name, _)| *name == wanted) {
        return print(page);
    }
    let names: Vec<&str> = pages.iter().filter_map(|(name, _)| name.strip_prefix("antumbra-")).collect();
    let unknown = args.command.as_deref().unwrap_or_default();
    let advice = match values::nearest(unknown, &names) {
        Some(name) => format!("did you mean `{name}`?"),
        None => format!("there are {}", names.join(", ")),
    };
    Err(Usage(format!("there is no command `{unknown}`; {advice}")).into())
}

/// Every page with its name, the program's first: `antumbra`, `antumbra-render`, `antumbra-scene-new`.
fn pages() -> Result<Vec<(String, String)>> {
    let mut program = Args::command();
    program.build();
    let mut open = vec![(PROGRAM.to_owned(), program)];
    let mut pages = Vec::new();
    while let Some((name, command)) = open.pop() {
        let below = command.get_subcommands().filter(|c| c.get_name() != "help");
        open.extend(
            below.map(|c| (format!("{name}-{}", c.get_name()), c.clone())).collect::<Vec<_>>().into_iter().rev(),
        );
        let page: Command = command.name(leak(&name)).display_name(leak(&name));
        let mut text = Vec::new();
        clap_mangen::Man::new(page).render(&mut text)?;
        pages.push((name, String::from_utf8(text)?));
    }
    Ok(pages)
}

/// The names of commands live as long as the program.
fn leak(name: &str) -> &'static str {
    Box::leak(name.to_owned().into_boxed_str())
}
