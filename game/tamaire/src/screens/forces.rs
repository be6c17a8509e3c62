//! Screen for sticks and pads: their abilities, live input, and current force output.

use super::widgets::{card, dim_background, header, page, page_rect, slider};
use crate::game::Game;
use crate::game::trial::Trial;
use crate::words::Words;
use app_shell::Theme;
use app_shell::widgets::{ButtonStyle, button, fitted};
use egui::{Color32, Painter, Pos2, Rect, RichText, Sense, Stroke, StrokeKind, Ui, pos2, vec2};
use force_feedback::{Ability, Calibration, Output, Report};
use sticks::Device;
use tamaire_sound::Menu;

/// Radius of the circle that shows a stick's deflection [points].
const CIRCLE: f32 = 78.0;
/// Size of the bar that shows the value of an axis [points].
const BAR: egui::Vec2 = vec2(150.0, 14.0);
/// Height of the row of a bar [points].
const ROW: f32 = 34.0;
/// Radius of a button's indicator light [points].
const LIGHT: f32 = 6.0;
/// Spacing of the lights [points].
const LIGHTS: f32 = 17.0;

pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    dim_background(ui, 255);
    let (theme, said) = (game.theme(), game.words());
    let before = game.settings.clone();
    let mut chosen = before.clone();
    let mut back = ui.input(|input| input.key_pressed(egui::Key::Escape));
    let area = page_rect(ui);
    ui.scope_builder(egui::UiBuilder::new().max_rect(area), |ui| {
        let response = header(ui, &theme, said.back, said.forces);
        super::widgets::focus_first(ui, &response);
        back |= response.clicked();
        page(ui, "forces", 860.0, |ui| {
            card(ui, &theme, |ui| {
                ui.set_width(ui.available_width());
                let strength = &mut chosen.haptics;
                slider(ui, &theme, said.haptics, strength, 0.0, 1.0, 0.05);
                if game.forces.is_cut() {
                    let width = ui.available_width();
                    let text = said.restore;
                    if button(ui, &theme, text, vec2(width, 48.0), ButtonStyle::Main).clicked() {
                        game.restore_forces();
                    }
                } else {
                    let keys = game
                        .settings
                        .bindings
                        .names(crate::input::Action::CutForces, game.controls.labels());
                    let hint = (said.cut_hint)(&keys);
                    ui.label(RichText::new(hint).size(18.0).color(theme.faint));
                }
            });
            ui.add_space(12.0);
            let devices = game.controls.devices.sticks.devices.clone();
            if devices.is_empty() {
                ui.vertical_centered(|ui| {
                    ui.add_space(60.0);
                    ui.label(RichText::new(said.no_devices).size(22.0).color(theme.faint));
                });
            }
            for device in &devices {
                card(ui, &theme, |ui| {
                    ui.set_width(ui.available_width());
                    show_device(ui, &theme, game, device);
                    let report = game.forces.report(device.id);
                    if report.is_some_and(|report| report.ability == Ability::Force) {
                        let model = &device.about.guid;
                        let known = chosen.calibrations.get(model).copied();
                        let mut calibration = known.unwrap_or_default();
                        for (name, gain) in said.gains.iter().zip(&mut calibration.gain) {
                            slider(ui, &theme, name, gain, 0.0, 1.0, 0.05);
                        }
                        if calibration != known.unwrap_or_default() {
                            chosen.calibrations.insert(model.clone(), calibration);
                        }
                    }
                });
                ui.add_space(12.0);
            }
        });
    });
    if chosen != before {
        game.settings = chosen.in_range();
        game.keep_settings();
    }
    if back {
        game.blip(Menu::Back);
        game.go_back();
    }
}

