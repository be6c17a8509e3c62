//! The levels of the path: their ways win, a straight push does not.

use fuwafuwa::Vec3;
use fuwafuwa_scenes::scene::point_at;
use std::sync::Arc;
use std::thread;
use tamaire_play::bot::StraightPush;
use tamaire_play::level::{LevelError, PATH, PathLevel};
use tamaire_play::{AnyRound, InputFrame, Level, Link, Replay, Way};

/// Time limit of a round: a minute [ticks].
const MINUTE: usize = 60 * 60;

/// Runs a check for each level of the path, each on its own thread.
fn for_each_level(check: impl Fn(&PathLevel, Arc<Level>) + Sync) {
    let check = &check;
    thread::scope(|scope| {
        for level in PATH {
            scope.spawn(move || check(level, Arc::new(level.open())));
        }
    });
}

#[test]
fn every_level_has_two_ways_that_win_as_stated() {
    for_each_level(|known, level| {
        let ways = known.ways().way;
        assert!(ways.len() >= 2, "{}", known.id);
        for (index, way) in ways.iter().enumerate() {
            let id = format!("{}, way {}", known.id, index + 1);
            let mut round = AnyRound::new(level.clone());
            let won = way.play(&mut round, None).unwrap_or_else(|| panic!("{id}"));
            assert_eq!(won.route, way.route, "{id}");
            assert_eq!(won.wishes(level.game()), way.wishes, "{id}: {won:?}");
            let replay = Replay::read(&round.replay().text()).unwrap();
            assert_eq!(replay.outcome, Some(won), "{id}");
            let Ok(Link::Round(sent)) = Link::read(&replay.link().unwrap()) else {
                panic!("{id}: no round in the link");
            };
            assert_eq!(sent.outcome, Some(won), "{id}");
        }
        for number in 1..=level.game().wish.len() {
            let is_shown = ways.iter().any(|way| way.wishes.contains(&number));
            assert!(is_shown, "{}: no way reaches goal {number}", known.id);
        }
        let different = |[a, b]: [usize; 2]| {
            let [a, b] = [&ways[a], &ways[b]];
            a.route != b.route || a.wishes != b.wishes
        };
        assert!(different([0, 1]), "{}: both ways are alike", known.id);
    });
}

#[test]
fn every_hint_is_the_beginning_of_a_way() {
    for level in PATH {
        let (hint, ways) = (level.open().game().hint.clone(), level.ways().way);
        assert!(hint.len() >= 2, "{}: no hint", level.id);
        let is_on = |way: &Way, &[seconds, x, y, z]: &[f32; 4]| {
            let at = Vec3::from(point_at(&way.path, seconds));
            (at - Vec3::new(x, y, z)).length() < 0.005
        };
        let is_beginning = ways
            .iter()
            .any(|way| hint.iter().all(|point| is_on(way, point)));
        assert!(is_beginning, "{}: {hint:?}", level.id);
    }
}

#[test]
fn a_way_wins_with_a_trembling_hand() {
    for_each_level(|known, level| {
        let wins = |seed| {
            known.ways().way.iter().any(|way| {
                let mut round = AnyRound::new(level.clone());
                way.play(&mut round, Some(seed)).is_some()
            })
        };
        assert!((11..13).all(wins), "{}", known.id);
    });
}

/// Plays a straight bot for a minute. Returns whether it wins.
fn straight_push_wins(level: &Arc<Level>, chases: bool, speed: f32, seed: u64) -> bool {
    let mut bot = StraightPush::new(chases, speed, seed);
    let mut round = AnyRound::new(level.clone());
    round.push_straight(&mut bot, MINUTE).is_some()
}

/// Rounds of 3D levels take ten times as long, so the ignored test plays them.
#[test]
fn straight_push_wins_no_2d_level() {
    for_each_level(|known, level| {
        if level.scene().dim == 2 {
            for (chases, speed) in [(false, 0.7), (true, 0.7)] {
                assert!(
                    !straight_push_wins(&level, chases, speed, 101),
                    "{}, {chases}",
                    known.id
                );
            }
        }
    });
}

