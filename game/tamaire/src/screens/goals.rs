//! Goals of the level: a strip over the round, and lines in the pause menu.

use super::hud::ChipRow;
use super::icons;
use crate::game::Game;
use crate::words::Words;
use app_shell::Theme;
use app_shell::widgets::fitted;
use egui::{Color32, FontId, Painter, Pos2, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};
use tamaire_play::{AnyRound, Route, Wish, WishState};

/// Width of an icon with its margins [points at scale 1].
const ICON: f32 = 38.0;
/// Size of the text in the strip [points at scale 1].
const TEXT: f32 = 19.0;

/// A goal of the level, in its current state.
struct Goal {
    icon: GoalIcon,
    /// Text in the strip.
    short: String,
    /// Text in the pause menu.
    long: String,
    state: WishState,
    /// Whether the goal is a star, and not needed for the win.
    is_star: bool,
}

impl Goal {
    /// Returns the sign before the text.
    fn sign(&self) -> &'static str {
        match (self.is_star, self.state) {
            (true, WishState::Open) => "☆ ",
            (true, WishState::Done) => "★ ",
            (false, WishState::Open) => "",
            (false, WishState::Done) => "✓ ",
            (_, WishState::Missed) => "× ",
        }
    }
}

#[derive(Copy, Clone)]
enum GoalIcon {
    Basket,
    Route(Route),
    Clock,
    Kept,
    Pieces,
    Joints,
    Fragile,
}

impl GoalIcon {
    fn of(wish: &Wish) -> Self {
        match (wish.route, wish.seconds, wish.kept) {
            (Some(route), _, _) => Self::Route(route),
            (_, Some(_), _) => Self::Clock,
            (_, _, Some(_)) => Self::Kept,
            _ if wish.joints.is_some() => Self::Joints,
            _ if !wish.whole.is_empty() => Self::Fragile,
            _ if wish.inside.is_some() => Self::Basket,
            _ => Self::Pieces,
        }
    }

    fn draw(self, painter: &Painter, theme: &Theme, at: Pos2, scale: f32, ink: Color32) {
        match self {
            Self::Basket => icons::basket(painter, at, scale, ink),
            Self::Route(route) => icons::route(painter, theme, at, 9.0 * scale, route, true),
            Self::Clock => icons::clock(painter, at, scale, ink),
            Self::Kept => icons::kept(painter, at, scale, ink),
            Self::Pieces => icons::pieces(painter, at, scale, ink),
            Self::Joints => icons::joints(painter, at, scale, ink),
            Self::Fragile => icons::egg(painter, at, scale, ink),
        }
    }
}

/// Returns the goals of a round: the basket first, then what the level requires, then its wishes.
fn goals(round: &AnyRound, said: &Words) -> Vec<Goal> {
    let (progress, rules) = (round.progress(), round.level().game());
    let basket = round.has_basket().then(|| Goal {
        icon: GoalIcon::Basket,
        short: match progress {
            _ if progress.waits_for_hand(rules) => said.let_go.into(),
            _ if progress.refused => said.wrong_basket.into(),
            _ => (said.share)(progress.inside, rules.share),
        },
        long: (said.share_in_basket)(progress.inside, rules.share),
        state: match progress.outcome {
            Some(_) => WishState::Done,
            None => WishState::Open,
        },
        is_star: false,
    });
    let required = rules.require.iter().map(|wish| (wish, false));
    let wishes = required.chain(rules.wish.iter().map(|wish| (wish, true)));
    let wishes = wishes.map(|(wish, is_star)| Goal {
        icon: GoalIcon::of(wish),
        short: (said.goal)(wish),
        long: (said.wish)(wish),
        state: progress.state_of(wish, round.seconds()),
        is_star,
    });
    basket.into_iter().chain(wishes).collect()
}

/// Draws a chip for each goal. A condition of the win that is met gets a check mark, a star that is reached is filled,
/// and a missed goal is crossed out.
pub(super) fn strip(row: &mut ChipRow, theme: &Theme, game: &Game) {
    for goal in goals(game.bout.round(), game.words()) {
        let scale = row.scale;
        let ink = match goal.state {
            WishState::Missed => theme.faint,
            _ => theme.ink,
        };
        let font = FontId::proportional(TEXT * scale);
        let is_done = goal.state == WishState::Done && !goal.is_star;
        let text = match goal.is_star && goal.state != WishState::Missed {
            true => format!("{}{}", goal.sign(), goal.short),
            false => goal.short,
        };
        let galley = row.painter.layout_no_wrap(text, font, ink);
        let mark = if is_done { 24.0 } else { 0.0 };
        let rect = row.take(galley.size().x / scale + ICON + 16.0 + mark);
        let painter = row.painter;
        let middle = rect.left_center() + scale * vec2(0.5 * ICON + 2.0, 0.0);
        goal.icon.draw(painter, theme, middle, scale, ink);
        let left = rect.left() + scale * ICON;
        let end = left + galley.size().x;
        let at = pos2(left, rect.center().y - 0.5 * galley.size().y);
        painter.galley(at, galley, ink);
        match goal.state {
            WishState::Done if is_done => {
                let at = pos2(end + 16.0 * scale, rect.center().y);
                icons::tick(
                    painter,
                    at,
                    8.0 * scale,
                    Stroke::new(4.0 * scale, theme.good),
                );
            }
            WishState::Missed => {
                let line = [pos2(left, rect.center().y), pos2(end, rect.center().y)];
                painter.line_segment(line, Stroke::new(2.0 * scale, ink));
            }
            WishState::Open | WishState::Done => {}
        }
    }
}

/// Shows a line for each goal.
pub(super) fn lines(ui: &mut Ui, theme: &Theme, game: &Game) {
    const HIGH: f32 = 26.0;
    let goals = goals(game.bout.round(), game.words());
    let most = ui.available_width() - ICON;
    let lines = goals.into_iter().map(|goal| {
        let ink = match goal.state {
            WishState::Missed => theme.faint,
            _ => theme.ink,
        };
        let text = format!("{}{}", goal.sign(), goal.long);
        let galley = fitted(ui.painter(), &text, TEXT, most, ink);
        (goal.icon, galley, ink)
    });
    let lines: Vec<_> = lines.collect();
    let widths = lines.iter().map(|(_, galley, _)| galley.size().x);
    let width = widths.fold(0.0, f32::max) + ICON;
    for (icon, galley, ink) in lines {
        let (rect, response) = ui.allocate_exact_size(vec2(width, HIGH), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, galley.text()));
        let middle = rect.left_center() + vec2(0.4 * ICON, 0.0);
        icon.draw(ui.painter(), theme, middle, 0.85, ink);
        let at = rect.left_center() + vec2(ICON, -0.5 * galley.size().y);
        ui.painter().galley(at, galley, ink);
    }
}
