//! Actions offered to a player with a single switch, drawn around the hand.

use super::{hud, icons, toys};
use crate::game::Game;
use crate::input::ScanAction;
use app_shell::Theme;
use app_shell::direction::to_world;
use egui::{Color32, Painter, Pos2, Shape, Stroke, Ui, Vec2};

/// Radius of the ring around the hand [points].
const RING: f32 = 58.0;
/// Size of an arrow [points].
const ARROW: f32 = 21.0;
/// Radius of the disc behind a sign [points].
const DISC: f32 = 21.0;
/// Distance from the hand to a point in the offered direction [m]. The point's position on the screen gives
/// the direction of the arrow.
const AHEAD: f32 = 0.1;

/// Draws the offered action, highlighted while the switch is pressed.
pub(super) fn show(game: &Game, ui: &Ui) {
    let round = game.bout.round();
    let is_offered = game.settings.scanning.is_on() && game.bout.session.is_played();
    let Some(view) = game.bout.view else {
        return;
    };
    if !is_offered || round.progress().outcome.is_some() {
        return;
    }
    let (theme, scale) = (game.theme(), hud::scale(game, ui));
    let (here, turn) = (round.hands()[0].position, game.bout.turn());
    let middle = view.to_screen(here);
    let is_taken = game.controls.devices.taken.is_some();
    let painter = ui.painter();
    let pale = Color32::from_white_alpha(150);
    painter.circle_stroke(middle, scale * RING, Stroke::new(scale * 2.5, pale));
    let above = middle - Vec2::new(0.0, scale * RING);
    match game.controls.scan.offer(&game.scan_actions()) {
        ScanAction::Move(way) => {
            let ahead = to_world(turn, AHEAD * way);
            let there = view.to_screen(here + ahead);
            arrow(
                painter,
                middle,
                (there - middle).normalized(),
                scale,
                tone(&theme, is_taken),
            );
        }
        ScanAction::Raise => sign(painter, &theme, above, scale, is_taken, icons::up),
        ScanAction::Lower => sign(painter, &theme, above, scale, is_taken, icons::down),
        ScanAction::Tool => {
            let icon = toys::icon(game.bout.toys.tool);
            let is_on = is_taken || game.bout.toys.is_latched;
            sign(painter, &theme, above, scale, is_on, icon);
        }
        ScanAction::Rewind => sign(painter, &theme, above, scale, is_taken, icons::rewind),
        ScanAction::Pause => sign(painter, &theme, above, scale, is_taken, icons::pause),
    }
}

fn tone(theme: &Theme, is_taken: bool) -> Color32 {
    if is_taken { theme.accent } else { theme.ink }
}

/// Draws an arrow on the ring around the hand. The arrow points outwards, in the direction `way`.
fn arrow(painter: &Painter, middle: Pos2, way: Vec2, scale: f32, tone: Color32) {
    let point = |out: f32, aside: f32| middle + scale * (out * way + aside * way.rot90());
    let corners = vec![
        point(RING + ARROW, 0.0),
        point(RING - 0.6 * ARROW, ARROW),
        point(RING - 0.35 * ARROW, 0.0),
        point(RING - 0.6 * ARROW, -ARROW),
    ];
    // Two convex halves, because the arrow as a whole is not convex.
    for half in [[0, 1, 2], [0, 2, 3]] {
        let half = half.map(|corner| corners[corner]).to_vec();
        painter.add(Shape::convex_polygon(half, tone, Stroke::NONE));
    }
    let edge = Stroke::new(scale * 2.5, Color32::WHITE);
    painter.add(Shape::closed_line(corners, edge));
}

/// Draws an icon on a disc.
fn sign(
    painter: &Painter,
    theme: &Theme,
    at: Pos2,
    scale: f32,
    is_taken: bool,
    icon: fn(&Painter, Pos2, f32, Color32),
) {
    let edge = Stroke::new(scale * 2.5, tone(theme, is_taken));
    painter.circle(at, scale * DISC, theme.card, edge);
    icon(painter, at, scale, tone(theme, is_taken));
}
