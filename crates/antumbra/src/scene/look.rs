//! How things look. Nothing here is certified, and nothing here changes what is.
use crate::eval::Inclusion;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::Arc;

/// How a surface throws back light, beside its colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Finish {
    /// No highlight.
    Matte,
    /// A soft one.
    #[default]
    Satin,
    /// A small bright one.
    Gloss,
    /// A highlight of the surface's own colour, and little else.
    Metal,
}

/// Numbers of a [`Finish`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reflection {
    /// Factor on the diffuse light.
    pub diffuse: f64,
    /// Strength of the highlight.
    pub strength: f64,
    /// Its exponent (Blinn and Phong).
    pub exponent: u32,
    /// Share of the surface's colour in the highlight's.
    pub tint: f64,
}

impl Finish {
    /// Every finish and its name.
    pub const ALL: [(Self, &'static str); 4] =
        [(Self::Matte, "matte"), (Self::Satin, "satin"), (Self::Gloss, "gloss"), (Self::Metal, "metal")];

    /// Its numbers.
    #[must_use]
    pub fn reflection(self) -> Reflection {
        let of = |diffuse, strength, exponent, tint| Reflection { diffuse, strength, exponent, tint };
        match self {
            Self::Matte => of(1.0, 0.0, 1, 0.0),
            Self::Satin => of(1.0, 0.22, 48, 0.0),
            Self::Gloss => of(0.95, 0.55, 220, 0.0),
            Self::Metal => of(0.55, 1.1, 36, 1.0),
        }
    }
}

/// What decides the colour of a point of a surface.
#[derive(Clone, Default)]
pub enum Coloring {
    /// The side that is seen.
    #[default]
    Sides,
    /// The direction of the gradient: x, y, z as red, green, blue.
    Normal,
    /// The mean curvature times the scene's scale: blue where it is a valley seen from outside, red where it is a hill.
    Curvature,
    /// The value of another function.
    Field(Field, Arc<dyn Inclusion>),
}

impl fmt::Debug for Coloring {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sides => f.write_str("Sides"),
            Self::Normal => f.write_str("Normal"),
            Self::Curvature => f.write_str("Curvature"),
            Self::Field(field, _) => field.fmt(f),
        }
    }
}

/// A function as a colour.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Field {
    /// The function, an expression in x, y and z.
    pub formula: String,
    /// The value at the map's beginning.
    pub from: f64,
    /// The value at its end.
    pub to: f64,
    /// The map.
    #[serde(default)]
    pub map: ColorMap,
}

/// A map from [0, 1] to colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ColorMap {
    /// From violet to yellow, of even steps for every eye.
    #[default]
    Viridis,
    /// From black to cream.
    Magma,
    /// From blue to red through all colours.
    Turbo,
    /// From red to blue through white.
    Diverging,
    /// A closed circle of colours.
    Cyclic,
}

impl ColorMap {
    /// The colour at `x` (cut to [0, 1]), linear Rec. 709.
    #[must_use]
    pub fn color(self, x: f64) -> [f64; 3] {
        let gradient = match self {
            Self::Viridis => colorous::VIRIDIS,
            Self::Magma => colorous::MAGMA,
            Self::Turbo => colorous::TURBO,
            Self::Diverging => colorous::RED_BLUE,
            Self::Cyclic => colorous::SINEBOW,
        };
        let x = if x.is_nan() { 0.5 } else { x.clamp(0.0, 1.0) };
        let color = gradient.eval_continuous(x);
        [color.r, color.g, color.b].map(|code| linear(f64::from(code) / 255.0))
    }
}

/// Linear light of a code of sRGB.
fn linear(code: f64) -> f64 {
    if code <= 0.040_45 { code / 12.92 } else { core_math::pow((code + 0.055) / 1.055, 2.4) }
}

/// Soft light from everywhere: of a horizontal surface from above, of one that looks down from below.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Sky {
    /// From above, linear Rec. 709.
    pub above: [f64; 3],
    /// From below.
    pub below: [f64; 3],
}

impl Default for Sky {
    fn default() -> Self {
        Self { above: [0.20, 0.23, 0.28], below: [0.10, 0.09, 0.085] }
    }
}

/// What is behind everything.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Backdrop {
    /// Its colour in the middle, linear Rec. 709.
    pub color: [f64; 3],
    /// How much darker the corners are: 0 not at all, 1 the usual.
    pub falloff: f64,
}

impl Default for Backdrop {
    fn default() -> Self {
        Self { color: [0.60, 0.63, 0.67], falloff: 1.0 }
    }
}

/// From light to the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Look {
    /// What becomes of light that is brighter than white.
    pub tone: Tone,
    /// Brightness.
    pub exposure: Exposure,
    /// Whether dark lines are drawn where the surface ends or bends sharply.
    pub outline: bool,
}

/// What becomes of light that is brighter than white.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Tone {
    /// The brightest is pressed together and keeps its hue; all else stays.
    #[default]
    Soft,
    /// It is cut.
    Plain,
    /// Everything is bent as film does: deeper shades, highlights that fade to white.
    Filmic,
}

impl Tone {
    /// Every tone and its name.
    pub const ALL: [(Self, &'static str); 3] = [(Self::Soft, "soft"), (Self::Plain, "plain"), (Self::Filmic, "filmic")];
}

/// Brightness of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "the exposure is a number of stops, or \"auto\"")]
pub enum Exposure {
    /// So many times twice as bright.
    Stops(f64),
    /// Chosen so that the brightest part of what is met is nearly white.
    Auto(Automatic),
}

/// The word for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Automatic {
    /// `"auto"`.
    Auto,
}

impl Exposure {
    /// Chosen from the picture.
    pub const AUTO: Self = Self::Auto(Automatic::Auto);
    /// Most stops, up or down.
    pub const MOST: f64 = 20.0;
}

impl Default for Exposure {
    fn default() -> Self {
        Self::Stops(0.0)
    }
}

/// What a scene wants of its picture, where nobody says otherwise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Output {
    /// Width and height in pixels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size: Option<[usize; 2]>,
    /// Width of a bracket of the visible fraction that is narrow enough.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
}
