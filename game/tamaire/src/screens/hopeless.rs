//! Quiet message in a round that cannot be won any more, with a button to restart.

use super::buttons::pale;
use super::hud;
use crate::game::{Game, ScreenButton};
use crate::input::Action;
use app_shell::widgets::{ButtonStyle, button, fitted};
use egui::{Id, Rect, Ui, UiBuilder, pos2, vec2};
use fuwafuwa::{Dim, DimVector};
use tamaire_play::rules::CRUMB;
use tamaire_play::{AnyRound, Round};

/// Interval between two looks at the pieces [ticks]. A look reads all elements.
const LOOK: u64 = 30;
/// Height of the message [points at scale 1].
const HIGH: f32 = 56.0;
/// Distance of the message from the lower edge of the window [points at scale 1].
const EDGE: f32 = 15.0;
/// Size of the button [points].
const BUTTON: egui::Vec2 = vec2(150.0, 42.0);

/// Shows the message if the round on the screen cannot be won any more. Returns whether the mouse is over its
/// button.
pub(super) fn show(game: &mut Game, ui: &mut Ui) -> bool {
    let round = game.bout.round();
    let is_open = game.bout.session.is_played() && round.progress().outcome.is_none();
    if !is_open || !is_hopeless_lately(round, ui) {
        return false;
    }
    let (theme, said, scale) = (game.theme(), game.words(), hud::scale(game, ui));
    let screen = ui.max_rect();
    let most = screen.width() - 2.0 * EDGE - BUTTON.x - scale * 56.0;
    let text = fitted(ui.painter(), said.hopeless, scale * 19.0, most, theme.ink);
    let size = vec2(text.size().x + BUTTON.x + scale * 44.0, scale * HIGH);
    let below = match game.public {
        Some(_) => hud::STAND,
        None => scale * EDGE,
    };
    let middle = pos2(screen.center().x, screen.bottom() - below - 0.5 * size.y);
    let rect = Rect::from_center_size(middle, size);
    ui.painter().rect_filled(rect, 0.5 * size.y, pale(&theme));
    let at = rect.left_center() + vec2(scale * 22.0, -0.5 * text.size().y);
    ui.painter().galley(at, text, theme.ink);
    let corner = rect.right_center() - vec2(BUTTON.x + scale * 8.0, 0.5 * BUTTON.y);
    let place = Rect::from_min_size(corner, BUTTON);
    // A finger on the button does not move the hand.
    let touched = ScreenButton {
        action: Action::Retry,
        rect: place,
    };
    game.controls.buttons.push(touched);
    let response = ui
        .scope_builder(UiBuilder::new().max_rect(place), |ui| {
            button(ui, &theme, said.again, BUTTON, ButtonStyle::Other)
        })
        .inner;
    if response.clicked() {
        game.act(Action::Retry, touched.seat());
    }
    response.hovered()
}

/// Whether the round was hopeless at the last look.
fn is_hopeless_lately(round: &AnyRound, ui: &Ui) -> bool {
    let id = Id::unique("hopeless round");
    let look = round.ticks() / LOOK;
    let known: Option<(u64, bool)> = ui.data(|data| data.get_temp(id));
    match known.filter(|(before, _)| *before == look) {
        Some((_, is_hopeless)) => is_hopeless,
        None => {
            let is_hopeless = is_hopeless(round);
            ui.data_mut(|data| data.insert_temp(id, (look, is_hopeless)));
            is_hopeless
        }
    }
}

/// Whether so much of the bodies is crumbs outside the basket that the rest is less than a win requires. Bodies
/// that start as crumbs can always be won.
pub(super) fn is_hopeless(round: &AnyRound) -> bool {
    let level = round.level();
    let starts_torn =
        { level.scene().body.iter() }.any(|body| body.crumbled || body.diced.is_some());
    let left = match round {
        AnyRound::Plane(round) => share_left(round),
        AnyRound::Space(round) => share_left(round),
    };
    round.has_basket() && !starts_torn && left < level.game().share
}

/// Returns the share of the mass that is in pieces larger than crumbs, or in the basket.
fn share_left<D: Dim>(round: &Round<D>) -> f32 {
    let whole = round.progress().mass;
    let is_in_basket = |at| {
        { round.basket() }.is_some_and(|basket| basket.distance(D::Vector::from_vec3(at)).0 <= 0.0)
    };
    let pieces = { round.world().soft_bodies() }.flat_map(|(_, body)| body.piece_views());
    let left = pieces.filter(|piece| piece.mass > CRUMB * whole || is_in_basket(piece.centre));
    left.map(|piece| piece.mass).sum::<f32>() / whole
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::Dim2;
    use std::sync::Arc;
    use tamaire_play::{InputFrame, Level};

    fn round(id: &str) -> AnyRound {
        let mut round = AnyRound::new(Arc::new(Level::open(id).unwrap()));
        for _ in 0..30 {
            round.step(InputFrame::default());
        }
        round
    }

    #[test]
    fn whole_bodies_are_not_hopeless() {
        for id in ["classic", "twins", "core", "biscuit", "hoop"] {
            assert!(!is_hopeless(&round(id)), "{id}");
        }
    }

    #[test]
    fn body_of_crumbs_outside_the_basket_is_hopeless() {
        let text = std::fs::read_to_string("../tamaire_play/levels/classic.toml").unwrap();
        let crumbled = text.replacen("[[body]]", "[[body]]\ncrumbled = true", 1);
        let none = |_: &str| Err(std::io::ErrorKind::NotFound.into());
        let level = Level::read("crumbs.toml", crumbled.as_bytes(), &none).unwrap();
        let AnyRound::Plane(round) = AnyRound::new(Arc::new(level)) else {
            panic!("the level is in 2D");
        };
        let left = share_left::<Dim2>(&round);
        assert!(left < 0.01, "{left}");
        // A level that starts in crumbs is meant to be won with crumbs.
        assert!(!is_hopeless(&AnyRound::Plane(round)));
    }
}
