//! A placement as a list of steps: move, turn, scale.

use super::fields;
use egui::Ui;
use smallvec::SmallVec;
use snell::{components::transform::Step, prelude::DVec3};

/// The steps that can be added, by what they are called.
const KINDS: [(&str, fn() -> Step); 6] = [
    ("Move", || Step::Translate(DVec3::ZERO)),
    ("Turn about x", || Step::RotateX(0.0)),
    ("Turn about y", || Step::RotateY(0.0)),
    ("Turn about z", || Step::RotateZ(0.0)),
    ("Turn about any axis", || Step::Rotate { axis: DVec3::Y, degrees: 0.0 }),
    ("Scale", || Step::Scale(DVec3::ONE)),
];

/// Width of the button that takes a step away.
const REMOVE: f32 = 34.0;

fn called(step: &Step) -> &'static str {
    match step {
        Step::Translate(_) => "Move",
        Step::Scale(_) => "Scale",
        Step::Rotate { .. } | Step::RotateX(_) | Step::RotateY(_) | Step::RotateZ(_) => "Turn",
    }
}

/// Shows steps; whether they changed.
pub(super) fn show(ui: &mut Ui, name: &str, steps: &mut SmallVec<[Step; 4]>) -> bool {
    let mut changed = false;
    let mut gone = None;
    let mut seen: Vec<&str> = vec![];
    for (number, step) in steps.iter_mut().enumerate() {
        let kind = called(step);
        seen.push(kind);
        let count = seen.iter().filter(|known| **known == kind).count();
        // Each row has a name of its own, for those who do not see the order.
        let row = if count > 1 { format!("{kind} {count}") } else { kind.into() };
        ui.push_id((name, number), |ui| {
            ui.horizontal(|ui| {
                ui.vertical(|ui| {
                    ui.set_max_width(ui.available_width() - REMOVE);
                    changed |= fields::step(ui, &row, step);
                });
                if ui
                    .small_button("×")
                    .accessible_name(format!("Remove {row}"))
                    .on_hover_text("Remove this step")
                    .clicked()
                {
                    gone = Some(number);
                }
            });
        });
    }
    if let Some(gone) = gone {
        steps.remove(gone);
        changed = true;
    }
    ui.menu_button("Add a step", |ui| {
        for (kind, make) in KINDS {
            if ui.button(kind).clicked() {
                steps.push(make());
                changed = true;
            }
        }
    })
    .response
    .on_hover_text("Steps are done one after the other, the first first");
    changed
}
