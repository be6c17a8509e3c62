//! The text of an edited level.
//!
//! A changed scene is written into the text from which it was read. Comments, the order of tables, blank lines and the
//! form of numbers stay as they are wherever nothing was changed.

mod alignment;
mod format;
#[cfg(test)]
mod tests;

use alignment::{Step, steps};
use format::rank;
use fuwafuwa_scenes::Scene;
use toml_edit::{Array, ArrayOfTables, DocumentMut, InlineTable, Item, Table, TableLike, Value};

/// Reason why a scene cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum DocumentError {
    /// A value has no form in TOML, for example a number above the range of integers.
    #[error("cannot write the level: {0}")]
    Unwritable(#[from] toml::ser::Error),
}

/// Keys that have another name in files of version 0.2, and these names.
const FORMER_KEYS: [(&str, &str); 9] = [
    ("max_substeps", "most_substeps"),
    ("rigid_body", "rigid"),
    ("kind", "tie"),
    ("anchors", "ends"),
    ("point", "at"),
    ("motion_type", "drive"),
    ("max_force", "limit"),
    ("rotation_vector", "turned"),
    ("angular_velocity", "spin"),
];

/// Returns `text`, from which the scene `before` was read, with the changes from `before` to `after`. The returned text
/// reads as `after`. It is `text` itself if both scenes are equal, and a new text without comments if the changes cannot
/// be written into it.
///
/// # Errors
/// [`DocumentError`] if a value has no form in TOML.
pub fn merged(text: &str, before: &Scene, after: &Scene) -> Result<String, DocumentError> {
    if before == after {
        return Ok(text.to_owned());
    }
    let tables = [
        toml::Table::try_from(before)?,
        toml::Table::try_from(after)?,
    ];
    match changed(text, &tables).filter(|text| reads_as(text, after)) {
        Some(text) => Ok(text),
        None => written(after),
    }
}

/// Returns a new text that reads as a scene, without the keys that hold defaults.
///
/// # Errors
/// [`DocumentError`] if a value has no form in TOML.
pub fn written(scene: &Scene) -> Result<String, DocumentError> {
    let text = format!("dim = {}\n", scene.dim);
    if let Ok(empty) = Scene::read("level", &text, &[]) {
        let tables = [
            toml::Table::try_from(&empty)?,
            toml::Table::try_from(scene)?,
        ];
        let text = changed(&text, &tables).filter(|text| reads_as(text, scene));
        if let Some(text) = text {
            return Ok(text);
        }
    }
    Ok(toml::to_string(scene)?)
}

fn reads_as(text: &str, scene: &Scene) -> bool {
    Scene::read("level", text, &[]).is_ok_and(|read| read == *scene)
}

/// Returns the text with the changes between two tables. `None` if the text has another structure than the first table.
fn changed(text: &str, [before, after]: &[toml::Table; 2]) -> Option<String> {
    let mut document: DocumentMut = text.parse().ok()?;
    let end = last_position(document.as_table()).unwrap_or(0);
    let place = Place::Root { end };
    merge_table(document.as_table_mut(), before, after, place)?;
    Some(document.to_string())
}

/// Place of a table in a document.
#[derive(Copy, Clone, Debug)]
enum Place {
    /// The whole document, whose last table has the position `end`.
    Root { end: isize },
    /// Table with a header.
    Headed,
    /// Table on one line.
    Inline,
}

/// Writes the changes between two tables into a table of the document.
fn merge_table(
    table: &mut dyn TableLike,
    before: &toml::Table,
    after: &toml::Table,
    place: Place,
) -> Option<()> {
    let gone = before.keys().filter(|key| !after.contains_key(*key));
    let mut keys: Vec<&String> = after.keys().chain(gone).collect();
    keys.sort_by_key(|key| (rank(key), *key));
    for key in keys {
        let (old, new) = (before.get(key), after.get(key));
        if old == new {
            continue;
        }
        let name = written_key(table, key);
        match (new, table.get_mut(name)) {
            (None, _) => drop(table.remove(name)),
            (Some(new), Some(item)) => merge_item(item, old, new, key)?,
            (Some(new), None) => insert(table, key, new, place),
        }
    }
    Some(())
}

/// Returns the name under which a key is in a table.
fn written_key<'a>(table: &dyn TableLike, key: &'a str) -> &'a str {
    let former = FORMER_KEYS.iter().find(|(present, _)| *present == key);
    match former {
        Some((_, former)) if !table.contains_key(key) && table.contains_key(former) => former,
        _ => key,
    }
}

fn insert(table: &mut dyn TableLike, key: &str, new: &toml::Value, place: Place) {
    let mut item = match place {
        Place::Root { .. } => format::item(new, key, true),
        Place::Headed => format::item(new, key, false),
        Place::Inline => Item::Value(format::value(new, key)),
    };
    if let Place::Root { end } = place {
        // The tables of a new list follow all others.
        match &mut item {
            Item::Table(table) => table.set_position(Some(end + 1)),
            Item::ArrayOfTables(list) => {
                list.iter_mut()
                    .for_each(|table| table.set_position(Some(end + 1)));
            }
            _ => {}
        }
    }
    table.insert(key, item);
}

fn merge_item(
    item: &mut Item,
    old: Option<&toml::Value>,
    new: &toml::Value,
    key: &str,
) -> Option<()> {
    match (item, old, new) {
        (Item::Value(value), _, _) => merge_value(value, old, new, key),
        (Item::Table(table), Some(toml::Value::Table(old)), toml::Value::Table(new)) => {
            merge_table(table, old, new, Place::Headed)
        }
        (Item::ArrayOfTables(list), Some(toml::Value::Array(old)), toml::Value::Array(new)) => {
            merge_tables(list, old, new, key)
        }
        _ => None,
    }
}

