use super::*;
use crate::items;
use crate::items::tests::{edit, start_of};
use fuwafuwa_scenes::scene::{BasketText, BoxText, WishText};
use tamaire_play::level::built_in;

fn read(text: &str) -> Scene {
    Scene::read("level", text, &[]).unwrap()
}

/// Comment lines of a text.
fn comments(text: &str) -> Vec<&str> {
    text.lines().filter(|line| line.starts_with('#')).collect()
}

/// Checks that a merge reads back, and returns its text.
fn checked(text: &str, before: &Scene, after: &Scene) -> String {
    let merged = merged(text, before, after).unwrap();
    assert_eq!(read(&merged), *after, "{merged}");
    merged
}

/// Tables of a text with a header: the lines from the header, with the comments before it, to the next one.
fn blocks(text: &str) -> Vec<String> {
    let mut blocks = vec![String::new()];
    let mut waiting = String::new();
    for line in text.lines() {
        if line.is_empty() || line.starts_with('#') {
            waiting += line;
            waiting.push('\n');
            continue;
        }
        if line.starts_with('[') && !line.starts_with("[[body.part") {
            blocks.push(String::new());
        }
        let block = blocks.last_mut().unwrap();
        *block += &std::mem::take(&mut waiting);
        *block += line;
        block.push('\n');
    }
    blocks
}

#[test]
fn merge_of_an_unchanged_level_is_its_text() {
    for (id, text) in built_in() {
        let scene = read(text);
        assert_eq!(checked(text, &scene, &scene.clone()), text, "{id}");
        // The document itself keeps every byte, so that unchanged parts of a changed text do.
        let document: DocumentMut = text.parse().unwrap();
        assert_eq!(document.to_string(), text, "{id}");
    }
}

#[test]
fn merge_after_small_changes_keeps_everything_else() {
    for (id, text) in built_in() {
        let before = read(text);
        let mut named = before.clone();
        named.game.as_mut().unwrap().name.en = "Another \"name\"".into();
        let merged = checked(text, &before, &named);
        let differing = text
            .lines()
            .zip(merged.lines())
            .filter(|(a, b)| a != b)
            .count();
        assert_eq!(
            (differing, text.lines().count()),
            (1, merged.lines().count()),
            "{id}"
        );

        let mut moved = before.clone();
        for obstacle in moved.obstacle.iter_mut().step_by(2) {
            obstacle.friction += 0.125;
        }
        let merged = checked(text, &before, &moved);
        assert_eq!(comments(&merged), comments(text), "{id}");
        let [old, new] = [blocks(text), blocks(&merged)];
        let differing = old.iter().zip(&new).filter(|(a, b)| a != b).count();
        assert_eq!(
            (old.len(), differing),
            (new.len(), before.obstacle.len().div_ceil(2)),
            "{id}"
        );
    }
}

#[test]
fn merge_without_an_obstacle_lacks_its_lines_only() {
    for (id, text) in built_in() {
        let before = read(text);
        for index in (0..before.obstacle.len()).step_by(3) {
            let mut after = before.clone();
            items::remove(&mut after, &[items::Item::Obstacle(index)]);
            let joints = before.joint.len() + before.knife.len();
            if joints > 0 {
                checked(text, &before, &after);
                continue;
            }
            let merged = checked(text, &before, &after);
            let mut left = blocks(text);
            let headers = left.iter().enumerate();
            let mut headers = headers.filter(|(_, block)| block.contains("[[obstacle]]\n"));
            let (place, _) = headers.nth(index).unwrap();
            let gone = left.remove(place);
            let twin = left
                .iter()
                .any(|block| block.trim_start() == gone.trim_start());
            assert!(blocks(&merged) == left || twin, "{id}, {index}:\n{merged}");
        }
    }
}

#[test]
fn merge_with_a_new_entry_adds_its_lines_only() {
    for (id, text) in built_in() {
        let before = read(text);
        for place in 0..=before.obstacle.len() {
            let mut after = before.clone();
            let mut made = before.obstacle[0].clone();
            (made.half_space, made.capsule, made.ball, made.layers) = (None, None, None, None);
            (made.angular_velocity, made.pivot, made.switch) = (None, None, None);
            (made.path, made.max_force, made.max_torque, made.repeat) = (vec![], None, None, None);
            let half = [0.3, 0.05, 0.1];
            made.boxed = Some(BoxText {
                centre: [1.0 / 3.0, 0.1, 0.0],
                half,
            });
            made.friction = 0.2;
            after.obstacle.insert(place, made);
            let merged = checked(text, &before, &after);
            let new = "[[obstacle]]\nbox = { centre = [0.33333334, 0.1, 0.0], half = [0.3, 0.05, 0.1] }\n";
            assert!(merged.contains(new), "{id}:\n{merged}");
            let without = merged.replacen(&format!("\n{new}"), "", 1);
            assert_eq!(without, text, "{id}, {place}");
        }
    }
}

