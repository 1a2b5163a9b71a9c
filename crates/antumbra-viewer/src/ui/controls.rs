//! The right panel: view, light, clip, method, what is shown.
use super::{App, Tool, bar::name, theme};
use antumbra::{
    geom::Vec3,
    render::{Method, Overlay},
    scene::{ClipEntry, LightEntry, Orbit, SceneFile},
};
use eframe::egui::{self, RichText, Sense, Vec2};
use std::f64::consts::{FRAC_PI_2, PI};

impl App {
    pub(super) fn controls(&mut self, ui: &mut egui::Ui) {
        section(ui, "View");
        self.camera(ui);
        section(ui, "Show");
        self.shown(ui);
        section(ui, "Proof");
        self.proof(ui);
        section(ui, "Light");
        self.lights(ui);
        section(ui, "Clip");
        self.clip(ui);
    }

    fn camera(&mut self, ui: &mut egui::Ui) {
        ui.horizontal(|ui| {
            for (tool, label, hover) in [
                (Tool::Orbit, "Turn", "Dragging turns the camera (O)"),
                (Tool::Pan, "Move", "Dragging moves it aside (M, or the right button)"),
                (Tool::Light, "Sun", "Dragging turns the light (L, or Ctrl)"),
            ] {
                if ui.selectable_label(self.tool == tool, label).on_hover_text(hover).clicked() {
                    self.tool = tool;
                }
            }
        });
        ui.horizontal(|ui| {
            if ui.button("Reset").on_hover_text("As it was opened (R)").clicked() {
                self.model.reset_camera();
            }
            if ui.button("Fit").on_hover_text("See everything (F)").clicked() {
                self.model.fit_camera();
            }
        });
        let Some(orbit) = self.model.orbit() else { return };
        ui.horizontal(|ui| {
            let mut parallel = orbit.parallel;
            ui.selectable_value(&mut parallel, false, "Perspective");
            ui.selectable_value(&mut parallel, true, "Parallel").on_hover_text("Orthographic (P)");
            if parallel != orbit.parallel {
                self.model.move_camera(|orbit| Orbit { parallel, ..orbit });
                self.model.settle();
            }
        });
        if !orbit.parallel {
            let mut angle = orbit.fov_deg;
            let field = ui.add(slider(&mut angle, 5.0..=100.0).suffix("°").max_decimals(1).text("angle"));
            if field.changed() {
                self.model.move_camera(|orbit| Orbit { fov_deg: angle, ..orbit });
            }
            self.settle_after(&field);
        }
    }

    fn lights(&mut self, ui: &mut egui::Ui) {
        let lights = self.model.lights();
        if lights.is_empty() {
            ui.label(RichText::new("no light of its own").color(theme::FAINT));
            return;
        }
        self.light = self.light.min(lights.len() - 1);
        if lights.len() > 1 {
            ui.horizontal(|ui| {
                for k in 0..lights.len() {
                    ui.selectable_value(&mut self.light, k, format!("{}", k + 1));
                }
            });
        }
        let (light, k) = (lights[self.light], self.light);
        ui.horizontal(|ui| {
            self.light_pad(ui);
            ui.vertical(|ui| {
                ui.spacing_mut().slider_width = 70.0;
                let side = side(&light);
                let mut size = side;
                let scale = self.model.scene().map_or(1.0, |scene| scene.scale());
                let range = 0.01 * scale..=8.0 * scale;
                ui.label(RichText::new("size").small().color(theme::FAINT));
                let field = ui.add(slider(&mut size, range).logarithmic(true).max_decimals(3));
                name(&field, "Size of the light");
                if field.changed() && size > 0.0 {
                    self.model.change_light(k, |light| resize(light, size / side));
                }
                self.settle_after(&field);
                ui.label(RichText::new("distance").small().color(theme::FAINT));
                if let Some(place) = self.model.light_direction(k) {
                    let mut length = place.length;
                    let range = 0.5 * scale..=30.0 * scale;
                    let field = ui.add(slider(&mut length, range).logarithmic(true).max_decimals(3));
                    name(&field, "Distance of the light");
                    if field.changed() {
                        self.model.place_light(k, antumbra::geom::Polar { length, ..place });
                    }
                    self.settle_after(&field);
                }
                ui.label(RichText::new("strength").small().color(theme::FAINT));
                let mut strength = light.strength.unwrap_or(1.0);
                let field = ui.add(slider(&mut strength, 0.0..=3.0).max_decimals(2));
                name(&field, "Strength of the light");
                if field.changed() {
                    self.model.change_light(k, |light| light.strength = Some(strength));
                }
                self.settle_after(&field);
            });
        });
        let mut floor = self.model.document().file.floor.is_some();
        if ui.checkbox(&mut floor, "floor").changed() {
            self.model.set_floor(floor);
        }
    }

