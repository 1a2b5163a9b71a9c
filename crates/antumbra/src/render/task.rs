//! One picture as the passes see it: everything that does not change while it is drawn.
use super::irradiance::irradiance;
use super::pixel::Hit;
use super::spec::{Error, Method, RenderSpec};
use super::window::Window;
use crate::eval::{Gradient, Inclusion, Workspace};
use crate::geom::{Beam, Box3, Film, Rect, Vec3};
use crate::paper::Settings;
use crate::scene::{ColorMap, Coloring, Colors, Light, Object, Scene};
use crate::shadow::Tolerance;
use crate::trace::{Effort, Sign, Surface};
use antumbra_interval::Interval;
use std::ops::Range;
use std::sync::Arc;

/// A hit of which more is to be known.
#[derive(Clone, Copy, Debug)]
pub(super) struct Asked {
    /// Index of the surface.
    pub(super) object: usize,
    /// The ray.
    pub(super) beam: Beam,
    /// Where on it.
    pub(super) t: Interval,
    /// The sign of f just before, if known.
    pub(super) before: Option<Sign>,
}

/// Scratch memory for many hits.
#[derive(Debug, Default)]
pub(super) struct HitScratch {
    regions: Vec<Box3>,
    gradients: Vec<Gradient>,
}

const NO_GRADIENT: Gradient = Gradient { value: Interval::ENTIRE, partials: [Interval::ENTIRE; 3] };

/// Scene, film and lights of one picture.
pub(super) struct Task {
    pub(super) scene: Arc<Scene>,
    /// The scene's objects; the floor, if it is wanted, is the last.
    pub(super) objects: Vec<Object>,
    pub(super) has_floor: bool,
    /// Of the scene.
    pub(super) scale: f64,
    pub(super) film: Film,
    /// The rows of it that planes hold.
    pub(super) window: Window,
    pub(super) lights: Vec<Light>,
    /// Form factor of each light where the camera looks, on a patch that faces it: full light.
    pub(super) full: Vec<f64>,
    pub(super) settings: Settings,
    pub(super) tolerance: Tolerance,
    pub(super) method: Method,
    /// How far rays go that only give colours.
    pub(super) glance: Effort,
}

/// From this distance on, in scales of the scene, a glance that is exact for its distance is none for the scene.
const FAR: f64 = 100.0;

impl Task {
    /// With unions as their parts, if they are to be `divided`.
    ///
    /// # Errors
    /// Where the scene's floor has no height.
    pub(super) fn new(scene: Arc<Scene>, spec: &RenderSpec, window: Window, divided: bool) -> Result<Self, Error> {
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
        if divided {
            let parts = |object: Object| object.parts(film.camera.eye).unwrap_or_else(|| vec![object]);
            objects = objects.into_iter().flat_map(parts).collect();
        }
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
        let lights: Vec<Light> = scene.lights.iter().map(scaled).collect();
        let full = lights.iter().map(|light| full(scene.view.target, &light.rect)).collect();
        let distance = (scene.view.eye - scene.view.target).length();
        let glance = if distance > FAR * scene.scale() { Effort::FINE } else { Effort::COARSE };
        let scale = scene.scale();
        Ok(Self {
            scene,
            objects,
            scale,
            has_floor,
            film,
            window,
            lights,
            full,
            settings,
            tolerance,
            method: spec.method,
            glance,
        })
    }

    /// Column and row of the pixel at an index of the planes.
    pub(super) fn place(&self, index: usize) -> (usize, usize) {
        (index % self.film.width, self.window.held().start + index / self.film.width)
    }

    /// Where planes hold a pixel; its row is held.
    pub(super) fn index(&self, column: usize, row: usize) -> usize {
        (row - self.window.held().start) * self.film.width + column
    }

