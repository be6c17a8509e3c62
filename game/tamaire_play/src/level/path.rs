//! Levels of the path: their chapters and order. Each level has a folder `levels/NAME` with the level, its ways to
//! win, and its pictures or models, if it has any.

use super::Level;
use crate::Ways;

/// A level of the path.
#[derive(Copy, Clone, Debug)]
pub struct PathLevel {
    /// Name of the level.
    pub id: &'static str,
    /// Chapter, counted from 1.
    pub chapter: usize,
    /// Text of the level.
    pub text: &'static str,
    /// Text of the ways to win.
    ways: &'static str,
}

/// A chapter of the path.
#[derive(Copy, Clone, Debug)]
pub struct Chapter {
    /// English name.
    pub en: &'static str,
    /// Japanese name.
    pub ja: &'static str,
}

/// Chapters of the path, in order.
pub const CHAPTERS: [Chapter; 5] = [
    Chapter {
        en: "Soft",
        ja: "やわらかい",
    },
    Chapter {
        en: "Torn",
        ja: "ちぎる",
    },
    Chapter {
        en: "Moving",
        ja: "うごく",
    },
    Chapter {
        en: "Tied",
        ja: "むすぶ",
    },
    Chapter {
        en: "Sticky and strange",
        ja: "ねばねば・ふしぎ",
    },
];

/// Share of the stars of a chapter with which the next one opens.
pub const OPENING_SHARE: f32 = 0.5;

macro_rules! level {
    ($chapter:literal, $id:literal) => {
        PathLevel {
            id: $id,
            chapter: $chapter,
            text: include_str!(concat!("../../levels/", $id, "/level.toml")),
            ways: include_str!(concat!("../../levels/", $id, "/ways.toml")),
        }
    };
}

/// Levels of the path, in order.
pub const PATH: &[PathLevel] = &[
    level!(1, "back-door"),
    level!(1, "dog-with-a-stick"),
    level!(1, "hop"),
    level!(1, "under-the-table"),
    level!(1, "futon"),
    level!(1, "plunger"),
    level!(1, "piano"),
    level!(1, "moving-sofa"),
    level!(2, "halves"),
    level!(2, "ring-and-peg"),
    level!(2, "cake"),
    level!(2, "tofu"),
    level!(2, "peach"),
    level!(2, "katanuki"),
    level!(2, "ring-and-peg-3d"),
    level!(2, "bento"),
    level!(2, "chocolate"),
    level!(3, "high-striker"),
    level!(3, "lift"),
    level!(3, "lever"),
    level!(3, "ketchup"),
    level!(3, "foot-in-the-door"),
    level!(3, "ferry"),
    level!(3, "washing-machine"),
    level!(3, "daruma"),
    level!(4, "walk-the-dog"),
    level!(4, "buttons"),
    level!(4, "ducklings"),
    level!(4, "spoon-race"),
    level!(4, "balloon"),
    level!(4, "yo-yo-fishing"),
    level!(4, "dumbwaiter"),
    level!(4, "slingshot"),
    level!(4, "kusudama"),
    level!(5, "make-a-nest"),
    level!(5, "ghost-twins"),
    level!(5, "mirror-hands"),
    level!(5, "planet"),
    level!(5, "mochi"),
    level!(5, "dough"),
    level!(5, "weightless"),
    level!(5, "tamaire"),
];

impl PathLevel {
    /// Opens the level.
    pub fn open(&self) -> Level {
        Level::open(self.id).expect("tests open every level of the path")
    }

    /// Returns the ways to win the level.
    pub fn ways(&self) -> Ways {
        Ways::read(self.ways).expect("tests read the ways of every level")
    }
}
