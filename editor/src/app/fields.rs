//! The fields of any component as widgets, made from its own description: shapes of others' programs have them unasked.

use super::{
    names::{tip, words},
    number::{dragged, typed, wrong},
};
use egui::{ComboBox, RichText, TextEdit, Ui};
use snell::{
    components::{
        asset::Asset,
        color::Encoding,
        describe::{FieldVisitor, Range, Spec, Value},
        transform::Step,
    },
    prelude::{DVec2, DVec3, Rgb},
};

/// What a file is chosen for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FileKind {
    /// An OBJ model.
    Model,
    /// An image.
    Image,
}

/// Shows fields; those that are changed are other afterwards.
pub(super) struct Fields<'a> {
    ui: &'a mut Ui,
    /// Says which fields are shown; all if none.
    only: Option<&'a dyn Fn(&str) -> bool>,
    encoding: Encoding,
    /// Whether any changed.
    pub(super) changed: bool,
    /// The field whose file is to be chosen.
    pub(super) choose: Option<(&'static str, FileKind)>,
}

impl<'a> Fields<'a> {
    /// Shows fields in `ui`; colours written as `#rrggbb` mean what `encoding` says.
    pub(super) fn new(ui: &'a mut Ui, encoding: Encoding) -> Self {
        Self { ui, only: None, encoding, changed: false, choose: None }
    }

    /// Shows only some fields.
    pub(super) fn only(self, only: &'a dyn Fn(&str) -> bool) -> Self {
        Self { only: Some(only), ..self }
    }
}

impl FieldVisitor for Fields<'_> {
    fn field(&mut self, name: &'static str, value: Value<'_>, spec: Spec) {
        if self.only.is_some_and(|only| !only(name)) {
            return;
        }
        let row = Row { name: words(name), spec, encoding: self.encoding };
        self.changed |= match value {
            Value::Number(x) => row.number(self.ui, x, false),
            Value::Integer(x) => {
                let mut number = f64::from(*x);
                let range =
                    Range { min: spec.range.min.max(0.0), max: spec.range.max.min(f64::from(u32::MAX)), ..spec.range };
                let row = Row { spec: Spec { range, ..spec }, ..row };
                let changed = row.number(self.ui, &mut number, true);
                *x = number as u32;
                changed
            }
            Value::OptionalNumber(x) => {
                row.optional(self.ui, x, start_number(spec.range), |row, ui, x| row.number(ui, x, false))
            }
            Value::Bool(x) => self.ui.checkbox(x, row.name.as_str()).on_hover_text(tip(&spec)).changed(),
            Value::Vector(v) => row.vector(self.ui, v),
            Value::OptionalVector(v) => row.optional(self.ui, v, DVec3::NEG_Z, |row, ui, v| row.vector(ui, v)),
            Value::Vectors(all) => row.list(self.ui, all, DVec3::ZERO, |row, ui, v| row.vector(ui, v)),
            Value::Vectors2(all) => row.list(self.ui, all, DVec2::ZERO, |row, ui, v| row.pair(ui, v)),
            Value::Color(color) => row.color(self.ui, color),
            Value::Choice(choice) => row.choice(self.ui, choice),
            Value::Steps(steps) => super::steps::show(self.ui, &row.name, steps),
            Value::Model(asset) => {
                if row.file(self.ui, asset) {
                    self.choose = Some((name, FileKind::Model));
                }
                false
            }
            Value::Image(asset) => {
                if row.file(self.ui, asset) {
                    self.choose = Some((name, FileKind::Image));
                }
                false
            }
        };
    }
}

/// The unit that a field's description tells of, if that is not the scene's own unit of length.
fn unit(about: &str) -> Option<&'static str> {
    let is_said = |word: &str| about.split([' ', ',', ';']).any(|said| said == word);
    [("degrees", "°"), ("pixels", "px")].into_iter().find(|(word, _)| is_said(word)).map(|(_, unit)| unit)
}

/// A number to begin with where there was none.
pub(super) fn start_number(range: Range) -> f64 {
    if range.contains(1.0) {
        1.0
    } else if range.min_inclusive {
        range.min
    } else {
        0.5 * (range.min + range.max)
    }
}

