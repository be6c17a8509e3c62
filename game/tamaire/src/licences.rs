//! Licences of the parts of this program.

use std::sync::LazyLock;

/// Licence texts: those gathered by `cargo xtask release`, or `THIRD-PARTY.md` in other builds. In a browser
/// the game shows `THIRD-PARTY.md` and links to a file with all texts.
#[cfg(not(target_family = "wasm"))]
pub const TEXT: &str = include_str!(env!("TAMAIRE_LICENCES"));

#[cfg(target_family = "wasm")]
const TEXT: &str = include_str!("../../../THIRD-PARTY.md");

/// Maximum length of a line that fits on a screen [characters].
const MOST: usize = 92;

static LINES: LazyLock<Vec<&'static str>> = LazyLock::new(|| lines_of(TEXT));

/// Returns the licence texts in lines that fit on a screen.
pub fn lines() -> &'static [&'static str] {
    &LINES
}

/// Wraps the lines of a text, at a space if possible.
fn lines_of(text: &str) -> Vec<&str> {
    let mut lines = Vec::new();
    for mut rest in text.lines() {
        while let Some((end, _)) = rest.char_indices().nth(MOST) {
            let cut = rest[..end].rfind(' ').filter(|&cut| cut > 0).unwrap_or(end);
            lines.push(rest[..cut].trim_end());
            rest = rest[cut..].trim_start();
        }
        lines.push(rest.trim_end());
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_wrap_without_loss() {
        let word = "é".repeat(MOST + 5);
        let text = format!("short\n\n{}end\n{word}\n", "seven77 ".repeat(30));
        let lines = lines_of(&text);
        assert!(lines.iter().all(|line| line.chars().count() <= MOST));
        assert_eq!(&lines[..2], ["short", ""]);
        let letters = |text: &str| -> String { text.split_whitespace().collect() };
        assert_eq!(letters(&lines.concat()), letters(&text));
        assert!(lines.contains(&"ééééé"), "{lines:?}");
    }

    #[test]
    fn text_names_font_and_stick_libraries() {
        for named in ["M PLUS Rounded 1c", "SDL", "SQLite"] {
            assert!(TEXT.contains(named), "{named}");
        }
    }
}
