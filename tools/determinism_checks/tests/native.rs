//! Golden scenes run natively; with the feature `parallel`, on one to eight threads.

use determinism_checks::golden::SCENES;

fn check_all(how: &str) {
    let found = SCENES.iter().map(|scene| (scene, (scene.run)()));
    let wrong = found.filter(|(scene, found)| *found != scene.golden);
    let wrong: Vec<String> = wrong
        .map(|(scene, found)| format!("{}: {found:#018x}", scene.name))
        .collect();
    assert!(wrong.is_empty(), "{how}: {wrong:#?}");
}

#[test]
fn every_scene_ends_in_its_golden_hash() {
    check_all("natively");
}

#[cfg(feature = "parallel")]
#[test]
fn golden_hashes_hold_for_any_number_of_threads() {
    for threads in 1..=8 {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().expect("threads can be started");
        pool.install(|| check_all(&format!("{threads} threads")));
    }
}