fn merge_value(
    value: &mut Value,
    old: Option<&toml::Value>,
    new: &toml::Value,
    key: &str,
) -> Option<()> {
    match (&mut *value, old, new) {
        (Value::InlineTable(table), Some(toml::Value::Table(old)), toml::Value::Table(new)) => {
            let count = table.len();
            merge_table(table, old, new, Place::Inline)?;
            if table.len() != count || old.keys().ne(new.keys()) {
                space_out(table);
            }
            return Some(());
        }
        (Value::Array(array), Some(toml::Value::Array(old)), toml::Value::Array(new))
            if array.len() == old.len() =>
        {
            return merge_array(array, old, new, key);
        }
        _ => {}
    }
    let decor = value.decor().clone();
    *value = format::value(new, key);
    *value.decor_mut() = decor;
    Some(())
}

/// Restores the spaces of a table on one line after keys were added or removed: none before commas, one before the end.
fn space_out(table: &mut InlineTable) {
    let count = table.len();
    for (index, (_, value)) in table.iter_mut().enumerate() {
        if is_blank(suffix(value)) {
            let end = if index + 1 == count { " " } else { "" };
            value.decor_mut().set_suffix(end);
        }
    }
}

fn is_blank(text: &str) -> bool {
    text.chars().all(|letter| letter == ' ' || letter == '\t')
}

fn suffix(value: &Value) -> &str {
    let suffix = value.decor().suffix();
    suffix.and_then(|suffix| suffix.as_str()).unwrap_or("")
}

fn prefix(value: &Value) -> Option<&str> {
    value.decor().prefix().and_then(|prefix| prefix.as_str())
}

/// Writes the changes between two arrays into an array of the document.
fn merge_array(
    array: &mut Array,
    old: &[toml::Value],
    new: &[toml::Value],
    key: &str,
) -> Option<()> {
    let steps = match old.len() == new.len() && !old.iter().any(toml::Value::is_table) {
        // Coordinates keep their places.
        true => (0..old.len())
            .map(|index| Step::Change(index, index))
            .collect(),
        false => steps(old, new),
    };
    let values: Vec<Value> = array.iter().cloned().collect();
    let [first, next] = [0, 1].map(|index| values.get(index).and_then(prefix));
    let first = first.unwrap_or("").to_owned();
    let next = next
        .unwrap_or(if first.contains('\n') { &first } else { " " })
        .to_owned();
    array.clear();
    for step in steps {
        let (mut value, came_from) = match step {
            Step::Delete(_) => continue,
            Step::Keep(index) => (values[index].clone(), Some(index)),
            Step::Change(index, later) => {
                let mut value = values[index].clone();
                if old[index] != new[later] {
                    merge_value(&mut value, Some(&old[index]), &new[later], key)?;
                }
                (value, Some(index))
            }
            Step::Insert(later) => (format::value(&new[later], key), None),
        };
        let is_first = array.is_empty();
        let usual = if is_first { &first } else { &next };
        // A comment belongs to its own entry.
        let is_plain = !usual.contains('#');
        match came_from {
            None if is_plain => *value.decor_mut() = toml_edit::Decor::new(usual.as_str(), ""),
            None if usual.contains('\n') => {
                *value.decor_mut() = toml_edit::Decor::new("\n    ", "")
            }
            Some(index) if is_plain && is_first != (index == 0) => {
                let own = if index == 0 { &first } else { &next };
                if prefix(&value) == Some(own) {
                    value.decor_mut().set_prefix(usual.as_str());
                }
            }
            _ => {}
        }
        array.push_formatted(value);
    }
    let count = array.len();
    for value in array.iter_mut().take(count.saturating_sub(1)) {
        if is_blank(suffix(value)) {
            value.decor_mut().set_suffix("");
        }
    }
    Some(())
}

/// Writes the changes between two lists into the tables of a list in the document.
fn merge_tables(
    list: &mut ArrayOfTables,
    old: &[toml::Value],
    new: &[toml::Value],
    key: &str,
) -> Option<()> {
    if list.len() != old.len() {
        return None;
    }
    let mut tables: Vec<Option<Table>> = std::mem::take(list).into_iter().map(Some).collect();
    for step in steps(old, new) {
        match step {
            Step::Delete(index) => tables[index] = None,
            Step::Keep(index) => list.push(tables[index].take()?),
            Step::Change(index, later) => {
                let mut table = tables[index].take()?;
                let [old, new] = [old[index].as_table()?, new[later].as_table()?];
                merge_table(&mut table, old, new, Place::Headed)?;
                list.push(table);
            }
            Step::Insert(later) => {
                let mut table = format::table(new[later].as_table()?, key);
                let before = list.iter().last().and_then(last_position);
                let after = || tables.iter().flatten().find_map(Table::position);
                set_position(&mut table, before.or_else(after));
                list.push(table);
            }
        }
    }
    Some(())
}

/// Sets the position of a table and of the tables in it.
fn set_position(table: &mut Table, position: Option<isize>) {
    table.set_position(position);
    for (_, item) in table.iter_mut() {
        if let Some(list) = item.as_array_of_tables_mut() {
            list.iter_mut()
                .for_each(|table| set_position(table, position));
        }
    }
}

/// Returns the last position of a table and of the tables in it.
fn last_position(table: &Table) -> Option<isize> {
    let own = table.position();
    let inner = table.iter().filter_map(|(_, item)| match item {
        Item::Table(table) => last_position(table),
        Item::ArrayOfTables(list) => list.iter().filter_map(last_position).max(),
        _ => None,
    });
    own.into_iter().chain(inner).max()
}
