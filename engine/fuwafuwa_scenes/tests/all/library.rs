//! The table of materials in the engine is made from `materials.toml`.

use fuwafuwa::library::Quantity;
use std::fmt::Write;
use std::path::Path;

/// Returns the source of the table.
fn table(text: &str) -> String {
    let file: toml::Table = text.parse().unwrap();
    let mut source = String::from(
        "//! Materials of the library, made from `materials.toml`: `UPDATE_TABLE=1 cargo test -p fuwafuwa_scenes library`.\n\n\
         use super::{LibraryMaterial, LibraryValue, Quantity};\n\n\
         /// All materials.\n\
         pub const MATERIALS: &[LibraryMaterial] = &[\n",
    );
    for material in file["material"].as_array().unwrap() {
        let fields = material.as_table().unwrap();
        let text = |key: &str| fields[key].as_str().unwrap();
        let known = |key: &&String| {
            ["name", "about"].contains(&key.as_str())
                || Quantity::ALL.iter().any(|quantity| quantity.key() == *key)
        };
        assert!(fields.keys().all(|key| known(&key)), "{fields:?}");
        writeln!(
            source,
            "    LibraryMaterial {{\n        name: {:?},\n        about: {:?},\n        values: &[",
            text("name"),
            text("about")
        )
        .unwrap();
        for quantity in Quantity::ALL {
            if let Some(field) = fields.get(quantity.key()) {
                source += &value(quantity, field.as_table().unwrap());
            }
        }
        source += "        ],\n    },\n";
    }
    source + "];\n"
}

/// Returns the source of one number.
fn value(quantity: Quantity, field: &toml::Table) -> String {
    let numbers = |value: &toml::Value| -> Vec<f64> {
        match value {
            toml::Value::Array(values) => values.iter().map(|k| k.as_float().unwrap()).collect(),
            value => vec![value.as_float().unwrap()],
        }
    };
    let given = numbers(&field["value"]);
    let value = [given[0], given.get(1).copied().unwrap_or(0.0)];
    let spread = field.get("spread").map(|spread| match numbers(spread)[..] {
        [deviation] => [value[0] - deviation, value[0] + deviation],
        [low, high] => [low, high],
        _ => panic!("{field:?}"),
    });
    let strain = field.get("strain").map(|strain| match numbers(strain)[..] {
        [low, high] => [low, high],
        _ => panic!("{field:?}"),
    });
    let option = |key: &str| field.get(key).map(|value| value.as_float().unwrap());
    let source = field["source"].as_str().unwrap();
    assert!(!source.is_empty());
    format!(
        "            LibraryValue {{\n                quantity: Quantity::{quantity:?},\n                value: {value:?},\n                \
         spread: {spread:?},\n                temperature: {:?},\n                rate: {:?},\n                strain: {strain:?},\n                source: {source:?},\n            }},\n",
        option("temperature"),
        option("rate"),
    )
}

#[test]
fn library_table_matches_materials_toml() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuwafuwa");
    let text = std::fs::read_to_string(folder.join("materials.toml")).unwrap();
    let path = folder.join("src/library/table.rs");
    let made = table(&text);
    if std::env::var_os("UPDATE_TABLE").is_some() {
        std::fs::write(&path, &made).unwrap();
    }
    // Compares without white space, because the formatter breaks long lines.
    let bare = |text: &str| -> String { text.split_whitespace().collect() };
    let found = std::fs::read_to_string(&path).unwrap();
    let found = bare(&found).replace(",}", "}").replace(",]", "]");
    let made = bare(&made).replace(",}", "}").replace(",]", "]");
    assert!(
        found == made,
        "run `UPDATE_TABLE=1 cargo test -p fuwafuwa_scenes library`, then `cargo fmt`"
    );
}
