//! Native tests of the checks: they cover all rounds, and they detect errors.

use determinism_checks::rounds::{Game, ROUNDS, record, series, verify};
use std::collections::BTreeSet;

#[test]
fn two_series_play_every_level_with_both_bots() {
    let [first, second] = [series(0), series(1)];
    assert_eq!([first.len(), second.len()], [ROUNDS; 2]);
    let pairs = first.iter().chain(&second).filter_map(|text| {
        let (pair, _) = text.rsplit_once(' ')?;
        Some(pair)
    });
    let pairs: BTreeSet<&str> = pairs.collect();
    // There are 14 levels. Two bots play each of them, except the two levels without a basket, which only
    // `random` plays.
    assert_eq!(pairs.len(), 14 + 12, "{pairs:?}");
    let all: BTreeSet<&String> = first.iter().chain(&second).collect();
    assert_eq!(all.len(), 2 * ROUNDS, "a round occurs twice");
}

#[test]
fn verify_accepts_a_recording_and_rejects_a_changed_hash() {
    let text = record("hoop squeeze 1").expect("the round can be played");
    verify(text.as_bytes()).expect("the replay is valid");
    let at = text.find("hashes = [").expect("the replay has hashes") + "hashes = [\"".len();
    let mut bytes = text.into_bytes();
    bytes[at] = if bytes[at] == b'0' { b'1' } else { b'0' };
    let reason = verify(&bytes).expect_err("the first hash was changed");
    assert!(reason.contains("goes another way at second 1"), "{reason}");
}

#[test]
fn invalid_rounds_and_replays_are_refused() {
    let check = |text, expect| {
        let reason = Game::begin(text).err().expect("the round is invalid");
        assert!(reason.contains(expect), "{text:?}: {reason}");
    };
    check("", "expected LEVEL BOT SEED");
    check("classic shave 1 2", "expected LEVEL BOT SEED");
    check("cheese shave 1", "no built-in level \"cheese\"");
    check("classic cook 1", "no bot \"cook\"");
    check("classic shave x", "the seed of");
    for bytes in [b"".as_slice(), b"\xff", b"version = 1"] {
        assert!(verify(bytes).is_err());
    }
}
