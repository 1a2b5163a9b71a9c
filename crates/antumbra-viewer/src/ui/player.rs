//! A parameter that moves by itself, there and back again.
use crate::model::Model;
use eframe::egui::Context;

/// Seconds from one end of the range to the other and back.
const PERIOD: f64 = 6.0;

/// What moves.
#[derive(Debug, Default)]
pub(super) struct Player {
    /// Its name, and where it is in its period, 0 to 1.
    playing: Option<(String, f64)>,
    /// The revision that was asked for last.
    asked: u64,
}

impl Player {
    /// Whether that parameter moves.
    pub(super) fn plays(&self, name: &str) -> bool {
        self.playing.as_ref().is_some_and(|(n, _)| n == name)
    }

    /// Starts it, from the value that it has, or stops it.
    pub(super) fn toggle(&mut self, model: &Model, name: &str) {
        if self.plays(name) {
            return self.stop();
        }
        let Some(slider) = model.sliders().iter().find(|s| s.name == name) else { return };
        let [lo, hi] = slider.range;
        self.playing = Some((name.to_owned(), 0.5 * ((slider.value - lo) / (hi - lo)).clamp(0.0, 1.0)));
        self.asked = 0;
    }

    pub(super) fn stop(&mut self) {
        self.playing = None;
    }

    /// Goes on, as soon as what was asked for is drawn: pictures never fall behind.
    pub(super) fn play(&mut self, context: &Context, model: &mut Model, seen: u64) {
        let Some((name, phase)) = &mut self.playing else { return };
        context.request_repaint();
        if self.asked > seen {
            return;
        }
        let Some(slider) = model.sliders().iter().find(|s| s.name == *name) else { return self.stop() };
        let [lo, hi] = slider.range;
        let seconds = context.input(|i| i.stable_dt).min(0.25);
        *phase = (*phase + f64::from(seconds) / PERIOD).fract();
        let share = 1.0 - (2.0 * *phase - 1.0).abs();
        let (name, value) = (name.clone(), lo + share * (hi - lo));
        if model.set_parameter(&name, value).is_err() {
            return self.stop();
        }
        self.asked = model.revision();
    }
}
