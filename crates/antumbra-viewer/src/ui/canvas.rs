//! The picture: hands turn, move and enlarge it; the line between two methods; what is known of a pixel.
use super::{App, Tool, controls::TURN, inspect, side::Side, theme};
use crate::worker::Kind;
use antumbra::geom::{Camera, Vec3};
use eframe::egui::{self, Align2, Color32, FontId, Pos2, Rect, RichText, Sense, Stroke, Vec2};

/// Most pixels of the finest picture: larger windows show it a little enlarged.
const MOST: f32 = 2_000_000.0;
/// Points on both sides of the line at which it is taken by a hand, and around the handle of a light.
const GRIP: f32 = 7.0;

impl App {
    pub(super) fn canvas(&mut self, ui: &mut egui::Ui) {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Picture"));
        self.pixels = pixels(rect.size(), ui.ctx().pixels_per_point());
        let sides = self.model.document().methods().len();
        let line = rect.left() + self.split * rect.width();
        for (k, side) in self.sides.iter().take(sides).enumerate() {
            let part = match (sides, k) {
                (1, _) => rect,
                (_, 0) => rect.with_max_x(line),
                _ => rect.with_min_x(line),
            };
            paint(ui, side, rect, part);
        }
        // The handles come first: what they take, the picture does not get.
        let taken = (sides > 1 && self.split_line(ui, rect)) | self.light_handle(ui, rect);
        if !taken {
            self.gestures(ui, rect, &response);
        }
        if response.hovered() || response.has_focus() {
            self.wheel(ui, rect);
        }
        if let Some(at) = response.hover_pos().filter(|_| !response.dragged()) {
            self.inspector(ui, rect, at);
        }
        self.legend(ui, rect);
        if self.sides.is_empty() {
            let font = FontId::proportional(15.0);
            ui.painter().text(rect.center(), Align2::CENTER_CENTER, "drawing…", font, theme::FAINT);
        }
    }

    fn gestures(&mut self, ui: &egui::Ui, rect: Rect, response: &egui::Response) {
        if response.double_clicked() {
            self.model.fit_camera();
            return;
        }
        if response.drag_stopped() {
            self.model.settle();
        }
        let by = response.drag_delta();
        if !response.dragged() || by == Vec2::ZERO {
            return;
        }
        let short = f64::from(rect.width().min(rect.height()).max(1.0));
        let (x, y) = (f64::from(by.x) / short, f64::from(by.y) / short);
        let modifiers = ui.input(|i| i.modifiers);
        let primary = response.dragged_by(egui::PointerButton::Primary);
        let tool = match self.tool {
            _ if !primary || modifiers.shift => Tool::Pan,
            _ if modifiers.command => Tool::Light,
            tool => tool,
        };
        match tool {
            Tool::Orbit => self.model.move_camera(|orbit| orbit.turned(-TURN * x, TURN * y)),
            Tool::Pan => self.model.move_camera(|orbit| orbit.moved(-x, y)),
            Tool::Light => {
                if let Some(place) = self.model.light_direction(self.light) {
                    self.model.place_light(self.light, place.turned(TURN * x, -TURN * y));
                }
            }
        }
    }

    fn wheel(&mut self, ui: &egui::Ui, rect: Rect) {
        let (scroll, pinch) = ui.input(|i| (i.smooth_scroll_delta.y, i.zoom_delta()));
        let factor = f64::from(-scroll / rect.height().max(1.0) * 2.0).exp() / f64::from(pinch);
        if factor != 1.0 {
            self.model.move_camera(|orbit| orbit.zoomed(factor));
        }
    }

