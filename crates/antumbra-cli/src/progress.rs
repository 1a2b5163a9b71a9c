//! The progress bar: on stderr, and only where a person is looking.

use std::{io::IsTerminal, time::Duration};

use antumbra::render::Renderer;
use indicatif::{HumanCount, HumanDuration, ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Steps of a full bar.
const STEPS: u64 = 10_000;

/// A progress bar, or nothing where stderr is not a terminal or the user wants quiet.
pub(crate) struct Progress(ProgressBar);

impl Progress {
    /// A bar at 0 with a word before it.
    pub(crate) fn new(quiet: bool, label: &str) -> Self {
        let seen = !quiet && std::io::stderr().is_terminal();
        let target = if seen { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(STEPS), target);
        if let Ok(style) = ProgressStyle::with_template("{prefix} {wide_bar} {percent:>3} %  {elapsed}{msg}") {
            bar.set_style(style);
        }
        bar.set_prefix(label.to_owned());
        Self(bar)
    }

    /// Shows a fraction in [0, 1].
    pub(crate) fn set(&self, fraction: f64) {
        self.0.set_position((fraction.clamp(0.0, 1.0) * STEPS as f64) as u64);
        self.0.set_message(format!(" (left: {})", HumanDuration(self.0.eta())));
    }

    /// Shows how far a render is, which pass it is in, and how long the rest may take.
    pub(crate) fn show(&self, renderer: &Renderer) {
        let (what, done, all) = renderer.activity();
        let left = renderer.remaining().map_or(String::new(), |time| format!(" (left: about {})", HumanDuration(time)));
        self.0.set_position((renderer.progress() * STEPS as f64) as u64);
        self.0.set_message(format!("  {what} {} of {}{left}", HumanCount(done), HumanCount(all)));
    }
}

impl Progress {
    /// Shows which frame of an animation is being drawn, how much of all is done, and how long the rest may take.
    pub(crate) fn show_frame(&self, k: usize, n: usize, done: f64, left: Option<Duration>) {
        let left = left.map_or(String::new(), |time| format!(" (left: about {})", HumanDuration(time)));
        self.0.set_position((done * STEPS as f64) as u64);
        self.0.set_message(format!("  {} of {n}{left}", k + 1));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
