//! List of the texts that every language provides.

use crate::input::{Action, InputMethod};
use crate::settings::Quality;
use force_feedback::{Ability, Calibration, Stop};
use fuwafuwa_render::frame::ElementColour;
use fuwafuwa_scenes::import::ImportNote;
use fuwafuwa_scenes::scene::Form;
use tamaire_play::level::LevelError;
use tamaire_play::link::LinkError;
use tamaire_play::playground::{Stuff, Tool};
use tamaire_play::{Assist, Outcome, ReplayError, Route, Wish};

/// Texts of the game in one language.
#[allow(missing_docs)] // the field names say it
pub struct Words {
    pub play: &'static str,
    pub replays: &'static str,
    pub settings: &'static str,
    pub quit: &'static str,
    pub back: &'static str,
    pub paused: &'static str,
    pub go_on: &'static str,
    pub again: &'static str,
    pub play_again: &'static str,
    pub levels: &'static str,
    pub next: &'static str,
    pub other_way: fn(Route) -> &'static str,
    pub route: fn(Route) -> &'static str,
    /// Headline after a win before any hand moved.
    pub won_by_itself: &'static str,
    pub wish: fn(&Wish) -> String,
    pub summary: fn(&Outcome) -> [(&'static str, String); 4],
    pub new_best: &'static str,
    pub hopeless: &'static str,
    /// Message that no hand can touch or pull anything any more.
    pub empty_hand: &'static str,
    /// Line below the name of a level without gravity.
    pub nothing_falls: &'static str,
    /// Message that a condition of the level can no longer be met.
    pub missed: fn(&Wish) -> String,
    /// Message that a body is in a basket that refuses it.
    pub wrong_basket: &'static str,
    /// Title of a chapter, from its number and its name.
    pub chapter: fn(usize, &str) -> String,
    /// Stars of a chapter or of the whole path: those earned, and all.
    pub stars: fn(usize, usize) -> String,
    /// How a locked chapter opens: number of missing stars, and number of the chapter before.
    pub opens_with: fn(usize, usize) -> String,
    pub daily: &'static str,
    pub first_levels: &'static str,
    pub more_levels: &'static str,
    pub own_levels: &'static str,
    pub open_all: &'static str,
    /// Mark of a round in which time ran back.
    pub rewound: &'static str,
    /// Hint in a hopeless round: how to let time run back, from the name of the key.
    pub hold_to_rewind: fn(&str) -> String,
    pub let_go: &'static str,
    /// A time in seconds, rounded up to tenths.
    pub seconds: fn(f32) -> String,
    /// Position in a replay, and its length [s].
    pub seconds_of: fn(f32, f32) -> String,
    /// Name of the star for the win.
    pub fill_basket: &'static str,
    pub watch: &'static str,
    pub race: &'static str,
    /// Button that shows a way to win the level.
    pub show_way: &'static str,
    pub save: &'static str,
    pub delete: &'static str,
    pub confirm: &'static str,
    /// Message about a saved file, with its name and its folder.
    pub saved: fn(&str, Option<&str>) -> String,
    pub open_folder: &'static str,
    pub folder_not_opened: &'static str,
    pub slow: fn(f64) -> String,
    pub licences: &'static str,
    pub link: &'static str,
    pub link_to_level: &'static str,
    pub link_copied: &'static str,
    pub link_refused: &'static str,
    pub link_error: fn(&LinkError) -> String,
    pub offered: &'static str,
    pub download: &'static str,
    pub no_replays: &'static str,
    pub open: &'static str,
    pub what_opens: &'static str,
    pub no_dialog: &'static str,
    pub race_best: &'static str,
    pub hands_section: &'static str,
    pub toggle_keys: &'static str,
    pub dwell: &'static str,
    pub scanning: &'static str,
    pub how_by_switch: &'static str,
    pub calm: &'static str,
    /// Reason why a level is closed in calm mode.
    pub not_in_calm: &'static str,
    pub assists_section: &'static str,
    pub assist: fn(Assist) -> &'static str,
    pub assisted: &'static str,
    pub assist_ignored: fn(&str) -> String,
    pub legend: [&'static str; 4],
    pub language: &'static str,
    pub volume: &'static str,
    pub effects: &'static str,
    pub music: &'static str,
    pub interface: &'static str,
    pub haptics: &'static str,
    pub forces: &'static str,
    pub try_forces: &'static str,
    pub no_devices: &'static str,
    pub ability: fn(Ability) -> &'static str,
    pub forces_off: &'static str,
    pub silent: fn(Stop) -> &'static str,
    pub motors: [&'static str; 2],
    pub gains: [&'static str; 2],
    pub try_it: &'static str,
    pub enough: &'static str,
    pub push_it: &'static str,
    pub measure: &'static str,
    pub hands_off: &'static str,
    pub measured: &'static str,
    pub not_measured: &'static str,
    pub built: fn(&Calibration) -> String,
    pub as_usual: &'static str,
    pub forces_cut: &'static str,
    pub cut_now: &'static str,
    pub cut_hint: fn(&[String; 2]) -> String,
    pub restore: &'static str,
    pub restored: &'static str,
    pub forces_zero: &'static str,
    pub speed: &'static str,
    pub sensitivity: &'static str,
    pub stick_places: &'static str,
    pub full_screen: &'static str,
    pub photo: &'static str,
    pub clip: &'static str,
    pub reduced_motion: &'static str,
    pub colour_safe: &'static str,
    pub text_size: &'static str,
    pub controls: &'static str,
    pub press_any: &'static str,
    pub reset: &'static str,
    pub reset_question: &'static str,
    pub reset_now: &'static str,
    pub cancel: &'static str,
    pub sound_section: &'static str,
    pub play_section: &'static str,
    pub look_section: &'static str,
    pub action: fn(Action) -> &'static str,
    pub on: &'static str,
    pub off: &'static str,
    pub no_sound: &'static str,
    pub no_sticks: &'static str,
    pub join_hint: &'static str,
    pub how_in_space: fn(InputMethod, &[String; 3]) -> [String; 3],
    /// Hint that explains how to cut deeper into bodies in 3D. Its second argument names the keys that cut
    /// deeper and less deep. `None` for an input method without such keys.
    pub look_inside: fn(InputMethod, &[String; 2]) -> Option<String>,
    pub watching: &'static str,
    pub position: &'static str,
    /// Message that names the saved data that could not be read. If there is an unchanged copy, the message
    /// also names its location.
    pub damaged: fn(&str, Option<&str>) -> String,
    pub not_written: &'static str,
    pub full: &'static str,
    pub level_error: fn(&LevelError) -> String,
    /// Note on an imported file: what was left out of it or may surprise.
    pub import_note: fn(&ImportNote) -> String,
    pub replay_error: fn(&ReplayError) -> String,
    /// Short text of a wish, for the strip over a round.
    pub goal: fn(&Wish) -> String,
    /// Share of the mass at rest in the basket, and the required share.
    pub share: fn(f32, f32) -> String,
    /// As `share`, as a line of the pause menu.
    pub share_in_basket: fn(f32, f32) -> String,
    /// Figures of the outcome that miss the limits of a wish. `None` if there are none.
    pub near_miss: fn(&Wish, &Outcome) -> Option<String>,
    pub quality: &'static str,
    pub quality_name: fn(Quality) -> &'static str,
    pub quality_lowered: &'static str,
    pub drawing_slow: &'static str,
    pub two_players: &'static str,
    /// Explanation of who plays with what. The arguments are the names of the arrow keys and of the letter keys.
    pub who_plays: fn(&[String; 2]) -> [String; 4],
    pub play_as_two: &'static str,
    pub play_alone: &'static str,
    /// A number called out when the won levels are counted.
    pub count: fn(usize) -> String,
    /// Thanks at the end of the game, for the number of won levels, earned stars and all stars.
    pub thanks: fn(usize, usize, usize) -> [String; 2],
    /// Button that shows the ending.
    pub ending: &'static str,
    /// Explanation of the element view by its colours: size of the elements, or strain.
    pub elements_caption: fn(ElementColour) -> &'static str,
    /// Names of the materials of a playground.
    pub stuff: fn(Stuff) -> &'static str,
    /// Buttons that add a shape.
    pub add_form: fn(Form) -> &'static str,
    pub tool: fn(Tool) -> &'static str,
    pub sliders: &'static str,
    pub clear: &'static str,
    /// Page with the tools of a playground.
    pub tools: &'static str,
    /// Name of the choice of a material.
    pub material: &'static str,
    /// Name of the choice of a tool.
    pub hand_tool: &'static str,
    pub gravity: &'static str,
    pub air: &'static str,
    pub hand_size: &'static str,
    pub room_is_full: &'static str,
    pub too_many_pins: &'static str,
    pub too_many_changes: &'static str,
    /// Notice when a ghost shows the first move of the level.
    pub first_move: &'static str,
    /// Missing keys of one of two players at a keyboard.
    pub no_arrow_keys: &'static str,
    pub no_letter_keys: &'static str,
    pub one_hand: &'static str,
}
