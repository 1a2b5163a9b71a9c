//! The bar above: opening, saving, the way back.
use super::{App, Note, theme};
use eframe::egui::{self, RichText};

impl App {
    pub(super) fn bar(&mut self, ui: &mut egui::Ui) {
        ui.horizontal(|ui| {
            ui.label(RichText::new("Antumbra").heading().strong().color(theme::ACCENT));
            ui.add_space(10.0);
            let title = self.model.document().file.title.clone().unwrap_or_else(|| self.model.document().name.clone());
            ui.label(RichText::new(title).heading());
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if ui.button("?").on_hover_text("Keys and gestures").clicked() {
                    self.help = !self.help;
                }
                if ui.button("Export…").on_hover_text("A picture of any size (Ctrl+E)").clicked() {
                    self.begin_exporting();
                }
                if ui.button("Save…").on_hover_text("The scene as a file (Ctrl+S)").clicked() {
                    self.begin_saving();
                }
                let [back, forth] = self.model.ways();
                if ui.add_enabled(forth, egui::Button::new("Redo")).on_hover_text("Ctrl+Shift+Z").clicked() {
                    self.model.redo();
                }
                if ui.add_enabled(back, egui::Button::new("Undo")).on_hover_text("Ctrl+Z").clicked() {
                    self.model.undo();
                }
                ui.add_space(6.0);
                let hint = "Open: a name, a scene file, a formula";
                let edit = egui::TextEdit::singleline(&mut self.open).hint_text(hint).desired_width(260.0);
                let field = ui.add(edit).on_hover_text("Enter opens it; files can be dropped on the window too");
                name(&field, "Open");
                let entered = field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
                if entered && !self.open.trim().is_empty() {
                    let text = std::mem::take(&mut self.open);
                    self.finder.ask(text.trim());
                }
            });
        });
        self.save_line(ui);
    }

    pub(super) fn begin_saving(&mut self) {
        let name: String =
            self.model.document().name.chars().filter(|c| c.is_alphanumeric() || "-_".contains(*c)).collect();
        self.save = Some(format!("{}.toml", if name.is_empty() { "scene" } else { &name }));
    }

    /// The line in which the name of a file is typed, while there is one.
    fn save_line(&mut self, ui: &mut egui::Ui) {
        let Some(mut path) = self.save.take() else { return };
        let (mut keep, mut write) = (true, false);
        ui.horizontal(|ui| {
            ui.label("Save the scene as");
            let field = ui.add(egui::TextEdit::singleline(&mut path).desired_width(320.0));
            name(&field, "File name");
            write = field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
            write |= ui.button("Write").clicked();
            keep = !ui.button("Cancel").clicked();
            if std::path::Path::new(&path).exists() {
                ui.label(RichText::new("exists, and will be replaced").color(theme::FAINT));
            }
        });
        if write {
            self.note = Some(match self.write_scene(&path) {
                Ok(()) => Note::Good(format!("wrote {path}")),
                Err(error) => Note::Bad(error),
            });
            keep = matches!(self.note, Some(Note::Bad(_)));
        }
        self.save = Some(path).filter(|_| keep);
    }

    fn write_scene(&self, path: &str) -> Result<(), String> {
        let path = std::path::Path::new(path);
        if path.extension().is_none_or(|e| e != "toml") {
            return Err(format!("`{}` should end in .toml, so that it is known as a scene file", path.display()));
        }
        let text = self.model.document().complete().text().map_err(|e| e.to_string())?;
        self.host.reserve(path)?.fill(text.as_bytes())
    }
}

/// Gives a field the name by which screen readers, and tests, find it.
pub(super) fn name(field: &egui::Response, name: &str) {
    let name = name.to_owned();
    field.ctx.accesskit_node_builder(field.id, |node| node.set_label(name));
}