/// A field's name and what holds for it.
pub(super) struct Row {
    pub(super) name: String,
    pub(super) spec: Spec,
    pub(super) encoding: Encoding,
}

/// Width of the names before the widgets.
const NAMES: f32 = 80.0;

impl Row {
    /// A name before widgets, which are in one line with it.
    fn line(&self, ui: &mut Ui, add: impl FnOnce(&mut Ui) -> bool) -> bool {
        ui.horizontal(|ui| {
            self.label(ui);
            add(ui)
        })
        .inner
    }

    fn label(&self, ui: &mut Ui) {
        let size = egui::vec2(NAMES, ui.spacing().interact_size.y);
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        ui.allocate_ui_with_layout(size, layout, |ui| {
            ui.set_min_width(NAMES);
            ui.add(egui::Label::new(self.name.as_str()).truncate()).on_hover_text(tip(&self.spec));
        });
    }

    fn told(ui: &mut Ui, fault: Option<String>) {
        if let Some(fault) = fault {
            ui.label(RichText::new(format!("Expected {fault}")).color(wrong(ui)).small());
        }
    }

    fn number(&self, ui: &mut Ui, x: &mut f64, whole: bool) -> bool {
        let range = self.spec.range;
        let mut fault = None;
        let is_share = !whole && range.min == 0.0 && range.max == 1.0;
        let changed = self.line(ui, |ui| {
            let (by_text, why) = typed(ui, &self.name, x, range, whole, 64.0);
            fault = why;
            if let Some(unit) = unit(self.spec.about) {
                ui.label(RichText::new(unit).weak());
            }
            let by_hand = if is_share {
                ui.spacing_mut().slider_width = (ui.available_width() - 8.0).clamp(40.0, 140.0);
                // What it shows may be rounded; only what a hand does counts.
                let mut shown = *x;
                let slider = ui.add(egui::Slider::new(&mut shown, 0.0..=1.0).show_value(false));
                let slider = slider.accessible_name(format!("{} slider", self.name));
                let is_moved = slider.changed() && (slider.dragged() || slider.clicked() || slider.has_focus());
                if is_moved {
                    *x = (shown * 100.0).round() / 100.0;
                }
                is_moved
            } else {
                dragged(ui, "↔", x, range, whole).0
            };
            by_text || by_hand
        });
        Self::told(ui, fault);
        changed
    }

    fn vector(&self, ui: &mut Ui, v: &mut DVec3) -> bool {
        let mut numbers = v.to_array();
        let changed = self.numbers(ui, &mut numbers, &["x", "y", "z"]);
        if changed && !(self.spec.nonzero && DVec3::from_array(numbers) == DVec3::ZERO) {
            *v = DVec3::from_array(numbers);
            return true;
        }
        false
    }

    fn pair(&self, ui: &mut Ui, v: &mut DVec2) -> bool {
        let mut numbers = v.to_array();
        let changed = self.numbers(ui, &mut numbers, &["u", "v"]);
        *v = DVec2::from_array(numbers);
        changed
    }

