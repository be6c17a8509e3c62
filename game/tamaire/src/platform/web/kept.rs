//! Storage in the browser. All entries are also in memory, because the browser's storage may take longer than
//! a frame. Changes by other tabs are received as messages.

use super::host;
use crate::platform::storage::{Entry, Kind, Storage, UpdateEntry};
use std::collections::BTreeMap;
use std::io;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, SystemTime};

/// Kinds that are stored in the browser, with their key prefixes. Entries of other kinds become downloads.
const KINDS: [(Kind, &str); 4] = [
    (Kind::Note, "note"),
    (Kind::Level, "level"),
    (Kind::Replay, "replay"),
    (Kind::Best, "best"),
];

/// Storage in the browser.
#[derive(Default)]
pub struct BrowserStorage(Mutex<BTreeMap<String, StoredEntry>>);

struct StoredEntry {
    bytes: Vec<u8>,
    written: SystemTime,
}

impl BrowserStorage {
    /// Applies changes by other tabs and returns all entries.
    fn now(&self) -> MutexGuard<'_, BTreeMap<String, StoredEntry>> {
        let mut things = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let host = host();
        while let Some(changed) = host.take_change() {
            let since = Duration::from_millis(changed.written().max(0.0) as u64);
            let written = SystemTime::UNIX_EPOCH + since;
            match changed.bytes() {
                Some(bytes) => _ = things.insert(changed.key(), StoredEntry { bytes, written }),
                None => things.clear(),
            }
        }
        things
    }
}

impl Storage for BrowserStorage {
    fn list(&self, kind: Kind) -> io::Result<Vec<Entry>> {
        let Some(beginning) = beginning(kind) else {
            return Ok(Vec::new());
        };
        let things = self.now();
        let entries = things.iter().filter_map(|(key, thing)| {
            let name = key.strip_prefix(&beginning)?.to_string();
            Some(Entry {
                name,
                written: thing.written,
            })
        });
        Ok(entries.collect())
    }

    fn read(&self, kind: Kind, name: &str) -> io::Result<Option<Vec<u8>>> {
        let Some(beginning) = beginning(kind) else {
            return Ok(None);
        };
        let things = self.now();
        let bytes = things.get(&(beginning + name)).map(|thing| &thing.bytes);
        match bytes.is_some_and(|bytes| bytes.len() as u64 > kind.most_bytes()) {
            true => Err(io::ErrorKind::FileTooLarge.into()),
            false => Ok(bytes.cloned()),
        }
    }

    fn change(&self, kind: Kind, name: &str, change: &mut UpdateEntry) -> io::Result<()> {
        let Some(beginning) = beginning(kind) else {
            if let Some(bytes) = change(None) {
                host().download(&file_name(kind, name), media(kind), &bytes);
            }
            return Ok(());
        };
        let (key, mut things) = (beginning + name, self.now());
        if let Some(bytes) = change(things.get(&key).map(|thing| &*thing.bytes)) {
            let milliseconds = js_sys::Date::now();
            host().keep(&key, &bytes, milliseconds);
            let written = SystemTime::UNIX_EPOCH + Duration::from_millis(milliseconds as u64);
            things.insert(key, StoredEntry { bytes, written });
        }
        Ok(())
    }

    fn remove(&self, kind: Kind, name: &str) -> io::Result<()> {
        let key = beginning(kind).map(|beginning| beginning + name);
        let removed = key.filter(|key| self.now().remove(key).is_some());
        let key = removed.ok_or(io::ErrorKind::NotFound)?;
        host().remove(&key);
        Ok(())
    }

    fn location(&self, kind: Kind, name: &str) -> PathBuf {
        file_name(kind, name).into()
    }

    fn can_export(&self) -> bool {
        true
    }

    fn export(&self, kind: Kind, name: &str) -> io::Result<()> {
        let bytes = self.read(kind, name)?.ok_or(io::ErrorKind::NotFound)?;
        host().download(&file_name(kind, name), media(kind), &bytes);
        Ok(())
    }

    fn take_failure(&self) -> Option<io::Error> {
        host().take_failure().map(refused)
    }
}

/// Converts the browser's reason of a failed write to an error.
pub(super) fn refused(reason: String) -> io::Error {
    let is_full = reason.starts_with("QuotaExceededError");
    let kind = if is_full {
        io::ErrorKind::StorageFull
    } else {
        io::ErrorKind::Other
    };
    io::Error::new(kind, reason)
}

/// Key prefix of a kind. `None` if the kind is not stored in the browser.
fn beginning(kind: Kind) -> Option<String> {
    let (_, word) = KINDS.iter().find(|(known, _)| *known == kind)?;
    Some(format!("{word}/"))
}

/// Returns the name of the file in which an entry is downloaded.
fn file_name(kind: Kind, name: &str) -> String {
    format!("{name}.{}", ending(kind))
}

fn ending(kind: Kind) -> &'static str {
    match kind {
        Kind::Note | Kind::Level => "toml",
        Kind::Replay | Kind::Best => "tamaire",
        Kind::Photo => "png",
        Kind::Clip => "gif",
        Kind::Pack => "zip",
    }
}

fn media(kind: Kind) -> &'static str {
    match kind {
        Kind::Photo => "image/png",
        Kind::Clip => "image/gif",
        Kind::Pack => "application/zip",
        _ => "text/plain",
    }
}
