//! What the page asks for.
use serde::Deserialize;
use std::collections::BTreeMap;

/// A picture to be drawn.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Request {
    /// Name of a preset or of a surface of the gallery, or a formula.
    pub scene: String,
    /// Parameters that have another value than the scene gives them.
    #[serde(default)]
    pub set: BTreeMap<String, f64>,
    /// Another camera than the scene's.
    #[serde(default)]
    pub camera: Option<CameraRequest>,
    /// Another place and size of the first light.
    #[serde(default)]
    pub light: Option<LightRequest>,
    /// Whether the floor is there; by default as the scene says.
    #[serde(default)]
    pub floor: Option<bool>,
    /// Pixels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Width of a bracket that is narrow enough.
    #[serde(default)]
    pub tolerance: Option<f64>,
    /// Rectangles of the light that one hit may take.
    #[serde(default)]
    pub rectangles: Option<u32>,
    /// Only part `[number, of]` of the picture: others draw the others.
    #[serde(default)]
    pub part: Option<[usize; 2]>,
}

/// A camera, as the view of a scene has it.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraRequest {
    /// Where it stands.
    pub eye: [f64; 3],
    /// What it looks at.
    pub target: [f64; 3],
    /// Full angle over the shorter side of the picture, degrees.
    pub angle: f64,
}

/// A light moved and scaled: its edges keep their directions.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LightRequest {
    /// Its middle.
    pub center: [f64; 3],
    /// Factor on its edges.
    pub scale: f64,
}
