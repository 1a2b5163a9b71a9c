//! Our pictures: times, the reference, and errors against it.
use crate::embree::Rays;
use crate::light::{found, visible};
use crate::sampler::Judge;
use crate::surfaces::Surface;
use antumbra::geom::Film;
use antumbra::render::{Frame, RenderSpec, Renderer, RunSpec};
use antumbra::scene::{Scene, preset};
use cpu_time::ProcessTime;
use std::sync::Arc;
use std::time::Duration;

/// Tolerances that are tried, widest first, until the error is at most that of another program.
pub(crate) const TOLERANCES: [f64; 5] = [1.0 / 16.0, 1.0 / 64.0, 1.0 / 255.0, 1.0 / 1024.0, 1.0 / 4096.0];

/// The preset's scene.
pub(crate) fn scene(surface: &Surface) -> Arc<Scene> {
    Arc::new(preset(surface.name).expect("a preset").expect("a preset"))
}

/// CPU seconds of one picture on one thread.
#[derive(Clone, Copy)]
pub(crate) struct Seconds {
    pub(crate) surfaces: f64,
    pub(crate) light: f64,
    pub(crate) whole: f64,
}

/// A certified picture.
pub(crate) fn certified(scene: &Arc<Scene>, size: usize, tolerance: f64) -> (Frame, Seconds) {
    let spec = RenderSpec { width: size, height: size, tolerance, ..RenderSpec::default() };
    let all = ProcessTime::now();
    let mut renderer = Renderer::new(Arc::clone(scene), spec, RunSpec { threads: Some(1) }).expect("a valid spec");
    renderer.color_late();
    let mut seconds = Seconds { surfaces: 0.0, light: 0.0, whole: 0.0 };
    loop {
        let activity = renderer.activity().0;
        let begin = ProcessTime::now();
        let done = renderer.refine(Duration::ZERO);
        let spent = begin.elapsed().as_secs_f64();
        if activity.starts_with("surface") {
            seconds.surfaces += spent;
        } else if activity.starts_with("light") {
            seconds.light += spent;
        }
        if done {
            break;
        }
    }
    seconds.whole = all.elapsed().as_secs_f64();
    (renderer.frame().clone(), seconds)
}

/// The rays of the pixels' centres.
pub(crate) fn rays(scene: &Scene, size: usize) -> Rays {
    let film = Film { camera: scene.view.camera(1.0), width: size, height: size };
    let direction = |i: usize| film.ray(i % size, i / size).direction.mid().0.map(|c| c as f32);
    Rays { eye: film.camera.eye.0.map(|c| c as f32), directions: (0..size * size).map(direction).collect() }
}

/// The truth to a few millionths: brackets of 1/65536.
pub(crate) struct Reference {
    frame: Frame,
    /// Pixels that are compared: proved hits all of whose neighbours are.
    inner: Vec<usize>,
}

/// How far a picture is from the truth.
#[derive(Clone, Copy)]
pub(crate) struct Errors {
    /// Root of the mean square.
    pub(crate) rms: f64,
    /// The worst pixel.
    pub(crate) most: f64,
}

impl Reference {
    pub(crate) fn of(scene: &Arc<Scene>, size: usize) -> Self {
        let (frame, _) = certified(scene, size, 1.0 / 65536.0);
        let hit = |i: usize| frame.verdict[i] == 1;
        let inside = |i: &usize| {
            let (x, y) = (i % size, i / size);
            let near = |c: usize| c.saturating_sub(1)..=(c + 1).min(size - 1);
            near(y).all(|y| near(x).all(|x| hit(y * size + x)))
        };
        let inner = (0..size * size).filter(inside).collect();
        Self { frame, inner }
    }

    /// Cosines at the light's centre, at least 0.
    pub(crate) fn facing(&self, i: usize) -> f64 {
        f64::from(self.frame.lights[0].facing[i].max(0.0))
    }

    /// Of a visible fraction for each pixel, times `weight`; what is NaN counts as dark.
    pub(crate) fn errors(&self, visible: impl Fn(usize) -> f64, weight: impl Fn(usize) -> f64) -> Errors {
        let light = &self.frame.lights[0];
        let (mut sum, mut most) = (0.0, 0.0f64);
        for &i in &self.inner {
            let seen = visible(i);
            let off = (if seen.is_nan() { 0.0 } else { seen })
                - weight(i) * 0.5 * (light.visible_lo[i] + light.visible_hi[i]);
            sum += off * off;
            most = most.max(off.abs());
        }
        Errors { rms: (sum / self.inner.len() as f64).sqrt(), most }
    }

    /// The errors of a certified picture, taking the middles of its brackets.
    pub(crate) fn errors_of(&self, frame: &Frame) -> Errors {
        let light = &frame.lights[0];
        self.errors(|i| 0.5 * (light.visible_lo[i] + light.visible_hi[i]), |_| 1.0)
    }

    /// Some penumbra pixels against `n x n` points of the light, which the independent sampler of our tests asks one by one. Returns
    /// how many pixels were looked at, and at how many samples and bracket disagree.
    pub(crate) fn sampled(&self, scene: &Scene, pixels: usize, n: usize) -> (usize, usize) {
        let judges: Vec<Judge> = scene.objects.iter().map(Judge::new).collect();
        let bracket = |i: usize| (self.frame.lights[0].visible_lo[i], self.frame.lights[0].visible_hi[i]);
        let partly = |i: &usize| bracket(*i).0 > 0.02 && bracket(*i).1 < 0.98;
        let partly: Vec<usize> = self.inner.iter().copied().filter(partly).collect();
        let step = (partly.len() / pixels.max(1)).max(1);
        let chosen: Vec<usize> = partly.into_iter().step_by(step).collect();
        // As many cells as may hide an edge between equal corners.
        let slack = 4.0 / (n * n) as f64;
        let away = |i: &&usize| {
            let (lo, hi) = bracket(**i);
            let Some((own, p, before)) = found(scene, &judges, &self.frame, **i) else { return true };
            !visible(&judges, own, &p, before, &scene.lights[0].rect, n).agree(lo, hi, slack)
        };
        (chosen.len(), chosen.iter().filter(away).count())
    }
}
