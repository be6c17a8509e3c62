//! Checks that `docs/report.md` describes every name in the output.

use crate::made_up::rows;
use crate::{all_files, logbooks, report_on};
use serde_json::Value;
use std::collections::BTreeSet;

fn names(value: &Value, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(fields) => {
            for (name, value) in fields {
                found.insert(name.clone());
                names(value, found);
            }
        }
        Value::Array(values) => values.iter().for_each(|value| names(value, found)),
        _ => {}
    }
}

#[test]
fn every_name_in_the_output_is_documented() {
    let described = include_str!("../../../../docs/report.md");
    let folder = tempfile::tempdir().unwrap();
    let files = logbooks(folder.path(), &[rows(4, 60)]);
    let out = folder.path().join("out");
    report_on(&files, &out, &all_files()).unwrap();
    let text = |name: &str| std::fs::read_to_string(out.join(name)).unwrap();
    let mut found = BTreeSet::new();
    let report: Value = serde_json::from_str(&text("report.json")).unwrap();
    let format = format!("| `format`, `rules` | {};", report["format"]);
    assert!(described.contains(&format), "{format}");
    names(&report, &mut found);
    for table in ["visits.csv", "rounds.csv", "events.csv"] {
        let columns = text(table);
        // Excel recognises UTF-8 by the byte order mark.
        let columns = columns.strip_prefix('\u{feff}').unwrap();
        let columns = columns.lines().next().unwrap().split(',');
        found.extend(columns.map(String::from));
    }
    assert!(found.len() > 80, "{}", found.len());
    for name in found {
        let is_described = [
            format!("`{name}`"),
            format!("`{name}["),
            format!("{name}` ="),
        ];
        assert!(
            is_described.iter().any(|text| described.contains(text)),
            "{name}"
        );
    }
}
