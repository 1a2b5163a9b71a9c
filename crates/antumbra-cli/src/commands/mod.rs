//! The commands: validated options in, files and text out.

mod audit;
mod compare;
mod gallery;
mod info;
mod paper;
mod record;
mod render;
mod scene;

use std::time::{Duration, Instant};

use antumbra::{
    image::{COLOR_PLANE, Planes, exr_bytes, png_bytes},
    render::Renderer,
};
use anyhow::{Result, bail};
use serde::Serialize;

use crate::{
    args::{Args, Command},
    options::{AuditOptions, CompareOptions, Format, GalleryOptions, JsonTarget, PaperOptions, RenderOptions},
    output::{self, Sink},
    progress::Progress,
};

/// Runs the command of a command line.
///
/// # Errors
/// Whatever the command could not do, worded for the user.
pub(crate) fn run(args: Args) -> Result<()> {
    match args.command {
        Command::Render(args) => render::run(&RenderOptions::new(args)?),
        Command::Compare(args) => compare::run(&CompareOptions::new(args)?),
        Command::Paper(args) => paper::run(&PaperOptions::new(args)),
        Command::Audit(args) => audit::run(&AuditOptions::new(args)?),
        Command::Gallery(args) => gallery::run(&GalleryOptions::new(args)?),
        Command::Scene(command) => scene::run(&command),
        Command::Info => info::run(),
    }
}

/// Work between two looks at the progress bar.
const SLICE: Duration = Duration::from_millis(100);

/// Renders to the end under a progress bar.
///
/// # Errors
/// Where that takes longer than the budget.
fn complete(renderer: &mut Renderer, budget: Option<Duration>, progress: &Progress) -> Result<()> {
    let begin = Instant::now();
    while !renderer.refine(SLICE) {
        progress.set(renderer.progress());
        if let Some(budget) = budget.filter(|budget| begin.elapsed() > *budget) {
            let (seconds, share) = (budget.as_secs_f64(), 100.0 * renderer.progress());
            bail!(
                "the budget of {seconds} s is spent and about {share:.0} % of the picture is done; nothing was written: \
                 allow more with --budget, or ask for less with --size, --tolerance or --rectangles"
            );
        }
    }
    Ok(())
}

/// The bytes of a picture file.
fn picture_bytes(planes: &Planes, format: Format) -> Result<Vec<u8>> {
    Ok(match format {
        Format::Png(depth) => png_bytes(planes.require(COLOR_PLANE)?, depth)?,
        Format::Exr => exr_bytes(planes)?,
    })
}

/// The file for JSON, if it is to be one.
fn json_sink(target: Option<&JsonTarget>) -> Result<Option<Sink>> {
    match target {
        Some(JsonTarget::File(path)) => Sink::open(path).map(Some),
        Some(JsonTarget::Stdout) | None => Ok(None),
    }
}

/// JSON for people and programs: indented, one final newline.
fn json_text(value: &impl Serialize) -> Result<String> {
    Ok(serde_json::to_string_pretty(value)? + "\n")
}

/// Prints JSON where it goes to standard output.
fn print_json(target: Option<&JsonTarget>, text: &str) -> Result<()> {
    if target == Some(&JsonTarget::Stdout) { output::print(text) } else { Ok(()) }
}