    /// The line between two methods; tells whether a hand has it.
    fn split_line(&mut self, ui: &egui::Ui, rect: Rect) -> bool {
        let x = rect.left() + self.split * rect.width();
        let grip = Rect::from_x_y_ranges(x - GRIP..=x + GRIP, rect.y_range());
        let response = ui.interact(grip, ui.scope_id().with("split"), Sense::drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, "Line between the methods"));
        let response = response.on_hover_cursor(egui::CursorIcon::ResizeHorizontal);
        if response.dragged() && rect.width() > 0.0 {
            self.split = (self.split + response.drag_delta().x / rect.width()).clamp(0.02, 0.98);
        }
        let strong = response.hovered() || response.dragged();
        let color = if strong { theme::ACCENT } else { theme::INK };
        let painter = ui.painter_at(rect);
        painter.line_segment([Pos2::new(x, rect.top()), Pos2::new(x, rect.bottom())], Stroke::new(1.5, color));
        painter.circle_filled(Pos2::new(x, rect.center().y), 7.0, color);
        let names = self.model.document().methods();
        let place = [
            (Pos2::new(x - 12.0, rect.top() + 12.0), Align2::RIGHT_TOP),
            (Pos2::new(x + 12.0, rect.top() + 12.0), Align2::LEFT_TOP),
        ];
        for (method, (at, align)) in names.iter().zip(place) {
            let galley = painter.layout_no_wrap(method.name().to_owned(), FontId::proportional(13.0), theme::INK);
            let frame = align.anchor_size(at, galley.size());
            painter.rect_filled(frame.expand2(Vec2::new(7.0, 4.0)), 5.0, Color32::from_black_alpha(170));
            painter.galley(frame.min, galley, theme::INK);
        }
        response.hovered() || response.dragged()
    }

    /// The light where it is in the picture, to be taken by a hand: it moves parallel to the picture. Shown with the tool for it.
    fn light_handle(&mut self, ui: &egui::Ui, rect: Rect) -> bool {
        if self.tool != Tool::Light {
            return false;
        }
        let (Some(view), Some(scene)) = (self.model.view(), self.model.scene().cloned()) else { return false };
        let Some(light) = scene.lights.get(self.light) else { return false };
        let camera = view.camera(f64::from(rect.width() / rect.height().max(1.0)));
        let centre = self.model.lights().get(self.light).map_or(light.rect.center, |entry| Vec3(entry.center));
        let corner = |u: f64, v: f64| screen(&camera, rect, light.rect.point(u, v) - light.rect.center + centre);
        let corners: Vec<Pos2> = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .into_iter()
            .filter_map(|(u, v)| corner(u, v))
            .collect();
        let painter = ui.painter_at(rect);
        if corners.len() == 4 {
            let line = Stroke::new(1.5, theme::ACCENT);
            painter.add(egui::Shape::convex_polygon(corners, theme::ACCENT.gamma_multiply(0.25), line));
        }
        let (Some(at), Some((film, depth))) = (screen(&camera, rect, centre), camera.project(centre)) else {
            return false;
        };
        if !rect.contains(at) {
            return false;
        }
        let response = ui.interact(
            Rect::from_center_size(at, Vec2::splat(3.0 * GRIP)),
            ui.scope_id().with("light"),
            Sense::drag(),
        );
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, "Light"));
        painter.circle_filled(at, GRIP, theme::ACCENT);
        let by = response.drag_delta();
        if response.dragged() && by != Vec2::ZERO {
            let moved =
                [film[0] + 2.0 * f64::from(by.x / rect.width()), film[1] - 2.0 * f64::from(by.y / rect.height())];
            self.model.change_light(self.light, |entry| entry.center = camera.point(moved, depth).0);
        }
        self.settle_after(&response);
        response.hovered() || response.dragged()
    }

    /// What is known of the pixel under the pointer.
    fn inspector(&self, ui: &egui::Ui, rect: Rect, at: Pos2) {
        let sides = self.model.document().methods().len();
        let right = sides > 1 && at.x > rect.left() + self.split * rect.width();
        let Some(side) = self.sides.get(usize::from(right)) else { return };
        let share = (at - rect.min) / rect.size();
        let pixel = |size: [usize; 2]| {
            let place = |share: f32, n: usize| ((share * n as f32) as usize).min(n.saturating_sub(1));
            (place(share.x, size[0]), place(share.y, size[1]))
        };
        // The finer picture where it is known.
        let known = side.fine.as_ref().map(|p| &p.image).filter(|image| {
            let (column, row) = pixel(image.size);
            crate::worker::is_settled(&image.frame, row * image.size[0] + column)
        });
        // What lies below may be the picture before: of that nothing is said.
        let now = side.best().map(|image| image.revision);
        let below = side.base.as_ref().map(|p| &p.image).filter(|image| Some(image.revision) == now);
        let Some(image) = known.or(below) else { return };
        let (column, row) = pixel(image.size);
        let tolerance = self.model.document().tolerance();
        let lines = inspect::lines(&image.frame, image.method, tolerance, row * image.size[0] + column);
        egui::Area::new(egui::Id::unique("inspector"))
            .fixed_pos(rect.left_bottom() + Vec2::new(12.0, -12.0))
            .pivot(Align2::LEFT_BOTTOM)
            .interactable(false)
            .show(ui.ctx(), |ui| {
                theme::float().show(ui, |ui| {
                    ui.spacing_mut().item_spacing.y = 3.0;
                    let [w, h] = image.size;
                    ui.label(RichText::new(format!("pixel {column}, {row} of {w} × {h}")).small().color(theme::FAINT));
                    egui::Grid::new("pixel").spacing([12.0, 2.0]).show(ui, |ui| {
                        for (name, text) in lines {
                            ui.label(RichText::new(name).small().color(theme::FAINT));
                            ui.label(RichText::new(text).small().monospace());
                            ui.end_row();
                        }
                    });
                });
            });
    }

    /// Colours and meanings of the overlay.
    fn legend(&self, ui: &egui::Ui, rect: Rect) {
        let Some(image) = self.sides.first().and_then(Side::best).filter(|image| !image.legend.is_empty()) else {
            return;
        };
        // What is told of a pixel stands below, and often there is no room beside it.
        egui::Area::new(egui::Id::unique("legend"))
            .fixed_pos(rect.right_top() + Vec2::new(-12.0, 12.0))
            .pivot(Align2::RIGHT_TOP)
            .interactable(false)
            .show(ui.ctx(), |ui| {
                theme::float().show(ui, |ui| {
                    ui.spacing_mut().item_spacing.y = 2.0;
                    // Never wider than the picture.
                    ui.set_max_width((rect.width() - 48.0).max(40.0));
                    for Kind { color: [r, g, b], text, count } in image.legend.iter().filter(|kind| kind.count > 0) {
                        ui.horizontal_wrapped(|ui| {
                            let (square, _) = ui.allocate_exact_size(Vec2::splat(11.0), Sense::hover());
                            // Dark colours have an outline.
                            let line = Stroke::new(1.0, theme::FAINT.gamma_multiply(0.5));
                            let color = Color32::from_rgb(*r, *g, *b);
                            ui.painter().rect(square, 3.0, color, line, egui::StrokeKind::Inside);
                            ui.label(RichText::new(text).small());
                            ui.label(RichText::new(count.to_string()).small().color(theme::FAINT));
                        });
                    }
                });
            });
    }
}

