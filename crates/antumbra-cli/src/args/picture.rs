//! Options that say what a picture shows and how it looks.

use antumbra::scene::{ColorBy, Course, Exposure, Finish, Tone};

use crate::values::{self, Assignment, Span};

/// Values of a scene's parameters.
#[derive(Debug, clap::Args)]
pub(crate) struct ParameterArgs {
    /// Give a parameter of the scene another value, as in --set a=0.05 or --set t=pi/3; may be given several times. Parameters
    /// stand in [parameters] of a scene file, or in a formula as definitions: 'a = 1; x^2 + y^2 + a z^2 = 1'
    #[arg(long, value_name = "NAME=VALUE", value_parser = values::assignment)]
    pub(crate) set: Vec<Assignment>,
}

/// What moves in an animation.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Animation")]
pub(crate) struct AnimationArgs {
    /// Move a parameter over the frames, as in --animate a=0:1; several move together
    #[arg(long, value_name = "NAME=FROM:TO", value_parser = values::span, requires = "frames")]
    pub(crate) animate: Vec<Span>,

    /// Let the camera go around its target once, about the vertical axis
    #[arg(long, requires = "frames")]
    pub(crate) turntable: bool,

    /// How many frames
    #[arg(long, value_name = "N", value_parser = values::frames, allow_negative_numbers = true)]
    pub(crate) frames: Option<usize>,

    /// Make the end meet the beginning: back (there and back again, also without =back) or around (the end is the beginning
    /// already, as of --animate t=0:2pi, and is left out)
    #[arg(long = "loop", value_name = "KIND", num_args = 0..=1, require_equals = true, default_missing_value = "back",
        value_parser = values::course, requires = "animate")]
    pub(crate) course: Option<Course>,

    /// Frames per second of a moving picture [default: 25]
    #[arg(long, value_name = "N", value_parser = values::rate, allow_negative_numbers = true, requires = "frames")]
    pub(crate) fps: Option<f64>,
}

/// How the picture looks: nothing here is certified, and nothing changes what is.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Look")]
pub(crate) struct LookArgs {
    /// What becomes of light brighter than white: soft (pressed together), plain (cut) or filmic (bent as film does)
    #[arg(long, value_name = "TONE", value_parser = values::tone)]
    pub(crate) tone: Option<Tone>,

    /// Brightness: `auto`, or so many times twice as bright, such as 0.5 or -1
    #[arg(long, value_name = "STOPS", value_parser = values::exposure, allow_negative_numbers = true)]
    pub(crate) exposure: Option<Exposure>,

    /// Dark lines where a surface ends or bends sharply
    #[arg(long)]
    pub(crate) outline: bool,

    /// How all surfaces throw back light: matte, satin, gloss or metal
    #[arg(long, value_name = "FINISH", value_parser = values::finish)]
    pub(crate) finish: Option<Finish>,

    /// What decides the colour of all surfaces: sides, normal or curvature (another formula: `field` in a scene file)
    #[arg(long, value_name = "WHAT", value_parser = values::color_by)]
    pub(crate) color_by: Option<ColorBy>,
}
