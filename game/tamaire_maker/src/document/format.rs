//! Text of new values.

use fuwafuwa_scenes::scene::{BodyText, FieldText, MaterialText, RigidBodyText, SwitchText};
use toml_edit::{Array, ArrayOfTables, Decor, InlineTable, Item, Table, Value};

/// Maximum length of an array of tables or of points on one line [characters].
const MAX_LINE: usize = 100;

/// Keys in the order in which they are written. All others follow, in alphabetical order, and then [`LAST_KEYS`].
const FIRST_KEYS: [&str; 42] = [
    "dim",
    "gravity",
    "drag",
    "max_substeps",
    "stiff_bodies",
    "tick",
    "sleep",
    "seconds",
    "view",
    "game",
    "material",
    "body",
    "name",
    "en",
    "ja",
    "basket",
    "baskets",
    "kind",
    "length",
    "shape",
    "file",
    "content",
    "voxels",
    "n",
    "width",
    "proportions",
    "young",
    "poisson",
    "density",
    "obstacle",
    "rigid_body",
    "hand",
    "normal",
    "point",
    "half_space",
    "box",
    "capsule",
    "ball",
    "from",
    "to",
    "centre",
    "half",
];
const LAST_KEYS: [&str; 12] = [
    "at",
    "rotation_vector",
    "velocity",
    "anchors",
    "path",
    "part",
    "joint",
    "knife",
    "switch",
    "field",
    "wish",
    "hint",
];

/// Keys of numbers with 64 bits.
const DOUBLES: [&str; 3] = ["young", "poisson", "quaternion"];

/// Returns the place of a key among the keys of its table.
pub(super) fn rank(key: &str) -> usize {
    let first = FIRST_KEYS.iter().position(|known| *known == key);
    let last = LAST_KEYS.iter().position(|known| *known == key);
    let last = last.map(|place| FIRST_KEYS.len() + 1 + place);
    first.or(last).unwrap_or(FIRST_KEYS.len())
}

/// Returns the text of the value of a key.
pub(super) fn value(value: &toml::Value, key: &str) -> Value {
    match value {
        toml::Value::String(text) => text.into(),
        toml::Value::Integer(number) => (*number).into(),
        toml::Value::Float(number) => float(*number, key),
        toml::Value::Boolean(is_on) => (*is_on).into(),
        toml::Value::Datetime(time) => time.to_string().into(),
        toml::Value::Array(entries) => array(entries, key).into(),
        toml::Value::Table(table) => inline_table(table, key).into(),
    }
}

/// Returns the shortest decimal that reads back to the same number. Numbers of 32 bits, which most are, need fewer digits
/// than those of 64 bits.
fn float(number: f64, key: &str) -> Value {
    let short = number as f32;
    let is_short = f64::from(short) == number && !DOUBLES.contains(&key);
    let text = if is_short {
        format!("{short:?}")
    } else {
        format!("{number:?}")
    };
    text.parse().unwrap_or_else(|_| Value::from(number))
}

fn array(entries: &[toml::Value], key: &str) -> Array {
    let mut array: Array = entries.iter().map(|entry| value(entry, key)).collect();
    let is_of_entries = entries
        .iter()
        .all(|entry| entry.is_table() || entry.is_array());
    if entries.len() > 1 && is_of_entries && array.to_string().len() > MAX_LINE {
        for entry in array.iter_mut() {
            *entry.decor_mut() = Decor::new("\n    ", "");
        }
        array.set_trailing("\n");
        array.set_trailing_comma(true);
    }
    array
}

fn inline_table(table: &toml::Table, key: &str) -> InlineTable {
    let is_default = |name: &str, value: &toml::Value| {
        key == "layers"
            && match name {
                "memberships" => *value == toml::Value::Integer(1),
                _ => *value == toml::Value::Integer(u32::MAX.into()),
            }
    };
    let mut inline = InlineTable::new();
    for (name, entry) in in_order(table) {
        if !is_default(name, entry) {
            inline.insert(name, value(entry, name));
        }
    }
    inline
}

