//! What can be used of a text that somebody may have changed: one bad value costs that value alone.

use serde::Serialize;
use serde::de::DeserializeOwned;
use toml::de::{DeTable, ValueDeserializer};
use toml::{Table, Value};

/// Most letters of a reason, and of what is quoted.
const LETTERS: usize = 80;

/// After so many lines that cannot be read a text is taken for another kind.
const MOST_LINES: usize = 32;

/// What is left of a text when all that cannot be used is taken out.
pub struct Sifted<T> {
    /// What it says.
    pub value: T,
    /// What of it was used, as it stands there.
    pub table: Table,
    /// What was taken out: where it stands, and why.
    pub refused: Vec<String>,
}

/// Reads a text, but for what cannot be used of it.
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

/// The same without the lines that are none of TOML.
fn good_lines(text: &str, refused: &mut Vec<String>) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    for _ in 0..MOST_LINES {
        let text = lines.join("\n");
        let Err(error) = DeTable::parse(&text) else {
            return text;
        };
        let place = error.span().map_or(0, |span| span.start);
        let breaks = text.as_bytes()[..place.min(text.len())].iter();
        let line = breaks.filter(|&&byte| byte == b'\n').count();
        // What is missing at the end of a line may be missed on the next one that says something.
        let at = (0..=line)
            .rev()
            .find(|&at| lines.get(at).is_some_and(|line| !line.is_empty()));
        let Some(at) = at else {
            break;
        };
        refused.push(format!("line {} ({})", at + 1, brief(error.message())));
        lines[at] = "";
    }
    // It is no such text at all.
    refused.push("all after that".into());
    lines.join("\n")
}

/// The part of a value with which the whole can still be read.
fn good_part(
    path: &str,
    value: Value,
    read: &dyn Fn(&Value) -> Result<(), String>,
    refused: &mut Vec<String>,
) -> Value {
    if read(&value).is_ok() {
        return value;
    }
    match value {
        Value::Table(entries) => {
            let mut good = Table::new();
            for (key, entry) in entries {
                let with = |entry: &Value| {
                    let mut more = good.clone();
                    more.insert(key.clone(), entry.clone());
                    read(&Value::Table(more))
                };
                if let Some(entry) = good_entry(&inside(path, &key), entry, &with, refused) {
                    good.insert(key, entry);
                }
            }
            Value::Table(good)
        }
        Value::Array(entries) => {
            let mut good = Vec::new();
            for (index, entry) in entries.into_iter().enumerate() {
                let with = |entry: &Value| {
                    let mut more = good.clone();
                    more.push(entry.clone());
                    read(&Value::Array(more))
                };
                let path = inside(path, &(index + 1).to_string());
                good.extend(good_entry(&path, entry, &with, refused));
            }
            Value::Array(good)
        }
        value => value,
    }
}

/// The part of an entry with which what it belongs to can still be read, if any.
fn good_entry(
    path: &str,
    entry: Value,
    read: &dyn Fn(&Value) -> Result<(), String>,
    refused: &mut Vec<String>,
) -> Option<Value> {
    let Err(reason) = read(&entry) else {
        return Some(entry);
    };
    let before = refused.len();
    let part = good_part(path, entry, read, refused);
    if read(&part).is_ok() {
        return Some(part);
    }
    // What is wrong with it is wrong with all of it.
    refused.truncate(before);
    refused.push(named(path, &reason));
    None
}

/// Notes what stands in a table and means nothing.
fn name_unknown(path: &str, table: &Table, meant: &Table, refused: &mut Vec<String>) {
    for (key, value) in table {
        let path = inside(path, key);
        match (value, meant.get(key)) {
            (Value::Table(table), Some(Value::Table(meant))) => {
                name_unknown(&path, table, meant, refused);
            }
            (_, Some(_)) => {}
            (_, None) => refused.push(named(&path, "it means nothing here")),
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
    // Nobody has to know Rust.
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

    /// What is left of a text, and what was refused.
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
    fn one_bad_value_costs_that_value_alone() {
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
    fn a_line_that_is_no_line_costs_that_line_alone() {
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

    #[test]
    fn anything_is_read_and_told_briefly() {
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