    /// The sky seen from above, the camera at the lower edge: the light is the bright dot. The inner circle is the horizon.
    fn light_pad(&mut self, ui: &mut egui::Ui) {
        let (rect, response) = ui.allocate_exact_size(Vec2::splat(96.0), Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, "Direction of the light"));
        let response = response.on_hover_text("Where the light is, seen from above; the camera is below");
        let (centre, radius) = (rect.center(), 46.0);
        let (Some(orbit), Some(place)) = (self.model.orbit(), self.model.light_direction(self.light)) else { return };
        let painter = ui.painter();
        painter.circle_filled(centre, radius, theme::STAGE);
        painter.circle_stroke(centre, radius, egui::Stroke::new(1.0, theme::FAINT.gamma_multiply(0.5)));
        painter.circle_stroke(centre, 0.5 * radius, egui::Stroke::new(1.0, theme::FAINT.gamma_multiply(0.35)));
        let share = 0.5 * (1.0 - place.elevation / FRAC_PI_2);
        let angle = place.azimuth - orbit.towards.azimuth;
        let at = centre + Vec2::new(angle.sin() as f32, angle.cos() as f32) * (share as f32 * radius);
        painter.line_segment([centre, at], egui::Stroke::new(1.0, theme::ACCENT.gamma_multiply(0.5)));
        painter.circle_filled(at, 5.0, theme::ACCENT);
        if let Some(to) = response.interact_pointer_pos().filter(|_| response.dragged() || response.clicked()) {
            let by = (to - centre) / radius;
            let elevation = FRAC_PI_2 * (1.0 - 2.0 * f64::from(by.length().min(1.0)));
            let angle = f64::from(by.x.atan2(by.y));
            let turned = place.turned(angle + orbit.towards.azimuth - place.azimuth, elevation - place.elevation);
            self.model.place_light(self.light, turned);
        }
        self.settle_after(&response);
    }

    fn clip(&mut self, ui: &mut egui::Ui) {
        let k = self.surface;
        let Some(entry) = self.model.document().file.surface.get(k) else { return };
        let clip = entry.clip;
        let built = self.model.scene().and_then(|scene| SceneFile::of(scene).surface.get(k)?.clip);
        let kind = clip.map(|clip| clip.ball.is_some());
        let mut wanted = kind;
        ui.horizontal(|ui| {
            ui.selectable_value(&mut wanted, None, "Chosen")
                .on_hover_text("A box around the surface, or a good part of it");
            ui.selectable_value(&mut wanted, Some(false), "Box");
            ui.selectable_value(&mut wanted, Some(true), "Ball");
        });
        if wanted != kind {
            let bounds = corners(clip.or(built));
            let clip = wanted.map(|ball| if ball { ball_in(bounds) } else { box_of(bounds) });
            self.model.set_clip(k, clip);
            self.model.settle();
            return;
        }
        let Some(clip) = clip else { return };
        let scale = self.model.scene().map_or(1.0, |scene| scene.scale());
        let number = |ui: &mut egui::Ui, value: &mut f64, label: String| {
            let field = ui.add(egui::DragValue::new(value).speed(0.01 * scale).max_decimals(3));
            name(&field, &label);
            field
        };
        let (mut changed, mut settled) = (false, false);
        let mut note = |field: egui::Response| {
            changed |= field.changed();
            settled |= field.drag_stopped() || field.lost_focus();
        };
        let new = if let Some(mut radius) = clip.ball {
            let mut center = clip.center.unwrap_or_default();
            ui.horizontal(|ui| {
                ui.label("radius");
                note(number(ui, &mut radius, "Radius of the ball".to_owned()));
            });
            ui.horizontal(|ui| {
                ui.label("centre");
                for (axis, value) in ["x", "y", "z"].iter().zip(&mut center) {
                    note(number(ui, value, format!("Centre of the ball, {axis}")));
                }
            });
            ClipEntry { ball: Some(radius.max(1e-6)), center: Some(center), ..ClipEntry::default() }
        } else {
            let [mut min, mut max] = corners(Some(clip));
            for (axis, (lo, hi)) in ["x", "y", "z"].iter().zip(min.iter_mut().zip(&mut max)) {
                ui.horizontal(|ui| {
                    ui.label(RichText::new(*axis).monospace());
                    note(number(ui, lo, format!("Box from {axis}")));
                    ui.label("to");
                    note(number(ui, hi, format!("Box to {axis}")));
                });
                // A box is never empty, however one pulls.
                *hi = hi.max(*lo + 1e-6 * scale);
            }
            box_of([min, max])
        };
        if changed {
            self.model.set_clip(k, Some(new));
        }
        if settled {
            self.model.settle();
        }
    }

    fn proof(&mut self, ui: &mut egui::Ui) {
        let document = self.model.document();
        let (mut method, mut beside) = (document.method, document.beside);
        let before = (method, beside);
        let choose = |ui: &mut egui::Ui, label: &str, method: &mut Method| {
            egui::ComboBox::from_label(label).selected_text(method.name()).show_ui(ui, |ui| {
                for (m, name, about) in Method::ALL {
                    ui.selectable_value(method, m, name).on_hover_text(about);
                }
            });
        };
        choose(ui, "method", &mut method);
        let mut two = beside.is_some();
        ui.checkbox(&mut two, "another one beside it");
        let other = Method::ALL.iter().map(|(m, ..)| *m).find(|m| *m != method);
        beside = if two { beside.or(other) } else { None };
        if let Some(beside) = &mut beside {
            choose(ui, "on the right", beside);
        }
        if (method, beside) != before {
            self.model.set_methods(method, beside);
        }
        let mut bits = -self.model.document().tolerance().log2();
        let field = slider(&mut bits, 2.0..=16.0)
            .custom_formatter(|bits, _| format!("1/{:.0}", bits.exp2()))
            .custom_parser(|text| {
                let number = text
                    .trim()
                    .strip_prefix("1/")
                    .map_or_else(|| text.trim().parse::<f64>().map(f64::recip), str::parse);
                number.ok().filter(|n| *n >= 1.0).map(f64::log2)
            })
            .text("tolerance");
        let field = ui.add(field).on_hover_text("How wide a bracket of the visible light may be");
        if field.changed() {
            self.model.set_tolerance((-bits).exp2().clamp(1e-9, 1.0));
        }
        self.settle_after(&field);
    }

    fn shown(&mut self, ui: &mut egui::Ui) {
        ui.horizontal_wrapped(|ui| {
            ui.selectable_value(&mut self.overlay, None, "Colours").on_hover_text("0");
            for (k, (overlay, name)) in Overlay::ALL.into_iter().enumerate() {
                let label = match overlay {
                    Overlay::Verdict => "Verdict",
                    Overlay::Shadow => "Shadow class",
                    Overlay::Cost => "Cost",
                    Overlay::Width => "Bracket width",
                };
                ui.selectable_value(&mut self.overlay, Some(overlay), label)
                    .on_hover_text(format!("{name} ({})", k + 1));
            }
        });
    }

    /// A gesture on a field is one step of the history. So is a value that comes without a hand, as from a screen reader.
    pub(super) fn settle_after(&mut self, field: &egui::Response) {
        let set = field.changed() && !field.is_pointer_button_down_on() && !field.has_focus();
        if set || field.drag_stopped() || field.lost_focus() {
            self.model.settle();
        }
    }
}

