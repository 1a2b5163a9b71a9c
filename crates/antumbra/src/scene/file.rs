//! Scenes as text: TOML files, read with errors that name line and key, and written so that they can be read again.
use super::{About, Colors, Light, Object, Scene, View, extent, framing};
use crate::geom::{Box3, Clip, Rect, Vec3};
use antumbra_interval::Interval;
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
}

/// A number with a name.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
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

/// One surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SurfaceEntry {
    /// The formula, in the language of formulas; parameters of the scene may be used.
    pub formula: String,
    /// Where the surface ends; without it, a box that holds it or a good part of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clip: Option<ClipEntry>,
    /// Colour of the side on which f > 0, linear Rec. 709 components from 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outside: Option<[f64; 3]>,
    /// Colour of the other side.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inside: Option<[f64; 3]>,
}

/// A region: `box` (half sizes about the origin), `min` and `max`, or `ball` (a radius) and `center`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClipEntry {
    /// Half sizes of a box about the origin.
    #[serde(rename = "box", skip_serializing_if = "Option::is_none")]
    pub half: Option<[f64; 3]>,
    /// Lower corner of a box.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min: Option<[f64; 3]>,
    /// Upper corner of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max: Option<[f64; 3]>,
    /// Radius of a ball.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ball: Option<f64>,
    /// Its middle; by default the origin.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub center: Option<[f64; 3]>,
}

/// A rectangular light: its middle and either the `side` of a horizontal square or two half edges `u` and `v`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LightEntry {
    /// Its middle.
    pub center: [f64; 3],
    /// Side of a horizontal square.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub side: Option<f64>,
    /// Half of one edge.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub u: Option<[f64; 3]>,
    /// Half of the other.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub v: Option<[f64; 3]>,
    /// Its colour, linear Rec. 709; by default a warm white.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<[f64; 3]>,
    /// Factor on the colour; by default 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strength: Option<f64>,
}

/// A perspective camera; up is z.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraEntry {
    /// Where it stands.
    pub eye: [f64; 3],
    /// What it looks at; by default the origin.
    #[serde(default)]
    pub target: [f64; 3],
    /// Full angle over the shorter side of the picture, degrees.
    pub angle: f64,
}

/// A horizontal floor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FloorEntry {
    /// Its height.
    pub height: f64,
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
    },
}

fn value_error(key: impl Into<String>, reason: impl Into<String>) -> FileError {
    FileError::Value { key: key.into(), reason: reason.into() }
}

/// Numbers of a key that must all be finite.
fn finite(key: &str, numbers: &[f64]) -> Result<(), FileError> {
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
            if let Some(near) = suggestion(e.message()) {
                message = format!("{message}\ndid you mean `{near}`?");
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
            SurfaceEntry { formula: o.text.clone(), clip, outside: Some(outside), inside: Some(inside) }
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
            camera: Some(CameraEntry { eye: eye.0, target: target.0, angle: fov_deg }),
            floor: scene.floor_shown.then_some(FloorEntry { height: scene.floor_height }),
        }
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
        let object = |(k, entry): (usize, &SurfaceEntry)| {
            let key = |part: &str| format!("surface[{}].{part}", k + 1);
            let text = format!("{definitions}{}", entry.formula);
            let clip = entry.clip.map(|c| c.clip(&key("clip"))).transpose()?;
            let object = Object::parse(&text, Clip::Everywhere).map_err(|e| FileError::Formula {
                key: key("formula"),
                message: match &e {
                    super::Error::Formula(e) => e.render(&text),
                    super::Error::Tape(e) => e.to_string(),
                },
            })?;
            let clip = clip.unwrap_or_else(|| Clip::Box(extent(object.surface.as_ref()).clip()));
            let mut object = object.with_clip(clip);
            for (part, given, color) in [
                ("outside", entry.outside, &mut object.colors.outside),
                ("inside", entry.inside, &mut object.colors.inside),
            ] {
                if let Some(given) = given {
                    if !given.iter().all(|c| (0.0..=1.0).contains(c)) {
                        return Err(value_error(key(part), "a colour has three components from 0 to 1"));
                    }
                    *color = given;
                }
            }
            Ok(object)
        };
        let objects = self.surface.iter().enumerate().map(object).collect::<Result<Vec<_>, _>>()?;
        let title = self.title.clone().unwrap_or_else(|| name.to_owned());
        let mut scene = framing::scene(name.to_owned(), title, objects);
        scene.about = self.about.clone();
        if let Some(camera) = self.camera {
            scene.view = camera.view()?;
        }
        if let Some(lights) = &self.light {
            let light = |(k, entry): (usize, &LightEntry)| entry.light(&format!("light[{}]", k + 1));
            scene.lights = lights.iter().enumerate().map(light).collect::<Result<_, _>>()?;
        }
        if let Some(FloorEntry { height }) = self.floor {
            finite("floor.height", &[height])?;
            (scene.floor_height, scene.floor_shown) = (height, true);
        }
        Ok(scene)
    }
}

