//! What is inside this program, and under which licences.

use std::sync::LazyLock;

/// All of it: what `cargo xtask release` gathered, and in other builds what the project knows by itself. The page of a browser
/// has a text of its own beside it.
#[cfg(not(target_family = "wasm"))]
pub const TEXT: &str = include_str!(env!("TAMAIRE_LICENCES"));

#[cfg(target_family = "wasm")]
const TEXT: &str = include_str!("../../../THIRD-PARTY.md");

/// Letters of the longest line that fits on a screen.
const MOST: usize = 92;

static LINES: LazyLock<Vec<&'static str>> = LazyLock::new(|| lines_of(TEXT));

/// The text in lines that fit on a screen.
pub fn lines() -> &'static [&'static str] {
    &LINES
}

/// The lines of a text; one that is too long goes on in the next, with a word of its own where there is one.
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
    fn long_lines_go_on_in_the_next_and_nothing_is_lost() {
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
    fn the_font_and_what_reads_sticks_are_named() {
        for named in ["M PLUS Rounded 1c", "SDL", "SQLite"] {
            assert!(TEXT.contains(named), "{named}");
        }
    }
}
