//! Packs of levels: many levels in one ZIP archive or folder, with the pictures and models that they name.

mod zip;

use crate::level::LevelError;
use crate::{Level, Replay};
use fuwafuwa_scenes::import::MAX_FILE_BYTES;
use fuwafuwa_scenes::scene::{Fetch, MAX_TEXT_BYTES, extension_of};
use std::cell::Cell;
use std::collections::BTreeSet;
use std::io;

/// Maximum number of levels in a pack.
pub const MAX_LEVELS: usize = 100;
/// Maximum number of files in a pack.
pub const MAX_FILES: usize = 1000;
/// Maximum size of all files in a pack together [bytes]. A picture counts once more for each level that names it.
pub const MAX_BYTES: u64 = 1 << 26;
/// Maximum number of solid voxels in all levels of a pack together. The worlds of a pack are built at once, so this
/// limits their time and memory. For example, eight cubes 64 voxels wide.
pub const MAX_SOLID_VOXELS: usize = 1 << 21;

const _: () = assert!(
    MAX_BYTES <= MAX_FILE_BYTES,
    "a file of a pack can be dropped alone, too"
);

/// Maximum length of the name of a level [characters].
const MAX_NAME: usize = 60;
/// Name of a file whose own name has no usable character.
const NAMELESS: &str = "level.toml";
/// File extensions of pictures and models.
const BODY_EXTENSIONS: [&str; 7] = ["png", "jpg", "jpeg", "webp", "gif", "bmp", "vox"];

/// Levels that were read together. Each level has another id.
#[derive(Debug, Default)]
pub struct Pack {
    /// Levels, in the order of their files.
    pub levels: Vec<Level>,
    /// Name of each file that could not be used, and the reason.
    pub refused: Vec<(String, LevelError)>,
}

/// File of a pack.
struct PackFile {
    /// Folders and name, without `.` and `..`.
    path: Vec<String>,
    bytes: Vec<u8>,
}

impl Pack {
    /// Returns whether the content of a file is that of a ZIP archive.
    pub fn is_in(bytes: &[u8]) -> bool {
        zip::is_archive(bytes)
    }

    /// Reads a pack from the bytes of a ZIP archive named `name`. The levels may name pictures and models in the
    /// archive. Without a level, each picture and model becomes a level. Hidden files are ignored.
    ///
    /// # Errors
    /// [`LevelError::Unreadable`] if the archive is damaged, or has no level and no other usable file. The error of a
    /// single file is in [`Pack::refused`].
    pub fn read(name: &str, bytes: &[u8]) -> Result<Self, LevelError> {
        let unreadable = |reason| LevelError::Unreadable(name.into(), reason);
        let entries = zip::entries(bytes).map_err(unreadable)?;
        let files = entries
            .into_iter()
            .filter(|entry| !entry.path.ends_with(['/', '\\']));
        let files = files.map(|entry| {
            let path = entry.path.clone();
            let read = move |most: u64| match entry.length() as u64 > most {
                true => Err(too_long(entry.length() as u64)),
                false => entry.content(bytes),
            };
            (path, read)
        });
        Self::gather(name, files, &|_| Err(io::ErrorKind::NotFound.into()))
    }

    /// Reads a pack from files, each given by its path and a function that reads at most so many bytes, or returns the
    /// reason why it cannot. `fetch` loads files that a level names and that are not among `files`.
    ///
    /// # Errors
    /// [`LevelError::Unreadable`] if there are too many files, or none that can be used or refused.
    pub fn gather<R>(
        name: &str,
        files: impl IntoIterator<Item = (String, R)>,
        fetch: Fetch,
    ) -> Result<Self, LevelError>
    where
        R: FnOnce(u64) -> Result<Vec<u8>, String>,
    {
        let unreadable = |reason| LevelError::Unreadable(name.into(), reason);
        let (mut pack, mut left, mut count) = (Self::default(), MAX_BYTES, 0);
        let mut found: Vec<PackFile> = Vec::new();
        for (path, read) in files {
            let path = parts(&path);
            if is_ignored(&path) {
                continue;
            }
            count += 1;
            if count > MAX_FILES {
                return Err(unreadable(format!(
                    "expected at most {MAX_FILES} files, found more"
                )));
            }
            match read(left) {
                Ok(bytes) => {
                    left = left.saturating_sub(bytes.len() as u64);
                    found.push(PackFile { path, bytes });
                }
                Err(reason) => pack.refuse(&path, reason),
            }
        }
        if count == 0 {
            return Err(unreadable(
                "expected levels, pictures or models, found none".into(),
            ));
        }
        pack.open_all(&found, fetch);
        Ok(pack)
    }

