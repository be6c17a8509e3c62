//! ZIP archives: the parts of the format that packs need, which are stored and deflated files below 4 GiB.
//!
//! The crate `zip` would bring five more crates, and its random numbers do not build for a browser without further
//! settings.

use miniz_oxide::inflate::{TINFLStatus, decompress_to_vec_with_limit};
use miniz_oxide::{deflate, inflate};

/// Signature of a file, of an entry of the directory, and of the end of the directory.
const FILE: [u8; 4] = *b"PK\x03\x04";
const ENTRY: [u8; 4] = *b"PK\x01\x02";
const END: [u8; 4] = *b"PK\x05\x06";
/// Length of the fixed part of each of them [bytes].
const FILE_BYTES: usize = 30;
const ENTRY_BYTES: usize = 46;
const END_BYTES: usize = 22;

const STORED: u16 = 0;
const DEFLATED: u16 = 8;
/// Flag of an encrypted file.
const ENCRYPTED: u16 = 1;
/// Flag of a name in UTF-8.
const UTF8: u16 = 1 << 11;
/// Version of the format in which files can be deflated.
const VERSION: u16 = 20;
/// 1980-01-01, the first date of the format. All archives have this date, so that equal content gives equal archives.
const DATE: u16 = 1 << 5 | 1;
/// Compression level of deflate, 0 to 10.
const EFFORT: u8 = 9;

/// Entry of the directory of an archive.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    /// Path of the file in the archive, as written there.
    pub(super) path: String,
    flags: u16,
    method: u16,
    checksum: u32,
    /// Length in the archive [bytes].
    packed: usize,
    /// Length of the file [bytes].
    length: usize,
    /// Place of the file in the archive.
    place: usize,
}

/// Returns whether bytes begin as an archive does.
pub(super) fn is_archive(bytes: &[u8]) -> bool {
    bytes.starts_with(&FILE) || bytes.starts_with(&END)
}

/// Reads the directory of an archive. An error is the reason, as text for the player.
pub(super) fn entries(bytes: &[u8]) -> Result<Vec<Entry>, String> {
    let end =
        end_of(bytes).ok_or("expected a whole ZIP archive, found one whose end is missing")?;
    let field = |at| u16_at(end, at).unwrap_or_default();
    let (count, is_split) = (
        field(10),
        field(4) != 0 || field(6) != 0 || field(8) != field(10),
    );
    let [size, place] = [12, 16].map(|at| u32_at(end, at).unwrap_or_default());
    if is_split {
        return Err("expected a ZIP archive in one file, found a part of one".into());
    }
    if count == u16::MAX || size == u32::MAX || place == u32::MAX {
        return Err("expected a ZIP archive below 4 GiB, found a larger one (ZIP64)".into());
    }
    let directory = part(bytes, place as usize, size as usize);
    let mut rest = directory.ok_or_else(damaged)?;
    let mut entries = Vec::new();
    for _ in 0..count {
        let (entry, after) = Entry::first_of(rest).ok_or_else(damaged)?;
        entries.push(entry);
        rest = after;
    }
    Ok(entries)
}

/// Returns the bytes from the end record of the directory to the end of the archive.
fn end_of(bytes: &[u8]) -> Option<&[u8]> {
    // Only a comment of at most 65535 bytes follows.
    let first = bytes
        .len()
        .saturating_sub(END_BYTES + usize::from(u16::MAX));
    let places = (first..=bytes.len().checked_sub(END_BYTES)?).rev();
    let mut ends = places.map(|place| &bytes[place..]);
    ends.find(|end| {
        let comment = u16_at(end, 20).map(usize::from);
        end.starts_with(&END) && comment == Some(end.len() - END_BYTES)
    })
}

impl Entry {
    /// Reads the entry at the beginning of `bytes`. Returns the bytes behind it, too.
    fn first_of(bytes: &[u8]) -> Option<(Self, &[u8])> {
        let [path, extra, comment] = [u16_at(bytes, 28)?, u16_at(bytes, 30)?, u16_at(bytes, 32)?];
        let [path, extra, comment] = [path, extra, comment].map(usize::from);
        let name = part(bytes, ENTRY_BYTES, path)?;
        let entry = Self {
            path: String::from_utf8_lossy(name).into_owned(),
            flags: u16_at(bytes, 8)?,
            method: u16_at(bytes, 10)?,
            checksum: u32_at(bytes, 16)?,
            packed: u32_at(bytes, 20)? as usize,
            length: u32_at(bytes, 24)? as usize,
            place: u32_at(bytes, 42)? as usize,
        };
        let rest = bytes.get(ENTRY_BYTES + path + extra + comment..)?;
        bytes.starts_with(&ENTRY).then_some((entry, rest))
    }

    /// Returns the length of the file that the archive states [bytes].
    pub(super) fn length(&self) -> usize {
        self.length
    }

