//! The left panel: the formula with its errors, the sliders, the gallery.
use super::{App, Note, bar::name, theme};
use crate::worker::Refusal;
use eframe::egui::{
    self, Color32, FontSelection, RichText, Stroke,
    text::{LayoutJob, TextFormat},
};
use std::ops::Range;

/// Most bytes of a formula that one edits: longer ones would hold up the window.
const MOST: usize = 20_000;

impl App {
    pub(super) fn left(&mut self, ui: &mut egui::Ui) {
        self.formula(ui);
        self.sliders(ui);
        ui.add_space(6.0);
        ui.separator();
        if let Some(name) = self.gallery.show(ui, &self.model.document().name) {
            self.finder.ask(name);
        }
    }

    fn formula(&mut self, ui: &mut egui::Ui) {
        let surfaces = self.model.document().file.surface.len();
        self.surface = self.surface.min(surfaces.saturating_sub(1));
        ui.horizontal(|ui| {
            ui.label(RichText::new("Formula").strong());
            if surfaces > 1 {
                for k in 0..surfaces {
                    if ui.selectable_label(self.surface == k, format!("{}", k + 1)).clicked() {
                        self.surface = k;
                    }
                }
            }
        });
        let written =
            self.model.document().file.surface.get(self.surface).map(|s| s.formula.clone()).unwrap_or_default();
        if self.text != written {
            self.text = written;
        }
        let revision = self.model.revision();
        let refusal = self.refusal.as_ref().filter(|(r, _)| *r == revision).map(|(_, refusal)| refusal.clone());
        let place = refusal.as_ref().and_then(|r| r.place.clone()).filter(|(k, _)| *k == self.surface).map(|(_, p)| p);
        let mut layout = |ui: &egui::Ui, text: &dyn egui::TextBuffer, width: f32| {
            let font = FontSelection::from(egui::TextStyle::Monospace).resolve(ui.style());
            let mut job = marked(text.as_str(), place.clone(), &TextFormat::simple(font, theme::INK));
            job.wrap.max_width = width;
            ui.fonts_mut(|fonts| fonts.layout_job(job))
        };
        if self.text.len() > MOST {
            let words =
                format!("This formula has {} bytes: it is drawn, but too long to be edited here.", self.text.len());
            ui.label(RichText::new(words).color(theme::FAINT));
            return self.below(ui, refusal.as_ref());
        }
        let mut text = std::mem::take(&mut self.text);
        let field = egui::ScrollArea::vertical().id_salt("formula").max_height(150.0).show(ui, |ui| {
            let edit = egui::TextEdit::multiline(&mut text)
                .font(egui::TextStyle::Monospace)
                .desired_rows(3)
                .char_limit(MOST)
                .desired_width(f32::INFINITY)
                .layouter(&mut layout);
            ui.add(edit)
        });
        name(&field.inner, "Text of the formula");
        if field.inner.changed() {
            self.player.stop();
            self.model.set_formula(self.surface, &text);
        }
        if field.inner.lost_focus() {
            self.model.settle();
        }
        self.text = text;
        self.below(ui, refusal.as_ref());
    }

    /// What is wrong with the formula, and what there is to say about it.
    fn below(&self, ui: &mut egui::Ui, refusal: Option<&Refusal>) {
        if let Some(refusal) = refusal {
            let bad = |text: String| RichText::new(text).size(12.5).color(theme::BAD);
            let place = refusal.place.as_ref().filter(|(k, _)| *k == self.surface).map(|(_, place)| place.clone());
            if let Some(place) = place {
                let Mistake { title, excerpt, caret, help } = Mistake::of(&refusal.message, &self.text, place);
                ui.label(bad(title));
                ui.add(egui::Label::new(bad(format!("{excerpt}\n{caret}")).monospace()).extend());
                if let Some(help) = help {
                    ui.label(RichText::new(help).size(12.5).color(theme::FAINT));
                }
            } else {
                egui::ScrollArea::vertical().id_salt("error").max_height(150.0).show(ui, |ui| {
                    ui.label(bad(refusal.message.clone()).monospace());
                });
            }
            if !self.sides.is_empty() {
                ui.label(RichText::new("The picture is the last one that could be drawn.").small().color(theme::FAINT));
            }
        }
        if let Some(about) = &self.model.document().file.about {
            let (credit, history) = (about.credit(), about.history.clone());
            if !credit.is_empty() {
                ui.label(RichText::new(credit).small().color(theme::ACCENT));
            }
            if let Some(history) = history {
                ui.label(RichText::new(history).small().color(theme::FAINT));
            }
        }
    }

    fn sliders(&mut self, ui: &mut egui::Ui) {
        let sliders = self.model.sliders().to_vec();
        if sliders.is_empty() {
            return;
        }
        ui.add_space(6.0);
        ui.label(RichText::new("Parameters").strong());
        for slider in sliders {
            ui.horizontal(|ui| {
                let plays = self.player.plays(&slider.name);
                let label = if plays { "stop" } else { "play" };
                let hover = if plays { format!("Stop {}", slider.name) } else { format!("Move {}", slider.name) };
                let button = ui.small_button(label).on_hover_text(&hover);
                name(&button, &hover);
                if button.clicked() {
                    self.player.toggle(&self.model, &slider.name);
                }
                let mut value = slider.value;
                let [lo, hi] = slider.range;
                ui.spacing_mut().slider_width = (ui.available_width() - 120.0).max(60.0);
                let field = ui.add(
                    egui::Slider::new(&mut value, lo..=hi)
                        .clamping(egui::SliderClamping::Edits)
                        .max_decimals(4)
                        .text(&slider.name),
                );
                if field.changed() && value != slider.value {
                    if !self.player.plays(&slider.name) {
                        self.player.stop();
                    }
                    if let Err(error) = self.model.set_parameter(&slider.name, value) {
                        self.note = Some(Note::Bad(error));
                    }
                }
                if field.drag_stopped() || field.lost_focus() {
                    self.model.settle();
                }
            });
        }
    }
}

