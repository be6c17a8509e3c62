//! Doors for files that the game itself writes and that users may have edited.

use crate::seeds::small_levels;
use tamaire::records::Records;
use tamaire::settings::Settings;
use tamaire_play::{Outcome, Route};

pub fn settings(bytes: &[u8]) -> bool {
    let (settings, refused) = Settings::read(&String::from_utf8_lossy(bytes));
    let again = Settings::read(&settings.text());
    assert_eq!(again, (settings, Vec::new()));
    assert!(refused.iter().all(|told| told.len() < 2000), "{refused:?}");
    refused.is_empty()
}

pub fn records(bytes: &[u8]) -> bool {
    let (records, refused) = Records::read(&String::from_utf8_lossy(bytes));
    let again = Records::read(&records.text());
    assert_eq!(again, (records.clone(), Vec::new()));
    records.by_name(std::iter::empty());
    assert!(refused.iter().all(|told| told.len() < 2000), "{refused:?}");
    refused.is_empty()
}

pub fn settings_seeds() -> Vec<Vec<u8>> {
    let usual = Settings::default().text();
    let measured = "[calibrations.\"Force Stick\"]\nswap = true\ngain = [0.5, 1.0]\n";
    let old =
        "speed = 0.75\nlanguage = \"japanese\"\n# a remark\n\n[bindings.keys]\npause = [\"P\"]\n";
    vec![(usual + measured).into_bytes(), old.into()]
}

pub fn records_seeds() -> Vec<Vec<u8>> {
    let mut reached = Records::default();
    for (level, route) in small_levels()
        .iter()
        .zip([Route::Squeeze, Route::Shave, Route::Mix])
    {
        let outcome = Outcome {
            ticks: 600,
            route,
            kept: 1.0,
            inside: 1.0,
            pieces: 12,
            lost: 0,
            broken: 0,
            torn: 0,
        };
        reached.note(level, &outcome, u32::from(route == Route::Mix));
    }
    let old = "[classic]\nwishes = [0, 2]\nbest = { squeeze = 9 }\n[\"/home/me/own.toml\"]\nbest = { mix = 9 }\n";
    vec![reached.text().into_bytes(), old.into()]
}
