//! Colours and spaces. Dark: pictures are looked at.
use eframe::egui::{
    Color32, Context, CornerRadius, FontFamily, FontId, Frame, Margin, Stroke, TextStyle, ThemePreference, Visuals,
    style,
};

/// Behind the picture.
pub(super) const STAGE: Color32 = Color32::from_rgb(16, 17, 21);
/// Panels.
const PANEL: Color32 = Color32::from_rgb(25, 27, 33);
const BAR: Color32 = Color32::from_rgb(20, 21, 26);
/// Fields.
const FIELD: Color32 = Color32::from_rgb(15, 16, 20);
const BUTTON: Color32 = Color32::from_rgb(40, 43, 52);
const HOVERED: Color32 = Color32::from_rgb(53, 57, 69);
const LINE: Color32 = Color32::from_rgb(47, 50, 60);
/// Text, and text of less weight.
pub(super) const INK: Color32 = Color32::from_rgb(219, 220, 225);
pub(super) const FAINT: Color32 = Color32::from_rgb(146, 150, 163);
/// Clay: what is chosen, what is proved.
pub(super) const ACCENT: Color32 = Color32::from_rgb(232, 163, 92);
/// What is wrong.
pub(super) const BAD: Color32 = Color32::from_rgb(244, 115, 104);
/// What went well.
pub(super) const GOOD: Color32 = Color32::from_rgb(142, 198, 142);

/// Makes a context look so.
pub(super) fn apply(context: &Context) {
    context.set_theme(ThemePreference::Dark);
    let mut visuals = Visuals::dark();
    visuals.override_text_color = Some(INK);
    visuals.panel_fill = PANEL;
    visuals.window_fill = PANEL;
    visuals.window_stroke = Stroke::new(1.0, LINE);
    visuals.window_corner_radius = CornerRadius::same(10);
    visuals.extreme_bg_color = FIELD;
    visuals.text_edit_bg_color = Some(FIELD);
    visuals.faint_bg_color = BAR;
    visuals.hyperlink_color = ACCENT;
    visuals.error_fg_color = BAD;
    visuals.selection.bg_fill = Color32::from_rgb(122, 79, 38);
    visuals.selection.stroke = Stroke::new(1.0, Color32::WHITE);
    visuals.slider_trailing_fill = true;
    let corner = CornerRadius::same(6);
    let widgets = &mut visuals.widgets;
    for (widget, fill, line) in [
        (&mut widgets.noninteractive, PANEL, LINE),
        (&mut widgets.inactive, BUTTON, Color32::TRANSPARENT),
        (&mut widgets.hovered, HOVERED, LINE),
        (&mut widgets.active, HOVERED, ACCENT),
        (&mut widgets.open, HOVERED, LINE),
    ] {
        (widget.bg_fill, widget.weak_bg_fill, widget.corner_radius) = (fill, fill, corner);
        widget.bg_stroke = Stroke::new(1.0, line);
        widget.expansion = 0.0;
    }
    context.all_styles_mut(|all| {
        all.visuals = visuals.clone();
        let size = |points| FontId::new(points, FontFamily::Proportional);
        all.text_styles = [
            (TextStyle::Small, size(11.5)),
            (TextStyle::Body, size(13.5)),
            (TextStyle::Button, size(13.5)),
            (TextStyle::Heading, size(16.0)),
            (TextStyle::Monospace, FontId::new(13.5, FontFamily::Monospace)),
        ]
        .into();
        let spacing: &mut style::Spacing = &mut all.spacing;
        spacing.item_spacing = [8.0, 7.0].into();
        spacing.button_padding = [9.0, 4.0].into();
        spacing.interact_size.y = 22.0;
        spacing.slider_width = 120.0;
        spacing.combo_width = 120.0;
    });
}

/// Frame of a panel at a side.
pub(super) fn panel() -> Frame {
    Frame::new().fill(PANEL).inner_margin(Margin::symmetric(14, 12))
}

/// Frame of the bars above and below.
pub(super) fn bar() -> Frame {
    Frame::new().fill(BAR).inner_margin(Margin::symmetric(14, 7))
}

/// Frame of the picture.
pub(super) fn stage() -> Frame {
    Frame::new().fill(STAGE)
}

/// Frame of what floats over the picture.
pub(super) fn float() -> Frame {
    Frame::new()
        .fill(Color32::from_rgba_unmultiplied(16, 17, 21, 225))
        .stroke(Stroke::new(1.0, LINE))
        .corner_radius(CornerRadius::same(8))
        .inner_margin(Margin::symmetric(11, 8))
}
