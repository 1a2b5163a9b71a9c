//! One picture as the passes see it: everything that does not change while it is drawn.
use super::pixel::Hit;
use super::spec::{Error, Method, RenderSpec};
use crate::eval::{Inclusion, Workspace};
use crate::geom::{Beam, Film, Vec3};
use crate::paper::Settings;
use crate::scene::{Light, Object, Scene};
use crate::shadow::Tolerance;
use crate::trace::{Sign, Surface};
use antumbra_interval::Interval;
use std::sync::Arc;

/// Scene, film and lights of one picture.
pub(super) struct Task {
    pub(super) scene: Arc<Scene>,
    /// The scene's objects; the floor, if it is wanted, is the last.
    pub(super) objects: Vec<Object>,
    pub(super) has_floor: bool,
    pub(super) film: Film,
    pub(super) lights: Vec<Light>,
    pub(super) settings: Settings,
    pub(super) tolerance: Tolerance,
    pub(super) method: Method,
}

impl Task {
    /// # Errors
    /// Where the scene's floor has no height.
    pub(super) fn new(scene: Arc<Scene>, spec: &RenderSpec) -> Result<Self, Error> {
        let (width, height) = (spec.width, spec.height);
        let film = Film { camera: scene.view.camera(width as f64 / height as f64), width, height };
        let mut objects = scene.objects.clone();
        let floor = if spec.floor {
            let value = scene.floor_height.to_string();
            let bad = |_| Error::OutOfRange { what: "the height of the floor", range: "finite", value };
            Some(scene.floor().map_err(bad)?)
        } else {
            None
        };
        let has_floor = floor.is_some();
        objects.extend(floor);
        if spec.regions {
            for object in &mut objects {
                if let Some(divided) = object.surface.in_regions(&object.clip().bounds()) {
                    object.surface = divided;
                }
            }
        }
        let settings = Settings {
            sub_beams: spec.sub_beams,
            offset: spec.offset.unwrap_or(RenderSpec::OFFSET * scene.scale()),
            bisection: spec.bisection,
            seed: spec.seed,
        };
        let tolerance = Tolerance { width: spec.tolerance, rectangles: spec.rectangles, penumbra: spec.penumbra };
        let scaled = |light: &Light| Light { rect: light.rect.scaled(spec.light_scale), ..*light };
        let lights = scene.lights.iter().map(scaled).collect();
        Ok(Self { scene, objects, has_floor, film, lights, settings, tolerance, method: spec.method })
    }

    /// The objects as surfaces.
    pub(super) fn surfaces(&self) -> Vec<Surface<'_>> {
        self.objects
            .iter()
            .map(|o| Surface { function: o.surface.as_ref(), clip: o.clip(), region: o.region() })
            .collect()
    }

    /// Index of the floor among the objects.
    pub(super) fn floor_index(&self) -> Option<usize> {
        self.has_floor.then(|| self.objects.len() - 1)
    }

    /// A hit on an object: where, and how the surface lies there. `before` is the sign of f just before it, if known.
    /// Nothing here is certified but the interval.
    pub(super) fn hit(
        &self,
        object: usize,
        beam: &Beam,
        t: Interval,
        before: Option<Sign>,
        work: &mut Workspace,
    ) -> Hit {
        // A floor seen along its plane has no far end; take the near one.
        let at = if t.hi().is_finite() { t } else { Interval::point(t.lo()) };
        let mut point = beam.at(at).mid();
        let floor = Some(object) == self.floor_index();
        if floor {
            point.0[2] = self.scene.floor_height;
        }
        let view = beam.direction.mid().normalized();
        let (normal, outside) = oriented_normal(self.objects[object].surface.as_ref(), point, view, before, work);
        Hit { t, point, normal, outside, object, floor, receiver: None }
    }
}

/// The unit normal towards the viewer, and whether he is on the side where f > 0.
fn oriented_normal(
    f: &dyn Inclusion,
    point: Vec3,
    view: Vec3,
    before: Option<Sign>,
    work: &mut Workspace,
) -> (Vec3, bool) {
    let gradient = f.gradient(&point.to_box(), work);
    let normal = Vec3(gradient.partials.map(|d| if d.is_empty() { 0.0 } else { d.mid() })).normalized();
    // No gradient (a singular point): the surface faces the viewer.
    let normal = if normal == Vec3::default() { -view } else { normal };
    let towards = normal.dot(view) < 0.0;
    let outside = before.map_or(towards, |sign| sign == Sign::Positive);
    (if towards { normal } else { -normal }, outside)
}
