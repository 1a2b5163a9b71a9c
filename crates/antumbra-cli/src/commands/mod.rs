//! The commands: validated options in, files and text out.

mod animate;
mod audit;
mod compare;
mod device;
mod gallery;
mod info;
mod manual;
mod paper;
mod record;
mod render;
mod scene;
mod serve;
mod view;

use std::{
    sync::atomic::Ordering,
    time::{Duration, Instant},
};

use antumbra::{
    image::{COLOR_PLANE, Planes, exr_bytes, png_bytes},
    render::{Frame, Overlay, Renderer},
    scene::Look,
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
        Command::View(args) => view::run(&args),
        Command::Scene(command) => scene::run(&command),
        Command::Info => info::run(),
        Command::Serve(args) => serve::run(&args),
        Command::Completions(args) => manual::completions(&args),
        Command::Man(args) => manual::man(&args),
    }
}

/// Work between two looks at the progress bar.
const SLICE: Duration = Duration::from_millis(250);

/// How the work on a picture ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    /// It is finished.
    Done,
    /// The time is over.
    Budget,
    /// Somebody asked it to stop.
    Asked,
}

/// Renders, under a progress bar if there is one, until the picture is finished, the time is over or the renderer's flag says stop; looks in
/// at `between` now and then.
fn pursue(
    renderer: &mut Renderer,
    deadline: Option<Instant>,
    progress: Option<&Progress>,
    between: &mut dyn FnMut(&Renderer),
) -> End {
    let flag = renderer.stop_flag();
    let slice = || match deadline {
        Some(deadline) => SLICE.min(deadline.saturating_duration_since(Instant::now())),
        None => SLICE,
    };
    while !renderer.refine(slice()) {
        if let Some(progress) = progress {
            progress.show(renderer);
        }
        if flag.load(Ordering::Relaxed) {
            return End::Asked;
        }
        if deadline.is_some_and(|deadline| Instant::now() > deadline) {
            return End::Budget;
        }
        between(renderer);
    }
    End::Done
}

/// Renders to the end under a progress bar.
///
/// # Errors
/// Where that takes longer than the budget.
fn complete(renderer: &mut Renderer, budget: Option<Duration>, progress: &Progress) -> Result<()> {
    match pursue(renderer, deadline(budget), Some(progress), &mut |_| {}) {
        End::Done => Ok(()),
        End::Budget | End::Asked => {
            bail!(spent(budget, &format!("about {:.0} % is done; nothing was written", 100.0 * renderer.progress())))
        }
    }
}

/// When a budget that begins now is spent.
fn deadline(budget: Option<Duration>) -> Option<Instant> {
    budget.and_then(|budget| Instant::now().checked_add(budget))
}

/// The message of a spent budget; `left` is what is done and written.
fn spent(budget: Option<Duration>, left: &str) -> String {
    let seconds = budget.unwrap_or_default().as_secs_f64();
    format!(
        "the budget of {seconds} s is spent; {left}. Allow more with --budget, or ask for less with --size, --tolerance \
         or --rectangles"
    )
}

/// The bytes of a frame's picture: as it is to be looked at, or as data.
pub(crate) fn frame_bytes(frame: &Frame, look: &Look, format: Format) -> Result<Vec<u8>> {
    let planes = match format {
        Format::Png(_) => frame.picture(look),
        Format::Exr => frame.planes(),
    };
    picture_bytes(&planes?, format)
}

/// The bytes of a picture file.
pub(crate) fn picture_bytes(planes: &Planes, format: Format) -> Result<Vec<u8>> {
    Ok(match format {
        Format::Png(depth) => png_bytes(planes.require(COLOR_PLANE)?, depth)?,
        Format::Exr => exr_bytes(planes)?,
    })
}

/// A word about the legend of an overlay, where there is no room for it.
fn legend_left_out(frame: &Frame, overlay: Option<Overlay>) -> Option<String> {
    let (width, height) = (frame.width, frame.height);
    // Widths of brackets do not change what is written.
    let fits = frame.legend(overlay?, 1.0).fits(width, height);
    let words = "is too small for the legend, which is left out; there is one from 256x256 on";
    (!fits).then(|| format!("{width}x{height} {words}"))
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
