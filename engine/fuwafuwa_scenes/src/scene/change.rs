//! Replacement of scene values from the command line.

/// Applies a change such as `material.young=9000`. A path that names a list without an entry number changes
/// all entries of the list.
pub(super) fn replace(value: &mut toml::Value, change: &str) -> Result<(), String> {
    let (path, new) = change
        .split_once('=')
        .ok_or_else(|| format!("{change:?} must be field=value"))?;
    let read: toml::Table = toml::from_str(&format!("value = {new}"))
        .map_err(|_| format!("{new:?} in {change:?} is not a value{}", hint(path, new)))?;
    let new = &read["value"];
    let fields: Vec<&str> = path.split('.').collect();
    put(value, &fields, new).map_err(|reason| format!("{change:?}: {reason}"))
}

/// Returns how to write a text as a value; empty if `new` is none.
fn hint(path: &str, new: &str) -> String {
    let is_word = |letter: char| letter.is_alphanumeric() || "-_./ ".contains(letter);
    match !new.is_empty() && new.chars().all(is_word) {
        true => format!("; a text requires quotes: '{path}=\"{new}\"'"),
        false => String::new(),
    }
}

fn put(value: &mut toml::Value, fields: &[&str], new: &toml::Value) -> Result<(), String> {
    let Some((field, rest)) = fields.split_first() else {
        *value = match (&*value, new) {
            // A whole number given for a float field is converted: 9000 means 9000.0.
            (toml::Value::Float(_), toml::Value::Integer(whole)) => {
                toml::Value::Float(*whole as f64)
            }
            _ => new.clone(),
        };
        return Ok(());
    };
    match value {
        toml::Value::Array(entries) => match field.parse::<usize>() {
            Ok(number) => {
                let count = entries.len();
                let entry = number
                    .checked_sub(1)
                    .and_then(|index| entries.get_mut(index));
                let entry = entry.ok_or(format!(
                    "there is no number {number}, the last one is {count}"
                ))?;
                put(entry, rest, new)
            }
            Err(_) if entries.is_empty() => Err(format!(
                "there is no entry that {field} could be a field of"
            )),
            Err(_) => entries
                .iter_mut()
                .try_for_each(|entry| put(entry, fields, new)),
        },
        toml::Value::Table(table) => {
            let absent = toml::Value::Array(Vec::new());
            put(table.entry(*field).or_insert(absent), rest, new)
        }
        _ => Err(format!("{field} is not a field of a single value")),
    }
}
