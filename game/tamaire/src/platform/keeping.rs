//! How single things are kept, whatever the storage: under which names, beside what was there, or set aside.

use super::storage::{Kind, Storage};
use crate::records::Records;
use std::io;
use std::sync::Arc;
use tamaire_play::{Assist, Level, Replay, shortened};

/// What could not be used of what was kept.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Damage {
    /// Each thing: where it stands, and why.
    pub refused: Vec<String>,
    /// Where all is kept as it was, if it could be.
    pub aside: Option<String>,
}

/// Most letters of why a level could not be read.
const LETTERS: usize = 200;

/// Between the name of what could not be used and the number of its copy.
const ASIDE: &str = ".broken-";

/// Names that are tried for what is kept.
const TRIES: usize = 8;

pub(super) const RECORDS: &str = "records";

/// Keeps bytes that cannot be used for whoever wrote them; says where.
pub(super) fn put_aside(
    storage: &dyn Storage,
    kind: Kind,
    name: &str,
    bytes: &[u8],
) -> io::Result<String> {
    let mut number = 1;
    loop {
        let aside = format!("{name}{ASIDE}{number}");
        let mut is_there = false;
        storage.change(kind, &aside, &mut |found| {
            is_there = found.is_none_or(|found| found == bytes);
            found.is_none().then(|| bytes.to_vec())
        })?;
        if is_there {
            return Ok(storage.location(kind, &aside));
        }
        number += 1;
    }
}

pub(super) fn is_aside(name: &str) -> bool {
    let number = name.rsplit_once(ASIDE).map(|(_, number)| number);
    number.is_some_and(|number| number.parse::<u32>().is_ok())
}

/// The level of a name; one that cannot be used is put aside.
pub(super) fn read_level(storage: &dyn Storage, name: &str) -> Result<Arc<Level>, Damage> {
    let location = storage.location(Kind::Level, name);
    let refused = |reason: &str, aside| {
        let reason = shortened(reason, LETTERS);
        let refused = vec![format!("{location} ({reason})")];
        Damage { refused, aside }
    };
    let unreadable = |error: io::Error| refused(&error.to_string(), None);
    let bytes = storage.read(Kind::Level, name).map_err(unreadable)?;
    let bytes = bytes.ok_or_else(|| unreadable(io::ErrorKind::NotFound.into()))?;
    let level = match Level::open(name) {
        Ok(_) => Err("a level of this name comes along".to_string()),
        Err(_) => Level::read_kept(name, &bytes).map_err(|error| error.to_string()),
    };
    level.map(Arc::new).map_err(|reason| {
        let aside = put_aside(storage, Kind::Level, name, &bytes);
        // What cannot be removed is told again the next time.
        let aside = aside.and_then(|aside| storage.remove(Kind::Level, name).map(|()| aside));
        refused(&reason, aside.ok())
    })
}

pub(super) fn merge_records(
    storage: &dyn Storage,
    records: &Records,
    levels: &[Arc<Level>],
) -> io::Result<()> {
    storage.change(Kind::Note, RECORDS, &mut |found| {
        let text = String::from_utf8_lossy(found.unwrap_or_default());
        let known = levels.iter().map(Arc::as_ref);
        let mut all = Records::read(&text).0.by_name(known);
        all.take(records.clone());
        Some(all.text().into_bytes())
    })
}

/// Keeps a replay; says where, or why not.
pub(super) fn save_replay(storage: &dyn Storage, replay: &Replay) -> io::Result<String> {
    // One that could not be watched is none.
    let text = replay.text_to_keep().map_err(io::Error::other)?;
    save(storage, Kind::Replay, &stem_of(replay), text.as_bytes())
}

/// How the names begin of what is kept of a round.
pub(super) fn stem_of(replay: &Replay) -> String {
    plain(&replay.level)
}

/// A name that any system takes.
pub(super) fn plain(name: &str) -> String {
    let is_plain = |letter: &char| letter.is_alphanumeric() || *letter == '-';
    name.chars().filter(is_plain).take(60).collect()
}

/// By which the fastest win in a level is kept: one for the level as it is, one for each way of making it easier.
pub(super) fn name_of_best(level: &Level) -> String {
    let assists = level.game().assists.iter().map(|assist| match assist {
        Assist::WiderBasket => "-wider",
        Assist::Unbreakable => "-unbreakable",
    });
    plain(&level.id) + &assists.collect::<String>()
}

/// Keeps a win, unless one in the same level that took no longer is kept.
pub(super) fn keep_best(storage: &dyn Storage, name: &str, replay: &Replay) -> io::Result<()> {
    let Ok(text) = replay.text_to_keep() else {
        // One that could not be watched is none.
        return Ok(());
    };
    storage.change(Kind::Best, name, &mut |found| {
        let known = found.and_then(|found| Replay::of_bytes(found).ok());
        let stays = known.is_some_and(|known| {
            known.level_hash == replay.level_hash && known.ticks() <= replay.ticks()
        });
        (!stays).then(|| text.clone().into_bytes())
    })
}

/// Keeps something under a name that is free; says where, or why not.
pub(super) fn save(
    storage: &dyn Storage,
    kind: Kind,
    stem: &str,
    bytes: &[u8],
) -> io::Result<String> {
    let names = storage.list(kind)?;
    let is_listed = |name: &String| names.iter().any(|entry| entry.name == *name);
    let numbered = (1..).map(|number| format!("{stem}-{number}"));
    let mut last = None;
    // What stands there and is not listed is no file, or of another program that was quicker.
    for name in numbered.filter(|name| !is_listed(name)).take(TRIES) {
        let mut is_free = false;
        let written = storage.change(kind, &name, &mut |found| {
            is_free = found.is_none();
            is_free.then(|| bytes.to_vec())
        });
        match written {
            Ok(()) if is_free => return Ok(storage.location(kind, &name)),
            Ok(()) => {}
            Err(error) => last = Some(error),
        }
    }
    Err(last.unwrap_or_else(|| io::Error::other("no name is free")))
}
