//! The camera of a scene: as numbers, and as a file gives it.
use super::entry::CameraEntry;
use super::file::{FileError, finite, value_error};
use super::framing::Stage;
use crate::geom::{Camera, Vec3};

/// Position and angle of the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Where it stands.
    pub eye: Vec3,
    /// What it looks at.
    pub target: Vec3,
    /// Full angle over the shorter side of the picture, degrees.
    pub fov_deg: f64,
}

/// Distance of an orthographic camera, in units of what it sees.
const FAR: f64 = (1 << 14) as f64;
/// Degrees.
const LEAST_ANGLE: f64 = 1e-4;

impl View {
    /// The camera for a picture of `width / height = aspect`.
    #[must_use]
    pub fn camera(&self, aspect: f64) -> Camera {
        Camera::look_at(self.eye, self.target, self.fov_deg, aspect)
    }

    /// A camera so far away in that direction from the target that parallel lines stay parallel: over a depth as large as the
    /// `width` that the shorter side of the picture shows, a point moves by less than a thirtieth of a pixel of 1000. It is an
    /// ordinary camera, and what is proved is proved for its rays.
    #[must_use]
    pub fn orthographic(direction: Vec3, target: Vec3, width: f64) -> Self {
        let fov_deg = 2.0 * core_math::atan(0.5 / FAR).to_degrees();
        Self { eye: target + direction.normalized() * (FAR * width), target, fov_deg }
    }
}

impl CameraEntry {
    /// The camera, on a stage that says where everything is.
    pub(super) fn view(&self, stage: &Stage<'_>) -> Result<View, FileError> {
        let Self { eye, from, target, angle, orthographic, width } = *self;
        for (name, numbers) in [("eye", eye), ("from", from), ("target", target)] {
            finite(&format!("camera.{name}"), &numbers.unwrap_or_default())?;
        }
        if eye.is_some() && from.is_some() {
            return Err(value_error("camera", "give either `eye` (a point) or `from` (a direction)"));
        }
        if from == Some([0.0; 3]) {
            return Err(value_error("camera.from", "a direction cannot be zero"));
        }
        let target = target.map_or(if eye.is_some() { Vec3::default() } else { stage.centre }, Vec3);
        let eye = match (eye, from) {
            (Some(eye), _) => Vec3(eye),
            (None, from) => target + from.map_or(Stage::FROM, Vec3).normalized() * stage.distance(),
        };
        if eye == target {
            return Err(value_error("camera", "eye and target are the same point"));
        }
        let parallel = orthographic.unwrap_or(width.is_some());
        match (angle, width) {
            (Some(_), _) if parallel => {
                Err(value_error("camera.angle", "an orthographic camera has no angle; give `width`, or leave it out"))
            }
            (_, Some(_)) if !parallel => {
                Err(value_error("camera.width", "belongs to an orthographic camera; a perspective one has an `angle`"))
            }
            (_, Some(width)) if !(width > 0.0 && width <= 1e100) => {
                Err(value_error("camera.width", "must be greater than 0 (and at most 1e100)"))
            }
            (Some(angle), _) if !(LEAST_ANGLE..=170.0).contains(&angle) => {
                Err(value_error("camera.angle", format!("must be from 0.0001 to 170 degrees, not {angle}")))
            }
            (_, width) if parallel => {
                let view = View::orthographic(eye - target, target, width.unwrap_or_else(|| stage.width(target)));
                // Beside a far target a small width is lost, and the direction with it.
                let (distance, meant) =
                    ((view.eye - target).length(), FAR * width.unwrap_or_else(|| stage.width(target)));
                if (distance - meant).abs() <= 1e-6 * meant {
                    Ok(view)
                } else {
                    Err(value_error("camera.width", "is too small for a target so far from the origin"))
                }
            }
            (angle, _) => {
                let angle = angle.unwrap_or_else(|| stage.angle(eye, target).max(LEAST_ANGLE));
                Ok(View { eye, target, fov_deg: angle })
            }
        }
    }
}
