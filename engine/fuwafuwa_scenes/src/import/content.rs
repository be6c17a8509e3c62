//! Type of a file, recognised by its content. A name can have a wrong ending or none.

use std::fmt;

/// Type of a file, recognised by its first bytes. [`fmt::Display`] writes it in plain words with an article,
/// for example "a JPEG picture".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FileType {
    /// File without a byte.
    Empty,
    /// PNG picture.
    Png,
    /// JPEG picture.
    Jpeg,
    /// WebP picture.
    WebP,
    /// GIF picture.
    Gif,
    /// BMP picture.
    Bmp,
    /// TIFF picture.
    Tiff,
    /// HEIF picture, as phones take them.
    Heif,
    /// AVIF picture.
    Avif,
    /// JPEG XL picture.
    JpegXl,
    /// Photoshop document.
    Photoshop,
    /// SVG drawing.
    Svg,
    /// MagicaVoxel model.
    Vox,
    /// Wavefront OBJ mesh.
    Obj,
    /// glTF mesh as a JSON text.
    Gltf,
    /// glTF mesh in one binary file.
    Glb,
    /// STL mesh, as a text or binary.
    Stl,
    /// PLY mesh.
    Ply,
    /// FBX mesh.
    Fbx,
    /// Blender document.
    Blender,
    /// ZIP archive.
    Zip,
    /// File compressed by gzip.
    Gzip,
    /// Archive or compressed file of another kind.
    Archive,
    /// PDF document.
    Pdf,
    /// Web page.
    Html,
    /// XML text that is no drawing and no web page.
    Xml,
    /// Text that Git LFS stores in place of a large file.
    GitLfsPointer,
    /// NIfTI-1 scan.
    Nifti1,
    /// NIfTI-2 scan.
    Nifti2,
    /// Analyze 7.5 header of a scan.
    Analyze,
    /// FreeSurfer scan. A `.mgz` file is such a scan in gzip.
    Mgh,
    /// NRRD scan.
    Nrrd,
    /// DICOM slice or scan.
    Dicom,
    /// Film or another file of the MP4 family.
    Video,
    /// TOML text.
    Toml,
    /// JSON text.
    Json,
    /// Another text in UTF-8.
    Text,
    /// Text in UTF-16.
    Utf16,
    /// Text in an encoding that is neither UTF-8 nor UTF-16.
    OtherText,
    /// Unknown content.
    Unknown,
}

use FileType::*;

/// Bytes at the beginning of a text that decide its type.
const HEAD: usize = 4096;

/// Byte offset, bytes there, and the type that they stand for.
const SIGNATURES: [(usize, &[u8], FileType); 37] = [
    (0, b"\x89PNG", Png),
    (0, b"\xff\xd8\xff", Jpeg),
    (8, b"WEBP", WebP),
    (0, b"GIF8", Gif),
    (0, b"II*\0", Tiff),
    (0, b"MM\0*", Tiff),
    (0, b"II+\0", Tiff),
    (0, b"MM\0+", Tiff),
    (0, b"\xff\x0a", JpegXl),
    (0, b"\0\0\0\x0cJXL ", JpegXl),
    (0, b"8BPS", Photoshop),
    (0, b"VOX ", Vox),
    (0, b"glTF", Glb),
    (0, b"ply\n", Ply),
    (0, b"ply\r\n", Ply),
    (0, b"Kaydara FBX", Fbx),
    (0, b"BLENDER", Blender),
    (0, b"PK\x03\x04", Zip),
    (0, b"PK\x05\x06", Zip),
    (0, b"\x1f\x8b", Gzip),
    (0, b"7z\xbc\xaf\x27\x1c", Archive),
    (0, b"Rar!\x1a\x07", Archive),
    (0, b"\xfd7zXZ\0", Archive),
    (0, b"BZh", Archive),
    (0, b"\x28\xb5\x2f\xfd", Archive),
    (257, b"ustar\0", Archive),
    (257, b"ustar ", Archive),
    (0, b"%PDF-", Pdf),
    (
        0,
        b"version https://git-lfs.github.com/spec/",
        GitLfsPointer,
    ),
    (344, b"n+1\0", Nifti1),
    (344, b"ni1\0", Nifti1),
    (4, b"n+2\0", Nifti2),
    (4, b"ni2\0", Nifti2),
    (0, b"\x5c\x01\0\0", Analyze),
    (0, b"\0\0\x01\x5c", Analyze),
    (0, b"NRRD000", Nrrd),
    (128, b"DICM", Dicom),
];

