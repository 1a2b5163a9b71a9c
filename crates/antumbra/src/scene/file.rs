//! Scenes as text: TOML files, read with errors that name line and key, and written so that they can be read again.
use super::entry::{CameraEntry, ClipEntry, ColorBy, FloorEntry, LightEntry, SurfaceEntry};
use super::place::advice;
use super::{About, Backdrop, Colors, Exposure, Light, Look, Object, Output, Scene, Sky, View, framing};
use crate::expr::is_name;
use crate::geom::Clip;
use crate::image::check_size;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::ops::Range;

/// A scene file as it is written. Everything but the surfaces may be left out.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// Name for people.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// Who found the surface, when, and why one looks at it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub about: Option<About>,
    /// Numbers that formulas may use by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub parameters: BTreeMap<String, Parameter>,
    /// The surfaces, at least one.
    pub surface: Vec<SurfaceEntry>,
    /// The lights; without the key, one that suits the surfaces. An empty list leaves only the fill light.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light: Option<Vec<LightEntry>>,
    /// The camera; without it, one that sees all surfaces.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub camera: Option<CameraEntry>,
    /// A floor under the surfaces.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub floor: Option<FloorEntry>,
    /// Soft light from everywhere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sky: Option<Sky>,
    /// What is behind everything.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub backdrop: Option<Backdrop>,
    /// From light to the picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub look: Option<Look>,
    /// Size and tolerance, where the command line does not say otherwise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub output: Option<Output>,
}

/// A number with a name.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "a parameter is a number, or { value = .., min = .., max = .. }")]
pub enum Parameter {
    /// Its value; a decimal is meant exactly.
    Value(f64),
    /// Its value, and where it may be moved.
    Ranged(Ranged),
}

/// A number and its range.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ranged {
    /// The value.
    pub value: f64,
    /// Least value.
    pub min: f64,
    /// Greatest value.
    pub max: f64,
}

impl Parameter {
    /// Its value.
    #[must_use]
    pub fn value(self) -> f64 {
        match self {
            Self::Value(value) | Self::Ranged(Ranged { value, .. }) => value,
        }
    }
}

/// Why a scene file is refused.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The text is not TOML, or has unknown or missing keys, or values of the wrong kind.
    #[error("{message}")]
    Shape {
        /// What is wrong, with line, column and an excerpt.
        message: String,
        /// Place in the text, in bytes, where known.
        span: Option<Range<usize>>,
    },
    /// A value that cannot be.
    #[error("{key}: {reason}")]
    Value {
        /// The key, such as `light[2].side`; lists count from 1.
        key: String,
        /// What is wrong, and what could stand there.
        reason: String,
    },
    /// A formula that is none.
    #[error("{key}: {message}")]
    Formula {
        /// The key, such as `surface[1].formula`.
        key: String,
        /// The formula's error, with its excerpt.
        message: String,
        /// Its place in the text at the key, in bytes, where known.
        place: Option<Range<usize>>,
    },
}

pub(super) fn value_error(key: impl Into<String>, reason: impl Into<String>) -> FileError {
    FileError::Value { key: key.into(), reason: reason.into() }
}

/// Numbers of a key that must all be finite.
pub(super) fn finite(key: &str, numbers: &[f64]) -> Result<(), FileError> {
    if numbers.iter().all(|x| x.abs() <= 1e150) {
        return Ok(());
    }
    Err(value_error(key, "a number is infinite, too large or not a number"))
}

impl SceneFile {
    /// Reads the text of a scene file.
    ///
    /// # Errors
    /// [`FileError::Shape`], with a suggestion where a key is misspelt.
    pub fn parse(text: &str) -> Result<Self, FileError> {
        toml::from_str(text).map_err(|e| {
            let mut message = e.to_string().trim_end().to_owned();
            if let Some(advice) = advice(e.message(), text, e.span()) {
                message = format!("{message}\n{advice}");
            }
            FileError::Shape { message, span: e.span() }
        })
    }

