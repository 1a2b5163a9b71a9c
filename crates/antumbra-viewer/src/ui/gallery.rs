//! The gallery: small pictures to choose from.
use super::{bar::name, theme};
use crate::thumbnails::{SIDE, Thumbnails};
use antumbra::scene::{GALLERY, PRESETS};
use eframe::egui::{self, Color32, ColorImage, RichText, Sense, TextureHandle, TextureOptions, Vec2};
use std::collections::HashMap;

/// How large a small picture is shown, in points.
const SHOWN: f32 = 84.0;

/// A small picture that was asked for.
enum Small {
    Drawing,
    Drawn(TextureHandle),
    Failed,
}

/// Small pictures, and what is looked for among them.
pub(super) struct Gallery {
    thumbnails: Thumbnails,
    pictures: HashMap<String, Small>,
    filter: String,
    /// Name and title of every scene.
    names: Vec<(&'static str, &'static str)>,
}

impl Gallery {
    pub(super) fn new(thumbnails: Thumbnails) -> Self {
        let gallery = GALLERY.iter().map(|e| (e.name, e.name));
        let others = PRESETS.iter().filter(|p| !GALLERY.iter().any(|e| e.name == p.name)).map(|p| (p.name, p.title));
        let names = gallery.chain(others).collect();
        Self { thumbnails, pictures: HashMap::new(), filter: String::new(), names }
    }

    /// Takes in what was drawn.
    pub(super) fn listen(&mut self, context: &egui::Context) {
        while let Some(done) = self.thumbnails.done() {
            let small = done.rgba.map_or(Small::Failed, |rgba| {
                let pixels =
                    rgba.chunks_exact(4).map(|c| Color32::from_rgba_premultiplied(c[0], c[1], c[2], c[3])).collect();
                let image = ColorImage::new([SIDE, SIDE], pixels);
                Small::Drawn(context.load_texture(format!("small {}", done.name), image, TextureOptions::LINEAR))
            });
            self.pictures.insert(done.name, small);
        }
    }

    /// The gallery; gives the name of a scene that was chosen.
    pub(super) fn show(&mut self, ui: &mut egui::Ui, current: &str) -> Option<&'static str> {
        let mut chosen = None;
        ui.horizontal(|ui| {
            ui.label(RichText::new("Gallery").strong());
            let edit = egui::TextEdit::singleline(&mut self.filter).hint_text("search").desired_width(f32::INFINITY);
            name(&ui.add(edit), "Search the gallery");
        });
        let filter = self.filter.to_lowercase();
        let found: Vec<_> = self
            .names
            .iter()
            .copied()
            .filter(|(n, t)| n.contains(&filter) || t.to_lowercase().contains(&filter))
            .collect();
        if found.is_empty() {
            ui.label(RichText::new("no surface of that name").color(theme::FAINT));
        }
        let across = ((ui.available_width() - 6.0) / (SHOWN + 8.0)).floor().max(1.0) as usize;
        let row = SHOWN + 20.0;
        let rows = found.len().div_ceil(across);
        egui::ScrollArea::vertical().id_salt("gallery").auto_shrink(false).show_rows(ui, row, rows, |ui, visible| {
            for k in visible {
                ui.horizontal(|ui| {
                    for (name, title) in found.iter().skip(k * across).take(across) {
                        if self.small(ui, name, title, *name == current) {
                            chosen = Some(*name);
                        }
                    }
                });
            }
        });
        chosen
    }

    /// One small picture; tells whether it was chosen.
    fn small(&mut self, ui: &mut egui::Ui, scene: &str, title: &str, current: bool) -> bool {
        if !self.pictures.contains_key(scene) {
            self.thumbnails.want(scene);
            self.pictures.insert(scene.to_owned(), Small::Drawing);
        }
        let (rect, response) = ui.allocate_exact_size(Vec2::new(SHOWN, SHOWN + 20.0), Sense::click());
        let response = if title == scene { response } else { response.on_hover_text(title) };
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, scene));
        let square = egui::Rect::from_min_size(rect.min, Vec2::splat(SHOWN));
        let painter = ui.painter();
        let rounding = 6.0;
        painter.rect_filled(square, rounding, theme::STAGE);
        match self.pictures.get(scene) {
            Some(Small::Drawn(texture)) => {
                let image = egui::Image::new((texture.id(), square.size())).corner_radius(rounding);
                image.paint_at(ui, square);
            }
            Some(Small::Failed) => {
                painter.text(
                    square.center(),
                    egui::Align2::CENTER_CENTER,
                    "not drawn",
                    egui::FontId::proportional(11.0),
                    theme::FAINT,
                );
            }
            Some(Small::Drawing) | None => {
                painter.text(
                    square.center(),
                    egui::Align2::CENTER_CENTER,
                    "…",
                    egui::FontId::proportional(16.0),
                    theme::FAINT,
                );
            }
        }
        let line = if response.hovered() || response.has_focus() {
            egui::Stroke::new(1.5, theme::INK)
        } else if current {
            egui::Stroke::new(2.0, theme::ACCENT)
        } else {
            egui::Stroke::NONE
        };
        ui.painter().rect_stroke(square, rounding, line, egui::StrokeKind::Inside);
        let color = if current { theme::ACCENT } else { theme::FAINT };
        let font = egui::FontId::proportional(11.0);
        let mut text = egui::text::LayoutJob::simple_singleline(scene.to_owned(), font, color);
        text.wrap = egui::text::TextWrapping::truncate_at_width(SHOWN);
        let galley = ui.fonts_mut(|fonts| fonts.layout_job(text));
        ui.painter().galley(square.left_bottom() + Vec2::new(1.0, 3.0), galley, color);
        response.clicked()
    }
}