impl FileType {
    /// Recognises the type of a file by its content.
    pub fn of(bytes: &[u8]) -> Self {
        if bytes.is_empty() {
            return Empty;
        }
        // A text may contain any letters after its beginning.
        let is_binary = has_control(&bytes[..bytes.len().min(HEAD)]);
        let has = |(at, signature, _): &&(usize, &[u8], Self)| {
            let rest = bytes.get(*at..).filter(|_| *at == 0 || is_binary);
            rest.is_some_and(|rest| rest.starts_with(signature))
        };
        if let Some((.., found)) = SIGNATURES.iter().find(has) {
            return *found;
        }
        is_binary
            .then(|| media_type(bytes))
            .flatten()
            .or_else(|| is_bmp(bytes).then_some(Bmp))
            .or_else(|| is_mgh(bytes).then_some(Mgh))
            .or_else(|| text_type(bytes))
            .or_else(|| is_binary_stl(bytes).then_some(Stl))
            .unwrap_or(Unknown)
    }

    /// Returns whether the file may be a text in UTF-8 such as a scene, perhaps with mistakes: not markup and
    /// not a Git LFS pointer.
    pub fn is_plain_text(self) -> bool {
        matches!(self, Empty | Toml | Json | Text | Obj)
    }

    /// Returns whether the file is a picture that [`super::Picture`] reads.
    pub fn is_readable_picture(self) -> bool {
        matches!(self, Png | Jpeg | WebP | Gif | Bmp)
    }

    fn words(self) -> &'static str {
        match self {
            Empty => "an empty file",
            Png => "a PNG picture",
            Jpeg => "a JPEG picture",
            WebP => "a WebP picture",
            Gif => "a GIF picture",
            Bmp => "a BMP picture",
            Tiff => "a TIFF picture",
            Heif => "a HEIF picture (.heic)",
            Avif => "an AVIF picture",
            JpegXl => "a JPEG XL picture",
            Photoshop => "a Photoshop document",
            Svg => "an SVG drawing",
            Vox => "a MagicaVoxel model",
            Obj => "an OBJ mesh",
            Gltf | Glb => "a glTF mesh",
            Stl => "an STL mesh",
            Ply => "a PLY mesh",
            Fbx => "an FBX mesh",
            Blender => "a Blender document",
            Zip => "a ZIP archive",
            Gzip => "a file compressed by gzip",
            Archive => "an archive or a compressed file",
            Pdf => "a PDF document",
            Html => "a web page",
            Xml => "an XML text",
            GitLfsPointer => "a Git LFS pointer, not the file itself (run git lfs pull)",
            Nifti1 => "a NIfTI scan",
            Nifti2 => "a NIfTI-2 scan",
            Analyze => "an Analyze header",
            Mgh => "a FreeSurfer scan (.mgh)",
            Nrrd => "an NRRD scan",
            Dicom => "a DICOM file",
            Video => "a film",
            Toml => "a TOML text",
            Json => "a JSON text",
            Text => "a text",
            Utf16 => "a text in UTF-16, not in UTF-8",
            OtherText => "a text in another encoding than UTF-8",
            Unknown => "an unknown type of file",
        }
    }
}

impl fmt::Display for FileType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.words())
    }
}

/// Returns the type of a file of the MP4 family, which has its brand after `ftyp`.
fn media_type(bytes: &[u8]) -> Option<FileType> {
    let brand = bytes.get(4..12)?.strip_prefix(b"ftyp")?;
    Some(match brand {
        b"heic" | b"heix" | b"heim" | b"heis" | b"hevc" | b"mif1" | b"msf1" => Heif,
        b"avif" | b"avis" => Avif,
        _ => Video,
    })
}

/// Returns whether the file begins as a BMP picture: "BM", then the length of the file, then zeros, then the
/// offset of the pixels.
fn is_bmp(bytes: &[u8]) -> bool {
    bytes.starts_with(b"BM") && bytes.get(6..10).is_some_and(|reserved| reserved == [0; 4])
}

