//! Records of what happens at a stand. None of them identifies a visitor.

use crate::{Id, Moment};
use serde::{Deserialize, Serialize};
use tamaire_play::Route;

/// Visit of one player or a group, from the first touch until the stand is idle again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Visit {
    /// Unique identifier.
    pub id: Id,
    /// Name of the stand, from its settings.
    pub stand: String,
    /// Time of the first touch of the stick.
    pub began: Moment,
    /// Time at which the stand went idle again. `None` if the visit goes on, or if power or the program
    /// failed during it.
    pub ended: Option<Moment>,
    /// Language shown last, such as `de`.
    pub language: String,
}

/// One attempt at a level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Round {
    /// Unique identifier.
    pub id: Id,
    /// Visit to which the round belongs.
    pub visit: Id,
    /// Name of the stand.
    pub stand: String,
    /// Number of the round within its visit, from 1.
    pub number: u32,
    /// Time at which the round began.
    pub began: Moment,
    /// Playing time without pauses, from the beginning of the round [s]. The clock of the game shows less: it
    /// starts with the first push.
    pub seconds: f32,
    /// Name of the level.
    pub level: String,
    /// Hash of the level, [`tamaire_play::Level::hash`]. It differs between a level and its easier variant.
    pub level_hash: u64,
    /// Number of players.
    pub players: u8,
    /// Reason why the round ended.
    pub end: RoundEnd,
    /// Route by which the round was won; `None` if it was not won.
    pub route: Option<Route>,
    /// Sum of the masses of each body's largest piece at the end, as a share of this sum at the start, 0 to
    /// 1.
    pub kept: f32,
    /// Share of the total mass that rests in the basket at the end, 0 to 1.
    pub inside: f32,
    /// Number of pieces at the end.
    pub pieces: u32,
    /// Number of pieces outside the basket at the end of a won round, without crumbs
    /// ([`tamaire_play::rules::CRUMB`]). 0 if the round was not won.
    pub lost: u32,
    /// Route that the game suggested before this round. It differs from the route of the visitor's last win.
    /// `None` without a suggestion.
    pub dare: Option<Route>,
    /// Replay as text from [`tamaire_play::Replay::fragment`], a few kilobytes. Empty if there is no replay.
    pub replay: String,
}

/// Reason why a round ended.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RoundEnd {
    /// The player won.
    Won,
    /// The player restarted the round.
    Retried,
    /// The player chose another level or left.
    Left,
    /// The program ended while the round was still going on.
    Cut,
}

/// An event that matters to the staff of a stand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Unique identifier.
    pub id: Id,
    /// Name of the stand.
    pub stand: String,
    /// Time of the event.
    pub at: Moment,
    /// Kind of the event.
    pub kind: Kind,
    /// Details as a sentence, at most [`MAX_TEXT_BYTES`] long.
    pub text: String,
}

/// Kind of an event.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub enum Kind {
    /// The program started.
    Began,
    /// The program ended normally.
    Ended,
    /// The program crashed.
    Crashed,
    /// The program hung and was restarted.
    Hung,
    /// The GPU or the window was lost.
    LostGraphics,
    /// The supervisor stopped restarting the program after too many failures.
    GaveUp,
    /// The disk was full.
    FullDisk,
    /// A damaged logbook file was renamed, and a new logbook was created.
    DamagedFile,
    /// The clock was changed.
    ClockChanged,
    /// A stick or gamepad was unplugged.
    DeviceLost,
    /// A stick or gamepad was plugged in.
    DeviceFound,
    /// The staff menu was opened.
    StaffIn,
    /// A wrong PIN was entered for the staff menu.
    StaffRefused,
    /// The staff changed the settings.
    SettingsChanged,
    /// A kind that a later version of the program wrote.
    Other(String),
}

/// An entry to be written to a logbook.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Entry {
    /// A visit began.
    VisitBegan(Visit),
    /// A visit ended.
    VisitEnded {
        /// Id of the visit.
        id: Id,
        /// Time of the end.
        at: Moment,
        /// Language shown last; an empty text keeps the language from the beginning of the visit.
        language: String,
    },
    /// A round ended.
    Round(Round),
    /// An event happened.
    Event(Event),
}

/// Maximum length of a text in a row, except for replays [bytes]. Longer texts are truncated.
pub const MAX_TEXT_BYTES: usize = 1 << 14;

/// Names of the kinds of events in the logbook file. Part of the file format: the names must not be changed.
const KINDS: [(&str, Kind); 14] = [
    ("began", Kind::Began),
    ("ended", Kind::Ended),
    ("crashed", Kind::Crashed),
    ("hung", Kind::Hung),
    ("lost_graphics", Kind::LostGraphics),
    ("gave_up", Kind::GaveUp),
    ("full_disk", Kind::FullDisk),
    ("damaged_file", Kind::DamagedFile),
    ("clock_changed", Kind::ClockChanged),
    ("device_lost", Kind::DeviceLost),
    ("device_found", Kind::DeviceFound),
    ("staff_in", Kind::StaffIn),
    ("staff_refused", Kind::StaffRefused),
    ("settings_changed", Kind::SettingsChanged),
];

impl Kind {
    /// Returns the name under which the logbook file stores this kind of event.
    pub fn text(&self) -> &str {
        let known = KINDS.iter().find(|(_, kind)| kind == self);
        match (self, known) {
            (Self::Other(text), _) => text,
            (_, Some((text, _))) => text,
            (_, None) => unreachable!("KINDS lists every kind but Other"),
        }
    }
}

impl From<String> for Kind {
    fn from(text: String) -> Self {
        let known = KINDS.iter().find(|(known, _)| *known == text);
        known.map_or(Self::Other(text), |(_, kind)| kind.clone())
    }
}

impl From<Kind> for String {
    fn from(kind: Kind) -> Self {
        kind.text().into()
    }
}

impl RoundEnd {
    /// Returns the name under which the logbook file stores this reason.
    pub fn text(self) -> &'static str {
        match self {
            Self::Won => "won",
            Self::Retried => "retried",
            Self::Left => "left",
            Self::Cut => "cut",
        }
    }

    pub(crate) fn read(text: &str) -> Option<Self> {
        let all = [Self::Won, Self::Retried, Self::Left, Self::Cut];
        all.into_iter().find(|end| end.text() == text)
    }
}

/// Returns the name under which the logbook file stores a route.
pub fn route_text(route: Route) -> &'static str {
    match route {
        Route::Squeeze => "squeeze",
        Route::Shave => "shave",
        Route::Mix => "mix",
    }
}

pub(crate) fn read_route(text: &str) -> Option<Route> {
    let all = [Route::Squeeze, Route::Shave, Route::Mix];
    all.into_iter().find(|route| route_text(*route) == text)
}

/// Returns the approximate size of an entry in memory [bytes].
pub(crate) fn memory_size(entry: &Entry) -> usize {
    let texts = match entry {
        Entry::VisitBegan(visit) => visit.stand.len() + visit.language.len(),
        Entry::VisitEnded { .. } => 0,
        Entry::Round(round) => round.stand.len() + round.level.len() + round.replay.len(),
        Entry::Event(event) => event.stand.len() + event.text.len(),
    };
    size_of::<Entry>() + texts
}