#[test]
#[ignore = "takes hours: cargo test --release -p tamaire_play --test all ways -- --ignored --nocapture"]
fn straight_push_wins_no_level_at_three_speeds_from_twenty_starts() {
    for_each_level(|known, level| {
        for chases in [false, true] {
            for speed in [0.3, 0.7, 3.0] {
                let won = |&seed: &u64| straight_push_wins(&level, chases, speed, seed);
                let won: Vec<u64> = (0..20).filter(won).collect();
                println!(
                    "{}, chases: {chases}, {speed} m/s: won with {won:?}",
                    known.id
                );
                assert!(won.is_empty(), "{}", known.id);
            }
        }
    });
}

/// Level with a ball that already lies in the basket, and the hand above it.
const LYING: &str = r#"
dim = 2
view = [[-1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]

[game]
name = { en = "Lying" }
basket = { centre = [0.0, 0.2, 0.0], half = [0.3, 0.3, 0.0] }

[[body]]
shape = "ball"
n = 16
width = 0.4
at = [-0.2, 0.0, 0.0]

[[obstacle]]
half_space = { normal = [0.0, 1.0, 0.0], point = [0.0, 0.0, 0.0] }

[[hand]]
radius = 0.1
path = [[0.0, 0.0, 0.8, 0.0]]
"#;

fn lying(text: &str) -> Result<Level, LevelError> {
    let nothing = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    Level::read("lying.toml", text.as_bytes(), &nothing)
}

/// Presses on the ball from 0.2 s to 3 s. Returns the time of the win [s] and the number of ticks in which only the hand
/// prevented it.
fn press(rule: &str) -> (f32, usize) {
    let text = LYING.replace("[game]", &format!("[game]\n{rule}"));
    let mut round = AnyRound::new(Arc::new(lying(&text).unwrap()));
    let mut waited = 0;
    while round.progress().outcome.is_none() && round.ticks() < 600 {
        let height = if (12..180).contains(&round.ticks()) {
            0.4
        } else {
            0.8
        };
        round.step(InputFrame::towards(Vec3::new(0.0, height, 0.0)));
        let progress = round.progress();
        if progress.waits_for_hand(round.level().game()) {
            assert!(progress.touched && progress.held == 0.0);
            waited += 1;
        }
    }
    (round.ticks() as f32 / 60.0, waited)
}

#[test]
fn basket_counts_only_while_no_hand_touches_its_content() {
    let (seconds, waited) = press("alone = true");
    assert!(
        (4.0..6.0).contains(&seconds) && waited > 100,
        "{seconds} s, {waited}"
    );
    let (seconds, waited) = press("");
    assert!(seconds < 3.0 && waited == 0, "{seconds} s, {waited}");
}

#[test]
fn only_the_chosen_bodies_count() {
    let other =
        "[[body]]\nshape = \"box\"\nn = 8\nwidth = 0.2\nat = [0.6, 0.0, 0.0]\n\n[[obstacle]]";
    let text = LYING.replacen("[[obstacle]]", other, 1);
    let won = |bodies: &str| {
        let text = text.replace("[game]", &format!("[game]\nshare = 0.95\n{bodies}"));
        let mut round = AnyRound::new(Arc::new(lying(&text).unwrap()));
        for _ in 0..240 {
            round.step(InputFrame::default());
        }
        round.progress().outcome.map(|won| won.pieces)
    };
    assert_eq!(
        [won("bodies = [1]"), won("bodies = [2]"), won("")],
        [Some(1), None, None]
    );
    let refused = lying(&text.replace("[game]", "[game]\nbodies = [3]"));
    let refused = refused.unwrap_err().to_string();
    assert!(
        refused.contains("bodies 1: expected 1 to 2, found 3"),
        "{refused}"
    );
}