    /// Where planes hold those rows.
    pub(super) fn indices(&self, rows: Range<usize>) -> Range<usize> {
        self.index(0, rows.start)..self.index(0, rows.end)
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

    /// A hit on an object: where, and how the surface lies there. Nothing here is certified but the interval.
    pub(super) fn hit(&self, asked: Asked, work: &mut Workspace) -> Hit {
        let f = self.objects[asked.object].surface.as_ref();
        let point = self.point(&asked);
        let gradient = f.gradient(&point.to_box(), work);
        self.hit_with(asked, point, &gradient, work)
    }

    /// The same for many, in their order.
    pub(super) fn hits(
        &self,
        asked: &[Asked],
        scratch: &mut HitScratch,
        work: &mut Workspace,
        mut found: impl FnMut(usize, Hit),
    ) {
        let HitScratch { regions, gradients } = scratch;
        for (object, o) in self.objects.iter().enumerate() {
            let of_this = || asked.iter().enumerate().filter(move |(_, a)| a.object == object);
            regions.clear();
            regions.extend(of_this().map(|(_, a)| self.point(a).to_box()));
            gradients.resize(regions.len(), NO_GRADIENT);
            o.surface.gradients(regions, gradients, work);
            for ((k, a), (region, gradient)) in of_this().zip(regions.iter().zip(gradients.iter())) {
                found(k, self.hit_with(*a, region.mid(), gradient, work));
            }
        }
    }

    /// About where it is.
    fn point(&self, Asked { object, beam, t, .. }: &Asked) -> Vec3 {
        // A floor seen along its plane has no far end; take the near one.
        let at = if t.hi().is_finite() { *t } else { Interval::point(t.lo()) };
        let mut point = beam.at(at).mid();
        if Some(*object) == self.floor_index() {
            point.0[2] = self.scene.floor_height;
        }
        point
    }

    fn hit_with(&self, asked: Asked, point: Vec3, gradient: &Gradient, work: &mut Workspace) -> Hit {
        let Asked { object, beam, t, before } = asked;
        let view = beam.direction.mid().normalized();
        let (normal, outside) = oriented_normal(gradient, view, before);
        let color = paint(&self.objects[object], point, normal, outside, self.scale, work);
        Hit { t, point, normal, color, object, floor: Some(object) == self.floor_index(), receiver: None }
    }
}

/// Form factor of a light on a patch at `target` that faces its middle. Positive, so that one may divide by it.
fn full(target: Vec3, light: &Rect) -> f64 {
    let towards = (light.center - target).normalized();
    irradiance(target, towards, light).form.max(f64::MIN_POSITIVE)
}

/// Colour of a surface at a point, of which the normal is turned to the viewer.
fn paint(object: &Object, point: Vec3, normal: Vec3, outside: bool, scale: f64, work: &mut Workspace) -> [f64; 3] {
    let Colors { outside: above, inside: below } = object.colors;
    match &object.coloring {
        Coloring::Sides if outside => above,
        Coloring::Sides => below,
        Coloring::Normal => {
            let upright = if outside { normal } else { -normal };
            upright.0.map(|n| 0.08 + 0.72 * (0.5 + 0.5 * n) * (0.5 + 0.5 * n))
        }
        Coloring::Curvature => {
            let bend = curvature(object.surface.as_ref(), point, normal, 1e-4 * scale, work) * scale;
            // Half of the map for a ball of the scene's size; the rest for all smaller ones.
            ColorMap::Diverging.color(0.5 - 0.5 * core_math::tanh(0.5 * bend))
        }
        Coloring::Field(field, function) => {
            let value = function.range(&point.to_box(), work).mid();
            field.map.color((value - field.from) / (field.to - field.from))
        }
    }
}

/// Mean curvature, about: half the divergence of the unit normal, by differences over `step`. Positive for a ball seen
/// from outside.
fn curvature(f: &dyn Inclusion, point: Vec3, normal: Vec3, step: f64, work: &mut Workspace) -> f64 {
    let mut unit = |axis: usize, by: f64| {
        let mut at = point;
        at.0[axis] += by;
        let n = Vec3(f.gradient(&at.to_box(), work).partials.map(|d| if d.is_empty() { 0.0 } else { d.mid() }));
        let n = n.normalized();
        if n.dot(normal) < 0.0 { -n } else { n }
    };
    let divergence: f64 = (0..3).map(|k| (unit(k, step)[k] - unit(k, -step)[k]) / (2.0 * step)).sum();
    0.5 * divergence
}

/// The unit normal towards the viewer, and whether he is on the side where f > 0.
fn oriented_normal(gradient: &Gradient, view: Vec3, before: Option<Sign>) -> (Vec3, bool) {
    let normal = Vec3(gradient.partials.map(|d| if d.is_empty() { 0.0 } else { d.mid() })).normalized();
    // No gradient (a singular point): the surface faces the viewer.
    let normal = if normal == Vec3::default() { -view } else { normal };
    let towards = normal.dot(view) < 0.0;
    let outside = before.map_or(towards, |sign| sign == Sign::Positive);
    (if towards { normal } else { -normal }, outside)
}
