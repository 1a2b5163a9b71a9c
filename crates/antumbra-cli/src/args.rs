//! The command line as clap reads it. Nothing happens here.

mod picture;
mod serve;

use std::{ffi::OsString, path::PathBuf, time::Duration};

use antumbra::{
    render::{Method, Overlay, RenderSpec},
    report::Exhibit,
    shadow::Penumbra,
};
use clap::{Parser, Subcommand};

pub(crate) use picture::{AnimationArgs, LookArgs, ParameterArgs};
pub(crate) use serve::ServeArgs;

use crate::{
    failure::EXIT_CODES,
    values::{self, Device, Size},
    view::ViewArgs,
};

/// Pictures of implicit surfaces f(x, y, z) = 0 with soft shadows from area lights.
#[derive(Debug, Parser)]
#[command(name = "antumbra", version, after_help = EXIT_CODES, arg_required_else_help = true)]
pub(crate) struct Args {
    #[command(subcommand)]
    pub(crate) command: Command,
}

impl Args {
    /// What clap makes of a command line, the program's name first. A formula that begins with a minus gets a space in front, so that it is none of its
    /// options.
    pub(crate) fn of(words: impl IntoIterator<Item = OsString>) -> Result<Self, clap::Error> {
        let apart = |word: OsString| match word.to_str() {
            Some(text) if values::is_negative_formula(text) => format!(" {text}").into(),
            _ => word,
        };
        Self::try_parse_from(words.into_iter().map(apart))
    }
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Render(RenderArgs),
    View(ViewArgs),
    Compare(CompareArgs),
    Paper(PaperArgs),
    Audit(AuditArgs),
    Gallery(GalleryArgs),
    #[command(subcommand, after_help = SCENE_EXAMPLES)]
    Scene(SceneCommand),
    #[command(after_help = INFO_EXAMPLES)]
    /// Say what this program and this machine offer: presets, gallery, methods, processor, GPUs
    Info,
    Serve(ServeArgs),
    Completions(CompletionsArgs),
    Man(ManArgs),
}

const INFO_EXAMPLES: &str = "\
Examples:
  antumbra info                                     # version, processor, GPUs, presets, gallery, methods
  antumbra info | grep AVX-512";

const SCENE_EXAMPLES: &str = "\
Examples:
  antumbra scene new rings.toml                     # a scene to begin with, every key explained
  antumbra scene check rings.toml
  antumbra scene show boy > mine.toml               # a scene of the gallery, to be changed
  antumbra scene show 'a = 1; x^2 + y^2 + a z^2 = 1' > ellipsoid.toml";

const RENDER_EXAMPLES: &str = "\
Examples:
  antumbra render orthocircle
  antumbra render chubs -o chubs.exr --size 1024 --light-scale 4 --floor
  antumbra render 'x^4 + y^4 + z^4 - (x^2 + y^2 + z^2) + 0.5 = 0' -o mine.png
  antumbra render -o sphere.png -- '-x^2 - y^2 - z^2 + 1'
  antumbra render mcmullen --planes planes --json - --quiet | jq .hits
  antumbra render - < formula.txt
  antumbra render chubs --size 4096 --resume       # goes on where an earlier render of it was stopped
  antumbra render rings.toml --size 800x600        # `antumbra scene new rings.toml` writes one to begin with
  antumbra render rings.toml --set r=0.2
  antumbra render rings.toml --animate r=0.1:0.6 --loop --frames 120 -o rings.gif
  antumbra render 't = 0; x^2 + y^2 + z^2 = 1 + sin(3x + t)/4' --animate t=0:2pi --loop=around --frames 48 -o wave.apng
  antumbra render chubs --turntable --frames 90 -o frames/%04d.png --resume

Planes have row 0 at the top. The shape of verdict, t_lo, t_hi, visible_lo, visible_hi, \
coverage_lo, coverage_hi, facing, initial_occluded and cost is (height, width) (visible_lo_2 and so on belong to a second light), that of normal and rgb (linear light) is (height, width, 3). t_lo and t_hi are NaN only where the \
pixel is empty.";

/// Render a scene or a formula to a picture.
///
/// A picture appears under its name only when it is complete; until then it is a hidden file beside it. Ctrl-C keeps what
/// is done: as NAME.png.state, for --resume, and as the picture NAME.unfinished.png. Messages go to standard error, so that standard output holds only what `--json -` asks for.
#[derive(Debug, clap::Args)]
#[command(after_help = format!("{RENDER_EXAMPLES}\n\n{EXIT_CODES}"))]
pub(crate) struct RenderArgs {
    /// A preset (`antumbra info` lists them), a scene file (.toml), a formula in x, y, z, or `-` for a formula on standard
    /// input
    #[arg(value_name = "SCENE-OR-FORMULA")]
    pub(crate) scene: String,