/// Returns whether the file begins as a FreeSurfer scan: version 1, then a size of at least 1 on four axes,
/// then the type of the voxels, all big-endian.
fn is_mgh(bytes: &[u8]) -> bool {
    let Some((header, _)) = bytes.split_first_chunk::<24>() else {
        return false;
    };
    let (words, _) = header.as_chunks::<4>();
    let mut numbers = words.iter().map(|&word| i32::from_be_bytes(word));
    let is_version = numbers.next() == Some(1);
    let sizes_are_good = numbers
        .by_ref()
        .take(4)
        .all(|size| (1..1 << 16).contains(&size));
    is_version && sizes_are_good && matches!(numbers.next(), Some(0 | 1 | 3 | 4 | 10))
}

/// Returns whether the file is exactly as long as the number of triangles in the header of a binary STL file
/// requires.
fn is_binary_stl(bytes: &[u8]) -> bool {
    let count = bytes.get(80..84).and_then(|count| count.try_into().ok());
    let count = count.map_or(0, u32::from_le_bytes);
    count > 0 && bytes.len() as u64 == 84 + 50 * u64::from(count)
}

/// Returns the type of a text, or `None` if the file is none.
fn text_type(bytes: &[u8]) -> Option<FileType> {
    let head = &bytes[..bytes.len().min(HEAD)];
    if head.starts_with(b"\xff\xfe") || head.starts_with(b"\xfe\xff") || is_utf16(head) {
        return Some(Utf16);
    }
    if has_control(head) {
        return None;
    }
    match std::str::from_utf8(bytes) {
        Ok(text) => Some(type_of_text(text)),
        // Bytes of a text have few values above 127 in a row of Latin letters, but many in Shift JIS, so only
        // the missing control characters decide. A few bytes alone decide nothing.
        Err(_) => (head.len() >= 16).then_some(OtherText),
    }
}

/// Returns whether bytes contain a control character other than a tab, a line break, a form feed or an escape,
/// which is in no text.
fn has_control(bytes: &[u8]) -> bool {
    let is_control = |byte: &u8| matches!(byte, 0..=8 | 11 | 14..=26 | 28..=31);
    bytes.iter().any(is_control)
}

/// Returns whether every second byte of the first ones is zero, as in UTF-16 without a byte order mark.
fn is_utf16(head: &[u8]) -> bool {
    let (pairs, _) = head[..head.len().min(64)].as_chunks::<2>();
    let is_ascii = |high: u8, low: u8| high == 0 && matches!(low, 9 | 10 | 13 | 32..=126);
    pairs.len() >= 4
        && (pairs.iter().all(|&[low, high]| is_ascii(high, low))
            || pairs.iter().all(|&[high, low]| is_ascii(high, low)))
}

fn type_of_text(text: &str) -> FileType {
    let text = text.trim_start_matches('\u{feff}').trim_start();
    let mut head = &text[..text.floor_char_boundary(HEAD)];
    if head.starts_with('<') {
        return type_of_markup(&head.to_ascii_lowercase());
    }
    if head.starts_with('{') {
        return if head.contains("\"asset\"") {
            Gltf
        } else {
            Json
        };
    }
    if head.starts_with("solid") && head.contains("facet") {
        return Stl;
    }
    while let Some(comment) = head.strip_prefix('#') {
        let rest = comment.split_once('\n').map_or("", |(_, rest)| rest);
        head = rest.trim_start();
    }
    let line = head.lines().next().unwrap_or_default();
    if is_line_of_obj(line) {
        Obj
    } else if is_line_of_toml(line) {
        Toml
    } else {
        Text
    }
}

fn type_of_markup(head: &str) -> FileType {
    if head.starts_with("<!doctype html") || head.contains("<html") {
        Html
    } else if head.contains("<svg") {
        Svg
    } else {
        Xml
    }
}

fn is_line_of_obj(line: &str) -> bool {
    const WORDS: [&str; 8] = ["v", "vn", "vt", "f", "o", "g", "s", "mtllib"];
    let mut words = line.split_whitespace();
    let known = words.next().is_some_and(|word| WORDS.contains(&word));
    known && words.next().is_some_and(|second| second != "=")
}

