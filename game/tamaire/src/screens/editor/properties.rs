//! Page with the properties of the selected thing, or of the level.

use super::super::widgets::{card, choice, focus_first, header, page, slider_with, text_field};
use crate::game::{Game, MOST_NAME};
use crate::words::{Language, MakingWords, Words};
use app_shell::Theme;
use app_shell::theme::PAGE;
use egui::{Key, Rect, Ui, UiBuilder, vec2};
use fuwafuwa::Vec3;
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::{
    BasketText, BodyText, FieldText, HandText, JointKindText, JointText, MotionTypeText,
    ObstacleText, RepeatText, RigidBodyText, SwitchText, SwitchedBy,
};
use tamaire_maker::items::{Item, Stops, set_stops, stops_of};
use tamaire_maker::palette::{crayon, number_in};
use tamaire_play::playground::Stuff;
use tamaire_play::{Route, Wish};
use tamaire_sound::Menu;

/// Width of the page [points].
const WIDE: f32 = 760.0;
/// Share of a landscape window that the properties take.
const SHARE: f32 = 0.48;
/// Margin around the page [points].
const MARGIN: egui::Vec2 = vec2(14.0, 10.0);
/// Width at which a row of options has several lines [points].
const NARROW: f32 = 550.0;
/// Step of the slider of the length of a rope or spring [m].
const LENGTH_STEP: f32 = 0.05;
/// Weight of a kilogram, as it is told to children [N].
const WEIGHT: f32 = 10.0;
/// Number of goals that can be set.
const GOALS: usize = 3;

/// Returns the part of the screen for the properties: the right side, or the lower part of a portrait window. The room
/// runs in the rest, so that the properties are felt.
fn place(screen: Rect) -> Rect {
    match screen.width() > screen.height() {
        true => screen.with_min_x(screen.right() - SHARE * screen.width()),
        false => screen.with_min_y(screen.bottom() - 0.6 * screen.height()),
    }
}

/// Returns the part of the screen beside the properties.
pub(in crate::screens) fn beside_properties(screen: Rect) -> Rect {
    let taken = place(screen);
    match taken.left() > screen.left() {
        true => screen.with_max_x(taken.left()),
        false => screen.with_max_y(taken.top()),
    }
}

pub(in crate::screens) fn show(game: &mut Game, ui: &mut Ui) {
    let (theme, said, words) = (game.theme(), game.words(), game.making());
    let mut back = ui.input(|input| input.key_pressed(Key::Escape));
    let place = place(ui.max_rect());
    ui.painter().rect_filled(place, 0.0, PAGE);
    let item = game.main_item();
    let title = match item {
        Some(item) => game.item_name(item),
        None => words.level_settings.to_string(),
    };
    ui.scope_builder(UiBuilder::new().max_rect(place.shrink2(MARGIN)), |ui| {
        ui.set_clip_rect(place);
        let response = header(ui, &theme, said.back, &title);
        focus_first(ui, &response);
        back |= response.clicked();
        page(ui, &format!("properties of {item:?}"), WIDE, |ui| {
            card(ui, &theme, |ui| {
                ui.set_width(ui.available_width());
                let mut scene = game.maker.draft.scene().clone();
                let mut fields = Fields {
                    ui,
                    theme: &theme,
                    said,
                    words,
                    dim: scene.dim,
                    is_full: false,
                };
                match item {
                    Some(item) => of_item(&mut fields, &mut scene, item),
                    None => of_level(&mut fields, &mut scene, game.settings.language),
                }
                if fields.is_full {
                    game.notify(words.level_full.to_string());
                }
                if scene != *game.maker.draft.scene() {
                    game.preview_level(|known| *known = scene);
                }
            });
        });
    });
    // A slider that is dragged gives one step of undo.
    if !ui.input(|input| input.pointer.any_down()) {
        game.settle_preview();
    }
    if back {
        game.settle_preview();
        game.blip(Menu::Back);
        game.go_back();
    }
}

/// Rows of a page of properties.
struct Fields<'a> {
    ui: &'a mut Ui,
    theme: &'a Theme,
    said: &'static Words,
    words: &'static MakingWords,
    dim: u8,
    /// Whether a material was chosen for which the level has no space.
    is_full: bool,
}