    /// Picture to write: .png for looking, .exr for all planes in linear light [default: SCENE.png]. An animation: frames
    /// (frames/%04d.png), or a looping .gif, .apng (or .png), or an .mp4 where ffmpeg is installed [default: SCENE.gif]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,

    /// Bits per channel of a PNG: 8 (dithered) or 16
    #[arg(long, value_name = "BITS", default_value = "8", value_parser = ["8", "16"])]
    pub(crate) bits: String,

    /// How light and surface are found (`antumbra info` lists the methods)
    #[arg(long, value_name = "METHOD", default_value = RenderSpec::default().method.name(), value_parser = values::method)]
    pub(crate) method: Method,

    #[command(flatten)]
    pub(crate) look: LookArgs,

    #[command(flatten)]
    pub(crate) parameters: ParameterArgs,

    #[command(flatten)]
    pub(crate) spec: SpecArgs,

    /// Stop after so many seconds of rendering, with an error; what is done is kept for --resume
    #[arg(long, value_name = "SECONDS", value_parser = values::budget, allow_negative_numbers = true)]
    pub(crate) budget: Option<Duration>,

    /// Go on with a render that was stopped, by Ctrl-C, a budget or worse: the picture is the same, bit for bit
    #[arg(long)]
    pub(crate) resume: bool,

    /// Save what is done so often, for --resume, as FILE.state beside the picture; it goes away when the picture is there
    #[arg(long, value_name = "SECONDS", default_value = "30", value_parser = values::budget, allow_negative_numbers = true)]
    pub(crate) save_every: Duration,

    /// Draw a picture that would take more memory than so many MiB in bands; outlines, automatic exposure, overlays and EXR need the whole
    /// picture [default: 1536, if the picture allows it]
    #[arg(long, value_name = "MIB", value_parser = clap::value_parser!(u64).range(1..=1 << 40))]
    pub(crate) memory: Option<u64>,

    /// Who does it: cpu; gpu, for certified, paper and fixed49, does what it can, the processor the rest; auto takes a GPU if there is one.
    /// All prove what they say; the bits of cpu and gpu differ
    #[arg(long, value_name = "DEVICE", default_value = "cpu", value_parser = values::device)]
    pub(crate) device: Device,

    /// Draw what is known instead of the surface, with a legend: verdict, shadow, cost or width (of the brackets)
    #[arg(long, value_name = "KIND", value_parser = values::overlay)]
    pub(crate) overlay: Option<Overlay>,

    /// Write every plane as DIR/NAME.npy, and what was drawn as DIR/frame.json
    #[arg(long, value_name = "DIR")]
    pub(crate) planes: Option<PathBuf>,

    /// Write counters and times as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,

    /// No progress bar and no summary
    #[arg(short, long)]
    pub(crate) quiet: bool,

    #[command(flatten)]
    pub(crate) animation: AnimationArgs,
}

/// What every command that renders understands.
#[derive(Debug, clap::Args)]
pub(crate) struct SpecArgs {
    /// Size in pixels, N for a square or WxH [default: the scene's, or 512]
    #[arg(long, value_name = "N|WxH", value_parser = values::size, allow_negative_numbers = true)]
    pub(crate) size: Option<Size>,

    /// Make the light K times as wide
    #[arg(
        long,
        value_name = "K",
        default_value = "1",
        value_parser = values::light_scale,
        allow_negative_numbers = true
    )]
    pub(crate) light_scale: f64,

    /// Put the scene's floor under the surface
    #[arg(long)]
    pub(crate) floor: bool,

    /// Threads to use; the picture does not depend on it [default: every processor]
    #[arg(long, value_name = "N", value_parser = values::threads, allow_negative_numbers = true)]
    pub(crate) threads: Option<usize>,

    /// Cells of the paper's grid along each axis
    #[arg(long, value_name = "N", default_value = "32", value_parser = values::grid, allow_negative_numbers = true)]
    pub(crate) grid: usize,

    /// Sub-beams along each side of the light: N x N of them
    #[arg(long, value_name = "N", default_value = "7", value_parser = values::sub_beams, allow_negative_numbers = true)]
    pub(crate) sub_beams: usize,

    /// Distance by which the paper's shadow beams start off the surface [default: a fraction of the size of the scene]
    #[arg(long, value_name = "E", value_parser = values::offset, allow_negative_numbers = true)]
    pub(crate) offset: Option<f64>,

    /// Certified: how wide a bracket of the visible fraction may be, as a number or a fraction such as 1/1024
    /// [default: the scene's, or 1/255]
    #[arg(long, value_name = "T", value_parser = values::tolerance, allow_negative_numbers = true)]
    pub(crate) tolerance: Option<f64>,

    /// Certified: rectangles of the light that one hit may take before its bracket is left open
    #[arg(long, value_name = "N", default_value = "4000", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) rectangles: u32,

    /// Certified: how penumbrae are resolved: first (planes), second (quadratic models) or auto
    #[arg(long, value_name = "ORDER", default_value = "auto", value_parser = values::penumbra)]
    pub(crate) penumbra: Penumbra,

    /// Ask every question of the whole formula: no shorter tapes for parts of space, no parts of unions. Formulas with many min and max take
    /// much longer; no claim changes
    #[arg(long)]
    pub(crate) no_regions: bool,

    /// Seed of random choices: the points of rays-mc, the pixels and rays of an audit
    #[arg(long, value_name = "N", default_value = "1")]
    pub(crate) seed: u64,
}

