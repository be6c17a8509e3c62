//! Tool bar with the tools and other actions.

use super::section::{Shown, Slices};
use super::session::Session;
use crate::procedure::BLUNTEST;
use crate::tools::Tool;
use app_shell::Theme;
use app_shell::widgets::{ButtonStyle, button};
use egui::{RichText, Slider, Ui, vec2};

/// Action chosen in the bar.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum BarAction {
    /// Take up a tool.
    Take(Tool),
    /// Pause or resume the procedure.
    Rest,
    /// Restart the procedure with the uncut organ.
    Again,
    /// Replay the procedure from the start.
    Watch,
    /// Continue by hand from the current point of a replay.
    TakeOver,
    /// Save recording, table and plots.
    Save,
}

/// Height of the buttons in the bar [points].
const HIGH: f32 = 48.0;

/// Shows the bar and returns the chosen action.
pub fn show(
    ui: &mut Ui,
    theme: &Theme,
    session: Option<&mut Session>,
    slices: Option<&mut Slices>,
) -> Option<BarAction> {
    let session = session?;
    let mut ask = None;
    ui.horizontal_centered(|ui| {
        ui.spacing_mut().item_spacing.x = 8.0;
        let mut press = |ui: &mut Ui, text: &str, wide: f32, is_main: bool, what: BarAction| {
            let weight = if is_main {
                ButtonStyle::Main
            } else {
                ButtonStyle::Other
            };
            if button(ui, theme, text, vec2(wide, HIGH), weight).clicked() {
                ask = Some(what);
            }
        };
        if session.is_by_hand() {
            for (number, tool) in Tool::ALL.into_iter().enumerate() {
                let text = format!("{} {}", number + 1, tool.name());
                press(
                    ui,
                    &text,
                    122.0,
                    session.hand.tool == tool,
                    BarAction::Take(tool),
                );
            }
            ui.vertical(|ui| {
                ui.add_space(2.0);
                ui.label(
                    RichText::new("Sharpness (radius)")
                        .size(15.0)
                        .color(theme.ink),
                );
                let slider = Slider::new(&mut session.hand.dull, 0..=BLUNTEST).suffix(" µm");
                ui.add(slider);
            });
        } else {
            press(ui, "Take over", 130.0, false, BarAction::TakeOver);
        }
        let rest = if session.is_paused { "Resume" } else { "Pause" };
        press(ui, rest, 90.0, session.is_paused, BarAction::Rest);
        press(ui, "Restart", 90.0, false, BarAction::Again);
        press(ui, "Replay", 90.0, false, BarAction::Watch);
        press(ui, "Save", 90.0, false, BarAction::Save);
    });
    if let Some(slices) = slices {
        let place = ui.max_rect();
        let right = place.with_min_x(place.right() - 300.0);
        let layout = egui::Layout::right_to_left(egui::Align::Center);
        let builder = egui::UiBuilder::new().max_rect(right).layout(layout);
        ui.scope_builder(builder, |ui| {
            let is_strain = slices.shown == Shown::Strain;
            let text = if is_strain { "Strain" } else { "Materials" };
            if button(ui, theme, text, vec2(124.0, HIGH), ButtonStyle::Other).clicked() {
                slices.shown = if is_strain {
                    Shown::Materials
                } else {
                    Shown::Strain
                };
            }
            let weight = if slices.follows {
                ButtonStyle::Main
            } else {
                ButtonStyle::Other
            };
            if button(ui, theme, "Slices follow tool", vec2(164.0, HIGH), weight).clicked() {
                slices.follows = !slices.follows;
            }
        });
    }
    ask
}
