//! A scene file and how it is drawn.
use crate::host::Found;
use antumbra::{
    render::{Method, RenderSpec},
    scene::{CameraEntry, ClipEntry, LightEntry, Orbit, Scene, SceneFile},
};

/// Everything that one can take back.
#[derive(Clone, Debug, PartialEq)]
pub struct Document {
    /// What it is called.
    pub name: String,
    /// The scene; what is left out is chosen when it is built.
    pub file: SceneFile,
    /// How shadows are found.
    pub method: Method,
    /// The method that is seen beside it, if one is.
    pub beside: Option<Method>,
    /// The camera where a hand has moved it: what the file says, before rounding.
    pub(super) orbit: Option<Orbit>,
    /// What was chosen, kept while parameters move.
    pub(super) held: Option<Box<Held>>,
    own: bool,
}

/// What the building of a scene has chosen.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Held {
    camera: Option<CameraEntry>,
    light: Option<Vec<LightEntry>>,
    clips: Vec<Option<ClipEntry>>,
}

impl Document {
    /// That of a scene that was found.
    #[must_use]
    pub fn new(found: Found) -> Self {
        let Found { name, file, own } = found;
        let method = RenderSpec::default().method;
        Self { name, file, own, method, beside: None, orbit: None, held: None }
    }

    /// The file as it is drawn and saved: with what is held.
    #[must_use]
    pub fn complete(&self) -> SceneFile {
        let mut file = self.file.clone();
        if let Some(held) = &self.held {
            file.camera = file.camera.or(held.camera);
            file.light = file.light.or_else(|| held.light.clone());
            for (entry, clip) in file.surface.iter_mut().zip(&held.clips) {
                entry.clip = entry.clip.or(*clip);
            }
        }
        file
    }

    /// How wide brackets may be.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        self.file.output.and_then(|o| o.tolerance).unwrap_or(RenderSpec::default().tolerance)
    }

    /// The methods that are drawn, one or two.
    #[must_use]
    pub fn methods(&self) -> Vec<Method> {
        std::iter::once(self.method).chain(self.beside).collect()
    }

    /// Keeps what was chosen for a scene of this document, unless that was done before.
    pub(super) fn hold(&mut self, scene: Option<&Scene>) {
        let Some(scene) = scene.filter(|scene| scene.objects.len() == self.file.surface.len()) else { return };
        if self.held.is_none() {
            let SceneFile { camera, light, surface, .. } = SceneFile::of(scene);
            self.held = Some(Box::new(Held { camera, light, clips: surface.into_iter().map(|s| s.clip).collect() }));
        }
    }

    /// Lets everything be framed anew, seen from where the camera stands. A scene of the user's own keeps what is written in it.
    pub(super) fn reframe(&mut self, orbit: Option<Orbit>) {
        self.held = None;
        if self.own {
            return;
        }
        let automatic = self.file.camera.is_none();
        self.file.camera = if automatic { None } else { orbit.map(|orbit| orbit.fitted()) };
        self.orbit = None;
        (self.file.light, self.file.about) = (None, None);
        if self.file.surface.len() == 1 {
            self.file.surface[0].clip = None;
            self.file.title = Some("Formula".to_owned());
            "formula".clone_into(&mut self.name);
        }
        // A floor is put where the new surface wants it.
        self.file.floor = None;
    }
}