const COMPARE_EXAMPLES: &str = "\
Examples:
  antumbra compare orthocircle --methods fixed49,paper
  antumbra compare mcmullen --methods fixed49,paper,paper-quadtree --threads 1 --json compare.json";

/// Run several methods on one scene, in one process, and compare their cost.
///
/// The first method named is the one that the ratios refer to: 2.0x means half of its cost.
#[derive(Debug, clap::Args)]
#[command(after_help = format!("{COMPARE_EXAMPLES}\n\n{EXIT_CODES}"))]
pub(crate) struct CompareArgs {
    /// A preset, a scene file (.toml), a formula in x, y, z, or `-` for a formula on standard input
    #[arg(value_name = "SCENE-OR-FORMULA")]
    pub(crate) scene: String,

    #[command(flatten)]
    pub(crate) parameters: ParameterArgs,

    /// Methods, separated by commas
    #[arg(
        long,
        value_name = "A,B,C",
        value_delimiter = ',',
        default_value = "fixed49,paper,certified",
        value_parser = values::method
    )]
    pub(crate) methods: Vec<Method>,

    #[command(flatten)]
    pub(crate) spec: SpecArgs,

    /// Give up after so many seconds of rendering, with an error and no picture
    #[arg(long, value_name = "SECONDS", value_parser = values::budget, allow_negative_numbers = true)]
    pub(crate) budget: Option<Duration>,

    /// Write the comparison as JSON; `-` is standard output (the table then goes to standard error)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,

    /// No progress bar
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Scene files: write one to begin with, check one, print one.
#[derive(Debug, Subcommand)]
pub(crate) enum SceneCommand {
    /// Write a scene file to begin with, with comments
    #[command(after_help = "Examples:\n  antumbra scene new rings.toml && antumbra render rings.toml")]
    New {
        /// File to write, such as rings.toml; an existing file is kept
        #[arg(value_name = "FILE.toml")]
        file: PathBuf,
    },
    /// Say whether a scene can be drawn, and what it holds
    #[command(after_help = "Examples:\n  antumbra scene check rings.toml\n  antumbra scene check 'x^2 + y^2 = z^3'")]
    Check {
        /// A scene file, a preset, a formula, or `-`
        #[arg(value_name = "SCENE")]
        scene: String,
    },
    /// Print a scene as a scene file, complete: what was left out is filled in
    #[command(
        after_help = "Examples:\n  antumbra scene show boy > mine.toml\n  antumbra scene show model.vm > model.toml"
    )]
    Show {
        /// A scene file, a preset, a formula, or `-`
        #[arg(value_name = "SCENE")]
        scene: String,
    },
}

const COMPLETIONS_EXAMPLES: &str = "\
Examples:
  antumbra completions bash > ~/.local/share/bash-completion/completions/antumbra
  antumbra completions zsh > ~/.zfunc/_antumbra
  antumbra completions fish > ~/.config/fish/completions/antumbra.fish";

/// Print a script that completes this program's options in a shell.
#[derive(Debug, clap::Args)]
#[command(after_help = COMPLETIONS_EXAMPLES)]
pub(crate) struct CompletionsArgs {
    /// The shell
    #[arg(value_name = "SHELL")]
    pub(crate) shell: clap_complete::Shell,
}

const MAN_EXAMPLES: &str = "\
Examples:
  antumbra man | man -l -                           # reads this program's page
  antumbra man render > antumbra-render.1           # the page of a command
  antumbra man -o ~/.local/share/man/man1           # writes all pages";

/// Print a manual page, or write all of them.
#[derive(Debug, clap::Args)]
#[command(after_help = MAN_EXAMPLES)]
pub(crate) struct ManArgs {
    /// The command whose page is wanted [default: the page of the program]
    #[arg(value_name = "COMMAND", conflicts_with = "output")]
    pub(crate) command: Option<String>,

