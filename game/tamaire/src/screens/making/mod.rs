//! Screen on which players draw bodies: with crayons on paper, or as a block of voxels.

mod block;
mod paper;
mod pen;
mod picture;
mod tools;

pub(super) use tools::{round as round_button, step_button, step_keys};

use super::widgets::{dim_background, finger, track};
use crate::game::Game;
use crate::input::InputMethod;
use app_shell::widgets::{ButtonStyle, button, least_letters};
use egui::{Key, Rect, Ui, UiBuilder, Vec2, pos2, vec2};
use tamaire_maker::drawing::PAPER;
use tamaire_sound::Menu;

/// Margin around the parts of the screen [points].
const EDGE: f32 = 12.0;
/// Least height of the row of buttons at the top [points].
const TOP: f32 = 48.0;
/// Width of the crayons in a landscape window, and least width of the tools [points].
const SIDE: f32 = 156.0;
/// Height of the line below the paper [points].
const LINE: f32 = 30.0;

/// Least number of cells along the longer side of a picture.
const LEAST_ACROSS: f32 = 12.0;

/// Parts of the screen.
struct Parts {
    top: Rect,
    crayons: Rect,
    paper: Rect,
    line: Rect,
    tools: Rect,
}

pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    dim_background(ui, 255);
    let parts = parts(ui);
    let leaves = top(game, ui, parts.top);
    match game.maker.shows_block {
        false => paper::show(game, ui, parts.paper),
        true => block::show(game, ui, parts.paper),
    }
    match game.maker.picture.is_some() && !game.maker.shows_block {
        true => picture_slider(game, ui, parts.line),
        false => told(game, ui, parts.line),
    }
    tools::crayons(game, ui, parts.crayons);
    tools::show(game, ui, parts.tools);
    if leaves {
        game.maker.lift_pen();
        game.maker.cursor = None;
        game.blip(Menu::Back);
        game.go_back();
    }
}

/// Returns the place of the paper or the block.
pub(super) fn sheet(ui: &Ui) -> Rect {
    parts(ui).paper
}

/// Divides the screen: crayons on the left, the paper in the middle, tools on the right, or all below each other in a
/// portrait window.
fn parts(ui: &Ui) -> Parts {
    let (screen, finger) = (ui.max_rect(), finger(ui));
    let all = screen.shrink(EDGE);
    let top = all.with_max_y(all.top() + finger.max(TOP));
    let below = all.with_min_y(top.bottom() + EDGE);
    if screen.width() > screen.height() {
        let side = (below.height() - LINE).min(below.width() - 2.0 * (SIDE + EDGE));
        let centre = pos2(below.center().x, below.top() + 0.5 * side);
        let paper = Rect::from_center_size(centre, Vec2::splat(side));
        return Parts {
            top,
            crayons: below.with_max_x(below.left() + SIDE),
            paper,
            line: paper
                .with_min_y(paper.bottom())
                .with_max_y(paper.bottom() + LINE),
            tools: below.with_min_x(paper.right() + EDGE),
        };
    }
    // The tools take what the paper leaves, but at least some rows.
    let side = below.width().min(0.56 * below.height());
    let centre = pos2(below.center().x, below.top() + 0.5 * side);
    let paper = Rect::from_center_size(centre, Vec2::splat(side));
    let line = below
        .with_min_y(paper.bottom())
        .with_max_y(paper.bottom() + LINE);
    let rest = below.with_min_y(line.bottom() + 4.0);
    let crayons = rest.with_max_y(rest.top() + tools::crayons_height(finger));
    Parts {
        top,
        crayons,
        paper,
        line,
        tools: rest.with_min_y(crayons.bottom() + 8.0),
    }
}

/// Shows the row at the top. Returns whether the player leaves the screen.
fn top(game: &mut Game, ui: &mut Ui, rect: Rect) -> bool {
    let (theme, said, words) = (game.theme(), game.words(), game.making());
    let high = rect.height();
    let wide = (0.3 * rect.width()).min(3.1 * high);
    let size = vec2(wide, high);
    let place = |left: f32, size: Vec2| Rect::from_min_size(pos2(left, rect.top()), size);
    let mut press = |text: &str, place: Rect, style: ButtonStyle| {
        let builder = UiBuilder::new().max_rect(place);
        let shown = ui.scope_builder(builder, |ui| button(ui, &theme, text, place.size(), style));
        shown.inner
    };
    let back = press(said.back, place(rect.left(), size), ButtonStyle::Other);
    // A drawing for the editor goes back there.
    let drop = if game.maker.is_alone() {
        words.drop
    } else {
        words.done
    };
    let drop = press(drop, place(rect.right() - wide, size), ButtonStyle::Main);
    let mut leaves = back.clicked();
    if drop.clicked() {
        game.blip(Menu::Confirm);
        game.drop_drawing();
    }
    let is_escape = ui.input(|input| input.key_pressed(Key::Escape));
    leaves |= is_escape && game.maker.cursor.is_none();
    let middle = Rect::from_x_y_ranges(
        rect.left() + wide + EDGE..=rect.right() - wide - EDGE,
        rect.y_range(),
    );
    tools::history(game, ui, middle);
    leaves
}

/// Shows how fine a picture is drawn. Any stroke on the paper makes it a drawing like others.
fn picture_slider(game: &mut Game, ui: &mut Ui, rect: Rect) {
    let Some(across) = game.maker.picture.as_ref().map(|picture| picture.across) else {
        return;
    };
    let (theme, words) = (game.theme(), game.making());
    let mut fine = across as f32;
    let builder = UiBuilder::new().max_rect(rect);
    let shown = ui.scope_builder(builder, |ui| {
        let title = words.fineness_of_picture;
        let range = [LEAST_ACROSS, PAPER as f32];
        let (response, asked) = track(ui, &theme, title, fine, range, 4.0, rect.width());
        if let Some(asked) = asked {
            fine = (asked / 4.0).round() * 4.0;
        }
        response.is_pointer_button_down_on()
    });
    let is_drag = shown.inner;
    if fine as usize != across {
        game.redraw_picture(fine as usize, is_drag);
    }
    if let Some(picture) = game.maker.picture.as_mut().filter(|_| !is_drag) {
        picture.end_drag();
    }
}

/// Tells below the paper what may surprise: thin parts and separate pieces.
fn told(game: &mut Game, ui: &Ui, rect: Rect) {
    let (theme, words) = (game.theme(), game.making());
    // In space, most bumps of a rounded body are thin, and break no sooner than the body.
    let is_paper = !game.maker.shows_block;
    let flaws = game.maker.flaws();
    let (pieces, is_thin) = (flaws.pieces.count, flaws.thin.contains(&true));
    let (text, ink) = if is_paper && is_thin {
        (words.too_thin.to_string(), theme.accent)
    } else if pieces > 1 {
        ((words.pieces)(pieces), theme.ink)
    } else if game.maker.cursor.is_some() || game.maker.is_sheet_on {
        let [by_keys, by_pad, by_switch] = words.how_to_draw;
        let how = match game.controls.means {
            _ if game.settings.scanning.is_on() => by_switch,
            InputMethod::Pad | InputMethod::Stick => by_pad,
            _ => by_keys,
        };
        (how.to_string(), theme.ink)
    } else {
        return;
    };
    let size = least_letters(ui.ctx()).max(18.0);
    let galley = app_shell::widgets::fitted(ui.painter(), &text, size, rect.width(), ink);
    ui.painter()
        .galley(rect.center() - 0.5 * galley.size(), galley, ink);
}
