//! What a folder of planes shows: `frame.json` beside them.

use antumbra::render::RenderSpec;
use serde::{Deserialize, Serialize};

/// Scene and options that a frame was made with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct FrameRecord {
    /// Of the program that wrote it.
    pub(super) version: String,
    /// A preset's name or a formula.
    pub(super) scene: String,
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) method: String,
    pub(super) light_scale: f64,
    pub(super) floor: bool,
    pub(super) tolerance: f64,
}

impl FrameRecord {
    /// Its name in the folder.
    pub(super) const FILE: &str = "frame.json";

    pub(super) fn new(scene: &str, spec: &RenderSpec) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            scene: scene.to_owned(),
            width: spec.width,
            height: spec.height,
            method: spec.method.name().to_owned(),
            light_scale: spec.light_scale,
            floor: spec.floor,
            tolerance: spec.tolerance,
        }
    }
}
