//! What is to be gone is asked for twice.

use egui::{Id, Ui};

/// How long one may take to say it again [s].
const PATIENCE: f64 = 6.0;

/// Whether this was asked for a moment ago.
pub(super) fn is_doomed(ui: &Ui, what: &str) -> bool {
    let now = ui.input(|input| input.time);
    let asked: Option<(String, f64)> = ui.data(|data| data.get_temp(id()));
    asked.is_some_and(|(asked, when)| asked == what && now - when < PATIENCE)
}

/// It is asked for; or nothing is any more.
pub(super) fn doom(ui: &Ui, what: Option<&str>) {
    let now = ui.input(|input| input.time);
    ui.data_mut(|data| match what {
        Some(what) => {
            data.insert_temp(id(), (what.to_string(), now));
        }
        None => data.remove::<(String, f64)>(id()),
    });
}

fn id() -> Id {
    Id::unique("doomed")
}
