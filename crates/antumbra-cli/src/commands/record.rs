//! What a folder of planes shows: `frame.json` beside them.

use antumbra::{render::RenderSpec, scene::SceneFile};
use anyhow::Result;
use serde::{Deserialize, Serialize};

use crate::options::NamedScene;

/// Scene and options that a frame was made with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct FrameRecord {
    /// Of the program that wrote it.
    pub(super) version: String,
    /// A preset's name, a file or a formula, as it was asked for.
    pub(super) scene: String,
    /// The scene itself, as the text of a scene file.
    pub(super) scene_file: String,
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

    /// # Errors
    /// Where the scene cannot be written as text.
    pub(super) fn new(scene: &NamedScene, spec: &RenderSpec) -> Result<Self> {
        Ok(Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            scene: scene.name.clone(),
            scene_file: SceneFile::of(&scene.scene).text()?,
            width: spec.width,
            height: spec.height,
            method: spec.method.name().to_owned(),
            light_scale: spec.light_scale,
            floor: spec.floor,
            tolerance: spec.tolerance,
        })
    }
}
