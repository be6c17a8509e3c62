//! Confirmation by a second press, for example of a deletion.

use egui::{Id, Ui};

/// Time after the first press in which a second press confirms an action [s].
const PATIENCE: f64 = 6.0;

/// Whether a press on `what` now would be the second one and confirm the action.
pub(super) fn is_pending(ui: &Ui, what: &str) -> bool {
    let now = ui.input(|input| input.time);
    let asked: Option<(String, f64)> = ui.data(|data| data.get_temp(id()));
    asked.is_some_and(|(asked, when)| asked == what && now - when < PATIENCE)
}

/// Whether the question about `what` is open. Unlike [`is_pending`], a question with an answer "no" waits without
/// a time limit.
pub(super) fn is_asked(ui: &Ui, what: &str) -> bool {
    let asked: Option<(String, f64)> = ui.data(|data| data.get_temp(id()));
    asked.is_some_and(|(asked, _)| asked == what)
}

/// Notes a first press on `what`, which starts the time window. `None` cancels a pending confirmation.
pub(super) fn set_pending(ui: &Ui, what: Option<&str>) {
    let now = ui.input(|input| input.time);
    ui.data_mut(|data| match what {
        Some(what) => {
            data.insert_temp(id(), (what.to_string(), now));
        }
        None => data.remove::<(String, f64)>(id()),
    });
}

fn id() -> Id {
    Id::unique("confirmation")
}
