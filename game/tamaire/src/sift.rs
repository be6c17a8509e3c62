//! Tolerant reading of TOML that users may have edited: an invalid value is dropped and all other values are
//! kept.

use serde::Serialize;
use serde::de::DeserializeOwned;
use toml::de::{DeTable, ValueDeserializer};
use toml::{Table, Value};

/// Maximum length of the reason why an entry was refused, and of a quoted name [characters].
const LETTERS: usize = 80;

/// Maximum number of unreadable lines that are dropped one by one. A text with more of them is probably not
/// TOML.
const MOST_LINES: usize = 32;

/// Maximum number of refused entries that are isolated one by one. Beyond this number, a group of entries is
/// dropped as a whole if one of them is invalid, which limits the time.
const MOST_REFUSED: usize = 256;

/// Maximum amount of text parsed in the search for unreadable lines [bytes]. Finding one line takes a pass
/// over the whole text, so fewer lines are searched for in a long text.
const MOST_READ: usize = 1 << 21;

/// Usable part of a TOML text, and reports about the rest.
pub struct Sifted<T> {
    /// Value read from [`Self::table`].
    pub value: T,
    /// Entries that were kept, as written in the text. Unknown keys are kept, too.
    pub table: Table,
    /// Refused entries: path or line, and reason.
    pub refused: Vec<String>,
}

/// Reads a value from TOML and leaves out invalid entries.
pub fn sift<T: DeserializeOwned + Serialize + Default>(text: &str) -> Sifted<T> {
    let mut refused = Vec::new();
    let text = good_lines(text, &mut refused);
    let (parsed, _) = DeTable::parse_recoverable(&text);
    let mut table = Table::new();
    for (key, value) in parsed.into_inner() {
        let key = key.into_inner().into_owned();
        match <Value as serde::Deserialize>::deserialize(ValueDeserializer::from(value)) {
            Ok(value) => drop(table.insert(key, value)),
            Err(error) => refused.push(named(&key, error.message())),
        }
    }
    let read = |table: &Value| match table.clone().try_into::<T>() {
        Ok(_) => Ok(()),
        Err(error) => Err(error.message().to_string()),
    };
    let table = good_part("", Value::Table(table), &read, &mut refused);
    let table = table.as_table().cloned().unwrap_or_default();
    let value: T = table.clone().try_into().unwrap_or_default();
    if let Ok(meant) = Table::try_from(&value) {
        name_unknown("", &table, &meant, &mut refused);
    }
    Sifted {
        value,
        table,
        refused,
    }
}

/// Returns the text with each line that is not valid TOML replaced by an empty line.
fn good_lines(text: &str, refused: &mut Vec<String>) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    let most = MOST_LINES.min(1 + MOST_READ / text.len().max(1));
    for _ in 0..most {
        let text = lines.join("\n");
        let Err(error) = DeTable::parse(&text) else {
            return text;
        };
        let start = error.span().map_or(0, |span| span.start);
        let breaks = text.as_bytes()[..start.min(text.len())].iter();
        let line = breaks.filter(|&&byte| byte == b'\n').count();
        // The parser may report an error at the end of a line on a later line. Therefore the last non-empty
        // line at or before the reported line is dropped.
        let at = (0..=line)
            .rev()
            .find(|&at| lines.get(at).is_some_and(|line| !line.is_empty()));
        let Some(at) = at else {
            break;
        };
        refused.push(format!("line {} ({})", at + 1, brief(error.message())));
        lines[at] = "";
    }
    // So many lines are unreadable that the text is probably not TOML. The search for further lines ends
    // here.
    refused.push("all after that".into());
    lines.join("\n")
}

/// Removes the invalid entries of a value, at any depth. `read` tests whether the whole text can be read with
/// a changed value in this place.
fn good_part(path: &str, value: Value, read: &Read, refused: &mut Vec<String>) -> Value {
    match value {
        Value::Table(entries) => {
            let entries: Vec<Entry> = entries.into_iter().collect();
            table_of(&good_entries(path, &entries, table_of, read, refused))
        }
        Value::Array(entries) => {
            let numbered = (1..).map(|number: usize| number.to_string());
            let entries: Vec<Entry> = numbered.zip(entries).collect();
            array_of(&good_entries(path, &entries, array_of, read, refused))
        }
        value => value,
    }
}

/// Tests whether a value can be read; returns the reason if it cannot.
type Read<'a> = dyn Fn(&Value) -> Result<(), String> + 'a;

/// Entry of a table (key and value) or of an array (number from 1 and value).
type Entry = (String, Value);

fn table_of(entries: &[Entry]) -> Value {
    Value::Table(entries.iter().cloned().collect())
}

fn array_of(entries: &[Entry]) -> Value {
    Value::Array(entries.iter().map(|(_, entry)| entry.clone()).collect())
}

/// Returns the valid entries of a table or an array; `of` builds a table or an array from entries. Bisection
/// isolates the invalid entries, so that the time does not grow with the square of their number.
fn good_entries(
    path: &str,
    entries: &[Entry],
    of: fn(&[Entry]) -> Value,
    read: &Read,
    refused: &mut Vec<String>,
) -> Vec<Entry> {
    match (read(&of(entries)), entries) {
        (Ok(()), _) => entries.to_vec(),
        (Err(_), []) => Vec::new(),
        (Err(_), _) if refused.len() >= MOST_REFUSED => Vec::new(),
        (Err(reason), [(name, entry)]) => {
            let path = inside(path, name);
            let with = |entry: &Value| read(&of(&[(name.clone(), entry.clone())]));
            let before = refused.len();
            let part = good_part(&path, entry.clone(), &with, refused);
            if with(&part).is_ok() {
                return vec![(name.clone(), part)];
            }
            // The entry is invalid as a whole, so one reason for the entry replaces the reasons for its
            // parts.
            refused.truncate(before);
            refused.push(named(&path, &reason));
            Vec::new()
        }
        (Err(_), entries) => {
            let (first, last) = entries.split_at(entries.len() / 2);
            let mut good = good_entries(path, first, of, read, refused);
            good.extend(good_entries(path, last, of, read, refused));
            good
        }
    }
}