/// Returns the keys and values of a table in the order in which they are written.
fn in_order(table: &toml::Table) -> Vec<(&String, &toml::Value)> {
    let mut entries: Vec<_> = table.iter().collect();
    entries.sort_by_key(|&(key, _)| (rank(key), key));
    entries
}

/// Returns an entry of the list `list`, or the table with this name, without the keys that hold defaults.
pub(super) fn table(entry: &toml::Table, list: &str) -> Table {
    let defaults = defaults(list);
    let mut table = Table::new();
    for (key, entry) in in_order(entry) {
        if defaults.get(key) != Some(entry) {
            table.insert(key, item(entry, key, false));
        }
    }
    table
}

/// Returns the value of a key of a table with a header. Lists become tables with headers if `is_root`, and the parts of a
/// body always.
pub(super) fn item(entry: &toml::Value, key: &str, is_root: bool) -> Item {
    match entry {
        toml::Value::Table(entry) if is_root => Item::Table(table(entry, key)),
        toml::Value::Array(entries) if is_root || key == "part" => match tables(entries, key) {
            Some(list) => Item::ArrayOfTables(list),
            None => Item::Value(value(entry, key)),
        },
        _ => Item::Value(value(entry, key)),
    }
}

fn tables(entries: &[toml::Value], key: &str) -> Option<ArrayOfTables> {
    let mut list = ArrayOfTables::new();
    for entry in entries {
        list.push(table(entry.as_table()?, key));
    }
    (!list.is_empty()).then_some(list)
}

/// Returns the keys and values that the reader restores in an entry of a list.
fn defaults(list: &str) -> toml::Table {
    let made = match list {
        "body" => toml::Table::try_from(BodyText::default()),
        "material" => toml::Table::try_from(MaterialText::default()),
        "rigid_body" => toml::Table::try_from(RigidBodyText::default()),
        "switch" => toml::Table::try_from(SwitchText::default()),
        "field" => toml::Table::try_from(FieldText::default()),
        "obstacle" => Ok([("friction".to_owned(), single(0.2))].into_iter().collect()),
        "hand" => Ok([("kinematic".to_owned(), toml::Value::Boolean(false))]
            .into_iter()
            .collect()),
        "game" => {
            let wish = toml::Value::Array(Vec::new());
            let known = [
                ("share", single(0.6)),
                ("hold", single(1.0)),
                ("wish", wish),
            ];
            Ok(known
                .into_iter()
                .map(|(key, value)| (key.to_owned(), value))
                .collect())
        }
        _ => Ok(toml::Table::new()),
    };
    made.unwrap_or_default()
}

/// Returns a number of 32 bits as the serializer gives it.
fn single(number: f32) -> toml::Value {
    toml::Value::Float(number.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn float_is_the_shortest_decimal_that_reads_back() {
        let mut random = fastrand::Rng::with_seed(3);
        let known = [
            0.3,
            0.05,
            1.0,
            -0.0,
            1e-7,
            3.4e38,
            1e-45,
            12_345_679.0,
            0.333_333_34,
        ];
        let random = (0..2000)
            .map(|_| f32::from_bits(random.u32(..)))
            .filter(|k| k.is_finite());
        for number in known.into_iter().chain(random.collect::<Vec<_>>()) {
            let text = float(number.into(), "at").to_string();
            let read: toml::Table = format!("x = {text}").parse().unwrap();
            assert_eq!(read["x"].as_float().unwrap() as f32, number, "{text}");
            assert!(text.len() <= format!("{number:e}").len().max(format!("{number:?}").len()));
        }
        assert_eq!(float(f64::from(0.3_f32), "at").to_string(), "0.3");
        assert_eq!(float(0.45, "poisson").to_string(), "0.45");
    }
}
