//! Golden scenes run natively; with the feature `parallel`, on one to eight threads.

use determinism_checks::golden::SCENES;

fn check_all(how: &str) {
    for scene in &SCENES {
        let found = (scene.run)();
        assert_eq!(found, scene.golden, "{}, {how}: {found:#018x}", scene.name);
    }
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