impl Fields<'_> {
    /// Shows a slider from the first to the second number of `range` in steps of the third one.
    fn slide(&mut self, name: &str, value: &mut f32, range: [f32; 3], unit: &str) {
        let digits = if range[2] < 0.1 {
            2
        } else if range[2] < 1.0 {
            1
        } else {
            0
        };
        slider_with(self.ui, self.theme, name, value, range, |value| {
            format!("{value:.digits$}{unit}")
        });
    }

    /// Shows a slider for a time [s].
    fn slide_seconds(&mut self, name: &str, value: &mut f32, range: [f32; 3]) {
        slider_with(self.ui, self.theme, name, value, range, self.said.seconds);
    }

    /// Shows a slider for a value that may be missing; then it has a usual one.
    fn slide_or(
        &mut self,
        name: &str,
        value: &mut Option<f32>,
        usual: f32,
        range: [f32; 3],
        unit: &str,
    ) {
        let mut shown = value.unwrap_or(usual);
        let before = shown;
        self.slide(name, &mut shown, range, unit);
        if shown != before {
            *value = Some(shown);
        }
    }

    /// Shows a slider whose highest value stands for no limit.
    fn slide_limit(
        &mut self,
        (name, without): (&str, &str),
        value: &mut Option<f32>,
        range: [f32; 3],
        unit: &str,
    ) {
        let (known, high) = (*value, range[1]);
        let mut shown = known.unwrap_or(high);
        let text = |shown: f32| match limit_at(shown, known, high) {
            Some(limit) => format!("{limit:.0}{unit}"),
            None => without.to_string(),
        };
        slider_with(self.ui, self.theme, name, &mut shown, range, text);
        *value = limit_at(shown, known, high);
    }

    /// Shows a slider for a share in percent.
    fn slide_share(&mut self, name: &str, share: &mut f32) {
        let mut percent = (100.0 * *share).round();
        let before = percent;
        self.slide(name, &mut percent, [10.0, 100.0, 1.0], " %");
        if percent != before {
            *share = percent / 100.0;
        }
    }

    fn choose<T: Copy + PartialEq>(
        &mut self,
        name: &str,
        value: &mut T,
        options: &[(T, &str)],
    ) -> bool {
        // Many options need several rows, below their name.
        let most = if options.len() > 3 {
            NARROW
        } else {
            f32::INFINITY
        };
        let shown = self.ui.scope(|ui| {
            ui.set_max_width(ui.available_width().min(most));
            choice(ui, self.theme, name, value, options)
        });
        shown.inner
    }

    fn toggle(&mut self, name: &str, value: &mut bool) {
        let options = [(true, self.words.yes), (false, self.words.no)];
        self.choose(name, value, &options);
    }

    /// Shows a line of text that can be edited.
    fn write(&mut self, name: &str, value: &mut String) {
        text_field(self.ui, self.theme, name, value, MOST_NAME);
    }
}

fn of_item(fields: &mut Fields, scene: &mut Scene, item: Item) {
    match item {
        Item::Body(index) => body(fields, scene, index),
        Item::Obstacle(index) => {
            let switches = scene.switch.len();
            stops(fields, scene, index);
            if let Some(text) = scene.obstacle.get_mut(index) {
                obstacle(fields, text, switches);
            }
        }
        Item::Hand(index) => {
            if let Some(text) = scene.hand.get_mut(index) {
                hand(fields, text);
            }
        }
        Item::RigidBody(index) => {
            if let Some(text) = scene.rigid_body.get_mut(index) {
                rigid_body(fields, text);
            }
        }
        Item::Joint(index) => {
            let switches = scene.switch.len();
            if let Some(text) = scene.joint.get_mut(index) {
                joint(fields, text, switches);
            }
        }
        Item::Knife(index) => {
            let words = fields.words;
            if let Some(text) = scene.knife.get_mut(index) {
                fields.slide_or(
                    words.height,
                    &mut text.height,
                    0.02,
                    [0.02, 0.6, 0.02],
                    " m",
                );
            }
        }
        Item::Switch(index) => {
            if let Some(text) = scene.switch.get_mut(index) {
                switch(fields, text);
            }
        }
        Item::Field(index) => {
            if let Some(text) = scene.field.get_mut(index) {
                field(fields, text);
            }
        }
        Item::Basket(index) => basket(fields, scene, index),
    }
}

