//! The function of a surface of the gallery, its gradient and its second derivatives at points: rounded, for tests that allow
//! for it.
use antumbra::eval::{Gradient, Inclusion, Workspace};
use antumbra::geom::{Box3, Vec3};
use antumbra::scene::named;
use fastrand::Rng;
use std::cell::RefCell;
use std::sync::Arc;

pub(crate) type Matrix = [[f64; 3]; 3];

pub(crate) struct Field {
    pub(crate) name: &'static str,
    function: Arc<dyn Inclusion>,
    work: RefCell<Workspace>,
}

impl Field {
    /// The first surface of that scene.
    pub(crate) fn of(name: &'static str) -> Self {
        let scene = named(name).unwrap_or_else(|| panic!("{name} is not in the gallery")).unwrap();
        Self { name, function: Arc::clone(&scene.objects[0].surface), work: RefCell::default() }
    }

    /// Enclosures over a box.
    pub(crate) fn over(&self, region: &Box3) -> Gradient {
        self.function.gradient(region, &mut self.work.borrow_mut())
    }

    pub(crate) fn value(&self, at: Vec3) -> f64 {
        self.function.range(&at.to_box(), &mut self.work.borrow_mut()).mid()
    }

    pub(crate) fn gradient(&self, at: Vec3) -> Vec3 {
        Vec3(self.over(&at.to_box()).partials.map(|d| d.mid()))
    }

    /// Second derivatives, by differences of gradients.
    pub(crate) fn hessian(&self, at: Vec3) -> Matrix {
        let step = 1e-5 * (1.0 + at.length());
        std::array::from_fn(|k| {
            let mut shift = Vec3::default();
            shift.0[k] = step;
            ((self.gradient(at + shift) - self.gradient(at - shift)) * (0.5 / step)).0
        })
    }

    /// The value as a distance: over the steepness, in units of the point's own size. At most this for a point on the surface.
    pub(crate) fn assert_on(&self, at: Vec3) {
        let (value, slope) = (self.value(at), self.gradient(at).length());
        let size = 1.0 + at.length();
        // Near singular points the slope vanishes, and the value with a higher power.
        let curved = self.hessian(at).iter().flatten().fold(0.0_f64, |m, h| m.max(h.abs()));
        assert!(
            value.abs() <= 1e-9 * size * (slope + size * curved),
            "{}: {value} at {at:?}, slope {slope}",
            self.name
        );
    }

    /// A point of the surface near `start`, by Newton's method along the gradient.
    pub(crate) fn near(&self, start: Vec3) -> Option<Vec3> {
        let mut at = start;
        for _ in 0..60 {
            let (value, slope) = (self.value(at), self.gradient(at));
            let step = slope * (value / slope.dot(slope));
            if !step.length().is_finite() {
                return None;
            }
            at = at - step;
            if step.length() < 1e-13 * (1.0 + at.length()) {
                return Some(at);
            }
        }
        None
    }
}

pub(crate) fn apply(m: &Matrix, p: Vec3) -> Vec3 {
    Vec3(std::array::from_fn(|i| Vec3(m[i]).dot(p)))
}

pub(crate) fn determinant(m: &Matrix) -> f64 {
    Vec3(m[0]).dot(Vec3(m[1]).cross(Vec3(m[2])))
}

/// A point of the cube of that half side.
pub(crate) fn random_point(r: &mut Rng, half: f64) -> Vec3 {
    Vec3(std::array::from_fn(|_| (2.0 * r.f64() - 1.0) * half))
}
