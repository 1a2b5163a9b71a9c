//! The windows over the picture: export, keys.
use super::{App, Note, bar::name, theme};
use crate::export::{Export, Order, Progress};
use antumbra::{image::MOST_SIDE, render::Overlay};
use eframe::egui::{self, RichText};
use std::path::{Path, PathBuf};

/// What is asked before a picture is written.
#[derive(Clone, Debug)]
pub(super) struct ExportForm {
    path: String,
    size: [usize; 2],
    deep: bool,
    overlay: Option<Overlay>,
}

impl App {
    pub(super) fn begin_exporting(&mut self) {
        let name: String =
            self.model.document().name.chars().filter(|c| c.is_alphanumeric() || "-_".contains(*c)).collect();
        let path = format!("{}.png", if name.is_empty() { "picture" } else { &name });
        self.form = Some(ExportForm {
            path,
            size: self.pixels.map(|n| (2 * n).min(MOST_SIDE)),
            deep: false,
            overlay: self.overlay,
        });
    }

    pub(super) fn export_window(&mut self, context: &egui::Context) {
        self.export_progress(context);
        let Some(mut form) = self.form.take() else { return };
        let (mut open, mut write) = (true, false);
        egui::Window::new("Export")
            .open(&mut open)
            .resizable(false)
            .collapsible(false)
            .default_pos([380.0, 90.0])
            .show(context, |ui| {
                egui::Grid::new("export").num_columns(2).spacing([12.0, 8.0]).show(ui, |ui| {
                    ui.label("file");
                    let field = ui.add(egui::TextEdit::singleline(&mut form.path).desired_width(280.0));
                    name(&field, "Picture file");
                    ui.end_row();
                    ui.label("size");
                    ui.horizontal(|ui| {
                        let number = |ui: &mut egui::Ui, n: &mut usize, label: &str| {
                            let field = ui.add(egui::DragValue::new(n).range(1..=MOST_SIDE).speed(4.0));
                            name(&field, label);
                        };
                        number(ui, &mut form.size[0], "Width");
                        ui.label("×");
                        number(ui, &mut form.size[1], "Height");
                        if ui.button("as the window").clicked() {
                            form.size = self.pixels;
                        }
                    });
                    ui.end_row();
                    ui.label("");
                    ui.checkbox(&mut form.deep, "16 bits per channel (PNG)");
                    ui.end_row();
                });
                let format = if form.path.to_lowercase().ends_with(".exr") {
                    "EXR: every plane, linear light"
                } else {
                    ".png for looking, .exr for all planes"
                };
                ui.label(RichText::new(format).small().color(theme::FAINT));
                if Path::new(&form.path).exists() {
                    ui.label(RichText::new("exists, and will be replaced").small().color(theme::FAINT));
                }
                let busy = self.export.is_some();
                write = ui.add_enabled(!busy, egui::Button::new("Write picture")).clicked();
                if busy {
                    ui.label(RichText::new("another one is being written").small().color(theme::FAINT));
                }
            });
        if write {
            match self.order(&form, context) {
                Ok(export) => {
                    (self.export, open) = (Some(export), false);
                }
                Err(error) => self.note = Some(Note::Bad(error)),
            }
        }
        self.form = Some(form).filter(|_| open);
    }

    fn order(&self, form: &ExportForm, context: &egui::Context) -> Result<Export, String> {
        let document = self.model.document();
        let order = Order {
            path: PathBuf::from(&form.path),
            name: document.name.clone(),
            file: document.complete(),
            size: form.size,
            method: document.method,
            overlay: form.overlay,
            deep: form.deep,
        };
        let context = context.clone();
        Export::begin(order, &self.host, self.run, move || context.request_repaint())
    }

    /// How far the export is, with a way to end it.
    fn export_progress(&mut self, context: &egui::Context) {
        let Some(export) = &self.export else { return };
        let end = match export.progress() {
            Progress::Drawing(share, rest) => {
                egui::Window::new("Writing a picture")
                    .resizable(false)
                    .collapsible(false)
                    .anchor(egui::Align2::RIGHT_TOP, [-286.0, 58.0])
                    .show(context, |ui| {
                        ui.add(egui::ProgressBar::new(share as f32).desired_width(220.0).show_percentage());
                        ui.horizontal(|ui| {
                            if ui.button("Cancel export").clicked() {
                                export.cancel();
                            }
                            if let Some(rest) = rest {
                                let words = format!("about {:.0} s left", rest.as_secs_f64().max(1.0));
                                ui.label(RichText::new(words).small().color(theme::FAINT));
                            }
                        });
                    });
                return;
            }
            Progress::Written(path) => Note::Good(format!("wrote {}", path.display())),
            Progress::Cancelled => Note::Good("export cancelled, nothing was written".to_owned()),
            Progress::Failed(error) => Note::Bad(error),
        };
        (self.note, self.export) = (Some(end), None);
    }

    pub(super) fn help_window(&mut self, context: &egui::Context) {
        if !self.help {
            return;
        }
        egui::Window::new("Keys and gestures").open(&mut self.help).resizable(false).collapsible(false).show(
            context,
            |ui| {
                egui::Grid::new("keys").num_columns(2).spacing([18.0, 4.0]).show(ui, |ui| {
                    for (keys, what) in KEYS {
                        ui.label(RichText::new(*keys).monospace().color(theme::ACCENT));
                        ui.label(*what);
                        ui.end_row();
                    }
                });
                if !self.drawn_by.is_empty() {
                    let words = format!("The window is drawn with {}.", self.drawn_by);
                    ui.label(RichText::new(words).small().color(theme::FAINT));
                }
            },
        );
    }
}

/// Every key and gesture.
const KEYS: &[(&str, &str)] = &[
    ("drag", "turn the camera (or what the tool says)"),
    ("right drag, Shift+drag", "move it aside"),
    ("Ctrl+drag", "turn the light"),
    ("wheel, pinch, + -", "nearer, further"),
    ("arrows", "turn by five degrees"),
    ("double click, F", "see everything"),
    ("R", "the camera as it was opened"),
    ("P", "perspective or parallel"),
    ("O M L", "tools: turn, move, light"),
    ("1 2 3 4 0", "verdict, shadow class, cost, bracket width, colours"),
    ("Ctrl+Z, Ctrl+Shift+Z", "undo, redo"),
    ("Ctrl+S, Ctrl+E", "save the scene, export a picture"),
];