fn body(fields: &mut Fields, scene: &mut Scene, index: usize) {
    let words = fields.words;
    let Some(text) = scene.body.get(index).cloned() else {
        return;
    };
    if text.shape.is_some() {
        let number = usize::from(text.material.unwrap_or(1));
        let known = number.checked_sub(1);
        let known = known.and_then(|place| scene.material.get(place));
        let mut stuff = Stuff::ALL
            .into_iter()
            .find(|&stuff| known == Some(&crayon(stuff)));
        let options: Vec<(Option<Stuff>, &str)> = { Stuff::ALL.into_iter() }
            .map(|stuff| (Some(stuff), (fields.said.stuff)(stuff)))
            .collect();
        if fields.choose(fields.said.material, &mut stuff, &options)
            && let Some(stuff) = stuff
        {
            match number_in(&mut scene.material, &crayon(stuff)) {
                Some(number) => scene.body[index].material = Some(number),
                None => fields.is_full = true,
            }
        }
        let most = if scene.dim == 2 { 64.0 } else { 24.0 };
        let mut n = text.n.unwrap_or(16) as f32;
        fields.slide(words.fineness, &mut n, [6.0, most, 1.0], "");
        scene.body[index].n = Some(n as usize);
    }
    let text: &mut BodyText = &mut scene.body[index];
    fields.slide_or(
        words.weight,
        &mut text.gravity_scale,
        1.0,
        [-1.0, 2.0, 0.1],
        "",
    );
    let counted = { scene.game.as_mut() }.map(|game| &mut game.bodies);
    if let Some(counted) = counted {
        // An empty list counts all bodies.
        let all: Vec<usize> = (1..=scene.body.len()).collect();
        let list: Vec<usize> = match counted.is_empty() {
            true => all.clone(),
            false => counted.clone(),
        };
        let mut counts = list.contains(&(index + 1));
        let before = counts;
        fields.toggle(words.counts, &mut counts);
        if counts != before {
            let mut list: Vec<usize> = match counts {
                true => list.into_iter().chain([index + 1]).collect(),
                false => list.into_iter().filter(|&body| body != index + 1).collect(),
            };
            list.sort_unstable();
            if !list.is_empty() {
                *counted = if list == all { Vec::new() } else { list };
            }
        }
    }
}

/// Shows what an obstacle stops.
fn stops(fields: &mut Fields, scene: &mut Scene, index: usize) {
    let words = fields.words;
    let mut stops = stops_of(scene, index);
    let [all, hands, bodies] = words.stops;
    let options = [
        (Some(Stops::All), all),
        (Some(Stops::Hands), hands),
        (Some(Stops::Bodies), bodies),
    ];
    if fields.choose(words.wall_kind, &mut stops, &options)
        && let Some(stops) = stops
    {
        set_stops(scene, index, stops);
    }
}

fn obstacle(fields: &mut Fields, text: &mut ObstacleText, switches: usize) {
    let words = fields.words;
    fields.slide(words.friction, &mut text.friction, [0.0, 1.0, 0.05], "");
    if text.half_space.is_some() {
        return;
    }
    path(fields, text);
    let mut turn = text.angular_velocity.map_or(0.0, |turn| turn[2]);
    let before = turn;
    fields.slide(words.turning, &mut turn, [-3.0, 3.0, 0.1], "");
    if turn != before {
        let others = text.angular_velocity.unwrap_or_default();
        let turning = [others[0], others[1], turn];
        text.angular_velocity = (turning != [0.0; 3]).then_some(turning);
    }
    if text.path.is_empty() {
        (text.repeat, text.max_force) = (None, None);
    } else {
        fields.slide_limit(
            (words.force, words.without_limit),
            &mut text.max_force,
            [20.0, 1000.0, 20.0],
            " N",
        );
    }
    if text.angular_velocity.is_none() {
        (text.pivot, text.max_torque) = (None, None);
    }
    match text.moves() {
        true => switch_number(fields, &mut text.switch, switches),
        false => text.switch = None,
    }
}