    /// Returns the content of the file. An error is the reason, as text for the player. Allocates at most about twice
    /// the stated length.
    pub(super) fn content(&self, archive: &[u8]) -> Result<Vec<u8>, String> {
        if self.flags & ENCRYPTED != 0 {
            return Err("expected a file without a password, found an encrypted file".into());
        }
        let packed = self.packed_in(archive).ok_or_else(damaged)?;
        let content = match self.method {
            STORED if packed.len() == self.length => packed.to_vec(),
            STORED => return Err(damaged()),
            DEFLATED => inflated(packed, self.length)?,
            other => {
                let name = method_name(other);
                return Err(format!(
                    "expected a stored or deflated file, found compression method {other}{name}"
                ));
            }
        };
        let is_whole = content.len() == self.length && checksum(&content) == self.checksum;
        is_whole.then_some(content).ok_or_else(damaged)
    }

    /// Returns the compressed content of the file.
    fn packed_in<'a>(&self, archive: &'a [u8]) -> Option<&'a [u8]> {
        let header = part(archive, self.place, FILE_BYTES)?;
        let [path, extra] = [u16_at(header, 26)?, u16_at(header, 28)?].map(usize::from);
        let place = self.place.checked_add(FILE_BYTES + path + extra)?;
        header.starts_with(&FILE).then_some(())?;
        part(archive, place, self.packed)
    }
}

/// Decompresses a file of `length` bytes. Stops as soon as it is longer.
fn inflated(packed: &[u8], length: usize) -> Result<Vec<u8>, String> {
    // With a limit of 0, the decompressor does not read the end of the stream.
    let inflated = decompress_to_vec_with_limit(packed, length.max(1));
    inflated.map_err(|error: inflate::DecompressError| match error.status {
        TINFLStatus::HasMoreOutput => {
            format!("expected {length} bytes, as the archive states, found more")
        }
        _ => damaged(),
    })
}

/// Writes an archive of files, each with its path and its content.
pub(super) fn write<'a>(files: impl IntoIterator<Item = (&'a str, &'a [u8])>) -> Vec<u8> {
    let (mut archive, mut directory, mut count) = (Vec::new(), Vec::new(), 0);
    for (path, content) in files {
        let deflated = deflate::compress_to_vec(content, EFFORT);
        let is_shorter = deflated.len() < content.len();
        let (method, packed) = match is_shorter {
            true => (DEFLATED, deflated.as_slice()),
            false => (STORED, content),
        };
        // The fields that the header of a file and its entry in the directory share.
        let mut common = Vec::new();
        for field in [VERSION, UTF8, method, 0, DATE] {
            common.extend(field.to_le_bytes());
        }
        for field in [checksum(content), size(packed.len()), size(content.len())] {
            common.extend(field.to_le_bytes());
        }
        common.extend(short(path.len()).to_le_bytes());
        common.extend([0; 2]);
        directory.extend(ENTRY);
        directory.extend(VERSION.to_le_bytes());
        directory.extend(&common);
        directory.extend([0; 10]);
        directory.extend(size(archive.len()).to_le_bytes());
        directory.extend(path.as_bytes());
        archive.extend(FILE);
        archive.extend(&common);
        archive.extend(path.as_bytes());
        archive.extend(packed);
        count += 1;
    }
    let place = size(archive.len());
    archive.extend(&directory);
    archive.extend(END);
    archive.extend([0; 4]);
    archive.extend([short(count).to_le_bytes(); 2].as_flattened());
    archive.extend(
        [size(directory.len()), place]
            .map(u32::to_le_bytes)
            .as_flattened(),
    );
    archive.extend([0; 2]);
    archive
}

fn checksum(content: &[u8]) -> u32 {
    crc32fast::hash(content)
}

/// Returns a length as a field of the archive. The limits of packs keep every length below the maximum.
fn size(length: usize) -> u32 {
    u32::try_from(length).unwrap_or(u32::MAX)
}

fn short(length: usize) -> u16 {
    u16::try_from(length).unwrap_or(u16::MAX)
}

/// Returns the name of a usual compression method, in brackets after its number.
fn method_name(method: u16) -> &'static str {
    match method {
        9 => " (Deflate64)",
        12 => " (bzip2)",
        14 => " (LZMA)",
        93 => " (Zstandard)",
        95 => " (XZ)",
        99 => " (AES)",
        _ => "",
    }
}

fn damaged() -> String {
    "expected an intact file in the ZIP archive, found a damaged one".into()
}

fn part(bytes: &[u8], place: usize, length: usize) -> Option<&[u8]> {
    bytes.get(place..place.checked_add(length)?)
}

fn u16_at(bytes: &[u8], place: usize) -> Option<u16> {
    let field = part(bytes, place, 2)?.try_into().ok()?;
    Some(u16::from_le_bytes(field))
}

