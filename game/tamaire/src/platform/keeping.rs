//! Rules for stored entries, independent of the storage: names, merging, and setting damaged data aside.

use super::storage::{Kind, Storage};
use crate::records::Records;
use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use tamaire_play::{Assist, Level, Pack, Replay, pack, shortened};

/// Stored data that could not be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Damage {
    /// Location and reason of each rejected item.
    pub refused: Vec<String>,
    /// Location of the unchanged copy, if it could be made.
    pub aside: Option<String>,
}

/// Maximum length of the reason why a level could not be read [characters].
const LETTERS: usize = 200;

/// Separator between the name of damaged data and the number of its copy.
const ASIDE: &str = ".broken-";

/// Maximum number of names tried for a new entry.
const TRIES: usize = 8;

pub(super) const RECORDS: &str = "records";

/// Name of the first pack of the player's own levels.
const PACK: &str = "my-levels";
/// Maximum number of packs with this name and a number.
const MOST_PACKS: usize = 999;

/// Stores a copy of damaged data for the player. Returns the location of the copy.
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
            return Ok(storage.location(kind, &aside).display().to_string());
        }
        number += 1;
    }
}

pub(super) fn is_aside(name: &str) -> bool {
    let number = name.rsplit_once(ASIDE).map(|(_, number)| number);
    number.is_some_and(|number| number.parse::<u32>().is_ok())
}

/// Reads a stored level. A damaged level is moved aside.
pub(super) fn read_level(storage: &dyn Storage, name: &str) -> Result<Arc<Level>, Damage> {
    let location = storage.location(Kind::Level, name);
    let refused = |reason: &str, aside| {
        let reason = shortened(reason, LETTERS);
        let refused = vec![format!("{} ({reason})", location.display())];
        Damage { refused, aside }
    };
    let unreadable = |error: io::Error| refused(&error.to_string(), None);
    let bytes = storage.read(Kind::Level, name).map_err(unreadable)?;
    let bytes = bytes.ok_or_else(|| unreadable(io::ErrorKind::NotFound.into()))?;
    let level = match Level::open(name) {
        Ok(_) => Err("the name belongs to a built-in level".to_string()),
        Err(_) => Level::read_kept(name, &bytes).map_err(|error| error.to_string()),
    };
    level.map(Arc::new).map_err(|reason| {
        let aside = put_aside(storage, Kind::Level, name, &bytes);
        // If the damaged level cannot be removed, the message about it appears again at the next start.
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

/// Saves a replay and returns its location.
pub(super) fn save_replay(storage: &dyn Storage, replay: &Replay) -> io::Result<PathBuf> {
    // Returns an error if the replay cannot be encoded, because such a replay could never be watched.
    let text = replay.text_to_keep().map_err(io::Error::other)?;
    save(storage, Kind::Replay, &stem_of(replay), text.as_bytes())
}

/// Returns the beginning of the file names of a round. A number follows in each name.
pub(super) fn stem_of(replay: &Replay) -> String {
    plain(&replay.level)
}

/// Returns `name` without the characters that some file system rejects, shortened to 60 characters.
pub(super) fn plain(name: &str) -> String {
    let is_plain = |letter: &char| letter.is_alphanumeric() || *letter == '-';
    name.chars().filter(is_plain).take(60).collect()
}

/// Returns the name under which the fastest win in a level is stored. Each combination of assists has a
/// separate entry.
pub(super) fn name_of_best(level: &Level) -> String {
    let assists = level.game().assists.iter().map(|assist| match assist {
        Assist::WiderBasket => "-wider",
        Assist::Unbreakable => "-unbreakable",
    });
    plain(&level.id) + &assists.collect::<String>()
}

/// Stores a win, unless an equally fast or faster one of the same level is stored.
pub(super) fn keep_best(storage: &dyn Storage, name: &str, replay: &Replay) -> io::Result<()> {
    let Ok(text) = replay.text_to_keep() else {
        // Skips a replay that cannot be encoded, because such a replay could never be watched.
        return Ok(());
    };
    storage.change(Kind::Best, name, &mut |found| {
        let known = found.and_then(|found| Replay::of_bytes(found).ok());
        let stays = known.is_some_and(|known| {
            known.level_hash == replay.level_hash && known.clock_ticks() <= replay.clock_ticks()
        });
        (!stays).then(|| text.clone().into_bytes())
    })
}

/// Stores the text of a level under its id, and replaces one with the same id.
pub(super) fn keep_text(storage: &dyn Storage, id: &str, text: &str) -> io::Result<()> {
    let mut change = |_: Option<&[u8]>| Some(text.as_bytes().to_vec());
    storage.change(Kind::Level, id, &mut change)
}

/// Returns the text of a stored level, as it was written. `None` if there is none, or it cannot be read.
pub(super) fn kept_text(storage: &dyn Storage, id: &str) -> Option<String> {
    let bytes = storage.read(Kind::Level, id).ok().flatten()?;
    String::from_utf8(bytes).ok()
}

/// Saves levels, each given by its id and its text, as packs. Returns the location of the last one; usually there is
/// only one. An earlier pack with other levels stays.
pub(super) fn save_packs(
    storage: &dyn Storage,
    levels: &[(String, String)],
) -> io::Result<PathBuf> {
    let mut place = Err(io::Error::other("there is no level to save"));
    let mut left = levels;
    while !left.is_empty() {
        let (now, later) = left.split_at(pack::fitting(left).max(1));
        place = save_pack(storage, &Pack::write(now));
        if place.is_err() {
            break;
        }
        left = later;
    }
    place
}

/// Saves a pack under the first name that is free or whose pack is the same.
fn save_pack(storage: &dyn Storage, bytes: &[u8]) -> io::Result<PathBuf> {
    let numbered = (2..=MOST_PACKS).map(|number| format!("{PACK}-{number}"));
    let mut last = None;
    for name in std::iter::once(PACK.to_string()).chain(numbered) {
        let mut is_there = false;
        let written = storage.change(Kind::Pack, &name, &mut |found| {
            is_there = found.is_none_or(|found| found == bytes);
            found.is_none().then(|| bytes.to_vec())
        });
        match written {
            Ok(()) if is_there => return Ok(storage.location(Kind::Pack, &name)),
            Ok(()) => {}
            // The name may be that of a folder, or of a file that the player put there.
            Err(error) if last.is_none() => last = Some(error),
            Err(error) => return Err(error),
        }
    }
    Err(last.unwrap_or_else(|| io::Error::other("no free name was found")))
}

/// Saves an entry under an unused name and returns its location.
pub(super) fn save(
    storage: &dyn Storage,
    kind: Kind,
    stem: &str,
    bytes: &[u8],
) -> io::Result<PathBuf> {
    let names = storage.list(kind)?;
    let is_listed = |name: &String| names.iter().any(|entry| entry.name == *name);
    let numbered = (1..).map(|number| format!("{stem}-{number}"));
    let mut last = None;
    // A name that is not listed may still be taken: by a folder, or by another program that has just used the
    // name.
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
    Err(last.unwrap_or_else(|| io::Error::other("no free name was found")))
}