/// Reports the keys of `table` that are unknown, that is, missing in `meant`.
fn name_unknown(path: &str, table: &Table, meant: &Table, refused: &mut Vec<String>) {
    for (key, value) in table {
        let path = inside(path, key);
        match (value, meant.get(key)) {
            (Value::Table(table), Some(Value::Table(meant))) => {
                name_unknown(&path, table, meant, refused);
            }
            (_, Some(_)) => {}
            (_, None) if refused.len() >= MOST_REFUSED => {}
            (_, None) => refused.push(named(&path, "unknown key")),
        }
    }
}

fn inside(path: &str, key: &str) -> String {
    let key = brief(key);
    match path {
        "" => key,
        path => format!("{path}.{key}"),
    }
}

fn named(path: &str, reason: &str) -> String {
    // Replaces names of Rust types, which users may not know.
    let types = ["f32", "f64", "u8", "u64", "usize"];
    let in_words = types.iter().fold(reason.to_string(), |reason, name| {
        reason.replace(&format!("expected {name}"), "expected a number")
    });
    format!("{path} ({})", brief(&in_words))
}

fn brief(text: &str) -> String {
    tamaire_play::shortened(text, LETTERS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;

    /// Checks that the entries of `left` are kept of `text`, and that the reports on refused entries begin as
    /// in `refused`.
    fn check(text: &str, left: &str, refused: &[&str]) {
        let found = sift::<Settings>(text);
        assert_eq!(
            found.table,
            toml::from_str::<Table>(left).unwrap(),
            "{text}"
        );
        let is_told = found.refused.iter().zip(refused);
        let is_told = is_told.filter(|(found, told)| found.starts_with(*told));
        let counts = (found.refused.len(), is_told.count());
        let expected = (refused.len(), refused.len());
        assert_eq!(counts, expected, "{text}: {:?}", found.refused);
    }

    #[test]
    fn sift_drops_only_invalid_values() {
        check("speed = 0.75", "speed = 0.75", &[]);
        check(
            "speed = \"fast\"\nvolume = 0.5\nwarp = 9\n",
            "volume = 0.5\nwarp = 9\n",
            &[
                "speed (invalid type: string \"fast\", expected a number)",
                "warp (",
            ],
        );
        check(
            "volume = 0.5\n[bindings.keys]\nretry = [\"P\", \"Nonsense\"]\nfly = [\"F\"]\npause = 3\n",
            "volume = 0.5\n[bindings.keys]\nretry = [\"P\"]\n",
            &[
                "bindings.keys.fly (",
                "bindings.keys.pause (",
                "bindings.keys.retry.2 (",
            ],
        );
        check(
            "[calibrations.stick]\nswap = true\ngain = [0.5, \"x\"]\n",
            "[calibrations.stick]\nswap = true\n",
            &["calibrations.stick.gain ("],
        );
        check(
            "language = \"klingon\"\ncolour_safe = true",
            "colour_safe = true",
            &["language ("],
        );
    }

    #[test]
    fn sift_drops_only_unreadable_lines() {
        check(
            "speed = 0.75\n?!\nvolume = 0.5\n",
            "speed = 0.75\nvolume = 0.5\n",
            &["line 2 ("],
        );
        check("speed = 0.75\nvolume = [", "speed = 0.75", &["line 2 ("]);
        check(
            "speed = 0.75\nspeed = 0.8\nvolume = 0.5",
            "speed = 0.75\nvolume = 0.5",
            &["line 2 ("],
        );
    }

    /// Regression test: the time once grew with the square of the number of entries.
    #[test]
    fn sift_reads_long_invalid_text_in_time() {
        let entries = |count: usize, value: &str| {
            let lines = (0..count).map(|number| format!("key{number} = {value}\n"));
            lines.collect::<String>()
        };
        let texts = [
            format!("speed = \"fast\"\n{}", entries(20_000, "1")),
            format!("[calibrations]\n{}", entries(20_000, "1")),
            format!("[bindings.keys]\n{}", entries(20_000, "[\"Q\"]")),
            format!("[bindings.keys]\npause = [{}]", "\"?\", ".repeat(20_000)),
        ];
        for text in texts {
            let start = std::time::Instant::now();
            let found = sift::<Settings>(&text);
            let refused = found.refused.len();
            assert!((200..=MOST_REFUSED + 1).contains(&refused), "{refused}");
            let seconds = start.elapsed().as_secs_f32();
            assert!(seconds < 20.0, "{seconds} s for {:?}", &text[..40]);
        }
    }

    #[test]
    fn sift_reads_any_text_with_short_reasons() {
        let texts = [
            String::new(),
            "\u{0}\u{1}".repeat(1000),
            "x = ".to_string() + &"[".repeat(100_000),
            "x = ".to_string() + &"{a = ".repeat(100_000),
            "a.".repeat(100_000) + "a = 1",
            format!("speed = \"{}\"", "z".repeat(1 << 19)),
            format!("{} = 1", "z".repeat(1 << 19)),
            "volume = 99999999999999999999".into(),
            "volume = 0.5\nvolume = 0.6".into(),
        ];
        for text in texts {
            let found = sift::<Settings>(&text);
            let told: usize = found.refused.iter().map(String::len).max().unwrap_or(0);
            assert!(told < 1000, "{told}");
        }
    }
}
