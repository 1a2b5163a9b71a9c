//! What is to be drawn: objects, light, camera, colours; the presets and the gallery; and a framing for any formula.
mod about;
mod animation;
mod camera;
mod entry;
mod file;
mod form;
mod framing;
mod gallery;
mod light;
mod look;
mod object;
mod orbit;
mod parameter;
mod place;
mod presets;
mod union;

pub use about::About;
pub use animation::{Animation, Course, Motion};
pub use camera::View;
pub use entry::{CameraEntry, ClipEntry, ColorBy, FloorEntry, LightEntry, SurfaceEntry, TransformEntry};
pub use file::{FileError, Parameter, Ranged, SceneFile};
pub use framing::{Extent, extent};
pub use gallery::{GALLERY, GalleryEntry, file_named, named, names};
pub use light::Light;
pub use look::{Automatic, Backdrop, ColorMap, Coloring, Exposure, Field, Finish, Look, Output, Reflection, Sky, Tone};
pub use object::{Colors, Error, Object};
pub use orbit::Orbit;
pub use parameter::number;
pub use presets::{PRESETS, Preset, preset};

use crate::geom::{Box3, Clip};
use antumbra_interval::Interval;

/// A scene, complete and valid.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Short name, as typed.
    pub name: String,
    /// Name for people.
    pub title: String,
    /// Who found what it shows, where somebody has said so.
    pub about: Option<About>,
    /// The surfaces, never empty.
    pub objects: Vec<Object>,
    /// Where a floor would be, if one is asked for.
    pub floor_height: f64,
    /// Whether the scene asks for it.
    pub floor_shown: bool,
    /// Where the camera stands and how wide it sees.
    pub view: View,
    /// The area lights; none leaves only the fill light.
    pub lights: Vec<Light>,
    /// Soft light from everywhere.
    pub sky: Sky,
    /// What is behind everything.
    pub backdrop: Backdrop,
    /// From light to the picture.
    pub look: Look,
    /// Size and tolerance, where nobody says otherwise.
    pub output: Output,
}

impl Scene {
    /// A scene of one formula typed by a user: clip box, camera and light are chosen to fit it ([`extent`]).
    ///
    /// # Errors
    /// The formula's own errors, with the place in the text.
    pub fn from_formula(text: &str) -> Result<Self, Error> {
        let object = Object::parse(text, Clip::Everywhere)?;
        let found = extent(object.surface.as_ref());
        let object = object.with_clip(Clip::Box(found.clip()));
        Ok(framing::scene(text.trim().to_owned(), "Formula".to_owned(), vec![object]))
    }

    /// A scene around objects, at least one: camera and light are chosen to fit them.
    #[must_use]
    pub fn around(name: String, title: String, objects: Vec<Object>) -> Self {
        framing::scene(name, title, objects)
    }

    /// A scene of objects, at least one, with camera and light chosen to fit them.
    #[must_use]
    pub fn new(name: impl Into<String>, objects: Vec<Object>) -> Self {
        let name = name.into();
        framing::scene(name.clone(), name, objects)
    }

    /// Half the largest edge of the box that holds all objects: the scale of the scene.
    #[must_use]
    pub fn scale(&self) -> f64 {
        let hull = self.objects.iter().map(|o| o.clip().bounds()).reduce(Box3::hull);
        hull.map_or(1.0, |b| b.half_extent().0.into_iter().fold(0.0, f64::max))
    }

    /// The floor as a surface of its own: a square of [`FLOOR_REACH`](Self::FLOOR_REACH) scales around the scene's axis.
    ///
    /// # Errors
    /// None: the formula is `z - height`.
    pub fn floor(&self) -> Result<Object, Error> {
        let (reach, scale) = (Self::FLOOR_REACH, self.scale());
        let (h, wide) = (self.floor_height, Interval::new(-reach * scale, reach * scale));
        let clip = Clip::Box(Box3([wide, wide, Interval::new(h - scale, h + scale)]));
        // Written with the shortest decimal that reads back as this height: that decimal is the floor's exact height.
        Object::parse(&format!("z - ({h:?}) = 0"), clip)
    }

    /// How far the floor reaches, in scales of the scene.
    pub const FLOOR_REACH: f64 = 100.0;
}