/// Pixels of a picture in so many points.
fn pixels(points: Vec2, per_point: f32) -> [usize; 2] {
    let all = points.x * points.y * per_point * per_point;
    let shrink = (all / MOST).sqrt().max(1.0);
    [points.x, points.y].map(|n| (n * per_point / shrink).round().max(1.0) as usize)
}

/// Where a point is seen.
fn screen(camera: &Camera, rect: Rect, point: Vec3) -> Option<Pos2> {
    let ([x, y], _) = camera.project(point)?;
    Some(rect.center() + 0.5 * Vec2::new(x as f32 * rect.width(), -y as f32 * rect.height()))
}

/// A side's pictures in a part of the place.
fn paint(ui: &egui::Ui, side: &Side, rect: Rect, part: Rect) {
    let painter = ui.painter_at(part);
    let uv = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
    for picture in [&side.base, &side.fine].into_iter().flatten() {
        painter.image(picture.texture.id(), rect, uv, Color32::WHITE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_windows_have_no_more_pixels_than_can_be_proved() {
        assert_eq!(pixels(Vec2::new(800.0, 600.0), 1.5), [1200, 900]);
        let [w, h] = pixels(Vec2::new(3840.0, 2160.0), 2.0);
        assert!(w * h <= 2_010_000 && (w as f32 / h as f32 - 16.0 / 9.0).abs() < 0.01, "{w} x {h}");
        assert_eq!(pixels(Vec2::ZERO, 1.0), [1, 1]);
    }

    #[test]
    fn points_are_shown_where_the_picture_has_them() {
        let camera = Camera::look_at(Vec3::new(0.0, -3.0, 0.0), Vec3::default(), 40.0, 1.0);
        let rect = Rect::from_min_size(Pos2::new(10.0, 20.0), Vec2::splat(100.0));
        let at = screen(&camera, rect, Vec3::default()).unwrap();
        assert!((at - Pos2::new(60.0, 70.0)).length() < 1e-3);
        let up = screen(&camera, rect, Vec3::new(0.5, 0.0, 0.5)).unwrap();
        assert!(up.x > 60.0 && up.y < 70.0, "right and up");
    }
}