/// Shows the end of a path of two points, the time to it, and what follows.
fn path(fields: &mut Fields, text: &mut ObstacleText) {
    let words = fields.words;
    let end = text.path.last().copied().unwrap_or([2.0, 0.0, 0.0, 0.0]);
    let mut changed = end;
    let axes = usize::from(fields.dim);
    for (axis, name) in words.moves_by.into_iter().take(axes).enumerate() {
        fields.slide(name, &mut changed[axis + 1], [-2.0, 2.0, 0.05], " m");
    }
    let moves = changed[1..] != [0.0; 3];
    if moves {
        fields.slide_seconds(words.seconds, &mut changed[0], [0.2, 10.0, 0.1]);
        let mut repeat = text.repeat.unwrap_or(RepeatText::Once);
        let [once, back, repeated] = words.repeats;
        let options = [
            (RepeatText::Once, once),
            (RepeatText::BackAndForth, back),
            (RepeatText::Loop, repeated),
        ];
        if fields.choose(words.then, &mut repeat, &options) {
            text.repeat = (repeat != RepeatText::Once).then_some(repeat);
        }
    }
    if changed != end {
        text.path = match (moves, text.path.len()) {
            (false, 0..=2) => Vec::new(),
            (true, 0 | 1) => vec![[0.0; 4], changed],
            (_, length) => {
                let mut path = std::mem::take(&mut text.path);
                changed[0] = changed[0].max(path[length - 2][0]);
                path[length - 1] = changed;
                path
            }
        };
    }
}

fn switch_number(fields: &mut Fields, value: &mut Option<usize>, count: usize) {
    let words = fields.words;
    let names: Vec<String> = (1..=count.min(12))
        .map(|number| number.to_string())
        .collect();
    let mut options = vec![(None, words.none)];
    options.extend(
        (1..)
            .zip(&names)
            .map(|(number, name)| (Some(number), name.as_str())),
    );
    if count > 0 {
        fields.choose(words.button, value, &options);
    }
}

fn hand(fields: &mut Fields, text: &mut HandText) {
    let words = fields.words;
    if let Some(radius) = &mut text.radius {
        let mut centimetres = 100.0 * *radius;
        fields.slide(
            fields.said.hand_size,
            &mut centimetres,
            [3.0, 30.0, 1.0],
            "",
        );
        if (centimetres - 100.0 * *radius).abs() > 0.01 {
            *radius = centimetres.round() / 100.0;
        }
    }
    if !text.kinematic {
        fields.slide_or(
            words.force,
            &mut text.max_force,
            1000.0,
            [20.0, 2000.0, 20.0],
            " N",
        );
    }
    fields.slide_or(
        words.friction,
        &mut text.friction,
        0.2,
        [0.0, 1.0, 0.05],
        "",
    );
}

fn rigid_body(fields: &mut Fields, text: &mut RigidBodyText) {
    let words = fields.words;
    let mut is_free = text.motion_type == MotionTypeText::Dynamic;
    if text.half_space.is_none() {
        let before = is_free;
        fields.toggle(words.free, &mut is_free);
        if is_free != before {
            text.motion_type = match is_free {
                true => MotionTypeText::Dynamic,
                false => MotionTypeText::Fixed,
            };
            text.mass = is_free.then_some(text.mass.unwrap_or(3.0));
            if !is_free {
                (text.velocity, text.angular_velocity) = (None, None);
            }
        }
    }
    if let Some(mass) = text.mass.as_mut().filter(|_| is_free) {
        fields.slide(words.mass, mass, [0.2, 40.0, 0.2], " kg");
    }
    let usual = if is_free { 0.5 } else { 0.2 };
    fields.slide_or(
        words.friction,
        &mut text.friction,
        usual,
        [0.0, 1.0, 0.05],
        "",
    );
}

fn joint(fields: &mut Fields, text: &mut JointText, switches: usize) {
    let words = fields.words;
    let is_rope = text.kind == JointKindText::Rope;
    let ends: Vec<Vec3> = { text.anchors.iter() }
        .map(|anchor| Vec3::from(anchor.point))
        .collect();
    if let Some(length) = &mut text.length {
        // A rope that is shorter than the distance of its ends tears at the start.
        let least = match ends[..] {
            [from, to] if is_rope => LENGTH_STEP * (from.distance(to) / LENGTH_STEP).ceil(),
            _ => 0.0,
        };
        let least = least.max(LENGTH_STEP);
        let range = [least, least.max(3.0), LENGTH_STEP];
        fields.slide(words.length, length, range, " m");
    }
    if text.kind == JointKindText::Spring {
        fields.slide_or(
            words.stiffness,
            &mut text.stiffness,
            200.0,
            [20.0, 4000.0, 20.0],
            "",
        );
    }
    let mut load = text.breaking_force.map(|force| force / WEIGHT);
    let before = load;
    fields.slide_limit(
        (words.breaks_at, words.never_breaks),
        &mut load,
        [2.0, 200.0, 2.0],
        " kg",
    );
    if load != before {
        text.breaking_force = load.map(|load| load * WEIGHT);
    }
    switch_number(fields, &mut text.switch, switches);
}

