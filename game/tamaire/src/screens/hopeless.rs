//! Quiet message in a round that cannot be won any more, with its reason and a button to restart.

use super::buttons::pale;
use super::hud;
use crate::game::{CurrentRound, Game, ScreenButton};
use crate::input::{Action, InputMethod};
use app_shell::widgets::{ButtonStyle, button};
use egui::{FontId, Rect, Ui, UiBuilder, pos2, vec2};
use fuwafuwa::inspect::{hands, is_hand, obstacles};
use fuwafuwa::{Dim, DimVector, JointAnchor, Vec3, World};
use tamaire_play::{AnyRound, Round, Wish, WishState};

/// Interval between two looks at the pieces [ticks]. A look reads all elements.
const LOOK: u64 = 30;
/// Distance from the arena from which a piece is out of reach [m].
const OUT: f32 = 0.3;
/// Speed below which a piece rests [m/s].
const SLOW: f32 = 0.03;
/// Height of the message with one line of text [points at scale 1].
const HIGH: f32 = 56.0;
/// Distance of the message from the lower edge of the window [points at scale 1].
const EDGE: f32 = 15.0;
/// Size of the button [points].
const BUTTON: egui::Vec2 = vec2(150.0, 42.0);

/// Shows the message if the round on the screen cannot be won any more. Returns whether the mouse is over its
/// button.
pub(super) fn show(game: &mut Game, ui: &mut Ui) -> bool {
    let bout = &mut game.bout;
    let is_open = bout.session.is_played() && bout.round().progress().outcome.is_none();
    if !is_open || !is_hopeless_lately(bout) {
        return false;
    }
    let (theme, said, scale) = (game.theme(), game.words(), hud::scale(game, ui));
    let bout = &game.bout;
    let screen = ui.max_rect();
    let most = screen.width() - 2.0 * EDGE - BUTTON.x - scale * 56.0;
    let font = FontId::proportional(scale * 19.0);
    let text = match lost_condition(bout.round()) {
        Some(wish) => (said.missed)(wish),
        None if can_any_hand_act(bout.round()) => said.hopeless.to_string(),
        None => said.empty_hand.to_string(),
    };
    let text = match rewind_hint(game) {
        Some(hint) => format!("{text} {hint}"),
        None => text,
    };
    let text = { ui.painter() }.layout(text, font, theme.ink, most.max(80.0));
    let high = (scale * HIGH).max(text.size().y + scale * 20.0);
    let size = vec2(text.size().x + BUTTON.x + scale * 44.0, high);
    let below = match game.public {
        Some(_) => hud::STAND,
        None => scale * EDGE,
    };
    let middle = pos2(screen.center().x, screen.bottom() - below - 0.5 * size.y);
    let rect = Rect::from_center_size(middle, size);
    ui.painter()
        .rect_filled(rect, scale * 0.5 * HIGH, pale(&theme));
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
    // A scope would make the whole screen count as hovered, so that the mouse would not move the hand.
    let mut child = ui.new_child(UiBuilder::new().max_rect(place));
    let response = button(&mut child, &theme, said.again, BUTTON, ButtonStyle::Other);
    if response.clicked() {
        game.act(Action::Retry, touched.seat());
    }
    response.hovered()
}

/// Returns how to let time run back, if it can.
fn rewind_hint(game: &Game) -> Option<String> {
    let bindings = &game.settings.bindings;
    let key = match game.controls.means {
        InputMethod::Fingers => "«".to_string(),
        InputMethod::Stick => bindings.first_names(&[Action::Rewind], true),
        InputMethod::Pad => {
            let [_, buttons] = bindings.names(Action::Rewind, game.controls.labels());
            buttons.split(" / ").next().unwrap_or_default().to_string()
        }
        InputMethod::Mouse | InputMethod::Keys => bindings.first_names(&[Action::Rewind], false),
    };
    let can = game.bout.session.seconds_to_rewind() > 0.0;
    can.then(|| (game.words().hold_to_rewind)(&key))
}

/// Whether the round was hopeless at the last look.
fn is_hopeless_lately(bout: &mut CurrentRound) -> bool {
    let look = bout.round().ticks() / LOOK;
    let known = bout.hopeless.filter(|(before, _)| *before == look);
    let (_, is_hopeless) = known.unwrap_or_else(|| (look, is_hopeless(bout.round())));
    bout.hopeless = Some((look, is_hopeless));
    is_hopeless
}

/// Returns whether the mass that can still be in the basket is less than a win requires, a condition can no longer be
/// met, or all rests and no hand can move anything any more.
fn is_hopeless(round: &AnyRound) -> bool {
    // A tool of a playground takes the touch away from the hand.
    if !round.has_basket() {
        return false;
    }
    let share = round.level().game().share;
    let (left, is_still) = match round {
        AnyRound::Plane(round) => (share_left(round), is_still(round)),
        AnyRound::Space(round) => (share_left(round), is_still(round)),
    };
    let is_stuck = is_still && round.progress().inside < share && !can_any_hand_act(round);
    left < share || lost_condition(round).is_some() || is_stuck
}

/// Returns whether a hand, or a part of it, touches bodies or holds a joint.
fn can_any_hand_act(round: &AnyRound) -> bool {
    match round {
        AnyRound::Plane(round) => can_hands_act(round.world()),
        AnyRound::Space(round) => can_hands_act(round.world()),
    }
}

