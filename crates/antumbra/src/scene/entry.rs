//! The tables of a scene file, and what they mean.
use super::file::{FileError, finite, value_error};
use super::{Coloring, Error, Field, Finish, Light, Object, extent};
use crate::expr::{self, Formula};
use crate::geom::{Box3, Clip, Rect, Vec3};
use crate::tape::Tape;
use antumbra_interval::Interval;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

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
    /// How it throws back light.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub finish: Option<Finish>,
    /// What decides its colour, if not its sides or a field.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color_by: Option<ColorBy>,
    /// Another function whose values are its colours.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub field: Option<Field>,
    /// Moves, turns and scales the surface; the clip stays where it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub transform: Option<TransformEntry>,
    /// Whether the solid inside (where the formula is negative) is closed where the clip cuts it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub caps: Option<bool>,
}

/// What decides the colour of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ColorBy {
    /// The side that is seen.
    Sides,
    /// The direction of the gradient.
    Normal,
    /// The mean curvature.
    Curvature,
}

impl ColorBy {
    /// Every choice and its name.
    pub const ALL: [(Self, &'static str); 3] =
        [(Self::Sides, "sides"), (Self::Normal, "normal"), (Self::Curvature, "curvature")];

    /// As a colouring.
    #[must_use]
    pub fn coloring(self) -> Coloring {
        match self {
            Self::Sides => Coloring::Sides,
            Self::Normal => Coloring::Normal,
            Self::Curvature => Coloring::Curvature,
        }
    }

    pub(super) fn of(coloring: &Coloring) -> (Option<Self>, Option<Field>) {
        match coloring {
            Coloring::Sides => (None, None),
            Coloring::Normal => (Some(Self::Normal), None),
            Coloring::Curvature => (Some(Self::Curvature), None),
            Coloring::Field(field, _) => (None, Some(field.clone())),
        }
    }
}

/// A similarity: scaled first, then turned about x, y and z, then moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TransformEntry {
    /// Factor on the size.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
    /// Angles about the axes, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotate: Option<[f64; 3]>,
    /// By how much it is moved.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub translate: Option<[f64; 3]>,
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

/// A camera; up is z. What is left out is chosen so that everything is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraEntry {
    /// Where it stands.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub eye: Option<[f64; 3]>,
    /// Instead of `eye`: the direction in which it stands, seen from the target; how far is chosen.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from: Option<[f64; 3]>,
    /// What it looks at; by default the origin, or the middle of everything if `eye` is left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<[f64; 3]>,
    /// Full angle over the shorter side of the picture, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle: Option<f64>,
    /// Whether parallel lines stay parallel: see [`View::orthographic`](super::View::orthographic).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub orthographic: Option<bool>,
    /// Of an orthographic camera: the length that the shorter side of the picture shows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub width: Option<f64>,
}

/// A horizontal floor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FloorEntry {
    /// Its height.
    pub height: f64,
}

