//! What is looked at, as plain data: the scene file, the edits, the way back. Knows no window and no thread.
mod document;
mod history;
mod slider;

pub use document::Document;
pub use history::History;
pub use slider::{Slider, sliders};

use crate::host::Found;
use antumbra::{
    geom::{Polar, Vec3},
    render::Method,
    scene::{ClipEntry, FloorEntry, LightEntry, Orbit, Output, Scene, SceneFile, View},
};
use std::sync::Arc;

/// The document, its history, and what has become of it.
#[derive(Debug)]
pub struct Model {
    document: Document,
    history: History<Document>,
    /// As it was opened.
    original: Document,
    /// Counts every change.
    revision: u64,
    /// The last scene that could be built, and the revision it is of.
    built: Option<(u64, Arc<Scene>)>,
    sliders: Vec<Slider>,
}

impl Model {
    /// A model of a scene that was found.
    #[must_use]
    pub fn new(found: Found) -> Self {
        let document = Document::new(found);
        let sliders = sliders(&document.file, &[]);
        Self { original: document.clone(), document, history: History::default(), revision: 1, built: None, sliders }
    }

    /// What is shown.
    #[must_use]
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// Number of the state: another one after every change.
    #[must_use]
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// The last scene that could be built.
    #[must_use]
    pub fn scene(&self) -> Option<&Arc<Scene>> {
        self.built.as_ref().map(|(_, scene)| scene)
    }

    /// The parameters that can be moved.
    #[must_use]
    pub fn sliders(&self) -> &[Slider] {
        &self.sliders
    }

    /// Tells that the scene of a revision was built.
    pub fn built(&mut self, revision: u64, scene: Arc<Scene>) {
        self.built = Some((revision, scene));
    }

    /// Looks at another scene; the way back stays.
    pub fn open(&mut self, found: Found) {
        let compared = (self.document.method, self.document.beside);
        self.edit("", |document| {
            *document = Document::new(found);
            (document.method, document.beside) = compared;
        });
        self.original = self.document.clone();
        self.built = None;
        self.history.close();
    }

    /// Writes another formula for a surface. Unless the scene is a file of the user's, everything is framed anew, seen from the same
    /// direction.
    pub fn set_formula(&mut self, surface: usize, text: &str) {
        let orbit = self.orbit();
        self.edit(&format!("formula {surface}"), |document| {
            let Some(entry) = document.file.surface.get_mut(surface) else { return };
            if entry.formula == text {
                return;
            }
            text.clone_into(&mut entry.formula);
            document.reframe(orbit);
        });
    }