fn show_device(ui: &mut Ui, theme: &Theme, game: &mut Game, device: &Device) {
    let said = game.words();
    let report = game.forces.report(device.id);
    let is_off = game.settings.haptics == 0.0;
    let can = match report {
        _ if is_off => said.forces_off,
        Some(report) => (said.ability)(report.ability),
        None => (said.ability)(Ability::Nothing),
    };
    let size = vec2(ui.available_width(), 34.0);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let right = fitted(ui.painter(), can, 19.0, 0.4 * size.x, theme.faint);
    let width = size.x - right.size().x - 20.0;
    let left = fitted(ui.painter(), &device.about.name, 24.0, width, theme.ink);
    let at = rect.left_center() - vec2(0.0, 0.5 * left.size().y);
    ui.painter().galley(at, left, theme.ink);
    let at = rect.right_center() - vec2(right.size().x, 0.5 * right.size().y);
    ui.painter().galley(at, right, theme.faint);
    ui.horizontal(|ui| {
        let size = vec2(2.0 * CIRCLE, 2.0 * CIRCLE + 8.0);
        let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
        draw_stick(ui.painter(), theme, rect.center(), device, report);
        ui.add_space(14.0);
        ui.vertical(|ui| draw_report(ui, theme, said, device, report));
        ui.add_space(14.0);
        ui.vertical(|ui| show_acts(ui, theme, game, device, report));
    });
}

/// Draws the deflection of the stick and the force on it.
fn draw_stick(
    painter: &Painter,
    theme: &Theme,
    middle: Pos2,
    device: &Device,
    report: Option<Report>,
) {
    let rim = Stroke::new(3.0, theme.button);
    painter.circle(middle, CIRCLE, theme.paper, rim);
    for way in [vec2(1.0, 0.0), vec2(0.0, 1.0)] {
        let ends = [middle - CIRCLE * way, middle + CIRCLE * way];
        painter.line_segment(ends, Stroke::new(1.5, theme.button));
    }
    let [x, y] = device.aim().map(|k| k.clamp(-1.0, 1.0));
    let knob = middle + (CIRCLE - 12.0) * vec2(x, -y);
    painter.circle(knob, 12.0, theme.card, Stroke::new(4.0, theme.ink));
    if let Some(Output::Force([x, y])) = report.map(|report| report.output) {
        let push = CIRCLE * vec2(x, -y);
        if push.length() > 2.0 {
            painter.arrow(knob, push, Stroke::new(5.0, theme.accent));
        }
    }
}

/// Draws the output in numbers, and all axes and buttons.
fn draw_report(ui: &mut Ui, theme: &Theme, said: &Words, device: &Device, report: Option<Report>) {
    let rows = device.axes.len().div_ceil(2) as f32;
    let width = 330.0;
    let a_row = (width / LIGHTS) as usize;
    let lights = device.controls().count().div_ceil(a_row) as f32;
    let (rect, _) = ui.allocate_exact_size(
        vec2(width, 2.0 * ROW + 30.0 + 12.0 * rows + LIGHTS * lights),
        Sense::hover(),
    );
    let painter = ui.painter();
    let mut at = rect.left_top();
    let zero = Output::Force([0.0; 2]);
    let output = report.map_or(zero, |report| report.output);
    let (names, levels) = match output {
        Output::Force(force) => (["←→", "↑↓"], force),
        Output::Rumble { low, high } => (said.motors, [low, high]),
    };
    for (name, level) in names.into_iter().zip(levels) {
        let galley = fitted(painter, name, 17.0, 94.0, theme.ink);
        let height = galley.size().y;
        painter.galley(at + vec2(0.0, 0.5 * (ROW - height)), galley, theme.ink);
        let bar = Rect::from_min_size(at + vec2(104.0, 0.5 * (ROW - BAR.y)), BAR);
        let is_signed = matches!(output, Output::Force(_));
        draw_bar(painter, theme, bar, level, is_signed, theme.accent);
        let text = match is_signed {
            true => format!("{level:+.2}"),
            false => format!("{level:.2}"),
        };
        let galley = fitted(painter, &text, 17.0, 70.0, theme.ink);
        painter.galley(
            bar.right_center() + vec2(10.0, -0.5 * height),
            galley,
            theme.ink,
        );
        at.y += ROW;
    }
    let text = match report {
        None => String::new(),
        Some(Report {
            silent: Some(why), ..
        }) => (said.silent)(why).to_string(),
        Some(Report {
            newtons: [x, y], ..
        }) => format!("{:.0} N", x.hypot(y)),
    };
    let galley = fitted(painter, &text, 17.0, width, theme.faint);
    painter.galley(at + vec2(0.0, 3.0), galley, theme.faint);
    at.y += 30.0;
    for (number, &axis) in device.axes.iter().enumerate() {
        let corner = vec2(
            0.5 * width * (number % 2) as f32,
            12.0 * (number / 2) as f32,
        );
        let bar = Rect::from_min_size(at + corner, vec2(0.5 * width - 14.0, 7.0));
        draw_bar(painter, theme, bar, axis, true, theme.ink);
    }
    at.y += 12.0 * rows + LIGHT;
    for (number, (_, button)) in device.controls().enumerate() {
        let corner = vec2((number % a_row) as f32, (number / a_row) as f32);
        let middle = at + vec2(LIGHT, LIGHT) + LIGHTS * corner;
        let fill = if button.down {
            theme.accent
        } else {
            theme.button
        };
        painter.circle_filled(middle, LIGHT, fill);
    }
}

