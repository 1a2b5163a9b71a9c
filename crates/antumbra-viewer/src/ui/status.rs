//! The bar below: how much is proved.
use super::{App, Note, theme};
use antumbra::render::{Method, Stats};
use eframe::egui::{self, RichText};

impl App {
    pub(super) fn status(&mut self, ui: &mut egui::Ui) {
        ui.horizontal(|ui| {
            let best = self.sides.first().and_then(|side| side.best());
            if let Some(image) = best {
                let share = proved(&image.stats);
                let certified = image.method == Method::Certified;
                let [w, h] = image.size;
                let full = self.pixels;
                // Of the finest picture: a coarse one, all proved, is not half of the way.
                let part = if image.last { 1.0 } else { (w * h) as f64 / (full[0] * full[1]).max(1) as f64 };
                let bar = egui::ProgressBar::new((part * if certified { share } else { image.progress }) as f32)
                    .desired_width(150.0)
                    .desired_height(8.0)
                    .fill(if self.done.is_some() { theme::GOOD } else { theme::ACCENT });
                ui.add(bar);
                let words = if certified {
                    format!("{} of {w} × {h} pixels proved", percent(share))
                } else {
                    format!(
                        "{w} × {h}, {}: {} done, nothing proved but empty pixels",
                        image.method.name(),
                        percent(image.progress)
                    )
                };
                ui.label(words);
                if certified && let Some((narrow, all)) = brackets(&image.stats) {
                    let share = narrow as f64 / all as f64;
                    ui.label(
                        RichText::new(format!("· {} of {all} brackets narrow enough", percent(share)))
                            .color(theme::FAINT),
                    );
                }
                if !image.last {
                    let words = format!("· on the way to {} × {}", full[0], full[1]);
                    ui.label(RichText::new(words).color(theme::FAINT));
                }
                let state = match self.done {
                    Some(seconds) => format!("· done in {seconds:.2} s"),
                    None => format!("· {:.1} s", image.seconds),
                };
                ui.label(RichText::new(state).color(theme::FAINT));
            } else {
                ui.label(RichText::new("drawing…").color(theme::FAINT));
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                match &self.note {
                    Some(Note::Good(text)) => ui.label(RichText::new(text).color(theme::GOOD)),
                    Some(Note::Bad(text)) => {
                        let short = text.lines().next().unwrap_or_default();
                        ui.label(RichText::new(short).color(theme::BAD)).on_hover_text(RichText::new(text).monospace())
                    }
                    None => ui.label(""),
                };
            });
        });
    }
}

/// Share of the pixels of which it is proved what they show.
fn proved(stats: &Stats) -> f64 {
    let pixels = (stats.width * stats.height).max(1) as f64;
    (stats.proved_empty + stats.proved_hit + stats.proved_partly) as f64 / pixels
}

/// Brackets that are as narrow as was asked for, of all that are there.
fn brackets(stats: &Stats) -> Option<(u64, u64)> {
    let all = stats.lit + stats.partly + stats.dark;
    (all > 0).then(|| (all.saturating_sub(stats.brackets_open), all))
}

/// 100 % only where it is all.
fn percent(share: f64) -> String {
    let hundredths = (share * 10_000.0).floor() / 100.0;
    if hundredths >= 100.0 { "100 %".to_owned() } else { format!("{hundredths:.2} %") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_not_rounded_up() {
        assert_eq!(percent(0.99999), "99.99 %");
        assert_eq!(percent(1.0), "100 %");
        assert_eq!(percent(0.0), "0.00 %");
    }
}
