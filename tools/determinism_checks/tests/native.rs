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
fn scene_ends_in_golden_hash_for_each() {
    check_all("natively");
}

#[cfg(feature = "parallel")]
#[test]
fn scene_ends_in_golden_hash_for_any_number_of_threads() {
    for threads in 1..=8 {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().expect("threads can be started");
        pool.install(|| check_all(&format!("{threads} threads")));
    }
}
