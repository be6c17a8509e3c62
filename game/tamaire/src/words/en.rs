//! Texts of the game in English.

use super::Language;
use super::Words;
use super::{percent_below, percent_lost, percent_of_limit, tenths_above};
use crate::input::{Action, InputMethod};
use crate::settings::Quality;
use force_feedback::{Ability, Stop};
use fuwafuwa_render::frame::ElementColour;
use fuwafuwa_scenes::import::{ImportNote, NoteKind};
use fuwafuwa_scenes::scene::Form;
use tamaire_play::playground::{Stuff, Tool};
use tamaire_play::{Assist, Joints, Route};

pub(super) const WORDS: Words = Words {
    play: "Play",
    replays: "Replays",
    settings: "Settings",
    quit: "Quit",
    back: "Back",
    paused: "Paused",
    go_on: "Resume",
    again: "Restart",
    play_again: "Play again",
    levels: "Levels",
    next: "Next",
    other_way: |route| match route {
        Route::Squeeze => "Now try shaving it to fit!",
        Route::Shave | Route::Mix => "Now try squeezing it in whole!",
    },
    route: |route| match route {
        Route::Squeeze => "It went in whole!",
        Route::Shave => "Shaved to fit!",
        Route::Mix => "Shaved and squeezed!",
    },
    won_by_itself: "It wins by itself!",
    wish: |wish| {
        let mut parts = Vec::new();
        if let Some(route) = wish.route {
            parts.push(match route {
                Route::Squeeze => "squeeze it in whole".to_string(),
                Route::Shave => "shave it to fit".to_string(),
                Route::Mix => "a bit of both".to_string(),
            });
        }
        parts.extend(wish.seconds.map(|most| format!("within {most} s")));
        parts.extend(
            wish.kept
                .map(|least| format!("tear off at most {} %", percent_of_limit(1.0 - least))),
        );
        parts.extend(match (wish.pieces, wish.max_pieces) {
            (None, None) => None,
            (_, Some(1)) => Some("in one piece".into()),
            (Some(least), None) => Some(format!("at least {least} pieces")),
            (Some(least), Some(most)) if least == most => Some(format!("exactly {least} pieces")),
            (Some(least), Some(most)) => Some(format!("{least} to {most} pieces")),
            (None, Some(most)) => Some(format!("at most {most} pieces")),
        });
        parts.extend(wish.joints.map(|joints| match joints {
            Joints::Whole => "let no joint break".to_string(),
            Joints::Broken => "break a joint".to_string(),
        }));
        if !wish.whole.is_empty() {
            parts.push("do not break what is fragile".to_string());
        }
        parts.extend(
            wish.inside
                .map(|least| format!("bring in at least {} %", percent_of_limit(least))),
        );
        parts.join(", ")
    },
    summary: |outcome| {
        [
            ("Time", time(outcome.seconds())),
            ("Torn off", format!("{} %", percent_lost(outcome))),
            (
                "In the basket",
                format!("{} %", percent_below(outcome.inside)),
            ),
            ("Pieces", outcome.pieces.to_string()),
        ]
    },
    new_best: "New best!",
    let_go: "Let go!",
    seconds: time,
    seconds_of: |here, all| format!("{here:.1} / {all:.1} s"),
    fill_basket: "fill the basket",
    hopeless: "Not enough of the body is left to win.",
    empty_hand: "The hand holds nothing any more.",
    nothing_falls: "Nothing falls here.",
    missed: |wish| {
        format!(
            "This round cannot be won any more: {}.",
            (Language::English.words().wish)(wish)
        )
    },
    wrong_basket: "Wrong basket!",
    chapter: |number, name| format!("{number} · {name}"),
    stars: |earned, all| format!("★ {earned} / {all}"),
    opens_with: |missing, before| match missing {
        1 => format!("Opens with one more star in chapter {before}"),
        _ => format!("Opens with {missing} more stars in chapter {before}"),
    },
    daily: "Level of the day",
    first_levels: "Classic and playground",
    more_levels: "More levels",
    own_levels: "Your levels",
    open_all: "All chapters open",
    rewound: "with rewind",
    hold_to_rewind: |key| format!("Hold {key} to turn back time."),
    watch: "Watch",
    race: "Race it",
    show_way: "Show me how",
    save: "Save replay",
    delete: "Delete",
    confirm: "Really?",
    saved: |file, folder| match folder {
        Some(folder) => format!("Saved as {file} in {folder}"),
        None => format!("Saved as {file}"),
    },
    open_folder: "Open folder",
    folder_not_opened: "The folder could not be opened:",
    slow: |share| {
        format!(
            "This device is too slow for this level: running at {:.0} % speed.",
            100.0 * share
        )
    },
    licences: "Licences",
    link: "Copy link",
    link_to_level: "Link to this level",
    link_copied: "Link copied! Paste it anywhere you like.",
    link_refused: "The link was not copied: the browser does not allow access to the clipboard.",
    link_error: |error| error.to_string(),
    offered: "Someone sent you a round!",
    download: "Download",
    no_replays: "No replays yet. Save one from the pause menu or after a win, or drop a file here.",
    open: "Open…",
    what_opens: "Levels, pictures, models, replays",
    no_dialog: "This computer has no file picker. Drag the file onto the game instead.",
    race_best: "Race against my best round",
    hands_section: "Accessibility",
    toggle_keys: "Sticky keys",
    dwell: "Click by hovering",
    scanning: "One-switch scanning",
    how_by_switch: "Press the switch to do what the arrow shows",
    calm: "Calm mode: nothing tears, faces stay happy",
    not_in_calm: "Something has to tear in this level, so it is closed in calm mode.",
    assists_section: "Easier play (from the next round)",
    assist: |assist| match assist {
        Assist::WiderBasket => "Wider basket",
        Assist::Unbreakable => "Unbreakable body",
    },
    assisted: "easier play",
    assist_ignored: |name| format!("\"{name}\" is off here: this level cannot be won with it."),
    legend: ["won", "star earned", "squeezed in whole", "shaved to fit"],
    language: "Language",
    volume: "Volume",
    effects: "Effects",
    music: "Music",
    interface: "Menus",
    haptics: "Force",
    forces: "Sticks and pads",
    try_forces: "Sticks and pads…",
    no_devices: "No stick or pad is plugged in.",
    ability: |ability| match ability {
        Ability::Force => "It can push back",
        Ability::Rumble => "It can rumble",
        Ability::Nothing => "It cannot push or rumble",
    },
    forces_off: "Force is set to 0, so nothing is felt",
    silent: |why| match why {
        Stop::NoState | Stop::Idle => "No force: not in use",
        Stop::Paused => "No force: the game is paused",
        Stop::FocusLost => "No force: another window is in front",
        Stop::Menu => "No force: a menu is open",
        Stop::Won => "No force: the round is won",
        Stop::Reset => "No force: the round is starting",
        Stop::Unplugged => "No force: unplugged",
        Stop::Stale => "No force: the game is running too slowly",
        Stop::Emergency => "No force: forces are switched off",
        Stop::Ended => "No force: force feedback stopped working",
    },
    motors: ["Slow motor", "Fast motor"],
    gains: ["Strength ←→", "Strength ↑↓"],
    try_it: "Try it",
    enough: "Stop",
    push_it: "Push the stick: it pushes back, then suddenly gives way near the edge.",
    measure: "Test its motors",
    hands_off: "Set the stick upright and let go. It will move by itself.",
    measured: "Done! The game now knows which way the motors push.",
    not_measured: "That did not work. Set the stick upright and keep your hands off during the test.",
    built: |built| match (built.swap, built.invert) {
        (false, [false, false]) => "Motors: normal".into(),
        (swap, [x, y]) => {
            let parts = [(swap, "swapped"), (x, "←→ reversed"), (y, "↑↓ reversed")];
            let parts: Vec<&str> = parts
                .iter()
                .filter(|part| part.0)
                .map(|part| part.1)
                .collect();
            format!("Motors: {}", parts.join(", "))
        }
    },
    as_usual: "Back to normal",
    forces_cut: "Forces off",
    cut_now: "All forces are off. To switch them on again, open Settings, then Sticks and pads.",
    cut_hint: |[keys, buttons]| {
        format!(
            "To switch all forces off at once, press {keys} on the keyboard, or button {buttons}."
        )
    },
    restore: "Switch forces on again",
    restored: "Forces are on again.",
    forces_zero: "The force setting was lost. Forces are off until you set it again.",
    speed: "Game speed",
    sensitivity: "Sensitivity",
    stick_places: "Stick position = hand position",
    photo: "Photo",
    clip: "Clip",
    full_screen: "Full screen (F11)",
    reduced_motion: "Reduce motion",
    colour_safe: "Colour-blind friendly",
    text_size: "Text size",
    controls: "Controls",
    press_any: "Press a key or button…",
    reset: "Restore default settings",
    reset_question: "Restore the default settings? Language and accessibility stay.",
    reset_now: "Restore",
    cancel: "Cancel",
    sound_section: "Sound",
    play_section: "Play",
    look_section: "Display",
    action: |action| match action {
        Action::Up => "Up",
        Action::Down => "Down",
        Action::Left => "Left",
        Action::Right => "Right",
        Action::Retry => "Try again",
        Action::Rewind => "Rewind",
        Action::Pause => "Pause",
        Action::Elements => "Elements",
        Action::Slow => "Slow motion",
        Action::Step => "Single step",
        Action::Make => "Back to making",
        Action::Tool => "Use the tool (playground)",
        Action::Join => "Second player",
        Action::Raise => "Move up (3D)",
        Action::Lower => "Move down (3D)",
        Action::TurnLeft => "Look from the left (3D)",
        Action::TurnRight => "Look from the right (3D)",
        Action::Deeper => "Elements: deeper (3D)",
        Action::Shallower => "Elements: less deep (3D)",
        Action::CutForces => "Forces off",
    },
    on: "On",
    off: "Off",
    no_sound: "No sound",
    no_sticks: "Sticks and pads do not work here.",
    join_hint: "2 players",
    how_in_space: |means, [ways, up, around]| match means {
        InputMethod::Mouse => [
            "Move: mouse".into(),
            format!("Up and down: wheel, or {up}"),
            format!("Look around: right mouse button, or {around}"),
        ],
        InputMethod::Fingers => [
            "Move: one finger".into(),
            "Up and down: a second finger, up and down".into(),
            "Look around: a second finger, sideways".into(),
        ],
        InputMethod::Keys => [
            format!("Move: {ways}"),
            format!("Up and down: {up}"),
            format!("Look around: {around}"),
        ],
        InputMethod::Pad => [
            "Move: left stick".into(),
            "Up and down: triggers".into(),
            "Look around: right stick".into(),
        ],
        InputMethod::Stick => [
            "Move: the stick".into(),
            format!("Up and down: buttons {up}"),
            format!("Look around: buttons {around}"),
        ],
    },
    look_inside: |means, [deeper, back]| match means {
        InputMethod::Mouse => Some(format!("Wheel up, or {deeper}: look deeper")),
        InputMethod::Keys | InputMethod::Stick => {
            Some(format!("{deeper}: look deeper, {back}: back"))
        }
        InputMethod::Pad => Some("Press the right stick: look deeper, the left: back".into()),
        InputMethod::Fingers => None,
    },
    watching: "Replay",
    position: "Position in the replay",
    damaged: |refused, aside| match aside {
        Some(aside) => {
            format!("This could not be read: {refused}. The original was kept as {aside}")
        }
        None => format!("This could not be read: {refused}."),
    },
    not_written: "This could not be saved:",
    full: "There is no space left, so it was not saved.",
    level_error: |error| error.to_string(),
    import_note,
    replay_error: |error| error.to_string(),
    goal: |wish| {
        let mut parts = Vec::new();
        parts.extend(wish.route.map(|route| match route {
            Route::Squeeze => "whole".to_string(),
            Route::Shave => "shaved".to_string(),
            Route::Mix => "both ways".to_string(),
        }));
        parts.extend(wish.seconds.map(|most| format!("{most} s")));
        parts.extend(
            wish.kept
                .map(|least| format!("at most {} % torn off", percent_of_limit(1.0 - least))),
        );
        parts.extend(match (wish.pieces, wish.max_pieces) {
            (None, None) => None,
            (_, Some(1)) => Some("one piece".into()),
            (Some(least), None) => Some(format!("{least} pieces")),
            (Some(least), Some(most)) if least == most => Some(format!("= {least} pieces")),
            (Some(least), Some(most)) => Some(format!("{least} to {most} pieces")),
            (None, Some(most)) => Some(format!("≤ {most} pieces")),
        });
        parts.extend(wish.joints.map(|joints| match joints {
            Joints::Whole => "joints whole".to_string(),
            Joints::Broken => "joint broken".to_string(),
        }));
        if !wish.whole.is_empty() {
            parts.push("nothing fragile broke".to_string());
        }
        parts.extend(
            wish.inside
                .map(|least| format!("{} % in", percent_of_limit(least))),
        );
        parts.join(", ")
    },
    share: |found, needed| format!("{} / {} %", percent_below(found), percent_of_limit(needed)),
    share_in_basket: |found, needed| {
        let found = percent_below(found);
        format!("in the basket: {found} of {} %", percent_of_limit(needed))
    },
    near_miss: |wish, outcome| {
        let missed = outcome.misses(wish);
        let parts = [
            missed.seconds.map(|_| time(outcome.seconds())),
            missed
                .kept
                .map(|_| format!("{} % torn off", percent_lost(outcome))),
            missed
                .pieces
                .map(|least| format!("{} of {least}", outcome.pieces)),
            missed
                .max_pieces
                .map(|_| format!("{} pieces", outcome.pieces)),
            missed.joints.map(|joints| match joints {
                Joints::Whole => "a joint broke".to_string(),
                Joints::Broken => "no joint broke".to_string(),
            }),
            (!missed.whole.is_empty()).then(|| "it broke".to_string()),
            missed.inside.map(|least| {
                let found = percent_below(outcome.inside);
                format!("{found} of {} %", percent_of_limit(least))
            }),
            missed.route.map(|_| match outcome.route {
                Route::Squeeze => "it went in whole".to_string(),
                Route::Shave => "it was shaved".to_string(),
                Route::Mix => "it was shaved and squeezed".to_string(),
            }),
        ];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        (!parts.is_empty()).then(|| parts.join(", "))
    },
    quality: "Picture quality",
    quality_name: |quality| match quality {
        Quality::Automatic => "Automatic",
        Quality::High => "High",
        Quality::Medium => "Medium",
        Quality::Low => "Low",
    },
    quality_lowered: "The picture quality was lowered to keep the game smooth. You can change it in Settings.",
    drawing_slow: "The picture is not smooth. A lower picture quality (in Settings) or a smaller window helps.",
    two_players: "Two players",
    who_plays: |[arrows, letters]| {
        [
            format!("First hand: mouse, or {arrows}"),
            format!("Second hand: {letters}"),
            "Stick or pad: press \"Second player\" to move the second hand.".into(),
            "Touch screen: in a 2D round, tap the two dots. Another finger then moves the second hand.".into(),
        ]
    },
    play_as_two: "Play as two",
    play_alone: "Play alone",
    no_arrow_keys: "The first player has no arrow key for each direction. Choose them in Settings, Controls.",
    no_letter_keys: "The second player has no letter key for each direction. Choose them in Settings, Controls.",
    count: |number| {
        const NAMES: [&str; 10] = [
            "One", "Two", "Three", "Four", "Five", "Six", "Seven", "Eight", "Nine", "Ten",
        ];
        let name = number.checked_sub(1).and_then(|index| NAMES.get(index));
        name.map_or(format!("{number}!"), |name| format!("{name}!"))
    },
    thanks: |levels, earned, all| {
        let first = match earned == all {
            true => format!("{levels} levels and every star! Nothing is left to tear."),
            false => format!("{levels} levels, {earned} of {all} stars."),
        };
        [first, "Thank you for playing!".to_string()]
    },
    ending: "The ending",
    elements_caption: |colour| match colour {
        ElementColour::Level => {
            "The body is made of blocks: small at the rim, large inside. Where it tears, small ones replace large ones."
        }
        ElementColour::Strain => {
            "Blue is at rest, yellow is strained. It tears where the strain is too great."
        }
    },
    stuff: |stuff| match stuff {
        Stuff::Jelly => "Jelly",
        Stuff::Rubber => "Rubber",
        Stuff::Biscuit => "Biscuit",
        Stuff::Clay => "Clay",
        Stuff::Stone => "Stone",
        Stuff::Caramel => "Caramel",
        Stuff::Dough => "Dough",
    },
    add_form: |form| match form {
        Form::Ball | Form::Empty => "Add a ball",
        Form::Box => "Add a box",
        Form::Ring => "Add a ring",
        Form::Heart => "Add a heart",
        Form::Flower => "Add a flower",
    },
    tool: |tool| match tool {
        Tool::Push => "Push",
        Tool::Grab => "Grab: press and hold",
        Tool::Knife => "Knife: press and hold",
        Tool::Pin => "Pin: press",
    },
    sliders: "Gravity, air, hand",
    clear: "Clear the room",
    tools: "Tools",
    material: "Material",
    hand_tool: "Hand",
    gravity: "Gravity [m/s²]",
    air: "Air drag [1/s]",
    hand_size: "Hand radius [cm]",
    room_is_full: "The room is full.",
    too_many_pins: "No more pins fit. Clear the room or rewind.",
    too_many_changes: "Too many changes at once. Go on playing, or restart.",
    first_move: "The ghost shows a first move.",
    one_hand: "This level has only one hand, so one player plays.",
};

/// Returns a time in seconds, rounded up to tenths.
fn time(seconds: f32) -> String {
    format!("{:.1} s", tenths_above(seconds))
}

fn import_note(note: &ImportNote) -> String {
    let file = &note.file;
    match note.kind {
        NoteKind::HiddenModels { left_out } => {
            format!("{file}: hidden parts are left out ({left_out}).")
        }
        NoteKind::UnplacedModels { left_out } => {
            format!(
                "{file}: parts that are not placed in MagicaVoxel's world are left out ({left_out})."
            )
        }
        NoteKind::Frames { .. } => {
            format!("{file} is an animation. Only its first picture is used.")
        }
        NoteKind::Overlap { voxels } => {
            format!("{file}: parts of different colours overlap ({voxels} cubes).")
        }
        NoteKind::Pieces { pieces, touch } => {
            let how = if touch {
                " Cubes that touch only at edges or corners come apart."
            } else {
                ""
            };
            format!("{file} falls into {pieces} pieces.{how}")
        }
        NoteKind::Surroundings { .. } => {
            format!("{file}: everything that touches the edge of the picture is left out.")
        }
        NoteKind::Specks { .. } => format!("{file}: small specks are left out."),
        _ => note.to_string(),
    }
}