/// Draws a bar that fills from its left end, or from its middle if it is signed.
fn draw_bar(
    painter: &Painter,
    theme: &Theme,
    bar: Rect,
    level: f32,
    is_signed: bool,
    fill: Color32,
) {
    let round = 0.5 * bar.height();
    painter.rect_filled(bar, round, theme.button);
    let level = level.clamp(-1.0, 1.0);
    let (start, length) = match is_signed {
        true => (bar.center().x, 0.5 * level * bar.width()),
        false => (bar.left(), level * bar.width()),
    };
    let ends = [start, start + length];
    let filled = Rect::from_x_y_ranges(
        ends[0].min(ends[1])..=ends[0].max(ends[1]),
        bar.top()..=bar.bottom(),
    );
    painter.rect_filled(filled, round, fill);
    let edge = Stroke::new(1.0, theme.faint);
    painter.rect_stroke(bar, round, edge, StrokeKind::Outside);
    if is_signed {
        let middle = [pos2(start, bar.top()), pos2(start, bar.bottom())];
        painter.line_segment(middle, edge);
    }
}

/// Shows the buttons that start a test or a measurement of a device.
fn show_acts(ui: &mut Ui, theme: &Theme, game: &mut Game, device: &Device, report: Option<Report>) {
    let said = game.words();
    let ability = report.map_or(Ability::Nothing, |report| report.ability);
    if ability == Ability::Nothing || game.forces.is_cut() {
        return;
    }
    let size = vec2(ui.available_width(), 48.0);
    let trial = game.trial.filter(|trial| trial.device == device.id);
    let progress = trial.and_then(|trial| trial.progress());
    let (text, weight) = match (trial, progress) {
        (None, _) => (said.try_it, ButtonStyle::Other),
        (Some(_), _) => (said.enough, ButtonStyle::Main),
    };
    if button(ui, theme, text, size, weight).clicked() {
        game.trial = trial.is_none().then(|| Trial::spring(device.id));
    }
    ui.add_space(6.0);
    let text = match progress {
        Some(_) => said.hands_off,
        None if trial.is_some() => said.push_it,
        None => "",
    };
    if trial.is_none() && ability == Ability::Force {
        if button(ui, theme, said.measure, size, ButtonStyle::Other).clicked() {
            game.trial = Some(Trial::measure(device.id));
        }
        let known = game.settings.calibrations.get(&device.about.guid);
        let known = known.copied().unwrap_or_default();
        let usual = Calibration {
            gain: known.gain,
            ..Calibration::IDENTITY
        };
        let text = (said.built)(&known);
        if known != usual && button(ui, theme, said.as_usual, size, ButtonStyle::Other).clicked() {
            let model = device.about.guid.clone();
            game.settings.calibrations.insert(model, usual);
            game.keep_settings();
        }
        ui.label(RichText::new(text).size(16.0).color(theme.faint));
    }
    ui.label(RichText::new(text).size(17.0).color(theme.ink));
    if let Some(share) = progress {
        let (bar, _) = ui.allocate_exact_size(vec2(size.x, BAR.y), Sense::hover());
        draw_bar(ui.painter(), theme, bar, share, false, theme.good);
    }
}