    fn numbers(&self, ui: &mut Ui, numbers: &mut [f64], axes: &[&str]) -> bool {
        let mut fault = None;
        let changed = self.line(ui, |ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            let width = ((ui.available_width() / axes.len() as f32) - 24.0).clamp(30.0, 64.0);
            let mut changed = false;
            for (axis, x) in axes.iter().zip(&mut *numbers) {
                changed |= dragged(ui, axis, x, self.spec.range, false).0;
                let (new, why) = typed(ui, &format!("{} {axis}", self.name), x, self.spec.range, false, width);
                changed |= new;
                fault = fault.take().or(why);
            }
            changed
        });
        if self.spec.nonzero && numbers.iter().all(|x| *x == 0.0) {
            fault = Some("a direction: not all can be 0".into());
        }
        Self::told(ui, fault);
        changed
    }

    /// A box to tick for a value that may be left out.
    fn optional<T: Copy>(
        &self,
        ui: &mut Ui,
        value: &mut Option<T>,
        start: T,
        show: impl FnOnce(&Self, &mut Ui, &mut T) -> bool,
    ) -> bool {
        let mut is_given = value.is_some();
        let ticked = ui.checkbox(&mut is_given, self.name.as_str()).on_hover_text(tip(&self.spec)).changed();
        if ticked {
            *value = is_given.then_some(start);
        }
        let mut changed = ticked;
        if let Some(value) = value {
            ui.indent(self.name.as_str(), |ui| changed |= show(self, ui, value));
        }
        changed
    }

    /// Any count of values, each in a row with a button to take it away.
    fn list<T: Copy>(
        &self,
        ui: &mut Ui,
        all: &mut Vec<T>,
        start: T,
        show: impl Fn(&Self, &mut Ui, &mut T) -> bool,
    ) -> bool {
        let mut changed = false;
        let mut gone = None;
        ui.label(self.name.as_str()).on_hover_text(tip(&self.spec));
        for (number, value) in all.iter_mut().enumerate() {
            let row = Self { name: format!("{} {}", self.name, number + 1), ..*self };
            ui.horizontal(|ui| {
                ui.vertical(|ui| {
                    ui.set_max_width(ui.available_width() - 34.0);
                    changed |= show(&row, ui, value);
                });
                if ui.small_button("×").accessible_name(format!("Remove {}", row.name)).clicked() {
                    gone = Some(number);
                }
            });
        }
        if let Some(gone) = gone {
            all.remove(gone);
            changed = true;
        }
        if ui.small_button("Add a point").accessible_name(format!("Add to {}", self.name)).clicked() {
            all.push(all.last().copied().unwrap_or(start));
            changed = true;
        }
        changed
    }

    fn choice(&self, ui: &mut Ui, choice: &mut dyn snell::components::describe::Choice) -> bool {
        let all = choice.words();
        let before = choice.position();
        let mut chosen = before;
        self.line(ui, |ui| {
            let shown =
                ComboBox::from_id_salt(("choice", &self.name)).selected_text(words(all[before])).show_ui(ui, |ui| {
                    for (position, word) in all.iter().enumerate() {
                        ui.selectable_value(&mut chosen, position, words(word));
                    }
                });
            shown.response.accessible_name(self.name.as_str()).on_hover_text(tip(&self.spec));
            false
        });
        choice.choose(chosen);
        chosen != before
    }

    fn color(&self, ui: &mut Ui, color: &mut Rgb) -> bool {
        let id = ui.make_persistent_id(("colour", &self.name));
        let text_of = |color: Rgb| {
            snell::systems::save::color_text(color, self.encoding).trim_matches(['"', '(', ')']).to_owned()
        };
        let known: Option<(String, [u64; 3])> = ui.data(|data| data.get_temp(id));
        let bits = |color: &Rgb| color.to_array().map(f64::to_bits);
        let known = known.filter(|(_, of)| *of == bits(color));
        let mut text = known.as_ref().map_or_else(|| text_of(*color), |(text, _)| text.clone());
        let parsed = |text: &str| parse_color(text, self.spec.range, self.encoding);
        let fault = known.as_ref().and_then(|_| parsed(&text).err());
        let changed = self.line(ui, |ui| {
            let mut channels = color.as_vec3().to_array();
            let picked = ui.color_edit_button_rgb(&mut channels);
            let mut changed = false;
            if picked.accessible_name(format!("{} picker", self.name)).changed() {
                *color = Rgb::from_array(channels.map(|x| (f64::from(x) * 1000.0).round() / 1000.0));
                changed = true;
            }
            let field = TextEdit::singleline(&mut text).id(id).desired_width(ui.available_width().min(130.0) - 8.0);
            let field = if fault.is_some() { field.text_color(wrong(ui)) } else { field };
            let response = ui.add(field).accessible_name(self.name.as_str()).on_hover_text(tip(&self.spec));
            if response.changed() {
                if let Ok(new) = parsed(&text) {
                    changed |= bits(&new) != bits(color);
                    *color = new;
                }
                let typed = (text.clone(), bits(color));
                ui.data_mut(|data| data.insert_temp(id, typed));
            } else if known.is_some() && fault.is_none() && !response.has_focus() {
                ui.data_mut(|data| data.remove::<(String, [u64; 3])>(id));
            }
            changed
        });
        Self::told(ui, fault);
        changed
    }

    /// The file that is named and a button to choose another; whether that was pressed.
    fn file<T>(&self, ui: &mut Ui, asset: &Asset<T>) -> bool {
        self.line(ui, |ui| {
            let name = std::path::Path::new(&asset.path).file_name().unwrap_or_default().to_string_lossy();
            let pressed = ui.button("Choose…").accessible_name(format!("Choose {}", self.name)).clicked();
            let shown = if name.is_empty() { "none yet" } else { &name };
            ui.add(egui::Label::new(shown).truncate()).on_hover_text(asset.path.as_str());
            pressed
        })
    }
}