fn switch(fields: &mut Fields, text: &mut SwitchText) {
    let words = fields.words;
    let mut by = text.by.unwrap_or(SwitchedBy::Body);
    let [body, hand] = words.switched_by;
    if fields.choose(
        words.pressed_by,
        &mut by,
        &[(SwitchedBy::Body, body), (SwitchedBy::Hand, hand)],
    ) {
        text.by = (by != SwitchedBy::Body).then_some(by);
        if by == SwitchedBy::Hand {
            text.mass = None;
            text.bodies.clear();
        }
    }
    fields.toggle(words.stays, &mut text.stays);
}

fn field(fields: &mut Fields, text: &mut FieldText) {
    let words = fields.words;
    if let Some(acceleration) = &mut text.acceleration {
        let axes = usize::from(fields.dim);
        for (axis, name) in words.wind.into_iter().take(axes).enumerate() {
            fields.slide(name, &mut acceleration[axis], [-20.0, 20.0, 0.5], "");
        }
    }
    if let Some(strength) = &mut text.strength {
        fields.slide(words.pull, strength, [-20.0, 20.0, 0.5], "");
    }
    if let Some(reach) = &mut text.reach {
        fields.slide(words.reach, reach, [0.05, 3.0, 0.05], " m");
    }
}

fn basket(fields: &mut Fields, scene: &mut Scene, index: usize) {
    let words = fields.words;
    let bodies = scene.body.len();
    let Some(game) = &mut scene.game else {
        return;
    };
    if game.basket.is_some() {
        return fields.slide_share(words.share, &mut game.share);
    }
    let usual = game.share;
    let Some(text) = game.baskets.get_mut(index) else {
        return;
    };
    let mut share = text.share.unwrap_or(usual);
    let before = share;
    fields.slide_share(words.share, &mut share);
    if share != before {
        text.share = Some(share);
    }
    takes(fields, text, bodies);
}

/// Shows which bodies a basket takes, refuses, or neither.
fn takes(fields: &mut Fields, text: &mut BasketText, bodies: usize) {
    let words = fields.words;
    let [neither, takes, refuses] = words.takes;
    for number in 1..=bodies.min(12) {
        let mut role = match () {
            () if text.bodies.contains(&number) => 1,
            () if text.refuses.contains(&number) => 2,
            () => 0,
        };
        let name = format!("{} {number}", words.body);
        if fields.choose(&name, &mut role, &[(0, neither), (1, takes), (2, refuses)]) {
            for (list, mine) in [(&mut text.bodies, 1), (&mut text.refuses, 2)] {
                list.retain(|&known| known != number);
                if role == mine {
                    list.push(number);
                    list.sort_unstable();
                }
            }
        }
    }
}

fn of_level(fields: &mut Fields, scene: &mut Scene, language: Language) {
    let words = fields.words;
    let mut gravity = -scene.gravity[1];
    fields.slide(fields.said.gravity, &mut gravity, [-10.0, 20.0, 0.5], "");
    if gravity != -scene.gravity[1] {
        scene.gravity[1] = -gravity;
    }
    fields.slide(fields.said.air, &mut scene.drag, [0.0, 5.0, 0.1], "");
    let Some(game) = &mut scene.game else {
        return;
    };
    let [english, japanese] = words.names;
    let mut ja = game.name.ja.clone().unwrap_or_default();
    let write_ja = |fields: &mut Fields, ja: &mut String| fields.write(japanese, ja);
    if language == Language::Japanese {
        write_ja(fields, &mut ja);
        fields.write(english, &mut game.name.en);
    } else {
        fields.write(english, &mut game.name.en);
        write_ja(fields, &mut ja);
    }
    game.name.ja = (!ja.is_empty()).then_some(ja);
    if game.basket.is_none() && game.baskets.is_empty() {
        fields.ui.label(
            egui::RichText::new(words.no_basket)
                .size(19.0)
                .color(fields.theme.ink),
        );
        return;
    }
    fields.slide_share(words.share, &mut game.share);
    fields.slide_seconds(words.hold, &mut game.hold, [0.1, 10.0, 0.1]);
    fields.toggle(words.alone, &mut game.alone);
    for place in 0..GOALS {
        goal(fields, &mut game.wish, place);
    }
}