impl ClipEntry {
    fn clip(&self, key: &str) -> Result<Clip, FileError> {
        let Self { half, min, max, ball, center } = *self;
        let corners = match (half, min, max, ball) {
            (Some(half), None, None, None) if center.is_none() => [half.map(|h| -h), half],
            (None, Some(min), Some(max), None) if center.is_none() => [min, max],
            (None, None, None, Some(radius)) => {
                let center = center.unwrap_or_default();
                finite(key, &[radius, center[0], center[1], center[2]])?;
                if radius <= 0.0 {
                    return Err(value_error(format!("{key}.ball"), "the radius must be greater than 0"));
                }
                return Ok(Clip::Ball { center: Vec3(center), radius });
            }
            _ => {
                let reason =
                    "give either `box` (half sizes), `min` and `max`, or `ball` (a radius) with or without `center`";
                return Err(value_error(key, reason));
            }
        };
        let mut sides = [Interval::ZERO; 3];
        for k in 0..3 {
            let (lo, hi) = (corners[0][k], corners[1][k]);
            finite(key, &[lo, hi])?;
            if lo >= hi {
                return Err(value_error(key, format!("the box is empty: from {lo} to {hi} along axis {}", k + 1)));
            }
            sides[k] = Interval::new(lo, hi);
        }
        Ok(Clip::Box(Box3(sides)))
    }
}

impl CameraEntry {
    fn view(&self) -> Result<View, FileError> {
        let Self { eye, target, angle } = *self;
        finite("camera", &[eye, target].concat())?;
        if eye == target {
            return Err(value_error("camera", "eye and target are the same point"));
        }
        if !(0.01..=170.0).contains(&angle) {
            return Err(value_error("camera.angle", format!("must be from 0.01 to 170 degrees, not {angle}")));
        }
        Ok(View { eye: Vec3(eye), target: Vec3(target), fov_deg: angle })
    }
}

impl LightEntry {
    fn light(&self, key: &str) -> Result<Light, FileError> {
        let center = Vec3(self.center);
        finite(key, &self.center)?;
        let rect = match (self.side, self.u, self.v) {
            (Some(side), None, None) => {
                if !(side > 0.0 && side <= 1e150) {
                    return Err(value_error(format!("{key}.side"), "must be greater than 0"));
                }
                Rect::horizontal(center, side)
            }
            (None, Some(u), Some(v)) => {
                finite(key, &[u, v].concat())?;
                if Vec3(u).cross(Vec3(v)) == Vec3::default() {
                    return Err(value_error(key, "`u` and `v` span no rectangle"));
                }
                Rect { center, edge_u: Vec3(u), edge_v: Vec3(v) }
            }
            _ => return Err(value_error(key, "give either `side` (a horizontal square) or `u` and `v` (half edges)")),
        };
        let strength = self.strength.unwrap_or(1.0);
        let color = self.color.unwrap_or(Light::WHITE).map(|c| c * strength);
        if !color.iter().all(|c| (0.0..=1e6).contains(c)) {
            return Err(value_error(key, "colour and strength must not be negative (and at most 1e6)"));
        }
        Ok(Light { rect, color })
    }
}

/// The known key that is nearest to an unknown one, out of TOML's message.
fn suggestion(message: &str) -> Option<String> {
    let mut names = message.strip_prefix("unknown field ")?.split('`').skip(1).step_by(2);
    let unknown = names.next()?;
    let near = |name: &&str| strsim::damerau_levenshtein(unknown, name);
    names.min_by_key(near).filter(|name| near(name) <= 1 + unknown.len() / 3).map(str::to_owned)
}
