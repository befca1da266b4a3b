//! A number that is typed or dragged, checked as it is typed.

use super::names::limits;
use egui::{Color32, CursorIcon, Id, Label, Response, RichText, Sense, TextEdit, Ui};
use snell::components::describe::Range;

/// What is being typed, and the number it stood for when it was last right.
#[derive(Clone)]
struct Typed {
    text: String,
    bits: u64,
}

/// The colour of what is wrong.
pub(super) fn wrong(ui: &Ui) -> Color32 {
    ui.visuals().error_fg_color
}

/// What makes of a text a number, or says what was expected.
pub(super) fn parse(text: &str, range: Range, whole: bool) -> Result<f64, String> {
    let expected = || format!("a {}number{}", if whole { "whole " } else { "" }, limits(range));
    let text = text.trim().replace('_', "");
    let text = if text.matches(',').count() == 1 && !text.contains('.') { text.replace(',', ".") } else { text };
    let number = text.parse::<f64>().ok().filter(|x| x.is_finite() && x.abs() <= 3.4e38);
    number.filter(|x| range.contains(*x) && (!whole || x.fract() == 0.0)).ok_or_else(expected)
}

/// A number as it is shown: the shortest text that means the same bits.
fn shown(x: f64) -> String {
    if x == 0.0 || (1e-4..1e15).contains(&x.abs()) { x.to_string() } else { format!("{x:e}") }
}

/// A text field for a number with the accessible name `name`. Gives whether the number changed; a fault is told below.
pub(super) fn typed(
    ui: &mut Ui,
    name: &str,
    x: &mut f64,
    range: Range,
    whole: bool,
    width: f32,
) -> (bool, Option<String>) {
    let id = ui.make_persistent_id(("number", name));
    let known = ui.data(|data| data.get_temp::<Typed>(id)).filter(|typed| typed.bits == x.to_bits());
    let mut text = known.as_ref().map_or_else(|| shown(*x), |typed| typed.text.clone());
    let fault = parse(&text, range, whole).err().filter(|_| known.is_some());
    let mut field = TextEdit::singleline(&mut text).id(id).desired_width(width);
    if fault.is_some() {
        field = field.text_color(wrong(ui));
    }
    let response = ui.add(field).accessible_name(name);
    let mut changed = false;
    if response.changed() {
        if let Ok(new) = parse(&text, range, whole) {
            changed = new.to_bits() != x.to_bits();
            *x = new;
        }
        keep(ui, id, Typed { text, bits: x.to_bits() });
    } else if known.is_some() && fault.is_none() && !response.has_focus() {
        ui.data_mut(|data| data.remove::<Typed>(id));
    }
    if fault.is_some() && ui.input(|input| input.key_pressed(egui::Key::Escape)) && response.lost_focus() {
        ui.data_mut(|data| data.remove::<Typed>(id));
    }
    (changed, fault)
}

fn keep(ui: &Ui, id: Id, typed: Typed) {
    ui.data_mut(|data| data.insert_temp(id, typed));
}

/// A label by which a number is dragged. Gives whether it changed.
pub(super) fn dragged(ui: &mut Ui, text: &str, x: &mut f64, range: Range, whole: bool) -> (bool, Response) {
    let label =
        Label::new(RichText::new(text).color(ui.visuals().weak_text_color())).sense(Sense::drag()).selectable(false);
    let response = ui.add(label).on_hover_cursor(CursorIcon::ResizeHorizontal);
    let id = response.id.with("drag");
    if response.drag_started() {
        ui.data_mut(|data| data.insert_temp(id, *x));
    }
    if !response.dragged() {
        return (false, response);
    }
    // What was dragged is summed up unrounded, or slow drags would never move.
    let start: f64 = ui.data(|data| data.get_temp(id)).unwrap_or(*x);
    let is_share = range.min == 0.0 && range.max == 1.0;
    let pace = if whole {
        0.1
    } else if is_share {
        0.005
    } else {
        0.01 * start.abs().max(0.5)
    };
    let exact = start + f64::from(response.drag_delta().x) * pace;
    ui.data_mut(|data| data.insert_temp(id, exact));
    let step = if whole { 1.0 } else { 1000.0_f64.min(1000.0 / pace_unit(pace)) };
    let rounded = if whole { exact.round() } else { (exact * step).round() / step };
    let least = if range.min_inclusive { range.min } else { range.min + range.min.abs().max(1.0) * 0.001 };
    let new = rounded.clamp(least, range.max);
    let changed = new.to_bits() != x.to_bits();
    *x = new;
    (changed, response)
}

/// The power of ten to which drags of a pace are rounded.
fn pace_unit(pace: f64) -> f64 {
    if pace > 1.0 { 10.0 } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use snell::components::describe::Spec;

    #[test]
    fn numbers_are_checked_as_the_scene_would() {
        let share = Spec::within(0.0, 1.0, "").range;
        assert_eq!(parse("0.5", share, false), Ok(0.5));
        assert_eq!(parse(" 0,5 ", share, false), Ok(0.5));
        assert_eq!(parse("1.5", share, false), Err("a number from 0 to 1".into()));
        assert_eq!(parse("x", Spec::positive("").range, false), Err("a number more than 0".into()));
        assert_eq!(parse("1.5", Spec::within(1.0, 9.0, "").range, true), Err("a whole number from 1 to 9".into()));
        for bad in ["nan", "inf", "1e39", ""] {
            assert!(parse(bad, Spec::any("").range, false).is_err(), "{bad}");
        }
    }

    #[test]
    fn numbers_are_shown_as_what_they_are() {
        for x in [0.0, -0.0, 0.1, 1.0 / 3.0, 1e-7, 1e300, 12_345.678] {
            assert_eq!(shown(x).parse::<f64>().map(f64::to_bits), Ok(x.to_bits()));
        }
    }
}
