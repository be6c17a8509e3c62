//! File access, for programs with a file system. The rest of the crate uses no paths and also works in a
//! browser.

use crate::import::{FileType, MAX_FILE_BYTES};
use crate::scene::{MAX_TEXT_BYTES, NAMED, Scene, SceneError};
use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// Number of bytes at the beginning of a file that is too long by which its type is recognised.
const HEAD: usize = 4096;

/// Reads a file of at most `most` bytes. Refuses folders, pipes and devices: reading a pipe can block
/// forever, and some devices are endless.
///
/// # Errors
/// [`ErrorKind::FileTooLarge`] for a longer file, [`ErrorKind::InvalidInput`] for a folder, a pipe or a
/// device, and errors of the system.
pub fn read_bytes(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let bytes = read_beginning(path, most.saturating_add(1))?;
    if bytes.len() as u64 > most {
        return Err(too_long(most));
    }
    Ok(bytes)
}

/// Reads a UTF-8 text file of at most `most` bytes.
///
/// # Errors
/// Same errors as [`read_bytes`], and [`ErrorKind::InvalidData`] if the file is no text in UTF-8. The error names
/// the type of the file.
pub fn read_text(path: &Path, most: u64) -> io::Result<String> {
    let mut bytes = read_beginning(path, most.saturating_add(1))?;
    let is_too_long = bytes.len() as u64 > most;
    if is_too_long {
        // A file of another type is often longer than a text, but its length is not what is wrong with it.
        bytes.truncate(HEAD);
        bytes.truncate(end_of_characters(&bytes));
    }
    let text = text_of(bytes).map_err(|reason| io::Error::new(ErrorKind::InvalidData, reason))?;
    if is_too_long {
        return Err(too_long(most));
    }
    Ok(text)
}

/// Reads at most `most` bytes from the beginning of a file.
fn read_beginning(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    if !path.metadata()?.is_file() {
        let reason = "expected a file, found a folder, a pipe or a device";
        return Err(io::Error::new(ErrorKind::InvalidInput, reason));
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(most).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn too_long(most: u64) -> io::Error {
    let reason = format!("expected at most {most} bytes, found more");
    io::Error::new(ErrorKind::FileTooLarge, reason)
}

/// Returns the end of the last complete character, if the bytes are the beginning of a text in UTF-8.
fn end_of_characters(bytes: &[u8]) -> usize {
    match std::str::from_utf8(bytes) {
        Err(error) if error.error_len().is_none() => error.valid_up_to(),
        _ => bytes.len(),
    }
}

/// Returns the bytes of a file as a text, or the reason why they are none.
fn text_of(bytes: Vec<u8>) -> Result<String, String> {
    let found = FileType::of(&bytes);
    let text = String::from_utf8(bytes)
        .ok()
        .filter(|_| found.is_plain_text());
    text.ok_or_else(|| format!("expected a TOML text in UTF-8, found {found}"))
}

/// Returns a function that reads pictures and models from a folder, for [`Scene::embed_files`].
pub fn reader_in(folder: &Path) -> impl Fn(&str) -> io::Result<Vec<u8>> {
    move |name| read_bytes(&folder.join(name), MAX_FILE_BYTES)
}

/// Opens a built-in scene by name, otherwise a scene file together with the files that it names. `changes`
/// replace values in the scene, as in [`Scene::open`].
///
/// # Errors
/// [`SceneError`] names the file, the line and the field.
pub fn open_scene(place: &str, changes: &[String]) -> Result<Scene, SceneError> {
    let path = Path::new(place);
    // Other errors, for example of a folder without permission, are reported with their reason below.
    let is_missing = matches!(path.metadata(), Err(error) if error.kind() == ErrorKind::NotFound);
    if is_missing || NAMED.iter().any(|(name, _)| *name == place) {
        return Scene::open(place, changes);
    }
    let text = read_text(path, MAX_TEXT_BYTES).map_err(|source| SceneError::File {
        path: place.into(),
        source,
    })?;
    let mut scene = Scene::read(place, &text, changes)?;
    scene.embed_files(&reader_in(path.parent().unwrap_or(Path::new(""))))?;
    Ok(scene)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::Command;

    #[test]
    fn error_of_text_names_type_of_file() {
        let refused = |bytes: &[u8]| text_of(bytes.to_vec()).unwrap_err();
        for (bytes, found) in [
            (&b"\xff\xd8\xff\xe0 photo"[..], "a JPEG picture"),
            (b"<!doctype html><title>404</title>", "a web page"),
            (b"d\0i\0m\0 \0=\0 \x002\0", "a text in UTF-16, not in UTF-8"),
            (
                b"version https://git-lfs.github.com/spec/v1\n",
                "a Git LFS pointer, not the file itself (run git lfs pull)",
            ),
        ] {
            let expected = format!("expected a TOML text in UTF-8, found {found}");
            assert_eq!(refused(bytes), expected);
        }
        assert_eq!(text_of(b"dim = 2".to_vec()).unwrap(), "dim = 2");
    }

    #[test]
    fn text_over_limit_is_refused_with_this_limit() {
        let name = format!("fuwafuwa-long-text-{}", std::process::id());
        let path = std::env::temp_dir().join(name);
        // The limit of 4096 bytes for the type lies within a character of three bytes.
        let text = "# ".to_owned() + &"ね".repeat(2000);
        std::fs::write(&path, &text).unwrap();
        assert_eq!(read_text(&path, 6002).unwrap(), text);
        for most in [0, 3, 6001] {
            let error = read_text(&path, most).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::FileTooLarge);
            let expected = format!("expected at most {most} bytes, found more");
            assert_eq!(error.to_string(), expected);
        }
        std::fs::write(&path, [&b"\xff\xd8\xff\xe0"[..], &[7; 6000]].concat()).unwrap();
        let error = read_text(&path, 100).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidData);
        assert!(error.to_string().contains("a JPEG picture"), "{error}");
        std::fs::remove_file(path).unwrap();
    }

    #[test]
    fn scene_that_cannot_be_opened_is_not_called_missing() {
        let folder = std::env::temp_dir();
        let error = open_scene(&folder.display().to_string(), &[]).unwrap_err();
        assert!(error.to_string().contains("found a folder"), "{error}");
        let long = "n".repeat(300);
        let error = open_scene(&long, &[]).unwrap_err();
        assert!(matches!(error, SceneError::File { .. }), "{error}");
        let error = open_scene("no-such-scene", &[]).unwrap_err();
        assert!(matches!(error, SceneError::Unknown { .. }), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn read_bytes_rejects_pipes_devices_and_folders_without_blocking() {
        let pipe = std::env::temp_dir().join(format!("fuwafuwa-pipe-{}", std::process::id()));
        assert!(
            Command::new("mkfifo")
                .arg(&pipe)
                .status()
                .unwrap()
                .success()
        );
        for path in [&pipe, Path::new("/dev/zero"), Path::new("/dev")] {
            let error = read_bytes(path, 10).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::InvalidInput, "{path:?}");
            assert!(error.to_string().contains("a pipe or a device"));
        }
        std::fs::remove_file(pipe).unwrap();
    }
}