impl SurfaceEntry {
    /// The surface, with the scene's parameters defined before its formula.
    pub(super) fn object(&self, key: &str, definitions: &str) -> Result<Object, FileError> {
        let named = |part: &str| format!("{key}.{part}");
        // Said of what was written: without the definitions that stand before it here.
        let formula_error = |part: &str, text: &str, own: &str, e: &Error| {
            let shift = |e: &expr::Error| text.strip_suffix(own).map(str::len).filter(|shift| e.span().start >= *shift);
            let (message, place) = match e {
                Error::Formula(e) => match shift(e) {
                    Some(shift) => {
                        let place = e.span().start - shift..e.span().end - shift;
                        (e.clone().moved(own, place.clone()).render(own), Some(place))
                    }
                    None => (e.render(text), None),
                },
                Error::Tape(e) => (e.to_string(), None),
            };
            FileError::Formula { key: named(part), message, place }
        };
        let written = format!("{definitions}{}", self.formula);
        // First as it is, so that an error speaks of what was written.
        let plain = Object::parse(&written, Clip::Everywhere)
            .map_err(|e| formula_error("formula", &written, &self.formula, &e))?;
        let clip = self.clip.map(|c| c.clip(&named("clip"))).transpose()?;
        let text = self.composed(&written, clip.as_ref(), &named)?;
        let object = if text == written { Ok(plain) } else { Object::parse(&text, Clip::Everywhere) };
        let object = object.map_err(|e| formula_error("formula", &text, &text, &e))?;
        let clip = match clip {
            // What closes the solid must not be cut off.
            Some(clip) if self.caps == Some(true) => Clip::Box(roomy(&clip.bounds())),
            Some(clip) => clip,
            None => Clip::Box(extent(object.surface.as_ref()).clip()),
        };
        let mut object = object.with_clip(clip);
        let sides =
            [("outside", self.outside, &mut object.colors.outside), ("inside", self.inside, &mut object.colors.inside)];
        for (part, given, color) in sides {
            if let Some(given) = given {
                if !given.iter().all(|c| (0.0..=1.0).contains(c)) {
                    return Err(value_error(named(part), "a colour has three components from 0 to 1"));
                }
                *color = given;
            }
        }
        object.finish = self.finish.unwrap_or_default();
        object.coloring = match (self.color_by, &self.field) {
            (None, None) => Coloring::Sides,
            (Some(by), None) => by.coloring(),
            (Some(_), Some(_)) => return Err(value_error(key, "give either `color_by` or `field`")),
            (None, Some(field)) => {
                finite(&named("field"), &[field.from, field.to])?;
                if field.from == field.to {
                    return Err(value_error(named("field"), "`from` and `to` are the same value"));
                }
                let text = format!("{definitions}{}", field.formula);
                let error = |e: &Error| formula_error("field.formula", &text, &field.formula, e);
                let formula = Formula::parse(&text).map_err(|e| error(&e.into()))?;
                let tape = Tape::compile(&formula).map_err(|e| error(&e.into()))?;
                // Complete in itself: whoever prints the scene prints no parameters.
                Coloring::Field(Field { formula: text, ..field.clone() }, Arc::new(tape))
            }
        };
        Ok(object)
    }

    /// The formula with transform and caps.
    fn composed(&self, text: &str, clip: Option<&Clip>, named: &dyn Fn(&str) -> String) -> Result<String, FileError> {
        let caps = self.caps == Some(true);
        if self.transform.is_none() && !caps {
            return Ok(text.to_owned());
        }
        let [definitions, mut solid] = Formula::split(text).map_err(|e| FileError::Formula {
            key: named("formula"),
            message: e.render(text),
            place: None,
        })?;
        if let Some(TransformEntry { scale, rotate, translate }) = self.transform {
            if let Some(s) = scale {
                finite(&named("transform.scale"), &[s])?;
                if s <= 0.0 {
                    return Err(value_error(named("transform.scale"), "must be greater than 0"));
                }
                solid = format!("scale({solid}, {s:?})");
            }
            for (name, numbers) in [("rotate", rotate), ("translate", translate)] {
                if let Some([a, b, c]) = numbers {
                    finite(&named(&format!("transform.{name}")), &[a, b, c])?;
                    solid = format!("{name}({solid}, {a:?}, {b:?}, {c:?})");
                }
            }
        }
        if caps {
            let within = clip.and_then(solid_of).ok_or_else(|| {
                value_error(named("caps"), "there is no clip that could cut the solid; give one with `clip`")
            })?;
            solid = format!("max({solid}, {within})");
        }
        Ok(format!("{definitions}{solid}"))
    }
}

/// By how much of its half size a clip is widened around caps.
const CAP_ROOM: f64 = 0.05;

fn roomy(b: &Box3) -> Box3 {
    let room = b.half_extent() * CAP_ROOM;
    Box3(std::array::from_fn(|k| b[k] + Interval::new(-room[k], room[k])))
}

/// A formula that is negative inside of a clip.
fn solid_of(clip: &Clip) -> Option<String> {
    match clip {
        Clip::Everywhere => None,
        Clip::Box(b) => {
            let sides = ["x", "y", "z"].into_iter().zip(b.0);
            let sides = sides.map(|(x, r)| format!("({:?}) - {x}, {x} - ({:?})", r.lo(), r.hi()));
            Some(format!("max({})", sides.collect::<Vec<_>>().join(", ")))
        }
        Clip::Ball { center, radius } => {
            let square = ["x", "y", "z"].into_iter().zip(center.0).map(|(x, c)| format!("({x} - ({c:?}))^2"));
            Some(format!("{} - ({radius:?})^2", square.collect::<Vec<_>>().join(" + ")))
        }
    }
}

impl ClipEntry {
    pub(super) fn clip(&self, key: &str) -> Result<Clip, FileError> {
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

impl LightEntry {
    pub(super) fn light(&self, key: &str) -> Result<Light, FileError> {
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