    /// Opens the levels among `files`.
    fn open_all(&mut self, files: &[PackFile], fetch: Fetch) {
        let has_levels = files.iter().any(|file| Level::is_text_in(&file.bytes));
        let mut taken = BTreeSet::new();
        let (budget, mut voxels) = (Cell::new(MAX_BYTES), MAX_SOLID_VOXELS);
        for file in files {
            if has_levels && Level::is_body_in(&file.bytes) {
                continue;
            }
            if self.levels.len() == MAX_LEVELS {
                self.refuse(
                    &file.path,
                    format!("expected at most {MAX_LEVELS} levels in a pack"),
                );
                continue;
            }
            if Replay::is_in(&file.bytes) {
                let reason = "expected a level, a picture or a model, found a replay";
                self.refuse(&file.path, reason.into());
                continue;
            }
            let id = free_id(&id_of(file.name()), |id| taken.contains(&id.to_lowercase()));
            let fetch = |name: &str| {
                let bytes = match file.named(name, files) {
                    Some(named) => named.bytes.clone(),
                    None => fetch(name)?,
                };
                let left = budget.get().checked_sub(bytes.len() as u64);
                budget.set(left.ok_or_else(|| io::Error::other(too_long(bytes.len() as u64)))?);
                Ok(bytes)
            };
            match open(&id, &file.bytes, &fetch, &mut voxels) {
                Ok(level) => {
                    taken.insert(id.to_lowercase());
                    self.levels.push(level);
                }
                Err(error) => self.refused.push((file.name().into(), error)),
            }
        }
    }

    fn refuse(&mut self, path: &[String], reason: String) {
        let name = path.last().map_or(NAMELESS, String::as_str).to_string();
        self.refused
            .push((name.clone(), LevelError::Unreadable(name, reason)));
    }

    /// Returns a ZIP archive of levels, each given by its id and its text. Equal levels give an equal archive.
    /// [`Pack::read`] opens at most [`fitting`] of the levels.
    pub fn write(levels: &[(String, String)]) -> Vec<u8> {
        let mut taken = BTreeSet::new();
        let mut names = Vec::new();
        for (id, _) in levels {
            let mut name = plain_name(id);
            if extension_of(&name) != "toml" {
                name += ".toml";
            }
            let name = free_id(&name, |name| taken.contains(&name.to_lowercase()));
            taken.insert(name.to_lowercase());
            names.push(name);
        }
        let texts = levels.iter().map(|(_, text)| text.as_bytes());
        zip::write(names.iter().map(String::as_str).zip(texts))
    }
}

/// Returns how many of the levels, from the first one on, fit into a pack.
pub fn fitting(levels: &[(String, String)]) -> usize {
    let mut bytes = 0;
    let fits = levels.iter().take(MAX_LEVELS).take_while(|(_, text)| {
        bytes += text.len() as u64;
        bytes <= MAX_BYTES
    });
    fits.count()
}

/// Returns `id`, with a number before its file extension if it is taken.
pub fn free_id(id: &str, is_taken: impl Fn(&str) -> bool) -> String {
    let (stem, extension) = match id.rsplit_once('.') {
        Some((stem, extension)) if !stem.is_empty() => (stem, format!(".{extension}")),
        _ => (id, String::new()),
    };
    let numbered = (2_u64..).map(|number| format!("{stem}-{number}{extension}"));
    let mut ids = std::iter::once(id.to_string()).chain(numbered);
    let free = ids.find(|id| !is_taken(id));
    free.unwrap_or_else(|| id.to_string())
}

