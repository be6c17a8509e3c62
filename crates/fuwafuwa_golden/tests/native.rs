//! The golden scenes, natively.

use fuwafuwa_golden::{SCENES, golden_count, golden_holds};

#[test]
fn every_scene_comes_out_as_it_always_did() {
    for (name, run, golden) in SCENES {
        let found = run();
        assert_eq!(found, golden, "{name}: {found:#018x}");
    }
    assert_eq!(
        golden_holds(golden_count()),
        0,
        "there is no scene after the last"
    );
}
