//! The camera as hands move it: around a target, aside, nearer.
use super::{CameraEntry, View};
use crate::geom::{Polar, Vec3};

/// A camera that looks at a target: how it stands, and how much it sees there. Perspective and parallel cameras are two views of
/// the same, which show the target equally large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// What it looks at.
    pub target: Vec3,
    /// Direction of the camera seen from the target; its length is 1.
    pub towards: Polar,
    /// What the shorter side of the picture shows at the target's distance, in units of the scene.
    pub width: f64,
    /// Full angle over the shorter side of the picture, degrees: of the perspective camera.
    pub fov_deg: f64,
    /// Whether parallel lines stay parallel.
    pub parallel: bool,
}

/// Smallest angle of a camera that is taken for one of perspective.
const LEAST_ANGLE: f64 = 0.01;
/// Angle of a perspective camera, where there was none before.
const USUAL_ANGLE: f64 = 30.0;
/// Bounds of what is seen, in units of the scene: beyond them numbers of a scene file get lost.
const WIDTHS: std::ops::RangeInclusive<f64> = 1e-9..=1e9;

impl Orbit {
    /// That of a view. A camera with hardly any angle is a parallel one ([`View::orthographic`]).
    #[must_use]
    pub fn of(view: &View) -> Self {
        let away = view.eye - view.target;
        let half = 0.5 * view.fov_deg.to_radians();
        let parallel = view.fov_deg < LEAST_ANGLE;
        Self {
            target: view.target,
            towards: Polar { length: 1.0, ..Polar::of(away) },
            width: 2.0 * away.length() * core_math::tan(half),
            fov_deg: if parallel { USUAL_ANGLE } else { view.fov_deg },
            parallel,
        }
    }

    /// The camera for it.
    #[must_use]
    pub fn view(&self) -> View {
        let direction = self.towards.vector();
        if self.parallel {
            return View::orthographic(direction, self.target, self.width);
        }
        let distance = 0.5 * self.width / core_math::tan(0.5 * self.fov_deg.to_radians());
        View { eye: self.target + direction * distance, target: self.target, fov_deg: self.fov_deg }
    }

    /// As a scene file writes it.
    #[must_use]
    pub fn entry(&self) -> CameraEntry {
        let target = Some(self.target.0);
        if self.parallel {
            let from = Some(self.towards.vector().0);
            return CameraEntry {
                from,
                target,
                orthographic: Some(true),
                width: Some(self.width),
                ..CameraEntry::default()
            };
        }
        let View { eye, fov_deg, .. } = self.view();
        CameraEntry { eye: Some(eye.0), target, angle: Some(fov_deg), ..CameraEntry::default() }
    }

    /// Only its direction, as a scene file writes it: where it stands and how much it sees is chosen anew, so that everything is seen.
    #[must_use]
    pub fn fitted(&self) -> CameraEntry {
        let orthographic = self.parallel.then_some(true);
        CameraEntry { from: Some(self.towards.vector().0), orthographic, ..CameraEntry::default() }
    }

    /// Around the target: by angles in radians, to the right and upwards.
    #[must_use]
    pub fn turned(self, azimuth: f64, elevation: f64) -> Self {
        Self { towards: self.towards.turned(azimuth, elevation), ..self }
    }

    /// Aside, with its target: by shares of the shorter side of the picture, to the right and upwards.
    #[must_use]
    pub fn moved(self, right: f64, up: f64) -> Self {
        let camera = self.view().camera(1.0);
        let by = camera.right.normalized() * (right * self.width) + camera.up.normalized() * (up * self.width);
        Self { target: self.target + by, ..self }
    }

    /// Nearer or further: it sees `factor` times as much.
    #[must_use]
    pub fn zoomed(self, factor: f64) -> Self {
        let width = self.width * factor;
        Self { width: if width.is_nan() { self.width } else { width.clamp(*WIDTHS.start(), *WIDTHS.end()) }, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::SceneFile;

    fn view() -> View {
        View { eye: Vec3::new(4.0, -2.0, 2.0), target: Vec3::new(0.5, 0.0, 0.1), fov_deg: 30.5 }
    }

    #[test]
    fn a_view_comes_back_and_files_say_the_same() {
        let orbit = Orbit::of(&view());
        let back = orbit.view();
        assert!((back.eye - view().eye).length() < 1e-12 && back.target == view().target && back.fov_deg == 30.5);
        let mut file = SceneFile::of_formula("x^2 + y^2 + z^2 = 1");
        for parallel in [false, true] {
            let orbit = Orbit { parallel, ..orbit };
            file.camera = Some(orbit.entry());
            let read = file.scene("s").unwrap().view;
            assert!((read.eye - orbit.view().eye).length() < 1e-9 * read.eye.length(), "{read:?}");
            let again = Orbit::of(&read);
            assert_eq!(again.parallel, parallel);
            assert!((again.width - orbit.width).abs() < 1e-6 * orbit.width, "{again:?}");
            file.camera = Some(orbit.fitted());
            let fitted = Orbit::of(&file.scene("s").unwrap().view);
            assert!((fitted.towards.azimuth - orbit.towards.azimuth).abs() < 1e-9 && fitted.parallel == parallel);
        }
    }

    #[test]
    fn hands_move_it() {
        let orbit = Orbit::of(&view());
        let distance = |o: &Orbit| (o.view().eye - o.view().target).length();
        let turned = orbit.turned(1.0, 0.3);
        assert!((distance(&turned) - distance(&orbit)).abs() < 1e-12);
        assert!((distance(&orbit.zoomed(2.0)) - 2.0 * distance(&orbit)).abs() < 1e-12);
        assert_eq!(orbit.zoomed(f64::NAN), orbit);
        // What was in the middle is half a picture further to the left.
        let moved = orbit.moved(0.5, 0.0);
        let ([x, y], _) = moved.view().camera(1.0).project(orbit.target).unwrap();
        assert!((x + 1.0).abs() < 1e-9 && y.abs() < 1e-9, "{x} {y}");
    }
}