    /// The file that describes a scene.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let surface = |o: &Object| {
            let clip = match o.clip() {
                Clip::Everywhere => None,
                Clip::Box(b) => Some(ClipEntry {
                    min: Some(b.0.map(|x| x.lo())),
                    max: Some(b.0.map(|x| x.hi())),
                    ..ClipEntry::default()
                }),
                Clip::Ball { center, radius } => {
                    Some(ClipEntry { ball: Some(radius), center: Some(center.0), ..ClipEntry::default() })
                }
            };
            let Colors { outside, inside } = o.colors;
            let (color_by, field) = ColorBy::of(&o.coloring);
            SurfaceEntry {
                formula: o.text.clone(),
                clip,
                outside: Some(outside),
                inside: Some(inside),
                finish: Some(o.finish),
                color_by,
                field,
                ..SurfaceEntry::default()
            }
        };
        let light = |l: &Light| LightEntry {
            center: l.rect.center.0,
            side: None,
            u: Some(l.rect.edge_u.0),
            v: Some(l.rect.edge_v.0),
            color: Some(l.color),
            strength: None,
        };
        let View { eye, target, fov_deg } = scene.view;
        Self {
            title: Some(scene.title.clone()),
            about: scene.about.clone(),
            parameters: BTreeMap::new(),
            surface: scene.objects.iter().map(surface).collect(),
            light: Some(scene.lights.iter().map(light).collect()),
            camera: Some(CameraEntry {
                eye: Some(eye.0),
                target: Some(target.0),
                angle: Some(fov_deg),
                ..CameraEntry::default()
            }),
            floor: scene.floor_shown.then_some(FloorEntry { height: scene.floor_height }),
            sky: Some(scene.sky),
            backdrop: Some(scene.backdrop),
            look: Some(scene.look),
            output: (scene.output != Output::default()).then_some(scene.output),
        }
    }

    /// The same file with everything filled in that was left out. Parameters stay parameters, formulas and clips as they are
    /// written. What it prints is the same scene.
    ///
    /// # Errors
    /// Those of [`SceneFile::scene`].
    pub fn completed(&self, name: &str) -> Result<Self, FileError> {
        let mut full = Self::of(&self.scene(name)?);
        full.parameters.clone_from(&self.parameters);
        for (entry, own) in full.surface.iter_mut().zip(&self.surface) {
            *entry = SurfaceEntry {
                formula: own.formula.clone(),
                clip: own.clip.or(entry.clip),
                field: own.field.clone(),
                transform: own.transform,
                caps: own.caps,
                ..entry.clone()
            };
        }
        Ok(full)
    }

    /// The text of the file; [`SceneFile::parse`] reads it back.
    ///
    /// # Errors
    /// [`FileError::Shape`] where TOML has no way to write it, which no scene is known to cause.
    pub fn text(&self) -> Result<String, FileError> {
        toml::to_string(self).map_err(|e| FileError::Shape { message: e.to_string(), span: None })
    }

    /// Gives a parameter, or else a number that formulas define (`a = 0.05;`), another value.
    ///
    /// # Errors
    /// [`FileError::Value`] where there is none of that name, or the value is outside its range.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), FileError> {
        finite(&format!("parameters.{name}"), &[value])?;
        match self.parameters.get_mut(name) {
            None => self.redefine(name, value)?,
            Some(Parameter::Value(v) | Parameter::Ranged(Ranged { value: v, .. })) => *v = value,
        }
        self.check_parameters()
    }

    fn check_parameters(&self) -> Result<(), FileError> {
        for (name, parameter) in &self.parameters {
            let key = format!("parameters.{name}");
            if !is_name(name) {
                return Err(value_error(key, "a name is made of letters, digits and _, and begins with no digit"));
            }
            finite(&key, &[parameter.value()])?;
            if let Parameter::Ranged(Ranged { value, min, max }) = *parameter {
                finite(&key, &[min, max])?;
                if !(min <= value && value <= max) {
                    return Err(value_error(key, format!("{value} is not between {min} and {max}")));
                }
            }
        }
        Ok(())
    }

    /// The scene, complete and valid.
    ///
    /// # Errors
    /// [`FileError::Value`] and [`FileError::Formula`], with the key.
    pub fn scene(&self, name: &str) -> Result<Scene, FileError> {
        self.check_parameters()?;
        if self.surface.is_empty() {
            return Err(value_error("surface", "there is none; begin one with [[surface]]"));
        }
        // On the formula's own line, so that its errors count lines as the file's string does.
        let definitions: String =
            self.parameters.iter().map(|(name, p)| format!("{name} = ({:?}); ", p.value())).collect();
        let object = |(k, entry): (usize, &SurfaceEntry)| entry.object(&format!("surface[{}]", k + 1), &definitions);
        let objects = self.surface.iter().enumerate().map(object).collect::<Result<Vec<_>, _>>()?;
        self.staged(name, objects)
    }

    /// The scene around the surfaces of another one, whose file has the same surfaces and parameters: everything that takes long
    /// is there already.
    ///
    /// # Errors
    /// [`FileError::Value`], with the key; also where the number of surfaces differs.
    pub fn scene_like(&self, built: &Scene) -> Result<Scene, FileError> {
        if self.surface.len() != built.objects.len() {
            return Err(value_error("surface", "the other scene has another number of them"));
        }
        self.staged(&built.name, built.objects.clone())
    }

    /// Light, camera and looks around surfaces.
    fn staged(&self, name: &str, objects: Vec<Object>) -> Result<Scene, FileError> {
        let title = self.title.clone().unwrap_or_else(|| name.to_owned());
        let mut scene = framing::scene(name.to_owned(), title, objects);
        scene.about = self.about.clone();
        if let Some(camera) = self.camera {
            scene.view = camera.view(&framing::Stage::of(&scene.objects))?;
        }
        if let Some(lights) = &self.light {
            let light = |(k, entry): (usize, &LightEntry)| entry.light(&format!("light[{}]", k + 1));
            scene.lights = lights.iter().enumerate().map(light).collect::<Result<_, _>>()?;
        }
        if let Some(FloorEntry { height }) = self.floor {
            finite("floor.height", &[height])?;
            (scene.floor_height, scene.floor_shown) = (height, true);
        }
        scene.sky = self.sky.unwrap_or_default();
        scene.backdrop = self.backdrop.unwrap_or_default();
        scene.look = self.look.unwrap_or_default();
        scene.output = self.output.unwrap_or_default();
        check_look(&scene)?;
        Ok(scene)
    }
}