fn can_hands_act<D: Dim>(world: &World<D>) -> bool {
    let is_hand = |anchor: &JointAnchor<D>| match anchor {
        JointAnchor::RigidBody { body, .. } => { world.rigid_body(*body) }.is_ok_and(is_hand),
        JointAnchor::Point(_) | JointAnchor::SoftBody { .. } => false,
    };
    let mut joints = world.joints();
    hands(world).any(|(_, hand)| hand.layers().filters != 0)
        || joints.any(|(_, joint)| joint.definition().anchors.iter().any(is_hand))
}

/// Returns whether all pieces and free rigid bodies rest.
fn is_still<D: Dim>(round: &Round<D>) -> bool {
    let world = round.world();
    let mut pieces = { world.soft_bodies() }.flat_map(|(_, body)| body.piece_views());
    let mut free = obstacles(world).filter(|body| body.is_dynamic());
    pieces.all(|piece| piece.velocity.length() < SLOW)
        && free.all(|body| body.velocity().linear.to_vec3().length() < SLOW)
}

/// Returns the condition of the level that can no longer be met.
fn lost_condition(round: &AnyRound) -> Option<&Wish> {
    let required = round.level().game().require.as_ref();
    required.filter(|wish| round.progress().state_of(wish, round.seconds()) == WishState::Missed)
}

/// Returns the share of the mass that is in the basket or that a hand can reach. Crumbs count: they can be swept
/// into the basket.
fn share_left<D: Dim>(round: &Round<D>) -> f32 {
    let is_in_basket = |at| {
        let at = D::Vector::from_vec3(at);
        { round.baskets().iter() }.any(|basket| basket.region.distance(at).0 <= 0.0)
    };
    let pieces = { round.counted_bodies() }.flat_map(|body| body.piece_views());
    let left = pieces.filter(|piece| {
        is_in_basket(piece.centre) || !piece.quarantined && !is_lost(round, piece.centre)
    });
    left.map(|piece| piece.mass).sum::<f32>() / round.progress().mass
}

/// Whether a position is outside the arena, where no hand can be, and gravity does not pull it back in.
fn is_lost<D: Dim>(round: &Round<D>, at: Vec3) -> bool {
    let [low, high] = round.level().arena();
    let fall = round.world().config().gravity;
    (0..D::N).any(|axis| {
        let is_below = at[axis] < low[axis] - OUT && fall[axis] <= 0.0;
        let is_above = at[axis] > high[axis] + OUT && fall[axis] >= 0.0;
        is_below || is_above
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::Session;
    use std::sync::Arc;
    use tamaire_play::{InputFrame, Level};

    /// Level without a floor.
    const BOTTOMLESS: &str = include_str!("../../tests/bottomless.toml");

    fn level(text: &str) -> Level {
        let none = |_: &str| Err(std::io::ErrorKind::NotFound.into());
        Level::read("test.toml", text.as_bytes(), &none).unwrap()
    }

    fn after(level: Level, ticks: usize) -> AnyRound {
        let mut round = AnyRound::new(Arc::new(level));
        for _ in 0..ticks {
            round.step(InputFrame::default());
        }
        round
    }

    #[test]
    fn whole_bodies_are_not_hopeless() {
        for id in ["classic", "twins", "core", "biscuit", "hoop"] {
            let round = after(Level::open(id).unwrap(), 30);
            assert!(!is_hopeless(&round), "{id}");
        }
    }

    #[test]
    fn crumbs_outside_the_basket_are_not_hopeless() {
        let text = std::fs::read_to_string("../tamaire_play/levels/classic.toml").unwrap();
        let crumbled = text.replacen("[[body]]", "[[body]]\ncrumbled = true", 1);
        let round = after(level(&crumbled), 0);
        assert!(round.progress().pieces > 100, "crumbs");
        assert!(!is_hopeless(&round));
    }

    #[test]
    fn body_that_fell_out_of_the_arena_is_hopeless() {
        assert!(!is_hopeless(&after(level(BOTTOMLESS), 0)));
        // It falls 6 m in two seconds.
        assert!(is_hopeless(&after(level(BOTTOMLESS), 120)));
        // A body above the arena falls back.
        let above = BOTTOMLESS.replace("at = [-0.3, -0.3, 0.0]", "at = [-0.3, 2.0, 0.0]");
        assert!(!is_hopeless(&after(level(&above), 0)));
    }

    #[test]
    fn hand_that_touches_and_holds_nothing_is_hopeless_once_all_rests() {
        let text = std::fs::read_to_string("../tamaire_play/levels/classic.toml").unwrap();
        let empty = text.replace("[[hand]]", "[[hand]]\nlayers = { filters = 0 }");
        let rope = "\n[[joint]]\nkind = \"rope\"\nlength = 3.0\n\
                    anchors = [{ hand = 1, point = [0.0, 0.0, 0.0] }, { point = [0.0, 0.5, 0.0] }]\n";
        let part = "\n[[hand]]\nradius = 0.05\nfollows = 1\npath = [[0.0, -1.5, -0.9, 0.0]]\n";
        for (text, expected) in [
            (text, false),
            (empty.clone(), true),
            (empty.clone() + part, false),
            (empty + rope, false),
        ] {
            let round = after(level(&text), 60);
            assert_eq!(
                (is_hopeless(&round), !can_any_hand_act(&round)),
                (expected, expected)
            );
        }
    }

    #[test]
    fn last_look_is_forgotten_in_a_new_round() {
        let begin = |text: &str| Session::of_people(Arc::new(level(text)));
        let mut bout = CurrentRound::new(begin(BOTTOMLESS));
        bout.hopeless = Some((0, true));
        assert!(is_hopeless_lately(&mut bout));
        bout.begin(begin(BOTTOMLESS), 0.0);
        assert!(!is_hopeless_lately(&mut bout));
    }
}