/// Opens a file of a pack as a level. Takes its solid voxels from `voxels`.
fn open(id: &str, bytes: &[u8], fetch: Fetch, voxels: &mut usize) -> Result<Level, LevelError> {
    let unreadable = |reason| LevelError::Unreadable(id.into(), reason);
    // A text that was kept has its pictures in it and may be longer than one that was written by hand.
    let is_kept = Level::is_text_in(bytes) && bytes.len() as u64 > MAX_TEXT_BYTES;
    let level = match is_kept {
        true => Level::read_kept(id, bytes)?,
        false => Level::read(id, bytes, fetch)?,
    };
    level.text_to_keep()?;
    let found = level.solid_voxels();
    let left = voxels.checked_sub(found).ok_or_else(|| {
        unreadable(format!(
            "expected at most {MAX_SOLID_VOXELS} solid voxels in all levels of a pack, found {found} after {} in the \
             levels before",
            MAX_SOLID_VOXELS - *voxels
        ))
    })?;
    *voxels = left;
    Ok(level)
}

impl PackFile {
    fn name(&self) -> &str {
        self.path.last().map_or(NAMELESS, String::as_str)
    }

    /// Returns the file to which a level in this file refers as `name`: the one at this place beside the level,
    /// otherwise one of this name in the folder of the level, otherwise one of this name in any folder.
    fn named<'a>(&self, name: &str, files: &'a [PackFile]) -> Option<&'a PackFile> {
        let wanted = parts(name);
        let folder = &self.path[..self.path.len().saturating_sub(1)];
        let place = [folder, &wanted].concat();
        let is_in_folder =
            |file: &&PackFile| file.path.split_last().is_some_and(|(_, of)| of == folder);
        let has_name = |file: &&PackFile| file.path.last() == wanted.last();
        let mut exact = files.iter().filter(|file| file.path == place);
        let mut near = files.iter().filter(is_in_folder).filter(has_name);
        let mut far = files.iter().filter(has_name);
        exact.next().or_else(|| near.next()).or_else(|| far.next())
    }
}

/// Returns the folders and the name of a path. Folders that lead out of the pack are left out.
fn parts(path: &str) -> Vec<String> {
    let parts = path.split(['/', '\\']).map(without_marks);
    parts
        .filter(|part| !matches!(part.as_str(), "" | "." | ".."))
        .collect()
}

/// Returns whether a file is hidden, or one that a system adds to archives and folders.
fn is_ignored(path: &[String]) -> bool {
    let is_of_system = |part: &String| {
        let known = ["__MACOSX", "Thumbs.db", "desktop.ini"];
        part.starts_with('.') || known.contains(&part.as_str())
    };
    path.iter().any(is_of_system)
}

/// Returns a text without control characters and without characters that change the direction of writing.
pub fn without_marks(text: &str) -> String {
    let is_mark = |letter: char| {
        letter.is_control()
            || matches!(letter, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}')
    };
    text.chars().filter(|&letter| !is_mark(letter)).collect()
}

/// Returns the name of a file without folders and without characters that some file system rejects, with at most
/// [`MAX_NAME`] characters.
fn plain_name(path: &str) -> String {
    let path = parts(path);
    let name = path.last().map_or(NAMELESS, String::as_str);
    let name = name.replace([':', '*', '?', '"', '<', '>', '|'], "");
    let name = name.trim_matches(['.', ' ']);
    let (stem, extension) = match name.rsplit_once('.') {
        Some((stem, extension)) if is_extension(extension) => (stem, format!(".{extension}")),
        _ => (name, String::new()),
    };
    let length = MAX_NAME - extension.len();
    let stem: String = stem
        .trim_end_matches(['.', ' '])
        .chars()
        .take(length)
        .collect();
    match stem.is_empty() {
        true => NAMELESS.into(),
        false => stem + &extension,
    }
}

fn is_extension(text: &str) -> bool {
    (1..=5).contains(&text.len()) && text.chars().all(|letter| letter.is_ascii_alphanumeric())
}

/// Returns the id of a level in a file. It has a file extension, so that it differs from the names of built-in levels.
/// A level that was kept, such as `cat.png.toml`, gets its former id.
fn id_of(name: &str) -> String {
    let name = plain_name(name);
    let kept = name.strip_suffix(".toml").unwrap_or_default();
    if BODY_EXTENSIONS.contains(&extension_of(kept).as_str()) {
        return kept.into();
    }
    match name.rsplit_once('.') {
        Some((_, extension)) if is_extension(extension) => name,
        _ => name + ".toml",
    }
}