/// Whether colours and numbers that only the eye sees are such.
fn check_look(scene: &Scene) -> Result<(), FileError> {
    let colors =
        [("sky.above", scene.sky.above), ("sky.below", scene.sky.below), ("backdrop.color", scene.backdrop.color)];
    for (key, color) in colors {
        if !color.iter().all(|c| (0.0..=1e6).contains(c)) {
            return Err(value_error(key, "a colour has three components, none of them negative"));
        }
    }
    if !(0.0..=100.0).contains(&scene.backdrop.falloff) {
        return Err(value_error("backdrop.falloff", "must be from 0 (even) to 100; 1 is the usual"));
    }
    if let Exposure::Stops(stops) = scene.look.exposure
        && (stops.is_nan() || stops.abs() > Exposure::MOST)
    {
        return Err(value_error(
            "look.exposure",
            format!("must be \"auto\" or from -{0} to {0} stops", Exposure::MOST),
        ));
    }
    if let Some(size) = scene.output.size {
        check_size(size).map_err(|e| value_error("output.size", e.to_string()))?;
    }
    if let Some(tolerance) = scene.output.tolerance
        && !(1e-9..=1.0).contains(&tolerance)
    {
        return Err(value_error("output.tolerance", "must be from 1e-9 to 1"));
    }
    Ok(())
}
