//! How long things take: frames of the window, and pictures from the moment that they are asked for.
use crate::worker::Image;
use std::time::Instant;

/// What was measured, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timings {
    /// Frames of the window.
    pub frames: u64,
    /// The longest of them, but for the first few: those load fonts.
    pub longest: f64,
    /// Pictures that were asked for and came.
    pub answers: u64,
    /// From the question to the first picture: the longest time, and the sum of all.
    pub latency: f64,
    /// The sum.
    pub latencies: f64,
}

/// A stop-watch.
#[derive(Debug, Default)]
pub struct Meter {
    timings: Timings,
    /// Revisions that were asked for and are not answered, and when.
    open: Vec<(u64, Instant)>,
}

/// Frames at the beginning that do not count.
const WARM: u64 = 10;

impl Meter {
    /// What was measured so far.
    #[must_use]
    pub fn timings(&self) -> Timings {
        self.timings
    }

    /// A frame of the window took so long.
    pub fn frame(&mut self, seconds: f64) {
        self.timings.frames += 1;
        if self.timings.frames > WARM {
            self.timings.longest = self.timings.longest.max(seconds);
        }
    }

    /// A picture is asked for.
    pub(super) fn asked(&mut self, revision: u64) {
        if self.open.len() < 1000 {
            self.open.push((revision, Instant::now()));
        }
    }

    /// A picture came: it answers its question and those before it.
    pub(super) fn image(&mut self, image: &Image) {
        let answered = self.open.iter().rposition(|(revision, _)| *revision == image.revision);
        if let Some(place) = answered {
            let seconds = self.open[place].1.elapsed().as_secs_f64();
            self.open.drain(..=place);
            let t = &mut self.timings;
            (t.answers, t.latencies, t.latency) = (t.answers + 1, t.latencies + seconds, t.latency.max(seconds));
        }
    }
}
