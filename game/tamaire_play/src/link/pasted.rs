//! Links as mail and chat programs leave them: percent-encoded, wrapped, quoted, or with punctuation around.

use super::{END, LEVEL, MAX_LENGTH, ROUND};
use std::borrow::Cow;

/// Maximum length of a text that is searched for a link [bytes]; the rest is ignored.
const MOST_BYTES: usize = 1 << 18;
/// Maximum number of times that a text is decoded: some programs encode an address that is encoded already.
const MOST_DECODED: usize = 3;

/// Returns whether a text is meant as a link: an address, or a text with the fragment of a link.
pub fn is_link(text: &str) -> bool {
    let text = decoded(text);
    let start = text.trim_start_matches(is_around);
    start.starts_with("https://") || start.starts_with("http://") || start_of(&text).is_some()
}

/// Fragments that a text may stand for: beginnings of one text.
pub struct Candidates {
    text: String,
    /// Lengths of the fragments, in the order in which they are tried [bytes].
    ends: Vec<usize>,
}

impl Candidates {
    /// Returns the fragments in the order in which they are tried.
    pub fn fragments(&self) -> impl Iterator<Item = &str> {
        self.ends.iter().map(|&end| &self.text[..end])
    }
}

/// Finds the fragments that a text may stand for. Line breaks and spaces may be part of a wrapped fragment, or
/// its end. The last fragment is that of the whole text. Besides the last one, fragments longer than a link are
/// left out.
pub fn candidates(text: &str) -> Candidates {
    let text = decoded(text);
    let start = start_of(&text)
        .or_else(|| text.find('#').map(|at| at + 1))
        .unwrap_or(0);
    let mut fragment = String::new();
    let mut ends = Vec::new();
    for word in text[start..].split_whitespace() {
        // Signs of quoted mails at the beginnings of lines.
        let word = word.trim_start_matches(['>', '|']);
        let end = word.find(|letter| !is_of_fragment(letter));
        fragment.push_str(&word[..end.unwrap_or(word.len())]);
        if end.is_some() {
            break;
        }
        if fragment.ends_with(END) && fragment.len() <= MAX_LENGTH {
            ends.push(fragment.len());
        }
    }
    if ends.last() != Some(&fragment.len()) {
        ends.push(fragment.len());
    }
    let text = fragment;
    Candidates { text, ends }
}

/// Returns the offset of the fragment of a link in a text, behind its `#`.
fn start_of(text: &str) -> Option<usize> {
    let is_start = |at: usize| {
        let mut letters = text[at..].chars();
        let is_kind = letters
            .next()
            .is_some_and(|kind| [ROUND, LEVEL].contains(&kind));
        is_kind && letters.next().is_some_and(|format| format.is_ascii_digit())
    };
    let marks = text.match_indices('#').map(|(at, _)| at + 1);
    marks.into_iter().find(|&at| is_start(at))
}

/// Returns whether a letter may stand before a link: a bracket, a quotation mark or a space.
fn is_around(letter: char) -> bool {
    letter.is_whitespace() || "<([{\"'`「『（＜“‘«".contains(letter)
}

fn is_of_fragment(letter: char) -> bool {
    letter.is_ascii_alphanumeric() || letter == '-' || letter == '_'
}

/// Undoes percent-encoding and quoted-printable, and drops invisible characters and backslashes, with which
/// chat programs protect a `_`.
fn decoded(text: &str) -> String {
    let text = &text[..text.floor_char_boundary(MOST_BYTES)];
    let mut text: Cow<str> = text.into();
    for _ in 0..MOST_DECODED {
        if !text.contains('%') {
            break;
        }
        text = unescaped(&text, '%').into();
    }
    if text.contains("=\n")
        || text.contains("=\r\n")
        || text.contains("=3D")
        || text.contains("=23")
    {
        text = unescaped(&text, '=').into();
    }
    text.chars()
        .filter(|&letter| !is_invisible(letter))
        .collect()
}

/// Replaces `sign` and two hexadecimal digits by the ASCII character with this number. Drops the sign at the
/// end of a line, which in quoted-printable continues the line.
fn unescaped(text: &str, sign: char) -> String {
    let mut parts = text.split(sign);
    let mut whole = String::from(parts.next().unwrap_or_default());
    for part in parts {
        // `from_str_radix` alone would accept a sign, as in `+5`.
        let is_digits = |digits: &&str| digits.bytes().all(|byte| byte.is_ascii_hexdigit());
        let digits = part.get(..2).filter(is_digits);
        let code = digits.and_then(|digits| u8::from_str_radix(digits, 16).ok());
        match code.filter(u8::is_ascii) {
            Some(code) => {
                whole.push(code.into());
                whole.push_str(&part[2..]);
            }
            None if part.starts_with(['\r', '\n']) => {
                whole.push_str(part.trim_start_matches(['\r', '\n']))
            }
            None => {
                whole.push(sign);
                whole.push_str(part);
            }
        }
    }
    whole
}

/// Zero-width spaces and joiners, the soft hyphen, the byte order mark, and the backslash.
fn is_invisible(letter: char) -> bool {
    matches!(
        letter,
        '\u{200b}'..='\u{200f}' | '\u{2060}' | '\u{ad}' | '\u{feff}' | '\\'
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fragments(text: &str) -> Vec<String> {
        candidates(text).fragments().map(String::from).collect()
    }

    #[test]
    fn candidates_of_a_text_of_many_ends_are_few() {
        let text = format!("#r1{}", "z ".repeat(131_000));
        let found = candidates(&text);
        // The fragments "r1z" to that of 16 000 characters, and that of the whole text.
        assert_eq!(found.ends.len(), MAX_LENGTH - 2 + 1);
        assert!(found.text.len() <= MOST_BYTES);
        assert_eq!(found.fragments().next(), Some("r1z"));
    }

    #[test]
    fn candidates_end_at_each_z_and_at_foreign_letters() {
        assert_eq!(fragments("x#r1az bz c"), ["r1az", "r1azbz", "r1azbzc"]);
        assert_eq!(fragments("x#r1az bc, dz"), ["r1az", "r1azbc"]);
        assert_eq!(fragments("x#r1az) bz"), ["r1az"]);
    }

    #[test]
    fn unescaped_requires_two_hexadecimal_digits() {
        assert_eq!(unescaped("a%+5b%41%4", '%'), "a%+5bA%4");
        assert_eq!(unescaped("=\nr=3D=-1", '='), "r==-1");
    }
}