/// A slider that leaves a value alone until a hand moves it.
fn slider(value: &mut f64, range: std::ops::RangeInclusive<f64>) -> egui::Slider<'_> {
    egui::Slider::new(value, range).clamping(egui::SliderClamping::Never)
}

fn section(ui: &mut egui::Ui, title: &str) {
    ui.add_space(8.0);
    ui.label(RichText::new(title).strong());
}

/// The longer side of a light.
fn side(light: &LightEntry) -> f64 {
    let edge = |half: Option<[f64; 3]>| 2.0 * half.map_or(0.0, |h| Vec3(h).length());
    light.side.unwrap_or_else(|| edge(light.u).max(edge(light.v)))
}

/// So many times as large.
fn resize(light: &mut LightEntry, factor: f64) {
    light.side = light.side.map(|side| side * factor);
    light.u = light.u.map(|u| (Vec3(u) * factor).0);
    light.v = light.v.map(|v| (Vec3(v) * factor).0);
}

/// Lower and upper corner of a clip.
fn corners(clip: Option<ClipEntry>) -> [[f64; 3]; 2] {
    let about = |center: [f64; 3], half: [f64; 3]| {
        let at = |sign: f64| std::array::from_fn(|k| center[k] + sign * half[k]);
        [at(-1.0), at(1.0)]
    };
    match clip.unwrap_or_default() {
        ClipEntry { half: Some(half), .. } => about([0.0; 3], half),
        ClipEntry { min: Some(min), max: Some(max), .. } => [min, max],
        ClipEntry { ball: Some(radius), center, .. } => about(center.unwrap_or_default(), [radius; 3]),
        _ => about([0.0; 3], [1.0; 3]),
    }
}

