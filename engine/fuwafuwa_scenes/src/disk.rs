//! Files, for programs that have a disk. Nothing else here knows of paths, and a browser does without this.

use crate::import::MAX_FILE_BYTES;
use crate::scene::{MAX_TEXT_BYTES, NAMED, Scene, SceneError};
use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// The bytes of a file, refused when there are more than `most` ([`ErrorKind::FileTooLarge`]), and when it is a folder, a
/// pipe or a device ([`ErrorKind::InvalidInput`]): who reads a pipe may wait for ever, and some devices have no end.
///
/// # Errors
/// These two, and what the system says.
pub fn bytes_of(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    if !path.metadata()?.is_file() {
        let reason = "expected a file, found a folder, a pipe or a device";
        return Err(io::Error::new(ErrorKind::InvalidInput, reason));
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        let reason = format!("longer than {most} bytes, the most that are read");
        return Err(io::Error::new(ErrorKind::FileTooLarge, reason));
    }
    Ok(bytes)
}

/// The text of a file, refused as [`bytes_of`] does.
///
/// # Errors
/// As [`bytes_of`], and when it is no UTF-8 ([`ErrorKind::InvalidData`]).
pub fn text_of(path: &Path, most: u64) -> io::Result<String> {
    let text = String::from_utf8(bytes_of(path, most)?);
    text.map_err(|_| io::Error::new(ErrorKind::InvalidData, "expected a text in UTF-8"))
}

/// Hands out the pictures and models that lie in a folder, for [`Scene::embed_files`].
pub fn beside(folder: &Path) -> impl Fn(&str) -> io::Result<Vec<u8>> {
    move |name| bytes_of(&folder.join(name), MAX_FILE_BYTES)
}

/// The scene of a name, as [`Scene::open`], or in a file, with the files that it names.
///
/// # Errors
/// [`SceneError`] says what is wrong and where.
pub fn scene_at(place: &str, changes: &[String]) -> Result<Scene, SceneError> {
    let path = Path::new(place);
    if NAMED.iter().any(|(name, _)| *name == place) || !path.exists() {
        return Scene::open(place, changes);
    }
    let text = text_of(path, MAX_TEXT_BYTES).map_err(|source| SceneError::File {
        path: place.into(),
        source,
    })?;
    let mut scene = Scene::read(place, &text, changes)?;
    scene.embed_files(&beside(path.parent().unwrap_or(Path::new(""))))?;
    Ok(scene)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::Command;

    #[cfg(unix)]
    #[test]
    fn pipes_and_devices_are_refused_and_not_waited_for() {
        let pipe = std::env::temp_dir().join(format!("fuwafuwa-pipe-{}", std::process::id()));
        assert!(
            Command::new("mkfifo")
                .arg(&pipe)
                .status()
                .unwrap()
                .success()
        );
        for path in [&pipe, Path::new("/dev/zero"), Path::new("/dev")] {
            let error = bytes_of(path, 10).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::InvalidInput, "{path:?}");
            assert!(error.to_string().contains("a pipe or a device"));
        }
        std::fs::remove_file(pipe).unwrap();
    }
}