fn u32_at(bytes: &[u8], place: usize) -> Option<u32> {
    let field = part(bytes, place, 4)?.try_into().ok()?;
    Some(u32::from_le_bytes(field))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Archive made by Info-ZIP, with extra fields: a deflated file, a folder, and a stored file in the folder.
    const BY_OTHERS: &[u8] = include_bytes!("by-others.zip");

    fn one(content: &[u8]) -> Vec<u8> {
        write([("a.txt", content)])
    }

    /// Returns the content of the first file of an archive, or the reason why it has none.
    fn first(archive: &[u8]) -> Result<Vec<u8>, String> {
        let entries = entries(archive)?;
        entries.first().ok_or("empty")?.content(archive)
    }

    /// Returns the archive with `bytes` in place of those at `place` of its directory entry.
    fn changed(mut archive: Vec<u8>, place: usize, bytes: &[u8]) -> Vec<u8> {
        let entry = archive.windows(4).position(|four| four == ENTRY).unwrap();
        archive[entry + place..][..bytes.len()].copy_from_slice(bytes);
        archive
    }

    #[test]
    fn archive_returns_what_was_written() {
        let long = "so long ".repeat(1000);
        let files = [
            ("a.txt", &b""[..]),
            ("b/ね.txt", b"b"),
            ("c", long.as_bytes()),
        ];
        let archive = write(files);
        assert!(is_archive(&archive) && archive.len() < 1000);
        let read = entries(&archive).unwrap();
        assert_eq!(read.len(), files.len());
        for (entry, (path, content)) in read.iter().zip(files) {
            assert_eq!((entry.path.as_str(), entry.length()), (path, content.len()));
            assert_eq!(entry.content(&archive).unwrap(), content, "{path}");
        }
        assert_eq!(
            write(files),
            archive,
            "no date and no random number is in it"
        );
        let none = write([]);
        assert!(is_archive(&none) && entries(&none).unwrap().is_empty());
    }

    #[test]
    fn archive_of_another_program_is_read() {
        let read = entries(BY_OTHERS).unwrap();
        let paths: Vec<&str> = read.iter().map(|entry| entry.path.as_str()).collect();
        assert_eq!(paths, ["a.txt", "b/", "b/c.txt"]);
        let content = |index: usize| read[index].content(BY_OTHERS).unwrap();
        assert_eq!(content(0), b"hello hello hello hello");
        assert_eq!((content(1), content(2)), (Vec::new(), b"c".to_vec()));
        // A comment may follow, also one that contains the signature of the end.
        let mut commented = BY_OTHERS.to_vec();
        let at = commented.len() - 2;
        commented.truncate(at);
        commented.extend([6, 0]);
        commented.extend(*b"PK\x05\x06..");
        assert_eq!(entries(&commented).unwrap().len(), 3);
    }

    #[test]
    fn damaged_archive_is_refused_with_its_reason() {
        let archive = one(&b"hello ".repeat(50));
        for length in 0..archive.len() {
            let told = first(&archive[..length]).unwrap_err();
            assert!(told.contains("end is missing"), "{length}: {told}");
        }
        let with = |place, bytes: &[u8]| first(&changed(archive.clone(), place, bytes));
        for (place, bytes, expected) in [
            (8, &[1, 0][..], "encrypted"),
            (10, &[12, 0], "found compression method 12 (bzip2)"),
            (10, &[77, 0], "found compression method 77"),
            (10, &[0, 0], "damaged"),
            (16, &[0; 4], "damaged"),
            (20, &[255; 4], "damaged"),
            (20, &[3, 0], "damaged"),
            (
                24,
                &[200, 0],
                "expected 200 bytes, as the archive states, found more",
            ),
            (24, &[0; 4], "found more"),
            (24, &[0, 2], "damaged"),
            (28, &[255; 2], "damaged"),
            (42, &[9], "damaged"),
            (42, &[255; 4], "damaged"),
            (0, b"KP", "damaged"),
        ] {
            let told = with(place, bytes).unwrap_err();
            assert!(told.contains(expected), "{place}: {told}");
        }
        let end = archive.len() - END_BYTES;
        for (place, bytes, expected) in [
            (8, &[2, 0, 2, 0][..], "damaged"),
            (8, &[2, 0], "a part of one"),
            (12, &[255; 4], "ZIP64"),
            (16, &[254; 4], "damaged"),
        ] {
            let mut archive = archive.clone();
            archive[end + place..][..bytes.len()].copy_from_slice(bytes);
            let told = first(&archive).unwrap_err();
            assert!(told.contains(expected), "{place}: {told}");
        }
    }

    #[test]
    fn bomb_is_not_decompressed_beyond_its_stated_length() {
        let archive = one(&vec![0; 1 << 26]);
        assert!(archive.len() < 1 << 17);
        let told = first(&changed(archive, 24, &1000_u32.to_le_bytes())).unwrap_err();
        assert_eq!(
            told,
            "expected 1000 bytes, as the archive states, found more"
        );
    }
}
