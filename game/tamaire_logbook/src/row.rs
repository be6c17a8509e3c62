//! What is kept of a day at a stand. Nothing in it says who somebody was.

use crate::{Id, Moment};
use serde::{Deserialize, Serialize};
use tamaire_play::Route;

/// What happens between two times at which the stand attracts: somebody, or some, came, played and went.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Visit {
    /// By what it is known.
    pub id: Id,
    /// The stand's name, as its settings have it.
    pub stand: String,
    /// When somebody touched the stick.
    pub began: Moment,
    /// When the stand went back to attracting. A visit without was cut off, by power or a crash, or goes on.
    pub ended: Option<Moment>,
    /// The language that was shown last, such as `de`.
    pub language: String,
}

/// One go at a level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Round {
    /// By what it is known.
    pub id: Id,
    /// The visit that it is of.
    pub visit: Id,
    /// The stand's name.
    pub stand: String,
    /// Which of its visit, from 1.
    pub number: u32,
    /// When it began.
    pub began: Moment,
    /// How long it was played [s], pauses aside.
    pub seconds: f32,
    /// The level's name.
    pub level: String,
    /// [`tamaire_play::Level::hash`]: the same level made easier has another one.
    pub level_hash: u64,
    /// How many people played.
    pub players: u8,
    /// How it ended.
    pub end: End,
    /// By which route it was won, if it was.
    pub route: Option<Route>,
    /// The mass in the largest piece of each body, as a share of what that was at the start.
    pub kept: f32,
    /// Share of the mass that rested in the basket at the end.
    pub inside: f32,
    /// Number of pieces at the end.
    pub pieces: u32,
    /// How many of them were not in the basket, crumbs aside.
    pub lost: u32,
    /// The other route, where it was suggested before this round.
    pub dare: Option<Route>,
    /// What [`tamaire_play::Replay::fragment`] made of it, a few kilobytes.
    pub replay: String,
}

/// How a round ended.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// It was won.
    Won,
    /// It was begun again.
    Retried,
    /// Whoever played chose something else, or went away.
    Left,
    /// The game ended under it.
    Cut,
}

/// Something that whoever looks after a stand may want to know.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// By what it is known.
    pub id: Id,
    /// The stand's name.
    pub stand: String,
    /// When it happened.
    pub at: Moment,
    /// What happened.
    pub kind: Kind,
    /// More about it, for people; of no more than [`MAX_TEXT_BYTES`].
    pub text: String,
}

/// What happened at a stand.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub enum Kind {
    /// The program was started.
    Began,
    /// The program ended as it was told to.
    Ended,
    /// The program broke down.
    Crashed,
    /// The program stood still and was started anew.
    Hung,
    /// The GPU or the window was lost.
    LostGraphics,
    /// What starts the program anew did so no more.
    GaveUp,
    /// There was no room left on the disk.
    FullDisk,
    /// A file could not be used and was set aside.
    DamagedFile,
    /// The clock was set to another time.
    ClockChanged,
    /// A stick or pad was unplugged.
    DeviceLost,
    /// A stick or pad was plugged in.
    DeviceFound,
    /// Somebody opened what is for the staff.
    StaffIn,
    /// Somebody tried to, and was refused.
    StaffRefused,
    /// The staff changed the settings.
    SettingsChanged,
    /// What a later version wrote.
    Other(String),
}

/// Something to write down.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Entry {
    /// A visit began.
    VisitBegan(Visit),
    /// A visit ended.
    VisitEnded {
        /// Which.
        id: Id,
        /// When.
        at: Moment,
        /// The language that was shown last; empty leaves it as it was when the visit began.
        language: String,
    },
    /// A round ended.
    Round(Round),
    /// Something else happened.
    Event(Event),
}

/// Most bytes of a text in a row, replays aside: what is longer is cut short.
pub const MAX_TEXT_BYTES: usize = 1 << 14;

/// The texts on file. They stay as they are.
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
    /// As it stands on file.
    pub fn text(&self) -> &str {
        let known = KINDS.iter().find(|(_, kind)| kind == self);
        match (self, known) {
            (Self::Other(text), _) => text,
            (_, Some((text, _))) => text,
            (_, None) => unreachable!("a test asks for the text of each"),
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

impl End {
    /// As it stands on file.
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

/// A route as it stands on file.
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

/// What an entry takes in memory [bytes], much as it is.
pub(crate) fn room_of(entry: &Entry) -> usize {
    let texts = match entry {
        Entry::VisitBegan(visit) => visit.stand.len() + visit.language.len(),
        Entry::VisitEnded { .. } => 0,
        Entry::Round(round) => round.stand.len() + round.level.len() + round.replay.len(),
        Entry::Event(event) => event.stand.len() + event.text.len(),
    };
    size_of::<Entry>() + texts
}