fn is_line_of_toml(line: &str) -> bool {
    if line.starts_with('[') && line.contains(']') {
        return true;
    }
    let key = line.split_once('=').map(|(key, _)| key.trim());
    let is_of_key = |sign: char| sign.is_ascii_alphanumeric() || "_-.\"' ".contains(sign);
    key.is_some_and(|key| !key.is_empty() && key.chars().all(is_of_key))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn type_follows_from_content() {
        let at = |offset: usize, text: &[u8]| [&vec![0; offset], text, &[0; 8]].concat();
        let text_with = |offset: usize, text: &str| {
            let beginning = format!("dim = 2\n# {}", "m".repeat(offset - 10));
            (beginning + text + "\n").into_bytes()
        };
        let stl = [&[b' '; 80][..], &2u32.to_le_bytes(), &[7; 100]].concat();
        let mgh = [1i32, 256, 256, 256, 1, 3].map(i32::to_be_bytes).concat();
        let utf16 = |text: &str| text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let cases: Vec<(Vec<u8>, FileType)> = vec![
            (vec![], Empty),
            (b"\x89PNG\r\n\x1a\n".into(), Png),
            (b"\xff\xd8\xff\xe1\0\x18Exif".into(), Jpeg),
            (b"RIFF\x10\0\0\0WEBPVP8 ".into(), WebP),
            (b"RIFF\x10\0\0\0WAVEfmt ".into(), Unknown),
            (b"GIF89a and more".into(), Gif),
            (b"BM\x46\0\0\0\0\0\0\0\x36\0\0\0".into(), Bmp),
            (b"BMI = 22".into(), Toml),
            (b"II*\0\x08\0\0\0".into(), Tiff),
            (b"\0\0\0\x18ftypheic\0\0\0\0".into(), Heif),
            (b"\0\0\0\x18ftypavif\0\0\0\0".into(), Avif),
            (b"\0\0\0\x18ftypisom\0\0\0\0".into(), Video),
            (b"<?xml version=\"1.0\"?>\n<svg/>".into(), Svg),
            (b"  <!DOCTYPE HTML><title>404</title>".into(), Html),
            (b"<html><body><svg></svg>".into(), Html),
            (b"<?xml version=\"1.0\"?><note/>".into(), Xml),
            (b"VOX \x96\0\0\0MAIN".into(), Vox),
            (b"# Blender\nmtllib a.mtl\no Cube\nv 1 2 3\n".into(), Obj),
            (b"v = 3".into(), Toml),
            (b"{ \"asset\": { \"version\": \"2.0\" } }".into(), Gltf),
            (b"glTF\x02\0\0\0".into(), Glb),
            (b"solid cube\n facet normal 0 0 1\n".into(), Stl),
            (stl, Stl),
            (b"PK\x03\x04\x14\0".into(), Zip),
            (b"\x1f\x8b\x08\0".into(), Gzip),
            (b"%PDF-1.7".into(), Pdf),
            (
                b"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 1\n".into(),
                GitLfsPointer,
            ),
            (at(344, b"n+1\0"), Nifti1),
            (b"\x1c\x02\0\0n+2\0\r\n\x1a\n".into(), Nifti2),
            (at(0, b"\x5c\x01\0\0"), Analyze),
            (at(128, b"DICM"), Dicom),
            (at(257, b"ustar\0"), Archive),
            (at(257, b"ustar  "), Archive),
            (at(257, b"ustard"), Unknown),
            (text_with(257, "ustard tastes good"), Toml),
            (text_with(257, "ustar tastes good"), Toml),
            (text_with(128, "DICM"), Toml),
            (b"# a ftypheic\ndim = 2\n".into(), Toml),
            (b"dim ftypheic".into(), Text),
            (b"NRRD0004\ntype: short\n".into(), Nrrd),
            (mgh, Mgh),
            (b"\n# A level.\ndim = 2\n".into(), Toml),
            ("\u{feff}[[material]]\r\nyoung = 1".into(), Toml),
            (b"{ \"a\": 1 }".into(), Json),
            ("絵ではない".into(), Text),
            (utf16("\u{feff}dim = 2"), Utf16),
            (utf16("dim = 2"), Utf16),
            (
                b"# \x82\xcb\x82\xb1\x82\xcc\x91\xcc\ndim = 2".into(),
                OtherText,
            ),
            (vec![0; 40], Unknown),
            (b"\xff".into(), Unknown),
        ];
        for (bytes, expected) in cases {
            assert_eq!(
                FileType::of(&bytes),
                expected,
                "{:?}",
                bytes.escape_ascii().to_string()
            );
        }
    }

    #[test]
    fn type_of_any_beginning_is_found_without_a_panic() {
        let bytes: Vec<u8> = (0..=u8::MAX).chain("あ".repeat(2000).bytes()).collect();
        for start in 0..300 {
            for end in [start, start + 1, start + 3, start + 90, bytes.len()] {
                assert!(!FileType::of(&bytes[start..end]).to_string().is_empty());
            }
        }
    }
}
