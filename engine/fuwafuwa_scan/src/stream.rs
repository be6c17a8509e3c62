//! Sequential access to the bytes of a file, decompressed on demand.

use flate2::bufread::GzDecoder;
use fuwafuwa_scenes::import::{FilePosition, PositionedProblem, too_large, unexpected};
use std::io::{self, Read};

/// Maximum size of a file and of its decompressed content, in bytes. Large enough for [`crate::MAX_VOXELS`]
/// 64-bit numbers and the bytes before them.
pub const MAX_FILE_BYTES: u64 = (1 << 30) + (1 << 26);

/// Maximum expansion by deflate: number of decompressed bytes per compressed byte.
const MOST_INFLATED: u64 = 1032;

/// First bytes of a gzip member: its signature, and deflate as its only method.
const GZIP: [u8; 3] = [0x1f, 0x8b, 8];

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
    Zipped(Members<'a>),
}

/// Members of a gzip file, which are decompressed one after the other. Zeros between and after members are
/// padding, as for `gunzip`.
struct Members<'a> {
    /// Decoder of the current member; `None` after the last member.
    decoder: Option<Box<GzDecoder<&'a [u8]>>>,
    /// Number of bytes after the last member, from the first byte on that is not zero.
    ignored: usize,
}

impl<'a> Members<'a> {
    fn of(bytes: &'a [u8]) -> Self {
        Self {
            decoder: Some(Box::new(GzDecoder::new(bytes))),
            ignored: 0,
        }
    }

    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        while let Some(mut decoder) = self.decoder.take() {
            let count = decoder.read(buffer)?;
            if count > 0 {
                self.decoder = Some(decoder);
                return Ok(count);
            }
            self.go_on(decoder.into_inner());
        }
        Ok(0)
    }

    /// Starts the next member, if `rest`, the bytes after the last one, contains a member.
    fn go_on(&mut self, rest: &'a [u8]) {
        let padding = rest.iter().take_while(|&&byte| byte == 0).count();
        let rest = &rest[padding..];
        match rest.starts_with(&GZIP) {
            true => *self = Self::of(rest),
            false => self.ignored = rest.len(),
        }
    }
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
            true => (Source::Zipped(Members::of(bytes)), length * MOST_INFLATED),
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
                Source::Zipped(members) => members.read(rest),
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
    /// its checksum. Returns the number of bytes after the gzip data that are not padding.
    pub fn finish(mut self) -> Result<usize, PositionedProblem> {
        let mut buffer = [0; 1 << 12];
        let mut trailing = 0;
        loop {
            let filled = self.fill(&mut buffer)?;
            trailing += filled as u64;
            if trailing > MAX_TRAILING {
                let what = "bytes after the last voxel";
                return Err(too_large(FilePosition::File, what, trailing, MAX_TRAILING));
            }
            if filled < buffer.len() {
                return Ok(match self.source {
                    Source::Zipped(members) => members.ignored,
                    Source::Plain(_) => 0,
                });
            }
        }
    }
}

fn bytes(expected: u64) -> String {
    format!("{expected} bytes up to the last voxel")
}
