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
        assert!(!draft.is_changed() && !draft.can_undo() && !draft.can_redo());
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
    assert!(draft.is_changed() && draft.can_undo() && !draft.can_redo());
    let shown = draft.scene().clone();
    assert!((shown.body[0].at[0] - start.body[0].at[0] - 0.5).abs() < 1e-5);
    draft.settle();
    assert!(*draft.scene() == shown && draft.undo() && *draft.scene() == start && !draft.undo());
    assert!(draft.redo() && *draft.scene() == shown);
    draft.preview(|scene| scene.drag = 9.0);
    draft.cancel();
    assert_eq!(*draft.scene(), shown);
    draft.preview(|scene| scene.drag = 9.0);
    assert!(
        draft.undo() && *draft.scene() == shown,
        "undo forgets the preview first"
    );
}

#[test]
fn rules_stay_in_their_ranges() {
    let mut draft = Draft::of_level(&Level::open("classic").unwrap(), None);
    draft.set_name(Language::English, "  A\n\u{7}b  ");
    draft.set_name(Language::Japanese, &"あ".repeat(100));
    draft.set_name(Language::English, " \t ");
    let name = draft.scene().game.as_ref().unwrap().name.clone();
    assert_eq!(
        (name.en.as_str(), name.ja.unwrap().chars().count()),
        ("Ab", 60)
    );
    draft.set_name(Language::Japanese, "");
    let good = Wish {
        pieces: Some(2),
        ..Wish::default()
    };
    let joints = Wish {
        joints: Some(tamaire_play::Joints::Whole),
        ..Wish::default()
    };
    let mut goals = vec![
        Wish::default(),
        joints,
        Wish {
            kept: Some(2.0),
            ..Wish::default()
        },
    ];
    goals.extend(vec![good.clone(); 20]);
    draft.set_goals(goals);
    assert_eq!(
        draft.scene().game.as_ref().unwrap().wish,
        vec![good; MAX_GOALS]
    );
    for value in [
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        -1.0,
        0.0,
        0.5,
        1e9,
    ] {
        draft.set_share(value);
        draft.set_hold(value);
        draft.set_alone(value > 0.0);
        draft.set_gravity([value; 3]);
        draft.set_drag(value);
        draft.set_hand_size(value);
        draft.level().unwrap();
        assert_eq!(draft.scene().gravity[2], 0.0);
    }
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
        assert!(*draft.scene() == start && !draft.is_changed(), "{edits:#?}");
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
