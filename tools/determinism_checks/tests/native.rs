//! The golden scenes, natively; with the feature `parallel`, on one to eight threads.

use determinism_checks::golden::SCENES;

fn check_all(how: &str) {
    for scene in &SCENES {
        let found = (scene.run)();
        assert_eq!(found, scene.golden, "{}, {how}: {found:#018x}", scene.name);
    }
}

#[test]
fn every_scene_comes_out_as_it_always_did() {
    check_all("natively");
}

#[cfg(feature = "parallel")]
#[test]
fn any_number_of_threads_gives_the_same_bits() {
    for threads in 1..=8 {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().expect("threads can be started");
        pool.install(|| check_all(&format!("{threads} threads")));
    }
}
