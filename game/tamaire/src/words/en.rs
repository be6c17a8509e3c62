//! English.

use super::Words;
use crate::input::{Action, Means};
use force_feedback::{Ability, Stop};
use tamaire_play::{Assist, Route};

pub(super) const WORDS: Words = Words {
    play: "Play",
    replays: "Replays",
    settings: "Settings",
    quit: "Quit",
    back: "Back",
    paused: "Paused",
    go_on: "Go on",
    again: "Again",
    levels: "Levels",
    next: "Next",
    other_way: |route| match route {
        Route::Squeeze => "Now try tearing bits off!",
        Route::Shave | Route::Mix => "Now try it whole!",
    },
    route: |route| match route {
        Route::Squeeze => "Squeezed in!",
        Route::Shave => "Shaved to fit!",
        Route::Mix => "Shaved and squeezed!",
    },
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
                .map(|least| format!("keep {:.0} %", 100.0 * least)),
        );
        parts.extend(wish.pieces.map(|least| format!("{least} pieces")));
        parts.join(", ")
    },
    summary: |outcome| {
        [
            ("Time", format!("{:.1} s", outcome.seconds())),
            ("Kept", format!("{:.0} %", 100.0 * outcome.kept)),
            ("Inside", format!("{:.0} %", 100.0 * outcome.inside)),
            ("Pieces", outcome.pieces.to_string()),
        ]
    },
    new_best: "New best!",
    watch: "Watch",
    race: "Race it",
    save: "Save replay",
    delete: "Delete",
    surely: "Really?",
    take_out: "Take out",
    saved: "Saved",
    slow: |share| {
        format!(
            "This level is a lot for this device: it runs at {:.0} % of its speed.",
            100.0 * share
        )
    },
    licences: "Licences",
    link: "Copy link",
    link_to_level: "Link to this level",
    link_copied: "The link is copied: paste it wherever you like.",
    link_refused: "The browser keeps its clipboard to itself: the link is not copied.",
    link_error: |error| error.to_string(),
    offered: "Somebody sent you a round",
    download: "Download",
    no_replays: "No replays yet. Save one while you pause or after a win, or drop a file here.",
    open: "Open…",
    what_opens: "Levels, pictures, models, replays",
    no_dialog: "This system has no window to pick a file with. Drop the file onto the game instead.",
    race_best: "Race my best round",
    hands_section: "Hands",
    toggle_keys: "Keys stay down until pressed again",
    dwell: "Resting the mouse presses a button",
    scanning: "One switch: all in turn",
    how_by_switch: "The switch does what the arrow shows",
    assists_section: "Help, from the next round on",
    assist: |assist| match assist {
        Assist::WiderBasket => "Wider basket",
        Assist::Unbreakable => "Nothing tears",
    },
    assisted: "with help",
    legend: [
        "won",
        "a wish came true",
        "squeezed in whole",
        "shaved to fit",
        "in space",
    ],
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
        Ability::Force => "It can push the stick",
        Ability::Rumble => "It can rumble",
        Ability::Nothing => "It cannot be felt",
    },
    forces_off: "Force is at 0: nothing is sent",
    silent: |why| match why {
        Stop::Unheard | Stop::Idle => "Nothing: nobody plays with it",
        Stop::Paused => "Nothing: the game is paused",
        Stop::FocusLost => "Nothing: another window is in front",
        Stop::Menu => "Nothing: a menu is open",
        Stop::Won => "Nothing: the round is won",
        Stop::Reset => "Nothing: the round begins",
        Stop::Unplugged => "Nothing: it is unplugged",
        Stop::Stale => "Nothing: the game is too slow",
        Stop::Emergency => "Nothing: forces are off",
        Stop::Ended => "Nothing: force feedback broke down",
    },
    motors: ["Slow motor", "Fast motor"],
    gains: ["Strength ←→", "Strength ↑↓"],
    try_it: "Try it",
    enough: "Enough",
    push_it: "Push the stick: it pushes back, and gives way at its edge.",
    measure: "Measure its motors",
    hands_off: "Put the stick upright and let go. It will move by itself.",
    measured: "Now it is known which way its motors push.",
    not_measured: "That was not clear. Put the stick upright and let go while it is measured.",
    built: |built| match (built.swap, built.invert) {
        (false, [false, false]) => "They push as usual".into(),
        (swap, [x, y]) => {
            let parts = [
                (swap, "swapped"),
                (x, "←→ turned round"),
                (y, "↑↓ turned round"),
            ];
            let parts: Vec<&str> = parts
                .iter()
                .filter(|part| part.0)
                .map(|part| part.1)
                .collect();
            format!("They are {}", parts.join(", "))
        }
    },
    as_usual: "As usual",
    forces_cut: "Forces off",
    cut_now: "All forces are off. Switch them on again in the settings, under Sticks and pads.",
    cut_hint: |[keys, buttons]| {
        format!(
            "To switch all forces off at once, press {keys} on the keyboard, or button {buttons}."
        )
    },
    restore: "Switch forces on again",
    restored: "Forces are on again.",
    forces_zero: "How strong forces were is lost, so they are at 0 until you choose again.",
    speed: "Game speed",
    sensitivity: "Sensitivity",
    stick_places: "Stick points at the place",
    photo: "Photo",
    clip: "Clip",
    full_screen: "Full screen, also by F11",
    reduced_motion: "Less motion",
    colour_safe: "Safe colours",
    text_size: "Text size",
    controls: "Controls",
    press_any: "Press a key or button…",
    reset: "Reset",
    sound_section: "Sound",
    play_section: "Play",
    look_section: "Look",
    action: |action| match action {
        Action::Up => "Up",
        Action::Down => "Down",
        Action::Left => "Left",
        Action::Right => "Right",
        Action::Retry => "Try again",
        Action::Pause => "Pause",
        Action::Elements => "Elements",
        Action::Slow => "Slow motion",
        Action::Step => "Single step",
        Action::Join => "Second player",
        Action::Raise => "Upwards (3D)",
        Action::Lower => "Downwards (3D)",
        Action::TurnLeft => "Look from the left (3D)",
        Action::TurnRight => "Look from the right (3D)",
        Action::Deeper => "Elements: deeper (3D)",
        Action::Shallower => "Elements: less deep (3D)",
        Action::CutForces => "Forces off",
    },
    on: "On",
    off: "Off",
    no_sound: "The game is silent",
    no_sticks: "Sticks and pads cannot be read here.",
    join_hint: "2 players",
    how_in_space: |means, [ways, up, around]| match means {
        Means::Mouse => [
            "Move: mouse".into(),
            format!("Up and down: wheel, or {up}"),
            format!("Look around: right mouse button, or {around}"),
        ],
        Means::Fingers => [
            "Move: one finger".into(),
            "Up and down: a second finger, up and down".into(),
            "Look around: a second finger, sideways".into(),
        ],
        Means::Keys => [
            format!("Move: {ways}"),
            format!("Up and down: {up}"),
            format!("Look around: {around}"),
        ],
        Means::Pad => [
            "Move: left stick".into(),
            "Up and down: triggers".into(),
            "Look around: right stick".into(),
        ],
        Means::Stick => [
            "Move: the stick".into(),
            format!("Up and down: buttons {up}"),
            format!("Look around: buttons {around}"),
        ],
    },
    look_inside: |means, [deeper, back]| match means {
        Means::Mouse => Some(format!("Wheel up, or {deeper}: look deeper")),
        Means::Keys | Means::Stick => Some(format!("{deeper}: look deeper, {back}: back")),
        Means::Pad => Some("Press the right stick: look deeper, the left: back".into()),
        Means::Fingers => None,
    },
    watching: "Replay",
    damaged: |refused, aside| match aside {
        Some(aside) => {
            format!("This was not understood: {refused}. All is kept as it was in {aside}")
        }
        None => format!("This could not be read: {refused}."),
    },
    not_written: "This could not be written:",
    full: "There is no room left: it is not kept.",
    level_error: |error| error.to_string(),
    replay_error: |error| error.to_string(),
};