/// A colour from one number, three numbers or `#rrggbb`.
fn parse_color(text: &str, range: Range, encoding: Encoding) -> Result<Rgb, String> {
    let expected = || {
        let limits = super::names::limits(range);
        format!("one number, three numbers or #rrggbb{}{limits}", if limits.is_empty() { "" } else { ", each" })
    };
    let text = text.trim().trim_matches(['"', '(', ')']);
    if let Some(digits) = text.strip_prefix('#') {
        let number = u32::from_str_radix(digits, 16).ok().filter(|_| digits.len() == 6).ok_or_else(expected)?;
        let channel = |shift: u32| encoding.decode(f64::from(number >> shift & 255) / 255.0);
        return Ok(Rgb::new(channel(16), channel(8), channel(0)));
    }
    let numbers: Vec<f64> = text
        .split([',', ' ', ';'])
        .filter(|part| !part.is_empty())
        .map(|part| super::number::parse(part, range, false).map_err(|_| expected()))
        .collect::<Result<_, _>>()?;
    match numbers[..] {
        [all] => Ok(Rgb::splat(all)),
        [r, g, b] => Ok(Rgb::new(r, g, b)),
        _ => Err(expected()),
    }
}

/// A step of a placement as a row; whether it changed.
pub(super) fn step(ui: &mut Ui, name: &str, step: &mut Step) -> bool {
    let row = |name: String, spec: Spec| Row { name, spec, encoding: Encoding::Srgb };
    let degrees = |ui: &mut Ui, x: &mut f64, axis: &str| {
        row(format!("{name} about {axis}"), Spec::any("degrees, counter-clockwise seen against the axis"))
            .number(ui, x, false)
    };
    match step {
        Step::Translate(by) => row(name.into(), Spec::any("moved by")).vector(ui, by),
        Step::Scale(by) => {
            let id = ui.make_persistent_id((name, "each axis"));
            let is_uneven = by.x != by.y || by.y != by.z;
            let mut each = is_uneven || ui.data(|data| data.get_temp(id)).unwrap_or(false);
            let changed = if each {
                row(name.into(), Spec::any("times as large along each axis")).vector(ui, by)
            } else {
                let changed = row(name.into(), Spec::any("times as large")).number(ui, &mut by.x, false);
                *by = DVec3::splat(by.x);
                changed
            };
            if !is_uneven && ui.checkbox(&mut each, "Each axis by itself").changed() {
                ui.data_mut(|data| data.insert_temp(id, each));
            }
            changed
        }
        Step::RotateX(x) => degrees(ui, x, "x"),
        Step::RotateY(x) => degrees(ui, x, "y"),
        Step::RotateZ(x) => degrees(ui, x, "z"),
        Step::Rotate { axis, degrees } => {
            let of_axis = row(format!("{name} axis"), Spec::any("the axis, any length").nonzero()).vector(ui, axis);
            row(format!("{name} degrees"), Spec::any("counter-clockwise seen against the axis"))
                .number(ui, degrees, false)
                || of_axis
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_read_in_all_three_forms() {
        let range = Spec::not_negative("").range;
        assert_eq!(parse_color("0.5", range, Encoding::Srgb), Ok(Rgb::splat(0.5)));
        assert_eq!(parse_color("0.1, 0.2 0.3", range, Encoding::Srgb), Ok(Rgb::new(0.1, 0.2, 0.3)));
        assert_eq!(parse_color("#ff0000", range, Encoding::Srgb), Ok(Rgb::X));
        assert_eq!(parse_color("#ff8000", range, Encoding::Raw), Ok(Rgb::new(1.0, 128.0 / 255.0, 0.0)));
        for bad in ["", "#12", "1 2", "-1", "red"] {
            assert!(parse_color(bad, range, Encoding::Srgb).is_err(), "{bad}");
        }
    }
}
