//! What the page is told, as JSON.
use antumbra::expr;
use antumbra::scene::{About, FileError};
use serde::Serialize;

/// Why a scene cannot be drawn.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub(crate) struct Refusal {
    /// What is wrong.
    pub(crate) message: String,
    /// What to do about it.
    pub(crate) help: Option<String>,
    /// Place in the formula, in UTF-16 units as JavaScript counts, where there is one.
    pub(crate) place: Option<[usize; 2]>,
}

impl Refusal {
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), ..Self::default() }
    }

    /// That of a formula.
    pub(crate) fn of_formula(error: &expr::Error, text: &str) -> Self {
        let units = |end: usize| text.get(..end).map_or(0, |before| before.encode_utf16().count());
        let span = error.span();
        let help = error.help().map(str::to_owned).or_else(|| {
            let expected = error.expected();
            (!expected.is_empty()).then(|| format!("expected {}", expected.join(", ")))
        });
        Self { message: error.message().to_owned(), help, place: Some([units(span.start), units(span.end)]) }
    }
}

impl From<FileError> for Refusal {
    fn from(error: FileError) -> Self {
        Self::new(error.to_string())
    }
}

/// A scene that is being drawn.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Description {
    pub(crate) title: String,
    pub(crate) about: Option<About>,
    /// The formulas of its surfaces.
    pub(crate) formulas: Vec<String>,
    pub(crate) parameters: Vec<Slider>,
    /// The scene's own camera.
    pub(crate) camera: CameraOf,
    /// The scene's own first light.
    pub(crate) light: Option<LightOf>,
    /// Number of lights.
    pub(crate) lights: usize,
    /// Half of the largest edge of what holds the surfaces.
    pub(crate) scale: f64,
    pub(crate) floor: bool,
    pub(crate) tolerance: Option<f64>,
}

/// A parameter and where it may be moved.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Slider {
    pub(crate) name: String,
    pub(crate) value: f64,
    pub(crate) min: f64,
    pub(crate) max: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct CameraOf {
    pub(crate) eye: [f64; 3],
    pub(crate) target: [f64; 3],
    pub(crate) angle: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct LightOf {
    pub(crate) center: [f64; 3],
    pub(crate) u: [f64; 3],
    pub(crate) v: [f64; 3],
}

/// A surface of the gallery.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Exhibit {
    pub(crate) name: String,
    pub(crate) title: String,
    pub(crate) author: Option<String>,
    pub(crate) year: Option<i32>,
    pub(crate) formula: String,
}

/// How far a render is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Report {
    pub(crate) done: bool,
    pub(crate) progress: f64,
    pub(crate) activity: &'static str,
    /// Seconds that the rest will take, roughly.
    pub(crate) remaining: Option<f64>,
    pub(crate) threads: usize,
    pub(crate) pixels: u64,
    pub(crate) proved_empty: u64,
    pub(crate) proved_hit: u64,
    pub(crate) proved_edge: u64,
    pub(crate) undecided: u64,
    /// Pairs of a hit and a light, and those whose bracket is as narrow as was asked for.
    pub(crate) brackets: u64,
    pub(crate) brackets_closed: u64,
    pub(crate) evaluations: u64,
    pub(crate) seconds: f64,
}

/// One line of a legend.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Line {
    pub(crate) color: [u8; 3],
    pub(crate) meaning: String,
    pub(crate) pixels: usize,
}

/// What is known of a pixel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Pixel {
    /// In words.
    pub(crate) verdict: String,
    pub(crate) code: u8,
    /// Enclosure of the hit: distance along the view axis.
    pub(crate) t: Option<[f64; 2]>,
    /// About where that is.
    pub(crate) point: Option<[f64; 3]>,
    pub(crate) normal: Option<[f32; 3]>,
    /// Bracket of the visible fraction of each light.
    pub(crate) visible: Vec<[f64; 2]>,
    pub(crate) coverage: [f64; 2],
    pub(crate) evaluations: u32,
}
