//! Sequential access to the bytes of a file, decompressed on demand.

use flate2::bufread::MultiGzDecoder;
use fuwafuwa_scenes::import::{FilePosition, PositionedProblem, too_large, unexpected};
use std::io::Read;

/// Maximum size of a file and of its decompressed content, in bytes. Large enough for [`crate::MAX_VOXELS`]
/// 64-bit numbers and the bytes before them.
pub const MAX_FILE_BYTES: u64 = (1 << 30) + (1 << 26);

/// Maximum expansion by deflate: number of decompressed bytes per compressed byte.
const MOST_INFLATED: u64 = 1032;

/// First two bytes of a gzip file.
const GZIP: [u8; 2] = [0x1f, 0x8b];

/// Maximum number of bytes after the last voxel. Some files end with padding, but longer data is treated as
/// an attack.
const MAX_TRAILING: u64 = 1 << 20;

/// Bytes of a file, read from front to back.
pub struct Stream<'a> {
    source: Source<'a>,
    /// Number of decompressed bytes read so far.
    at: u64,
    /// Maximum number of bytes that the file can contain after decompression.
    most: u64,
}

enum Source<'a> {
    Plain(&'a [u8]),
    Zipped(Box<MultiGzDecoder<&'a [u8]>>),
}

impl<'a> Stream<'a> {
    pub fn of(bytes: &'a [u8]) -> Result<Self, PositionedProblem> {
        let length = bytes.len() as u64;
        if length > MAX_FILE_BYTES {
            return Err(too_large(
                FilePosition::File,
                "bytes",
                length,
                MAX_FILE_BYTES,
            ));
        }
        let is_zipped = bytes.starts_with(&GZIP);
        let (source, most) = match is_zipped {
            true => (
                Source::Zipped(Box::new(MultiGzDecoder::new(bytes))),
                length * MOST_INFLATED,
            ),
            false => (Source::Plain(bytes), length),
        };
        let at = 0;
        Ok(Self { source, at, most })
    }

    /// Checks that the file can contain `expected` bytes.
    pub fn check(&self, expected: u64) -> Result<(), PositionedProblem> {
        let missing = || {
            let found = format!("at most {}", self.most);
            unexpected(FilePosition::File, bytes(expected), found)
        };
        (expected <= self.most).then_some(()).ok_or_else(missing)
    }

    /// Reads until the buffer is full or the file ends, and returns the number of bytes read.
    pub fn fill(&mut self, buffer: &mut [u8]) -> Result<usize, PositionedProblem> {
        let mut filled = 0;
        while filled < buffer.len() {
            let rest = &mut buffer[filled..];
            let read = match &mut self.source {
                Source::Plain(bytes) => bytes.read(rest),
                Source::Zipped(decoder) => decoder.read(rest),
            };
            let at = FilePosition::Byte((self.at + filled as u64) as usize);
            match read.map_err(|error| unexpected(at, "valid gzip data", error))? {
                0 => break,
                count => filled += count,
            }
        }
        self.at += filled as u64;
        Ok(filled)
    }

    /// Reads until the buffer is full. If the file ends before, the error names `expected`, the length of the
    /// file up to the last voxel.
    pub fn fill_all(&mut self, buffer: &mut [u8], expected: u64) -> Result<(), PositionedProblem> {
        let filled = self.fill(buffer)?;
        let missing = || {
            unexpected(
                FilePosition::Byte(self.at as usize),
                bytes(expected),
                self.at,
            )
        };
        (filled == buffer.len()).then_some(()).ok_or_else(missing)
    }

    /// Reads the remaining bytes, at most `MAX_TRAILING`. At the end of its data, a gzip stream verifies
    /// its checksum.
    pub fn finish(mut self) -> Result<(), PositionedProblem> {
        let mut buffer = [0; 1 << 12];
        let mut trailing = 0;
        loop {
            let filled = self.fill(&mut buffer)?;
            trailing += filled as u64;
            if trailing > MAX_TRAILING {
                let what = "bytes behind the last voxel";
                return Err(too_large(FilePosition::File, what, trailing, MAX_TRAILING));
            }
            if filled < buffer.len() {
                return Ok(());
            }
        }
    }
}

fn bytes(expected: u64) -> String {
    format!("{expected} bytes up to the last voxel")
}