    /// Moves a parameter. What was framed automatically stays where it is, so that only the surface moves.
    ///
    /// # Errors
    /// Why it cannot have that value; nothing is changed then.
    pub fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), String> {
        let mut file = self.document.file.clone();
        file.set(name, value).map_err(|e| e.to_string())?;
        let scene = self.scene().cloned();
        self.edit(&format!("parameter {name}"), |document| {
            document.file = file;
            document.hold(scene.as_deref());
        });
        Ok(())
    }

    /// How the camera stands; of the last scene that was built where the document leaves it to be chosen.
    #[must_use]
    pub fn orbit(&self) -> Option<Orbit> {
        let scene = self.scene()?;
        let view = match self.document.orbit {
            Some(orbit) => return Some(orbit),
            None => scene.view,
        };
        Some(Orbit::of(&view))
    }

    /// Moves the camera.
    pub fn move_camera(&mut self, to: impl FnOnce(Orbit) -> Orbit) {
        let Some(orbit) = self.orbit() else { return };
        let orbit = to(orbit);
        self.edit("camera", |document| {
            document.orbit = Some(orbit);
            document.file.camera = Some(orbit.entry());
        });
    }

    /// The camera as it was when the scene was opened.
    pub fn reset_camera(&mut self) {
        let Document { orbit, file: SceneFile { camera, .. }, .. } = self.original.clone();
        self.edit("", |document| {
            document.file.camera = camera;
            document.orbit = orbit;
            document.held = None;
        });
    }

    /// The camera in the same direction, so far away that everything is seen.
    pub fn fit_camera(&mut self) {
        let Some(orbit) = self.orbit() else { return };
        self.edit("", |document| {
            document.file.camera = Some(orbit.fitted());
            document.orbit = None;
            document.held = None;
        });
    }

    /// Cuts a surface: `None` lets the clip be chosen.
    pub fn set_clip(&mut self, surface: usize, clip: Option<ClipEntry>) {
        self.edit(&format!("clip {surface}"), |document| {
            if let Some(entry) = document.file.surface.get_mut(surface) {
                entry.clip = clip;
            }
            document.held = None;
        });
    }

    /// The lights, as entries of the file; those of the built scene where they are chosen.
    #[must_use]
    pub fn lights(&self) -> Vec<LightEntry> {
        match (&self.document.file.light, self.scene()) {
            (Some(lights), _) => lights.clone(),
            (None, Some(scene)) => SceneFile::of(scene).light.unwrap_or_default(),
            (None, None) => vec![],
        }
    }

    /// Changes a light.
    pub fn change_light(&mut self, light: usize, to: impl FnOnce(&mut LightEntry)) {
        let mut lights = self.lights();
        let Some(entry) = lights.get_mut(light) else { return };
        to(entry);
        self.edit(&format!("light {light}"), |document| document.file.light = Some(lights));
    }

    /// Where a light stands, seen from what the camera looks at.
    #[must_use]
    pub fn light_direction(&self, light: usize) -> Option<Polar> {
        let target = self.orbit()?.target;
        Some(Polar::of(Vec3(self.lights().get(light)?.center) - target))
    }

    /// Puts a light somewhere else around what the camera looks at.
    pub fn place_light(&mut self, light: usize, place: Polar) {
        let Some(orbit) = self.orbit() else { return };
        self.change_light(light, |entry| entry.center = (orbit.target + place.vector()).0);
    }

    /// Sets how wide brackets may be.
    pub fn set_tolerance(&mut self, tolerance: f64) {
        self.edit("tolerance", |document| {
            let output = document.file.output.unwrap_or_default();
            document.file.output = Some(Output { tolerance: Some(tolerance), ..output });
        });
    }

    /// Puts a floor under the surfaces, or takes it away.
    pub fn set_floor(&mut self, shown: bool) {
        let height = self.scene().map_or(-1.0, |scene| scene.floor_height);
        self.edit("", |document| document.file.floor = shown.then_some(FloorEntry { height }));
    }

    /// Chooses the method, and another one to be seen beside it.
    pub fn set_methods(&mut self, method: Method, beside: Option<Method>) {
        self.edit("", |document| (document.method, document.beside) = (method, beside));
    }

    /// Ends a gesture: the next change is a step of its own.
    pub fn settle(&mut self) {
        self.history.close();
    }

    /// Whether there is something to take back, and something to do again.
    #[must_use]
    pub fn ways(&self) -> [bool; 2] {
        self.history.ways()
    }

    /// Takes the last step back.
    pub fn undo(&mut self) {
        if let Some(document) = self.history.undo(&self.document) {
            self.replace(document);
        }
    }

    /// Does it again.
    pub fn redo(&mut self) {
        if let Some(document) = self.history.redo(&self.document) {
            self.replace(document);
        }
    }

    /// The view that is shown now, if a scene was built.
    #[must_use]
    pub fn view(&self) -> Option<View> {
        self.orbit().map(|orbit| orbit.view())
    }

    fn replace(&mut self, document: Document) {
        self.document = document;
        self.revision += 1;
        self.sliders = sliders(&self.document.file, &self.sliders);
    }

    /// A step: several of the same kind, one after another, are taken back together. An empty kind is always a step of its own.
    fn edit(&mut self, kind: &str, change: impl FnOnce(&mut Document)) {
        let mut document = self.document.clone();
        change(&mut document);
        if document == self.document {
            return;
        }
        let old = std::mem::replace(&mut self.document, document);
        let surfaces = self.document.file.surface != old.file.surface;
        if surfaces || self.document.file.parameters != old.file.parameters {
            self.sliders = sliders(&self.document.file, &self.sliders);
        }
        self.history.push(kind, old);
        self.revision += 1;
    }
}

#[cfg(test)]
mod tests;
