//! The renders of one exhibit, one after the other.
use super::Error;
use crate::render::{RenderSpec, Renderer, RunSpec};
use crate::scene::{self, Scene};
use std::sync::Arc;
use std::time::Duration;

/// Work between two words to `progress`.
const SLICE: Duration = Duration::from_millis(100);

/// What every render of an exhibit has in common, and how many are done.
pub(super) struct Runs<'a> {
    /// Options of the user; the method is the exhibit's.
    pub(super) spec: RenderSpec,
    run: RunSpec,
    progress: &'a mut dyn FnMut(f64),
    done: usize,
    total: usize,
}

impl<'a> Runs<'a> {
    pub(super) fn new(spec: &RenderSpec, run: RunSpec, progress: &'a mut dyn FnMut(f64)) -> Self {
        Self { spec: spec.clone(), run, progress, done: 0, total: 1 }
    }

    /// Announces how many renders there will be.
    pub(super) fn announce(&mut self, total: usize) {
        self.total = total.max(1);
    }

    /// A finished render of `preset`.
    pub(super) fn render(&mut self, preset: &Arc<Scene>, spec: RenderSpec) -> Result<Renderer, Error> {
        let mut renderer = Renderer::new(Arc::clone(preset), spec, self.run)?;
        self.finish(&mut renderer);
        Ok(renderer)
    }

    /// Renders to the end; counts as one render.
    pub(super) fn finish(&mut self, renderer: &mut Renderer) {
        while !renderer.refine(SLICE) {
            (self.progress)((self.done as f64 + renderer.progress()) / self.total as f64);
        }
        self.done += 1;
        (self.progress)(self.done as f64 / self.total as f64);
    }

    /// Threads that the renders use.
    pub(super) fn threads(&self) -> usize {
        self.run.threads.or_else(|| std::thread::available_parallelism().ok().map(Into::into)).unwrap_or(1)
    }

    /// "512 x 512 pixels, 49 sub-beams, grid of 32^3 cells, 2 threads".
    pub(super) fn setting(&self) -> String {
        let s = &self.spec;
        let plural = |n: usize| if n == 1 { "" } else { "s" };
        format!(
            "{} x {} pixels, {} sub-beams, grid of {}^3 cells, {} thread{}{}{}",
            s.width,
            s.height,
            s.sub_beams * s.sub_beams,
            s.grid,
            self.threads(),
            plural(self.threads()),
            if s.light_scale == 1.0 { String::new() } else { format!(", light x {}", s.light_scale) },
            if s.floor { ", with floor" } else { "" },
        )
    }
}

/// The scene of a preset's name.
///
/// # Errors
/// None for presets (tested where they are).
pub(super) fn preset(name: &str) -> Result<Arc<Scene>, Error> {
    let scene = scene::preset(name).unwrap_or_else(|| Scene::from_formula(name))?;
    Ok(Arc::new(scene))
}