#[test]
fn merge_writes_embedded_files_of_built_in_levels() {
    for id in ["cat", "pudding"] {
        let (text, before, after) = start_of(id);
        let merged = checked(text, &before, &after);
        assert_eq!(comments(&merged), comments(text), "{id}");
        assert!(merged.contains("\ncontent = \""), "{id}");
    }
}

#[test]
fn merge_changes_inline_tables_and_arrays() {
    let text = "dim = 2 # flat\n[game]\nname = { en = \"A\" } # short\nbasket = { centre = [0.50, 0.0, 0.0], half = [0.2, 0.20, 0.0] }\nwish = [{ route = \"squeeze\" }, { seconds = 20.0 }]\nhint = [\n    [0.0, 0.10, 0.2, 0.0], # start\n    [1.0, 0.3, 0.4, 0.0],\n]\n\n[[hand]]\nradius = 0.10 # wide\npath = [[0.0, -1.20, 0.3, 0.0]]\n";
    let before = read(text);
    let mut after = before.clone();
    after.hand[0].path[0][2] = 0.35;
    let game = after.game.as_mut().unwrap();
    game.name.ja = Some("え".into());
    game.basket.as_mut().unwrap().half[0] = 0.3;
    game.wish.remove(0);
    game.wish.push(WishText {
        pieces: Some(3),
        ..WishText::default()
    });
    game.hint.push([2.0, 0.5, 0.5, 0.0]);
    let expected = "dim = 2 # flat\n[game]\nname = { en = \"A\", ja = \"え\" } # short\nbasket = { centre = [0.50, 0.0, 0.0], half = [0.3, 0.20, 0.0] }\nwish = [{ seconds = 20.0 }, { pieces = 3 }]\nhint = [\n    [0.0, 0.10, 0.2, 0.0], # start\n    [1.0, 0.3, 0.4, 0.0],\n    [2.0, 0.5, 0.5, 0.0],\n]\n\n[[hand]]\nradius = 0.10 # wide\npath = [[0.0, -1.20, 0.35, 0.0]]\n";
    assert_eq!(checked(text, &before, &after), expected);
}

#[test]
fn merge_replaces_one_basket_by_several() {
    let (text, before, _) = start_of("classic");
    let mut after = before.clone();
    let game = after.game.as_mut().unwrap();
    let only = game.basket.take().unwrap();
    for share in [None, Some(0.45)] {
        game.baskets.push(BasketText {
            centre: only.centre,
            half: only.half,
            share,
            ..BasketText::default()
        });
    }
    let merged = checked(text, &before, &after);
    assert!(merged.contains("share = 0.45 }"), "{merged}");
}

#[test]
fn merge_of_a_text_of_version_0_2_reads_back() {
    let text = "dim = 2\nmost_substeps = 32\n# A weight.\n[[rigid]]\nball = { centre = [0.0, 0.0, 0.0], radius = 0.2 }\ndrive = \"free\"\nmass = 3.0\nat = [0.0, 1.0, 0.0]\nturned = [0.0, 0.0, 0.5]\n[[joint]]\ntie = \"rope\"\nlength = 1.0\nends = [{ rigid = 1, at = [0.0, 1.0, 0.0] }, { at = [0.0, 2.0, 0.0] }]\n";
    let before = read(text);
    let mut after = before.clone();
    after.max_substeps = 16;
    after.rigid_body[0].rotation_vector = Some([0.0, 0.0, 0.25]);
    after.joint[0].anchors[1].point[1] = 2.5;
    let merged = checked(text, &before, &after);
    assert!(
        merged.contains("most_substeps = 16") && merged.contains("# A weight."),
        "{merged}"
    );
    // A text that is not that of the scene is replaced.
    assert_eq!(
        read(&super::merged("a = [", &before, &after).unwrap()),
        after
    );
    assert_eq!(
        read(&super::merged("dim = 3\n", &before, &after).unwrap()),
        after
    );
}

#[test]
fn written_levels_read_back_and_are_short() {
    for (id, text) in built_in() {
        let scene = read(text);
        let made = written(&scene).unwrap();
        assert_eq!(read(&made), scene, "{id}");
        assert!(
            made.len() < text.len() + 200,
            "{id}: {} and {}\n{made}",
            made.len(),
            text.len()
        );
    }
}

#[test]
fn merge_after_random_edits_reads_back() {
    let mut random = fastrand::Rng::with_seed(11);
    let levels: Vec<_> = built_in().collect();
    let mut fallbacks = 0;
    for _ in 0..300 {
        let (id, _) = *random.choice(&levels).unwrap();
        let (text, before, embedded) = start_of(id);
        let mut after = embedded;
        let mut clip = items::Clip::default();
        for _ in 0..random.usize(1..5) {
            edit(&mut after, &mut random, &mut clip);
        }
        let merged = checked(text, &before, &after);
        let is_known = |line: &&str| comments(text).contains(line);
        if comments(&merged).is_empty() && !comments(text).is_empty() && after != before {
            fallbacks += 1;
        }
        assert!(
            comments(&merged).iter().all(is_known),
            "{id}: no new comments"
        );
    }
    assert_eq!(fallbacks, 0, "merges that lost all comments");
}
