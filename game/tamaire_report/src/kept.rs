//! Stored results of rounds that were run again. The file has one line of JSON per round. After an
//! interruption, the next report continues from the file.

use crate::Error;
use crate::rerun::Rerun;
use fuwafuwa::inspect::Hash;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use tamaire_logbook::{Id, Round};
use tamaire_play::replay::VERSION;

/// Stored results, by round and replay, for the current rules.
#[derive(Debug)]
pub struct RerunCache {
    path: PathBuf,
    file: File,
    /// Offset and length of each line [bytes].
    places: HashMap<Key, (u64, usize)>,
    end: u64,
}

/// Id of a round and hash of the round's replay.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
struct Key {
    round: Id,
    replay: u64,
}

#[derive(Serialize, Deserialize)]
struct Line {
    #[serde(flatten)]
    head: Head,
    result: Rerun,
}

#[derive(Serialize, Deserialize)]
struct Head {
    rules: u32,
    #[serde(flatten)]
    key: Key,
}

impl Key {
    fn of(round: &Round) -> Self {
        Self {
            round: round.id,
            replay: Hash::of(round.replay.as_bytes()),
        }
    }
}

impl RerunCache {
    /// Opens the file, and creates it if it does not exist. Removes an incomplete last line, which a killed
    /// program leaves behind.
    ///
    /// # Errors
    /// [`Error::Unwritable`].
    pub fn open(path: &Path) -> Result<Self, Error> {
        let failed = |error: std::io::Error| Error::unwritable(path, error);
        let mut options = OpenOptions::new();
        let options = options.read(true).write(true).create(true).truncate(false);
        let mut kept = Self {
            path: path.into(),
            file: options.open(path).map_err(failed)?,
            places: HashMap::new(),
            end: 0,
        };
        kept.index().map_err(failed)?;
        Ok(kept)
    }

    /// Returns whether there is no stored result of a round.
    pub fn lacks(&self, round: &Round) -> bool {
        !self.places.contains_key(&Key::of(round))
    }

    /// Returns the stored result of a round.
    ///
    /// # Errors
    /// [`Error::Unwritable`] if the file cannot be read.
    pub fn get(&mut self, round: &Round) -> Result<Option<Rerun>, Error> {
        let Some(&(at, length)) = self.places.get(&Key::of(round)) else {
            return Ok(None);
        };
        let mut bytes = vec![0; length];
        let read = self.file.seek(SeekFrom::Start(at));
        let read = read.and_then(|_| self.file.read_exact(&mut bytes));
        read.map_err(|error| Error::unwritable(&self.path, error))?;
        Ok(serde_json::from_slice::<Line>(&bytes)
            .ok()
            .map(|line| line.result))
    }

    /// Stores the result of a round.
    ///
    /// # Errors
    /// [`Error::Unwritable`].
    pub fn add(&mut self, round: &Round, result: Rerun) -> Result<(), Error> {
        let key = Key::of(round);
        let head = Head {
            rules: VERSION,
            key,
        };
        let line = Line { head, result };
        let mut text = serde_json::to_vec(&line).expect("every result can be serialized");
        text.push(b'\n');
        let written = self.file.seek(SeekFrom::Start(self.end));
        let written = written.and_then(|_| self.file.write_all(&text));
        written.map_err(|error| Error::unwritable(&self.path, error))?;
        self.places.insert(key, (self.end, text.len()));
        self.end += text.len() as u64;
        Ok(())
    }

    fn index(&mut self) -> std::io::Result<()> {
        let mut reader = BufReader::new(&self.file);
        let mut line = Vec::new();
        loop {
            line.clear();
            let length = reader.read_until(b'\n', &mut line)?;
            if line.last() != Some(&b'\n') {
                break;
            }
            // Lines of other versions of the rules stay in the file but are not used.
            if let Ok(Line { head, .. }) = serde_json::from_slice(&line)
                && head.rules == VERSION
            {
                self.places.insert(head.key, (self.end, length));
            }
            self.end += length as u64;
        }
        drop(reader);
        self.file.set_len(self.end)
    }
}
