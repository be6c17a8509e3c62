//! Notices, and the progress bar of a photo or clip.

use super::widgets::{finger, note_notices_height, notices_height};
use super::{editor, hud, making, result};
use crate::game::{Game, Notice, Screen};
use crate::platform::Location;
use app_shell::widgets::{ButtonStyle, button, least_letters};
use egui::{Color32, FontId, Id, Painter, Pos2, Rect, Role, Sense, Ui, WidgetInfo, pos2, vec2};
use tamaire_sound::Menu;

/// Size of the progress bar [points].
const BAR: egui::Vec2 = vec2(240.0, 12.0);

/// Width of the button that opens the folder of a saved file [points].
const BUTTON: f32 = 170.0;
/// Gap between notices, and between the notices and a page above them [points].
const GAP: f32 = 8.0;

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
    let top = place.top();
    let mut y = top;
    let scale = hud::scale(game, ui);
    let layer = egui::LayerId::new(egui::Order::Foreground, egui::Id::unique("notices"));
    let painter = ui.ctx().layer_painter(layer);
    let mut opened = None;
    for notice in shown(game) {
        let at = pos2(place.center().x, y);
        let rect = draw(ui, &painter, &notice, at, place.width(), scale);
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
        y += rect.height() + GAP;
    }
    let is_page = is_page(game.screen());
    if game.files.picture_progress().is_some() {
        let at = pos2(place.center().x, y + 3.0);
        draw_progress(game, &painter, at, scale);
        y += scale * BAR.y + GAP + 6.0;
    }
    let height = if y > top && is_page {
        y - top + GAP
    } else {
        0.0
    };
    // The buttons of this page are often followed by a notice, so there is always room for one.
    let height = match game.screen() == Screen::Finish {
        true => height.max(line_height(ui, scale) + 2.0 * GAP),
        false => height,
    };
    let height = height.min(0.6 * ui.max_rect().height());
    // The next press must not meet another button.
    let page_stays = matches!(game.screen(), Screen::Levels | Screen::Finish);
    note_notices_height(ui, height, page_stays);
    if let Some(location) = opened {
        game.blip(Menu::Confirm);
        game.open_folder_of(&location);
    }
}

/// Whether a screen is a page whose contents scroll. Its notices are below the page, which is as much shorter.
fn is_page(screen: Screen) -> bool {
    matches!(
        screen,
        Screen::Levels
            | Screen::Settings
            | Screen::Forces
            | Screen::Licences
            | Screen::Replays
            | Screen::Toolbox
            | Screen::Finish
    )
}

/// Returns the height of a notice of one line [points].
fn line_height(ui: &Ui, scale: f32) -> f32 {
    let font = font(ui, scale);
    let line = ui.fonts_mut(|fonts| fonts.row_height(&font));
    line + scale * 18.0
}

fn font(ui: &Ui, scale: f32) -> FontId {
    FontId::proportional((18.0 * scale).max(least_letters(ui.ctx())))
}

/// Returns the part of the screen in which notices are stacked, from its upper edge downwards. No button is there.
fn place(game: &Game, ui: &Ui) -> Rect {
    let screen = ui.max_rect();
    let free = match game.screen() {
        page if is_page(page) => {
            let height = notices_height(ui) - GAP;
            return screen
                .with_min_y(screen.bottom() - height)
                .shrink2(vec2(22.0, 0.0));
        }
        Screen::Play => screen.with_min_y(screen.top() + hud::height(game, ui)),
        // The result stays readable beside the notices.
        Screen::Result => result::free_part(game, screen).with_min_y(screen.top() + 18.0),
        Screen::Paper => making::sheet(ui),
        Screen::Editor => editor::room(game, ui),
        Screen::Properties => editor::beside_properties(screen),
        _ => screen.with_min_y(screen.top() + 18.0),
    };
    free.shrink2(vec2(22.0, 0.0))
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
fn draw(ui: &Ui, painter: &Painter, notice: &Shown, top: Pos2, width: f32, scale: f32) -> Rect {
    let strength = notice.left.min(1.0);
    let ink = Color32::WHITE.gamma_multiply(strength);
    let font = font(ui, scale);
    let galley = painter.layout(notice.text.clone(), font, ink, width - scale * 36.0);
    let mut size = galley.size() + scale * vec2(36.0, 18.0);
    if notice.saved.is_some() {
        size.x = size.x.max(BUTTON + scale * 36.0);
        size.y += finger(ui) + scale * 9.0;
    }
    let rect = Rect::from_min_size(pos2(top.x - 0.5 * size.x, top.y), size);
    let shade = Color32::from_black_alpha((190.0 * strength) as u8);
    painter.rect_filled(rect, 16.0 * scale, shade);
    let left = rect.center().x - 0.5 * galley.size().x;
    let text = pos2(left, rect.top() + scale * 9.0);
    let place = Rect::from_min_size(text, galley.size());
    let response = ui.interact(place, Id::unique(("notice", &notice.text)), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &notice.text));
    painter.galley(text, galley, ink);
    rect
}

/// Shows the button that opens the folder of the file saved at `location`, with the middle of its lower edge at
/// `below`. Returns whether it was pressed.
fn open_folder(game: &Game, ui: &Ui, location: &Location, below: Pos2) -> bool {
    let size = vec2(BUTTON, finger(ui));
    let corner = below - vec2(0.5 * size.x, size.y);
    // One layer above the notices, which have no area of their own and would be drawn over an area.
    let area = egui::Area::new(egui::Id::unique(("open folder", location)))
        .order(egui::Order::Tooltip)
        .fixed_pos(corner);
    let (theme, said) = (game.theme(), game.words());
    area.show(ui.ctx(), |ui| {
        button(ui, &theme, said.open_folder, size, ButtonStyle::Other).clicked()
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