fn box_of([min, max]: [[f64; 3]; 2]) -> ClipEntry {
    ClipEntry { min: Some(min), max: Some(max), ..ClipEntry::default() }
}

/// The ball in a box that touches its nearest faces.
fn ball_in([min, max]: [[f64; 3]; 2]) -> ClipEntry {
    let center = std::array::from_fn(|k| 0.5 * (min[k] + max[k]));
    let radius = (0..3).map(|k| 0.5 * (max[k] - min[k])).fold(f64::INFINITY, f64::min);
    ClipEntry { ball: Some(radius), center: Some(center), ..ClipEntry::default() }
}

/// Radians that a drag over the whole height of the picture turns.
pub(super) const TURN: f64 = PI;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clips_and_lights_change_their_form() {
        let half = ClipEntry { half: Some([1.0, 2.0, 3.0]), ..ClipEntry::default() };
        assert_eq!(corners(Some(half)), [[-1.0, -2.0, -3.0], [1.0, 2.0, 3.0]]);
        let ball = ball_in(corners(Some(half)));
        assert_eq!((ball.ball, ball.center), (Some(1.0), Some([0.0; 3])));
        assert_eq!(corners(Some(ball)), [[-1.0; 3], [1.0; 3]]);
        let mut light = LightEntry {
            center: [0.0; 3],
            side: None,
            u: Some([0.0, 0.5, 0.0]),
            v: Some([0.25, 0.0, 0.0]),
            color: None,
            strength: None,
        };
        assert_eq!(side(&light), 1.0);
        resize(&mut light, 3.0);
        assert_eq!((side(&light), light.v), (3.0, Some([0.75, 0.0, 0.0])));
    }
}
