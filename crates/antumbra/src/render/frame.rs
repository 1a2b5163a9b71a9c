//! The picture as data.
use super::spec::Error;
use crate::verdict::{Reason, Verdict};
use serde::{Deserialize, Serialize};

/// Every plane of a picture. Row 0 is at the top; element `row * width + column` belongs to a pixel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// Pixels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// What is known of the pixel: 0 proved empty, 1 proved hit (of the centre ray), 2 to 5 undecided
    /// ([`Frame::verdict_code`]), [`Frame::PARTLY`], or [`Frame::UNSEEN`].
    pub verdict: Vec<u8>,
    /// The ray of which the verdict speaks (the centre ray, for [`Frame::PARTLY`] another one) meets nothing before this
    /// parameter (distance along the view axis from the eye); NaN where the pixel is empty. The paper's methods: no ray
    /// of the pixel does.
    pub t_lo: Vec<f64>,
    /// The meeting, if it is one, begins at or before this parameter; NaN where the pixel is empty.
    pub t_hi: Vec<f64>,
    /// Unit normal, turned to the viewer; 0 where the pixel is empty. Rounded, not certified.
    pub normal: Vec<[f32; 3]>,
    /// What reaches the pixels of each light of the scene, in its order.
    pub lights: Vec<LightPlanes>,
    /// Bounds of the share of the pixel's rays that meet a surface. Certified by the method `certified`; the paper's
    /// methods know only 0 (proved empty) and "0 to 1".
    pub coverage_lo: Vec<f64>,
    /// Upper bound of it.
    pub coverage_hi: Vec<f64>,
    /// Evaluations of inclusion functions that the pixel took.
    pub cost: Vec<u32>,
    /// Colour, linear, Rec. 709 primaries, about 0 to 1. Not certified.
    pub rgb: Vec<[f32; 3]>,
}

/// The planes of one light; elements as in [`Frame`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LightPlanes {
    /// Lower bound of the visible fraction of the light; NaN where the pixel is empty. The paper's methods give one
    /// number for both bounds: 1 - shadow index.
    pub visible_lo: Vec<f64>,
    /// Upper bound of it.
    pub visible_hi: Vec<f64>,
    /// Cosine between normal and the direction to the light's centre; 0 where the pixel is empty.
    pub facing: Vec<f32>,
    /// Whether the first shadow beam, over the whole light, was not found free (paper: "initial beam occluded").
    pub initial_occluded: Vec<bool>,
}

impl LightPlanes {
    /// Middle of the bracket: what a picture shows, where the bracket is as narrow as was asked for.
    pub(super) fn visible(&self, index: usize) -> f64 {
        0.5 * (self.visible_lo[index] + self.visible_hi[index])
    }

    /// Whether nothing has been told of the light of a hit.
    pub(super) fn is_untold(&self, index: usize) -> bool {
        (self.visible_lo[index], self.visible_hi[index]) == (0.0, 1.0)
    }

    /// Whether the bracket is wider than the tolerance.
    pub(super) fn is_open(&self, index: usize, tolerance: f64) -> bool {
        self.visible_hi[index] - self.visible_lo[index] > tolerance * (1.0 + 1e-9)
    }
}

/// Forgets the first elements of a plane, and fills it up with new ones to that length.
pub(super) fn slide<T: Clone>(plane: &mut Vec<T>, forget: usize, length: usize, value: T) {
    plane.drain(..forget);
    plane.resize(length, value);
}

impl Frame {
    /// The code of a pixel that nobody has looked at yet.
    pub const UNSEEN: u8 = 255;

    /// The code of a pixel whose centre ray meets nothing while another of its rays meets a surface: both proved.
    pub const PARTLY: u8 = 6;

