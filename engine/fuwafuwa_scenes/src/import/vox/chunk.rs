//! Chunks of a file and their contents.

use super::MAX_VOXELS_ACROSS;
use super::palette::{self, Palette};
use crate::import::error::{FilePosition, PositionedProblem, too_large, unexpected};

/// Unread part of a file; `at` is its offset in the file.
#[derive(Clone, Copy)]
pub(super) struct Bytes<'a> {
    pub bytes: &'a [u8],
    pub at: usize,
}

pub(super) struct Chunk<'a> {
    pub name: [u8; 4],
    pub place: FilePosition,
    pub contents: Bytes<'a>,
    pub children: Bytes<'a>,
}

/// Keys and values that describe a node, a frame or a layer.
pub(super) struct Attributes<'a>(Vec<(&'a [u8], &'a [u8])>);

impl<'a> Bytes<'a> {
    /// Takes the next `count` bytes; `what` names their content in errors.
    fn take(&mut self, count: usize, what: &str) -> Result<Self, PositionedProblem> {
        let Some((taken, rest)) = self.bytes.split_at_checked(count) else {
            let expected = format!("{count} bytes for {what}");
            let found = self.bytes.len().to_string();
            return Err(unexpected(FilePosition::Byte(self.at), expected, found));
        };
        let at = self.at;
        *self = Self {
            bytes: rest,
            at: at + count,
        };
        Ok(Self { bytes: taken, at })
    }

    pub fn word(&mut self, what: &str) -> Result<[u8; 4], PositionedProblem> {
        let word = self.take(4, what)?.bytes;
        Ok(word.try_into().expect("four bytes were taken"))
    }

    pub fn number(&mut self, what: &str) -> Result<u32, PositionedProblem> {
        self.word(what).map(u32::from_le_bytes)
    }

    /// Takes a signed number, such as the id of a node.
    pub fn id(&mut self, what: &str) -> Result<i32, PositionedProblem> {
        self.word(what).map(i32::from_le_bytes)
    }

    /// Takes a list: its length, then one entry after the other.
    pub fn list<T>(
        &mut self,
        what: &str,
        mut entry: impl FnMut(&mut Self) -> Result<T, PositionedProblem>,
    ) -> Result<Vec<T>, PositionedProblem> {
        let count = self.number(&format!("the number of {what}"))?;
        // No capacity is reserved: the count may be larger than the file.
        (0..count).map(|_| entry(self)).collect()
    }

    pub fn attributes(&mut self) -> Result<Attributes<'a>, PositionedProblem> {
        let pairs = self.list("attributes", |bytes| Ok((bytes.text()?, bytes.text()?)));
        pairs.map(Attributes)
    }

    fn text(&mut self) -> Result<&'a [u8], PositionedProblem> {
        let length = self.number("the length of a text")?;
        Ok(self.take(length as usize, "a text")?.bytes)
    }

    pub fn chunk(&mut self) -> Result<Chunk<'a>, PositionedProblem> {
        let at = self.at;
        let name = self.word("the name of a chunk")?;
        let length = self.number("the length of a chunk")?;
        let length_of_children = self.number("the length of the children of a chunk")?;
        let title = name.escape_ascii();
        Ok(Chunk {
            name,
            place: FilePosition::Chunk(name, at),
            contents: self.take(length as usize, &format!("the chunk {title}"))?,
            children: self.take(
                length_of_children as usize,
                &format!("the children of the chunk {title}"),
            )?,
        })
    }
}

impl<'a> Attributes<'a> {
    pub fn get(&self, key: &str) -> Option<&'a [u8]> {
        let mut pairs = self.0.iter();
        let pair = pairs.find(|(name, _)| *name == key.as_bytes());
        pair.map(|(_, value)| *value)
    }

    pub fn is_hidden(&self) -> bool {
        self.get("_hidden") == Some(b"1")
    }
}

impl Chunk<'_> {
    /// Checks that the contents have `expected` bytes; `what` names them in errors.
    fn check_length(&self, expected: u64, what: &str) -> Result<(), PositionedProblem> {
        let found = self.contents.bytes.len() as u64;
        let expected_text = format!("{expected} bytes for {what}");
        let wrong = unexpected(self.place, expected_text, found.to_string());
        (found == expected).then_some(()).ok_or(wrong)
    }

    /// Returns the size of a model on the axes of the file. A model without voxels may have a size of 0.
    pub fn size(&self) -> Result<[u32; 3], PositionedProblem> {
        self.check_length(12, "a size on three axes")?;
        let mut contents = self.contents;
        let mut size = [0; 3];
        for extent in &mut size {
            *extent = contents.number("a size")?;
        }
        match size.into_iter().find(|&extent| extent > MAX_VOXELS_ACROSS) {
            Some(found) => {
                let (found, limit) = (found.into(), MAX_VOXELS_ACROSS.into());
                Err(too_large(self.place, "voxels on an axis", found, limit))
            }
            None => Ok(size),
        }
    }

    /// Returns the solid voxels of a model of `size`, with their positions on the axes of the file and their
    /// palette indices. If the file lists a voxel twice, the later entry counts. An entry with index 0 is an
    /// empty voxel. `is_known` has a bit for each position, all false before and after the call.
    pub fn voxels(
        &self,
        size: [u32; 3],
        is_known: &mut [bool],
    ) -> Result<Vec<[u8; 4]>, PositionedProblem> {
        let mut contents = self.contents;
        let count = contents.number("the number of voxels")?;
        self.check_length(4 + 4 * u64::from(count), &format!("{count} voxels"))?;
        let (entries, _) = contents.bytes.as_chunks::<4>();
        for (number, &[x, y, z, _]) in entries.iter().enumerate() {
            let voxel = [x, y, z].map(u32::from);
            if (0..3).any(|axis| voxel[axis] >= size[axis]) {
                let place = FilePosition::Byte(contents.at + 4 * number);
                let [width, depth, height] = size;
                let expected = format!("a voxel in the box of {width} x {depth} x {height}");
                return Err(unexpected(place, expected, format!("({x}, {y}, {z})")));
            }
        }
        let mut voxels = Vec::new();
        for &[x, y, z, index] in entries.iter().rev() {
            let is_listed_later = std::mem::replace(&mut is_known[place_of([x, y, z])], true);
            if !is_listed_later && index != 0 {
                voxels.push([x, y, z, index]);
            }
        }
        for &[x, y, z, _] in entries {
            is_known[place_of([x, y, z])] = false;
        }
        Ok(voxels)
    }

    /// Returns the palette. A file may list only its first colours: the others are those of MagicaVoxel's
    /// default palette.
    pub fn palette(&self) -> Result<Palette, PositionedProblem> {
        let (colours, rest) = self.contents.bytes.as_chunks::<4>();
        let mut palette = palette::DEFAULT;
        if !rest.is_empty() || colours.len() > palette.len() {
            let expected = "4 bytes for each of at most 256 colours";
            let found = format!("{} bytes", self.contents.bytes.len());
            return Err(unexpected(self.place, expected, found));
        }
        for (entry, &[red, green, blue, _]) in palette.iter_mut().zip(colours) {
            *entry = [red, green, blue];
        }
        Ok(palette)
    }
}

/// Number of positions that a voxel of a file can have.
pub(super) const POSITIONS: usize = 1 << 24;

fn place_of([x, y, z]: [u8; 3]) -> usize {
    u32::from_be_bytes([0, z, y, x]) as usize
}