/// Returns the reason why a file of `found` bytes does not fit into a pack.
pub fn too_long(found: u64) -> String {
    format!(
        "expected at most {MAX_BYTES} bytes in all files of a pack, found a file of {found} bytes, which no longer fits"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::level::NAMED;
    use fuwafuwa_scenes::scene::Scene;

    const CAT: &[u8] = include_bytes!("../levels/cat.png");
    const PUDDING: &[u8] = include_bytes!("../levels/pudding.vox");
    const CAT_LEVEL: &str = NAMED[6].1;

    fn zipped(files: &[(&str, &[u8])]) -> Vec<u8> {
        zip::write(files.iter().copied())
    }

    fn read(files: &[(&str, &[u8])]) -> Pack {
        Pack::read("a.zip", &zipped(files)).unwrap()
    }

    fn ids(pack: &Pack) -> Vec<&str> {
        pack.levels.iter().map(|level| level.id.as_str()).collect()
    }

    /// Returns the names of the refused files, and the reasons.
    fn refused(pack: &Pack) -> Vec<String> {
        let told = |(name, error): &(String, LevelError)| format!("{name}: {error}");
        pack.refused.iter().map(told).collect()
    }

    /// Returns a level with a small body, which is built quickly.
    fn small(name: &str) -> String {
        let (id, text) = NAMED[0];
        let changes = ["body.n=6".to_string(), format!("game.name.en=\"{name}\"")];
        let scene = Scene::read(id, text, &changes).unwrap();
        let level = Level::from_scene(id, scene).unwrap();
        level.text_to_keep().unwrap()
    }

    #[test]
    fn pack_returns_the_levels_that_were_written() {
        let levels: Vec<Level> = ["classic", "cat", "pudding", "hoop"]
            .map(|id| Level::open(id).unwrap())
            .into();
        let texts = levels.iter().map(|level| {
            let id = if level.id == "cat" {
                "drawn cat.png"
            } else {
                &level.id
            };
            (id.to_string(), level.text_to_keep().unwrap())
        });
        let texts: Vec<(String, String)> = texts.collect();
        assert_eq!(fitting(&texts), 4);
        let bytes = Pack::write(&texts);
        assert_eq!(Pack::write(&texts), bytes);
        assert!(Pack::is_in(&bytes));
        let pack = Pack::read("a.zip", &bytes).unwrap();
        assert_eq!(refused(&pack), [""; 0]);
        assert_eq!(
            ids(&pack),
            ["classic.toml", "drawn cat.png", "pudding.toml", "hoop.toml"]
        );
        for (read, written) in pack.levels.iter().zip(&levels) {
            assert_eq!(read.scene(), written.scene(), "{}", read.id);
        }
    }

    #[test]
    fn level_finds_its_picture_beside_it_or_elsewhere() {
        let level = CAT_LEVEL.as_bytes();
        let nested = CAT_LEVEL.replace("\"cat.png\"", "\"../pictures/cat.png\"");
        let scene = Level::open("cat").unwrap().scene().clone();
        for files in [
            &[("level.toml", level), ("cat.png", CAT)][..],
            &[
                ("a/level.toml", level),
                ("a/cat.png", CAT),
                ("cat.png", b"another"),
            ],
            &[
                ("cat.png", b"another"),
                ("a\\level.toml", level),
                ("a\\cat.png", CAT),
            ],
            &[("a/level.toml", level), ("b/c/cat.png", CAT)],
            &[
                ("a/level.toml", nested.as_bytes()),
                ("a/pictures/cat.png", CAT),
                ("cat.png", b"another"),
            ],
        ] {
            let pack = read(files);
            assert_eq!(ids(&pack), ["level.toml"], "{:?}", refused(&pack));
            assert_eq!(pack.levels[0].scene(), &scene);
            // The other picture is none, so it is told.
            assert_eq!(pack.refused.len(), files.len() - 2);
        }
        let alone = read(&[("level.toml", level)]);
        assert_eq!(alone.levels.len(), 0);
        let told = refused(&alone).join("");
        assert!(
            told.contains("level.toml") && told.contains("cat.png"),
            "{told}"
        );
    }

    #[test]
    fn pictures_and_models_become_levels_unless_there_is_a_level() {
        let bodies = [("a/cat.png", CAT), ("pudding.vox", PUDDING)];
        let pack = read(&bodies);
        assert_eq!(
            (ids(&pack), pack.refused.len()),
            (vec!["cat.png", "pudding.vox"], 0)
        );
        let alone = Level::read("cat.png", CAT, &|_| Err(io::ErrorKind::NotFound.into()));
        assert_eq!(pack.levels[0], alone.unwrap());
        let text = small("one");
        let pack = read(&[bodies[0], bodies[1], ("one", text.as_bytes())]);
        assert_eq!((ids(&pack), pack.refused.len()), (vec!["one.toml"], 0));
    }

    #[test]
    fn file_that_is_no_level_is_told_and_hidden_files_are_not() {
        let text = small("one");
        let nested = zipped(&[("one.toml", text.as_bytes())]);
        let scene = text.split("[game]").next().unwrap();
        let pack = read(&[
            ("one.toml", text.as_bytes()),
            ("__MACOSX/._one.toml", b"\x00"),
            ("a/.DS_Store", b"\x00"),
            ("Thumbs.db", b"\x00"),
            ("folder/", b""),
            ("broken.toml", b"dim = 2\n[game]\nname = 3\n"),
            ("a/scene.toml", scene.as_bytes()),
            ("inside.zip", &nested),
            ("empty", b""),
        ]);
        assert_eq!(ids(&pack), ["one.toml"]);
        let told = refused(&pack);
        let expected = [
            ("broken.toml", "line 3"),
            ("scene.toml", "game"),
            ("inside.zip", "a ZIP archive"),
            ("empty", "an empty file"),
        ];
        assert_eq!(told.len(), expected.len(), "{told:?}");
        for (told, (name, reason)) in told.iter().zip(expected) {
            assert!(told.starts_with(name) && told.contains(reason), "{told}");
        }
    }

    #[test]
    fn names_lead_nowhere_and_differ() {
        let text = small("one");
        let names = [
            ("../../x.toml", "x.toml"),
            ("..\\..\\x.toml", "x-2.toml"),
            ("/etc/X.toml", "X-3.toml"),
            ("x.toml", "x-4.toml"),
            ("C:\\a\\c:on.toml", "con.toml"),
            ("a\u{202e}\u{7}b\n.toml", "ab.toml"),
            ("classic", "classic.toml"),
            ("x.broken-1", "x.broken-1.toml"),
            ("cat.PNG.toml", "cat.PNG"),
            ("..", "level.toml"),
            ("?*", "level-2.toml"),
        ];
        let long = "ね".repeat(300) + ".toml";
        let files = names.iter().map(|(name, _)| (*name, text.as_bytes()));
        let files: Vec<_> = files.chain([(long.as_str(), text.as_bytes())]).collect();
        let pack = read(&files);
        assert_eq!(refused(&pack), [""; 0]);
        let expected = names.map(|(_, id)| id.to_string()).into_iter();
        let expected: Vec<String> = expected.chain(["ね".repeat(55) + ".toml"]).collect();
        assert_eq!(ids(&pack), expected);
        assert!(
            pack.levels
                .iter()
                .all(|level| Level::open(&level.id).is_err())
        );
        let texts: Vec<_> = names
            .map(|(name, _)| (name.to_string(), text.clone()))
            .into();
        let written = Pack::read("a.zip", &Pack::write(&texts)).unwrap();
        assert_eq!(written.levels.len(), names.len());
    }

    #[test]
    fn pack_without_levels_is_refused() {
        for (bytes, expected) in [
            (zipped(&[]), "found none"),
            (zipped(&[("a/", b""), (".hidden", b"a")]), "found none"),
            (b"PK\x03\x04".to_vec(), "end is missing"),
            (Vec::new(), "end is missing"),
        ] {
            let told = Pack::read("a.zip", &bytes).unwrap_err().to_string();
            assert!(
                told.starts_with("a.zip: ") && told.contains(expected),
                "{told}"
            );
        }
        let files: Vec<String> = (0..=MAX_FILES)
            .map(|number| format!("{number}.txt"))
            .collect();
        let files: Vec<_> = files.iter().map(|name| (name.as_str(), &b""[..])).collect();
        let told = Pack::read("a.zip", &zipped(&files))
            .unwrap_err()
            .to_string();
        assert_eq!(told, "a.zip: expected at most 1000 files, found more");
    }

    #[test]
    fn levels_beyond_the_limit_are_told() {
        let text = small("one");
        let names: Vec<String> = (0..103).map(|number| format!("{number}.toml")).collect();
        let files: Vec<_> = names
            .iter()
            .map(|name| (name.as_str(), text.as_bytes()))
            .collect();
        let pack = read(&files);
        assert_eq!(pack.levels.len(), MAX_LEVELS);
        let told = "100.toml: 100.toml: expected at most 100 levels in a pack";
        assert_eq!((refused(&pack)[0].as_str(), pack.refused.len()), (told, 3));
        let texts: Vec<_> = names
            .iter()
            .map(|name| (name.clone(), text.clone()))
            .collect();
        assert_eq!(fitting(&texts), MAX_LEVELS);
    }

    #[test]
    fn pack_that_decompresses_to_too_much_is_refused_in_part() {
        let (text, zeros) = (small("one"), vec![0; 1 << 25]);
        let pack = read(&[
            ("a.bin", &zeros),
            ("b.bin", &zeros),
            ("one.toml", text.as_bytes()),
            ("none", b""),
        ]);
        assert_eq!(pack.levels.len(), 0);
        let told = refused(&pack);
        let expected = format!(
            "one.toml: one.toml: expected at most 67108864 bytes in all files of a pack, found a file of {} bytes, \
             which no longer fits",
            text.len()
        );
        assert!(told.contains(&expected) && told.len() == 4, "{told:?}");
    }

    #[test]
    fn picture_counts_for_each_level_that_names_it() {
        // A PNG picture may be followed by other data.
        let picture = [CAT, &vec![0; 1 << 21]].concat();
        let names: Vec<String> = (0..40).map(|number| format!("{number}.toml")).collect();
        let files = names
            .iter()
            .map(|name| (name.as_str(), CAT_LEVEL.as_bytes()));
        let files: Vec<_> = files.chain([("cat.png", picture.as_slice())]).collect();
        let pack = read(&files);
        let told = refused(&pack);
        assert!(
            (1..32).contains(&pack.levels.len()),
            "{} {told:?}",
            pack.levels.len()
        );
        assert!(
            told.last()
                .is_some_and(|told| told.contains("in all files of a pack")),
            "{told:?}"
        );
    }

    #[test]
    fn levels_with_too_many_voxels_together_are_told() {
        let (id, text) = crate::level::NAMED_3D[0];
        let scene = Scene::read(id, text, &["body.n=78".into()]).unwrap();
        let text = toml::to_string(&scene).unwrap();
        let names: Vec<String> = (0..10).map(|number| format!("{number}.toml")).collect();
        let files: Vec<_> = names
            .iter()
            .map(|name| (name.as_str(), text.as_bytes()))
            .collect();
        let pack = read(&files);
        assert_eq!(pack.levels.len(), 8, "{:?}", refused(&pack));
        assert!(refused(&pack)[0].contains("expected at most 2097152 solid voxels"));
    }

    /// Changes a pack in many ways. Files with a wrong checksum are refused, so this tests the reading of the archive.
    #[test]
    fn noise_in_a_pack_causes_no_panic() {
        let mut random = fastrand::Rng::with_seed(5);
        let text = "dim = 2\n[game]\n";
        let seed = zipped(&[
            ("a.toml", text.as_bytes()),
            ("b/c.png", b"no picture"),
            ("d", b"ddddddddddddddddddd"),
        ]);
        let mut accepted = 0;
        for _ in 0..100_000 {
            let mut bytes = seed.clone();
            for _ in 0..random.usize(1..4) {
                if bytes.is_empty() {
                    break;
                }
                let place = random.usize(..bytes.len());
                match random.u32(..6) {
                    0 => bytes[place] = random.u8(..),
                    1 => bytes[place] ^= 1 << random.u32(..8),
                    2 => bytes[place..]
                        .iter_mut()
                        .take(4)
                        .for_each(|byte| *byte = 255),
                    3 => _ = bytes.remove(place),
                    4 => bytes.insert(place, random.u8(..)),
                    _ => bytes.truncate(place),
                }
            }
            accepted += usize::from(Pack::read("a.zip", &bytes).is_ok());
        }
        assert!(accepted > 10_000, "{accepted}");
    }
}