    /// Write the pages of the program and of all its commands into this folder; made if its parent exists
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

const AUDIT_EXAMPLES: &str = "\
Examples:
  antumbra audit orthocircle --size 256
  antumbra audit 'x^2 + y^2 + z^2 - 1' --pixels 2000 --seed 7
  antumbra render chubs --planes chubs && antumbra audit chubs/

A folder's frame is read as it is (options that say what to draw do not apply); everything else is rendered first.";

/// Check the claims of a finished frame again, ray by ray, in high precision (about a minute for 1000 pixels).
///
/// Random pixels, random rays and random points of the lights, against the formula as it was written, on numbers of 192
/// bits. A violation is printed and makes the command fail; so no violation is what one expects to see.
#[derive(Debug, clap::Args)]
#[command(after_help = format!("{AUDIT_EXAMPLES}\n\n{EXIT_CODES}"))]
pub(crate) struct AuditArgs {
    /// A folder that `render --planes` wrote, or a preset, a scene file, a formula, or `-`
    #[arg(value_name = "FOLDER-OR-SCENE")]
    pub(crate) frame: String,

    #[command(flatten)]
    pub(crate) parameters: ParameterArgs,

    /// Pixels to look at
    #[arg(long, value_name = "N", default_value = "1000", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    pub(crate) pixels: u32,

    #[command(flatten)]
    pub(crate) spec: SpecArgs,

    /// Give up after so many seconds of rendering, with an error and no picture
    #[arg(long, value_name = "SECONDS", value_parser = values::budget, allow_negative_numbers = true)]
    pub(crate) budget: Option<Duration>,

    /// Write the counts as JSON; `-` is standard output (the table then goes to standard error)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,

    /// No progress bar
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

const PAPER_EXAMPLES: &str = "\
Examples:
  antumbra paper table1
  antumbra paper offsets --size 128
  antumbra paper fig6 -o figures --size 256";

/// One line for each exhibit, from the heart's list.
fn exhibits() -> String {
    let lines = Exhibit::ALL.iter().map(|(_, name, about)| format!("  {name:<10} {about}"));
    format!("Exhibits:\n{}\n\n", lines.collect::<Vec<_>>().join("\n"))
}

/// Reproduce a table or a figure of the paper behind the method `paper`.
///
/// Tables go to standard output, pictures to DIR (default: the current folder). Where there is a folder for files, the text
/// is written there too, as Markdown.
#[derive(Debug, clap::Args)]
#[command(after_help = format!("{}{PAPER_EXAMPLES}\n\n{EXIT_CODES}", exhibits()))]
pub(crate) struct PaperArgs {
    /// What to reproduce
    #[arg(value_name = "EXHIBIT", value_parser = values::exhibit)]
    pub(crate) exhibit: Exhibit,

    /// Folder for the files; made if its parent exists
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) spec: SpecArgs,

    /// No progress bar
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

const GALLERY_EXAMPLES: &str = "\
Examples:
  antumbra gallery                                  # all of it, into the folder gallery
  antumbra gallery barth-sextic boy -o two --size 512
  antumbra gallery --list
  antumbra render boy --size 1024                   # a surface of the gallery is a scene like others";

/// Draw the surfaces of the gallery, with a page that shows them.
///
/// Writes NAME.png for each as soon as it is done, then index.html (everything in one file), sheet.png (all pictures in one),
/// and the counts of proved and undecided pixels as gallery.md and gallery.json. A surface that fails does not stop the
/// others.
#[derive(Debug, clap::Args)]
#[command(after_help = format!("{GALLERY_EXAMPLES}\n\n{EXIT_CODES}"))]
#[command(mut_arg("size", |arg| arg.default_value("256")))]
pub(crate) struct GalleryArgs {
    /// Surfaces [default: all]
    #[arg(value_name = "NAME")]
    pub(crate) names: Vec<String>,

    /// Print names and titles, draw nothing
    #[arg(long)]
    pub(crate) list: bool,

    /// Folder for the files; made if its parent exists
    #[arg(short, long, value_name = "DIR", default_value = "gallery")]
    pub(crate) output: PathBuf,

    /// Pictures in a row of sheet.png
    #[arg(long, value_name = "N", default_value = "8", value_parser = values::columns, allow_negative_numbers = true)]
    pub(crate) columns: usize,

    #[command(flatten)]
    pub(crate) spec: SpecArgs,

    /// Give up on a surface after so many seconds, and go on with the next
    #[arg(long, value_name = "SECONDS", value_parser = values::budget, allow_negative_numbers = true)]
    pub(crate) budget: Option<Duration>,

    /// No progress bar and no summary
    #[arg(short, long)]
    pub(crate) quiet: bool,
}
