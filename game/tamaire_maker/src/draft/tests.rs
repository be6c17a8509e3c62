use super::*;
use crate::items::tests::{edit, small};
use crate::items::{Clip, Item, translate};
use fuwafuwa::Vec3;
use tamaire_play::Link;
use tamaire_play::level::built_in;

fn drafts() -> Vec<Draft> {
    let all = built_in();
    all.map(|(id, text)| Draft::of_level(&Level::open(id).unwrap(), Some(text)))
        .collect()
}

#[test]
fn unchanged_draft_has_the_text_of_its_level() {
    for (draft, (id, text)) in drafts().iter().zip(built_in()) {
        assert!(!draft.can_undo() && !draft.can_redo());
        // Texts that name files get their content.
        assert!(
            draft.text() == text || draft.scene().body.iter().any(|body| body.file.is_some()),
            "{id}"
        );
    }
    let level = Level::open("classic").unwrap();
    let draft = Draft::of_level(&level, None);
    let read = Scene::read("classic", &draft.text(), &[]).unwrap();
    assert_eq!(read, *level.scene());
}

#[test]
fn blank_levels_can_be_played() {
    for dim in [2, 3] {
        let draft = Draft::blank(dim);
        let level = draft.level().unwrap();
        assert_eq!((level.scene().dim, level.has_basket()), (dim, false));
        assert_eq!(
            Scene::read("new", &draft.text(), &[]).unwrap(),
            *level.scene()
        );
    }
}

#[test]
fn preview_is_one_step_when_it_settles() {
    let mut draft = Draft::blank(2);
    let start = draft.scene().clone();
    for step in 1..=5 {
        draft.preview(|scene| translate(scene, &[Item::Body(0)], Vec3::X * 0.1 * step as f32));
    }
    assert!(draft.can_undo() && !draft.can_redo());
    let shown = draft.scene().clone();
    assert!((shown.body[0].at[0] - start.body[0].at[0] - 0.5).abs() < 1e-5);
    draft.settle();
    assert!(*draft.scene() == shown && draft.undo() && *draft.scene() == start && !draft.undo());
    assert!(draft.redo() && *draft.scene() == shown);
    draft.preview(|scene| scene.drag = 9.0);
    assert!(
        draft.undo() && *draft.scene() == shown,
        "undo forgets the preview first"
    );
}

#[test]
fn names_are_trimmed_and_cut() {
    let mut draft = Draft::of_level(&Level::open("classic").unwrap(), None);
    let long = "あ".repeat(100);
    draft.set_names(&[
        (Language::English, "  A\n\u{7}b  "),
        (Language::Japanese, &long),
    ]);
    assert_eq!(draft.name(Language::English), "Ab");
    assert_eq!(draft.name(Language::Japanese).chars().count(), MAX_NAME);
    draft.level().unwrap();
    draft.set_names(&[(Language::Japanese, "")]);
    assert_eq!(draft.scene().game.as_ref().unwrap().name.ja, None);
    draft.level().unwrap();
    draft.set_names(&[(Language::English, " \t ")]);
    assert_eq!(draft.name(Language::English), "");
    draft.level().expect_err("a level needs an English name");
    assert_eq!(draft.first_name(Language::English), "Classic");
}

#[test]
fn typed_name_is_one_step_of_undo() {
    let mut draft = Draft::of_level(&Level::open("classic").unwrap(), None);
    for name in ["M", "My", "Mine"] {
        draft.set_names(&[(Language::English, name), (Language::Japanese, name)]);
    }
    draft.settle();
    assert_eq!(draft.name(Language::Japanese), "Mine");
    assert!(draft.undo() && !draft.can_undo());
    assert_eq!(draft.name(Language::English), "Classic");
}

#[test]
fn amended_draft_has_no_further_step_and_keeps_redo() {
    let mut draft = Draft::blank(2);
    draft.change(|scene| scene.drag = 9.0);
    assert!(draft.undo());
    draft.amend(|scene| scene.drag = 3.0);
    assert!(draft.scene().drag == 3.0 && !draft.can_undo());
    assert!(draft.redo() && draft.scene().drag == 9.0);
}

#[test]
fn restarted_draft_has_no_steps_and_a_new_first_name() {
    let mut draft = Draft::blank(2);
    draft.change(|scene| scene.drag = 9.0);
    draft.restart(|scene| set_name(scene, Language::English, "Second"));
    assert!(!draft.can_undo() && draft.scene().drag == 9.0);
    assert_eq!(draft.first_name(Language::English), "Second");
}

#[test]
fn oldest_steps_of_a_huge_level_are_forgotten() {
    let mut draft = Draft::blank(2);
    draft.restart(|scene| scene.body[0].content = Some("A".repeat(100 << 20)));
    for step in 1..=4 {
        draft.change(|scene| scene.drag = step as f32);
    }
    let undone = (0..4).take_while(|_| draft.undo()).count();
    assert_eq!((undone, draft.scene().drag), (2, 2.0));
}

#[test]
fn edited_levels_undo_to_their_start_and_read_back() {
    let drafts = drafts();
    let mut random = fastrand::Rng::with_seed(21);
    let mut links = 0;
    for round in 0..1000 {
        let mut draft = random.choice(&drafts).unwrap().clone();
        let start = draft.scene().clone();
        let mut clip = Clip::default();
        let mut edits = vec![draft.id().to_owned()];
        for _ in 0..random.usize(1..13) {
            match random.u8(..6) {
                0 => drop(draft.undo()),
                1 => drop(draft.redo()),
                2 => {
                    draft.preview(|scene| edit(scene, &mut random.clone(), &mut clip.clone()));
                    edits.push(draft.preview(|scene| edit(scene, &mut random, &mut clip)));
                    draft.settle();
                }
                _ => edits.push(draft.change(|scene| edit(scene, &mut random, &mut clip))),
            }
        }
        let read = Scene::read("level", &draft.text(), &[]).unwrap();
        assert!(read == *draft.scene(), "{edits:#?}");
        if round % 25 == 0 {
            let mut reduced = draft.clone();
            reduced.change(|scene| *scene = small(scene));
            links += usize::from(link_reads_back(&reduced));
        }
        while draft.undo() {}
        assert!(*draft.scene() == start, "{edits:#?}");
    }
    assert!(links > 10, "{links} links");
}

/// Whether the level can be played and sent. Checks that it is the same then.
fn link_reads_back(draft: &Draft) -> bool {
    let Ok(level) = draft.level() else {
        return false;
    };
    // A link may be too long.
    let Ok(link) = level.link() else {
        return false;
    };
    match Link::read(&link).unwrap() {
        Link::Level(read) => assert_eq!(*read.scene(), *level.scene()),
        Link::Round(_) => panic!("expected a level"),
    }
    true
}

#[test]
fn usual_names_are_those_of_new_levels_with_any_number() {
    for (name, language, expected) in [
        ("My level", Language::English, true),
        ("My level 12", Language::English, true),
        ("My level", Language::Japanese, false),
        ("わたしの ステージ 2", Language::Japanese, true),
        ("My levels", Language::English, false),
        ("", Language::English, false),
    ] {
        assert_eq!(is_usual_name(name, language), expected, "{name}");
    }
    for (name, expected) in [
        ("Cat 2", ("Cat", Some(2))),
        ("Cat", ("Cat", None)),
        ("Race 2000", ("Race 2000", None)),
        (" 2", (" 2", None)),
    ] {
        assert_eq!(without_number(name), expected);
    }
}