    /// A frame of unseen pixels under `lights` lights.
    ///
    /// # Errors
    /// [`Error::Memory`] if it does not fit.
    pub fn new(width: usize, height: usize, lights: usize) -> Result<Self, Error> {
        fn plane<T: Clone>(n: usize, value: T) -> Option<Vec<T>> {
            let mut v = Vec::new();
            v.try_reserve_exact(n).ok()?;
            v.resize(n, value);
            Some(v)
        }
        let n = width * height;
        let light = || {
            Some(LightPlanes {
                visible_lo: plane(n, f64::NAN)?,
                visible_hi: plane(n, f64::NAN)?,
                facing: plane(n, 0.0)?,
                initial_occluded: plane(n, false)?,
            })
        };
        let make = || {
            Some(Self {
                width,
                height,
                verdict: plane(n, Self::UNSEEN)?,
                t_lo: plane(n, f64::NAN)?,
                t_hi: plane(n, f64::NAN)?,
                normal: plane(n, [0.0; 3])?,
                lights: (0..lights).map(|_| light()).collect::<Option<_>>()?,
                coverage_lo: plane(n, 0.0)?,
                coverage_hi: plane(n, 1.0)?,
                cost: plane(n, 0)?,
                rgb: plane(n, [0.0; 3])?,
            })
        };
        make().ok_or(Error::Memory { width, height, bytes: n * Self::bytes_per_pixel(lights) })
    }

    /// Forgets the first pixels, a whole number of rows, and fills up with unseen ones to so many.
    pub(super) fn slide(&mut self, forget: usize, pixels: usize) {
        self.height = pixels / self.width;
        slide(&mut self.verdict, forget, pixels, Self::UNSEEN);
        slide(&mut self.t_lo, forget, pixels, f64::NAN);
        slide(&mut self.t_hi, forget, pixels, f64::NAN);
        slide(&mut self.normal, forget, pixels, [0.0; 3]);
        for light in &mut self.lights {
            slide(&mut light.visible_lo, forget, pixels, f64::NAN);
            slide(&mut light.visible_hi, forget, pixels, f64::NAN);
            slide(&mut light.facing, forget, pixels, 0.0);
            slide(&mut light.initial_occluded, forget, pixels, false);
        }
        slide(&mut self.coverage_lo, forget, pixels, 0.0);
        slide(&mut self.coverage_hi, forget, pixels, 1.0);
        slide(&mut self.cost, forget, pixels, 0);
        slide(&mut self.rgb, forget, pixels, [0.0; 3]);
    }

    /// Some of its rows.
    #[must_use]
    pub fn rows(&self, rows: std::ops::Range<usize>) -> Self {
        let part = rows.start * self.width..rows.end * self.width;
        let light = |light: &LightPlanes| LightPlanes {
            visible_lo: light.visible_lo[part.clone()].to_vec(),
            visible_hi: light.visible_hi[part.clone()].to_vec(),
            facing: light.facing[part.clone()].to_vec(),
            initial_occluded: light.initial_occluded[part.clone()].to_vec(),
        };
        Self {
            width: self.width,
            height: rows.len(),
            verdict: self.verdict[part.clone()].to_vec(),
            t_lo: self.t_lo[part.clone()].to_vec(),
            t_hi: self.t_hi[part.clone()].to_vec(),
            normal: self.normal[part.clone()].to_vec(),
            lights: self.lights.iter().map(light).collect(),
            coverage_lo: self.coverage_lo[part.clone()].to_vec(),
            coverage_hi: self.coverage_hi[part.clone()].to_vec(),
            cost: self.cost[part.clone()].to_vec(),
            rgb: self.rgb[part.clone()].to_vec(),
        }
    }

    /// The code of a verdict in the plane [`Frame::verdict`]: 0 no, 1 yes, 2 resolution, 3 touching, 4 domain, 5 budget.
    #[must_use]
    pub const fn verdict_code(verdict: Verdict) -> u8 {
        match verdict {
            Verdict::No => 0,
            Verdict::Yes => 1,
            Verdict::Unknown(Reason::Resolution) => 2,
            Verdict::Unknown(Reason::Touching) => 3,
            Verdict::Unknown(Reason::Domain) => 4,
            Verdict::Unknown(Reason::Budget) => 5,
        }
    }
}
