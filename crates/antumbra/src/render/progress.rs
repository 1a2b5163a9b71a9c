//! How far a render is.
use super::Method;
use super::renderer::{Renderer, Stage};
use std::time::Duration;

impl Renderer {
    /// Share of the work that is done, 0 to 1, roughly: tiles, the shadows counted three times.
    #[must_use]
    pub fn progress(&self) -> f64 {
        let share = self.share();
        let of_band = match self.stage {
            Stage::Grid => 0.0,
            Stage::Primary => 0.25 * share,
            Stage::Shadow => 0.25 + 0.75 * share,
            Stage::Edges | Stage::Done | Stage::Parted => 1.0,
        };
        let band = self.task.window.fresh();
        (band.start as f64 + band.len() as f64 * of_band) / self.task.film.height as f64
    }

    /// Guess of the time that the rest will take at the pace so far, once there is a pace. Tiles are drawn in a scattered
    /// order, so those that are done are a fair sample of those that are not. How long shadows take in comparison with hits
    /// is not known before the first ones are found; a usual factor stands in for it.
    #[must_use]
    pub fn remaining(&self) -> Option<Duration> {
        let (share, stats) = (self.share(), &self.book.stats);
        if !self.task.window.is_whole() {
            let (spent, done) = (stats.totalled().seconds, self.progress());
            return Duration::try_from_secs_f64(spent * (1.0 - done) / done).ok();
        }
        let all = |spent: f64| if share > 0.0 { spent / share } else { f64::NAN };
        let seconds = match self.stage {
            Stage::Grid => f64::NAN,
            Stage::Primary => all(stats.primary_seconds) * (1.0 + SHADOWS_PER_HITS) - stats.primary_seconds,
            Stage::Shadow if share > 0.0 => all(stats.shadow_seconds) - stats.shadow_seconds,
            Stage::Shadow => SHADOWS_PER_HITS * stats.primary_seconds,
            Stage::Edges | Stage::Done | Stage::Parted => 0.0,
        };
        Duration::try_from_secs_f64(seconds).ok()
    }

    /// What is being done, and how many pixels of how many are settled: in words for people.
    #[must_use]
    pub fn activity(&self) -> (&'static str, u64, u64) {
        let stats = &self.book.stats;
        let pixels = (self.task.film.width * self.task.film.height) as u64;
        let proved = stats.proved_empty + stats.proved_hit + stats.proved_partly;
        match self.stage {
            Stage::Grid => ("grid", 0, pixels),
            Stage::Primary if self.task.method == Method::Certified => ("surface: pixels proved", proved, pixels),
            Stage::Primary => {
                let band = self.task.window.fresh();
                let rows = band.start as f64 + band.len() as f64 * self.share();
                ("surface: pixels", (self.task.film.width as f64 * rows) as u64, pixels)
            }
            Stage::Shadow => {
                let all = stats.hits * stats.lights as u64;
                ("light: hits", stats.lit + stats.partly + stats.dark, all)
            }
            Stage::Edges | Stage::Done | Stage::Parted => ("colours", pixels, pixels),
        }
    }
}

/// How much longer shadows take than hits: the certified method on the presets, between 0.2 and 2.5.
const SHADOWS_PER_HITS: f64 = 1.5;