/// A mistake in a formula, in as many letters as the panel is wide.
struct Mistake {
    title: String,
    /// What is written around the place, in one line.
    excerpt: String,
    /// Carets under the place, and what could have stood there.
    caret: String,
    help: Option<String>,
}

impl Mistake {
    /// Out of the heart's message: its first line, what stands behind its carets, and its advice.
    fn of(message: &str, text: &str, place: Range<usize>) -> Self {
        const SIDE: usize = 15;
        let letters: Vec<(usize, char)> = text.char_indices().collect();
        let start = letters.iter().position(|(k, _)| *k >= place.start).unwrap_or(letters.len());
        let end = letters.iter().position(|(k, _)| *k >= place.end).unwrap_or(letters.len()).max(start + 1);
        let (from, to) = (start.saturating_sub(SIDE), (start + SIDE + 4).min(letters.len()));
        let head = if from > 0 { "…" } else { "" };
        let shown: String = letters[from..to].iter().map(|(_, c)| if c.is_whitespace() { ' ' } else { *c }).collect();
        let tail = if to < letters.len() { "…" } else { "" };
        let label = message.lines().find_map(|line| {
            let after = line.split_once('^')?.1.trim_start_matches('^');
            (line.trim_start().starts_with('|')).then(|| after.trim().to_owned())
        });
        let carets = "^".repeat((end - start).min(to.max(start + 1) - start));
        let indent = " ".repeat(head.chars().count() + start - from);
        Self {
            title: message.lines().next().unwrap_or_default().to_owned(),
            excerpt: format!("{head}{shown}{tail}"),
            caret: format!("{indent}{carets} {}", label.unwrap_or_default()).trim_end().to_owned(),
            help: message.lines().find_map(|line| Some(line.split_once("= help: ")?.1.to_owned())),
        }
    }
}

/// The text with a line under a place; under the last letter where the place is the end.
fn marked(text: &str, place: Option<Range<usize>>, plain: &TextFormat) -> LayoutJob {
    let mut job = LayoutJob::default();
    let Some(place) = place else {
        job.append(text, 0.0, plain.clone());
        return job;
    };
    let floor = |k: usize| (0..=k.min(text.len())).rev().find(|k| text.is_char_boundary(*k)).unwrap_or(0);
    let ceil = |k: usize| (k.min(text.len())..=text.len()).find(|k| text.is_char_boundary(*k)).unwrap_or(text.len());
    let mut start = floor(place.start);
    if start == text.len() {
        start = text.char_indices().next_back().map_or(0, |(k, _)| k);
    }
    let end = ceil(place.end.max(start + 1));
    let bad = TextFormat {
        underline: Stroke::new(2.0, theme::BAD),
        background: Color32::from_rgba_unmultiplied(244, 115, 104, 36),
        ..plain.clone()
    };
    for (part, format) in [(&text[..start], plain), (&text[start..end], &bad), (&text[end..], plain)] {
        if !part.is_empty() {
            job.append(part, 0.0, format.clone());
        }
    }
    job
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mistakes_are_short_and_carets_stand_under_them() {
        use antumbra::expr::Formula;
        for (text, at) in [("x^2 + $ y", '$'), ("x^2 + y^2 + z^2 + x^2 + y^2 + z^2 = 1 = 2 + x", '='), ("π + $", '$')]
        {
            let error = Formula::parse(text).unwrap_err();
            let message = error.render(text);
            let mistake = Mistake::of(message.strip_prefix("error: ").unwrap(), text, error.span());
            assert!(mistake.excerpt.chars().count() < 42, "{}", mistake.excerpt);
            let column = mistake.caret.chars().position(|c| c == '^').unwrap();
            assert_eq!(mistake.excerpt.chars().nth(column), Some(at), "{}\n{}", mistake.excerpt, mistake.caret);
            assert_eq!(mistake.title, error.message());
        }
        let error = Formula::parse("x +").unwrap_err();
        let mistake = Mistake::of(&error.render("x +"), "x +", error.span());
        assert_eq!(mistake.caret.find('^'), Some(3), "after the end: {}", mistake.caret);
    }

    #[test]
    fn places_are_marked_whatever_the_text() {
        let plain = TextFormat::default();
        let parts = |text: &str, place| {
            let job = marked(text, Some(place), &plain);
            job.sections.iter().map(|s| text[s.byte_range.start.0..s.byte_range.end.0].to_owned()).collect::<Vec<_>>()
        };
        assert_eq!(parts("x + $ y", 4..5), ["x + ", "$", " y"]);
        assert_eq!(parts("x +", 3..3), ["x ", "+"], "at the end");
        assert_eq!(parts("π×", 1..1), ["π", "×"], "inside of a letter");
        assert_eq!(parts("x", 7..90), ["x"]);
        assert!(parts("", 0..1).is_empty() || parts("", 0..1).concat().is_empty());
    }
}
