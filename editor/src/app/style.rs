//! How the editor looks: calm greys, one accent, room between things.

use egui::{Color32, Context, CornerRadius, FontDefinitions, FontFamily, FontId, TextStyle, Theme, vec2};

/// The colour of what is chosen.
pub(super) const ACCENT: Color32 = Color32::from_rgb(58, 110, 190);

/// Sets the style once.
pub(super) fn set(ctx: &Context) {
    // The font for code has the arrows that the one for text lacks.
    let mut fonts = FontDefinitions::default();
    if let Some(text) = fonts.families.get_mut(&FontFamily::Proportional) {
        text.push("Hack".into());
    }
    ctx.set_fonts(fonts);
    ctx.set_theme(Theme::Dark);
    ctx.all_styles_mut(|style| {
        style.spacing.item_spacing = vec2(8.0, 6.0);
        style.spacing.button_padding = vec2(8.0, 3.0);
        style.spacing.interact_size.y = 22.0;
        for (kind, size) in [
            (TextStyle::Body, 14.0),
            (TextStyle::Button, 14.0),
            (TextStyle::Heading, 18.0),
            (TextStyle::Small, 12.0),
            (TextStyle::Monospace, 13.0),
        ] {
            let family =
                if kind == TextStyle::Monospace { FontId::monospace(size) } else { FontId::proportional(size) };
            style.text_styles.insert(kind, family);
        }
        let visuals = &mut style.visuals;
        visuals.panel_fill = Color32::from_gray(36);
        visuals.window_fill = Color32::from_gray(40);
        visuals.extreme_bg_color = Color32::from_gray(22);
        visuals.selection.bg_fill = ACCENT;
        visuals.selection.stroke.color = Color32::WHITE;
        visuals.error_fg_color = Color32::from_rgb(255, 120, 110);
        visuals.warn_fg_color = Color32::from_rgb(240, 180, 70);
        visuals.override_text_color = None;
        let widgets = &mut visuals.widgets;
        widgets.noninteractive.fg_stroke.color = Color32::from_gray(205);
        widgets.inactive.fg_stroke.color = Color32::from_gray(220);
        widgets.inactive.weak_bg_fill = Color32::from_gray(58);
        widgets.inactive.bg_fill = Color32::from_gray(66);
        for widget in [&mut widgets.inactive, &mut widgets.hovered, &mut widgets.active, &mut widgets.open] {
            widget.corner_radius = CornerRadius::same(4);
        }
    });
}
