//! Notices, and the progress bar of a photo or clip.

use super::{hud, result};
use crate::game::{Game, Notice, Screen};
use crate::platform::Location;
use app_shell::widgets::{ButtonStyle, button};
use egui::{Color32, FontId, Painter, Pos2, Rect, Ui, pos2, vec2};
use tamaire_sound::Menu;

/// Size of the progress bar [points].
const BAR: egui::Vec2 = vec2(240.0, 12.0);

/// Size of the button that opens the folder of a saved file [points].
const BUTTON: egui::Vec2 = vec2(170.0, 38.0);

/// A notice to draw.
struct Shown {
    text: String,
    /// Location of a saved file.
    saved: Option<Location>,
    /// Remaining display time [s].
    left: f32,
}

pub(super) fn show(game: &mut Game, ui: &Ui) {
    let place = place(game, ui);
    let mut y = place.top();
    let scale = hud::scale(game, ui);
    let layer = egui::LayerId::new(egui::Order::Foreground, egui::Id::unique("notices"));
    let painter = ui.ctx().layer_painter(layer);
    let mut opened = None;
    for notice in shown(game) {
        let rect = draw(
            &painter,
            &notice,
            pos2(place.center().x, y),
            place.width(),
            scale,
        );
        if let Some(location) = notice.saved
            && open_folder(
                game,
                ui,
                &location,
                pos2(rect.center().x, rect.bottom() - scale * 9.0),
            )
        {
            opened = Some(location);
        }
        y += rect.height() + 8.0;
    }
    draw_progress(game, &painter, pos2(place.center().x, y), scale);
    if let Some(location) = opened {
        game.blip(Menu::Confirm);
        game.open_folder_of(&location);
    }
}

/// Returns the part of the screen in which notices are stacked, from its upper edge downwards.
fn place(game: &Game, ui: &Ui) -> Rect {
    let screen = ui.max_rect();
    let above = match game.screen() {
        Screen::Play => hud::height(game, ui),
        // On these screens, notices are below the headline and the back button.
        Screen::Levels
        | Screen::Settings
        | Screen::Forces
        | Screen::Licences
        | Screen::Replays
        | Screen::Toolbox => 92.0,
        _ => 18.0,
    };
    let free = match game.screen() {
        // The result stays readable beside the notices.
        Screen::Result => result::free_part(game, screen),
        _ => screen,
    };
    free.with_min_y(screen.top() + above)
        .shrink2(vec2(22.0, 0.0))
}

/// Returns the notices to show, the oldest first.
fn shown(game: &Game) -> Vec<Shown> {
    // The notice about cut forces is hidden during a round, where a chip says so, and on the forces screen,
    // where a button says so.
    let is_said = matches!(game.screen(), Screen::Play | Screen::Forces);
    let is_cut = game.forces.is_cut() && !is_said;
    let lasting = is_cut.then(|| Shown {
        text: game.words().cut_now.to_string(),
        saved: None,
        left: 1.0,
    });
    let is_new = |notice: &&Notice| !is_cut || notice.text != game.words().cut_now;
    let passing = game.notices.iter().filter(is_new).map(|notice| Shown {
        text: notice.text.clone(),
        saved: notice.saved.clone(),
        left: notice.seconds,
    });
    lasting.into_iter().chain(passing).collect()
}

/// Draws a notice below `top` and returns its area, with room for a button if the notice has one.
fn draw(painter: &Painter, notice: &Shown, top: Pos2, width: f32, scale: f32) -> Rect {
    let strength = notice.left.min(1.0);
    let ink = Color32::WHITE.gamma_multiply(strength);
    let font = FontId::proportional(18.0 * scale);
    let galley = painter.layout(notice.text.clone(), font, ink, width - scale * 36.0);
    let mut size = galley.size() + scale * vec2(36.0, 18.0);
    if notice.saved.is_some() {
        size.x = size.x.max(BUTTON.x + scale * 36.0);
        size.y += BUTTON.y + scale * 9.0;
    }
    let rect = Rect::from_min_size(pos2(top.x - 0.5 * size.x, top.y), size);
    let shade = Color32::from_black_alpha((190.0 * strength) as u8);
    painter.rect_filled(rect, 16.0 * scale, shade);
    let left = rect.center().x - 0.5 * galley.size().x;
    painter.galley(pos2(left, rect.top() + scale * 9.0), galley, ink);
    rect
}

/// Shows the button that opens the folder of the file saved at `location`, with the middle of its lower edge at
/// `below`. Returns whether it was pressed.
fn open_folder(game: &Game, ui: &Ui, location: &Location, below: Pos2) -> bool {
    let corner = below - vec2(0.5 * BUTTON.x, BUTTON.y);
    // One layer above the notices, which have no area of their own and would be drawn over an area.
    let area = egui::Area::new(egui::Id::unique(("open folder", location)))
        .order(egui::Order::Tooltip)
        .fixed_pos(corner);
    let (theme, said) = (game.theme(), game.words());
    area.show(ui.ctx(), |ui| {
        button(ui, &theme, said.open_folder, BUTTON, ButtonStyle::Other).clicked()
    })
    .inner
}

/// Draws the progress of a photo or clip below `top`, if one is being made.
fn draw_progress(game: &Game, painter: &Painter, top: Pos2, scale: f32) {
    let Some(share) = game.files.picture_progress() else {
        return;
    };
    let size = scale * vec2(BAR.x, BAR.y);
    let rect = Rect::from_min_size(pos2(top.x - 0.5 * size.x, top.y), size);
    let done = Rect::from_min_size(rect.min, vec2(share * rect.width(), rect.height()));
    painter.rect_filled(rect.expand(3.0), BAR.y, Color32::from_black_alpha(190));
    painter.rect_filled(done, BAR.y, game.theme().accent);
}