/// Kinds of goals that can be chosen.
#[derive(Copy, Clone, Debug, PartialEq)]
enum Goal {
    Nothing,
    Squeeze,
    Shave,
    Time,
    Whole,
    Little,
    Other,
}

impl Goal {
    /// Goals that a level states with one condition.
    const STATED: [Self; 5] = [
        Self::Squeeze,
        Self::Shave,
        Self::Time,
        Self::Whole,
        Self::Little,
    ];

    /// Returns the goal of a level. Time and share are those of `known`, or usual ones.
    fn wish(self, known: &Wish) -> Wish {
        let wish = Wish::default();
        match self {
            Self::Squeeze => Wish {
                route: Some(Route::Squeeze),
                ..wish
            },
            Self::Shave => Wish {
                route: Some(Route::Shave),
                ..wish
            },
            Self::Time => Wish {
                seconds: known.seconds.or(Some(10.0)),
                ..wish
            },
            Self::Whole => Wish {
                max_pieces: Some(1),
                ..wish
            },
            Self::Little => Wish {
                kept: known.kept.or(Some(0.9)),
                ..wish
            },
            Self::Nothing | Self::Other => wish,
        }
    }
}

fn goal(fields: &mut Fields, wishes: &mut Vec<Wish>, place: usize) {
    let words = fields.words;
    let known = wishes.get(place).cloned().unwrap_or_default();
    let mut stated = Goal::STATED.into_iter();
    let known_goal = match place < wishes.len() {
        true => stated.find(|goal| goal.wish(&known) == known),
        false => Some(Goal::Nothing),
    };
    let mut goal = known_goal.unwrap_or(Goal::Other);
    let [nothing, squeeze, shave, time, whole, little, other] = words.goals;
    let mut options = vec![
        (Goal::Nothing, nothing),
        (Goal::Squeeze, squeeze),
        (Goal::Shave, shave),
        (Goal::Time, time),
        (Goal::Whole, whole),
        (Goal::Little, little),
    ];
    if goal == Goal::Other {
        options.push((Goal::Other, other));
    }
    let name = format!("{} {}", words.goal, place + 1);
    if fields.choose(&name, &mut goal, &options) {
        let wish = goal.wish(&known);
        match (goal, place < wishes.len()) {
            (Goal::Nothing, true) => {
                wishes.remove(place);
            }
            (Goal::Nothing, false) => {}
            (_, true) => wishes[place] = wish,
            (_, false) => wishes.push(wish),
        }
    }
    let Some(wish) = wishes.get_mut(place) else {
        return;
    };
    match goal {
        Goal::Time => {
            let seconds = wish.seconds.get_or_insert(10.0);
            fields.slide_seconds(words.seconds, seconds, [1.0, 120.0, 1.0]);
        }
        Goal::Little => {
            let mut torn = 100.0 * (1.0 - wish.kept.unwrap_or(0.9));
            let before = torn;
            fields.slide(words.torn, &mut torn, [1.0, 60.0, 1.0], " %");
            if torn != before {
                wish.kept = Some((100.0 - torn.round()) / 100.0);
            }
        }
        _ => {}
    }
}

/// Returns the limit for which a slider with the highest value `high` stands at `shown`. `known` is the limit before, which
/// stays as long as the slider does not move, even if it is out of its range.
fn limit_at(shown: f32, known: Option<f32>, high: f32) -> Option<f32> {
    known
        .filter(|&known| known == shown)
        .or((shown < high).then_some(shown))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limit_above_the_range_of_its_slider_stays() {
        for (shown, known, expected) in [
            (5000.0, Some(5000.0), Some(5000.0)),
            (2000.0, Some(2000.0), Some(2000.0)),
            (2000.0, None, None),
            (2000.0, Some(600.0), None),
            (600.0, None, Some(600.0)),
        ] {
            assert_eq!(limit_at(shown, known, 2000.0), expected);
        }
    }
}
