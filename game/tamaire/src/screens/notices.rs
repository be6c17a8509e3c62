//! Notices, and the progress bar of a photo or clip.

use super::hud;
use crate::game::{Game, Screen};
use egui::{Color32, FontId, Rect, Ui, pos2, vec2};

/// Size of the progress bar [points].
const BAR: egui::Vec2 = vec2(240.0, 12.0);

pub(super) fn show(game: &Game, ui: &Ui) {
    let screen = ui.max_rect();
    let above = match game.screen() {
        Screen::Play => hud::height(game, ui),
        // On these screens, notices are below the headline and the back button.
        Screen::Levels | Screen::Settings | Screen::Forces | Screen::Licences | Screen::Replays => {
            92.0
        }
        _ => 18.0,
    };
    let mut y = screen.top() + above;
    let scale = hud::scale(game, ui);
    let font = FontId::proportional(18.0 * scale);
    let layer = egui::LayerId::new(egui::Order::Foreground, egui::Id::unique("notices"));
    let painter = ui.ctx().layer_painter(layer);
    // The notice about cut forces is hidden during a round, where a chip says so, and on the forces screen,
    // where a button says so.
    let is_said = matches!(game.screen(), Screen::Play | Screen::Forces);
    let is_cut = game.forces.is_cut() && !is_said;
    let lasting = is_cut.then(|| (game.words().cut_now.to_string(), 1.0));
    let passing = game.notices.iter();
    let passing = passing.map(|notice| (notice.text.clone(), notice.seconds));
    let is_new = |notice: &(String, f32)| !is_cut || notice.0 != game.words().cut_now;
    for (text, left) in lasting.into_iter().chain(passing.filter(is_new)) {
        let strength = left.min(1.0);
        let ink = Color32::WHITE.gamma_multiply(strength);
        let width = screen.width() - 80.0;
        let galley = painter.layout(text.clone(), font.clone(), ink, width);
        let size = galley.size() + scale * vec2(36.0, 18.0);
        let rect = Rect::from_min_size(pos2(screen.center().x - 0.5 * size.x, y), size);
        let shade = Color32::from_black_alpha((190.0 * strength) as u8);
        painter.rect_filled(rect, 16.0 * scale, shade);
        painter.galley(rect.min + scale * vec2(18.0, 9.0), galley, ink);
        y += size.y + 8.0;
    }
    if let Some(share) = game.files.picture_progress() {
        let rect = Rect::from_min_size(
            pos2(screen.center().x - 0.5 * BAR.x, y),
            scale * vec2(BAR.x, BAR.y),
        );
        let done = Rect::from_min_size(rect.min, vec2(share * rect.width(), rect.height()));
        painter.rect_filled(rect.expand(3.0), BAR.y, Color32::from_black_alpha(190));
        painter.rect_filled(done, BAR.y, game.theme().accent);
    }
}
